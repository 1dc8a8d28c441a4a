//! A run as a write-up: a folder with the run file, the CSV, figures, its numbers beside the exact motion and theory, and a
//! document that says what was run, whether to believe it, and how to make it again.
//!
//! The same run gives the same bytes each time: what the machine's clock says is left out.

pub mod exact;
pub mod figures;
pub mod fit;
pub mod measured;
mod page;
mod quantities;
mod verdict;

use crate::engine::analysis::Readouts;
use crate::engine::analysis::readouts::{READOUTS, Readout, ReadoutSource};
use crate::engine::run::{Clock, NotFinite};
use crate::engine::scenario::Scenario;
use crate::plot::Unwritable;
use crate::report::document::{BIBLIOGRAPHY_FILE, Document};
pub use exact::ExactNumbers;
pub use figures::WriteupFigure;
pub use measured::MeasuredComparison;
use quantities::RunNumbers;
use serde_json::{Map, Value};
use std::path::Path;
use std::sync::Arc;

pub const CSV: &str = "run.csv";
/// The scenario with its edits, from which the rows are computed.
pub const RUN_FILE: &str = "run.toml";
pub const WRITEUP_PAGE: &str = "README.md";
pub const TEX_FILE: &str = "report.tex";
pub const READOUTS_FILE: &str = "readouts.json";
/// The CSV that the page's commands write beside the others.
const AGAIN: &str = "again.csv";

/// The name, among the readouts, of what was measured.
pub const MEASURED_DATA: &str = "measured_data";

/// The name, among them, of the time from which theory speaks of the motion, s.
const PREDICTED_SINCE: &str = "predicted_since_s";

/// The name of the numbers of the exact motion among the readouts.
const EXACT_MOTION: &str = "exact_motion";

/// The languages in which the document is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DocumentFormats {
    pub markdown: bool,
    pub tex: bool,
}

#[derive(Clone, Debug)]
pub struct Writeup {
    pub scenario: Arc<Scenario>,
    pub readouts: Readouts,
    pub exact: ExactNumbers,
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
    pub fn files(&self, formats: DocumentFormats) -> Result<Vec<(String, Vec<u8>)>, Unwritable> {
        let mut files = vec![
            (RUN_FILE.to_owned(), self.scenario.to_toml().into_bytes()),
            (READOUTS_FILE.to_owned(), self.readouts_json().into_bytes()),
        ];
        files.extend(formats.files(&self.document()));
        let measured = self.beside.iter();
        files.extend(measured.map(|beside| {
            let text = beside.measured.text.to_string();
            (beside.name().to_owned(), text.into_bytes())
        }));
        for drawing in &self.drawings {
            files.extend(drawing.files()?);
        }
        Ok(files)
    }

    /// Whether to believe the run, and what would mend it.
    pub fn verdict(&self) -> String {
        let readouts = &self.readouts;
        readouts.health.sentence(readouts.advice.as_ref())
    }

    pub fn document(&self) -> Document {
        page::document(self)
    }

    fn numbers(&self) -> RunNumbers<'_> {
        RunNumbers {
            run: &self.readouts,
            exact: &self.exact,
            since_s: self.forces_changed_s(),
        }
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

    /// The readouts without the times by the clock, one object.
    fn readouts_json(&self) -> String {
        let lasting = READOUTS
            .iter()
            .filter(|readout| readout.source != ReadoutSource::Clock);
        let mut object = named_values(lasting, &self.readouts);
        let since_s = self.forces_changed_s().unwrap_or(0.0);
        object.insert(PREDICTED_SINCE.to_owned(), since_s.into());
        object.insert(EXACT_MOTION.to_owned(), self.exact_json());
        if let Some(beside) = &self.beside {
            object.insert(MEASURED_DATA.to_owned(), beside.json());
        }
        format!("{:#}\n", Value::Object(object))
    }

    /// The numbers of the exact motion that the document compares with those of the run; null if there is none.
    fn exact_json(&self) -> Value {
        let Some(exact) = self.exact.readouts() else {
            return Value::Null;
        };
        let compared = quantities::compared();
        let with_uncertainty = compared.flat_map(|it| [Some(it), it.uncertainty()]);
        let mut object = named_values(with_uncertainty.flatten(), exact);
        object.insert("time_step_s".to_owned(), exact.time_step_s.into());
        Value::Object(object)
    }
}

/// Returns the values of these readouts under their names.
fn named_values(
    of: impl Iterator<Item = &'static Readout>,
    readouts: &Readouts,
) -> Map<String, Value> {
    let named = of.map(|readout| {
        let value = serde_json::to_value(readout.read_from(readouts));
        (readout.name.to_owned(), value.unwrap_or(Value::Null))
    });
    named.collect()
}

impl DocumentFormats {
    /// Returns the formats of the write-up in `folder`; both if it has none.
    pub fn in_folder(folder: &Path) -> Self {
        let [markdown, tex] = [WRITEUP_PAGE, TEX_FILE].map(|name| folder.join(name).is_file());
        Self {
            markdown: markdown || !tex,
            tex: tex || !markdown,
        }
    }

    /// Returns the files of `document`, each with its name and its bytes.
    pub fn files(self, document: &Document) -> Vec<(String, Vec<u8>)> {
        let mut files = Vec::new();
        if self.markdown {
            files.push((WRITEUP_PAGE, document.markdown()));
        }
        if self.tex {
            files.push((TEX_FILE, document.tex()));
            files.push((BIBLIOGRAPHY_FILE, document.bibliography()));
        }
        let bytes = |(name, text): (&str, String)| (name.to_owned(), text.into_bytes());
        files.into_iter().map(bytes).collect()
    }
}
