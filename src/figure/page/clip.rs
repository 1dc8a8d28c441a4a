//! What of a line lies in a rectangle. Places far outside would not fit into the numbers of a file.

use super::ink::{Frame, at};
use super::scene::Point;
use std::cmp::Ordering;

/// The parts of the line through `points` that lie in `frame`; it is interrupted where a point is not finite.
pub fn clipped(points: impl Iterator<Item = Point>, frame: &Frame) -> Vec<Vec<Point>> {
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

/// The part of a straight line that lies in `frame` (Liang and Barsky, 1984); its ends are those of the line where they
/// are inside.
fn inside(from: Point, to: Point, frame: &Frame) -> Option<[Point; 2]> {
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
    // Neither where one of them is no number.
    if begin.partial_cmp(&end).is_none_or(Ordering::is_gt) {
        return None;
    }
    let point = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        share => at(from.x + share * dx, from.y + share * dy),
    };
    Some([point(begin), point(end)])
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
    };

    fn parts(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let points = points.iter().map(|&(x, y)| at(x, y));
        let parts = clipped(points, &FRAME);
        let plain = |part: &Vec<Point>| part.iter().map(|p| (p.x, p.y)).collect();
        parts.iter().map(plain).collect()
    }

    #[test]
    fn a_line_ends_at_the_edge_and_begins_there_again() {
        let line = parts(&[(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (5.0, 8.0)]);
        assert_eq!(
            line,
            [vec![(5.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (5.0, 8.0)]]
        );
        assert!(parts(&[(-5.0, -5.0), (-1.0, 20.0)]).is_empty());
        assert_eq!(
            parts(&[(-5.0, 5.0), (15.0, 5.0)]),
            [[(0.0, 5.0), (10.0, 5.0)]]
        );
    }

    #[test]
    fn what_is_not_finite_interrupts_it() {
        let line = parts(&[
            (1.0, 1.0),
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (4.0, 1.0),
            (5.0, 1.0),
        ]);
        assert_eq!(line, [[(1.0, 1.0), (2.0, 1.0)], [(4.0, 1.0), (5.0, 1.0)]]);
        let far = parts(&[(5.0, 5.0), (5.0, 1e300), (1e300, 1e308)]);
        assert_eq!(far, [[(5.0, 5.0), (5.0, 10.0)]]);
    }

    #[test]
    fn a_point_alone_stays() {
        assert_eq!(parts(&[(1.0, 1.0)]), [[(1.0, 1.0)]]);
    }
}
