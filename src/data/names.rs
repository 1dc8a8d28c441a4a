//! What the columns of a file are: the time, quantities, keys of the scenario, readouts, and uncertainties of these.

use super::quantity::{self, COUNTS, Quantity, TIME};
use crate::analysis::readouts::{self, Readout, Source};
use crate::scenario::csv::Csv;
use crate::scenario::keys::{self, Kind};
use crate::scenario::problem::{at_line, is_near, listed, nearest};
use crate::scenario::{Problem, Problems};
use crate::text::number::significant;
use crate::text::unit::{Unit, with_word};

/// In the name of a column that is the uncertainty of another.
pub(super) const UNCERTAINTY: &str = "uncertainty";

#[derive(Clone, Debug)]
pub(super) enum Is {
    /// The time, s.
    Time,
    /// A number of the run's steps or edits, which says nothing of the motion.
    Count,
    /// Nothing that is known, nor near to it: a column for another purpose.
    Foreign,
    /// A quantity at the time of its row.
    Quantity(&'static Quantity),
    /// What the scenario has in the run of its row.
    Key(Kind),
    /// A readout of the run of its row.
    Readout(&'static Readout),
}

impl Is {
    /// Whether a column may hold its uncertainty.
    fn may_be_off(&self) -> bool {
        match self {
            Self::Quantity(_) | Self::Readout(_) => true,
            Self::Key(kind) => matches!(kind, Kind::Number(_)),
            Self::Time | Self::Count | Self::Foreign => false,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Named {
    pub place: usize,
    pub name: String,
    pub is: Is,
    pub uncertainty: Option<usize>,
}

/// The columns of `cells`, without those that count, and the names of those of a time series that are not known.
pub(super) fn named(cells: &Csv) -> Result<(Vec<Named>, Vec<String>), Problems> {
    let mut problems = Vec::new();
    let names = &cells.names;
    let is_series = names.iter().any(|name| name == TIME);
    let of = if is_series { of_series } else { of_table };
    let (mut columns, mut left_out) = (Vec::new(), Vec::new());
    for (place, name) in names.iter().enumerate() {
        let mut refuse = |rule| problems.push(Problem::at(shown(name, place), rule));
        if names[..place].contains(name) {
            refuse("names two columns: leave one of them out".to_owned());
        }
        if is_uncertainty(name) {
            continue;
        }
        match of(name) {
            Ok(Is::Foreign) => left_out.push(name.clone()),
            Ok(is) => {
                let uncertainty = with_word(name, UNCERTAINTY);
                let mut others = names.iter();
                let uncertainty = others.position(|other| *other == uncertainty);
                columns.push(Named {
                    place,
                    name: name.clone(),
                    uncertainty: uncertainty.filter(|_| is.may_be_off()),
                    is,
                });
            }
            Err(rule) => refuse(rule),
        }
    }
    problems.extend(uncertainties_alone(names, &columns));
    if problems.is_empty() {
        problems.extend(kind_is_whole(&columns, is_series));
    }
    columns.retain(|column| !matches!(column.is, Is::Count));
    let place = |problem| at_line(cells.line_of_names, problem);
    Problems::from(problems.into_iter().map(place).collect::<Vec<_>>()).or((columns, left_out))
}

/// A column's name, or its number where it has none.
fn shown(name: &str, place: usize) -> String {
    match name {
        "" => format!("column {}", place + 1),
        name => name.to_owned(),
    }
}

fn is_uncertainty(name: &str) -> bool {
    name.split(['_', '.']).any(|word| word == UNCERTAINTY)
}

fn of_series(name: &str) -> Result<Is, String> {
    if name == TIME {
        return Ok(Is::Time);
    }
    if COUNTS.contains(&name) {
        return Ok(Is::Count);
    }
    if let Some(quantity) = Quantity::find(name) {
        return Ok(Is::Quantity(quantity));
    }
    if keys::find(name).is_ok() {
        return Err(format!(
            "is a key of the scenario: beside {TIME} stands what was measured on one run; set the key in the scenario, or by --set"
        ));
    }
    if readouts::find(name).is_some() {
        return Err(format!(
            "is a number of a whole run, not of one time: a table of such has no column {TIME}, and a run in every row"
        ));
    }
    let known = quantity::names;
    let is_meant = name.is_empty()
        || is_time(name)
        || wrong_unit(name, known()).is_some()
        || is_near(name, known());
    if is_meant {
        Err(unknown(name, known()))
    } else {
        Ok(Is::Foreign)
    }
}

fn of_table(name: &str) -> Result<Is, String> {
    if let Some(readout) = readouts::find(name) {
        let rule = match readout.source {
            _ if COUNTS.contains(&name) || name == "steps" => return Ok(Is::Count),
            _ if readout.is_text => "is a text of the run, and cannot be measured",
            Source::Clock => "is told by the clock, and says nothing of the motion",
            Source::Scenario => "follows from the scenario alone: nothing is measured by it",
            _ => return Ok(Is::Readout(readout)),
        };
        return Err(rule.to_owned());
    }
    let first = name.split('.').next().unwrap_or_default();
    if [
        "gyrolab", "title", "about", "source", "expected", "edit", "view",
    ]
    .contains(&first)
    {
        return Err("is a key that no number of a run depends on".to_owned());
    }
    match keys::find(name) {
        Ok((_, kind)) => Ok(Is::Key(kind)),
        Err(rule) if name.contains('.') => {
            Err(wrong_unit(name, keys::KEYS.iter().map(|key| key.path)).unwrap_or(rule))
        }
        Err(_) => Err(unknown(name, readouts::names().chain([TIME]))),
    }
}

/// Why `name` is none of `known`, and which is meant.
fn unknown<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    if name.is_empty() {
        return "has no name: name it, or leave the column out".to_owned();
    }
    if let Some(told) = wrong_unit(name, known.clone()) {
        return told;
    }
    let near = match is_time(name).then_some(TIME) {
        Some(time) => format!("did you mean {time}?"),
        None => nearest(name, known),
    };
    format!("is no column that gyrolab knows: {near}")
}

fn is_time(name: &str) -> bool {
    ["t", "time", "zeit"].contains(&stem(name).to_lowercase().as_str())
}

fn stem(name: &str) -> &str {
    let end = Unit::anybodys(name).map_or("", |unit| unit.end);
    &name[..name.len() - end.len()]
}

/// Which unit is wanted where `name` is one of `known` but for that.
fn wrong_unit<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let last = |name: &'a str| name.rsplit('.').next().unwrap_or(name);
    let own = name.rsplit('.').next().unwrap_or(name);
    let found = Unit::anybodys(own)?;
    let mut meant = known.filter_map(|known| {
        let unit = Unit::of(last(known))?;
        let is_same = stem(last(known)) == stem(own) && unit != found;
        is_same.then_some((last(known), unit, found.times(unit)?))
    });
    let (meant, unit, times) = meant.next()?;
    let table = &name[..name.len() - own.len()];
    let factor = match times {
        1.0 => "as it is".to_owned(),
        times => format!("multiplied by {}", significant(times, 7)),
    };
    Some(format!(
        "is in {}, and is wanted in {}: name the column {table}{meant}, its values {factor}",
        found.name, unit.name
    ))
}

fn uncertainties_alone(names: &[String], columns: &[Named]) -> Vec<Problem> {
    let owned = |place| {
        columns
            .iter()
            .any(|column| column.uncertainty == Some(place))
    };
    let all = names.iter().enumerate();
    let alone = all.filter(|(place, name)| is_uncertainty(name) && !owned(*place));
    let lacking = columns.iter();
    let lacking = lacking.filter(|column| column.uncertainty.is_none() && column.is.may_be_off());
    let wanted: Vec<String> = lacking
        .map(|column| with_word(&column.name, UNCERTAINTY))
        .collect();
    let rule = |name: &str| {
        if let Some(wrong) = wrong_unit(name, wanted.iter().map(String::as_str)) {
            return wrong;
        }
        let own = name.replacen(&format!("_{UNCERTAINTY}"), "", 1);
        if own == TIME {
            return format!(
                "is not taken: make what was measured the more uncertain, by its change in that time ({TIME} is without error)"
            );
        }
        let known = listed(wanted.iter().map(String::as_str));
        format!("is the uncertainty of no measured column: there is {known}")
    };
    let alone = alone.map(|(_, name)| Problem::at(name.clone(), rule(name)));
    alone.collect()
}

/// Why the columns make neither a time series nor a table of runs.
fn kind_is_whole(columns: &[Named], is_series: bool) -> Option<Problem> {
    let has = |is: fn(&Is) -> bool| columns.iter().any(|column| is(&column.is));
    if is_series {
        let rule = format!(
            "has no column that a run has too: beside {TIME} one is needed, such as tilt_deg, azimuth_deg, x_m or spin_rpm"
        );
        return (!has(|is| matches!(is, Is::Quantity(_)))).then(|| Problem::at("", rule));
    }
    let rule = match (has(|is| matches!(is, Is::Key(_))), has(|is| matches!(is, Is::Readout(_)))) {
        (true, true) => return None,
        (true, false) => {
            "has no column that was measured: beside the keys of the scenario a table of runs needs a readout (gyrolab readouts lists them)".to_owned()
        }
        (false, _) => format!(
            "is neither a time series, which has a column {TIME}, nor a table of runs, which has a column named by a key of the scenario, such as start.spin_rpm"
        ),
    };
    Some(Problem::at("", rule))
}
