//! Reads the text of a scenario from a file: the whole file, the run file in the head of a CSV, or the run file in a
//! figure.

use super::limits::{self, LONGEST_HEADER, LONGEST_SCENARIO_FILE};
use super::problem::{Problem, at_line};
use crate::provenance::{FigureFile, Payload};
use crate::text::io_errors::unread;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// Start of the line of names in the CSV of a run with every column.
const EVERY_COLUMN: &[u8] = b"step,t_s,";

/// Start of the version line, which is in the head of every CSV that gyrolab writes.
const VERSION_LINE: &[u8] = b"# gyrolab = ";

/// Mark that some programs write before the first line of a file.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Head of a file: the lines that begin with `#`, and the next one, which in a CSV names the columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    bytes: Vec<u8>,
    names: usize,
}

impl Head {
    /// Reads the head of a file from its start, up to the maximum length.
    pub fn read(reader: &mut impl BufRead) -> io::Result<Self> {
        let mut head = reader.take(LONGEST_HEADER + 1);
        let (mut bytes, mut names) = (Vec::new(), 0);
        loop {
            head.read_until(b'\n', &mut bytes)?;
            let line = without_mark(&bytes[names..]);
            let is_above = line.starts_with(b"#") || line.trim_ascii().is_empty();
            if line.is_empty() || !is_above {
                return Ok(Self { bytes, names });
            }
            names = bytes.len();
        }
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the line that names the columns of a CSV, without its line end.
    pub fn names(&self) -> &[u8] {
        without_mark(&self.bytes[self.names..]).trim_ascii_end()
    }

    /// Returns the number of the line of names, from 1.
    pub fn line_of_names(&self) -> u64 {
        let above = &self.bytes[..self.names];
        1 + above.iter().filter(|&&byte| byte == b'\n').count() as u64
    }

    /// Returns true if this is the head of a CSV that gyrolab wrote. In TOML, no line consists of names without a
    /// value.
    pub fn is_of_csv(&self) -> bool {
        let names = self.names();
        if names.starts_with(EVERY_COLUMN) {
            return true;
        }
        let are_names = names
            .iter()
            .all(|byte| byte.is_ascii_alphanumeric() || b"_.,;\"".contains(byte));
        let mut comments = self.comments().split(|&byte| byte == b'\n');
        !names.is_empty() && are_names && comments.any(|line| line.starts_with(VERSION_LINE))
    }

    /// Returns the lines that begin with `#`, without a byte order mark.
    fn comments(&self) -> &[u8] {
        without_mark(&self.bytes[..self.names])
    }

    /// Returns the run file of a CSV: the lines above the line of names, without their `# `.
    pub fn run_file(&self) -> Result<String, Problem> {
        if self.comments().trim_ascii().is_empty() {
            let rule = "is a CSV without a run file in its header (\"# \" lines, which other programs drop): use the file as gyrolab wrote it";
            return Err(Problem::at("", rule));
        }
        self.header()
    }

    /// Returns the lines above the line of names, without their `# `. The result is empty if there are none.
    pub fn header(&self) -> Result<String, Problem> {
        let lines = utf8(self.comments().to_vec(), "")?;
        Ok(lines.split_inclusive('\n').map(uncommented).collect())
    }
}

/// Returns `line` without the `# ` at its start.
fn uncommented(line: &str) -> &str {
    let whole = line.trim_start_matches('\u{feff}');
    let comment = whole.strip_prefix('#').unwrap_or(whole);
    comment.strip_prefix(' ').unwrap_or(comment)
}

fn without_mark(line: &[u8]) -> &[u8] {
    line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line)
}

/// Reads the text of the file at `path`. A file of more than `most` bytes is an error with the message `too_long`.
pub fn read_whole(path: &Path, most: u64, too_long: &str) -> Result<String, Problem> {
    if path.is_dir() {
        return Err(Problem::at("", "is a folder: name a file in it"));
    }
    let file = File::open(path).map_err(|error| cannot_read(&error))?;
    utf8(bytes_of(file, most, too_long)?, "")
}

/// The text of a scenario or run file, by where it was found.
pub(super) enum ScenarioText {
    /// Found in a file of its own, or in a figure.
    Whole(String),
    /// Found in the header of a CSV.
    Header(String),
}

/// Reads the text of a scenario, the run file in a figure, or the run file in the header of a CSV. The rest of a CSV is
/// not read.
pub(super) fn read_text(path: &Path) -> Result<ScenarioText, Problem> {
    if path.is_dir() {
        return Err(Problem::at("", "is a folder: name a file in it"));
    }
    let mut reader = BufReader::new(File::open(path).map_err(|error| cannot_read(&error))?);
    let figure = FigureFile::read(&mut reader).map_err(|rule| Problem::at("", rule))?;
    if let Some(figure) = figure {
        return run_of_figure(&figure).map(ScenarioText::Whole);
    }
    let head = Head::read(&mut reader).map_err(|error| cannot_read(&error))?;
    if head.is_of_csv() {
        return head.run_file().map(ScenarioText::Header);
    }
    if path.extension().is_some_and(|extension| extension == "csv") {
        let names = String::from_utf8_lossy(EVERY_COLUMN);
        let rule = format!("is not the CSV of a run: no line \"{names}...\" below a run file");
        return Err(Problem::at("", rule));
    }
    text_of_file(head.bytes.as_slice().chain(reader))
}

fn cannot_read(error: &io::Error) -> Problem {
    Problem::at("", unread(error))
}

/// Returns the run file in a figure. If there are several, it returns the first. For a table, it returns the run file
/// in the table's header.
fn run_of_figure(figure: &FigureFile) -> Result<String, Problem> {
    match figure.origin.files.first() {
        Some(file) if file.sha256.is_some() => {
            let rule = format!(
                "shows a table that is not embedded in it: name {}",
                file.name
            );
            Err(Problem::at("", rule))
        }
        Some(file) if file.holds == Payload::Table => {
            let head = Head::read(&mut file.text.as_bytes());
            head.map_err(|error| cannot_read(&error))?.run_file()
        }
        file => Ok(file.map(|file| file.text.clone()).unwrap_or_default()),
    }
}

/// Returns true if the argument SCENARIO names a file, and not a preset.
pub fn is_file(name: &str) -> bool {
    let endings = [".toml", ".csv", ".svg", ".pdf", ".png"];
    name.contains('/') || endings.iter().any(|ending| name.contains(ending))
}

/// Reads the text of a scenario, or the run file in the header of a CSV, from `stream`.
pub(super) fn text_of_stream(stream: impl Read) -> Result<ScenarioText, Problem> {
    let mut reader = BufReader::new(stream);
    let head = Head::read(&mut reader).map_err(|error| cannot_read(&error))?;
    if head.is_of_csv() {
        return head.run_file().map(ScenarioText::Header);
    }
    text_of_file(head.bytes.as_slice().chain(reader))
}

fn text_of_file(file: impl Read) -> Result<ScenarioText, Problem> {
    let text = utf8(
        bytes_of(file, LONGEST_SCENARIO_FILE, limits::SCENARIO_TOO_LONG)?,
        "",
    )?;
    limits::check_toml_size(&text, 1)?;
    Ok(ScenarioText::Whole(text))
}

/// Reads the bytes of `file` to its end. More than `most` are an error with the message `too_long`.
pub(super) fn bytes_of(file: impl Read, most: u64, too_long: &str) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    let read = file.take(most + 1).read_to_end(&mut bytes);
    let length = read.map_err(|error| cannot_read(&error))?;
    if length as u64 > most {
        return Err(Problem::at("", too_long));
    }
    Ok(bytes)
}

/// Decodes `bytes` as UTF-8. `words` follow the name of the encoding in the error message.
pub(super) fn utf8(bytes: Vec<u8>, words: &str) -> Result<String, Problem> {
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        let rule = format!("is not text in UTF-8: save the file in that encoding{words}");
        at_line(line, Problem::at("", rule))
    })
}
