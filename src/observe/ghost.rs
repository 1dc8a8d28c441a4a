//! The pictures of the previous run, kept when an edit restarts the run, so that both can be compared.

use super::live::LiveRun;
use super::marks::Marks;
use super::path::Path;
use super::recording::Recording;

/// The pictures of the previous run.
#[derive(Clone, Debug)]
pub struct Ghost {
    recording: Recording,
    path: Path,
    marks: Marks,
}

impl Ghost {
    /// The pictures of `run`, up to the furthest step that it has reached.
    pub fn of(run: &LiveRun) -> Self {
        let (recording, path) = run.pictures();
        Self {
            recording: recording.clone(),
            path: path.clone(),
            marks: Marks::of(run.scenario()),
        }
    }

    /// The time that the run had reached, s.
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

    /// Its pushes and edits.
    pub fn marks(&self) -> &Marks {
        &self.marks
    }
}
