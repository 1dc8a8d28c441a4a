//! Which slips make the rows of a file: each alone, then two together.

use super::follow::{Followed, OFFSETS, Twin, follow};
use super::plan::Plan;
use super::rows::Rows;
use super::slips::{Changes, SLIPS, Slip};
use super::step::{Order, Program};
use super::times::Steps;
use crate::cores;
use crate::text::number::shortest;

pub const ANOTHER_STEP: &str = "another-dt";
/// The number of slips that are looked for.
pub const COUNT: usize = SLIPS.len() + 1;

/// The least number of steps for which a slip must last to come closest, and how many times as long as the scheme itself.
const LASTS: (i64, i64) = (20, 10);

/// The last step at which rows may begin to differ, where pairs are tried.
pub const MOST_FOR_PAIRS: i64 = 4000;

/// A variant of a slip.
#[derive(Clone, Debug)]
pub struct Variant {
    pub name: &'static str,
    /// What is special about it; empty where nothing is.
    pub note: String,
    /// `None` for another time step.
    pub slip: Option<&'static Slip>,
    change: Change,
}

#[derive(Clone, Copy, Debug)]
enum Change {
    Of(fn(&mut Changes)),
    /// The time step, s, and its place among the file's others.
    TimeStep(f64, usize),
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
}

/// The search among programs of one plan for that which has made the rows.
pub struct Search<'a> {
    pub plan: &'a Plan,
    pub rows: &'a Rows,
    /// The first row that differs from the scheme, and its step.
    pub first: (usize, i64),
    /// Whether to go on.
    pub go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Variant {
    /// Every variant of every slip.
    pub fn all(rows: &Rows) -> Vec<Self> {
        let of_slip = |slip: &'static Slip| {
            slip.variants.iter().map(move |(note, change)| Self {
                name: slip.name,
                note: (*note).to_owned(),
                slip: Some(slip),
                change: Change::Of(*change),
            })
        };
        let others = rows.times.others.iter().enumerate();
        let of_times = others.map(|(place, (time_step_s, _))| Self {
            name: ANOTHER_STEP,
            note: format!("{} s", shortest(*time_step_s)),
            slip: None,
            change: Change::TimeStep(*time_step_s, place),
        });
        SLIPS.iter().flat_map(of_slip).chain(of_times).collect()
    }

    fn apply(&self, changes: Changes) -> Changes {
        let mut changes = changes;
        match self.change {
            Change::Of(change) => change(&mut changes),
            Change::TimeStep(time_step_s, _) => changes.time_step_s = Some(time_step_s),
        }
        changes
    }
}

impl Search<'_> {
    /// The slips that explain the rows alone.
    pub fn alone(&self) -> (Vec<Explanation>, Vec<Explanation>) {
        let variants = Variant::all(self.rows);
        let candidates: Vec<_> = variants.into_iter().map(|variant| vec![variant]).collect();
        self.try_all(&candidates)
    }

    /// Whether pairs can be tried in a few seconds: each is computed up to the first row that differs.
    pub fn can_try_pairs(&self) -> bool {
        self.first.1 <= MOST_FOR_PAIRS
    }

    /// The pairs of slips that explain the rows.
    pub fn in_pairs(&self) -> (Vec<Explanation>, Vec<Explanation>) {
        let mut variants = Variant::all(self.rows);
        if self.rows.times.own_s.is_none() {
            variants.retain(|variant| matches!(variant.change, Change::Of(_)));
        }
        let mut pairs = Vec::new();
        for (place, one) in variants.iter().enumerate() {
            for other in &variants[place + 1..] {
                let none = Changes::default();
                let [together, turned] = [[one, other], [other, one]]
                    .map(|pair| pair.iter().fold(none, |sum, variant| variant.apply(sum)));
                let [alone, beside] = [one, other].map(|variant| variant.apply(none));
                let is_pair = together == turned && together != alone && together != beside;
                if one.name != other.name && is_pair {
                    pairs.push(vec![one.clone(), other.clone()]);
                }
            }
        }
        self.try_all(&pairs)
    }

    /// Those of `candidates` that explain the rows, each list of names once; and the others that come close, the closest first.
    fn try_all(&self, candidates: &[Vec<Variant>]) -> (Vec<Explanation>, Vec<Explanation>) {
        let tried: Vec<Option<Explanation>> = cores::map(candidates, |variants| {
            let followed = (self.go_on)().then(|| followed(self.plan, self.rows, variants))?;
            Some(Explanation {
                variants: variants.clone(),
                followed,
            })
        });
        let (mut found, mut close) = (Vec::<Explanation>::new(), Vec::new());
        for tried in tried.into_iter().flatten() {
            let step = tried.followed.differs.map(|differs| differs.step);
            if tried.followed.explains(self.first.0) {
                let is_known = found.iter().any(|known| known.names() == tried.names());
                if !is_known {
                    found.push(tried);
                }
            } else if step.is_some_and(|step| step >= LASTS.0.max(LASTS.1 * self.first.1)) {
                close.push(tried);
            }
        }
        close.sort_by_key(|tried| tried.followed.differs.map(|differs| -differs.step));
        (found, close)
    }
}

/// How far the rows agree with the program that has the changes of `variants`.
fn followed(plan: &Plan, rows: &Rows, variants: &[Variant]) -> Followed {
    let changes = variants
        .iter()
        .fold(Changes::default(), |sum, variant| variant.apply(sum));
    let steps = variants.iter().find_map(|variant| match variant.change {
        Change::TimeStep(_, place) => Some(&rows.times.others[place].1),
        Change::Of(_) => None,
    });
    let steps: &Steps = steps.unwrap_or(&rows.times.steps);
    let [one, other] =
        [Order::Forward, Order::Backward].map(|order| Program::<f64>::new(plan, &changes, order));
    follow(rows, steps, &mut Twin(one, Some(other)), &OFFSETS, false)
}

/// The slips that could hide in `rows`, which are the scheme's own: those that change none of them.
/// `parted` is the step at which rounding decides about the scheme's own motion.
pub fn hidden(
    plan: &Plan,
    rows: &Rows,
    parted: Option<i64>,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Vec<&'static str> {
    let variants = Variant::all(rows).into_iter();
    let variants: Vec<_> = variants.filter(|variant| variant.slip.is_some()).collect();
    let hides: Vec<bool> = cores::map(&variants, |variant| {
        if !go_on() {
            return false;
        }
        let followed = followed(plan, rows, std::slice::from_ref(variant));
        // A run that parts from its copy long before the scheme does is another one.
        let parts_with = |step: i64| parted.is_some_and(|own| step + 10 >= own);
        followed.is_whole() && followed.parted.is_none_or(parts_with)
    });
    let mut names = Vec::new();
    for (variant, hides) in variants.iter().zip(hides) {
        if hides && !names.contains(&variant.name) {
            names.push(variant.name);
        }
    }
    names
}
