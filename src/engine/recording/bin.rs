//! Data types of a recording: the curves, their values at one sample, and their extremes over many.

use crate::physics::State;
use crate::run::Sample;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RecordedCurve {
    /// x of the traced point, world frame, m.
    X,
    /// y of the traced point, world frame, m.
    Y,
    /// z of the traced point, world frame, m.
    Z,
    /// Angle of the axle from +z, degrees.
    Tilt,
}

impl RecordedCurve {
    pub const ALL: [Self; 4] = [Self::X, Self::Y, Self::Z, Self::Tilt];

    pub const OF_POINT: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Returns the name of the curve's column in a CSV and among the readouts.
    pub fn column(self) -> &'static str {
        self.named().2
    }

    pub fn name(self) -> &'static str {
        self.named().0
    }

    /// Returns the unit of its extents, as written after numbers.
    pub fn unit(self) -> &'static str {
        self.named().1
    }

    pub fn at(self, sample: &Sample) -> f64 {
        match self {
            Self::X => sample.position.x,
            Self::Y => sample.position.y,
            Self::Z => sample.position.z,
            Self::Tilt => sample.tilt_deg,
        }
    }

    fn of_stored(self, stored: f64) -> f64 {
        match self {
            Self::X | Self::Y | Self::Z => stored,
            Self::Tilt => tilt_deg(stored),
        }
    }

    pub fn in_its_unit(self, stored: Extent) -> Extent {
        Extent {
            min: self.of_stored(stored.min),
            max: self.of_stored(stored.max),
        }
    }

    fn named(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::X => ("x", "m", "x_m"),
            Self::Y => ("y", "m", "y_m"),
            Self::Z => ("z", "m", "z_m"),
            Self::Tilt => ("tilt", "deg", "tilt_deg"),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedSample {
    pub time_s: f64,
    /// Traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Height of the axle's direction, a unit vector, which is the cosine of the tilt.
    pub axle_height: f64,
}

impl RecordedSample {
    pub fn new(state: &State, traced: &Vector3<f64>) -> Self {
        Self {
            time_s: state.time_s,
            position: state.orientation * traced,
            axle_height: state.axle().z,
        }
    }

    pub fn is_finite(&self) -> bool {
        self.values().iter().all(|value| value.is_finite())
    }

    pub fn value(&self, curve: RecordedCurve) -> f64 {
        curve.of_stored(self.values()[curve as usize])
    }

    /// Returns the stored value of each curve. For the tilt, it is the negative cosine, which grows with the tilt and
    /// saves an arc cosine at every step.
    pub(super) fn values(&self) -> [f64; 4] {
        let at = &self.position;
        [at.x, at.y, at.z, -self.axle_height]
    }
}

/// Minimum and maximum over an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    pub min: f64,
    pub max: f64,
}

impl Extent {
    pub fn single(value: f64) -> Self {
        Self {
            min: value,
            max: value,
        }
    }

    /// Returns the extent of both. It avoids [`f64::min`], which takes several instructions because of NaN.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        let Self { min, max } = self;
        Self {
            min: if other.min < min { other.min } else { min },
            max: if other.max > max { other.max } else { max },
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordingBin {
    /// Time of the first sample, s.
    pub begin_s: f64,
    /// Time of the last sample, s.
    pub end_s: f64,
    samples: u64,
    pub extents: [Extent; 4],
    /// Number of turns of each curve, from up to down or from down to up.
    pub turned: [u32; 4],
    pub last: [f64; 4],
}

impl RecordingBin {
    pub fn extent(&self, curve: RecordedCurve) -> Extent {
        curve.in_its_unit(self.stored(curve))
    }

    /// Returns the extremes of the stored value of `curve`. Convert them only when they are drawn: an arc cosine for
    /// every bin would be too slow.
    pub fn stored(&self, curve: RecordedCurve) -> Extent {
        self.extents[curve as usize]
    }

    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Returns the number of turns of `curve` in the bin, up or down: two in each swing.
    pub fn turns(&self, curve: RecordedCurve) -> u32 {
        self.turned[curve as usize]
    }

    /// Returns the traced point at the last sample, world frame, m.
    pub fn end(&self) -> Vector3<f64> {
        let [x, y, z, _] = self.last;
        Vector3::new(x, y, z)
    }

    #[inline]
    pub(super) fn new(time_s: f64, values: [f64; 4], turned: [u32; 4]) -> Self {
        Self {
            begin_s: time_s,
            end_s: time_s,
            samples: 1,
            extents: values.map(Extent::single),
            turned,
            last: values,
        }
    }

    #[inline]
    pub fn and(self, later: Self) -> Self {
        Self {
            begin_s: self.begin_s,
            samples: self.samples + later.samples,
            extents: std::array::from_fn(|curve| self.extents[curve].and(later.extents[curve])),
            turned: std::array::from_fn(|curve| self.turned[curve] + later.turned[curve]),
            ..later
        }
    }
}

/// Returns the tilt of an axle, degrees, from the negative cosine of the tilt. Near the vertical it is accurate to a
/// millionth of a degree, which is enough for a picture but not for a printed number.
fn tilt_deg(negative_cosine: f64) -> f64 {
    libm::acos((-negative_cosine).clamp(-1.0, 1.0)).to_degrees()
}
