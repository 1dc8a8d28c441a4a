//! Steps a scenario forward in time.

use super::pushes::{self, Counting, Stretch};
use super::step::{Derived, EnergyAccount};
use super::{Clock, Sample, Step};
use crate::physics::observables::{self, Azimuth};
use crate::physics::workings::LoadInterval;
use crate::physics::{Loads, PointForce, Scheme, State, Workings};
use crate::scenario::{Edit, Motion, Pushes, Scenario};
use std::sync::Arc;

/// A run at one of its steps. [`step`](Self::step) takes it to the next. A clone is independent, and computes the same
/// bits.
#[derive(Clone)]
pub struct Simulation {
    now: Step,
    scheme: Box<dyn Scheme>,
    pushes: Pushes,
    /// Forces of the pushes on the next step, to be compared with those on the present one.
    acting: Vec<PointForce>,
    clock: Clock,
    counting: Counting,
    edits_made: usize,
    /// Step of the next edit, or [`u64::MAX`] if there is none.
    next_edit: u64,
    ended: Option<NotFinite>,
    /// The run before the loads were changed for the next step. If that step fails, the run is restored from it.
    unchanged: Option<Box<Step>>,
    /// While |L|² is below this, every number computed from a finite state is finite too.
    safe_below: f64,
    /// True if the workings of every step are kept.
    keeps_workings: bool,
    has_friction: bool,
}

/// Error: the numbers of a run are no longer finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} at step {step}: the run ends at step {}; try a shorter time step or another scheme",
    self.fact(),
    step - 1
)]
pub struct NotFinite {
    /// The step that failed.
    pub step: u64,
    /// True if the body turns too far in this step for the exact motion to be integrated.
    pub is_too_far: bool,
}

impl NotFinite {
    /// Describes the failure, without the step.
    pub fn fact(&self) -> &'static str {
        if self.is_too_far {
            "the body turns too far for the exact motion to be integrated"
        } else {
            "the numbers are no longer finite"
        }
    }
}

impl Simulation {
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let (motion, state) = (scenario.motion, scenario.start);
        let loads = Loads {
            gravity: motion.gravity,
            friction: scenario.friction,
            ..Loads::default()
        };
        let mut scheme = motion.scheme.make(&scenario.body.mechanics);
        scheme.load(&loads);
        scheme.start(&state);
        Self {
            scheme,
            pushes: Arc::clone(&scenario.pushes),
            acting: Vec::with_capacity(scenario.pushes.len()),
            clock: Clock::new(motion.time_step_s),
            counting: counting(&scenario),
            edits_made: 0,
            next_edit: step_of_edit(&scenario, 0),
            ended: None,
            unchanged: None,
            safe_below: safe_below(&scenario, motion.gravity),
            keeps_workings: false,
            has_friction: !scenario.friction.is_none(),
            now: Step {
                number: 0,
                segment: 0,
                motion,
                loads,
                changes: 0,
                before: state,
                after: state,
                azimuth: Azimuth::start(&state.axle()),
                energy: EnergyAccount::new(&scenario),
                rotor_turn: 0.0,
                workings: None,
                derived: Derived::default(),
                scenario,
            },
        }
    }

    /// Takes the run one time step further, and returns that step.
    ///
    /// # Errors
    /// Returns an error if the numbers stop being finite. The run then stays at its present step, and every further
    /// call fails too.
    #[inline]
    pub fn step(&mut self) -> Result<&Step, NotFinite> {
        self.take_step()?;
        Ok(&self.now)
    }

    fn take_step(&mut self) -> Result<(), NotFinite> {
        if let Some(end) = self.ended {
            return Err(end);
        }
        let (before, friction) = (self.now.after, self.now.energy.friction);
        if self.next_edit == self.now.number {
            self.make_due_edits();
        }
        self.now.derived = Derived::default();
        let mut workings = self.keeps_workings.then(Workings::default);
        let work = self.integrate_step(workings.as_mut());
        let now = &mut self.now;
        now.after.time_s = self.clock.time_s(now.number + 1);
        // Numbers can overflow only near the largest floats, so each is checked only there.
        let is_safe = now.after.momentum.norm_squared() < self.safe_below;
        if !now.after.is_finite() || !(is_safe || now.can_be_read()) {
            return Err(self.fail(before, friction));
        }
        now.before = before;
        now.energy.work += work;
        now.number += 1;
        now.workings = workings.map(Arc::new);
        now.azimuth.turn_to(&now.after.axle());
        now.turn_rotor();
        self.unchanged = None; // it may contain workings, which take much memory
        Ok(())
    }

    /// Ends the run at its present step, because the next one failed. Everything that was changed for the failed step
    /// is restored. `before` is the state at the present step, and `friction` the work of friction up to it, J.
    #[cold]
    fn fail(&mut self, before: State, friction: f64) -> NotFinite {
        if let Some(unchanged) = self.unchanged.take() {
            self.now = *unchanged;
        }
        let now = &mut self.now;
        now.energy.friction = friction;
        now.after = before;
        now.derived = Derived::default();
        let end = NotFinite {
            step: now.number + 1,
            is_too_far: self.scheme.has_given_up(),
        };
        self.ended = Some(end);
        end
    }

    #[inline]
    pub fn now(&self) -> &Step {
        &self.now
    }

    /// Sets whether the [workings](Step::workings) of future steps are kept. If not, those of the present step are
    /// dropped too. Keeping them does not change the run, but takes several times as long.
    pub fn keep_workings(&mut self, kept: bool) {
        self.keeps_workings = kept;
        self.now.workings.take_if(|_| !kept);
    }

    /// Steps until the run is at `step`.
    pub fn step_to(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.now.number < step {
            self.step()?;
        }
        Ok(())
    }

    /// Continues in `scenario`, which must have the same past: its differences apply to the steps to come. A run that
    /// has [ended](Self::has_ended) cannot continue.
    pub fn branch(&mut self, scenario: Arc<Scenario>) {
        self.edits_made = scenario
            .edits
            .partition_point(|edit| edit.step < self.now.number);
        self.next_edit = step_of_edit(&scenario, self.edits_made);
        let made = self
            .edits_made
            .checked_sub(1)
            .map(|last| &scenario.edits[last]);
        let pushes = made.map_or(&scenario.pushes, |edit| &edit.pushes);
        self.pushes = Arc::clone(pushes);
        self.now.scenario = scenario;
    }

    /// Returns true if the next step failed because its numbers are not finite.
    pub fn has_ended(&self) -> bool {
        self.ended.is_some()
    }

    /// Integrates the state over the next step. Returns the work of the pushes during it, J.
    fn integrate_step(&mut self, mut workings: Option<&mut Workings>) -> f64 {
        let time_step_s = self.now.motion.time_step_s;
        if self.pushes.is_empty() {
            self.integrate_part(time_step_s, workings);
            return 0.0;
        }
        let mut stretch = Stretch::step(self.now.number + 1, &self.clock);
        let mut work = 0.0;
        let end = stretch.end;
        if self.now.motion.scheme.continuous {
            while let Some(change) = pushes::next_change(&self.pushes, self.counting, &stretch) {
                stretch.end = change;
                let length = change - stretch.begin;
                work += self.integrate_under_push(&stretch, length, workings.as_deref_mut());
                (stretch.begin, stretch.end) = (change, end);
            }
        }
        let whole = stretch.begin == self.clock.time_s(self.now.number);
        let length = if whole {
            time_step_s
        } else {
            end - stretch.begin
        };
        work + self.integrate_under_push(&stretch, length, workings)
    }

    fn integrate_under_push(
        &mut self,
        stretch: &Stretch,
        length: f64,
        workings: Option<&mut Workings>,
    ) -> f64 {
        pushes::acting(&self.pushes, self.counting, stretch, &mut self.acting);
        if self.acting != self.now.loads.pushes {
            self.change_loads();
            self.now.loads.pushes.clone_from(&self.acting);
            self.scheme.load(&self.now.loads);
        }
        let before = self.now.after;
        self.integrate_part(length, workings);
        let now = &self.now;
        let body = &now.scenario.body.mechanics;
        let pushes = now.loads.pushes.iter();
        pushes
            .map(|push| {
                let [from, to] = [&before, &now.after]
                    .map(|state| observables::position(body, state, push.point));
                push.force.dot(&(to - from))
            })
            .sum()
    }

    /// Integrates the state over `length_s` (s) under the present loads.
    #[inline]
    fn integrate_part(&mut self, length_s: f64, workings: Option<&mut Workings>) {
        let state = &mut self.now.after;
        match workings {
            None => self.scheme.step(length_s, state),
            Some(workings) => {
                let mut phases = Vec::new();
                self.scheme.explain(length_s, state, &mut phases);
                workings.parts.push(LoadInterval {
                    length_s,
                    loads: self.now.loads.clone(),
                    phases,
                });
            }
        }
        if self.has_friction {
            self.now.energy.friction += self.scheme.friction_work();
        }
    }

    /// Counts a change of the loads. The first change for a step saves the run, in case the step fails.
    fn change_loads(&mut self) {
        if self.unchanged.is_none() {
            self.unchanged = Some(Box::new(self.now.clone()));
        }
        self.now.changes += 1;
    }

    /// Applies the edits made at this step.
    fn make_due_edits(&mut self) {
        let scenario = Arc::clone(&self.now.scenario);
        let first = self.edits_made;
        while let Some(edit) = scenario
            .edits
            .get(self.edits_made)
            .filter(|edit| edit.step == self.now.number)
        {
            self.make_edit(edit);
            self.now.segment += u64::from(edit.begins_segment);
            self.edits_made += 1;
        }
        if let Some(last) = scenario.edits[first..self.edits_made].last() {
            self.pushes = Arc::clone(&last.pushes);
        }
        self.next_edit = step_of_edit(&scenario, self.edits_made);
    }

    fn make_edit(&mut self, edit: &Edit) {
        self.change_loads();
        let now = &mut self.now;
        let body = &now.scenario.body.mechanics;
        if edit.sets_time_step {
            self.clock.change(now.number, edit.motion.time_step_s);
            self.counting = Counting::in_seconds(&now.scenario);
        }
        let lift = edit.motion.gravity - now.motion.gravity;
        now.energy.work += lift * observables::weight_height(body, &now.after);
        if edit.motion.scheme != now.motion.scheme {
            self.scheme = edit.motion.scheme.make(body);
            self.scheme.start(&now.after);
        }
        now.motion = edit.motion;
        now.loads.gravity = now.motion.gravity;
        self.safe_below = safe_below(&now.scenario, now.motion.gravity);
        now.loads.pushes.clear();
        self.scheme.load(&now.loads);
    }

    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.now.scenario
    }

    pub fn step_number(&self) -> u64 {
        self.now.number
    }

    pub fn state(&self) -> &State {
        &self.now.after
    }

    /// Returns the forces of the last step (at step 0: gravity alone).
    pub fn loads(&self) -> &Loads {
        &self.now.loads
    }

    /// Returns gravity, scheme and time step of the last step (at step 0: of the first).
    pub fn motion(&self) -> &Motion {
        &self.now.motion
    }

    /// Returns the scheme's remark on how the run was computed, if it has more than one variant.
    pub fn remark(&self) -> Option<String> {
        self.scheme.remark()
    }

    /// Returns the numbers of this step for output.
    pub fn sample(&self) -> Sample {
        self.now.sample()
    }

    /// Returns the first step at or after `time_s` (s), edits of the time step included.
    pub fn step_at(scenario: &Scenario, time_s: f64) -> u64 {
        let mut clock = Clock::new(scenario.motion.time_step_s);
        for edit in scenario.edits.iter().filter(|edit| edit.sets_time_step) {
            if clock.step_at(time_s) <= edit.step {
                break;
            }
            clock.change(edit.step, edit.motion.time_step_s);
        }
        clock.step_at(time_s)
    }

    /// Returns the time at which the next step ends, s.
    pub fn next_time_s(&self) -> f64 {
        let number = self.now.number;
        let mut clock = self.clock;
        let due = self.now.scenario.edits[self.edits_made..].iter();
        for edit in due.take_while(|edit| edit.step == number) {
            if edit.sets_time_step {
                clock.change(number, edit.motion.time_step_s);
            }
        }
        clock.time_s(number + 1)
    }

    /// Takes one step of the scheme that ends at `time_s`, s, in place of the run's next step.
    ///
    /// Up to the time of the next step, this gives the run between its steps, with the same accuracy. It does nothing
    /// if `time_s` is not later than now.
    ///
    /// The steps that follow have other times than those of the run. If the run is still needed, call this on a clone.
    pub fn step_to_time(&mut self, time_s: f64) -> Result<(), NotFinite> {
        if self.next_edit == self.now.number {
            self.make_due_edits();
        }
        let length_s = time_s - self.now.after.time_s;
        if length_s <= 0.0 {
            return Ok(());
        }
        self.clock.change(self.now.number, length_s);
        self.now.motion.time_step_s = length_s;
        self.take_step()?;
        self.now.after.time_s = time_s; // not the sum, whose last digit may differ
        Ok(())
    }
}

fn step_of_edit(scenario: &Scenario, index: usize) -> u64 {
    scenario.edits.get(index).map_or(u64::MAX, |edit| edit.step)
}

/// Returns the unit of the step counts of pushes: steps, unless they were written for another time step.
fn counting(scenario: &Scenario) -> Counting {
    if scenario.written_for_s == scenario.motion.time_step_s {
        Counting::Steps
    } else {
        Counting::in_seconds(scenario)
    }
}

/// Returns the |L|² (J² s²) below which energy and traced point are always in the range of numbers; 0 if there is no
/// such limit.
fn safe_below(scenario: &Scenario, gravity: f64) -> f64 {
    const LARGEST_STATE: f64 = 1e300;
    let body = &scenario.body.mechanics;
    let weight = gravity.abs() * body.first_moment().norm();
    if weight < LARGEST_STATE && scenario.arm_m() < LARGEST_STATE {
        LARGEST_STATE / body.inverse_inertia().trace().max(1.0)
    } else {
        0.0
    }
}
