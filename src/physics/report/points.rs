//! The points of the body two at a time, what turns them, and what is summed over them.

use nalgebra::{Matrix3, Vector3};
use wide::f64x2;

pub(super) const LANES: usize = 2;

/// Two points side by side, world frame; places past the last point hold no mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub x: f64x2,
    pub y: f64x2,
    pub z: f64x2,
    pub mass: f64x2,
}

/// Masses times coordinates and times their products: of two points side by side, or summed over all pairs of points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub x: f64x2,
    pub y: f64x2,
    pub z: f64x2,
    pub xx: f64x2,
    pub yy: f64x2,
    pub zz: f64x2,
    pub xy: f64x2,
    pub xz: f64x2,
    pub yz: f64x2,
}

/// The inertia I, kg m², a symmetric matrix.
///
/// The next step begins with these numbers, which have just been written. A processor passes a number on at once only to
/// a load that lies within one store. So they are pairs of lanes, each stored as one; zz and yz are in both lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inertia {
    xy_xz: f64x2,
    zz: f64x2,
    xx_yy: f64x2,
    yz: f64x2,
}

/// A rotation matrix, each element in both lanes.
#[derive(Clone, Copy)]
pub(super) struct LaneRotation([[f64x2; 3]; 3]);

impl Moments {
    const NONE: Self = {
        let zero = f64x2::ZERO;
        Self {
            x: zero,
            y: zero,
            z: zero,
            xx: zero,
            yy: zero,
            zz: zero,
            xy: zero,
            xz: zero,
            yz: zero,
        }
    };

    #[inline]
    pub fn from_pair(pair: &Pair) -> Self {
        let (x, y, z) = (pair.x, pair.y, pair.z);
        let (mx, my, mz) = (pair.mass * x, pair.mass * y, pair.mass * z);
        Self {
            x: mx,
            y: my,
            z: mz,
            xx: mx * x,
            yy: my * y,
            zz: mz * z,
            xy: mx * y,
            xz: mx * z,
            yz: my * z,
        }
    }

    #[inline]
    fn and(self, more: Self) -> Self {
        Self {
            x: self.x + more.x,
            y: self.y + more.y,
            z: self.z + more.z,
            xx: self.xx + more.xx,
            yy: self.yy + more.yy,
            zz: self.zz + more.zz,
            xy: self.xy + more.xy,
            xz: self.xz + more.xz,
            yz: self.yz + more.yz,
        }
    }

    #[inline]
    pub fn from_pairs(points: &[Pair]) -> Self {
        points
            .iter()
            .map(Self::from_pair)
            .fold(Self::NONE, Self::and)
    }

    /// Σ m X, kg m.
    #[inline]
    pub fn first(&self) -> Vector3<f64> {
        Vector3::from([self.x, self.y, self.z].map(add_up))
    }

    /// Σ m XXᵀ, kg m².
    pub fn second(&self) -> Matrix3<f64> {
        let [xx, yy, zz] = [self.xx, self.yy, self.zz].map(add_up);
        let [xy, xz, yz] = [self.xy, self.xz, self.yz].map(add_up);
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

impl Inertia {
    pub fn from_matrix(matrix: &Matrix3<f64>) -> Self {
        let m = |row, column| matrix[(row, column)];
        Self {
            xx_yy: f64x2::new([m(0, 0), m(1, 1)]),
            xy_xz: f64x2::new([m(0, 1), m(0, 2)]),
            zz: f64x2::splat(m(2, 2)),
            yz: f64x2::splat(m(1, 2)),
        }
    }

    /// Σ m (|X|²E − XXᵀ) from Σ m XXᵀ.
    #[inline]
    pub fn from_moments(moments: &Moments) -> Self {
        let (xx, yy, zz) = (moments.xx, moments.yy, moments.zz);
        let diagonal = add_up_both(yy, xx);
        Self {
            xy_xz: -add_up_both(moments.xy, moments.xz),
            zz: diagonal + add_up_both(xx, yy),
            xx_yy: diagonal + add_up_both(zz, zz),
            yz: -add_up_both(moments.yz, moments.yz),
        }
    }

    pub fn matrix(&self) -> Matrix3<f64> {
        let ([xx, yy], [xy, xz]) = (self.xx_yy.to_array(), self.xy_xz.to_array());
        let ([zz, _], [yz, _]) = (self.zz.to_array(), self.yz.to_array());
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// I⁻¹ L, by cofactors: one division, and exact to a few units in the last place for any inertia that
    /// [`Body`](crate::Body) lets pass.
    #[inline]
    pub fn solve(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        let ([a, b], [h, g]) = (self.xx_yy.to_array(), self.xy_xz.to_array());
        let ([c, _], [f, _]) = (self.zz.to_array(), self.yz.to_array());
        let (aa, bb, cc) = (b * c - f * f, a * c - g * g, a * b - h * h);
        let (ff, gg, hh) = (g * h - a * f, h * f - b * g, f * g - c * h);
        let scale = 1.0 / (a * aa + h * hh + g * gg);
        let (x, y, z) = (momentum.x, momentum.y, momentum.z);
        Vector3::new(
            aa * x + hh * y + gg * z,
            hh * x + bb * y + ff * z,
            gg * x + ff * y + cc * z,
        ) * scale
    }
}

impl LaneRotation {
    #[inline]
    pub fn from_matrix(rotation: &Matrix3<f64>) -> Self {
        Self([0, 1, 2].map(|row| [0, 1, 2].map(|column| f64x2::splat(rotation[(row, column)]))))
    }

    /// R X of two points.
    #[inline]
    fn of_two(&self, [x, y, z]: [f64x2; 3]) -> [f64x2; 3] {
        self.0.map(|[a, b, c]| a * x + b * y + c * z)
    }

    #[inline]
    pub fn points(&self, points: &mut [Pair]) {
        for pair in points {
            [pair.x, pair.y, pair.z] = self.of_two([pair.x, pair.y, pair.z]);
        }
    }

    /// R Q, by the columns of Q.
    #[inline]
    pub fn times(&self, matrix: &Matrix3<f64>) -> Matrix3<f64> {
        let both = |columns: [usize; LANES]| {
            let rows = [0, 1, 2].map(|row| f64x2::new(columns.map(|column| matrix[(row, column)])));
            self.of_two(rows).map(f64x2::to_array)
        };
        let [[x0, x1], [y0, y1], [z0, z1]] = both([0, 1]);
        let [[x2, _], [y2, _], [z2, _]] = both([2, 2]);
        Matrix3::new(x0, x1, x2, y0, y1, y2, z0, z1, z2)
    }
}

/// The sum of both lanes, without the library, whose order may differ between processors.
fn add_up(lanes: f64x2) -> f64 {
    let [a, b] = lanes.to_array();
    a + b
}

/// The same of two, side by side.
#[inline]
fn add_up_both(a: f64x2, b: f64x2) -> f64x2 {
    let ([a0, a1], [b0, b1]) = (a.to_array(), b.to_array());
    f64x2::new([a0, b0]) + f64x2::new([a1, b1])
}
