//! Which slips make the rows of a file: each alone, then two together.

use super::follow::{Followed, Run, follow};
use super::plan::{PARTS, Plan};
use super::rows::Rows;
use super::slips::{Changes, SLIPS};
use super::step::{Order, Program};
use super::times::Steps;
use crate::cores;
use crate::scenario::{Document, Scenario};
use crate::text::number::shortest;
use std::sync::Arc;

const ANOTHER_STEP: &str = "another-dt";
const ANOTHER_START: &str = "start-of-another-preset";
/// The number of slips that are looked for.
pub const COUNT: usize = SLIPS.len() + 2;

/// The presets whose start may be left in a program: those that a plan can be made of, the report's own first.
const STARTS: [&str; 4] = ["method-1", "method-2", "wobble-push", "every-slip"];

/// The least number of steps for which a slip must last to come closest, and how many times as long as the scheme itself.
const LASTS: (i64, i64) = (20, 10);

/// How many more rows than the first that differs a pair must explain.
const ROWS_OF_PAIR: usize = 2;

/// The last step at which rows may begin to differ, where pairs are tried.
pub const MOST_FOR_PAIRS: i64 = 4000;

/// A variant of a slip.
#[derive(Clone, Debug)]
pub struct Variant {
    pub name: &'static str,
    /// What the program does, and what the report does.
    pub words: String,
    change: Change,
}

#[derive(Clone, Debug)]
enum Change {
    Of(fn(&mut Changes)),
    /// The time step, s, and its place among the file's others.
    TimeStep(f64, usize),
    /// It begins so, with the values of another preset: whether with one of them.
    Start(Arc<Plan>, bool),
}

/// Slips with which all rows agree that could be compared.
#[derive(Clone, Debug)]
pub struct Explanation {
    pub variants: Vec<Variant>,
    pub followed: Followed,
}

impl Explanation {
    pub fn names(&self) -> Vec<&'static str> {
        self.variants.iter().map(|variant| variant.name).collect()
    }

    /// The program with these slips; `None` where its time step is another one.
    pub fn program(&self, plan: &Plan) -> Option<Program<f64>> {
        let program = || program(plan, &self.variants, Order::Forward);
        (!self.names().contains(&ANOTHER_STEP)).then(program)
    }
}

fn changes<'a>(variants: impl IntoIterator<Item = &'a Variant>) -> Changes {
    let mut changes = Changes::default();
    for variant in variants {
        match variant.change {
            Change::Of(change) => change(&mut changes),
            Change::TimeStep(time_step_s, _) => changes.time_step_s = Some(time_step_s),
            Change::Start(..) => {}
        }
    }
    changes
}

fn program(plan: &Plan, variants: &[Variant], order: Order) -> Program<f64> {
    let start = variants.iter().find_map(|variant| match &variant.change {
        Change::Start(plan, _) => Some(&**plan),
        _ => None,
    });
    Program::new(start.unwrap_or(plan), &changes(variants), order)
}

/// The slips that explain rows, and the closest of the others, if one is close.
type Came = (Vec<Explanation>, Option<Explanation>);

/// The search among programs of one plan for that which has made the rows.
pub struct Search<'a> {
    pub plan: &'a Plan,
    pub rows: &'a Rows,
    /// The first row that differs from the scheme, and its step.
    pub first: (usize, i64),
    pub go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Variant {
    fn all(plan: &Plan, rows: &Rows) -> Vec<Self> {
        let mut all = Vec::new();
        for (name, program, report, variants) in SLIPS {
            all.extend(variants.iter().map(|(note, change)| Self {
                name,
                words: match *note {
                    "" => format!("{program}. The report {report}."),
                    note => format!("{program} ({note}). The report {report}."),
                },
                change: Change::Of(*change),
            }));
        }
        let dt = shortest(plan.time_step_s);
        let others = rows.times.others.iter().enumerate();
        all.extend(others.map(|(place, (own, _))| Self {
            name: ANOTHER_STEP,
            words: format!("its time step is {own} s. The scenario's is {dt} s."),
            change: Change::TimeStep(*own, place),
        }));
        all.extend(Self::other_starts(plan));
        all
    }

    fn other_starts(plan: &Plan) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for preset in STARTS {
            let scenario = Document::open(preset).and_then(|it| it.scenario());
            let Some(other) = scenario.ok().and_then(|it: Scenario| Plan::of(&it)) else {
                continue;
            };
            for parts in 1..1_u8 << PARTS {
                let Some(start) = plan.with_parts(&other, parts) else {
                    break;
                };
                let places = (0..PARTS).filter(|part| parts & (1 << part) != 0);
                let both = places.map(|part| (other.part(part), plan.part(part)));
                let (theirs, own): (Vec<_>, Vec<_>) = both.unzip();
                let is_other = theirs.iter().zip(&own).all(|(theirs, own)| theirs != own);
                let has = format!("it still has {}", theirs.join(", "));
                if is_other && !all.iter().any(|known| known.words.starts_with(&has)) {
                    let own = own.join(", ");
                    all.push(Self {
                        name: ANOTHER_START,
                        words: format!("{has}, as {preset} has. The scenario has {own}."),
                        change: Change::Start(Arc::new(start), parts.is_power_of_two()),
                    });
                }
            }
        }
        all
    }
}

impl Search<'_> {
    pub fn alone(&self) -> Came {
        let variants = Variant::all(self.plan, self.rows);
        let candidates: Vec<_> = variants.into_iter().map(|variant| vec![variant]).collect();
        self.try_all(&candidates)
    }

    pub fn in_pairs(&self) -> Came {
        let has_own_step = self.rows.times.own_s.is_some();
        let mut variants = Variant::all(self.plan, self.rows);
        variants.retain(|it| match it.change {
            Change::Of(_) => true,
            Change::TimeStep(..) => has_own_step,
            Change::Start(_, is_one) => is_one,
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
        self.try_all(&pairs)
    }

    /// Those of `candidates` that explain the rows, each list of names once; and of the others the closest, if one is close.
    fn try_all(&self, candidates: &[Vec<Variant>]) -> Came {
        let tried: Vec<Option<Explanation>> = cores::map(candidates, |variants| {
            let followed = (self.go_on)().then(|| followed(self.plan, self.rows, variants))?;
            Some(Explanation {
                variants: variants.clone(),
                followed,
            })
        });
        let lasts = |tried: &Explanation| tried.followed.differs.map_or(0, |differs| differs.step);
        let (mut found, mut closest) = (Vec::<Explanation>::new(), None);
        let mut most = LASTS.0.max(LASTS.1 * self.first.1) - 1;
        for tried in tried.into_iter().flatten() {
            // Where hardly a row can be compared, two slips explain anything.
            let more = if tried.variants.len() > 1 {
                ROWS_OF_PAIR
            } else {
                0
            };
            let last = (self.first.0 + more).min(self.rows.count - 1);
            if tried.followed.explains(last) {
                let is_known = found.iter().any(|known| known.names() == tried.names());
                if !is_known {
                    found.push(tried);
                }
            } else if lasts(&tried) > most {
                most = lasts(&tried);
                closest = Some(tried);
            }
        }
        (found, closest)
    }
}

/// How far the rows agree with the program that has the changes of `variants`.
fn followed(plan: &Plan, rows: &Rows, variants: &[Variant]) -> Followed {
    let steps = variants.iter().find_map(|variant| match variant.change {
        Change::TimeStep(_, place) => Some(&rows.times.others[place].1),
        _ => None,
    });
    let steps: &Steps = steps.unwrap_or(&rows.times.steps);
    let [one, other] =
        [Order::Forward, Order::Backward].map(|order| program(plan, variants, order));
    follow(rows, steps, Run::of(one, vec![other], false))
}

/// The slips that could hide in `rows`, which are the scheme's own: those that change none of them.
/// `parted` is the step at which rounding decides about the scheme's own motion.
pub fn hidden(
    plan: &Plan,
    rows: &Rows,
    parted: Option<i64>,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Vec<&'static str> {
    let mut variants = Variant::all(plan, rows);
    variants.retain(|variant| matches!(variant.change, Change::Of(_)));
    let hides: Vec<bool> = cores::map(&variants, |variant| {
        if !go_on() {
            return false;
        }
        let followed = followed(plan, rows, std::slice::from_ref(variant));
        // A run that parts from its copy long before the scheme does is another one.
        let parts_with = |step: i64| parted.is_some_and(|own| step + 10 >= own);
        followed.is_whole() && followed.parted.is_none_or(parts_with)
    });
    let hidden = variants.iter().zip(hides).filter(|(_, hides)| *hides);
    let mut names: Vec<_> = hidden.map(|(variant, _)| variant.name).collect();
    names.dedup();
    names
}
