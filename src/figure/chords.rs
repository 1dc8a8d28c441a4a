//! Paths of which a figure shows too few points: straight lines between them cut the bends off.
//!
//! A run that takes ten time steps for a turn of its path is drawn as chords, which lie inside the circle that its points lie
//! on. Beside the exact motion that looks like an error of the run.

use super::request::Drawn;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A path with more points than this in a turn, on the average, looks round: the chords are off it by 1.5 % of its radius.
const ROUND: f64 = 18.0;
/// A path bends where so many of its points, at least, turn on.
const FEWEST: usize = 4;

/// How many points there are to a turn of `path` (m), where they are too few to look round.
fn points_a_turn(path: &[[f64; 3]]) -> Option<f64> {
    let steps = path
        .windows(2)
        .map(|pair| Vector3::from(pair[1]) - Vector3::from(pair[0]));
    let steps: Vec<_> = steps.filter(|step| step.norm() > 0.0).collect();
    if steps.len() < FEWEST {
        return None;
    }
    let angles = steps.windows(2).map(|pair| pair[0].angle(&pair[1]));
    let a_turn = TAU * (steps.len() - 1) as f64 / angles.sum::<f64>();
    (a_turn < ROUND).then_some(a_turn)
}

/// The name of what is drawn; of a path in chords it says so.
pub(super) fn name(drawn: &Drawn) -> String {
    let is_in_chords = points_a_turn(&drawn.course.path).is_some();
    match is_in_chords && !drawn.name.is_empty() {
        true => format!("{}, steps joined", drawn.name),
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
            "the line{of} joins time steps, about {a_turn:.0} to a turn: between them it cuts the bends off, and the run says nothing"
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
