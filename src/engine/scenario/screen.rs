//! Names of the parts of the lab's screen, as used in `[view]` of a scenario and in commands.

use crate::physics::workings::PhaseName;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Id of the pane with the traces over time, and of its figure.
pub const TRACES: &str = "traces";
/// Id of the pane with the path from above, and of its figure.
pub const ABOVE: &str = "above";
/// Id of the pane with the scene in space, and of its figure.
pub const THREE_D: &str = "3d";

/// Makes the enum of panes, the list of all panes, and their ids from one table.
macro_rules! panes {
    ($($(#[$about:meta])* $name:ident = $id:expr,)*) => {
        /// A pane of the screen. Its id names it in commands, in `[view]` and in sessions. `tui` has a row for each
        /// pane.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Pane {
            $($(#[$about])* $name,)*
        }

        impl Pane {
            /// All panes, from left to right on the screen. The focus moves in this order.
            pub const ALL: [Self; [$($id),*].len()] = [$(Self::$name),*];

            pub const fn id(self) -> &'static str {
                match self {
                    $(Self::$name => $id,)*
                }
            }
        }
    };
}

panes! {
    /// The page of a lesson, shown while a lesson is open.
    Lesson = "lesson",
    /// x, y, z and tilt over time.
    Traces = TRACES,
    /// The path from above.
    Above = ABOVE,
    /// The scene in space.
    ThreeD = THREE_D,
    /// The scenario's values and the readouts.
    Parameters = "parameters",
    /// One time step, phase by phase.
    Step = "step",
}

impl Pane {
    /// Returns true if the pane is shown only on request. The others are shown if there is room.
    pub const fn is_on_request(self) -> bool {
        matches!(self, Self::Step)
    }

    /// Returns the pane with this id in files and commands.
    pub fn named(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|pane| pane.id() == id)
    }
}

impl Serialize for Pane {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.id().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Pane {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let id = String::deserialize(deserializer)?;
        Self::named(&id).ok_or_else(|| D::Error::custom(format!("there is no pane {id}")))
    }
}

/// Parts of the screen that can be hidden in addition to panes: the line about reliability, the predicted numbers, the
/// line `look_at`, and the arrows of the 3-D view.
pub const HIDEABLE: [&str; 4] = ["health", "predicted", "look_at", "arrows"];

/// Choices for the fourth strip of the traces. `distance` is the distance from the exact motion. `auto` is the
/// distance, or the tilt, if the screen is large. The names with a unit are columns of the run's CSV.
#[rustfmt::skip]
pub const DETAILS: [&str; 21] = [
    AUTO, "none", "x", "y", "z", "tilt", "distance",
    "Lx_Js", "Ly_Js", "Lz_Js", "wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s", "azimuth_deg", "energy_J",
    "spin_rpm", "L_axle_Js", "foot_force_N", "w1_rad_per_s", "w2_rad_per_s", "w3_rad_per_s",
];
pub const AUTO: &str = "auto";

/// Page of the step pane after the phases.
pub const WHY: &str = "why";
/// The last phase of a step, whatever its name.
pub const LAST_PHASE: &str = "last";
pub const ALL_ROWS: &str = "all";

/// Choices for the step pane in addition to the number of a phase.
pub const PHASES: [&str; PhaseName::ALL.len() + 2] = {
    let mut all = [LAST_PHASE; PhaseName::ALL.len() + 2];
    let mut at = 0;
    while at < PhaseName::ALL.len() {
        all[at] = PhaseName::ALL[at].text();
        at += 1;
    }
    all[PhaseName::ALL.len() + 1] = WHY;
    all
};
