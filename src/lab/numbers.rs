//! The numbers of a run by name, for conditions: the columns of the CSV as they are now, and the scenario's keys.

use crate::export::columns::{COLUMNS, Column};
use crate::observe::live::LiveRun;
use crate::scenario::dotted;
use crate::scenario::keys::{self, KEYS, Kind};
use crate::work::parameters::table_at;
use toml::Value;

/// Where a number comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// The present row of the CSV has it.
    Column(&'static Column),
    /// Gravity in force, m/s².
    Gravity,
    /// The time step in force, s.
    TimeStep,
    /// A value of the scenario, where it has one.
    Fixed(Option<f64>),
}

/// Whether there is a number of that name: a column, or a key of the scenario that holds a number.
pub fn is_known(name: &str) -> bool {
    let holds_number = |kind| matches!(kind, Kind::Number(_) | Kind::Whole(..));
    Column::find(name).is_some() || keys::find(name).is_ok_and(|(_, kind)| holds_number(kind))
}

/// The names to offer for one that is not known.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    let columns = COLUMNS.iter().map(|column| column.name);
    let numbers = KEYS
        .iter()
        .filter(|key| matches!(key.kind, Kind::Number(_) | Kind::Whole(..)));
    columns.chain(numbers.map(|key| key.path))
}

/// Where the number of that name comes from in `run`; `None` where there is none such.
pub fn source(run: &LiveRun, name: &str) -> Option<Source> {
    if let Some(column) = Column::find(name) {
        return Some(Source::Column(column));
    }
    if !is_known(name) {
        return None;
    }
    Some(match name {
        "motion.gravity_m_per_s2" => Source::Gravity,
        "motion.time_step_s" => Source::TimeStep,
        _ => {
            let table = table_at(run.scenario(), run.simulation().step_number());
            Source::Fixed(dotted::find(&table, name).and_then(number))
        }
    })
}

impl Source {
    /// The number as it is now in `run`.
    pub fn value(&self, run: &LiveRun) -> Option<f64> {
        match self {
            Self::Column(column) => Some(column.value(&run.simulation().sample()).number()),
            Self::Gravity => Some(run.simulation().motion().gravity),
            Self::TimeStep => Some(run.simulation().motion().time_step_s),
            Self::Fixed(value) => *value,
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    let whole = || value.as_integer().map(|whole| whole as f64);
    value.as_float().or_else(whole)
}
