//! The report's step as a student writes it, in plain code.
//!
//! It is the scheme of [`physics::report`](crate::physics::report) again, line by line as the report prints it, because a slip
//! must be able to change any line. Its order of additions can be chosen, and so can its precision: what depends on either is
//! rounding, and no fault of a program.

use super::arithmetic::{Matrix, Real, Vector, cross, dot, solve};
use super::plan::Plan;
use super::slips::{Centre, Changes, FOREVER, Sequence};
use crate::scenario::{Push, Window};
use nalgebra::Vector3;

/// In which order sums are added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Forward,
    Backward,
    EvenThenOdd,
}

/// A run of the report's step with changes in it. It stands at step 0 at first.
#[derive(Clone, Debug)]
pub struct Program<T> {
    changes: Changes,
    order: Order,
    sequence: Vec<usize>,
    points: Vec<(Vector<T>, T)>,
    momentum: Vector<T>,
    earlier: Vector<T>,
    inertia: Matrix<T>,
    torques: Vector<T>,
    traced: usize,
    rim: usize,
    pushes: Vec<Push>,
    gravity: T,
    time_step: T,
    clock: u64,
}

impl<T: Real> Program<T> {
    pub fn new(plan: &Plan, changes: &Changes, order: Order) -> Self {
        let (turned, momentum) = plan.start(changes);
        let vector = |of: Vector3<f64>| [T::of(of.x), T::of(of.y), T::of(of.z)];
        let points = plan.body(changes).into_iter();
        let points = points.map(|(at, mass)| (vector(turned * Vector3::from(at)), T::of(mass)));
        let count = plan.points.len();
        let mut program = Self {
            changes: *changes,
            order,
            sequence: match order {
                Order::Forward => (0..count).collect(),
                Order::Backward => (0..count).rev().collect(),
                Order::EvenThenOdd => (0..count).step_by(2).chain((1..count).step_by(2)).collect(),
            },
            points: points.collect(),
            momentum: vector(momentum),
            earlier: vector(momentum),
            inertia: [[T::of(0.0); 3]; 3],
            torques: [T::of(0.0); 3],
            traced: plan.traced(changes),
            rim: plan.rim,
            pushes: plan.pushes.clone(),
            gravity: T::of(changes.gravity.unwrap_or(plan.gravity)),
            time_step: T::of(changes.time_step_s.unwrap_or(plan.time_step_s)),
            clock: 0,
        };
        program.inertia = program.inertia();
        program
    }

    /// The traced point, world frame, m, and L, J s, as the program writes them.
    pub fn row(&self) -> [f64; 6] {
        let [x, y, z] = self.points[self.traced].0.map(T::f64);
        let momentum = if self.changes.row_late {
            self.earlier
        } else {
            self.momentum
        };
        let [lx, ly, lz] = momentum.map(T::f64);
        let mut row = [x, y, z, lx, ly, lz];
        if let Some((one, other)) = self.changes.swapped {
            row.swap(one, other);
        }
        row
    }

    /// One step of the report.
    pub fn step(&mut self) {
        self.clock += 1;
        self.earlier = self.momentum;
        if self.changes.sequence == Sequence::LBeforeTurn {
            let torque = self.torque();
            self.kick(torque);
        }
        if !self.changes.inertia_kept {
            self.inertia = self.inertia();
        }
        let omega = solve(&self.inertia, &self.momentum);
        let early = (self.changes.sequence == Sequence::TorqueBeforeTurn).then(|| self.torque());
        let rotation = self.rotation(&omega);
        self.turn(&omega, rotation.as_ref());
        if let Some(rotation) = rotation.filter(|_| self.changes.turned.is_some()) {
            self.momentum = self.times(&rotation, &self.momentum);
        }
        if self.changes.sequence != Sequence::LBeforeTurn {
            let torque = early.unwrap_or_else(|| self.torque());
            self.kick(torque);
        }
    }

    /// Equation (2): I = sum of m (|r|^2 E - r r^T), about the pivot.
    fn inertia(&self) -> Matrix<T> {
        let zero = T::of(0.0);
        let changes = &self.changes;
        let centre = if changes.about_centre {
            self.centre()
        } else {
            [zero; 3]
        };
        let mut sum = [[zero; 3]; 3];
        for &k in &self.sequence {
            if self.is_left_out(k, false) {
                continue;
            }
            let (at, mass) = self.points[k];
            let r = [0, 1, 2].map(|i| at[i] - centre[i]);
            let square = self.dot(&r, &r);
            for i in 0..3 {
                for j in 0..3 {
                    let e = if i == j || changes.without_e {
                        square
                    } else {
                        zero
                    };
                    sum[i][j] = sum[i][j] + mass * (e - r[i] * r[j]);
                }
            }
        }
        for (i, row) in sum.iter_mut().enumerate() {
            for (_, place) in row.iter_mut().enumerate().filter(|(j, _)| *j != i) {
                *place = match changes.products {
                    0 => *place,
                    1 => -*place,
                    _ => zero,
                };
            }
        }
        sum
    }

    /// Whether point `k` is left out of the sum, of the inertia or of the weight.
    fn is_left_out(&self, k: usize, of_weight: bool) -> bool {
        self.changes.left_out.is_some_and(|(is_last, weight_too)| {
            let place = if is_last {
                self.rim.saturating_sub(1)
            } else {
                0
            };
            k == place && self.rim > 0 && (weight_too || !of_weight)
        })
    }

    fn centre(&self) -> Vector<T> {
        let zero = T::of(0.0);
        let (mut sum, mut total) = ([zero; 3], zero);
        let is_mean = self.changes.centre == Centre::Mean && !self.changes.about_centre;
        for (at, mass) in &self.points {
            let mass = if is_mean { T::of(1.0) } else { *mass };
            sum = [0, 1, 2].map(|i| sum[i] + mass * at[i]);
            total = total + mass;
        }
        sum.map(|part| part / total)
    }

    /// R = P + cos(|Omega| dt)(E - P) + sin(|Omega| dt)[u]x; `None` where there is no Omega.
    fn rotation(&self, omega: &Vector<T>) -> Option<Matrix<T>> {
        let changes = &self.changes;
        let rate = T::of(self.dot(omega, omega).f64().sqrt());
        if rate.f64() == 0.0 || changes.first_order {
            return None;
        }
        let u = if changes.axis_not_unit {
            *omega
        } else {
            omega.map(|part| part / rate)
        };
        let mut angle = rate;
        if !changes.dt_forgotten {
            angle = angle * self.time_step;
        }
        if let Some(factor) = changes.angle {
            angle = angle * T::of(factor);
        }
        if changes.rotation_reversed {
            angle = -angle;
        }
        let (sine, cosine) = libm::sincos(angle.f64());
        let (sine, cosine, zero) = (T::of(sine), T::of(cosine), T::of(0.0));
        let cross = [
            [zero, -u[2], u[1]],
            [u[2], zero, -u[0]],
            [-u[1], u[0], zero],
        ];
        Some([0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| {
                let (p, e) = (u[i] * u[j], T::of(f64::from(u8::from(i == j))));
                p + cosine * (e - p) + sine * cross[i][j]
            })
        }))
    }

    fn turn(&mut self, omega: &Vector<T>, rotation: Option<&Matrix<T>>) {
        for k in 0..self.points.len() {
            let r = self.points[k].0;
            self.points[k].0 = match rotation {
                Some(rotation) => self.times(rotation, &r),
                None => {
                    let velocity = cross(omega, &r);
                    [0, 1, 2].map(|i| r[i] + self.time_step * velocity[i])
                }
            };
            if let (Some(rotation), Some(y_too)) = (rotation, self.changes.in_place) {
                let new = &mut self.points[k].0;
                new[1] = dot(&rotation[1], &[new[0], r[1], r[2]]);
                let y = if y_too { new[1] } else { r[1] };
                new[2] = dot(&rotation[2], &[new[0], y, r[2]]);
            }
        }
    }

    /// Sum of r x F.
    fn torque(&self) -> Vector<T> {
        let changes = &self.changes;
        let zero = T::of(0.0);
        let mut sum = [zero; 3];
        let mut add = |r: &Vector<T>, force: Vector<T>| {
            let torque = cross(r, &force);
            sum = [0, 1, 2].map(|i| sum[i] + torque[i]);
        };
        let mut weight = zero;
        for &k in &self.sequence {
            let (at, mass) = &self.points[k];
            let force = [zero, zero, self.weight(k, *mass)];
            weight = weight + force[2];
            if changes.centre == Centre::Nothing {
                add(at, force);
            }
        }
        let centre = self.centre();
        let one_mass = self.points.first().map_or(zero, |(_, mass)| *mass);
        let of_points = |count: usize| self.weight(0, one_mass) * T::of(count as f64);
        match changes.centre {
            Centre::Nothing => {}
            Centre::OnePoint | Centre::OnePointAndPush => add(&centre, [zero, zero, of_points(1)]),
            Centre::AllPoints => add(&centre, [zero, zero, of_points(self.points.len())]),
            Centre::All | Centre::Mean => add(&centre, [zero, zero, weight]),
        }
        for push in &self.pushes {
            let factor = T::of(self.push_factor(push));
            let force: [f64; 3] = push.force.into();
            let at = match changes.centre {
                Centre::OnePointAndPush | Centre::All => &centre,
                _ => &self.points[push.point].0,
            };
            add(at, force.map(|part| T::of(part) * factor));
        }
        if changes.torque_reversed {
            sum = sum.map(|part| -part);
        }
        sum
    }

    /// The force of gravity on point `k`, along z, N.
    fn weight(&self, k: usize, mass: T) -> T {
        let changes = &self.changes;
        let mass = match changes.without_mass {
            Some(true) => T::of(1.0),
            Some(false) if mass.f64() != 0.0 => T::of(1.0),
            _ => mass,
        };
        let has_none = changes.no_gravity || self.is_left_out(k, true);
        match (has_none, changes.gravity_up) {
            (true, _) => T::of(0.0),
            (false, true) => mass * self.gravity,
            (false, false) => -(mass * self.gravity),
        }
    }

    /// How many times `push` acts on the step that is taken now.
    fn push_factor(&self, push: &Push) -> f64 {
        let Window::Steps { first, count } = push.window else {
            return 0.0;
        };
        let changes = &self.changes;
        let nth = self.clock as i64 + 1 - first as i64 - changes.push_shift;
        let count = (count.saturating_add(changes.push_longer)).min(FOREVER) as i64;
        if push.accumulates || changes.accumulates {
            nth.clamp(0, count) as f64
        } else {
            f64::from(u8::from(nth >= 1 && nth <= count))
        }
    }

    /// L <- L + dt torque.
    fn kick(&mut self, torque: Vector<T>) {
        let changes = &self.changes;
        let mut torque = torque;
        if changes.sums_up {
            self.torques = [0, 1, 2].map(|i| self.torques[i] + torque[i]);
            torque = self.torques;
        }
        if changes.kept || changes.turned == Some(false) {
            return;
        }
        let dt = if changes.dt_missing {
            T::of(1.0)
        } else {
            self.time_step
        };
        self.momentum = [0, 1, 2].map(|i| self.momentum[i] + dt * torque[i]);
    }

    fn times(&self, matrix: &Matrix<T>, vector: &Vector<T>) -> Vector<T> {
        [0, 1, 2].map(|i| self.dot(&matrix[i], vector))
    }

    fn dot(&self, a: &Vector<T>, b: &Vector<T>) -> T {
        if self.order == Order::Backward {
            return a[2] * b[2] + a[1] * b[1] + a[0] * b[0];
        }
        dot(a, b)
    }
}
