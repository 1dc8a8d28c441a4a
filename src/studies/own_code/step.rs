//! The report's step as a student writes it, in plain code.
//!
//! It repeats the scheme of [`physics::report`](crate::physics::report) line by line as the report prints it, because a
//! slip must be able to change any line. The order of additions and the precision can be chosen. Differences that
//! depend on either are rounding errors, not mistakes of a program.

use super::plan::Plan;
use super::slips::{Along, FOREVER, Mutations, Other, Sequence};
use crate::engine::scenario::{Push, Window};
use crate::physics::workings::{PhaseName, WorkedQuantity, WorkedValue};
use nalgebra::{Matrix3, RealField, Vector3, convert, convert_unchecked};

/// A floating-point number, f64 or f32.
pub trait Real: RealField + Copy {
    fn from_double(number: f64) -> Self {
        convert(number)
    }
    fn f64(self) -> f64 {
        convert_unchecked(self)
    }
}

impl Real for f64 {}
impl Real for f32 {}

/// Order in which sums are added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Forward,
    Backward,
    EvenThenOdd,
}

/// Symbol of the traced point after the step.
pub const TRACED_SYMBOL: &str = "new X";

/// Rotation of the points in a step: about u by an angle, with the matrix R.
#[derive(Clone, Copy, Debug)]
pub struct StepRotation<T> {
    u: Vector3<T>,
    angle: T,
    rotation: Matrix3<T>,
}

/// A run of the report's step with changes. It starts at step 0.
#[derive(Clone, Debug)]
pub struct MutantStepper<T> {
    changes: Mutations,
    order: Order,
    sequence: Vec<usize>,
    points: Vec<(Vector3<T>, T)>,
    momentum: Vector3<T>,
    earlier: Vector3<T>,
    inertia: Matrix3<T>,
    torques: Vector3<T>,
    traced: usize,
    rim: usize,
    axle: usize,
    pushes: Vec<Push>,
    gravity: T,
    time_step: T,
    clock: u64,
}

impl<T: Real> MutantStepper<T> {
    pub fn new(plan: &Plan, changes: &Mutations, order: Order) -> Self {
        let (turned, momentum) = plan.start(changes);
        let points = plan.body(changes).into_iter().map(|(at, mass)| {
            (
                (turned * Vector3::from(at)).map(T::from_double),
                T::from_double(mass),
            )
        });
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
            momentum: momentum.map(T::from_double),
            earlier: momentum.map(T::from_double),
            inertia: Matrix3::zeros(),
            torques: Vector3::zeros(),
            traced: plan.traced,
            rim: plan.rim,
            axle: plan.axle.len(),
            pushes: plan.pushes.clone(),
            gravity: T::from_double(changes.gravity.unwrap_or(plan.gravity)),
            time_step: T::from_double(changes.time_step_s.unwrap_or(plan.time_step_s)),
            clock: 0,
        };
        if !changes.inertia_sums_up {
            program.inertia = program.inertia();
        }
        program
    }

    /// Returns true if the current moments of inertia differ from axis to axis.
    pub fn has_axes(&self) -> bool {
        const SAME_WITHIN: f64 = 1e-6;
        let mean = self.inertia.trace() / T::from_double(3.0);
        let rest = self.inertia - Matrix3::identity() * mean;
        rest.amax().f64() > SAME_WITHIN * mean.f64()
    }

    /// Returns the traced point, world frame, m, and L, J s, as the program writes them.
    pub fn row(&self) -> [f64; 6] {
        let momentum = if self.changes.row_late {
            self.earlier
        } else {
            self.momentum
        };
        let at = self.at(self.changes.traced, self.traced);
        let mut row = [at.x, at.y, at.z, momentum.x, momentum.y, momentum.z].map(T::f64);
        if let Some((one, other)) = self.changes.swapped {
            row.swap(one, other);
        }
        if self.changes.swapped_twice {
            row.swap(0, 1);
            row.swap(3, 4);
        }
        row
    }

    /// Takes one step of the report. Returns the angular velocity, the rotation and the torque.
    pub fn step(&mut self) -> (Vector3<T>, Option<StepRotation<T>>, Vector3<T>) {
        self.clock += 1;
        self.earlier = self.momentum;
        let mut early = None;
        if self.changes.sequence == Sequence::LBeforeTurn {
            let torque = self.torque();
            self.kick(torque);
            early = Some(torque);
        }
        if self.changes.inertia_sums_up {
            self.inertia += self.inertia();
        } else if !self.changes.inertia_kept {
            self.inertia = self.inertia();
        }
        let omega = self.omega();
        if self.changes.sequence == Sequence::TorqueBeforeTurn {
            early = Some(self.torque());
        }
        let turn = self.rotation(&omega);
        self.turn(&omega, turn.as_ref().map(|turn| &turn.rotation));
        if let Some(turn) = turn.filter(|_| self.changes.turned.is_some()) {
            self.momentum = self.times(&turn.rotation, &self.momentum);
        }
        let torque = early.unwrap_or_else(|| self.torque());
        if self.changes.sequence != Sequence::LBeforeTurn {
            self.kick(torque);
        }
        (omega, turn, torque)
    }

    /// Takes a step, and returns the results of each phase with the phase's name.
    pub fn numbers(&mut self) -> Vec<(PhaseName, WorkedQuantity)> {
        let (omega, turn, torque) = self.step();
        let mut numbers = vec![
            (PhaseName::Inertia, "I", "kg m²", matrix(&self.inertia)),
            (PhaseName::AngularVelocity, "Ω", "rad/s", vector(&omega)),
            (
                PhaseName::NewPositions,
                TRACED_SYMBOL,
                "m",
                vector(&self.points[self.traced].0),
            ),
            (PhaseName::Torque, "τ", "N m", vector(&torque)),
            (
                PhaseName::NewMomentum,
                "new L",
                "J s",
                vector(&self.momentum),
            ),
        ];
        if let Some(StepRotation { u, angle, rotation }) = &turn {
            numbers.push((PhaseName::AxisAndAngle, "u", "", vector(u)));
            numbers.push((PhaseName::AxisAndAngle, "angle", "rad", angle.f64().into()));
            numbers.push((PhaseName::Rotation, "R", "", matrix(rotation)));
        }
        numbers
            .into_iter()
            .map(|(phase, symbol, unit, value)| (phase, WorkedQuantity::new(symbol, unit, value)))
            .collect()
    }

    /// Computes equation (2): I = sum of m (|r|^2 E - r r^T), about the pivot.
    fn inertia(&self) -> Matrix3<T> {
        let changes = &self.changes;
        let centre = if changes.about_centre {
            self.centre()
        } else {
            Vector3::zeros()
        };
        let e = if changes.without_e {
            Matrix3::repeat(T::one())
        } else {
            Matrix3::identity()
        };
        let total = self.total(changes.total_on_each == Some(true));
        let mut sum = Matrix3::zeros();
        let counted = self
            .sequence
            .iter()
            .filter(|k| !self.is_left_out(**k, false));
        for &k in counted {
            let (at, own) = self.points[k];
            let mass = total.filter(|_| own.f64() != 0.0).unwrap_or(own);
            let r = at - centre;
            sum += (e * self.dot(&r, &r) - r * r.transpose()) * mass;
        }
        let diagonal = Matrix3::from_diagonal(&sum.diagonal());
        match changes.products {
            0 => sum,
            1 => diagonal + diagonal - sum,
            _ => diagonal,
        }
    }

    /// Returns true if point `k` is omitted from the sum of the inertia, or of the weight.
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

    /// Returns the mass of the whole body if each rim point has it in the sum.
    fn total(&self, has_it: bool) -> Option<T> {
        has_it.then(|| {
            self.points
                .iter()
                .map(|(_, mass)| *mass)
                .fold(T::zero(), |sum, mass| sum + mass)
        })
    }

    /// Returns the position of point `k`, or of the `other` point that replaces it.
    fn at(&self, other: Option<Other>, k: usize) -> Vector3<T> {
        let mut rim = self.points[..self.rim].iter().map(|(at, _)| at);
        let place = match other {
            None => None,
            Some(Other::OfAxle(nth)) => {
                let mut others = (self.rim..self.rim + self.axle).filter(|place| *place != k);
                others.nth(nth).map(|place| self.points[place].0)
            }
            Some(Other::FirstOfRim) => rim.next().copied(),
            Some(Other::CenterOfRim) if self.rim > 0 => {
                Some(rim.sum::<Vector3<T>>() / T::from_double(self.rim as f64))
            }
            Some(Other::CenterOfRim) => None,
        };
        place.unwrap_or(self.points[k].0)
    }

    /// Solves I Omega = L.
    fn omega(&self) -> Vector3<T> {
        let momentum = &self.momentum;
        let omega = solve(&self.inertia, momentum);
        let axle = match self.changes.along_momentum {
            None => return omega,
            Some(Along::AxisAlone) => {
                let [rate, length] =
                    [&omega, momentum].map(|of| T::from_double(self.dot(of, of).f64().sqrt()));
                return momentum * (rate / length);
            }
            Some(Along::OverThird) => Vector3::z(),
            Some(Along::OverFirst) => Vector3::x(),
            Some(Along::OverAxle | Along::OverAcross) => {
                let at = self.points[self.traced].0;
                at / T::from_double(self.dot(&at, &at).f64().sqrt())
            }
        };
        let moment = self.dot(&axle, &(self.inertia * axle));
        if self.changes.along_momentum == Some(Along::OverAcross) {
            return momentum / ((self.inertia.trace() - moment) * T::from_double(0.5));
        }
        momentum / moment
    }

    fn centre(&self) -> Vector3<T> {
        let (mut sum, mut total) = (Vector3::zeros(), T::zero());
        for (at, mass) in &self.points {
            sum += at * *mass;
            total += *mass;
        }
        sum / total
    }

    /// Computes R = P + cos(|Omega| dt)(E - P) + sin(|Omega| dt)[u]x. Returns `None` if Omega is 0 or the points move
    /// to first order only.
    fn rotation(&self, omega: &Vector3<T>) -> Option<StepRotation<T>> {
        let changes = &self.changes;
        let rate = T::from_double(self.dot(omega, omega).f64().sqrt());
        if rate.f64() == 0.0 || changes.first_order {
            return None;
        }
        let u = match (changes.axis_not_unit, changes.omega_squared) {
            (true, _) => *omega,
            (false, Some(true)) => omega / (rate * rate),
            (false, _) => omega / rate,
        };
        let mut angle = rate * self.time_step.powi(changes.turn_dt.unwrap_or(1));
        if changes.omega_squared.is_some() {
            angle *= rate;
        }
        if let Some(factor) = changes.angle {
            angle *= T::from_double(factor);
        }
        if changes.rotation_reversed {
            angle = -angle;
        }
        let (sine, cosine) = libm::sincos(angle.f64());
        let mut cross = u.cross_matrix();
        if changes.middle_sign == Some(false) {
            cross.row_mut(1).neg_mut();
        }
        let e = changes.turn_e.map(|e| Matrix3::repeat(T::from_double(e)));
        let (p, e) = (u * u.transpose(), e.unwrap_or_else(Matrix3::identity));
        let along = if changes.without_projector {
            Matrix3::zeros()
        } else {
            p
        };
        let rotation = along + (e - p) * T::from_double(cosine) + cross * T::from_double(sine);
        Some(StepRotation { u, angle, rotation })
    }

    fn turn(&mut self, omega: &Vector3<T>, rotation: Option<&Matrix3<T>>) {
        for k in 0..self.points.len() {
            let r = self.points[k].0;
            self.points[k].0 = match rotation {
                Some(rotation) => self.times(rotation, &r),
                None => r + self.cross(omega, &r, false) * self.time_step,
            };
            if let (Some(rotation), Some(y_too)) = (rotation, self.changes.in_place) {
                let new = &mut self.points[k].0;
                new.y = (rotation.row(1) * Vector3::new(new.x, r.y, r.z)).x;
                let y = if y_too { new.y } else { r.y };
                new.z = (rotation.row(2) * Vector3::new(new.x, y, r.z)).x;
            }
        }
    }

    /// Computes the sum of r x F.
    fn torque(&self) -> Vector3<T> {
        let changes = &self.changes;
        let (mut sum, mut weight) = (Vector3::zeros(), Vector3::zeros());
        let (centre, one) = (self.centre(), self.points.first());
        let about = if changes.about_cm {
            centre
        } else {
            Vector3::zeros()
        };
        let total = self.total(changes.total_on_each.is_some());
        for &k in &self.sequence {
            let (at, own) = self.points[k];
            let mass = total.filter(|_| own.f64() != 0.0).unwrap_or(own);
            let force = Vector3::new(T::zero(), T::zero(), self.weight(k, mass));
            weight += force;
            let at = if changes.weight_at_top {
                self.points[self.traced].0
            } else {
                at
            };
            if changes.centre.is_none() {
                sum += self.cross(&(at - about), &force, true);
            }
        }
        if let Some(of_all) = changes.centre {
            if !of_all {
                weight.z = one.map_or(T::zero(), |(_, mass)| self.weight(0, *mass));
            }
            sum += self.cross(&centre, &weight, true);
        }
        for push in &self.pushes {
            let force = push.force.map(T::from_double) * T::from_double(self.push_factor(push));
            let at = match changes.centre {
                Some(true) => centre,
                _ => self.at(changes.push_point, push.point),
            };
            sum += self.cross(&(at - about), &force, true);
        }
        if changes.torque_reversed { -sum } else { sum }
    }

    /// Returns the force of gravity on point `k`, along z, N.
    fn weight(&self, k: usize, mass: T) -> T {
        let changes = &self.changes;
        let mass = match changes.without_mass {
            Some(true) => T::from_double(1.0),
            Some(false) if mass.f64() != 0.0 => T::from_double(1.0),
            _ => mass,
        };
        match (self.is_left_out(k, true), changes.gravity_up) {
            (true, _) => T::zero(),
            (false, true) => mass * self.gravity,
            (false, false) => -(mass * self.gravity),
        }
    }

    /// Returns how many times `push` acts in the current step.
    fn push_factor(&self, push: &Push) -> f64 {
        let Window::Steps { first, count } = push.window else {
            return 0.0;
        };
        let changes = &self.changes;
        let nth = self.clock as i64 + 1 - first as i64 - changes.push_shift;
        let count = (count.min(FOREVER as u64) as i64 + changes.push_longer).clamp(0, FOREVER);
        let times = if push.accumulates || changes.accumulates {
            nth.clamp(0, count) as f64
        } else {
            f64::from(u8::from(nth >= 1 && nth <= count))
        };
        if changes.push_reversed { -times } else { times }
    }

    /// Adds dt times the torque to L.
    fn kick(&mut self, mut torque: Vector3<T>) {
        let changes = &self.changes;
        if changes.sums_up {
            self.torques += torque;
            torque = self.torques;
        }
        if changes.kept || changes.turned == Some(false) {
            return;
        }
        self.momentum += torque * self.time_step.powi(changes.torque_dt.unwrap_or(1));
    }

    fn times(&self, matrix: &Matrix3<T>, vector: &Vector3<T>) -> Vector3<T> {
        match self.order {
            Order::Backward => {
                let [x, y, z] = [0, 1, 2].map(|j| matrix.column(j) * vector[j]);
                z + y + x
            }
            _ => matrix * vector,
        }
    }

    fn cross(&self, a: &Vector3<T>, b: &Vector3<T>, is_torque: bool) -> Vector3<T> {
        let mut cross = a.cross(b);
        if self.changes.middle_sign == Some(is_torque) {
            cross.y = -cross.y;
        }
        cross
    }

    fn dot(&self, a: &Vector3<T>, b: &Vector3<T>) -> T {
        match self.order {
            Order::Backward => a.z * b.z + a.y * b.y + a.x * b.x,
            _ => a.dot(b),
        }
    }
}

/// Solves I Omega = L by Cramer's rule.
fn solve<T: Real>(matrix: &Matrix3<T>, vector: &Vector3<T>) -> Vector3<T> {
    let [a, b, c] = [0, 1, 2].map(|j| matrix.column(j).into_owned());
    let across = b.cross(&c);
    let parts = [
        vector.dot(&across),
        a.dot(&vector.cross(&c)),
        a.dot(&b.cross(vector)),
    ];
    Vector3::from(parts) / a.dot(&across)
}

fn vector<T: Real>(of: &Vector3<T>) -> WorkedValue {
    of.map(T::f64).into()
}

fn matrix<T: Real>(of: &Matrix3<T>) -> WorkedValue {
    of.map(T::f64).into()
}
