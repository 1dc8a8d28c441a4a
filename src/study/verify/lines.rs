//! The lines of a file, held one by one against those that are computed.

use super::row::{self, Field};
use crate::text::printable::brief;
use std::cell::Cell;
use std::fmt;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::rc::Rc;

/// The most bytes of a line that are read beyond the length that it should have.
const MOST_BEYOND: u64 = 4096;

/// The most characters of a line or a field that are shown.
const MOST_SHOWN: usize = 60;

/// How the line begins that tells the version: another one may have written the same rows.
const VERSION: &[u8] = b"# gyrolab = ";

/// The first thing in a file that is not as it is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The line of the file, counted from 1.
    pub line: u64,
    /// What differs there.
    pub what: What,
}

/// What differs in a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum What {
    /// A field.
    Field(Field),
    /// A field of the first row, and others with it: the rows are those of another scenario than the one in the header.
    FirstRow(Field),
    /// A line of the header, or one with another number of fields.
    Line {
        /// What stands in the file.
        stands: String,
        /// What was computed.
        computed: String,
    },
    /// The file ends before this line.
    Missing {
        /// What was computed.
        computed: String,
    },
    /// The file goes on after the last line.
    Extra {
        /// What stands in the file.
        stands: String,
    },
    /// The last line begins as it should and is cut off, if only its end is missing.
    Unended,
    /// Nothing but the ends of the lines: CR LF, where gyrolab writes LF.
    LineEnds,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line;
        match &self.what {
            What::Field(field) => write!(f, "line {line}, {field}"),
            What::FirstRow(field) => write!(
                f,
                "its rows are not those of the scenario in its header: already in the first, line {line}, {field}"
            ),
            What::Line { stands, computed } => {
                write!(f, "line {line} is \"{stands}\", computed \"{computed}\"")
            }
            What::Missing { computed } => write!(
                f,
                "the file ends before line {line}, computed \"{computed}\": it is cut off"
            ),
            What::Extra { stands } => write!(
                f,
                "line {line} is \"{stands}\", where the computed rows have come to their end"
            ),
            What::Unended => write!(f, "line {line}, the last one, is cut off before its end"),
            What::LineEnds => write!(
                f,
                "every row is the same, but the lines end in CR LF from line {line} on, where gyrolab writes LF: \
                 another program has rewritten the file"
            ),
        }
    }
}

/// The lines of a file.
#[derive(Debug)]
pub(super) struct Lines<R> {
    reader: BufReader<R>,
    line: Vec<u8>,
    number: u64,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self {
            reader: BufReader::new(reader),
            line: Vec::new(),
            number: 0,
        }
    }

    /// The next line with its end, of which no more than `most` bytes are read; empty at the end of the file.
    pub(super) fn next(&mut self, most: u64) -> io::Result<&[u8]> {
        self.line.clear();
        self.number += 1;
        self.reader
            .by_ref()
            .take(most)
            .read_until(b'\n', &mut self.line)?;
        Ok(&self.line)
    }
}

/// Takes what is computed, and holds it against the lines of a file up to the first difference.
#[derive(Debug)]
pub(super) struct Held<R> {
    lines: Lines<R>,
    delimiter: char,
    /// The computed line, as far as it has come.
    computed: Vec<u8>,
    names: Option<Vec<String>>,
    rows: u64,
    /// The first line that ends in CR LF.
    rewritten: Option<u64>,
    difference: Option<Difference>,
    differs: Rc<Cell<bool>>,
}

impl<R: Read> Held<R> {
    pub(super) fn new(lines: Lines<R>, delimiter: char) -> Self {
        Self {
            lines,
            delimiter,
            computed: Vec::new(),
            names: None,
            rows: 0,
            rewritten: None,
            difference: None,
            differs: Rc::default(),
        }
    }

    /// Tells, while the lines are held, whether a difference has been found.
    pub(super) fn differs(&self) -> Rc<Cell<bool>> {
        Rc::clone(&self.differs)
    }

    /// How many rows are the same, and what differs first.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(super) fn end(mut self) -> io::Result<(u64, Option<Difference>)> {
        if self.difference.is_none() {
            let next = self.lines.next(MOST_BEYOND)?;
            let stands = (!next.is_empty()).then(|| shown(next));
            self.difference = stands.map(|stands| Difference {
                line: self.lines.number,
                what: What::Extra { stands },
            });
        }
        let line_ends = self.rewritten.map(|line| Difference {
            line,
            what: What::LineEnds,
        });
        Ok((self.rows, self.difference.or(line_ends)))
    }

    /// Holds the computed line against the next one of the file.
    fn hold(&mut self) -> io::Result<()> {
        let is_first = self.lines.number == 0;
        let computed = without_mark(&self.computed, is_first);
        let is_header = self.names.is_none() && computed.starts_with(b"#");
        let stands = self.lines.next(computed.len() as u64 + MOST_BEYOND)?;
        let (stands, end) = parted(without_mark(stands, is_first));
        let is_version = is_header && computed.starts_with(VERSION) && stands.starts_with(VERSION);
        let what = if stands == computed || is_version {
            match end {
                End::None => Some(What::Unended),
                End::Dos => {
                    self.rewritten.get_or_insert(self.lines.number);
                    None
                }
                End::Plain => None,
            }
        } else if stands.is_empty() && end == End::None {
            let computed = shown(computed);
            Some(What::Missing { computed })
        } else if end == End::None && computed.starts_with(stands) {
            Some(What::Unended)
        } else {
            let names = self.names.as_deref();
            let is_first = self.rows == 0;
            let differs = names.and_then(|names| {
                let [there, wanted] = [stands, computed].map(|line| fields(line, self.delimiter));
                row::differing(names, &there, &wanted)
            });
            Some(match differs {
                None => What::Line {
                    stands: shown(stands),
                    computed: shown(computed),
                },
                Some((field, count)) if is_first && count > 1 => What::FirstRow(field),
                Some((field, _)) => What::Field(field),
            })
        };
        if what.is_none() && !is_header {
            match &self.names {
                None => self.names = Some(fields(computed, self.delimiter)),
                Some(_) => self.rows += 1,
            }
        }
        let line = self.lines.number;
        self.difference = what.map(|what| Difference { line, what });
        self.differs.set(self.difference.is_some());
        Ok(())
    }
}

impl<R: Read> Write for Held<R> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for part in bytes.split_inclusive(|&byte| byte == b'\n') {
            if self.difference.is_some() {
                break;
            }
            let (text, is_whole) = match part.strip_suffix(b"\n") {
                Some(text) => (text, true),
                None => (part, false),
            };
            self.computed.extend_from_slice(text);
            if is_whole {
                self.hold()?;
                self.computed.clear();
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The lines that begin with `#` at the beginning of `bytes`, each with the end that gyrolab writes.
pub(super) fn comments(bytes: &[u8]) -> Vec<u8> {
    let lines = without_mark(bytes, true).split_inclusive(|&byte| byte == b'\n');
    let comments = lines.take_while(|line| line.starts_with(b"#"));
    comments
        .flat_map(|line| [parted(line).0, b"\n"])
        .flatten()
        .copied()
        .collect()
}

/// How a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    None,
    Plain,
    Dos,
}

/// A line without its end, and that.
fn parted(line: &[u8]) -> (&[u8], End) {
    match line.strip_suffix(b"\n") {
        None => (line, End::None),
        Some(line) => match line.strip_suffix(b"\r") {
            None => (line, End::Plain),
            Some(line) => (line, End::Dos),
        },
    }
}

/// `line` without a byte order mark where it is the first one.
fn without_mark(line: &[u8], is_first: bool) -> &[u8] {
    let marked = line.strip_prefix("\u{feff}".as_bytes());
    marked.filter(|_| is_first).unwrap_or(line)
}

/// The fields of a line; none where it is not text.
fn fields(line: &[u8], delimiter: char) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(delimiter as u8)
        .from_reader(line);
    let record = reader.records().next().and_then(Result::ok);
    let fields = record.map(|record| record.iter().map(str::to_owned).collect());
    fields.unwrap_or_default()
}

/// What there is to show of a line or a field.
fn shown(bytes: &[u8]) -> String {
    let (text, _) = parted(bytes);
    brief(&String::from_utf8_lossy(text), MOST_SHOWN)
}
