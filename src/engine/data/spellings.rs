//! Table of the column names that other programs use, with the units in them.
//!
//! Read without `--map`:
//! - phyphox: `Gyroscope x (rad/s)`, `Rotation x`, `Angular velocity x`, `X (rad/s)`
//! - Tracker: `t`, `x`, `y`, with or without units and titles
//! - Sensor Logger: `seconds_elapsed`, and `x`, `y`, `z` in a file called Gyroscope.csv
//! - Physics Toolbox: `time`, `wx`, `wy`, `wz`
//! - loggers with units: `timestamp_ms`, `gx_dps`

use super::names::{UNCERTAINTY_WORD, is_known, uncertainty_of, without_uncertainty};
use super::quantity::{QUANTITIES, TIME_COLUMN};
use crate::scenario::Problem;
use crate::scenario::csv::Csv;
use crate::text::number::significant;
use crate::text::printable::brief;
use crate::text::unit::{Unit, UnitKind, in_known_unit, with_word};
use std::path::Path;

/// Names of the time, without unit, in lower case and without separators.
const TIMES: [&str; 9] = [
    "t",
    "time",
    "zeit",
    "timestamp",
    "elapsed",
    "elapsedtime",
    "timeelapsed",
    "secondselapsed",
    "systemtime",
];
/// Names of a time in seconds, if no unit is given.
const IN_SECONDS: [&str; 4] = ["t", "time", "zeit", "secondselapsed"];

/// Words before an axis in the name of an angular velocity about the body's own axis.
const RATES: [&str; 17] = [
    "",
    "g",
    "gyr",
    "gyro",
    "gyroscope",
    "gyroskop",
    "rot",
    "rotation",
    "rotationrate",
    "angularvelocity",
    "angularrate",
    "angularspeed",
    "angvel",
    "omega",
    "ω",
    "winkelgeschwindigkeit",
    "drehrate",
];
/// Words before an axis in the name of a coordinate.
const PLACES: [&str; 3] = ["", "pos", "position"];

/// Maximum number of columns in the list of how columns are read.
const MOST_TOLD: usize = 12;

/// Name of the time in Sensor Logger, which names its files after the sensors.
const SENSOR_LOGGER: &str = "seconds_elapsed";

const AXES: [&str; 3] = ["x", "y", "z"];
const BODY_RATES: [&str; 3] = ["w1_rad_per_s", "w2_rad_per_s", "w3_rad_per_s"];
const COORDINATES: [&str; 3] = ["x_m", "y_m", "z_m"];

/// Certainty of the meaning of a column. Of several columns for one quantity, the one with the highest certainty is
/// read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Surety {
    /// A name without a unit.
    Bare,
    /// A name with a unit.
    WithUnit,
    /// gyrolab's own name.
    Named,
}

/// Meaning of a column.
#[derive(Clone, Debug)]
struct Meaning {
    /// gyrolab's name.
    name: String,
    /// Factor to the unit of that name.
    factor: f64,
    surety: Surety,
}

/// Evidence from the other columns for the meaning of names without a unit.
struct Company {
    /// True if the file has a time `t`. Its coordinates are then in m, as Tracker writes them.
    has_t: bool,
    /// True if the file has a time `time`. Its rates `wx`, `wy`, `wz` are then in rad/s, as Physics Toolbox writes
    /// them.
    has_time: bool,
    /// True for the gyroscope's file of Sensor Logger, with rates `x`, `y`, `z` in rad/s.
    is_gyroscope: bool,
}

/// Gives gyrolab's names to the columns that `--map` does not name, if `is_wanted` is true for the name. Converts their
/// numbers. `origin` is the file.
///
/// # Errors
/// Returns an error if several columns have the same meaning and no `--map` chooses one.
pub fn name_columns(
    cells: &mut Csv,
    origin: &str,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<(), Vec<Problem>> {
    let company = Company::new(cells, origin);
    let is_mapped = cells.own.iter().any(|own| own.is_mapped);
    let meanings: Vec<Option<Meaning>> = (0..cells.names.len())
        .map(|place| {
            meaning(&cells.names[place], &company)
                .filter(|it| !cells.own[place].is_mapped && is_wanted(&it.name))
        })
        .collect();
    let mut problems = Vec::new();
    for (place, meaning) in meanings.iter().enumerate() {
        let Some(meaning) = meaning else { continue };
        let same_name: Vec<(usize, &Meaning)> = meanings
            .iter()
            .enumerate()
            .filter_map(|(other_place, other)| Some((other_place, other.as_ref()?)))
            .filter(|(_, other)| other.name == meaning.name)
            .collect();
        let surest = same_name.iter().map(|(_, other)| other.surety).max();
        let is_surest = surest == Some(meaning.surety);
        let rivals: Vec<usize> = same_name
            .iter()
            .filter(|(_, other)| other.surety == meaning.surety)
            .map(|(other_place, _)| *other_place)
            .collect();
        let mut columns = cells.own.iter().zip(&cells.names);
        let is_taken = columns.any(|(own, name)| own.is_mapped && *name == meaning.name);
        if is_taken || !is_surest || (is_mapped && rivals.len() > 1) {
            cells.names[place].insert_str(0, OTHER);
        } else if rivals.len() == 1 {
            cells.name_column(place, &meaning.name, meaning.factor);
        } else if rivals[0] == place {
            problems.push(several(cells, &meaning.name, &rivals));
        }
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems)
    }
}

/// Prefix of the name of a column that is not read because another one is.
const OTHER: &str = "(another) ";

fn several(cells: &Csv, name: &str, places: &[usize]) -> Problem {
    let numbers = places
        .iter()
        .map(|&place| cells.own[place].number.to_string())
        .collect::<Vec<_>>()
        .join(" and ");
    let tracks: Vec<String> = places
        .iter()
        .filter_map(|&place| track(cells, place))
        .map(|title| format!("\"{}\"", brief(title, 40)))
        .collect();
    let of_tracks = if tracks.is_empty() {
        String::new()
    } else {
        format!(", of the tracks {}", tracks.join(" and "))
    };
    let rule = format!(
        "names columns {numbers}{of_tracks}, which would both be {name}: leave one out, or choose one by its number"
    );
    Problem::at(cells.own[places[0]].shown(), rule)
}

/// Returns the title above the column, which is the name of its track.
pub(super) fn track(cells: &Csv, place: usize) -> Option<&str> {
    let mut titles = cells
        .titles
        .iter()
        .take(cells.own[place].number)
        .filter(|title| !title.is_empty());
    titles.next_back().map(String::as_str)
}

impl Company {
    fn new(cells: &Csv, origin: &str) -> Self {
        let mut names = cells.own.iter().map(|own| own.name.as_str());
        let has_time = names.clone().any(|name| name == "time");
        let is_of_logger = names.any(|name| name == SENSOR_LOGGER);
        let file = Path::new(origin)
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        Self {
            has_t: cells
                .own
                .iter()
                .any(|own| Unit::split(&own.name).map_or(&*own.name, |(stem, _)| stem) == "t"),
            has_time,
            is_gyroscope: is_of_logger && file.contains("gyroscope"),
        }
    }
}

/// Returns true if the meaning of the columns in `cells` depends on the name of the file.
pub(super) fn depends_on_name(cells: &Csv) -> bool {
    cells.own.iter().any(|own| own.name == SENSOR_LOGGER)
}

/// Returns the meaning of the column `name`.
fn meaning(name: &str, company: &Company) -> Option<Meaning> {
    if let Some(of) = without_uncertainty(name) {
        let of = meaning(&of, company).filter(|of| of.name != TIME_COLUMN)?;
        return Some(Meaning {
            name: with_word(&of.name, UNCERTAINTY_WORD),
            ..of
        });
    }
    if is_known(name) {
        return Some(Meaning {
            name: name.to_owned(),
            factor: 1.0,
            surety: Surety::Named,
        });
    }
    if let Some((known, factor)) = in_known_unit(name, is_known) {
        return Some(Meaning {
            name: known,
            factor,
            surety: Surety::WithUnit,
        });
    }
    if let Some((stem, unit)) = Unit::split(name) {
        let known = with_unit(stem, unit)?;
        return Some(Meaning {
            factor: unit.times(Unit::from_name(known)?)?,
            name: known.to_owned(),
            surety: Surety::WithUnit,
        });
    }
    let known = without_unit(name, company)?;
    Some(Meaning {
        name: known.to_owned(),
        factor: 1.0,
        surety: if letters(name) == "secondselapsed" {
            Surety::WithUnit
        } else {
            Surety::Bare
        },
    })
}

/// Returns gyrolab's name for a column with the name `stem` and the given `unit`.
fn with_unit(stem: &str, unit: &Unit) -> Option<&'static str> {
    let own = letters(stem);
    match unit.kind {
        UnitKind::Time => TIMES.contains(&&*own).then_some(TIME_COLUMN),
        UnitKind::Rate if axis_after(&own, &RATES).is_some() => {
            axis_after(&own, &RATES).map(|axis| BODY_RATES[axis])
        }
        UnitKind::Length if axis_after(&own, &PLACES).is_some() => {
            axis_after(&own, &PLACES).map(|axis| COORDINATES[axis])
        }
        // The axes of wx (rad/s) are ambiguous.
        UnitKind::Rate if axis_after(&own, &["w"]).is_some() => None,
        kind => QUANTITIES
            .iter()
            .map(|quantity| quantity.name)
            .find(|name| {
                Unit::from_name(name).is_some_and(|known| {
                    known.kind == kind && letters(&name[..name.len() - known.end.len()]) == own
                })
            }),
    }
}

/// Returns gyrolab's name for a column without a unit.
fn without_unit(name: &str, company: &Company) -> Option<&'static str> {
    if IN_SECONDS.contains(&&*letters(name)) {
        return Some(TIME_COLUMN);
    }
    if company.has_time && name.len() == 2 {
        return axis_after(name, &["w"]).map(|axis| BODY_RATES[axis]);
    }
    let axis = AXES.iter().position(|axis| *axis == name)?;
    if company.is_gyroscope {
        return Some(BODY_RATES[axis]);
    }
    company.has_t.then_some(COORDINATES[axis])
}

/// Returns the axis at the end of a name, if one of `fronts` is before it.
fn axis_after(letters: &str, fronts: &[&str]) -> Option<usize> {
    AXES.iter().position(|axis| {
        let front = letters.strip_suffix(axis);
        front.is_some_and(|front| fronts.contains(&front))
    })
}

/// Returns true if programs use `name` for the time, in any unit.
pub fn time_like(name: &str) -> bool {
    let stem = Unit::split(name).map_or(name, |(stem, _)| stem);
    TIMES.contains(&&*letters(stem))
}

/// Returns the letters and digits of `name` in lower case, without the word "axis".
fn letters(name: &str) -> String {
    let all: String = name
        .chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect();
    all.replace("axis", "")
}

/// Describes how the columns with other names are read. `None` if there are none.
pub(super) fn read_as(cells: &Csv) -> Option<String> {
    let columns = cells.own.iter().zip(&cells.names);
    let renamed = columns.filter(|(own, name)| {
        let of = uncertainty_of(name).unwrap_or_else(|| (*name).clone());
        let is_read = is_known(&of) && **name != own.name;
        is_read && (!own.is_mapped || own.factor != 1.0)
    });
    let mut words: Vec<String> = renamed
        .map(|(own, name)| {
            let own_name = brief(&own.shown(), 40);
            match own.factor {
                1.0 => format!("{own_name} as {name}"),
                factor => format!("{own_name} as {name} (times {})", significant(factor, 7)),
            }
        })
        .collect();
    let more = words.len().saturating_sub(MOST_TOLD);
    words.truncate(MOST_TOLD);
    words.extend((more > 0).then(|| format!("and {more} more")));
    (!words.is_empty()).then(|| format!("columns read: {}", words.join(", ")))
}
