//! The one road forward in time.

use super::pushes::{self, Counting, Stretch};
use super::{Clock, EnergyScale, EnergyUnit, Sample};
use crate::physics::observables::{self, Azimuth};
use crate::physics::{Loads, PointForce, Scheme, State, StepRecord, Workings};
use crate::scenario::{Edit, Motion, Push, Scenario};
use std::sync::Arc;

/// A run as it stands at one step; [`step`](Self::step) takes it to the next. A clone goes its own way from here,
/// with the same bits.
#[derive(Clone)]
pub struct Simulation {
    scenario: Arc<Scenario>,
    scheme: Box<dyn Scheme>,
    motion: Motion,
    pushes: Arc<[Push]>,
    loads: Loads,
    /// The pushes of the step to come, before they are known to differ from the loads.
    acting: Vec<PointForce>,
    clock: Clock,
    counting: Counting,
    step: u64,
    segment: u64,
    edits_made: usize,
    /// The step of the next edit; the last step there could be where there is none.
    next_edit: u64,
    before: State,
    state: State,
    azimuth: Azimuth,
    energy: EnergyAccount,
    ended: Option<NotFinite>,
    /// How often the forces have changed.
    changes: u64,
    /// While |L|² is below this, every number read off a finite state is finite too.
    safe_below: f64,
}

/// What the energy would be if the scheme made no error.
#[derive(Clone, Copy, Debug)]
struct EnergyAccount {
    /// Energy at the start, J.
    start: f64,
    /// Work of pushes and of edits of gravity since then, J.
    work: f64,
    /// What its error is measured in; `None` where there is nothing to measure it by.
    scale: Option<EnergyScale>,
}

/// The numbers of a run are no longer finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the numbers are no longer finite at step {step}: the run ends at step {}; a shorter time step or another scheme may mend it",
    step - 1
)]
pub struct NotFinite {
    /// The step that would have led to them.
    pub step: u64,
}

impl Simulation {
    /// The run of `scenario`, at step 0.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let body = &scenario.body.mechanics;
        let (motion, state) = (scenario.motion, scenario.start);
        let loads = Loads {
            gravity: motion.gravity,
            pushes: Vec::with_capacity(scenario.pushes.len()),
        };
        let mut scheme = motion.scheme.make(body);
        scheme.load(&loads);
        scheme.start(&state);
        let kinetic = observables::kinetic_energy(body, &state);
        let energy = EnergyAccount {
            start: kinetic + motion.gravity * observables::weight_height(body, &state),
            work: 0.0,
            scale: EnergyScale::of(&scenario),
        };
        Self {
            scheme,
            motion,
            pushes: scenario.pushes.iter().copied().collect(),
            acting: Vec::with_capacity(scenario.pushes.len()),
            loads,
            clock: Clock::new(motion.time_step_s),
            counting: counting(&scenario),
            step: 0,
            segment: 0,
            edits_made: 0,
            next_edit: step_of_edit(&scenario, 0),
            before: state,
            state,
            azimuth: Azimuth::start(&state.axle()),
            energy,
            ended: None,
            changes: 0,
            safe_below: safe_below(&scenario, motion.gravity),
            scenario,
        }
    }

    /// Takes the run one time step further.
    ///
    /// # Errors
    /// When the numbers stop being finite. The run then stays at the step before, and so it does at every further
    /// call.
    pub fn step(&mut self) -> Result<(), NotFinite> {
        if let Some(end) = self.ended {
            return Err(end);
        }
        let undo = (self.motion, self.energy, self.segment);
        if self.next_edit == self.step {
            self.make_due_edits();
        }
        self.before = self.state;
        let work = self.advance();
        self.state.time_s = self.clock.time_s(self.step + 1);
        if !self.can_be_read() {
            // This step's edits have led nowhere: the run is read as it stood before them.
            (self.motion, self.energy, self.segment) = undo;
            self.state = self.before;
            let end = NotFinite {
                step: self.step + 1,
            };
            self.ended = Some(end);
            return Err(end);
        }
        self.energy.work += work;
        self.step += 1;
        self.azimuth.follow(&self.state.axle());
        Ok(())
    }

    /// Steps until the run stands at `step`.
    ///
    /// # Errors
    /// When the numbers stop being finite before that.
    pub fn step_to(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.step < step {
            self.step()?;
        }
        Ok(())
    }

    /// Goes on in `scenario` from here. It must have the same past: what differs in it acts on the steps to come, and the
    /// steps taken so far are those it would have led to. A run that has [ended](Self::has_ended) cannot go on.
    pub fn go_on_in(&mut self, scenario: Arc<Scenario>) {
        self.edits_made = scenario.edits.partition_point(|edit| edit.step < self.step);
        self.next_edit = step_of_edit(&scenario, self.edits_made);
        let made = self
            .edits_made
            .checked_sub(1)
            .map(|last| &scenario.edits[last]);
        let pushes = made.map_or(&scenario.pushes, |edit| &edit.pushes);
        self.pushes = pushes.iter().copied().collect();
        self.scenario = scenario;
    }

    /// Whether the numbers of the next step are not finite.
    pub fn has_ended(&self) -> bool {
        self.ended.is_some()
    }

    /// Whether every number read off the state is finite: squares leave the range of numbers before L itself does. A
    /// finite energy means a finite Omega too.
    fn can_be_read(&self) -> bool {
        let body = &self.scenario.body.mechanics;
        if !self.state.is_finite() {
            return false;
        }
        // Far inside the range nothing can leave it: only what comes near the edge is looked at number by number.
        if self.state.momentum.norm_squared() < self.safe_below {
            return true;
        }
        let potential = self.motion.gravity * observables::weight_height(body, &self.state);
        let energy = observables::kinetic_energy(body, &self.state) + potential;
        let traced = observables::position(body, &self.state, self.scenario.trace);
        energy.is_finite() && traced.iter().all(|c| c.is_finite())
    }

    /// Takes the state through the coming step and returns the work the pushes did on the way, J.
    fn advance(&mut self) -> f64 {
        if self.pushes.is_empty() {
            self.scheme.step(self.motion.time_step_s, &mut self.state);
            return 0.0;
        }
        let mut stretch = Stretch::step(self.step + 1, &self.clock);
        let mut work = 0.0;
        let end = stretch.end;
        if self.motion.scheme.continuous {
            while let Some(change) = pushes::next_change(&*self.pushes, self.counting, &stretch) {
                stretch.end = change;
                work += self.advance_under_push(&stretch, change - stretch.begin);
                (stretch.begin, stretch.end) = (change, end);
            }
        }
        let whole = stretch.begin == self.clock.time_s(self.step);
        let length = if whole {
            self.motion.time_step_s
        } else {
            end - stretch.begin
        };
        work + self.advance_under_push(&stretch, length)
    }

    fn advance_under_push(&mut self, stretch: &Stretch, length: f64) -> f64 {
        pushes::acting(&*self.pushes, self.counting, stretch, &mut self.acting);
        if self.acting != self.loads.pushes {
            self.loads.pushes.clone_from(&self.acting);
            self.changes += 1;
            self.scheme.load(&self.loads);
        }
        let before = self.state;
        self.scheme.step(length, &mut self.state);
        let body = &self.scenario.body.mechanics;
        let at = |state: &State, push: &PointForce| observables::position(body, state, push.point);
        let moved =
            |push: &PointForce| push.force.dot(&(at(&self.state, push) - at(&before, push)));
        self.loads.pushes.iter().map(moved).sum()
    }

    /// Carries out the edits made at this step.
    fn make_due_edits(&mut self) {
        let scenario = Arc::clone(&self.scenario);
        let first = self.edits_made;
        while let Some(edit) = scenario
            .edits
            .get(self.edits_made)
            .filter(|edit| edit.step == self.step)
        {
            self.make_edit(edit);
            self.segment += u64::from(edit.touches.segment);
            self.edits_made += 1;
        }
        let made = &scenario.edits[first..self.edits_made];
        if let Some(last) = made.last()
            && made.iter().any(|edit| !edit.set_pushes.is_empty())
        {
            self.pushes = last.pushes.iter().copied().collect();
        }
        self.next_edit = step_of_edit(&scenario, self.edits_made);
    }

    fn make_edit(&mut self, edit: &Edit) {
        let body = &self.scenario.body.mechanics;
        if edit.touches.time_step {
            self.clock.change(self.step, edit.motion.time_step_s);
            self.counting = Counting::in_seconds(&self.scenario);
        }
        let lift = edit.motion.gravity - self.motion.gravity;
        self.energy.work += lift * observables::weight_height(body, &self.state);
        if edit.motion.scheme != self.motion.scheme {
            self.scheme = edit.motion.scheme.make(body);
            self.scheme.start(&self.state);
        }
        self.motion = edit.motion;
        self.loads.gravity = self.motion.gravity;
        self.safe_below = safe_below(&self.scenario, self.motion.gravity);
        self.loads.pushes.clear();
        self.changes += 1;
        self.scheme.load(&self.loads);
    }

    /// The scenario that is being run.
    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    /// The number of the step it stands at.
    pub fn step_number(&self) -> u64 {
        self.step
    }

    /// The state it stands at.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The axle's azimuth, counted on through full turns.
    pub fn azimuth(&self) -> &Azimuth {
        &self.azimuth
    }

    /// How often the forces have changed so far, edits of the time step and the scheme counted in: what is measured
    /// across such a change is the motion of neither side.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// The forces of the step taken last (at step 0: gravity alone).
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Gravity, scheme and time step of the step taken last (at step 0: of the first).
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// What the scheme has to say of how the run was computed, beyond its name.
    pub fn remark(&self) -> Option<String> {
        self.scheme.remark()
    }

    /// The whole of the step taken last; `None` at step 0.
    pub fn record(&self) -> Option<StepRecord> {
        let body = &self.scenario.body.mechanics;
        (self.step > 0).then(|| StepRecord {
            step: self.step,
            time_step_s: self.motion.time_step_s,
            before: self.before,
            workings: self.scheme.workings().unwrap_or_else(|| {
                Workings::between(body, &self.before, &self.state, self.motion.time_step_s)
            }),
            after: self.state,
        })
    }

    /// The numbers of this step, as they leave the program.
    pub fn sample(&self) -> Sample {
        let body = &self.scenario.body.mechanics;
        let counters = (self.step, self.segment);
        Sample::new(
            body,
            self.scenario.trace,
            self.motion.gravity,
            counters,
            &self.state,
            &self.azimuth,
        )
    }

    /// (E − E₀ − W)/S: the energy that only the scheme's error can have made, W the work of pushes and of edits of
    /// gravity, S as [`EnergyScale`] has it; `None` where there is no S, or the drift is beyond the range of numbers.
    pub fn energy_drift(&self) -> Option<f64> {
        let gained = self.sample().energy - self.energy.start - self.energy.work;
        let drift = gained / self.energy.scale?.size;
        drift.is_finite().then_some(drift)
    }

    /// What the energy drift is measured in; `None` where there is nothing to measure it by.
    pub fn energy_unit(&self) -> Option<EnergyUnit> {
        self.energy.scale.map(|scale| scale.unit)
    }

    /// The first step at or after `time_s` (s), edits of the time step counted in.
    pub fn step_at(scenario: &Scenario, time_s: f64) -> u64 {
        let mut clock = Clock::new(scenario.motion.time_step_s);
        for edit in scenario.edits.iter().filter(|edit| edit.touches.time_step) {
            if clock.step_at(time_s) <= edit.step {
                break;
            }
            clock.change(edit.step, edit.motion.time_step_s);
        }
        clock.step_at(time_s)
    }
}

fn step_of_edit(scenario: &Scenario, index: usize) -> u64 {
    scenario.edits.get(index).map_or(u64::MAX, |edit| edit.step)
}

/// Step counts are steps, unless they were written for another time step.
fn counting(scenario: &Scenario) -> Counting {
    match scenario.written_for_s == scenario.motion.time_step_s {
        true => Counting::Steps,
        false => Counting::in_seconds(scenario),
    }
}

/// |L|² (J² s²) below which energy and traced point cannot leave the range of numbers; 0 where they could at any L.
fn safe_below(scenario: &Scenario, gravity: f64) -> f64 {
    const EDGE: f64 = 1e300;
    let body = &scenario.body.mechanics;
    let weight = gravity.abs() * body.first_moment().norm();
    match weight < EDGE && scenario.arm_m() < EDGE {
        true => EDGE / body.inverse_inertia().trace().max(1.0),
        false => 0.0,
    }
}
