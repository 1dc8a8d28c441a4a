//! A line through fewer of its points.

use super::scene::Point;

/// Points that are thinned together; the first and the last of them stay. It bounds the time that a hostile line takes.
const TOGETHER: usize = 512;

/// Some of the points, the first and the last among them: none of the others lies farther than `within_pt` from the line
/// between its neighbours that are kept (Douglas and Peucker, 1973).
pub fn simplified(points: &[Point], within_pt: f64) -> Vec<Point> {
    let Some(last) = points.len().checked_sub(1) else {
        return vec![];
    };
    let mut is_kept = vec![false; points.len()];
    is_kept[last] = true;
    let mut open: Vec<(usize, usize)> = Vec::new();
    for begin in (0..last).step_by(TOGETHER) {
        is_kept[begin] = true;
        open.push((begin, (begin + TOGETHER).min(last)));
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

/// The square of the distance of a point from the straight line between two others; infinite if it is not a number, so that
/// the point is kept.
pub(super) fn beyond(point: Point, from: Point, to: Point) -> f64 {
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
