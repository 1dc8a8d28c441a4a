//! The run before a restart by an edit, as far as the pictures go: what did the edit change?

use super::live::LiveRun;
use super::marks::Marks;
use super::path::Path;
use super::recording::Recording;

/// What is kept of a run that is over.
#[derive(Clone, Debug)]
pub struct Ghost {
    recording: Recording,
    path: Path,
    marks: Marks,
}

impl Ghost {
    /// What `run` has left behind, as far as it has been.
    pub fn of(run: &LiveRun) -> Self {
        let (recording, path) = run.pictures();
        Self {
            recording: recording.clone(),
            path: path.clone(),
            marks: Marks::of(run.scenario()),
        }
    }

    /// How far it has come, s.
    pub fn end_s(&self) -> f64 {
        self.recording.whole().map_or(0.0, |whole| whole.end_s)
    }

    /// Its curves over time.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Its path from above.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What was done to it.
    pub fn marks(&self) -> &Marks {
        &self.marks
    }
}
