//! What follows a run step by step and can say at any moment how it stands: instruments, theory, health.

use super::trial::{Deviation, stride};
use super::{Health, Instruments, Theory};
use crate::physics::{SymmetricTop, observables};
use crate::run::{Simulation, Truth};
use crate::scenario::Scenario;
use std::sync::Arc;

/// Radians of rotation through which the exact motion may be integrated on the side: less than a second's work.
pub const AFFORDABLE_RAD: f64 = 5e5;

/// Follows one run from its start.
#[derive(Clone, Debug)]
pub struct Monitor {
    instruments: Instruments,
    truth: Option<Truth>,
    most_distance_m: f64,
    /// The change of forces since which the instruments measure.
    changes: u64,
    /// The next step at which to hold the run against the exact motion, and how many there are between two.
    next_look: u64,
    stride: u64,
}

impl Monitor {
    /// A monitor for the run that `simulation` begins.
    pub fn new(simulation: &Simulation) -> Self {
        let scenario = simulation.scenario();
        let truth = is_affordable(scenario).then(|| Truth::new(Arc::clone(scenario)));
        Self {
            instruments: Instruments::new(simulation),
            truth,
            most_distance_m: 0.0,
            changes: simulation.changes(),
            next_look: simulation.step_number() + stride(scenario.steps),
            stride: stride(scenario.steps),
        }
    }

    /// Goes on with a run of `scenario`, whose past is the same.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        match &mut self.truth {
            Some(truth) => truth.go_on_in(scenario),
            None => self.truth = Some(Truth::new(Arc::clone(scenario))),
        }
        self.truth.take_if(|_| !is_affordable(scenario));
    }

    /// Takes in the step that `simulation` stands at; to be shown every step.
    #[inline]
    pub fn follow(&mut self, simulation: &Simulation) {
        if simulation.changes() == self.changes {
            self.instruments.follow(simulation);
        } else {
            self.changes = simulation.changes();
            self.instruments = Instruments::new(simulation);
        }
        if simulation.step_number() >= self.next_look {
            self.next_look = simulation.step_number() + self.stride;
            self.deviation(simulation);
        }
    }

    /// Holds the run against the exact motion where it stands, and says how it is.
    pub fn health(&mut self, simulation: &Simulation) -> Health {
        let deviation = self.deviation(simulation);
        Health::new(
            simulation,
            deviation,
            deviation.map(|_| self.most_distance_m),
        )
    }

    fn deviation(&mut self, simulation: &Simulation) -> Option<Deviation> {
        let deviation = Deviation::of(simulation, self.truth.as_mut()?);
        if !deviation.distance_m.is_finite() {
            self.truth = None; // it has left the range of numbers, and does not come back
            return None;
        }
        self.most_distance_m = self.most_distance_m.max(deviation.distance_m);
        Some(deviation)
    }

    /// What theory says of the exact motion at `time_s` (s); `None` for a lopsided body, a push off the axle, or a
    /// motion that would take too long.
    pub fn theory(&mut self, time_s: f64) -> Option<Theory> {
        let truth = self.truth.as_mut()?;
        let state = truth.state_at(time_s);
        let body = &truth.scenario().body.mechanics;
        let top = SymmetricTop::of(body)?;
        let load = truth.loads().on_axle(body, &top)?;
        let motion = truth.motion().closed_form()?;
        Some(Theory::new(&top, &load, motion, &state))
    }

    /// What has been measured since the forces last changed.
    pub fn instruments(&self) -> &Instruments {
        &self.instruments
    }
}

/// Whether the exact motion of `scenario` can be had on the side: in closed form always, by integration for a while.
pub fn is_affordable(scenario: &Scenario) -> bool {
    integration_rad(scenario) <= AFFORDABLE_RAD
}

/// Radians of rotation through which the exact motion of `scenario` has to be integrated; 0 where it has a closed form.
pub fn integration_rad(scenario: &Scenario) -> f64 {
    let body = &scenario.body.mechanics;
    let on_axle = |point: usize| {
        let at = body.points()[point].at;
        at.x == 0.0 && at.y == 0.0
    };
    let edited = scenario.edits.iter().flat_map(|edit| &edit.pushes);
    let closed = scenario
        .pushes
        .iter()
        .chain(edited)
        .all(|push| on_axle(push.point));
    if closed && SymmetricTop::of(body).is_some() {
        return 0.0;
    }
    let spin = observables::angular_velocity(body, &scenario.start).norm();
    // A body at rest will swing and turn under its weight, at about this rate.
    let weight = scenario.motion.gravity.abs() * body.first_moment().norm();
    let swing = (weight * body.inverse_inertia().trace()).sqrt();
    (spin + swing) * crate::run::Clock::end_s(scenario)
}
