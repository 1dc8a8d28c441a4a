//! Describes the swings of the tilt between two of its turning points.

use crate::engine::analysis::readouts::Readouts;
use crate::engine::text::number::{short, uncertain};

/// Returns a message with number, period and mean of the swings between `turns`, and with the theory in `readouts`;
/// `None` for fewer than two turning points.
///
/// `turns` contains the time (s) and the tilt (degrees) of each turning point.
pub(super) fn in_words(
    turns: &[(f64, f64)],
    time_step_s: f64,
    readouts: &Readouts,
) -> Option<String> {
    let ((begin_s, _), (end_s, _)) = turns.first().zip(turns.last())?;
    let middles: Vec<f64> = turns
        .windows(2)
        .map(|pair| 0.5 * (pair[0].1 + pair[1].1))
        .collect();
    let (parts, length_s) = (middles.len() as f64, end_s - begin_s);
    if middles.is_empty() {
        return None;
    }
    let swings = 0.5 * parts;
    // Each turning point is known to a time step. Its error is dt/sqrt(12) (root mean square).
    let period_sigma_s = time_step_s / 6.0_f64.sqrt() / swings;
    let mean_deg = middles.iter().sum::<f64>() / parts;
    let squares = middles.iter().map(|it| (it - mean_deg) * (it - mean_deg));
    let mean_sigma_deg = (squares.sum::<f64>() / (parts - 1.0).max(1.0) / parts).sqrt();
    let period = uncertain(length_s / swings, period_sigma_s)?;
    let mean = uncertain(mean_deg, mean_sigma_deg).map(|it| it.to_string());
    let period_of_theory_s = readouts.number("predicted_nutation_period_s");
    let theory = match (period_of_theory_s, readouts.predicted_tilt_range_deg()) {
        (Some(period_s), Some((low, high))) => {
            let predicted = period.to_the_same_digit(period_s);
            let asymmetry = readouts.theory.and_then(|theory| theory.of_mean_moment());
            let asymmetry = asymmetry.map_or(String::new(), |it| format!(" (asymmetry {it})"));
            let middle = short(0.5 * (low + high));
            format!("theory: {predicted} s, {middle} deg{asymmetry}")
        }
        _ => "no theory for this run".to_owned(),
    };
    Some(format!(
        "{swings} swings of the tilt in {} s: period {period} s, mean {} deg; {theory}",
        short(length_s),
        mean.unwrap_or_else(|| short(mean_deg)),
    ))
}
