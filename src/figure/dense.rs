//! Whether a figure would be solid black, and which stretch of time would not.

use super::chart::Chart;
use super::chart::curve;
use super::chart::layout::Layout;
use super::course::Course;
use super::page::cover::Grid;
use super::page::scene::Point;
use super::path::Path;
use super::request::{Drawn, Request};
use crate::export::Column;
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
    let black = panels.flat_map(|(column, (panel, placed))| {
        let series = drawn.iter().zip(&panel.series);
        let black = series.filter(|(_, series)| {
            let lines = placed.pieces(series);
            black_pt2(&lines, series.style.width_pt).is_some()
        });
        black.map(|(drawn, _)| drawn.course.turns(column))
    });
    // What shows the most swings shows those of the other curves too.
    let turns = black.max()?;
    let (_, end_s) = layout.panels.first()?.x.range;
    // The axis may begin before the run, so that a measured point at 0 has room.
    let begin_s = request.from_s;
    let window_s = 2.0 * SWINGS * (end_s - begin_s) / turns as f64;
    let what = format!("about {} swings", turns / 2);
    Some(proposal(begin_s, window_s, request, what))
}

/// The area of the places of that side (pt) that `lines` pass, pt², where most of them are inside of the ink; `None` where
/// lines can be told apart.
fn black_pt2(lines: &[Vec<Point>], place_pt: f64) -> Option<f64> {
    /// From the edge of the ink, places.
    const INSIDE: usize = 3;
    const MOST: f64 = 0.5;
    let grid = Grid::inked(lines, place_pt, 0.0)?;
    let area_pt2 = grid.area_pt2();
    (grid.area_inside_pt2(INSIDE) >= MOST * area_pt2).then_some(area_pt2)
}

/// Side of the places of a path that are looked at, pt.
const PLACE_PT: f64 = 0.5;
/// About the width of a path's line, pt, and the part of the black places that the lines of a proposed stretch are to cover.
const LINE_PT: f64 = 0.9;
const LOOSE: f64 = 0.3;

/// As [`warning`], of the paths of `drawn`, of which `path` gives the lines on the page: of the runs, and where none of them is
/// dense, of the exact motion.
pub(super) fn of_paths(
    drawn: &[Drawn],
    request: &Request,
    path: impl Fn(&Course) -> (Vec<Vec<Point>>, &Path),
) -> Option<Dense> {
    let earliest = |is_exact: bool| {
        let drawn = drawn.iter().filter(|drawn| drawn.is_exact == is_exact);
        let dense = drawn.filter_map(|drawn| {
            let (lines, path) = path(&drawn.course);
            path_warning(&lines, path, drawn.course.end_s, request)
        });
        dense.min_by(|a, b| a.to_s.total_cmp(&b.to_s))
    };
    earliest(false).or_else(|| earliest(true))
}

/// As [`warning`], of a `path` up to `end_s`, which is `lines` on the page.
fn path_warning(lines: &[Vec<Point>], path: &Path, end_s: f64, request: &Request) -> Option<Dense> {
    if path.points.len() < 2000 {
        return None;
    }
    let area_pt2 = black_pt2(lines, PLACE_PT)?;
    let length_pt: f64 = lines.iter().map(|line| curve::length(line)).sum();
    let share = (LOOSE * area_pt2 / (path.times * length_pt * LINE_PT)).min(0.5);
    let window_s = share * (end_s - request.from_s);
    let what = "its turns".to_owned();
    Some(proposal(request.from_s, window_s, request, what))
}

fn proposal(from_s: f64, window_s: f64, request: &Request, what: String) -> Dense {
    Dense {
        what,
        width_mm: (request.width_pt / super::PT_PER_MM).round(),
        from_s,
        to_s: from_s + ladder::at_or_below(window_s),
    }
}
