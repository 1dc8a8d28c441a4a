//! Lines on the page: clips a line to a rectangle, and reduces the number of its points.

use super::ink::{PageRectangle, at};
use super::scene::Point;
use std::cmp::Ordering;

/// Number of points that are simplified together; the first and last are kept. This bounds the time for a pathological
/// line.
const POINTS_TOGETHER: usize = 512;

/// Returns the pieces of the line through `points` inside `frame`. The line is interrupted at points that are not
/// finite.
pub fn clipped(points: impl Iterator<Item = Point>, frame: &PageRectangle) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut part: Vec<Point> = Vec::new();
    let mut before: Option<Point> = None;
    for point in points {
        if !(point.x.is_finite() && point.y.is_finite()) {
            before = None;
            continue;
        }
        let Some(from) = before.replace(point) else {
            if frame.holds(point) {
                keep(&mut parts, &mut part);
                part.push(point);
            }
            continue;
        };
        let Some([begin, end]) = inside(from, point, frame) else {
            continue;
        };
        if part.last() != Some(&begin) {
            keep(&mut parts, &mut part);
            part.push(begin);
        }
        part.push(end);
    }
    keep(&mut parts, &mut part);
    parts
}

fn keep(parts: &mut Vec<Vec<Point>>, part: &mut Vec<Point>) {
    if !part.is_empty() {
        parts.push(std::mem::take(part));
    }
}

/// Returns the piece of a straight line inside `frame` (Liang and Barsky, 1984). An end inside the frame is returned
/// exactly.
fn inside(from: Point, to: Point, frame: &PageRectangle) -> Option<[Point; 2]> {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let edges = [
        (-dx, from.x - frame.left),
        (dx, frame.right - from.x),
        (-dy, from.y - frame.top),
        (dy, frame.bottom - from.y),
    ];
    let (mut begin, mut end) = (0.0_f64, 1.0_f64);
    for (speed, room) in edges {
        if speed == 0.0 {
            if room < 0.0 {
                return None;
            }
            continue;
        }
        let share = room / speed;
        if speed < 0.0 {
            begin = begin.max(share);
        } else {
            end = end.min(share);
        }
    }
    // Also outside if one of them is NaN.
    if begin.partial_cmp(&end).is_none_or(Ordering::is_gt) {
        return None;
    }
    Some([begin, end].map(|share| match share {
        0.0 => from,
        1.0 => to,
        share => at(from.x + share * dx, from.y + share * dy),
    }))
}

/// Returns a subset of the points, including the first and the last. No other point is farther than `within_pt` from
/// the line between its kept neighbors (Douglas and Peucker, 1973).
pub fn simplified(points: &[Point], within_pt: f64) -> Vec<Point> {
    let Some(last) = points.len().checked_sub(1) else {
        return vec![];
    };
    let mut is_kept = vec![false; points.len()];
    is_kept[last] = true;
    let mut open: Vec<(usize, usize)> = Vec::new();
    for begin in (0..last).step_by(POINTS_TOGETHER) {
        is_kept[begin] = true;
        open.push((begin, (begin + POINTS_TOGETHER).min(last)));
        while let Some((from, to)) = open.pop() {
            let between = (from + 1..to)
                .map(|index| (index, beyond(points[index], points[from], points[to])));
            let farthest = between.max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((index, _)) = farthest.filter(|(_, square)| *square > within_pt * within_pt)
            {
                is_kept[index] = true;
                open.extend([(from, index), (index, to)]);
            }
        }
    }
    let kept = points.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
    kept.map(|(point, _)| *point).collect()
}

/// Returns the squared distance of a point from the line segment between two others; infinity if it is NaN, so that the
/// point is kept.
fn beyond(point: Point, from: Point, to: Point) -> f64 {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let (px, py) = (point.x - from.x, point.y - from.y);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 {
        ((px * dx + py * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (x, y) = (px - share * dx, py - share * dy);
    let distance = x * x + y * y;
    if distance.is_nan() {
        f64::INFINITY
    } else {
        distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parts(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let frame = PageRectangle {
            left: 0.0,
            top: 0.0,
            right: 10.0,
            bottom: 10.0,
        };
        let parts = clipped(points.iter().map(|&(x, y)| at(x, y)), &frame);
        parts
            .iter()
            .map(|part| part.iter().map(|p| (p.x, p.y)).collect())
            .collect()
    }

    #[test]
    fn a_line_ends_at_the_edge_and_where_it_is_not_finite() {
        let line = parts(&[(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (5.0, 8.0)]);
        let there_and_back = [vec![(5.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (5.0, 8.0)]];
        assert_eq!(line, there_and_back);
        assert!(parts(&[(-5.0, -5.0), (-1.0, 20.0)]).is_empty());
        let through = [[(0.0, 5.0), (10.0, 5.0)]];
        assert_eq!(parts(&[(-5.0, 5.0), (15.0, 5.0)]), through);
        let broken = parts(&[(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (4.0, 1.0)]);
        assert_eq!(broken, [vec![(1.0, 1.0), (2.0, 1.0)], vec![(4.0, 1.0)]]);
        let far = parts(&[(5.0, 5.0), (5.0, 1e300), (1e300, 1e308)]);
        assert_eq!(far, [[(5.0, 5.0), (5.0, 10.0)]]);
    }

    proptest! {
        #[test]
        fn no_point_is_left_far_from_the_line(
            steps in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 0..2000),
            within in 0.0_f64..2.0,
        ) {
            let points: Vec<Point> = steps.iter().scan(at(0.0, 0.0), |place, step| {
                *place = at(place.x + step.0, place.y + step.1);
                Some(*place)
            }).collect();
            let kept = simplified(&points, within);
            prop_assert_eq!(kept.first(), points.first());
            prop_assert_eq!(kept.last(), points.last());
            // The points that are kept are found again in their order, each of the others near the line between two.
            let mut next = 1;
            for point in &points {
                let near = |index: usize| kept.get(index).is_some_and(|to| beyond(*point, kept[index - 1], *to) <= within * within + 1e-12);
                while next < kept.len() - 1 && !near(next) {
                    next += 1;
                }
                prop_assert!(kept.len() < 2 || near(next), "{:?}", point);
            }
        }
    }
}
