//! The least and the greatest of a run's numbers, over every step that it has taken, its start included.

use super::swings::height_in;
use crate::run::Step;

/// Where the heights of two tilts differ by less than this, the tilts themselves are compared.
pub(super) const NEAR: f64 = 1e-14;

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
    pub(super) fn follow(&mut self, step: &Step, height: f64) {
        let z = step.position().z;
        self.lowest_z_m = self.lowest_z_m.min(z);
        self.highest_z_m = self.highest_z_m.max(z);
        self.tilt.follow(step, height);
    }
}

impl Tilts {
    pub(super) fn new(step: &Step) -> Self {
        let (tilt, height) = (step.tilt_deg(), height_in(step.after()));
        Self {
            lowest_deg: tilt,
            highest_deg: tilt,
            heights: (height, height),
        }
    }

    #[inline]
    pub(super) fn follow(&mut self, step: &Step, height: f64) {
        // An arc tangent at every step would cost as much as some schemes' step: it is taken only where the axle is
        // about as low or as high as it has ever been.
        let (least, greatest) = self.heights;
        if height > least + NEAR && height < greatest - NEAR {
            return;
        }
        let tilt = step.tilt_deg();
        self.heights = (least.min(height), greatest.max(height));
        self.lowest_deg = self.lowest_deg.min(tilt);
        self.highest_deg = self.highest_deg.max(tilt);
    }

    /// The greatest tilt less the least, degrees.
    pub(super) fn swing_deg(&self) -> f64 {
        self.highest_deg - self.lowest_deg
    }
}
