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
    pub(super) fn remove_empty_columns(&mut self) {
        let all = 0..self.columns.len();
        let is_kept: Vec<bool> = all
            .map(|column| self.rows.is_empty() || !self.cells(column).all(Text::is_empty))
            .collect();
        let mut columns = is_kept.iter();
        self.columns.retain(|_| columns.next() == Some(&true));
        for row in &mut self.rows {
            let mut cells = is_kept.iter();
            row.retain(|_| cells.next() == Some(&true));
        }
    }

    /// Returns the cells of a column.
    pub(super) fn cells(&self, column: usize) -> impl Iterator<Item = &Text> {
        self.rows.iter().filter_map(move |row| row.get(column))
    }
}
