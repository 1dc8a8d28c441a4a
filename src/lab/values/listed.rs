//! One value of the list.

use super::NEXT_PUSH;
use crate::journal::next_push::{Field, NextPush};
use crate::journal::parameters::Parameter;

/// A value, in words, and where it is set.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedValue {
    /// Dotted key, as `--set` takes it; `None` for the push to come.
    pub key: Option<String>,
    /// The heading under which it stands.
    pub group: String,
    pub label: String,
    pub unit: &'static str,
    /// The value with all its digits.
    pub text: String,
    /// Whether the scenario's file does not contain it: the value is the default.
    pub is_default: bool,
    pub(in crate::lab) of: Of,
}

#[derive(Clone, Debug, PartialEq)]
pub(in crate::lab) enum Of {
    Scenario(Box<Parameter>),
    NextPush(Field),
}

impl From<Parameter> for ListedValue {
    fn from(parameter: Parameter) -> Self {
        let label = &parameter.label;
        let with_frame = parameter.frame.map(|frame| format!("{label} {frame}"));
        Self {
            key: Some(parameter.key.clone()),
            group: parameter.group.clone(),
            label: with_frame.unwrap_or_else(|| label.clone()),
            unit: parameter.unit(),
            text: parameter.shown(),
            is_default: parameter.is_default,
            of: Of::Scenario(Box::new(parameter)),
        }
    }
}

impl ListedValue {
    pub(super) fn all_of(push: &NextPush) -> [Self; 4] {
        Field::ALL.map(|field| Self {
            key: None,
            group: NEXT_PUSH.to_owned(),
            label: field.label().0.to_owned(),
            unit: field.label().1,
            text: push.shown(field),
            is_default: false,
            of: Of::NextPush(field),
        })
    }

    /// How its group, label and key answer the search for `name`.
    pub(super) fn answers(&self, name: &str) -> Option<Match> {
        let key = self.key.as_deref().unwrap_or_default();
        Match::of(&format!("{} {} {key}", self.group, self.label), name)
    }
}

/// How names answer a search; capitals do not matter. The best comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Match {
    /// With each word that is searched for one of their words begins.
    Word,
    /// Each word that is searched for is a part of them.
    Part,
}

impl Match {
    /// How `names` answer the search for `name`; `None` where they do not.
    pub fn of(names: &str, name: &str) -> Option<Self> {
        let (names, name) = (names.to_lowercase(), name.to_lowercase());
        let begins = |wanted: &str| {
            let mut words = names.split(|c: char| !c.is_alphanumeric());
            names.starts_with(wanted) || words.any(|word| word.starts_with(wanted))
        };
        let mut wanted = name.split_whitespace();
        if wanted.clone().all(begins) {
            return Some(Self::Word);
        }
        wanted
            .all(|word| names.contains(word))
            .then_some(Self::Part)
    }
}
