//! Mean force of the floor on the foot over whole nutations, measured from the rows.
//!
//! The floor's force is the weight, minus the pushes, plus the rate of change of the body's vertical momentum. Its mean
//! between two times is therefore M g, minus the pushes, plus the change of that momentum over the time. If the mean
//! ended at an arbitrary step, it would depend on where the run ends. So both times are turning points of the center of
//! mass: highest points or lowest points. The vertex of a parabola through the heights of three rows gives the time.
//! The force at the middle row gives the momentum there.
//!
//! At a turning point the vertical momentum is 0. The value measured there is therefore the error of the measurement,
//! and gives the uncertainty.

use super::turns::MeasuredNumber;
use crate::physics::State;
use crate::physics::observables::{pivot_force_z, vertical_momentum, weight_height};
use crate::run::Step;

/// Minimum swing of the center of mass, as a fraction of its distance from the pivot.
const LEAST_SWING: f64 = 1e-9;
/// A start is a turning point if its vertical momentum is less than this fraction of its change in a time step.
const AT_TURN: f64 = 1e-6;

/// Follows the center of mass. It must receive every step since the forces last changed.
#[derive(Clone, Debug)]
pub(super) struct FootForce {
    /// Distance of the center of mass from the pivot, times the mass, kg m.
    moment: f64,
    /// Mean force without any change of momentum, N: the weight minus the upward pushes.
    at_rest: f64,
    /// M z of the center of mass at the last two rows, kg m.
    heights: [f64; 2],
    /// M z of the center of mass at the last turning point, kg m.
    turned_at: f64,
    /// State at the start of the measurement, until the first step.
    start: Option<State>,
    /// Span of the lowest points, and span of the highest points.
    turns: [Option<Span>; 2],
}

/// The first and the last turning point of one kind.
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

    /// Counts the start if it is a turning point. `step` is the first step after it.
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

    /// Counts the row before `step` as a turning point. After `step`, the center of mass is at `height` (M z, kg m).
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

    /// Returns the mean over whole nutations, N. `None` until a whole nutation has been seen.
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

/// Returns the force of the floor on the foot while the center of mass does not accelerate, N: the weight minus the
/// upward pushes.
pub(super) fn mean_at_rest(step: &Step) -> f64 {
    let loads = step.loads();
    let pushes: f64 = loads.pushes.iter().map(|push| push.force.z).sum();
    step.scenario().body.mechanics.mass() * loads.gravity - pushes
}
