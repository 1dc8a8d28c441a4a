//! Taking a seat: a name becomes a seat with a drawn code, and the seat's word leads back to it. Five wrong codes lock a
//! name for a minute, for every login: they are counted in the folder.

use super::Folder;
use super::seat::{LONGEST_NAME, Seat, all_seats, is_name, name_of};
use crate::storage::shared;
use crate::text::printable::printable;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};

/// The most seats of a class.
pub const MOST_SEATS: usize = 200;
/// After this many wrong codes a name is locked, and for how long, s.
const MOST_WRONG: u32 = 5;
const LOCKED_S: u64 = 60;

pub const ASKS: &str = "A name for your seat (the teacher sees it, others do not);\n\
    or, to come back, your seat's word, such as anna-4711: ";
const RULE: &str = "a name has letters, digits and hyphens,\n\
    no blanks, 24 at most; the word of a seat ends\n\
    in a hyphen and four digits";

/// The seat that `typed` asks for, and whether it is new.
///
/// # Errors
/// Why there is none, in words for the student.
pub fn take(folder: &Folder, typed: &str, now_unix_s: u64) -> Result<(Seat, bool), String> {
    let typed = typed.trim().to_lowercase();
    match name_of(&typed) {
        Some(name) => come_back(folder, &typed, name, now_unix_s).map(|seat| (seat, false)),
        None if is_name(&typed) => begin(folder, &typed).map(|seat| (seat, true)),
        None => {
            let shown: String = typed.chars().take(2 * LONGEST_NAME).collect();
            Err(format!("{}: {RULE}", printable(&shown)))
        }
    }
}

fn begin(folder: &Folder, name: &str) -> Result<Seat, String> {
    if all_seats(folder).len() >= MOST_SEATS {
        return Err(format!(
            "this class has {MOST_SEATS} seats, the most that it can have: ask your teacher"
        ));
    }
    for _ in 0..100 {
        let code = RandomState::new().build_hasher().finish() % 10_000;
        let seat = Seat::of(folder, &format!("{name}-{code:04}"));
        match seat.make() {
            Ok(true) => return Ok(seat),
            Ok(false) => {}
            Err(error) => return Err(format!("no seat can be made: {error}")),
        }
    }
    Err("no seat is free under that name: choose another".to_owned())
}

fn come_back(folder: &Folder, word: &str, name: &str, now_unix_s: u64) -> Result<Seat, String> {
    // One login after the other, so that each is counted.
    let _turn = File::open(folder.wrong()).and_then(|turn| turn.lock().map(|()| turn));
    let count = wrong(folder, name, now_unix_s);
    if count >= MOST_WRONG {
        let rule = "wait a minute, or ask your teacher";
        return Err(format!("too many wrong codes for {name}: {rule}"));
    }
    let seat = Seat::of(folder, word);
    if seat.folder.is_dir() {
        let state = folder.state().ok().flatten().unwrap_or_default();
        if state.closed.contains(word) {
            return Err("this seat is closed: ask your teacher".to_owned());
        }
        folder.unlock(name);
        return Ok(seat);
    }
    // A name without a seat has nothing to guess, and would fill the folder.
    let mut seats = all_seats(folder).into_iter();
    if seats.any(|seat| name_of(&seat.word) == Some(name)) {
        let text = format!("{} {now_unix_s}", count + 1);
        let counted = shared::replace(&folder.wrong().join(name), &text);
        counted.map_err(|error| format!("no code can be tried now: {error}"))?;
    }
    Err("there is no seat of that word; for a new seat type a name alone".to_owned())
}

/// How many wrong codes were typed for `name`; a lock that is over counts no more.
fn wrong(folder: &Folder, name: &str, now_unix_s: u64) -> u32 {
    let counted = || {
        // Of either account: the teacher's may have made the folder.
        let text = fs::read_to_string(folder.wrong().join(name)).ok()?;
        let (count, at_s) = text.split_once(' ')?;
        let (count, at_s): (u32, u64) = (count.parse().ok()?, at_s.parse().ok()?);
        (count < MOST_WRONG || now_unix_s < at_s.saturating_add(LOCKED_S)).then_some(count)
    };
    counted().unwrap_or(0)
}

/// The names that are locked now.
pub fn locked(folder: &Folder, now_unix_s: u64) -> Vec<String> {
    let entries = fs::read_dir(folder.wrong()).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_locked = |name: &String| is_name(name) && wrong(folder, name, now_unix_s) >= MOST_WRONG;
    names.filter(is_locked).collect()
}
