//! The figure of paths in space: a box with grids on its far sides, axes along its near edges, and the paths with their
//! shadows on the floor. Width and gray level of the lines show the depth.
//!
//! x and y have the same scale; z has its own, since a swing is often small compared with the precession.

mod path;

use super::chords;
use super::dense;
use super::job::{Dense, FigureJob, FigureRun, SampledRunNumbers};
use super::quantity;
use super::size;
use crate::engine::text::number::significant;
use crate::plot::camera::{Camera, CameraView};
use crate::plot::chart::layout::PAGE_EDGE;
use crate::plot::chart::legend::Legend;
use crate::plot::chart::ticks::{Tick, Ticks};
use crate::plot::chart::{ChartAxis, SeriesStyle};
use crate::plot::ink::{self, BLACK, LABEL_PT, TITLE_PT, at, grey, pen};
use crate::plot::scene::{Color, PageScene, Point, StrokeStyle, TextAnchor};
use nalgebra::Vector3;

/// Height of the box, relative to its sides.
const TALL: f64 = 0.72;
/// Distance of the eye from the center of the box, relative to its sides.
const EYE: f64 = 5.0;
/// Minimum and maximum elevation of the eye at which both floor and walls are visible, degrees.
const PITCHES_DEG: (f64, f64) = (8.0, 65.0);
/// Length of a tick, and the gap between a tick and its label, pt.
const SPACE_TICK_LENGTH: f64 = 2.5;
const TICK_GAP: f64 = 2.2;
/// Gap between labels and title, pt.
const SPACE_TITLE_GAP: f64 = 3.0;

/// Minimum stretch factor of z that the legend mentions.
const STATED_STRETCH: f64 = 1.1;

/// Lengths of the box's sides.
const SIZES: [f64; 3] = [1.0, 1.0, TALL];

struct Space {
    view: CameraView,
    /// Ranges of the three axes.
    ranges: [(f64, f64); 3],
    side_pt: f64,
    decimal_comma: bool,
}

/// Draws the figure of paths in space. If a path is too dense, also returns a time range in which it is not.
pub(super) fn scene(
    job: &FigureJob<'_>,
    drawn: &[SampledRunNumbers],
) -> (PageScene, Option<Dense>) {
    let width_pt = job.spec.page_width_pt();
    let space = Space::fitted(job, drawn);
    let (names, styles): (Vec<_>, Vec<_>) = drawn
        .iter()
        .map(|drawn| chords::as_drawn(drawn, &drawn.course.path))
        .unzip();
    let series = names.iter().map(String::as_str).zip(&styles);
    let legend = Legend::new(series, space.stretched());
    let mut items = space.draw(drawn, &styles);
    let (left, top, right, bottom) = extent(&items);
    let top_edge = legend.height_above(width_pt) + PAGE_EDGE;
    let shift = at(0.5 * (width_pt - left - right), top_edge - top);
    for item in &mut items.items {
        *item = item.clone().mapped(|p| at(p.x + shift.x, p.y + shift.y));
    }
    items.title = job.title();
    items.width_pt = width_pt;
    items.height_pt = top_edge + bottom - top + PAGE_EDGE;
    legend.draw_above(width_pt, PAGE_EDGE, &mut items);
    let dense = dense::of_paths(
        drawn,
        job.spec,
        |course| &course.path,
        |at| space.place(&space.boxed(at)),
    );
    (items, dense)
}

/// Returns the camera in the first run's file, or the default one. The elevation is limited so that no side of the box
/// disappears.
fn camera(runs: &[FigureRun]) -> Camera {
    let file = runs
        .first()
        .and_then(|run| run.scenario.file.viewed("camera"));
    let camera = file.and_then(|camera| camera.clone().try_into().ok());
    let camera: Camera = camera.unwrap_or_default();
    Camera {
        yaw_deg: camera.yaw_deg,
        pitch_deg: camera.pitch_deg.clamp(PITCHES_DEG.0, PITCHES_DEG.1),
    }
}

fn ranges(drawn: &[SampledRunNumbers], size: &ChartAxis) -> [(f64, f64); 3] {
    let [x, y, z] = [0, 1, 2].map(|index| {
        let paths = drawn.iter().flat_map(|drawn| &drawn.course.path.points);
        size.range_of(paths.map(|point| point[index]))
    });
    let half = 0.5 * (x.1 - x.0).max(y.1 - y.0);
    let [x, y] = [x, y].map(|(low, high)| {
        let middle = 0.5 * (low + high);
        (middle - half, middle + half)
    });
    [x, y, z]
}

/// Returns the bounding box of the scene, pt: left, top, right, bottom.
fn extent(scene: &PageScene) -> (f64, f64, f64, f64) {
    let sides: [fn(Point) -> f64; 2] = [|p| p.x, |p| p.y];
    let [(left, right), (top, bottom)] = sides.map(|side| {
        let points = scene.items.iter().flat_map(|item| item.path.points());
        crate::plot::extent(points.map(side)).unwrap_or_default()
    });
    (left, top, right, bottom)
}

impl Space {
    /// Creates the space, scaled so that box and labels are as wide as the page.
    fn fitted(job: &FigureJob<'_>, drawn: &[SampledRunNumbers]) -> Self {
        let (runs, width_pt) = (job.runs, job.spec.page_width_pt());
        let mut space = Self {
            view: camera(runs).view(),
            ranges: ranges(drawn, &size::axis(runs, "z_m")),
            side_pt: 0.5 * width_pt,
            decimal_comma: job.spec.decimal_comma,
        };
        // The labels do not grow with the box, so its size is adjusted to the remaining width. The paths are always
        // inside the box.
        for _ in 0..4 {
            let (left, _, right, _) = extent(&space.draw(&[], &[]));
            let over = right - left - (width_pt - 2.0 * PAGE_EDGE);
            space.side_pt = (space.side_pt - over / 1.45).max(0.1 * width_pt);
            if over.abs() < 0.2 {
                break;
            }
        }
        space
    }

    /// Returns a remark, as markup, if z has another scale than x and y.
    fn stretched(&self) -> Option<String> {
        let [x, _, z] = self.ranges.map(|(low, high)| high - low);
        let factor = TALL * x / z;
        if factor >= STATED_STRETCH {
            return Some(format!("*z* stretched {}-fold", significant(factor, 2)));
        }
        let is_shorter = factor.recip() >= STATED_STRETCH;
        is_shorter.then(|| format!("*z* shortened to {} of its length", significant(factor, 2)))
    }

    /// Maps a point into the box: from −1/2 to 1/2 along each side, except for the height.
    fn boxed(&self, point: &[f64; 3]) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| SIZES[axis] * (self.share(axis, point[axis]) - 0.5))
    }

    /// Returns the position on the page of a point in the box, pt.
    fn place(&self, boxed: &Vector3<f64>) -> Point {
        let (right, up) = self.view.project(boxed);
        let size = self.side_pt * EYE / (EYE + self.view.depth(boxed));
        at(size * right, -size * up)
    }

    /// Returns the end of an axis that is closer to the eye.
    fn near(&self, axis: usize) -> f64 {
        let mut ahead = Vector3::zeros();
        ahead[axis] = 1.0;
        if self.view.depth(&ahead) < 0.0 {
            0.5
        } else {
            -0.5
        }
    }

    /// Draws the box with the paths of `drawn` in `styles`.
    fn draw(&self, drawn: &[SampledRunNumbers], styles: &[SeriesStyle]) -> PageScene {
        let mut scene = PageScene::new(0.0, 0.0, "");
        scene.decimal_comma = self.decimal_comma;
        let edges = [self.edge(0), self.edge(1), self.edge(2)];
        let ticks = [0, 1, 2].map(|axis| self.ticks(axis, &edges[axis]));
        self.walls(&ticks, &mut scene);
        self.paths(drawn, styles, &mut scene);
        for axis in 0..3 {
            self.axis(axis, &edges[axis], &ticks[axis], &mut scene);
        }
        scene
    }

    /// Returns the ends of the edge along which the axis runs.
    fn edge(&self, axis: usize) -> [Vector3<f64>; 2] {
        let (x, y) = (self.near(0), self.near(1));
        let mut foot = Vector3::new(x, y, -0.5 * TALL);
        if axis == 2 {
            // Of the two vertical edges between a near and a far side, the left one.
            let [a, b] = [(x, -y), (-x, y)].map(|(x, y)| Vector3::new(x, y, 0.0));
            foot = if self.place(&b).x < self.place(&a).x {
                b
            } else {
                a
            };
        }
        [-0.5, 0.5].map(|side| {
            let mut end = foot;
            end[axis] = side * SIZES[axis];
            end
        })
    }

    /// Returns the point at the fraction `share` of an edge.
    fn along(edge: &[Vector3<f64>; 2], share: f64) -> Vector3<f64> {
        edge[0] + (edge[1] - edge[0]) * share
    }

    fn share(&self, axis: usize, value: f64) -> f64 {
        let (low, high) = self.ranges[axis];
        (value - low) / (high - low)
    }

    fn ticks(&self, axis: usize, edge: &[Vector3<f64>; 2]) -> Ticks {
        /// Minimum distance between two labels, horizontally and vertically, pt.
        const LABEL_DISTANCE: (f64, f64) = (6.0, 6.5);
        let (low, high) = self.ranges[axis];
        let height = ink::height(LABEL_PT);
        let mut ticks = Ticks::linear(low, high, |ticks| {
            ticks.len() <= 6
                && ticks.array_windows().all(|[a, b]| {
                    let [at_a, at_b] =
                        [a, b].map(|it| self.place(&Self::along(edge, self.share(axis, it.at))));
                    let wide = a.half_width() + b.half_width() + LABEL_DISTANCE.0;
                    (at_a.x - at_b.x).abs() >= wide
                        || (at_a.y - at_b.y).abs() >= height + LABEL_DISTANCE.1
                })
        });
        // Labels at a corner would collide with labels of another axis.
        let (inside, _): (Vec<Tick>, Vec<Tick>) = ticks
            .major
            .iter()
            .cloned()
            .partition(|tick| (0.03..=0.97).contains(&self.share(axis, tick.at)));
        if inside.len() >= 2 {
            ticks.major = inside;
        }
        ticks
    }

    /// Draws the far sides: their grids and outlines.
    fn walls(&self, ticks: &[Ticks; 3], scene: &mut PageScene) {
        /// The sides along which the grid lines of each axis run.
        const ALONG: [[usize; 2]; 3] = [[1, 2], [0, 2], [1, 0]];
        let far = Vector3::new(-self.near(0), -self.near(1), -0.5 * TALL);
        for (axis, along_axis) in ticks.iter().enumerate() {
            for tick in &along_axis.major {
                for along in ALONG[axis] {
                    let mut from = far;
                    from[axis] = SIZES[axis] * (self.share(axis, tick.at) - 0.5);
                    from[along] = -0.5 * SIZES[along];
                    let ends = [from, opposite(from, along)].map(|end| self.place(&end));
                    scene.line(ends, 0.35, grey(215));
                }
            }
        }
        let mut edges = Vec::new();
        for corner in [far, opposite(far, 2)] {
            edges.push([corner, opposite(corner, 0)]);
            edges.push([corner, opposite(corner, 1)]);
        }
        for foot in [far, opposite(far, 0), opposite(far, 1)] {
            edges.push([foot, opposite(foot, 2)]);
        }
        for edge in edges {
            scene.line(edge.map(|end| self.place(&end)), 0.4, grey(140));
        }
    }

    /// Draws an axis with its ticks, labels and title, outside the box.
    fn axis(&self, axis: usize, edge: &[Vector3<f64>; 2], ticks: &Ticks, scene: &mut PageScene) {
        let ends = edge.map(|end| self.place(&end));
        scene.line(ends, 0.6, BLACK);
        let out = self.outwards(axis, edge);
        let height = ink::height(LABEL_PT);
        let mut reach: f64 = 0.0;
        for tick in &ticks.major {
            let foot = self.place(&Self::along(edge, self.share(axis, tick.at)));
            // The label is moved outward until it is clear of the tick.
            let half = at(0.5 * ink::width(&tick.label, LABEL_PT), 0.5 * height);
            let clear = SPACE_TICK_LENGTH + TICK_GAP + half.x * out.x.abs() + half.y * out.y.abs();
            let [end, middle] = [SPACE_TICK_LENGTH, clear]
                .map(|length| at(foot.x + out.x * length, foot.y + out.y * length));
            scene.line([foot, end], 0.5, BLACK);
            reach = reach.max(clear + half.x * out.x.abs() + half.y * out.y.abs());
            let base = at(middle.x, middle.y + half.y);
            scene.write(&tick.label, LABEL_PT, base, TextAnchor::Middle);
        }
        let name = ["x_m", "y_m", "z_m"][axis];
        let title = quantity::axis(name).title(ticks);
        let middle = self.place(&Self::along(edge, 0.5));
        let (size, cap) = (TITLE_PT, ink::height(TITLE_PT));
        if axis == 2 {
            let x = middle.x - reach - SPACE_TITLE_GAP - 0.4 * cap;
            scene.write_up(&title, size, at(x, middle.y));
            return;
        }
        let half = at(0.5 * ink::width(&title, size), 0.6 * cap);
        let clear = reach + SPACE_TITLE_GAP + half.x * out.x.abs() + half.y * out.y.abs();
        let base = at(
            middle.x + out.x * clear,
            middle.y + out.y * clear + 0.5 * cap,
        );
        scene.write(&title, size, base, TextAnchor::Middle);
    }

    /// Returns the direction on the page from an axis out of the box.
    fn outwards(&self, axis: usize, edge: &[Vector3<f64>; 2]) -> Point {
        if axis == 2 {
            return at(-1.0, 0.0);
        }
        let middle = Self::along(edge, 0.5);
        let mut outside = middle;
        let across = 1 - axis;
        outside[across] += 0.1 * middle[across].signum();
        let (a, b) = (self.place(&middle), self.place(&outside));
        let length = libm::hypot(b.x - a.x, b.y - a.y).max(1e-9);
        at((b.x - a.x) / length, (b.y - a.y) / length)
    }
}

/// Returns the point opposite to `place` along one axis of the box.
fn opposite(mut place: Vector3<f64>, axis: usize) -> Vector3<f64> {
    place[axis] = -place[axis];
    place
}

fn round_pen(width_pt: f64, color: Color) -> StrokeStyle {
    StrokeStyle {
        is_round: true,
        ..pen(width_pt, color)
    }
}
