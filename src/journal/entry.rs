//! One act of the user, and the step at which it was done.

use crate::scenario::file::PushFile;
use crate::scenario::keys::Effect;
use crate::text::printable::brief;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// The most characters of a value that a message shows.
const LONGEST_VALUE: usize = 30;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    pub step: u64,
    /// Whether the entry is an edit that the opened file contained.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) from_file: bool,
    /// Whether it is one more nudge of the same value: undo takes it back together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) is_chained: bool,
    /// What the user did. It must stay the last field: TOML writes it as a table, and the serializer of `toml` moves the
    /// whole text that follows for each value that it meets after a table.
    pub act: Act,
}

/// What can be done to a run without beginning a new one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    Push(PushFile),
    /// Sets keys of `motion` or `push`, with effect from the next step on.
    Edit(Table),
    /// Sets keys on which no number of the run depends: title, number of steps, `[view]`.
    Describe(Table),
}

impl Act {
    /// Sets `key` to `value`: a [`Describe`](Self::Describe) where the key has no effect on the numbers, else an
    /// [`Edit`](Self::Edit).
    pub fn set(key: &str, value: Value) -> Self {
        let set = Table::from_iter([(key.to_owned(), value)]);
        match Effect::of(key) {
            Effect::None => Self::Describe(set),
            Effect::FromHere | Effect::NewRun => Self::Edit(set),
        }
    }

    pub fn in_words(&self) -> String {
        match self {
            Self::Push(push) => format!("the push on {}", push.point),
            Self::Edit(set) | Self::Describe(set) => {
                let words = set.iter().map(|(key, value)| {
                    format!("{key} = {}", brief(&value.to_string(), LONGEST_VALUE))
                });
                words.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

impl Entry {
    /// Whether it has its effect later than an act done at `step` would. A description belongs to no step.
    pub(super) fn is_later_than(&self, step: u64) -> bool {
        self.step > step && !self.is_description()
    }

    /// Whether it drops older entries that stand at later steps. Edits of the opened file do not: they stand beside each
    /// other in any order.
    pub(super) fn drops_later_steps(&self) -> bool {
        !self.from_file && !self.is_description()
    }

    /// Whether no number of the run depends on it.
    pub(super) fn is_description(&self) -> bool {
        matches!(self.act, Act::Describe(_))
    }
}
