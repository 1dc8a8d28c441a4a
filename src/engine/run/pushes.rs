//! Computes the forces of the pushes on a step.
//!
//! A push in steps acts on whole steps, like the report's. A push in seconds may begin or end within a step. So may a
//! push in steps after an edit of the time step, because it keeps its times in seconds. A scheme that follows time
//! between steps then gets the force when it begins. Any other scheme gets the mean force over the step, so that the
//! impulse is right at every time step.

use super::Clock;
use crate::physics::PointForce;
use crate::scenario::{Push, Scenario, Window};

/// Fractions of a step below this are rounding errors.
const STEP_PART_ROUNDING: f64 = 1e-9;

/// Unit of the windows of pushes that are given in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counting {
    Steps,
    /// Seconds, because the time step has been edited. Each step counts as one time step of the scenario as written.
    Seconds {
        /// Time step of the scenario as written, s.
        written_for_s: f64,
    },
}

/// A time step of the run, or a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Number of the step. Step 1 leads from the start to t = dt.
    pub step: u64,
    /// Start, s.
    pub begin: f64,
    /// End, s.
    pub end: f64,
}

impl Stretch {
    pub fn step(step: u64, clock: &Clock) -> Self {
        Self {
            step,
            begin: clock.time_s(step - 1),
            end: clock.time_s(step),
        }
    }
}

/// Writes the forces during `stretch` into `forces`: the mean force of each push over it.
pub fn acting(
    pushes: &[Push],
    counting: Counting,
    stretch: &Stretch,
    forces: &mut Vec<PointForce>,
) {
    forces.clear();
    for push in pushes {
        let multiple = factor(push, counting, stretch);
        if multiple != 0.0 {
            forces.push(PointForce {
                point: push.point,
                force: push.force * multiple,
            });
        }
    }
}

/// Returns the mean force of a push during `stretch`, as a multiple of its given force.
fn factor(push: &Push, counting: Counting, stretch: &Stretch) -> f64 {
    match (push.window, counting) {
        (Window::Steps { first, count }, Counting::Steps) => {
            let nth = (stretch.step + 1).saturating_sub(first); // 1 on its first step, 0 before
            if push.accumulates {
                nth.min(count) as f64
            } else {
                f64::from(nth >= 1 && nth <= count)
            }
        }
        (Window::Steps { first, count }, Counting::Seconds { written_for_s })
            if push.accumulates =>
        {
            let [begin, end] = [stretch.begin, stretch.end]
                .map(|time_s| time_s / written_for_s - (first - 1) as f64);
            mean_growth(begin, end, count as f64)
        }
        (window, counting) => {
            let (from, to) = seconds(window, counting);
            share(from, to, stretch)
        }
    }
}

/// Returns the mean factor of an accumulating push between two times. The times are numbers of its own steps since it
/// began.
fn mean_growth(begin: f64, end: f64, count: f64) -> f64 {
    let nth = (end - STEP_PART_ROUNDING).ceil();
    let is_full = begin + STEP_PART_ROUNDING >= count;
    if is_full || nth <= (begin + STEP_PART_ROUNDING).floor() + 1.0 {
        return nth.clamp(0.0, count);
    }
    // Sum of the factors up to a time: the whole steps 1 + 2 + ..., and the fraction of the current one.
    let [sum_to_begin, sum_to_end] = [begin, end].map(|time: f64| {
        let growing = time.clamp(0.0, count);
        let whole = growing.floor();
        whole * (whole + 1.0) / 2.0
            + (growing - whole) * (whole + 1.0)
            + (time - count).max(0.0) * count
    });
    (sum_to_end - sum_to_begin) / (end - begin)
}

impl Counting {
    /// Counts steps as the seconds that they meant when `scenario` was written.
    pub fn in_seconds(scenario: &Scenario) -> Self {
        Self::Seconds {
            written_for_s: scenario.written_for_s,
        }
    }
}

/// Returns the times at which `push` of `scenario` begins and ends, s. An accumulating push ends at infinity.
pub fn acts_s(push: &Push, scenario: &Scenario) -> (f64, f64) {
    let (begin, end) = seconds(push.window, Counting::in_seconds(scenario));
    let grows = push.accumulates && matches!(push.window, Window::Steps { .. });
    (begin, if grows { f64::INFINITY } else { end })
}

/// Returns a window in seconds, from and to. Both are infinite if the window has no times in seconds.
fn seconds(window: Window, counting: Counting) -> (f64, f64) {
    match (window, counting) {
        (Window::Time { from_s, for_s }, _) => (from_s, from_s + for_s),
        (Window::Steps { first, count }, Counting::Seconds { written_for_s: dt }) => {
            ((first - 1) as f64 * dt, (first - 1 + count) as f64 * dt)
        }
        // Whole steps have no times in seconds, and never begin within a step.
        (Window::Steps { .. }, Counting::Steps) => (f64::INFINITY, f64::INFINITY),
    }
}

/// Returns the fraction of `stretch` between `from` and `to`, from 0 to 1, without rounding errors at either end.
fn share(from: f64, to: f64, stretch: &Stretch) -> f64 {
    let length = stretch.end - stretch.begin;
    if length <= 0.0 {
        // The time step is so small that it does not change t.
        return f64::from(from <= stretch.begin && stretch.begin < to);
    }
    match (to.min(stretch.end) - from.max(stretch.begin)) / length {
        share if share <= STEP_PART_ROUNDING => 0.0,
        share if share >= 1.0 - STEP_PART_ROUNDING => 1.0,
        share => share,
    }
}

/// Returns the first time strictly inside `stretch` at which a push in seconds begins, ends or (if it accumulates)
/// grows.
pub fn next_change(pushes: &[Push], counting: Counting, stretch: &Stretch) -> Option<f64> {
    let margin = STEP_PART_ROUNDING * (stretch.end - stretch.begin);
    let moment = next_after(pushes, counting, stretch.begin + margin);
    (moment < stretch.end - margin).then_some(moment)
}

/// Returns the first time after `time_s` (s) at which a push in seconds begins, ends or grows. Infinity if there is
/// none.
pub fn next_after(pushes: &[Push], counting: Counting, time_s: f64) -> f64 {
    let changes = pushes.iter().flat_map(|push| {
        let (begin, end) = seconds(push.window, counting);
        let growth = next_growth(push, counting, time_s).unwrap_or(f64::INFINITY);
        [begin, end, growth]
    });
    changes
        .filter(|&moment| moment > time_s)
        .fold(f64::INFINITY, f64::min)
}

fn next_growth(push: &Push, counting: Counting, time_s: f64) -> Option<f64> {
    match (push.window, counting) {
        (Window::Steps { first, count }, Counting::Seconds { written_for_s: dt })
            if push.accumulates =>
        {
            // The next boundary, safely beyond rounding, because `time_s` itself may be a boundary.
            let next = (time_s / dt + STEP_PART_ROUNDING).floor() + 1.0;
            let inside = next >= (first - 1) as f64 && next <= (first - 1 + count) as f64;
            inside.then_some(next * dt)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn steps(first: u64, count: u64, accumulates: bool) -> Push {
        push(Window::Steps { first, count }, accumulates)
    }

    fn seconds(from_s: f64, for_s: f64) -> Push {
        push(Window::Time { from_s, for_s }, false)
    }

    fn push(window: Window, accumulates: bool) -> Push {
        Push {
            point: 0,
            force: Vector3::new(0.0, 0.0, -100.0),
            window,
            accumulates,
        }
    }

    fn factors(push: Push, counting: Counting, dt: f64, steps: u64) -> Vec<f64> {
        let clock = Clock::new(dt);
        (1..=steps)
            .map(|step| factor(&push, counting, &Stretch::step(step, &clock)))
            .collect()
    }

    /// Returns the times after `begin` at which the force of `push` changes.
    fn changes(push: Push, counting: Counting, begin: f64, end: f64) -> Vec<f64> {
        let change = |&from: &f64| {
            let stretch = Stretch {
                step: 1,
                begin: from,
                end,
            };
            next_change(&[push], counting, &stretch)
        };
        std::iter::successors(change(&begin), change).collect()
    }

    #[test]
    fn the_impulse_is_right_at_every_time_step() {
        for dt in [0.001, 0.01, 0.03, 0.1, 0.7] {
            let factors = factors(seconds(0.02, 0.05), Counting::Steps, dt, 200);
            let impulse: f64 = factors.iter().map(|f| f * dt).sum();
            assert!((impulse - 0.05).abs() < 1e-12, "dt {dt}: {impulse}");
        }
    }

    #[test]
    fn the_next_change_lies_inside_the_step() {
        let grown = steps(2, 3, true);
        let seconds_of = Counting::Seconds { written_for_s: 0.1 };
        let times = [0.1, 0.2, 0.1 * 3.0, 0.4];
        assert_eq!(changes(grown, seconds_of, 0.0, 1.0), times);
        assert!(changes(grown, Counting::Steps, 0.4, 1.0).is_empty());
        for (begin, end, expected) in [
            (0.0, 0.1, &[0.02, 0.02 + 0.05][..]),
            (0.02, 0.1, &[0.02 + 0.05]),
            (0.07, 0.1, &[]),
            (0.0, 0.02, &[]),
        ] {
            let found = changes(seconds(0.02, 0.05), Counting::Steps, begin, end);
            assert_eq!(found, expected, "{begin} {end}");
        }
    }
}
