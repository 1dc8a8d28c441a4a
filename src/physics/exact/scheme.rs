//! The exact motion as a scheme: the time step only says where the rows stand.

use super::{ExactMethod, ExactMotion};
use crate::stepping::StepClock;
use crate::workings::{Listener, Nobody, Phase};
use crate::{Body, Loads, Scheme, State};

/// Exact motion, anew from every change of the loads; see [`super`].
#[derive(Clone, Debug)]
pub struct Exact {
    body: Body,
    loads: Loads,
    /// The motion since the loads changed, its times counted from there; none before the first step under them.
    motion: Option<ExactMotion>,
    /// Time since the loads changed.
    pace: StepClock,
    kinds: (bool, bool),
    /// Work of friction since the loads changed, and in the step taken last, J.
    work: f64,
    step_work: f64,
}

impl Exact {
    pub fn new(body: &Body) -> Self {
        let (loads, pace) = (Loads::default(), StepClock::default());
        Self {
            body: body.clone(),
            loads,
            motion: None,
            pace,
            kinds: (false, false),
            work: 0.0,
            step_work: 0.0,
        }
    }

    #[inline]
    fn advance<L: Listener>(&mut self, dt: f64, state: &mut State, listener: &mut L) {
        let motion = self.motion.get_or_insert_with(|| {
            self.pace = StepClock::default();
            self.work = 0.0;
            ExactMotion::new(
                &self.body,
                &self.loads,
                &State {
                    time_s: 0.0,
                    ..*state
                },
            )
        });
        match motion.kind() {
            ExactMethod::Closed => self.kinds.0 = true,
            ExactMethod::Integrated | ExactMethod::Rubbing => self.kinds.1 = true,
        }
        let now = motion.at_heard(self.pace.next_time(dt), listener);
        (state.orientation, state.momentum) = (now.orientation, now.momentum);
        let work = motion.friction_work();
        self.step_work = work - self.work;
        self.work = work;
    }
}

impl Scheme for Exact {
    fn start(&mut self, _: &State) {
        self.motion = None;
    }

    fn load(&mut self, loads: &Loads) {
        self.loads.clone_from(loads);
        self.motion = None;
    }

    fn step(&mut self, dt: f64, state: &mut State) {
        self.advance(dt, state, &mut Nobody);
    }

    fn explain(&mut self, dt: f64, state: &mut State, phases: &mut Vec<Phase>) {
        self.advance(dt, state, phases);
    }

    fn friction_work(&self) -> f64 {
        self.step_work
    }

    fn has_given_up(&self) -> bool {
        let motion = self.motion.as_ref();
        motion.is_some_and(ExactMotion::has_given_up)
    }

    fn remark(&self) -> Option<String> {
        if !self.loads.friction.is_none() {
            return Some(ExactMethod::Rubbing.to_string());
        }
        match self.kinds {
            (true, true) => Some(format!(
                "{}, and off the axle {}",
                ExactMethod::Closed,
                ExactMethod::Integrated
            )),
            (true, false) => Some(ExactMethod::Closed.to_string()),
            (false, true) => Some(ExactMethod::Integrated.to_string()),
            (false, false) => None,
        }
    }

    fn boxed(&self) -> Box<dyn Scheme> {
        Box::new(self.clone())
    }
}
