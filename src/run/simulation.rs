//! The one road forward in time.

use super::pushes::{self, Counting, Stretch};
use super::{Clock, Sample};
use crate::physics::observables::{self, Azimuth};
use crate::physics::{Loads, PointForce, Scheme, State, StepRecord};
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
    before: State,
    state: State,
    azimuth: Azimuth,
    energy: EnergyAccount,
    ended: Option<NotFinite>,
}

/// What the energy would be if the scheme made no error.
#[derive(Clone, Copy, Debug)]
struct EnergyAccount {
    /// Energy at the start, J.
    start: f64,
    /// Work of pushes and of edits of gravity since then, J.
    work: f64,
    /// M g |c|, or the kinetic energy at the start where that is 0, J.
    scale: f64,
}

/// The numbers of a run are no longer finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the numbers are no longer finite at step {step}: the run ends at step {}", step - 1)]
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
        let weight = motion.gravity.abs() * body.first_moment().norm();
        let energy = EnergyAccount {
            start: kinetic + motion.gravity * observables::weight_height(body, &state),
            work: 0.0,
            scale: if weight > 0.0 { weight } else { kinetic },
        };
        Self {
            scheme,
            motion,
            pushes: scenario.pushes.as_slice().into(),
            acting: Vec::with_capacity(scenario.pushes.len()),
            loads,
            clock: Clock::new(motion.time_step_s),
            counting: Counting::Steps,
            step: 0,
            segment: 0,
            edits_made: 0,
            before: state,
            state,
            azimuth: Azimuth::start(&state.axle()),
            energy,
            ended: None,
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
        let (motion, energy) = (self.motion, self.energy);
        let resume = self.make_due_edits();
        let mut next = self.state;
        let work = self.advance(&mut next);
        next.time_s = self.clock.time_s(self.step + 1);
        if !self.can_be_read(&next) {
            // This step's edits have led nowhere: the run is read as it stood before them.
            (self.motion, self.energy) = (motion, energy);
            let end = NotFinite {
                step: self.step + 1,
            };
            self.ended = Some(end);
            return Err(end);
        }
        self.segment += resume;
        self.energy.work += work;
        self.before = std::mem::replace(&mut self.state, next);
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

    /// Whether every number read off `state` is finite: squares leave the range of numbers before L itself does. A
    /// finite energy means a finite Omega too.
    fn can_be_read(&self, state: &State) -> bool {
        let body = &self.scenario.body.mechanics;
        let potential = self.motion.gravity * observables::weight_height(body, state);
        let energy = observables::kinetic_energy(body, state) + potential;
        let traced = observables::position(body, state, self.scenario.trace);
        state.is_finite() && energy.is_finite() && traced.iter().all(|c| c.is_finite())
    }

    /// Takes `state` through the coming step and returns the work the pushes did on the way, J.
    fn advance(&mut self, state: &mut State) -> f64 {
        let mut stretch = Stretch::step(self.step + 1, &self.clock);
        if self.pushes.is_empty() {
            self.scheme.step(self.motion.time_step_s, state);
            return 0.0;
        }
        let mut work = 0.0;
        let end = stretch.end;
        if self.motion.scheme.continuous {
            while let Some(change) = pushes::next_change(&self.pushes, self.counting, &stretch) {
                stretch.end = change;
                work += self.advance_under_push(&stretch, change - stretch.begin, state);
                (stretch.begin, stretch.end) = (change, end);
            }
        }
        let whole = stretch.begin == self.clock.time_s(self.step);
        let length = if whole {
            self.motion.time_step_s
        } else {
            end - stretch.begin
        };
        work + self.advance_under_push(&stretch, length, state)
    }

    fn advance_under_push(&mut self, stretch: &Stretch, length: f64, state: &mut State) -> f64 {
        pushes::acting(&self.pushes, self.counting, stretch, &mut self.acting);
        if self.acting != self.loads.pushes {
            self.loads.pushes.clone_from(&self.acting);
            self.scheme.load(&self.loads);
        }
        let before = *state;
        self.scheme.step(length, state);
        let body = &self.scenario.body.mechanics;
        let moved = |push: &PointForce| {
            let at = body.points()[push.point].at;
            push.force
                .dot(&(state.orientation * at - before.orientation * at))
        };
        self.loads.pushes.iter().map(moved).sum()
    }

    /// Carries out the edits made at this step, and says how many segments they begin.
    fn make_due_edits(&mut self) -> u64 {
        let scenario = Arc::clone(&self.scenario);
        let mut segments = 0;
        while let Some(edit) = scenario
            .edits
            .get(self.edits_made)
            .filter(|edit| edit.step == self.step)
        {
            self.make_edit(edit);
            segments += u64::from(edit.touches.segment);
            self.edits_made += 1;
        }
        segments
    }

    fn make_edit(&mut self, edit: &Edit) {
        let body = &self.scenario.body.mechanics;
        if edit.touches.time_step {
            self.clock.change(self.step, edit.motion.time_step_s);
            self.counting = Counting::Seconds {
                written_for_s: self.scenario.motion.time_step_s,
            };
        }
        let lift = edit.motion.gravity - self.motion.gravity;
        self.energy.work += lift * observables::weight_height(body, &self.state);
        if edit.motion.scheme != self.motion.scheme {
            self.scheme = edit.motion.scheme.make(body);
            self.scheme.start(&self.state);
        }
        self.motion = edit.motion;
        self.pushes = edit.pushes.as_slice().into();
        self.loads.gravity = self.motion.gravity;
        self.loads.pushes.clear();
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

    /// Gravity, scheme and time step of the step taken last (at step 0: of the first).
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The whole of the step taken last; `None` at step 0.
    pub fn record(&self) -> Option<StepRecord> {
        (self.step > 0).then(|| StepRecord {
            step: self.step,
            time_step_s: self.motion.time_step_s,
            before: self.before,
            workings: self
                .scheme
                .workings(&self.before, &self.state, self.motion.time_step_s),
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
    /// gravity, S = M g |c| or else the kinetic energy at the start; `None` where both are 0.
    pub fn energy_drift(&self) -> Option<f64> {
        let gained = self.sample().energy - self.energy.start - self.energy.work;
        (self.energy.scale > 0.0).then(|| gained / self.energy.scale)
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
