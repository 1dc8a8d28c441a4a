//! Rows that somebody's own program of the report's scheme has written, held against the scheme: do they agree, and if not,
//! which slip has made them?
//!
//! `rows` reads the file, `times` finds the time step of each row, `follow` compares them with a run. `step` has the
//! report's step in plain code, `slips` the table of slips, `plan` what it begins with, `explain` the search among them.
//! `words` says what has come out.

mod explain;
mod follow;
mod plan;
pub mod rows;
mod slips;
mod step;
mod times;
mod words;

use crate::physics::workings::Quantity;
use crate::run::Simulation;
use crate::scenario::presets::PRESETS;
use crate::scenario::{Document, Problem, Problems, Scenario};
use crate::verify::Unverified;
use explain::{Explanation, MOST_FOR_PAIRS, Search};
use follow::{Followed, Run, follow};
use plan::Plan;
pub use rows::Rows;
use serde::Serialize;
use slips::Changes;
use std::sync::Arc;
pub use step::TRACED;
use step::{Order, Program};

/// What has come out of the comparison, as `--json` gives it.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    pub agrees: bool,
    /// "single" where the rows agree as far as single precision can.
    pub precision: &'static str,
    /// The rows that were compared: where they differ all of the file, else those that agree.
    pub rows: usize,
    /// By how many rows the file is late.
    pub offset: i64,
    pub first_step: Option<i64>,
    /// The columns that differ there, with the values of the file and of the scheme.
    pub columns: Vec<&'static str>,
    pub yours: Vec<f64>,
    pub scheme: Vec<f64>,
    /// The largest difference of x, y, z, m.
    pub worst_m: Option<f64>,
    pub slips: Vec<Vec<&'static str>>,
    pub unseen: Vec<&'static str>,
    /// The same in words, a line each, the first of which begins behind the file's name.
    #[serde(skip)]
    pub lines: Vec<String>,
    /// Whether nothing that is known makes the rows.
    #[serde(skip)]
    pub is_unexplained: bool,
    #[serde(skip)]
    pub trial: Option<Trial>,
}

/// The program with the slip that makes the rows, as it stands before the first step at which they differ.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The step that differs.
    pub first: u64,
    program: Program<f64>,
    /// What the program does, and the slip's name.
    pub words: String,
}

impl Trial {
    /// The numbers of its step `step`, phase by phase; `None` for the steps before the first that differs, and for those so
    /// much later that they take long to compute.
    pub fn numbers(&self, step: u64) -> Option<Vec<(&'static str, Quantity)>> {
        const MOST: u64 = 1000;
        let later = step.checked_sub(self.first).filter(|later| *later < MOST)?;
        let mut program = self.program.clone();
        for _ in 0..later {
            program.step();
        }
        Some(program.numbers())
    }
}

/// What was found, before it is put into words.
struct Found<'a> {
    name: &'a str,
    scenario: &'a Arc<Scenario>,
    rows: &'a Rows,
    /// The rows beside the scheme.
    beside: Followed,
    is_single: bool,
    /// The preset whose own rows these are.
    other: Option<&'static str>,
    explanations: Vec<Explanation>,
    closest: Option<Explanation>,
    unseen: Vec<&'static str>,
    /// Whether slips could be looked for, and two together.
    has_plan: bool,
    has_pairs: bool,
}

/// Holds `rows` against the run of `scenario`, which is called `name`. `go_on` says whether to go on.
pub fn compare(
    rows: &Rows,
    name: &str,
    scenario: &Arc<Scenario>,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Verdict, Unverified> {
    let plan = Plan::of(scenario);
    let copy = |plan| Program::<f64>::new(plan, &Changes::default(), Order::Forward);
    let copies = plan.iter().map(copy).collect();
    let run = Run::of(Simulation::new(Arc::clone(scenario)), copies, false);
    let beside = follow(rows, &rows.times.steps, run);
    if beside.differs.is_none() && beside.agreeing == 0 {
        let mut rule = "has no row of a step that there is: steps count from 0".to_owned();
        if let Some(step) = beside.parted {
            rule = format!("has no row before step {step}, from which on rounding decides");
        }
        return Err(Problems::one("", Problem::at("", rule)).into());
    }
    let mut found = Found {
        name,
        scenario,
        rows,
        beside,
        is_single: false,
        other: None,
        explanations: Vec::new(),
        closest: None,
        unseen: Vec::new(),
        has_plan: plan.is_some(),
        has_pairs: false,
    };
    if let Some(plan) = &plan {
        found.explain(plan, go_on);
        if found.beside.is_whole() && !found.is_single {
            found.unseen = explain::hidden(plan, rows, found.beside.parted, go_on);
        }
    }
    if !go_on() {
        return Err(Unverified::Stopped);
    }
    Ok(Verdict {
        trial: plan.as_ref().and_then(|plan| found.trial(plan)),
        ..found.verdict()
    })
}

impl Found<'_> {
    /// Looks for what makes the rows, where they differ from the scheme: a slip, single precision, two slips.
    fn explain(&mut self, plan: &Plan, go_on: &(dyn Fn() -> bool + Sync)) {
        let rows = self.rows;
        let Some(differs) = self.beside.differs else {
            return; // numbers that are not finite after rows of the scheme's own are no slip's
        };
        self.other = self.other_preset();
        if self.other.is_some() {
            return;
        }
        let first = (differs.row, differs.step);
        let search = Search {
            plan,
            rows,
            first,
            go_on,
        };
        (self.explanations, self.closest) = search.alone();
        if self.explanations.is_empty() && rows.not_finite.is_none() {
            let single = single(rows, self.scenario, plan);
            self.is_single = single.is_whole();
            if self.is_single {
                self.beside = single;
            }
        }
        // Each pair is computed up to the first row that differs.
        self.has_pairs = differs.step <= MOST_FOR_PAIRS;
        if self.explanations.is_empty() && !self.is_single && self.has_pairs {
            let (found, close) = search.in_pairs();
            self.explanations = found;
            self.closest = self.closest.take().or(close);
        }
    }

    /// The preset with which all rows agree.
    fn other_preset(&self) -> Option<&'static str> {
        self.rows.columns.iter().find(|column| column.varies())?;
        let is_its = |scenario: Scenario| {
            let (times, dt) = (&self.rows.times, scenario.motion.time_step_s);
            let mut others = times.others.iter();
            let steps = if dt == self.scenario.motion.time_step_s {
                &times.steps
            } else {
                &others.find(|(own, _)| *own == dt)?.1
            };
            let none = Vec::<Program<f64>>::new();
            let run = Run::of(Simulation::new(scenario.into()), none, false);
            Some(follow(self.rows, steps, run))
        };
        let names = PRESETS.iter().map(|preset| preset.name);
        names.into_iter().find(|name| {
            let scenario = Document::open(name).and_then(|it| it.scenario());
            let followed = scenario.ok().and_then(is_its);
            followed.is_some_and(|it| it.is_whole() && it.agreeing == self.rows.count)
        })
    }

    /// The program that makes the rows; `None` where none does, or where its steps are others than the run's.
    fn trial(&self, plan: &Plan) -> Option<Trial> {
        let (explanation, differs) = (self.explanations.first()?, self.beside.differs?);
        let mut program = explanation.program(plan)?;
        let first = u64::try_from(differs.step.max(1)).ok()?;
        for _ in 1..first {
            program.step();
        }
        Some(Trial {
            first,
            program,
            words: format!(
                "{}: {}",
                explanation.names().join(" + "),
                words::words(explanation)
            ),
        })
    }
}

/// The rows beside the scheme's run, with as much room as single precision needs. They differ where they cannot be of that
/// precision: where no column holds numbers of it.
fn single(rows: &Rows, scenario: &Arc<Scenario>, plan: &Plan) -> Followed {
    if !rows.columns.iter().any(rows::Column::may_be_single) {
        return Followed::default();
    }
    let copy = |order| Program::<f32>::new(plan, &Changes::default(), order);
    let copies = [Order::Forward, Order::Backward, Order::EvenThenOdd].map(copy);
    let run = Simulation::new(Arc::clone(scenario));
    follow(rows, &rows.times.steps, Run::of(run, copies.into(), true))
}
