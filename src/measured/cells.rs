//! A CSV taken apart: its comments, the names of its columns, and its cells as texts, each with its line.

use crate::scenario::{Problem, Problems};
use crate::text::unread;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The longest file that is read, bytes.
const LONGEST: u64 = 32 << 20;

/// The most values of one, rows times columns.
const MOST_VALUES: usize = 1_000_000;

/// What may part two cells. The first is that of a CSV; the others leave the comma to the decimals.
const SEPARATORS: [char; 3] = [',', ';', '\t'];

/// The cells of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cells {
    /// The lines that begin with `#` before the names, without that.
    pub about: String,
    /// The line of the columns' names.
    pub line_of_names: u64,
    /// The names of the columns.
    pub names: Vec<String>,
    /// What parts them.
    pub separator: char,
    /// The rows, each with its line and as many cells as there are names.
    pub rows: Vec<(u64, Vec<String>)>,
}

/// A problem of the whole file.
fn whole(rule: impl Into<String>) -> Problem {
    Problem::at("", rule)
}

/// A problem in `line`.
pub(super) fn at_line(line: u64, mut problem: Problem) -> Problem {
    problem.place = Some(format!("line {line}"));
    problem
}

/// The text of the file `path`.
///
/// # Errors
/// When it is a folder, too long, no text in UTF-8, or the system reports an error.
pub(super) fn text_of(path: &Path) -> Result<String, Problem> {
    if path.is_dir() {
        return Err(whole("is a folder: name a CSV file in it"));
    }
    let cannot = |error: std::io::Error| whole(unread::why(&error));
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(cannot)?;
    // Of a FIFO no more than the limit.
    let read = file.take(LONGEST + 1).read_to_end(&mut bytes);
    read.map_err(cannot)?;
    if bytes.len() as u64 > LONGEST {
        let most = LONGEST >> 20;
        return Err(whole(format!(
            "is longer than {most} MiB, the most that is read of measured data: leave rows out"
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        let rule = "is not text in UTF-8: save the file in that encoding (\"CSV UTF-8\")";
        at_line(line, whole(rule))
    })
}

impl Cells {
    /// Takes `text` apart.
    ///
    /// # Errors
    /// When there are no names or no rows, or a row has more or fewer cells than there are names; all such rows are told.
    pub fn of(origin: &str, text: &str) -> Result<Self, Problems> {
        let one = |problem| Problems::one(origin, problem);
        let mut cells = Self::default();
        let mut rest = text.trim_start_matches('\u{feff}');
        loop {
            let (line, after) = match rest.split_once('\n') {
                Some((line, after)) => (line.trim_end(), after),
                None => (rest.trim_end(), ""),
            };
            if rest.is_empty() {
                let rule = "has no columns: the first line after its comments must name them, such as t_s,tilt_deg";
                return Err(one(whole(rule)));
            }
            cells.line_of_names += 1;
            match line.strip_prefix('#') {
                Some(comment) => {
                    cells.about += comment.strip_prefix(' ').unwrap_or(comment);
                    cells.about.push('\n');
                }
                None if line.is_empty() => {}
                None => break,
            }
            rest = after;
        }
        cells.read_rows(rest).map_err(|list| Problems {
            origin: origin.to_owned(),
            more: list.len().saturating_sub(MOST_TOLD),
            list: list.into_iter().take(MOST_TOLD).collect(),
        })?;
        Ok(cells)
    }

    /// Reads the line of names and the rows below it, which are `text`.
    fn read_rows(&mut self, text: &str) -> Result<(), Vec<Problem>> {
        let line_of_names = text.lines().next().unwrap_or_default();
        let is_there = |separator: &&char| line_of_names.contains(**separator);
        self.separator = *SEPARATORS.iter().find(is_there).unwrap_or(&SEPARATORS[0]);
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .delimiter(self.separator as u8)
            .from_reader(text.as_bytes());
        let mut problems = Vec::new();
        let mut lines = Lines::of(text);
        for record in reader.records() {
            let record = record.map_err(|error| vec![whole(format!("cannot be read: {error}"))])?;
            let begin = record.position().map_or(0, |place| place.byte() as usize);
            let line = lines.at(begin) + self.line_of_names - 1;
            let texts: Vec<String> = record.iter().map(str::to_owned).collect();
            match self.names.len() {
                0 => self.names = without_empty_end(texts),
                _ if texts.iter().all(String::is_empty) => {} // as spreadsheet programs write empty rows
                count => match fitting(texts, count) {
                    Ok(texts) => self.rows.push((line, texts)),
                    Err(texts) => problems.push(at_line(line, self.ragged(&texts))),
                },
            }
            if self.rows.len() * self.names.len() > MOST_VALUES {
                let rule = format!(
                    "has more than {MOST_VALUES} values (rows times columns): leave rows or columns out"
                );
                return Err(vec![whole(rule)]);
            }
        }
        if problems.is_empty() && self.rows.is_empty() {
            problems.push(whole(
                "has no rows below the names of its columns: nothing was measured",
            ));
        }
        if problems.is_empty() {
            Ok(())
        } else {
            Err(problems)
        }
    }

    /// A row that has more or fewer cells than there are names.
    fn ragged(&self, texts: &[String]) -> Problem {
        let plural = |count: usize, what: &str| match count {
            1 => format!("1 {what}"),
            _ => format!("{count} {what}s"),
        };
        let mut rule = format!(
            "has {}, and {} a name",
            plural(texts.len(), "value"),
            match self.names.len() {
                1 => "1 column has".to_owned(),
                count => format!("{count} columns have"),
            }
        );
        if self.separator == ',' && texts.len() > self.names.len() {
            rule += ": numbers have a decimal point (1.5, not 1,5); a file with decimal commas parts its columns by ;";
        } else {
            rule += ": leave no column out; a value that is missing is an empty place between two separators";
        }
        Problem::at("this row", rule)
    }
}

/// Counts the lines of a text.
struct Lines<'a> {
    text: &'a str,
    /// How many bytes and lines have been passed.
    bytes: usize,
    lines: u64,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        Self {
            text,
            bytes: 0,
            lines: 0,
        }
    }

    /// The line, from 1, of the row that is looked for from the byte `begin` on, which is not before those asked for
    /// earlier: empty lines and comments are passed over.
    fn at(&mut self, begin: usize) -> u64 {
        while let Some(line) = self.text[self.bytes..].split_inclusive('\n').next() {
            let is_passed = line.trim_end().is_empty() || line.starts_with('#');
            if self.bytes >= begin && !is_passed {
                break;
            }
            self.bytes += line.len();
            self.lines += 1;
        }
        self.lines + 1
    }
}

/// How many problems of one file are listed.
const MOST_TOLD: usize = 100;

/// `names` without the empty ones at their end, which a spreadsheet program writes for columns that were once filled.
fn without_empty_end(mut names: Vec<String>) -> Vec<String> {
    while names.len() > 1 && names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    names
}

/// `texts` as a row of `count` cells: empty ones behind the last are left out.
fn fitting(mut texts: Vec<String>, count: usize) -> Result<Vec<String>, Vec<String>> {
    while texts.len() > count && texts.last().is_some_and(String::is_empty) {
        texts.pop();
    }
    if texts.len() == count {
        Ok(texts)
    } else {
        Err(texts)
    }
}
