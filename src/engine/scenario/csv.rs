//! Parses CSV files with a header of `#` lines: measured data, output of other programs, and tables of sweeps,
//! comparisons and fits.

use super::head::{Head, bytes_of, utf8};
use super::problem::{Problem, Problems, at_line, nearest};
use crate::text::io_errors::unread;
use crate::text::printable::brief;
use crate::text::unit::{Unit, in_known_unit};
use ::csv::{ReaderBuilder, StringRecord, Trim};
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

const LONGEST_CSV: u64 = 32 << 20;
const CSV_TOO_LONG: &str = "is larger than 32 MiB, the limit: remove rows";

/// Maximum number of columns in a file. More would take minutes.
const MOST_CSV_COLUMNS: usize = 10_000;

/// First bytes of a zip archive. Spreadsheet files are zip archives too.
const ZIP: &[u8] = b"PK\x03\x04";

/// Names of the columns in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// The first line contains the names.
    Names,
    /// There is no line of names. The columns are named by their numbers, from 1.
    Numbers,
}

#[derive(Clone, Debug)]
pub struct Csv {
    /// Lines that begin with `#` above the names, without the `#`.
    pub header: String,
    pub line_of_names: u64,
    pub names: Vec<String>,
    /// The file's own columns, in the order of `names`.
    pub own: Vec<OwnColumn>,
    pub naming: Naming,
    /// Cells of a line of titles above the names, as Tracker writes it. Empty without such a line.
    pub titles: Vec<String>,
    /// Separator of the cells. A blank means any number of blanks.
    pub separator: char,
    /// Rows, each with its line number and one cell per name.
    pub rows: Vec<(u64, Vec<String>)>,
}

/// A column before renaming.
#[derive(Clone, Debug)]
pub struct OwnColumn {
    /// Number of the column in the file, from 1.
    pub number: usize,
    pub name: String,
    /// True if `--map` names the column.
    pub is_mapped: bool,
    /// Factor by which its numbers were multiplied to convert them to the unit of the new name.
    pub factor: f64,
}

impl OwnColumn {
    /// Returns the name of the column, or its number if it has no name.
    pub fn shown(&self) -> String {
        match &*self.name {
            "" => format!("column {}", self.number),
            name => name.to_owned(),
        }
    }
}

/// A column of a file, by name or by number from 1, and its new name.
pub type Renaming = (String, String);

/// Used instead of a new name, to leave the column out.
pub const LEFT_OUT: &str = "-";

/// Parses a renaming, `COLUMN=NAME`.
pub fn renaming(text: &str) -> Result<Renaming, String> {
    let (column, name) = text
        .rsplit_once('=')
        .ok_or("must be COLUMN=NAME, such as X=x_m, 3=z_m, or note=- to leave a column out")?;
    Ok((column.trim().to_owned(), name.trim().to_owned()))
}

/// Reads the text of the file `path`.
pub fn text(path: &Path) -> Result<String, Problem> {
    if path.is_dir() {
        return Err(Problem::at("", "is a folder: name a CSV file in it"));
    }
    let file = File::open(path).map_err(|error| Problem::at("", unread(&error)))?;
    text_from(file)
}

/// Reads the text of a CSV in UTF-8 or Latin-1.
pub fn text_from(file: impl Read) -> Result<String, Problem> {
    let bytes = bytes_of(file, LONGEST_CSV, CSV_TOO_LONG)?;
    if bytes.starts_with(ZIP) {
        let rule = "is a zip archive: unpack it and name the file in it (for phyphox \"Raw Data.csv\"), or save the spreadsheet as CSV";
        return Err(Problem::at("", rule));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        let rule = "is text in UTF-16: save the file as \"CSV UTF-8\" (iconv -f UTF-16 -t UTF-8 converts it)";
        return Err(Problem::at("", rule));
    }
    let is_latin = !bytes
        .iter()
        .any(|byte| matches!(byte, 0..=8 | 14..=31 | 127..=159));
    if is_latin && str::from_utf8(&bytes).is_err() {
        return Ok(bytes.into_iter().map(char::from).collect());
    }
    utf8(bytes, " (\"CSV UTF-8\")")
}

fn one(rule: String) -> Problems {
    Problem::at("", rule).into()
}

fn cannot(error: &dyn fmt::Display) -> Problems {
    one(format!("cannot be read: {error}"))
}

/// Returns the separator of the cells in a file whose first line is `line`.
fn separator(line: &str) -> char {
    let is_of_numbers = line
        .chars()
        .all(|c| c.is_ascii_digit() || "+-.,eE \t".contains(c));
    // In "0,5 1,2" the commas are decimal commas.
    let has_decimal_commas = is_of_numbers && !line.contains(", ") && line.trim().contains(' ');
    if line.contains(';') {
        ';'
    } else if line.contains('\t') && !line.contains(",\t") {
        '\t'
    } else if line.contains(',') && !has_decimal_commas {
        ','
    } else if !line.contains('"') && line.split_whitespace().count() > 1 {
        ' '
    } else if line.contains(',') {
        ','
    } else {
        ';' // one column, whose numbers may have decimal commas
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
    /// Parses `text`, which may have at most `most` values (rows times columns).
    pub fn parse(text: &str, most: usize) -> Result<Self, Problems> {
        let head = Head::read(&mut text.as_bytes()).map_err(|error| cannot(&error))?;
        let mut csv = Self {
            header: head.header()?,
            line_of_names: head.line_of_names(),
            names: Vec::new(),
            own: Vec::new(),
            naming: Naming::Names,
            titles: Vec::new(),
            separator: separator(str::from_utf8(head.names()).unwrap_or_default()),
            rows: Vec::new(),
        };
        let mut lines = text
            .splitn(csv.line_of_names as usize, '\n')
            .last()
            .unwrap_or_default()
            .trim_start_matches('\u{feff}');
        if let Some((titles, below)) = lines.split_once('\n')
            && csv.separator != ' '
            && titles.starts_with(csv.separator)
            && !below.starts_with(csv.separator)
            && !is_number(
                below
                    .split([csv.separator, '\n'])
                    .next()
                    .unwrap_or_default()
                    .trim(),
            )
        {
            csv.titles = titles
                .split(csv.separator)
                .map(|title| title.trim().to_owned())
                .collect();
            lines = below;
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
        // With uniform line ends, the reader counts lines correctly.
        let lines: String = if self.separator == ' ' {
            text.lines()
                .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n")
                .collect()
        } else {
            text.replace("\r\n", "\n") + "\n"
        };
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .delimiter(self.separator as u8)
            .from_reader(lines.as_bytes());
        let (mut record, mut found) = (StringRecord::new(), Problems::default());
        loop {
            let read = reader.read_record(&mut record);
            if !read.map_err(|error| cannot(&error))? {
                break;
            }
            let line = self.line_of_names + reader.position().line() - 2;
            if record.len() > MOST_CSV_COLUMNS {
                return Err(one(format!(
                    "has more than {MOST_CSV_COLUMNS} columns: remove some"
                )));
            }
            let mut ends = (1..=record.len()).rev();
            let filled = ends.find(|&end| !record[end - 1].is_empty()).unwrap_or(0);
            match self.names.len() {
                0 => self.read_first(line, record.iter().take(filled.max(1))),
                _ if filled == 0 => {} // spreadsheet programs write empty rows like this
                // Empty cells after the last column do not count.
                count if filled <= count && record.len() >= count => {
                    let cells = record.iter().take(count).map(str::to_owned);
                    self.rows.push((line, cells.collect()));
                }
                _ => found.add(|| at_line(line, self.ragged(record.len()))),
            }
            if self.rows.len() * self.names.len() > most {
                return Err(one(format!(
                    "has more than {most} values (rows times columns): remove rows or columns"
                )));
            }
        }
        found.or(())
    }

    /// Reads the cells of the first line. They are the names, or a row of data if they are all numbers.
    fn read_first<'a>(&mut self, line: u64, cells: impl Iterator<Item = &'a str>) {
        self.names = cells.map(str::to_owned).collect();
        if self.names.len() > 1 && self.names.iter().all(|name| is_number(name)) {
            self.naming = Naming::Numbers;
            let numbers = (1..=self.names.len()).map(|number| number.to_string());
            let row = std::mem::replace(&mut self.names, numbers.collect());
            self.rows.push((line, row));
        }
        let names = self.names.iter().enumerate();
        let own = names.map(|(place, name)| OwnColumn {
            number: place + 1,
            name: name.clone(),
            is_mapped: false,
            factor: 1.0,
        });
        self.own = own.collect();
    }

    /// Returns the problem of a row whose number of values differs from the number of names.
    fn ragged(&self, count: usize) -> Problem {
        let names = self.names.len();
        let advice = if self.separator == ',' && count > names {
            "write numbers with a decimal point (1.5, not 1,5), or separate columns by ; if you use decimal commas"
        } else {
            "leave no column out; write a missing value as an empty cell between two separators"
        };
        Problem::at(
            "this row",
            format!("cells: {count}, columns: {names}; {advice}"),
        )
    }

    /// Renames columns. Each pair is a column, by name or by number from 1, and its new name or [`LEFT_OUT`].
    ///
    /// A new name in another unit, or a unit in the column's old name, converts the column's numbers.
    ///
    /// # Errors
    /// Returns an error if there is no such column, or if `may_be` does not accept the new name in any unit.
    pub fn rename(
        &mut self,
        map: &[Renaming],
        may_be: impl Fn(&str) -> bool,
    ) -> Result<(), Problems> {
        let mut found = Problems::default();
        let mut left_out = Vec::new();
        for (column, name) in map {
            let place = match self.place_of(column) {
                Ok(place) => place,
                Err(rule) => {
                    found.add(|| in_map(column, name, rule));
                    continue;
                }
            };
            if name == LEFT_OUT {
                left_out.push(place);
                continue;
            }
            if self.own[place].is_mapped {
                let rule = "is mapped twice: give one name".to_owned();
                found.add(|| in_map(column, name, rule));
                continue;
            }
            let Some((ours, factor)) = in_known_unit(name, &may_be) else {
                let rule = "is not a known column name".to_owned();
                found.add(|| in_map(column, name, rule));
                continue;
            };
            let others = self.names.iter_mut().zip(&self.own).enumerate();
            for (at, (other, own)) in
                others.filter(|(at, (other, _))| *at != place && **other == ours)
            {
                if own.is_mapped {
                    let rule = format!(
                        "column {} is also mapped to {ours}: map only one of them",
                        at + 1
                    );
                    found.add(|| in_map(column, name, rule));
                }
                other.insert_str(0, "(the file's own) ");
            }
            let factor = if *name == ours {
                unit_between(&self.own[place].name, &ours)
            } else {
                factor
            };
            self.own[place].is_mapped = true;
            self.name_column(place, &ours, factor);
        }
        found.or(())?;
        remove(&mut self.names, &left_out);
        remove(&mut self.own, &left_out);
        for (_, row) in &mut self.rows {
            remove(row, &left_out);
        }
        Ok(())
    }

    /// Returns the position of a column, given its own name or its number from 1.
    fn place_of(&self, column: &str) -> Result<usize, String> {
        let named: Vec<_> = self.own.iter().filter(|own| own.name == column).collect();
        match named[..] {
            [own] => Ok(own.number - 1),
            [] => match column.parse::<usize>() {
                Ok(number) if (1..=self.own.len()).contains(&number) => Ok(number - 1),
                _ => {
                    let near = nearest(column, self.own.iter().map(|own| own.name.as_str()));
                    Err(format!(
                        "is not a name or number of a column in the file: {near}"
                    ))
                }
            },
            _ => {
                let numbers: Vec<_> = named.iter().map(|own| own.number.to_string()).collect();
                let rule = "is the name of columns";
                Err(format!("{rule} {}: give the number", numbers.join(" and ")))
            }
        }
    }

    /// Renames the column at `place` to `name`, and multiplies its numbers by `factor`.
    pub fn name_column(&mut self, place: usize, name: &str, factor: f64) {
        name.clone_into(&mut self.names[place]);
        self.own[place].factor = factor;
        if factor == 1.0 {
            return;
        }
        for (_, row) in &mut self.rows {
            if let Some(number) = multiplied(&row[place], factor, self.separator) {
                row[place] = number;
            }
        }
    }

    pub fn column<'a>(&'a self, name: &str) -> Option<impl Iterator<Item = &'a str> + Clone> {
        let place = self.names.iter().position(|other| other == name)?;
        Some(self.rows.iter().map(move |(_, row)| row[place].as_str()))
    }
}

/// Returns the factor from the unit in the column's own name to the unit of `ours`. It is 1 if the name has no unit of
/// the same kind.
fn unit_between(own: &str, ours: &str) -> f64 {
    let units = Unit::split(own).zip(Unit::from_name(ours));
    let factor = units.and_then(|((_, stated), unit)| stated.times(unit));
    factor.unwrap_or(1.0)
}

/// Removes the items at `places`.
fn remove<T>(items: &mut Vec<T>, places: &[usize]) {
    let mut place = 0;
    items.retain(|_| {
        place += 1;
        !places.contains(&(place - 1))
    });
}

/// Returns the number in `cell` times `factor`, with at least as many significant digits, and without a decimal sign
/// that the file might not use. `None` if it is not a finite number.
fn multiplied(cell: &str, factor: f64, separator: char) -> Option<String> {
    let plain = if separator == ',' {
        cell.to_owned()
    } else {
        cell.replacen(',', ".", 1)
    };
    let number: f64 = plain
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())?;
    let power = libm::log10(factor).round();
    if (libm::pow(10.0, power) / factor - 1.0).abs() < 1e-12 {
        // Changing only the exponent keeps every digit.
        let (mantissa, written) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
        let exponent = written.parse::<i32>().ok()?.checked_add(power as i32)?;
        return Some(format!("{mantissa}e{exponent}"));
    }
    let mantissa = plain.split(['e', 'E']).next().unwrap_or_default();
    let digits = mantissa
        .trim_start_matches(['+', '-', '0', '.'])
        .chars()
        .filter(char::is_ascii_digit)
        .count();
    let shortest = format!("{:e}", number * factor);
    let (significand, exponent) = shortest.split_once('e')?;
    let (whole, decimals) = significand.split_once('.').unwrap_or((significand, ""));
    let padded = format!("{decimals:0<width$}", width = digits.saturating_sub(1));
    let last_digit = exponent.parse::<i32>().ok()? - padded.len() as i32;
    Some(format!("{whole}{padded}e{last_digit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_converted_number_keeps_its_digits() {
        for (cell, factor, converted) in [
            ("25.00", 1e-2, "25.00e-2"),
            ("2.500000E+01", 1e-2, "2.500000e-1"),
            ("1700000000010000000", 1e-9, "1700000000010000000e-9"),
            ("-1,5", 1e-3, "-1,5e-3"),
            ("30.0", 60.0, "180e1"),
            ("0.5", 2.5, "125e-2"),
            ("0", 60.0, "0e0"),
        ] {
            let found = multiplied(cell, factor, ';');
            assert_eq!(found.as_deref(), Some(converted));
            let value = |text: &str| text.replace(',', ".").parse::<f64>().unwrap();
            let error = value(converted) - factor * value(cell);
            assert!(error.abs() <= 1e-15 * value(converted).abs(), "{cell}");
        }
        assert_eq!(multiplied("12 cm", 1e-2, ';'), None);
        assert_eq!(multiplied("NaN", 1e-2, ';'), None);
    }
}
