//! Whether a figure would be solid black, and which stretch of time would not.

use super::chart::Chart;
use super::chart::layout::Layout;
use super::page::cover::range;
use super::page::scene::Point;
use super::request::{Drawn, Request};
use crate::text::ladder;
use crate::text::number::{shortest, significant};
use std::fmt;

/// What covers the paper so densely that nothing of it is told apart, and a stretch of time in which it does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// What does, in words: "about 1200 swings".
    pub what: String,
    /// The width of the page, mm.
    pub width_mm: f64,
    /// The begin of the stretch, s.
    pub from_s: f64,
    /// Its end, s.
    pub to_s: f64,
}

impl Dense {
    /// The stretch as options of the command line.
    pub fn options(&self) -> String {
        let (from_s, to_s) = (shortest(self.from_s), significant(self.to_s, 9));
        format!("--from {from_s} --to {to_s}")
    }
}

impl fmt::Display for Dense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "on {} mm {} cover the paper, so that nothing of them is told apart; {} shows a part",
            self.width_mm,
            self.what,
            self.options()
        )
    }
}

/// Parts of a panel's width that are looked at, pt.
const PART_PT: f64 = 1.0;
/// Such a part is black where its lines are as wide as it is, and reach over so much of the panel's height.
const HIGH: f64 = 0.05;
/// A curve is black where so many of its parts are.
const MOST: f64 = 0.5;
/// Swings that a proposed stretch shows.
const SWINGS: f64 = 20.0;

/// Whether a curve of a chart is solid black; `drawn` are the runs of its curves, of which `first` is its first.
pub(super) fn warning(
    chart: &Chart,
    drawn: &[Drawn],
    first: usize,
    request: &Request,
) -> Option<Dense> {
    let layout = Layout::new(chart, 0.0);
    let panels = chart.panels.iter().zip(&layout.panels).enumerate();
    let all = panels.flat_map(|(place, (panel, placed))| {
        drawn.iter().zip(&panel.series).map(move |(drawn, series)| {
            let curve = &drawn.course.curves[first + place];
            let (low, high) = placed.y.range;
            let columns = (placed.frame.width() / PART_PT).ceil() as usize;
            let mut turns = vec![0; columns + 1];
            let mut extents = vec![(f64::INFINITY, f64::NEG_INFINITY); columns + 1];
            for part in curve.density() {
                let column = (placed.x.place(part.time_s) - placed.frame.left) / PART_PT;
                let column = (column.max(0.0) as usize).min(columns);
                turns[column] += part.turns;
                let extent = &mut extents[column];
                *extent = (extent.0.min(part.extent.0), extent.1.max(part.extent.1));
            }
            let is_black = |(&turns, extent): (&u64, &(f64, f64))| {
                turns as f64 * series.style.width_pt >= PART_PT
                    && extent.1 - extent.0 >= HIGH * (high - low)
            };
            let black = turns
                .iter()
                .zip(&extents)
                .filter(|part| is_black(*part))
                .count();
            let all: u64 = turns.iter().sum();
            (black as f64 > MOST * columns as f64).then_some(all)
        })
    });
    // What shows the most swings shows those of the other curves too.
    let turns = all.flatten().max()?;
    let (_, end_s) = layout.panels.first()?.x.range;
    // The axis may begin before the run, so that a measured point at 0 has room.
    let begin_s = request.from_s;
    let window_s = 2.0 * SWINGS * (end_s - begin_s) / turns as f64;
    Some(proposal(
        begin_s,
        window_s,
        request,
        format!("about {} swings", turns / 2),
    ))
}

/// Side of the places of a path that are looked at, pt, and how many places from the edge of the ink make its inside.
const PLACE_PT: f64 = 0.5;
const INSIDE: usize = 3;
/// About the width of a path's line, pt, and the part of the black places that the lines of a proposed stretch are to cover.
const LINE_PT: f64 = 0.9;
const LOOSE: f64 = 0.3;

/// As [`warning`], of the paths of `drawn`, the points of which stand at `places` on the page: of the runs, and where none of
/// them is dense, of the exact motion.
pub(super) fn of_paths(
    drawn: &[Drawn],
    request: &Request,
    places: impl Fn(&Drawn) -> Vec<Point>,
) -> Option<Dense> {
    let earliest = |is_exact: bool| {
        let drawn = drawn.iter().filter(|drawn| drawn.is_exact == is_exact);
        let dense =
            drawn.filter_map(|drawn| path_warning(&places(drawn), drawn.course.end_s, request));
        dense.min_by(|a, b| a.to_s.total_cmp(&b.to_s))
    };
    earliest(false).or_else(|| earliest(true))
}

/// As [`warning`], of a path whose points stand at `places` on the page, in the order of time up to `end_s`.
fn path_warning(places: &[Point], end_s: f64, request: &Request) -> Option<Dense> {
    if places.len() < 2000 {
        return None;
    }
    let (left, right) = range(places.iter().map(|place| place.x))?;
    let (top, bottom) = range(places.iter().map(|place| place.y))?;
    let side = |length: f64| (length / PLACE_PT) as usize + 1;
    let (columns, rows) = (side(right - left), side(bottom - top));
    let mut ink = vec![false; columns * rows];
    let mut length_pt = 0.0;
    for pair in places.windows(2) {
        let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
        let length = (dx * dx + dy * dy).sqrt();
        length_pt += length;
        let parts = (length / PLACE_PT).ceil().clamp(1.0, 4000.0);
        let (dx, dy) = (dx / parts / PLACE_PT, dy / parts / PLACE_PT);
        let (x, y) = ((pair[0].x - left) / PLACE_PT, (pair[0].y - top) / PLACE_PT);
        for part in 0..parts as u32 {
            let part = f64::from(part);
            let (column, row) = ((x + part * dx) as usize, (y + part * dy) as usize);
            if let Some(place) = ink.get_mut(row * columns + column) {
                *place = true;
            }
        }
    }
    let inked = ink.iter().filter(|inked| **inked).count();
    let inside = deep_inside(&ink, columns);
    if (inside as f64) < MOST * inked as f64 {
        return None;
    }
    let area = inked as f64 * PLACE_PT * PLACE_PT;
    let share = (LOOSE * area / (length_pt * LINE_PT)).min(0.5);
    let window_s = share * (end_s - request.from_s);
    Some(proposal(
        request.from_s,
        window_s,
        request,
        "its turns".to_owned(),
    ))
}

/// How many places are the lower right corner of a square of ink with sides of more than `INSIDE` places.
fn deep_inside(ink: &[bool], columns: usize) -> usize {
    let rows = ink.len() / columns.max(1);
    // Ink to the left without a gap, up to the place; the same to the top gives squares.
    let mut sides = vec![0_usize; ink.len()];
    let mut count = 0;
    for row in 0..rows {
        for column in 0..columns {
            let here = row * columns + column;
            if !ink[here] {
                continue;
            }
            let before = match (row, column) {
                (0, _) | (_, 0) => 0,
                _ => sides[here - 1]
                    .min(sides[here - columns])
                    .min(sides[here - columns - 1]),
            };
            sides[here] = before + 1;
            count += usize::from(sides[here] > INSIDE);
        }
    }
    count
}

fn proposal(from_s: f64, window_s: f64, request: &Request, what: String) -> Dense {
    Dense {
        what,
        width_mm: (request.width_pt / super::PT_PER_MM).round(),
        from_s,
        to_s: from_s + ladder::at_or_below(window_s),
    }
}
