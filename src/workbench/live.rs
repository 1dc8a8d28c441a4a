//! A run as it is watched: the simulation, and what is kept of it for the pictures.

use super::overlay::Overlay;
use super::path::Path;
use super::recording::{Moment, Recording};
use crate::analysis::{Health, Instruments, Monitor, Theory};
use crate::run::{NotFinite, Simulation};
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::sync::Arc;

/// Between two looks at the clock a body of one point takes this many steps; one of n points an n-th of it.
const STEPS_PER_LOOK: usize = 4096;

/// Parts of a time step smaller than this are rounding, not time.
const ROUNDING: f64 = 1e-6;

/// A run under observation.
pub struct LiveRun {
    simulation: Simulation,
    monitor: Monitor,
    traced: Vector3<f64>,
    now: Moment,
    recording: Recording,
    path: Path,
    overlay: Option<Overlay>,
}

/// How playing on came to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Played {
    /// Simulated time that passed, s.
    pub stepped_s: f64,
    /// Why it ended.
    pub end: PlayEnd,
}

/// Why playing on ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayEnd {
    /// All the time that was allowed is stepped.
    InTime,
    /// There was no more time to compute.
    CutShort,
    /// It stands at the step at which it was to stop.
    AtStop,
    /// The numbers are no longer finite.
    NotFinite(NotFinite),
}

impl LiveRun {
    /// The run of `scenario`, at step 0.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let now = Moment::new(&scenario.start, &traced);
        let simulation = Simulation::new(scenario);
        let mut run = Self {
            monitor: Monitor::new(&simulation),
            simulation,
            traced,
            now,
            recording: Recording::default(),
            path: Path::new(traced.norm()),
            overlay: None,
        };
        run.keep();
        run
    }

    /// Takes it one time step further.
    ///
    /// # Errors
    /// When the numbers stop being finite; it then stays where it is.
    pub fn step(&mut self) -> Result<(), NotFinite> {
        self.simulation.step()?;
        self.monitor.follow(&self.simulation);
        self.now = Moment::new(self.simulation.state(), &self.traced);
        self.keep();
        Ok(())
    }

    fn keep(&mut self) {
        self.recording.push(&self.now);
        self.path
            .follow(self.simulation.step_number(), &self.now.position);
    }

    /// Plays on for `time_s` simulated seconds (whole steps of them), no further than the step `stop`, until `enough`
    /// says that there is no more time for it.
    pub fn play(&mut self, time_s: f64, stop: u64, mut enough: impl FnMut() -> bool) -> Played {
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

    /// Lets the exact motion come after the run until `enough` says that there is no more time for it.
    pub fn follow_exact(&mut self, enough: impl FnMut() -> bool) {
        if let Some(overlay) = &mut self.overlay {
            overlay.follow(self.now.time_s, enough);
        }
    }

    /// The exact motion, where it is shown.
    pub fn overlay(&self) -> Option<&Overlay> {
        self.overlay.as_ref()
    }

    /// Whether the exact motion is shown and has not come as far as the run.
    pub fn overlay_is_behind(&self) -> bool {
        self.overlay
            .as_ref()
            .is_some_and(|overlay| overlay.now().time_s < self.now.time_s)
    }

    /// How far its numbers can be trusted where it stands.
    pub fn health(&mut self) -> Health {
        self.monitor.health(&self.simulation)
    }

    /// What theory says of the exact motion now; `None` where it says nothing.
    pub fn theory(&mut self) -> Option<Theory> {
        self.monitor.theory(self.now.time_s)
    }

    /// What has been measured on its steps.
    pub fn instruments(&self) -> &Instruments {
        self.monitor.instruments()
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

    /// Its curves over time.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Its path from above.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
