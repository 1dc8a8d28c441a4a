//! One value of the list.

use super::NEXT_PUSH;
use crate::work::next_push::{Field, NextPush};
use crate::work::parameters::Parameter;
use std::borrow::Cow;

/// A value that the user can edit.
#[derive(Clone, Debug, PartialEq)]
pub enum ListedValue {
    /// A value of the scenario.
    OfScenario(Box<Parameter>),
    /// A value of the push to come.
    OfNextPush {
        /// Which of its values.
        field: Field,
        /// The value as text.
        text: String,
    },
}

impl ListedValue {
    /// The values of `push`.
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

    /// Short name.
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

    /// Its unit, or empty.
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

    /// Whether each word of `name` is a part of its group, label or key. Capitals do not matter.
    pub(super) fn has(&self, name: &str) -> bool {
        let key = self.key().unwrap_or_default();
        let names = format!("{} {} {key}", self.group(), self.label()).to_lowercase();
        let name = name.to_lowercase();
        name.split_whitespace().all(|word| names.contains(word))
    }
}
