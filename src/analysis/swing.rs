//! How the axle of a symmetric top moves between two rows of a run, under a constant load on the axle.
//!
//! With l = L/I1 and p the load over I1, both in the world frame, da/dt = l × a and dl/dt = a × p: the spin about the axle
//! does not enter. Both right sides are products, so that a Taylor series follows term by term.

use nalgebra::Vector3;

const ORDER: usize = 18;
/// Size of the last term against the whole.
const LAST_TERM: f64 = f64::EPSILON / 16.0;
/// Steps of the series between two rows at most; beyond them the motion is too fast to be followed.
const MOST_STEPS: usize = 64;

/// The terms of one series, from the constant one on.
type Series = [Vector3<f64>; ORDER + 1];

/// Axle and momentum of a symmetric top at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Swing {
    pub axle: Vector3<f64>,
    /// L over the moment across the axle, rad/s.
    pub momentum: Vector3<f64>,
}

impl Swing {
    /// Rate of the axle's height, 1/s.
    pub fn climb(&self) -> f64 {
        self.momentum.x * self.axle.y - self.momentum.y * self.axle.x
    }

    /// Rate of that rate, 1/s², under `pull`: the load over the moment across, 1/s².
    pub fn bend(&self, pull: &Vector3<f64>) -> f64 {
        let turning = self.momentum.cross(&self.axle);
        (self.axle.cross(pull).cross(&self.axle) + self.momentum.cross(&turning)).z
    }

    /// The axle's rate of azimuth, rad/s.
    pub fn azimuth_rate(&self) -> f64 {
        let turning = self.momentum.cross(&self.axle);
        (self.axle.x * turning.y - self.axle.y * turning.x) / self.level().powi(2)
    }

    /// Horizontal length of the axle's direction, the sine of the tilt.
    pub fn level(&self) -> f64 {
        self.axle.x.hypot(self.axle.y)
    }

    /// Azimuth from here to `other`, rad, in (−π, π].
    pub fn azimuth_to(&self, other: &Self) -> f64 {
        let (a, b) = (&self.axle, &other.axle);
        libm::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y)
    }

    /// Where it is `time_s` later (earlier, if negative).
    pub fn after(mut self, time_s: f64, pull: &Vector3<f64>) -> Self {
        let mut left = time_s;
        for _ in 0..MOST_STEPS {
            let (axle, momentum, radius) = self.series(pull);
            let step = left.clamp(-radius, radius);
            let sum = |terms: &Series| {
                let rest = terms[1..].iter().rev();
                terms[0] + rest.fold(Vector3::zeros(), |sum, term| (sum + term) * step)
            };
            self = Self {
                axle: sum(&axle),
                momentum: sum(&momentum),
            };
            left -= step;
            if left == 0.0 {
                break;
            }
        }
        self
    }

    /// The series of axle and momentum, and how far they hold, s.
    fn series(&self, pull: &Vector3<f64>) -> (Series, Series, f64) {
        let zeros = [Vector3::zeros(); ORDER + 1];
        let (mut axle, mut momentum) = (zeros, zeros);
        (axle[0], momentum[0]) = (self.axle, self.momentum);
        for k in 0..ORDER {
            let next = (k + 1) as f64;
            let turning = (0..=k).map(|i| momentum[i].cross(&axle[k - i]));
            axle[k + 1] = turning.sum::<Vector3<f64>>() / next;
            momentum[k + 1] = axle[k].cross(pull) / next;
        }
        let reach = |k: usize| libm::pow(LAST_TERM / axle[k].norm(), 1.0 / k as f64);
        let radius = reach(ORDER - 1).min(reach(ORDER));
        (axle, momentum, radius)
    }
}

/// The axle between two rows by its directions and their rates at both: a polynomial of the third degree.
pub(super) struct Interpolation {
    ends: [Vector3<f64>; 2],
    /// Rates times the time between the rows.
    ways: [Vector3<f64>; 2],
    step_s: f64,
}

impl Interpolation {
    pub fn between(from: &Swing, to: &Swing, step_s: f64) -> Self {
        Self {
            ends: [from.axle, to.axle],
            ways: [from, to].map(|swing| swing.momentum.cross(&swing.axle) * step_s),
            step_s,
        }
    }

    /// When its height has an extreme, s after the first row: at a root of a polynomial of the second degree.
    pub fn time_of_turn(&self, is_top: bool) -> f64 {
        let [begin, end] = self.ways.map(|way| way.z);
        let rise = self.ends[1].z - self.ends[0].z;
        let (square, linear) = (
            3.0 * (begin + end) - 6.0 * rise,
            6.0 * rise - 4.0 * begin - 2.0 * end,
        );
        // Of both roots the one at which it turns the right way: linear + 2 square t is negative at a top.
        let root = (linear * linear - 4.0 * square * begin).max(0.0).sqrt();
        let signed = if is_top { -root } else { root };
        let share = if linear * signed > 0.0 {
            -2.0 * begin / (linear + signed)
        } else {
            (signed - linear) / (2.0 * square)
        };
        share.clamp(0.0, 1.0) * self.step_s
    }

    pub fn at(&self, time_s: f64) -> Swing {
        let t = time_s / self.step_s;
        let [from, to] = self.ends;
        let [begin, end] = self.ways;
        let rise = to - from;
        let axle = from
            + t * (begin + t * ((3.0 * rise - 2.0 * begin - end) + t * (begin + end - 2.0 * rise)));
        Swing {
            axle,
            momentum: Vector3::zeros(),
        }
    }
}
