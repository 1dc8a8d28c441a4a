//! The tables of CSV columns: every number of a step with its column name, those that a CSV has on request, and those of a
//! CSV with a row for each point of the body.

use crate::physics::{PointMass, State, rotation};
use crate::run::Sample;
use crate::scenario::{Scenario, start};
use nalgebra::Vector3;

#[derive(Debug)]
pub struct CsvColumn {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    pub about: &'static str,
    pub(super) cell: for<'a> fn(&CsvRow<'a>) -> CsvCell<'a>,
}

/// What a row is of: a step, in a CSV of all points a point at that step.
#[derive(Clone, Copy)]
pub(super) struct CsvRow<'a> {
    pub scenario: &'a Scenario,
    pub sample: &'a Sample,
    pub point: PlacedPoint<'a>,
}

/// A field: a count without a decimal point, any other number so that it reads back as the same f64, or a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CsvCell<'a> {
    Whole(u64),
    Number(f64),
    Text(&'a str),
    /// An empty field.
    Nothing,
}

use CsvCell::{Nothing, Number, Text, Whole};

const TRACED_TEXT: &str = "traced point, world frame";
const MOMENTUM_TEXT: &str = "angular momentum about the pivot, world frame";
const OMEGA_TEXT: &str = "angular velocity I^-1 L at this step, world frame";
const OMEGA_OF_BODY: &str = "angular velocity along the body's own x, y or axle";
const TILT: &str = "angle of the axle from +z";
const AZIMUTH: &str = "azimuth of the axle, counted on through full turns";
const ENERGY: &str = "kinetic energy, and that of the weight from the pivot";
const DISTANCE_TEXT: &str =
    "distance of the traced point from the exact motion; empty where that is not known";
const SEGMENT: &str = "edits of time step, scheme or gravity before this step";

pub const COLUMNS: &[CsvColumn] = &[
    column("step", "number of the time step, 0 at the start", |r| {
        Whole(r.sample.step)
    }),
    column("t_s", "time", |r| Number(r.sample.time_s)),
    column("x_m", TRACED_TEXT, |r| Number(r.sample.position.x)),
    column("y_m", TRACED_TEXT, |r| Number(r.sample.position.y)),
    column("z_m", TRACED_TEXT, |r| Number(r.sample.position.z)),
    column("Lx_Js", MOMENTUM_TEXT, |r| Number(r.sample.momentum.x)),
    column("Ly_Js", MOMENTUM_TEXT, |r| Number(r.sample.momentum.y)),
    column("Lz_Js", MOMENTUM_TEXT, |r| Number(r.sample.momentum.z)),
    column("wx_rad_per_s", OMEGA_TEXT, |r| {
        Number(r.sample.angular_velocity.x)
    }),
    column("wy_rad_per_s", OMEGA_TEXT, |r| {
        Number(r.sample.angular_velocity.y)
    }),
    column("wz_rad_per_s", OMEGA_TEXT, |r| {
        Number(r.sample.angular_velocity.z)
    }),
    column("tilt_deg", TILT, |r| Number(r.sample.tilt_deg)),
    column("azimuth_deg", AZIMUTH, |r| Number(r.sample.azimuth_deg)),
    column("energy_J", ENERGY, |r| Number(r.sample.energy)),
    column("segment", SEGMENT, |r| Whole(r.sample.segment)),
];

/// Columns that a CSV has where they are asked for: not every run has a use for them.
pub const OPTIONAL_COLUMNS: &[CsvColumn] = &[
    column("spin_rpm", "rate of the spin about the axle", |r| {
        Number(start::rpm(r.scenario.spin_rad_per_s(&r.state())))
    }),
    column("L_axle_Js", "angular momentum along the axle", |r| {
        Number(r.sample.momentum.dot(&r.state().axle()))
    }),
    column(
        "foot_force_N",
        "vertical force of the floor on the foot",
        |r| Number(r.sample.foot_force),
    ),
    column("w1_rad_per_s", OMEGA_OF_BODY, |r| {
        Number(r.sample.omega().x)
    }),
    column("w2_rad_per_s", OMEGA_OF_BODY, |r| {
        Number(r.sample.omega().y)
    }),
    column("w3_rad_per_s", OMEGA_OF_BODY, |r| {
        Number(r.sample.omega().z)
    }),
    column(DISTANCE, DISTANCE_TEXT, |r| {
        r.sample.distance_m.map_or(Nothing, Number)
    }),
];

/// The column of the distance from the exact motion, which whoever writes it has to compute.
pub const DISTANCE: &str = "distance_m";

const PLACE_TEXT: &str = "the point, world frame";
const VELOCITY: &str = "velocity of the point, world frame";
const POINT: &str =
    "name of the point; rim.0 is the rim's first, a part's six stand along its own axes: wheel +x";

/// The columns of a CSV of all points: one row for each point of the body at each step.
pub const POINT_COLUMNS: &[CsvColumn] = &[
    column("step", "number of the time step", |r| Whole(r.sample.step)),
    column("t_s", "time", |r| Number(r.sample.time_s)),
    column("point", POINT, |r| Text(r.point.name)),
    column("mass_kg", "mass of the point", |r| Number(r.point.mass)),
    column("x_m", PLACE_TEXT, |r| Number(r.point.position.x)),
    column("y_m", PLACE_TEXT, |r| Number(r.point.position.y)),
    column("z_m", PLACE_TEXT, |r| Number(r.point.position.z)),
    column("vx_m_per_s", VELOCITY, |r| Number(r.point.velocity.x)),
    column("vy_m_per_s", VELOCITY, |r| Number(r.point.velocity.y)),
    column("vz_m_per_s", VELOCITY, |r| Number(r.point.velocity.z)),
    column("segment", SEGMENT, |r| Whole(r.sample.segment)),
];

const fn column(
    name: &'static str,
    about: &'static str,
    cell: for<'a> fn(&CsvRow<'a>) -> CsvCell<'a>,
) -> CsvColumn {
    CsvColumn { name, about, cell }
}

impl CsvColumn {
    /// The column of that name which every CSV of a run has.
    pub fn find(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
    }

    /// Every column of a run, those on request last.
    pub fn all() -> impl Iterator<Item = &'static Self> + Clone {
        COLUMNS.iter().chain(OPTIONAL_COLUMNS)
    }

    pub fn value(&self, scenario: &Scenario, sample: &Sample) -> f64 {
        match (self.cell)(&CsvRow::new(scenario, sample)) {
            Whole(count) => count as f64,
            Number(number) => number,
            Text(_) | Nothing => f64::NAN,
        }
    }
}

impl<'a> CsvRow<'a> {
    pub fn new(scenario: &'a Scenario, sample: &'a Sample) -> Self {
        let point = PlacedPoint::default();
        Self {
            scenario,
            sample,
            point,
        }
    }

    fn state(&self) -> State {
        self.sample.state()
    }
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
