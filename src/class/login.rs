//! Taking a seat: a name becomes a seat with a random code, and the seat's word leads back to it.
//!
//! Wrong codes are counted in the folder for every seat with the typed name, over all logins. After `FREE` wrong codes,
//! seats with that name accept no code for a minute, then twice as long after each further one, up to `LONGEST_WAIT_S`.
//! The right code of a seat resets the count of that seat only. The teacher can reset it too.
//!
//! Security: a code is one of a million. Guessing one code per hour, with any number of logins and of seats with the
//! same name, takes 500 000 hours (57 years) on average.

use super::ClassFolder;
use super::seat::{CODE_DIGITS, CODES, LONGEST_SEAT_NAME, Seat, all_seats, is_name, name_of};
use crate::engine::text::printable::printable;
use crate::lab::storage::shared;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::PathBuf;

/// Maximum number of seats in a class.
pub const MOST_SEATS: usize = 200;
/// Number of wrong codes in a row that are allowed without a wait.
const FREE: u32 = 5;
/// Wait after the last of these wrong codes, s.
const FIRST_WAIT_S: u64 = 60;
/// Longest wait, s.
const LONGEST_WAIT_S: u64 = 3600;
/// Maximum length of a file with a count, bytes.
const LONGEST_COUNT: usize = 100;

pub const ASKS: &str = "A name for your seat (only the teacher sees it);\n\
    or, to return, the word of your seat, such as anna-471108: ";
const RULE: &str = "a name has letters, digits and hyphens,\n\
    no blanks, at most 24; the word of a seat ends\n\
    in a hyphen and six digits";

/// Wrong codes for a seat since its right code was typed or the teacher reset the count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongCodes {
    pub count: u32,
    /// Time of the last wrong code, s since 1970.
    at_unix_s: u64,
}

impl WrongCodes {
    fn file(folder: &ClassFolder, word: &str) -> PathBuf {
        folder.wrong().join(word)
    }

    /// Reads the count for the seat `word`. A file that cannot be read counts as zero, and the next wrong code replaces
    /// it.
    fn read(folder: &ClassFolder, word: &str) -> Self {
        let text = shared::read_of_anyone(&Self::file(folder, word), LONGEST_COUNT);
        let parsed = text.ok().flatten().and_then(|text| Self::parse(&text));
        parsed.unwrap_or_default()
    }

    fn parse(text: &str) -> Option<Self> {
        let (count, at_unix_s) = text.split_once(' ')?;
        Some(Self {
            count: count.parse().ok()?,
            at_unix_s: at_unix_s.parse().ok()?,
        })
    }

    fn write(self, folder: &ClassFolder, word: &str) -> Result<(), String> {
        let Self { count, at_unix_s } = self;
        if count == 0 {
            folder.forget_wrong_codes(word);
            return Ok(());
        }
        let text = format!("{count} {at_unix_s}");
        shared::replace(&Self::file(folder, word), &text)
            .map_err(|error| format!("no code can be tried now: {error}"))
    }

    /// Returns how long no code is accepted from `now_unix_s`, s.
    fn wait_s(self, now_unix_s: u64) -> u64 {
        let Some(further) = self.count.checked_sub(FREE) else {
            return 0;
        };
        let whole_s = (FIRST_WAIT_S << further.min(6)).min(LONGEST_WAIT_S);
        self.at_unix_s
            .saturating_add(whole_s)
            .saturating_sub(now_unix_s)
            .min(whole_s) // the clock may have been set back
    }
}

/// Returns the seat for the name or word `typed`, and true if it is new.
///
/// # Errors
///
/// Returns a message for the student if there is no such seat.
pub fn claim(folder: &ClassFolder, typed: &str, now_unix_s: u64) -> Result<(Seat, bool), String> {
    let word = typed.trim().to_lowercase();
    match name_of(&word) {
        Some(name) => return_to_seat(folder, &word, name, now_unix_s).map(|seat| (seat, false)),
        None if is_name(&word) => create_seat(folder, &word).map(|seat| (seat, true)),
        None => {
            let shown: String = word.chars().take(2 * LONGEST_SEAT_NAME).collect();
            Err(format!("{}: {RULE}", printable(&shown)))
        }
    }
}

/// Returns the seat with the word `typed`.
///
/// # Errors
///
/// Returns a message for the student if there is no such seat.
pub fn find(folder: &ClassFolder, typed: &str, now_unix_s: u64) -> Result<Seat, String> {
    let word = typed.trim().to_lowercase();
    match name_of(&word) {
        Some(name) => return_to_seat(folder, &word, name, now_unix_s),
        None => Err("type the word of your seat, such as anna-471108".to_owned()),
    }
}

fn create_seat(folder: &ClassFolder, name: &str) -> Result<Seat, String> {
    if all_seats(folder)?.len() >= MOST_SEATS {
        return Err(format!(
            "this class is full with {MOST_SEATS} seats: ask your teacher"
        ));
    }
    for _ in 0..100 {
        let code = RandomState::new().build_hasher().finish() % CODES;
        let seat = Seat::named(folder, &format!("{name}-{code:0CODE_DIGITS$}"));
        match seat.make() {
            Ok(true) => return Ok(seat),
            Ok(false) => {}
            Err(error) => return Err(format!("the seat cannot be created: {error}")),
        }
    }
    Err("all seats with that name are taken: choose another name".to_owned())
}

/// Returns the seat `word`, whose name is `name`.
///
/// While a seat with that name must wait, its right code gets the same answer as a wrong one, so that an attempt
/// reveals nothing. Other seats with that name can be taken meanwhile.
fn return_to_seat(
    folder: &ClassFolder,
    word: &str,
    name: &str,
    now_unix_s: u64,
) -> Result<Seat, String> {
    // Process one login at a time, so that each is counted. On a file system without locks, some may count as one.
    let turn =
        File::open(folder.wrong()).map_err(|error| format!("no code can be tried now: {error}"))?;
    let _ = turn.lock(); // locked until this function returns
    let mut seats = all_seats(folder)?;
    seats.retain(|seat| name_of(&seat.word) == Some(name));
    let before: Vec<_> = seats
        .iter()
        .map(|seat| WrongCodes::read(folder, &seat.word))
        .collect();
    let waits = before.iter().map(|wrong| wrong.wait_s(now_unix_s));
    let longest_s = waits.clone().max().unwrap_or(0);
    let mut found = seats.iter().zip(waits).filter(|(_, wait_s)| *wait_s == 0);
    let seat = found.find_map(|(seat, _)| (seat.word == word).then_some(seat));
    if seat.is_none() && longest_s > 0 {
        let wait = in_words(longest_s);
        return Err(format!(
            "too many wrong codes for {name}: wait {wait}, or ask your teacher"
        ));
    }
    // Count before answering, so that the answer on a full disk is the same for every code.
    for (tried, wrong) in seats.iter().zip(&before) {
        let counted = WrongCodes {
            count: wrong.count.saturating_add(1),
            at_unix_s: now_unix_s,
        };
        counted.write(folder, &tried.word)?;
    }
    let Some(seat) = seat else {
        return Err("there is no seat of that word; for a new seat type a name alone".to_owned());
    };
    for (other, wrong) in seats.iter().zip(before) {
        if other.word != seat.word {
            wrong.write(folder, &other.word)?;
        }
    }
    folder.forget_wrong_codes(&seat.word);
    let state = folder.state().ok().flatten().unwrap_or_default();
    if state.closed.contains(word) {
        return Err("this seat is closed: ask your teacher".to_owned());
    }
    Ok(seat.clone())
}

/// A seat that accepts no code for a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaitingSeat {
    pub word: String,
    pub wrong: WrongCodes,
    wait_s: u64,
}

impl WaitingSeat {
    /// Returns the seat as the teacher's lists show it.
    pub fn in_words(&self) -> String {
        let (word, count) = (&self.word, self.wrong.count);
        format!(
            "{word}: {count} wrong codes, waits {}",
            in_words(self.wait_s)
        )
    }
}

/// Returns the seats that accept no code now.
pub fn waiting(folder: &ClassFolder, now_unix_s: u64) -> Vec<WaitingSeat> {
    let mut waiting = Vec::new();
    for entry in fs::read_dir(folder.wrong()).into_iter().flatten().flatten() {
        let Ok(word) = entry.file_name().into_string() else {
            continue;
        };
        let wrong = WrongCodes::read(folder, &word);
        let wait_s = wrong.wait_s(now_unix_s);
        if wait_s > 0 && name_of(&word).is_some() && Seat::named(folder, &word).is_there() {
            waiting.push(WaitingSeat {
                word,
                wrong,
                wait_s,
            });
        }
    }
    waiting.sort_unstable_by(|a, b| a.word.cmp(&b.word));
    waiting
}

/// Returns a time in whole minutes, or in seconds below two minutes.
fn in_words(seconds: u64) -> String {
    match seconds {
        0..120 => format!("{seconds} s"),
        _ => format!("{} min", seconds.div_ceil(60)),
    }
}
