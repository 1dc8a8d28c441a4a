//! What stands in a file, held against the sweep whose rows it should have.

use super::difference::of_headers;
use super::grid::Sweep;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};

/// What stands in a file, held against a sweep.
pub(super) enum There {
    /// So many rows of it, and how many bytes they and the header take; a torn line behind them is not counted.
    Rows(u64, u64),
    /// Nothing, or a beginning of the header.
    Nothing,
    /// Something else.
    Other(String),
}

/// Holds what stands in `file` against `sweep`.
pub(super) fn look(file: &File, sweep: &Sweep) -> io::Result<There> {
    let mut reader = BufReader::with_capacity(1 << 16, file);
    reader.rewind()?;
    let header = sweep.header();
    let mut begin = Vec::new();
    (&mut reader)
        .take(header.len() as u64)
        .read_to_end(&mut begin)?;
    if begin != header.as_bytes() {
        return Ok(match header.as_bytes().starts_with(&begin) {
            true => There::Nothing,
            false => {
                // The whole of the other header, as far as it is one.
                reader.rewind()?;
                There::Other(of_headers(&header_lines(&mut reader)?, &header))
            }
        });
    }
    let (mut rows, mut bytes) = (0, header.len() as u64);
    let mut line = Vec::new();
    loop {
        line.clear();
        reader.read_until(b'\n', &mut line)?;
        if line.last() != Some(&b'\n') {
            return Ok(There::Rows(rows, bytes));
        }
        if rows == sweep.rows() {
            return Ok(There::Other("it has more rows than the sweep".to_owned()));
        }
        if !is_row(&line, sweep, rows) {
            let row = rows + 1;
            return Ok(There::Other(format!(
                "its row {row} is no row of this sweep"
            )));
        }
        (rows, bytes) = (rows + 1, bytes + line.len() as u64);
    }
}

/// Whether `line` could be the `row`-th row of `sweep`: its values vary as they must, and it has as many cells as columns.
pub(super) fn is_row(line: &[u8], sweep: &Sweep, row: u64) -> bool {
    let begin = sweep.row_begins(row);
    let Some(rest) = line.strip_prefix(begin.as_bytes()) else {
        return false;
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(rest);
    let mut cells = csv::ByteRecord::new();
    let read = reader.read_byte_record(&mut cells).unwrap_or(false);
    // A line of one empty cell is taken for none.
    let count = if read { cells.len() } else { 1 };
    count == sweep.measure().len()
}

/// The `# ` lines at the beginning of a file, of which no more is read than any header has.
fn header_lines(reader: &mut impl BufRead) -> io::Result<String> {
    const LONGEST: u64 = 16 << 20;
    let mut reader = reader.take(LONGEST);
    let mut lines = Vec::new();
    loop {
        let begin = lines.len();
        reader.read_until(b'\n', &mut lines)?;
        if !lines[begin..].starts_with(b"#") {
            lines.truncate(begin);
            return Ok(String::from_utf8_lossy(&lines).into_owned());
        }
    }
}
