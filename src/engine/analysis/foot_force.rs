//! The mean force of the floor on the foot over whole nutations, read off the rows.
//!
//! The floor pushes with what the weight and the pushes do not accelerate. Its mean from one time to another is therefore
//! M g, less the pushes, and the change of the body's vertical momentum over the time. Up to any last step that depends on
//! where the run ends. So both times are turning points of the center of mass: its highest points, or its lowest. The top
//! of a parabola through the heights of three rows has the time, and the force at the middle row the momentum there.
//!
//! At a turning point the vertical momentum is 0. What is read there instead is the error of the reading, and makes the
//! uncertainty.

use super::turns::MeasuredNumber;
use crate::physics::State;
use crate::physics::observables::{pivot_force_z, vertical_momentum, weight_height};
use crate::run::Step;

/// A center of mass that swings by less than this part of its distance from the pivot does not swing.
const LEAST_SWING: f64 = 1e-9;
/// A start whose vertical momentum is less than this part of its change in a time step is a turning point.
const AT_TURN: f64 = 1e-6;

/// Follows the center of mass; to be shown every step since the forces last changed.
#[derive(Clone, Debug)]
pub(super) struct FootForce {
    /// Distance of the center of mass from the pivot, times the mass, kg m.
    moment: f64,
    /// The mean of the force without any change of momentum, N: the weight, less the pushes upwards.
    at_rest: f64,
    /// M z of the center of mass at the last two rows, and at the last turning point, kg m.
    heights: [f64; 2],
    turned_at: f64,
    /// The state at which the run starts to be followed.
    start: Option<State>,
    /// First and last of the lowest points, and of the highest.
    turns: [Option<Span>; 2],
}

/// From the first turning point of one kind to the last.
#[derive(Clone, Copy, Debug)]
struct Span {
    first: TurningPoint,
    last: TurningPoint,
    nutations: u64,
}

/// A turning point of the center of mass, as the rows show it.
#[derive(Clone, Copy, Debug)]
struct TurningPoint {
    time_s: f64,
    /// Vertical momentum, kg m/s.
    vertical_momentum: f64,
}

impl FootForce {
    pub fn new(step: &Step) -> Self {
        let body = &step.scenario().body.mechanics;
        let height = weight_height(body, step.after());
        Self {
            moment: body.first_moment().norm(),
            at_rest: mean_at_rest(step),
            heights: [height; 2],
            turned_at: height,
            start: Some(*step.after()),
            turns: [None; 2],
        }
    }

    #[inline]
    pub fn record(&mut self, step: &Step) {
        let height = weight_height(&step.scenario().body.mechanics, step.after());
        let [before, at] = self.heights;
        if let Some(start) = self.start.take() {
            self.begin(step, &start);
        } else if (at > before && at >= height) || (at < before && at <= height) {
            self.turn(step, height);
        }
        self.heights = [at, height];
    }

    /// Counts the start, if it is a turning point; `step` is the first one after it.
    #[cold]
    fn begin(&mut self, step: &Step, start: &State) {
        let body = &step.scenario().body.mechanics;
        let momentum = vertical_momentum(body, start);
        let push = pivot_force_z(body, start, step.loads()) - self.at_rest;
        if momentum.abs() <= AT_TURN * (push * (step.time_s() - start.time_s)).abs() {
            let time_s = start.time_s;
            self.count(
                push < 0.0,
                TurningPoint {
                    time_s,
                    vertical_momentum: momentum,
                },
            );
        }
    }

    /// Counts the row before `step`, after which the center of mass is at `height`, as a turning point.
    fn turn(&mut self, step: &Step, height: f64) {
        let [before, at] = self.heights;
        let is_rounding = (at - self.turned_at).abs() <= LEAST_SWING * self.moment;
        let Some(row) = step.before().filter(|_| !is_rounding) else {
            return;
        };
        self.turned_at = at;
        let body = &step.scenario().body.mechanics;
        let bend = before - 2.0 * at + height;
        let shift_s = (before - height) / (2.0 * bend) * (step.time_s() - row.time_s);
        let push = pivot_force_z(body, row, step.loads()) - self.at_rest;
        let turn = TurningPoint {
            time_s: row.time_s + shift_s,
            vertical_momentum: vertical_momentum(body, row) + push * shift_s,
        };
        self.count(at > before, turn);
    }

    fn count(&mut self, is_top: bool, turn: TurningPoint) {
        let span = &mut self.turns[usize::from(is_top)];
        *span = Some(match *span {
            None => Span {
                first: turn,
                last: turn,
                nutations: 0,
            },
            Some(span) => Span {
                last: turn,
                nutations: span.nutations + 1,
                ..span
            },
        });
    }

    /// The mean over whole nutations, N; `None` before one was seen.
    pub fn mean(&self) -> Option<MeasuredNumber> {
        let [bottoms, tops] = self.turns;
        let span = [tops, bottoms]
            .into_iter()
            .flatten()
            .max_by_key(|span| span.nutations)?;
        let time_s = span.last.time_s - span.first.time_s;
        let rounding = f64::EPSILON * self.at_rest.abs();
        (span.nutations > 0).then(|| MeasuredNumber {
            value: self.at_rest
                + (span.last.vertical_momentum - span.first.vertical_momentum) / time_s,
            uncertainty: libm::hypot(span.first.vertical_momentum, span.last.vertical_momentum)
                / time_s
                + rounding,
            nutations: span.nutations,
        })
    }
}

/// The force of the floor on the foot of a body whose center of mass does not speed up, N: the weight, and what pushes
/// press down.
pub(super) fn mean_at_rest(step: &Step) -> f64 {
    let loads = step.loads();
    let pushes: f64 = loads.pushes.iter().map(|push| push.force.z).sum();
    step.scenario().body.mechanics.mass() * loads.gravity - pushes
}
