//! What follows a run step by step and can say at any moment how it stands: instruments, theory, health.
//!
//! How the instruments measure precession and nutation, each with its uncertainty: the axle's height turns back twice in every nutation. Nutation is the mean time from one such point to the
//! next of its kind, precession the change of azimuth from the first to the last over the time between them.
//!
//! Of a symmetric top each nutation is like the one before, and its second half the mirror image of the first. Where the
//! time step is short enough to follow it, a turning point is found between two rows by the equations of motion, from
//! either of them: the difference is what the scheme's step has done otherwise. With rounding, and with the distance of
//! the turning points from a steady rate, it makes the uncertainty. Half a nutation is enough then.
//!
//! Of other runs, those of a lopsided body, under a load aside, whose time step is too long, or whose nutation is no larger
//! than the error of a scheme of the first order, a parabola through three rows gives the highest points, and it takes four
//! nutations to say how much they differ, of a lopsided body sixteen. Rows so few that a nutation may lie unseen between
//! them give no period. The direction in which a lopsided body points as the axle turns back changes its nutations in
//! length, in beats that may be longer than the run: `beats`. Its numbers are stated once all directions
//! were seen, its nutation only if all swings are large. A run without nutation has its precession from the whole way of the azimuth. Where less was seen
//! than that there is no number.
//!
//! A turning point is read by interpolation between two rows, and how far that reading is off is known from the equations
//! of motion. It is stated in the uncertainty and not taken away from the value. Taken away, the value would no longer be
//! read off the rows but computed from the equations that it is to be compared with: it would agree with theory to rounding
//! however coarse the rows are, and nothing would be left that the uncertainty could be compared with.
//!
//! What is measured is the run as its steps show it: the error of its scheme is not in the uncertainty, and a nutation of
//! less than two time steps is seen as a slower one, as it is on the screen.

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

/// The instruments that follow a run; to be shown every step of it.
#[derive(Clone, Debug)]
pub enum Instruments {
    TurningPoints(Box<TurningPoints>),
    Parabolas(Box<Parabolas>),
}

impl Instruments {
    /// Instruments that begin to follow a run at `step`.
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

    /// Nutation period of the run so far, s.
    ///
    /// # Errors
    /// Where there is none, or too little of it was seen to say how well it is known.
    pub fn nutation_period_s(&self) -> Result<MeasuredNumber, WithoutNutation> {
        match self {
            Self::TurningPoints(points) => points.nutation_period_s(),
            Self::Parabolas(parabolas) => parabolas.nutation_period_s(),
        }
    }

    /// Precession of the run so far, rad/s; `None` likewise, and where the axle passes through the vertical.
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
    /// The change of forces since which the instruments measure.
    changes: u64,
    /// The step from which on they do.
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

    /// Takes in `step`; to be shown every step. Every one of them is compared with the exact motion: what leaves it and
    /// comes back between two looks has left it too.
    pub fn record(&mut self, step: &Step) {
        self.measure(step);
        self.beside.hold(step.after());
    }

    /// The same, but the step is compared with the exact motion later: when [`catch_up`](Self::catch_up) is called, at the
    /// latest when health or theory is asked for. So the time that stepping takes can be told from it.
    pub fn record_ahead(&mut self, step: &Step) {
        self.measure(step);
        self.beside.wait(step.after());
    }

    /// The mean force of the floor on the foot over whole nutations since the forces last changed, N; `None` before one
    /// was seen.
    pub fn mean_foot_force(&self) -> Option<MeasuredNumber> {
        self.foot_force.mean()
    }

    /// What that mean is by Newton's second law at `step`, N: the weight, and what pushes press down.
    pub fn predicted_mean_foot_force(&self, step: &Step) -> f64 {
        mean_at_rest(step)
    }

    /// Compares the steps with the exact motion that have not been, as long as `go_on` says so: see
    /// [`ExactReference::settle_while`].
    pub fn catch_up(&mut self, go_on: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        self.beside.settle_while(go_on)
    }

    /// As [`record`](Self::record), without comparing the step with the exact motion: for a reader of what is measured
    /// and of the extremes alone.
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

    /// By how much the tilt has swung since the forces last changed, degrees; `None` before it was seen whole.
    pub fn tilt_swing_deg(&self) -> Option<MeasuredNumber> {
        self.tilt_swing.measured()
    }

    /// How the run stands at `step`, the last one that it was shown.
    pub fn health(&mut self, step: &Step) -> Health {
        Health::new(step, &mut self.beside)
    }

    /// Returns what theory says of the exact motion at `time_s` (s), where there is friction as if it ceased then; `None` for
    /// a lopsided body, a push off the axle, or a motion that would take too long.
    ///
    /// For a nearly symmetric body it is the theory of the mean moment across, as the forces last changed: what is constant
    /// in the motion of a symmetric top swings in its own.
    pub fn theory(&mut self, time_s: f64) -> Option<Theory> {
        let truth = self.beside.truth()?;
        let state = truth.state_at(time_s);
        let body = &truth.scenario().body.mechanics;
        let (top, asymmetry) = SymmetricTop::nearly(body)?;
        let load = truth.loads().on_axle(body, &top)?;
        let rubs = !truth.loads().friction.is_none();
        let of = if asymmetry > 0.0 && !rubs {
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
            // The steady precessions are those at the present tilt.
            slow_precession: now.slow_precession,
            fast_precession: now.fast_precession,
            is_of_a_moment: rubs,
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
