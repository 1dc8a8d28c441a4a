//! The pages of the step pane: the phases of the latest time step, and the explanation of the sideways motion.

use crate::engine::scenario::file::Choice;
use crate::engine::scenario::screen::{LAST_PHASE, WHY};
use crate::physics::Workings;
use crate::physics::workings::PhaseName;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(into = "Choice")]
pub enum StepPageChoice {
    /// The phase with this number, from 1, or the last one if there are fewer.
    Number(usize),
    /// The first phase with this name, or the first phase if none has it.
    Named(PhaseName),
    Last,
    /// Why the axle moves sideways, not down.
    Why,
}

impl Default for StepPageChoice {
    fn default() -> Self {
        Self::Number(1)
    }
}

impl<'de> Deserialize<'de> for StepPageChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Choice::deserialize(deserializer)? {
            Choice::Number(number) => Ok(Self::Number(number as usize)),
            Choice::Word(word) if word == LAST_PHASE => Ok(Self::Last),
            Choice::Word(word) if word == WHY => Ok(Self::Why),
            Choice::Word(word) => {
                let mut names = PhaseName::ALL.iter();
                let name = names.find(|name| name.text() == word);
                name.map(|name| Self::Named(*name))
                    .ok_or_else(|| D::Error::custom(format!("there is no phase {word}")))
            }
        }
    }
}

impl From<StepPageChoice> for Choice {
    fn from(page: StepPageChoice) -> Self {
        match page {
            StepPageChoice::Number(number) => Self::Number(number as u64),
            StepPageChoice::Named(name) => Self::Word(name.to_string()),
            StepPageChoice::Last => Self::Word(LAST_PHASE.to_owned()),
            StepPageChoice::Why => Self::Word(WHY.to_owned()),
        }
    }
}

impl StepPageChoice {
    /// Returns the index of its phase in `workings`; `None` for the page without a phase, and if there are no phases.
    pub fn index(self, workings: &Workings) -> Option<usize> {
        let last = workings.phases().count().checked_sub(1)?;
        match self {
            Self::Number(number) => Some(number.saturating_sub(1).min(last)),
            Self::Named(name) => {
                let found = workings.phases().position(|phase| phase.name == name);
                Some(found.unwrap_or(0))
            }
            Self::Last => Some(last),
            Self::Why => None,
        }
    }
}
