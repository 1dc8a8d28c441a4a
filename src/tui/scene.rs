//! Lines in space on a sheet of dots. What is nearer hides what is farther and leaves a gap beside it, so that one sees
//! which of two crossing lines passes in front of the other.

use crate::lab::view::theme::Marker;
use crate::plot::camera::{Camera, CameraView};
use crate::tui::dots::{self, Dots, Ink};
use crate::tui::plane::Plane;
use nalgebra::Vector3;
use ratatui::layout::Rect;

/// A line hides what lies behind it by more than this part of the scene's reach: lines that meet do not hide each other.
const BEHIND: f64 = 0.05;
/// Half the angle of an arrow's head, radians.
const HEAD_ANGLE: f64 = 0.4;
/// Length of an arrow's head: this part of the scene's reach, at least these dots, at most this part of the arrow.
const ARROW_HEAD: f64 = 0.07;
const LEAST_HEAD: f64 = 5.0;
const MOST_OF_ARROW: f64 = 0.6;
/// Strokes of a head to each side of its middle.
const HEAD_STROKES: i32 = 3;
/// An arrow that is seen as short as this, dots, has no head.
const SHORTEST: f64 = 4.0;
/// A rod is nearer than what lies along it by this part of the scene's reach.
const IN_FRONT: f64 = 0.15;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStroke {
    /// Every dot, and those on both of its sides. What passes in front leaves no gap beside itself.
    Heavy,
    /// Every dot, and those beside them.
    Thick,
    Thin,
    /// Every n-th dot. It hides nothing.
    Dotted(u32),
}

struct Dot {
    at: (f64, f64),
    depth: f64,
    ink: Ink,
    hides: bool,
    /// Whether what passes in front leaves a gap beside itself.
    is_parted: bool,
}

/// What an arrow is drawn over, where it is not seen as near as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthBias {
    Farther,
    Arrow,
    /// Everything but what is farther than a rod that is nearly as near.
    BehindRod,
    /// Everything but the arrows of this kind that are nearer: nothing hides a part of it.
    Everything,
}

impl DepthBias {
    /// What is taken off the depth of an arrow, of the scene's reach.
    fn nearer(self) -> f64 {
        match self {
            Self::Farther => 0.0,
            Self::Arrow => 0.01,
            Self::BehindRod => -0.5,
            Self::Everything => 10.0,
        }
    }
}

/// The camera's eye on a sheet of dots.
pub struct DotScene {
    camera: CameraView,
    pub plane: Plane,
    reach: f64,
    specks: Vec<Dot>,
}

pub struct VisibleArea {
    /// What stands in the middle of the sheet, m to the right and up.
    pub middle: (f64, f64),
    /// How far that is to be seen to each side, and up and down, m.
    pub half: (f64, f64),
    /// The size of what is drawn, m.
    pub reach: f64,
}

impl DotScene {
    /// An empty scene on `area`, as large as there is room for.
    pub fn new(area: Rect, marker: Marker, camera: Camera, shown: &VisibleArea) -> Self {
        Self {
            camera: camera.view(),
            plane: Plane::new(area, marker, shown.middle, shown.half),
            reach: shown.reach,
            specks: Vec::new(),
        }
    }

    /// Where `point` (world frame, m) is on the sheet.
    pub fn dot(&self, point: &Vector3<f64>) -> (f64, f64) {
        self.plane.dot(self.camera.project(point))
    }

    /// The cell of `point`, or the one at the edge that is nearest to it.
    pub fn cell(&self, point: &Vector3<f64>) -> (u16, u16) {
        self.plane.cell(self.camera.project(point))
    }

    pub fn shows(&self, point: &Vector3<f64>) -> bool {
        self.plane.shows(self.camera.project(point))
    }

    pub fn line(&mut self, from: &Vector3<f64>, to: &Vector3<f64>, stroke: LineStroke, ink: Ink) {
        self.line_of_dots(self.ends(from, to, 0.0), stroke, ink);
    }

    /// The dots of the ends of a line, with their depths less `nearer` (of the scene's reach).
    fn ends(&self, from: &Vector3<f64>, to: &Vector3<f64>, nearer: f64) -> [((f64, f64), f64); 2] {
        [from, to].map(|end| (self.dot(end), self.camera.depth(end) - nearer * self.reach))
    }

    fn line_of_dots(&mut self, ends: [((f64, f64), f64); 2], stroke: LineStroke, ink: Ink) {
        let [(from, near), (to, far)] = ends;
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let every = match stroke {
            LineStroke::Dotted(every) => every.max(1),
            LineStroke::Heavy | LineStroke::Thick | LineStroke::Thin => 1,
        };
        // Where a dot is as wide as a cell, the dot beside it makes a heavy line.
        let beside: &[f64] = match stroke {
            LineStroke::Heavy if self.plane.in_cell.0 > 1 => &[0.0, -1.0, 1.0],
            LineStroke::Heavy | LineStroke::Thick => &[0.0, 1.0],
            LineStroke::Thin | LineStroke::Dotted(_) => &[0.0],
        };
        let across = if dx.abs() > dy.abs() {
            (0.0, 1.0)
        } else {
            (1.0, 0.0)
        };
        for (share, at) in dots::line(from, to, self.plane.size).step_by(every as usize) {
            self.specks.extend(beside.iter().map(|side| Dot {
                at: (at.0 + side * across.0, at.1 + side * across.1),
                depth: near + share * (far - near),
                ink,
                hides: every == 1,
                is_parted: stroke != LineStroke::Heavy,
            }));
        }
    }

    /// A closed line through `points`; the stroke of each part goes by the depth of its middle.
    pub fn ring(&mut self, points: &[Vector3<f64>], look: impl Fn(f64) -> (LineStroke, Ink)) {
        for (index, from) in points.iter().enumerate() {
            let to = &points[(index + 1) % points.len()];
            let (stroke, ink) = look(self.camera.depth(&((from + to) * 0.5)));
            self.line(from, to, stroke, ink);
        }
    }

    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        self.camera.depth(point)
    }

    /// A line with a filled head at its tip, which is seen on a small sheet too.
    pub fn arrow(&mut self, from: &Vector3<f64>, tip: &Vector3<f64>, ink: Ink, over: DepthBias) {
        let ends = self.ends(from, tip, over.nearer());
        self.line_of_dots(ends, LineStroke::Thin, ink);
        let [(begin, _), (end, depth)] = ends;
        let (x, y) = (begin.0 - end.0, begin.1 - end.1);
        let length = libm::hypot(x, y);
        if length < SHORTEST {
            return; // seen along itself, it has no head
        }
        let head = (ARROW_HEAD * self.reach * self.plane.scale.1).max(LEAST_HEAD);
        let share = head.min(MOST_OF_ARROW * length) / length;
        for part in -HEAD_STROKES..=HEAD_STROKES {
            let angle = HEAD_ANGLE * f64::from(part) / f64::from(HEAD_STROKES);
            let (sin, cos) = libm::sincos(angle);
            let stroke = (x * cos - y * sin, x * sin + y * cos);
            let stroke_end = (end.0 + share * stroke.0, end.1 + share * stroke.1);
            self.line_of_dots([(end, depth), (stroke_end, depth)], LineStroke::Thin, ink);
        }
    }

    /// A place beyond the tip of an arrow, for its letter: far enough not to cover the head.
    pub fn beyond(&self, from: &Vector3<f64>, tip: &Vector3<f64>) -> Vector3<f64> {
        let (begin, end) = (self.dot(from), self.dot(tip));
        let length = libm::hypot(end.0 - begin.0, end.1 - begin.1);
        if length < SHORTEST {
            *tip
        } else {
            tip + (tip - from) * (self.plane.in_cell.1 as f64 / length)
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
        tip + right * (side * self.plane.in_cell.0 as f64 / self.plane.scale.0)
    }

    /// A heavy line that is in front of what lies along it: arrows along the axle do not cover it. What crosses it in front
    /// leaves no gap in it, so that it is seen as one line.
    pub fn rod(&mut self, from: &Vector3<f64>, to: &Vector3<f64>, ink: Ink) {
        self.line_of_dots(self.ends(from, to, IN_FRONT), LineStroke::Heavy, ink);
    }

    /// Sets the dots that are to be seen, and takes away those beside and behind them that were set before: in a cell with a
    /// strong line all of them, as a cell has one colour.
    pub fn draw(mut self, dots: &mut Dots) {
        let (width, height) = self.plane.size;
        let mut nearest = vec![f64::INFINITY; width * height];
        let mut at_dot = nearest.clone();
        for speck in self.specks.iter().filter(|speck| speck.hides) {
            let Some((x, y)) = self.plane.place(speck.at) else {
                continue;
            };
            if matches!(speck.ink, Ink::Strong(_)) {
                dots.clear_cell(x, y);
            }
            let depth = &mut at_dot[y * width + x];
            *depth = depth.min(speck.depth);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let nearest_depth = &mut nearest[row * width + column];
                    *nearest_depth = nearest_depth.min(speck.depth);
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
            let place = self.plane.place(speck.at).map(|(x, y)| y * width + x);
            let is_seen = place.is_some_and(|at| speck.depth <= nearest[at] + BEHIND * self.reach);
            if is_seen {
                dots.set(speck.at.0, speck.at.1, speck.ink);
            }
        }
    }
}
