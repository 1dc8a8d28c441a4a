//! Forces on a body: gravity, pushes on single points, and friction.

use super::Body;
use nalgebra::{Matrix3, Vector3};

/// A force on one point of the body, constant in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Index of the point in the body.
    pub point: usize,
    /// The force, world frame, N.
    pub force: Vector3<f64>,
}

/// The forces and the friction on a body. They are constant until the loads are changed.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Loads {
    /// Acceleration of gravity along −z, m/s².
    pub gravity: f64,
    /// Forces other than gravity.
    pub pushes: Vec<PointForce>,
    /// Friction about the pivot.
    pub friction: Friction,
}

/// The coefficients of friction; none is negative. Their torque is in [`friction`](super::friction).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Friction {
    /// k0: dry friction on the spin, N m.
    pub spin_dry: f64,
    /// k1: viscous friction on the spin, N m s.
    pub spin_viscous: f64,
    /// k2: friction on the spin by the square of its rate, N m s².
    pub spin_quadratic: f64,
    /// k4: viscous friction on the swing, N m s.
    pub swing_viscous: f64,
}

impl Friction {
    /// True if there is no friction.
    pub fn is_none(&self) -> bool {
        !self.is_on_spin() && self.swing_viscous == 0.0
    }

    /// k0, k1, k2, k4.
    pub(crate) fn coefficients(&self) -> [f64; 4] {
        [
            self.spin_dry,
            self.spin_viscous,
            self.spin_quadratic,
            self.swing_viscous,
        ]
    }

    /// True if there is friction on the spin.
    pub(crate) fn is_on_spin(&self) -> bool {
        self.spin_dry > 0.0 || self.spin_viscous > 0.0 || self.spin_quadratic > 0.0
    }
}

impl Loads {
    /// Returns Σ x Fᵀ over all points, N m, with x in the body frame and F in the world frame. [`torque`] computes the
    /// torque on the body from it and the orientation.
    ///
    /// # Panics
    /// If a push acts on a point that `body` does not have.
    pub fn moment(&self, body: &Body) -> Matrix3<f64> {
        let weight = Vector3::new(0.0, 0.0, -self.gravity);
        let gravity = body.first_moment() * weight.transpose();
        self.pushes.iter().fold(gravity, |sum, push| {
            sum + body.points()[push.point].at * push.force.transpose()
        })
    }
}

/// Returns the torque about the pivot, world frame, N m, of forces with this [`moment`](Loads::moment): τᵢ = εᵢⱼₖ (Q Σ x
/// Fᵀ)ⱼₖ.
///
/// Under vertical forces the first two columns of the moment are zero. Then τ_z is exactly zero, and L_z is conserved.
#[inline]
pub fn torque(orientation: &Matrix3<f64>, moment: &Matrix3<f64>) -> Vector3<f64> {
    axial(&(orientation * moment))
}

/// Returns εᵢⱼₖ mⱼₖ, twice the axial vector of the antisymmetric part of `m`: the sum of x × F if `m` is the sum of x Fᵀ.
#[inline]
pub(crate) fn axial(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(
        m[(1, 2)] - m[(2, 1)],
        m[(2, 0)] - m[(0, 2)],
        m[(0, 1)] - m[(1, 0)],
    )
}
