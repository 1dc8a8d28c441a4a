//! Solid parts of a body, each replaced by six points of the same mass, center and inertia.
//!
//! A rigid part of mass m, center c and principal moments A, B, C about its center moves as six points of m/6 at
//! c ± a e1, c ± b e2, c ± c3 e3 do (they are *equimomental* to it), where
//!
//! a² = 3 (B + C − A)/(2 m), b² = 3 (A + C − B)/(2 m), c3² = 3 (A + B − C)/(2 m).
//!
//! Every scheme therefore needs only points. Source: E. J. Routh, *The Elementary Part of a Treatise on the Dynamics of a
//! System of Rigid Bodies*, chapter 1, "equimomental bodies". The moments are in the tables of Goldstein and of Landau and
//! Lifshitz, *Mechanics*, section 32.

use super::PointMass;
use nalgebra::{Matrix3, Vector3};
use std::fmt;

/// A sum of two moments may be smaller than the third by this fraction of the largest. For a flat body both are equal,
/// except for rounding.
const MOMENT_SUM_ROUNDING: f64 = 1e-12;

/// The number of points of a part: its center, without mass, and the six.
pub const POINTS_PER_PART: usize = 7;

/// A solid in its own frame. Its axis is z and its center of mass is the origin. Lengths are in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A thin ring across the axis.
    Ring {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder about the axis; a disk if its length is 0.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Along the axis.
        length: f64,
    },
    /// A thick-walled tube about the axis.
    Tube {
        /// Radius of the hole.
        inner: f64,
        /// Radius of the outside.
        outer: f64,
        /// Along the axis.
        length: f64,
    },
    /// A thin rod along the axis.
    Rod {
        /// Its length.
        length: f64,
    },
    /// A solid ball.
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// A thin hollow ball.
    Shell {
        /// Its radius.
        radius: f64,
    },
    /// A solid cone. Its apex is at −z, three quarters of its length from the center of mass.
    Cone {
        /// Radius of its base.
        radius: f64,
        /// From the base to the apex.
        length: f64,
    },
    /// A box.
    Block {
        /// Its sides along x, y and the axis.
        size: Vector3<f64>,
    },
    /// Any solid with these principal moments divided by the mass, m²: about x, about y, about the axis.
    Moments(Vector3<f64>),
}

impl Shape {
    /// Returns the principal moments about the center divided by the mass, m²: about x, about y, about the axis.
    pub fn moments_per_mass(&self) -> Vector3<f64> {
        let symmetric = |along: f64, across: f64| Vector3::new(across, across, along);
        match *self {
            Self::Ring { radius } => {
                let along = radius * radius;
                symmetric(along, along / 2.0)
            }
            Self::Cylinder { radius, length } => {
                let along = radius * radius / 2.0;
                symmetric(along, along / 2.0 + length * length / 12.0)
            }
            Self::Tube {
                inner,
                outer,
                length,
            } => {
                let along = (inner * inner + outer * outer) / 2.0;
                symmetric(along, along / 2.0 + length * length / 12.0)
            }
            Self::Rod { length } => symmetric(0.0, length * length / 12.0),
            Self::Ball { radius } => Vector3::repeat(radius * radius * 2.0 / 5.0),
            Self::Shell { radius } => Vector3::repeat(radius * radius * 2.0 / 3.0),
            Self::Cone { radius, length } => symmetric(
                radius * radius * 3.0 / 10.0,
                3.0 * (4.0 * radius * radius + length * length) / 80.0,
            ),
            Self::Block { size } => {
                let [a, b, h] = [size.x * size.x, size.y * size.y, size.z * size.z];
                Vector3::new(b + h, a + h, a + b) / 12.0
            }
            Self::Moments(moments) => moments,
        }
    }

    /// Checks that a solid of this shape can have the dimensions.
    fn check(&self) -> Result<(), PartError> {
        match *self {
            Self::Ring { radius } | Self::Ball { radius } | Self::Shell { radius } => {
                above_zero("radius", radius)
            }
            Self::Cylinder { radius, length } => {
                above_zero("radius", radius)?;
                not_negative("length", length)
            }
            Self::Tube {
                inner,
                outer,
                length,
            } => {
                above_zero("outer", outer)?;
                not_negative("inner", inner)?;
                not_negative("length", length)?;
                require(inner <= outer, "inner", "must not be greater than outer")
            }
            Self::Rod { length } => above_zero("length", length),
            Self::Cone { radius, length } => {
                above_zero("radius", radius)?;
                above_zero("length", length)
            }
            Self::Block { size } => none_negative("size", &size),
            Self::Moments(moments) => none_negative("moments", &moments),
        }
    }
}

fn require(holds: bool, name: &'static str, rule: &'static str) -> Result<(), PartError> {
    if holds {
        Ok(())
    } else {
        Err(PartError::Dimension { name, rule })
    }
}

fn above_zero(name: &'static str, value: f64) -> Result<(), PartError> {
    require(value > 0.0, name, "must be greater than zero")
}

fn not_negative(name: &'static str, value: f64) -> Result<(), PartError> {
    require(value >= 0.0, name, "must not be negative")
}

fn none_negative(name: &'static str, values: &Vector3<f64>) -> Result<(), PartError> {
    let holds = values.iter().all(|value| *value >= 0.0);
    require(holds, name, "must not contain a negative number")
}

/// Checks that a part can have this mass and this axis.
fn check_mass_and_axis(mass: f64, axis: &Vector3<f64>) -> Result<(), PartError> {
    above_zero("mass", mass)?;
    if !axis.iter().all(|component| component.is_finite()) {
        return Err(PartError::OutOfRange);
    }
    let is_direction = *axis != Vector3::zeros();
    require(
        is_direction,
        "axis",
        "must not have length 0: it is a direction",
    )
}

/// Why there is no such part.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PartError {
    /// The mass, the axis or a dimension has a value that no solid has.
    #[error("{name} {rule}")]
    Dimension {
        /// The name of the field or argument.
        name: &'static str,
        /// What it must be.
        rule: &'static str,
    },
    /// One moment is larger than the sum of the two others.
    #[error("{0}: no body of real masses has these moments")]
    Unreal(&'static str),
    /// A moment about the pivot, or a sum such as A + B − C, is smaller than if all mass were at the center.
    #[error(
        "about the pivot {sum} must be at least {least} kg m^2, d the distance of its center of mass {from}"
    )]
    TooFar {
        /// The moment, or the sum of moments.
        sum: &'static str,
        /// The smallest possible value, with its formula: "M d^2 = 1.25e-3".
        least: Bound,
        /// The axis from which, or along which, d is measured.
        from: &'static str,
        /// These moments become possible if the distance of the center is multiplied by this factor and M d is kept.
        nearer: f64,
    },
    /// Mass or dimensions are so large or small that the moments leave the range of floating-point numbers, or are not
    /// finite.
    #[error("its moments leave the range of numbers: use masses and dimensions nearer to 1")]
    OutOfRange,
}

/// A bound on a moment, M d² or twice that, kg m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// One or two.
    factor: u8,
    value: f64,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factor = if self.factor == 1 { "" } else { "2 " };
        // A product of decimals has twelve digits at the most, but for rounding.
        let digits = format!("{:.11e}", self.value);
        let value: f64 = digits.parse().unwrap_or(self.value);
        write!(f, "{factor}M d^2 = {value:e}")
    }
}

/// Returns the distances of the six points from the center for the moments A, B, C divided by the mass, m.
///
/// # Errors
/// If one of A, B, C is larger than the sum of the two others, or not finite.
fn distances(moments: &Vector3<f64>) -> Result<[f64; 3], PartError> {
    let [a, b, c] = (*moments).into();
    if !(a + b + c).is_finite() {
        return Err(PartError::OutOfRange);
    }
    let rounding = MOMENT_SUM_ROUNDING * moments.amax();
    let distance = |sum: f64, third: f64, rule: &'static str| match sum - third {
        difference if difference < -rounding => Err(PartError::Unreal(rule)),
        difference => Ok((1.5 * difference.max(0.0)).sqrt()),
    };
    Ok([
        distance(b + c, a, "B + C is below A")?,
        distance(a + c, b, "A + C is below B")?,
        distance(a + b, c, "A + B is below C")?,
    ])
}

/// A solid part at its place in the upright body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedSolid {
    /// Its shape.
    pub shape: Shape,
    /// Its mass, kg.
    pub mass: f64,
    /// Its center of mass, body frame, m.
    pub center: Vector3<f64>,
    /// Its own directions x, y and axis as columns, body frame.
    pub directions: Matrix3<f64>,
    /// Distances of the six points from the center along its own x, y and axis, m. They are the half axes of the thin
    /// ellipsoid (the shell between two similar ones) that has the same moments.
    pub distances: [f64; 3],
}

impl PlacedSolid {
    /// Makes a part with this shape and `mass` (kg). Its center of mass is at `center` (body frame, m), and its axis has
    /// the direction `axis` (body frame, of any length but 0).
    ///
    /// # Errors
    /// If the mass is not above 0, the axis has no direction, a dimension is impossible, or no body with positive masses
    /// has these moments (to 1e-12 of the largest).
    pub fn new(
        shape: Shape,
        mass: f64,
        center: Vector3<f64>,
        axis: &Vector3<f64>,
    ) -> Result<Self, PartError> {
        check_mass_and_axis(mass, axis)?;
        shape.check()?;
        Ok(Self {
            shape,
            mass,
            center,
            directions: turn_to(axis),
            distances: distances(&shape.moments_per_mass())?,
        })
    }

    /// Makes a part with these `moments` (kg m²) about the axes through the pivot that are parallel to its own x, y and
    /// axis. These are its principal axes at the center. Mass, center and axis are as in [`new`](Self::new).
    ///
    /// # Errors
    /// As [`new`](Self::new), and if no body with positive masses has these moments, this mass and this center.
    pub fn about_pivot(
        moments: &Vector3<f64>,
        mass: f64,
        center: Vector3<f64>,
        axis: &Vector3<f64>,
    ) -> Result<Self, PartError> {
        check_mass_and_axis(mass, axis)?;
        let per_mass = moments / mass;
        Shape::Moments(per_mass).check()?;
        distances(&per_mass)?;
        // Steiner's theorem for the second moments of the mass, ∫x² dm and so on, divided by it.
        let squares = turn_to(axis).tr_mul(&center).map(|along| along * along);
        let about_pivot = Vector3::repeat(0.5 * per_mass.sum()) - per_mass;
        let about_center = about_pivot - squares;
        if !about_center.sum().is_finite() {
            return Err(PartError::OutOfRange);
        }
        if about_center.min() < -MOMENT_SUM_ROUNDING * per_mass.amax() {
            let ratios = about_pivot
                .iter()
                .zip(&squares)
                .filter(|(_, square)| **square > 0.0);
            let nearer = ratios.fold(f64::INFINITY, |least, (own, square)| {
                least.min(own / square)
            });
            return Err(too_far(&per_mass, &squares, mass, nearer));
        }
        let [x, y, z] = about_center.map(|second| second.max(0.0)).into();
        let shape = Shape::Moments(Vector3::new(y + z, x + z, x + y));
        Self::new(shape, mass, center, axis)
    }

    /// Returns the principal moments about the center: about its own x, y and axis, kg m².
    pub fn moments(&self) -> Vector3<f64> {
        self.mass * self.shape.moments_per_mass()
    }

    /// Returns its points, body frame: the center, without mass, and then for each of its own directions x, y and axis the
    /// point in front of the center and the point behind it.
    pub fn points(&self) -> [PointMass; POINTS_PER_PART] {
        let mass = self.mass / 6.0;
        let [x, y, z] = [0, 1, 2].map(|i| self.directions.column(i) * self.distances[i]);
        let six = [x, -x, y, -y, z, -z].map(|off| PointMass::new(self.center + off, mass));
        let mut points = [PointMass::new(self.center, 0.0); POINTS_PER_PART];
        points[1..].copy_from_slice(&six);
        points
    }
}

/// Returns the moment about the pivot, divided by the mass, that is too small if the coordinates of the center have these
/// `squares`; if each moment is large enough, the sum that is too small.
fn too_far(per_mass: &Vector3<f64>, squares: &Vector3<f64>, mass: f64, nearer: f64) -> PartError {
    const FROM: [&str; 3] = [
        "from the axis of A",
        "from the axis of B",
        "from the axis of C",
    ];
    const ALONG: [&str; 3] = [
        "along the axis of A",
        "along the axis of B",
        "along the axis of C",
    ];
    const SUMS: [&str; 3] = ["B + C - A", "A + C - B", "A + B - C"];
    let from = Vector3::repeat(squares.sum()) - squares;
    let single = (0..3).find(|&axis| per_mass[axis] < from[axis]);
    let missing = Vector3::repeat(per_mass.sum()) - 2.0 * (per_mass + squares);
    let (sum, factor, square, from) = match single {
        Some(axis) => (["A", "B", "C"][axis], 1, from[axis], FROM[axis]),
        None => {
            let axis = missing.imin();
            (SUMS[axis], 2, squares[axis], ALONG[axis])
        }
    };
    PartError::TooFar {
        sum,
        least: Bound {
            factor,
            value: f64::from(factor) * mass * square,
        },
        from,
        nearer,
    }
}

/// Returns the shortest rotation from +z to the direction of `axis`; for −z, half a turn about x.
fn turn_to(axis: &Vector3<f64>) -> Matrix3<f64> {
    let axis = (axis / axis.amax()).normalize(); // its square may leave the range of numbers
    let across = libm::hypot(axis.x, axis.y);
    if across == 0.0 {
        let sign = 1.0_f64.copysign(axis.z);
        return Matrix3::from_diagonal(&Vector3::new(1.0, sign, sign));
    }
    // About (−uy, ux, 0), by the angle whose cosine is axis.z.
    let (ux, uy, bend) = (axis.x / across, axis.y / across, 1.0 - axis.z);
    Matrix3::new(
        1.0 - ux * ux * bend,
        -ux * uy * bend,
        axis.x,
        -ux * uy * bend,
        1.0 - uy * uy * bend,
        axis.y,
        -axis.x,
        -axis.y,
        axis.z,
    )
}
