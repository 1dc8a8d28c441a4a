//! Suggests a `--map` with which a rejected file can be read, filled in with the file's own names.

use super::names::{is_known, named};
use super::quantity::{RunQuantity, TIME_COLUMN, names};
use super::spellings::{name_columns, time_like, track};
use crate::analysis::readouts;
use crate::scenario::csv::{Csv, LEFT_OUT, Naming, Renaming};
use crate::scenario::keys::KEYS;
use crate::scenario::problem::near;
use crate::text::printable::{brief, is_steering};
use crate::text::unit::{Unit, UnitKind, in_known_unit};

/// Minimum length of a name for a suggestion. A shorter name is near to too many others.
const LEAST_NEAR: usize = 4;
/// Largest plausible rate in rad/s. The rate of a gyroscope in deg/s is often larger.
const MOST_RATE: f64 = 40.0;
/// Largest possible tilt in radians.
pub(super) const MOST_TILT_RAD: f64 = 3.15;
/// Maximum number of rows from which units are guessed.
const MOST_ROWS: usize = 2000;

/// Describes the `--map` with which `cells`, the file `origin`, can be read. `map` is the one given. Empty if none can
/// be found.
pub(super) fn hint(cells: &Csv, map: &[Renaming], origin: &str) -> String {
    let mut tracks: Vec<&str> = Vec::new();
    for place in 0..cells.names.len() {
        if let Some(title) = track(cells, place).filter(|title| !tracks.contains(title)) {
            tracks.push(title);
        }
    }
    if tracks.len() < 2 {
        let map = completed(cells, map, origin, None);
        return map.map_or_else(String::new, |map| format!("; this reads the file: {map}"));
    }
    let all: Vec<String> = tracks
        .iter()
        .filter_map(|title| {
            let map = completed(cells, map, origin, Some(title))?;
            Some(format!("{map} reads the track \"{}\"", brief(title, 40)))
        })
        .collect();
    if all.is_empty() {
        String::new()
    } else {
        format!("; {}", all.join(", "))
    }
}

/// Returns the option with `map` and the missing columns. If there are several tracks, only columns of the track `only`
/// are added.
fn completed(cells: &Csv, map: &[Renaming], origin: &str, only: Option<&str>) -> Option<String> {
    let mut guess = Guess {
        cells,
        added: Vec::new(),
    };
    guess.add_all(only, origin);
    let mut named_cells = cells.clone();
    for (place, name) in &guess.added {
        let known = in_known_unit(name, is_known)
            .map_or_else(|| format!("({LEFT_OUT})"), |(known, _)| known);
        named_cells.name_column(*place, &known, 1.0);
        named_cells.own[*place].is_mapped = true;
    }
    let is_read =
        name_columns(&mut named_cells, origin, |_| true).is_ok() && named(&named_cells).is_ok();
    is_read.then(|| map_option(cells, map, &guess.added))?
}

/// Returns the option that maps the columns in `map` and the `added` columns.
pub fn map_option(cells: &Csv, map: &[Renaming], added: &[(usize, String)]) -> Option<String> {
    let given = map.iter().map(|(column, name)| format!("{column}={name}"));
    let also = added
        .iter()
        .map(|(place, name)| format!("{}={name}", label(cells, *place)));
    let all = given.chain(also).collect::<Vec<_>>().join(",");
    if all
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || "_=,.:/+-@".contains(c))
    {
        return Some(format!("--map {all}"));
    }
    let quoted = shlex::try_quote(&all).ok()?;
    Some(format!("--map {quoted}"))
}

/// Returns the name with which `--map` finds the column at `place`, or its number.
fn label(cells: &Csv, place: usize) -> String {
    let own = &cells.own[place];
    let is_alone = cells.own.iter().filter(|it| it.name == own.name).count() == 1;
    let is_plain = !own.name.is_empty()
        && own
            .name
            .chars()
            .all(|c| c != ',' && c != '\'' && !is_steering(c))
        && own.name.len() <= 80
        && (cells.naming == Naming::Numbers || own.name.parse::<usize>().is_err());
    if is_alone && is_plain {
        own.name.clone()
    } else {
        own.number.to_string()
    }
}

/// Returns true if only a table of runs has columns of this name, and not a time series.
fn is_of_table(name: &str) -> bool {
    name.contains('.')
        || readouts::find(name).is_some()
            && RunQuantity::find(name).is_none()
            && name != TIME_COLUMN
}

/// Columns, and the names that they probably should have.
struct Guess<'a> {
    cells: &'a Csv,
    added: Vec<(usize, String)>,
}

impl Guess<'_> {
    fn add_all(&mut self, only: Option<&str>, origin: &str) {
        let places: Vec<usize> = (0..self.cells.names.len())
            .filter(|&place| {
                let is_first = place == 0 || only.is_none();
                !self.cells.own[place].is_mapped && (is_first || track(self.cells, place) == only)
            })
            .collect();
        let times = self.cells.names.iter().filter(|name| *name == TIME_COLUMN);
        let has_time = times.count() == 1;
        if !has_time && self.cells.names.iter().any(|name| is_of_table(name)) {
            return self.add_of_table(&places);
        }
        if !has_time && let Some(place) = self.time(&places) {
            let unit = self.time_unit(place);
            self.added.push((place, unit.to_owned()));
        }
        let mut names = self.cells.names.iter();
        let has_quantity = names.any(|name| RunQuantity::find(name).is_some());
        let is_gyroscope = self.is_gyroscope(origin);
        for &place in &places {
            if self.is_added(place) {
                continue;
            }
            let name = &self.cells.names[place];
            let is_refused = name.contains('.') && is_known(name)
                || name.contains("uncertainty") && name.starts_with("t_");
            let guessed = self.quantity(place, is_gyroscope);
            if is_refused {
                self.added.push((place, LEFT_OUT.to_owned()));
            } else if let Some(known) = guessed.filter(|known| self.is_free(known)) {
                self.added.push((place, known));
            }
        }
        if !has_quantity
            && !self
                .added
                .iter()
                .any(|(_, name): &(usize, String)| name != LEFT_OUT && !name.starts_with("t_"))
            && let Some(&place) = places
                .iter()
                .filter(|&&place| readouts::find(&self.cells.names[place]).is_none())
                .find(|&&place| !self.is_added(place) && !self.numbers(place).is_empty())
        {
            self.added.push((place, self.tilt(place).to_owned()));
        }
    }

    /// Returns true if no column has this name, neither from the user nor as a guess.
    fn is_free(&self, name: &str) -> bool {
        let mut columns = self.cells.own.iter().zip(&self.cells.names);
        !columns.any(|(own, known)| own.is_mapped && known == name)
            && self.added.iter().all(|(_, other)| other != name)
    }

    fn is_added(&self, place: usize) -> bool {
        self.added.iter().any(|(added, _)| *added == place)
    }

    /// Adds guesses for a table of runs: the key or readout that was probably meant, or a mark to leave the column out.
    fn add_of_table(&mut self, places: &[usize]) {
        for &place in places {
            let name = &self.cells.names[place];
            if super::names::is_refused_in_table(name) {
                let meant = near(
                    name,
                    KEYS.iter().map(|key| key.path).chain(readouts::names()),
                )
                .filter(|meant| !meant.contains('*') && *meant != name)
                .unwrap_or(LEFT_OUT)
                .to_owned();
                self.added.push((place, meant));
            }
        }
    }

    /// Returns the first numbers of a column.
    fn numbers(&self, place: usize) -> Vec<f64> {
        let rows = self.cells.rows.iter().take(MOST_ROWS);
        rows.filter_map(|(_, row): &(u64, Vec<String>)| {
            let text = match self.cells.separator {
                ',' => row[place].clone(),
                _ => row[place].replacen(',', ".", 1),
            };
            text.parse::<f64>().ok().filter(|number| number.is_finite())
        })
        .collect()
    }

    fn largest(&self, place: usize) -> f64 {
        let numbers = self.numbers(place);
        numbers
            .iter()
            .fold(0.0, |most, number| most.max(number.abs()))
    }

    /// Returns the column that is probably the time: one with such a name, else one with increasing numbers, else the
    /// first with numbers.
    fn time(&self, places: &[usize]) -> Option<usize> {
        let columns: Vec<usize> = places
            .iter()
            .copied()
            .filter(|place| RunQuantity::find(&self.cells.names[*place]).is_none())
            .collect();
        let mut called_so = columns
            .iter()
            .filter(|place| time_like(&self.cells.own[**place].name))
            .peekable();
        let first_called_so = called_so.peek().copied();
        called_so
            .find(|place| self.increases(**place))
            .or(first_called_so)
            .or_else(|| columns.iter().find(|place| self.increases(**place)))
            .or_else(|| {
                columns
                    .iter()
                    .find(|place| !self.numbers(**place).is_empty())
            })
            .copied()
    }

    fn increases(&self, place: usize) -> bool {
        let numbers = self.numbers(place);
        numbers.len() > 1 && numbers.windows(2).all(|pair| pair[0] < pair[1])
    }

    fn time_unit(&self, place: usize) -> &'static str {
        if Unit::split(&self.cells.own[place].name)
            .is_some_and(|(_, unit)| unit.kind == UnitKind::Time)
        {
            return TIME_COLUMN; // its own unit is used
        }
        let numbers = self.numbers(place);
        let span = numbers
            .last()
            .zip(numbers.first())
            .map_or(0.0, |(last, first)| last - first);
        let between = span / (numbers.len().max(2) - 1) as f64;
        match between {
            1e4.. => "t_ns",
            1.5.. => "t_ms",
            _ => TIME_COLUMN,
        }
    }

    fn is_gyroscope(&self, origin: &str) -> bool {
        let names = self.cells.own.iter().map(|own| own.name.as_str());
        names.chain([origin]).any(|text| {
            let lower = text.to_lowercase();
            ["gyr", "rot", "rate", "angular", "seconds_elapsed"]
                .iter()
                .any(|word| lower.contains(word))
        })
    }

    /// Returns the quantity that the column probably contains.
    fn quantity(&self, place: usize, is_gyroscope: bool) -> Option<String> {
        let own = &self.cells.own[place].name;
        if is_known(&self.cells.names[place])
            && RunQuantity::find(&self.cells.names[place]).is_some()
        {
            // A name that occurs only once is read without mapping.
            let name = &self.cells.names[place];
            let same = self.cells.names.iter().filter(|other| *other == name);
            return (same.count() > 1).then(|| name.clone());
        }
        let (stem, unit) =
            Unit::split(own).map_or((own.as_str(), None), |(stem, unit)| (stem, Some(unit)));
        let lower = stem.trim().to_lowercase();
        if ["theta", "θ", "tilt", "inclination"]
            .iter()
            .any(|word| lower.contains(word))
        {
            return Some(self.tilt(place).to_owned());
        }
        let axis = ["x", "y", "z"].iter().position(|axis| {
            let mut words = lower.split(|c: char| !c.is_alphanumeric());
            words.any(|word| {
                word == *axis
                    || word.strip_suffix(axis).is_some_and(|front| {
                        ["g", "w", "gyro", "gyr", "omega", "ω"].contains(&front)
                    })
            })
        });
        let has_foreign_word = ["acc", "mag", "grav", "linear"]
            .iter()
            .any(|word| lower.contains(word));
        if let Some(axis) = axis.filter(|_| !has_foreign_word) {
            let number = axis + 1;
            let is_length = unit.is_some_and(|unit| unit.kind == UnitKind::Length);
            if is_length || !is_gyroscope && lower.len() == 1 && unit.is_none() {
                return Some(format!("{}_m", ["x", "y", "z"][axis]));
            }
            if unit.is_some_and(|unit| unit.kind != UnitKind::Rate) {
                return None;
            }
            let is_in_degrees = unit.is_none() && self.largest(place) > MOST_RATE;
            let angle = if is_in_degrees { "deg" } else { "rad" };
            return Some(format!("w{number}_{angle}_per_s"));
        }
        let quantities =
            names().filter(|name| *name != TIME_COLUMN && RunQuantity::find(name).is_some());
        let meant = near(own, quantities).filter(|_| own.len() >= LEAST_NEAR)?;
        Some(meant.to_owned())
    }

    fn tilt(&self, place: usize) -> &'static str {
        let has_unit = Unit::split(&self.cells.own[place].name).is_some();
        if !has_unit && self.largest(place) <= MOST_TILT_RAD {
            "tilt_rad"
        } else {
            "tilt_deg"
        }
    }
}
