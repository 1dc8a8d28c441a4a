//! The least and the greatest of a run's numbers, over every step that it has taken, its start included; and by how much
//! the axle's tilt swings: the greatest tilt less the least since the forces last changed.
//!
//! Where the steps follow the swing, the row nearest to a turning point is off it by what a parabola through it and its
//! neighbours says; that is stated as the uncertainty, and not added to the value. Where they do not (fewer than six rows a
//! swing: a strobed run) the rows are phases of the swing in no order. How much the second half of them has added to the
//! swing of the first then tells how much is still unseen.

use super::swings::height_in;
use super::turns::MeasuredNumber;
use crate::physics::observables::tilt_of;
use crate::run::Step;
use nalgebra::Vector3;

/// Where the heights of two tilts differ by less than this, the tilts themselves are compared.
const EQUAL_HEIGHTS: f64 = 1e-14;

/// With fewer turning points there has been no whole swing.
const LEAST_TURNS: u64 = 3;
/// Rows with more than one turning point among them: the run is strobed.
const STROBED: u64 = 3;
/// What the parabola does not see, in units of its second difference squared over the swing: with it the uncertainty covers
/// swings of six rows.
const BEYOND_PARABOLA: f64 = 0.05;
/// Rounding of a tilt, degrees.
const ROUNDING_DEG: f64 = 1e-12;

/// Extremes of tilt and height of a run. They are those of the CSV's columns, to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    pub tilt: Tilts,
    /// Least z of the traced point, m.
    pub lowest_z_m: f64,
    /// Greatest z of the traced point, m.
    pub highest_z_m: f64,
}

/// The extremes of the axle's tilt from +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilts {
    pub lowest_deg: f64,
    pub highest_deg: f64,
    /// The least and the greatest height of the axle, see [`height_in`]: the height falls as the tilt grows.
    heights: (f64, f64),
}

impl Extremes {
    /// Of the run that stands at `step`.
    pub fn new(step: &Step) -> Self {
        let z = step.position().z;
        Self {
            tilt: Tilts::new(step),
            lowest_z_m: z,
            highest_z_m: z,
        }
    }

    /// Takes in the next `step`, at which the axle has this height.
    #[inline]
    pub(super) fn record(&mut self, step: &Step, height: f64) {
        let z = step.position().z;
        self.lowest_z_m = self.lowest_z_m.min(z);
        self.highest_z_m = self.highest_z_m.max(z);
        self.tilt.record(step, height);
    }
}

impl Tilts {
    fn new(step: &Step) -> Self {
        let (tilt, height) = (step.tilt_deg(), height_in(step.after()));
        Self {
            lowest_deg: tilt,
            highest_deg: tilt,
            heights: (height, height),
        }
    }

    #[inline]
    fn record(&mut self, step: &Step, height: f64) {
        // An arc tangent at every step would cost as much as some schemes' step: it is taken only where the axle is
        // about as low or as high as it has ever been.
        let (least, greatest) = self.heights;
        if height > least + EQUAL_HEIGHTS && height < greatest - EQUAL_HEIGHTS {
            return;
        }
        let tilt = step.tilt_deg();
        self.heights = (least.min(height), greatest.max(height));
        self.lowest_deg = self.lowest_deg.min(tilt);
        self.highest_deg = self.highest_deg.max(tilt);
    }

    /// The greatest tilt less the least, degrees.
    fn swing_deg(&self) -> f64 {
        self.highest_deg - self.lowest_deg
    }
}

/// Follows the tilt; to be shown every step since the forces last changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TiltSwing {
    rows: u64,
    turns: u64,
    /// The axle at the last two rows, and its [height].
    last: [(Vector3<f64>, f64); 2],
    tilts: Tilts,
    /// The lowest and the highest turning point among the rows.
    turned: [Option<TurningRow>; 2],
    /// The swing at the last two numbers of rows that were powers of two, degrees.
    earlier: [f64; 2],
}

/// A turning point, at the row nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TurningRow {
    tilt_deg: f64,
    height: f64,
    /// By how much the parabola through it and its neighbours reaches beyond the row, degrees.
    beyond: f64,
    /// The second difference of the three, without its sign, degrees.
    bend: f64,
}

impl TiltSwing {
    pub fn new(step: &Step) -> Self {
        let row = (step.after().axle(), height_in(step.after()));
        Self {
            rows: 1,
            turns: 0,
            last: [row; 2],
            tilts: Tilts::new(step),
            turned: [None; 2],
            earlier: [0.0; 2],
        }
    }

    /// Takes in the next `step`, at which the axle has this height.
    #[inline]
    pub fn record(&mut self, step: &Step, height: f64) {
        let row = (step.after().axle(), height);
        let [before, at] = self.last;
        // The height falls as the tilt grows.
        let is_top = at.1 < before.1 && at.1 <= row.1;
        if is_top || (at.1 > before.1 && at.1 >= row.1) {
            self.turn(is_top, [before, at, row]);
        }
        self.last = [at, row];
        self.rows += 1;
        self.tilts.record(step, height);
        if self.rows.is_power_of_two() {
            self.earlier = [self.earlier[1], self.tilts.swing_deg()];
        }
    }

    /// Takes in three consecutive rows; the middle one is a turning point.
    fn turn(&mut self, is_top: bool, rows: [(Vector3<f64>, f64); 3]) {
        self.turns += 1;
        let sign = if is_top { 1.0 } else { -1.0 };
        let record = &mut self.turned[usize::from(is_top)];
        let height = rows[1].1;
        if record.is_some_and(|there| sign * height > sign * there.height + EQUAL_HEIGHTS) {
            return;
        }
        let [before, at, after] = rows.map(|(axle, _)| tilt_of(&axle));
        if record.is_none_or(|there| sign * at > sign * there.tilt_deg) {
            let bend = (sign * (2.0 * at - before - after)).max(f64::MIN_POSITIVE);
            let beyond = ((before - after).powi(2) / (8.0 * bend)).min(bend);
            *record = Some(TurningRow {
                tilt_deg: at,
                height,
                beyond,
                bend,
            });
        }
    }

    /// The swing so far, degrees; `None` before it was seen whole.
    pub fn measured(&self) -> Option<MeasuredNumber> {
        let [Some(bottom), Some(top)] = self.turned else {
            return None;
        };
        let swing = self.tilts.swing_deg();
        // The start of the run may be a turning point too, and lie beyond those between two rows.
        let above = top.tilt_deg + top.beyond - self.tilts.highest_deg;
        let below = self.tilts.lowest_deg - (bottom.tilt_deg - bottom.beyond);
        let bends = top.bend.powi(2) + bottom.bend.powi(2);
        let unseen = if self.turns * STROBED > self.rows {
            swing - self.earlier[0] + 20.0 * swing / (self.rows as f64).powi(2)
        } else if swing > 0.0 {
            above.max(0.0) + below.max(0.0) + BEYOND_PARABOLA * bends / swing
        } else {
            0.0
        };
        (self.turns >= LEAST_TURNS).then_some(MeasuredNumber {
            value: swing,
            uncertainty: unseen + ROUNDING_DEG,
            nutations: self.turns / 2,
        })
    }
}
