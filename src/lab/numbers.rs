//! The numbers of a run that a condition can name: CSV columns, readouts, and keys of the scenario.

use crate::engine::analysis::Readouts;
use crate::engine::analysis::readouts::{self, Readout};
use crate::engine::export::columns::{COLUMNS, CsvColumn};
use crate::engine::journal::parameters::table_at;
use crate::engine::run::Sample;
use crate::engine::scenario::keys::{self, KEYS};
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{dotted, float};
use crate::lab::playback::live::LiveRun;

#[derive(Clone, Copy, Debug)]
pub enum NumberSource {
    /// A column of the CSV at the present step.
    Column(&'static CsvColumn),
    /// A readout that is not a CSV column.
    Readout(&'static Readout),
    /// Gravity in force, m/s².
    Gravity,
    /// The time step in force, s.
    TimeStep,
    /// A constant value of the scenario; `None` if the scenario lacks it or there is no run.
    Fixed(Option<f64>),
}

/// Finds the number called `name`, in `run` if there is one yet.
///
/// # Errors
/// Returns an error if there is no such number, or if it cannot be compared in the lab.
pub fn find(name: &str, run: Option<&LiveRun>) -> Result<NumberSource, String> {
    if let Some(column) = CsvColumn::find(name) {
        return Ok(NumberSource::Column(column));
    }
    match (readouts::find(name), keys::find(name)) {
        (Some(readout), _) if readout.is_text => Err(format!(
            "{name} is a text ({}), and a condition compares numbers",
            readout.meaning
        )),
        (Some(readout), _) if readout.source == readouts::ReadoutSource::Clock => {
            Err(format!("{name} is not available in the lab"))
        }
        (Some(readout), _) => Ok(NumberSource::Readout(readout)),
        (None, Ok((_, kind))) if holds_number(kind) => Ok(match name {
            "motion.gravity_m_per_s2" => NumberSource::Gravity,
            "motion.time_step_s" => NumberSource::TimeStep,
            _ => NumberSource::Fixed(run.and_then(|run| number_in(run, name))),
        }),
        (None, Ok((_, ValueKind::Vector))) => Err(format!(
            "{name} is a vector: its numbers are {name}.0, {name}.1 and {name}.2"
        )),
        (None, Ok(_)) => Err(format!(
            "there is no number named {name}: that key holds no number"
        )),
        (None, Err(_)) => Err(format!(
            "there is no number named {name}: {}",
            nearest_to(name)
        )),
    }
}

fn holds_number(kind: ValueKind) -> bool {
    matches!(kind, ValueKind::Number(_) | ValueKind::Whole(..))
}

/// Returns the rest of the message about the unknown name `wrong`: the nearest name, or all names.
fn nearest_to(wrong: &str) -> String {
    let near = readouts::nearest(wrong);
    if near.contains(" or ") {
        return near; // for example, lowest_tilt_deg can be measured or predicted
    }
    let columns = COLUMNS.iter().map(|column| column.name);
    let others = readouts::READOUTS.iter().filter(|readout| {
        !readout.is_text
            && readout.source != readouts::ReadoutSource::Clock
            && CsvColumn::find(readout.name).is_none()
    });
    let keys = KEYS.iter().filter(|key| holds_number(key.kind));
    let names = columns.chain(others.map(|readout| readout.name));
    nearest(wrong, names.chain(keys.map(|key| key.path)))
}

/// Returns the value of `key` in the scenario of `run` at its present step.
fn number_in(run: &LiveRun, key: &str) -> Option<f64> {
    let table = table_at(run.scenario(), run.simulation().step_number());
    let number = dotted::find(&table, key).and_then(float);
    number.or(ZERO_BY_ITSELF.contains(&key).then_some(0.0))
}

/// The keys that are 0 if a scenario does not set them.
const ZERO_BY_ITSELF: [&str; 3] = ["start.tilt_deg", "start.turn_deg", "start.roll_deg"];

/// The numbers of a run at successive steps. At each step only the requested numbers are computed.
#[derive(Debug, Default)]
pub struct RunNumbers {
    /// The readouts. Those not in `read` are outdated.
    readouts: Option<Readouts>,
    /// The groups of readouts that were computed at the present step.
    read: Vec<readouts::ReadoutSource>,
}

/// The numbers of a run at its present step.
pub struct PresentNumbers<'a> {
    run: &'a mut LiveRun,
    numbers: &'a mut RunNumbers,
    sample: Option<Sample>,
}

impl RunNumbers {
    pub fn at<'a>(&'a mut self, run: &'a mut LiveRun) -> PresentNumbers<'a> {
        self.read.clear();
        PresentNumbers {
            run,
            numbers: self,
            sample: None,
        }
    }
}

impl PresentNumbers<'_> {
    /// Returns the number of `source`; `None` if it has no value at this step.
    pub fn value(&mut self, source: &NumberSource) -> Option<f64> {
        match source {
            NumberSource::Column(column) => {
                let run = self.run.simulation();
                let sample = self.sample.get_or_insert_with(|| run.sample());
                Some(column.value(run.scenario(), sample))
            }
            NumberSource::Readout(readout) => {
                readout.read_from(self.readouts(readout.source)).number()
            }
            NumberSource::Gravity => Some(self.run.simulation().motion().gravity),
            NumberSource::TimeStep => Some(self.run.simulation().motion().time_step_s),
            NumberSource::Fixed(value) => *value,
        }
    }

    fn readouts(&mut self, source: readouts::ReadoutSource) -> &Readouts {
        let RunNumbers { readouts, read } = &mut *self.numbers;
        let known = readouts.get_or_insert_with(|| self.run.readouts());
        if !read.contains(&source) {
            self.run.read_again(known, source);
            read.push(source);
        }
        known
    }
}
