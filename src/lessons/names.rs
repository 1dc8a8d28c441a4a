//! The numbers that expressions of a lesson can use: readouts of a run, and numbers kept by earlier pages.

use crate::engine::analysis::readouts;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::problem::nearest;
use crate::lab::{Lab, numbers};
use std::collections::BTreeMap;

/// Kept numbers by their names. A number that was not available is NaN.
pub type KeptNumbers = BTreeMap<String, f64>;

/// Names with another meaning in a lesson.
const RESERVED: [&str; 5] = ["with", "prediction", "and", "or", "abs"];

/// Maximum number of kept numbers in a lesson.
const MOST_KEPT_NUMBERS: usize = 100;

/// Names under which a lesson keeps numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptNames {
    /// Names, each with the first page on which it is known.
    kept: Vec<(String, usize)>,
    /// First page on which a run is open, once a block that opens one has been read.
    open_from: Option<usize>,
    /// True if a block that may keep numbers could not be read.
    is_incomplete: bool,
}

impl KeptNames {
    /// Adds `name`, which is known from page `from`.
    ///
    /// # Errors
    ///
    /// Returns the reason if no number can be kept under that name.
    pub(super) fn keep(&mut self, name: &str, from: usize) -> Result<(), String> {
        let mut characters = name.chars();
        let begins = characters.next().is_some_and(|c| c.is_ascii_alphabetic());
        let rule = if self.kept.len() == MOST_KEPT_NUMBERS {
            return Err(format!(
                "is one too many: a lesson keeps at most {MOST_KEPT_NUMBERS} numbers"
            ));
        } else if !begins || !characters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
            "must begin with a letter and have only letters without accents, digits and _"
        } else if RESERVED.contains(&name) {
            "means something else in a lesson: choose another name"
        } else if readouts::find(name).is_some() || numbers::find(name, None).is_ok() {
            "is a number of the run already: choose another name"
        } else if self.is_kept(name) {
            "is kept twice: choose another name"
        } else {
            self.kept.push((name.to_owned(), from));
            return Ok(());
        };
        Err(rule.to_owned())
    }

    /// Records that a run is open from page `page`, unless one was open before.
    pub(super) fn open_from(&mut self, page: usize) {
        self.open_from.get_or_insert(page);
    }

    fn is_kept(&self, name: &str) -> bool {
        self.kept.iter().any(|(known, _)| known == name)
    }

    /// Records that a block could not be read. Unknown names are accepted from now on, because that block may define
    /// them.
    pub(super) fn mark_incomplete(&mut self) {
        self.is_incomplete = true;
    }

    /// Checks that `name` is a number on page `page`.
    ///
    /// # Errors
    ///
    /// Returns the reason if it is not, with the nearest known name.
    pub(super) fn find(&self, name: &str, page: usize) -> Result<(), String> {
        match self.kept.iter().find(|(known, _)| known == name) {
            Some((_, from)) if *from <= page => return Ok(()),
            Some((_, from)) => return Err(format!("{name} is known from page {from} on")),
            None => {}
        }
        if self.is_incomplete {
            return Ok(());
        }
        let found = numbers::find(name, None).map(|_| ());
        if found.is_ok() && self.open_from.is_none_or(|from| page < from) {
            return Err(format!(
                "{name} is a number of a run, but no lab block has opened a run yet"
            ));
        }
        found.map_err(|reason| {
            let kept = self.kept.iter().map(|(known, _)| known.as_str());
            match nearest(name, kept) {
                near if near.starts_with("did you mean") => {
                    format!("there is no number named {name}: {near}")
                }
                _ => reason,
            }
        })
    }
}

/// Returns the kept number called `name`, or else the run's number in `lab`. Returns `None` if neither is available
/// now.
pub fn number(name: &str, lab: &Lab, kept: &KeptNumbers) -> Option<f64> {
    match kept.get(name) {
        Some(number) => Some(*number).filter(|number| number.is_finite()),
        None => lab.player().number(name),
    }
}

/// Returns the value of `expression` in `lab`, or `None` if a number that it needs is not available.
pub fn value(expression: &Expression, lab: &Lab, kept: &KeptNumbers) -> Option<f64> {
    let value = expression.value(|name| number(name, lab, kept));
    value.filter(|value| value.is_finite())
}
