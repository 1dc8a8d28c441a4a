//! What follows a run step by step and can say at any moment how it stands: instruments, theory, health.

use super::beside::Beside;
use super::gauges::Gauges;
use super::health::Health;
use super::swings::Swing;
use super::theory::Theory;
use super::trial::Deviation;
use crate::physics::{LagrangeTop, State, SymmetricTop};
use crate::run::Step;
use crate::scenario::Scenario;
use std::sync::Arc;

/// Follows one run from its start.
#[derive(Clone, Debug)]
pub struct Monitor {
    pub gauges: Gauges,
    beside: Beside,
    /// Steps still to be compared with the exact motion.
    unheld: Vec<State>,
}

impl Monitor {
    pub fn new(step: &Step) -> Self {
        Self {
            gauges: Gauges::new(step),
            beside: Beside::new(step.scenario()),
            unheld: Vec::new(),
        }
    }

    /// Goes on with a run of `scenario`, whose past is the same.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.beside.go_on_in(scenario);
    }

    /// Takes in `step`; to be shown every step. Every one of them is compared with the exact motion: what leaves it and
    /// comes back between two looks has left it too.
    #[inline]
    pub fn follow(&mut self, step: &Step) {
        self.measure(step);
        self.beside.hold(step.after());
    }

    /// The same, but for the exact motion: [`catch_up`](Self::catch_up) comes to that later, at the latest when health or
    /// theory is asked for. So the time that stepping takes can be told from it.
    #[inline]
    pub fn follow_ahead(&mut self, step: &Step) {
        self.measure(step);
        if self.beside.is_known() {
            self.unheld.push(*step.after());
        }
    }

    /// Holds against the exact motion the steps that have not been.
    pub fn catch_up(&mut self) {
        self.hold_rest();
        self.beside.settle();
    }

    fn hold_rest(&mut self) {
        for state in &self.unheld {
            self.beside.hold(state);
        }
        self.unheld.clear();
    }

    /// Whether the run is compared with the exact motion.
    pub fn has_exact(&self) -> bool {
        self.beside.is_known()
    }

    /// As [`follow`](Self::follow), without holding the step against the exact motion: for a reader of what is measured
    /// and of the extremes alone.
    #[inline]
    pub fn measure(&mut self, step: &Step) {
        self.gauges.follow(step);
    }

    /// Holds `step` against the exact motion, and says how the run is there.
    pub fn health(&mut self, step: &Step) -> Health {
        self.catch_up();
        Health::new(step, &mut self.beside)
    }

    /// How the tilt has swung up to the last [`deviation`](Self::deviation) beside the exact motion's, where they differ most;
    /// `None` where it is not compared.
    pub fn swing(&self) -> Option<Swing> {
        self.beside.swing()
    }

    /// How far off the exact motion the run is at `step`; `None` where that would take too long.
    pub fn deviation(&mut self, step: &Step) -> Option<Deviation> {
        self.catch_up();
        self.beside.deviation(step.after())
    }

    /// What theory says of the exact motion at `time_s` (s), where there is friction as if it ceased then; `None` for a
    /// lopsided body, a push off the axle, or a motion that would take too long.
    pub fn theory(&mut self, time_s: f64) -> Option<Theory> {
        let truth = self.beside.truth()?;
        let state = truth.state_at(time_s);
        let body = &truth.scenario().body.mechanics;
        let top = SymmetricTop::of(body)?;
        let load = truth.loads().on_axle(body, &top)?;
        if truth.loads().friction.is_none() {
            let motion = truth.motion().closed_form()?;
            return Some(Theory::new(&top, &load, motion, &state));
        }
        let (turn, momentum) = (state.orientation, state.momentum);
        let motion = LagrangeTop::new(top.across, top.along, load, turn, momentum);
        let theory = Theory::new(&top, &load, &motion, &state);
        Some(Theory {
            is_of_a_moment: true,
            ..theory
        })
    }

    /// The largest distance of the traced point from the exact motion up to the last [`deviation`](Self::deviation), m; 0
    /// where it is not compared.
    pub fn most_distance_m(&self) -> f64 {
        self.beside.most_distance_m()
    }
}
