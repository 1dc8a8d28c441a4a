//! The least and the greatest of a run's numbers, over every step that it has taken, its start included.

use crate::run::Step;

/// Where the heights of two tilts differ by less than this, the tilts themselves are compared.
pub(super) const NEAR: f64 = 1e-14;

/// Extremes of tilt and height; to be shown every step of a run. They are those of the CSV's columns, to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Least tilt of the axle from +z, degrees.
    pub lowest_tilt_deg: f64,
    /// Greatest tilt of the axle from +z, degrees.
    pub highest_tilt_deg: f64,
    /// Least z of the traced point, m.
    pub lowest_z_m: f64,
    /// Greatest z of the traced point, m.
    pub highest_z_m: f64,
    /// Least and greatest [height](height) of the axle so far.
    heights: (f64, f64),
}

impl Extremes {
    /// Of the run that stands at `step`.
    pub fn new(step: &Step) -> Self {
        let (tilt, z, height) = (step.tilt_deg(), step.position().z, height(step));
        Self {
            lowest_tilt_deg: tilt,
            highest_tilt_deg: tilt,
            lowest_z_m: z,
            highest_z_m: z,
            heights: (height, height),
        }
    }

    #[inline]
    pub fn follow(&mut self, step: &Step) {
        let z = step.position().z;
        self.lowest_z_m = self.lowest_z_m.min(z);
        self.highest_z_m = self.highest_z_m.max(z);
        // An arc tangent at every step would cost as much as some schemes' step: it is taken only where the axle is
        // about as low or as high as it has ever been.
        let height = height(step);
        let (least, greatest) = self.heights;
        if height > least + NEAR && height < greatest - NEAR {
            return;
        }
        let tilt = step.tilt_deg();
        self.heights = (least.min(height), greatest.max(height));
        self.lowest_tilt_deg = self.lowest_tilt_deg.min(tilt);
        self.highest_tilt_deg = self.highest_tilt_deg.max(tilt);
    }
}

/// cos|cos| of the tilt, with no root to take: it falls as the tilt grows, by no more than the tilt grows (rad).
pub(super) fn height(step: &Step) -> f64 {
    let axle = step.after().axle();
    axle.z * axle.z.abs() / axle.norm_squared()
}
