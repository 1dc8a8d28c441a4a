//! A run as a write-up: a folder with the run file, the CSV, figures, its numbers beside theory, and a page that
//! says what was run, whether to believe it, and how to make it again.
//!
//! The same run gives the same bytes each time: what the machine's clock says is left out.

pub mod figures;
pub mod measured;
mod page;
mod quantities;

use crate::engine::analysis::Readouts;
use crate::engine::analysis::readouts::{READOUTS, ReadoutSource};
use crate::engine::run::{Clock, NotFinite};
use crate::engine::scenario::Scenario;
use crate::plot::{PageFormat, Unwritable};
pub use figures::WriteupFigure;
pub use measured::MeasuredComparison;
use serde_json::{Map, Value};
use std::sync::Arc;

pub const CSV: &str = "run.csv";
/// The scenario with its edits, from which the rows are computed.
pub const RUN_FILE: &str = "run.toml";
pub const WRITEUP_PAGE: &str = "README.md";
pub const READOUTS_FILE: &str = "readouts.json";
/// The CSV that the page's commands write beside the others.
const AGAIN: &str = "again.csv";

/// The name, among the readouts, of what was measured.
pub const MEASURED_DATA: &str = "measured_data";

/// The name, among them, of the time from which theory speaks of the motion, s.
const PREDICTED_SINCE: &str = "predicted_since_s";

#[derive(Clone, Debug)]
pub struct Writeup {
    pub scenario: Arc<Scenario>,
    pub readouts: Readouts,
    /// Why it ended before its last step, where it did.
    pub broken: Option<NotFinite>,
    /// Measured data beside the run, where there are some.
    pub beside: Option<MeasuredComparison>,
    pub drawings: Vec<WriteupFigure>,
}

impl Writeup {
    /// All files but the CSV, each with its name and its bytes.
    ///
    /// # Errors
    /// When a figure is too large for its form.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Unwritable> {
        let texts = [
            (RUN_FILE, self.scenario.to_toml()),
            (READOUTS_FILE, self.readouts_json()),
            (WRITEUP_PAGE, self.page()),
        ];
        let measured = self
            .beside
            .iter()
            .map(|beside| (beside.name(), beside.measured.text.to_string()));
        let mut files: Vec<_> = texts
            .into_iter()
            .chain(measured)
            .map(|(name, text)| (name.to_owned(), text.into_bytes()))
            .collect();
        for drawing in &self.drawings {
            for (ending, format) in [("svg", PageFormat::Svg), ("pdf", PageFormat::Pdf)] {
                let bytes = drawing.source.write(&drawing.scene, format)?;
                files.push((format!("{}.{ending}", drawing.name), bytes));
            }
        }
        Ok(files)
    }

    /// Whether to believe the run, and what would mend it.
    pub fn verdict(&self) -> String {
        let readouts = &self.readouts;
        readouts.health.sentence(readouts.advice.as_ref())
    }

    /// When the forces last changed, s, where that is not the start.
    fn forces_changed_s(&self) -> Option<f64> {
        // The first step under other forces: they changed where it began.
        let step = self
            .readouts
            .since
            .checked_sub(1)
            .filter(|step| *step > 0)?;
        Some(Clock::at(&self.scenario, step).time_s(step))
    }

    pub fn page(&self) -> String {
        page::page(self).unwrap_or_default() // a String takes what is written to it
    }

    /// The readouts without the times by the clock, one object.
    pub fn readouts_json(&self) -> String {
        let lasting = READOUTS
            .iter()
            .filter(|readout| readout.source != ReadoutSource::Clock);
        let named = lasting.map(|readout| {
            let value = serde_json::to_value(readout.read_from(&self.readouts));
            (readout.name.to_owned(), value.unwrap_or(Value::Null))
        });
        let mut object: Map<_, _> = named.collect();
        let since_s = self.forces_changed_s().unwrap_or(0.0);
        object.insert(PREDICTED_SINCE.to_owned(), since_s.into());
        if let Some(beside) = &self.beside {
            object.insert(MEASURED_DATA.to_owned(), beside.json());
        }
        format!("{:#}\n", Value::Object(object))
    }
}
