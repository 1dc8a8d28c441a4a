//! The folder of a class, and the state that the teacher's lab publishes in it.

use super::{ago, unix_ms};
use crate::engine::text::printable::PrintablePath;
use crate::lab::Snapshot;
use crate::lab::storage::confined::SESSIONS;
use crate::lab::storage::shared;
use crate::lessons::KeptNumbers;
use crate::lessons::open_lesson::ClassPage;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The longest run file that a class can follow, bytes; and the longest state with it.
pub const LONGEST_RUN: usize = 64 * 1024;
const LONGEST_STATE: usize = 2 * LONGEST_RUN;
/// The teacher's lab is gone when its state was not touched for longer than this.
const GONE: Duration = Duration::from_secs(4);
/// The modes of folders in which both accounts write, and of the teacher's.
pub(super) const OF_ALL: u32 = 0o2770;
const OF_TEACHER: u32 = 0o2750;

pub const CLASS_VERSION: &str = env!("CARGO_PKG_VERSION");

#[derive(Clone, Debug, Default)]
pub struct ClassFolder {
    /// The folder that the command line names, as a full path.
    pub root: PathBuf,
}

/// What the teacher's lab publishes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ClassState {
    /// The version that wrote it.
    pub gyrolab: String,
    pub is_on: bool,
    /// The full name of the lesson.
    pub lesson: String,
    /// The number of its open page, from 1.
    pub page: usize,
    /// How many seats are here, and how many of them have answered the question of the page.
    pub here: usize,
    pub answered: usize,
    /// Whether the run has arrived where the page wants it.
    pub has_arrived: bool,
    /// The seats that the teacher has closed.
    pub closed: BTreeSet<String>,
    /// When the teacher last gathered the class, ms since 1970: seats that left it before follow it again.
    pub gathered_ms: u64,
    /// By LESSON and then by the question's name.
    pub questions: BTreeMap<String, BTreeMap<String, QuestionState>>,
    /// The numbers that the lesson has kept.
    pub kept: KeptNumbers,
    /// Whether the students' labs follow; otherwise the students go on alone.
    pub is_followed: bool,
    /// The run that is shown; `None` where its file is too long.
    pub shown: Option<PresentedRun>,
}

/// How the class stands with a question.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct QuestionState {
    /// The present round, less 1.
    pub earlier_rounds: u32,
    pub stage: VoteStage,
    /// Whether the teacher has closed the round. Votes that come now are late.
    pub is_closed: bool,
    /// When a countdown closes the round, ms since 1970.
    pub closes_at_ms: Option<u64>,
    /// When the round began, ms since 1970.
    pub since_ms: u64,
    /// The bars, where all may see them.
    pub bars: Vec<(String, usize)>,
}

/// Who sees the votes of a round. The order is that of the key that shows more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VoteStage {
    /// Nobody sees more than their number.
    #[default]
    Counted,
    /// The teacher sees bars.
    Teacher,
    All,
}

/// The run that the class follows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PresentedRun {
    #[serde(flatten)]
    pub snapshot: Snapshot,
    /// When it was at the snapshot's step, ms since 1970.
    pub at_ms: u64,
    pub is_running: bool,
}

impl ClassFolder {
    /// Finds the class in the folder DIR.
    pub fn at(dir: &Path) -> Result<Self, String> {
        let root =
            fs::canonicalize(dir).map_err(|error| format!("{}: {error}", PrintablePath(dir)))?;
        Ok(Self { root })
    }

    /// Opens the class in the folder DIR, and makes its own folders if they do not exist.
    pub fn open(dir: &Path) -> Result<Self, String> {
        let folder = Self::at(dir)?;
        for path in [folder.own(), folder.seats(), folder.wrong()] {
            make(&path, OF_ALL)?;
        }
        Ok(folder)
    }

    /// Makes the teacher's folder.
    pub fn make_teacher(&self) -> Result<(), String> {
        make(&self.teacher(), OF_TEACHER)
    }

    fn own(&self) -> PathBuf {
        self.root.join(SESSIONS)
    }

    pub fn seats(&self) -> PathBuf {
        self.own().join("seats")
    }

    pub(super) fn wrong(&self) -> PathBuf {
        self.own().join("wrong")
    }

    /// Forgets the wrong codes that were typed for the seat `word`.
    pub(super) fn forget_wrong_codes(&self, word: &str) {
        let _ = fs::remove_file(self.wrong().join(word)); // where it stays, it counts on
    }

    /// Keeps seats, votes and state of the class in a folder of their own, `name`, which is then the folder of that class:
    /// `--votes`, `--answers` and `--board` read it. Afterwards this folder has no seats. Returns that folder; `None` where
    /// there was nothing to keep.
    ///
    /// # Errors
    /// When a folder cannot be made or moved.
    pub fn keep_as_earlier(&self, name: &str) -> Result<Option<PathBuf>, String> {
        let has_seats = fs::read_dir(self.seats()).is_ok_and(|mut seats| seats.next().is_some());
        if !has_seats && !self.state_file().exists() {
            return Ok(None);
        }
        let earlier = self.own().join("earlier");
        let group = earlier.join(name);
        let inside = group.join(SESSIONS);
        for path in [&earlier, &group, &inside] {
            make(path, OF_TEACHER)?;
        }
        for moved in [self.seats(), self.wrong(), self.teacher()] {
            let to = inside.join(moved.file_name().unwrap_or_default());
            fs::rename(&moved, to)
                .map_err(|error| format!("{}: {error}", PrintablePath(&moved)))?;
        }
        Ok(Some(group))
    }

    /// Returns the folder of the teacher, for the state and the sessions.
    pub fn teacher(&self) -> PathBuf {
        self.own().join("teacher")
    }

    pub(super) fn state_file(&self) -> PathBuf {
        self.teacher().join("state")
    }

    /// Reads the teacher's state; `None` before any class.
    ///
    /// # Errors
    /// When it cannot be read, or another version has written it.
    pub fn state(&self) -> Result<Option<ClassState>, String> {
        let path = self.state_file();
        let damaged = || format!("{}: is damaged", PrintablePath(&path));
        let read = shared::read(&path, LONGEST_STATE)
            .map_err(|error| format!("{}: {error}", PrintablePath(&path)))?;
        let Some(text) = read else { return Ok(None) };
        let table: toml::Table = toml::from_str(&text).map_err(|_| damaged())?;
        let version = table.get("gyrolab").and_then(toml::Value::as_str);
        if version != Some(CLASS_VERSION) {
            return Err(format!(
                "the teacher's gyrolab is {}, this one is {CLASS_VERSION}: both must be the same",
                version.unwrap_or("unknown")
            ));
        }
        table.try_into().map(Some).map_err(|_| damaged())
    }

    /// Publishes `state`.
    ///
    /// # Errors
    /// When it is too long, or cannot be written; the one before stays.
    pub fn publish(&self, state: &ClassState) -> Result<(), String> {
        let text = toml::to_string(state).map_err(|error| error.to_string())?;
        if text.len() > LONGEST_STATE {
            return Err("the class's state is above 128 kB".to_owned());
        }
        shared::replace(&self.state_file(), &text)
            .map_err(|error| format!("the class cannot be told: {error}"))
    }

    pub fn touch_state(&self) {
        let _ = shared::touch(&self.state_file()); // what is wrong is said where it is written
    }

    /// Returns whether the teacher's lab has touched its state a moment ago.
    pub fn is_teacher_alive(&self) -> bool {
        shared::modified(&self.state_file()).is_some_and(|time| ago(time) < GONE)
    }

    /// Returns whether nothing more can be written.
    pub fn is_full(&self) -> bool {
        rustix::fs::statvfs(self.own()).is_ok_and(|there| there.f_bavail == 0)
    }

    /// `lesson` without the folder's path.
    pub fn short<'a>(&self, lesson: &'a str) -> &'a str {
        let inside = Path::new(lesson).strip_prefix(&self.root).ok();
        inside.and_then(Path::to_str).unwrap_or(lesson)
    }
}

fn make(path: &Path, mode: u32) -> Result<(), String> {
    let made = shared::make_folder(path, mode).map(drop);
    made.map_err(|error| format!("{}: {error}", PrintablePath(path)))
}

impl QuestionState {
    /// Returns the present round, from 1.
    pub fn round(&self) -> u32 {
        self.earlier_rounds.saturating_add(1)
    }

    /// Returns whether the round is closed at `now_ms`: by the teacher, or because its countdown is over.
    pub fn is_closed_at(&self, now_ms: u64) -> bool {
        self.is_closed || self.closes_at_ms.is_some_and(|at_ms| at_ms <= now_ms)
    }

    /// Returns the seconds until the countdown closes the round; `None` where none is running.
    pub fn seconds_left(&self, now_ms: u64) -> Option<u64> {
        let at_ms = self.closes_at_ms.filter(|_| !self.is_closed_at(now_ms))?;
        Some((at_ms - now_ms).div_ceil(1000))
    }

    /// Closes the round. The bars stay where they are seen.
    pub(super) fn close(&mut self) {
        (self.is_closed, self.closes_at_ms) = (true, None);
    }

    /// Begins the next round.
    pub(super) fn ask_again(&mut self) {
        *self = Self {
            earlier_rounds: self.round(),
            since_ms: unix_ms(),
            ..Self::default()
        };
    }
}

impl ClassState {
    /// Returns what its lesson shows; `is_there` says whether the run has come where the teacher's is.
    pub(super) fn followed(&self, is_there: bool) -> ClassPage<'_> {
        ClassPage {
            lesson: &self.lesson,
            page: self.page,
            kept: &self.kept,
            has_arrived: self.has_arrived && is_there,
        }
    }

    pub fn question(&self, name: &str) -> QuestionState {
        let questions = self.questions.get(&self.lesson);
        questions
            .and_then(|all| all.get(name))
            .cloned()
            .unwrap_or_default()
    }

    pub(super) fn question_mut(&mut self, name: &str) -> &mut QuestionState {
        let questions = self.questions.entry(self.lesson.clone()).or_default();
        questions
            .entry(name.to_owned())
            .or_insert_with(|| QuestionState {
                since_ms: unix_ms(),
                ..QuestionState::default()
            })
    }
}
