//! The exact motion of a rigid body about a fixed point, to which every scheme is compared.
//!
//! - [`LagrangeTop`]: a body symmetric about its axle, under a constant force that acts on the axle. Solved in closed
//!   form by theta functions: any time, past or future, in one evaluation and without stepping.
//! - [`AccurateMotion`]: any body under any constant forces and friction, by a Taylor series with only rounding errors.
//!
//! [`ExactMotion`] uses the closed form if there is one, otherwise the series. The scheme `exact` follows it.

mod lagrange;
mod phases;
mod positions;
mod scheme;
mod series;
mod sliding;
mod taylor;
mod theta;
mod turning;

pub use lagrange::LagrangeTop;
pub use positions::AT_ONCE;
pub(crate) use scheme::Exact;
pub use taylor::AccurateMotion;

use super::symmetry::SymmetricTop;
use super::workings::{Listener, Nobody};
use super::{Body, Damping, Loads, State};
use nalgebra::{Matrix3, Vector3};

/// The exact motion from one state, under constant loads. It is as accurate as [`LagrangeTop`] or [`AccurateMotion`],
/// depending on its [`kind`](Self::kind).
#[derive(Clone, Debug)]
pub struct ExactMotion {
    begin: State,
    solution: ExactSolution,
}

#[derive(Clone, Debug)]
enum ExactSolution {
    Closed(Box<LagrangeTop>),
    Integrated(Box<AccurateMotion>),
    /// For numbers that are not finite.
    None,
}

/// How the exact motion is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactMethod {
    /// By elliptic functions: the body is symmetric about its axle and every force acts on it.
    Closed,
    /// By an integration with only rounding errors: any body, any forces.
    Integrated,
    /// By an integration with only rounding errors, with friction. The time at which the spin stops is found as an event.
    Rubbing,
}

impl ExactMotion {
    /// Makes the motion of `body` under `loads` that has `state` at the state's own time.
    ///
    /// # Panics
    /// If a push acts on a point that `body` does not have.
    pub fn new(body: &Body, loads: &Loads, state: &State) -> Self {
        let (turn, momentum) = (state.orientation, state.momentum);
        let top = SymmetricTop::from_body(body);
        let damping = Damping::new(body, &loads.friction);
        let force = top.and_then(|top| Some((top, loads.on_axle(body, &top)?)));
        let solution = match force.filter(|_| damping.is_none()) {
            Some((around, force)) => ExactSolution::Closed(Box::new(LagrangeTop::new(
                around.across,
                around.along,
                force,
                turn,
                momentum,
            ))),
            None => {
                let moment = loads.moment(body);
                AccurateMotion::damped(body.inertia(), moment, turn, momentum, damping)
                    .map_or(ExactSolution::None, |motion| {
                        ExactSolution::Integrated(Box::new(motion))
                    })
            }
        };
        Self {
            begin: *state,
            solution,
        }
    }

    /// Returns the state at `time_s`, s. In closed form, every time costs the same; an integration continues from the last
    /// time. The state is NaN if the integration [has given up](Self::has_given_up).
    pub fn at(&mut self, time_s: f64) -> State {
        self.at_heard(time_s, &mut Nobody)
    }

    /// Like [`at`](Self::at), and passes each phase to `listener`.
    pub(crate) fn at_heard<L: Listener>(&mut self, time_s: f64, listener: &mut L) -> State {
        let t = time_s - self.begin.time_s;
        let (orientation, momentum) = match &mut self.solution {
            ExactSolution::Closed(top) => top.at_heard(t, listener),
            ExactSolution::Integrated(motion) => {
                let now = motion.state_at(t);
                listener.hear(|| phases::integrated(t, motion.time, &now));
                now
            }
            ExactSolution::None => (
                Matrix3::from_element(f64::NAN),
                Vector3::from_element(f64::NAN),
            ),
        };
        State {
            time_s,
            orientation,
            momentum,
        }
    }

    /// Returns only the orientation of [`at`](Self::at); in closed form, this takes half the time.
    #[inline]
    pub fn orientation_at(&mut self, time_s: f64) -> Matrix3<f64> {
        match &self.solution {
            ExactSolution::Closed(top) => top.orientation_at(time_s - self.begin.time_s),
            ExactSolution::Integrated(_) | ExactSolution::None => self.at(time_s).orientation,
        }
    }

    /// Returns the positions of the point `at` (body frame, m) at `times` (s), like [`LagrangeTop::positions_near`].
    pub fn positions_near(
        &self,
        at: &Vector3<f64>,
        times: &[f64; AT_ONCE],
    ) -> Option<[[f64; AT_ONCE]; 3]> {
        let since = times.map(|time_s| time_s - self.begin.time_s);
        self.closed_form()?.positions_near(at, &since)
    }

    /// Returns the time at which it begins, s.
    pub fn begin_s(&self) -> f64 {
        self.begin.time_s
    }

    /// Returns the state in which it begins.
    pub fn begin(&self) -> &State {
        &self.begin
    }

    /// Returns how it is computed.
    pub fn kind(&self) -> ExactMethod {
        match &self.solution {
            ExactSolution::Closed(_) => ExactMethod::Closed,
            ExactSolution::Integrated(motion) if motion.friction.is_some() => ExactMethod::Rubbing,
            ExactSolution::Integrated(_) | ExactSolution::None => ExactMethod::Integrated,
        }
    }

    /// True if the integration to a requested time would have taken too long. All later states are NaN.
    pub fn has_given_up(&self) -> bool {
        matches!(&self.solution, ExactSolution::Integrated(motion) if motion.gave_up)
    }

    /// Returns the work of friction from the beginning to the last requested time, J.
    pub fn friction_work(&self) -> f64 {
        match &self.solution {
            ExactSolution::Integrated(motion) => motion.friction_work(),
            ExactSolution::Closed(_) | ExactSolution::None => 0.0,
        }
    }

    /// Returns the closed form, if there is one.
    pub fn closed_form(&self) -> Option<&LagrangeTop> {
        match &self.solution {
            ExactSolution::Closed(top) => Some(top),
            ExactSolution::Integrated(_) | ExactSolution::None => None,
        }
    }
}

impl std::fmt::Display for ExactMethod {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Closed => "closed form",
            Self::Integrated => "integration held to 1e-12",
            Self::Rubbing => {
                "integration held to 1e-12, friction in it and stops of the spin found as events"
            }
        })
    }
}
