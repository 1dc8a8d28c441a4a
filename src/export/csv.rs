//! A run as CSV: the run file in `# ` lines, one header line, then the rows. Each row is written when it is added, so that
//! memory does not grow with the run.

use super::Layout;
use super::columns::{Cell, Row, Value};
use super::layout::Shape;
use super::points::{NamedPoint, PlacedPoint};
use crate::run::Sample;
use crate::scenario::Scenario;
use std::io::{self, Write};

/// It makes spreadsheet programs read the file as UTF-8.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Writes a run's CSV row by row.
#[derive(Debug)]
pub struct CsvWriter<W: Write> {
    rows: csv::Writer<W>,
    count: u64,
    layout: Layout,
    /// The points of the body, where each of them has a row.
    points: Vec<NamedPoint>,
}

impl<W: Write> CsvWriter<W> {
    /// Begins a CSV of every row and column on `out` with the run file of `scenario` and the header line.
    ///
    /// # Errors
    /// When `out` cannot be written.
    pub fn new(out: W, scenario: &Scenario) -> io::Result<Self> {
        Self::with_layout(out, scenario, Layout::default())
    }

    /// Begins a CSV as `layout` says on `out`.
    ///
    /// # Errors
    /// When `out` cannot be written.
    pub fn with_layout(mut out: W, scenario: &Scenario, layout: Layout) -> io::Result<Self> {
        if layout.has_decimal_comma() {
            out.write_all(BYTE_ORDER_MARK.as_bytes())?;
        }
        out.write_all(layout.comments().as_bytes())?;
        out.write_all(commented(&scenario.to_toml()).as_bytes())?;
        let mut rows = csv::WriterBuilder::new()
            .has_headers(false)
            .delimiter(layout.delimiter() as u8)
            .from_writer(out);
        rows.write_record(layout.names()).map_err(plain)?;
        let points = match layout.is_of_points() {
            true => NamedPoint::all_of(scenario),
            false => Vec::new(),
        };
        Ok(Self {
            rows,
            count: 0,
            layout,
            points,
        })
    }

    /// Which rows and columns it has.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Adds the row of `sample`, or its rows where every point has one. Whether the layout has it is the caller's to ask.
    ///
    /// # Errors
    /// When the row cannot be written.
    pub fn write(&mut self, sample: &Sample) -> io::Result<()> {
        let comma = self.layout.has_decimal_comma();
        let rows = &mut self.rows;
        match self.layout.shape() {
            Shape::Whole if !comma => {
                rows.serialize(Row(sample)).map_err(plain)?;
                self.count += 1;
            }
            Shape::Whole => {
                let columns = super::COLUMNS.iter();
                write_row(
                    rows,
                    columns.map(|column| Cell::Number(column.value(sample))),
                    comma,
                )?;
                self.count += 1;
            }
            Shape::Columns(columns) => {
                let cells = columns
                    .iter()
                    .map(|column| Cell::Number(column.value(sample)));
                write_row(rows, cells, comma)?;
                self.count += 1;
            }
            Shape::Points(columns) => {
                for point in &self.points {
                    let placed = PlacedPoint::new(point, sample);
                    write_row(
                        rows,
                        columns.iter().map(|column| column.cell(&placed)),
                        comma,
                    )?;
                    self.count += 1;
                }
            }
        }
        Ok(())
    }

    /// How many rows have been added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Writes what is still buffered, and returns the output.
    ///
    /// # Errors
    /// When the output cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.rows.flush()?;
        self.rows
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

/// Writes one row field by field; numbers are those that csv writes with serde.
fn write_row<'a, W: Write>(
    rows: &mut csv::Writer<W>,
    cells: impl Iterator<Item = Cell<'a>>,
    comma: bool,
) -> io::Result<()> {
    let (mut digits, mut whole) = (ryu::Buffer::new(), itoa::Buffer::new());
    for cell in cells {
        let written = match cell {
            Cell::Text(text) => rows.write_field(text),
            Cell::Number(Value::Whole(count)) => rows.write_field(whole.format(count)),
            Cell::Number(Value::Number(number)) if comma => {
                rows.write_field(digits.format(number).replace('.', ","))
            }
            Cell::Number(Value::Number(number)) => rows.write_field(digits.format(number)),
        };
        written.map_err(plain)?;
    }
    rows.write_record(None::<&[u8]>).map_err(plain)
}

/// The system's error without csv's wrapping, which would hide its kind: a closed pipe is handled unlike a full disk.
fn plain(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// `text` with "# " before every line, as the run file is written above the rows.
pub fn commented(text: &str) -> String {
    text.lines().flat_map(|line| ["# ", line, "\n"]).collect()
}
