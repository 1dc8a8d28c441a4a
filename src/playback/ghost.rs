//! The pictures of the previous run, kept when an edit restarts the run, so that both can be compared.

use super::live::LiveRun;
use super::marks::Marks;
use super::path::Path;
use super::recording::Recording;
use crate::scenario::Scenario;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct Ghost {
    pub recording: Recording,
    pub path: Path,
    pub marks: Marks,
    pub scenario: Arc<Scenario>,
    pub furthest: u64,
}

impl Ghost {
    /// The pictures of `run`, up to the furthest step that it has reached.
    pub fn of(run: &LiveRun) -> Self {
        let (recording, path) = run.pictures();
        Self {
            recording: recording.clone(),
            path: path.clone(),
            marks: Marks::of(run.scenario()),
            scenario: Arc::clone(run.scenario()),
            furthest: run.furthest(),
        }
    }

    pub fn end_s(&self) -> f64 {
        self.recording.whole().map_or(0.0, |whole| whole.end_s)
    }
}
