//! Exports a run to a CSV file, or draws a figure of it, in the background.

mod drawing;
mod estimate;
mod scp;

pub use drawing::Drawn;
pub use estimate::{Estimate, estimate};
pub use scp::scp_line;

use super::at_exit::{self, Registered, Release};
use crate::export::destination::{Destination, DestinationError};
use crate::export::stream::{self, Ended};
use crate::export::{CsvWriter, Layout};
use crate::run::{NotFinite, Simulation};
use crate::scenario::Scenario;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// An export in progress, or a finished one. Dropping it cancels an export in progress and removes its temporary file.
pub struct Exporting {
    path: PathBuf,
    shared: Arc<Shared>,
    worker: Option<JoinHandle<Result<Written, String>>>,
    _at_end: Registered,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    pub path: PathBuf,
    /// Number of rows; `None` for a figure.
    pub rows: Option<u64>,
    pub bytes: u64,
    pub warnings: Vec<String>,
    /// Where the run's numbers stopped being finite, if they did. The file has the rows before that.
    pub not_finite: Option<NotFinite>,
}

#[derive(Default)]
struct Shared {
    step: AtomicU64,
    steps: u64,
    is_cancelled: AtomicBool,
    has_ended: AtomicBool,
    /// Whether the end of the process has cancelled it.
    is_cut_off: AtomicBool,
}

impl Exporting {
    /// Starts writing the run of `scenario`, from step 0 to its last step, to the file `path`. It writes the same bytes as
    /// `gyrolab run -o`, with the rows and columns of `layout`. The file appears once it is complete.
    ///
    /// # Errors
    /// [`Exists`](DestinationError::Exists) when there is such a file and `replace` is false; any other error that opening
    /// the file or starting the thread gives.
    pub fn begin(
        scenario: Arc<Scenario>,
        path: &Path,
        layout: Layout,
        replace: bool,
    ) -> Result<Self, DestinationError> {
        let refused = |error| DestinationError::refused(path, error);
        let destination = Destination::open_file(path, replace)?;
        let csv = CsvWriter::with_layout(destination, &scenario, layout).map_err(refused)?;
        let path = std::path::absolute(path).map_err(refused)?;
        let steps = scenario.steps;
        let written = path.clone();
        let write = move |shared: &Shared| write(scenario, csv, written, shared);
        Self::spawn(path, steps, write).map_err(refused)
    }

    fn spawn(
        path: PathBuf,
        steps: u64,
        write: impl FnOnce(&Shared) -> Result<Written, String> + Send + 'static,
    ) -> io::Result<Self> {
        let shared = Arc::new(Shared {
            steps,
            ..Shared::default()
        });
        let (at_work, at_end) = (Arc::clone(&shared), Arc::clone(&shared));
        let work = move || {
            let result = write(&at_work);
            at_work.has_ended.store(true, Ordering::SeqCst);
            result
        };
        let worker = thread::Builder::new()
            .name("export".to_owned())
            .spawn(work)?;
        Ok(Self {
            path,
            shared,
            worker: Some(worker),
            _at_end: at_exit::hook(move |release| at_end.prepare_for(release)),
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The step that the export has reached, and the run's last step.
    pub fn progress(&self) -> (u64, u64) {
        (self.shared.step.load(Ordering::Relaxed), self.shared.steps)
    }

    /// Asks the export to stop and to remove its temporary file; [`outcome`](Self::outcome) tells when it has.
    pub fn cancel(&self) {
        self.shared.cancel();
    }

    /// Returns what was written, or why nothing was. `None` while the export is in progress, after the result has been
    /// returned once, and where the end of the process cuts the export off: the session then keeps that it was under way.
    pub fn outcome(&mut self) -> Option<Result<Written, String>> {
        if self.shared.is_cut_off.load(Ordering::SeqCst) {
            return None;
        }
        let worker = self.worker.take_if(|worker| worker.is_finished())?;
        let broken = || Err("the export broke off, and nothing was written".to_owned());
        Some(worker.join().unwrap_or_else(|_| broken()))
    }
}

impl Drop for Exporting {
    fn drop(&mut self) {
        self.cancel();
        if let Some(worker) = self.worker.take() {
            let _ = worker.join();
        }
    }
}

impl Shared {
    fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::SeqCst);
    }

    /// Notes that `step` has been reached; breaks where the export has been cancelled.
    fn reach(&self, step: u64) -> ControlFlow<()> {
        self.step.store(step.min(self.steps), Ordering::Relaxed);
        if self.is_cancelled.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Before the process ends, cancels the export and waits until its temporary file is removed. A suspended process
    /// continues its export when it is resumed.
    fn prepare_for(&self, release: Release) {
        if release == Release::Suspend {
            return;
        }
        if !self.has_ended.load(Ordering::SeqCst) {
            self.is_cut_off.store(true, Ordering::SeqCst);
        }
        self.cancel();
        let begin = Instant::now();
        while !self.has_ended.load(Ordering::SeqCst) && begin.elapsed() < release.patience() {
            thread::sleep(Duration::from_millis(2));
        }
    }
}

/// Plays the run of `scenario` and writes its rows to `csv`, which becomes the file `path`.
fn write(
    scenario: Arc<Scenario>,
    mut csv: CsvWriter<Destination>,
    path: PathBuf,
    shared: &Shared,
) -> Result<Written, String> {
    let mut simulation = Simulation::new(scenario);
    let watch = |step, _| shared.reach(step);
    let cannot_write = |error| DestinationError::refused(&path, error).fact();
    let played = stream::play(&mut simulation, shared.steps, Some(&mut csv), |_| {}, watch);
    let (ended, _) = played.map_err(cannot_write)?;
    let rows = csv.count();
    let destination = csv.finish().map_err(cannot_write)?;
    if ended == Ended::Stopped || shared.reach(simulation.step_number()).is_break() {
        return Err("the export was stopped, and nothing was written".to_owned());
    }
    let bytes = destination.bytes().map_err(cannot_write)?;
    destination.keep().map_err(|error| error.fact())?;
    Ok(Written {
        path,
        rows: Some(rows),
        warnings: Vec::new(),
        bytes,
        not_finite: ended.not_finite(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An export that does nothing until it is cancelled.
    fn waiting() -> Exporting {
        let write = |shared: &Shared| {
            while shared.reach(0).is_continue() {
                thread::yield_now();
            }
            Err("stopped".to_owned())
        };
        Exporting::spawn(PathBuf::from("run.csv"), 10, write).unwrap()
    }

    fn wait(exporting: &Exporting) {
        let worker = exporting.worker.as_ref().unwrap();
        while !worker.is_finished() {
            thread::yield_now();
        }
    }

    #[test]
    fn an_export_that_the_user_stops_has_an_outcome_and_one_that_the_end_cuts_off_has_none() {
        let mut stopped = waiting();
        stopped.cancel();
        wait(&stopped);
        assert_eq!(stopped.outcome(), Some(Err("stopped".to_owned())));
        let mut suspended = waiting();
        suspended.shared.prepare_for(Release::Suspend);
        assert!(suspended.shared.reach(0).is_continue());
        let mut cut_off = waiting();
        cut_off.shared.prepare_for(Release::Exit);
        wait(&cut_off);
        assert_eq!((suspended.outcome(), cut_off.outcome()), (None, None));
    }
}
