//! The columns of a CSV of all points: one row for each point of the body at each step.

use super::columns::{
    Cell, SEGMENT,
    Value::{Number, Whole},
};
use crate::physics::{PointMass, rotation};
use crate::run::Sample;
use crate::scenario::Scenario;
use nalgebra::Vector3;

#[derive(Debug)]
pub struct PointColumn {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    pub about: &'static str,
    cell: for<'a> fn(&PlacedPoint<'a>) -> Cell<'a>,
}

/// A point of the body under the name that it has in the CSV.
#[derive(Clone, Debug)]
pub(super) struct NamedPoint {
    /// Quoted where the CSV wants it.
    name: String,
    mass: PointMass,
    /// Whether it belongs to what does not spin beside a rotor.
    is_in_frame: bool,
}

/// A point of the body as it stands and moves at one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedPoint<'a> {
    point: &'a NamedPoint,
    sample: &'a Sample,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
}

const PLACE: &str = "the point, world frame";
const VELOCITY: &str = "velocity of the point, world frame";
const POINT: &str =
    "name of the point; rim.0 is the rim's first, a part's six stand along its own axes: wheel +x";

pub const POINT_COLUMNS: &[PointColumn] = &[
    column("step", "number of the time step", |p| {
        Cell::Number(Whole(p.sample.step))
    }),
    column("t_s", "time", |p| number(p.sample.time_s)),
    column("point", POINT, |p| Cell::Text(&p.point.name)),
    column("mass_kg", "mass of the point", |p| {
        number(p.point.mass.mass)
    }),
    column("x_m", PLACE, |p| number(p.position.x)),
    column("y_m", PLACE, |p| number(p.position.y)),
    column("z_m", PLACE, |p| number(p.position.z)),
    column("vx_m_per_s", VELOCITY, |p| number(p.velocity.x)),
    column("vy_m_per_s", VELOCITY, |p| number(p.velocity.y)),
    column("vz_m_per_s", VELOCITY, |p| number(p.velocity.z)),
    column("segment", SEGMENT, |p| {
        Cell::Number(Whole(p.sample.segment))
    }),
];

const fn column(
    name: &'static str,
    about: &'static str,
    cell: for<'a> fn(&PlacedPoint<'a>) -> Cell<'a>,
) -> PointColumn {
    PointColumn { name, about, cell }
}

fn number<'a>(number: f64) -> Cell<'a> {
    Cell::Number(Number(number))
}

impl PointColumn {
    pub fn find(name: &str) -> Option<&'static Self> {
        POINT_COLUMNS.iter().find(|column| column.name == name)
    }

    pub(super) fn cell<'a>(&self, point: &PlacedPoint<'a>) -> Cell<'a> {
        (self.cell)(point)
    }
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
}

impl<'a> PlacedPoint<'a> {
    /// `point` where the body stands as `sample` says; its velocity is ω x r, ω without the spin for a point of the frame.
    pub(super) fn new(point: &'a NamedPoint, sample: &'a Sample) -> Self {
        let (mut at, mut omega) = (point.mass.at, sample.angular_velocity);
        if point.is_in_frame {
            let axle = sample.orientation.column(2);
            at = rotation::about(&Vector3::z(), -sample.rotor_turn) * at;
            omega -= axle * axle.dot(&omega);
        }
        let position = sample.orientation * at;
        Self {
            point,
            sample,
            position,
            velocity: omega.cross(&position),
        }
    }
}
