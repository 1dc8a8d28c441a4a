//! Whether a figure would be solid black, and which stretch of time would not.

use super::chart::Chart;
use super::chart::layout::Layout;
use super::of_runs::{Drawn, Request};
use crate::text::ladder;
use crate::text::number::{shortest, significant};

/// Parts of a panel's width that are looked at, pt.
const PART_PT: f64 = 1.0;
/// Such a part is black where its lines are as wide as it is, and reach over so much of the panel's height.
const HIGH: f64 = 0.05;
/// A curve is black where so many of its parts are.
const MOST: f64 = 0.5;
/// Swings that a proposed stretch shows.
const SWINGS: f64 = 20.0;

/// What is said of a chart of which a curve is solid black; `drawn` are the runs of its curves.
pub(super) fn warning(chart: &Chart, drawn: &[Drawn], request: &Request) -> Option<String> {
    let layout = Layout::new(chart, 0.0);
    let panels = chart.panels.iter().zip(&layout.panels).enumerate();
    let mut all = panels.flat_map(|(place, (panel, placed))| {
        drawn.iter().zip(&panel.series).map(move |(drawn, series)| {
            let curve = &drawn.course.curves[place];
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
    let turns = all.find_map(|turns| turns)?;
    let (begin_s, end_s) = layout.panels.first()?.x.range;
    let window_s = 2.0 * SWINGS * (end_s - begin_s) / turns as f64;
    Some(proposal(
        begin_s,
        window_s,
        request,
        &format!("about {} swings", turns / 2),
    ))
}

/// Side of the places of a path that are looked at, pt, and how many places from the edge of the ink make its inside.
const PLACE_PT: f64 = 0.25;
const INSIDE: usize = 4;
/// Turns of a path that a proposed stretch shows.
const TURNS: f64 = 3.0;

/// As [`warning`], of the path from above.
pub(super) fn path_warning(chart: &Chart, drawn: &[Drawn], request: &Request) -> Option<String> {
    let layout = Layout::new(chart, 0.0);
    let placed = layout.panels.first()?;
    let (width, height) = (placed.frame.width(), placed.frame.height());
    let side = |length: f64| (length / PLACE_PT).ceil() as usize + 1;
    let (columns, rows) = (side(width), side(height));
    for (drawn, series) in drawn.iter().zip(&chart.panels.first()?.series) {
        if series.points.len() < 2000 {
            continue;
        }
        let mut ink = vec![false; columns * rows];
        let mut length_pt = 0.0;
        for pair in series.points.windows(2) {
            let (a, b) = (placed.place(&pair[0]), placed.place(&pair[1]));
            let length = (b.x - a.x).hypot(b.y - a.y);
            length_pt += length;
            let parts = (length / PLACE_PT).ceil().clamp(1.0, 4000.0);
            for part in 0..parts as u32 {
                let share = f64::from(part) / parts;
                let x = (a.x + share * (b.x - a.x) - placed.frame.left) / PLACE_PT;
                let y = (a.y + share * (b.y - a.y) - placed.frame.top) / PLACE_PT;
                if x >= 0.0 && y >= 0.0 && (x as usize) < columns && (y as usize) < rows {
                    ink[y as usize * columns + x as usize] = true;
                }
            }
        }
        let inked = ink.iter().filter(|inked| **inked).count();
        let inside = deep_inside(&ink, columns);
        if (inside as f64) < MOST * inked as f64 {
            continue;
        }
        // One turn about the middle is about as long as the picture is wide, three times.
        let turns = length_pt / (3.0 * width);
        let time_s = drawn.course.end_s - request.from_s;
        let window_s = TURNS * time_s / turns.max(1.0);
        return Some(proposal(request.from_s, window_s, request, "its turns"));
    }
    None
}

/// How many of the places with ink have ink all around, as far as `INSIDE`.
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

fn proposal(begin_s: f64, window_s: f64, request: &Request, what: &str) -> String {
    let window_s = ladder::at_or_below(window_s);
    let to_s = significant(begin_s + window_s, 9);
    let width_mm = (request.width_pt / super::PT_PER_MM).round();
    format!(
        "on {width_mm} mm {what} cover the paper: the figure is solid black; --from {} --to {to_s} shows a part of it",
        shortest(begin_s)
    )
}
