//! A CSV with a header of `#` lines, taken apart: measured data, and the tables of sweeps, comparisons and fits.

use super::head::{Head, text_of};
use super::problem::{Problem, Problems, at_line};
use crate::text::advice::unread;
use ::csv::{ReaderBuilder, StringRecord, Trim};
use std::fmt;
use std::fs::File;
use std::path::Path;

const LONGEST: u64 = 32 << 20;
const TOO_LONG: &str = "is longer than 32 MiB, the most that is read: leave rows out";

/// Separators of cells. The last two are used where decimals have a comma.
const SEPARATORS: [char; 3] = [',', ';', '\t'];

#[derive(Clone, Debug)]
pub struct Csv {
    /// The lines that begin with `#` before the names, without that.
    pub header: String,
    pub line_of_names: u64,
    pub names: Vec<String>,
    pub separator: char,
    /// The rows, each with its line and as many cells as there are names.
    pub rows: Vec<(u64, Vec<String>)>,
}

/// The text of the file `path`.
pub fn text(path: &Path) -> Result<String, Problem> {
    if path.is_dir() {
        return Err(Problem::at("", "is a folder: name a CSV file in it"));
    }
    let file = File::open(path).map_err(|error| Problem::at("", unread(&error)))?;
    text_of(file, LONGEST, TOO_LONG, " (\"CSV UTF-8\")")
}

fn one(rule: String) -> Problems {
    Problem::at("", rule).into()
}

fn cannot(error: &dyn fmt::Display) -> Problems {
    one(format!("cannot be read: {error}"))
}

impl Csv {
    /// Takes `text` apart, of at most `most` values (rows times columns).
    pub fn of(text: &str, most: usize) -> Result<Self, Problems> {
        let head = Head::read(&mut text.as_bytes()).map_err(|error| cannot(&error))?;
        let names = str::from_utf8(head.names()).unwrap_or_default();
        let is_there = |separator: &&char| names.contains(**separator);
        let separator = *SEPARATORS.iter().find(is_there).unwrap_or(&SEPARATORS[0]);
        let mut csv = Self {
            header: head.header()?,
            line_of_names: head.line_of_names(),
            names: Vec::new(),
            separator,
            rows: Vec::new(),
        };
        let lines = text.splitn(csv.line_of_names as usize, '\n').last();
        let lines = lines.unwrap_or_default().trim_start_matches('\u{feff}');
        csv.read_rows(lines, most)?;
        if csv.names.is_empty() {
            let rule = "has no columns: the first line after its comments must name them, such as t_s,tilt_deg";
            return Err(one(rule.to_owned()));
        }
        if csv.rows.is_empty() {
            return Err(one("has no rows below the names of its columns".to_owned()));
        }
        Ok(csv)
    }

    fn read_rows(&mut self, text: &str, most: usize) -> Result<(), Problems> {
        // With every line ended alike, the reader's own count of lines is right.
        let text = text.replace("\r\n", "\n") + "\n";
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .delimiter(self.separator as u8)
            .from_reader(text.as_bytes());
        let (mut record, mut found) = (StringRecord::new(), Problems::default());
        loop {
            let read = reader.read_record(&mut record);
            if !read.map_err(|error| cannot(&error))? {
                break;
            }
            let line = self.line_of_names + reader.position().line() - 2;
            let mut ends = (1..=record.len()).rev();
            let filled = ends.find(|&end| !record[end - 1].is_empty()).unwrap_or(0);
            match self.names.len() {
                0 => {
                    let names = record.iter().take(filled.max(1));
                    self.names = names.map(str::to_owned).collect();
                }
                _ if filled == 0 => {} // as spreadsheet programs write empty rows
                // Empty cells behind the last column do not count.
                count if filled <= count && record.len() >= count => {
                    let cells = record.iter().take(count).map(str::to_owned);
                    self.rows.push((line, cells.collect()));
                }
                _ => found.add(|| at_line(line, self.ragged(record.len()))),
            }
            if self.rows.len() * self.names.len() > most {
                return Err(one(format!(
                    "has more than {most} values (rows times columns): leave rows or columns out"
                )));
            }
        }
        found.or(())
    }

    /// A row of another number of values than there are names.
    fn ragged(&self, count: usize) -> Problem {
        let names = self.names.len();
        let advice = if self.separator == ',' && count > names {
            "numbers have a decimal point (1.5, not 1,5); a file with decimal commas parts its columns by ;"
        } else {
            "leave no column out; a value that is missing is an empty place between two separators"
        };
        Problem::at(
            "this row",
            format!("number of cells: {count}, of columns: {names}; {advice}"),
        )
    }

    pub fn column<'a>(&'a self, name: &str) -> Option<impl Iterator<Item = &'a str> + Clone> {
        let place = self.names.iter().position(|other| other == name)?;
        Some(self.rows.iter().map(move |(_, row)| row[place].as_str()))
    }
}
