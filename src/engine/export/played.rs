//! A run that is played to its end, with all that is read off it there.

use super::CsvWriter;
use super::stream::{self, Ended};
use crate::analysis::health::{Health, advise};
use crate::analysis::{Monitor, Readouts};
use crate::run::{Simulation, Step};
use crate::scenario::Scenario;
use std::cell::RefCell;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// A run at its end.
pub struct PlayedRun {
    pub ended: Ended,
    /// Time spent on stepping alone.
    pub wall: Duration,
    simulation: Simulation,
    monitor: Monitor,
}

impl PlayedRun {
    /// Plays the run of `scenario`, writes its rows to `csv`, and shows its start and every step to `also`. `watch` is called
    /// with the step reached and the last one, and says whether to go on.
    ///
    /// # Errors
    /// When a row cannot be written.
    pub fn play<W: Write>(
        scenario: &Arc<Scenario>,
        csv: Option<&mut CsvWriter<W>>,
        mut also: impl FnMut(&Step),
        mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> io::Result<Self> {
        let mut simulation = Simulation::new(Arc::clone(scenario));
        let monitor = RefCell::new(Monitor::new(simulation.now()));
        also(simulation.now());
        let (ended, wall) = stream::play(
            &mut simulation,
            scenario.steps,
            csv,
            |step| {
                monitor.borrow_mut().record_ahead(step);
                also(step);
            },
            // The exact motion is computed after the block, outside the time of stepping.
            |step, steps| {
                monitor.borrow_mut().catch_up(&mut || watch(step, steps))?;
                watch(step, steps)
            },
        )?;
        Ok(Self {
            ended,
            wall,
            simulation,
            monitor: monitor.into_inner(),
        })
    }

    /// Compares the run with the exact motion.
    pub fn health(&mut self) -> Health {
        self.monitor.health(self.simulation.now())
    }

    /// Returns what is read off the run. For a run that is not to be believed it also searches for a time step or scheme that
    /// is, which takes a while.
    pub fn readouts(&mut self) -> Readouts {
        let health = self.health();
        let is_doubtful = health.is_believed() == Some(false);
        let advice = is_doubtful.then(|| advise(self.simulation.scenario()));
        Readouts::new(
            &self.simulation,
            &mut self.monitor,
            &health,
            advice.as_ref(),
        )
    }
}
