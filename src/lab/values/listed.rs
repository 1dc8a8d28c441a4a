//! One value of the list.

use super::NEXT_PUSH;
use crate::work::next_push::{Field, NextPush};
use crate::work::parameters::Parameter;
use std::borrow::Cow;

#[derive(Clone, Debug, PartialEq)]
pub enum ListedValue {
    OfScenario(Box<Parameter>),
    OfNextPush {
        field: Field,
        /// The value as text.
        text: String,
    },
}

impl ListedValue {
    pub(super) fn of(push: &NextPush) -> [Self; 4] {
        Field::ALL.map(|field| Self::OfNextPush {
            field,
            text: push.shown(field),
        })
    }

    /// Dotted key, as `--set` takes it; `None` for the push to come.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::OfScenario(parameter) => Some(&parameter.key),
            Self::OfNextPush { .. } => None,
        }
    }

    /// The heading under which it stands.
    pub fn group(&self) -> &str {
        match self {
            Self::OfScenario(parameter) => &parameter.group,
            Self::OfNextPush { .. } => NEXT_PUSH,
        }
    }

    pub fn label(&self) -> Cow<'_, str> {
        match self {
            Self::OfScenario(parameter) => match parameter.frame {
                Some(frame) => format!("{} {frame}", parameter.label).into(),
                None => parameter.label.as_str().into(),
            },
            Self::OfNextPush { field, .. } => field.label().0.into(),
        }
    }

    /// The value with all its digits.
    pub fn text(&self) -> String {
        match self {
            Self::OfScenario(parameter) => parameter.shown(),
            Self::OfNextPush { text, .. } => text.clone(),
        }
    }

    pub fn unit(&self) -> &'static str {
        match self {
            Self::OfScenario(parameter) => parameter.unit(),
            Self::OfNextPush { field, .. } => field.label().1,
        }
    }

    /// Whether the scenario's file does not contain it: the value is the default.
    pub fn is_default(&self) -> bool {
        match self {
            Self::OfScenario(parameter) => parameter.is_default,
            Self::OfNextPush { .. } => false,
        }
    }

    /// How its group, label and key answer the search for `name`.
    pub(super) fn answers(&self, name: &str) -> Option<Match> {
        let key = self.key().unwrap_or_default();
        Match::of(&format!("{} {} {key}", self.group(), self.label()), name)
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
