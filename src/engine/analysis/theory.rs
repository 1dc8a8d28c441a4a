//! Textbook theory of the top that is being run, from its exact motion.
//!
//! Source: H. Goldstein, Classical Mechanics, section 5.7 (the heavy symmetrical top with one point fixed).

use crate::physics::symmetry::steady_precession;
use crate::physics::{LagrangeTop, State, SymmetricTop};
use crate::text::number::significant;
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::fmt;

/// Theory of one heavy symmetric top under its present loads.
///
/// "Vertical" is the direction opposite to the load. For gravity alone that is +z. Under a tilted load, such as a
/// sideways push on the axle, it is another direction. For a load along z, up or down, it is +z. Without a load, it is
/// the direction of L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// Axis of precession, tilts and path.
    pub axis: TheoryAxis,
    /// Moment of the load, N m: M g h for gravity alone, negative if it pulls the axle to +z.
    pub load: f64,
    /// L3 = L·axle, J s. It is constant during the motion.
    pub axle_momentum: f64,
    /// Precession of a fast top, mgl/L3, rad/s. `None` without spin.
    pub fast_top_precession: Option<f64>,
    /// Slow steady precession at this tilt, rad/s. `None` if the top spins too slowly for it.
    pub slow_precession: Option<f64>,
    /// Fast steady precession at this tilt, rad/s. It is also `None` for a level axle.
    pub fast_precession: Option<f64>,
    /// Mean precession of the exact motion, rad/s. `None` if the axle passes through the vertical, where it has no
    /// azimuth.
    pub precession: Option<f64>,
    /// Nutation of a fast top, L3/I1, rad/s.
    pub fast_top_nutation: f64,
    /// Period in which the instantaneous axis goes round the figure axis, seen from the body, s: (I1/|I3 - I1|) 2π/ω3.
    /// `None` if the body is not free, does not spin, or has I3 = I1.
    pub body_cone_period_s: Option<f64>,
    /// Nutation period of the exact motion, s. `None` if the motion does not repeat.
    pub nutation_period_s: Option<f64>,
    /// Minimum and maximum tilt of the exact motion, degrees.
    pub tilt_range_deg: (f64, f64),
    /// Minimum |L3| with which this top sleeps, J s: L3² > 4 I1 mgl. `None` if the load pulls the axle up, so that it
    /// is stable without spin.
    pub sleeping_limit: Option<f64>,
    /// Tilt at which the azimuth of the axle stops, degrees, which is the height of the cusps. `None` if it never
    /// stops.
    pub cusp_tilt_deg: Option<f64>,
    pub path: AxlePath,
    /// True with friction. The theory then describes the motion that would follow if friction ceased now. Only the
    /// rates at this moment are true of the real motion.
    pub is_of_a_moment: bool,
    /// [Asymmetry](SymmetricTop::nearly) of the body. If it is above 0, the theory uses the mean moment of inertia
    /// across the axle.
    pub asymmetry: f64,
}

/// Axis of a theory. Its tilts are angles from this axis, and its precession turns about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TheoryAxis {
    /// +z, which is also the axis of the measured tilts and azimuths.
    Z,
    /// Direction opposite to a load that does not pull along -z; a unit vector, world frame.
    AgainstLoad(Vector3<f64>),
    /// Direction of L, if there is no load.
    Momentum,
}

impl TheoryAxis {
    /// Returns the axis that points along `up` (unit vector, world frame): opposite to the load or, without a load,
    /// along L.
    fn new(up: Vector3<f64>, is_loaded: bool) -> Self {
        if (up - Vector3::z()).norm() <= SAME_DIRECTION {
            Self::Z
        } else if is_loaded {
            Self::AgainstLoad(up)
        } else {
            Self::Momentum
        }
    }
}

impl fmt::Display for TheoryAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Z => f.write_str("+z"),
            Self::Momentum => f.write_str("L"),
            Self::AgainstLoad(up) => {
                let [x, y, z] = [up.x, up.y, up.z].map(|part| part + 0.0); // no -0
                write!(f, "the forces' vertical ({x:.3}, {y:.3}, {z:.3})")
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxlePath {
    /// No nutation.
    Circle,
    /// The axle stops at one end of every nutation.
    Cusps,
    /// The axle goes backwards at one end of every nutation.
    Loops,
    /// The axle always goes in the same direction.
    Waves,
    /// The axle passes through the vertical, or stays there.
    ThroughVertical,
}

impl AxlePath {
    pub const ALL: [Self; 5] = [
        Self::Circle,
        Self::Cusps,
        Self::Loops,
        Self::Waves,
        Self::ThroughVertical,
    ];
}

impl fmt::Display for AxlePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Circle => "circle",
            Self::Cusps => "cusps",
            Self::Loops => "loops",
            Self::Waves => "waves",
            Self::ThroughVertical => "through the vertical",
        })
    }
}

/// Swings and differences of the tilt below this are rounding, degrees.
const SAME_DEG: f64 = 1e-6;

/// Angle below which two directions are equal except for rounding, rad.
const SAME_DIRECTION: f64 = 1e-9;

/// Maximum height of a level axle, as a fraction of its length. It is larger than rounding and a scheme's error.
const LEVEL: f64 = 1e-6;

/// Spins below this fraction of the momenta in the motion are rounding.
const SAME_PART: f64 = 1e-12;

/// Angle from the vertical below which an axle passes through it, except for rounding, rad.
const PASSES_RAD: f64 = 1e-7;

impl Theory {
    /// Returns the theory of `top` in `state`, for the exact motion `motion`. `load` is the moment of the load, N m,
    /// world frame, as [`Loads::on_axle`](crate::physics::Loads::on_axle) returns it.
    pub fn new(
        top: &SymmetricTop,
        load: &Vector3<f64>,
        motion: &LagrangeTop,
        state: &State,
    ) -> Self {
        let axle = state.axle();
        // Without a load the axle turns about L.
        let up = -load
            .try_normalize(0.0)
            .unwrap_or_else(|| -state.momentum.try_normalize(0.0).unwrap_or(axle));
        let (size, spin) = (load.norm(), state.momentum.dot(&axle));
        let momenta = state.momentum.norm() + (top.across * size).sqrt();
        let spins = spin.abs() > SAME_PART * momenta;
        let (low, high) = motion.tilt_range();
        // A rotation about -z is the opposite rotation about +z, from which tilts and azimuths are measured.
        let is_turned_over = (up + Vector3::z()).norm() <= SAME_DIRECTION;
        let (up, upward_load, way, (low, high)) = if is_turned_over {
            (-up, -size, -1.0, (PI - high, PI - low))
        } else {
            (up, size, 1.0, (low, high))
        };
        let is_through_vertical = low <= PASSES_RAD || high >= PI - PASSES_RAD;
        let tilt_range_deg = (low.to_degrees(), high.to_degrees());
        let cosine = Some(axle.dot(&up)).filter(|cosine| cosine.abs() > LEVEL);
        let (slow, fast) = if spins {
            steady_precession(top.across * cosine.unwrap_or(0.0), spin, upward_load)
        } else {
            (None, None)
        };
        let cusp_cosine = state.momentum.dot(&up) / spin;
        let cusp_tilt_deg = (size > 0.0 && spins && cusp_cosine.abs() <= 1.0)
            .then(|| libm::acos(cusp_cosine).to_degrees());
        Self {
            axis: TheoryAxis::new(up, size > 0.0),
            load: upward_load,
            axle_momentum: spin,
            fast_top_precession: spins.then(|| upward_load / spin),
            slow_precession: slow,
            fast_precession: fast,
            precession: (!is_through_vertical).then(|| way * motion.mean_precession()),
            fast_top_nutation: spin / top.across,
            body_cone_period_s: body_cone_period_s(top, spin, size).filter(|_| spins),
            nutation_period_s: motion.nutation_period(),
            tilt_range_deg,
            sleeping_limit: (upward_load >= 0.0).then(|| 2.0 * (top.across * size).sqrt()),
            cusp_tilt_deg,
            path: if is_through_vertical {
                AxlePath::ThroughVertical
            } else {
                path(tilt_range_deg, cusp_tilt_deg)
            },
            is_of_a_moment: false,
            asymmetry: 0.0,
        }
    }

    /// Returns the theory of a top in its unstable equilibrium: it stays there, and only rounding would tip it over.
    pub fn in_balance(self) -> Self {
        let tilt_deg = if self.load < 0.0 { 180.0 } else { 0.0 };
        Self {
            precession: None,
            nutation_period_s: None,
            tilt_range_deg: (tilt_deg, tilt_deg),
            ..self
        }
    }

    /// Describes how asymmetric the body is, and the top that the theory describes. `None` for a symmetric body.
    pub fn of_mean_moment(&self) -> Option<String> {
        let percent = significant(100.0 * self.asymmetry, 2);
        (self.asymmetry > 0.0)
            .then(|| format!("{percent} %; theory uses the mean moment across the axle"))
    }

    /// Returns the time of one turn of the mean precession, s. `None` if there is no precession or its rate is 0.
    pub fn precession_period_s(&self) -> Option<f64> {
        let rate = self.precession?.abs();
        Some(2.0 * PI / rate).filter(|period_s| period_s.is_finite())
    }
}

/// Returns the period of the body cone of `top`, s. `spin` is L3, J s, and `load` is the moment of the forces, N m.
/// `None` if `load` is more than rounding, or the moments of inertia are equal except for rounding.
fn body_cone_period_s(top: &SymmetricTop, spin: f64, load: f64) -> Option<f64> {
    // A load changes the period by a fraction of about load·I1/L3².
    let is_free = load * top.across <= SAME_DIRECTION * spin * spin;
    let difference = (top.along - top.across).abs();
    let differs = difference > SAME_DIRECTION * top.across;
    (is_free && differs)
        .then(|| top.across / difference * 2.0 * PI * (top.along / spin).abs())
        .filter(|period_s| period_s.is_finite())
}

fn path((low, high): (f64, f64), cusp: Option<f64>) -> AxlePath {
    match cusp {
        _ if high - low <= SAME_DEG => AxlePath::Circle,
        Some(tilt) if tilt > low + SAME_DEG && tilt < high - SAME_DEG => AxlePath::Loops,
        Some(tilt) if (tilt - low).abs() <= SAME_DEG || (tilt - high).abs() <= SAME_DEG => {
            AxlePath::Cusps
        }
        _ => AxlePath::Waves,
    }
}
