//! Paths of which a figure shows too few points: straight lines between them cut the bends off.
//!
//! A run that takes ten time steps for a turn of its path is drawn as chords, which lie inside the circle that its points lie
//! on. Beside the exact motion that looks like an error of the run. Of the exact motion itself, too, there are no more points
//! than so many in a long stretch of time.

use super::request::Drawn;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A path with more points than this in a turn, on the average, looks round: the chords are off it by 1.5 % of its radius.
const ROUND: f64 = 18.0;
/// Of fewer bends than these there is no average.
const FEWEST: u32 = 3;
/// About so many points of a path are looked at.
const LOOKED_AT: usize = 50_000;

/// How many points there are to a turn of `path` (m), where they are too few to look round.
fn points_a_turn(path: &[[f64; 3]]) -> Option<f64> {
    let angles = path.windows(3).step_by(1 + path.len() / LOOKED_AT);
    let angles = angles.filter_map(|three| {
        let [a, b, c] = [0, 1, 2].map(|place| Vector3::from(three[place]));
        let moves = a != b && b != c;
        moves.then(|| (b - a).angle(&(c - b)))
    });
    let (count, sum) = angles.fold((0, 0.0), |(count, sum), angle| (count + 1, sum + angle));
    let a_turn = TAU * f64::from(count) / sum;
    (count >= FEWEST && a_turn < ROUND).then_some(a_turn)
}

/// The name of what is drawn; of a path in chords it says so.
pub(super) fn name(drawn: &Drawn) -> String {
    let is_in_chords = points_a_turn(&drawn.course.path).is_some();
    match is_in_chords && !drawn.name.is_empty() {
        true => format!("{}, points joined", drawn.name),
        false => drawn.name.clone(),
    }
}

/// What is said of the first of `drawn` whose path is in chords.
pub(super) fn warning(drawn: &[Drawn]) -> Option<String> {
    drawn.iter().find_map(|drawn| {
        let a_turn = points_a_turn(&drawn.course.path)?;
        let of = match drawn.name.as_str() {
            "" => String::new(),
            name => format!(" of {name}"),
        };
        Some(format!(
            "the line{of} joins points, about {a_turn:.0} to a turn: between them it cuts the bends off, where nothing was computed"
        ))
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
        let standing = vec![[1.0, 0.0, 0.0]; 100];
        let straight: Vec<_> = (0..100).map(|step| [f64::from(step), 0.0, 0.0]).collect();
        assert_eq!(points_a_turn(&standing), None);
        assert_eq!(points_a_turn(&straight), None);
        assert_eq!(points_a_turn(&[]), None);
    }
}
