//! A command: one thing that a user can do to the lab, as a value. Keys and dialogs lead to commands, and files of
//! commands (`--do`) contain them.
//!
//! A file of commands is a list of `[[do]]` tables with one command each. The [table](COMMANDS) lists every command with
//! its name, its value and its effect; [`read`] and the manual use it.

mod form;
mod table;

pub use form::MOST_MAGNIFIED;
pub use table::{COMMANDS, CommandRow};

use crate::export::layout::LayoutFile;
use crate::journal::expression::Expression;
use crate::journal::next_push::Toward;
use crate::lab::view::{Look, Pane};
use crate::playback::pace::Speed;
use crate::scenario::file::Choice;
use crate::scenario::problem::nearest;
use crate::scenario::screen::TRACES;
use crate::scenario::{Document, Problem, Problems};
use form::{below, quoted};
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::{Table, Value};

/// A command; serde reads and writes it under its name in a `[[do]]` table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Opens a preset or a file: SCENARIO as on the command line.
    Open(String),
    /// Sets dotted keys of the scenario, as one act: one undo takes all of them back.
    Set(Table),
    /// Nudges the value of a dotted key: up, or down where `times` is negative.
    Nudge {
        /// The key, of a single value.
        key: String,
        /// How often; negative: downwards. Not 0.
        #[serde(default = "once")]
        times: i32,
    },
    /// Pushes from the next step on.
    Push(PushChoice),
    /// Chooses the push to come.
    NextPush(PushChoice),
    /// Takes this many time steps, or goes back by as many where that is negative. Not 0.
    Step(i64),
    /// Goes to a step or a time, and stops there.
    GoTo(Place),
    /// Plays at the present speed until this condition holds, and stops there.
    RunUntil(Expression),
    #[serde(with = "only_true")]
    Run,
    #[serde(with = "only_true")]
    Pause,
    /// Lets the next command of the script wait for this many seconds.
    #[serde(rename = "wait_s")]
    Wait(f64),
    /// Begins a part of the script that has this title.
    Chapter(String),
    Undo(u32),
    /// Does this many undone acts again.
    Redo(u32),
    Export(Export),
    Figure(Figure),
    Save(Save),
    Speed(Speed),
    /// Time at the left edge of the traces, s; `None`: they follow the run.
    #[serde(rename = "since_s", with = "or_none")]
    Since(Option<f64>),
    /// How many times the values of the traces are magnified.
    Magnify(f64),
    /// The step at which the traces are read off.
    Cursor(CursorTo),
    /// Whether the exact motion is drawn beside the run.
    Exact(bool),
    /// Puts these measured data beside the run, or none.
    #[serde(with = "or_none")]
    Measured(Option<String>),
    /// Begins the run anew with the time step or scheme that mends doubtful numbers.
    #[serde(with = "only_true")]
    TakeAdvice,
    /// Whether the present run is pinned as the reference; false: no run is.
    Pin(bool),
    #[serde(with = "or_none")]
    Fill(Option<Pane>),
    #[serde(with = "or_none")]
    PointAt(Option<Pane>),
    /// Shows the run as these keys of `[view]` say: those of [`Look`].
    #[serde(skip)]
    Look(Table),
}

fn once() -> i32 {
    1
}

/// Writes the run up to a step as CSV.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Export {
    pub path: String,
    #[serde(flatten)]
    pub layout: LayoutFile,
    /// Up to this step instead of the present one.
    pub to_step: Option<u64>,
    /// Whether an existing file is replaced.
    #[serde(default)]
    pub force: bool,
}

/// Draws the run up to a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// The file; its name's end says in which form.
    pub path: String,
    /// What it shows: traces, above, 3d, or columns.
    #[serde(default = "traces")]
    pub kind: String,
    /// Whether the exact motion is drawn beside it.
    #[serde(default)]
    pub exact: bool,
    /// Up to this step instead of the present one.
    pub to_step: Option<u64>,
    /// Whether an existing file is replaced.
    #[serde(default)]
    pub force: bool,
}

fn traces() -> String {
    TRACES.to_owned()
}

/// Writes the run up to a step as a run file, or the present state as a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Save {
    pub path: String,
    /// Whether the file is a scenario that starts from the present state.
    #[serde(default)]
    pub from_here: bool,
    /// Of a run file: up to this step instead of the present one.
    pub to_step: Option<u64>,
    /// Whether an existing file is replaced.
    #[serde(default)]
    pub force: bool,
}

/// The values of a push that a command gives. The push to come has the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct PushChoice {
    pub point: Option<String>,
    pub force_N: Option<Force>,
    /// Direction of the force, if `force_N` is only a size.
    pub toward: Option<Toward>,
    pub for_s: Option<f64>,
}

/// A force, N.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Force {
    Size(f64),
    /// The force itself, world frame.
    Vector([f64; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Choice", into = "Choice")]
pub enum Place {
    Step(u64),
    /// The one at this time, s.
    Time(f64),
    Start,
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CursorTo {
    /// To the next step at which the tilt turns up or down.
    #[serde(rename = "next turn")]
    NextTurn,
    #[serde(rename = "turn before")]
    TurnBefore,
    /// Off the traces.
    #[serde(rename = "none")]
    Nowhere,
    /// To a step or a time that the run has reached.
    #[serde(untagged)]
    Place(Place),
}

/// The value of a command that takes none.
mod only_true {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        true.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        bool::deserialize(deserializer).map(|_| ())
    }
}

/// A value, or the word `none`.
mod or_none {
    use serde::de::{DeserializeOwned, Error};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use toml::Value;

    pub fn serialize<T: Serialize, S: Serializer>(
        value: &Option<T>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match value {
            Some(value) => value.serialize(serializer),
            None => "none".serialize(serializer),
        }
    }

    pub fn deserialize<'de, T: DeserializeOwned, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<T>, D::Error> {
        let value = Value::deserialize(deserializer)?;
        if value.as_str() == Some("none") {
            return Ok(None);
        }
        value.try_into().map(Some).map_err(D::Error::custom)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    pub command: Command,
    /// Its line, from 1; `None` where that is not known.
    pub line: Option<usize>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Commands {
    /// The file, as the user named it.
    pub origin: String,
    pub list: Vec<Placed>,
}

impl Command {
    /// The command called `name` with `value`.
    pub fn new(name: &str, value: &Value) -> Result<Self, Vec<Problem>> {
        let Some(row) = COMMANDS.iter().find(|row| row.name == name) else {
            return Err(vec![unknown(name, None)]);
        };
        let table = Table::from_iter([(name.to_owned(), row.form.check(value)?)]);
        if Look::has(name) {
            return Ok(Self::Look(table));
        }
        let read = table.try_into();
        read.map_err(|error: toml::de::Error| vec![Problem::with_value("", value, error.message())])
    }

    /// The command that shows the run as the key `name` of `[view]` says with `value`.
    pub fn look(name: &str, value: impl Serialize) -> Self {
        let value = Value::try_from(value).ok();
        let entry = value.map(|value| (name.to_owned(), value));
        Self::Look(entry.into_iter().collect())
    }

    /// The value of the key `name` of `[view]`, where the command sets it.
    pub fn looked(&self, name: &str) -> Option<&Value> {
        match self {
            Self::Look(table) => table.get(name),
            _ => None,
        }
    }

    /// Its name and the value behind it, as TOML.
    pub fn to_table(&self) -> Table {
        match (self, Value::try_from(self)) {
            (Self::Look(table), _) => table.clone(),
            (_, Ok(Value::Table(table))) => table,
            _ => Table::new(), // a command holds nothing that TOML cannot write
        }
    }
}

pub fn to_toml(commands: &[Command]) -> String {
    let tables = commands
        .iter()
        .map(|command| Value::Table(command.to_table()));
    let file = Table::from_iter([("do".to_owned(), Value::Array(tables.collect()))]);
    toml::to_string(&file).unwrap_or_default() // a command holds nothing that TOML cannot write
}

/// Whether `document` is a file of commands, by its `[[do]]`.
pub fn is_file_of_commands(document: &Document) -> bool {
    document.table().contains_key("do")
}

/// Reads the file of commands at `path`, or standard input where that is `-`.
pub fn open(path: &Path) -> Result<Commands, Problems> {
    read(&if path == Path::new("-") {
        Document::read_from("standard input", std::io::stdin().lock())?
    } else {
        Document::read(path)?
    })
}

/// The commands in `document`.
pub fn read(document: &Document) -> Result<Commands, Problems> {
    let mut problems = Problems::default();
    let mut list = Vec::new();
    for name in document.table().keys().filter(|name| *name != "do") {
        let rule = "unknown key: a file of commands holds [[do]] and nothing else";
        problems.add(|| Problem::at(name, rule));
    }
    match document.table().get("do") {
        Some(Value::Array(tables)) => {
            let keys = (0..tables.len()).map(|index| format!("do.{index}"));
            let lines = document.lines_of(keys);
            for ((index, value), line) in tables.iter().enumerate().zip(lines) {
                match one(index, value) {
                    Ok(command) => list.push(Placed { command, line }),
                    Err(found) => problems.add_all(found),
                }
            }
        }
        Some(other) => problems.add(|| {
            let rule = "must be an array of tables: write [[do]]";
            Problem::with_value("do", other, rule)
        }),
        None => problems.add(|| {
            let rule = "holds no command: write a table [[do]] for each";
            Problem::at("", rule)
        }),
    }
    let origin = document.origin().to_owned();
    let commands = problems.or(Commands { origin, list });
    commands.map_err(|problems| document.placed(problems))
}

/// The command in the table `do.index`.
fn one(index: usize, value: &Value) -> Result<Command, Vec<Problem>> {
    let here = format!("do.{index}");
    let wrong = |rule: String| Err(vec![Problem::at(here.as_str(), rule)]);
    let Value::Table(table) = value else {
        return Err(vec![Problem::with_value(here, value, "must be a table")]);
    };
    let known = |name: &&String| COMMANDS.iter().any(|row| row.name == name.as_str());
    let beside = COMMANDS.iter().find(|row| table.contains_key(row.name));
    let unknown: Vec<_> = table
        .keys()
        .filter(|name| !known(name))
        .map(|name| below(&here, unknown(name, beside)))
        .collect();
    if !unknown.is_empty() {
        return Err(unknown);
    }
    match table.iter().collect::<Vec<_>>()[..] {
        [(name, value)] => Command::new(name, value).map_err(|problems| {
            let problems = problems.into_iter();
            problems
                .map(|problem| below(&here, below(name, problem)))
                .collect()
        }),
        [] => wrong("holds no command: there is gyrolab man for their names".to_owned()),
        _ => {
            let names: Vec<_> = table.keys().map(String::as_str).collect();
            let names = names.join(", ");
            wrong(format!(
                "holds {names}: one command each, the next in a [[do]] of its own"
            ))
        }
    }
}

/// The problem that `name` is no command. `beside` is a command in the same table: `name` may belong into its value.
fn unknown(name: &str, beside: Option<&CommandRow>) -> Problem {
    let near = match beside {
        Some(row) => format!(
            "what belongs to {} stands in its value: {}",
            row.name, row.value
        ),
        None => nearest(name, COMMANDS.iter().map(|row| row.name)),
    };
    Problem::at(quoted(name), format!("unknown command: {near}"))
}

impl TryFrom<Choice> for Place {
    type Error = &'static str;

    fn try_from(choice: Choice) -> Result<Self, Self::Error> {
        match choice {
            Choice::Number(step) => Ok(Self::Step(step)),
            Choice::Word(text) => Self::parse(&text).ok_or("must be a step or a time"),
        }
    }
}

impl From<Place> for Choice {
    fn from(place: Place) -> Self {
        match place {
            Place::Step(step) => Self::Number(step.min(i64::MAX as u64)), // TOML has no larger one
            Place::Time(time_s) => Self::Word(format!("{time_s} s")),
            Place::Start => Self::Word("start".to_owned()),
            Place::End => Self::Word("end".to_owned()),
        }
    }
}

impl Place {
    /// A step (421, 1e7), a time (12.5 s), start or end.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if let Some(time) = text.strip_suffix('s') {
            let time_s: f64 = time.trim().parse().ok()?;
            return Some(Self::Time(time_s)).filter(|_| time_s >= 0.0 && time_s.is_finite());
        }
        match text {
            "start" => Some(Self::Start),
            "end" => Some(Self::End),
            _ => whole(text).map(Self::Step),
        }
    }
}

/// A whole number, also as 1e7.
fn whole(text: &str) -> Option<u64> {
    /// Floats are exact whole numbers up to here.
    const EXACT: f64 = 9e15;
    let is_whole = |number: &f64| number.fract() == 0.0 && (0.0..=EXACT).contains(number);
    let float = || text.parse().ok().filter(is_whole);
    text.parse().ok().or_else(|| Some(float()? as u64))
}
