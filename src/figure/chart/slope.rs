//! The triangle that shows a slope between two logarithmic axes.

use super::Panel;
use super::axis::Scale;
use super::layout::Placed;
use crate::figure::page::ink::{self, Frame, LABEL_PT, at, grey, pen};
use crate::figure::page::scene::{Path, Point, Scene};
use crate::text::number::significant;

/// Lengths of the triangle that are tried, of the panel's width.
const LENGTHS: [f64; 4] = [0.24, 0.18, 0.13, 0.09];
/// Places that are tried along each side of the panel.
const PLACES: usize = 24;
const FREE: f64 = 5.0;
/// Lowest and highest triangle that is drawn, pt.
const HEIGHTS: (f64, f64) = (5.0, 0.6);

/// A triangle in its place: its right angle is at the lower right, or at the upper left for a falling line.
struct Triangle {
    left: Point,
    right: Point,
    slope: f64,
}

/// Draws the triangle of the panel's slope where no curve is, and nothing of `taken`; where there is no such place, none.
pub fn draw(panel: &Panel, placed: &Placed, taken: Option<&Frame>, scene: &mut Scene) {
    let Some(slope) = panel.slope.filter(|slope| slope.is_finite()) else {
        return;
    };
    let inside = placed.frame.grown(-FREE);
    let is_free = |triangle: &Triangle| {
        let around = triangle.frame().grown(FREE);
        around.corners().iter().all(|corner| inside.holds(*corner))
            && taken.is_none_or(|taken| !taken.meets(&around))
            && placed.is_clear(&around, panel)
    };
    let mut triangles = LENGTHS
        .iter()
        .flat_map(|length| triangles(placed, slope, *length));
    if let Some(triangle) = triangles.find(is_free) {
        triangle.draw(scene);
    }
}

/// The triangles of that slope and that part of the panel's width, from below at the right, where curves of errors leave room.
fn triangles(placed: &Placed, slope: f64, length: f64) -> impl Iterator<Item = Triangle> {
    let frame = placed.frame;
    let width = length * frame.width();
    // As steep as the line: the axes' decades may differ in length.
    let decade = |scale: &Scale| {
        (scale.places.1 - scale.places.0).abs() / libm::log(scale.range.1 / scale.range.0)
    };
    let height = slope * width * decade(&placed.y) / decade(&placed.x);
    let is_drawn = (HEIGHTS.0..=HEIGHTS.1 * frame.height()).contains(&height.abs());
    let steps = || (0..PLACES).map(|step| (step as f64 + 0.5) / PLACES as f64);
    let places = steps().flat_map(move |down| steps().map(move |across| (down, across)));
    places.filter(move |_| is_drawn).map(move |(down, across)| {
        let left = at(
            frame.left + across * (frame.width() - width),
            frame.bottom - down * (frame.height() - height.abs()) - height.min(0.0).abs(),
        );
        Triangle {
            left,
            right: at(left.x + width, left.y - height),
            slope,
        }
    })
}

impl Triangle {
    fn corner(&self) -> Point {
        at(self.right.x, self.left.y)
    }

    fn name(&self) -> String {
        super::ticks::with_minus(&significant(self.slope, 2))
    }

    fn frame(&self) -> Frame {
        let label = ink::height(LABEL_PT) + 2.0;
        let (top, bottom) = (self.left.y.min(self.right.y), self.left.y.max(self.right.y));
        let is_rising = self.slope > 0.0;
        Frame {
            left: self.left.x,
            right: self.right.x + 2.5 + ink::width(&self.name(), LABEL_PT),
            top: if is_rising { top } else { top - label },
            bottom: if is_rising { bottom + label } else { bottom },
        }
    }

    fn draw(&self, scene: &mut Scene) {
        let (corner, label) = (self.corner(), ink::height(LABEL_PT));
        let outline = Path::polygon([self.left, corner, self.right]);
        scene.stroke(outline, pen(0.5, grey(90)), None);
        let base = if self.slope > 0.0 {
            corner.y + 2.0 + label
        } else {
            corner.y - 2.0
        };
        let middle = 0.5 * (self.left.x + self.right.x);
        scene.write("1", LABEL_PT, at(middle, base), 0.5);
        let beside = at(corner.x + 2.5, 0.5 * (self.left.y + self.right.y + label));
        scene.write(&self.name(), LABEL_PT, beside, 0.0);
    }
}
