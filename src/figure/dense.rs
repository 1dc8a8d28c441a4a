//! Whether a figure would be solid black, and which stretch of time would not.

use super::chart::Chart;
use super::chart::curve;
use super::chart::layout::{Layout, Placed};
use super::course::{Course, Part};
use super::page::cover::Grid;
use super::page::scene::Point;
use super::path::Path;
use super::request::{Drawn, Request};
use crate::export::Column;
use crate::playback::recording::Extent;
use crate::text::ladder;
use crate::text::number::{shortest, significant};
use std::fmt;

/// What fills the paper with ink until nothing can be distinguished, and a shorter stretch of time that does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// What does, in words: "about 1200 swings".
    pub what: String,
    pub width_mm: f64,
    pub from_s: f64,
    pub to_s: f64,
}

impl Dense {
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
/// A curve is black where more than this share of its parts is, a path where this share of its places is inside of the ink.
const MOST: f64 = 0.5;
const SWINGS: f64 = 20.0;

/// What is said where a curve of a chart, which shows `columns` of `drawn`, is solid black.
pub(super) fn warning(
    chart: &Chart,
    columns: &[&'static Column],
    drawn: &[Drawn],
    request: &Request,
) -> Option<Dense> {
    let layout = Layout::new(chart, 0.0);
    let panels = columns.iter().zip(chart.panels.iter().zip(&layout.panels));
    let all = panels.flat_map(|(column, (panel, placed))| {
        let series = drawn.iter().zip(&panel.series);
        series.map(|(drawn, series)| {
            swings_of_black(&drawn.course.parts(column), series.style.width_pt, placed)
        })
    });
    // What shows the most swings shows those of the other curves too.
    let turns = all.flatten().max()?;
    let (_, end_s) = layout.panels.first()?.x.range;
    // The axis may begin before the run, so that a measured point at 0 has room.
    let window_s = 2.0 * SWINGS * (end_s - request.from_s) / turns as f64;
    let what = format!("about {} swings", turns / 2);
    Some(proposal(window_s, request, what))
}

/// How often a curve, which has these `parts`, turns where its line makes most of its panel black.
fn swings_of_black(parts: &[Part], width_pt: f64, placed: &Placed) -> Option<u64> {
    let columns = (placed.frame.width() / PART_PT).ceil() as usize;
    let mut black: Vec<(u32, Option<Extent>)> = vec![(0, None); columns + 1];
    for part in parts {
        let time_s = 0.5 * (part.times_s[0] + part.times_s[1]);
        let column = (placed.x.place(time_s) - placed.frame.left) / PART_PT;
        let (turns, extent) = &mut black[(column.max(0.0) as usize).min(columns)];
        *turns += part.turns;
        *extent = Some(extent.map_or(part.extent, |extent| extent.and(part.extent)));
    }
    let all = black.iter().map(|(turns, _)| u64::from(*turns)).sum();
    let high = HIGH * (placed.y.range.1 - placed.y.range.0);
    black.retain(|(turns, extent)| {
        let is_high = extent.is_some_and(|extent| extent.max - extent.min >= high);
        f64::from(*turns) * width_pt >= PART_PT && is_high
    });
    (black.len() as f64 > MOST * columns as f64).then_some(all)
}

/// Side of the places of a path that are looked at, pt, and how many places from the edge of the ink make its inside.
const PLACE_PT: f64 = 0.5;
const INSIDE: usize = 3;
/// About the width of a path's line, pt, and the part of the black places that the lines of a proposed stretch are to cover.
const LINE_PT: f64 = 0.9;
const LOOSE: f64 = 0.3;

/// As [`warning`], of each `path` of `drawn`, whose points stand at a `place` on the page: of the runs, and where none of them
/// is dense, of the exact motion.
pub(super) fn of_paths(
    drawn: &[Drawn],
    request: &Request,
    path: fn(&Course) -> &Path,
    place: impl Fn(&[f64; 3]) -> Point,
) -> Option<Dense> {
    let dense = |drawn: &Drawn| {
        let path = path(&drawn.course);
        if path.points.len() < 2000 {
            return None;
        }
        let lines = path.lines(&place);
        let grid = Grid::inked(&lines, PLACE_PT, 0.0)?;
        let area_pt2 = grid.area_pt2();
        if grid.area_inside_pt2(INSIDE) < MOST * area_pt2 {
            return None;
        }
        let length_pt: f64 = lines.iter().map(|line| curve::length(line)).sum();
        let share = (LOOSE * area_pt2 / (path.times * length_pt * LINE_PT)).min(0.5);
        let window_s = share * (drawn.course.end_s - request.from_s);
        Some(proposal(window_s, request, "its turns".to_owned()))
    };
    let earliest = |is_exact: bool| {
        let drawn = drawn.iter().filter(|drawn| drawn.is_exact == is_exact);
        let dense = drawn.filter_map(dense);
        dense.min_by(|a, b| a.to_s.total_cmp(&b.to_s))
    };
    earliest(false).or_else(|| earliest(true))
}

fn proposal(window_s: f64, request: &Request, what: String) -> Dense {
    Dense {
        what,
        width_mm: (request.width_pt / super::PT_PER_MM).round(),
        from_s: request.from_s,
        to_s: request.from_s + ladder::at_or_below(window_s),
    }
}
