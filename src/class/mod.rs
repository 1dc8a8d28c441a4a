//! A class: a teacher's lab and the students' seats, which communicate through files in a folder.
//!
//! It uses the [`lessons`](crate::lessons) and the [`lab`](crate::lab). All communication between labs of a class
//! belongs here.
//!
//! ```text
//! DIR/.gyrolab/teacher/state                state of the teacher's lab, with the rounds of votes
//! DIR/.gyrolab/seats/anna-471108/           a seat: its exports
//! DIR/.gyrolab/seats/anna-471108/.gyrolab/  seat (progress and votes), open (token, heartbeat), session
//! DIR/.gyrolab/wrong/anna-471108            count of wrong codes for that seat, and time of the last one
//! DIR/.gyrolab/earlier/DATE/.gyrolab/       the same for an earlier group; DIR/.gyrolab/earlier/DATE is its class folder
//! ```
//!
//! Each file is written whole by one account and read by the other, three times per second. A run is deterministic, so
//! a student's lab computes the same run as the teacher's.
//!
//! - [`folder`]: the folders, and the teacher's [`ClassState`]. [`seat`]: the files of a seat. [`login`]: taking a
//!   seat.
//! - [`votes`]: counts the votes on a question, as CSV and as bars. [`table`]: the table for a gradebook.
//! - [`teacher`], [`student`] and [`projector`]: the [`ClassRole`] of each lab. `following`: the common part of the
//!   last two.
//! - [`board`]: the class on a second terminal. [`rehearsal`]: simulated students for a teacher who practices.

pub mod board;
pub mod folder;
mod following;
pub mod login;
pub mod projector;
pub mod rehearsal;
pub mod seat;
pub mod student;
pub mod table;
pub mod teacher;
pub mod votes;

pub use folder::{ClassFolder, ClassState};
pub use seat::Seat;

use crate::lab::Lab;
use crate::lab::action::LessonKey;
use crate::lessons::Lessons;
use std::ops::ControlFlow;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use toml::Table;

/// Time between two reads of the files.
const CLASS_POLL_INTERVAL: Duration = Duration::from_millis(300);
/// Minimum wait of the loop.
const LEAST_WAIT: Duration = Duration::from_millis(10);

/// The role of a lab in a class.
pub trait ClassRole {
    /// Returns the state of the lessons when the lab opens. `kept` is the state in the lab's session.
    fn lessons(&self, kept: Table) -> Table {
        kept
    }

    /// Updates lab and files. `now` is the time since the lab was opened. Breaks if the lab must end.
    fn advance(
        &mut self,
        _now: Duration,
        _lab: &mut Lab,
        _lessons: &mut Lessons,
    ) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Handles the class key, `k`.
    fn on_class_key(&mut self, lab: &mut Lab, lessons: &mut Lessons);

    /// Handles `key` if it belongs to the class. Returns true if the lesson must not handle it.
    fn intercept(&mut self, _key: LessonKey, _lab: &mut Lab, _lessons: &Lessons) -> bool {
        false
    }

    /// Records the effects of keys.
    fn after_keys(&mut self, _lab: &mut Lab, _lessons: &Lessons) {}

    /// Returns how long the loop may wait before the next [`advance`](Self::advance).
    fn wait(&self, _now: Duration) -> Duration {
        Duration::MAX
    }

    /// Returns the reason if the files cannot be written.
    fn trouble(&self) -> Option<String> {
        None
    }

    /// Records that the lab was left. Returns a message on that, and on how to return.
    ///
    /// # Errors
    ///
    /// Returns the reason if the last state cannot be saved.
    fn leave(&mut self) -> Result<String, String> {
        Ok(String::new())
    }
}

/// The role of a lab without a class.
#[derive(Debug)]
pub struct NoClass;

impl ClassRole for NoClass {
    fn on_class_key(&mut self, lab: &mut Lab, _lessons: &mut Lessons) {
        lab.refuse("this lab is not in a class; see gyrolab man class");
    }
}

/// Returns the milliseconds since 1970 (UTC).
fn unix_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_millis() as u64
}

/// Returns the time since `time`. A time in the future, after the clock was set back, counts as equally far in the
/// past.
fn ago(time: SystemTime) -> Duration {
    let since = SystemTime::now().duration_since(time);
    since.unwrap_or_else(|ahead| ahead.duration())
}
