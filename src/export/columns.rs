//! The table of CSV columns: every number of a [`Sample`] with its column name, and those that a CSV has on request.

use crate::physics::State;
use crate::run::Sample;
use crate::scenario::{Scenario, start};

#[derive(Debug)]
pub struct Column {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    pub about: &'static str,
    value: fn(&Sample) -> Value,
}

/// One field of a CSV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    Number(Value),
    Text(&'a str),
}

/// A number as it is written: a count without a decimal point, any other number so that it reads back as the same f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    Whole(u64),
    Number(f64),
}

use Value::{Number, Whole};

const TRACED: &str = "traced point, world frame";
const MOMENTUM: &str = "angular momentum about the pivot, world frame";
const OMEGA: &str = "angular velocity I^-1 L at this step, world frame";
const TILT: &str = "angle of the axle from +z";
const AZIMUTH: &str = "azimuth of the axle, counted on through full turns";
const ENERGY: &str = "kinetic energy, and that of the weight from the pivot";
pub(super) const SEGMENT: &str = "edits of time step, scheme or gravity before this step";

pub const COLUMNS: &[Column] = &[
    column("step", "number of the time step, 0 at the start", |s| {
        Whole(s.step)
    }),
    column("t_s", "time", |s| Number(s.time_s)),
    column("x_m", TRACED, |s| Number(s.position.x)),
    column("y_m", TRACED, |s| Number(s.position.y)),
    column("z_m", TRACED, |s| Number(s.position.z)),
    column("Lx_Js", MOMENTUM, |s| Number(s.momentum.x)),
    column("Ly_Js", MOMENTUM, |s| Number(s.momentum.y)),
    column("Lz_Js", MOMENTUM, |s| Number(s.momentum.z)),
    column("wx_rad_per_s", OMEGA, |s| Number(s.angular_velocity.x)),
    column("wy_rad_per_s", OMEGA, |s| Number(s.angular_velocity.y)),
    column("wz_rad_per_s", OMEGA, |s| Number(s.angular_velocity.z)),
    column("tilt_deg", TILT, |s| Number(s.tilt_deg)),
    column("azimuth_deg", AZIMUTH, |s| Number(s.azimuth_deg)),
    column("energy_J", ENERGY, |s| Number(s.energy)),
    column("segment", SEGMENT, |s| Whole(s.segment)),
];

/// A column that a CSV has where it is asked for: not every run has a use for it.
#[derive(Debug)]
pub struct OptionalColumn {
    /// Name with its unit, as in the header line.
    pub name: &'static str,
    pub about: &'static str,
    value: fn(&Scenario, &State) -> f64,
}

pub static OPTIONAL_COLUMNS: [OptionalColumn; 2] = [
    OptionalColumn {
        name: "spin_rpm",
        about: "rate of the spin about the axle",
        value: |scenario, state| start::rpm(scenario.spin_rad_per_s(state)),
    },
    OptionalColumn {
        name: "L_axle_Js",
        about: "angular momentum along the axle",
        value: |_, state| state.momentum.dot(&state.axle()),
    },
];

impl OptionalColumn {
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
