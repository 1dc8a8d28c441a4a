//! Playback speed: simulated time per wall-clock time, independent of the time step.

use crate::engine::scenario::{Scenario, keys};
use crate::engine::text::nice_numbers::climbed;
use serde::{Deserialize, Serialize};
use std::time::Duration;
use toml::Value;

/// Maximum time that one frame counts. After a suspension, or on a slow line, the rest of the time is skipped.
const LONGEST_FRAME: Duration = Duration::from_millis(250);

/// Ends of the 1-2-5 series of playback speeds, simulated seconds per second.
const SLOWEST: f64 = 1e-4;
const FASTEST: f64 = 5e5;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Speed {
    Top,
    #[serde(untagged)]
    Times(f64),
}

impl Speed {
    pub fn shifted(self, notches: i32) -> Self {
        let next = match self {
            Self::Top if notches >= 0 => return Self::Top,
            Self::Top => climbed(FASTEST, notches + 1).max(SLOWEST),
            Self::Times(now) => climbed(now, notches).max(SLOWEST.min(now)),
        };
        match next {
            next if next <= FASTEST => Self::Times(next),
            _ if notches > 0 => Self::Top,
            _ => Self::Times(FASTEST),
        }
    }
}

/// The playback state: running or paused, the speed, and the simulated time that is due.
#[derive(Clone, Debug, PartialEq)]
pub struct Pace {
    pub speed: Speed,
    pub is_running: bool,
    /// Simulated time that is due but not stepped yet, s.
    owed_s: f64,
    pub achieved: f64,
}

impl Pace {
    /// Creates the pace of the run of `scenario`, with the speed in its `[view]`.
    pub fn of_scenario(scenario: &Scenario, running: bool) -> Self {
        let speed = scenario.file.viewed("speed").and_then(Value::as_float);
        Self::new(speed.unwrap_or(keys::DEFAULT_SPEED), running)
    }

    pub fn new(speed: f64, running: bool) -> Self {
        Self {
            speed: Speed::Times(speed),
            is_running: running,
            owed_s: 0.0,
            achieved: speed,
        }
    }

    /// Sets the speed. Ignores a speed that is not positive and finite.
    pub fn set_speed(&mut self, speed: Speed) {
        match speed {
            Speed::Times(times) if !(times > 0.0 && times.is_finite()) => return,
            speed => self.speed = speed,
        }
        self.set_running(self.is_running);
    }

    /// Returns true if the machine is too slow for the chosen speed: it reaches less than 80 % of it.
    pub fn falls_behind(&self) -> bool {
        matches!(self.speed, Speed::Times(speed) if self.is_running && self.achieved < 0.8 * speed)
    }

    pub fn set_running(&mut self, running: bool) {
        self.is_running = running;
        self.owed_s = 0.0;
        if let Speed::Times(speed) = self.speed {
            self.achieved = speed;
        }
    }

    /// Adds the simulated time for `wall`. Returns all simulated time that is now due, s.
    pub fn earn(&mut self, wall: Duration) -> f64 {
        let wall_s = wall.min(LONGEST_FRAME).as_secs_f64();
        self.owed_s = match (self.is_running, self.speed) {
            (false, _) => 0.0,
            (true, Speed::Times(speed)) => self.owed_s + speed * wall_s,
            (true, Speed::Top) => f64::INFINITY,
        };
        self.owed_s
    }

    /// Subtracts `stepped_s` simulated seconds, which were stepped within `wall`.
    ///
    /// If `cut_short` is true, the computing time was used up. The rest that is due is then dropped, because the
    /// machine would never catch up.
    pub fn spend(&mut self, stepped_s: f64, wall: Duration, cut_short: bool) {
        self.owed_s = if cut_short {
            0.0
        } else {
            (self.owed_s - stepped_s).max(0.0)
        };
        match self.speed {
            Speed::Times(speed) if !cut_short => self.achieved = speed,
            _ if wall > Duration::ZERO => {
                let now = stepped_s / wall.as_secs_f64();
                self.achieved += 0.2 * (now - self.achieved);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONGEST_PACE_FRAME: Duration = Duration::from_millis(100);

    /// Returns the time stepped in `frames` frames at `speed`, in steps of `step_s`, by a machine that keeps up.
    fn stepped_s(speed: f64, frames: u32, step_s: f64) -> f64 {
        let mut pace = Pace::new(speed, true);
        (0..frames)
            .map(|_| {
                let stepped_s = (pace.earn(LONGEST_PACE_FRAME) / step_s).floor() * step_s;
                pace.spend(stepped_s, LONGEST_PACE_FRAME, false);
                stepped_s
            })
            .sum()
    }

    #[test]
    fn simulated_time_follows_wall_time_at_every_step_length() {
        let fast_s = stepped_s(20.0, 10, 0.3);
        assert!((fast_s - 20.0).abs() < 0.3, "{fast_s}");
        let steps = (stepped_s(0.1, 100, 0.1) / 0.1).round();
        assert!((9.0..=10.0).contains(&steps), "{steps}");
    }

    #[test]
    fn time_that_a_slow_machine_misses_is_dropped() {
        let mut pace = Pace::new(1000.0, true);
        for _ in 0..31 {
            pace.earn(LONGEST_PACE_FRAME);
            pace.spend(1.0, LONGEST_PACE_FRAME, true);
            assert_eq!(pace.owed_s, 0.0);
        }
        assert!(pace.falls_behind());
    }
}
