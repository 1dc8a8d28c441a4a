//! Lines on the page: clips a line to a rectangle, and reduces the number of its points.

use super::ink::{PageRectangle, at};
use super::scene::Point;
use std::cmp::Ordering;
use std::collections::HashMap;

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
    let corners = corners(points, within_pt);
    corners.into_iter().map(|index| points[index]).collect()
}

/// Returns the line through `points`, each at a `place` on the page, without ripples of at most `within_pt`. A dashed line
/// is then as long as it looks: its dashes do not follow ripples that nobody sees.
pub fn without_ripples<P: Copy>(
    points: &[P],
    place: impl Fn(&P) -> Point,
    within_pt: f64,
) -> Vec<P> {
    /// Length of a ripple compared with the straight line between its ends. A bend is shorter.
    const RIPPLE: f64 = 1.2;
    let places: Vec<Point> = points.iter().map(place).collect();
    let mut steady: Vec<P> = Vec::new();
    for pair in corners(&places, within_pt).windows(2) {
        let (begin, end) = (pair[0], pair[1]);
        let straight = distance(places[begin], places[end]);
        let is_ripple = length(&places[begin..=end]) > RIPPLE * straight;
        let kept = if is_ripple {
            begin..begin + 1
        } else {
            begin..end
        };
        steady.extend(&points[kept]);
    }
    steady.extend(points.last());
    steady
}

/// Returns the parts of `lines` that are at least `apart_pt` away from all parts before them; `place` returns where a point
/// is on the page. A dashed line that follows itself would look solid.
pub fn first_passes<P: Copy>(
    lines: &[Vec<P>],
    place: impl Fn(&P) -> Point,
    apart_pt: f64,
) -> Vec<Vec<P>> {
    let mut passed = Passed::new(apart_pt);
    let mut fresh: Vec<Vec<P>> = Vec::new();
    for line in lines {
        let mut is_joined = false;
        for pair in line.windows(2) {
            let is_new = passed.is_first([place(&pair[0]), place(&pair[1])]);
            match fresh.last_mut().filter(|_| is_joined) {
                Some(part) if is_new => part.push(pair[1]),
                _ if is_new => fresh.push(pair.to_vec()),
                _ => {}
            }
            is_joined = is_new;
        }
    }
    fresh
}

/// The places on the page that a line has passed.
struct Passed {
    apart_pt: f64,
    /// One place in each square of side `apart_pt`, and the length of the line up to there, pt.
    places: HashMap<[i64; 2], (Point, f64)>,
    length_pt: f64,
    checked: u32,
}

/// The most places along a line that are checked. Beyond them the page is full.
const MOST_CHECKED: u32 = 2_000_000;

impl Passed {
    fn new(apart_pt: f64) -> Self {
        Self {
            apart_pt,
            places: HashMap::new(),
            length_pt: 0.0,
            checked: 0,
        }
    }

    /// Appends the next segment of the line. Returns whether it leads through a new place.
    fn is_first(&mut self, [from, to]: [Point; 2]) -> bool {
        let long_pt = distance(from, to);
        let count = (long_pt / self.apart_pt).ceil().clamp(1.0, 1e5) as u32;
        self.checked = self.checked.saturating_add(count);
        if self.checked > MOST_CHECKED {
            return false;
        }
        let begin_pt = self.length_pt;
        let along = (1..=count).map(|number| {
            let share = f64::from(number) / f64::from(count);
            let there = at(
                from.x + share * (to.x - from.x),
                from.y + share * (to.y - from.y),
            );
            (there, begin_pt + share * long_pt)
        });
        let along: Vec<(Point, f64)> = along.collect();
        self.length_pt += long_pt;
        let is_first = along
            .iter()
            .any(|(there, length_pt)| !self.has(*there, *length_pt));
        if is_first {
            for (there, length_pt) in along {
                let square = self.square(there);
                self.places.entry(square).or_insert((there, length_pt));
            }
        }
        is_first
    }

    /// Returns whether the line was near `there` before; `length_pt` is its length up to there now.
    fn has(&self, there: Point, length_pt: f64) -> bool {
        /// Neighbors along the line do not count: their distance along it, in units of `apart_pt`.
        const ITSELF: f64 = 4.0;
        let [column, row] = self.square(there);
        (-1..=1).any(|right| {
            (-1..=1).any(|down| {
                let near = self.places.get(&[column + right, row + down]);
                near.is_some_and(|(place, when_pt)| {
                    distance(*place, there) < self.apart_pt
                        && length_pt - when_pt > ITSELF * self.apart_pt
                })
            })
        })
    }

    fn square(&self, place: Point) -> [i64; 2] {
        [place.x, place.y].map(|side| (side / self.apart_pt).floor() as i64)
    }
}

/// Returns the length of the line through `points`, pt.
pub fn length(points: &[Point]) -> f64 {
    points.array_windows().map(|[a, b]| distance(*a, *b)).sum()
}

/// Returns the distance of two points, pt.
pub fn distance(a: Point, b: Point) -> f64 {
    libm::hypot(b.x - a.x, b.y - a.y)
}

/// Returns the indices of the points that [`simplified`] keeps.
fn corners(points: &[Point], within_pt: f64) -> Vec<usize> {
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
    (0..points.len()).filter(|index| is_kept[*index]).collect()
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
    fn lines_are_cut_at_the_edge_and_at_non_finite_points() {
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

    #[test]
    fn dashed_lines_ignore_invisible_ripples() {
        let rippled = |apart: f64, height: f64| -> Vec<Point> {
            (0..2000)
                .map(|i| at(apart * f64::from(i), height * f64::from(i % 2)))
                .collect()
        };
        let straight = without_ripples(&rippled(0.1, 0.2), |place| *place, 0.25);
        assert!(length(&straight) < 1.01 * 199.9, "{}", length(&straight));
        let seen = rippled(1.0, 1.0);
        assert_eq!(without_ripples(&seen, |place| *place, 0.25), seen);
        // A bend is no ripple.
        let bend: Vec<Point> = (0..100)
            .map(|i| at(f64::from(i), 1e-3 * f64::from(i * i)))
            .collect();
        assert_eq!(without_ripples(&bend, |place| *place, 0.25), bend);
    }

    #[test]
    fn a_dashed_line_that_follows_itself_is_drawn_once() {
        let circle = |radius: f64, turns: u32| -> Vec<Point> {
            (0..=100 * turns)
                .map(|i| 0.02 * std::f64::consts::PI * f64::from(i))
                .map(|angle| at(radius * libm::cos(angle), radius * libm::sin(angle)))
                .collect()
        };
        let once = circle(50.0, 1);
        let whole_pt = length(&once);
        let drawn_pt = |lines: &[Vec<Point>]| -> f64 {
            let parts = first_passes(lines, |place| *place, 2.0);
            parts.iter().map(|part| length(part)).sum()
        };
        assert!((drawn_pt(std::slice::from_ref(&once)) / whole_pt - 1.0).abs() < 0.05);
        assert!((drawn_pt(&[circle(50.0, 7)]) / whole_pt - 1.0).abs() < 0.05);
        assert!((drawn_pt(&[once, circle(60.0, 1)]) / whole_pt - 2.2).abs() < 0.1);
    }

    proptest! {
        #[test]
        fn simplification_keeps_every_point_near_the_line(
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
            // Kept points appear in order, and every other point is near the line between two of them.
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
