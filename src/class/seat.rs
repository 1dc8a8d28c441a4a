//! The files of a seat: the progress in its lessons, its votes, and the process that has it open.

use super::folder::{CLASS_VERSION, ClassFolder, OF_ALL};
use super::{ago, unix_ms};
use crate::engine::text::printable::PrintablePath;
use crate::lab::storage::confined::SESSIONS;
use crate::lab::storage::shared;
use crate::lessons::state::KeptLessons;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Format of a seat's file. Raise it when the form or the meaning changes.
const SEAT_FORMAT: u32 = 2;
/// Maximum characters of a name.
pub(super) const LONGEST_SEAT_NAME: usize = 24;
/// Digits of a code.
pub(super) const CODE_DIGITS: usize = 6;
/// Number of different codes.
pub(super) const CODES: u64 = 1_000_000;
/// Digits of a code of an older version. Seats of that version keep their words.
const OLD_DIGITS: usize = 4;
/// Maximum length of a seat's file, bytes.
const LONGEST_SEAT_FILE: usize = 1 << 20;
/// Time without a heartbeat after which a seat is lost.
const LOST: Duration = Duration::from_secs(10);
/// Time without a heartbeat after which a seat is away.
const AWAY: Duration = Duration::from_secs(3600);

/// A seat of a class.
#[derive(Clone, Debug, Default)]
pub struct Seat {
    /// Word of the seat, such as `anna-471108`.
    pub word: String,
    pub folder: PathBuf,
}

/// The content of a seat's file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SeatRecord {
    /// Number of the format.
    pub format: u32,
    /// True if the seat has left a class that follows the teacher.
    pub is_aside: bool,
    /// Time at which the seat left or rejoined, ms since 1970.
    pub aside_since_ms: u64,
    /// Lessons with the answers to their questions, as a session keeps them.
    pub lessons: toml::Table,
}

/// Presence of a student at a seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    Here,
    /// Its lab has sent no heartbeat for a while.
    Lost,
    /// Its lab was left, or has sent no heartbeat for long.
    Away,
}

pub(super) fn is_name(name: &str) -> bool {
    let length = name.chars().count();
    (1..=LONGEST_SEAT_NAME).contains(&length)
        && name.chars().all(|c| c.is_alphanumeric() || c == '-')
        && !name.starts_with('-')
}

/// Returns the name in a seat's `word`, or `None` if it is not a word of a seat.
///
/// A word whose code lacks a digit counts as a word, not as a name. Thus nobody who mistypes a word gets a new seat.
pub(super) fn name_of(word: &str) -> Option<&str> {
    let (name, code) = word.rsplit_once('-')?;
    let is_code = code.len() >= OLD_DIGITS && code.bytes().all(|digit| digit.is_ascii_digit());
    (is_code && is_name(name)).then_some(name)
}

/// Returns the seats of the class, sorted by word.
///
/// # Errors
///
/// Returns an error if the folder of the seats cannot be read.
pub fn all_seats(folder: &ClassFolder) -> Result<Vec<Seat>, String> {
    let mut words = match words_in(&folder.seats()) {
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(format!("{}: {error}", PrintablePath(&folder.seats()))),
        Ok(words) => words,
    };
    words.sort_unstable();
    Ok(words.iter().map(|it| Seat::named(folder, it)).collect())
}

/// Returns the words of the seats in the folder `seats`.
fn words_in(seats: &Path) -> io::Result<Vec<String>> {
    let mut words = Vec::new();
    for found in fs::read_dir(seats)? {
        let entry = found?;
        let is_folder = entry.file_type().is_ok_and(|it| it.is_dir());
        if let Ok(word) = entry.file_name().into_string()
            && is_folder
            && name_of(&word).is_some()
        {
            words.push(word);
        }
    }
    Ok(words)
}

impl Seat {
    pub(super) fn named(folder: &ClassFolder, word: &str) -> Self {
        Self {
            word: word.to_owned(),
            folder: folder.seats().join(word),
        }
    }

    pub(super) fn is_there(&self) -> bool {
        self.folder.is_dir()
    }

    /// Creates the folders of the seat. Returns true if the seat is new.
    pub(super) fn make(&self) -> io::Result<bool> {
        let is_new = shared::make_folder(&self.folder, OF_ALL)?;
        shared::make_folder(&self.folder.join(SESSIONS), OF_ALL)?;
        Ok(is_new)
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(SESSIONS).join(name)
    }

    /// Reads the seat's file.
    ///
    /// # Errors
    ///
    /// Returns an error if it cannot be read, or was written by another version.
    pub fn record(&self) -> Result<SeatRecord, String> {
        let text = shared::read(&self.file("seat"), LONGEST_SEAT_FILE)
            .map_err(|error| error.to_string())?;
        let Some(text) = text else {
            return Ok(SeatRecord::default());
        };
        let record: SeatRecord = toml::from_str(&text).map_err(|_| "is damaged".to_owned())?;
        if record.format != SEAT_FORMAT {
            return Err(format!(
                "another version of gyrolab wrote it, this is {CLASS_VERSION}"
            ));
        }
        Ok(record)
    }

    /// Reads the seat's file with the progress in the lessons.
    ///
    /// # Errors
    ///
    /// Returns an error as [`record`](Self::record) does, or if the progress is damaged. The message names the seat.
    pub fn places(&self) -> Result<(SeatRecord, KeptLessons), String> {
        let read = self
            .record()
            .and_then(|record| match KeptLessons::read(&record.lessons) {
                Ok(kept) => Ok((record, kept)),
                Err(_) => Err("is damaged".to_owned()),
            });
        read.map_err(|reason| format!("the file of the seat {}: {reason}", self.word))
    }

    pub fn save(&self, record: &SeatRecord) -> Result<(), String> {
        let text = toml::to_string(&SeatRecord {
            format: SEAT_FORMAT,
            ..record.clone()
        })
        .map_err(|error| error.to_string())?;
        if text.len() > LONGEST_SEAT_FILE {
            return Err("the file of this seat exceeds 1 MB".to_owned());
        }
        shared::replace(&self.file("seat"), &text)
            .map_err(|error| format!("your answers cannot be saved: {error}"))
    }

    /// Opens the seat in this process. A lab that has it open elsewhere notices that. Returns the token of this
    /// process.
    pub fn hold(&self) -> Result<String, String> {
        let word = format!("{} {}", std::process::id(), unix_ms());
        let held = shared::replace(&self.file("open"), &word);
        held.map_err(|error| format!("the seat cannot be opened: {error}"))?;
        Ok(word)
    }

    /// Returns true if the seat is still open under the token `word`. It then also sends a heartbeat.
    pub(super) fn is_held(&self, word: &str) -> bool {
        let path = self.file("open");
        match shared::read(&path, 100) {
            Ok(Some(held)) if held == word => {
                let _ = shared::touch(&path); // without heartbeats the board shows the seat as lost
                true
            }
            Ok(_) => false,
            Err(_) => true, // no sign that another process has it
        }
    }

    pub(super) fn leave(&self, word: &str) {
        if self.is_held(word) {
            let _ = fs::remove_file(self.file("open")); // if this fails, the seat shows as lost
        }
    }

    pub fn presence(&self) -> Presence {
        match shared::modified(&self.file("open")) {
            Some(sign) if ago(sign) <= LOST => Presence::Here,
            Some(sign) if ago(sign) <= AWAY => Presence::Lost,
            _ => Presence::Away,
        }
    }
}
