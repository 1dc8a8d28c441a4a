//! Rows of a file beside a run: up to which of them they agree.

use super::rows::{Rows, within};
use super::step::{Program, Real};
use super::times::Steps;
use crate::run::Simulation;

/// Two copies of a run have parted where they differ by more than this share of what right programs may differ by.
const PARTED: f64 = 0.1;
/// A difference within so many times the spread of the copies in single precision is of that precision.
const SPREADS: f64 = 10.0;
/// Rounding of numbers in single precision, in units of the largest: of the start, and of what is written.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
/// The offsets that are tried, in rows.
const OFFSETS: [i64; 3] = [0, 1, -1];

/// What a run is at one of its steps: the six numbers that may be compared, and what is not known of each.
#[derive(Clone, Copy, Debug)]
struct At {
    values: [f64; 6],
    slack: [f64; 6],
}

/// Something that makes rows of six numbers.
pub trait Stepper {
    fn row(&self) -> [f64; 6];
    fn advance(&mut self);
}

impl<T: Real> Stepper for Program<T> {
    fn row(&self) -> [f64; 6] {
        Self::row(self)
    }

    fn advance(&mut self) {
        self.step();
    }
}

/// The scenario's own run; NaN once it has ended.
impl Stepper for Simulation {
    fn row(&self) -> [f64; 6] {
        if self.has_ended() {
            return [f64::NAN; 6];
        }
        let (at, momentum) = (self.now().position(), self.now().after().momentum);
        [at.x, at.y, at.z, momentum.x, momentum.y, momentum.z]
    }

    fn advance(&mut self) {
        // The row says it where the run has ended.
        let _ = self.step();
    }
}

/// A run that rows are compared with, from step 0 on, and copies of it that add up in other orders.
pub struct Run<A, B> {
    run: A,
    copies: Vec<B>,
    /// Of copies in single precision, whose spread is what is not known of the run: the largest spread so far, and the largest
    /// number, of x, y, z, and of L.
    single: Option<[[f64; 2]; 2]>,
}

impl<A: Stepper, B: Stepper> Run<A, B> {
    pub fn of(run: A, copies: Vec<B>, is_single: bool) -> Self {
        Self {
            single: is_single.then_some([[0.0; 2]; 2]),
            run,
            copies,
        }
    }

    /// What it is now; `None` from where rounding has grown so much that nothing can be said.
    fn now(&mut self) -> Option<At> {
        let (values, mut slack) = (self.run.row(), [0.0; 6]);
        let rows: Vec<_> = self.copies.iter().map(Stepper::row).collect();
        let mut is_known = values.iter().all(|value| value.is_finite());
        for place in 0..6 {
            let value = values[place];
            let all = || rows.iter().map(|row| row[place]);
            if let Some(so_far) = &mut self.single {
                let [spread, scale] = &mut so_far[place / 3];
                let most = all().fold(f64::NEG_INFINITY, f64::max);
                *spread = spread.max(most - all().fold(f64::INFINITY, f64::min));
                *scale = scale.max(value.abs());
                slack[place] = SPREADS * *spread + ROUNDING * *scale;
            } else {
                is_known &= all().all(|it| (value - it).abs() <= PARTED * within(place, value));
            }
        }
        is_known.then_some(At { values, slack })
    }

    fn step(&mut self) {
        self.run.advance();
        self.copies.iter_mut().for_each(Stepper::advance);
    }
}

/// How far rows agree with a run.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// By how many rows the file is late.
    pub offset: i64,
    /// How many rows were compared and agree.
    pub agreeing: usize,
    /// The first row that differs, with the step and what the run is there.
    pub differs: Option<Difference>,
    /// The step from which on nothing could be compared, because rounding has grown too much.
    pub parted: Option<i64>,
    /// The largest difference in x, y, z, m, and that in L, J s, over the rows that were compared: each with column and step.
    pub worst: [Option<Worst>; 2],
    /// The first row that was not compared.
    next: usize,
}

#[derive(Clone, Copy, Debug)]
pub struct Difference {
    pub row: usize,
    pub step: i64,
    pub scheme: [f64; 6],
}

#[derive(Clone, Copy, Debug)]
pub struct Worst {
    pub off: f64,
    pub place: usize,
    pub step: i64,
}

impl Followed {
    /// Whether every row that could be compared agrees, and row `row` is one of them.
    pub fn explains(&self, row: usize) -> bool {
        self.is_whole() && self.next > row
    }

    pub fn is_whole(&self) -> bool {
        self.differs.is_none() && self.agreeing > 0
    }

    /// Takes in what the run is at `step`.
    fn take(&mut self, rows: &Rows, steps: &Steps, step: i64, at: &At) {
        let (offset, count) = (self.offset * steps.stride, rows.count);
        let of = |row: usize| steps.of_rows[row].saturating_add(offset);
        while self.next < count && of(self.next) < step {
            self.next += 1; // before the start
        }
        if self.next < count && of(self.next) == step {
            self.next += usize::from(self.compare(rows, self.next, step, at));
        }
    }

    /// Compares a row. Returns whether it agrees.
    fn compare(&mut self, rows: &Rows, row: usize, step: i64, at: &At) -> bool {
        let mut agrees = true;
        for column in &rows.columns {
            let (yours, scheme) = (column.values[row], at.values[column.place]);
            agrees &= column.agrees(yours, scheme, at.slack[column.place]);
            let off = (yours - scheme).abs();
            let worst = &mut self.worst[column.place / 3];
            if worst.is_none_or(|worst| off > worst.off) {
                let place = column.place;
                *worst = Some(Worst { off, place, step });
            }
        }
        if agrees {
            self.agreeing += 1;
        } else {
            let scheme = at.values;
            self.differs = Some(Difference { row, step, scheme });
        }
        agrees
    }
}

/// Follows `run` along the rows, which are the `steps` of it, at each offset at once, and gives the one at which the
/// most rows agree.
pub fn follow<A: Stepper, B: Stepper>(rows: &Rows, steps: &Steps, mut run: Run<A, B>) -> Followed {
    let lane = |offset| Followed {
        offset,
        ..Followed::default()
    };
    let mut lanes = OFFSETS.map(lane);
    let count = rows.count;
    let goes_on = |lane: &Followed| lane.next < count && lane.differs.is_none();
    let mut step = 0;
    let is_found = |lanes: &[Followed]| lanes[0].is_whole() && !goes_on(&lanes[0]);
    while lanes.iter().any(goes_on) && !is_found(&lanes) {
        let Some(at) = run.now() else {
            let unfinished = lanes.iter_mut().filter(|lane| goes_on(lane));
            unfinished.for_each(|lane| lane.parted = Some(step));
            break;
        };
        let going = lanes.iter_mut().filter(|lane| goes_on(lane));
        going.for_each(|lane| lane.take(rows, steps, step, &at));
        run.step();
        step += 1;
    }
    // Of equals the first.
    let best = |best: Followed, lane: Followed| match (best.is_whole(), lane.is_whole()) {
        (true, _) => best,
        (false, true) => lane,
        _ if lane.agreeing > best.agreeing => lane,
        _ => best,
    };
    // That the start stands there twice is no agreement with the run.
    let says_more = |lane: &Followed| lane.offset >= 0 || lane.agreeing > 1;
    let lanes = lanes.into_iter().filter(says_more);
    lanes.reduce(best).unwrap_or_default()
}
