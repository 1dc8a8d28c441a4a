//! The points of the body as rows of a CSV: their names, where they stand, and how they move.

use crate::physics::{PointMass, rotation};
use crate::run::Sample;
use crate::scenario::Scenario;
use nalgebra::Vector3;

/// A point of the body under the name that it has in the CSV.
#[derive(Clone, Debug)]
pub(super) struct NamedPoint {
    /// Quoted where the CSV wants it.
    name: String,
    mass: PointMass,
    /// Whether it belongs to what does not spin beside a rotor.
    is_in_frame: bool,
}

/// A point of the body at one step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlacedPoint<'a> {
    pub name: &'a str,
    pub mass: f64,
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
}

impl NamedPoint {
    /// The points of `scenario`'s body in its order: the rim's as `rim.0`, `rim.1` and so on, every other by its
    /// [name](Scenario::point_name), which `field` makes fit for the CSV.
    pub(super) fn all_of(scenario: &Scenario, field: impl Fn(&str) -> String) -> Vec<Self> {
        let body = &scenario.body;
        let points = body.mechanics.points();
        let rotor = scenario.rotor().map(|part| body.points_of_part(part));
        let named = points.iter().enumerate().map(|(index, mass)| Self {
            name: match scenario.point_name(index) {
                Some(name) => field(&name),
                None => format!("rim.{index}"),
            },
            mass: *mass,
            is_in_frame: rotor.as_ref().is_some_and(|rotor| !rotor.contains(&index)),
        });
        named.collect()
    }

    /// The point where the body stands as `sample` says; its velocity is ω x r, ω without the spin for a point of the frame.
    pub(super) fn placed(&self, sample: &Sample) -> PlacedPoint<'_> {
        let (mut at, mut omega) = (self.mass.at, sample.angular_velocity);
        if self.is_in_frame {
            let axle = sample.orientation.column(2);
            at = rotation::about(&Vector3::z(), -sample.rotor_turn) * at;
            omega -= axle * axle.dot(&omega);
        }
        let position = sample.orientation * at;
        PlacedPoint {
            name: &self.name,
            mass: self.mass.mass,
            position,
            velocity: omega.cross(&position),
        }
    }
}
