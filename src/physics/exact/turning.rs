//! Where the axle of a Lagrange top turns back: the three roots of the cubic for u = cos(tilt), as gaps.
//!
//! With w = L/I1 (rad/s), a the axle, k = (unit vertical), s = w.a, l = w.k and c = |p|/I1 (1/s^2),
//!
//! ```text
//! (du/dt)^2 = F(u) = (n^2 - 2c(u - u0))(1 - u^2) - (l - s u)^2,      n = |w x a| at the start, u0 = u at the start,
//! ```
//!
//! has roots -1 <= u1 <= u2 <= 1 <= u3, and the axle moves between u1 and u2 (Whittaker, Analytical Dynamics, section
//! 71). Everything later is a function of the gaps (1 + u1), (u2 - u1), (1 - u2) and (u3 - 1), each of which can be far
//! smaller than the rounding of the roots: a steady top has u1 = u2, an upright one u2 = 1, one about to fall u2 = u3.
//! Each gap is therefore found about the point where its polynomial has *one* root of its own sign, which makes it a
//! well-conditioned root, and never as a difference of two roots.

use nalgebra::Complex;

/// The state at the start, in a frame with its third axis along the vertical. Horizontal vectors are complex, x + i y.
#[derive(Clone, Copy, Debug)]
pub struct TurningStart {
    /// |p| / I1, 1/s^2: how hard the load pulls the axle down.
    pub pull: f64,
    /// Horizontal part of the axle, a unit vector.
    pub axle: Complex<f64>,
    /// Vertical part of the axle: the cosine of the tilt.
    pub height: f64,
    /// Horizontal part of L/I1, rad/s.
    pub spin: Complex<f64>,
    /// Vertical part of L/I1, rad/s.
    pub spin_vertical: f64,
}

impl TurningStart {
    /// 1 - u0, without cancellation near the top.
    pub fn below_top(&self) -> f64 {
        if self.height > 0.0 {
            self.axle.norm_sqr() / (1.0 + self.height)
        } else {
            1.0 - self.height
        }
    }

    /// 1 + u0, without cancellation near the bottom.
    pub fn above_bottom(&self) -> f64 {
        if self.height < 0.0 {
            self.axle.norm_sqr() / (1.0 - self.height)
        } else {
            1.0 + self.height
        }
    }

    /// du/dt at the start, rad/s.
    pub fn climb(&self) -> f64 {
        (self.spin.conj() * self.axle).im
    }

    /// Horizontal part of w times horizontal part of the axle.
    fn horizontal_product(&self) -> f64 {
        (self.spin.conj() * self.axle).re
    }

    /// w.a, rad/s.
    pub fn spin_along(&self) -> f64 {
        self.spin_vertical * self.height + self.horizontal_product()
    }

    /// w.k - w.a, rad/s, to the accuracy of the distance from upright.
    pub fn spin_difference(&self) -> f64 {
        self.spin_vertical * self.below_top() - self.horizontal_product()
    }

    /// w.k + w.a, rad/s, to the accuracy of the distance from hanging.
    pub fn spin_sum(&self) -> f64 {
        self.spin_vertical * self.above_bottom() + self.horizontal_product()
    }

    /// |w x a|^2, the squared speed of the axle's tip, 1/s^2.
    fn tip_speed_squared(&self) -> f64 {
        let level = self.axle * self.spin_vertical - self.spin * self.height;
        self.climb() * self.climb() + level.norm_sqr()
    }
}

/// The gaps between the roots, dimensionless, and the two rates that stay finite when the load vanishes.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// 1 + u1.
    pub above_bottom: f64,
    /// u2 - u1.
    pub swing: f64,
    /// 1 - u2.
    pub below_top: f64,
    /// 2c (u3 - 1), 1/s^2.
    pub beyond_top: f64,
    /// 2c (u3 - u1) = 4 (rate of the elliptic functions)^2, 1/s^2.
    pub whole: f64,
    /// 1 - u1.
    pub reach: f64,
    /// 1 + u2.
    pub rise: f64,
    /// u0 - u1.
    pub start_above: f64,
    /// u2 - u0.
    pub start_below: f64,
}

impl Turning {
    pub fn new(start: &TurningStart) -> Self {
        let cubic = about_start(start);
        let lowest = lowest_root(cubic, -start.above_bottom());
        let reach = start.below_top() - lowest;
        let (below_top, beyond_top) = gaps_at_top(start, reach);
        let (start_above, start_below, swing) = turning_points(start, cubic, lowest, beyond_top);
        let two_c = 2.0 * start.pull;
        let rise = start.above_bottom() + start_below;
        Self {
            above_bottom: gap_at_bottom(start, start_above, rise, beyond_top),
            swing,
            below_top,
            beyond_top,
            whole: two_c * (swing + below_top) + beyond_top,
            reach: swing + below_top,
            rise,
            start_above,
            start_below,
        }
    }

    /// The parameter m = (u2 - u1)/(u3 - u1) of the elliptic functions, and 1 - m, both to full relative accuracy.
    pub fn parameters(&self, start: &TurningStart) -> (f64, f64) {
        if self.whole <= 0.0 {
            return (0.0, 1.0);
        }
        let two_c = 2.0 * start.pull;
        (
            two_c * self.swing / self.whole,
            (two_c * self.below_top + self.beyond_top) / self.whole,
        )
    }
}

/// F as a polynomial in x = u - u0, lowest power first.
fn about_start(start: &TurningStart) -> [f64; 4] {
    let (c, u, s2) = (start.pull, start.height, start.axle.norm_sqr());
    let (along, n2) = (start.spin_along(), start.tip_speed_squared());
    let twist = start.spin_vertical * s2 - u * start.horizontal_product();
    [
        start.climb() * start.climb(),
        2.0 * (twist * along - u * n2 - c * s2),
        4.0 * c * u - n2 - along * along,
        2.0 * c,
    ]
}

/// u1 - u0: Newton's method from the left, where F rises and is concave, so that every step stays left of the root.
///
/// F has one root left of u0 and two right of it; that makes this one insensitive to rounding of the coefficients.
fn lowest_root([f0, f1, f2, f3]: [f64; 4], left_end: f64) -> f64 {
    let mut x = left_end;
    // A double root at u0 (a steady top) is approached by halves: 120 of them leave nothing of it.
    for _ in 0..120 {
        let value = f0 + x * (f1 + x * (f2 + x * f3));
        let slope = f1 + x * (2.0 * f2 + x * 3.0 * f3);
        let next = (x - value / slope).min(0.0);
        if next <= x || next.is_nan() {
            break;
        }
        x = next;
    }
    x
}

/// 1 - u2 and 2c (u3 - 1): the two roots next to the top, of opposite signs as seen from u = 1, from their sum and product.
fn gaps_at_top(start: &TurningStart, reach: f64) -> (f64, f64) {
    let (c, along, difference) = (start.pull, start.spin_along(), start.spin_difference());
    let energy = start.tip_speed_squared() - 2.0 * c * start.below_top();
    if reach <= 0.0 {
        return (0.0, (along * along + energy - 4.0 * c).max(0.0));
    }
    let product = difference * difference / reach;
    let sum = (product - 2.0 * (energy - difference * along)) / reach;
    let root = (sum * sum + 8.0 * c * product).sqrt();
    if sum < 0.0 {
        let beyond = 0.5 * (root - sum);
        (product / beyond, beyond)
    } else if c <= 0.0 {
        (start.below_top(), 0.0)
    } else {
        let below = (sum + root) / (4.0 * c);
        (below, if below > 0.0 { product / below } else { 0.0 })
    }
}

/// u0 - u1, u2 - u0 and u2 - u1, with the root u3 divided out of the cubic.
fn turning_points(
    start: &TurningStart,
    [f0, f1, ..]: [f64; 4],
    lowest: f64,
    beyond_top: f64,
) -> (f64, f64, f64) {
    let z = beyond_top + 2.0 * start.pull * start.below_top();
    if z <= 0.0 {
        return (-lowest, 0.0, -lowest);
    }
    let slope = f1 + 2.0 * start.pull * f0 / z;
    let root = (slope * slope + 4.0 * z * f0).sqrt();
    let far = 0.5 * (slope.abs() + root) / z;
    let near = if far > 0.0 { f0 / (z * far) } else { 0.0 };
    if slope > 0.0 {
        (near, far, root / z)
    } else {
        (far, near, root / z)
    }
}

/// 1 + u1, from F(-1) = -(l + s)^2.
fn gap_at_bottom(start: &TurningStart, start_above: f64, rise: f64, beyond_top: f64) -> f64 {
    let scale = rise * (beyond_top + 4.0 * start.pull);
    if scale <= 0.0 {
        // At rest: hanging, or without a load.
        return start.above_bottom() - start_above;
    }
    start.spin_sum() * start.spin_sum() / scale
}
