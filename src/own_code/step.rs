//! The report's step as a student writes it, in plain code, and the slips: each changes one thing in it.
//!
//! It is the scheme of [`physics::report`](crate::physics::report) again, line by line as the report prints it, because a slip
//! must be able to change any line. Its order of additions can be chosen, and so can its precision: what depends on either is
//! rounding, and no fault of a program.

use super::arithmetic::{Matrix, Real, Vector, cross, dot, solve};
use super::plan::Plan;
use crate::physics::workings::{Quantity, Value};
use crate::scenario::{Push, Window};
use nalgebra::{Matrix3, Vector3};

/// In which order sums are added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Forward,
    Backward,
    EvenThenOdd,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Sequence {
    /// Inertia, Omega, turn, torque, L.
    #[default]
    Report,
    /// Inertia, Omega, torque, turn, L.
    TorqueBeforeTurn,
    /// Torque, L, inertia, Omega, turn.
    LBeforeTurn,
}

/// What acts at the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Centre {
    #[default]
    Nothing,
    OnePoint,
    OnePointAndPush,
    All,
    AllPoints,
    Mean,
}

/// Everything that a slip can change in the report's step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Changes {
    inertia_kept: bool,
    /// Of the products of inertia: 1 adds them, 2 leaves them out.
    products: u8,
    without_e: bool,
    about_centre: bool,
    /// The point of the rim that is left out: whether it is the last, and whether its weight is left out too.
    left_out: Option<(bool, bool)>,
    /// Mass for the axle: whether its top alone has it.
    pub(super) axle_mass: Option<bool>,
    pub(super) rim_point_twice: bool,
    rotation_reversed: bool,
    dt_forgotten: bool,
    axis_not_unit: bool,
    first_order: bool,
    /// By what the angle is multiplied.
    angle: Option<f64>,
    sequence: Sequence,
    row_late: bool,
    /// Turned in place: whether the new y is used too.
    in_place: Option<bool>,
    dt_missing: bool,
    /// Weights without m: whether the points without mass have one too.
    without_mass: Option<bool>,
    no_gravity: bool,
    /// Which of the axle's other points is written; beyond them the first of the rim.
    pub(super) traced: Option<usize>,
    swapped: Option<(usize, usize)>,
    torque_reversed: bool,
    gravity_up: bool,
    centre: Centre,
    sums_up: bool,
    gravity: Option<f64>,
    kept: bool,
    /// L turned with the body: whether the torque is added too.
    turned: Option<bool>,
    pub(super) other_frame: bool,
    /// The axis of the tilt, and whether the points alone are tilted about it.
    pub(super) tilt_axis: Option<([f64; 3], bool)>,
    pub(super) tilt_in_radians: bool,
    /// How many steps later the push acts.
    push_shift: i64,
    /// How many steps longer it acts.
    push_longer: u64,
    accumulates: bool,
    pub(super) time_step_s: Option<f64>,
}

/// What is special about a variant of a slip, and the change that it makes.
type Variant = (&'static str, fn(&mut Changes));

/// One thing that goes wrong in programs of the report's step.
#[derive(Debug)]
pub struct Slip {
    pub name: &'static str,
    /// What the program does, and what the report does: two sentences without their ends.
    pub program: &'static str,
    pub report: &'static str,
    pub variants: &'static [Variant],
}

const fn slip(
    name: &'static str,
    program: &'static str,
    report: &'static str,
    variants: &'static [Variant],
) -> Slip {
    Slip {
        name,
        program,
        report,
        variants,
    }
}

/// The symbol of the traced point after the step.
pub const TRACED: &str = "new X";

const DEGREES: f64 = std::f64::consts::PI / 180.0;
const FOREVER: u64 = u64::MAX / 2;

/// Every slip that is looked for, but for another time step, which is read off the file.
#[rustfmt::skip]
pub const SLIPS: &[Slip] = &[
    slip("inertia-kept", "the inertia is summed once, at the start", "sums it anew in each step, from the turned points", &[("", |c| c.inertia_kept = true)]),
    slip("inertia-product-sign", "the products of inertia are added", "subtracts them: I = sum m (|r|^2 E - r r^T)", &[("", |c| c.products = 1)]),
    slip("inertia-diagonal", "the products of inertia are left out, or L is divided by the diagonal alone", "solves I Omega = L with the whole matrix", &[("", |c| c.products = 2)]),
    slip("inertia-without-E", "r r^T is subtracted from the number r.r, in each of the nine places", "multiplies r.r by the unit matrix E first", &[("", |c| c.without_e = true)]),
    slip("inertia-about-centre", "the inertia is about the centre of mass", "measures r from the pivot, about which L is too", &[("", |c| c.about_centre = true)]),
    slip("point-left-out", "one point of the rim is left out of the sum", "sums over every point", &[
        ("the first, in the inertia alone", |c| c.left_out = Some((false, false))),
        ("the last, in the inertia alone", |c| c.left_out = Some((true, false))),
        ("the first, in inertia and weight", |c| c.left_out = Some((false, true))),
        ("the last, in inertia and weight", |c| c.left_out = Some((true, true)))]),
    slip("top-has-mass", "points of the axle have the mass of a rim point", "gives the axle no mass", &[
        ("all of them", |c| c.axle_mass = Some(false)), ("the top alone", |c| c.axle_mass = Some(true))]),
    slip("rim-point-twice", "the first and the last point of the rim are in one place, as linspace(0, 2*pi, n) puts them", "puts n points at n different angles, 2 pi/n apart", &[("", |c| c.rim_point_twice = true)]),
    slip("rotation-reversed", "the points are turned by minus the angle, as the transposed R does", "turns them by +|Omega| dt about Omega", &[("", |c| c.rotation_reversed = true)]),
    slip("dt-forgotten", "the points are turned by |Omega|", "turns them by |Omega| dt", &[("", |c| c.dt_forgotten = true)]),
    slip("axis-not-unit", "P and the cross matrix are made from Omega itself", "makes them from the unit vector Omega/|Omega|", &[("", |c| c.axis_not_unit = true)]),
    slip("first-order-rotation", "the points move by dt Omega x r", "turns them by the rotation matrix", &[("", |c| c.first_order = true)]),
    slip("angle-in-degrees", "degrees and radians are mixed up in the angle of the turn", "turns by |Omega| dt radians", &[
        ("radians in cosd and sind", |c| c.angle = Some(DEGREES)), ("degrees in cos and sin", |c| c.angle = Some(1.0 / DEGREES))]),
    slip("torque-before-turn", "the torque is taken before the points are turned", "turns them first, then sums r x F", &[("", |c| c.sequence = Sequence::TorqueBeforeTurn)]),
    slip("L-before-turn", "L gets its torque first, and the points are turned with the new L", "turns the points with the old L, and then adds the torque to L", &[("", |c| c.sequence = Sequence::LBeforeTurn)]),
    slip("L-a-row-late", "L is written a row late: in each row it is the L before the step", "has in one row the points and the L after the step", &[("", |c| c.row_late = true)]),
    slip("points-in-place", "x is turned in place, and the new x is used for y and z", "turns all three from the old x, y and z", &[
        ("and the new y for z", |c| c.in_place = Some(true)), ("", |c| c.in_place = Some(false))]),
    slip("dt-missing-in-torque", "the torque is added to L without dt", "adds dt times the torque", &[("", |c| c.dt_missing = true)]),
    slip("force-without-mass", "the weight of a point is g", "makes it m g", &[
        ("also of the points without mass", |c| c.without_mass = Some(true)), ("of the points with mass", |c| c.without_mass = Some(false))]),
    slip("no-gravity", "there is no weight", "pulls each point down by m g", &[("", |c| c.no_gravity = true)]),
    slip("hub-traced", "another point is written", "traces the axle's top", &[
        ("", |c| c.traced = Some(0)), ("", |c| c.traced = Some(1)), ("", |c| c.traced = Some(2)),
        ("the first of the rim", |c| c.traced = Some(usize::MAX))]),
    slip("columns-swapped", "two columns have changed places", "has x, y, z in this order", &[
        ("x and y", |c| c.swapped = Some((0, 1))), ("x and z", |c| c.swapped = Some((0, 2))), ("y and z", |c| c.swapped = Some((1, 2))),
        ("Lx and Ly", |c| c.swapped = Some((3, 4))), ("Lx and Lz", |c| c.swapped = Some((3, 5))), ("Ly and Lz", |c| c.swapped = Some((4, 5)))]),
    slip("torque-reversed", "the torque is F x r", "takes r x F", &[("", |c| c.torque_reversed = true)]),
    slip("gravity-up", "the weight points up", "has it along -z", &[("", |c| c.gravity_up = true)]),
    slip("torque-of-centre", "the torque is taken at one point for all, the centre of mass", "sums r x F over the points, each with its own r and F", &[
        ("with the mass of one point", |c| c.centre = Centre::OnePoint), ("with the mass of one point, the push there too", |c| c.centre = Centre::OnePointAndPush),
        ("with the whole mass, the push there too", |c| c.centre = Centre::All), ("with a rim point's mass for every point, massless ones too", |c| c.centre = Centre::AllPoints),
        ("at the mean of all points, massless ones too", |c| c.centre = Centre::Mean)]),
    slip("torque-sums-up", "the torque is never set to zero, and adds up over the steps", "sums it anew in each step", &[("", |c| c.sums_up = true)]),
    slip("gravity-9.81", "g is 9.81", "has g = 9.8", &[("", |c| c.gravity = Some(9.81))]),
    slip("gravity-10", "g is 10", "has g = 9.8", &[("", |c| c.gravity = Some(10.0))]),
    slip("L-kept", "L is never updated", "adds dt times the torque to it in each step", &[("", |c| c.kept = true)]),
    slip("L-turned", "L is turned with the body", "keeps it in the world frame, where the torque alone changes it", &[
        ("and the torque is added", |c| c.turned = Some(true)), ("and no torque is added", |c| c.turned = Some(false))]),
    slip("L-other-frame", "L begins in the other frame: turned where it is the world's, or not turned where it is the body's", "takes it as the scenario states it", &[("", |c| c.other_frame = true)]),
    slip("tilt-other-axis", "the body is tilted about another axis", "tilts it about +x", &[
        ("about -x", |c| c.tilt_axis = Some(([-1.0, 0.0, 0.0], false))), ("about +y", |c| c.tilt_axis = Some(([0.0, 1.0, 0.0], false))),
        ("about -y", |c| c.tilt_axis = Some(([0.0, -1.0, 0.0], false))), ("about -x, the points alone", |c| c.tilt_axis = Some(([-1.0, 0.0, 0.0], true))),
        ("about +y, the points alone", |c| c.tilt_axis = Some(([0.0, 1.0, 0.0], true))), ("about -y, the points alone", |c| c.tilt_axis = Some(([0.0, -1.0, 0.0], true)))]),
    slip("tilt-in-radians", "the tilt in degrees is taken for radians", "converts it", &[("", |c| c.tilt_in_radians = true)]),
    slip("push-early", "the push acts a step early, and ends a step early", "has it from its first step on", &[("", |c| c.push_shift = -1)]),
    slip("push-late", "t in it is the time at the step's start, so that the push acts a step later", "gets t = step times dt here", &[("", |c| c.push_shift = 1)]),
    slip("push-too-long", "the push acts too long", "ends it after its last step", &[
        ("one step more", |c| c.push_longer = 1), ("to the end of the run", |c| c.push_longer = FOREVER)]),
    slip("push-accumulates", "the push is added to an array of forces that is never built anew, and grows with each step", "builds F anew in each step", &[("", |c| c.accumulates = true)]),
];

/// Another reading of the report's text is no slip.
pub const ANOTHER_READING: &str = "push-late";

/// How a step turns the points: about u by an angle, with the matrix R.
#[derive(Clone, Copy, Debug)]
pub struct Turn<T> {
    u: Vector<T>,
    angle: T,
    rotation: Matrix<T>,
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

    /// One step of the report. Returns the angular velocity, the turn and the torque on its way.
    pub fn step(&mut self) -> (Vector<T>, Option<Turn<T>>, Vector<T>) {
        self.clock += 1;
        self.earlier = self.momentum;
        let mut early = None;
        if self.changes.sequence == Sequence::LBeforeTurn {
            let torque = self.torque();
            self.kick(torque);
            early = Some(torque);
        }
        if !self.changes.inertia_kept {
            self.inertia = self.inertia();
        }
        let omega = solve(&self.inertia, &self.momentum);
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

    /// Takes a step, and gives what each phase of it results in, with the phase's name.
    pub fn numbers(&mut self) -> Vec<(&'static str, Quantity)> {
        let vector = |of: &Vector<T>| Value::from(Vector3::from(of.map(T::f64)));
        let matrix = |of: &Matrix<T>| Value::from(Matrix3::from_fn(|i, j| of[i][j].f64()));
        let (omega, turn, torque) = self.step();
        let mut numbers = vec![
            ("inertia", "I", "kg m²", matrix(&self.inertia)),
            ("angular velocity", "Ω", "rad/s", vector(&omega)),
            (
                "new positions",
                TRACED,
                "m",
                vector(&self.points[self.traced].0),
            ),
            ("torque", "τ", "N m", vector(&torque)),
            ("new momentum", "new L", "J s", vector(&self.momentum)),
        ];
        if let Some(Turn { u, angle, rotation }) = &turn {
            numbers.push(("axis and angle", "u", "", vector(u)));
            numbers.push(("axis and angle", "angle", "rad", angle.f64().into()));
            numbers.push(("rotation", "R", "", matrix(rotation)));
        }
        let quantity = |(phase, symbol, unit, value)| (phase, Quantity::new(symbol, unit, value));
        numbers.into_iter().map(quantity).collect()
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
    fn rotation(&self, omega: &Vector<T>) -> Option<Turn<T>> {
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
        let rotation = [0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| {
                let (p, e) = (u[i] * u[j], T::of(f64::from(u8::from(i == j))));
                p + cosine * (e - p) + sine * cross[i][j]
            })
        });
        Some(Turn { u, angle, rotation })
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
