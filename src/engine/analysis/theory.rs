//! What the textbook says of the top that is being run, from its exact motion.
//!
//! Source: H. Goldstein, Classical Mechanics, section 5.7 (the heavy symmetrical top with one point fixed).

use crate::physics::symmetry::steady_precession;
use crate::physics::{LagrangeTop, State, SymmetricTop};
use crate::text::number::significant;
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::fmt;

/// The theory of one heavy symmetric top under its present loads, of which only gravity is vertical by right: under a
/// tilted load (a sideways push on the axle) "vertical" is the direction opposite to it, and without a load that of L. A
/// load along z, up or down, has +z for its vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// The axis about which precession, tilts and path are meant.
    pub axis: TheoryAxis,
    /// Moment of the load, N m: M g h for gravity alone, negative where it pulls the axle to +z.
    pub load: f64,
    /// L3 = L·axle, J s, a constant of the motion.
    pub axle_momentum: f64,
    /// The fast top's precession mgl/L3, rad/s; `None` without spin.
    pub fast_top_precession: Option<f64>,
    /// Steady precession at this tilt, the slow root, rad/s; `None` where the top is too slow for it.
    pub slow_precession: Option<f64>,
    /// The fast root, rad/s; `None` too for a level axle.
    pub fast_precession: Option<f64>,
    /// Mean precession of this very motion, rad/s; `None` where the axle passes through the vertical, and has no azimuth.
    pub precession: Option<f64>,
    /// The fast top's nutation L3/I1, rad/s.
    pub fast_top_nutation: f64,
    /// The period in which the instantaneous axis goes round the figure axis as seen from the body, s: (I1/|I3 - I1|) 2π/ω3;
    /// `None` where the body is not free, does not spin, or has no such motion because I3 = I1.
    pub body_cone_period_s: Option<f64>,
    /// Nutation period of this very motion, s; `None` where nothing returns.
    pub nutation_period_s: Option<f64>,
    /// Least and greatest tilt of this very motion, degrees.
    pub tilt_range_deg: (f64, f64),
    /// The least |L3| with which this top sleeps, J s: L3² > 4 I1 mgl; `None` where the load pulls the axle up, so that it
    /// stands without spin.
    pub sleeping_limit: Option<f64>,
    /// Tilt at which the axle stands still in azimuth, degrees: the height of the cusps; `None` where it never does.
    pub cusp_tilt_deg: Option<f64>,
    pub path: AxlePath,
    /// Whether there is friction: then all this is of the motion that would follow if it ceased now, and no part of the
    /// motion that does follow, but for the rates at this moment.
    pub is_of_a_moment: bool,
    /// The [asymmetry](SymmetricTop::nearly) of the body: above 0 the theory is that of the mean moment across.
    pub asymmetry: f64,
}

/// The axis that a theory speaks of: its tilts are angles from it, its precession turns about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TheoryAxis {
    /// +z, from which the measured tilts and azimuths count too.
    Z,
    /// The direction opposite to a load that does not pull along -z; a unit vector, world frame.
    AgainstLoad(Vector3<f64>),
    /// The direction of L: there is no load.
    Momentum,
}

impl TheoryAxis {
    /// The axis that points along `up` (unit vector, world frame), opposite to a load or, without one, along L.
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
    /// It comes to rest at one end of every nutation.
    Cusps,
    /// It goes backwards at one end of every nutation.
    Loops,
    /// It always goes the same way.
    Waves,
    /// It passes through the vertical, or stays there.
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

/// A swing of the tilt below this (degrees) is rounding, and so is a difference between two tilts.
const SAME_DEG: f64 = 1e-6;

/// Two directions nearer to each other than this (rad) are one but for rounding.
const SAME_DIRECTION: f64 = 1e-9;

/// An axle whose height is less than this part of its length is level: rounding and a scheme's error are more than that.
const LEVEL: f64 = 1e-6;

/// A spin below this part of the momenta that the motion is made of is rounding.
const SAME_PART: f64 = 1e-12;

/// An axle that comes so near to the vertical (rad) passes through it but for rounding.
const PASSES_RAD: f64 = 1e-7;

impl Theory {
    /// The theory of `top` whose exact motion is `motion`, as it is in `state`; `load` is the moment of the load, N m,
    /// world frame, as [`Loads::on_axle`](crate::physics::Loads::on_axle) gives it.
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
        // What turns about -z turns the other way about +z, from which tilts and azimuths are measured.
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

    /// Returns the same of a top that is in its unstable equilibrium: it stays there, and rounding alone would tip it over.
    pub fn in_balance(self) -> Self {
        let tilt_deg = if self.load < 0.0 { 180.0 } else { 0.0 };
        Self {
            precession: None,
            nutation_period_s: None,
            tilt_range_deg: (tilt_deg, tilt_deg),
            ..self
        }
    }

    /// Returns in words how asymmetric the body is, and so of which top the theory is; `None` for a symmetric body.
    pub fn of_mean_moment(&self) -> Option<String> {
        let percent = significant(100.0 * self.asymmetry, 2);
        (self.asymmetry > 0.0)
            .then(|| format!("{percent} %; theory is that of the mean moment across"))
    }

    /// The time of one turn of the mean precession, s; `None` where there is none, or it does not turn.
    pub fn precession_period_s(&self) -> Option<f64> {
        let rate = self.precession?.abs();
        Some(2.0 * PI / rate).filter(|period_s| period_s.is_finite())
    }
}

/// The period of the body cone of `top` with L3 = `spin`, J s; `None` where the moment `load`, N m, of the forces is more than
/// rounding, or the moments of inertia are the same but for that.
fn body_cone_period_s(top: &SymmetricTop, spin: f64, load: f64) -> Option<f64> {
    // By this share of itself a load changes the period, in the order of its size.
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
