//! A run on the screen: the simulation, and the data of its pictures.
//!
//! It can return to any step that it has reached before. It loads the last checkpoint before that step and steps on
//! from there, with the same bits as the first time. The pictures of later steps are stored separately.

mod pictures;

use super::path::PathFromAbove;
use crate::engine::analysis::cost::{has_closed_form, integration_rad_per_s, is_affordable};
use crate::engine::analysis::readouts::ReadoutSource;
use crate::engine::analysis::{ExactReference, Monitor, Readouts};
use crate::engine::journal::restart::in_force;
use crate::engine::recording::{RecordedSample, Recording};
use crate::engine::run::{Moment, NotFinite, Simulation};
use crate::engine::scenario::Scenario;
use crate::physics::{State, Workings};
pub use pictures::Overlay;
use pictures::Pictures;
use std::sync::Arc;

/// Steps between two readings of the clock for a body of one point. A body of n points takes 1/n of that.
const STEPS_PER_LOOK: usize = 4096;

/// Cost of a step in addition to its points, in points.
const COST_OF_A_STEP: u64 = 60;
/// Cost of an integration of the exact motion, in points per radian.
const COST_OF_A_RADIAN: f64 = 1000.0;

/// Maximum cost of integrations for the intermediate results of a step: about half a second.
const MOST_INTEGRATION: u64 = 250_000_000;

/// A remaining time below this share of a time step is rounding error.
const DUE_TIME_ROUNDING: f64 = 1e-6;

pub struct LiveRun {
    simulation: Simulation,
    monitor: Monitor,
    checkpoints: Checkpoints,
    pictures: Pictures,
    shows_exact: bool,
    overlay: Option<Overlay>,
    keeps_workings: bool,
    /// The intermediate results that were last recomputed, with the number of their step.
    explained: Option<(u64, Arc<Workings>)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayEnd {
    /// The run has stepped the whole simulated time.
    InTime,
    CutShort,
    AtStop,
    Fulfilled,
    NotFinite(NotFinite),
}

impl LiveRun {
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let reach = scenario.arm_m();
        let simulation = Simulation::new(scenario);
        let monitor = Monitor::new(simulation.now());
        Self {
            checkpoints: Checkpoints::new(&simulation, &monitor),
            pictures: Pictures::new(simulation.now(), reach),
            monitor,
            simulation,
            shows_exact: false,
            overlay: None,
            keeps_workings: false,
            explained: None,
        }
    }

    /// Takes one time step.
    ///
    /// # Errors
    /// Returns an error if the numbers stop being finite. The run then stays at the previous step.
    pub fn step(&mut self) -> Result<(), NotFinite> {
        let step = self.simulation.step()?;
        self.monitor.record(step);
        self.pictures.record(step);
        self.checkpoints.offer(&self.simulation, &self.monitor);
        Ok(())
    }

    /// Steps until the run is at `step`, or until `is_over` returns true: see [`play`](Self::play).
    ///
    /// # Errors
    /// Returns an error if the numbers stop being finite. The run then stays at the previous step.
    pub fn step_to(&mut self, step: u64, is_over: impl FnMut() -> bool) -> Result<(), NotFinite> {
        match self.play(f64::INFINITY, step, is_over, |_| false) {
            PlayEnd::NotFinite(error) => Err(error),
            _ => Ok(()),
        }
    }

    /// Returns the latest step that the run has reached.
    pub fn furthest(&self) -> u64 {
        self.pictures.furthest()
    }

    /// Starts seeking `step`, or the furthest step that the run has reached if that is earlier. The run is then at that
    /// step, or at an earlier one with the step as its [`seek_target`](Self::seek_target).
    pub fn begin_seek(&mut self, step: u64) {
        self.cancel_seek();
        let here = self.simulation.step_number();
        let target = step.min(self.furthest());
        if target == here {
            return;
        }
        if target < here {
            self.set_overlay(self.shows_exact);
        }
        let latest = self.pictures.begin_seek(target, here);
        self.load_checkpoint(latest);
        self.pictures.keep(self.simulation.step_number());
    }

    /// Returns the step that the run seeks; `None` if it has arrived. Repeated calls of [`step`](Self::step) lead
    /// there.
    pub fn seek_target(&self) -> Option<u64> {
        let (step, target) = (self.simulation.step_number(), self.pictures.followed_to);
        (step < target).then_some(target)
    }

    /// Stays at the present step instead of the seek target. If the recording lacks steps, it is filled with the
    /// present sample.
    pub fn cancel_seek(&mut self) {
        if self.seek_target().is_some() {
            self.pictures.cancel_seek(self.simulation.step_number());
        }
    }

    /// Returns a copy of the run at the last stored state that is not later than `step`, to step through its past.
    pub(super) fn again_before(&self, step: u64) -> Simulation {
        let Some(stored) = self.checkpoint_before(step) else {
            return self.simulation.clone();
        };
        let mut again = stored.simulation.clone();
        if !Arc::ptr_eq(again.scenario(), self.scenario()) {
            again.branch(Arc::clone(self.scenario()));
        }
        again
    }

    /// Returns the last checkpoint that is not later than `step`; `None` if the present state is nearer.
    fn checkpoint_before(&self, step: u64) -> Option<&Checkpoint> {
        let stored = self.checkpoints.before(step);
        let here = self.simulation.step_number();
        let is_nearer = (stored.simulation.step_number()..=step).contains(&here);
        (!is_nearer || self.simulation.has_ended()).then_some(stored)
    }

    /// Moves the run to the last stored state that is not later than `latest`: a checkpoint, or the present state.
    fn load_checkpoint(&mut self, latest: u64) {
        let Some(stored) = self.checkpoint_before(latest) else {
            return;
        };
        let scenario = Arc::clone(self.simulation.scenario());
        (self.simulation, self.monitor) = (stored.simulation.clone(), stored.monitor.clone());
        self.simulation.keep_workings(self.keeps_workings);
        self.pictures.return_to(self.simulation.now());
        self.replace_metadata(&scenario);
    }

    /// Makes the simulation and its measurements follow `scenario`, which has the same past, from the present step on.
    ///
    /// The pictures stay. If `scenario` leads to other numbers, call [`branch`](Self::branch).
    pub fn replace_metadata(&mut self, scenario: &Arc<Scenario>) {
        if !Arc::ptr_eq(self.simulation.scenario(), scenario) {
            self.simulation.branch(Arc::clone(scenario));
            self.monitor.beside.branch(scenario);
        }
    }

    /// Continues with `scenario`, which has the same motion up to the present step and the seek target. Drops the
    /// pictures of later steps.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.pictures.ahead = None;
        self.explained = None;
        self.checkpoints.cut_back(self.pictures.followed_to);
        if self.simulation.has_ended() {
            self.load_checkpoint(self.simulation.step_number());
        }
        self.replace_metadata(scenario);
        let now_s = self.now().time_s;
        match &mut self.overlay {
            Some(overlay) if is_affordable(scenario) && overlay.can_continue_at(now_s) => {
                overlay.branch(scenario);
            }
            _ => self.set_overlay(self.shows_exact),
        }
    }

    /// Plays for `time_s` simulated seconds, in whole steps.
    ///
    /// It ends earlier at the step `stop`, at a step for which `is_fulfilled` returns true, or when `is_over` returns
    /// true because the computing time is used up.
    pub fn play(
        &mut self,
        time_s: f64,
        stop: u64,
        mut is_over: impl FnMut() -> bool,
        mut is_fulfilled: impl FnMut(&mut Self) -> bool,
    ) -> PlayEnd {
        let begin_s = self.now().time_s;
        let look_every = self.steps_per_look();
        let mut until_look = look_every;
        loop {
            let time_step_s = self.simulation.motion().time_step_s;
            if self.simulation.step_number() >= stop {
                break PlayEnd::AtStop;
            }
            if self.now().time_s + time_step_s - begin_s > time_s + DUE_TIME_ROUNDING * time_step_s
            {
                break PlayEnd::InTime;
            }
            if let Err(error) = self.step() {
                break PlayEnd::NotFinite(error);
            }
            if is_fulfilled(self) {
                break PlayEnd::Fulfilled;
            }
            until_look -= 1;
            if until_look == 0 {
                if is_over() {
                    break PlayEnd::CutShort;
                }
                until_look = look_every;
            }
        }
    }

    /// Returns the number of steps between two readings of the clock. An integrated step may take long without warning,
    /// because a push may begin.
    fn steps_per_look(&self) -> usize {
        if !has_closed_form(self.scenario()) {
            return 1;
        }
        (STEPS_PER_LOOK / self.scenario().body.mechanics.points().len()).max(1)
    }

    /// Returns the cost of a step, in points of a body: its points, a constant, and the integration of the exact
    /// motion.
    pub fn cost_of_a_step(&self) -> u64 {
        let points = self.scenario().body.mechanics.points().len() as u64;
        let beside = self.monitor.beside.motions();
        (points + COST_OF_A_STEP).saturating_add(integration_cost(&self.simulation, beside))
    }

    /// Shows the exact motion if it is affordable, or hides it.
    pub fn set_overlay(&mut self, shown: bool) {
        let scenario = self.simulation.scenario();
        self.overlay = (shown && is_affordable(scenario)).then(|| Overlay::new(scenario));
        self.shows_exact = shown;
    }

    pub fn shows_exact(&self) -> bool {
        self.shows_exact
    }

    /// Advances the exact motion, if it is shown, to the time of the run, or until `is_over` returns true.
    pub fn follow_exact(&mut self, is_over: impl FnMut() -> bool) {
        let now_s = self.now().time_s;
        if let Some(overlay) = &mut self.overlay {
            overlay.advance_to(now_s, &self.pictures.recording, is_over);
        }
    }

    pub fn overlay(&self) -> Option<&Overlay> {
        self.overlay.as_ref()
    }

    /// Returns the present sample of the exact motion if it is shown and has reached the time of the run.
    pub fn exact_now(&self) -> Option<&RecordedSample> {
        let now = &self.overlay.as_ref()?.now;
        (now.time_s >= self.now().time_s).then_some(now)
    }

    /// Returns the exact motion at the present time, even if it is hidden; `None` if it is unknown.
    pub fn exact_moment(&mut self) -> Option<Moment> {
        let now = self.simulation.now();
        exact_moment(&mut self.monitor.beside, now.time_s(), now.scenario())
    }

    /// Returns the exact motion at `time_s` (s), the time of `step`; `None` if it is unknown.
    pub(super) fn exact_moment_at(&self, step: u64, time_s: f64) -> Option<Moment> {
        let scenario = self.scenario();
        let mut beside = match self.checkpoint_before(step) {
            Some(stored) => stored.monitor.beside.clone(),
            None => self.monitor.beside.clone(),
        };
        beside.branch(scenario);
        exact_moment(&mut beside, time_s, scenario)
    }

    /// Returns true if the exact motion is shown and is behind the run.
    pub fn overlay_is_behind(&self) -> bool {
        let now_s = self.now().time_s;
        let overlay = self.overlay.as_ref();
        overlay.is_some_and(|overlay| overlay.is_before(now_s))
    }

    pub fn readouts(&mut self) -> Readouts {
        let health = self.monitor.health(self.simulation.now());
        Readouts::new(&self.simulation, &mut self.monitor, &health, None)
    }

    /// Updates the part `source` of `readouts`, which were read at an earlier step.
    pub fn read_again(&mut self, readouts: &mut Readouts, source: ReadoutSource) {
        readouts.read_again(source, &self.simulation, &mut self.monitor);
    }

    /// Sets whether the intermediate results of every further step are kept, for a pane that shows them while the run
    /// plays.
    pub fn keep_workings(&mut self, kept: bool) {
        self.keeps_workings = kept;
        self.simulation.keep_workings(kept);
    }

    /// Returns the intermediate results of the latest step; `None` at step 0.
    ///
    /// If they were not kept, that step is repeated on a copy of the run, from the last checkpoint before it. Returns
    /// `None` if that would take too long.
    pub fn workings(&mut self) -> Option<Arc<Workings>> {
        let now = self.simulation.now();
        let before = now.number().checked_sub(1)?;
        if let Some(workings) = now.workings() {
            return Some(Arc::clone(workings));
        }
        let known = self.explained.as_ref();
        if let Some((_, workings)) = known.filter(|(step, _)| *step == before + 1) {
            return Some(Arc::clone(workings));
        }
        let mut again = self.again_before(before);
        let mut left = MOST_INTEGRATION;
        while again.step_number() < before {
            left = left.checked_sub(integration_cost(&again, 0))?;
            again.step().ok()?;
        }
        again.keep_workings(true);
        let workings = again.step().ok()?.workings()?;
        self.explained = Some((before + 1, Arc::clone(workings)));
        Some(Arc::clone(workings))
    }

    /// Returns the step and the state at which the body was last rigid, if the scheme has broken down since.
    pub fn last_whole(&self) -> Option<&(u64, State)> {
        self.pictures.last_whole.as_ref()
    }

    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    pub fn scenario(&self) -> &Arc<Scenario> {
        self.simulation.scenario()
    }

    pub fn now(&self) -> &RecordedSample {
        &self.pictures.now
    }

    pub fn pictures(&self) -> (&Recording, &PathFromAbove) {
        match &self.pictures.ahead {
            Some(ahead) => (&ahead.recording, &ahead.path),
            None => (&self.pictures.recording, &self.pictures.path),
        }
    }

    pub fn recording(&self) -> &Recording {
        &self.pictures.recording
    }

    pub fn path(&self) -> &PathFromAbove {
        &self.pictures.path
    }
}

fn exact_moment(beside: &mut ExactReference, time_s: f64, scenario: &Scenario) -> Option<Moment> {
    let state = beside.exact_state(time_s)?;
    Some(Moment::of_exact_motion(scenario, &state))
}

/// Returns the cost of the integrations in the next step of `simulation`, in points of a body: one if its scheme is the
/// exact one, and `others` more.
pub fn integration_cost(simulation: &Simulation, others: u32) -> u64 {
    let (motion, _) = in_force(simulation.scenario(), simulation.step_number());
    let is_exact = motion.scheme.order.is_none();
    let integrations = f64::from(others) + f64::from(is_exact);
    if integrations == 0.0 {
        return 0;
    }
    let rad_per_s = integration_rad_per_s(simulation.scenario(), simulation.state());
    (integrations * rad_per_s * motion.time_step_s * COST_OF_A_RADIAN).ceil() as u64
}

/// Initial number of steps between two checkpoints; a power of two.
const SPACING: u64 = 256;
const MEMORY: usize = 24 << 20;
const PER_POINT: usize = 64;
/// Memory of one checkpoint without its points, bytes.
const PER_CHECKPOINT: usize = 16 << 10;
/// Minimum number of checkpoints, however large the body.
const FEWEST_CHECKPOINTS: usize = 8;

/// A copy of a run at one step, and the measurements on its steps up to there.
struct Checkpoint {
    simulation: Simulation,
    monitor: Monitor,
}

/// Stored states, equally spaced from the start. When there are too many, every second one is dropped and the spacing
/// doubles, so that memory is bounded however long the run is.
struct Checkpoints {
    stored: Vec<Checkpoint>,
    spacing: u64,
    most: usize,
}

impl Checkpoint {
    fn new(simulation: &Simulation, monitor: &Monitor) -> Self {
        let mut stored = Self {
            simulation: simulation.clone(),
            monitor: monitor.clone(),
        };
        stored.simulation.keep_workings(false); // they may need much memory, and one step recomputes them
        stored
    }

    fn step(&self) -> u64 {
        self.simulation.step_number()
    }
}

impl Checkpoints {
    pub fn new(simulation: &Simulation, monitor: &Monitor) -> Self {
        let points = simulation.scenario().body.mechanics.points().len();
        Self {
            stored: vec![Checkpoint::new(simulation, monitor)],
            spacing: SPACING,
            most: (MEMORY / (PER_CHECKPOINT + PER_POINT * points)).max(FEWEST_CHECKPOINTS),
        }
    }

    /// Stores a run and the measurements on its steps if its step is a multiple of the spacing. Must be called after
    /// every step.
    #[inline]
    pub fn offer(&mut self, simulation: &Simulation, monitor: &Monitor) {
        if simulation.step_number() & (self.spacing - 1) == 0 {
            self.keep(simulation, monitor);
        }
    }

    fn keep(&mut self, simulation: &Simulation, monitor: &Monitor) {
        if self.before(u64::MAX).step() >= simulation.step_number() {
            return; // this step is stored already
        }
        self.stored.push(Checkpoint::new(simulation, monitor));
        if self.stored.len() > self.most + 1 {
            self.spacing *= 2;
            self.stored
                .retain(|stored| stored.step().is_multiple_of(self.spacing));
        }
    }

    pub fn before(&self, step: u64) -> &Checkpoint {
        let begun = self.stored.partition_point(|stored| stored.step() <= step);
        &self.stored[begun.saturating_sub(1)]
    }

    pub fn cut_back(&mut self, step: u64) {
        self.stored.retain(|stored| stored.step() <= step);
    }
}

#[cfg(test)]
impl LiveRun {
    /// Returns the run of a preset, played to the step `steps`.
    pub fn played(preset: &str, steps: u64) -> Self {
        let mut run = Self::new(crate::lab::for_tests::preset(preset));
        run.step_to(steps, || false).unwrap();
        run
    }
}
