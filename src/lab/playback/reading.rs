//! The numbers on the screen.
//!
//! They are updated four times a second: nobody can read digits that change in every frame, and sending them would load
//! a slow line. For a very fast run they are updated in every frame, so that they match the picture.

use super::live::LiveRun;
use super::pace::{Pace, Speed};
use crate::engine::analysis::{MeasuredNumber, Readouts};
use crate::engine::journal::restart::in_force;
use crate::engine::run::Moment;
use crate::engine::scenario::Motion;
use crate::engine::text::number::{exponent, fixed, rounded, shortest};
use crate::physics::State;
use std::time::Duration;

pub const READING_INTERVAL: Duration = Duration::from_millis(250);

#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    pub readouts: Readouts,
    /// Gravity, scheme and time step of the next step.
    pub motion: Motion,
    /// The present state. If the scheme has broken down, the last state whose orientation is a rotation.
    pub state: State,
    /// The step of that state if the scheme has broken down since; otherwise `None`.
    pub last_whole: Option<u64>,
    pub moment: Moment,
    /// The exact motion at the same time, even if its curves are hidden; `None` if it is unknown.
    pub exact: Option<Moment>,
    pub pace: String,
}

impl Reading {
    pub fn new(run: &mut LiveRun, pace: &Pace) -> Self {
        let last_whole = run.last_whole();
        Self {
            state: last_whole.map_or(*run.simulation().state(), |(_, state)| *state),
            last_whole: last_whole.map(|(step, _)| *step),
            moment: Moment::of_run(run.simulation().now()),
            motion: in_force(run.scenario(), run.simulation().step_number()).0,
            readouts: run.readouts(),
            exact: run.exact_moment(),
            pace: pace_in_words(pace),
        }
    }

    /// Returns the measured precession, degrees per second; `None` until its uncertainty is small enough.
    pub fn precession_deg_per_s(&self) -> Option<f64> {
        self.readouts
            .precession
            .filter(MeasuredNumber::is_settled)
            .map(|measured| measured.value.to_degrees())
    }
}

fn pace_in_words(pace: &Pace) -> String {
    match (pace.is_running, pace.speed) {
        (false, Speed::Times(speed)) => format!("paused ×{}", short(speed)),
        (false, Speed::Top) => "paused, top".to_owned(),
        (true, Speed::Top) => format!("► top ×{}", achieved(pace)),
        (true, Speed::Times(_)) if pace.falls_behind() => {
            format!("► ×{} max", achieved(pace))
        }
        (true, Speed::Times(speed)) => format!("► ×{}", short(speed)),
    }
}

/// Returns the achieved speed to two digits. More digits would change all the time.
fn achieved(pace: &Pace) -> String {
    let speed = rounded(pace.achieved, 2);
    short(if speed.is_finite() { speed } else { 0.0 })
}

/// Formats the speed in few characters: 20, 0.002, 5e5.
fn short(speed: f64) -> String {
    match speed {
        n if n >= 1e5 => exponent(n, 0),
        n if n >= 10.0 => fixed(n, 0),
        n if n >= 1e-3 => shortest((n * 1e6).round() / 1e6),
        n => exponent(n, 0),
    }
}
