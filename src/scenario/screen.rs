//! The names of what the lab's screen shows, as `[view]` of a scenario and commands have them.

/// The panes of the lab. The table of panes in `tui` has a row for each, in this order: the compiler compares the two.
pub const PANES: [&str; 5] = ["lesson", "traces", "above", "3d", "parameters"];

/// What of the lab's screen can be hidden: the panes, the line about the numbers' health, the numbers that theory
/// predicts, the line that says what there is to see.
pub const HIDEABLE: [&str; PANES.len() + 3] = panes_and(["health", "predicted", "look_at"]);

/// What can fill the screen.
pub const FILLING: [&str; PANES.len() + 1] = panes_and(["none"]);

/// The panes, and `others` after them; `ALL` is how many that makes.
const fn panes_and<const OTHERS: usize, const ALL: usize>(
    others: [&'static str; OTHERS],
) -> [&'static str; ALL] {
    let mut all = [""; ALL];
    let mut at = 0;
    while at < ALL {
        all[at] = if at < PANES.len() {
            PANES[at]
        } else {
            others[at - PANES.len()]
        };
        at += 1;
    }
    all
}
