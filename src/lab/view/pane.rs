//! The panes and the other parts of the screen, by the names that commands, `[view]` and sessions have for them.

use crate::scenario::screen::{self, PANES};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// A pane, by its id: the word for it in commands, in `[view]` and in sessions. `tui` has the table of all panes. The
/// constants here are the panes that the lab itself needs to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Pane(&'static str);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    Health,
    Predicted,
    /// The line that says what there is to see.
    LookAt,
    #[serde(untagged)]
    Pane(Pane),
}

impl Pane {
    /// x, y, z and tilt over time.
    pub const TRACES: Self = Self::called(screen::TRACES);
    pub const FROM_ABOVE: Self = Self::called(screen::ABOVE);
    /// The scene in space.
    pub const THREE_D: Self = Self::called(screen::THREE_D);
    /// The scenario's values and the readouts.
    pub const PARAMETERS: Self = Self::called("parameters");
    /// One time step, phase by phase. It is shown where it is asked for.
    pub const STEP: Self = Self::called("step");
    /// The page of a lesson. It is shown as long as there is one.
    pub const LESSON: Self = Self::called("lesson");

    /// The pane of an id that is one of [`PANES`].
    pub const fn called(id: &'static str) -> Self {
        Self(id)
    }

    pub const fn id(self) -> &'static str {
        self.0
    }

    /// The pane of that name in files and commands.
    pub fn named(id: &str) -> Option<Self> {
        PANES.into_iter().find(|pane| *pane == id).map(Self)
    }
}

impl<'de> Deserialize<'de> for Pane {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let id = String::deserialize(deserializer)?;
        Self::named(&id).ok_or_else(|| D::Error::custom(format!("there is no pane {id}")))
    }
}
