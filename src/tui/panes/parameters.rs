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
use ratatui::layout::Rect;
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
/// Below this height a pane in focus has the list alone.
const TABLE_FROM: u16 = 8;

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
        let [place, _] = split_columns(area, width.saturating_sub(1));
        let theme = &self.view.theme;
        let end = write(place, (0, 0), label, theme.style(Role::Text), buf);
        let unit = self.unit(unit);
        if usize::from(end) + 1 + unit.chars().count() <= place.width.into() {
            write(place, (end + 1, 0), unit, theme.style(Role::Label), buf);
        }
    }

    fn editor(&self, columns: u16, value_end: u16, area: Rect, buf: &mut Buffer) {
        let editor = Editor {
            pane: self,
            columns,
            value_end,
        };
        editor.render(area, buf);
    }

    /// The table above, and the values of the scenario below.
    fn stacked(&self, area: Rect, buf: &mut Buffer) {
        let (table_width, value_columns) = table::narrow_columns(area.width);
        let value_end = table_width + value_columns;
        if self.has_focus() && area.height < TABLE_FROM {
            return self.editor(1, value_end, below_rule(area), buf);
        }
        let rows = self.table_rows(area.height);
        let [upper, rest] = split_rows(area, rows);
        ValueTable { pane: self }.render(upper, buf);
        let gap = u16::from(rest.height > editor::main_rows(self.list) + 1);
        let [_, lower] = split_rows(rest, gap);
        self.editor(1, value_end, lower, buf);
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

    /// The table, and beside it the values of the scenario.
    fn side_by_side(&self, area: Rect, buf: &mut Buffer) {
        let widths = TABLE_COLUMNS.iter().find(|(from, _)| area.width >= *from);
        let table_width = widths.map_or(0, |(_, columns)| *columns);
        if area.width >= WIDE_FROM {
            let [left, rest] = split_columns(area, table_width);
            let [_, right] = split_columns(rest, 2);
            ValueTable { pane: self }.render(left, buf);
            return self.editor(right.width / LIST_COLUMNS, 25, right, buf);
        }
        let [left, rest] = split_columns(area, area.width - table_width - 2);
        let [_, right] = split_columns(rest, 2);
        let columns = (left.width / LIST_COLUMNS).max(1);
        self.editor(columns, left.width.min(25), below_rule(left), buf);
        ValueTable { pane: self }.render(right, buf);
    }
}

impl Widget for ValuesPane<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        // The last column is empty, as the gap between panes is.
        let [area, _] = split_columns(area, area.width.saturating_sub(1));
        if area.is_empty() {
            return;
        }
        let is_wide = area.width + 1 >= WIDE_FROM;
        let under_title = if is_wide {
            TABLE_COLUMNS[0].1
        } else {
            area.width
        };
        let [titled, _] = split_columns(area, under_title);
        let focus = self.view.marks_focus_of(PARAMETERS_ROW.id);
        rule(&self.title(), None, focus, titled, &self.view.theme, buf);
        if area.width + 1 < BESIDE_FROM {
            self.stacked(area, buf);
        } else {
            self.side_by_side(area, buf);
        }
    }
}

/// `number` with the minus sign of a printed text, and without that of a zero.
fn with_minus(number: String) -> String {
    without_minus_zero(number).replace('-', "−")
}
