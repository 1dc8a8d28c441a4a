//! Where the traced point was measured to be, from above.

use super::{FromAbove, Plan};
use crate::measured::Place;
use crate::tui::points::{Ends, Points};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

impl FromAbove<'_> {
    /// The measured places; none where the columns of the data do not tell them.
    pub(super) fn places(&self) -> &[Place] {
        self.measured.map_or(&[], |beside| &beside.compared.places)
    }

    /// The measured places: those at times that the run has not reached are faint.
    pub(super) fn points(&self, plan: &Plan, picture: Rect, buf: &mut Buffer) {
        let now_s = self.run.now().time_s;
        let mut points = Points::new(picture, self.view.marker);
        for place in self.places() {
            let cell = |x: f64, y: f64| {
                let (column, row) = plan.dot(x, y);
                (column / plan.dots.0, row / plan.dots.1)
            };
            let (x, y) = (place.at.x, place.at.y);
            let level = |sigma: f64| -> Ends { (cell(x - sigma, y).0, cell(x + sigma, y).0) };
            let upright = |sigma: f64| -> Ends { (cell(x, y + sigma).1, cell(x, y - sigma).1) };
            let role = if place.time_s <= now_s {
                Role::Measured
            } else {
                Role::Quiet
            };
            let [of_x, of_y] = place.sigmas;
            points.add(cell(x, y), of_x.map(level), of_y.map(upright), role);
        }
        points.render(&self.view.theme, buf);
    }
}
