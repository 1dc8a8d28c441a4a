//! Reference motions computed with 60 digits, and distances from them.

use gyrolab::physics::exact::LagrangeTop;
use nalgebra::{Matrix3, Rotation3, Vector3};

pub use crate::support::dice::Dice;

pub struct Start {
    pub name: String,
    pub across: f64,
    pub along: f64,
    pub load: Vector3<f64>,
    pub orientation: Matrix3<f64>,
    pub momentum: Vector3<f64>,
}

/// A state without the second body axis: axle, first body axis, L (J s).
pub struct Known {
    pub t: f64,
    pub axle: Vector3<f64>,
    pub body_x: Vector3<f64>,
    pub momentum: Vector3<f64>,
}

impl Start {
    pub fn top(&self) -> LagrangeTop {
        LagrangeTop::new(
            self.across,
            self.along,
            self.load,
            self.orientation,
            self.momentum,
        )
    }

    pub fn inertia(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(self.across, self.across, self.along))
    }

    pub fn moment(&self) -> Matrix3<f64> {
        Vector3::z() * self.load.transpose()
    }

    /// Scale of the angular momentum, J s.
    pub fn momentum_scale(&self) -> f64 {
        self.momentum.norm() + (self.load.norm() * self.across).sqrt() + f64::MIN_POSITIVE
    }

    /// Sum of the frequencies of the motion, rad/s.
    pub fn rates(&self) -> f64 {
        let along = self.momentum.dot(&self.orientation.column(2)).abs();
        self.momentum_scale() / self.across + along / self.along
    }
}

impl Known {
    /// Distances of axle, first body axis and L (relative to `scale`, J s).
    pub fn errors(
        &self,
        (orientation, momentum): &(Matrix3<f64>, Vector3<f64>),
        scale: f64,
    ) -> [f64; 3] {
        [
            (orientation.column(2) - self.axle).norm(),
            (orientation.column(0) - self.body_x).norm(),
            (momentum - self.momentum).norm() / scale,
        ]
    }
}

/// Returns the maximum of `errors`, or NaN if any of them is NaN.
pub fn greatest(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors
        .into_iter()
        .fold(0.0, |worst, e| if e <= worst { worst } else { e })
}

/// Parses the rows of a table: name, start, end.
pub fn table(text: &str) -> Vec<(Start, Known)> {
    text.lines().skip(1).map(row).collect()
}

fn row(line: &str) -> (Start, Known) {
    let (name, rest) = line.split_once(',').expect("a name");
    let v: Vec<f64> = rest
        .split(',')
        .map(|x| x.trim().parse().expect("a number"))
        .collect();
    let three = |k: usize| Vector3::new(v[k], v[k + 1], v[k + 2]);
    let start = Start {
        name: name.to_string(),
        across: v[0],
        along: v[1],
        load: three(2),
        orientation: Matrix3::from_columns(&[three(5), three(8), three(11)]),
        momentum: three(14),
    };
    (
        start,
        Known {
            t: v[17],
            axle: three(18),
            body_x: three(21),
            momentum: three(24),
        },
    )
}

/// Returns the rotation by `degrees` about the world's first axis.
pub fn tilted(degrees: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::x_axis(), degrees.to_radians()).matrix()
}
