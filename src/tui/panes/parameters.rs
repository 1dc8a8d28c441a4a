//! The values pane: readouts of the run and of the exact motion now or at the cursor, and the values of the scenario.
//! Underlined values can be edited.

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

/// Minimum width for the values of the scenario next to the table, columns.
const BESIDE_FROM: u16 = 40;
/// Minimum width for a table with further columns, which then comes first, columns.
const WIDE_FROM: u16 = 90;
/// Columns of the table next to the values of the scenario, for minimum widths of the pane: (width, columns).
const TABLE_COLUMNS: [(u16, u16); 3] = [(WIDE_FROM, 54), (60, 29), (BESIDE_FROM, 22)];
/// Minimum columns for a list of the scenario's values.
const LIST_COLUMNS: u16 = 27;
/// Column after the last digit of a value in a wide list.
const VALUE_END: u16 = 25;
/// Minimum height for the table above the list while the pane has the focus, rows.
const TABLE_FROM: u16 = 8;

/// Minimum width of a label that is shortened with dots, columns.
const DOTTED_FROM: u16 = 9;

pub const PARAMETERS_ROW: PaneRow = PaneRow {
    id: Pane::Parameters,
    title: "values",
    draw: |lab, area, buf| ValuesPane::of(lab).render(area, buf),
    keys: VALUES_KEYS,
    arrows: None,
};

/// The values pane with everything it shows.
pub struct ValuesPane<'a> {
    pub readouts: &'a Readouts,
    pub now: &'a Moment,
    /// Exact motion at the same time, if known.
    pub exact: Option<&'a Moment>,
    /// The run and the exact motion at the cursor.
    pub cursor: Option<(&'a Moment, Option<&'a Moment>)>,
    pub list: &'a ValueList,
    /// True while the user types a part of a name to find a value.
    pub is_searched: bool,
    /// Input field that replaces the selected value while it is edited.
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

    /// Returns the pane's title, or the searched name.
    fn title(&self) -> Cow<'static, str> {
        let name = &self.list.name;
        match (self.has_focus() && !name.is_empty(), self.is_searched) {
            (_, true) => format!("/{name}_").into(),
            (true, false) => format!("/{name}").into(),
            (false, false) => PARAMETERS_ROW.title.into(),
        }
    }

    /// Returns the searched name; empty if all values are shown.
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

    /// Returns a unit in the characters of this screen.
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

    /// Writes `label` and, if there is room within `width` columns, its unit.
    fn label(&self, label: &str, unit: &'static str, width: u16, area: Rect, buf: &mut Buffer) {
        let [place, _] = split_columns(area, width);
        let theme = &self.view.theme;
        // In few columns, more letters tell more than dots for the rest.
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

    /// Returns the areas of the table and the list on `area`.
    fn places(&self, area: Rect) -> Places {
        if area.width + 1 < BESIDE_FROM {
            self.stacked(area)
        } else {
            self.side_by_side(area)
        }
    }

    /// Places the table above the values of the scenario.
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

    /// Places the table and the values of the scenario side by side.
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

    /// Returns the rows of the table, including its rule, in a pane of this height.
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

/// Areas of the parts of the pane.
struct Places {
    /// Area of the table; empty if only the list has room.
    table: Rect,
    list: ListPlace,
}

/// Area of the values of the scenario.
#[derive(Clone, Copy)]
struct ListPlace {
    area: Rect,
    /// Number of lists side by side.
    columns: u16,
    /// Column of each list after the last digit of a value.
    value_end: u16,
}

/// Returns the number, in the list of values, of the value at the cell `at`, if the pane has this `area`.
pub fn value_at(lab: &Lab, area: Rect, at: Position) -> Option<usize> {
    let pane = &ValuesPane::of(lab);
    let place = pane.places(without_gap(area)).list;
    Editor { pane, place }.value_at(at)
}

/// Returns `area` without its last column, which stays empty like the gap between panes.
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

/// Returns `number` with a typographic minus sign, and without a sign before zero.
fn with_minus(number: String) -> String {
    without_minus_zero(number).replace('-', "−")
}
