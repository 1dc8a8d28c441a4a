//! The paths in the box. Close lines are wide and dark.

use super::{Space, TALL, round_pen};
use crate::plot::chart::SeriesStyle;
use crate::plot::chart::axis::AxisScale;
use crate::plot::chart::curve;
use crate::plot::extent;
use crate::plot::ink::{WHITE, grey, paler};
use crate::plot::line;
use crate::plot::scene::{PageScene, Point, StrokeStyle};
use crate::report::figure::job::SampledRunNumbers;
use nalgebra::Vector3;

const DEPTHS: usize = 6;
/// Width of the nearest and the farthest line, pt, and the fraction of white in the farthest.
const WIDTHS: (f64, f64) = (0.95, 0.5);
const FARTHEST_WHITE: f64 = 0.58;

/// A path, or its shadow on the floor: points on the page with their depths, in pieces.
type PathPieces = Vec<Vec<(Point, f64)>>;

impl Space {
    /// Draws the paths, the farthest parts first, with their shadows behind them.
    pub(super) fn paths(
        &self,
        drawn: &[SampledRunNumbers],
        styles: &[SeriesStyle],
        scene: &mut PageScene,
    ) {
        for (run, style) in drawn.iter().zip(styles).rev() {
            let shadow = run.course.above.lines(|at| {
                let boxed = self.boxed(at);
                self.place(&Vector3::new(boxed.x, boxed.y, -0.5 * TALL))
            });
            draw(&shadow, &round_pen(0.45, grey(198)), style, scene);
        }
        let paths: Vec<PathPieces> = drawn
            .iter()
            .zip(styles)
            .map(|(drawn, style)| {
                let lines = drawn.course.path.lines(|at| {
                    let boxed = self.boxed(at);
                    (self.place(&boxed), self.view.depth(&boxed))
                });
                curve::as_dashed(lines, style, |(place, _)| *place)
            })
            .collect();
        let depths = paths.iter().flatten().flatten().map(|(_, depth)| *depth);
        let (near, far) = extent(depths).unwrap_or_default();
        let share = AxisScale {
            range: (far, near),
            is_log: false,
            places: (0.0, DEPTHS as f64),
        };
        let parted: Vec<_> = paths
            .iter()
            .map(|path| {
                by_degree(path, |depth| {
                    (share.place(depth).max(0.0) as usize).min(DEPTHS - 1)
                })
            })
            .collect();
        // Runs are drawn first, in reverse order. The exact motion is drawn on top of them.
        let (behind, before): (Vec<_>, Vec<_>) = parted
            .iter()
            .zip(styles)
            .partition(|(_, style)| style.is_behind);
        for (parts, style) in behind.into_iter().rev().chain(before) {
            for (nearness, pieces) in parts.iter().enumerate() {
                draw_at(nearness, pieces, style, scene);
            }
        }
        for (place, (path, style)) in paths.iter().zip(styles).enumerate() {
            if let Some(mark) = style.sparse_mark {
                let lines: Vec<Vec<Point>> = path
                    .iter()
                    .map(|line| line.iter().map(|(point, _)| *point).collect())
                    .collect();
                for point in curve::spread(&lines, place, line::distance) {
                    scene.mark(mark, point, style.color);
                }
            }
        }
    }
}

/// Draws pieces with this nearness. Close pieces are wide and dark.
fn draw_at(nearness: usize, pieces: &[Vec<Point>], style: &SeriesStyle, scene: &mut PageScene) {
    let pen = style.pen();
    let part = nearness as f64 / (DEPTHS - 1) as f64;
    let width = WIDTHS.1 + part * (WIDTHS.0 - WIDTHS.1);
    let pen = StrokeStyle {
        width_pt: pen.width_pt * width / SeriesStyle::default().width_pt,
        color: paler(pen.color, FARTHEST_WHITE * (1.0 - part)),
        ..pen
    };
    if style.halo_pt() > 0.0 {
        let halo = StrokeStyle {
            width_pt: pen.width_pt + style.halo_pt(),
            color: WHITE,
            ..pen.clone()
        };
        draw(pieces, &halo, style, scene);
    }
    draw(pieces, &pen, style, scene);
}

fn draw(pieces: &[Vec<Point>], pen: &StrokeStyle, style: &SeriesStyle, scene: &mut PageScene) {
    if style.is_dots {
        let dots = curve::dots(pieces.iter().flatten().copied());
        curve::draw_curve(&dots, pen, None, scene);
    } else {
        curve::draw_curve(pieces, pen, None, scene);
    }
}

/// Splits a path's lines by the degree of depth at which they begin. Consecutive lines of the same degree form one
/// piece.
fn by_degree(
    path: &[Vec<(Point, f64)>],
    degree: impl Fn(f64) -> usize,
) -> [Vec<Vec<Point>>; DEPTHS] {
    let mut pieces: [Vec<Vec<Point>>; DEPTHS] = Default::default();
    for line in path {
        let mut last = None;
        for pair in line.windows(2) {
            let nearness = degree(pair[0].1);
            match pieces[nearness].last_mut() {
                Some(piece) if last == Some(nearness) => piece.push(pair[1].0),
                _ => pieces[nearness].push(vec![pair[0].0, pair[1].0]),
            }
            last = Some(nearness);
        }
    }
    pieces
}
