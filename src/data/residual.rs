//! Measured less model: the one place where the two are held against each other.

use super::{Point, Quantity};

/// What is left of a measured value when the model's is taken away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// The row, from 0.
    pub row: usize,
    /// The measured value; of a direction, with the number of full turns that [`residuals`] gives it.
    pub measured: f64,
    /// One standard uncertainty of it, where it is stated.
    pub sigma: Option<f64>,
    /// The model's value.
    pub model: f64,
}

impl Residual {
    /// Measured less model, in the unit of both.
    pub fn value(&self) -> f64 {
        self.measured - self.model
    }

    /// The same in units of the uncertainty.
    pub fn in_sigmas(&self) -> Option<f64> {
        self.sigma.map(|sigma| self.value() / sigma)
    }
}

/// `points` against the values of `model`, one each.
///
/// Of a direction, such as the azimuth, the number of full turns is another for everybody who counts from another zero.
/// Where the values do not leave one turn, they are read as directions, and each is taken at the turn at which it is nearest
/// to the model. Where they were counted on through full turns, that count stays as it was measured, and all are shifted
/// by the same number of turns, so that the first is nearest to the model.
pub fn residuals(quantity: Option<&Quantity>, points: &[Point], model: &[f64]) -> Vec<Residual> {
    let is_direction = quantity.is_some_and(|quantity| quantity.is_direction);
    let shift = |index: usize| turns_deg(model[index] - points[index].value);
    let common = (is_counted(points) && !points.is_empty() && !model.is_empty()).then(|| shift(0));
    let pairs = points.iter().zip(model).enumerate();
    let all = pairs.map(|(index, (point, &model))| Residual {
        row: point.row,
        measured: if is_direction {
            point.value + common.unwrap_or_else(|| shift(index))
        } else {
            point.value
        },
        sigma: point.sigma,
        model,
    });
    all.collect()
}

/// Whether the directions of `points`, degrees, were counted on through full turns.
pub fn is_counted(points: &[Point]) -> bool {
    let values = || points.iter().map(|point| point.value);
    let (least, most) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    );
    most - least > 360.0
}

/// The full turns nearest to `angle_deg`, degrees.
fn turns_deg(angle_deg: f64) -> f64 {
    360.0 * (angle_deg / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(name: &str, values: &[f64], model: &[f64]) -> Vec<Residual> {
        let point = |(row, &value)| Point {
            row,
            value,
            sigma: Some(2.0),
        };
        let points: Vec<_> = values.iter().enumerate().map(point).collect();
        residuals(Quantity::find(name), &points, model)
    }

    #[test]
    fn directions_are_taken_at_the_nearest_turn_and_counted_turns_stay_counted() {
        for (measured, model, expected) in [
            (
                [352.0, 171.0, 349.0, 172.0],
                [-10.0, 170.0, 350.0, 530.0],
                [2.0, 1.0, -1.0, 2.0],
            ),
            // The model turns twice as fast: read as directions, the values would fit it.
            (
                [360.0, 540.0, 720.0, 900.0],
                [0.0, 540.0, 1080.0, 1620.0],
                [0.0, -360.0, -720.0, -1080.0],
            ),
        ] {
            let all = between("azimuth_deg", &measured, &model);
            let values: Vec<_> = all.iter().map(Residual::value).collect();
            assert_eq!(values, expected);
        }
    }

    #[test]
    fn a_tilt_is_taken_as_it_is() {
        let all = between("tilt_deg", &[1.0, 5.0], &[2.0, 361.0]);
        assert_eq!(all[1].value(), -356.0);
        assert_eq!(all[0].in_sigmas(), Some(-0.5));
    }
}
