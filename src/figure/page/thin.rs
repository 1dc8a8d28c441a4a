//! Lines with fewer points that look the same: for curves in a plane, which may turn back and cover themselves.

use super::cover;
use super::scene::{Path, Point};
use super::simplify::simplified;

/// How far a line may leave its points, as a share of its width: a tenth of a dot at 600 dpi for a line of 0.7 pt.
const TOLERANCE: f64 = 0.02;
/// From so many points on, the area that a line covers is looked at: a file of 40 kB.
const MANY: usize = 5_000;

/// A line as it is put on the page.
#[derive(Clone, Debug, PartialEq)]
pub enum Thinned {
    Lines(Vec<Vec<Point>>),
    /// The outline of what the line's ink covers, to be filled by the non-zero rule.
    Area(Path),
}

/// A line with round corners and ends, `width_pt` wide, with fewer points. Where it runs over itself so often that the
/// outline of its ink has fewer points than the line, it becomes that area.
pub fn plane_curve(pieces: &[Vec<Point>], width_pt: f64) -> Thinned {
    let thin = |piece: &Vec<Point>| simplified(piece, TOLERANCE * width_pt);
    let lines: Vec<Vec<Point>> = pieces.iter().map(thin).collect();
    let count: usize = lines.iter().map(Vec::len).sum();
    if count > MANY {
        let area = cover::area(&lines, width_pt);
        // Nothing is found of lines that need too large a grid.
        if !area.0.is_empty() && area.0.len() < count {
            return Thinned::Area(area);
        }
    }
    Thinned::Lines(lines)
}

#[cfg(test)]
mod tests {
    use super::super::simplify::beyond;
    use super::*;
    use proptest::prelude::*;

    fn at(x: f64, y: f64) -> Point {
        Point { x, y }
    }

    /// A precession about (100, 100) with cusps and loops, `turns` times round.
    fn rosette(points: usize, turns: f64) -> Vec<Point> {
        let place = |i: usize| {
            let t = i as f64 / points as f64 * turns * std::f64::consts::TAU;
            let radius = 60.0 + 25.0 * libm::cos(t * 17.3);
            at(100.0 + radius * libm::cos(t), 100.0 + radius * libm::sin(t))
        };
        (0..points).map(place).collect()
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

    #[test]
    fn a_straight_line_needs_its_ends_and_one_that_turns_back_its_turn() {
        let there: Vec<Point> = (0..=100).map(|i| at(f64::from(i), 0.0)).collect();
        assert_eq!(simplified(&there, 0.01), [at(0.0, 0.0), at(100.0, 0.0)]);
        let mut back = there.clone();
        back.extend(there.iter().rev().skip(1).take(30));
        assert_eq!(
            simplified(&back, 0.01),
            [at(0.0, 0.0), at(100.0, 0.0), at(70.0, 0.0)]
        );
        assert_eq!(simplified(&[], 1.0), []);
        assert_eq!(simplified(&there[..1], 1.0), there[..1]);
    }

    #[test]
    fn a_line_stays_a_line_and_a_million_points_become_an_area() {
        let few = rosette(20_000, 1.0);
        let Thinned::Lines(lines) = plane_curve(std::slice::from_ref(&few), 0.7) else {
            panic!("an area");
        };
        assert!((400..2500).contains(&lines[0].len()), "{}", lines[0].len());
        let Thinned::Area(area) = plane_curve(&[rosette(100_000, 100.0)], 0.7) else {
            panic!("lines");
        };
        assert!((100..20_000).contains(&area.0.len()), "{}", area.0.len());
    }
}
