//! Draws a figure of a run in the background.

use super::{Exporting, Shared, Written};
use crate::data::Measured;
use crate::export::destination::{Destination, DestinationError};
use crate::figure::kind::Kind;
use crate::figure::labels::Labels;
use crate::figure::of_runs::{self, EXACT_BESIDE, Request, Run};
use crate::figure::{self, Format};
use crate::scenario::Scenario;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a figure shows of a run.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub kind: Kind,
    /// Whether the exact motion stands beside the run.
    pub exact: bool,
    /// What was measured, to be drawn with the run.
    pub measured: Option<Arc<Measured>>,
    pub format: Format,
}

impl Exporting {
    /// Starts drawing a figure of the run of `scenario`, a column of a page wide, to the file `path`. It writes the same bytes
    /// as `gyrolab figure -o`. The file appears once it is complete.
    pub fn begin_figure(
        scenario: Arc<Scenario>,
        path: &Path,
        drawn: Drawn,
        replace: bool,
    ) -> Result<Self, DestinationError> {
        let refused = |error| DestinationError::refused(path, error);
        let output = Destination::open_file(path, replace)?;
        let path = std::path::absolute(path).map_err(refused)?;
        let (steps, drawn_to) = (scenario.steps, path.clone());
        let draw = move |shared: &Shared| draw(scenario, output, drawn_to, drawn, shared);
        Self::spawn(path, steps, draw).map_err(refused)
    }
}

/// Draws the run of `scenario` on `output`, which becomes the file `path`.
fn draw(
    scenario: Arc<Scenario>,
    output: Destination,
    path: PathBuf,
    drawn: Drawn,
    shared: &Shared,
) -> Result<Written, String> {
    let request = Request {
        kind: drawn.kind,
        from_s: 0.0,
        to_s: None,
        exact: drawn.exact,
        measured: drawn.measured,
        width_pt: figure::COLUMN_PT,
        labels: Labels::default(),
    };
    let run = Run {
        named: scenario.file.title.clone(),
        scenario,
    };
    let figure = of_runs::figure(&[run], &request, |step, _| shared.reach(step))?;
    let figure = figure.filter(|_| shared.reach(shared.steps).is_continue());
    let figure = figure.ok_or("the figure was stopped, and nothing was written")?;
    let bytes = figure::write(&figure.scene, drawn.format).map_err(|error| error.to_string())?;
    output
        .write_and_keep(&bytes)
        .map_err(|error| error.fact())?;
    let told = figure.broke.iter().cloned().chain(figure.told());
    let in_the_lab = |text: String| text.replace(EXACT_BESIDE, "t, then X draws that beside it");
    Ok(Written {
        path,
        rows: None,
        bytes: bytes.len() as u64,
        warnings: told.map(in_the_lab).collect(),
        not_finite: None,
    })
}
