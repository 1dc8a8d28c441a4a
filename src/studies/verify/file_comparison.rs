//! Comparison of a file with the recomputed text, line by line.

use crate::engine::scenario::head::Head;
use crate::engine::text::printable::brief;
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Write};
use std::path::Path;

/// Maximum number of bytes read from a line beyond its computed length.
const MOST_LINE_EXCESS: u64 = 4096;
/// Maximum number of characters shown of a line or a field.
const MOST_SHOWN: usize = 60;
/// Start of the header line with the version, which is not compared.
const CSV_VERSION_LINE: &[u8] = b"# gyrolab = ";
/// A header's line with a warning. Another version has other words for it, or none.
const CSV_WARNING_LINE: &[u8] = b"# # warning:";

/// The first difference between a file and the recomputed text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileDifference {
    pub line: u64,
    text: String,
}

impl fmt::Display for FileDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A writer that compares its input with a file, line by line up to the first difference.
pub struct FileComparison {
    file: Box<dyn BufRead>,
    pub delimiter: u8,
    /// Number of leading columns that identify a row.
    pub keys: usize,
    /// The columns that are not compared.
    pub left_out: &'static [&'static str],
    /// The computed line so far.
    computed: Vec<u8>,
    line: u64,
    names: Option<Vec<String>>,
    rows: u64,
    /// Number of the first line that ends in CR LF.
    first_crlf_line: Option<u64>,
    difference: Option<FileDifference>,
}

impl FileComparison {
    /// Opens the CSV of a run to compare all rows and columns.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = BufReader::new(File::open(path)?);
        let head = Head::read(&mut file)?;
        Ok(Self {
            keys: 1,
            ..Self::new(&head, file)
        })
    }

    /// Compares with a file whose `head` has been read; `rest` is the remainder.
    pub fn new(head: &Head, rest: impl Read + 'static) -> Self {
        let head = Cursor::new(head.bytes().to_vec());
        Self {
            file: Box::new(BufReader::new(head.chain(rest))),
            delimiter: b',',
            keys: 0,
            left_out: &[],
            computed: Vec::new(),
            line: 0,
            names: None,
            rows: 0,
            first_crlf_line: None,
            difference: None,
        }
    }

    /// Returns true if a difference has been found.
    pub fn differs(&self) -> bool {
        self.difference.is_some()
    }

    /// Finishes the comparison. Returns the number of equal rows, and the first difference.
    pub fn end(mut self) -> io::Result<(u64, Option<FileDifference>)> {
        if !self.differs() {
            let more = self.next(MOST_LINE_EXCESS)?;
            if !more.is_empty() {
                let (line, text) = (self.line, shown(&more));
                self.differ(format!(
                    "line {line} is \"{text}\", but the computed rows have ended"
                ));
            }
        }
        if let Some(line) = self.first_crlf_line {
            self.line = line;
            self.differ(format!(
                "every row is the same, but the lines end in CR LF from line {line} on instead of LF: \
                 another program has rewritten the file"
            ));
        }
        Ok((self.rows, self.difference))
    }

    /// Records a difference in the current line. Only the first difference is kept.
    fn differ(&mut self, text: String) {
        let line = self.line;
        self.difference.get_or_insert(FileDifference { line, text });
    }

    /// Reads the next line of the file with its line end, at most `most` bytes; empty at the end of the file.
    fn next(&mut self, most: u64) -> io::Result<Vec<u8>> {
        let mut line = Vec::new();
        self.line += 1;
        (&mut self.file).take(most).read_until(b'\n', &mut line)?;
        Ok(line)
    }

    /// Whether the next line of the file is a warning.
    fn begins_with_warning(&mut self) -> io::Result<bool> {
        let next = self.file.fill_buf()?;
        let next = next.strip_prefix("\u{feff}".as_bytes()).unwrap_or(next);
        Ok(next.starts_with(CSV_WARNING_LINE))
    }

    /// Compares the computed line with the next line of the file.
    fn compare(&mut self) -> io::Result<()> {
        let computed = std::mem::take(&mut self.computed);
        let is_warning =
            self.names.is_none() && self.without_mark(&computed).starts_with(CSV_WARNING_LINE);
        if is_warning && !self.begins_with_warning()? {
            return Ok(());
        }
        let mut there = self.next(computed.len() as u64 + MOST_LINE_EXCESS)?;
        let is_whole = there.pop_if(|byte| *byte == b'\n').is_some();
        if is_whole && there.pop_if(|byte| *byte == b'\r').is_some() {
            self.first_crlf_line.get_or_insert(self.line);
        }
        let [computed, there] = [&computed, &there].map(|text| self.without_mark(text));
        let is_header = self.names.is_none() && computed.starts_with(b"#");
        let may_differ = is_header
            && [CSV_VERSION_LINE, CSV_WARNING_LINE]
                .iter()
                .any(|line| computed.starts_with(line) && there.starts_with(line));
        let line = self.line;
        let text = if !is_whole && there.is_empty() {
            let computed = shown(computed);
            Some(format!(
                "the file ends before line {line}, computed \"{computed}\": it is cut off"
            ))
        } else if !is_whole && computed.starts_with(there) {
            Some(format!(
                "line {line}, the last one, is cut off before its end"
            ))
        } else if there == computed || may_differ {
            None
        } else {
            self.fields_differ(there, computed)
        };
        match (text, &self.names) {
            (Some(text), _) => self.differ(text),
            (None, Some(_)) => self.rows += 1,
            (None, None) if is_header => {}
            (None, None) => self.names = Some(fields(computed, self.delimiter)),
        }
        Ok(())
    }

    /// Removes a byte order mark, which only the first line may have.
    fn without_mark<'a>(&self, line: &'a [u8]) -> &'a [u8] {
        let marked = line.strip_prefix("\u{feff}".as_bytes());
        marked.filter(|_| self.line == 1).unwrap_or(line)
    }

    /// Describes the difference between two lines. Returns `None` if only ignored columns differ.
    fn fields_differ(&self, there: &[u8], computed: &[u8]) -> Option<String> {
        let line = self.line;
        let names = self.names.as_deref().unwrap_or_default();
        let [cells, wanted] = [there, computed].map(|text| fields(text, self.delimiter));
        let mut differing = Vec::new();
        if cells.len() == wanted.len() && names.len() == wanted.len() {
            differing.extend((0..names.len()).filter(|&at| cells[at] != wanted[at]));
        }
        if differing.is_empty() {
            let (there, computed) = (shown(there), shown(computed));
            return Some(format!(
                "line {line} is \"{there}\", computed \"{computed}\""
            ));
        }
        let at = *differing
            .iter()
            .find(|at| !self.left_out.contains(&names[**at].as_str()))?;
        let [cell, expected] = [&cells[at], &wanted[at]].map(|text| match text.as_str() {
            "" => "empty".to_owned(),
            text => brief(text, MOST_SHOWN),
        });
        let (row, column) = (self.row_of(names, &wanted), &names[at]);
        let field = format!("line {line}{row}: {column} is {cell}, computed {expected}");
        if self.rows == 0 && differing.len() > 1 {
            let why = "its rows do not belong to the scenario in its header: already in the first";
            return Some(format!("{why}, {field}"));
        }
        Some(field)
    }

    /// Names the row with these fields by its first columns.
    fn row_of(&self, names: &[String], fields: &[String]) -> String {
        let keys = names.iter().zip(fields).take(self.keys);
        let keys: Vec<_> = keys
            .map(|(name, value)| format!("{name} {value}"))
            .collect();
        if keys.is_empty() {
            return String::new();
        }
        let keys = brief(&keys.join(", "), 2 * MOST_SHOWN);
        format!(", the row of {keys}")
    }
}

impl Write for FileComparison {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for part in bytes.split_inclusive(|&byte| byte == b'\n') {
            if self.differs() {
                break;
            }
            self.computed.extend_from_slice(part);
            if self.computed.pop_if(|byte| *byte == b'\n').is_some() {
                self.compare()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Compares too, and fails at the first difference, so that nothing more is computed.
pub(super) struct UntilDifference<'a>(pub &'a mut FileComparison);

impl Write for UntilDifference<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.0.write(bytes)?;
        if self.0.differs() {
            return Err(io::Error::other("the file differs"));
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Describes the first line that differs between the file's text `there` and the recomputed text `made`, and the number
/// of differing lines. Returns `None` if the texts are equal.
pub fn first_difference(there: &str, made: &str) -> Option<String> {
    if there == made {
        return None;
    }
    let [mut there, mut made] = [there, made].map(|text| text.lines().collect::<Vec<_>>());
    let are_same = there.iter().zip(&made).take_while(|(a, b)| a == b);
    let first = are_same.count();
    while there.len().min(made.len()) > first && there.last() == made.last() {
        there.pop();
        made.pop();
    }
    let lines = [&there, &made].map(|lines| lines.get(first).copied());
    if lines == [None, None] {
        return Some("its line ends differ: another program has rewritten it".to_owned());
    }
    let [a, b] = lines.map(Option::unwrap_or_default);
    let same = a.chars().zip(b.chars()).take_while(|(a, b)| a == b).count();
    let [there_is, made_is] = lines.map(|line| match (line, same.saturating_sub(MOST_SHOWN / 2)) {
        (None, _) => "nothing".to_owned(),
        (Some(line), 0) => format!("\"{}\"", brief(line, 2 * MOST_SHOWN)),
        (Some(line), from) => {
            let rest: String = line.chars().skip(from).collect();
            format!("\"...{}\"", brief(&rest, 2 * MOST_SHOWN))
        }
    });
    let (line, last) = (first + 1, there.len());
    let place = if last > line {
        format!("lines {line} to {last} differ; line {line}")
    } else {
        format!("line {line}")
    };
    Some(format!("{place} is {there_is}, recomputed {made_is}"))
}

/// Returns the fields of a line, or nothing if it is not text.
fn fields(line: &[u8], delimiter: u8) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new();
    let mut reader = reader
        .has_headers(false)
        .delimiter(delimiter)
        .from_reader(line);
    let record = reader.records().next().and_then(Result::ok);
    record.map_or(Vec::new(), |record| {
        record.iter().map(str::to_owned).collect()
    })
}

fn shown(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    brief(text.trim_end_matches(['\r', '\n']), MOST_SHOWN)
}
