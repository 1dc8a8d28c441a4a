//! The file that a program wrote: its columns, their digits, and the time step of each row.

use super::times::{STEP_NAME, TIME_NAME, Times, find_steps};
use crate::engine::data::{map_option, name_columns, time_like};
use crate::engine::scenario::csv::{Csv, Naming, Renaming};
use crate::engine::scenario::problem::{at_line, listed};
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::number::shortest;
use crate::engine::text::printable::brief;

/// Names of the columns that are read. First the compared columns: the traced point in the world frame, and L about the
/// pivot. Then the columns that give the step of a row.
const ROW_COLUMN_NAMES: [&str; 8] = [
    "x_m", "y_m", "z_m", "Lx_Js", "Ly_Js", "Lz_Js", STEP_NAME, TIME_NAME,
];
pub const COMPARED_COLUMNS: &[&str] = ROW_COLUMN_NAMES.split_at(6).0;
/// Maximum number of values in a file, rows times columns.
const MOST_ROW_VALUES: usize = 1_000_000;
/// Digits of single precision. A column needs them to show it.
pub const SINGLE_DIGITS: i32 = 7;
/// Digits of double precision.
const MOST_DIGITS: i32 = 17;
/// Minimum digits with which a column can show that its values are not in single precision.
const TELLING_DIGITS: i32 = 9;
/// Tolerance for correct programs, m and J s, times the value if it is above 1.
const AGREEMENT_TOLERANCES: [f64; 2] = [1e-8, 1e-6];

#[derive(Clone, Debug)]
pub struct ProgramColumn {
    /// Index in `ROW_COLUMN_NAMES`.
    pub place: usize,
    pub values: Vec<f64>,
    /// Maximum number of decimals. `significant` is the maximum number of significant digits.
    pub decimals: i32,
    significant: i32,
    /// True if all values have the same number of decimals.
    pub is_fixed: bool,
}

#[derive(Clone, Debug)]
pub struct ProgramRows {
    /// The columns that are compared.
    pub columns: Vec<ProgramColumn>,
    pub count: usize,
    /// The names of the columns that are not compared.
    pub left_out: Vec<String>,
    /// Line and column of the first number that is not finite. The rows end before it.
    pub not_finite: Option<(u64, &'static str)>,
    pub times: Times,
}

impl ProgramColumn {
    /// Reads column `at` of `cells`, and adds its errors to `found`.
    fn read(place: usize, at: usize, cells: &Csv, found: &mut Problems) -> Self {
        let mut column = Self {
            place,
            values: Vec::with_capacity(cells.rows.len()),
            decimals: i32::MIN,
            significant: 0,
            is_fixed: true,
        };
        for (line, texts) in &cells.rows {
            if column.read_number(&texts[at], cells.separator).is_none() {
                found.add(|| at_line(*line, no_number(column.name(), &texts[at])));
            }
        }
        column
    }

    /// Adds a number with a decimal point, or with a decimal comma if commas do not separate the columns.
    fn read_number(&mut self, cell: &str, separator: char) -> Option<()> {
        let text = match separator {
            ',' => cell.to_owned(),
            _ => cell.replacen(',', ".", 1),
        };
        self.values.push(text.parse().ok()?);
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
        let behind = mantissa.split_once('.').map_or("", |(_, behind)| behind);
        let decimals = (behind.len() as i32).saturating_sub(exponent.parse().unwrap_or(0));
        let digits = mantissa.trim_start_matches(['+', '-', '0', '.']).chars();
        let significant = digits.filter(char::is_ascii_digit).count() as i32;
        self.is_fixed &= self.values.len() == 1 || decimals == self.decimals;
        self.decimals = self.decimals.max(decimals);
        self.significant = self.significant.max(significant);
        Some(())
    }

    pub fn name(&self) -> &'static str {
        ROW_COLUMN_NAMES[self.place]
    }

    /// Returns the unit of the last digit of `value` in this column. If all values are 0 without decimals, they are
    /// exact.
    fn unit(&self, value: f64) -> f64 {
        let of_decimals = 10_f64.powi(self.decimals.saturating_neg());
        match (value == 0.0, self.significant) {
            (_, 0) if self.decimals <= 0 => return 0.0,
            (true, _) | (_, 0) => return of_decimals,
            _ => {}
        }
        let first = libm::log10(value.abs()).floor() as i32;
        of_decimals.max(10_f64.powi(first + 1 - self.significant))
    }

    /// Returns true if `yours` agrees with the scheme's value, which is uncertain by `slack`.
    pub fn agrees(&self, yours: f64, scheme: f64, slack: f64) -> bool {
        (yours - scheme).abs() <= 0.5 * self.unit(yours) + within(self.place, scheme) + slack
    }

    /// Returns the tolerance for a value in this column.
    pub fn room(&self, value: f64) -> f64 {
        0.5 * self.unit(value) + within(self.place, value)
    }

    /// Returns the number of digits of the longest value. Zeros after the point count, because they show that the value
    /// is small.
    pub fn digits(&self) -> i32 {
        self.significant.max(self.decimals.min(MOST_DIGITS)).max(1)
    }

    /// Returns true if each value is in single precision, as far as its digits show.
    fn is_of_single(&self) -> bool {
        self.values.iter().all(|value: &f64| {
            let nearest = *value as f32;
            let off = (value - f64::from(nearest)).abs();
            // NumPy and others print the shortest number that parses to the same float32.
            off <= 0.5 * self.unit(*value) * (1.0 + 1e-6)
                || nearest.to_string().parse() == Ok(*value)
        })
    }

    pub fn varies(&self) -> bool {
        self.values.iter().any(|value| *value != self.values[0])
    }
}

/// Returns the tolerance for correct programs in the column with this index.
pub fn within(place: usize, value: f64) -> f64 {
    AGREEMENT_TOLERANCES[place / 3] * value.abs().max(1.0)
}

impl ProgramRows {
    /// Returns true if the program may compute in single precision, because one of the columns holds such numbers.
    pub fn may_be_single(&self) -> bool {
        let mut varying = self.columns.iter().filter(|column| column.varies());
        let mut telling = varying
            .clone()
            .filter(|it| it.significant >= TELLING_DIGITS)
            .peekable();
        if telling.peek().is_none() {
            return varying.any(|column| column.significant >= SINGLE_DIGITS);
        }
        telling.any(ProgramColumn::is_of_single)
    }

    /// Writes the rows as a CSV of measured data for a run with this time step, each at the time of its step.
    pub fn to_csv(&self, time_step_s: f64) -> String {
        let dt = self.times.own_s.unwrap_or(time_step_s);
        let names = self
            .columns
            .iter()
            .map(|column| format!(",{}", column.name()));
        let mut text = TIME_NAME.to_owned() + &names.collect::<String>() + "\n";
        for (row, step) in self.times.steps.of_rows.iter().enumerate() {
            text += &shortest((*step as f64 * dt).max(0.0));
            let values = self.columns.iter().map(|column| column.values[row]);
            values.for_each(|value| text += &format!(",{}", shortest(value)));
            text.push('\n');
        }
        text
    }
}

/// Parses `text`, the file of a program.
///
/// `map` renames columns. With `every`, the file has every N-th step only.
///
/// # Errors
/// Returns the errors in the file, each with its line.
pub fn read(
    text: &str,
    map: &[Renaming],
    every: Option<u64>,
    time_step_s: f64,
) -> Result<ProgramRows, Problems> {
    let cells = renamed(text, map)?;
    let mut found = Problems::default();
    let names = ROW_COLUMN_NAMES.iter().enumerate();
    let places = names.filter_map(|(place, name)| {
        let at = cells.names.iter().position(|own| own == name)?;
        Some(ProgramColumn::read(place, at, &cells, &mut found))
    });
    let mut columns: Vec<ProgramColumn> = places.collect();
    found.or(())?;
    let count = (0..cells.rows.len())
        .take_while(|row| columns.iter().all(|it| it.values[*row].is_finite()))
        .count();
    let broken = columns
        .iter()
        .find(|it| it.values.get(count).is_some_and(|it| !it.is_finite()))
        .map(ProgramColumn::name);
    let not_finite = broken.map(|name| (cells.rows[count].0, name));
    if let Some((line, name)) = not_finite.filter(|_| count == 0) {
        let rule = "is not finite in the first row: there is nothing to compare";
        return Err(vec![at_line(line, Problem::at(name, rule))].into());
    }
    columns.iter_mut().for_each(|it| it.values.truncate(count));
    let others = columns.split_off(columns.partition_point(|it| it.place < COMPARED_COLUMNS.len()));
    if columns.is_empty() {
        return Err(nothing_to_compare(&cells).into());
    }
    let [step_column, time_column] =
        [STEP_NAME, TIME_NAME].map(|name| others.iter().find(|column| column.name() == name));
    let step = step_column.map(|column| &column.values[..]);
    let time = time_column.map(|it| (&it.values[..], it.unit(it.values[count - 1])));
    let steps = find_steps(count, step, time, every, time_step_s, &|row| {
        cells.rows[row].0
    })?;
    let left_out = cells
        .names
        .iter()
        .filter(|name| !ROW_COLUMN_NAMES.contains(&&***name));
    Ok(ProgramRows {
        left_out: left_out.cloned().collect(),
        columns,
        count,
        not_finite,
        times: steps,
    })
}

/// Parses `text`, and renames its columns by `map`.
fn renamed(text: &str, map: &[Renaming]) -> Result<Csv, Problems> {
    let mut cells = Csv::parse(text, MOST_ROW_VALUES)?;
    cells.rename(map, |name| ROW_COLUMN_NAMES.contains(&name))?;
    if cells.titles.is_empty() {
        name_columns(&mut cells, "", |name| ROW_COLUMN_NAMES.contains(&name)).map_err(
            |problems| {
                Problems::from(
                    problems
                        .into_iter()
                        .map(|problem| at_line(cells.line_of_names, problem))
                        .collect::<Vec<_>>(),
                )
            },
        )?;
    }
    Ok(cells)
}

/// Describes why `cells` has nothing to compare.
fn nothing_to_compare(cells: &Csv) -> Vec<Problem> {
    let wanted = listed(COMPARED_COLUMNS.iter().copied());
    let rule = match cells.naming {
        Naming::Numbers => format!(
            "has no line of names: write one above the rows, such as {STEP_NAME},{TIME_NAME},x_m (at least one of {wanted}), or name the columns with an option such as --map 1={STEP_NAME},2={TIME_NAME},3=x_m"
        ),
        Naming::Names => {
            let names = brief(&listed(cells.names.iter().map(String::as_str)), 200);
            let option = map_option(cells, &[], &coordinates(cells)).unwrap_or_default();
            format!(
                "has none of the columns {wanted}, but {names}: name the columns with an option such as {option}"
            )
        }
    };
    vec![Problem::at("", rule)]
}

/// Returns the columns that are probably x, y and z; or the first column as x.
fn coordinates(cells: &Csv) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for axis in ["x", "y", "z"] {
        let place = cells.names.iter().position(|name| {
            let lower = name.to_lowercase();
            lower
                .split(|c: char| !c.is_alphanumeric())
                .any(|word| word == axis)
        });
        found.extend(place.map(|place| (place, format!("{axis}_m"))));
    }
    if found.is_empty() {
        let first = cells.names.iter().position(|name| !time_like(name));
        found.push((first.unwrap_or(0), COMPARED_COLUMNS[0].to_owned()));
    }
    found
}

fn no_number(name: &str, text: &str) -> Problem {
    let rule = if text.is_empty() {
        "is missing: write a number in every row"
    } else {
        "must be a number, without its unit"
    };
    Problem {
        value: brief(text, 40),
        ..Problem::at(name, rule)
    }
}
