//! Tables.

use super::text::Text;

#[derive(Clone, Debug)]
pub struct Table {
    /// The name by which `[#label]` in a text refers to it: letters, digits and hyphens.
    pub label: Option<String>,
    pub caption: Text,
    pub columns: Vec<Column>,
    /// Rows, each with a cell for every column.
    pub rows: Vec<Vec<Text>>,
}

#[derive(Clone, Debug)]
pub struct Column {
    pub header: Text,
    pub kind: ColumnKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    Text,
    /// Cells made by [`Text::number`] are aligned at the decimal point; other cells are centered.
    Number,
}

impl Column {
    /// A column of text; `header` is markup.
    pub fn text(header: &str) -> Self {
        Self {
            header: Text::marked(header),
            kind: ColumnKind::Text,
        }
    }

    /// A column of numbers; `header` is markup.
    pub fn number(header: &str) -> Self {
        Self {
            header: Text::marked(header),
            kind: ColumnKind::Number,
        }
    }
}

impl Table {
    /// Returns the cells of a column.
    pub(super) fn cells(&self, column: usize) -> impl Iterator<Item = &Text> {
        self.rows.iter().filter_map(move |row| row.get(column))
    }
}
