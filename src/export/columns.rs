//! The table of CSV columns: every number of a [`Sample`] with its column name.

use crate::run::Sample;

/// A column of the CSV.
#[derive(Debug)]
pub struct Column {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    /// What it holds, in one line.
    pub about: &'static str,
    value: fn(&Sample) -> Value,
}

/// What stands in one field of a CSV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number.
    Number(Value),
    /// A text, such as the name of a point.
    Text(&'a str),
}

/// A number as it is written: a count without a decimal point, any other number so that it reads back as the same f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A count.
    Whole(u64),
    /// A measured number.
    Number(f64),
}

use Value::{Number, Whole};

/// Every column, in the order of the CSV.
pub const COLUMNS: &[Column] = &[
    column("step", "number of the time step, 0 at the start", |s| {
        Whole(s.step)
    }),
    column("t_s", "time", |s| Number(s.time_s)),
    column("x_m", "traced point, world frame", |s| Number(s.position.x)),
    column("y_m", "traced point, world frame", |s| Number(s.position.y)),
    column("z_m", "traced point, world frame", |s| Number(s.position.z)),
    column(
        "Lx_Js",
        "angular momentum about the pivot, world frame",
        |s| Number(s.momentum.x),
    ),
    column(
        "Ly_Js",
        "angular momentum about the pivot, world frame",
        |s| Number(s.momentum.y),
    ),
    column(
        "Lz_Js",
        "angular momentum about the pivot, world frame",
        |s| Number(s.momentum.z),
    ),
    column(
        "wx_rad_per_s",
        "angular velocity I^-1 L at this step, world frame",
        |s| Number(s.angular_velocity.x),
    ),
    column(
        "wy_rad_per_s",
        "angular velocity I^-1 L at this step, world frame",
        |s| Number(s.angular_velocity.y),
    ),
    column(
        "wz_rad_per_s",
        "angular velocity I^-1 L at this step, world frame",
        |s| Number(s.angular_velocity.z),
    ),
    column("tilt_deg", "angle of the axle from +z", |s| {
        Number(s.tilt_deg)
    }),
    column(
        "azimuth_deg",
        "azimuth of the axle, counted on through full turns",
        |s| Number(s.azimuth_deg),
    ),
    column(
        "energy_J",
        "kinetic energy, and that of the weight from the pivot",
        |s| Number(s.energy),
    ),
    column(
        "segment",
        "edits of time step, scheme or gravity before this step",
        |s| Whole(s.segment),
    ),
];

const fn column(name: &'static str, about: &'static str, value: fn(&Sample) -> Value) -> Column {
    Column { name, about, value }
}

impl Column {
    /// The column of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
    }

    /// Its field in the row of `sample`.
    pub(super) fn cell(&self, sample: &Sample) -> Cell<'_> {
        Cell::Number(self.value(sample))
    }

    /// The value of `sample` in this column.
    pub fn value(&self, sample: &Sample) -> Value {
        (self.value)(sample)
    }
}

impl Value {
    /// The value as a floating-point number.
    pub fn number(self) -> f64 {
        match self {
            Whole(count) => count as f64,
            Number(number) => number,
        }
    }
}
