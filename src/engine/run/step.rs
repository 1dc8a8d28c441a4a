//! The record of one time step of a run. All code that shows, measures, explains or exports a step reads it.

use crate::physics::observables::{self, Azimuth};
use crate::physics::{Body, Loads, State, Workings};
use crate::scenario::{Motion, Scenario};
use nalgebra::{Matrix3, Vector3};
use std::cell::OnceCell;
use std::fmt;
use std::sync::Arc;

/// A step of a run, as the [simulation](super::Simulation) publishes it. Derived numbers are computed once, when they
/// are first read.
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

/// Terms of the energy balance, which the energy would satisfy if the scheme made no error.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyAccount {
    /// Energy at the start, J.
    pub start: f64,
    /// Work of pushes and of edits of gravity since then, J.
    pub work: f64,
    /// Work of friction since then, J. It is never positive.
    pub friction: f64,
    /// Unit of the energy error. `None` if there is nothing to measure it by.
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
        Self {
            start: observables::total_energy(body, state, scenario.motion.gravity),
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

    /// Returns the number of the step. Step 1 leads from the start to t = dt. It is 0 at the start.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns gravity, scheme and time step of this step (at the start: of the first step).
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Returns the forces during the step, or those at its end if they changed (at the start: gravity alone).
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Returns how often the forces have changed so far. Edits of the time step and the scheme count too. A period or
    /// rate that is measured across such a change belongs to no single motion.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Returns the state before the step. `None` at the start.
    pub fn before(&self) -> Option<&State> {
        (self.number > 0).then_some(&self.before)
    }

    pub fn after(&self) -> &State {
        &self.after
    }

    pub fn time_s(&self) -> f64 {
        self.after.time_s
    }

    /// Returns the intermediate results of the scheme. `None` at the start, or if they [are not
    /// kept](super::Simulation::keep_workings).
    pub fn workings(&self) -> Option<&Arc<Workings>> {
        self.workings.as_ref()
    }

    /// Returns the axle's azimuth after the step, with all full turns.
    pub fn azimuth(&self) -> &Azimuth {
        &self.azimuth
    }

    /// Returns the position of the traced point, world frame, m.
    #[inline]
    pub fn position(&self) -> &Vector3<f64> {
        self.derived.position.get_or_init(|| {
            let body = &self.scenario.body.mechanics;
            observables::position(body, &self.after, self.scenario.trace)
        })
    }

    /// Returns ω = I⁻¹L after the step, world frame, rad/s.
    #[inline]
    pub fn angular_velocity(&self) -> &Vector3<f64> {
        self.derived.angular_velocity.get_or_init(|| {
            observables::angular_velocity(&self.scenario.body.mechanics, &self.after)
        })
    }

    /// Returns the angle of the axle from +z, degrees.
    #[inline]
    pub fn tilt_deg(&self) -> f64 {
        let tilt = &self.derived.tilt_deg;
        *tilt.get_or_init(|| observables::tilt_deg(&self.after))
    }

    /// Returns the kinetic and potential energy, J. The potential energy is 0 at the height of the pivot.
    #[inline]
    pub fn energy(&self) -> f64 {
        *self.derived.energy.get_or_init(|| {
            let kinetic = 0.5 * self.after.momentum.dot(self.angular_velocity());
            let body = &self.scenario.body.mechanics;
            kinetic + self.motion.gravity * observables::weight_height(body, &self.after)
        })
    }

    /// Returns the work of friction since the start, J, according to [the
    /// scheme](crate::physics::Scheme::friction_work). It is never positive.
    pub fn friction_work(&self) -> f64 {
        self.energy.friction
    }

    /// Returns the energy error (E − E₀ − W)/S, which only the scheme can have caused. W is the work of pushes, of
    /// edits of gravity and of friction, and S is the [`EnergyScale`]. `None` if there is no S, or the error is beyond
    /// the range of numbers.
    pub fn energy_drift(&self) -> Option<f64> {
        let gained = self.energy() - self.energy.start - self.energy.work - self.energy.friction;
        let drift = gained / self.energy.scale?.size;
        drift.is_finite().then_some(drift)
    }

    /// Returns the unit of the energy error. `None` if there is nothing to measure it by.
    pub fn energy_unit(&self) -> Option<EnergyUnit> {
        self.energy.scale.map(|scale| scale.unit)
    }

    /// Turns a rotor in its frame by its mean spin from the state before the step to the state after it. With friction,
    /// the error is of second order in the time step. Otherwise there is none.
    #[inline]
    pub(super) fn turn_rotor(&mut self) {
        if self.scenario.body.mechanics.frame_moment() != 0.0 {
            let rates =
                [&self.before, &self.after].map(|state| self.scenario.spin_rad_per_s(state));
            self.rotor_turn +=
                0.5 * (rates[0] + rates[1]) * (self.after.time_s - self.before.time_s);
        }
    }

    /// Returns the numbers of the step for output.
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
            distance_m: None,
        }
    }

    /// Returns true if every number computed from the state is finite. Squares leave the range of numbers before L
    /// itself does. If the energy is finite, Omega is finite too.
    pub(super) fn can_be_read(&self) -> bool {
        self.energy().is_finite() && self.position().iter().all(|c| c.is_finite())
    }
}

/// State at one step, for output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of the step; 0 at the start.
    pub step: u64,
    pub time_s: f64,
    /// Orientation, which turns body-frame vectors into world-frame ones.
    pub orientation: Matrix3<f64>,
    /// Traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Angular momentum about the pivot, world frame, J s.
    pub momentum: Vector3<f64>,
    /// ω = I⁻¹L at this state, world frame, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// Angle of the axle from +z, degrees.
    pub tilt_deg: f64,
    /// Azimuth of the axle with all full turns, degrees.
    pub azimuth_deg: f64,
    /// Kinetic and potential energy, J; the potential energy is 0 at the height of the pivot.
    pub energy: f64,
    /// Vertical force of the floor on the foot, N.
    pub foot_force: f64,
    /// Angle by which a rotor has turned in its frame about the axle since the start, rad; 0 if the whole body spins.
    pub rotor_turn: f64,
    /// Number of edits of time step, scheme or gravity before this step.
    pub segment: u64,
    /// Distance of the traced point from the exact motion, m; `None` where it was not computed or is not known.
    pub distance_m: Option<f64>,
}

impl Sample {
    pub fn state(&self) -> State {
        State {
            time_s: self.time_s,
            orientation: self.orientation,
            momentum: self.momentum,
        }
    }

    /// Returns ω along the body's own x, y and axle, rad/s, as an instrument on the body measures it.
    pub fn omega(&self) -> Vector3<f64> {
        self.orientation.tr_mul(&self.angular_velocity)
    }
}

/// Minimum ratio of M g |c| to the kinetic energy at the start. Below it, the body is nearly balanced, and M g |c| is
/// not used as the scale.
const LEAST_ENERGY_PART: f64 = 1e-9;
/// Distance of the center of mass from the pivot that is a rounding error, as a fraction of the body's size.
const CENTER_ROUNDING: f64 = 1e-12;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyUnit {
    /// M g |c|, where c is the center of mass seen from the pivot.
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

/// S, the scale by which an energy error is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyScale {
    /// Size of the scale, J; positive and finite.
    pub size: f64,
    pub unit: EnergyUnit,
}

impl EnergyScale {
    /// Returns M g |c|, or the kinetic energy at the start if M g |c| is below 1e-9 of it. `None` if both are 0 (M g
    /// |c| to within rounding), or beyond the range of numbers.
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

/// Returns M |c|, kg m. A sum that is 0 except for rounding gives 0.
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
