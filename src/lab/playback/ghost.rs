//! The pictures of the previous run, kept for comparison when an edit restarts the run; and recomputing such pictures
//! in the background.

use super::background::BackgroundJob;
use super::live::LiveRun;
use super::path::PathFromAbove;
use crate::engine::recording::Recording;
use crate::engine::run::marks::Marks;
use crate::engine::scenario::Scenario;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct Ghost {
    pub recording: Recording,
    pub path: PathFromAbove,
    pub marks: Marks,
    pub scenario: Arc<Scenario>,
    pub furthest: u64,
}

impl Ghost {
    /// Copies the pictures of `run`, up to the furthest step that it has reached.
    pub fn capture(run: &LiveRun) -> Self {
        let (recording, path) = run.pictures();
        Self {
            recording: recording.clone(),
            path: path.clone(),
            marks: Marks::new(run.scenario()),
            scenario: Arc::clone(run.scenario()),
            furthest: run.furthest(),
        }
    }

    pub fn end_s(&self) -> f64 {
        self.recording.whole().map_or(0.0, |whole| whole.end_s)
    }
}

/// The pictures of a run that is being replayed in the background. Dropping this value stops the replay.
pub struct PendingGhost {
    pub scenario: Arc<Scenario>,
    pub furthest: u64,
    job: BackgroundJob<Ghost>,
}

impl PendingGhost {
    /// Starts playing `scenario` up to the step `furthest`, or until its numbers stop being finite.
    pub fn begin(scenario: Arc<Scenario>, furthest: u64) -> Self {
        let played = Arc::clone(&scenario);
        let job = BackgroundJob::begin("pinned", move |is_wanted| {
            let mut run = LiveRun::new(played);
            run.play(f64::INFINITY, furthest, || !is_wanted(), |_| false);
            Some(Ghost::capture(&run))
        });
        Self {
            scenario,
            furthest,
            job,
        }
    }

    pub fn made(&self) -> Option<Ghost> {
        self.job.answer().cloned()
    }
}
