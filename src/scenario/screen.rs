//! The names of what the lab's screen shows, as `[view]` of a scenario and commands have them.

use crate::physics::workings::NAMES;

/// The pane of the traces over time, and the figure of the same name.
pub const TRACES: &str = "traces";
/// The pane of the path from above, and its figure.
pub const ABOVE: &str = "above";
/// The pane of the scene in space, and its figure.
pub const THREE_D: &str = "3d";

/// The panes of the lab. The table of panes in `tui` has a row for each, in this order: a test compares the two.
pub const PANES: [&str; 6] = ["lesson", TRACES, ABOVE, THREE_D, "parameters", "step"];

/// What of the lab's screen can be hidden: the panes, the line about the numbers' health, the numbers that theory
/// predicts, the line that says what there is to see.
pub const HIDEABLE: [&str; PANES.len() + 3] = joined(&PANES, &["health", "predicted", "look_at"]);

pub const FILLING: [&str; PANES.len() + 1] = joined(&PANES, &["none"]);

/// What the strip of the fast motion can show; auto: the tilt, or x where the tilt does not swing.
pub const DETAILS: [&str; 5] = [AUTO, "x", "y", "z", "tilt"];
pub const AUTO: &str = "auto";

/// The page of the step pane after those of the phases.
pub const WHY: &str = "why";
/// The last phase of a step, whatever it is called.
pub const LAST: &str = "last";
pub const ALL_ROWS: &str = "all";

/// What the step pane can show besides a phase by its number.
pub const PHASES: [&str; NAMES.len() + 2] = joined(&NAMES, &[LAST, WHY]);

/// The names in `first`, and then those in `others`; `ALL` is how many that makes.
const fn joined<const ALL: usize>(
    first: &[&'static str],
    others: &[&'static str],
) -> [&'static str; ALL] {
    let mut all = [""; ALL];
    let mut at = 0;
    while at < ALL {
        all[at] = if at < first.len() {
            first[at]
        } else {
            others[at - first.len()]
        };
        at += 1;
    }
    all
}
