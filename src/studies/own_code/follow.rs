//! Comparison of the rows of a file with a run, up to the first difference.

use super::rows::{ProgramRows, within};
use super::step::{MutantStepper, Real};
use super::times::RowSteps;
use crate::engine::run::Simulation;
use std::ops::Range;

/// Two copies of a run have diverged if they differ by more than this fraction of a column's tolerance.
const DIVERGED: f64 = 0.1;
/// Errors of single precision are at most this multiple of the errors of the copies in single precision.
const SINGLE_ERROR_FACTOR: f64 = 10.0;
/// Rounding of numbers in single precision, relative to the largest: of the start values and of the output.
const SINGLE_ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
/// The same rounding for a whole vector, which few digits cannot distinguish from single precision.
const VECTOR_ROUNDING: f64 = 2.0 * SINGLE_ROUNDING;
/// Maximum tolerance for errors of single precision, relative to the vector. With more, nothing is left to compare.
const MOST_SLACK: f64 = 0.02;
/// The offsets to try, in rows.
const OFFSETS: [i64; 3] = [0, 1, -1];

/// State of a run at one of its steps: the six numbers to compare, and the uncertainty of each.
#[derive(Clone, Copy, Debug)]
struct At {
    values: [f64; 6],
    slack: [f64; 6],
}

/// A source of rows of six numbers.
pub trait Stepper {
    fn row(&self) -> [f64; 6];
    fn next_step(&mut self);
}

impl<T: Real> Stepper for MutantStepper<T> {
    fn row(&self) -> [f64; 6] {
        Self::row(self)
    }

    fn next_step(&mut self) {
        self.step();
    }
}

/// The scenario's own run. Its rows are NaN after it has ended.
impl Stepper for Simulation {
    fn row(&self) -> [f64; 6] {
        if self.has_ended() {
            return [f64::NAN; 6];
        }
        let (at, momentum) = (self.now().position(), self.now().after().momentum);
        [at.x, at.y, at.z, momentum.x, momentum.y, momentum.z]
    }

    fn next_step(&mut self) {
        // An ended run shows in its row.
        let _ = self.step();
    }
}

/// Purpose of the copies of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Copies in double precision: if they differ, rounding errors dominate the motion.
    Double,
    /// Copies in single precision: their errors are tolerated.
    Single,
    /// The same, as long as the errors are small compared with the numbers.
    SingleOfSlip,
    /// The same, plus the rounding of the whole vector in each of its components.
    FewDigits,
}

/// A run to compare rows with, from step 0, and copies of it that add in another order.
pub struct ReferenceRun<A, B> {
    run: A,
    copies: Vec<B>,
    rounding: Rounding,
    /// For each number: the largest error of the copies so far, and the largest absolute value.
    so_far: [[f64; 2]; 6],
}

impl<A: Stepper, B: Stepper> ReferenceRun<A, B> {
    pub fn new(run: A, copies: Vec<B>, rounding: Rounding) -> Self {
        let so_far = [[0.0; 2]; 6];
        Self {
            run,
            copies,
            rounding,
            so_far,
        }
    }

    /// Returns the current state; `None` if rounding has grown too large to compare the digits of `rows`.
    fn now(&mut self, rows: &ProgramRows) -> Option<At> {
        let values = self.run.row();
        let copies: Vec<_> = self.copies.iter().map(Stepper::row).collect();
        let is_finite = values.iter().all(|value| value.is_finite());
        if self.rounding == Rounding::Double {
            let mut columns = rows.columns.iter().map(|it| (it, values[it.place]));
            let is_known = columns.all(|(column, value)| {
                let room = DIVERGED * column.room(value);
                copies
                    .iter()
                    .all(|copy| (value - copy[column.place]).abs() <= room)
            });
            let slack = [0.0; 6];
            return (is_finite && is_known).then_some(At { values, slack });
        }
        for (place, [error, scale]) in self.so_far.iter_mut().enumerate() {
            let errors = copies
                .iter()
                .map(|copy| (copy[place] - values[place]).abs());
            *error = errors.fold(*error, f64::max);
            *scale = scale.max(values[place].abs());
        }
        // An error of the rotation affects the whole arm. Each component of L is a separate sum.
        let slack = std::array::from_fn(|place| {
            let (vector, own) = (place / 3 * 3..place / 3 * 3 + 3, place..place + 1);
            let most = |places: Range<usize>, which: usize| {
                let numbers = self.so_far[places].iter().map(|it| it[which]);
                numbers.fold(0.0, f64::max)
            };
            let places = if place < 3 { vector.clone() } else { own };
            let slack =
                SINGLE_ERROR_FACTOR * most(places.clone(), 0) + SINGLE_ROUNDING * most(places, 1);
            match self.rounding {
                Rounding::FewDigits => slack + VECTOR_ROUNDING * most(vector, 1),
                _ => slack,
            }
        });
        let is_lost = self.rounding == Rounding::SingleOfSlip
            && (0..6).any(|place: usize| {
                let scales = self.so_far[place / 3 * 3..place / 3 * 3 + 3].iter();
                let scale = scales.fold(0.0, |most: f64, it| most.max(it[1]));
                slack[place] > MOST_SLACK * scale
            });
        (is_finite && !is_lost).then_some(At { values, slack })
    }

    fn step(&mut self) {
        self.run.next_step();
        self.copies.iter_mut().for_each(Stepper::next_step);
    }
}

/// Agreement of rows with a run.
#[derive(Clone, Debug, Default)]
pub struct RowAgreement {
    /// Number of rows by which the file is late.
    pub offset: i64,
    /// Number of compared rows that agree.
    pub agreeing: usize,
    /// The first row that differs, with its step and the state of the run.
    pub differs: Option<RowDifference>,
    /// The step from which on rounding is too large to compare anything.
    pub parted: Option<i64>,
    /// The largest differences over the compared rows, with column and step: of x, y, z in m, and of L in J s.
    pub worst: [Option<Worst>; 2],
    /// The first row that was not compared.
    pub next: usize,
    /// True if a row after the start agrees.
    moves: bool,
    /// For each column: true if a value is farther from the run than a correct program with all digits would be.
    pub is_rounded: [bool; 6],
}

#[derive(Clone, Copy, Debug)]
pub struct RowDifference {
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

impl RowAgreement {
    /// Returns true if every row that could be compared agrees, and if `row` is one of them.
    pub fn explains(&self, row: usize) -> bool {
        self.is_whole() && self.next > row
    }

    pub fn is_whole(&self) -> bool {
        self.differs.is_none() && self.agreeing > 0
    }

    /// Compares the rows that are due at `step` with the state `at` of the run.
    fn compare_due_rows(&mut self, rows: &ProgramRows, steps: &RowSteps, step: i64, at: &At) {
        let (offset, count) = (self.offset * steps.stride, rows.count);
        // An offset row before the start must equal the start; otherwise this offset fails.
        while self.next < count
            && steps.of_rows[self.next].saturating_add(offset) <= step
            && self.compare(rows, self.next, step, at)
        {
            self.next += 1;
        }
    }

    /// Compares one row, and returns true if it agrees.
    fn compare(&mut self, rows: &ProgramRows, row: usize, step: i64, at: &At) -> bool {
        let mut agrees = true;
        for column in &rows.columns {
            let (yours, scheme) = (column.values[row], at.values[column.place]);
            agrees &= column.agrees(yours, scheme, at.slack[column.place]);
            let off = (yours - scheme).abs();
            self.is_rounded[column.place] |= off > within(column.place, scheme);
            let worst = &mut self.worst[column.place / 3];
            if worst.is_none_or(|worst| off > worst.off) {
                let place = column.place;
                *worst = Some(Worst { off, place, step });
            }
        }
        if agrees {
            self.agreeing += 1;
            self.moves |= step > 0;
        } else {
            let scheme = at.values;
            self.differs = Some(RowDifference { row, step, scheme });
        }
        agrees
    }
}

/// Compares `rows`, at the given `steps`, with `run` at several offsets at once. Returns the agreement for the best
/// offset.
pub fn compare_rows<A: Stepper, B: Stepper>(
    rows: &ProgramRows,
    steps: &RowSteps,
    mut run: ReferenceRun<A, B>,
) -> RowAgreement {
    let mut lanes = OFFSETS.map(|offset| RowAgreement {
        offset,
        ..RowAgreement::default()
    });
    let count = rows.count;
    let is_active = |lane: &RowAgreement| lane.next < count && lane.differs.is_none();
    let mut step = 0;
    while lanes.iter().any(is_active) && (is_active(&lanes[0]) || !lanes[0].is_whole()) {
        let Some(at) = run.now(rows) else {
            for lane in lanes.iter_mut().filter(|lane| is_active(lane)) {
                lane.parted = Some(step);
            }
            break;
        };
        for lane in lanes.iter_mut().filter(|lane| is_active(lane)) {
            lane.compare_due_rows(rows, steps, step, &at);
        }
        run.step();
        step += 1;
    }
    // Of equal results the first wins. A repeated start alone does not count as agreement.
    lanes
        .into_iter()
        .filter(|lane| lane.offset >= 0 || lane.moves)
        .reduce(
            |best: RowAgreement, lane: RowAgreement| match (best.is_whole(), lane.is_whole()) {
                (true, _) => best,
                (false, true) => lane,
                _ if lane.agreeing > best.agreeing => lane,
                _ => best,
            },
        )
        .unwrap_or_default()
}

/// Returns the largest difference between `run` and the first `count` rows at `offset`, in units of the tolerance. Rows
/// after rounding has taken over are not counted.
pub fn difference<A: Stepper, B: Stepper>(
    rows: &ProgramRows,
    count: usize,
    steps: &RowSteps,
    offset: i64,
    mut run: ReferenceRun<A, B>,
) -> f64 {
    let (mut most, mut step): (f64, i64) = (0.0, 0);
    let late = offset * steps.stride;
    for (row, of_row) in steps.of_rows[..count].iter().enumerate() {
        while step < of_row.saturating_add(late) {
            run.step();
            step += 1;
            if run.rounding != Rounding::Double {
                run.now(rows); // the errors of every step count
            }
        }
        let Some(at) = run.now(rows) else {
            break;
        };
        for column in &rows.columns {
            let (yours, value) = (column.values[row], at.values[column.place]);
            let room = column.room(value) + at.slack[column.place];
            most = most.max((yours - value).abs() / room);
        }
    }
    most
}
