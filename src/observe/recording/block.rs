//! What a recording stores: the curves, their values at one moment, and their extremes over many.

use crate::physics::State;
use crate::run::Sample;
use nalgebra::Vector3;

/// The curves that are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// x of the traced point, world frame, m.
    X,
    /// y of the traced point, world frame, m.
    Y,
    /// z of the traced point, world frame, m.
    Z,
    /// Angle of the axle from +z, degrees.
    Tilt,
}

impl Curve {
    /// Every curve, in the order in which blocks hold them.
    pub const ALL: [Self; 4] = [Self::X, Self::Y, Self::Z, Self::Tilt];

    /// The curves of the traced point.
    pub const OF_POINT: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The curve of this [name](Self::name).
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }

    /// The name of its numbers in a CSV and among the readouts.
    pub fn column(self) -> &'static str {
        match self {
            Self::X => "x_m",
            Self::Y => "y_m",
            Self::Z => "z_m",
            Self::Tilt => "tilt_deg",
        }
    }

    /// What it is called where it is drawn.
    pub fn name(self) -> &'static str {
        self.named().0
    }

    /// The unit of its extents, as it is written after numbers.
    pub fn unit(self) -> &'static str {
        self.named().1
    }

    /// Its value at `sample`, in its unit.
    pub fn at(self, sample: &Sample) -> f64 {
        match self {
            Self::X => sample.position.x,
            Self::Y => sample.position.y,
            Self::Z => sample.position.z,
            Self::Tilt => sample.tilt_deg,
        }
    }

    /// A stored value of it in its unit.
    fn of_stored(self, stored: f64) -> f64 {
        match self {
            Self::X | Self::Y | Self::Z => stored,
            Self::Tilt => tilt_deg(stored),
        }
    }

    /// Stored extremes of it in its unit.
    pub(in crate::observe) fn in_its_unit(self, stored: Extent) -> Extent {
        Extent {
            min: self.of_stored(stored.min),
            max: self.of_stored(stored.max),
        }
    }

    /// Name and unit.
    fn named(self) -> (&'static str, &'static str) {
        match self {
            Self::X => ("x", "m"),
            Self::Y => ("y", "m"),
            Self::Z => ("z", "m"),
            Self::Tilt => ("tilt", "deg"),
        }
    }
}

/// The values of one moment that the pictures need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Time, s.
    pub time_s: f64,
    /// The traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Height of the axle's direction, a unit vector: the cosine of the tilt.
    pub axle_height: f64,
}

impl Moment {
    /// The values of `state`; the traced point is at `traced` (body frame, m).
    pub fn new(state: &State, traced: &Vector3<f64>) -> Self {
        Self {
            time_s: state.time_s,
            position: state.orientation * traced,
            axle_height: state.axle().z,
        }
    }

    /// Whether the traced point and the axle stand anywhere.
    pub fn is_finite(&self) -> bool {
        self.values().iter().all(|value| value.is_finite())
    }

    /// What `curve` has, in its unit.
    pub fn value(&self, curve: Curve) -> f64 {
        curve.of_stored(self.values()[curve as usize])
    }

    /// The stored value of each curve. For the tilt it is the negative cosine: it grows with the tilt, and saves computing
    /// an arc cosine at every step.
    pub(super) fn values(&self) -> [f64; 4] {
        let at = &self.position;
        [at.x, at.y, at.z, -self.axle_height]
    }
}

/// A moment as it is stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded {
    /// Time, s.
    pub time_s: f64,
    /// The stored value of each curve.
    values: [f64; 4],
    /// 1 for each curve that has turned here: gone up after it had gone down, or down after it had gone up; 0 for the others.
    turned: [u32; 4],
}

impl Recorded {
    #[inline]
    pub fn new(moment: &Moment, turned: [u32; 4]) -> Self {
        Self {
            time_s: moment.time_s,
            values: moment.values(),
            turned,
        }
    }
}

/// The smallest and largest value of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

impl Extent {
    /// The extent of one value.
    pub fn of(value: f64) -> Self {
        Self {
            min: value,
            max: value,
        }
    }

    /// The extent of both.
    pub fn and(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The extent of both, whose values are finite: one instruction for each, which [`f64::min`], with its care for what is
    /// no number, is not.
    #[inline]
    fn with(self, other: Self) -> Self {
        let Self { min, max } = self;
        Self {
            min: if other.min < min { other.min } else { min },
            max: if other.max > max { other.max } else { max },
        }
    }
}

/// A stretch of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Time of its first moment, s.
    pub begin_s: f64,
    /// Time of its last moment, s.
    pub end_s: f64,
    /// How many moments it has.
    moments: u64,
    /// Extremes of the stored value of each curve.
    pub(super) extents: [Extent; 4],
    /// How often each curve has turned: gone up after it had gone down, or down after it had gone up.
    turns: [u32; 4],
    /// The traced point at its last moment, world frame, m.
    pub end: Vector3<f64>,
}

impl Block {
    /// The extremes of `curve`, in its unit.
    pub fn extent(&self, curve: Curve) -> Extent {
        curve.in_its_unit(self.stored(curve))
    }

    /// The extremes of the stored value of `curve`: of many blocks only what is drawn in the end is worth an arc cosine.
    pub(in crate::observe) fn stored(&self, curve: Curve) -> Extent {
        self.extents[curve as usize]
    }

    /// How many moments it has.
    pub fn moments(&self) -> u64 {
        self.moments
    }

    /// How often `curve` turns in it, up or down: twice in a swing.
    pub fn turns(&self, curve: Curve) -> u32 {
        self.turns[curve as usize]
    }

    /// The block of one moment.
    #[inline]
    pub(super) fn of(moment: &Recorded) -> Self {
        let [x, y, z, _] = moment.values;
        Self {
            begin_s: moment.time_s,
            end_s: moment.time_s,
            moments: 1,
            extents: moment.values.map(Extent::of),
            turns: moment.turned,
            end: Vector3::new(x, y, z),
        }
    }

    /// The block of consecutive `moments`, whose values are finite; `None` of none.
    #[inline]
    pub(super) fn of_all<'a>(mut moments: impl Iterator<Item = &'a Recorded>) -> Option<Self> {
        let first = moments.next()?;
        let (mut least, mut greatest) = (first.values, first.values);
        let (mut turns, mut count, mut last) = (first.turned, 1, first);
        for moment in moments {
            for curve in 0..4 {
                let value = moment.values[curve];
                least[curve] = if value < least[curve] {
                    value
                } else {
                    least[curve]
                };
                greatest[curve] = if value > greatest[curve] {
                    value
                } else {
                    greatest[curve]
                };
                turns[curve] += moment.turned[curve];
            }
            (count, last) = (count + 1, moment);
        }
        Some(Self {
            begin_s: first.time_s,
            moments: count,
            extents: std::array::from_fn(|curve| Extent {
                min: least[curve],
                max: greatest[curve],
            }),
            turns,
            ..Self::of(last)
        })
    }

    /// Both as one; `later` begins where this one ends.
    #[inline]
    pub(super) fn and(&self, later: &Self) -> Self {
        Self {
            begin_s: self.begin_s,
            end_s: later.end_s,
            moments: self.moments + later.moments,
            extents: std::array::from_fn(|curve| self.extents[curve].with(later.extents[curve])),
            turns: std::array::from_fn(|curve| self.turns[curve] + later.turns[curve]),
            end: later.end,
        }
    }
}

/// The tilt of an axle, degrees, from the negative cosine of the tilt. Near the vertical it is accurate to a millionth of a
/// degree, which is enough for a picture but not for a printed number.
fn tilt_deg(negative_cosine: f64) -> f64 {
    libm::acos((-negative_cosine).clamp(-1.0, 1.0)).to_degrees()
}
