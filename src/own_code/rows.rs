//! The file that a program has written: which columns are compared, to how many digits, and which time step each row is.

use super::times::{self, STEP, TIME, Times};
use crate::scenario::csv::{Csv, Naming, Renaming};
use crate::scenario::problem::{at_line, listed};
use crate::scenario::{Problem, Problems};
use crate::text::printable::brief;

/// The columns that are compared: the traced point, world frame, and L about the pivot.
pub const COLUMNS: [&str; 6] = ["x_m", "y_m", "z_m", "Lx_Js", "Ly_Js", "Lz_Js"];
/// The most values of one file, rows times columns.
const MOST_VALUES: usize = 1_000_000;
/// By how much right programs may differ, m and J s, times the value where it is above 1.
const WITHIN: [f64; 2] = [1e-8, 1e-6];

/// A column of the file that is compared.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its place among [`COLUMNS`].
    pub place: usize,
    digits: Digits,
}

/// How many digits stand in a column, at most.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Digits {
    /// Behind the point.
    decimals: Option<i32>,
    significant: i32,
}

#[derive(Clone, Debug)]
pub struct Rows {
    pub columns: Vec<Column>,
    /// The values of each row, by columns.
    pub values: Vec<Vec<f64>>,
    /// The names of the columns that are not compared.
    pub left_out: Vec<String>,
    /// The line, and the column, of the first number that is not finite; the rows end before it.
    pub not_finite: Option<(u64, String)>,
    pub times: Times,
}

impl Digits {
    fn take(&mut self, written: &Written) {
        self.decimals = self.decimals.max(Some(written.decimals));
        self.significant = self.significant.max(written.significant);
    }

    /// The unit of the last digit of `value` in this column.
    pub fn unit(&self, value: f64) -> f64 {
        let power = |exponent: i32| 10_f64.powi(exponent);
        let of_decimals = self.decimals.map_or(0.0, |decimals| power(-decimals));
        if value == 0.0 || self.significant == 0 {
            return of_decimals;
        }
        let first = libm::log10(value.abs()).floor() as i32;
        of_decimals.max(power(first + 1 - self.significant))
    }
}

impl Column {
    pub fn name(&self) -> &'static str {
        COLUMNS[self.place]
    }

    /// Whether `yours` agrees with the scheme's value, of which `slack` is not known.
    pub fn agrees(&self, yours: f64, scheme: f64, slack: f64) -> bool {
        let within = 0.5 * self.digits.unit(yours) + within(self.place, scheme) + slack;
        (yours - scheme).abs() <= within
    }

    /// Whether `value` may be a float32, as far as the digits of the column say.
    pub fn may_be_single(&self, value: f64) -> bool {
        self.digits.significant < 11
            || (value - f64::from(value as f32)).abs() <= self.digits.unit(value)
    }
}

/// By how much right programs may differ in the column of this place.
pub fn within(place: usize, value: f64) -> f64 {
    WITHIN[place / 3] * value.abs().max(1.0)
}

/// A number as it is written.
#[derive(Clone, Copy, Debug)]
struct Written {
    value: f64,
    decimals: i32,
    significant: i32,
}

/// Reads a number with a decimal point, or a comma where that does not part the columns.
fn written(text: &str, separator: char) -> Option<Written> {
    let text = if separator == ',' {
        text.to_owned()
    } else {
        text.replacen(',', ".", 1)
    };
    let value: f64 = text.parse().ok()?;
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let decimals = mantissa
        .split_once('.')
        .map_or(0, |(_, behind)| behind.len() as i32);
    let digits = mantissa.trim_start_matches(['+', '-', '0', '.']);
    Some(Written {
        value,
        decimals: decimals.saturating_sub(exponent),
        significant: digits.chars().filter(char::is_ascii_digit).count() as i32,
    })
}

/// A column of numbers.
struct Numbers {
    name: &'static str,
    values: Vec<f64>,
    digits: Digits,
}

/// Reads `text`, the file of a program. `map` gives columns other names; `every` says that only every so many-th step is there.
///
/// # Errors
/// What is wrong with the file, each with its line.
pub fn read(
    text: &str,
    map: &[Renaming],
    every: Option<u64>,
    time_step_s: f64,
) -> Result<Rows, Problems> {
    let cells = renamed(text, map)?;
    let mut found = Problems::default();
    let mut column = |name: &'static str| numbers(&cells, name, &mut found);
    let (step, time) = (column(STEP), column(TIME));
    let columns = COLUMNS.iter().enumerate();
    let columns = columns.filter_map(|(place, name)| Some((place, column(name)?)));
    let columns: Vec<(usize, Numbers)> = columns.collect();
    found.or(())?;
    if columns.is_empty() {
        return Err(nothing_to_compare(&cells).into());
    }
    let all = || {
        step.iter()
            .chain(&time)
            .chain(columns.iter().map(|(_, column)| column))
    };
    let is_finite = |row: &usize| all().all(|column| column.values[*row].is_finite());
    let count = (0..cells.rows.len()).take_while(is_finite).count();
    let broken = all().find(|column| column.values.get(count).is_some_and(|it| !it.is_finite()));
    let not_finite = broken.map(|column| (cells.rows[count].0, column.name.to_owned()));
    if let Some((line, name)) = not_finite.as_ref().filter(|_| count == 0) {
        let rule = "is no finite number in the first row: there is nothing to compare";
        return Err(vec![at_line(*line, Problem::at(name, rule))].into());
    }
    let upper = |column: &Numbers| column.values[..count].to_vec();
    let unit = |column: &Numbers| column.digits.unit(column.values[count - 1]);
    let time = time.as_ref().map(|column| (upper(column), unit(column)));
    let step = step.as_ref().map(upper);
    let times = times::of(count, step, time, every, time_step_s, &|row| {
        cells.rows[row].0
    })?;
    let of_row = |row| {
        columns
            .iter()
            .map(|(_, column)| column.values[row])
            .collect()
    };
    let known =
        |name: &String| COLUMNS.contains(&name.as_str()) || [STEP, TIME].contains(&name.as_str());
    Ok(Rows {
        values: (0..count).map(of_row).collect(),
        columns: with_digits(&columns),
        left_out: cells
            .names
            .iter()
            .filter(|name| !known(name))
            .cloned()
            .collect(),
        not_finite,
        times,
    })
}

/// The cells of `text` with the names of `map`.
fn renamed(text: &str, map: &[Renaming]) -> Result<Csv, Problems> {
    let mut cells = Csv::of(text, MOST_VALUES)?;
    let may_be = |name: &str| COLUMNS.contains(&name) || [STEP, TIME].contains(&name);
    cells.rename(map, may_be)?;
    let names = cells.names.iter().enumerate();
    let mut twice =
        names.filter(|(place, name)| may_be(name) && cells.names[..*place].contains(name));
    if let Some((_, name)) = twice.next() {
        let rule = "names two columns: leave one of them out, or map one of them (--map 3=z_m)";
        return Err(vec![at_line(cells.line_of_names, Problem::at(name, rule))].into());
    }
    Ok(cells)
}

/// The numbers of the column `name`, where there is one.
fn numbers(cells: &Csv, name: &'static str, found: &mut Problems) -> Option<Numbers> {
    let place = cells.names.iter().position(|own| own == name)?;
    let (mut values, mut digits) = (Vec::with_capacity(cells.rows.len()), Digits::default());
    for (line, texts) in &cells.rows {
        let number = written(&texts[place], cells.separator);
        if let Some(number) = &number {
            digits.take(number);
        } else {
            found.add(|| at_line(*line, no_number(name, &texts[place])));
        }
        values.push(number.map_or(f64::NAN, |number| number.value));
    }
    Some(Numbers {
        name,
        values,
        digits,
    })
}

/// The columns with their digits. A column of zeros has those of the others in its unit.
fn with_digits(columns: &[(usize, Numbers)]) -> Vec<Column> {
    let column = |(place, own): &(usize, Numbers)| {
        let (place, mut digits) = (*place, own.digits);
        let others = columns.iter().filter(|(other, _)| other / 3 == place / 3);
        for (_, other) in others.filter(|_| own.digits.significant == 0) {
            digits.decimals = digits.decimals.max(other.digits.decimals);
            digits.significant = digits.significant.max(other.digits.significant);
        }
        Column { place, digits }
    };
    columns.iter().map(column).collect()
}

/// Why there is nothing to compare in `cells`.
fn nothing_to_compare(cells: &Csv) -> Vec<Problem> {
    let wanted = listed(COLUMNS.into_iter());
    let rule = match cells.naming {
        Naming::Numbers => format!(
            "has no line of names: say what its columns are, such as --map 1={STEP},2={TIME},3=x_m (at least one of {wanted})"
        ),
        Naming::Names => {
            let names = brief(&listed(cells.names.iter().map(String::as_str)), 200);
            format!(
                "has none of the columns {wanted}, but {names}: say which is which, such as --map {}=x_m",
                cells.names.first().map_or("1", String::as_str)
            )
        }
    };
    vec![Problem::at("", rule)]
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
