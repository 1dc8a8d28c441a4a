//! A class: a teacher's lab and the seats of the students, which know of each other through files in a folder.
//!
//! It uses the [`lessons`](crate::lessons) and the [`lab`](crate::lab). What one lab of a class tells another belongs here.
//!
//! ```text
//! DIR/.gyrolab/teacher/state                what the teacher's lab shows, and the rounds of votes
//! DIR/.gyrolab/seats/anna-471108/           a seat: its exports
//! DIR/.gyrolab/seats/anna-471108/.gyrolab/  seat (place and votes), open (who has it open, heartbeat), its session
//! DIR/.gyrolab/wrong/anna-471108            wrong codes that count for that seat, and when the last was typed
//! DIR/.gyrolab/earlier/DATE/.gyrolab/       the same of an earlier group: DIR/.gyrolab/earlier/DATE is the folder of its class
//! ```
//!
//! Each file is written whole by one account and read by the other, three times a second. A run is deterministic: a student's
//! lab computes what the teacher's shows.
//!
//! - [`folder`]: the folders, and the teacher's [`ClassState`]; [`seat`]: the files of a seat; [`login`]: taking a seat.
//! - [`votes`]: the votes of a question, counted; as CSV and as bars. [`table`]: the table for a gradebook.
//! - [`teacher`], [`student`] and [`projector`]: the [`ClassRole`] of a lab in a class; `following`: what the last two share;
//!   [`board`]: the class on a second terminal; [`rehearsal`]: players for a teacher who practices.

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

/// How often the files are looked at.
const CLASS_POLL_INTERVAL: Duration = Duration::from_millis(300);
const LEAST_WAIT: Duration = Duration::from_millis(10);

/// What a class adds to a lab.
pub trait ClassRole {
    /// Returns the state of the lessons with which the lab begins; its session has `kept` this one.
    fn lessons(&self, kept: Table) -> Table {
        kept
    }

    /// Brings lab and files up to date; `now` is the time since the lab was opened. Breaks where the lab is to end.
    fn advance(
        &mut self,
        _now: Duration,
        _lab: &mut Lab,
        _lessons: &mut Lessons,
    ) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Does what the key of the class stands for.
    fn on_class_key(&mut self, lab: &mut Lab, lessons: &mut Lessons);

    /// Does what `key` means to the class. Returns whether that is all of it.
    fn intercept(&mut self, _key: LessonKey, _lab: &mut Lab, _lessons: &Lessons) -> bool {
        false
    }

    /// Takes note of what keys have done.
    fn after_keys(&mut self, _lab: &mut Lab, _lessons: &Lessons) {}

    /// Returns how long the loop may wait until the files are looked at again.
    fn wait(&self, _now: Duration) -> Duration {
        Duration::MAX
    }

    /// Returns why the files cannot be written, if they cannot.
    fn trouble(&self) -> Option<String> {
        None
    }

    /// Takes note that the lab was left. Returns what is said of that, and of how to come back.
    fn leave(&mut self) -> Result<String, String> {
        Ok(String::new())
    }
}

/// The role of a lab without a class.
#[derive(Debug)]
pub struct NoClass;

impl ClassRole for NoClass {
    fn on_class_key(&mut self, lab: &mut Lab, _lessons: &mut Lessons) {
        lab.refuse("this is no lab of a class: gyrolab man class says how one begins");
    }
}

/// Milliseconds since 1970 (UTC).
fn unix_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_millis() as u64
}

/// Returns how long ago `time` was. One that is to come, as the clock was set back, counts as long ago as it is ahead.
fn ago(time: SystemTime) -> Duration {
    let since = SystemTime::now().duration_since(time);
    since.unwrap_or_else(|ahead| ahead.duration())
}
