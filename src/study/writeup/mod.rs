//! A run as a write-up: a folder with the run file, the CSV, figures, the measured numbers beside theory, and a page that
//! says what was run, whether to believe it, and how to make it again.
//!
//! The same run gives the same bytes each time: what the machine's clock says is left out.

mod exact_range;
pub mod figures;
mod languages;
mod latex;
mod markdown;
pub mod measured;
mod page;
mod quantities;
mod setup;

use self::exact_range::ExactRange;
use crate::analysis::Readouts;
use crate::analysis::readouts::{READOUTS, Source};
use crate::export::columns::COLUMNS;
use crate::export::summary::steps_in_words;
use crate::figure::{self, Format, Unwritable};
use crate::run::NotFinite;
use crate::scenario::Scenario;
pub use figures::Drawing;
pub use languages::Lines;
pub use measured::Beside;
pub use quantities::Quantity;
use serde_json::{Map, Value};
use std::sync::Arc;

/// The run's rows.
pub const CSV: &str = "run.csv";
/// The scenario with its edits, from which the rows are computed.
pub const RUN_FILE: &str = "run.toml";
/// The first page.
pub const PAGE: &str = "README.md";
/// The measured numbers beside theory, for LaTeX.
pub const LATEX: &str = "readouts.tex";
/// Every readout.
pub const READOUTS_FILE: &str = "readouts.json";
/// The CSV that the page's commands write beside the others.
const AGAIN: &str = "again.csv";

/// The name, among the readouts, of what was measured.
const MEASURED_DATA: &str = "measured_data";

/// What a write-up is made of.
#[derive(Clone, Debug)]
pub struct Writeup {
    /// The run.
    pub scenario: Arc<Scenario>,
    /// What was read off it.
    pub readouts: Readouts,
    /// Why it ended before its last step, where it did.
    pub broken: Option<NotFinite>,
    /// The measured numbers beside theory.
    pub quantities: Vec<Quantity>,
    /// Measured data beside the run, where there are some.
    pub beside: Option<Beside>,
    /// The figures, in the order in which the page shows them.
    pub drawings: Vec<Drawing>,
}

impl Writeup {
    /// The write-up of the run of `scenario`, whose `readouts` were read at its end; `broken` is why that was not its
    /// last step, and `beside` has what was measured.
    pub fn new(
        scenario: Arc<Scenario>,
        readouts: Readouts,
        broken: Option<NotFinite>,
        beside: Option<Beside>,
        drawings: Vec<Drawing>,
    ) -> Self {
        Self {
            broken,
            beside,
            quantities: quantities::quantities(
                &scenario,
                &readouts,
                ExactRange::new(&scenario, readouts.sample.time_s),
            ),
            scenario,
            readouts,
            drawings,
        }
    }

    /// All files but the CSV, each with its name and its bytes.
    ///
    /// # Errors
    /// When a figure is too large for its form.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>, Unwritable> {
        let page = page::page(self).unwrap_or_default(); // a String takes what is written to it
        let caption = format!(
            "{}. Scheme {}, time steps: {}.",
            self.readouts.title,
            self.readouts.scheme,
            steps_in_words(&self.scenario, self.readouts.sample.step)
        );
        let verdict = self.readouts.health.sentence(self.readouts.advice.as_ref());
        let texts = [
            (RUN_FILE, self.scenario.to_toml()),
            (READOUTS_FILE, self.readouts_json()),
            (LATEX, latex::table(&self.quantities, &caption, &verdict)),
            (PAGE, page),
        ];
        let mut files: Vec<_> = texts
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text.into_bytes()))
            .collect();
        if let Some(beside) = &self.beside {
            let text = beside.text.clone().into_bytes();
            files.push((beside.name().to_owned(), text));
        }
        for drawing in &self.drawings {
            for (ending, format) in [("svg", Format::Svg), ("pdf", Format::Pdf)] {
                let bytes = figure::write(&drawing.scene, format)?;
                files.push((format!("{}.{ending}", drawing.name), bytes));
            }
        }
        Ok(files)
    }

    /// Lines that read the CSV.
    pub fn languages(&self) -> [Lines; 4] {
        let header = self.scenario.to_toml().lines().count();
        let column = |name| {
            1 + COLUMNS
                .iter()
                .take_while(|column| column.name != name)
                .count()
        };
        languages::lines(CSV, header, column("t_s"), column("z_m"))
    }

    /// The readouts but for those of the clock, one object.
    fn readouts_json(&self) -> String {
        let lasting = READOUTS
            .iter()
            .filter(|readout| readout.source != Source::Clock);
        let mut object: Map<_, _> = lasting
            .map(|readout| {
                let value = serde_json::to_value(readout.of(&self.readouts));
                (readout.name.to_owned(), value.unwrap_or(Value::Null))
            })
            .collect();
        if let Some(beside) = &self.beside {
            object.insert(MEASURED_DATA.to_owned(), beside.json());
        }
        format!("{:#}\n", Value::Object(object))
    }

    /// The name of the point with that index.
    fn name_of(&self, point: usize) -> String {
        let body = &self.scenario.body;
        let name = body
            .names()
            .into_iter()
            .find(|name| body.point(name) == Some(point));
        name.map_or_else(|| format!("number {point}"), str::to_owned)
    }
}
