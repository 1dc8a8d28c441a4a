//! Decodes the bytes of a terminal into keys and pastes.
//!
//! Bytes arrive in pieces of any length. An unfinished sequence waits a short time for its next byte. After that time,
//! or at a byte that cannot belong to it, the sequence is dropped and decoding restarts. Ctrl-C ends every sequence.
//! Focus reports, old mouse reports and similar sequences are recognized and ignored, so that they are not mistaken for
//! keys.

use crate::lab::MOST_PASTED;
use crate::lab::view::theme::Background;
use crate::tui::keymap::Key;
use crate::tui::mouse::{Did, Mouse};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Longest wait for the next byte of a sequence. A single Esc is recognized only after this time.
const BYTE_GAP: Duration = Duration::from_millis(50);
/// Longest time for a whole sequence.
const WHOLE_SEQUENCE_LIMIT: Duration = Duration::from_millis(500);
/// Longest wait for the next byte of a paste, which comes in pieces on a slow line.
const GAP_IN_PASTE: Duration = Duration::from_secs(3);
/// Maximum bytes kept of a sequence. Every key has fewer.
const LONGEST_SEQUENCE: usize = 64;
/// Maximum bytes kept of a paste: one more than the lab accepts, so that the lab can tell that it is too long.
const LONGEST_PASTE: usize = MOST_PASTED + 1;

const ESC: u8 = 0x1b;
const BELL: u8 = 0x07;
const CTRL_C: u8 = 0x03;
const END_OF_PASTE: &[u8] = b"\x1b[201~";

/// A decoded input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Typed {
    Key(Key),
    /// Pasted text, marked as such by the terminal (bracketed paste).
    Paste(String),
    Mouse(Mouse),
    /// The terminal's answer about its background color.
    Background(Background),
}

/// A decoder with its unfinished sequence and the inputs decoded so far.
#[derive(Debug, Default)]
pub struct Decoder {
    typed: VecDeque<Typed>,
    /// The bytes of the unfinished sequence.
    pending: Vec<u8>,
    paste: Option<Paste>,
    /// Arrival times of the first and the last byte of the unfinished sequence or paste.
    arrivals: Option<(Instant, Instant)>,
}

/// A paste whose end has not arrived.
#[derive(Debug, Default)]
struct Paste {
    bytes: Vec<u8>,
    /// Number of bytes at the end that match the beginning of [`END_OF_PASTE`].
    matched_of_end: usize,
}

/// Result of decoding the bytes of a sequence or a character.
#[derive(Debug, PartialEq, Eq)]
enum Decoded {
    Unfinished,
    Typed(Typed),
    /// A complete sequence that is no key of the lab.
    Nothing,
    Paste,
    /// The last byte does not belong to the sequence.
    Broken,
}

impl Decoder {
    pub fn feed(&mut self, bytes: &[u8], now: Instant) {
        self.expire(now);
        for &byte in bytes {
            if !self.is_waiting() {
                self.arrivals = Some((now, now));
            }
            self.take(byte);
        }
        let first = self.arrivals.map_or(now, |(first, _)| first);
        self.arrivals = self.is_waiting().then_some((first, now));
    }

    pub fn take_typed(&mut self) -> Option<Typed> {
        self.typed.pop_front()
    }

    pub fn ready(&self) -> usize {
        self.typed.len()
    }

    /// Returns the time at which the unfinished sequence or paste will be dropped, if any.
    pub fn deadline(&self) -> Option<Instant> {
        let (first, last) = self.arrivals?;
        match self.paste {
            Some(_) => Some(last + GAP_IN_PASTE),
            None => Some((last + BYTE_GAP).min(first + WHOLE_SEQUENCE_LIMIT)),
        }
    }

    /// Drops the unfinished sequence or paste if its time is over at `now`.
    pub fn expire(&mut self, now: Instant) {
        if self.deadline().is_none_or(|deadline| now < deadline) {
            return;
        }
        self.arrivals = None;
        match self.paste.take() {
            Some(paste) => self.end_paste(&paste),
            None => self.drop_pending(),
        }
    }

    fn is_waiting(&self) -> bool {
        !self.pending.is_empty() || self.paste.is_some()
    }

    fn take(&mut self, byte: u8) {
        if let Some(paste) = self.paste.take() {
            return self.take_pasted(paste, byte);
        }
        if self.pending.len() >= LONGEST_SEQUENCE && is_body(&self.pending, byte) {
            return;
        }
        self.pending.push(byte);
        match decode(&self.pending) {
            Decoded::Unfinished => return,
            Decoded::Typed(typed) => self.typed.push_back(typed),
            Decoded::Nothing => {}
            Decoded::Paste => self.paste = Some(Paste::default()),
            Decoded::Broken => {
                self.pending.pop();
                if self.pending.is_empty() {
                    return; // no sequence begins with this byte
                }
                self.drop_pending();
                return self.take(byte);
            }
        }
        self.pending.clear();
    }

    /// Drops the unfinished sequence.
    ///
    /// Esc, or Esc and one more key, count as typed. A longer sequence cannot have been typed so fast and is ignored.
    fn drop_pending(&mut self) {
        let count = match self.pending.as_slice() {
            [ESC] => 1,
            [ESC, other] if other.is_ascii_graphic() => 2,
            _ => 0,
        };
        let keys = self.pending[..count]
            .iter()
            .map(|byte| Typed::Key(key_of(*byte)));
        self.typed.extend(keys);
        self.pending.clear();
    }

    fn take_pasted(&mut self, mut paste: Paste, byte: u8) {
        if byte == CTRL_C {
            // No terminal sends Ctrl-C within a paste: the end of the paste was lost, and this is a key.
            return self.typed.push_back(Typed::Key(key_of(byte)));
        }
        if byte == END_OF_PASTE[paste.matched_of_end] {
            paste.matched_of_end += 1;
            if paste.matched_of_end == END_OF_PASTE.len() {
                return self.end_paste(&paste);
            }
        } else {
            let no_end = &END_OF_PASTE[..paste.matched_of_end];
            if paste.bytes.len() < LONGEST_PASTE {
                paste.bytes.extend_from_slice(no_end);
            }
            paste.matched_of_end = usize::from(byte == ESC);
            if byte != ESC && paste.bytes.len() < LONGEST_PASTE {
                paste.bytes.push(byte);
            }
        }
        self.paste = Some(paste);
    }

    fn end_paste(&mut self, paste: &Paste) {
        let text = String::from_utf8_lossy(&paste.bytes).into_owned();
        self.typed.push_back(Typed::Paste(text));
    }
}

/// Returns true if `byte` continues the body of the overlong sequence `pending` and need not be kept.
fn is_body(pending: &[u8], byte: u8) -> bool {
    match pending {
        [ESC, b'[', ..] => (0x20..0x40).contains(&byte),
        [.., last] => *last != ESC && byte >= 0x20,
        [] => false,
    }
}

fn decode(bytes: &[u8]) -> Decoded {
    match bytes {
        [ESC, rest @ ..] => after_escape(rest),
        [byte @ 0..0x80] => key_or_nothing(Some(key_of(*byte))),
        bytes => character(bytes),
    }
}

/// Decodes a character of more than one byte.
fn character(bytes: &[u8]) -> Decoded {
    let length = match bytes.first() {
        Some(0xc2..=0xdf) => 2,
        Some(0xe0..=0xef) => 3,
        Some(0xf0..=0xf4) => 4,
        _ => return Decoded::Broken,
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => key_or_nothing(text.chars().next().map(Key::Char)),
        Err(error) if error.error_len().is_none() && bytes.len() < length => Decoded::Unfinished,
        Err(_) => Decoded::Broken,
    }
}

fn key_of(byte: u8) -> Key {
    match byte {
        b'\r' => Key::Enter,
        b'\t' => Key::Tab,
        ESC => Key::Esc,
        0x7f => Key::Backspace,
        0 => Key::Ctrl(' '),
        0x01..=0x1a => Key::Ctrl(char::from(byte - 1 + b'a')),
        0x1c..=0x1f => Key::Ctrl(char::from(byte - 0x1c + b'4')),
        _ => Key::Char(char::from(byte)),
    }
}

fn after_escape(rest: &[u8]) -> Decoded {
    match rest {
        [] | [b'O' | b'['] => Decoded::Unfinished,
        [b'O', letter @ 0x20..0x7f] => key_or_nothing(key_of_letter(*letter, 1)),
        [b'[', rest @ ..] => control_sequence(rest),
        [b']', rest @ ..] => match (string(rest), background(rest)) {
            (Decoded::Nothing, Some(background)) => Decoded::Typed(Typed::Background(background)),
            (decoded, _) => decoded,
        },
        [b'P' | b'^' | b'_' | b'X', rest @ ..] => string(rest),
        _ => Decoded::Broken, // Alt with a key looks like Esc and a key, and is decoded as such
    }
}

fn key_or_nothing(key: Option<Key>) -> Decoded {
    key.map_or(Decoded::Nothing, |key| Decoded::Typed(Typed::Key(key)))
}

/// Decodes a string that a terminal sends unasked. It ends with `ESC \` or a bell, and is ignored.
fn string(rest: &[u8]) -> Decoded {
    match rest {
        [.., CTRL_C] => Decoded::Broken,
        [.., BELL] | [.., ESC, b'\\'] => Decoded::Nothing,
        [.., ESC, _] => Decoded::Broken,
        _ => Decoded::Unfinished,
    }
}

/// Parses the terminal's report of its background color: `11;rgb:RRRR/GGGG/BBBB`, each component with one to four
/// hexadecimal digits.
fn background(rest: &[u8]) -> Option<Background> {
    let text = std::str::from_utf8(rest).ok()?;
    let color = text.strip_prefix("11;rgb:")?;
    let ends = |c| c == '\u{7}' || c == '\u{1b}' || c == '\\';
    let parts: Vec<_> = color.trim_end_matches(ends).split('/').collect();
    let [red, green, blue] = parts[..] else {
        return None;
    };
    let share = |digits: &str| {
        let number = u16::from_str_radix(digits, 16).ok()?;
        let most = 16_f64.powi(digits.len() as i32) - 1.0;
        Some(f64::from(number) / most)
    };
    let brightness = 0.3 * share(red)? + 0.59 * share(green)? + 0.11 * share(blue)?;
    Some(if brightness > 0.5 {
        Background::Light
    } else {
        Background::Dark
    })
}

/// Decodes the bytes after `ESC [`: parameters, then a last byte from `@` to `~`.
fn control_sequence(rest: &[u8]) -> Decoded {
    match rest {
        [.., 0..0x20] => Decoded::Broken,
        // The Linux console's F1 to F5 and old mouse reports continue after a byte that looks like the last one.
        [] | [b'['] | [b'M'] | [b'M', _] | [b'M', _, _] => Decoded::Unfinished,
        [b'[', _] | [b'M', ..] => Decoded::Nothing,
        [.., 0x20..0x40] => Decoded::Unfinished,
        [b'<', parameters @ .., last @ (b'M' | b'm')] => mouse(parameters, *last == b'M')
            .map_or(Decoded::Nothing, |mouse| {
                Decoded::Typed(Typed::Mouse(mouse))
            }),
        [parameters @ .., last @ 0x40..0x7f] => meaning(parameters, *last),
        _ => Decoded::Broken,
    }
}

/// Parses a mouse report, `BUTTON;COLUMN;LINE` counted from 1. `is_down` is false if a button was released.
fn mouse(parameters: &[u8], is_down: bool) -> Option<Mouse> {
    /// Shift, Alt and Ctrl.
    const MODIFIERS: u16 = 4 | 8 | 16;
    /// Maximum bytes of a report. No screen position needs more.
    const LONGEST_PLACE: usize = 20;
    let text = std::str::from_utf8(parameters).ok()?;
    if text.len() > LONGEST_PLACE {
        return None;
    }
    let numbers: Result<Vec<u16>, _> = text.split(';').map(str::parse).collect();
    let [button, column, line] = numbers.ok()?[..] else {
        return None;
    };
    let did = match (button & !MODIFIERS, is_down) {
        (0, true) => Did::Press,
        (32, true) => Did::Drag,
        (64, true) => Did::WheelUp,
        (65, true) => Did::WheelDown,
        (0..=3, false) => Did::Release,
        _ => return None,
    };
    let (x, y) = (column.checked_sub(1)?, line.checked_sub(1)?);
    Some(Mouse { did, x, y })
}

fn meaning(parameters: &[u8], last: u8) -> Decoded {
    let text = std::str::from_utf8(parameters).unwrap_or("?");
    // A number may have sub-parameters after a colon.
    let mut numbers = text
        .split(';')
        .map(|text| text.split(':').next().and_then(|text| text.parse().ok()));
    let first: Option<u32> = numbers.next().flatten();
    let modifiers = numbers.next().flatten().unwrap_or(1);
    match (first, last) {
        (Some(200), b'~') => Decoded::Paste,
        (Some(number), b'~') => key_or_nothing(key_of_number(number)),
        (Some(code), b'u') => key_or_nothing(key_of_code(code, modifiers)),
        (None, _) if !text.is_empty() => Decoded::Nothing, // the mouse, and other reports
        (_, letter) => key_or_nothing(key_of_letter(letter, modifiers)),
    }
}

fn has_shift(modifiers: u32) -> bool {
    modifiers.saturating_sub(1) & 1 != 0
}

fn has_control(modifiers: u32) -> bool {
    modifiers.saturating_sub(1) & 4 != 0
}

fn key_of_letter(letter: u8, modifiers: u32) -> Option<Key> {
    Some(match (letter, has_shift(modifiers)) {
        // rxvt sends small letters with Shift.
        (b'A', true) | (b'a', _) => Key::ShiftUp,
        (b'B', true) | (b'b', _) => Key::ShiftDown,
        (b'C', true) | (b'c', _) => Key::ShiftRight,
        (b'D', true) | (b'd', _) => Key::ShiftLeft,
        (b'A', false) => Key::Up,
        (b'B', false) => Key::Down,
        (b'C', false) => Key::Right,
        (b'D', false) => Key::Left,
        (b'H', _) => Key::Home,
        (b'F', _) => Key::End,
        (b'Z', _) => Key::BackTab,
        _ => return None,
    })
}

fn key_of_number(number: u32) -> Option<Key> {
    Some(match number {
        1 | 7 => Key::Home,
        4 | 8 => Key::End,
        3 => Key::Delete,
        5 => Key::PageUp,
        6 => Key::PageDown,
        _ => return None,
    })
}

/// Returns the key with this code point. Some terminals send keys with modifiers in this form.
fn key_of_code(code: u32, modifiers: u32) -> Option<Key> {
    let c = char::from_u32(code)?;
    Some(match c {
        '\t' if has_shift(modifiers) => Key::BackTab,
        c if c.is_ascii_graphic() && has_control(modifiers) => Key::Ctrl(c.to_ascii_lowercase()),
        c if has_shift(modifiers) => Key::Char(c.to_ascii_uppercase()),
        c if c.is_ascii() => key_of(code as u8),
        c => Key::Char(c),
    })
}

#[cfg(test)]
mod tests;
