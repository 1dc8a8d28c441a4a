//! The parts of the screen, by the names that commands, `[view]` and sessions have for them.

pub use crate::engine::scenario::screen::Pane;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HideablePart {
    Health,
    Predicted,
    /// The line that says what there is to see.
    LookAt,
    /// The arrows of the 3-D view.
    Arrows,
    #[serde(untagged)]
    Pane(Pane),
}

impl HideablePart {
    /// Returns whether it can answer a question of a lesson.
    pub fn is_answer(self) -> bool {
        matches!(self, Self::Health | Self::Predicted)
    }
}
