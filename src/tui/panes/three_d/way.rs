//! The newest part of the path: it is joined to the point that draws it, whatever is in front, and a sign on it shows which
//! way the point goes.

use super::Subject;
use crate::playback::ages::Age;
use crate::tui::dots::{Dots, Ink};
use crate::tui::scene::Scene;
use crate::tui::theme::Role;
use crate::tui::trail;

/// Distances from the point, columns, a row counting as two: up to the first the path is drawn over everything, at the
/// second the sign stands.
const JOINED: f64 = 3.0;
const HEAD: f64 = 7.0;
/// Length of the stretch of path that gives the sign its direction, columns.
const STRETCH: f64 = 1.5;

/// A place on the sheet, dots across and down.
type Place = (f64, f64);

/// The newest part of the path on the sheet.
pub struct Way {
    /// From the point backwards.
    dots: Vec<Place>,
    /// The sign that shows where the point goes, if the path is long enough.
    pub head: Option<(&'static str, Role, (u16, u16))>,
}

impl Subject<'_> {
    /// The way on which the point has come.
    pub(super) fn way(&self, scene: &Scene) -> Way {
        let until = self.state.time_s;
        let [turn, recent] = [Age::Turn, Age::Recent].map(|age| self.ages.since(age, until));
        let blocks = self.seen.run.recording().since(turn);
        let blocks = blocks.filter(|block| block.end_s >= turn && block.end_s <= until);
        let blocks: Vec<_> = blocks.collect();
        let now = scene.dot(&self.position);
        let (across, down) = (
            scene.plane.in_cell.0 as f64,
            0.5 * scene.plane.in_cell.1 as f64,
        );
        let columns =
            |from: Place, to: Place| ((to.0 - from.0) / across).hypot((to.1 - from.1) / down);
        let (mut way, mut joined) = (vec![now], 0);
        let mut head = None;
        for block in blocks.iter().rev() {
            let at = scene.dot(&block.end());
            let longest = trail::longest_line(scene.plane.size, block.end_s >= recent);
            let last = way[way.len() - 1];
            let apart = (at.0 - last.0).abs().max((at.1 - last.1).abs());
            if apart.is_nan() || apart > longest {
                break; // the path has a gap here
            }
            way.push(at);
            joined += usize::from(joined + 2 == way.len() && columns(now, last) < JOINED);
            if columns(now, at) < HEAD {
                continue;
            }
            let mut newer = way.iter().rev();
            let newer = newer.find(|place| columns(at, **place) >= STRETCH);
            let to = newer.unwrap_or(&now);
            let direction = ((to.0 - at.0) / across, (to.1 - at.1) / down);
            let cell = scene.plane.cell_of(at);
            head = cell.map(|cell| (sign(direction), Role::Focus, cell));
            break;
        }
        way.truncate(joined + 1);
        Way { dots: way, head }
    }
}

/// The sign that points most nearly along `right`, `down`.
fn sign((right, down): Place) -> &'static str {
    match (right.abs() >= down.abs(), right >= 0.0, down >= 0.0) {
        (true, true, _) => "►",
        (true, false, _) => "◄",
        (false, _, true) => "▼",
        (false, _, false) => "▲",
    }
}

impl Way {
    /// Draws the part of it that nothing hides.
    pub fn join(&self, dots: &mut Dots) {
        for pair in self.dots.windows(2) {
            if let [from, to] = pair {
                dots.line(*from, *to, Ink::Strong(Role::Focus));
            }
        }
    }
}
