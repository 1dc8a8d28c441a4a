//! Searches for the slips that explain the rows of a file: one slip, then two together.

use super::follow::{ReferenceRun, Rounding, RowAgreement, compare_rows, difference};
use super::plan::{PLAN_PARTS, Plan};
use super::rows::ProgramRows;
use super::slips::{Mutations, Other, SLIPS};
use super::step::{MutantStepper, Order, Real};
use super::times::RowSteps;
use crate::engine::cores;
use crate::engine::scenario::{Document, Scenario};
use crate::engine::text::number::shortest;
use std::sync::Arc;

const ANOTHER_STEP: &str = "another-dt";
const ANOTHER_START: &str = "start-of-another-preset";
/// Number of slips that are tried.
pub const SLIP_COUNT: usize = SLIPS.len() + 2;

/// Presets whose start may be left over in a program, the report's own first. Each can be made into a plan.
const STARTS: [&str; 4] = ["method-1", "method-2", "wobble-push", "every-slip"];

/// Minimum number of agreeing steps of the closest slip: a fixed number, and a multiple of the steps that agree with
/// the scheme itself.
const LASTS: (i64, i64) = (20, 10);

/// Number of rows after the first difference that must agree with a pair of slips, or with a slip that is stated as
/// fact.
const ROWS_AFTER: usize = 2;
/// The same number for a pair, if rounding takes over before the last row.
const ROWS_BEFORE_PARTING: usize = 20;
/// The same number for one slip, in rows with more than the digits of single precision.
const ROWS_OF_ONE_BEFORE_PARTING: usize = 8;
/// Rows are evidence of a slip if they differ from the run without it by this multiple of the tolerance.
const MIN_EVIDENCE: f64 = 50.0;

/// Latest step of the first difference for which pairs are tried.
pub const MOST_FOR_PAIRS: i64 = 4000;

/// A variant of a slip.
#[derive(Clone, Debug)]
pub struct Variant {
    pub name: &'static str,
    /// Description of the program's behavior.
    program: String,
    /// Description of the report's behavior, a sentence.
    report: String,
    change: SlipChange,
    /// Index among all variants.
    place: usize,
}

#[derive(Clone, Debug)]
enum SlipChange {
    Of(fn(&mut Mutations)),
    /// The time step, s, and its index among the file's other time steps.
    TimeStep(f64, usize),
    /// A start with values of another preset, and true if it is only one value.
    Start(Arc<Plan>, bool),
}

/// Slips that agree with all rows that could be compared.
#[derive(Clone, Debug)]
pub struct Explanation {
    pub variants: Vec<Variant>,
    /// Other variants of the same slips that agree with the rows too.
    alternatives: Vec<Vec<Variant>>,
    pub followed: RowAgreement,
    /// True if the program computes in single precision.
    pub is_single: bool,
    /// Difference between the rows and the runs without one of the slips, in units of the tolerance.
    evidence: f64,
}

impl Explanation {
    pub fn names(&self) -> Vec<&'static str> {
        self.variants.iter().map(|variant| variant.name).collect()
    }

    /// Returns the program with these slips; `None` if its time step differs.
    pub fn program(&self, plan: &Plan) -> Option<MutantStepper<f64>> {
        (!self.names().contains(&ANOTHER_STEP))
            .then(|| program(plan, &self.variants, Order::Forward))
    }

    /// Describes the behavior of the program and of the report.
    pub fn words(&self) -> String {
        let words: Vec<_> = (0..self.variants.len())
            .map(|place: usize| {
                let all = std::iter::once(&self.variants).chain(&self.alternatives);
                let mut programs: Vec<&str> = Vec::new();
                for variants in all {
                    let program = variants[place].program.as_str();
                    if !programs.contains(&program) {
                        programs.push(program);
                    }
                }
                format!(
                    "{}. {}",
                    programs.join(", or "),
                    self.variants[place].report
                )
            })
            .collect();
        words.join(" Second: ")
    }
}

fn changes<'a>(variants: impl IntoIterator<Item = &'a Variant>) -> Mutations {
    let mut changes = Mutations::default();
    for variant in variants {
        match variant.change {
            SlipChange::Of(change) => change(&mut changes),
            SlipChange::TimeStep(time_step_s, _) => changes.time_step_s = Some(time_step_s),
            SlipChange::Start(..) => {}
        }
    }
    changes
}

fn program<T: Real>(plan: &Plan, variants: &[Variant], order: Order) -> MutantStepper<T> {
    let start = variants.iter().find_map(|variant| match &variant.change {
        SlipChange::Start(changed, _) => Some(&**changed),
        _ => None,
    });
    MutantStepper::new(start.unwrap_or(plan), &changes(variants), order)
}

/// The slips that explain the rows, and the closest other slip, if one is close.
type SearchOutcome = (Vec<Explanation>, Option<Explanation>);

/// The search for the program of one plan that produced the rows.
pub struct Search<'a> {
    pub plan: &'a Plan,
    pub rows: &'a ProgramRows,
    /// The first row that differs from the scheme, and its step.
    pub first: (usize, i64),
    /// True if the programs compute in single precision.
    pub is_single: bool,
    /// True if the rows have too few digits to distinguish double from single precision.
    pub has_few_digits: bool,
    pub go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Variant {
    fn all(plan: &Plan, rows: &ProgramRows) -> Vec<Self> {
        let mut all = Vec::new();
        for (name, program, report, variants) in SLIPS {
            for (note, change) in *variants {
                let change = SlipChange::Of(*change);
                let Some(note) = Self::note(note, &change, plan) else {
                    continue;
                };
                all.push(Self {
                    name,
                    program: format!("{program}{note}"),
                    report: format!("The report {report}."),
                    change,
                    place: 0,
                });
            }
        }
        let dt = shortest(plan.time_step_s);
        let others = rows.times.others.iter().enumerate();
        all.extend(others.map(|(place, (own, _))| Self {
            name: ANOTHER_STEP,
            program: format!("its time step is {own} s"),
            report: format!("The scenario's is {dt} s."),
            change: SlipChange::TimeStep(*own, place),
            place: 0,
        }));
        all.extend(Self::other_starts(plan));
        for (place, variant) in all.iter_mut().enumerate() {
            variant.place = place;
        }
        all
    }

    /// Returns `note` in parentheses, with the name of the point that it mentions; `None` if the plan has no such
    /// point.
    fn note(note: &str, change: &SlipChange, plan: &Plan) -> Option<String> {
        let changes = match change {
            SlipChange::Of(change) => {
                let mut changes = Mutations::default();
                change(&mut changes);
                changes
            }
            _ => Mutations::default(),
        };
        if changes.hub_in_plane && plan.hub().is_none() {
            return None;
        }
        let pushed = plan.pushes.first().map_or(0, |push| push.point);
        let other = match (changes.traced, changes.push_point) {
            (Some(Other::OfAxle(nth)), _) => Some(plan.other_of_axle(nth, plan.traced)?),
            (_, Some(Other::OfAxle(nth))) => Some(plan.other_of_axle(nth, pushed)?),
            _ => None,
        };
        Some(match (other, note) {
            (Some(name), _) => format!(" ({name})"),
            (None, "") => String::new(),
            (None, note) => format!(" ({note})"),
        })
    }

    fn other_starts(plan: &Plan) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for preset in STARTS {
            let scenario = Document::open(preset).and_then(|it| it.scenario());
            let Some(other) = scenario
                .ok()
                .and_then(|it: Scenario| Plan::from_scenario(&it))
            else {
                continue;
            };
            for parts in 1..1_u8 << PLAN_PARTS {
                let Some(start) = plan.with_parts(&other, parts) else {
                    break;
                };
                let places = (0..PLAN_PARTS).filter(|part| parts & (1 << part) != 0);
                let both = places.map(|part| (other.part(part), plan.part(part)));
                let (theirs, own): (Vec<_>, Vec<_>) = both.unzip();
                let is_other = theirs.iter().zip(&own).all(|(theirs, own)| theirs != own);
                let has = format!("it still has {}", theirs.join(", "));
                if is_other && !all.iter().any(|known| known.program.starts_with(&has)) {
                    all.push(Self {
                        name: ANOTHER_START,
                        program: format!("{has}, like {preset}"),
                        report: format!("The scenario has {}.", own.join(", ")),
                        change: SlipChange::Start(Arc::new(start), parts.is_power_of_two()),
                        place: 0,
                    });
                }
            }
        }
        all
    }
}

impl Search<'_> {
    pub fn alone(&self) -> SearchOutcome {
        let variants = Variant::all(self.plan, self.rows);
        let candidates: Vec<_> = variants.into_iter().map(|variant| vec![variant]).collect();
        self.try_all(&candidates)
    }

    /// Tries two slips together.
    ///
    /// Pairs that contain a slip from `alone` are skipped: it explains the rows by itself, so the second slip changes
    /// nothing.
    pub fn in_pairs(&self, alone: &[Explanation]) -> SearchOutcome {
        let has_own_step = self.rows.times.own_s.is_some();
        let mut variants = Variant::all(self.plan, self.rows);
        variants.retain(|it| match it.change {
            SlipChange::Of(_) => true,
            SlipChange::TimeStep(..) => has_own_step,
            SlipChange::Start(_, is_one) => is_one,
        });
        variants.retain(|it| {
            let mut all_alone = alone
                .iter()
                .flat_map(|known| known.alternatives.iter().chain([&known.variants]));
            !all_alone.any(|known| known[0].place == it.place)
        });
        let mut pairs = Vec::new();
        for (place, one) in variants.iter().enumerate() {
            for other in &variants[place + 1..] {
                let [together, turned] = [[one, other], [other, one]].map(changes);
                let has_start = [one, other].iter().any(|it| it.name == ANOTHER_START);
                let is_pair =
                    together == turned && ![[one], [other]].map(changes).contains(&together);
                if one.name != other.name && (is_pair || has_start) {
                    pairs.push(vec![one.clone(), other.clone()]);
                }
            }
        }
        let (mut found, closest) = self.try_all(&pairs);
        // With few digits, any rows agree with a run in which rounding takes over early.
        let needs_all_rows = self.has_few_digits || self.is_single;
        found.retain(|pair| {
            let has_all_rows = pair.followed.parted.is_none();
            pair.evidence >= MIN_EVIDENCE && (has_all_rows || !needs_all_rows)
        });
        (found, closest)
    }

    /// Returns true if the rows prove `explanation`, the only one. Rows that are shifted do not.
    pub fn is_proof_of(&self, explanation: &Explanation) -> bool {
        let followed = &explanation.followed;
        let after = match (followed.parted, self.has_few_digits) {
            (None, _) => ROWS_AFTER,
            (Some(_), false) => ROWS_OF_ONE_BEFORE_PARTING,
            (Some(_), true) => ROWS_BEFORE_PARTING,
        };
        // Without principal axes, two slips together can produce the rows of many other pairs.
        explanation.evidence >= MIN_EVIDENCE
            && (explanation.variants.len() == 1
                || program::<f64>(self.plan, &[], Order::Forward).has_axes())
            && followed.offset == 0
            && followed.explains(self.first.0 + after)
            && !(self.is_single && self.has_few_digits)
    }

    /// Returns the `candidates` that explain the rows, each list of names once, and the closest other candidate, if one
    /// is close.
    fn try_all(&self, candidates: &[Vec<Variant>]) -> SearchOutcome {
        let tried: Vec<Option<Explanation>> = cores::map(candidates, |variants| {
            let followed = (self.go_on)().then(|| self.followed(variants))?;
            Some(Explanation {
                variants: variants.clone(),
                alternatives: Vec::new(),
                followed,
                is_single: self.is_single,
                evidence: 0.0,
            })
        });
        let (mut found, mut closest) = (Vec::<Explanation>::new(), None);
        let mut most = LASTS.0.max(LASTS.1 * self.first.1) - 1;
        for mut one in tried.into_iter().flatten() {
            let lasts = one.followed.differs.map_or(0, |differs| differs.step);
            if self.is_explained_by(&one) {
                let known = found.iter_mut().find(|it| it.names() == one.names());
                match known {
                    Some(known) => known.alternatives.push(one.variants),
                    None => {
                        one.evidence = self.evidence(&one);
                        found.push(one);
                    }
                }
            } else if lasts > most {
                most = lasts;
                closest = Some(one);
            }
        }
        (found, closest)
    }

    /// Returns true if all rows that can be compared agree with `tried`, and if they are enough. If very few rows can
    /// be compared, two slips explain almost anything.
    fn is_explained_by(&self, tried: &Explanation) -> bool {
        let after = match (tried.variants.len(), tried.followed.parted) {
            (1, _) => 0,
            (_, None) => ROWS_AFTER,
            (_, Some(_)) => ROWS_BEFORE_PARTING,
        };
        let last = (self.first.0 + after).min(self.rows.count - 1);
        tried.followed.explains(last)
    }

    /// Compares the rows with the program that has these `variants`.
    fn followed(&self, variants: &[Variant]) -> RowAgreement {
        let (rows, steps) = (self.rows, steps_by(self.rows, variants));
        if self.is_single {
            compare_rows(rows, steps, single(self.plan, variants))
        } else {
            compare_rows(rows, steps, double(self.plan, variants))
        }
    }

    /// Returns the smallest difference between the explained rows and the runs without one of the slips, in units of
    /// the tolerance.
    fn evidence(&self, explanation: &Explanation) -> f64 {
        let (plan, rows, followed) = (self.plan, self.rows, &explanation.followed);
        let without = match &explanation.variants[..] {
            [one, other] => vec![vec![one.clone()], vec![other.clone()]],
            _ => vec![Vec::new()],
        };
        let differences = without.iter().map(|variants| {
            let steps = steps_by(rows, variants);
            let (count, offset) = (followed.next, followed.offset);
            if self.is_single {
                let run = single(plan, variants);
                difference(rows, count, steps, offset, run)
            } else {
                difference(rows, count, steps, offset, double(plan, variants))
            }
        });
        differences.fold(f64::INFINITY, f64::min)
    }
}

/// Returns the steps of the rows for the time step of `variants`.
fn steps_by<'a>(rows: &'a ProgramRows, variants: &[Variant]) -> &'a RowSteps {
    let others = variants.iter().find_map(|variant| match variant.change {
        SlipChange::TimeStep(_, place) => Some(&rows.times.others[place].1),
        _ => None,
    });
    others.unwrap_or(&rows.times.steps)
}

fn double(
    plan: &Plan,
    variants: &[Variant],
) -> ReferenceRun<MutantStepper<f64>, MutantStepper<f64>> {
    let [one, other] =
        [Order::Forward, Order::Backward].map(|order| program(plan, variants, order));
    ReferenceRun::new(one, vec![other], Rounding::Double)
}

/// Returns the run of the program with `variants`, with a tolerance for errors of single precision.
fn single(
    plan: &Plan,
    variants: &[Variant],
) -> ReferenceRun<MutantStepper<f64>, MutantStepper<f32>> {
    let run = program(plan, variants, Order::Forward);
    ReferenceRun::new(run, in_single(plan, variants), Rounding::SingleOfSlip)
}

/// Returns copies of the program with `variants` in single precision, each with another order of additions.
pub fn in_single(plan: &Plan, variants: &[Variant]) -> Vec<MutantStepper<f32>> {
    let orders = [Order::Forward, Order::Backward, Order::EvenThenOdd];
    orders.map(|order| program(plan, variants, order)).into()
}

/// Returns the slips that `rows`, which agree with the scheme, cannot reveal because these slips change none of them.
/// `parted` is the step at which rounding takes over in the scheme's own motion.
pub fn hidden(
    plan: &Plan,
    rows: &ProgramRows,
    parted: Option<i64>,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Vec<&'static str> {
    let mut variants = Variant::all(plan, rows);
    variants.retain(|variant| matches!(variant.change, SlipChange::Of(_)));
    let hides: Vec<bool> = cores::map(&variants, |variant| {
        if !go_on() {
            return false;
        }
        let alone = std::slice::from_ref(variant);
        let followed = compare_rows(rows, steps_by(rows, alone), double(plan, alone));
        // A run whose copies diverge long before the scheme's copies is a different run.
        followed.is_whole()
            && followed
                .parted
                .is_none_or(|step| parted.is_some_and(|own| step + 10 >= own))
    });
    let hidden = variants.iter().zip(hides).filter(|(_, hides)| *hides);
    let mut names: Vec<_> = hidden.map(|(variant, _)| variant.name).collect();
    names.dedup();
    names
}
