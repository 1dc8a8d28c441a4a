//! A command: one thing that a user can do to the lab, as a value. Keys and dialogs lead to commands, and files of
//! commands (`--do`) contain them.
//!
//! The [table](COMMANDS) lists every command with its name, its value and its effect; the reading of files and the manual
//! use it. Each part of the lab carries its own commands out.

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

/// A command; serde reads and writes it under its name in a `[[do]]` table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Opens a preset or a file: SCENARIO as on the command line.
    Open(String),
    /// Sets dotted keys of the scenario, as one act: one undo takes all of them back.
    Set(Table),
    /// Sets dotted keys of the scenario in a new run, which is played to the same time.
    #[serde(skip)]
    Rerun(Table),
    /// Nudges the value of a dotted key: up, or down where `times` is negative.
    Nudge {
        /// The key, of a single value.
        key: String,
        /// How often; negative: downwards. Not 0.
        #[serde(default = "once")]
        times: i32,
        /// Whether a new run begins with the value, instead of a change from the next step on.
        #[serde(default)]
        rerun: bool,
    },
    /// Pushes from the next step on.
    Push(PushChoice),
    /// Chooses the push to come.
    NextPush(PushChoice),
    /// Takes this many time steps, or goes back by as many where that is negative. Not 0.
    Step(i64),
    /// Goes to a step or a time, and stops there.
    GoTo(SeekTarget),
    /// Plays at the present speed until this condition holds, and stops there.
    RunUntil(Expression),
    #[serde(with = "only_true")]
    Run,
    #[serde(with = "only_true")]
    Pause,
    /// Lets the next command of the script wait for this many seconds.
    WaitS(f64),
    /// Begins a part of the script that has this title.
    Chapter(String),
    Undo(u32),
    /// Does this many undone acts again.
    Redo(u32),
    Export(Export),
    Figure(Box<FigureCommand>),
    Save(Save),
    Speed(Speed),
    /// Time at the left edge of the traces, s; `None`: they follow the run.
    #[serde(with = "or_none")]
    SinceS(Option<f64>),
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
    /// Shows the run as these keys of `[view]` say: those of [`ViewSettings`].
    #[serde(skip)]
    Look(Table),
}

/// The command of a file beside which [`RERUN`] may be.
pub const SET: &str = "set";
/// `rerun = true` beside `set` begins a new run.
pub const RERUN: &str = "rerun";

pub struct CommandRow {
    /// Its name in a `[[do]]` table.
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

/// Every command: those of `own`, and a row for each other key of `[view]`.
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

/// Examples of a value of this kind, as TOML.
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

/// The commands that are no key of `[view]`, or are said in words of their own.
#[rustfmt::skip]
fn own() -> Vec<CommandRow> {
    vec![
        row("open", "\"wobble-push\"", "open a preset or a file, SCENARIO as on the command line; it stands still at step 0", form::OPEN_SCHEMA),
        row("set", "{ \"motion.time_step_s\" = 0.05 }", "set dotted keys of the scenario, from the next step on; of body or start in a new run; rerun = true beside it begins a new run with any of them", ValueSchema::Keys),
        row("nudge", "{ key = \"motion.time_step_s\", times = -1 }", "nudge a value up, or down where times is negative; rerun = true in it begins a new run", form::NUDGE),
        row("push", "true, or { point = \"top\", force_N = [0, 0, -50], for_s = 2 }", "give the push to come, or one of one's own, from now on or from_s; force_N can be a size beside toward = \"down\"", form::PUSH_SCHEMA),
        row("next_push", "{ point = \"top\", force_N = 50, toward = \"down\", for_s = 2 }", "choose the push to come, or a part of it", form::NEXT_PUSH_SCHEMA),
        row("step", "10", "take so many time steps, or go so many back", form::STEPS_SCHEMA),
        row("go_to", "400, \"60 s\", \"start\" or \"end\"", "go to a step or a time at most 10000000 steps away and stop there", form::PLACE_SCHEMA),
        row("run_until", "\"t_s >= 60\"", "play at the speed that is set until this holds, and stop; given up after 10000000 steps", form::CONDITION),
        row("run", "true", "let the run go on", form::TRUE),
        row("pause", "true", "stop the run", form::TRUE),
        row("wait_s", "2.5", "let so many seconds pass on the clock before the next command", form::WAIT),
        row("chapter", "\"one line\"", "say this line; a recording (gyrolab cast) has a marker there", Is(ValueKind::Line)),
        row("undo", "1", "take back so many of the things done last", form::COUNT_SCHEMA),
        row("redo", "1", "bring so many of them again", form::COUNT_SCHEMA),
        row("export", "\"run.csv\", or { path = \"run.csv\", every = 10, force = true }", "write the run up to here, or to_step, as CSV; force replaces a file; columns, from_s, to_s, points and excel are those of gyrolab run", form::EXPORT),
        row("figure", "\"run.pdf\", or { path = \"run.svg\", kind = \"above\", exact = true, force = true }", "draw the run up to here, or to_step; kind as in gyrolab figure, and the file's end says .svg, .pdf or .png", form::FIGURE),
        row("save", "\"run.toml\", or { path = \"run.toml\", from_here = true, force = true }", "write the run up to here, or to_step, as a run file; from_here: the present state as a scenario", form::SAVE),
        row("speed", "20 or \"top\"", "how fast the run is played, simulated seconds a second", form::SPEED_SCHEMA),
        row("since_s", "12.5, or \"none\"", "time at the left edge of the traces, s; none: they follow the run", form::SINCE),
        row("magnify", "4", "how many times the values of the traces are magnified, 1 to 1000000", form::MAGNIFY),
        row("cursor", "400, \"60 s\", \"next turn\", \"turn before\", \"mark\" or \"none\"", "the step at which the traces are read off; turns are those of the tilt; mark: mark this one, and from one that is marked count the swings", form::CURSOR_SCHEMA),
        row("measured", "\"heidelberg-spin-decay\", \"data.csv\" or \"none\"", "put measured data beside the run: data that come with gyrolab, or a CSV file with a column t_s", View("view.measured")),
        row("pin", "true or false", "pin the present run as the reference, which stays in view; false: none is pinned", Is(ValueKind::Flag)),
        row("take_advice", "true", "begin the run anew at the time step, or by the scheme, that mends doubtful numbers, up to the same time", form::TRUE),
        row("point_at", "\"above\"", "the pane that is pointed at, by a heavy frame, or \"none\"", View("view.fill")),
        row("camera", "{ yaw_deg = 30, pitch_deg = 20 }", "from where the 3-D view is seen", View("view.camera")),
        row("zoom", "{ above = 4, 3d = 2 }", "how much larger than the whole the path from above and the 3-D view are shown", View("view.zoom")),
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
    /// Up to this step instead of the present one.
    pub to_step: Option<u64>,
    /// Whether an existing file is replaced.
    #[serde(default)]
    pub force: bool,
}

/// Draws the run up to a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureCommand {
    /// The file; its name's end says in which form.
    pub path: String,
    /// The name of a [`FigureKind`](crate::report::figure::kind::FigureKind).
    #[serde(default = "traces")]
    pub kind: String,
    /// Whether the exact motion is drawn beside the run.
    #[serde(default)]
    pub exact: bool,
    /// Up to this step instead of the present one.
    pub to_step: Option<u64>,
    /// Whether an existing file is replaced.
    #[serde(default)]
    pub force: bool,
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
    /// When it begins, s; 0 for now.
    pub from_s: Option<f64>,
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
pub enum SeekTarget {
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
    /// Stays, and marks its turn; from a mark at another turn, the swings between are counted.
    #[serde(rename = "mark")]
    Mark,
    /// Off the traces.
    #[serde(rename = "none")]
    Nowhere,
    /// To a step or a time that the run has reached.
    #[serde(untagged)]
    Place(SeekTarget),
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

impl Command {
    /// The command called `name` with `value`.
    ///
    /// # Errors
    /// Every rule that the value breaks; the keys of the problems begin with the name.
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

    /// Returns the command `set` as one that begins a new run, if `rerun`, the value of [`RERUN`] beside it, says so.
    ///
    /// # Errors
    /// If `rerun` is no truth value.
    pub fn with_rerun(self, rerun: Option<&Value>) -> Result<Self, Problems> {
        match (self, rerun.map(|value| (value, value.as_bool()))) {
            (Self::Set(keys), Some((_, Some(true)))) => Ok(Self::Rerun(keys)),
            (_, Some((value, None))) => {
                Err(Problem::with_value(RERUN, value, "must be true or false").into())
            }
            (command, _) => Ok(command),
        }
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

    /// Its name in a `[[do]]` table.
    pub fn name(&self) -> String {
        let table = self.to_table();
        let mut names = table.keys().filter(|name| *name != RERUN);
        names.next().cloned().unwrap_or_default()
    }

    /// Its name and the value behind it, as TOML.
    pub fn to_table(&self) -> Table {
        match (self, Value::try_from(self)) {
            (Self::Look(table), _) => table.clone(),
            (Self::Rerun(keys), _) => Table::from_iter([
                (SET.to_owned(), keys.clone().into()),
                (RERUN.to_owned(), true.into()),
            ]),
            (_, Ok(Value::Table(table))) => table,
            _ => Table::new(), // a command holds nothing that TOML cannot write
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
            SeekTarget::Step(step) => Self::Number(step.min(i64::MAX as u64)), // TOML has no larger one
            SeekTarget::Time(time_s) => Self::Word(format!("{time_s} s")),
            SeekTarget::Start => Self::Word("start".to_owned()),
            SeekTarget::End => Self::Word("end".to_owned()),
        }
    }
}

impl SeekTarget {
    /// A step (421, 1e7), a time (12.5 s), start or end.
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

/// A whole number, also as 1e7.
fn whole(text: &str) -> Option<u64> {
    /// Floats are exact whole numbers up to here.
    const LARGEST_WHOLE_ARGUMENT: f64 = 9e15;
    if let Ok(whole) = text.parse() {
        return Some(whole);
    }
    let number: f64 = text.parse().ok()?;
    let is_whole = number.fract() == 0.0 && (0.0..=LARGEST_WHOLE_ARGUMENT).contains(&number);
    is_whole.then_some(number as u64)
}
