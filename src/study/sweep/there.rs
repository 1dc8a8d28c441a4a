//! What stands in a file, held against the sweep whose rows it should have.

use super::difference::{Differs, of_headers};
use super::grid::Sweep;
use super::row::{KindOfRow, RowsThere};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};

/// What stands in a file, held against a sweep.
pub(super) enum There {
    /// Rows of it, and how many bytes they and the header take; a torn line behind them is not counted.
    Rows(RowsThere, u64),
    /// So many rows of it, and behind them a line that is none of its rows.
    Damaged(u64),
    /// Nothing, or a beginning of the header.
    Nothing,
    /// Something else.
    Other(Differs),
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
                let there = header_lines(&mut reader)?;
                There::Other(of_headers(&there, &header, ["there", "here"]))
            }
        });
    }
    let (mut rows, mut bytes) = (RowsThere::default(), header.len() as u64);
    let mut line = Vec::new();
    loop {
        line.clear();
        reader.read_until(b'\n', &mut line)?;
        if line.last() != Some(&b'\n') {
            return Ok(There::Rows(rows, bytes));
        }
        if rows.count() == sweep.rows() {
            let what = "it has more rows than the sweep".to_owned();
            return Ok(There::Other(Differs::Form(what)));
        }
        match kind_of_row(&line, sweep, rows.count()) {
            Some(kind) => rows.add(kind),
            None => return Ok(There::Damaged(rows.count())),
        }
        bytes += line.len() as u64;
    }
}

/// What kind of row `line` is as the `row`-th of `sweep`; `None` where it cannot be that one: the values that vary must be
/// those of its point, and it must have as many cells as there are columns.
pub(super) fn kind_of_row(line: &[u8], sweep: &Sweep, row: u64) -> Option<KindOfRow> {
    let begin = sweep.row_begins(row);
    let rest = line.strip_prefix(begin.as_bytes())?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(rest);
    let mut cells = csv::ByteRecord::new();
    let read = reader.read_byte_record(&mut cells).unwrap_or(false);
    // A line of one empty cell is taken for none.
    let count = if read { cells.len() } else { 1 };
    let kind = match cells.iter().all(<[u8]>::is_empty) {
        true => KindOfRow::Empty,
        false => KindOfRow::Filled,
    };
    (count == sweep.measure().len()).then_some(kind)
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
