//! Draws a figure of a run in the background.

use super::{Exporting, Shared, Written, refused};
use crate::export::destination::{Destination, DestinationError};
use crate::figure::kind::Kind;
use crate::figure::of_runs::{self, EXACT_BESIDE, Request, Run};
use crate::figure::{self, Format};
use crate::measured::Measured;
use crate::scenario::Scenario;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// A figure that is to be drawn.
struct Drawing {
    scenario: Arc<Scenario>,
    output: Destination,
    path: PathBuf,
    format: Format,
    request: Request,
}

/// What a figure shows of a run.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its kind.
    pub kind: Kind,
    /// Whether the exact motion stands beside the run.
    pub exact: bool,
    /// What was measured, to be drawn with the run.
    pub measured: Option<Arc<Measured>>,
    /// The form of the file.
    pub format: Format,
}

impl Exporting {
    /// Starts drawing a figure of the run of `scenario`, a column of a page wide, to the file `path`. It writes the same bytes
    /// as `gyrolab figure -o`. The file appears once it is complete.
    ///
    /// # Errors
    /// As [`begin`](Self::begin).
    pub fn begin_figure(
        scenario: Arc<Scenario>,
        path: &Path,
        drawn: Drawn,
        replace: bool,
    ) -> Result<Self, DestinationError> {
        let refused = |error| refused(path, error);
        let steps = scenario.steps;
        let drawing = Drawing {
            scenario,
            output: Destination::open_file(path, replace)?,
            path: std::path::absolute(path).map_err(refused)?,
            format: drawn.format,
            request: Request {
                kind: drawn.kind,
                from_s: 0.0,
                to_s: None,
                exact: drawn.exact,
                measured: drawn.measured,
                width_pt: figure::COLUMN_PT,
            },
        };
        let path = drawing.path.clone();
        Self::spawn(path, steps, |shared| drawing.write(shared)).map_err(refused)
    }
}

impl Drawing {
    fn write(mut self, shared: &Shared) -> Result<Written, String> {
        let run = Run {
            named: self.scenario.file.title.clone(),
            scenario: self.scenario,
        };
        let figure = of_runs::figure(&[run], &self.request, |step, _| {
            shared.step.store(step.min(shared.steps), Ordering::Relaxed);
            if shared.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        let figure = figure.filter(|_| !shared.is_cancelled());
        let figure = figure.ok_or("the figure was stopped, and nothing was written")?;
        let bytes = figure::write(&figure.scene, self.format).map_err(|error| error.to_string())?;
        let written = self.output.write_all(&bytes);
        written.map_err(|error| refused(&self.path, error).fact())?;
        self.output.keep().map_err(|error| error.fact())?;
        let told = figure.broke.iter().cloned().chain(figure.told());
        let in_the_lab =
            |text: String| text.replace(EXACT_BESIDE, "t, then X draws that beside it");
        Ok(Written {
            path: self.path,
            rows: None,
            bytes: bytes.len() as u64,
            warnings: told.map(in_the_lab).collect(),
            not_finite: None,
        })
    }
}
