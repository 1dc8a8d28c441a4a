//! A run that is being watched: the simulation, and the data of its pictures.
//!
//! It can return to any step that it has reached before: it loads the last [checkpoint](Checkpoints) before that step and
//! steps on from there, with the same bits as the first time. The pictures of the steps that then lie ahead are stored
//! separately.

mod on_two_cores;

use super::checkpoints::Checkpoints;
use super::overlay::Overlay;
use super::path::Path;
use super::recording::{Moment, Recording};
use crate::analysis::readouts::Source;
use crate::analysis::{Health, Instruments, Monitor, Readouts, Theory};
use crate::physics::{State, Workings};
use crate::run::{NotFinite, Simulation, Step};
use crate::scenario::Scenario;
use std::cmp::Ordering;
use std::sync::Arc;

/// Steps between two readings of the clock for a body of one point; a body of n points takes 1/n of that.
const STEPS_PER_LOOK: usize = 4096;

/// A remaining time below this share of a time step is rounding.
const ROUNDING: f64 = 1e-6;

/// A run that is being watched.
pub struct LiveRun {
    simulation: Simulation,
    monitor: Monitor,
    checkpoints: Checkpoints,
    now: Moment,
    recording: Recording,
    path: Path,
    /// The last step in the path. It is later than the present step while the run is still stepping towards it.
    followed_to: u64,
    ahead: Option<Ahead>,
    overlay: Option<Overlay>,
    keeps_workings: bool,
    /// The last state in which the body was a rigid one, and its step; `None` where it still is one.
    last_whole: Option<(u64, State)>,
    /// The workings that were asked for last without having been kept, and of which step they are.
    explained: Option<(u64, Arc<Workings>)>,
}

/// The pictures of a run up to the furthest step it has been at, while it stands at an earlier one.
struct Ahead {
    step: u64,
    recording: Recording,
    path: Path,
}

/// The result of playing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Played {
    /// Simulated time that passed, s.
    pub stepped_s: f64,
    /// Why playing ended.
    pub end: PlayEnd,
}

/// Why playing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayEnd {
    /// The run has stepped all the simulated time that it was given.
    InTime,
    /// The time for computing was used up.
    CutShort,
    /// The run stands at its stop.
    AtStop,
    /// The condition to which it was played holds.
    Fulfilled,
    /// The numbers are no longer finite.
    NotFinite(NotFinite),
}

impl LiveRun {
    /// The run of `scenario`, at step 0.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let reach = scenario.arm_m();
        let simulation = Simulation::new(scenario);
        let monitor = Monitor::new(simulation.now());
        let now = moment(simulation.now());
        let mut run = Self {
            checkpoints: Checkpoints::new(&simulation, &monitor),
            monitor,
            simulation,
            now,
            recording: Recording::default(),
            path: Path::new(reach),
            followed_to: 0,
            ahead: None,
            overlay: None,
            keeps_workings: false,
            last_whole: None,
            explained: None,
        };
        run.recording.push(&run.now);
        run.path.follow(0, &run.now.position);
        run
    }

    /// Takes one time step.
    ///
    /// # Errors
    /// When the numbers stop being finite; the run then stays at the step before.
    pub fn step(&mut self) -> Result<(), NotFinite> {
        self.take_step(Monitor::follow).map(drop)
    }

    /// Takes one time step, of which the monitor takes in what `follow` gives it. Returns whether that stored a checkpoint.
    #[inline]
    fn take_step(&mut self, follow: impl Fn(&mut Monitor, &Step)) -> Result<bool, NotFinite> {
        let step = self.simulation.step()?;
        follow(&mut self.monitor, step);
        self.now = moment(step);
        if self.last_whole.is_none() && !step.after().is_a_rotation() {
            let before = step.before().filter(|before| before.is_a_rotation());
            self.last_whole = before.map(|before| (step.number() - 1, *before));
        }
        let is_stored = self.checkpoints.offer(&self.simulation, &self.monitor);
        self.keep();
        Ok(is_stored)
    }

    /// Adds the present moment to the recording and the path, unless they have it already.
    fn keep(&mut self) {
        let step = self.simulation.step_number();
        if step >= self.recording.moments() {
            self.recording.push(&self.now);
        }
        match step.cmp(&self.followed_to) {
            Ordering::Less => {}
            Ordering::Equal => self.path.stand_at(&self.now.position),
            Ordering::Greater => {
                self.path.follow(step, &self.now.position);
                self.followed_to = step;
            }
        }
        if let Some(ahead) = self.ahead.take_if(|ahead| ahead.step == step) {
            (self.recording, self.path) = (ahead.recording, ahead.path);
        }
    }

    /// The furthest step that the run has reached.
    pub fn furthest(&self) -> u64 {
        let ahead = self.ahead.as_ref().map_or(0, |ahead| ahead.step);
        ahead.max(self.followed_to)
    }

    /// The step for which it has set out, if it has not arrived. Calling [`step`](Self::step) repeatedly leads there.
    pub fn destination(&self) -> Option<u64> {
        let step = self.simulation.step_number();
        (step < self.followed_to).then_some(self.followed_to)
    }

    /// Sets out for `step`, or for the furthest step that it has reached if that is earlier. It then stands at that step, or
    /// at an earlier one with the step as its [`destination`](Self::destination).
    pub fn set_out_for(&mut self, step: u64) {
        self.stay();
        let here = self.simulation.step_number();
        let step = step.min(self.furthest());
        if step == here {
            return;
        }
        let ahead = self.ahead.get_or_insert_with(|| Ahead {
            step: here,
            recording: self.recording.clone(),
            path: self.path.clone(),
        });
        if step > here {
            self.recording.clone_from(&ahead.recording);
            self.path.clone_from(&ahead.path);
        } else if self.overlay.is_some() {
            self.set_overlay(true);
        }
        self.path.cut_back(step);
        self.followed_to = step;
        let recorded = self.cut_back_recording(step + 1);
        self.stand_before(step.min(recorded.saturating_sub(1)), here);
        if self.recording.moments() == 0 {
            self.recording.push(&self.now);
        }
        self.keep();
    }

    /// Cuts the recording back to at most `moments`, and so far that filling it again makes it fine enough. Returns how
    /// many moments it keeps.
    fn cut_back_recording(&mut self, moments: u64) -> u64 {
        let kept = self.recording.cut_back(moments);
        match self.recording.coarse_since() {
            Some(from) => self.recording.cut_back(from),
            None => kept,
        }
    }

    /// A copy of the run at the last stored state that is at `step` or before, to step through what it has been through.
    pub(super) fn again_before(&self, step: u64) -> Simulation {
        let stored = &self.checkpoints.before(step).simulation;
        let here = self.simulation.step_number();
        if (stored.step_number()..=step).contains(&here) && !self.simulation.has_ended() {
            return self.simulation.clone();
        }
        let mut again = stored.clone();
        if !Arc::ptr_eq(again.scenario(), self.scenario()) {
            again.go_on_in(Arc::clone(self.scenario()));
        }
        again
    }

    /// Puts the run at the latest stored state that is not later than `latest`: a checkpoint, or the present one, which is
    /// at step `here`.
    fn stand_before(&mut self, latest: u64, here: u64) {
        let checkpoint = self.checkpoints.before(latest);
        if (checkpoint.step()..=latest).contains(&here) && !self.simulation.has_ended() {
            return;
        }
        let scenario = Arc::clone(self.simulation.scenario());
        (self.simulation, self.monitor) =
            (checkpoint.simulation.clone(), checkpoint.monitor.clone());
        self.simulation.keep_workings(self.keeps_workings);
        self.now = moment(self.simulation.now());
        let here = self.simulation.step_number();
        self.last_whole.take_if(|(step, _)| *step >= here);
        self.adopt(&scenario);
    }

    /// Makes `scenario` the one that the simulation and its measurements follow from the present step on.
    fn adopt(&mut self, scenario: &Arc<Scenario>) {
        if !Arc::ptr_eq(self.simulation.scenario(), scenario) {
            self.simulation.go_on_in(Arc::clone(scenario));
            self.monitor.go_on_in(scenario);
        }
    }

    /// Cancels its way to the destination and stays at the present step. Where the recording lacks steps, it is filled with
    /// the present moment.
    pub fn stay(&mut self) {
        if self.destination().is_none() {
            return;
        }
        let step = self.simulation.step_number();
        self.path.cut_back(step);
        self.path.stand_at(&self.now.position);
        self.followed_to = step;
        for _ in self.recording.cut_back(step + 1)..=step {
            self.recording.push(&self.now);
        }
    }

    /// Continues with `scenario`, which has the same motion up to the present step and up to the destination. The pictures
    /// of later steps are dropped.
    pub fn go_on_in(&mut self, scenario: &Arc<Scenario>) {
        self.ahead = None;
        self.explained = None;
        self.checkpoints.cut_back(self.followed_to);
        if self.simulation.has_ended() {
            let here = self.simulation.step_number();
            self.stand_before(here, here);
        }
        self.adopt(scenario);
        match &mut self.overlay {
            Some(overlay) if overlay.now().time_s <= self.now.time_s => overlay.go_on_in(scenario),
            overlay => *overlay = overlay.is_some().then(|| Overlay::new(scenario)),
        }
    }

    /// Replaces the scenario by one that leads to the same numbers at every step: another title, length or `[view]`.
    pub fn describe_as(&mut self, scenario: &Arc<Scenario>) {
        self.adopt(scenario);
    }

    /// Plays for `time_s` simulated seconds, in whole steps. It ends earlier at the step `stop`, at a step where
    /// `is_fulfilled` returns true, or when `enough` returns true because the time for computing is used up.
    pub fn play(
        &mut self,
        time_s: f64,
        stop: u64,
        mut enough: impl FnMut() -> bool,
        mut is_fulfilled: impl FnMut(&mut Self) -> bool,
    ) -> Played {
        let begin_s = self.now.time_s;
        let look_every = (STEPS_PER_LOOK / self.scenario().body.mechanics.points().len()).max(1);
        let mut until_look = look_every;
        let end = loop {
            let time_step_s = self.simulation.motion().time_step_s;
            if self.now.time_s + time_step_s - begin_s > time_s + ROUNDING * time_step_s {
                break PlayEnd::InTime;
            }
            if self.simulation.step_number() >= stop {
                break PlayEnd::AtStop;
            }
            if let Err(error) = self.step() {
                break PlayEnd::NotFinite(error);
            }
            if is_fulfilled(self) {
                break PlayEnd::Fulfilled;
            }
            until_look -= 1;
            if until_look == 0 {
                if enough() {
                    break PlayEnd::CutShort;
                }
                until_look = look_every;
            }
        };
        Played {
            stepped_s: self.now.time_s - begin_s,
            end,
        }
    }

    /// Shows the exact motion beside the run, or does not.
    pub fn set_overlay(&mut self, shown: bool) {
        self.overlay = shown.then(|| Overlay::new(self.simulation.scenario()));
    }

    /// Advances the exact motion to the run's time, or until `enough` returns true.
    pub fn follow_exact(&mut self, enough: impl FnMut() -> bool) {
        if let Some(overlay) = &mut self.overlay {
            overlay.follow(self.now.time_s, enough);
        }
    }

    /// The exact motion, where it is shown.
    pub fn overlay(&self) -> Option<&Overlay> {
        self.overlay.as_ref()
    }

    /// Whether the exact motion is shown and its time is earlier than the run's.
    pub fn overlay_is_behind(&self) -> bool {
        self.overlay
            .as_ref()
            .is_some_and(|overlay| overlay.now().time_s < self.now.time_s)
    }

    /// How reliable the run's numbers are at the present step.
    pub fn health(&mut self) -> Health {
        self.monitor.health(self.simulation.now())
    }

    /// Every number that is read off it where it stands.
    pub fn readouts(&mut self) -> Readouts {
        let health = self.health();
        Readouts::new(&self.simulation, &mut self.monitor, &health, None)
    }

    /// Reads those of `source` off it again, of `readouts` that were read at an earlier step.
    pub fn read_again(&mut self, readouts: &mut Readouts, source: Source) {
        readouts.read_again(source, &self.simulation, &mut self.monitor);
    }

    /// What theory says of the exact motion now; `None` where it says nothing.
    pub fn theory(&mut self) -> Option<Theory> {
        self.monitor.theory(self.now.time_s)
    }

    /// What has been measured on its steps.
    pub fn instruments(&self) -> &Instruments {
        self.monitor.instruments()
    }

    /// Whether the workings of every step to come are kept, as whoever shows them wants it while the run goes on.
    pub fn keep_workings(&mut self, kept: bool) {
        self.keeps_workings = kept;
        self.simulation.keep_workings(kept);
    }

    /// What the scheme computed in the step taken last; `None` at step 0. Where the workings were not kept, that step is
    /// taken a second time, on a copy of the run that comes from the last checkpoint before it.
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
        again.step_to(before).ok()?;
        again.keep_workings(true);
        let workings = again.step().ok()?.workings()?;
        self.explained = Some((before + 1, Arc::clone(workings)));
        Some(Arc::clone(workings))
    }

    /// The last state in which the body was a rigid one, and its step, where the scheme has broken down since.
    pub fn last_whole(&self) -> Option<&(u64, State)> {
        self.last_whole.as_ref()
    }

    /// The run itself.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The scenario it plays.
    pub fn scenario(&self) -> &Arc<Scenario> {
        self.simulation.scenario()
    }

    /// Where it stands.
    pub fn now(&self) -> &Moment {
        &self.now
    }

    /// Its curves over time and its path, as far as it has been.
    pub fn pictures(&self) -> (&Recording, &Path) {
        match &self.ahead {
            Some(ahead) => (&ahead.recording, &ahead.path),
            None => (&self.recording, &self.path),
        }
    }

    /// Its curves over time.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Its path from above.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// What the pictures need of `step`.
fn moment(step: &Step) -> Moment {
    Moment {
        time_s: step.time_s(),
        position: *step.position(),
        axle_height: step.after().axle().z,
    }
}
