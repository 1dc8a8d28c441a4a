//! Lines in space on a sheet of dots. What is nearer hides what is farther and leaves a gap beside it, so that one sees
//! which of two crossing lines passes in front of the other.

use crate::observe::camera::{Camera, View};
use crate::tui::dots::{Dots, Ink};
use nalgebra::Vector3;

/// A line hides what is farther than it by more than this part of the scene's reach: lines that meet do not hide each other.
const BEHIND: f64 = 0.05;
/// Half the angle of an arrow's head, radians.
const HEAD_ANGLE: f64 = 0.4;
/// Length of an arrow's head, of the scene's reach; at least so many dots, and at most this part of the arrow.
const HEAD: f64 = 0.07;
const LEAST_HEAD: f64 = 5.0;
const MOST_OF_ARROW: f64 = 0.6;
/// Strokes of a head to each side of its middle.
const HEAD_STROKES: i32 = 3;
/// An arrow that is seen as short as this, dots, has no head.
const SHORTEST: f64 = 4.0;
/// An arrow over another one, and a rod, are nearer than what lies along them by these parts of the scene's reach.
const OVER: f64 = 0.01;
const IN_FRONT: f64 = 0.15;
/// An arrow behind a rod is farther than it is by this part of the scene's reach.
const FARTHER: f64 = 0.5;
/// An arrow in front of everything is nearer than it is by this part of the scene's reach.
const FRONT: f64 = 10.0;

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Every dot, and those on both of its sides. What passes in front leaves no gap beside itself.
    Heavy,
    /// Every dot, and those beside them.
    Thick,
    Thin,
    /// One dot of so many. It hides nothing.
    Dotted(u32),
}

struct Speck {
    at: (f64, f64),
    depth: f64,
    ink: Ink,
    hides: bool,
    /// Whether what passes in front leaves a gap beside itself.
    is_parted: bool,
}

/// The camera's eye on a sheet of dots.
pub struct Scene {
    camera: View,
    /// Dots in a cell, across and down.
    pub in_cell: (usize, usize),
    /// Dots of the sheet, across and down.
    pub size: (usize, usize),
    /// What stands in the middle of the sheet, m to the right and up.
    middle: (f64, f64),
    /// Dots in a metre, across and down.
    pub scale: (f64, f64),
    reach: f64,
    specks: Vec<Speck>,
}

/// What a scene shows of the world.
pub struct Shown {
    /// What stands in the middle of the sheet, m to the right and up.
    pub middle: (f64, f64),
    /// How far that is to be seen to each side, and up and down, m.
    pub half: (f64, f64),
    /// The size of what is drawn, m.
    pub reach: f64,
}

impl Scene {
    /// An empty scene on the sheet of `dots`, as large as there is room for.
    pub fn new(dots: &Dots, camera: Camera, shown: &Shown) -> Self {
        let marker = dots.marker();
        let aspect = marker.dot_aspect();
        let size = (dots.width(), dots.height());
        let down =
            (0.5 * size.1 as f64 / shown.half.1).min(0.5 * size.0 as f64 * aspect / shown.half.0);
        Self {
            camera: camera.view(),
            in_cell: marker.dots(),
            size,
            middle: shown.middle,
            scale: (down / aspect, down),
            reach: shown.reach,
            specks: Vec::new(),
        }
    }

    /// Where `point` (world frame, m) is on the sheet.
    pub fn dot(&self, point: &Vector3<f64>) -> (f64, f64) {
        self.dot_at(self.camera.project(point))
    }

    fn dot_at(&self, (right, up): (f64, f64)) -> (f64, f64) {
        (
            0.5 * self.size.0 as f64 + (right - self.middle.0) * self.scale.0,
            0.5 * self.size.1 as f64 - (up - self.middle.1) * self.scale.1,
        )
    }

    /// The cell of `point`, or the one at the edge that is nearest to it.
    pub fn cell(&self, point: &Vector3<f64>) -> (u16, u16) {
        let (x, y) = self.dot(point);
        let inside = |dot: f64, dots: usize| dot.clamp(0.0, dots.saturating_sub(1) as f64);
        (
            (inside(x, self.size.0) / self.in_cell.0 as f64) as u16,
            (inside(y, self.size.1) / self.in_cell.1 as f64) as u16,
        )
    }

    /// The cell of the dot `at`, if it is on the sheet.
    pub fn cell_of(&self, at: (f64, f64)) -> Option<(u16, u16)> {
        let (x, y) = self.place(at)?;
        Some(((x / self.in_cell.0) as u16, (y / self.in_cell.1) as u16))
    }

    pub fn shows(&self, point: &Vector3<f64>) -> bool {
        let (x, y) = self.dot(point);
        (0.0..self.size.0 as f64).contains(&x) && (0.0..self.size.1 as f64).contains(&y)
    }

    pub fn line(&mut self, from: &Vector3<f64>, to: &Vector3<f64>, stroke: Stroke, ink: Ink) {
        let depths = (self.camera.depth(from), self.camera.depth(to));
        self.line_of_dots(
            (self.dot(from), depths.0),
            (self.dot(to), depths.1),
            stroke,
            ink,
        );
    }

    fn line_of_dots(
        &mut self,
        (from, near): ((f64, f64), f64),
        (to, far): ((f64, f64), f64),
        stroke: Stroke,
        ink: Ink,
    ) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.abs().max(dy.abs()).ceil();
        if length.is_nan() || length > 8.0 * (self.size.0 + self.size.1) as f64 {
            return; // nowhere near the sheet
        }
        let every = match stroke {
            Stroke::Dotted(every) => every.max(1),
            Stroke::Heavy | Stroke::Thick | Stroke::Thin => 1,
        };
        // Where a dot is as wide as a cell, the dot beside it makes a heavy line.
        let beside: &[f64] = match stroke {
            Stroke::Heavy if self.in_cell.0 > 1 => &[-1.0, 1.0],
            Stroke::Heavy | Stroke::Thick => &[1.0],
            Stroke::Thin | Stroke::Dotted(_) => &[],
        };
        let across = if dx.abs() > dy.abs() {
            (0.0, 1.0)
        } else {
            (1.0, 0.0)
        };
        for dot in (0..=length as u32).step_by(every as usize) {
            let share = f64::from(dot) / length.max(1.0);
            let at = (from.0 + share * dx, from.1 + share * dy);
            let depth = near + share * (far - near);
            let hides = every == 1;
            let mut speck = |at| {
                self.specks.push(Speck {
                    at,
                    depth,
                    ink,
                    hides,
                    is_parted: stroke != Stroke::Heavy,
                });
            };
            speck(at);
            for side in beside {
                speck((at.0 + side * across.0, at.1 + side * across.1));
            }
        }
    }

    /// A closed line through `points`; the stroke of each part goes by the depth of its middle.
    pub fn ring(&mut self, points: &[Vector3<f64>], look: impl Fn(f64) -> (Stroke, Ink)) {
        for (index, from) in points.iter().enumerate() {
            let to = &points[(index + 1) % points.len()];
            let (stroke, ink) = look(self.camera.depth(&((from + to) * 0.5)));
            self.line(from, to, stroke, ink);
        }
    }

    /// How far from the eye `point` is, m.
    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        self.camera.depth(point)
    }

    /// A line with a filled head at its tip, which is seen on a small sheet too.
    pub fn arrow(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink) {
        self.arrow_nearer(from, tip, ink, 0.0);
    }

    /// As [`arrow`](Self::arrow), over another arrow that lies along it.
    pub fn arrow_over(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink) {
        self.arrow_nearer(from, tip, ink, OVER * self.reach);
    }

    /// As [`arrow`](Self::arrow), behind a rod that is nearly as near.
    pub fn arrow_behind(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink) {
        self.arrow_nearer(from, tip, ink, -FARTHER * self.reach);
    }

    /// As [`arrow`](Self::arrow), in front of everything but the arrows of this kind that are nearer: nothing hides a part
    /// of it.
    pub fn arrow_in_front(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink) {
        self.arrow_nearer(from, tip, ink, FRONT * self.reach);
    }

    /// An arrow that counts as nearer to the eye than it is by `nearer`, m.
    fn arrow_nearer(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink, nearer: f64) {
        let end = |point| (self.dot(point), self.camera.depth(point) - nearer);
        let ends = (end(from), end(tip));
        self.line_of_dots(ends.0, ends.1, Stroke::Thin, ink);
        let ((begin, _), (end, depth)) = ends;
        let (x, y) = (begin.0 - end.0, begin.1 - end.1);
        let length = x.hypot(y);
        if length < SHORTEST {
            return; // seen along itself, it has no head
        }
        let head = (HEAD * self.reach * self.scale.1).max(LEAST_HEAD);
        let share = head.min(MOST_OF_ARROW * length) / length;
        for part in -HEAD_STROKES..=HEAD_STROKES {
            let angle = HEAD_ANGLE * f64::from(part) / f64::from(HEAD_STROKES);
            let (sin, cos) = angle.sin_cos();
            let stroke = (x * cos - y * sin, x * sin + y * cos);
            let stroke_end = (end.0 + share * stroke.0, end.1 + share * stroke.1);
            self.line_of_dots((end, depth), (stroke_end, depth), Stroke::Thin, ink);
        }
    }

    /// A place beyond the tip of an arrow, for its letter: far enough not to cover the head.
    pub fn beyond(&self, from: &Vector3<f64>, tip: &Vector3<f64>) -> Vector3<f64> {
        let (begin, end) = (self.dot(from), self.dot(tip));
        let length = (end.0 - begin.0).hypot(end.1 - begin.1);
        if length < SHORTEST {
            *tip
        } else {
            tip + (tip - from) * (self.in_cell.1 as f64 / length)
        }
    }

    /// A place two columns beside `tip` on the side that `direction` does not point to, for the letter of an arrow beyond
    /// whose tip there is something else.
    pub fn beside(&self, tip: &Vector3<f64>, direction: &Vector3<f64>) -> Vector3<f64> {
        let right = self.camera.right();
        let side = if right.dot(direction) > 0.0 {
            -2.0
        } else {
            2.0
        };
        tip + right * (side * self.in_cell.0 as f64 / self.scale.0)
    }

    /// A heavy line that is in front of what lies along it: arrows along the axle do not cover it. What crosses it in front
    /// leaves no gap in it, so that it is seen as one line.
    pub fn rod(&mut self, from: &Vector3<f64>, to: &Vector3<f64>, ink: Ink) {
        let nearer = |point| self.camera.depth(point) - IN_FRONT * self.reach;
        let ends = ((self.dot(from), nearer(from)), (self.dot(to), nearer(to)));
        self.line_of_dots(ends.0, ends.1, Stroke::Heavy, ink);
    }

    fn place(&self, (x, y): (f64, f64)) -> Option<(usize, usize)> {
        let inside = x >= 0.0 && y >= 0.0 && x < self.size.0 as f64 && y < self.size.1 as f64;
        inside.then_some((x as usize, y as usize))
    }

    /// Sets the dots that are to be seen, and takes away those beside and behind them that were set before: in a cell with a
    /// strong line all of them, as a cell has one colour.
    pub fn draw(mut self, dots: &mut Dots) {
        let (width, height) = self.size;
        let mut nearest = vec![f64::INFINITY; width * height];
        let mut at_dot = nearest.clone();
        for speck in self.specks.iter().filter(|speck| speck.hides) {
            let Some((x, y)) = self.place(speck.at) else {
                continue;
            };
            if matches!(speck.ink, Ink::Strong(_)) {
                dots.clear_cell(x, y);
            }
            let at_dot = &mut at_dot[y * width + x];
            *at_dot = at_dot.min(speck.depth);
            for y in y.saturating_sub(1)..(y + 2).min(height) {
                for x in x.saturating_sub(1)..(x + 2).min(width) {
                    let nearest = &mut nearest[y * width + x];
                    *nearest = nearest.min(speck.depth);
                }
            }
        }
        for (place, _) in nearest
            .iter()
            .enumerate()
            .filter(|(_, depth)| depth.is_finite())
        {
            dots.clear(place % width, place / width);
        }
        // The nearest last: it decides how a cell looks that several lines cross.
        self.specks.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        for speck in &self.specks {
            let nearest = if speck.is_parted { &nearest } else { &at_dot };
            let is_seen = self
                .place(speck.at)
                .is_some_and(|(x, y)| speck.depth <= nearest[y * width + x] + BEHIND * self.reach);
            if is_seen {
                dots.set(speck.at.0, speck.at.1, speck.ink);
            }
        }
    }
}

#[cfg(test)]
mod tests;
