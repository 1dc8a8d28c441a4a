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

/// Maximum length of a run file that a class can follow, bytes.
pub const LONGEST_RUN: usize = 64 * 1024;
/// Maximum length of the published state, bytes.
const LONGEST_STATE: usize = 2 * LONGEST_RUN;
/// Time without a heartbeat after which the teacher's lab counts as gone.
const GONE: Duration = Duration::from_secs(4);
/// Mode of folders in which both accounts write.
pub(super) const OF_ALL: u32 = 0o2770;
/// Mode of the teacher's folders.
const OF_TEACHER: u32 = 0o2750;

pub const CLASS_VERSION: &str = env!("CARGO_PKG_VERSION");

/// The folder of a class.
#[derive(Clone, Debug, Default)]
pub struct ClassFolder {
    /// Folder named on the command line, as a full path.
    pub root: PathBuf,
}

/// The state that the teacher's lab publishes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ClassState {
    /// Version that wrote the state.
    pub gyrolab: String,
    pub is_on: bool,
    /// Full name of the lesson.
    pub lesson: String,
    /// Number of its open page, from 1.
    pub page: usize,
    /// Number of seats that are here.
    pub here: usize,
    /// Number of these seats that have answered the question of the page.
    pub answered: usize,
    /// True if the run has arrived at the state of the page.
    pub has_arrived: bool,
    /// Seats that the teacher has closed.
    pub closed: BTreeSet<String>,
    /// Time at which the teacher last gathered the class, ms since 1970. Seats that left before it follow again.
    pub gathered_ms: u64,
    /// Questions by lesson, then by name.
    pub questions: BTreeMap<String, BTreeMap<String, QuestionState>>,
    /// Numbers kept by the lesson.
    pub kept: KeptNumbers,
    /// True if the students' labs follow; false if the students work on their own.
    pub is_followed: bool,
    /// Presented run; `None` if its file is too long.
    pub shown: Option<PresentedRun>,
}

/// The state of a question in a class.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct QuestionState {
    /// Number of rounds before the current one.
    pub earlier_rounds: u32,
    pub stage: VoteStage,
    /// True if the teacher has closed the round. Votes after that are late.
    pub is_closed: bool,
    /// Time at which a countdown closes the round, ms since 1970.
    pub closes_at_ms: Option<u64>,
    /// Time at which the round began, ms since 1970.
    pub since_ms: u64,
    /// Bars, if the whole class may see them.
    pub bars: Vec<(String, usize)>,
}

/// Visibility of the votes of a round, in the order of the key that shows more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VoteStage {
    /// Nobody sees more than the number of votes.
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
    /// Time at which the run was at the snapshot's step, ms since 1970.
    pub at_ms: u64,
    pub is_running: bool,
}

impl ClassFolder {
    /// Finds the class in the folder `dir`.
    ///
    /// # Errors
    ///
    /// Returns an error if the folder does not exist.
    pub fn at(dir: &Path) -> Result<Self, String> {
        let root =
            fs::canonicalize(dir).map_err(|error| format!("{}: {error}", PrintablePath(dir)))?;
        Ok(Self { root })
    }

    /// Opens the class in the folder `dir`, and creates its subfolders if necessary.
    ///
    /// # Errors
    ///
    /// Returns an error if a folder cannot be created.
    pub fn open(dir: &Path) -> Result<Self, String> {
        let folder = Self::at(dir)?;
        for path in [folder.private_folder(), folder.seats(), folder.wrong()] {
            create_folder(&path, OF_ALL)?;
        }
        Ok(folder)
    }

    /// Creates the teacher's folder.
    ///
    /// # Errors
    ///
    /// Returns an error if the folder cannot be created.
    pub fn make_teacher(&self) -> Result<(), String> {
        create_folder(&self.teacher(), OF_TEACHER)
    }

    fn private_folder(&self) -> PathBuf {
        self.root.join(SESSIONS)
    }

    pub fn seats(&self) -> PathBuf {
        self.private_folder().join("seats")
    }

    pub(super) fn wrong(&self) -> PathBuf {
        self.private_folder().join("wrong")
    }

    /// Resets the count of wrong codes for the seat `word`.
    pub(super) fn forget_wrong_codes(&self, word: &str) {
        let _ = fs::remove_file(self.wrong().join(word)); // if this fails, the count remains
    }

    /// Moves seats, votes and state of the class to a new class folder, `name`, for `--votes`, `--answers` and
    /// `--board`.
    ///
    /// Afterwards this folder has no seats. Returns the new folder, or `None` if there was nothing to move.
    ///
    /// # Errors
    ///
    /// Returns an error if a folder cannot be created or moved.
    pub fn keep_as_earlier(&self, name: &str) -> Result<Option<PathBuf>, String> {
        let has_seats = fs::read_dir(self.seats()).is_ok_and(|mut seats| seats.next().is_some());
        if !has_seats && !self.state_file().exists() {
            return Ok(None);
        }
        let earlier = self.private_folder().join("earlier");
        let group = earlier.join(name);
        let inside = group.join(SESSIONS);
        for path in [&earlier, &group, &inside] {
            create_folder(path, OF_TEACHER)?;
        }
        for moved in [self.seats(), self.wrong(), self.teacher()] {
            let to = inside.join(moved.file_name().unwrap_or_default());
            fs::rename(&moved, to)
                .map_err(|error| format!("{}: {error}", PrintablePath(&moved)))?;
        }
        Ok(Some(group))
    }

    /// Returns the teacher's folder, for the state and the sessions.
    pub fn teacher(&self) -> PathBuf {
        self.private_folder().join("teacher")
    }

    pub(super) fn state_file(&self) -> PathBuf {
        self.teacher().join("state")
    }

    /// Reads the teacher's state; `None` before any class.
    ///
    /// # Errors
    ///
    /// Returns an error if the state cannot be read, or was written by another version.
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
    ///
    /// Returns an error if it is too long or cannot be written. The previous state remains.
    pub fn publish(&self, state: &ClassState) -> Result<(), String> {
        let text = toml::to_string(state).map_err(|error| error.to_string())?;
        if text.len() > LONGEST_STATE {
            return Err("the class's state exceeds 128 kB".to_owned());
        }
        shared::replace(&self.state_file(), &text)
            .map_err(|error| format!("the class cannot be updated: {error}"))
    }

    pub fn touch_state(&self) {
        let _ = shared::touch(&self.state_file()); // publish() reports write errors
    }

    /// Returns true if the teacher's lab has sent a heartbeat recently.
    pub fn is_teacher_alive(&self) -> bool {
        shared::modified(&self.state_file()).is_some_and(|time| ago(time) < GONE)
    }

    /// Returns true if the disk is full.
    pub fn is_full(&self) -> bool {
        rustix::fs::statvfs(self.private_folder()).is_ok_and(|there| there.f_bavail == 0)
    }

    /// Returns `lesson` without the folder's path.
    pub fn short<'a>(&self, lesson: &'a str) -> &'a str {
        let inside = Path::new(lesson).strip_prefix(&self.root).ok();
        inside.and_then(Path::to_str).unwrap_or(lesson)
    }
}

fn create_folder(path: &Path, mode: u32) -> Result<(), String> {
    let made = shared::make_folder(path, mode).map(drop);
    made.map_err(|error| format!("{}: {error}", PrintablePath(path)))
}

impl QuestionState {
    /// Returns the current round, from 1.
    pub fn round(&self) -> u32 {
        self.earlier_rounds.saturating_add(1)
    }

    /// Returns true if the round is closed at `now_ms`, by the teacher or by its countdown.
    pub fn is_closed_at(&self, now_ms: u64) -> bool {
        self.is_closed || self.closes_at_ms.is_some_and(|at_ms| at_ms <= now_ms)
    }

    /// Returns the seconds until the countdown closes the round, or `None` if no countdown is running.
    pub fn seconds_left(&self, now_ms: u64) -> Option<u64> {
        let at_ms = self.closes_at_ms.filter(|_| !self.is_closed_at(now_ms))?;
        Some((at_ms - now_ms).div_ceil(1000))
    }

    /// Closes the round. Visible bars remain.
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
    /// Returns the class's page. `is_there` is true if the run here has arrived at the teacher's step.
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
