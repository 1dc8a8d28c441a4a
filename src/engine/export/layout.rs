//! Which rows and columns of a run its CSV has, and how the numbers in it are written.
//!
//! Whatever is not the default stands above the run file in the CSV's header, as TOML in TOML's comments, such as
//! `# # every = 10`: the CSV runs again as any other, and can be recomputed as it was written.

use super::columns::{COLUMNS, CsvColumn, POINT_COLUMNS};
use crate::run::{Clock, Step};
use crate::scenario::kind::Range::NotNegative;
use crate::scenario::kind::ValueKind::{Flag, Lines, Number, Whole};
use crate::scenario::problem::nearest;
use crate::scenario::schema::{DefaultValue, SchemaRow, may};
use crate::scenario::{Problem, Scenario};
use crate::text::number::shortest;
use crate::text::printable::printable;
use serde::{Deserialize, Serialize};
use std::num::NonZeroU64;

/// The options of a CSV, as commands and the command line have them.
#[rustfmt::skip]
pub const LAYOUT_KEYS: &[SchemaRow] = &[
    may("every", Whole(1, i64::MAX), "Write every N-th row only, and the last").or(DefaultValue::Whole(1)),
    may("columns", Lines, "Write these columns only, in this order; gyrolab man csv lists them"),
    may("from_s", Number(NotNegative), "Leave out the rows before this time, s; the run begins at 0 all the same"),
    may("to_s", Number(NotNegative), "Leave out the rows after this time, s; the run goes on to its end all the same"),
    may("points", Flag, "Write a row for each point of the body at each step: its name, mass, place and velocity"),
    may("excel", Flag, "Write decimal commas, with semicolons between the columns, for Excel in German and other such languages"),
];

/// A layout as the user states it, or as a header holds it, before it is checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayoutFile {
    /// 10 writes rows 0, 10, 20 and so on, and the last.
    pub every: Option<NonZeroU64>,
    /// The time of the first row, s; earlier ones are left out.
    pub from_s: Option<f64>,
    /// The time of the last row, s; later ones are left out.
    pub to_s: Option<f64>,
    pub columns: Option<Vec<String>>,
    #[serde(skip_serializing_if = "is_false")]
    #[serde(default)]
    pub points: bool,
    /// Whether it is written for a spreadsheet program that has the decimal comma.
    #[serde(skip_serializing_if = "is_false")]
    #[serde(default)]
    pub excel: bool,
    /// Where it comes from, in words: the seat of a class, and the page.
    pub note: Option<String>,
}

/// Which rows and columns a CSV has, and how its numbers are written. The default is every row and every column.
#[derive(Clone, Debug)]
pub struct CsvLayout {
    file: LayoutFile,
    columns: Vec<&'static CsvColumn>,
}

impl Default for CsvLayout {
    fn default() -> Self {
        Self {
            file: LayoutFile::default(),
            columns: COLUMNS.iter().collect(),
        }
    }
}

fn is_false(flag: &bool) -> bool {
    !flag
}

impl LayoutFile {
    /// Its values, and those of `other` where it has none. The columns of a row for each step are none of a row for each
    /// point.
    pub fn or(self, other: Self) -> Self {
        let points = self.points || other.points;
        let columns = other.columns.filter(|_| points == other.points);
        Self {
            every: self.every.or(other.every),
            from_s: self.from_s.or(other.from_s),
            to_s: self.to_s.or(other.to_s),
            columns: self.columns.or(columns),
            points,
            excel: self.excel || other.excel,
            note: self.note.or(other.note),
        }
    }

    /// The layout, checked.
    pub fn check(mut self) -> Result<CsvLayout, Problem> {
        // No run is longer, and TOML has no larger number.
        let most = NonZeroU64::new(i64::MAX as u64).unwrap_or(NonZeroU64::MAX);
        let every = self.every.filter(|every| every.get() > 1);
        self.every = every.map(|every| every.min(most));
        for (key, bound) in [("from_s", self.from_s), ("to_s", self.to_s)] {
            if let Some(seconds) = bound.filter(|seconds| !seconds.is_finite() || *seconds < 0.0) {
                let rule = format!("{seconds:?} must be a time in seconds, 0 or more");
                return Err(Problem::at(key, rule));
            }
        }
        if let (Some(from_s), Some(to_s)) = (self.from_s, self.to_s)
            && from_s > to_s
        {
            let [from_s, to_s] = [from_s, to_s].map(shortest);
            let rule = format!("{to_s} s is before the first row's time, {from_s} s");
            return Err(Problem::at("to_s", rule));
        }
        let columns = match (&self.columns, self.points) {
            (None, false) => COLUMNS.iter().collect(),
            (None, true) => POINT_COLUMNS.iter().collect(),
            (Some(names), false) => chosen(names, &CsvColumn::all())?,
            (Some(names), true) => chosen(names, &POINT_COLUMNS.iter())?,
        };
        Ok(CsvLayout {
            file: self,
            columns,
        })
    }
}

fn chosen(
    names: &[String],
    all: &(impl Iterator<Item = &'static CsvColumn> + Clone),
) -> Result<Vec<&'static CsvColumn>, Problem> {
    if names.is_empty() {
        return Err(Problem::at("columns", "must name a column"));
    }
    let mut columns = Vec::new();
    for (index, name) in names.iter().enumerate() {
        if names[..index].contains(name) {
            let rule = format!("{} is named twice", printable(name));
            return Err(Problem::at("columns", rule));
        }
        let found = all.clone().find(|column| column.name == name);
        columns.push(found.ok_or_else(|| {
            let near = nearest(name, all.clone().map(|column| column.name));
            let rule = format!("no column named {}: {near}", printable(name));
            Problem::at("columns", rule)
        })?);
    }
    Ok(columns)
}

impl PartialEq for CsvLayout {
    fn eq(&self, other: &Self) -> bool {
        self.file == other.file
    }
}

impl CsvLayout {
    /// Every `every`-th row, and the last, with every column.
    pub fn every(every: NonZeroU64) -> Self {
        let file = LayoutFile {
            every: Some(every),
            ..LayoutFile::default()
        };
        file.check().unwrap_or_default() // only columns and times can be refused
    }

    pub fn file(&self) -> &LayoutFile {
        &self.file
    }

    pub fn steps_between(&self) -> u64 {
        self.file.every.map_or(1, NonZeroU64::get)
    }

    pub(super) fn columns(&self) -> &[&'static CsvColumn] {
        &self.columns
    }

    /// The character between two columns.
    pub fn delimiter(&self) -> u8 {
        if self.file.excel { b';' } else { b',' }
    }

    pub fn names(&self) -> Vec<&'static str> {
        self.columns.iter().map(|column| column.name).collect()
    }

    /// Whether `step` has a row, in a run whose last step is `last`. The steps 0, every, twice every and so on and the last
    /// have one, unless their times lie outside the two ends. A time within a billionth of a time step of an end, or within
    /// the rounding of times, counts as on it.
    pub fn has_row(&self, step: &Step, last: u64) -> bool {
        let number = step.number();
        let is_counted = number.is_multiple_of(self.steps_between()) || number == last;
        is_counted && self.has_time(step)
    }

    /// Whether the first row would come after the end of the run of `scenario`.
    pub fn begins_after(&self, scenario: &Scenario) -> bool {
        let end_s = Clock::end_s(scenario);
        let latest_s = end_s + slack_s(scenario.motion.time_step_s, end_s);
        self.file.from_s.is_some_and(|from_s| from_s > latest_s)
    }

    /// Whether the time of `step` lies between the two ends.
    pub(super) fn has_time(&self, step: &Step) -> bool {
        let LayoutFile { from_s, to_s, .. } = self.file;
        if from_s.is_none() && to_s.is_none() {
            return true;
        }
        let time_s = step.time_s();
        let slack = slack_s(step.motion().time_step_s, time_s);
        from_s.is_none_or(|from_s| time_s >= from_s - slack)
            && to_s.is_none_or(|to_s| time_s <= to_s + slack)
    }

    /// The lines above the run file in the header; none of the default.
    pub fn comments(&self) -> String {
        // A checked layout holds nothing that TOML cannot write.
        let text = toml::to_string(&self.file).unwrap_or_default();
        commented(&commented(&text))
    }

    /// The layout that stands above the run file in the header of a CSV, whose lines have lost their `# `.
    pub fn read(header: &str) -> Result<Self, Problem> {
        let file: Result<LayoutFile, _> = toml::from_str(&above_run_file(header));
        file.map_err(|error| Problem::at("the lines above the run file", error.message()))?
            .check()
    }
}

/// A time this near to an end counts as on it, s.
fn slack_s(time_step_s: f64, time_s: f64) -> f64 {
    1e-9 * time_step_s + 4.0 * f64::EPSILON * time_s
}

/// How a comment above the run file begins that is a warning, and no option of the CSV.
pub const WARNING_MARK: &str = "warning:";

/// The comments above the run file, without their marks and without warnings. `header` is the header of a CSV whose lines have lost their `# `.
pub fn above_run_file(header: &str) -> String {
    let comments = header.lines().map_while(|line| line.strip_prefix('#'));
    let options = comments.filter(|line| !line.trim_start().starts_with(WARNING_MARK));
    options.flat_map(|line| [line, "\n"]).collect()
}

/// `text` with `# ` before every line, as the run file is written above the rows.
pub fn commented(text: &str) -> String {
    text.lines().flat_map(|line| ["# ", line, "\n"]).collect()
}
