//! Minimum and maximum of a run's numbers over every step, including the start, and the swing of the axle's tilt. The
//! swing is the maximum tilt minus the minimum since the forces last changed.
//!
//! If the steps follow the swing, the row nearest to a turning point misses it by an amount that a parabola through the
//! row and its neighbors gives. This amount is reported as the uncertainty, and is not added to the value.
//!
//! With fewer than six rows per swing the run is under-sampled: the rows are phases of the swing in no particular
//! order. The amount that their second half has added to the swing of the first half then tells how much is still
//! unseen.

use super::swings::height_in;
use super::turns::MeasuredNumber;
use crate::physics::observables::tilt_of;
use crate::run::Step;
use nalgebra::Vector3;

/// If the heights of two tilts differ by less than this, the tilts themselves are compared.
const EQUAL_HEIGHTS: f64 = 1e-14;

/// Minimum number of turning points of a whole swing.
const LEAST_TURNS: u64 = 3;
/// With fewer rows per turning point than this, the run is under-sampled.
const STROBED: u64 = 3;
/// Weight of the error that the parabola does not show, which is its second difference squared over the swing. With it,
/// the uncertainty covers swings of six rows.
const BEYOND_PARABOLA: f64 = 0.05;
/// Rounding error of a tilt, degrees.
const ROUNDING_DEG: f64 = 1e-12;

/// Extremes of a run's tilt and height. They equal the extremes of the CSV's columns to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    pub tilt: Tilts,
    /// Minimum z of the traced point, m.
    pub lowest_z_m: f64,
    /// Maximum z of the traced point, m.
    pub highest_z_m: f64,
}

/// The extremes of the axle's tilt from +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilts {
    pub lowest_deg: f64,
    pub highest_deg: f64,
    /// Minimum and maximum height of the axle, see [`height_in`]. The height falls as the tilt grows.
    heights: (f64, f64),
}

impl Extremes {
    /// Returns the extremes of a run that begins at `step`.
    pub fn new(step: &Step) -> Self {
        let z = step.position().z;
        Self {
            tilt: Tilts::new(step),
            lowest_z_m: z,
            highest_z_m: z,
        }
    }

    /// Records the next `step`. `height` is the height of the axle after it.
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
        // An arc tangent at every step would cost as much as a step of some schemes. It is computed only if the axle is
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

    /// Returns the maximum tilt minus the minimum, degrees.
    fn swing_deg(&self) -> f64 {
        self.highest_deg - self.lowest_deg
    }
}

/// Follows the tilt. It must receive every step since the forces last changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TiltSwing {
    rows: u64,
    turns: u64,
    /// Axle and its height at the last two rows.
    last: [(Vector3<f64>, f64); 2],
    tilts: Tilts,
    /// Lowest and highest turning point among the rows.
    turned: [Option<TurningRow>; 2],
    /// Swing at the last two row counts that were powers of two, degrees.
    earlier: [f64; 2],
}

/// A turning point, at the row nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TurningRow {
    tilt_deg: f64,
    height: f64,
    /// Amount by which the parabola through the row and its neighbors exceeds the row, degrees.
    beyond: f64,
    /// Absolute second difference of the three rows, degrees.
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

    /// Records the next `step`. `height` is the height of the axle after it.
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

    /// Records a turning point at the middle one of three consecutive rows.
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

    /// Returns the swing so far, degrees. `None` until a whole swing has been seen.
    pub fn measured(&self) -> Option<MeasuredNumber> {
        let [Some(bottom), Some(top)] = self.turned else {
            return None;
        };
        let swing = self.tilts.swing_deg();
        // The start of the run may be a turning point too, and lie beyond the turning points between two rows.
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
