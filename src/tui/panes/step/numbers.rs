//! The numbers of a phase in columns: vectors and matrices with x, y and z, single numbers, and tables of points, each
//! with its unit.
//!
//! Below a table is the sum of its rows up to the chosen one. Only visible rows are computed.

use super::super::shortened;
use super::page::{StepPageLine, StepPageSection};
use crate::engine::text::number::{NOT_AVAILABLE, exponent, significant};
use crate::engine::text::wrap::columns;
use crate::physics::workings::{PointTable, WorkedQuantity, WorkedValue};
use crate::tui::theme::Role;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Columns of the symbols.
pub const SYMBOL: usize = 6;
/// Columns of the units.
const UNIT_WIDTH: usize = 6;
/// Columns of a number besides its digits: sign, decimal point, leading zero, and a space.
const COLUMNS_BESIDE_DIGITS: usize = 4;
/// Minimum and maximum digits of a number.
const CELL_DIGITS: std::ops::RangeInclusive<usize> = 3..=9;
/// Fraction of a group's largest number below which a number counts as the rounding error of a zero.
///
/// It is a few units in the last place of the number's terms.
const CELL_ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Text for such a number, which is not exactly zero.
const ALMOST_ZERO: &str = "~0";
/// Minimum digits of a component. With fewer, it is written with an exponent.
const LEAST_DIGITS_SEEN: i32 = 3;

/// Digits of a number of turns.
const DIGITS_OF_TURNS: usize = 5;

/// Format of the numbers in a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellFormat {
    /// Columns of a number, including a space before it.
    pub cell: usize,
    /// Digits of the largest number of a vector, a matrix or a column.
    pub digits: usize,
}

impl CellFormat {
    /// Creates the format for `count` numbers side by side on `width` columns.
    pub fn new(width: usize, count: usize) -> Self {
        let digits = (width / count.max(1))
            .saturating_sub(COLUMNS_BESIDE_DIGITS)
            .clamp(*CELL_DIGITS.start(), *CELL_DIGITS.end());
        Self {
            cell: digits + COLUMNS_BESIDE_DIGITS,
            digits,
        }
    }

    /// Creates the format for vectors between their symbols and units on `width` columns.
    pub fn of_vectors(width: usize) -> Self {
        Self::new(width.saturating_sub(SYMBOL + UNIT_WIDTH), 3)
    }

    /// Returns `numbers` with the decimals that the largest one needs, each as wide as a cell, with aligned decimal
    /// points.
    ///
    /// A number much smaller than the largest has an exponent, so that it does not look like zero. A number within the
    /// rounding error is written as [`ALMOST_ZERO`].
    pub fn aligned(self, numbers: &[f64]) -> Vec<String> {
        let sizes = numbers.iter().map(|number| number.abs());
        let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        numbers
            .iter()
            .map(|number| format!("{:>1$}", self.one(*number, largest), self.cell))
            .collect()
    }

    /// Returns the text of `number` in a group whose largest number is `largest`.
    fn one(self, number: f64, largest: f64) -> String {
        if !number.is_finite() {
            return NOT_AVAILABLE.to_owned();
        }
        if number == 0.0 {
            return "0".to_owned();
        }
        if number.abs() <= CELL_ROUNDING * largest {
            return ALMOST_ZERO.to_owned();
        }
        let digits = self.digits as i32;
        let power = libm::floor(libm::log10(largest)) as i32;
        let wanted = digits - 1 - power;
        let decimals = wanted.min(digits);
        let seen = libm::floor(libm::log10(number.abs())) as i32 + decimals + 1;
        let fits = (0..=digits + 1).contains(&wanted);
        if fits && seen >= LEAST_DIGITS_SEEN {
            format!("{number:.*}", decimals.unsigned_abs() as usize)
        } else {
            // Use as many digits as the exponent leaves room for.
            let text = exponent(number, 0);
            let used_columns = columns(&text) + 2;
            exponent(
                number,
                self.cell.saturating_sub(used_columns).min(self.digits - 1),
            )
        }
    }
}

/// Returns the lines of `quantity`, which is not a table. `is_result` is true for the result of the phase.
pub fn lines(quantity: &WorkedQuantity, format: CellFormat, is_result: bool) -> Vec<StepPageLine> {
    let of_vector = role_of(quantity.symbol);
    let role = if is_result { of_vector } else { Role::Text };
    let (numbers, across): (Vec<f64>, usize) = match &quantity.value {
        WorkedValue::Number(number) => (vec![*number], 1),
        WorkedValue::Vector(vector) => (vector.iter().copied().collect(), 3),
        WorkedValue::Matrix(matrix) => (matrix.transpose().iter().copied().collect(), 3),
        WorkedValue::Table(_) => return Vec::new(),
    };
    let mut cells = format.aligned(&numbers);
    if let [number] = numbers[..] {
        let text = significant(number, format.digits);
        if columns(&text) < format.cell {
            cells = vec![format!("{text:>0$}", format.cell)];
        }
    }
    let mut lines: Vec<_> = cells
        .chunks(across)
        .map(|cells| StepPageLine::new(SYMBOL, cells.concat(), role))
        .collect();
    let unit = SYMBOL + across * format.cell + 1;
    let unit = (unit, unit_of(quantity), Role::Label);
    lines[0].pieces.push(unit);
    let symbol = StepPageLine::new(0, quantity.symbol, of_vector);
    if columns(quantity.symbol) < SYMBOL {
        lines[0].pieces.extend(symbol.pieces);
    } else {
        lines.insert(0, symbol);
    }
    lines
}

/// Returns the role of a quantity: the role of its arrow, if it has one.
fn role_of(symbol: &str) -> Role {
    match symbol {
        "L" | "new L" => Role::AngularMomentum,
        "Ω" => Role::AngularVelocity,
        "τ" | "dL" | "ΔL" => Role::Torque,
        _ => Role::Heading,
    }
}

/// Returns the unit of `quantity`. For an angle of more than half a turn, it also states the number of turns.
fn unit_of(quantity: &WorkedQuantity) -> String {
    match quantity.value {
        WorkedValue::Number(angle) if quantity.unit == "rad" && angle.abs() > PI => {
            let turns = significant(angle / TAU, DIGITS_OF_TURNS);
            format!("rad = {turns} turns")
        }
        _ => quantity.unit.to_owned(),
    }
}

/// Returns the heads of the columns of vectors and matrices.
pub fn heads(rank: u8, format: CellFormat) -> StepPageSection {
    let heads = ["x", "y", "z"].map(|head| format!("{head:>0$}", format.cell));
    StepPageSection::new(
        rank,
        vec![StepPageLine::new(SYMBOL, heads.concat(), Role::Label)],
    )
}

/// Columns of the points' names, including a space.
const POINT_NAME_WIDTH: usize = 8;
/// Columns of a mass between the name and the coordinates of its point, if there is no room for the whole table.
const MASS: usize = 5;
const MASS_DIGITS: usize = 3;
/// Minimum useful columns of a number.
const LEAST_CELL: usize = 9;
/// Numbers side by side if there is no room for all.
const FEW: usize = 3;
/// Maximum rows of a table that is searched for points without mass.
const MOST_SEARCHED: usize = 1000;
/// Minimum rows of a table.
const LEAST_ROWS: usize = 4;

/// A table of points as the step pane shows it.
pub struct TableView<'a> {
    pub table: &'a PointTable,
    /// Number of rows that are added up, and the sum of each column over them; `None` if no sum is requested.
    pub sum: Option<(usize, Vec<f64>)>,
    pub name: &'a dyn Fn(usize) -> String,
    pub width: usize,
}

impl TableView<'_> {
    /// Returns the minimum number of lines.
    pub fn least(&self) -> usize {
        let groups = self.groups();
        let rows = LEAST_ROWS.min(self.table.points.len()) * groups.len();
        self.heads(&groups).len() + rows + self.sum_lines(&groups).len()
    }

    /// Returns the lines: the heads, the rows that fit in `room`, and the sum.
    pub fn lines(&self, room: usize) -> Vec<StepPageLine> {
        let groups = self.groups();
        let sum = self.sum_lines(&groups);
        let mut lines = self.heads(&groups);
        let rows = room.saturating_sub(lines.len() + sum.len()) / groups.len();
        let all = self.table.points.len();
        let massless = self.massless();
        // Points without mass share a row.
        let entries = massless + usize::from(massless < all);
        let (shown, has_more) = match self.chosen() {
            Some(last) => (
                last.saturating_sub(rows)..last.max(rows).min(entries),
                false,
            ),
            None if entries > rows => (0..rows.saturating_sub(1), true),
            None => (0..entries, false),
        };
        let own = shown.start..shown.end.min(massless);
        let left = all - own.len().min(all);
        lines.extend(self.rows(&groups, own));
        if shown.end > massless {
            let points = self.table.points[massless..].iter();
            let names: Vec<_> = points.map(|point| (self.name)(*point)).collect();
            let text = format!("{}: no mass", names.join(", "));
            lines.push(StepPageLine::new(0, text, Role::Label));
        }
        if has_more {
            let what = if is_summed(self.table) {
                "press Down to add them up"
            } else {
                "press Down to step through them"
            };
            let text = format!("... {left} more: {what}");
            lines.push(StepPageLine::new(0, text, Role::Label));
        }
        lines.extend(sum);
        lines
    }

    /// Returns the index of the first of the last rows whose points have no mass. These points share one row.
    ///
    /// Returns the number of rows if there are fewer than two such points or one of them is chosen.
    fn massless(&self) -> usize {
        let all = self.table.points.len();
        if !is_summed(self.table) || all > MOST_SEARCHED {
            return all;
        }
        let has_mass = |row: usize| match self.table.columns.len() {
            10 => self.table.row(row)[0] != 0.0,
            _ => self.table.row(row).iter().any(|number| *number != 0.0),
        };
        let begin = (0..all).rposition(has_mass).map_or(0, |last| last + 1);
        let is_free = self.chosen().is_none_or(|last| last <= begin);
        if is_free && all - begin > 1 {
            begin
        } else {
            all
        }
    }

    /// Returns the number of rows that are added up. The last of them is the chosen one.
    fn chosen(&self) -> Option<usize> {
        self.sum.as_ref().map(|(rows, _)| *rows)
    }

    fn rows(&self, groups: &[Range<usize>], shown: Range<usize>) -> Vec<StepPageLine> {
        let texts_of_groups: Vec<_> = groups
            .iter()
            .map(|group| self.texts(group, &shown))
            .collect();
        let mut lines = Vec::with_capacity(shown.len() * groups.len());
        for (at, row) in shown.enumerate() {
            let role = match self.chosen() {
                Some(last) if row >= last => Role::Label,
                _ => Role::Text,
            };
            let name = (self.name)(self.table.points[row]);
            let mut name = shortened(&name, POINT_NAME_WIDTH - 1).into_owned();
            for (index, (group, texts)) in groups.iter().zip(&texts_of_groups).enumerate() {
                let mut line = StepPageLine::new(0, std::mem::take(&mut name), role);
                if self.has_mass_aside(group) {
                    let mass = significant(self.table.row(row)[0], MASS_DIGITS);
                    line = line.and(POINT_NAME_WIDTH - 1, format!("{mass:>MASS$}"), role);
                }
                line.is_chosen = index == 0 && self.chosen() == Some(row + 1);
                lines.push(line.and(self.begin(group), side_by_side(texts, at), role));
            }
        }
        lines
    }

    /// Returns the groups of columns shown side by side. With several groups, a row has a line for each.
    fn groups(&self) -> Vec<Range<usize>> {
        let count = self.table.columns.len();
        match (count, summed(self.table)) {
            (count, _) if POINT_NAME_WIDTH + count * LEAST_CELL <= self.width => {
                std::iter::once(0..count).collect()
            }
            // Only the coordinates: their products are shown only in the sum.
            (10, products) => std::iter::once(1..products.start).collect(),
            _ => (0..count.div_ceil(FEW))
                .map(|group| group * FEW..((group + 1) * FEW).min(count))
                .collect(),
        }
    }

    /// Returns true if the masses are shown before the columns of `group`, which do not include them.
    fn has_mass_aside(&self, group: &Range<usize>) -> bool {
        group.start == 1 && self.table.columns.len() == 10
    }

    /// Returns the screen column in which the numbers of `group` begin.
    fn begin(&self, group: &Range<usize>) -> usize {
        if self.has_mass_aside(group) {
            POINT_NAME_WIDTH - 1 + MASS
        } else {
            POINT_NAME_WIDTH
        }
    }

    fn format(&self, group: &Range<usize>) -> CellFormat {
        CellFormat::new(self.width.saturating_sub(self.begin(group)), group.len())
    }

    /// Returns the numbers of each column of `group` in the rows `shown`.
    fn texts(&self, group: &Range<usize>, shown: &Range<usize>) -> Vec<Vec<String>> {
        let format = self.format(group);
        group
            .clone()
            .map(|column| {
                let cells = shown.clone().map(|row| self.table.row(row)[column]);
                format.aligned(&cells.collect::<Vec<_>>())
            })
            .collect()
    }

    /// Returns the symbols above the columns of each group, with a common unit or with a line of units.
    fn heads(&self, groups: &[Range<usize>]) -> Vec<StepPageLine> {
        let mut lines = Vec::new();
        for group in groups {
            let cell = self.format(group).cell;
            let columns = &self.table.columns[group.clone()];
            let symbols = columns
                .iter()
                .map(|(symbol, _)| format!("{symbol:>cell$}"))
                .collect::<String>();
            let mut line = StepPageLine::new(self.begin(group), symbols, Role::Label);
            if self.has_mass_aside(group) {
                let mass = self.table.columns[0].1;
                line = line.and(POINT_NAME_WIDTH - 1, format!("{mass:>MASS$}"), Role::Label);
            }
            if columns.iter().all(|(_, unit)| *unit == columns[0].1) {
                let unit = format!("in {}", columns[0].1);
                lines.push(line.and(0, unit, Role::Label));
            } else {
                let units = columns
                    .iter()
                    .map(|(_, unit)| format!("{unit:>cell$}"))
                    .collect::<String>();
                lines.extend([
                    line,
                    StepPageLine::new(self.begin(group), units, Role::Label),
                ]);
            }
        }
        lines
    }

    /// Returns the contribution of the chosen row, and the sum up to it.
    fn sum_lines(&self, groups: &[Range<usize>]) -> Vec<StepPageLine> {
        let columns = summed(self.table);
        let (Some(rows), Some((_, sums)), false) = (self.chosen(), &self.sum, columns.is_empty())
        else {
            return Vec::new();
        };
        let all = self.table.points.len();
        let caption = match rows {
            1 => format!("the first of {all} points gives"),
            rows => format!("the first {rows} of {all} points add up to"),
        };
        let mut lines = vec![StepPageLine::new(0, caption, Role::Text)];
        match groups {
            [group] if group.contains(&columns.start) => {
                let format = self.format(group);
                let blank = " ".repeat((columns.start - group.start) * format.cell);
                let text: String = sums[columns]
                    .iter()
                    .map(|sum| format.aligned(&[*sum]).concat())
                    .collect();
                let line = StepPageLine::new(0, "sum", Role::Heading);
                lines.push(line.and(POINT_NAME_WIDTH, blank + &text, Role::Heading));
            }
            _ => lines.extend(columns.clone().step_by(FEW).flat_map(|begin| {
                let group = begin..(begin + FEW).min(columns.end);
                self.added(group, rows.saturating_sub(1), sums)
            })),
        }
        lines
    }

    /// Returns the contribution of `row` to each column of `group`, and their `sums`, with heads of their own.
    fn added(&self, group: Range<usize>, row: usize, sums: &[f64]) -> [StepPageLine; 3] {
        let adds = self.table.row(row);
        let format = CellFormat::of_vectors(self.width);
        let columns = &self.table.columns[group.clone()];
        let heads = columns
            .iter()
            .map(|(symbol, _)| format!("{symbol:>0$}", format.cell));
        let heads = StepPageLine::new(SYMBOL, heads.collect::<String>(), Role::Label);
        let unit = SYMBOL + group.len() * format.cell + 1;
        let both: Vec<_> = group
            .map(|column| format.aligned(&[adds[column], sums[column]]))
            .collect();
        let line = |at: usize, name, role| {
            let line = StepPageLine::new(0, name, Role::Heading).and(
                SYMBOL,
                side_by_side(&both, at),
                role,
            );
            line.and(unit, columns[0].1, Role::Label)
        };
        [
            heads,
            line(0, "adds", Role::Text),
            line(1, "sum", Role::Heading),
        ]
    }
}

/// Returns the cells of the row `at` of `columns`.
fn side_by_side(columns: &[Vec<String>], at: usize) -> String {
    columns.iter().map(|column| column[at].as_str()).collect()
}

/// Returns the columns of `table` whose sums have a meaning.
fn summed(table: &PointTable) -> Range<usize> {
    match table.columns.first() {
        Some(("m", _)) if table.columns.len() == 10 => 4..10,
        Some(("m x", _)) => 0..table.columns.len(),
        _ => 0..0,
    }
}

/// Returns true if rows of `table` can be added up.
pub fn is_summed(table: &PointTable) -> bool {
    !summed(table).is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_their_cells() {
        for width in [12, 30, 42, 60, 100] {
            let format = CellFormat::of_vectors(width);
            for power in -320..308 {
                for other in [0, -3, -8, 5] {
                    let numbers = [-9.99999999_f64, 1.0, 5.5].map(|n| n * 10f64.powi(power));
                    let numbers = [numbers[0], numbers[1], numbers[2] * 10f64.powi(other)];
                    for text in format.aligned(&numbers) {
                        assert_eq!(columns(&text), format.cell, "{text} of {numbers:?}");
                    }
                }
            }
        }
    }
}
