//! Rows that somebody's own program of the report's scheme has written, held against the scheme: do they agree, and if not,
//! which slip has made them?
//!
//! `rows` reads the file, `times` finds the time step of each row, `follow` compares them with a run. `step` has the
//! report's step in plain code, `slips` the table of slips, `plan` what it begins with, `explain` the search among them.
//! `words` says what has come out.

mod arithmetic;
mod explain;
mod follow;
mod plan;
pub mod rows;
mod slips;
mod step;
mod times;
mod words;

use crate::run::Simulation;
use crate::scenario::{Problem, Problems, Scenario};
use explain::{Explanation, Search};
use follow::{Followed, OFFSETS, Scheme, Single, Twin, follow};
use plan::Plan;
pub use rows::Rows;
use serde::Serialize;
use slips::Changes;
use std::sync::Arc;
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
}

/// Why nothing has come out.
#[derive(Debug)]
pub enum Uncompared {
    Refused(Problems),
    Stopped,
}

impl From<Problems> for Uncompared {
    fn from(problems: Problems) -> Self {
        Self::Refused(problems)
    }
}

/// What was found, before it is put into words.
struct Found<'a> {
    name: &'a str,
    scenario: &'a Arc<Scenario>,
    rows: &'a Rows,
    /// The rows beside the scheme, to the end of the file.
    beside: Followed,
    is_single: bool,
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
) -> Result<Verdict, Uncompared> {
    let plan = Plan::of(scenario);
    let beside = |offsets: &[i64], to_end| beside(rows, scenario, plan.as_ref(), offsets, to_end);
    let along = beside(&OFFSETS, false);
    if along.differs.is_none() && along.agreeing == 0 {
        return Err(nothing_compared(&along).into());
    }
    let mut found = Found {
        name,
        scenario,
        rows,
        beside: along,
        is_single: false,
        explanations: Vec::new(),
        closest: None,
        unseen: Vec::new(),
        has_plan: plan.is_some(),
        has_pairs: false,
    };
    if let Some(plan) = &plan {
        found.explain(plan, go_on);
        let own = of_scheme(rows, plan, found.beside.offset);
        found.unseen = explain::hidden(plan, &own, found.beside.parted, go_on);
    }
    if found.beside.differs.is_some() {
        found.beside = beside(&[found.beside.offset], true);
    }
    if !go_on() {
        return Err(Uncompared::Stopped);
    }
    Ok(found.verdict())
}

impl Found<'_> {
    /// Looks for what makes the rows, where they differ from the scheme: a slip, single precision, two slips.
    fn explain(&mut self, plan: &Plan, go_on: &(dyn Fn() -> bool + Sync)) {
        let rows = self.rows;
        let Some(differs) = self.beside.differs else {
            return; // numbers that are not finite after rows of the scheme's own are no slip's
        };
        let search = Search {
            plan,
            rows,
            first: (differs.row, differs.step),
            go_on,
        };
        let (found, close) = search.alone();
        (self.explanations, self.closest) = (found, close.into_iter().next());
        if self.explanations.is_empty() && rows.not_finite.is_none() {
            let single = single(rows, self.scenario, plan);
            self.is_single = single.is_whole();
            if self.is_single {
                self.beside = single;
            }
        }
        self.has_pairs = search.can_try_pairs();
        if self.explanations.is_empty() && !self.is_single && self.has_pairs {
            let (found, close) = search.in_pairs();
            self.explanations = found;
            let closest = self.closest.take();
            self.closest = closest.or(close.into_iter().next());
        }
    }
}

fn nothing_compared(beside: &Followed) -> Problems {
    let rule = match beside.parted {
        Some(step) => format!(
            "has no row that can be compared: from step {step} on rounding decides about the motion"
        ),
        None => "has no row of a step that there is: steps count from 0".to_owned(),
    };
    Problems::one("", Problem::at("", rule))
}

/// The rows beside the scheme's run.
fn beside(
    rows: &Rows,
    scenario: &Arc<Scenario>,
    plan: Option<&Plan>,
    offsets: &[i64],
    to_end: bool,
) -> Followed {
    let none = Changes::default();
    let other = plan.map(|plan| Program::<f64>::new(plan, &none, Order::Forward));
    let mut run = Twin(Scheme(Simulation::new(Arc::clone(scenario))), other);
    follow(rows, &rows.times.steps, &mut run, offsets, to_end)
}

/// The rows beside the scheme's run, with as much room as single precision needs. They differ where they cannot be of that
/// precision: where no column holds numbers of it alone.
fn single(rows: &Rows, scenario: &Arc<Scenario>, plan: &Plan) -> Followed {
    let may_be = |(place, column): (usize, &rows::Column)| {
        rows.values
            .iter()
            .all(|row| column.may_be_single(row[place]))
            && rows
                .values
                .iter()
                .any(|row| row[place] != rows.values[0][place])
    };
    let of_single = rows.columns.iter().enumerate().any(may_be);
    if !of_single && rows.values.len() > 1 {
        return Followed::default();
    }
    let copy = |order| Program::<f32>::new(plan, &Changes::default(), order);
    let copies = [Order::Forward, Order::Backward, Order::EvenThenOdd].map(copy);
    let scheme = Scheme(Simulation::new(Arc::clone(scenario)));
    let mut run = Single::new(scheme, copies);
    follow(rows, &rows.times.steps, &mut run, &OFFSETS, false)
}

/// Rows as the scheme would have written them, in the columns and to the digits of `rows`.
fn of_scheme(rows: &Rows, plan: &Plan, offset: i64) -> Rows {
    let mut own = rows.clone();
    let mut program = Program::<f64>::new(plan, &Changes::default(), Order::Forward);
    let mut values = Vec::new();
    let (mut step, stride) = (0, rows.times.steps.stride);
    let own_steps = &mut own.times.steps.of_rows;
    own_steps
        .iter_mut()
        .for_each(|of_row| *of_row += offset * stride);
    own_steps.retain(|step| *step >= 0);
    for of_row in own_steps.iter() {
        while step < *of_row {
            program.step();
            step += 1;
        }
        let row = program.row();
        values.push(
            rows.columns
                .iter()
                .map(|column| row[column.place])
                .collect(),
        );
    }
    own.values = values;
    own
}
