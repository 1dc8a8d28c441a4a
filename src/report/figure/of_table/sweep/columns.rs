//! The columns of a sweep, by origin and quantity.

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

/// Origin of the numbers in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum QuantityOwner {
    /// Theory of the exact motion or of the scheme.
    Theory,
    /// Measured in the run.
    Measured,
    /// A value of the run that is not a measurement, such as its tilt at the end, or the turns of its wheel per step.
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

/// The columns of one quantity: theory first, because it is drawn below the points.
pub(super) type QuantityColumns = Vec<QuantityColumn>;

/// A column of a sweep.
pub(super) struct QuantityColumn {
    pub name: String,
    pub role: QuantityOwner,
    /// The column with the standard errors.
    pub uncertainty: Option<String>,
}

/// Removes the prefix that tells the origin of a number from a name.
fn bare(name: &str) -> &str {
    let parts = [MEASURED_PREFIX, PREDICTED_PREFIX].map(|word| name.strip_prefix(word));
    parts.into_iter().flatten().next().unwrap_or(name)
}

/// Returns the quantities of a sweep in the order of its columns: all, or the requested ones.
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

/// Returns the quantity of the column `name`. Theory of a special case, such as `fast_top_precession_rad_per_s`,
/// belongs to the measured quantity, here `measured_precession_rad_per_s`.
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

/// Returns the column with the standard errors of `name`, such as measured_precession_uncertainty_rad_per_s for
/// measured_precession_rad_per_s.
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

/// Returns the axis of a quantity, named after the measured column if there are several, else after the only column.
pub(super) fn axis(parts: &[QuantityColumn]) -> ChartAxis {
    let named = parts
        .iter()
        .find(|part| part.role != QuantityOwner::Theory)
        .or_else(|| parts.iter().find(|part| bare(&part.name) != part.name));
    let Some(part) = named.or(parts.first()) else {
        return ChartAxis::default();
    };
    let own = quantity::axis(&part.name);
    // With several columns, the legend already tells their origins.
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
    /// Returns true if the column holds the theory of the exact motion, not an approximation.
    pub fn is_of_exact_motion(&self) -> bool {
        let source = readouts::find(&self.name).map(|readout| readout.source);
        let is_of_exact = [PREDICTED_PREFIX, TRUE_PREFIX].map(|word| self.name.starts_with(word));
        source == Some(ReadoutSource::Theory) && is_of_exact.contains(&true)
    }

    /// Returns the name in the legend, as markup. `is_alone` is true if the axis already names the theory.
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

/// Returns two columns as an example of a choice, measured ones first.
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
