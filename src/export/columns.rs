//! The one table of columns: every number of a [`Sample`] under the name by which it leaves the program.

use crate::run::Sample;
use serde::{Serialize, Serializer};

/// A column of the CSV.
#[derive(Debug)]
pub struct Column {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    /// What it holds, in one line.
    pub about: &'static str,
    value: fn(&Sample) -> Value,
}

/// A number as it is written: counts without a point, all else so that it reads back to the same f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A count.
    Whole(u64),
    /// A measured number.
    Number(f64),
}

use Value::{Number, Whole};

/// Every column, in the order of the CSV.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    Column { name: "step", about: "number of the time step, 0 at the start", value: |s| Whole(s.step) },
    Column { name: "t_s", about: "time", value: |s| Number(s.time_s) },
    Column { name: "x_m", about: "traced point, world frame", value: |s| Number(s.position.x) },
    Column { name: "y_m", about: "traced point, world frame", value: |s| Number(s.position.y) },
    Column { name: "z_m", about: "traced point, world frame", value: |s| Number(s.position.z) },
    Column { name: "Lx_Js", about: "angular momentum about the pivot, world frame", value: |s| Number(s.momentum.x) },
    Column { name: "Ly_Js", about: "angular momentum about the pivot, world frame", value: |s| Number(s.momentum.y) },
    Column { name: "Lz_Js", about: "angular momentum about the pivot, world frame", value: |s| Number(s.momentum.z) },
    Column { name: "wx_rad_per_s", about: "angular velocity I^-1 L at this step, world frame", value: |s| Number(s.angular_velocity.x) },
    Column { name: "wy_rad_per_s", about: "angular velocity I^-1 L at this step, world frame", value: |s| Number(s.angular_velocity.y) },
    Column { name: "wz_rad_per_s", about: "angular velocity I^-1 L at this step, world frame", value: |s| Number(s.angular_velocity.z) },
    Column { name: "tilt_deg", about: "angle of the axle from +z", value: |s| Number(s.tilt_deg) },
    Column { name: "azimuth_deg", about: "azimuth of the axle, counted on through full turns", value: |s| Number(s.azimuth_deg) },
    Column { name: "energy_J", about: "kinetic energy, and that of the weight from the pivot", value: |s| Number(s.energy) },
    Column { name: "segment", about: "edits of time step, scheme or gravity before this step", value: |s| Whole(s.segment) },
];

impl Column {
    /// The column of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
    }

    /// What `sample` has in this column.
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

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Whole(count) => serializer.serialize_u64(count),
            Number(number) => serializer.serialize_f64(number),
        }
    }
}

/// A sample as one row.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a>(pub &'a Sample);

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(COLUMNS.iter().map(|column| column.value(self.0)))
    }
}
