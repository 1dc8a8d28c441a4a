//! Which time a cell of the traces shows.

use super::Traces;
use ratatui::layout::{Margin, Position, Rect};

impl Traces<'_> {
    /// The time that the cell `at` of the screen shows where the traces are drawn on `area`, s; `None` beside the strips.
    pub fn time_s(&self, area: Rect, at: Position) -> Option<f64> {
        let inside = area.inner(Margin::new(1, 1));
        if !inside.contains(at) {
            return None;
        }
        let beside = self.beside(inside);
        let groups = self.groups(inside, beside);
        let group = groups.iter().find(|group| group.area.contains(at))?;
        let cell = (at.x - inside.x).checked_sub(beside)?;
        let across = self.view.marker.dots().0;
        Some(
            group
                .strip
                .time_s(cell as usize * across + (across - 1) / 2),
        )
    }
}
