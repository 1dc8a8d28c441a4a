//! Sums of the first rows of a table, for whoever shows how they add up.

use super::Table;

/// Rows between two sums that are stored.
const EVERY: usize = 256;
/// Rows are added up in turn to so many sums, which are added last, as the report's scheme does it with its points: the
/// sum of all rows is then the scheme's to the last bit.
const LANES: usize = 2;

/// Sums of the columns of a table, stored after every 256 rows: the sum of any number of rows is at most 255 rows away.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    columns: usize,
    /// After 0, 256, 512 ... rows: the sums of every second row from the first, column by column, and then those of every
    /// second row from the second.
    stored: Vec<f64>,
}

impl Sums {
    /// The sums of `table`; its rows are visited once.
    pub fn of(table: &Table) -> Self {
        let columns = table.columns.len();
        let mut lanes = vec![0.0; LANES * columns];
        let mut stored = lanes.clone();
        for (row, (_, cells)) in table.rows().enumerate() {
            add(&mut lanes, row, cells);
            if (row + 1) % EVERY == 0 {
                stored.extend_from_slice(&lanes);
            }
        }
        Self { columns, stored }
    }

    /// The sum of each column over the first `rows` rows of `table`, which is the one they were made of.
    pub fn first(&self, table: &Table, rows: usize) -> Vec<f64> {
        let rows = rows.min(table.points.len());
        let from = rows / EVERY;
        let width = LANES * self.columns;
        let stored = self.stored.get(from * width..(from + 1) * width);
        let mut lanes = stored.map_or_else(|| vec![0.0; width], <[f64]>::to_vec);
        for row in from * EVERY..rows {
            add(&mut lanes, row, table.row(row));
        }
        let (even, odd) = lanes.split_at(self.columns);
        even.iter().zip(odd).map(|(even, odd)| even + odd).collect()
    }
}

fn add(lanes: &mut [f64], row: usize, cells: &[f64]) {
    let begin = row % LANES * cells.len();
    for (sum, cell) in lanes[begin..].iter_mut().zip(cells) {
        *sum += cell;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_rows_adds_up() {
        let mut table = Table::new(&[("i", ""), ("i²", "")]);
        for row in 0..1000 {
            let number = f64::from(row);
            table.add(row as usize, [number, number * number]);
        }
        let sums = Sums::of(&table);
        for rows in [0, 1, 2, 255, 256, 257, 511, 512, 700, 999, 1000, 5000] {
            let n = rows.min(1000) as f64;
            let squares = (n - 1.0) * n * (2.0 * n - 1.0) / 6.0;
            let expected = [(n - 1.0) * n / 2.0, squares];
            assert_eq!(sums.first(&table, rows), expected.map(|sum| sum + 0.0));
        }
    }

    #[test]
    fn a_table_without_rows_adds_up_to_nothing() {
        let table = Table::new(&[("F", "N")]);
        assert_eq!(Sums::of(&table).first(&table, 3), [0.0]);
    }
}
