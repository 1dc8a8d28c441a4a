//! A run as CSV: the run file in `# ` lines, one header line, then the rows. Each row is written when it is added, so that
//! memory does not grow with the run.

use super::CsvLayout;
use super::columns::{CsvCell, CsvRow, DISTANCE, NamedPoint};
use super::layout::{WARNING_MARK, commented};
use crate::analysis::DistanceMeter;
use crate::analysis::verdict::warning_at_start;
use crate::run::Sample;
use crate::scenario::Scenario;
use std::io::{self, BufWriter, Write};
use std::sync::Arc;

/// It makes spreadsheet programs read the file as UTF-8.
const BYTE_ORDER_MARK_TEXT: &str = "\u{feff}";

#[derive(Debug)]
pub struct CsvWriter<W: Write> {
    out: BufWriter<W>,
    line: Vec<u8>,
    count: u64,
    layout: CsvLayout,
    scenario: Scenario,
    points: Vec<NamedPoint>,
    /// Computes the distance from the exact motion, if there is a column for it.
    meter: Option<DistanceMeter>,
}

impl<W: Write> CsvWriter<W> {
    /// Begins a CSV of every row and column on `out` with the run file of `scenario` and the header line.
    pub fn new(out: W, scenario: &Scenario) -> io::Result<Self> {
        Self::with_layout(out, scenario, CsvLayout::default())
    }

    /// Begins a CSV as `layout` says on `out`.
    pub fn with_layout(out: W, scenario: &Scenario, layout: CsvLayout) -> io::Result<Self> {
        let mut out = BufWriter::new(out);
        let mark = if layout.file().excel {
            BYTE_ORDER_MARK_TEXT
        } else {
            ""
        };
        let separator = layout.delimiter();
        let warning = warning_at_start(scenario).map_or(String::new(), |warning| {
            commented(&commented(&format!("{WARNING_MARK} {warning}")))
        });
        let (above, run_file) = (layout.comments(), commented(&scenario.to_toml()));
        let names = layout.names().join(&char::from(separator).to_string());
        writeln!(out, "{mark}{above}{warning}{run_file}{names}")?;
        let points = if layout.file().points {
            NamedPoint::all_of(scenario, |name| field(name, separator))
        } else {
            Vec::new()
        };
        let has_distance = layout.names().contains(&DISTANCE);
        Ok(Self {
            out,
            line: Vec::new(),
            count: 0,
            meter: has_distance.then(|| DistanceMeter::new(&Arc::new(scenario.clone()))),
            layout,
            scenario: scenario.clone(),
            points,
        })
    }

    pub fn layout(&self) -> &CsvLayout {
        &self.layout
    }

    /// Adds the row of `sample`, or its rows where every point has one. The caller
    /// has asked the layout whether there is one.
    pub fn write(&mut self, sample: &Sample) -> io::Result<()> {
        let is_of_points = self.layout.file().points;
        let meter = self.meter.as_mut();
        let compared = Sample {
            distance_m: meter.and_then(|meter| meter.distance_m(&sample.state())),
            ..*sample
        };
        let step = CsvRow::new(&self.scenario, &compared);
        let points = self.points.iter().map(|point| CsvRow {
            point: point.placed(sample),
            ..step
        });
        for row in points.chain((!is_of_points).then_some(step)) {
            self.line.clear();
            add(&mut self.line, &self.layout, &row);
            self.count += 1;
            self.out.write_all(&self.line)?;
        }
        Ok(())
    }

    pub fn count(&self) -> u64 {
        self.count
    }

    /// Writes what is still buffered, and returns the output.
    pub fn finish(self) -> io::Result<W> {
        let whole = self.out.into_inner();
        whole.map_err(io::IntoInnerError::into_error)
    }
}

/// Adds one row to `line`. Numbers have the digits that the csv crate gives them with serde; where a text needs quotes, it has
/// them already.
fn add(line: &mut Vec<u8>, layout: &CsvLayout, row: &CsvRow<'_>) {
    let (mut digits, mut whole) = (ryu::Buffer::new(), itoa::Buffer::new());
    for column in layout.columns() {
        let begin = line.len();
        match (column.cell)(row) {
            CsvCell::Text(text) => line.extend_from_slice(text.as_bytes()),
            CsvCell::Nothing => {}
            CsvCell::Whole(count) => line.extend_from_slice(whole.format(count).as_bytes()),
            CsvCell::Number(number) => {
                line.extend_from_slice(digits.format(number).as_bytes());
                if layout.file().excel
                    && let Some(point) = line[begin..].iter_mut().find(|c| **c == b'.')
                {
                    *point = b',';
                }
            }
        }
        line.push(layout.delimiter());
    }
    if let Some(last) = line.last_mut() {
        *last = b'\n';
    }
}

/// `text` as it stands in a CSV, quoted where it has to be.
fn field(text: &str, delimiter: u8) -> String {
    let mut writer = csv::WriterBuilder::new()
        .delimiter(delimiter)
        .from_writer(Vec::new());
    // Writing to memory does not fail.
    let written = writer.write_record([text]).is_ok();
    debug_assert!(written);
    let mut field = String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default();
    field.truncate(field.trim_end_matches('\n').len());
    field
}
