//! The table of CSV columns: every number of a [`Sample`] with its column name, and those that a CSV has on request.

use crate::physics::State;
use crate::run::Sample;
use crate::scenario::{Scenario, start};

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

/// A column that a CSV has where it is asked for: not every run has a use for it.
#[derive(Debug)]
pub struct OptionalColumn {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    /// What it holds, in one line.
    pub about: &'static str,
    value: fn(&Scenario, &State) -> f64,
}

/// Every column on request.
pub static OPTIONAL_COLUMNS: [OptionalColumn; 2] = [SPIN, L_AXLE];

const SPIN: OptionalColumn = OptionalColumn {
    name: "spin_rpm",
    about: "rate of the spin about the axle",
    value: |scenario, state| start::rpm(scenario.spin_rad_per_s(state)),
};

const L_AXLE: OptionalColumn = OptionalColumn {
    name: "L_axle_Js",
    about: "angular momentum along the axle",
    value: |_, state| state.momentum.dot(&state.axle()),
};

impl OptionalColumn {
    /// The column of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        OPTIONAL_COLUMNS.iter().find(|column| column.name == name)
    }

    /// The value in `state` of a run of `scenario`.
    pub fn of(&self, scenario: &Scenario, state: &State) -> f64 {
        (self.value)(scenario, state)
    }

    /// The value at `sample`, which is of a run of `scenario`.
    pub fn value(&self, scenario: &Scenario, sample: &Sample) -> f64 {
        let state = State {
            time_s: sample.time_s,
            orientation: sample.orientation,
            momentum: sample.momentum,
        };
        self.of(scenario, &state)
    }
}

/// A column that a CSV was asked for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Chosen {
    Usual(&'static Column),
    Optional(&'static OptionalColumn),
}

impl Chosen {
    /// The names of all there are.
    pub(super) fn names() -> impl Iterator<Item = &'static str> + Clone {
        let usual = COLUMNS.iter().map(|column| column.name);
        usual.chain(OPTIONAL_COLUMNS.iter().map(|column| column.name))
    }

    /// The column of that name.
    pub(super) fn find(name: &str) -> Option<Self> {
        let optional = || OptionalColumn::find(name).map(Self::Optional);
        Column::find(name).map(Self::Usual).or_else(optional)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Usual(column) => column.name,
            Self::Optional(column) => column.name,
        }
    }

    /// Its field in the row of `sample`, which is of a run of `scenario`.
    pub(super) fn cell(self, scenario: &Scenario, sample: &Sample) -> Cell<'static> {
        Cell::Number(match self {
            Self::Usual(column) => column.value(sample),
            Self::Optional(column) => Number(column.value(scenario, sample)),
        })
    }
}

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
