//! A class: a teacher's lab and the seats of the students, which know of each other through files in a folder.
//!
//! ```text
//! DIR/.gyrolab/teacher/state              what the teacher's lab shows, and the rounds of votes; twice a second at most
//! DIR/.gyrolab/seats/anna-4711/           a seat: its exports
//! DIR/.gyrolab/seats/anna-4711/.gyrolab/  seat (place and votes), open (who has it open, heartbeat), its session
//! DIR/.gyrolab/wrong/anna                 wrong codes typed for that name
//! ```
//!
//! Each file is written whole by one account and read by the other; nothing is sent. A run is deterministic: a student's
//! lab computes what the teacher's shows.
//!
//! - [`folder`]: the folders, and the teacher's [`State`]; [`seat`]: the files of a seat; [`login`]: taking a seat.
//! - [`votes`]: the votes of a question, counted; as CSV and as bars.
//! - [`teacher`] and [`student`]: what a class adds to a lab; `aside`: what makes a student step aside;
//!   [`board`]: the class on a second terminal.

mod aside;
pub mod board;
pub mod folder;
pub mod login;
pub mod seat;
pub mod student;
pub mod teacher;
pub mod votes;

pub use folder::{Folder, State};
pub use seat::Seat;
use student::Student;
use teacher::Teacher;

use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::command::Command;
use crate::lessons::Class as Lessons;
use std::ops::ControlFlow;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// How often the files are looked at.
pub const EVERY: Duration = Duration::from_millis(400);

/// What a class adds to a lab.
#[derive(Debug, Default)]
pub enum Class {
    #[default]
    None,
    Teacher(Box<Teacher>),
    Student(Box<Student>),
}

impl Class {
    /// Brings lab and files up to date; `now` is the time since the lab was opened. Breaks where the lab is to end.
    pub fn advance(
        &mut self,
        now: Duration,
        lab: &mut Lab,
        lessons: &mut Lessons,
    ) -> ControlFlow<()> {
        match self {
            Self::None => {}
            Self::Teacher(teacher) => teacher.advance(now, lab, lessons),
            Self::Student(student) => return student.advance(now, lab, lessons),
        }
        ControlFlow::Continue(())
    }

    /// Takes note that `action` is about to be carried out. Returns whether it was the class's, and is done.
    pub fn takes(&mut self, action: Action, lab: &mut Lab, lessons: &mut Lessons) -> bool {
        match self {
            Self::None => false,
            Self::Teacher(teacher) => teacher.takes(action, lab),
            Self::Student(student) => student.takes(action, lab, lessons),
        }
    }

    /// Takes note that `commands`, which a key means, are about to be carried out.
    pub fn expect(&mut self, commands: &[Command], lab: &mut Lab, lessons: &mut Lessons) {
        match self {
            Self::None => {}
            Self::Teacher(teacher) => teacher.expect(),
            Self::Student(student) => student.expect(commands, lab, lessons),
        }
    }

    /// Does what `key` stands for where the list of seats is shown. Returns whether it was.
    pub fn takes_key(&mut self, key: LessonKey, lab: &mut Lab) -> bool {
        match self {
            Self::Teacher(teacher) => teacher.takes_key(key, lab),
            _ => false,
        }
    }

    /// How long the loop may wait until the files are looked at again; `None` without a class.
    pub fn wait(&self, now: Duration) -> Option<Duration> {
        let next = match self {
            Self::None => return None,
            Self::Teacher(teacher) => teacher.next_look,
            Self::Student(student) => student.next_look,
        };
        Some(next.saturating_sub(now).max(Duration::from_millis(10)))
    }

    /// Why the files cannot be written, if they cannot.
    pub fn trouble(&self) -> Option<String> {
        match self {
            Self::None => None,
            Self::Teacher(teacher) => teacher.trouble.clone(),
            Self::Student(student) => student.trouble.clone(),
        }
    }
}

/// Milliseconds since 1970 (UTC).
fn unix_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_millis() as u64
}

/// How long ago `time` was; nothing for one to come.
fn ago(time: SystemTime) -> Duration {
    SystemTime::now().duration_since(time).unwrap_or_default()
}
