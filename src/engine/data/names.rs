//! Roles of the columns of a file: the time, quantities, keys of the scenario, readouts, and uncertainties of these.

use super::quantity::{self, COUNTS, RunQuantity, TIME_COLUMN};
use crate::analysis::readouts::{self, Readout, ReadoutSource};
use crate::export::columns::DISTANCE;
use crate::scenario::Problem;
use crate::scenario::csv::Csv;
use crate::scenario::keys;
use crate::scenario::kind::ValueKind;
use crate::text::unit::with_word;

/// Word in the name of a column that is the uncertainty of another.
pub(super) const UNCERTAINTY_WORD: &str = "uncertainty";

#[derive(Clone, Debug)]
pub(super) enum ColumnRole {
    /// The time, s.
    Time,
    /// A count of the run's steps or edits, which has no effect on the motion.
    Count,
    /// An unknown column, for some other purpose.
    Foreign,
    /// A quantity at the time of the row.
    Quantity(&'static RunQuantity),
    /// A value of the scenario in the run of the row.
    Key(ValueKind),
    /// A readout of the run of the row.
    Readout(&'static Readout),
}

impl ColumnRole {
    /// Returns true if another column may contain its uncertainty.
    fn may_be_off(&self) -> bool {
        match self {
            Self::Quantity(_) | Self::Readout(_) => true,
            Self::Key(kind) => matches!(kind, ValueKind::Number(_)),
            Self::Time | Self::Count | Self::Foreign => false,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct NamedColumn {
    pub place: usize,
    pub name: String,
    pub is: ColumnRole,
    pub uncertainty: Option<usize>,
}

/// Columns of a file that are read, and the names of the others.
#[derive(Debug, Default)]
pub(super) struct Columns {
    pub read: Vec<NamedColumn>,
    pub left_out: Vec<String>,
}

/// Returns the columns of `cells`, without counts. Unknown columns are left out. In a file with mapped columns, so are
/// columns that would cause an error.
pub(super) fn named(cells: &Csv) -> Result<Columns, Vec<Problem>> {
    let names = &cells.names;
    let is_series = names.iter().any(|name| name == TIME_COLUMN);
    let is_mapped = cells.own.iter().any(|own| own.is_mapped);
    let of = if is_series { of_series } else { of_table };
    let (mut columns, mut problems) = (Columns::default(), Vec::new());
    for (place, (name, own)) in names.iter().zip(&cells.own).enumerate() {
        if uncertainty_of(name).is_some() {
            continue;
        }
        match of(name) {
            Ok(ColumnRole::Foreign) => columns.left_out.push(own.shown()),
            Ok(is) => {
                let uncertainty = with_word(name, UNCERTAINTY_WORD);
                let mut others = names.iter();
                let uncertainty = others.position(|other| *other == uncertainty);
                columns.read.push(NamedColumn {
                    place,
                    name: name.clone(),
                    uncertainty: uncertainty.filter(|_| is.may_be_off()),
                    is,
                });
            }
            Err(_) if is_mapped && !own.is_mapped => columns.left_out.push(own.shown()),
            Err(rule) => problems.push(Problem::at(own.shown(), rule)),
        }
    }
    for (place, (name, own)) in names.iter().zip(&cells.own).enumerate() {
        let is_read = columns
            .read
            .iter()
            .any(|column| column.uncertainty == Some(place));
        match uncertainty_of(name) {
            Some(stem) if stem == TIME_COLUMN && !is_mapped => {
                let rule = format!(
                    "is not read, because {TIME_COLUMN} has no uncertainty: add the change of the measured values in that time to their uncertainties"
                );
                problems.push(Problem::at(own.shown(), rule));
            }
            Some(_) if !is_read => columns.left_out.push(own.shown()),
            _ => {}
        }
    }
    if problems.is_empty() {
        problems.extend(kind_is_whole(&columns.read, is_series));
    }
    columns
        .read
        .retain(|column| !matches!(column.is, ColumnRole::Count));
    if problems.is_empty() {
        Ok(columns)
    } else {
        Err(problems)
    }
}

/// Returns the name of the column whose uncertainty is in the column `name`.
pub(super) fn uncertainty_of(name: &str) -> Option<String> {
    name.split(['_', '.'])
        .any(|word| word == UNCERTAINTY_WORD)
        .then(|| name.replacen(&format!("_{UNCERTAINTY_WORD}"), "", 1))
}

/// Returns `name` without the word for an uncertainty, wherever it occurs. `None` if it does not occur.
pub(super) fn without_uncertainty(name: &str) -> Option<String> {
    let lower = name.to_lowercase();
    let at = lower
        .find(UNCERTAINTY_WORD)
        .filter(|_| lower.len() == name.len())?;
    let (front, back) = (name.get(..at)?, name.get(at + UNCERTAINTY_WORD.len()..)?);
    Some(match front.trim_end_matches(['_', ' ', '-']) {
        "" => back.trim_start_matches(['_', ' ', '-']).to_owned(),
        front => format!("{front}{back}"),
    })
}

/// Returns true if gyrolab itself uses the column name `name`.
pub(super) fn is_known(name: &str) -> bool {
    quantity::names().any(|known| known == name)
        || readouts::find(name).is_some()
        || name.contains('.') && keys::find(name).is_ok()
}

/// Returns true if `--map` may give a column the name `name`.
pub(super) fn may_be(name: &str) -> bool {
    is_known(name) || uncertainty_of(name).is_some_and(|of| is_known(&of))
}

fn of_series(name: &str) -> Result<ColumnRole, String> {
    if name == TIME_COLUMN {
        return Ok(ColumnRole::Time);
    }
    if COUNTS.contains(&name) || name == DISTANCE {
        return Ok(ColumnRole::Count);
    }
    if let Some(quantity) = RunQuantity::find(name) {
        return Ok(ColumnRole::Quantity(quantity));
    }
    if name.contains('.') && keys::find(name).is_ok() {
        return Err(format!(
            "is a key of the scenario, but a file with the time {TIME_COLUMN} belongs to a single run: set the key in the scenario or with --set"
        ));
    }
    if readouts::find(name).is_some_and(|readout| !readout.is_text && name.contains('_')) {
        return Err(format!(
            "is a number of a whole run, not of one time: put it into a table without {TIME_COLUMN}, with one run per row"
        ));
    }
    Ok(ColumnRole::Foreign)
}

fn of_table(name: &str) -> Result<ColumnRole, String> {
    if let Some(readout) = readouts::find(name) {
        let rule = match readout.source {
            _ if COUNTS.contains(&name) || name == "steps" => return Ok(ColumnRole::Count),
            _ if readout.is_text => "is a text, and cannot be measured",
            ReadoutSource::Clock => "comes from the clock, and is not part of the motion",
            ReadoutSource::Scenario => "follows from the scenario alone, and cannot be measured",
            _ => return Ok(ColumnRole::Readout(readout)),
        };
        return Err(rule.to_owned());
    }
    let Some((first, _)) = name.split_once('.') else {
        return Ok(ColumnRole::Foreign);
    };
    if ["expected", "edit", "view"].contains(&first) {
        return Err("is a key that does not affect any number of a run".to_owned());
    }
    if !["body", "start", "motion", "push", "friction"].contains(&first) {
        return Ok(ColumnRole::Foreign);
    }
    keys::find(name).map(|(_, kind)| ColumnRole::Key(kind))
}

/// Returns true if a column `name` is an error in a table of runs.
pub(super) fn is_refused_in_table(name: &str) -> bool {
    of_table(name).is_err()
}

/// Returns why the columns are neither a time series nor a table of runs.
fn kind_is_whole(columns: &[NamedColumn], is_series: bool) -> Option<Problem> {
    let has = |is: fn(&ColumnRole) -> bool| columns.iter().any(|column| is(&column.is));
    if is_series {
        let rule = format!(
            "has only the time {TIME_COLUMN}: add a column that a run has too, such as tilt_deg, azimuth_deg, x_m or spin_rpm"
        );
        return (!has(|is| matches!(is, ColumnRole::Quantity(_)))).then(|| Problem::at("", rule));
    }
    // Quantities that a run has at every time do not distinguish the runs of a table.
    let has_key = has(|is| matches!(is, ColumnRole::Key(_)));
    let rule = match has(|is| matches!(is, ColumnRole::Readout(_))) {
        true if has_key || columns.iter().any(|column: &NamedColumn| {
        matches!(column.is, ColumnRole::Readout(_)) && RunQuantity::find(&column.name).is_none()
    }) => return None,
        false if has_key => {
            "has no measured column: besides keys of the scenario, a table of runs needs a readout (gyrolab readouts lists them)".to_owned()
        }
        _ => format!(
            "is neither a time series (with the time {TIME_COLUMN}) nor a table of runs (with a key of the scenario, such as start.spin_rpm, or a number of a whole run)"
        ),
    };
    Some(Problem::at("", rule))
}
