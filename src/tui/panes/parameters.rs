//! The values: what the run and the exact motion are now or at the cursor, and the values of the scenario, of which the
//! underlined ones can be edited.

mod editor;
mod table;

use super::{PaneRow, below_rule, rule, write};
use crate::engine::analysis::Readouts;
use crate::engine::run::Moment;
use crate::engine::text::number::without_minus_zero;
use crate::lab::Lab;
use crate::lab::form::InputField;
use crate::lab::values::list::ValueList;
use crate::lab::view::theme::Marker;
use crate::lab::view::{HideablePart, Pane, View};
use crate::tui::keymap::{Mode, VALUES_KEYS};
use crate::tui::split::{split_columns, split_rows};
use crate::tui::theme::Role;
use editor::Editor;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::widgets::Widget;
use std::borrow::Cow;
use table::ValueTable;

/// From this width on the values of the scenario are beside the table.
const BESIDE_FROM: u16 = 40;
/// From this width on the table has further columns and comes first.
const WIDE_FROM: u16 = 90;
/// Columns of the table where it is beside the values of the scenario, by the width of the pane.
const TABLE_COLUMNS: [(u16, u16); 3] = [(WIDE_FROM, 54), (60, 29), (BESIDE_FROM, 22)];
/// The fewest columns for a list of the scenario's values.
const LIST_COLUMNS: u16 = 27;
/// The column of a wide list after the last digit of a value.
const VALUE_END: u16 = 25;
/// Below this height a pane in focus has the list alone.
const TABLE_FROM: u16 = 8;

/// From this many columns on, dots stand for the rest of a label.
const DOTTED_FROM: u16 = 9;

pub const PARAMETERS_ROW: PaneRow = PaneRow {
    id: Pane::Parameters,
    title: "values",
    draw: |lab, area, buf| ValuesPane::of(lab).render(area, buf),
    keys: VALUES_KEYS,
    arrows: None,
};

pub struct ValuesPane<'a> {
    pub readouts: &'a Readouts,
    pub now: &'a Moment,
    /// The exact motion at the same time; `None` where it is not known.
    pub exact: Option<&'a Moment>,
    /// The run and the exact motion at the cursor.
    pub cursor: Option<(&'a Moment, Option<&'a Moment>)>,
    pub list: &'a ValueList,
    /// Whether a part of a name is being typed, to find a value.
    pub is_searched: bool,
    /// The field in the place of the selected value while it is typed.
    pub field: Option<&'a InputField>,
    pub view: &'a View,
}

impl<'a> ValuesPane<'a> {
    fn of(lab: &'a Lab) -> Self {
        let reading = &lab.player().reading;
        let dialog = lab.popups().dialog().filter(|dialog| dialog.is_of_value());
        Self {
            readouts: &reading.readouts,
            now: &reading.moment,
            exact: reading.exact.as_ref(),
            cursor: lab.player().cursor_moments(),
            list: &lab.values().list,
            is_searched: lab.popups().mode == Mode::Find,
            field: dialog.and_then(|dialog| dialog.form.fields.first()),
            view: lab.view(),
        }
    }

    fn has_focus(&self) -> bool {
        self.view.focus == PARAMETERS_ROW.id
    }

    /// The pane's title, or the name that is searched for.
    fn title(&self) -> Cow<'static, str> {
        let name = &self.list.name;
        match (self.has_focus() && !name.is_empty(), self.is_searched) {
            (_, true) => format!("/{name}_").into(),
            (true, false) => format!("/{name}").into(),
            (false, false) => PARAMETERS_ROW.title.into(),
        }
    }

    /// The name that is searched for; empty if all values are shown.
    fn searched(&self) -> &str {
        if self.has_focus() {
            &self.list.name
        } else {
            ""
        }
    }

    fn hides_exact(&self) -> bool {
        self.view.hides(HideablePart::Predicted)
    }

    /// A unit as this screen can show it.
    fn unit(&self, unit: &'static str) -> &'static str {
        if self.view.marker == Marker::Ascii {
            return match unit {
                "°" => "deg",
                "°/s" => "deg/s",
                other => other,
            };
        }
        match unit {
            "deg" => "°",
            "deg/s" => "°/s",
            "m/s2" => "m/s²",
            "kg m2" => "kg m²",
            other => other,
        }
    }

    /// Writes `label` and, where there is room for it within `width` columns, its unit.
    fn label(&self, label: &str, unit: &'static str, width: u16, area: Rect, buf: &mut Buffer) {
        let [place, _] = split_columns(area, width);
        let theme = &self.view.theme;
        // In few columns the letters tell more than the dots of what is cut.
        let most = usize::from(place.width);
        let cut: String = label.chars().take(most).collect();
        let text = if place.width < DOTTED_FROM {
            &cut
        } else {
            label
        };
        let end = write(place, (0, 0), text, theme.style(Role::Text), buf);
        let unit = self.unit(unit);
        if usize::from(end) + 1 + unit.chars().count() <= place.width.into() {
            write(place, (end + 1, 0), unit, theme.style(Role::Label), buf);
        }
    }

    /// Where the table and the list are on `area`.
    fn places(&self, area: Rect) -> Places {
        if area.width + 1 < BESIDE_FROM {
            self.stacked(area)
        } else {
            self.side_by_side(area)
        }
    }

    /// The table above, and the values of the scenario below.
    fn stacked(&self, area: Rect) -> Places {
        let (label_width, number_width) = table::narrow_columns(area.width);
        let list = |place| ListPlace {
            area: place,
            columns: 1,
            value_end: label_width + number_width,
        };
        if self.has_focus() && area.height < TABLE_FROM {
            return Places {
                table: Rect::ZERO,
                list: list(below_rule(area)),
            };
        }
        let [upper, rest] = split_rows(area, self.table_rows(area.height));
        let gap = u16::from(rest.height > editor::main_rows(self.list) + 1);
        let [_, lower] = split_rows(rest, gap);
        Places {
            table: upper,
            list: list(lower),
        }
    }

    /// The table, and beside it the values of the scenario.
    fn side_by_side(&self, area: Rect) -> Places {
        let widths = TABLE_COLUMNS
            .iter()
            .find(|(from, _)| area.width + 1 >= *from);
        let table_width = widths.map_or(0, |(_, columns)| *columns);
        if area.width + 1 >= WIDE_FROM {
            let [table, rest] = split_columns(area, table_width);
            let [_, right] = split_columns(rest, 2);
            let list = ListPlace {
                area: right,
                columns: right.width / LIST_COLUMNS,
                value_end: VALUE_END,
            };
            return Places { table, list };
        }
        let [left, rest] = split_columns(area, area.width.saturating_sub(table_width + 2));
        let [_, table] = split_columns(rest, 2);
        let list = ListPlace {
            area: below_rule(left),
            columns: (left.width / LIST_COLUMNS).max(1),
            value_end: left.width.min(VALUE_END),
        };
        Places { table, list }
    }

    /// Rows of the table, its rule included, in a pane of this height.
    fn table_rows(&self, height: u16) -> u16 {
        let [least, most] = table::row_counts(self).map(|rows| rows + 1);
        let list = if self.has_focus() {
            height * 3 / 5
        } else {
            editor::main_rows(self.list)
        };
        height.saturating_sub(list).clamp(least.min(height), most)
    }
}

/// Where the parts of the pane are.
struct Places {
    /// Empty if only the list has room.
    table: Rect,
    list: ListPlace,
}

/// Where the values of the scenario are.
#[derive(Clone, Copy)]
struct ListPlace {
    area: Rect,
    /// How many lists are beside each other.
    columns: u16,
    /// The column of each list after the last digit of a value.
    value_end: u16,
}

/// Returns the number, in the list of values, of the one at `at` of the pane on `area`.
pub fn value_at(lab: &Lab, area: Rect, at: Position) -> Option<usize> {
    let pane = &ValuesPane::of(lab);
    let place = pane.places(without_gap(area)).list;
    Editor { pane, place }.value_at(at)
}

/// `area` without its last column, which is empty as the gap between panes is.
fn without_gap(area: Rect) -> Rect {
    split_columns(area, area.width.saturating_sub(1))[0]
}

impl Widget for ValuesPane<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let inside = without_gap(area);
        if inside.is_empty() {
            return;
        }
        let is_wide = inside.width + 1 >= WIDE_FROM;
        let under_title = if is_wide {
            TABLE_COLUMNS[0].1
        } else {
            inside.width
        };
        let [titled, _] = split_columns(inside, under_title);
        let focus = self.view.marks_focus_of(PARAMETERS_ROW.id);
        rule(&self.title(), None, focus, titled, &self.view.theme, buf);
        let places = self.places(inside);
        ValueTable { pane: &self }.render(places.table, buf);
        let editor = Editor {
            pane: &self,
            place: places.list,
        };
        editor.render(buf);
    }
}

/// `number` with the minus sign of a printed text, and without that of a zero.
fn with_minus(number: String) -> String {
    without_minus_zero(number).replace('-', "−")
}
