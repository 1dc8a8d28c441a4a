//! The exact motion of a scenario: what its start does under the same pushes, whatever the scheme and the time step.
//!
//! For now it is an integration by `rk4` in steps so short that the textbook's tops are true to 1e-6 m; the closed
//! form will take its place behind the same two functions. Edits of gravity are not followed yet.

use super::pushes::{self, Counting, Stretch};
use crate::physics::{Loads, PointForce, Scheme, SchemeInfo, State, observables, report::Report};
use crate::scenario::Scenario;
use std::sync::Arc;

/// Angle by which the body turns in one step of the integration, rad.
const TURN: f64 = 0.03;

/// The exact motion; see the module's text.
#[derive(Clone)]
pub struct Truth {
    scenario: Arc<Scenario>,
    scheme: Box<dyn Scheme>,
    acting: Vec<PointForce>,
    state: State,
}

impl Truth {
    /// The exact motion of `scenario`, at its start.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let body = &scenario.body.mechanics;
        let scheme: Box<dyn Scheme> = match SchemeInfo::find("rk4") {
            Some(rk4) => rk4.make(body),
            None => Box::new(Report::new(body)),
        };
        Self {
            scheme,
            acting: Vec::new(),
            state: scenario.start,
            scenario,
        }
    }

    /// The state at `t_s` (s), which must not lie before that of the call before.
    pub fn advance_to(&mut self, t_s: f64) -> State {
        let counting = Counting::Seconds {
            written_for_s: self.scenario.motion.time_step_s,
        };
        while self.state.time_s < t_s {
            let speed =
                observables::angular_velocity(&self.scenario.body.mechanics, &self.state).norm();
            let longest = if speed > 0.0 {
                TURN / speed
            } else {
                f64::INFINITY
            };
            let begin = self.state.time_s;
            let mut stretch = Stretch {
                step: 0,
                begin,
                end: t_s.min(begin + longest),
            };
            if let Some(change) = pushes::next_change(&self.scenario.pushes, counting, &stretch) {
                stretch.end = change;
            }
            if stretch.end <= begin {
                break; // steps below the resolution of t: the motion has come as far as it can
            }
            self.integrate(counting, &stretch);
        }
        self.state
    }

    fn integrate(&mut self, counting: Counting, stretch: &Stretch) {
        pushes::acting(&self.scenario.pushes, counting, stretch, &mut self.acting);
        let loads = Loads {
            gravity: self.scenario.motion.gravity,
            pushes: self.acting.clone(),
        };
        self.scheme.load(&loads);
        self.scheme
            .step(stretch.end - stretch.begin, &mut self.state);
        self.state.time_s = stretch.end;
    }
}
