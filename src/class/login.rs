//! Taking a seat: a name becomes a seat with a drawn code, and the seat's word leads back to it.
//!
//! A wrong code counts for every seat of its name, in the folder, for all logins together. After `FREE` of them the seats
//! of that name accept no code for a minute, and after each further one for twice as long, up to `LONGEST_WAIT_S`. The
//! right code of a seat resets the count of that seat alone; the teacher can reset it too.
//!
//! How long a guess takes: the code of a seat is one of a million. Someone who guesses a code in every hour, in however many
//! logins and with however many seats of the same name, needs 500 000 hours on average, which is 57 years.

use super::ClassFolder;
use super::seat::{CODE_DIGITS, CODES, LONGEST_SEAT_NAME, Seat, all_seats, is_name, name_of};
use crate::engine::text::printable::printable;
use crate::lab::storage::shared;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::PathBuf;

/// The most seats of a class.
pub const MOST_SEATS: usize = 200;
/// So many wrong codes may be typed one after the other.
const FREE: u32 = 5;
/// The wait after the last of them, s, and the longest.
const FIRST_WAIT_S: u64 = 60;
const LONGEST_WAIT_S: u64 = 3600;
/// The longest file that counts wrong codes, bytes.
const LONGEST_COUNT: usize = 100;

pub const ASKS: &str = "A name for your seat (the teacher sees it, others do not);\n\
    or, to come back, your seat's word, such as anna-471108: ";
const RULE: &str = "a name has letters, digits and hyphens,\n\
    no blanks, 24 at most; the word of a seat ends\n\
    in a hyphen and six digits";

/// The wrong codes that were typed for a seat since its right code was typed, or the teacher reset them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongCodes {
    pub count: u32,
    /// When the last one was typed, s since 1970.
    at_unix_s: u64,
}

impl WrongCodes {
    fn file(folder: &ClassFolder, word: &str) -> PathBuf {
        folder.wrong().join(word)
    }

    /// Reads what the folder holds for the seat `word`. A file that cannot be read counts nothing: the next wrong code
    /// replaces it.
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

    /// Returns for how long no code is accepted from `now_unix_s` on, s.
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

/// Returns the seat that `typed` asks for, and whether it is new.
///
/// # Errors
/// Why there is none, in words for the student.
pub fn claim(folder: &ClassFolder, typed: &str, now_unix_s: u64) -> Result<(Seat, bool), String> {
    let word = typed.trim().to_lowercase();
    match name_of(&word) {
        Some(name) => come_back(folder, &word, name, now_unix_s).map(|seat| (seat, false)),
        None if is_name(&word) => begin(folder, &word).map(|seat| (seat, true)),
        None => {
            let shown: String = word.chars().take(2 * LONGEST_SEAT_NAME).collect();
            Err(format!("{}: {RULE}", printable(&shown)))
        }
    }
}

/// Returns the seat whose word is `typed`.
///
/// # Errors
/// Why there is none, in words for the student.
pub fn find(folder: &ClassFolder, typed: &str, now_unix_s: u64) -> Result<Seat, String> {
    let word = typed.trim().to_lowercase();
    match name_of(&word) {
        Some(name) => come_back(folder, &word, name, now_unix_s),
        None => Err("type the word of your seat, such as anna-471108".to_owned()),
    }
}

fn begin(folder: &ClassFolder, name: &str) -> Result<Seat, String> {
    if all_seats(folder)?.len() >= MOST_SEATS {
        return Err(format!(
            "this class has {MOST_SEATS} seats, the most that it can have: ask your teacher"
        ));
    }
    for _ in 0..100 {
        let code = RandomState::new().build_hasher().finish() % CODES;
        let seat = Seat::named(folder, &format!("{name}-{code:0CODE_DIGITS$}"));
        match seat.make() {
            Ok(true) => return Ok(seat),
            Ok(false) => {}
            Err(error) => return Err(format!("no seat can be made: {error}")),
        }
    }
    Err("no seat is free under that name: choose another".to_owned())
}

/// Returns the seat `word`, whose name is `name`.
///
/// While a seat of that name waits, its right code gets the same answer as a wrong one: what is typed then says nothing
/// about it. A seat of that name that does not wait can be taken meanwhile.
fn come_back(
    folder: &ClassFolder,
    word: &str,
    name: &str,
    now_unix_s: u64,
) -> Result<Seat, String> {
    // One login after the other, so that each is counted. On a file system without locks some may count as one.
    let turn =
        File::open(folder.wrong()).map_err(|error| format!("no code can be tried now: {error}"))?;
    let _ = turn.lock(); // held until this function returns
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
    // Counted before the answer, whatever it is: where the disk is full, it is the same for every code.
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
    /// As the lists of the teacher have it.
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

/// Returns a time in whole minutes, or in seconds below two.
fn in_words(seconds: u64) -> String {
    match seconds {
        0..120 => format!("{seconds} s"),
        _ => format!("{} min", seconds.div_ceil(60)),
    }
}
