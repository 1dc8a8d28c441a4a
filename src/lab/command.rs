//! A command: one action of the user on the lab, as a value. Keys and dialogs create commands, and files of commands
//! (`--do`) contain them.
//!
//! The [table](COMMANDS) lists every command with its name, its value and its effect. The file reader and the manual
//! use it. `form` checks the values, and `file` reads the files. Each part of the lab carries out its own commands.

mod file;
mod form;

pub use file::{Commands, LocatedCommand, is_file_of_commands, open, read};
pub use form::MOST_MAGNIFIED;

use crate::engine::export::layout::LayoutFile;
use crate::engine::journal::expression::Expression;
use crate::engine::journal::next_push::Toward;
use crate::engine::scenario::file::Choice;
use crate::engine::scenario::keys::KEYS;
use crate::engine::scenario::kind::ValueKind;
use crate::engine::scenario::screen::TRACES;
use crate::engine::scenario::{Problem, Problems};
use crate::lab::playback::pace::Speed;
use crate::lab::view::{Pane, ViewSettings};
use form::ValueSchema::{self, Is, View};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::LazyLock;
use toml::{Table, Value};

/// A command. Serde reads and writes it under its name in a `[[do]]` table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Opens a preset or a file: SCENARIO as on the command line.
    Open(String),
    /// Sets dotted keys of the scenario as one edit: a single undo restores all of them.
    Set(Table),
    /// Sets dotted keys of the scenario in a new run, which is replayed to the same time.
    #[serde(skip)]
    Rerun(Table),
    /// Nudges the value of a dotted key: up, or down if `times` is negative.
    Nudge {
        /// The dotted key of a single value.
        key: String,
        /// Number of nudges, not 0. Negative numbers nudge down.
        #[serde(default = "once")]
        times: i32,
        /// True to start a new run with the value instead of changing it from the next step on.
        #[serde(default)]
        rerun: bool,
    },
    /// Pushes from the next step on.
    Push(PushChoice),
    /// Chooses the next push.
    NextPush(PushChoice),
    /// Takes this many time steps, or goes back if negative. Not 0.
    Step(i64),
    /// Goes to a step or a time, and stops there.
    GoTo(SeekTarget),
    /// Plays at the present speed until this condition holds, and stops.
    RunUntil(Expression),
    #[serde(with = "only_true")]
    Run,
    #[serde(with = "only_true")]
    Pause,
    /// Delays the next command of the script by this many seconds.
    WaitS(f64),
    /// Begins a part of the script with this title.
    Chapter(String),
    Undo(u32),
    /// Redoes this many edits.
    Redo(u32),
    Export(Export),
    Figure(Box<FigureCommand>),
    Save(Save),
    Speed(Speed),
    /// Time at the left edge of the traces, s. With `None` they follow the run.
    #[serde(with = "or_none")]
    SinceS(Option<f64>),
    /// Magnification of the traces' values.
    Magnify(f64),
    /// The step at which the traces are read.
    Cursor(CursorTo),
    /// Shows or hides the exact motion.
    Exact(bool),
    /// Shows these measured data with the run, or removes them.
    #[serde(with = "or_none")]
    Measured(Option<String>),
    /// Starts a new run with the time step or scheme that fixes unreliable numbers.
    #[serde(with = "only_true")]
    TakeAdvice,
    /// Pins the present run as the reference. With false, unpins it.
    Pin(bool),
    #[serde(with = "or_none")]
    Fill(Option<Pane>),
    #[serde(with = "or_none")]
    PointAt(Option<Pane>),
    /// Sets these keys of `[view]`, the fields of [`ViewSettings`].
    #[serde(skip)]
    Look(Table),
}

/// The name of the command that may be combined with [`RERUN`] in a table.
pub const SET: &str = "set";
/// The key that makes a `set` command in the same table start a new run.
pub const RERUN: &str = "rerun";

pub struct CommandRow {
    /// Name of the command in a `[[do]]` table.
    pub name: &'static str,
    /// Examples of its value, as TOML.
    pub value: Cow<'static, str>,
    pub about: Cow<'static, str>,
    form: ValueSchema,
}

fn row(
    name: &'static str,
    value: &'static str,
    about: &'static str,
    form: ValueSchema,
) -> CommandRow {
    CommandRow {
        name,
        value: value.into(),
        about: about.into(),
        form,
    }
}

/// All commands: the rows of `own`, and a row for each other key of `[view]`.
pub static COMMANDS: LazyLock<Vec<CommandRow>> = LazyLock::new(|| {
    let mut rows = own();
    for key in KEYS {
        let name = key.path.strip_prefix("view.").unwrap_or(".");
        if !name.contains('.') && rows.iter().all(|row| row.name != name) {
            rows.push(CommandRow {
                name,
                value: examples(key.kind).into(),
                about: key.description().into(),
                form: View(key.path),
            });
        }
    }
    rows
});

/// Returns examples of a value of this kind, as TOML.
fn examples(kind: ValueKind) -> String {
    let words = kind.words().join("\", \"");
    match kind {
        ValueKind::Flag => "true or false".to_owned(),
        ValueKind::Number(_) => "2.5".to_owned(),
        ValueKind::WholeOr(..) => format!("4, or \"{words}\""),
        ValueKind::Panes(_) => format!("[\"{words}\"]"),
        ValueKind::OneOf(_) | ValueKind::Pane(_) => format!("\"{words}\""),
        _ => "\"one line\"".to_owned(),
    }
}

/// Returns the rows of the commands that are not keys of `[view]`, or that need their own description.
#[rustfmt::skip]
fn own() -> Vec<CommandRow> {
    vec![
        row("open", "\"wobble-push\"", "open a preset or a file (SCENARIO as on the command line), paused at step 0", form::OPEN_SCHEMA),
        row("set", "{ \"motion.time_step_s\" = 0.05 }", "set dotted keys of the scenario from the next step on; keys of body and start, or any with rerun = true, begin a new run", ValueSchema::Keys),
        row("nudge", "{ key = \"motion.time_step_s\", times = -1 }", "nudge a value up, or down if times is negative; rerun = true begins a new run", form::NUDGE),
        row("push", "true, or { point = \"top\", force_N = [0, 0, -50], for_s = 2 }", "start the next push, or one with these values, now or at from_s; force_N can be a magnitude if toward = \"down\" is given", form::PUSH_SCHEMA),
        row("next_push", "{ point = \"top\", force_N = 50, toward = \"down\", for_s = 2 }", "choose the next push, or some of its values", form::NEXT_PUSH_SCHEMA),
        row("step", "10", "take this many time steps, or go back if negative", form::STEPS_SCHEMA),
        row("go_to", "400, \"60 s\", \"start\" or \"end\"", "go to a step or a time at most 10000000 steps away, and stop there", form::PLACE_SCHEMA),
        row("run_until", "\"t_s >= 60\"", "play at the set speed until this holds, and stop; give up after 10000000 steps", form::CONDITION),
        row("run", "true", "play the run", form::TRUE),
        row("pause", "true", "pause the run", form::TRUE),
        row("wait_s", "2.5", "wait this many seconds of wall-clock time before the next command", form::WAIT),
        row("chapter", "\"one line\"", "show this line; a recording (gyrolab cast) has a marker there", Is(ValueKind::Line)),
        row("undo", "1", "undo this many edits", form::COUNT_SCHEMA),
        row("redo", "1", "redo this many edits", form::COUNT_SCHEMA),
        row("export", "\"run.csv\", or { path = \"run.csv\", every = 10, force = true }", "write the run up to the present step or to_step as CSV; force replaces a file; columns, from_s, to_s, points and excel as in gyrolab run", form::EXPORT),
        row("figure", "\"run.pdf\", or { path = \"run.svg\", kind = \"above\", exact = true, force = true }", "draw the run up to the present step or to_step; kind as in gyrolab figure; the extension is .svg, .pdf or .png", form::FIGURE),
        row("save", "\"run.toml\", or { path = \"run.toml\", from_here = true, force = true }", "write the run up to the present step or to_step as a run file; from_here writes the present state as a scenario", form::SAVE),
        row("speed", "20 or \"top\"", "playback speed, simulated seconds per second", form::SPEED_SCHEMA),
        row("since_s", "12.5, or \"none\"", "time at the left edge of the traces, s; with none they follow the run", form::SINCE),
        row("magnify", "4", "magnification of the traces' values, 1 to 1000000", form::MAGNIFY),
        row("cursor", "400, \"60 s\", \"next turn\", \"turn before\", \"mark\" or \"none\"", "the step at which the traces are read; a turn is a turning point of the tilt; mark marks it, or counts the swings since the marked one", form::CURSOR_SCHEMA),
        row("measured", "\"heidelberg-spin-decay\", \"data.csv\" or \"none\"", "show measured data with the run: data shipped with gyrolab, or a CSV file with a column t_s", View("view.measured")),
        row("pin", "true or false", "pin the present run as the reference, which stays visible; false unpins it", Is(ValueKind::Flag)),
        row("take_advice", "true", "rerun to the same time with the time step or scheme that makes unreliable numbers reliable", form::TRUE),
        row("point_at", "\"above\"", "the pane that gets a heavy frame, or \"none\"", View("view.fill")),
        row("camera", "{ yaw_deg = 30, pitch_deg = 20 }", "direction from which the 3-D view is seen", View("view.camera")),
        row("zoom", "{ above = 4, 3d = 2 }", "magnification of the path from above and of the 3-D view", View("view.zoom")),
    ]
}

fn once() -> i32 {
    1
}

fn traces() -> String {
    TRACES.to_owned()
}

/// Writes the run up to a step as CSV.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Export {
    pub path: String,
    #[serde(flatten)]
    pub layout: LayoutFile,
    /// Last step of the run in the file; the present step if `None`.
    pub to_step: Option<u64>,
    /// True to replace an existing file.
    #[serde(default)]
    pub force: bool,
}

/// Draws the run up to a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureCommand {
    /// The file. Its extension selects the format.
    pub path: String,
    /// The name of a [`FigureKind`](crate::report::figure::kind::FigureKind).
    #[serde(default = "traces")]
    pub kind: String,
    /// True to draw the exact motion too.
    #[serde(default)]
    pub exact: bool,
    /// Last step of the run in the figure; the present step if `None`.
    pub to_step: Option<u64>,
    /// True to replace an existing file.
    #[serde(default)]
    pub force: bool,
}

/// Writes the run up to a step as a run file, or the present state as a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Save {
    pub path: String,
    /// True to write a scenario that starts from the present state.
    #[serde(default)]
    pub from_here: bool,
    /// Last step of the run in a run file; the present step if `None`.
    pub to_step: Option<u64>,
    /// True to replace an existing file.
    #[serde(default)]
    pub force: bool,
}

/// The values of a push that a command sets. The next push supplies the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct PushChoice {
    pub point: Option<String>,
    pub force_N: Option<Force>,
    /// Direction of the force, if `force_N` is a magnitude.
    pub toward: Option<Toward>,
    /// Start time, s; 0 means now.
    pub from_s: Option<f64>,
    pub for_s: Option<f64>,
}

/// A force, N.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Force {
    Size(f64),
    /// Components in the world frame.
    Vector([f64; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Choice", into = "Choice")]
pub enum SeekTarget {
    Step(u64),
    /// The step at this time, s.
    Time(f64),
    Start,
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CursorTo {
    /// The next turning point of the tilt.
    #[serde(rename = "next turn")]
    NextTurn,
    #[serde(rename = "turn before")]
    TurnBefore,
    /// Marks the turning point at the cursor. If another one is marked already, counts the swings between the two.
    #[serde(rename = "mark")]
    Mark,
    /// No cursor.
    #[serde(rename = "none")]
    Nowhere,
    /// A step or a time that the run has reached.
    #[serde(untagged)]
    Place(SeekTarget),
}

/// Serde functions for a command without a value, which is written as `true`.
mod only_true {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        true.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        bool::deserialize(deserializer).map(|_| ())
    }
}

/// Serde functions for an optional value, which is written as the word `none` if absent.
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

impl Command {
    /// Parses the command `name` with `value`.
    ///
    /// # Errors
    /// Returns every rule that the value breaks. The keys of the problems begin with the name.
    pub fn new(name: &str, value: &Value) -> Result<Self, Problems> {
        let Some(row) = COMMANDS.iter().find(|row| row.name == name) else {
            return Err(file::unknown(name, None).into());
        };
        let whole = row.form.check(name, value)?;
        let table = Table::from_iter([(name.to_owned(), whole.clone())]);
        if ViewSettings::has(name) {
            return Ok(Self::Look(table));
        }
        let command = table.try_into();
        let command: Self = command
            .map_err(|error: toml::de::Error| Problem::with_value(name, value, error.message()))?;
        form::check_together(&command).map_err(|problem| {
            let value = whole.get(&problem.key).unwrap_or(value);
            Problem::with_value(problem.key, value, problem.rule).inside(name)
        })?;
        Ok(command)
    }

    /// Turns a `set` command into one that starts a new run if `rerun`, the value of [`RERUN`] in its table, is true.
    ///
    /// # Errors
    /// Returns an error if `rerun` is not a boolean.
    pub fn with_rerun(self, rerun: Option<&Value>) -> Result<Self, Problems> {
        match (self, rerun.map(|value| (value, value.as_bool()))) {
            (Self::Set(keys), Some((_, Some(true)))) => Ok(Self::Rerun(keys)),
            (_, Some((value, None))) => {
                Err(Problem::with_value(RERUN, value, "must be true or false").into())
            }
            (command, _) => Ok(command),
        }
    }

    /// Returns the command that sets the key `name` of `[view]` to `value`.
    pub fn look(name: &str, value: impl Serialize) -> Self {
        let value = Value::try_from(value).ok();
        let entry = value.map(|value| (name.to_owned(), value));
        Self::Look(entry.into_iter().collect())
    }

    /// Returns the value of the key `name` of `[view]` if the command sets it.
    pub fn looked(&self, name: &str) -> Option<&Value> {
        match self {
            Self::Look(table) => table.get(name),
            _ => None,
        }
    }

    /// Returns the name of the command in a `[[do]]` table.
    pub fn name(&self) -> String {
        let table = self.to_table();
        let mut names = table.keys().filter(|name| *name != RERUN);
        names.next().cloned().unwrap_or_default()
    }

    /// Returns the table with the command's name and value, as in a `[[do]]` table.
    pub fn to_table(&self) -> Table {
        match (self, Value::try_from(self)) {
            (Self::Look(table), _) => table.clone(),
            (Self::Rerun(keys), _) => Table::from_iter([
                (SET.to_owned(), keys.clone().into()),
                (RERUN.to_owned(), true.into()),
            ]),
            (_, Ok(Value::Table(table))) => table,
            _ => Table::new(), // unreachable: TOML can write every command
        }
    }
}

impl TryFrom<Choice> for SeekTarget {
    type Error = &'static str;

    fn try_from(choice: Choice) -> Result<Self, Self::Error> {
        match choice {
            Choice::Number(step) => Ok(Self::Step(step)),
            Choice::Word(text) => Self::parse(&text).ok_or("must be a step or a time"),
        }
    }
}

impl From<SeekTarget> for Choice {
    fn from(place: SeekTarget) -> Self {
        match place {
            SeekTarget::Step(step) => Self::Number(step.min(i64::MAX as u64)), // the largest integer of TOML
            SeekTarget::Time(time_s) => Self::Word(format!("{time_s} s")),
            SeekTarget::Start => Self::Word("start".to_owned()),
            SeekTarget::End => Self::Word("end".to_owned()),
        }
    }
}

impl SeekTarget {
    /// Parses a step (421, 1e7), a time (12.5 s), `start` or `end`.
    pub fn parse(text: &str) -> Option<Self> {
        match text.trim() {
            "start" => Some(Self::Start),
            "end" => Some(Self::End),
            place => match place.strip_suffix('s') {
                None => whole(place).map(Self::Step),
                Some(time) => {
                    let time_s: f64 = time.trim().parse().ok()?;
                    (time_s >= 0.0 && time_s.is_finite()).then_some(Self::Time(time_s))
                }
            },
        }
    }
}

/// Parses a whole number, also in the form 1e7.
fn whole(text: &str) -> Option<u64> {
    /// Largest argument for which every whole number is an exact float.
    const LARGEST_WHOLE_ARGUMENT: f64 = 9e15;
    if let Ok(whole) = text.parse() {
        return Some(whole);
    }
    let number: f64 = text.parse().ok()?;
    let is_whole = number.fract() == 0.0 && (0.0..=LARGEST_WHOLE_ARGUMENT).contains(&number);
    is_whole.then_some(number as u64)
}
