//! The names of what the lab's screen shows, as `[view]` of a scenario and commands have them.

use crate::physics::workings::PHASE_NAMES;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::OnceLock;

/// The pane of the traces over time, and the figure of the same name.
pub const TRACES: &str = "traces";
/// The pane of the path from above, and its figure.
pub const ABOVE: &str = "above";
/// The pane of the scene in space, and its figure.
pub const THREE_D: &str = "3d";

/// A pane. Its id is the word for it in commands, in `[view]` and in sessions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pane {
    id: &'static str,
    /// Whether it is shown only where it is asked for; the others are shown where there is room.
    pub is_on_request: bool,
}

/// The panes that the rooms below `tui` name themselves.
const NAMED_PANES: [Pane; 6] = [
    Pane::LESSON,
    Pane::TRACES,
    Pane::FROM_ABOVE,
    Pane::THREE_D,
    Pane::PARAMETERS,
    Pane::STEP,
];

/// All panes of the screen: `tui` has their table.
static REGISTERED_PANES: OnceLock<&'static [Pane]> = OnceLock::new();

/// Says which panes the screen has. The program calls it before it reads a file.
pub fn set_panes(panes: &'static [Pane]) {
    let _ = REGISTERED_PANES.set(panes); // they are the same each time
}

pub fn panes() -> &'static [Pane] {
    REGISTERED_PANES.get().copied().unwrap_or(&NAMED_PANES)
}

impl Pane {
    /// x, y, z and tilt over time.
    pub const TRACES: Self = Self::called(TRACES);
    pub const FROM_ABOVE: Self = Self::called(ABOVE);
    /// The scene in space.
    pub const THREE_D: Self = Self::called(THREE_D);
    /// The scenario's values and the readouts.
    pub const PARAMETERS: Self = Self::called("parameters");
    /// One time step, phase by phase.
    pub const STEP: Self = Self::called("step").on_request();
    /// The page of a lesson. It is shown as long as there is one.
    pub const LESSON: Self = Self::called("lesson");

    pub const fn called(id: &'static str) -> Self {
        Self {
            id,
            is_on_request: false,
        }
    }

    pub const fn on_request(self) -> Self {
        Self {
            is_on_request: true,
            ..self
        }
    }

    pub const fn id(self) -> &'static str {
        self.id
    }

    /// The pane of that name in files and commands.
    pub fn named(id: &str) -> Option<Self> {
        panes().iter().copied().find(|pane| pane.id == id)
    }
}

impl Serialize for Pane {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.id.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Pane {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let id = String::deserialize(deserializer)?;
        Self::named(&id).ok_or_else(|| D::Error::custom(format!("there is no pane {id}")))
    }
}

/// What of the screen can be hidden besides panes: the line about the numbers' health, the numbers that theory predicts,
/// the line that says what there is to see.
pub const HIDEABLE: [&str; 3] = ["health", "predicted", "look_at"];

/// What the strip of the fast motion can show; auto: the tilt, or x where the tilt does not swing.
pub const DETAILS: [&str; 5] = [AUTO, "x", "y", "z", "tilt"];
pub const AUTO: &str = "auto";

/// The page of the step pane after those of the phases.
pub const WHY: &str = "why";
/// The last phase of a step, whatever it is called.
pub const LAST_PHASE: &str = "last";
pub const ALL_ROWS: &str = "all";

/// What the step pane can show besides a phase by its number.
pub const PHASES: [&str; PHASE_NAMES.len() + 2] = {
    let mut all = [LAST_PHASE; PHASE_NAMES.len() + 2];
    let mut at = 0;
    while at < PHASE_NAMES.len() {
        all[at] = PHASE_NAMES[at];
        at += 1;
    }
    all[PHASE_NAMES.len() + 1] = WHY;
    all
};
