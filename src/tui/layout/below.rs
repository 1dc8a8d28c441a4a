//! The lines below the panes on a low screen.

/// On lower screens the lines below the panes take no more than leaves these so many rows, and a hint has as many lines at
/// most.
const ROWS_OF_PANES: u16 = 6;
const MOST_LINES: u16 = 3;

/// What the lines below the panes have to say: what there is to see, and whether the numbers are to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    /// Lines of the hint that stands there, on a screen of this width.
    pub lines: u16,
    /// Whether the numbers' health warns of something.
    pub warns: bool,
}

/// Lines of the hint on a screen of this `height` that is low, and whether the health of the numbers has one too, which it
/// has not where it is hidden.
pub(super) fn on_low_screen(said: Said, height: u16, hides_health: bool) -> (u16, bool) {
    let below = height.saturating_sub(2 + ROWS_OF_PANES);
    let lines = below.saturating_sub(said.warns.into());
    let lines = lines.min(MOST_LINES).min(said.lines).max(1);
    let has_health = said.warns || lines == 1;
    (lines, height >= 9 && has_health && !hides_health)
}
