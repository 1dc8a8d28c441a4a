//! Follows a run step by step, and reports instruments, theory and health at any moment.
//!
//! # How the instruments measure
//!
//! Each measured number has an uncertainty. The axle's height has two turning points in every nutation. The nutation
//! period is the mean time between successive turning points of one kind. The precession is the change of azimuth from
//! the first to the last of them, divided by the time between.
//!
//! The nutations of a symmetric top are all alike, and the second half of each mirrors the first. If the time step is
//! short enough, the equations of motion give the turning point between two rows, starting from either of them. The
//! difference between the two results is the error of the scheme's step. The uncertainty consists of this error, of
//! rounding, and of the deviation of the turning points from a steady rate. Half a nutation is enough then.
//!
//! In other runs, a parabola through three rows gives the highest points. This applies to lopsided bodies, to loads off
//! the axle, and to time steps that are too long. It also applies if the nutation is no larger than the error of a
//! first-order scheme. Four nutations are needed to know how much they differ, and sixteen for a lopsided body. If a
//! nutation may be missed between two rows, no period is reported.
//!
//! The direction in which a lopsided body points at a turning point changes the length of its nutations, in beats that
//! may be longer than the run (see `beats`). Its numbers are reported once all directions have been seen, and its
//! nutation only if all swings are large. In a run without nutation, the precession is the whole change of azimuth over
//! the time. With less data, no number is reported.
//!
//! # Why the value is not corrected
//!
//! A turning point is read by interpolation between two rows, and the equations of motion give the error of this
//! reading. The error is part of the uncertainty, and is not subtracted from the value. A corrected value would be
//! computed from the equations that it is to be compared with, and not read from the rows. It would agree with theory
//! to rounding however coarse the rows are, and the uncertainty could not be tested.
//!
//! The instruments measure the run as its steps show it. The scheme's error is not part of the uncertainty. A nutation
//! shorter than two time steps appears as a slower one, as it does on the screen.

use super::deviation::ExactReference;
use super::extremes::{Extremes, TiltSwing};
use super::foot_force::{FootForce, mean_at_rest};
use super::health::Health;
use super::parabolas::Parabolas;
use super::report_theory::ReportTheory;
use super::swings::height_in;
use super::theory::Theory;
use super::turning_points::TurningPoints;
use super::turns::{MeasuredNumber, WithoutNutation};
use crate::physics::{LagrangeTop, SymmetricTop};
use crate::run::Step;
use std::borrow::Cow;
use std::ops::ControlFlow;

/// Instruments that follow a run. They must receive every step of it.
#[derive(Clone, Debug)]
pub enum Instruments {
    TurningPoints(Box<TurningPoints>),
    Parabolas(Box<Parabolas>),
}

impl Instruments {
    /// Creates instruments that follow a run from `step` on.
    pub fn new(step: &Step) -> Self {
        match TurningPoints::new(step) {
            Some(points) => Self::TurningPoints(Box::new(points)),
            None => Self::Parabolas(Box::new(Parabolas::new(step))),
        }
    }

    #[inline]
    pub fn record(&mut self, step: &Step) {
        match self {
            Self::TurningPoints(points) => points.record(step),
            Self::Parabolas(parabolas) => parabolas.record(step),
        }
    }

    /// Returns the nutation period of the run so far, s.
    ///
    /// # Errors
    /// Returns an error if there is no nutation, or if too little of it was seen to give an uncertainty.
    pub fn nutation_period_s(&self) -> Result<MeasuredNumber, WithoutNutation> {
        match self {
            Self::TurningPoints(points) => points.nutation_period_s(),
            Self::Parabolas(parabolas) => parabolas.nutation_period_s(),
        }
    }

    /// Returns the precession of the run so far, rad/s. `None` in the same cases, and if the axle passes through the
    /// vertical.
    pub fn precession_rad_per_s(&self) -> Option<MeasuredNumber> {
        match self {
            Self::TurningPoints(points) => points.precession_rad_per_s(),
            Self::Parabolas(parabolas) => parabolas.precession_rad_per_s(),
        }
    }
}

/// Follows one run from its start.
#[derive(Clone, Debug)]
pub struct Monitor {
    pub instruments: Instruments,
    pub extremes: Extremes,
    /// Number of force changes when the instruments started.
    changes: u64,
    /// Step at which the instruments started.
    pub since: u64,
    tilt_swing: TiltSwing,
    pub report_theory: Option<ReportTheory>,
    pub beside: ExactReference,
    foot_force: FootForce,
}

impl Monitor {
    pub fn new(step: &Step) -> Self {
        Self {
            instruments: Instruments::new(step),
            extremes: Extremes::new(step),
            changes: step.changes(),
            since: step.number(),
            tilt_swing: TiltSwing::new(step),
            report_theory: ReportTheory::new(step),
            beside: ExactReference::new(step.scenario()),
            foot_force: FootForce::new(step),
        }
    }

    /// Records `step`. It must receive every step, and compares each with the exact motion. A deviation counts even if
    /// it has vanished by the next reading.
    pub fn record(&mut self, step: &Step) {
        self.measure(step);
        self.beside.hold(step.after());
    }

    /// Records `step`, but compares it with the exact motion later, so that the time spent on stepping can be measured
    /// alone. The comparison follows when [`catch_up`](Self::catch_up) is called, or at the latest when health or
    /// theory is needed.
    pub fn record_ahead(&mut self, step: &Step) {
        self.measure(step);
        self.beside.wait(step.after());
    }

    /// Returns the mean force of the floor on the foot over whole nutations since the forces last changed, N. `None`
    /// until a whole nutation has been seen.
    pub fn mean_foot_force(&self) -> Option<MeasuredNumber> {
        self.foot_force.mean()
    }

    /// Returns the prediction of that mean at `step` by Newton's second law, N: the weight minus the upward pushes.
    pub fn predicted_mean_foot_force(&self, step: &Step) -> f64 {
        mean_at_rest(step)
    }

    /// Compares the waiting steps with the exact motion while `go_on` returns `Continue`; see
    /// [`ExactReference::settle_while`].
    pub fn catch_up(&mut self, go_on: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        self.beside.settle_while(go_on)
    }

    /// Records `step` without comparing it with the exact motion. This is enough for measurements and extremes.
    #[inline]
    pub fn measure(&mut self, step: &Step) {
        let height = height_in(step.after());
        self.extremes.record(step, height);
        if step.changes() == self.changes {
            self.instruments.record(step);
            self.tilt_swing.record(step, height);
            self.foot_force.record(step);
        } else {
            self.changes = step.changes();
            self.since = step.number();
            self.instruments = Instruments::new(step);
            self.tilt_swing = TiltSwing::new(step);
            self.foot_force = FootForce::new(step);
            self.report_theory = ReportTheory::new(step);
        }
    }

    /// Returns the swing of the tilt since the forces last changed, degrees. `None` until a whole swing has been seen.
    pub fn tilt_swing_deg(&self) -> Option<MeasuredNumber> {
        self.tilt_swing.measured()
    }

    /// Returns the health of the run at `step`, the last step that was recorded.
    pub fn health(&mut self, step: &Step) -> Health {
        Health::new(step, &mut self.beside)
    }

    /// Returns the theory of the exact motion at `time_s` (s). With friction, it describes the motion that would follow
    /// if friction ceased then. `None` for a lopsided body, a push off the axle, or a motion that would take too long.
    ///
    /// For a nearly symmetric body, the theory uses the mean moment of inertia across, and the state at the last change
    /// of forces. The constants of a symmetric top's motion oscillate in the motion of such a body.
    pub fn theory(&mut self, time_s: f64) -> Option<Theory> {
        let truth = self.beside.truth()?;
        let state = truth.state_at(time_s);
        let body = &truth.scenario().body.mechanics;
        let (top, asymmetry) = SymmetricTop::nearly(body)?;
        let load = truth.loads().on_axle(body, &top)?;
        let has_friction = !truth.loads().friction.is_none();
        let of = if asymmetry > 0.0 && !has_friction {
            *truth.motion().begin()
        } else {
            state
        };
        let motion = match truth.motion().closed_form() {
            Some(motion) => Cow::Borrowed(motion),
            None => Cow::Owned(LagrangeTop::new(
                top.across,
                top.along,
                load,
                of.orientation,
                of.momentum,
            )),
        };
        let now = Theory::new(&top, &load, &motion, &state);
        let theory = Theory {
            // The steady precessions belong to the present tilt.
            slow_precession: now.slow_precession,
            fast_precession: now.fast_precession,
            is_of_a_moment: has_friction,
            asymmetry,
            ..Theory::new(&top, &load, &motion, &of)
        };
        let is_unstable = self.beside.predictability().unstable.is_some();
        Some(if is_unstable {
            theory.in_balance()
        } else {
            theory
        })
    }
}
