//! One time step of a run, whole: everything that shows, measures, explains or exports a step reads this.

use crate::physics::observables::{self, Azimuth};
use crate::physics::{Body, Loads, State, Workings};
use crate::scenario::{Motion, Scenario};
use nalgebra::{Matrix3, Vector3};
use std::cell::OnceCell;
use std::fmt;
use std::sync::Arc;

/// The step at which a run stands, as the [simulation](super::Simulation) publishes it. What is read off it is computed
/// when it is first asked for, and once, however many ask.
#[derive(Clone, Debug)]
pub struct Step {
    pub(super) scenario: Arc<Scenario>,
    pub(super) number: u64,
    pub(super) segment: u64,
    pub(super) motion: Motion,
    pub(super) loads: Loads,
    pub(super) changes: u64,
    pub(super) before: State,
    pub(super) after: State,
    pub(super) azimuth: Azimuth,
    pub(super) energy: EnergyAccount,
    pub(super) rotor_turn: f64,
    pub(super) workings: Option<Arc<Workings>>,
    pub(super) derived: Derived,
}

/// What the energy would be if the scheme made no error.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyAccount {
    /// Energy at the start, J.
    pub start: f64,
    /// Work of pushes and of edits of gravity since then, J.
    pub work: f64,
    /// Work of friction since then, J: 0, or less.
    pub friction: f64,
    /// What its error is measured in; `None` where there is nothing to measure it by.
    pub scale: Option<EnergyScale>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Derived {
    position: OnceCell<Vector3<f64>>,
    angular_velocity: OnceCell<Vector3<f64>>,
    tilt_deg: OnceCell<f64>,
    energy: OnceCell<f64>,
}

impl EnergyAccount {
    pub fn new(scenario: &Scenario) -> Self {
        let (body, state) = (&scenario.body.mechanics, &scenario.start);
        let kinetic = observables::kinetic_energy(body, state);
        Self {
            start: kinetic + scenario.motion.gravity * observables::weight_height(body, state),
            work: 0.0,
            friction: 0.0,
            scale: EnergyScale::find(scenario),
        }
    }
}

impl Step {
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    /// Its number: step 1 leads from the start to t = dt. 0 at the start, where no step has been taken.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Gravity, scheme and time step with which it was taken (at the start: those of the first).
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Returns the forces that acted on it, those at its end if they changed (at the start: gravity alone).
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Returns how often the forces have changed so far, edits of the time step and the scheme counted in: a period or
    /// rate that is measured across such a change belongs to no motion.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Returns the state before it; `None` at the start.
    pub fn before(&self) -> Option<&State> {
        (self.number > 0).then_some(&self.before)
    }

    pub fn after(&self) -> &State {
        &self.after
    }

    pub fn time_s(&self) -> f64 {
        self.after.time_s
    }

    /// Returns what the scheme computed on the way; `None` at the start, and where nobody has [asked for
    /// it](super::Simulation::keep_workings).
    pub fn workings(&self) -> Option<&Arc<Workings>> {
        self.workings.as_ref()
    }

    /// Returns the axle's azimuth after it, counted on through full turns.
    pub fn azimuth(&self) -> &Azimuth {
        &self.azimuth
    }

    /// Returns the traced point, world frame, m.
    #[inline]
    pub fn position(&self) -> &Vector3<f64> {
        self.derived.position.get_or_init(|| {
            let body = &self.scenario.body.mechanics;
            observables::position(body, &self.after, self.scenario.trace)
        })
    }

    /// ω = I⁻¹L after it, world frame, rad/s.
    #[inline]
    pub fn angular_velocity(&self) -> &Vector3<f64> {
        self.derived.angular_velocity.get_or_init(|| {
            observables::angular_velocity(&self.scenario.body.mechanics, &self.after)
        })
    }

    /// Angle of the axle from +z, degrees.
    #[inline]
    pub fn tilt_deg(&self) -> f64 {
        let tilt = &self.derived.tilt_deg;
        *tilt.get_or_init(|| observables::tilt_deg(&self.after))
    }

    /// Kinetic and potential energy, from the pivot, J.
    #[inline]
    pub fn energy(&self) -> f64 {
        *self.derived.energy.get_or_init(|| {
            let kinetic = 0.5 * self.after.momentum.dot(self.angular_velocity());
            let body = &self.scenario.body.mechanics;
            kinetic + self.motion.gravity * observables::weight_height(body, &self.after)
        })
    }

    /// Work of friction since the start, J, as [the scheme](crate::physics::Scheme::friction_work) has it: 0, or less.
    pub fn friction_work(&self) -> f64 {
        self.energy.friction
    }

    /// (E − E₀ − W)/S: the energy that only the scheme's error can have made, W the work of pushes, of edits of gravity and
    /// of friction, S as [`EnergyScale`] has it; `None` where there is no S, or the drift is beyond the range of numbers.
    pub fn energy_drift(&self) -> Option<f64> {
        let gained = self.energy() - self.energy.start - self.energy.work - self.energy.friction;
        let drift = gained / self.energy.scale?.size;
        drift.is_finite().then_some(drift)
    }

    /// Returns what the energy drift is measured in; `None` where there is nothing to measure it by.
    pub fn energy_unit(&self) -> Option<EnergyUnit> {
        self.energy.scale.map(|scale| scale.unit)
    }

    /// Lets a rotor turn in its frame as it spun from the state before it to the one after it: by the mean of both rates, an
    /// error of the second order in the time step where friction slows it, else none.
    #[inline]
    pub(super) fn turn_rotor(&mut self) {
        if self.scenario.body.mechanics.frame_moment() != 0.0 {
            let rates =
                [&self.before, &self.after].map(|state| self.scenario.spin_rad_per_s(state));
            self.rotor_turn +=
                0.5 * (rates[0] + rates[1]) * (self.after.time_s - self.before.time_s);
        }
    }

    /// Its numbers as they leave the program.
    pub fn sample(&self) -> Sample {
        Sample {
            step: self.number,
            time_s: self.after.time_s,
            orientation: self.after.orientation,
            position: *self.position(),
            momentum: self.after.momentum,
            angular_velocity: *self.angular_velocity(),
            tilt_deg: self.tilt_deg(),
            azimuth_deg: self.azimuth.degrees(),
            energy: self.energy(),
            foot_force: observables::pivot_force_z(
                &self.scenario.body.mechanics,
                &self.after,
                &self.loads,
            ),
            rotor_turn: self.rotor_turn,
            segment: self.segment,
        }
    }

    /// Returns whether every number read off the state is finite: squares leave the range of numbers before L itself
    /// does. A finite energy means a finite Omega too.
    pub(super) fn can_be_read(&self) -> bool {
        self.energy().is_finite() && self.position().iter().all(|c| c.is_finite())
    }
}

/// The state at one step as it leaves the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of the step, 0 at the start.
    pub step: u64,
    pub time_s: f64,
    /// Orientation: turns body-frame vectors into world-frame ones.
    pub orientation: Matrix3<f64>,
    /// The traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Angular momentum about the pivot, world frame, J s.
    pub momentum: Vector3<f64>,
    /// ω = I⁻¹L at this state, world frame, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// Angle of the axle from +z, degrees.
    pub tilt_deg: f64,
    /// Azimuth of the axle, counted on through full turns, degrees.
    pub azimuth_deg: f64,
    /// Kinetic and potential energy, from the pivot, J.
    pub energy: f64,
    /// Vertical force of the floor on the foot, N.
    pub foot_force: f64,
    /// The angle about the axle by which a rotor has turned in its frame since the start, rad; 0 where the whole body spins.
    pub rotor_turn: f64,
    /// The number of edits of time step, scheme or gravity before this step.
    pub segment: u64,
}

impl Sample {
    /// ω along the body's own x, y and axle, rad/s: what an instrument on the body measures.
    pub fn omega(&self) -> Vector3<f64> {
        self.orientation.tr_mul(&self.angular_velocity)
    }
}

/// M g |c| below this part of the kinetic energy at the start is no scale: the body is balanced, or nearly.
const LEAST_ENERGY_PART: f64 = 1e-9;
/// A centre of mass nearer to the pivot than this part of the body's size is at the pivot but for rounding.
const CENTER_ROUNDING: f64 = 1e-12;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyUnit {
    /// M g |c|, c the centre of mass seen from the pivot.
    Weight,
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
    /// Returns M g |c|, or the kinetic energy at the start where M g |c| is below 1e-9 of it; `None` where both are 0 (M g
    /// |c| up to rounding), or beyond the range of numbers.
    pub fn find(scenario: &Scenario) -> Option<Self> {
        let body = &scenario.body.mechanics;
        let kinetic = observables::kinetic_energy(body, &scenario.start);
        let weight = scenario.motion.gravity.abs() * first_moment(body);
        let (size, unit) = if weight > 0.0 && weight >= LEAST_ENERGY_PART * kinetic {
            (weight, EnergyUnit::Weight)
        } else {
            (kinetic, EnergyUnit::KineticAtStart)
        };
        (size > 0.0 && size.is_finite()).then_some(Self { size, unit })
    }
}

/// Returns M |c|, kg m; 0 where rounding leaves it of a sum that should be 0.
fn first_moment(body: &Body) -> f64 {
    let first_moment = body.first_moment().norm();
    let points = body.points().iter();
    let parts: f64 = points.map(|point| point.mass * point.at.norm()).sum();
    if first_moment > CENTER_ROUNDING * parts {
        first_moment
    } else {
        0.0
    }
}
