//! Rows of a file beside a run: up to which of them they agree.

use super::arithmetic::Real;
use super::rows::{Rows, within};
use super::step::Program;
use super::times::Steps;
use crate::run::Simulation;

/// Two copies of a run have parted where they differ by more than this share of what right programs may differ by.
const PARTED: f64 = 0.1;
/// A difference within so many times the spread of the copies in single precision is of that precision.
const SPREADS: f64 = 10.0;
/// Rounding of numbers in single precision, in units of the largest: of the start, and of what is written.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
/// The offsets that are tried, in rows.
pub const OFFSETS: [i64; 3] = [0, 1, -1];

/// What a run is at one of its steps: the six numbers that may be compared, and what is not known of each.
#[derive(Clone, Copy, Debug)]
pub struct At {
    pub values: [f64; 6],
    pub slack: [f64; 6],
}

/// A run that rows are compared with. It begins at step 0.
pub trait Run {
    /// What it is now; `None` from where rounding has grown so much that nothing can be said.
    fn now(&mut self) -> Option<At>;
    fn step(&mut self);
}

/// Something that makes rows of six numbers.
pub trait Stepper {
    fn row(&self) -> [f64; 6];
    fn take_step(&mut self);
}

impl<T: Real> Stepper for Program<T> {
    fn row(&self) -> [f64; 6] {
        Self::row(self)
    }

    fn take_step(&mut self) {
        self.step();
    }
}

/// The scenario's own run; NaN once it has ended.
pub struct Scheme(pub Simulation);

impl Stepper for Scheme {
    fn row(&self) -> [f64; 6] {
        if self.0.has_ended() {
            return [f64::NAN; 6];
        }
        let (at, momentum) = (self.0.now().position(), self.0.now().after().momentum);
        [at.x, at.y, at.z, momentum.x, momentum.y, momentum.z]
    }

    fn take_step(&mut self) {
        // The row says it where the run has ended.
        let _ = self.0.step();
    }
}

/// A run, and a copy of it that adds up in another order.
pub struct Twin<A, B>(pub A, pub Option<B>);

impl<A: Stepper, B: Stepper> Run for Twin<A, B> {
    fn now(&mut self) -> Option<At> {
        let values = self.0.row();
        let others = self.1.as_ref().map_or(values, Stepper::row);
        let has_parted = |place: usize| {
            let off = (values[place] - others[place]).abs();
            off.is_nan() || off > PARTED * within(place, values[place])
        };
        let slack = [0.0; 6];
        (!(0..6).any(has_parted)).then_some(At { values, slack })
    }

    fn step(&mut self) {
        self.0.take_step();
        if let Some(other) = &mut self.1 {
            other.take_step();
        }
    }
}

/// The scheme's run, with the spread of three copies in single precision as what is not known.
pub struct Single {
    scheme: Scheme,
    copies: [Program<f32>; 3],
    /// The largest spread so far, and the largest number: of x, y, z, and of L.
    spread: [f64; 2],
    scale: [f64; 2],
}

impl Single {
    pub fn new(scheme: Scheme, copies: [Program<f32>; 3]) -> Self {
        let (spread, scale) = ([0.0; 2], [0.0; 2]);
        Self {
            scheme,
            copies,
            spread,
            scale,
        }
    }
}

impl Run for Single {
    fn now(&mut self) -> Option<At> {
        let values = self.scheme.row();
        let rows = self.copies.each_ref().map(Program::row);
        for place in 0..6 {
            let all = rows.map(|row| row[place]);
            let most = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let least = all.into_iter().fold(f64::INFINITY, f64::min);
            let (spread, scale) = (&mut self.spread[place / 3], &mut self.scale[place / 3]);
            *spread = spread.max(most - least);
            *scale = scale.max(values[place].abs());
        }
        let slack =
            |place: usize| SPREADS * self.spread[place / 3] + ROUNDING * self.scale[place / 3];
        let slack = [0, 1, 2, 3, 4, 5].map(slack);
        values
            .iter()
            .all(|value| value.is_finite())
            .then_some(At { values, slack })
    }

    fn step(&mut self) {
        self.scheme.take_step();
        for copy in &mut self.copies {
            copy.step();
        }
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
    /// The place of the column among those of the file.
    pub column: usize,
    pub step: i64,
}

impl Followed {
    /// Whether every row that could be compared agrees, and row `row` is one of them.
    pub fn explains(&self, row: usize) -> bool {
        self.differs.is_none() && self.agreeing > 0 && self.next > row
    }

    /// Whether nothing differs.
    pub fn is_whole(&self) -> bool {
        self.differs.is_none() && self.agreeing > 0
    }

    /// Takes in what the run is at `step`.
    fn take(&mut self, rows: &Rows, steps: &Steps, step: i64, at: &At, to_end: bool) {
        let (offset, count) = (self.offset * steps.stride, rows.values.len());
        let of = |row: usize| steps.of_rows[row].saturating_add(offset);
        while self.next < count && of(self.next) < step {
            self.next += 1; // before the start
        }
        if self.next < count && of(self.next) == step {
            self.next += usize::from(self.compare(rows, self.next, step, at) || to_end);
        }
    }

    /// Compares a row. Returns whether it agrees.
    fn compare(&mut self, rows: &Rows, row: usize, step: i64, at: &At) -> bool {
        let mut agrees = true;
        for (place, column) in rows.columns.iter().enumerate() {
            let (yours, scheme) = (rows.values[row][place], at.values[column.place]);
            agrees &= column.agrees(yours, scheme, at.slack[column.place]);
            let off = (yours - scheme).abs();
            let worst = &mut self.worst[column.place / 3];
            if worst.is_none_or(|worst| off > worst.off) {
                *worst = Some(Worst {
                    off,
                    column: place,
                    step,
                });
            }
        }
        if agrees {
            self.agreeing += 1;
        } else if self.differs.is_none() {
            let scheme = at.values;
            self.differs = Some(Difference { row, step, scheme });
        }
        agrees
    }
}

/// Follows `run` along the rows, which are the `steps` of it, at each of `offsets` at once, and gives the one at which the
/// most rows agree. Where `to_end`, rows are compared behind the first that differs too.
pub fn follow(
    rows: &Rows,
    steps: &Steps,
    run: &mut dyn Run,
    offsets: &[i64],
    to_end: bool,
) -> Followed {
    let lane = |&offset: &i64| Followed {
        offset,
        ..Followed::default()
    };
    let mut lanes: Vec<_> = offsets.iter().map(lane).collect();
    let count = rows.values.len();
    let goes_on = |lane: &Followed| lane.next < count && (to_end || lane.differs.is_none());
    let mut step = 0;
    let is_found = |lanes: &[Followed]| lanes[0].is_whole() && !goes_on(&lanes[0]);
    while lanes.iter().any(goes_on) && !is_found(&lanes) {
        let Some(at) = run.now() else {
            let unfinished = lanes.iter_mut().filter(|lane| goes_on(lane));
            unfinished.for_each(|lane| lane.parted = Some(step));
            break;
        };
        let going = lanes.iter_mut().filter(|lane| goes_on(lane));
        going.for_each(|lane| lane.take(rows, steps, step, &at, to_end));
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
