//! Bodies: rigid sets of point masses with one point fixed at the origin.

use super::PlacedSolid;
use nalgebra::{Matrix3, Vector3};

/// If the ratio of the smallest to the largest principal moment is at most this, the inertia counts as singular: Ω = I⁻¹L
/// would be only rounding.
const SINGULAR_BELOW: f64 = 1e-12;

/// One point mass, in the upright pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// Position in the body frame, m; the pivot is the origin.
    pub at: Vector3<f64>,
    /// Mass, kg, not negative.
    pub mass: f64,
}

impl PointMass {
    pub(crate) fn new(at: Vector3<f64>, mass: f64) -> Self {
        Self { at, mass }
    }
}

/// A rigid body of point masses that turns about the origin of its frame, the pivot.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    points: Vec<PointMass>,
    mass: f64,
    first_moment: Vector3<f64>,
    inertia: Matrix3<f64>,
    inverse_inertia: Matrix3<f64>,
    frame_moment: f64,
}

/// Why points do not make a body.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A point has a negative mass.
    #[error("point {point} has a negative mass, {mass:e} kg")]
    NegativeMass {
        /// Index of the point.
        point: usize,
        /// Its mass, kg.
        mass: f64,
    },
    /// All mass is on one line through the pivot, or there is none.
    #[error(
        "singular inertia: about the pivot the smallest principal moment is {smallest:e} kg m^2, the largest {largest:e}; put mass off the axle"
    )]
    Singular {
        /// Smallest principal moment, kg m².
        smallest: f64,
        /// Largest principal moment, kg m².
        largest: f64,
    },
    /// Masses or distances are so large or small that the inertia or its inverse leaves the range of floating-point
    /// numbers.
    #[error(
        "the inertia about the pivot leaves the range of numbers: use masses and distances nearer to 1"
    )]
    OutOfRange,
}

impl Body {
    /// Makes a body of `points` (body frame, upright pose).
    ///
    /// # Errors
    /// If a mass is negative, or if the inertia about the pivot is singular (its smallest principal moment at most 1e-12 of
    /// the largest) or out of the range of numbers.
    pub fn new(points: Vec<PointMass>) -> Result<Self, BodyError> {
        if let Some(point) = points.iter().position(|point| point.mass < 0.0) {
            let mass = points[point].mass;
            return Err(BodyError::NegativeMass { point, mass });
        }
        let mass = points.iter().map(|p| p.mass).sum();
        let first_moment = points
            .iter()
            .fold(Vector3::zeros(), |sum, p| sum + p.mass * p.at);
        let inertia = points
            .iter()
            .fold(Matrix3::zeros(), |sum, p| sum + point_inertia(p));
        let inverse_inertia = invert(&inertia)?;
        Ok(Self {
            points,
            mass,
            first_moment,
            inertia,
            inverse_inertia,
            frame_moment: 0.0,
        })
    }

    /// Makes a body of `solids`. Each becomes [seven points](super::part::POINTS_PER_PART), its center first: the center of
    /// `solids[i]` is point 7 i. To push or follow another point, add it to the points of the solids with mass 0, and use
    /// [`new`](Self::new).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_solids(solids: &[PlacedSolid]) -> Result<Self, BodyError> {
        Self::new(solids.iter().flat_map(PlacedSolid::points).collect())
    }

    /// Lets only a rotor spin, with the moment `rotor` (kg m²) about the axle. The rest of the body tilts with the axle but
    /// does not spin.
    ///
    /// The body must be symmetric about its axle, which is not checked. The axle then moves as in a rigid body with the
    /// moment `rotor` about it, and the angular velocity is the rotor's.
    ///
    /// # Errors
    /// If the inertia about the pivot is then singular.
    pub fn with_rotor(mut self, rotor: f64) -> Result<Self, BodyError> {
        self.frame_moment += self.inertia[(2, 2)] - rotor;
        self.inertia[(2, 2)] = rotor;
        self.inverse_inertia = invert(&self.inertia)?;
        Ok(self)
    }

    /// Returns the points, in the order in which they were given.
    pub fn points(&self) -> &[PointMass] {
        &self.points
    }

    /// Returns the total mass M, kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Returns Σ m x, kg m, body frame: the mass times the center of mass.
    pub fn first_moment(&self) -> Vector3<f64> {
        self.first_moment
    }

    /// Returns the inertia about the pivot, kg m², body frame (equation (2) of the report, with E). [With a
    /// rotor](Self::with_rotor), the moment about the axle is the rotor's.
    pub fn inertia(&self) -> Matrix3<f64> {
        self.inertia
    }

    /// Returns the inverse of the inertia about the pivot, 1/(kg m²), body frame.
    pub fn inverse_inertia(&self) -> Matrix3<f64> {
        self.inverse_inertia
    }

    /// Returns the moment about the axle of the parts that do not spin, kg m²; 0 without a rotor.
    pub fn frame_moment(&self) -> f64 {
        self.frame_moment
    }
}

/// Returns m(|x|²E − xxᵀ), kg m²: the inertia of one point about the pivot (report, equation (2)).
fn point_inertia(point: &PointMass) -> Matrix3<f64> {
    let x = point.at;
    point.mass * (Matrix3::identity() * x.norm_squared() - x * x.transpose())
}

fn invert(inertia: &Matrix3<f64>) -> Result<Matrix3<f64>, BodyError> {
    if !inertia.iter().all(|m| m.is_finite()) {
        return Err(BodyError::OutOfRange);
    }
    let moments = inertia.symmetric_eigenvalues();
    let (smallest, largest) = (moments.min(), moments.max());
    if largest <= 0.0 || smallest <= SINGULAR_BELOW * largest {
        return Err(BodyError::Singular { smallest, largest });
    }
    inertia
        .try_inverse()
        .filter(|inverse| inverse.iter().all(|m| m.is_finite()))
        .ok_or(BodyError::OutOfRange)
}
