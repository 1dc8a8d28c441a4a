//! The motion within long time steps, for figures. Straight lines between the steps would cut off its bends.
//!
//! The scheme itself defines this motion: it takes a part of the step from the state before it. The report's scheme turns
//! the body about Ω, so its points move along arcs of circles. Nothing is computed within a step that turns the body by
//! half a turn or more: such a run is under-sampled, and its figure shows its steps.

use super::course::SampleRequest;
use crate::engine::run::{Simulation, Step};
use crate::engine::scenario::{Motion, Scenario};
use crate::physics::scheme::SchemeInfo;
use crate::physics::{Body, Scheme, State, observables};
use std::f64::consts::{PI, TAU};

/// Steps that turn the body by less than this need no parts, rad: a straight line is off the arc by 0.1 % of its radius.
const STRAIGHT_RAD: f64 = TAU / 64.0;
/// Parts of the other steps are this long or shorter, rad: where the axle passes the vertical, the least tilt is missed by
/// less than 1 % of the swing.
const PART_RAD: f64 = TAU / 200.0;
/// The most parts that are computed for one figure of a run: about two seconds.
const MOST_PARTS: u64 = 4_000_000;

/// Computes the motion within the steps of a run, one step after the other.
#[derive(Clone)]
pub(super) struct StepArcs {
    from_s: f64,
    to_s: f64,
    /// The most parts of one step, so that a long run takes bounded time.
    most_parts: u64,
    /// The scheme, by its name, under the forces that have changed so many times.
    scheme: Option<(&'static str, u64, Box<dyn Scheme>)>,
    /// How many times the forces had changed at the step before.
    changes: u64,
}

impl StepArcs {
    /// Returns an interpolation of what is `wanted` of the run of `scenario`.
    pub fn new(scenario: &Scenario, wanted: &SampleRequest) -> Self {
        Self {
            from_s: wanted.from_s,
            to_s: wanted.end_s(scenario),
            most_parts: most_parts(scenario, wanted),
            scheme: None,
            changes: 0,
        }
    }

    /// Returns the states within `step`, without its ends, in order of time. The caller passes each step of the run in
    /// order.
    pub fn within(&mut self, step: &Step) -> Vec<State> {
        let has_changed = std::mem::replace(&mut self.changes, step.changes()) != step.changes();
        let motion = step.motion();
        // A scheme that meets a push where it begins, within the step, has had two kinds of forces in it.
        let has_two_forces = has_changed && motion.scheme.continuous;
        let Some(before) = step.before().filter(|before| {
            !has_two_forces && before.time_s < self.to_s && step.time_s() > self.from_s
        }) else {
            return Vec::new();
        };
        let body = &step.scenario().body.mechanics;
        let turn_rad = turn_rad(body, before, motion.time_step_s);
        if !is_shown(motion, turn_rad) {
            return Vec::new();
        }
        let count = parts(turn_rad).min(self.most_parts);
        if count == 1 {
            return Vec::new();
        }
        let scheme = self.scheme(step, body);
        let length_s = step.time_s() - before.time_s;
        let parts = (1..count).map(|part| {
            let share = part as f64 / count as f64;
            let mut state = *before;
            scheme.start(before);
            scheme.step(share * motion.time_step_s, &mut state);
            state.time_s = before.time_s + share * length_s;
            state
        });
        parts.filter(State::is_finite).collect()
    }

    /// Returns the scheme of `step` under its forces.
    fn scheme(&mut self, step: &Step, body: &Body) -> &mut Box<dyn Scheme> {
        let (info, changes): (&'static SchemeInfo, u64) = (step.motion().scheme, step.changes());
        let made = self
            .scheme
            .take()
            .filter(|(name, of, _)| (*name, *of) == (info.name, changes));
        let made = made.unwrap_or_else(|| {
            let mut scheme = info.make(body);
            scheme.load(step.loads());
            (info.name, changes, scheme)
        });
        &mut self.scheme.insert(made).2
    }
}

/// Returns true if a figure of what is `wanted` of the run of `scenario` shows its motion between the steps: by states
/// within them, or because the steps are short.
pub(super) fn are_drawn(scenario: &Scenario, wanted: &SampleRequest) -> bool {
    let turn_rad = first_turn_rad(scenario);
    let is_enough = parts(turn_rad) <= most_parts(scenario, wanted);
    is_enough && is_shown(scenario.first_motion(), turn_rad)
}

/// Returns true if figures of the whole run of `scenario` show its motion between the steps.
pub fn show_whole_run(scenario: &Scenario) -> bool {
    let whole = SampleRequest {
        columns: Vec::new(),
        path: true,
        from_s: 0.0,
        to_s: None,
    };
    are_drawn(scenario, &whole)
}

/// Returns true if straight lines between the steps of the run of `scenario` would cut off bends.
pub(super) fn are_bent(scenario: &Scenario) -> bool {
    first_turn_rad(scenario) > STRAIGHT_RAD
}

/// Returns the angle by which the first step turns the body, rad.
fn first_turn_rad(scenario: &Scenario) -> f64 {
    let body = &scenario.body.mechanics;
    turn_rad(body, &scenario.start, scenario.first_motion().time_step_s)
}

/// Returns true if figures show the motion within a step that turns the body by `turn_rad`.
fn is_shown(motion: &Motion, turn_rad: f64) -> bool {
    let is_exact = motion.scheme.order.is_none(); // figures compute it at any time
    !is_exact && turn_rad.is_finite() && (turn_rad < PI || motion.scheme.turns_exactly)
}

/// Returns the angle by which a step of that length turns the body, rad.
fn turn_rad(body: &Body, state: &State, time_step_s: f64) -> f64 {
    observables::angular_velocity(body, state).norm() * time_step_s
}

/// Returns the number of parts of a step that turns the body by `turn_rad`.
fn parts(turn_rad: f64) -> u64 {
    if turn_rad <= STRAIGHT_RAD {
        return 1;
    }
    (turn_rad / PART_RAD).ceil() as u64
}

/// Returns the most parts of a step for what is `wanted` of the run of `scenario`; 1 if it includes step numbers.
fn most_parts(scenario: &Scenario, wanted: &SampleRequest) -> u64 {
    if wanted.counts_steps() {
        return 1;
    }
    let ends_s = [wanted.from_s, wanted.end_s(scenario)];
    let [first, last] = ends_s.map(|time_s| Simulation::step_at(scenario, time_s));
    (MOST_PARTS / last.saturating_sub(first).max(1)).max(1)
}
