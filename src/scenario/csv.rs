//! A CSV with a header of `#` lines, taken apart: measured data, what other programs print, and the tables of sweeps,
//! comparisons and fits.

use super::head::{Head, text_of};
use super::problem::{Problem, Problems, at_line, nearest};
use crate::text::advice::unread;
use crate::text::printable::brief;
use ::csv::{ReaderBuilder, StringRecord, Trim};
use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

const LONGEST: u64 = 32 << 20;
const TOO_LONG: &str = "is longer than 32 MiB, the most that is read: leave rows out";

/// The most columns of a file; more would take minutes.
const MOST_COLUMNS: usize = 10_000;

/// How archives begin: zip's, which spreadsheets are too.
const ZIP: &[u8] = b"PK\x03\x04";

/// What a file calls its columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// The first line names them.
    Names,
    /// There is no such line: their names are their numbers, from 1.
    Numbers,
}

#[derive(Clone, Debug)]
pub struct Csv {
    /// The lines that begin with `#` before the names, without that.
    pub header: String,
    pub line_of_names: u64,
    pub names: Vec<String>,
    pub naming: Naming,
    /// Whether a line of titles stands above the names, as Tracker writes it.
    pub is_titled: bool,
    /// What parts the cells; any number of blanks for a blank.
    pub separator: char,
    /// The rows, each with its line and as many cells as there are names.
    pub rows: Vec<(u64, Vec<String>)>,
}

/// A column of a file, by name or by number from 1, and the name that it gets.
pub type Renaming = (String, String);

/// Reads a renaming, `COLUMN=NAME`.
pub fn renaming(text: &str) -> Result<Renaming, String> {
    let (column, name) = text
        .rsplit_once('=')
        .ok_or("must be COLUMN=NAME, such as X=x_m or 3=z_m")?;
    Ok((column.trim().to_owned(), name.trim().to_owned()))
}

/// The text of the file `path`.
pub fn text(path: &Path) -> Result<String, Problem> {
    if path.is_dir() {
        return Err(Problem::at("", "is a folder: name a CSV file in it"));
    }
    let cannot = |error: std::io::Error| Problem::at("", unread(&error));
    let mut file = BufReader::new(File::open(path).map_err(cannot)?);
    if file.fill_buf().map_err(cannot)?.starts_with(ZIP) {
        let rule = "is a zip archive: unpack it and name the file in it (of phyphox \"Raw Data.csv\"); a spreadsheet is saved as CSV";
        return Err(Problem::at("", rule));
    }
    text_of(file, LONGEST, TOO_LONG, " (\"CSV UTF-8\")")
}

fn one(rule: String) -> Problems {
    Problem::at("", rule).into()
}

fn cannot(error: &dyn fmt::Display) -> Problems {
    one(format!("cannot be read: {error}"))
}

/// What parts the cells of a file whose first line is `line`.
fn separator(line: &str) -> char {
    let has = |separator: char| line.contains(separator);
    let is_of_numbers = |c: char| c.is_ascii_digit() || "+-.,eE \t".contains(c);
    // "0,5 1,2": the commas are of decimals.
    let has_decimal_commas = || !line.contains(", ") && line.trim().contains(' ');
    if has(';') {
        ';'
    } else if has('\t') && !line.contains(",\t") {
        '\t'
    } else if has(',') && !(line.chars().all(is_of_numbers) && has_decimal_commas()) {
        ','
    } else if !line.contains('"') && line.split_whitespace().count() > 1 {
        ' '
    } else {
        ','
    }
}

fn is_number(cell: &str) -> bool {
    cell.replacen(',', ".", 1).parse::<f64>().is_ok()
}

fn in_map(column: &str, name: &str, rule: String) -> Problem {
    let mut problem = Problem::at("", rule);
    problem.place = Some(brief(&format!("--map {column}={name}"), 80));
    problem
}

impl Csv {
    /// Takes `text` apart, of at most `most` values (rows times columns).
    pub fn of(text: &str, most: usize) -> Result<Self, Problems> {
        let head = Head::read(&mut text.as_bytes()).map_err(|error| cannot(&error))?;
        let mut csv = Self {
            header: head.header()?,
            line_of_names: head.line_of_names(),
            names: Vec::new(),
            naming: Naming::Names,
            is_titled: false,
            separator: separator(str::from_utf8(head.names()).unwrap_or_default()),
            rows: Vec::new(),
        };
        let lines = text.splitn(csv.line_of_names as usize, '\n').last();
        let mut lines = lines.unwrap_or_default().trim_start_matches('\u{feff}');
        if let Some((titles, below)) = lines.split_once('\n')
            && csv.separator != ' '
            && titles.starts_with(csv.separator)
            && !below.starts_with(csv.separator)
        {
            (lines, csv.is_titled) = (below, true);
            csv.line_of_names += 1;
        }
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
        let mut text = text.replace("\r\n", "\n") + "\n";
        if self.separator == ' ' {
            let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n";
            text = text.lines().map(words).collect();
        }
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
            if record.len() > MOST_COLUMNS {
                return Err(one(format!(
                    "has more than {MOST_COLUMNS} columns: leave columns out"
                )));
            }
            let mut ends = (1..=record.len()).rev();
            let filled = ends.find(|&end| !record[end - 1].is_empty()).unwrap_or(0);
            match self.names.len() {
                0 => self.read_first(line, record.iter().take(filled.max(1))),
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

    /// Reads the first line with its cells: the names, or a row where it holds numbers alone.
    fn read_first<'a>(&mut self, line: u64, cells: impl Iterator<Item = &'a str>) {
        self.names = cells.map(str::to_owned).collect();
        if self.names.len() > 1 && self.names.iter().all(|name| is_number(name)) {
            self.naming = Naming::Numbers;
            let numbers = (1..=self.names.len()).map(|number| number.to_string());
            let cells = std::mem::replace(&mut self.names, numbers.collect());
            self.rows.push((line, cells));
        }
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

    /// Gives columns other names: each pair is the name or the number of a column, from 1, and its new name.
    ///
    /// # Errors
    /// Where there is no such column, or the new name is none that `may_be` accepts.
    pub fn rename(
        &mut self,
        map: &[Renaming],
        may_be: impl Fn(&str) -> bool,
    ) -> Result<(), Problems> {
        let own = self.names.clone();
        let mut found = Problems::default();
        for (column, name) in map {
            let number = column
                .parse()
                .ok()
                .filter(|number| (1..=own.len()).contains(number));
            let place = own.iter().position(|own| own == column);
            let Some(place) = place.or(number.map(|number: usize| number - 1)) else {
                let near = nearest(column, own.iter().map(String::as_str));
                let rule = format!("is no column of the file, by name or by number: {near}");
                found.add(|| in_map(column, name, rule));
                continue;
            };
            if !may_be(name) {
                let rule = "is no column that is read here".to_owned();
                found.add(|| in_map(column, name, rule));
            }
            for other in self.names.iter_mut().filter(|other| *other == name) {
                other.insert_str(0, "(the file's own) ");
            }
            self.names[place].clone_from(name);
        }
        found.or(())
    }

    pub fn column<'a>(&'a self, name: &str) -> Option<impl Iterator<Item = &'a str> + Clone> {
        let place = self.names.iter().position(|other| other == name)?;
        Some(self.rows.iter().map(move |(_, row)| row[place].as_str()))
    }
}
