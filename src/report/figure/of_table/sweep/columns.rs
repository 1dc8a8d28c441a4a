//! The columns of a sweep: whose number each is, and which of them are the same quantity.

use crate::engine::analysis::readouts::{self, ReadoutSource};
use crate::engine::text::unit::Unit;
use crate::plot::chart::ChartAxis;
use crate::report::figure::names::EXACT_CURVE_NAME;
use crate::report::figure::of_table::RELIABLE;
use crate::report::figure::quantity::{self, MEASURED_PREFIX, SIMULATED};
use crate::studies::table::{SweepTable, TableSource};

const PREDICTED_PREFIX: &str = "predicted_";
const TRUE_PREFIX: &str = "true_";
const UNCERTAINTY_INFIX: &str = "_uncertainty";

/// Whose number a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum QuantityOwner {
    /// What theory says, of the exact motion or of the scheme.
    Theory,
    /// What was measured on the run.
    Measured,
    /// A value of the run that is no measurement: its tilt at the end, the turns of its wheel in a step.
    Value,
}

impl QuantityOwner {
    fn from_name(name: &str) -> Self {
        let source = readouts::find(name).map(|readout| readout.source);
        match source {
            _ if name.starts_with(MEASURED_PREFIX) => Self::Measured,
            Some(ReadoutSource::Theory | ReadoutSource::Scheme) => Self::Theory,
            _ if name.starts_with(PREDICTED_PREFIX) => Self::Theory,
            _ => Self::Value,
        }
    }
}

/// A quantity of a sweep, by its columns: what was measured of it, and what theory says. Theory comes first: the points stand
/// on it.
pub(super) type QuantityColumns = Vec<QuantityColumn>;

/// A column.
pub(super) struct QuantityColumn {
    pub name: String,
    pub role: QuantityOwner,
    /// The column of its standard errors.
    pub uncertainty: Option<String>,
}

/// What a name is without saying whose number it is.
fn bare(name: &str) -> &str {
    let parts = [MEASURED_PREFIX, PREDICTED_PREFIX].map(|word| name.strip_prefix(word));
    parts.into_iter().flatten().next().unwrap_or(name)
}

/// The quantities of a sweep in the order of its columns: all of them, or those that are asked for.
pub(super) fn quantities(
    table: &TableSource,
    swept: &SweepTable,
    columns: &[&str],
) -> Vec<QuantityColumns> {
    let names: Vec<&String> = table
        .names()
        .iter()
        .filter(|name| {
            let is_asked = match columns {
                [] => *name != RELIABLE,
                columns => columns.contains(&name.as_str()),
            };
            !swept.has_varied(name) && is_asked && !name.contains(UNCERTAINTY_INFIX)
        })
        .filter(|name| {
            let numbers = table.numbers(name);
            numbers.is_some_and(|numbers| numbers.iter().any(|number| number.is_finite()))
        })
        .collect();
    let mut quantities: Vec<(&str, QuantityColumns)> = Vec::new();
    for name in &names {
        let part = QuantityColumn {
            name: (*name).clone(),
            role: QuantityOwner::from_name(name),
            uncertainty: uncertainty_of(table, name),
        };
        let what = what(name, &names);
        match quantities.iter_mut().find(|(other, _)| *other == what) {
            Some((_, quantity)) => quantity.push(part),
            None => quantities.push((what, vec![part])),
        }
    }
    let mut quantities: Vec<_> = quantities.into_iter().map(|(_, it)| it).collect();
    for quantity in &mut quantities {
        quantity.sort_by_key(|part| part.role != QuantityOwner::Theory);
    }
    quantities
}

/// What quantity the column `name` holds a number of. Theory of a special case, such as `fast_top_precession_rad_per_s`, is
/// of the quantity that was measured beside it, `measured_precession_rad_per_s`.
fn what<'a>(name: &'a str, names: &[&'a String]) -> &'a str {
    let own = bare(name);
    if QuantityOwner::from_name(name) != QuantityOwner::Theory {
        return own;
    }
    let mut measured = names
        .iter()
        .filter_map(|other| other.strip_prefix(MEASURED_PREFIX));
    measured
        .find(|other| {
            let case = own.strip_suffix(other);
            case.is_some_and(|case| case.is_empty() || case.ends_with('_'))
        })
        .unwrap_or(own)
}

/// The column of the standard errors of `name`: measured_precession_uncertainty_rad_per_s of measured_precession_rad_per_s.
fn uncertainty_of(table: &TableSource, name: &str) -> Option<String> {
    table
        .names()
        .iter()
        .find(|other| {
            let parts = other.split_once(UNCERTAINTY_INFIX);
            parts.is_some_and(|(begin, unit)| name.starts_with(begin) && name.ends_with(unit))
        })
        .cloned()
}

/// The axis of a quantity: named by what was measured where theory stands beside it, else by the column.
pub(super) fn axis(parts: &[QuantityColumn]) -> ChartAxis {
    let named = parts
        .iter()
        .find(|part| part.role != QuantityOwner::Theory)
        .or_else(|| parts.iter().find(|part| bare(&part.name) != part.name));
    let Some(part) = named.or(parts.first()) else {
        return ChartAxis::default();
    };
    let own = quantity::axis(&part.name);
    // Words say whose number it is; the legend says so already where both stand beside each other.
    if parts.len() == 1 {
        return own;
    }
    let words = [SIMULATED, PREDICTED_PREFIX.trim_end_matches('_')];
    let name = words
        .iter()
        .find_map(|word| own.name.strip_prefix(&format!("{word} ")))
        .map(str::to_owned);
    ChartAxis {
        name: name.unwrap_or(own.name),
        ..own
    }
}

impl QuantityColumn {
    /// Whether it holds what theory says of the exact motion, and no approximation of that.
    pub fn is_of_exact_motion(&self) -> bool {
        let source = readouts::find(&self.name).map(|readout| readout.source);
        let is_of_exact = [PREDICTED_PREFIX, TRUE_PREFIX].map(|word| self.name.starts_with(word));
        source == Some(ReadoutSource::Theory) && is_of_exact.contains(&true)
    }

    /// What the legend calls it, as markup; `is_alone`: the axis says which theory it is.
    pub fn word(&self, is_alone: bool) -> String {
        let source = readouts::find(&self.name).map(|readout| readout.source);
        match self.role {
            QuantityOwner::Value => String::new(),
            QuantityOwner::Measured => SIMULATED.to_owned(),
            QuantityOwner::Theory if self.name.starts_with(TRUE_PREFIX) => {
                EXACT_CURVE_NAME.to_owned()
            }
            QuantityOwner::Theory if !is_alone && !self.name.starts_with(PREDICTED_PREFIX) => {
                quantity::axis(&self.name).name
            }
            QuantityOwner::Theory if source == Some(ReadoutSource::Scheme) => {
                "theory of the scheme".to_owned()
            }
            QuantityOwner::Theory => "theory".to_owned(),
        }
    }
}

/// Two of the columns as an example of a choice, those that were measured before others.
pub(super) fn example(quantities: &[QuantityColumns]) -> String {
    let (measured, others): (Vec<_>, Vec<_>) = quantities
        .iter()
        .flatten()
        .partition(|part| part.role == QuantityOwner::Measured);
    let with_unit = others
        .into_iter()
        .filter(|part| Unit::from_name(&part.name).is_some());
    let names = measured.into_iter().chain(with_unit);
    names
        .map(|part| part.name.as_str())
        .take(2)
        .collect::<Vec<_>>()
        .join(",")
}
