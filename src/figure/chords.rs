//! Paths with too few points for a figure: straight lines between them would cut the bends off.
//!
//! A run that takes ten time steps for a turn of its path, drawn as chords, lies inside the circle that its points lie on.
//! Beside the exact motion that looks like an error of the run: so the points are drawn, and not joined. The exact motion is
//! a line with more points, though over a very long stretch of time they are too few as well.

use super::chart::Style;
use super::course::Course;
use super::path::Path;
use super::request::Drawn;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A path with more points than this in a turn, on the average, looks round: the chords are off it by 1.5 % of its radius.
const ROUND: f64 = 18.0;
/// Chords that are off it by less than this part of the picture's width look round too: about 0.15 pt.
const UNSEEN: f64 = 7e-4;
/// Of fewer bends than these there is no average.
const FEWEST: u32 = 3;
/// About this many points of a path are examined.
const LOOKED_AT: usize = 50_000;

/// How many points there are to a turn of `path` (m), where they are too few to look round.
pub(super) fn points_a_turn(path: &[[f64; 3]]) -> Option<f64> {
    let bends = path.windows(3).step_by(1 + path.len() / LOOKED_AT);
    let bends = bends.filter_map(|three| {
        let [a, b, c] = [0, 1, 2].map(|place| Vector3::from(three[place]));
        let moves = a != b && b != c;
        moves.then(|| {
            let (angle, chord) = ((b - a).angle(&(c - b)), (b - a).norm());
            (angle, 0.5 * chord * libm::tan(0.25 * angle))
        })
    });
    let none = (0, 0.0, 0.0);
    let (count, angles, heights) = bends.fold(none, |(count, angles, heights), (angle, height)| {
        (count + 1, angles + angle, heights + height)
    });
    let a_turn = TAU * f64::from(count) / angles;
    let is_seen = heights > UNSEEN * f64::from(count) * width(path);
    (count >= FEWEST && a_turn < ROUND && is_seen).then_some(a_turn)
}

/// The longest way along one of the axes from one end of `path` to the other, m.
fn width(path: &[[f64; 3]]) -> f64 {
    let far = Vector3::repeat(f64::INFINITY);
    let (low, high) = path.iter().fold((far, -far), |(low, high), at| {
        let at = Vector3::from(*at);
        (low.inf(&at), high.sup(&at))
    });
    (high - low).max()
}

/// What is drawn, as its `path` is drawn: of a run with too few points to look round these alone, and its name says so.
pub(super) fn as_drawn(drawn: &Drawn, path: &Path) -> (String, Style) {
    if path.few_a_turn.is_none() || drawn.is_exact {
        return (drawn.name.clone(), drawn.style.clone());
    }
    let name = match drawn.name.as_str() {
        "" => String::new(),
        name => format!("{name}, every step"),
    };
    (name, drawn.style.clone().as_dots())
}

/// What is said of the first of `drawn` whose `path` has too few points to look round.
pub(super) fn warning(drawn: &[Drawn], path: fn(&Course) -> &Path) -> Option<String> {
    drawn.iter().find_map(|drawn| {
        let a_turn = path(&drawn.course).few_a_turn?;
        Some(match (drawn.is_exact, drawn.name.as_str()) {
            (true, name) => format!(
                "the line of {name} has only about {a_turn:.0} points a turn in so long a stretch of time: between them it is straight"
            ),
            (false, name) => {
                let run = if name.is_empty() { "the run" } else { name };
                format!(
                    "{run} takes about {a_turn:.0} time steps for a turn: they are drawn as points, since straight lines between them would cut the bends off"
                )
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_few_points_is_in_chords() {
        let circle = |a_turn: f64| -> Vec<[f64; 3]> {
            let angles = (0..100).map(|step| f64::from(step) * TAU / a_turn);
            angles
                .map(|angle| [angle.cos(), angle.sin(), 1.0])
                .collect()
        };
        assert!((points_a_turn(&circle(10.0)).unwrap() - 10.0).abs() < 1e-9);
        assert_eq!(points_a_turn(&circle(40.0)), None);
        // Bends that are far smaller than the picture.
        let wavy: Vec<_> = (0..4000)
            .map(|step| [f64::from(step), 0.3 * f64::from(step % 2), 1.0])
            .collect();
        assert_eq!(points_a_turn(&wavy), None);
        let standing = vec![[1.0, 0.0, 0.0]; 100];
        let straight: Vec<_> = (0..100).map(|step| [f64::from(step), 0.0, 0.0]).collect();
        assert_eq!(points_a_turn(&standing), None);
        assert_eq!(points_a_turn(&straight), None);
        assert_eq!(points_a_turn(&[]), None);
    }
}
