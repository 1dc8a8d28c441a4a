//! Error messages about a scenario, in words for users who have never seen the code.

use crate::text::printable::{brief, printable};
use std::fmt;

/// One error: the place, the key, its value, and the rule that it breaks.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Dotted key, with numbers for positions in arrays (`push.0.force_N`). Empty for an error of the whole file.
    pub key: String,
    /// Value as the file writes it, shortened. Empty if there is none.
    pub value: String,
    /// The rule, with the remedy if there is one ("must be greater than zero").
    pub rule: String,
    /// Place in the input, once known: `line 12` or `--set KEY=VALUE`.
    pub place: Option<String>,
}

impl Problem {
    /// Creates a problem with the value at `key`.
    pub fn with_value(
        key: impl Into<String>,
        value: &toml::Value,
        rule: impl Into<String>,
    ) -> Self {
        Self {
            value: shown(value),
            ..Self::at(key, rule)
        }
    }

    /// Creates a problem with `key` that is not caused by a single value.
    pub fn at(key: impl Into<String>, rule: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            value: String::new(),
            rule: rule.into(),
            place: None,
        }
    }

    /// Returns the same problem with its key below the key `outer`.
    #[must_use]
    pub fn inside(self, outer: &str) -> Self {
        let key = join(outer, &self.key).trim_end_matches('.').to_owned();
        Self { key, ..self }
    }

    /// Returns the problem in words, without its place.
    fn bare(&self) -> String {
        let (key, value, rule) = (brief(&self.key, 80), &self.value, &self.rule);
        match (self.key.is_empty(), value.is_empty()) {
            (true, _) => rule.clone(),
            (false, true) => format!("{key}: {rule}"),
            (false, false) => format!("{key} ({value}) {rule}"),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.bare())
    }
}

/// Sets the place of `problem` to `line`.
pub fn at_line(line: u64, mut problem: Problem) -> Problem {
    problem.place = Some(format!("line {line}"));
    problem
}

/// Maximum number of listed problems of one file. More would not help anybody.
const MOST_PROBLEMS: usize = 100;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problems {
    /// Name of the file. Empty while the problems are being collected.
    pub origin: String,
    /// The first hundred problems, finally sorted in the order of the file.
    pub list: Vec<Problem>,
    pub more: usize,
}

impl Problems {
    /// Creates the list with the single `problem` of the file `origin`.
    pub fn one(origin: impl Into<String>, problem: Problem) -> Self {
        Self::from(problem).in_file(origin)
    }

    /// Returns the same problems with `origin` as their file.
    pub fn in_file(self, origin: impl Into<String>) -> Self {
        Self {
            origin: origin.into(),
            ..self
        }
    }

    /// Adds a problem. Beyond the first hundred, problems are only counted.
    pub fn add(&mut self, problem: impl FnOnce() -> Problem) {
        if self.is_full() {
            self.more += 1;
        } else {
            self.list.push(problem());
        }
    }

    /// Returns true if further problems are only counted.
    pub fn is_full(&self) -> bool {
        self.list.len() >= MOST_PROBLEMS
    }

    pub fn add_all(&mut self, other: impl Into<Self>) {
        let Self { list, more, .. } = other.into();
        list.into_iter().for_each(|problem| self.add(|| problem));
        self.more += more;
    }

    /// Returns the value in `made`. If it is an error, adds its problems and returns `None`.
    pub fn kept<T>(&mut self, made: Result<T, impl Into<Self>>) -> Option<T> {
        made.map_err(|problems| self.add_all(problems)).ok()
    }

    /// Returns `Ok(made)` if there are no problems.
    pub fn or<T>(self, made: T) -> Result<T, Self> {
        if self.list.is_empty() {
            Ok(made)
        } else {
            Err(self)
        }
    }

    /// Returns the same problems with their keys below the key `outer`.
    #[must_use]
    pub fn inside(self, outer: &str) -> Self {
        let list = self.list.into_iter();
        Self {
            list: list.map(|problem| problem.inside(outer)).collect(),
            ..self
        }
    }

    fn is_about_option(&self, problem: &Problem) -> bool {
        let place = problem.place.as_deref().unwrap_or_default();
        place.starts_with("--") && self.origin.starts_with(PRESETS_FOLDER)
    }

    /// Returns the first problem in one line, without file, line or `--set`: `motion.time_step_s (-0.1) must be greater
    /// than zero`.
    pub fn in_one_line(&self) -> String {
        let first = self.list.first().map(Problem::bare);
        first.unwrap_or_default().replace('\n', " ")
    }
}

impl From<Problems> for String {
    fn from(problems: Problems) -> Self {
        problems.in_one_line()
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self {
            list: vec![problem],
            ..Self::default()
        }
    }
}

impl From<Problem> for String {
    fn from(problem: Problem) -> Self {
        problem.to_string()
    }
}

impl From<Vec<Problem>> for Problems {
    fn from(mut list: Vec<Problem>) -> Self {
        let more = list.len().saturating_sub(MOST_PROBLEMS);
        list.truncate(MOST_PROBLEMS);
        Self {
            list,
            more,
            ..Self::default()
        }
    }
}

/// Folder of the presets in the source, with which their origin begins.
pub(super) const PRESETS_FOLDER: &str = "presets/";

/// Number of problems that are printed. The rest is only counted.
const SHOWN: usize = 12;

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.list.iter().take(SHOWN).enumerate() {
            let newline = if index == 0 { "" } else { "\n" };
            // The line number follows the file's name (`file.toml:12: ...`), as editors and compilers write it.
            let place = problem.place.as_deref();
            match place.and_then(|place| place.strip_prefix("line ")) {
                Some(line) => {
                    let bare = problem.bare();
                    write!(f, "{newline}{}:{line}: {bare}", printable(&self.origin))?;
                }
                // An error in an option does not belong to the preset's file, which the user has not named.
                None if self.origin.is_empty() || self.is_about_option(problem) => {
                    write!(f, "{newline}{problem}")?;
                }
                None => write!(f, "{newline}{}: {problem}", printable(&self.origin))?,
            }
        }
        match self.list.len().saturating_sub(SHOWN) + self.more {
            0 => Ok(()),
            more => write!(f, "\n{}: and {more} more", printable(&self.origin)),
        }
    }
}

impl std::error::Error for Problems {}

/// Returns a value on one line, at most 40 characters of it.
fn shown(value: &toml::Value) -> String {
    match value {
        toml::Value::Table(_) => "a table".to_owned(),
        toml::Value::Array(items) if items.first().is_some_and(toml::Value::is_table) => {
            format!("{} tables", items.len())
        }
        other => brief(&other.to_string(), 40),
    }
}

/// Lists the names, at most the first twelve.
pub fn listed<'a>(names: impl Iterator<Item = &'a str> + Clone) -> String {
    const MOST_SUGGESTED_NAMES: usize = 12;
    let first = names.clone().take(MOST_SUGGESTED_NAMES);
    let mut list: Vec<_> = first.map(|name| brief(name, 40)).collect();
    match names.count() {
        0 => list.push("none".to_owned()),
        count if count > MOST_SUGGESTED_NAMES => {
            list.push(format!("and {} more", count - MOST_SUGGESTED_NAMES));
        }
        _ => {}
    }
    list.join(", ")
}

/// Maximum length of a name that is compared. Nothing longer is a typing mistake.
const LONGEST_COMPARED_NAME: usize = 80;
/// Maximum number of names that are compared. The body may have 100 000 points.
const MOST_COMPARED: usize = 2000;

/// Returns "did you mean ...?" for a name that is not in `known`, or the list of known names if none is near.
pub fn nearest<'a>(wrong: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    if wrong.len() > LONGEST_COMPARED_NAME {
        return format!("there is {}", listed(known));
    }
    let bare = letters(wrong);
    if let Some(name) = closest(wrong, &bare, known.clone().take(MOST_COMPARED)) {
        return format!("did you mean {}?", brief(name, LONGEST_COMPARED_NAME));
    }
    // For "precession", list all names that contain it.
    let having_it = known
        .clone()
        .filter(|name| bare.len() > 2 && letters(name).contains(&bare));
    match having_it.clone().next() {
        Some(_) => format!("there is {}", listed(having_it)),
        None => format!("there is {}", listed(known)),
    }
}

/// Returns the name among `known` that was probably meant by `name`.
pub fn near<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Option<&'a str> {
    let is_short = name.len() <= LONGEST_COMPARED_NAME;
    is_short
        .then(|| closest(name, &letters(name), known))
        .flatten()
}

/// Returns the name in `known` that was probably meant by `wrong`. `bare` are the letters and digits of `wrong`.
fn closest<'a>(
    wrong: &str,
    bare: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Option<&'a str> {
    // A name without its unit ("radius" for "radius_m", "L_z" for "Lz_Js") is near, however long the unit. A name with
    // the same letters and digits is nearer ("method2" for "method-2", and not for "method-2-slow").
    if !bare.is_empty() {
        let found = known
            .clone()
            .find(|name| letters(name) == bare)
            .or_else(|| known.clone().find(|name| letters(name).starts_with(bare)));
        if found.is_some() {
            return found;
        }
    }
    let lower = wrong.to_lowercase();
    let length = lower.chars().count();
    let distances = known.filter_map(|name| {
        let furthest = 2.max(name.len() / 3);
        // If two names differ in length by more than this, they differ in at least this many letters.
        let may_be_near = name.len() <= LONGEST_COMPARED_NAME
            && name.chars().count().abs_diff(length) <= furthest;
        may_be_near.then(|| {
            let distance = strsim::damerau_levenshtein(&lower, &name.to_lowercase());
            (distance, furthest, name)
        })
    });
    let (distance, furthest, name) = distances.min_by_key(|(distance, ..)| *distance)?;
    (distance <= furthest).then_some(name)
}

/// Returns the letters and digits of `name`, in lower case.
fn letters(name: &str) -> String {
    let all = name.chars().filter(|c| c.is_alphanumeric());
    all.flat_map(char::to_lowercase).collect()
}

/// Returns the dotted key of `name` in the table at the dotted path `under`.
pub fn join(under: &str, name: &str) -> String {
    if under.is_empty() {
        name.to_owned()
    } else {
        format!("{under}.{name}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_suggested() {
        let keys = ["radius_m", "height_m", "points"];
        let readouts = "t_s Lx_Js Lz_Js L_axle_Js predicted_lowest_tilt_deg".split(' ');
        let presets = ["method-1", "method-2-slow", "method-2"];
        let known: Vec<_> = keys.into_iter().chain(readouts).chain(presets).collect();
        for (names, wrong, near) in [
            (0..3, "raduis_m", "did you mean radius_m?"),
            (0..3, "radius", "did you mean radius_m?"),
            (0..3, "colour", "there is radius_m, height_m, points"),
            (3..8, "L_z", "did you mean Lz_Js?"),
            (3..8, "lz", "did you mean Lz_Js?"),
            (3..8, "l_z_js", "did you mean Lz_Js?"),
            (3..8, "Laxle", "did you mean L_axle_Js?"),
            (3..8, "tilt", "there is predicted_lowest_tilt_deg"),
            // A name with the same letters is nearer than one that only begins with them.
            (8..11, "method2", "did you mean method-2?"),
            (8..11, "Method_2", "did you mean method-2?"),
            (8..11, "method 2", "did you mean method-2?"),
            (8..11, "method2slow", "did you mean method-2-slow?"),
        ] {
            assert_eq!(
                nearest(wrong, known[names].iter().copied()),
                near,
                "{wrong}"
            );
        }
    }
}
