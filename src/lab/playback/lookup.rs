//! Computes the numbers of any step that a run has reached from its stored states, without moving the run.

use super::live::{LiveRun, integration_cost};
use crate::engine::run::{Moment, Sample, Simulation};

/// Maximum number of time steps computed for one lookup, for a body of one point. A body of n points has 1/n of that.
/// Integrated steps count as several points.
const MOST_LOOKUP_STEPS: u64 = 4_000_000;

/// Cost of one point in one of these steps, in the units of [`integration_cost`].
const COST_OF_A_POINT: u64 = 30;

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Missing {
    #[error("the run has not reached that step")]
    NotReached,
    #[error("its steps take too long to compute: go there to see them")]
    TooFar,
    #[error("the tilt has no turning point on that side")]
    NoTurn,
}

/// The numbers at one step of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepNumbers {
    /// The numbers in the CSV row of that step.
    pub sample: Sample,
    pub moment: Moment,
}

/// Returns the numbers at `step` of `run`.
///
/// # Errors
/// Returns an error if the run has not reached the step or computing it again would take too long.
pub fn numbers(run: &LiveRun, step: u64) -> Result<StepNumbers, Missing> {
    if step > run.furthest() {
        return Err(Missing::NotReached);
    }
    let mut steps = LookupSteps::before(run, step);
    while steps.step_number() < step {
        steps.step()?;
    }
    Ok(StepNumbers {
        sample: steps.simulation.sample(),
        moment: Moment::of_run(steps.simulation.now()),
    })
}

/// Returns the exact motion at `time_s` (s), the time of `step`, which `run` has reached; `None` if it is unknown or
/// computing it again would take too long.
pub fn exact(run: &LiveRun, step: u64, time_s: f64) -> Option<Moment> {
    let before = run.again_before(step);
    let cost = integration_cost(&before, 1).saturating_mul(step - before.step_number());
    (cost / COST_OF_A_POINT <= MOST_LOOKUP_STEPS)
        .then(|| run.exact_moment_at(step, time_s))
        .flatten()
}

/// Returns the nearest step after (`forward`) or before `from` at which the tilt of `run` has a turning point.
///
/// # Errors
/// Returns an error if there is none or computing it would take too long.
pub fn turn(run: &LiveRun, from: u64, forward: bool) -> Result<u64, Missing> {
    if forward {
        let mut steps = LookupSteps::before(run, from.saturating_sub(1));
        while steps.step_number() < run.furthest() {
            if let Some(turn) = steps.step()?.filter(|turn| *turn > from) {
                return Ok(turn);
            }
        }
        return Err(Missing::NoTurn);
    }
    // Start from earlier and earlier stored states, until the tilt turns after one of them.
    let (mut begin, mut left) = (from, None);
    while begin > 0 {
        let mut steps = LookupSteps::before(run, begin - 1);
        steps.left = left.unwrap_or(steps.left);
        let end = from.min(begin + 1); // a turning point is detected one step later
        begin = steps.step_number();
        let mut last = None;
        while steps.step_number() < end {
            last = steps.step()?.or(last);
        }
        if let Some(turn) = last {
            return Ok(turn);
        }
        left = Some(steps.left);
    }
    Err(Missing::NoTurn)
}

/// Returns the turning points of the tilt of `run` from step `from` to step `to`: the time (s) and the tilt (degrees)
/// of each.
///
/// # Errors
/// Returns an error if computing them would take too long.
pub fn turns(run: &LiveRun, from: u64, to: u64) -> Result<Vec<(f64, f64)>, Missing> {
    let mut steps = LookupSteps::before(run, from.saturating_sub(1));
    let mut turns = Vec::new();
    while steps.step_number() <= to && steps.step_number() < run.furthest() {
        let now = steps.simulation.now();
        let (time_s, tilt_deg) = (now.time_s(), now.tilt_deg());
        if steps.step()?.is_some_and(|turn| turn >= from) {
            turns.push((time_s, tilt_deg));
        }
    }
    Ok(turns)
}

struct LookupSteps {
    simulation: Simulation,
    /// Remaining cost, in points of the body.
    left: u64,
    points: u64,
    /// The latest nonzero change of the axle's height in a step.
    change: f64,
}

impl LookupSteps {
    fn before(run: &LiveRun, step: u64) -> Self {
        Self {
            simulation: run.again_before(step),
            left: MOST_LOOKUP_STEPS,
            points: run.scenario().body.mechanics.points().len() as u64,
            change: 0.0,
        }
    }

    fn step_number(&self) -> u64 {
        self.simulation.step_number()
    }

    /// Takes a step. Returns the number of the previous step if the tilt has a turning point there.
    fn step(&mut self) -> Result<Option<u64>, Missing> {
        let cost = self.points + integration_cost(&self.simulation, 0) / COST_OF_A_POINT;
        self.left = self.left.checked_sub(cost).ok_or(Missing::TooFar)?;
        let (before, height) = (self.step_number(), self.simulation.state().axle().z);
        self.simulation.step().map_err(|_| Missing::NotReached)?;
        let change = self.simulation.state().axle().z - height;
        let turned = change * self.change < 0.0;
        if change != 0.0 {
            self.change = change;
        }
        Ok(turned.then_some(before))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_an_earlier_step_are_reproduced() {
        let samples: Vec<_> = (0..=700)
            .map(|steps| LiveRun::played("cusps", steps).simulation().sample())
            .collect();
        let run = LiveRun::played("cusps", 700);
        for step in [0, 1, 255, 256, 257, 699, 700] {
            assert_eq!(numbers(&run, step).unwrap().sample, samples[step as usize]);
        }
        assert_eq!(numbers(&run, 701), Err(Missing::NotReached));
    }

    #[test]
    fn turning_points_of_the_tilt_are_found_in_both_directions() {
        // The axle is highest at the cusps, every 0.8225 s, and lowest between them.
        let run = LiveRun::played("cusps", 3000);
        let turns: Vec<_> = std::iter::successors(Some(0), |&at| turn(&run, at, true).ok())
            .skip(1)
            .collect();
        assert_eq!(turns.len(), 7, "{turns:?}");
        for (index, &turn) in turns.iter().enumerate() {
            let expected = 411.25 * (index + 1) as f64;
            assert!((turn as f64 - expected).abs() < 2.0, "{turns:?}");
        }
        for pair in turns.windows(2) {
            assert_eq!(turn(&run, pair[1], false), Ok(pair[0]));
            assert_eq!(turn(&run, pair[1] - 1, false), Ok(pair[0]));
        }
        assert_eq!(turn(&run, turns[0], false), Err(Missing::NoTurn));
        assert_eq!(turn(&run, turns[6], true), Err(Missing::NoTurn));
    }

    #[test]
    fn the_search_for_a_turning_point_is_limited() {
        let run = LiveRun::played("torque-free", 400_000);
        assert_eq!(turn(&run, 1000, false), Err(Missing::NoTurn));
        assert_eq!(turn(&run, 400_000, false), Err(Missing::TooFar));
    }
}
