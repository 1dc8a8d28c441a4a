//! A checked sweep: its points in their order, the scenario of each, and its row.

use super::axis::{SweepAxis, read_axes};
use super::file::{Base, Shard, SweepFile};
use crate::engine::analysis::readouts::{
    self, READOUTS, Readout, ReadoutSource, ReadoutValue as Readable,
};
use crate::engine::export::layout::commented;
use crate::engine::run::{Clock, resampled};
use crate::engine::scenario::document::Document;
use crate::engine::scenario::dotted::{find, join, number_of_push};
use crate::engine::scenario::head::is_file;
use crate::engine::scenario::rescale::{MOST_RUN_STEPS_BY_TIME, accumulates};
use crate::engine::scenario::{Problem, Problems, Scenario};
use crate::engine::text::number::{decimal, shortest};
use serde::Serialize;
use std::path::Path;
use toml::Value;

/// The key that, as it varies, leaves the seconds of a run as they are and not its steps.
pub const TIME_STEP: &str = "motion.time_step_s";

/// The keys of a push in steps, and those that say the same in seconds.
const IN_STEPS_OR_SECONDS: [(&str, &str); 2] = [("first_step", "from_s"), ("steps", "for_s")];

const MOST_GRID_POINTS: u64 = 1_000_000_000;

#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// The line of the file, with its end.
    pub line: String,
    /// Why it holds no readouts; `None` where it holds some.
    pub empty: Option<String>,
    pub reliability: Reliability,
    pub has_failed: bool,
}

/// Whether the numbers of a row's run hold, as its column `reliable` says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reliability {
    /// The sweep has no such column.
    NotAsked,
    Reliable,
    Unreliable,
    Unknown,
}

/// The readout that a sweep has on its own accord.
const RELIABLE: &str = "reliable";

/// A grid of runs whose keys, values and readouts have been checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// As it stands in the header of its CSV.
    file: SweepFile,
    base: Document,
    /// The keys that vary, the last fastest.
    pub axes: Vec<SweepAxis>,
    pub measure: Vec<&'static Readout>,
    pub shard: Shard,
    points: u64,
}

impl Sweep {
    /// The sweep that `document` tells, a sweep file or the header of a sweep's CSV.
    pub fn open(document: &Document) -> Result<Self, Problems> {
        let file = SweepFile::read(document)?;
        let base = Self::base(&file, document, |_| Ok(()))?;
        Self::new(file, &base, &|problems| document.placed(problems))
    }

    /// The sweep `file` from `base` on, whatever `file` says of its scenario; `placed` knows where things stand.
    pub fn new(
        file: SweepFile,
        base: &Scenario,
        placed: &dyn Fn(Vec<Problem>) -> Problems,
    ) -> Result<Self, Problems> {
        let mut problems = Vec::new();
        let axes = read_axes(&file.vary, &mut problems);
        let mut measure = measured(file.measure.as_deref(), &axes, &mut problems);
        // The header of a CSV, also of an older version, names all columns.
        if file.gyrolab.is_none() {
            measure.extend(reliable(&measure));
        }
        if let Some(figure) = &file.figure {
            let varied = axes.iter().flat_map(|axis| &axis.keys).map(String::as_str);
            let names: Vec<&str> = measure.iter().map(|readout| readout.name).collect();
            problems.extend(figure.problems(&varied.collect::<Vec<_>>(), &names));
        }
        let stated = file.shard.as_deref().map_or(Ok(Shard::WHOLE), str::parse);
        let shard = stated.unwrap_or_else(|rule| {
            problems.push(Problem::at("shard", rule));
            Shard::WHOLE
        });
        let counts = axes.iter().map(|axis| axis.points.len() as u64);
        let points = counts.fold(1, u64::saturating_mul);
        if points > MOST_GRID_POINTS {
            let rule =
                format!("is a grid of {points} points: at most {MOST_GRID_POINTS} are allowed");
            problems.push(Problem::at("vary", rule));
        }
        if !problems.is_empty() {
            return Err(placed(problems));
        }
        let base_file = base.file.clone().bare();
        let names = measure.iter().map(|readout| readout.name.to_owned());
        let sweep = Self {
            base: Document::from_file("", &base_file)?,
            file: SweepFile {
                gyrolab: Some(env!("CARGO_PKG_VERSION").to_owned()),
                title: Some(file.title.unwrap_or_else(|| base_file.title.clone())),
                measure: Some(names.collect()),
                scenario: Base::Checked(Box::new(base_file)),
                ..file
            },
            axes,
            measure,
            shard: Shard::WHOLE,
            points,
        }
        .with_shard(shard);
        let led = sweep.keys_lead_somewhere();
        led.map_err(|problem| placed(vec![problem]))?;
        Ok(sweep)
    }

    /// The scenario that `file`, which stands in `document`, begins from, with what `change` changes in it.
    pub fn base(
        file: &SweepFile,
        document: &Document,
        change: impl FnOnce(&mut Document) -> Result<(), Problems>,
    ) -> Result<Scenario, Problems> {
        let (mut base, is_inside) = match &file.scenario {
            Base::Name(name) if is_file(name) => {
                let folder = Path::new(document.origin()).parent();
                let path = folder.unwrap_or(Path::new("")).join(name);
                (Document::read(&path)?, false)
            }
            Base::Name(name) => (Document::open(name)?, false),
            Base::Written(table) => (Document::from_table(document.origin(), table.clone()), true),
            Base::Checked(file) => (Document::from_file(document.origin(), file)?, true),
        };
        change(&mut base)?;
        base.scenario().map_err(|problems| {
            if is_inside {
                inside(problems, document)
            } else {
                problems
            }
        })
    }

    #[must_use]
    pub fn with_shard(mut self, shard: Shard) -> Self {
        self.file.shard = (shard != Shard::WHOLE).then(|| shard.to_string());
        self.shard = shard;
        self
    }

    /// Whether every key has a place in the scenario: the key of a push that is not there, say, has none.
    fn keys_lead_somewhere(&self) -> Result<(), Problem> {
        let mut document = self.base.clone();
        for (key, value) in self.axes.iter().flat_map(SweepAxis::first_values) {
            let names: Vec<_> = key.split('.').collect();
            let number = names.iter().position(|name| name.parse::<usize>().is_ok());
            let entry = number.map(|at| names[..=at].join("."));
            if let Some(entry) = entry.filter(|entry| find(self.base.table(), entry).is_none()) {
                let rule = format!("leads nowhere: the scenario has no {entry}");
                return Err(Problem::at(key, rule));
            }
            if let Some(rule) = self.counts_otherwise(key) {
                return Err(Problem::at(key, rule));
            }
            document.set_value(key, value.clone())?;
        }
        Ok(())
    }

    /// What is wrong with `key` where it is in steps and its push in seconds, or the reverse.
    fn counts_otherwise(&self, key: &str) -> Option<String> {
        number_of_push(key)?;
        let (entry, name) = key.rsplit_once('.')?;
        let [in_steps, in_seconds] =
            ["steps", "for_s"].map(|own| find(self.base.table(), &join(entry, own)).is_some());
        IN_STEPS_OR_SECONDS.into_iter().find_map(|(steps, seconds)| {
            if name == steps && in_seconds {
                return Some(format!(
                    "the push counts in seconds (--time-step turns steps into seconds): vary {entry}.{seconds}"
                ));
            }
            (name == seconds && in_steps)
                .then(|| format!("the push counts in steps: vary {entry}.{steps}"))
        })
    }

    pub fn title(&self) -> &str {
        self.file.title.as_deref().unwrap_or_default()
    }

    pub fn about(&self) -> Option<&str> {
        self.file.about.as_deref()
    }

    /// How many rows its shard has.
    pub fn rows(&self) -> u64 {
        let points = self.shard.range(self.points);
        points.end - points.start
    }

    /// The sweep file in `# ` lines, and the line of the columns' names.
    pub fn header(&self) -> String {
        let keys = self.keys();
        let readouts = self.measure.iter().map(|readout| readout.name);
        commented(&self.file.to_toml()) + &line(&keys.chain(readouts).collect::<Vec<_>>())
    }

    /// Returns the keys that vary, in the order of their columns.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let keys = self.axes.iter().flat_map(|axis| &axis.keys);
        keys.map(String::as_str)
    }

    /// Returns the values of the point of the `row`-th row, from 0, one for each of the [keys](Self::keys).
    pub fn values(&self, row: u64) -> Vec<&Value> {
        let mut rest = self.shard.range(self.points).start + row;
        let mut of_axes = Vec::new();
        for axis in self.axes.iter().rev() {
            let count = axis.points.len() as u64;
            of_axes.push(&axis.points[(rest % count) as usize]);
            rest /= count;
        }
        of_axes.into_iter().rev().flatten().collect()
    }

    /// Returns the readouts in `text`, the line of the `row`-th row, from 0, with its end; `None` where it is not such a line:
    /// other values vary, a field is no value of its readout, or it would be written in other bytes.
    pub fn parse_row(&self, row: u64, text: &[u8]) -> Option<Vec<Readable>> {
        let labels = self.labels(row);
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_reader(text);
        let record = reader.records().next()?.ok()?;
        if record.len() != labels.len() + self.measure.len() {
            return None;
        }
        let written = record.iter().skip(labels.len());
        let cells: Vec<_> = self
            .measure
            .iter()
            .zip(written)
            .map(|(readout, cell)| readout.parse(cell))
            .collect::<Option<_>>()?;
        (line(&(labels, &cells)).as_bytes() == text).then_some(cells)
    }

    fn labels(&self, row: u64) -> Vec<String> {
        self.values(row).into_iter().map(label).collect()
    }

    /// The point behind the `row`-th row in words: `motion.time_step_s = 0.1, motion.scheme = "rk4"`.
    pub fn point_in_words(&self, row: u64) -> String {
        let values = self.keys().zip(self.values(row));
        let pairs = values.map(|(key, value)| format!("{key} = {}", in_words(value)));
        pairs.collect::<Vec<_>>().join(", ")
    }

    pub fn scenario(&self, row: u64) -> Result<Scenario, String> {
        let mut document = self.base.clone();
        let mut time_step_s = None;
        for (key, value) in self.keys().zip(self.values(row)) {
            if key == TIME_STEP {
                time_step_s = value.as_float();
            } else {
                document.set_value(key, value.clone())?;
            }
        }
        let scenario = document.scenario()?;
        match time_step_s {
            Some(time_step_s) => at_time_step(&scenario, time_step_s),
            None => Ok(scenario),
        }
    }

    /// The `row`-th row, from 0; `None` where `go_on` said no on the way.
    pub fn row(&self, row: u64, go_on: &dyn Fn() -> bool) -> Option<SweepRow> {
        let found = self
            .scenario(row)
            .and_then(|scenario| readouts::at_end(scenario, &self.measure, go_on));
        let (cells, failure) = match found {
            Ok(cells) => (cells?, None),
            Err(why) => (vec![Readable::Nothing; self.measure.len()], Some(why)),
        };
        let is_empty = self.lacks_readouts(&cells);
        Some(SweepRow {
            reliability: self.reliability(&cells),
            line: line(&(self.labels(row), cells)),
            has_failed: failure.is_some(),
            empty: is_empty.then(|| {
                failure.unwrap_or_else(|| "none of its readouts can be stated".to_owned())
            }),
        })
    }

    /// Returns whether none of the `cells` of a row, one for each readout, holds a value of its run; whether the run is
    /// reliable is none.
    pub(super) fn lacks_readouts(&self, cells: &[Readable]) -> bool {
        let are_all = self.measure.iter().all(|readout| readout.name == RELIABLE);
        let mut of_run = self
            .measure
            .iter()
            .zip(cells)
            .filter(|(readout, _)| are_all || readout.name != RELIABLE);
        of_run.all(|(_, cell)| *cell == Readable::Nothing)
    }

    /// Returns what the `cells` of a row, one for each readout, say of the numbers of its run.
    pub(super) fn reliability(&self, cells: &[Readable]) -> Reliability {
        let place = self
            .measure
            .iter()
            .position(|readout| readout.name == RELIABLE);
        match place.map(|place| &cells[place]) {
            None => Reliability::NotAsked,
            Some(Readable::Flag(true)) => Reliability::Reliable,
            Some(Readable::Flag(false)) => Reliability::Unreliable,
            Some(_) => Reliability::Unknown,
        }
    }
}

/// Returns the readout `reliable` where `measure` reads a number off the runs and lacks it.
fn reliable(measure: &[&'static Readout]) -> Option<&'static Readout> {
    let reads_runs = measure.iter().any(|readout| match readout.source {
        ReadoutSource::Scenario | ReadoutSource::Scheme | ReadoutSource::Theory => false,
        ReadoutSource::State
        | ReadoutSource::EveryStep
        | ReadoutSource::Measured
        | ReadoutSource::Exact
        | ReadoutSource::Clock => true,
    });
    let has_it = measure.iter().any(|readout| readout.name == RELIABLE);
    readouts::find(RELIABLE).filter(|_| reads_runs && !has_it)
}

/// The readouts called `names`; without any, every number that is the same each time.
fn measured(
    names: Option<&[String]>,
    axes: &[SweepAxis],
    problems: &mut Vec<Problem>,
) -> Vec<&'static Readout> {
    let Some(names) = names else {
        return READOUTS
            .iter()
            .filter(|readout| readout.source != ReadoutSource::Clock && !readout.is_text)
            .collect();
    };
    if names.is_empty() {
        problems.push(Problem::at("measure", "must name at least one readout"));
    }
    let mut found: Vec<&Readout> = Vec::new();
    for name in names {
        let rule = match readouts::find(name) {
            None => format!("is no readout: {}", readouts::nearest(name)),
            Some(readout) if readout.source == ReadoutSource::Clock => {
                "is told by the clock: it is another number each time, and so would be the file"
                    .to_owned()
            }
            Some(readout) if found.iter().any(|other| other.name == readout.name) => {
                "is named twice".to_owned()
            }
            Some(readout)
                if axes
                    .iter()
                    .any(|axis| axis.keys.iter().any(|key| key == readout.name)) =>
            {
                "varies, and has its column already".to_owned()
            }
            Some(readout) => {
                found.push(readout);
                continue;
            }
        };
        let value = Value::String(name.clone());
        problems.push(Problem::with_value("measure", &value, rule));
    }
    found
}

/// The `problems` of the table `[scenario]` of `document`, with their lines there.
fn inside(problems: Problems, document: &Document) -> Problems {
    if problems.list.iter().any(|problem| problem.place.is_some()) {
        return problems; // they are those of an option
    }
    document.placed(problems.inside("scenario").list)
}

fn line(cells: &impl Serialize) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    // Writing plain values to memory does not fail.
    let _ = writer.serialize(cells);
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// A varied value as TOML has it, but for large numbers without their zeros.
fn in_words(value: &Value) -> String {
    match value {
        Value::Float(_) => label(value),
        other => other.to_string(),
    }
}

/// A varied value as its column has it.
fn label(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        // As the readouts' numbers are written.
        Value::Float(number) => line(&[number]).trim_end().to_owned(),
        other => other.to_string(),
    }
}

/// `scenario` at another time step, s, with its length and its pushes held in seconds.
fn at_time_step(scenario: &Scenario, time_step_s: f64) -> Result<Scenario, String> {
    let duration_s = Clock::end_s(scenario);
    if accumulates(scenario) && time_step_s != scenario.motion.time_step_s {
        return Err(
            "a push accumulates step by step: at another time step it is another force".to_owned(),
        );
    }
    if time_step_s > duration_s * (1.0 + 1e-9) {
        return Err(format!(
            "{TIME_STEP} ({}) must not be longer than the whole run, {} s",
            shortest(time_step_s),
            decimal(duration_s)
        ));
    }
    if duration_s / time_step_s > MOST_RUN_STEPS_BY_TIME {
        return Err(format!(
            "{TIME_STEP} ({}) would be more than {MOST_RUN_STEPS_BY_TIME:e} steps",
            shortest(time_step_s)
        ));
    }
    Ok(resampled(scenario, time_step_s, scenario.motion.scheme))
}
