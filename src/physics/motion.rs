//! A body, its loads and its state, stepped together by one scheme.

use super::observables::{position, total_energy, weight_height};
use super::scheme::{SchemeInfo, names};
use super::stepping::StepClock;
use super::{Body, Loads, Scheme, State};
use nalgebra::Matrix3;

/// The largest difference between QᵀQ and the identity with which Q counts as a rotation.
const ROTATION_ROUNDING: f64 = 1e-9;

/// A motion that a scheme computes step by step, with its time and its energy.
///
/// [`ExactMotion`](super::ExactMotion) takes the same body, loads and state, so that both can be compared at any time.
///
/// # Examples
/// A ring on a light axle, let go at a tilt of 0.5 rad. It is pushed down for one second:
///
/// ```
/// use gyrolab_physics::{Body, Loads, PlacedSolid, PointForce, Shape, State, SteppedMotion};
/// use gyrolab_physics::{nalgebra::Vector3, rotation};
///
/// let axle = Vector3::z();
/// let ring = PlacedSolid::new(Shape::Ring { radius: 0.8 }, 5.0, axle, &axle)?;
/// let body = Body::from_solids(&[ring])?;
/// let start = State::spinning(&body, rotation::about(&Vector3::x(), 0.5), 30.0);
/// let weight = Loads { gravity: 9.8, ..Loads::default() };
/// let push = PointForce { point: 0, force: Vector3::new(0.0, 0.0, -10.0) }; // the ring's center
///
/// let mut motion = SteppedMotion::new("strang", &body, &weight, &start)?;
/// (0..1000).for_each(|_| motion.step(0.001));
/// motion.set_loads(&Loads { pushes: vec![push], ..weight.clone() })?;
/// (0..1000).for_each(|_| motion.step(0.001));
/// motion.set_loads(&weight)?;
/// (0..1000).for_each(|_| motion.step(0.001));
/// assert!((motion.state().time_s - 3.0).abs() < 1e-12);
/// assert!(motion.energy_error().abs() < 1e-5 * motion.energy());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SteppedMotion {
    body: Body,
    loads: Loads,
    state: State,
    info: &'static SchemeInfo,
    scheme: Box<dyn Scheme>,
    clock: StepClock,
    start_energy: f64,
    work: f64,
}

/// Why a scheme cannot step a body in some state under some loads.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// There is no scheme of this name.
    #[error("no scheme {name:?}: there is {}", names().join(", "))]
    UnknownScheme {
        /// The name that was given.
        name: String,
    },
    /// A number of the state or of the loads is infinite or not a number.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// The orientation is not a rotation matrix.
    #[error("the orientation must be a rotation: orthogonal, and of determinant 1")]
    NotRotation,
    /// A push acts on a point that the body does not have.
    #[error("no point {point}: the body has {points} points, counted from 0")]
    NoPoint {
        /// Index of the point.
        point: usize,
        /// Number of points of the body.
        points: usize,
    },
    /// A coefficient of friction is negative.
    #[error("friction must not be negative")]
    NegativeFriction,
    /// The scheme cannot follow this friction.
    #[error("{scheme} cannot follow this friction: it {why}")]
    Friction {
        /// Name of the scheme.
        scheme: &'static str,
        /// What the scheme does that does not fit the friction.
        why: &'static str,
    },
}

impl SteppedMotion {
    /// Begins the motion of `body` under `loads` at `state`, at the state's own time, by the scheme that
    /// [`SCHEMES`](super::scheme::SCHEMES) lists under the name `scheme`.
    ///
    /// # Errors
    /// If there is no such scheme, if it cannot follow the friction, or if state or loads are not possible.
    pub fn new(
        scheme: &str,
        body: &Body,
        loads: &Loads,
        state: &State,
    ) -> Result<Self, MotionError> {
        let info = SchemeInfo::find(scheme).ok_or_else(|| MotionError::UnknownScheme {
            name: scheme.to_owned(),
        })?;
        check_state(state)?;
        check_loads(info, body, loads)?;
        let mut stepper = info.make(body);
        stepper.load(loads);
        stepper.start(state);
        Ok(Self {
            body: body.clone(),
            loads: loads.clone(),
            state: *state,
            info,
            scheme: stepper,
            clock: StepClock::starting_at(state.time_s),
            start_energy: total_energy(body, state, loads.gravity),
            work: 0.0,
        })
    }

    /// Steps the motion `dt` seconds further.
    ///
    /// Steps of equal length add no rounding to the time. Where the numbers leave their range, the state is no longer
    /// [finite](State::is_finite).
    pub fn step(&mut self, dt: f64) {
        let before = self.state;
        self.scheme.step(dt, &mut self.state);
        self.state.time_s = self.clock.next_time(dt);
        let pushes = self.loads.pushes.iter();
        let work: f64 = pushes
            .map(|push| {
                let [from, to] =
                    [&before, &self.state].map(|state| position(&self.body, state, push.point));
                push.force.dot(&(to - from))
            })
            .sum();
        self.work += work + self.scheme.friction_work();
    }

    /// Sets the forces and the friction that act from now on.
    ///
    /// # Errors
    /// If the scheme cannot follow the friction, or if the loads are not possible. The old loads then stay.
    pub fn set_loads(&mut self, loads: &Loads) -> Result<(), MotionError> {
        check_loads(self.info, &self.body, loads)?;
        let lift = loads.gravity - self.loads.gravity;
        self.work += lift * weight_height(&self.body, &self.state);
        self.loads.clone_from(loads);
        self.scheme.load(loads);
        Ok(())
    }

    /// Returns the present state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the body.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Returns the present loads.
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Returns the scheme.
    pub fn scheme(&self) -> &'static SchemeInfo {
        self.info
    }

    /// Returns the [total energy](total_energy), J.
    pub fn energy(&self) -> f64 {
        total_energy(&self.body, &self.state, self.loads.gravity)
    }

    /// Returns the work since the beginning, J: of pushes, of changes of gravity, and of friction.
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Returns the energy that only the scheme's error can have made, J: the change of the total energy since the beginning,
    /// less the work.
    pub fn energy_error(&self) -> f64 {
        self.energy() - self.start_energy - self.work
    }
}

fn check_state(state: &State) -> Result<(), MotionError> {
    if !state.is_finite() {
        return Err(MotionError::NotFinite("the state"));
    }
    let turn = &state.orientation;
    let bent = (turn.tr_mul(turn) - Matrix3::identity()).amax();
    if bent > ROTATION_ROUNDING || turn.determinant() < 0.0 {
        return Err(MotionError::NotRotation);
    }
    Ok(())
}

fn check_loads(info: &SchemeInfo, body: &Body, loads: &Loads) -> Result<(), MotionError> {
    let points = body.points().len();
    for push in &loads.pushes {
        if push.point >= points {
            let point = push.point;
            return Err(MotionError::NoPoint { point, points });
        }
        if !push.force.iter().all(|component| component.is_finite()) {
            return Err(MotionError::NotFinite("the force of a push"));
        }
    }
    if !loads.gravity.is_finite() {
        return Err(MotionError::NotFinite("gravity"));
    }
    let coefficients = loads.friction.coefficients();
    if !coefficients.iter().all(|rate| rate.is_finite()) {
        return Err(MotionError::NotFinite("friction"));
    }
    if coefficients.iter().any(|rate| *rate < 0.0) {
        return Err(MotionError::NegativeFriction);
    }
    match info.admits.why_not(&loads.friction) {
        Some(why) => Err(MotionError::Friction {
            scheme: info.name,
            why,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::PartError;
    use crate::{Friction, PlacedSolid, PointForce, Shape, rotation};
    use nalgebra::Vector3;

    fn top() -> (Body, Loads, State) {
        let axle = Vector3::z();
        let ring = PlacedSolid::new(Shape::Ring { radius: 0.8 }, 5.0, axle, &axle).unwrap();
        let body = Body::from_solids(&[ring]).unwrap();
        let loads = Loads {
            gravity: 9.8,
            ..Loads::default()
        };
        let start = State::spinning(&body, rotation::about(&Vector3::x(), 0.5), 30.0);
        (body, loads, start)
    }

    #[test]
    fn a_second_motion_continues_the_first_bit_for_bit() {
        let (body, loads, start) = top();
        let mut whole = SteppedMotion::new("strang", &body, &loads, &start).unwrap();
        (0..8).for_each(|_| whole.step(0.125));
        let mut first = SteppedMotion::new("strang", &body, &loads, &start).unwrap();
        (0..3).for_each(|_| first.step(0.125));
        let mut second = SteppedMotion::new("strang", &body, &loads, first.state()).unwrap();
        (0..5).for_each(|_| second.step(0.125));
        assert_eq!(second.state(), whole.state());
        assert_eq!(whole.state().time_s, 1.0);
    }

    #[test]
    fn work_of_pushes_gravity_and_friction_equals_the_energy_change() {
        let (body, weight, start) = top();
        let push = PointForce {
            point: 1,
            force: Vector3::new(3.0, -4.0, 5.0),
        };
        let viscous = Friction {
            spin_viscous: 0.1,
            ..Friction::default()
        };
        let mut motion = SteppedMotion::new("exact", &body, &weight, &start).unwrap();
        for (pushes, gravity, friction) in [
            (vec![push], 9.8, Friction::default()),
            (vec![push], 1.6, viscous),
            (vec![], 9.8, viscous),
        ] {
            let loads = Loads {
                gravity,
                pushes,
                friction,
            };
            motion.set_loads(&loads).unwrap();
            (0..100).for_each(|_| motion.step(0.01));
        }
        assert!(motion.work().abs() > 10.0);
        assert!(
            motion.energy_error().abs() < 1e-8,
            "{}",
            motion.energy_error()
        );
    }

    #[test]
    fn impossible_states_loads_and_frictions_are_rejected() {
        let (body, loads, start) = top();
        let refusal = |scheme: &str, given: &Loads, state: &State| {
            let refused = SteppedMotion::new(scheme, &body, given, state);
            refused.unwrap_err().to_string()
        };
        let stretched = State {
            orientation: 1.001 * start.orientation,
            ..start
        };
        let endless = State {
            time_s: f64::INFINITY,
            ..start
        };
        let dry = Loads {
            friction: Friction {
                spin_dry: 0.1,
                ..Friction::default()
            },
            ..loads.clone()
        };
        let off = Loads {
            pushes: vec![PointForce {
                point: 7,
                force: Vector3::x(),
            }],
            ..loads.clone()
        };
        assert_eq!(
            refusal("euler", &loads, &start),
            "no scheme \"euler\": there is report, rk4, strang, srkn11b, exact"
        );
        assert_eq!(
            refusal("rk4", &loads, &stretched),
            "the orientation must be a rotation: orthogonal, and of determinant 1"
        );
        assert_eq!(refusal("rk4", &loads, &endless), "the state must be finite");
        assert!(
            refusal("rk4", &dry, &start).starts_with("rk4 cannot follow this friction: it takes")
        );
        assert_eq!(
            refusal("rk4", &off, &start),
            "no point 7: the body has 7 points, counted from 0"
        );
        let mut motion = SteppedMotion::new("srkn11b", &body, &loads, &start).unwrap();
        assert!(motion.set_loads(&dry).is_err());
        assert_eq!(motion.loads(), &loads);
    }

    #[test]
    fn solids_with_impossible_dimensions_are_rejected() {
        let axle = Vector3::z();
        let refusal = |shape: Shape, mass: f64, axis: Vector3<f64>| {
            let refused: PartError = PlacedSolid::new(shape, mass, axle, &axis).unwrap_err();
            refused.to_string()
        };
        let (ball, tube) = (
            Shape::Ball { radius: 1.0 },
            Shape::Tube {
                inner: 0.2,
                outer: 0.1,
                length: 0.0,
            },
        );
        let zero = "must be greater than zero";
        assert_eq!(refusal(ball, 0.0, axle), format!("mass {zero}"));
        assert_eq!(refusal(ball, f64::NAN, axle), format!("mass {zero}"));
        assert_eq!(
            refusal(Shape::Ring { radius: -1.0 }, 1.0, axle),
            format!("radius {zero}")
        );
        assert_eq!(
            refusal(tube, 1.0, axle),
            "inner must not be greater than outer"
        );
        assert_eq!(
            refusal(ball, 1.0, Vector3::zeros()),
            "axis must not have length 0: it is a direction"
        );
        let negative = Shape::Block {
            size: Vector3::new(1.0, -1.0, 1.0),
        };
        assert_eq!(
            refusal(negative, 1.0, axle),
            "size must not contain a negative number"
        );
    }
}
