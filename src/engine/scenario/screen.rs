//! The names of what the lab's screen shows, as `[view]` of a scenario and commands have them.

use crate::physics::workings::PhaseName;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The pane of the traces over time, and the figure of the same name.
pub const TRACES: &str = "traces";
/// The pane of the path from above, and its figure.
pub const ABOVE: &str = "above";
/// The pane of the scene in space, and its figure.
pub const THREE_D: &str = "3d";

/// Makes the enum of the panes, the list of all, and their ids from one table.
macro_rules! panes {
    ($($(#[$about:meta])* $name:ident = $id:expr,)*) => {
        /// A pane of the screen. Its id is the word for it in commands, in `[view]` and in sessions. `tui` has a row for each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Pane {
            $($(#[$about])* $name,)*
        }

        impl Pane {
            /// Every pane, from left to right on the screen; the focus goes through them in this order.
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
    /// The page of a lesson. It is shown as long as there is one.
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
    /// Whether it is shown only where it is asked for; the others are shown where there is room.
    pub const fn is_on_request(self) -> bool {
        matches!(self, Self::Step)
    }

    /// Returns the pane of that name in files and commands.
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

/// What of the screen can be hidden besides panes: the line about the numbers' health, the numbers that theory predicts,
/// the line that says what there is to see, the arrows of the 3-D view.
pub const HIDEABLE: [&str; 4] = ["health", "predicted", "look_at", "arrows"];

/// What the fourth strip of the traces can show: distance is how far the run is from the exact motion; auto is that, or the
/// tilt, if the screen is large; the others after it are columns of the run's CSV.
#[rustfmt::skip]
pub const DETAILS: [&str; 21] = [
    AUTO, "none", "x", "y", "z", "tilt", "distance",
    "Lx_Js", "Ly_Js", "Lz_Js", "wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s", "azimuth_deg", "energy_J",
    "spin_rpm", "L_axle_Js", "foot_force_N", "w1_rad_per_s", "w2_rad_per_s", "w3_rad_per_s",
];
pub const AUTO: &str = "auto";

/// The page of the step pane after those of the phases.
pub const WHY: &str = "why";
/// The last phase of a step, whatever it is called.
pub const LAST_PHASE: &str = "last";
pub const ALL_ROWS: &str = "all";

/// What the step pane can show besides a phase by its number.
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
