//! The pictures of the previous run, kept when an edit restarts the run, so that both can be compared, and the making of
//! such pictures anew, in the background.

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
    /// Returns the pictures of `run`, up to the furthest step that it has reached.
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

/// The pictures of a run that is played again in the background. Dropping it ends that.
pub struct PendingGhost {
    pub scenario: Arc<Scenario>,
    pub furthest: u64,
    job: BackgroundJob<Ghost>,
}

impl PendingGhost {
    /// Begins to play `scenario` up to the step `furthest`, or up to where its numbers stop being finite.
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
