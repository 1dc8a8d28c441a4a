//! A command: one thing that a user can do to the lab, as a value. Keys and dialogs lead to commands, and files of
//! commands (`--do`) contain them.
//!
//! A file of commands is a list of `[[do]]` tables with one command each. The [table](COMMANDS) lists every command with
//! its name, its value and its effect; [`read`] and the manual use it.

mod exporting;
mod looking;
mod reading;
mod table;
mod write;

pub use table::{COMMANDS, CommandRow};

use crate::export::Layout;
use crate::lab::view::step::Page;
use crate::lab::view::{Pane, Part};
use crate::observe::camera::{Camera, Zoom};
use crate::observe::pace::Speed;
use crate::observe::recording::Curve;
use crate::scenario::dotted::join;
use crate::scenario::problem::nearest;
use crate::scenario::{Document, Problem, Problems};
use crate::work::expression::Expression;
use crate::work::next_push::Toward;
use std::path::Path;
use toml::{Table, Value};

pub const MOST_MAGNIFIED: f64 = 1e6;
/// What stands for the absence of a choice, and for turns of the tilt, in files.
const NONE: &str = "none";
const NEXT_TURN: &str = "next turn";
const TURN_BEFORE: &str = "turn before";

#[derive(Clone, Debug, PartialEq)]
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
    Run,
    Pause,
    /// Lets the next command of the script wait for this many seconds.
    Wait(f64),
    /// Begins a part of the script that has this title.
    Chapter(String),
    Undo(u32),
    /// Does this many undone acts again.
    Redo(u32),
    /// Writes the run up to here as CSV.
    Export {
        path: String,
        layout: Layout,
        /// Up to this step instead of the present one.
        to_step: Option<u64>,
        /// Whether an existing file is replaced.
        force: bool,
    },
    /// Draws the run up to here.
    Figure {
        /// The file; its name's end says in which form.
        path: String,
        /// What it shows: traces, above, 3d, or columns.
        kind: String,
        /// Whether the exact motion is drawn beside it.
        exact: bool,
        /// Up to this step instead of the present one.
        to_step: Option<u64>,
        /// Whether an existing file is replaced.
        force: bool,
    },
    /// Writes the run up to here as a run file, or the present state as a scenario.
    Save {
        path: String,
        /// Whether the file is a scenario that starts from the present state.
        from_here: bool,
        /// Of a run file: up to this step instead of the present one.
        to_step: Option<u64>,
        /// Whether an existing file is replaced.
        force: bool,
    },
    Speed(Speed),
    LookAt(String),
    /// The line about what to try after the run.
    Next(String),
    /// Length of time that the traces show, s.
    Window(f64),
    /// Length of time that the strip of the fast motion shows, s.
    Detail(f64),
    /// What that strip shows; `None`: the motion tells.
    DetailOf(Option<Curve>),
    /// Time at the left edge of the traces, s; `None`: they follow the run.
    Since(Option<f64>),
    /// How many times the values of the traces are magnified.
    Magnify(f64),
    /// The step at which the traces are read off.
    Cursor(CursorTo),
    /// Whether the exact motion is drawn beside the run.
    Exact(bool),
    /// Puts these measured data beside the run, or none.
    Measured(Option<String>),
    /// Whether measured data are shown less what the run says.
    Residuals(bool),
    /// Begins the run anew with the time step or scheme that mends doubtful numbers.
    TakeAdvice,
    /// Whether the present run is pinned as the reference; false: no run is.
    Pin(bool),
    /// The panes that share the screen; none: as many as there is room for.
    Show(Vec<Pane>),
    Hide(Vec<Part>),
    Fill(Option<Pane>),
    Phase(Page),
    /// How many rows of a table the step pane adds up; `None`: all.
    SumTo(Option<usize>),
    PointAt(Option<Pane>),
    Bare(bool),
    /// The direction from which the 3-D view is seen.
    Camera(Camera),
    /// How large the round pictures show what they show.
    Zoom(Zoom),
}

/// The values of a push that a command gives. The push to come has the others.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct PushChoice {
    pub point: Option<String>,
    pub force_N: Option<Force>,
    /// Direction of the force, if `force_N` is only a size.
    pub toward: Option<Toward>,
    pub for_s: Option<f64>,
}

/// A force, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    Size(f64),
    /// The force itself, world frame.
    Vector([f64; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    Step(u64),
    /// The one at this time, s.
    Time(f64),
    Start,
    End,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CursorTo {
    /// To a step or a time that the run has reached.
    Place(Place),
    /// To the next step at which the tilt turns up or down.
    NextTurn,
    TurnBefore,
    /// Off the traces.
    Nowhere,
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
        match COMMANDS.iter().find(|row| row.name == name) {
            Some(row) => row.read(value),
            None => Err(vec![unknown(name, None)]),
        }
    }

    /// Its name and the value behind it, as TOML.
    pub fn to_table(&self) -> Table {
        let (name, value) = write::written(self);
        Table::from_iter([(name.to_owned(), value)])
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
    let Value::Table(table) = value else {
        return Err(vec![Problem::with_value(here, value, "must be a table")]);
    };
    let under = |problem: Problem| Problem {
        key: format!("{here}.{}", problem.key),
        ..problem
    };
    let names: Vec<&String> = table.keys().collect();
    let wrong = names
        .iter()
        .filter(|name| !COMMANDS.iter().any(|row| row.name == name.as_str()));
    let beside = COMMANDS.iter().find(|row| table.contains_key(row.name));
    let wrong: Vec<_> = wrong.map(|name| under(unknown(name, beside))).collect();
    if !wrong.is_empty() {
        return Err(wrong);
    }
    match table.iter().collect::<Vec<_>>()[..] {
        [(name, value)] => {
            let inside = |problem: Problem| Problem {
                key: join(name, &problem.key).trim_end_matches('.').to_owned(),
                ..problem
            };
            let under_name = |problem| under(inside(problem));
            Command::new(name, value)
                .map_err(|problems| problems.into_iter().map(under_name).collect())
        }
        [] => {
            let rule = "holds no command: there is gyrolab man for their names";
            Err(vec![Problem::at(here, rule)])
        }
        _ => {
            let names: Vec<_> = names.iter().map(|name| name.as_str()).collect();
            let rule = format!(
                "holds {}: one command each, the next in a [[do]] of its own",
                names.join(", ")
            );
            Err(vec![Problem::at(here, rule)])
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
    let key = if name.contains('.') {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    };
    Problem::at(key, format!("unknown command: {near}"))
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
pub(super) fn whole(text: &str) -> Option<u64> {
    /// Floats are exact whole numbers up to here.
    const EXACT: f64 = 9e15;
    let float = || {
        text.parse()
            .ok()
            .filter(|number: &f64| number.fract() == 0.0 && (0.0..=EXACT).contains(number))
    };
    text.parse().ok().or_else(|| Some(float()? as u64))
}
