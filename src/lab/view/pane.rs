//! The parts of the screen, with their names in commands, `[view]` and sessions.

pub use crate::engine::scenario::screen::Pane;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HideablePart {
    Health,
    Predicted,
    /// The line about what to look at.
    LookAt,
    /// The arrows of the 3-D view.
    Arrows,
    #[serde(untagged)]
    Pane(Pane),
}

impl HideablePart {
    /// Returns true if it can reveal the answer to a question of a lesson.
    pub fn is_answer(self) -> bool {
        matches!(self, Self::Health | Self::Predicted)
    }
}
