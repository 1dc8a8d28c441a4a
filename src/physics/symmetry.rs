//! Symmetric and nearly symmetric bodies, and forces on their axle, for the closed form and the theory of the heavy top.

use super::{Body, Loads, State};
use nalgebra::Vector3;

/// A body whose moments differ by less than this part of the whole is symmetric, and a point that is off the axle by less
/// than this part of the body's size is on it: such differences are the rounding of a scenario's digits.
///
/// The splitting schemes ask for equality to the rounding of a sum instead (`splitting::principal::ROUNDING`): what they
/// take as zero is left out of every step.
const SYMMETRY_TOLERANCE: f64 = 1e-9;

/// The largest difference of the moments across, as a share of their mean, with which the motion is still near to that of a
/// symmetric top.
const NEARLY: f64 = 0.01;

/// The same for a principal axis (rad) and a center of mass (of the radius of gyration) that are off the axle. The axle wobbles
/// by as much with each turn of the body, and a wobble of 1 % hides the nutation of a fast top.
const NEARLY_ON_AXLE: f64 = 1e-3;

/// The largest difference of the moments across, as a share of the difference between their mean and the moment along the axle.
/// Nearer to equal moments, the small difference decides how the axle moves.
const OF_KAPPA: f64 = 0.2;

/// The moments of a body that is symmetric about its axle, the z axis of the body. Its center of mass is on the axle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetricTop {
    /// I1, across the axle, about the pivot, kg m².
    pub across: f64,
    /// I3, along the axle, kg m².
    pub along: f64,
    /// M l, the mass times the height of the center of mass along the axle, kg m; negative below the pivot.
    pub first_moment: f64,
}

impl SymmetricTop {
    /// Returns the moments of `body`; `None` if it is not symmetric to 1e-9 of the whole.
    pub fn from_body(body: &Body) -> Option<Self> {
        let inertia = body.inertia();
        let largest = inertia.diagonal().amax();
        let small = |moment: f64| moment.abs() <= SYMMETRY_TOLERANCE * largest;
        let even = small(inertia[(0, 0)] - inertia[(1, 1)])
            && small(inertia[(0, 1)])
            && small(inertia[(0, 2)])
            && small(inertia[(1, 2)]);
        let first = body.first_moment();
        // An offset c of the center of mass counts against the size of the body: M c² against its moments.
        let size = (largest * body.mass()).sqrt();
        let centered = first.x.abs().max(first.y.abs()) <= SYMMETRY_TOLERANCE * size;
        (even && centered).then(|| Self {
            across: 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
            along: inertia[(2, 2)],
            first_moment: first.z,
        })
    }

    /// Returns a top with the mean of the two moments across the axle, and the asymmetry of `body`: 0 if it is symmetric,
    /// otherwise at most 0.01. Returns `None` if the body is more lopsided.
    ///
    /// The asymmetry is the largest of three: the difference of the principal moments across, divided by their mean; the
    /// angle between the axle and the principal axis nearest to it, rad; and the distance of the center of mass from the axle,
    /// divided by the radius of gyration. The difference of the moments across must also be small against their difference
    /// from the moment along the axle: else it decides how the axle moves.
    pub fn nearly(body: &Body) -> Option<(Self, f64)> {
        if let Some(top) = Self::from_body(body) {
            return Some((top, 0.0));
        }
        let (inertia, first) = (body.inertia(), body.first_moment());
        let top = Self {
            across: 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
            along: inertia[(2, 2)],
            first_moment: first.z,
        };
        let difference = inertia[(0, 0)] - inertia[(1, 1)];
        let unequal = libm::hypot(difference, 2.0 * inertia[(0, 1)]);
        let skew = libm::hypot(inertia[(0, 2)], inertia[(1, 2)]);
        let from_sphere = (top.along - top.across).abs();
        let size = (inertia.diagonal().amax() * body.mass()).sqrt();
        let of_moments = unequal / top.across;
        let of_axis = skew / from_sphere;
        let of_center = libm::hypot(first.x, first.y) / size;
        let is_near = unequal <= OF_KAPPA * from_sphere
            && of_moments <= NEARLY
            && of_axis <= NEARLY_ON_AXLE
            && of_center <= NEARLY_ON_AXLE;
        is_near.then(|| (top, of_moments.max(of_axis).max(of_center)))
    }

    /// True if the point `at` (body frame, m) of `body` is on its axle. With forces on such points there is a closed form.
    pub fn has_on_axle(&self, body: &Body, at: &Vector3<f64>) -> bool {
        let size = (self.across.max(self.along) / body.mass()).sqrt();
        at.x.abs().max(at.y.abs()) <= SYMMETRY_TOLERANCE * size.max(at.z.abs())
    }

    /// Returns κ = I3/I1: below 1 for a long body, above 1 for a flat one.
    pub fn kappa(&self) -> f64 {
        self.along / self.across
    }

    /// Returns the angle between axle and L, rad, in slow steady precession with the tilt and the spin of `state`. The
    /// component of L across the axle is then I1 w sin θ. `load` is from [`Loads::on_axle`], N m, world frame. Returns
    /// `None` if the top spins too slowly for steady precession.
    pub fn steady_lag(&self, state: &State, load: &Vector3<f64>) -> Option<f64> {
        let (axle, spin) = (state.axle(), state.momentum.dot(&state.axle()));
        let Some(down) = load.try_normalize(0.0) else {
            return Some(0.0);
        };
        let (rate, _) = steady_precession(-self.across * axle.dot(&down), spin, load.norm());
        let across = self.across * rate? * axle.cross(&down).norm();
        Some(libm::atan2(across.abs(), spin.abs()))
    }
}

/// Returns the slow and the fast rate of steady precession, rad/s: the roots w of `across_cos` w² − `spin` w + `load` = 0.
///
/// `across_cos` is I1 cos θ, kg m²; `spin` is L3 = I3 ω3, J s; `load` is M g l, N m. Neither root is found as a small
/// difference. There is no slow rate if the top spins too slowly. There is no fast rate then either, nor if the axle is
/// level. Without spin and load the slow rate is NaN.
pub fn steady_precession(across_cos: f64, spin: f64, load: f64) -> (Option<f64>, Option<f64>) {
    let discriminant = spin * spin - 4.0 * across_cos * load;
    if discriminant < 0.0 {
        return (None, None);
    }
    let larger = 0.5 * (spin + discriminant.sqrt().copysign(spin));
    let fast = larger / across_cos;
    (Some(load / larger), fast.is_finite().then_some(fast))
}

impl Loads {
    /// Returns Σ s F over all forces, N m, world frame; s is the height along the axle at which F acts. The torque is axle
    /// × Σ s F. Returns `None` if a force acts off the axle. `top` must be [made from](SymmetricTop::from_body) `body`.
    ///
    /// # Panics
    /// If a push acts on a point that `body` does not have.
    pub fn on_axle(&self, body: &Body, top: &SymmetricTop) -> Option<Vector3<f64>> {
        let weight = Vector3::new(0.0, 0.0, -self.gravity * top.first_moment);
        self.pushes.iter().try_fold(weight, |sum, push| {
            let at = body.points()[push.point].at;
            top.has_on_axle(body, &at).then(|| sum + at.z * push.force)
        })
    }
}
