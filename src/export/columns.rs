//! The table of CSV columns: every number of a [`Sample`] with its column name.

use crate::run::Sample;
use serde::ser::{Serialize, SerializeTuple, Serializer};

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

/// Generates from one list both the table, for access by name, and the serializer of a row, which needs no look-up.
macro_rules! columns {
    ($($name:literal, $about:literal, $kind:ident($sample:ident $(. $field:ident)+);)*) => {
        /// Every column, in the order of the CSV.
        pub const COLUMNS: &[Column] = &[
            $(Column { name: $name, about: $about, value: |$sample| $kind($sample $(. $field)+) }),*
        ];

        impl Serialize for Row<'_> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let mut row = serializer.serialize_tuple(COLUMNS.len())?;
                $({
                    let $sample = self.0;
                    row.serialize_element(&($sample $(. $field)+))?;
                })*
                row.end()
            }
        }
    };
}

/// A sample as one row.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a>(pub &'a Sample);

columns! {
    "step", "number of the time step, 0 at the start", Whole(s.step);
    "t_s", "time", Number(s.time_s);
    "x_m", "traced point, world frame", Number(s.position.x);
    "y_m", "traced point, world frame", Number(s.position.y);
    "z_m", "traced point, world frame", Number(s.position.z);
    "Lx_Js", "angular momentum about the pivot, world frame", Number(s.momentum.x);
    "Ly_Js", "angular momentum about the pivot, world frame", Number(s.momentum.y);
    "Lz_Js", "angular momentum about the pivot, world frame", Number(s.momentum.z);
    "wx_rad_per_s", "angular velocity I^-1 L at this step, world frame", Number(s.angular_velocity.x);
    "wy_rad_per_s", "angular velocity I^-1 L at this step, world frame", Number(s.angular_velocity.y);
    "wz_rad_per_s", "angular velocity I^-1 L at this step, world frame", Number(s.angular_velocity.z);
    "tilt_deg", "angle of the axle from +z", Number(s.tilt_deg);
    "azimuth_deg", "azimuth of the axle, counted on through full turns", Number(s.azimuth_deg);
    "energy_J", "kinetic energy, and that of the weight from the pivot", Number(s.energy);
    "segment", "edits of time step, scheme or gravity before this step", Whole(s.segment);
}

impl Column {
    /// The column of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
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
