//! The check of a reader's own program of the report's scheme: compares its rows with the scheme, and finds the mistake
//! that explains a difference. The code calls a common mistake a slip.
//!
//! - `rows` reads the file, and `times` finds the time step of each row.
//! - `follow` compares the rows with a run.
//! - `step` is the report's step in plain code, which `slips` can change. Add a new mistake to the table in `slips`.
//! - `plan` holds the body and the start of a program. `explain` searches for the mistakes.
//! - `words` describes the result.

mod explain;
mod follow;
mod plan;
pub mod rows;
mod slips;
mod step;
mod times;
mod words;

use crate::engine::run::Simulation;
use crate::engine::scenario::presets::PRESETS;
use crate::engine::scenario::{Document, Problem, Problems, Scenario};
use crate::physics::workings::{PhaseName, WorkedQuantity};
use crate::studies::verify::Unverified;
use explain::{Explanation, MOST_FOR_PAIRS, Search};
use follow::{ReferenceRun, Rounding, RowAgreement, compare_rows};
use plan::Plan;
pub use rows::ProgramRows;
use rows::{ProgramColumn, SINGLE_DIGITS};
use serde::Serialize;
use slips::Mutations;
use std::sync::Arc;
pub use step::TRACED_SYMBOL;
use step::{MutantStepper, Order};

/// The floating-point precision of a program, as far as its rows show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    Double,
    Single,
    Unknown,
}

/// Number of explanations found for the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Explanations {
    Unique,
    /// Several explanations, or one that the rows do not prove.
    Several,
    None,
}

/// Result of the comparison, as printed by `--json`.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    pub agrees: bool,
    pub precision: Precision,
    /// Significant digits of the least precise column.
    pub digits: i32,
    /// Number of compared rows: all rows of the file if they differ, else the rows that agree.
    pub rows: usize,
    /// Number of rows that agree with the scheme, or with the first explanation. Without either, the rows up to the
    /// first difference.
    pub rows_compared: usize,
    /// Number of rows by which the file is late.
    pub offset: i64,
    pub first_step: Option<i64>,
    /// The columns that differ at `first_step`, with the file's and the scheme's values.
    pub columns: Vec<&'static str>,
    pub yours: Vec<f64>,
    pub scheme: Vec<f64>,
    /// Largest difference of x, y, z; m.
    pub worst_m: Option<f64>,
    pub explanations: Explanations,
    pub slips: Vec<Vec<&'static str>>,
    pub unseen: Vec<&'static str>,
    /// The result in words, one line each. The first line follows the file's name.
    #[serde(skip)]
    pub lines: Vec<String>,
    /// True if no known mistake explains the rows.
    #[serde(skip)]
    pub is_unexplained: bool,
    #[serde(skip)]
    pub trial: Option<SlipTrial>,
}

/// The program with the mistake that explains the rows, before the first step that differs.
#[derive(Clone, Debug)]
pub struct SlipTrial {
    /// The first step that differs.
    pub first: u64,
    program: MutantStepper<f64>,
    /// The slip's name, and a description of the program's behavior.
    pub words: String,
}

impl SlipTrial {
    /// Returns the numbers of the program's step `step`, phase by phase. Returns `None` for steps before the first
    /// difference, and for steps so late that they take long to compute.
    pub fn numbers(&self, step: u64) -> Option<Vec<(PhaseName, WorkedQuantity)>> {
        const MOST_OFFSET_ROWS: u64 = 1000;
        let later = step
            .checked_sub(self.first)
            .filter(|later| *later < MOST_OFFSET_ROWS)?;
        let mut program = self.program.clone();
        for _ in 0..later {
            program.step();
        }
        Some(program.numbers())
    }
}

/// Findings of the comparison, before they are put into words.
struct CheckOutcome<'a> {
    name: &'a str,
    scenario: &'a Arc<Scenario>,
    rows: &'a ProgramRows,
    /// Agreement of the rows with the scheme.
    beside: RowAgreement,
    precision: Precision,
    /// True if the rows agree only within single precision, or within their few digits.
    is_lenient: bool,
    /// The preset that produces these rows, if it is not the scenario.
    other: Option<&'static str>,
    explanations: Vec<Explanation>,
    /// True if the rows prove the only explanation.
    is_proved: bool,
    closest: Option<Explanation>,
    unseen: Vec<&'static str>,
    /// True if a search for slips is possible. `has_pairs` is true if pairs of slips were tried too.
    has_plan: bool,
    has_pairs: bool,
}

/// Compares `rows` with the run of `scenario`, which is called `name`. The computation stops if `go_on` returns false.
///
/// # Errors
/// Returns an error if no row can be compared, or if `go_on` stopped the computation.
pub fn compare(
    rows: &ProgramRows,
    name: &str,
    scenario: &Arc<Scenario>,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Verdict, Unverified> {
    let plan = Plan::from_scenario(scenario);
    let copies = plan
        .iter()
        .map(|plan| MutantStepper::<f64>::new(plan, &Mutations::default(), Order::Forward))
        .collect();
    let run = ReferenceRun::new(
        Simulation::new(Arc::clone(scenario)),
        copies,
        Rounding::Double,
    );
    let beside = compare_rows(rows, &rows.times.steps, run);
    if beside.differs.is_none() && beside.agreeing == 0 {
        let mut rule = "has no row of an existing step: steps count from 0".to_owned();
        if let Some(step) = beside.parted {
            rule = format!("has no row before step {step}, where rounding errors take over");
        }
        return Err(Problems::one("", Problem::at("", rule)).into());
    }
    let mut found = CheckOutcome {
        name,
        scenario,
        rows,
        beside,
        precision: Precision::Unknown,
        is_lenient: false,
        other: None,
        explanations: Vec::new(),
        is_proved: false,
        closest: None,
        unseen: Vec::new(),
        has_plan: plan.is_some(),
        has_pairs: false,
    };
    if let Some(plan) = &plan {
        found.explain(plan, go_on);
        found.precision = found.precision(plan);
        if found.beside.is_whole() && !found.is_lenient {
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

impl CheckOutcome<'_> {
    /// Searches for an explanation of rows that differ from the scheme: one slip, single precision, or two slips.
    fn explain(&mut self, plan: &Plan, go_on: &(dyn Fn() -> bool + Sync)) {
        let rows = self.rows;
        let Some(differs) = self.beside.differs else {
            return; // no slip explains numbers that are not finite after rows that agree
        };
        self.other = self.other_preset();
        if self.other.is_some() {
            return;
        }
        let first = (differs.row, differs.step);
        // Each pair is computed up to the first row that differs.
        self.has_pairs = differs.step <= MOST_FOR_PAIRS;
        let mut search = Search {
            plan,
            rows,
            first,
            is_single: false,
            has_few_digits: self.has_few_digits(),
            go_on,
        };
        let (explanations, closest) = search.alone();
        (self.explanations, self.closest) = (explanations, closest);
        let may_be_single = self.explanations.is_empty() && rows.not_finite.is_none();
        let single = may_be_single.then(|| self.single(plan)).flatten();
        if let Some(single) = single.as_ref().filter(|it| it.is_whole()) {
            self.is_lenient = true;
            self.beside = single.clone();
            return;
        }
        self.try_pairs(&search);
        let single_differs = single.and_then(|single| single.differs);
        if let Some(differs_first) = single_differs.filter(|_| self.explanations.is_empty()) {
            search.is_single = true;
            search.first = (differs_first.row, differs_first.step);
            self.explanations = search.alone().0;
            self.try_pairs(&search);
        }
        if let [only] = &self.explanations[..] {
            self.is_proved = self.has_pairs && search.is_proof_of(only);
        }
    }

    /// Adds the pairs of slips that explain the rows, if pairs are tried.
    fn try_pairs(&mut self, search: &Search<'_>) {
        if self.has_pairs {
            let (pairs, closest) = search.in_pairs(&self.explanations);
            self.explanations.extend(pairs);
            self.closest = self.closest.take().or(closest);
        }
    }

    /// Compares the rows with the scheme, allowing for errors of single precision or of few digits. Returns `None` if
    /// the rows have too many digits for single precision.
    fn single(&self, plan: &Plan) -> Option<RowAgreement> {
        let rounding = if self.has_few_digits() {
            Rounding::FewDigits
        } else if self.rows.may_be_single() {
            Rounding::Single
        } else {
            return None;
        };
        let scheme = Simulation::new(Arc::clone(self.scenario));
        let run = ReferenceRun::new(scheme, explain::in_single(plan, &[]), rounding);
        Some(compare_rows(self.rows, &self.rows.times.steps, run))
    }

    /// Returns the precision of the program. Call it after the search for slips.
    fn precision(&self, plan: &Plan) -> Precision {
        let rows = self.rows;
        if self.has_few_digits() {
            return Precision::Unknown;
        }
        if self.is_lenient || self.explanations.first().is_some_and(|it| it.is_single) {
            return Precision::Single;
        }
        if !rows.may_be_single() || self.is_proved {
            return Precision::Double;
        }
        if self.beside.differs.is_some() {
            return Precision::Unknown;
        }
        let single = explain::in_single(plan, &[]).swap_remove(0);
        let alone = ReferenceRun::new(single, Vec::<MutantStepper<f64>>::new(), Rounding::Double);
        match compare_rows(rows, &rows.times.steps, alone).differs {
            Some(_) => Precision::Double,
            None => Precision::Unknown,
        }
    }

    /// Returns the column with the fewest digits. A constant column counts only if it agrees just because of its few
    /// digits.
    fn coarsest(&self) -> Option<&ProgramColumn> {
        let agrees = self.beside.differs.is_none();
        let columns = &self.rows.columns;
        let fewest = columns
            .iter()
            .filter(|column| column.varies() || agrees && self.beside.is_rounded[column.place])
            .min_by_key(|it| it.digits());
        fewest.or_else(|| columns.iter().min_by_key(|it| it.digits()))
    }

    fn digits(&self) -> i32 {
        self.coarsest().map_or(0, ProgramColumn::digits)
    }

    /// Returns true if the rows have fewer digits than single precision.
    fn has_few_digits(&self) -> bool {
        self.digits() < SINGLE_DIGITS
    }

    /// Returns the preset that agrees with all rows, if there is one.
    fn other_preset(&self) -> Option<&'static str> {
        self.rows.columns.iter().find(|column| column.varies())?;
        let names = PRESETS.iter().map(|preset| preset.name);
        names.into_iter().find(|name| {
            let scenario = Document::open(name).and_then(|it| it.scenario());
            let followed = scenario.ok().and_then(|scenario: Scenario| {
                let (times, dt) = (&self.rows.times, scenario.motion.time_step_s);
                let mut others = times.others.iter();
                let steps = if dt == self.scenario.motion.time_step_s {
                    &times.steps
                } else {
                    &others.find(|(own, _)| *own == dt)?.1
                };
                let none = Vec::<MutantStepper<f64>>::new();
                let run =
                    ReferenceRun::new(Simulation::new(scenario.into()), none, Rounding::Double);
                Some(compare_rows(self.rows, steps, run))
            });
            followed.is_some_and(|it| it.is_whole() && it.agreeing == self.rows.count)
        })
    }

    /// Returns the program that produces the rows. Returns `None` if it is not known, or if its time step differs from
    /// the run's.
    fn trial(&self, plan: &Plan) -> Option<SlipTrial> {
        let (explanation, differs) = (self.explanations.first()?, self.beside.differs?);
        if !self.is_proved {
            return None;
        }
        let mut program = explanation.program(plan)?;
        let first = u64::try_from(differs.step.max(1)).ok()?;
        for _ in 1..first {
            program.step();
        }
        Some(SlipTrial {
            first,
            program,
            words: format!(
                "{}: {}",
                explanation.names().join(" + "),
                explanation.words()
            ),
        })
    }
}
