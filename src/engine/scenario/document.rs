//! The text of a scenario, with its origin and the changes by `--set`.
//!
//! A document is parsed and checked here, and becomes a [`Scenario`]. Problems get the line or the `--set` argument
//! that caused them.

use super::checks;
use super::dotted::{find, is_in, overlap, set_key};
use super::head::{ScenarioText, is_file, read_text, text_of_stream};
use super::limits;
use super::problem::{PRESETS_FOLDER, Problem, Problems, at_line, nearest};
use super::schema::UNKNOWN_KEY;
use super::{file::ScenarioFile, keys, model::Scenario, presets, rescale, solids, start};
use crate::text::number::shortest;
use crate::text::printable::{brief, printable, printable_lines};
use std::io::Read;
use std::path::Path;
use toml::Value;
use toml::de::{DeTable, DeValue};

/// A scenario or run file on its way to a [`Scenario`].
#[derive(Clone, Debug)]
pub struct Document {
    origin: String,
    text: String,
    is_header_of_csv: bool,
    table: toml::Table,
    set: Vec<SetArgument>,
}

#[derive(Clone, Debug)]
struct SetArgument {
    key: String,
    argument: String,
    /// Why an array or a table is not valid TOML, and was read as text.
    mistake: Option<String>,
}

impl Document {
    /// Opens the argument SCENARIO: a shipped preset, or a file. The file is a scenario, a run file, a CSV with its run
    /// file in the header, or a figure.
    pub fn open(scenario: &str) -> Result<Self, Problems> {
        if is_file(scenario) {
            return Self::read(Path::new(scenario));
        }
        match presets::find(scenario) {
            Some(preset) => {
                let mut document =
                    Self::parse(&format!("{PRESETS_FOLDER}{scenario}.toml"), preset.text)?;
                // Values for the preset's own test are of no use in the header of a user's CSV.
                document.table.remove("expected");
                Ok(document)
            }
            None => Err(no_preset(scenario)),
        }
    }

    /// Reads a scenario or run file, the header of a CSV, or the run in a figure.
    pub fn read(path: &Path) -> Result<Self, Problems> {
        let origin = path.display().to_string();
        let text = read_text(path).map_err(|problem| Problems::one(&*origin, problem))?;
        Self::parse_found(&origin, text)
    }

    /// Reads the same from a stream, which cannot be a figure.
    pub fn read_from(origin: &str, reader: impl Read) -> Result<Self, Problems> {
        let text = text_of_stream(reader).map_err(|problem| Problems::one(origin, problem))?;
        Self::parse_found(origin, text)
    }

    fn parse_found(origin: &str, text: ScenarioText) -> Result<Self, Problems> {
        match text {
            ScenarioText::Whole(text) => Self::parse_header(origin, &text),
            ScenarioText::Header(text) => Ok(Self {
                is_header_of_csv: true,
                ..Self::parse_header(origin, &text)?
            }),
        }
    }

    /// Returns the header of the CSV in which the document was found, with `# ` removed from its lines. `None` for any
    /// other document.
    pub fn header_of_csv(&self) -> Option<&str> {
        self.is_header_of_csv.then_some(&self.text)
    }

    pub fn origin(&self) -> &str {
        &self.origin
    }

    pub fn table(&self) -> &toml::Table {
        &self.table
    }

    /// Returns the lines of the dotted `keys` in the text, from 1.
    pub fn lines_of(&self, keys: impl Iterator<Item = String>) -> Vec<Option<usize>> {
        let line = self.line_finder();
        keys.map(|key| line(&key)).collect()
    }

    fn line_finder(&self) -> impl Fn(&str) -> Option<usize> {
        let spans = DeTable::parse(&self.text).ok();
        let line_ends: Vec<usize> = self.text.match_indices('\n').map(|(at, _)| at).collect();
        move |key| {
            let offset = offset_of(spans.as_ref()?.get_ref(), key)?;
            Some(line_ends.partition_point(|&end| end < offset) + 1)
        }
    }

    /// Parses `text`, a scenario from `origin`.
    pub fn parse(origin: &str, text: &str) -> Result<Self, Problems> {
        limits::check_toml_size(text, 1).map_err(|problem| Problems::one(origin, problem))?;
        Self::parse_header(origin, text)
    }

    /// Parses the header of a CSV, which may be twice as long.
    pub fn parse_header(origin: &str, text: &str) -> Result<Self, Problems> {
        let lines = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
        match toml_within_limits(&lines) {
            Ok(table) => Ok(Self {
                text: lines,
                ..Self::from_table(origin, table)
            }),
            Err(problem) => Err(Problems::one(origin, problem)),
        }
    }

    /// Returns the document that `file` would be written as.
    pub fn from_file(origin: &str, file: &ScenarioFile) -> Result<Self, Problems> {
        let table = toml::Table::try_from(file)
            .map_err(|error| Problems::one(origin, Problem::at("", error.to_string())))?;
        Ok(Self::from_table(origin, table))
    }

    /// Returns a document with the contents `table`, which is a part of the file `origin`.
    pub fn from_table(origin: &str, table: toml::Table) -> Self {
        Self {
            origin: origin.to_owned(),
            text: String::new(),
            is_header_of_csv: false,
            table,
            set: Vec::new(),
        }
    }

    /// Checks the size of the document, and each key and value by itself.
    pub fn check(&self) -> Result<(), Problems> {
        if let Some(problem) = limits::exceeded(&self.table) {
            return Err(self.placed(problem));
        }
        let mut problems = keys::check(&self.table);
        if problems.list.is_empty() {
            return Ok(());
        }
        checks::check_names(&self.table, &mut problems);
        Err(self.placed(problems))
    }

    /// Applies one `--set KEY=VALUE`. The value is parsed as TOML, or else read as text.
    pub fn set(&mut self, argument: &str) -> Result<(), Problems> {
        let Some((key, value)) = argument.split_once('=') else {
            let rule = "must be KEY=VALUE, such as motion.time_step_s=0.05";
            return Err(self.with_error(argument, Problem::at("", rule)));
        };
        let (value, mistake) = toml_or_text(value);
        if let Err(problem) = self.set_value(key.trim(), value) {
            return Err(self.with_error(argument, problem));
        }
        self.set.push(SetArgument {
            key: key.trim().to_owned(),
            argument: argument.to_owned(),
            mistake,
        });
        Ok(())
    }

    fn with_error(&self, argument: &str, mut problem: Problem) -> Problems {
        problem.place = Some(set_place(argument));
        Problems::one(self.origin.as_str(), problem)
    }

    pub fn set_value(&mut self, key: &str, value: Value) -> Result<(), Problem> {
        start::make_room(&mut self.table, key);
        solids::prepare(&mut self.table, key, &value);
        set_key(&mut self.table, key, value)
    }

    /// Writes `value` at the dotted `key`; problems get no place. Other keys are converted first if the value requires
    /// it. A spin becomes a momentum, a momentum becomes a spin when the start is made steady, and a part that gets
    /// another shape gets its dimensions.
    pub fn write(&mut self, key: &str, value: Value) -> Result<(), Problems> {
        if start::is_other_way(&self.table, key, &value) {
            let now = self.scenario()?;
            let told = start::tell_other_way(&mut self.table, key, &value, &now);
            told.map_err(|problem| self.placed(problem))?;
        }
        let written = self.set_value(key, value);
        written.map_err(|problem| self.placed(problem))
    }

    /// Changes the time step of the scenario (s), and keeps its times in seconds; see [`rescale`].
    pub fn set_time_step(&mut self, time_step_s: f64) -> Result<(), Problems> {
        match rescale::at_time_step(&self.scenario()?.file, time_step_s) {
            Ok(file) => *self = Self::from_file(&self.origin, &file)?,
            Err(mut problem) if problem.key == "motion.time_step_s" => {
                problem.place = Some(format!("--time-step {}", shortest(time_step_s)));
                return Err(Problems::one(self.origin.as_str(), problem));
            }
            Err(problem) => return Err(self.placed(problem)),
        }
        Ok(())
    }

    pub fn scenario(&self) -> Result<Scenario, Problems> {
        if self.is_sweep() {
            let rule = "is a sweep of many runs, not a scenario: run it with gyrolab sweep";
            return Err(Problems::one(self.origin.as_str(), Problem::at("", rule)));
        }
        self.check()?;
        checks::scenario(self.file()?).map_err(|problems| self.placed(problems))
    }

    /// Returns true if this is a sweep's file, or the header of a sweep's CSV. No scenario has these keys.
    pub fn is_sweep(&self) -> bool {
        ["scenario", "vary", "measure"]
            .iter()
            .any(|key| self.table.contains_key(*key))
    }

    /// Returns the parsed file. Its numbers are not checked.
    pub fn file(&self) -> Result<ScenarioFile, Problems> {
        let file = self.table.clone().try_into();
        file.map_err(|error: toml::de::Error| self.placed(Problem::at("", error.message())))
    }

    /// Returns the last `--set` behind a problem at `key`. It set the value, something inside or around it, or the
    /// table without the value if that table is not in the file.
    fn setting_behind(&self, key: &str, written: &toml::Table) -> Option<&SetArgument> {
        let last =
            |wanted: &dyn Fn(&str) -> bool| self.set.iter().rev().find(|set| wanted(&set.key));
        last(&|set| overlap(key, set)).or_else(|| {
            let table = key.rsplit_once('.')?.0;
            let is_new = find(written, table).is_none();
            last(&|set| is_new && is_in(set, table))
        })
    }

    /// Describes the entries that the file has, if only `--set` created the entry (a push, a point) that lacks a key.
    fn existing_entries(problem: &Problem, written: &toml::Table) -> Option<String> {
        let (entry, _) = problem.key.rsplit_once('.')?;
        let (list, number) = entry.rsplit_once('.')?;
        number.parse::<usize>().ok()?;
        if find(written, entry).is_some() || !problem.rule.starts_with("is missing") {
            return None;
        }
        let there = find(written, list).and_then(Value::as_array);
        let there = match there.map_or(0, Vec::len) {
            0 => format!("there is no {list}"),
            1 => format!("there is only {list}.0"),
            count => format!("there are {list}.0 to {list}.{}", count - 1),
        };
        Some(format!(": {entry} would be a new one, {there}"))
    }

    /// Adds to problems the places at which the user wrote their keys, and sorts them in the order of the file.
    pub fn placed(&self, found: impl Into<Problems>) -> Problems {
        let Problems { list, more, .. } = found.into();
        let line_of = self.line_finder();
        let written = if self.set.is_empty() {
            toml::Table::new()
        } else {
            self.text.parse().unwrap_or_default()
        };
        let mut placed = Vec::with_capacity(list.len());
        for mut problem in list {
            let Some(setting) = self.setting_behind(&problem.key, &written) else {
                let line = line_of(&problem.key);
                problem.place = line.map(|line| format!("line {line}"));
                placed.push((line.unwrap_or(0), problem));
                continue;
            };
            problem.place = Some(set_place(&setting.argument));
            let meant = keys::meant(&setting.key);
            match (&setting.mistake, meant) {
                (Some(mistake), _) if problem.key == setting.key => {
                    (problem.value, problem.rule) = (String::new(), mistake.clone());
                }
                (_, Some(meant)) if problem.rule.starts_with(UNKNOWN_KEY) => {
                    // Show the whole key, because the user who typed the argument does not see the tables of a file.
                    problem.key.clone_from(&setting.key);
                    problem.rule = format!("{UNKNOWN_KEY}: did you mean {meant}?");
                }
                _ => problem
                    .rule
                    .extend(Self::existing_entries(&problem, &written)),
            }
            placed.push((usize::MAX, problem));
        }
        placed.sort_by_key(|(line, _)| *line);
        Problems {
            origin: self.origin.clone(),
            list: placed.into_iter().map(|(_, problem)| problem).collect(),
            more,
        }
    }
}

/// Parses `text`, which is at most as long as the header of a CSV.
fn toml_within_limits(text: &str) -> Result<toml::Table, Problem> {
    if text.len() as u64 > limits::LONGEST_HEADER {
        return Err(Problem::at("", limits::SCENARIO_TOO_LONG));
    }
    limits::check_toml_size(text, 2)?;
    text.parse().map_err(|error| syntax_problem(text, &error))
}

/// Parses `text` as TOML, or else as text. Also returns why an array or a table is not valid TOML.
pub fn toml_or_text(text: &str) -> (Value, Option<String>) {
    match text.trim().parse() {
        Ok(value) => (value, None),
        Err(error) => (
            Value::String(text.to_owned()),
            why_no_toml(text.trim(), &error),
        ),
    }
}

fn set_place(argument: &str) -> String {
    format!("--set {}", brief(argument, 80))
}

fn no_preset(name: &str) -> Problems {
    let near = nearest(name, presets::PRESETS.iter().map(|preset| preset.name));
    let hint = if Path::new(name).exists() {
        format!("to open the file of that name, write ./{}", printable(name))
    } else {
        "a file's name contains a / or ends in .toml or .csv".to_owned()
    };
    let rule = format!("no preset of that name: {near} ({hint})");
    Problems::one(name, Problem::at("", rule))
}

fn syntax_problem(text: &str, error: &toml::de::Error) -> Problem {
    const WIDEST: usize = 160;
    let picture = error.to_string();
    let mut lines = picture.trim_end().lines();
    let shown = if lines.clone().all(|line| line.len() <= WIDEST) {
        printable_lines(picture.trim_end()).into_owned()
    } else {
        // An excerpt of a line that fills the screen shows nothing.
        let place = brief(lines.next().unwrap_or_default(), WIDEST);
        format!("{place}: {}", brief(error.message(), WIDEST))
    };
    let Some(span) = error.span() else {
        return Problem::at("", format!("cannot be read as TOML: {shown}"));
    };
    let rule = repeated_table(text, span.start).unwrap_or(shown);
    at_line(line_at(text, span.start) as u64, Problem::at("", rule))
}

/// Tables that may occur several times in a file.
const REPEATED: [&str; 6] = ["do", "push", "edit", "expected", "body.point", "body.part"];

/// Describes the problem in the line at `offset`, if it begins one of these tables for the second time in single
/// brackets.
fn repeated_table(text: &str, offset: usize) -> Option<String> {
    let line = text.lines().nth(line_at(text, offset) - 1)?.trim();
    let name = line.strip_prefix('[')?.strip_suffix(']')?.trim();
    REPEATED.contains(&name).then(|| {
        format!(
            "[{name}] occurs a second time: write [[{name}]], in double brackets, for each of them"
        )
    })
}

fn line_at(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())]
        .iter()
        .filter(|&&byte| byte == b'\n')
        .count()
        + 1
}

/// Returns the position of the dotted `key` in the text, or of its longest part that exists: a value's key, or a
/// table's head.
fn offset_of(table: &DeTable<'_>, key: &str) -> Option<usize> {
    let quoted = key.strip_prefix('"').and_then(|key| key.strip_suffix('"'));
    let (name, rest) = match quoted {
        Some(name) => (name, ""),
        None => key.split_once('.').unwrap_or((key, "")),
    };
    // The keys that an edit sets are whole paths.
    let (found, value) = table
        .get_key_value(name)
        .or_else(|| table.get_key_value(key))?;
    Some(offset_inside(value.get_ref(), rest).unwrap_or(found.span().start))
}

fn offset_inside(value: &DeValue<'_>, key: &str) -> Option<usize> {
    match value {
        DeValue::Table(table) => offset_of(table, key),
        DeValue::Array(array) => {
            let (place, rest) = key.split_once('.').unwrap_or((key, ""));
            let item = array.get(place.parse::<usize>().ok()?)?;
            Some(offset_inside(item.get_ref(), rest).unwrap_or(item.span().start))
        }
        _ => None,
    }
}

/// Describes why `value`, which begins like an array or a table, is not valid TOML.
fn why_no_toml(value: &str, error: &toml::de::Error) -> Option<String> {
    if !value.starts_with(['[', '{']) {
        return None;
    }
    let from = error.span().map_or(0, |span| span.start);
    let place = match value.get(from..).unwrap_or_default() {
        "" => "its end".to_owned(),
        rest => format!("\"{}\"", brief(rest, 24)),
    };
    let message = brief(error.message(), 120);
    Some(format!("is not valid TOML at {place}: {message}"))
}
