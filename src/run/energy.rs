//! What an energy drift is measured in.

use crate::physics::{Body, observables};
use crate::scenario::Scenario;
use std::fmt;

/// M g |c| below this part of the kinetic energy at the start is no scale: the body is balanced, or nearly.
const LEAST_PART: f64 = 1e-9;
/// A centre of mass nearer to the pivot than this part of the body's size is at the pivot but for rounding.
const ROUNDING: f64 = 1e-12;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyUnit {
    /// M g |c|, c the centre of mass seen from the pivot.
    Weight,
    /// The kinetic energy at the start.
    KineticAtStart,
}

impl fmt::Display for EnergyUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Weight => "M g |c|",
            Self::KineticAtStart => "the kinetic energy at the start",
        })
    }
}

/// S, by which an energy drift is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyScale {
    /// Its size, J; above 0 and finite.
    pub size: f64,
    pub unit: EnergyUnit,
}

impl EnergyScale {
    /// M g |c|, or the kinetic energy at the start where M g |c| is below 1e-9 of it; `None` where both are 0 (M g |c| but
    /// for rounding), or beyond the range of numbers.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let body = &scenario.body.mechanics;
        let kinetic = observables::kinetic_energy(body, &scenario.start);
        let weight = scenario.motion.gravity.abs() * moment(body);
        let (size, unit) = if weight > 0.0 && weight >= LEAST_PART * kinetic {
            (weight, EnergyUnit::Weight)
        } else {
            (kinetic, EnergyUnit::KineticAtStart)
        };
        (size > 0.0 && size.is_finite()).then_some(Self { size, unit })
    }
}

/// M |c|, kg m; 0 where it is what rounding leaves of a sum that should be 0.
fn moment(body: &Body) -> f64 {
    let moment = body.first_moment().norm();
    let parts = body
        .points()
        .iter()
        .map(|point| point.mass * point.at.norm());
    if moment > ROUNDING * parts.sum::<f64>() {
        moment
    } else {
        0.0
    }
}
