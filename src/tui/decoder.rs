//! What the bytes of a terminal say: keys and pastes.
//!
//! Bytes come in pieces of any length. A sequence that is not finished waits for its next byte, but not for long: then,
//! or at a byte that cannot belong to it, it is given up, and what follows is read anew. Ctrl-C ends every sequence.
//! Reports of the mouse, of the focus and the like are recognised, so that they are no keys, and passed over.

use crate::tui::keymap::Key;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// How long a sequence may wait for its next byte: so long a lone Esc is held back.
const GAP: Duration = Duration::from_millis(50);
/// How long a sequence may take as a whole.
const WHOLE: Duration = Duration::from_millis(500);
/// How long a paste may wait for its next byte.
const GAP_IN_PASTE: Duration = Duration::from_secs(1);
/// Bytes of a sequence that are kept; no key has as many.
const LONGEST: usize = 64;
/// Bytes of a paste that are kept: more than any field takes.
const LONGEST_PASTE: usize = 1 << 16;

const ESC: u8 = 0x1b;
const BELL: u8 = 0x07;
const CTRL_C: u8 = 0x03;
const END_OF_PASTE: &[u8] = b"\x1b[201~";

/// What was typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Typed {
    /// A key.
    Key(Key),
    /// A text that the terminal says is pasted.
    Paste(String),
}

/// Bytes on their way to keys.
#[derive(Debug, Default)]
pub struct Decoder {
    typed: VecDeque<Typed>,
    /// The bytes of a sequence that is not finished.
    pending: Vec<u8>,
    paste: Option<Paste>,
    /// When the first and the last byte came of what is not finished.
    came: Option<(Instant, Instant)>,
}

/// A paste that is not finished.
#[derive(Debug, Default)]
struct Paste {
    bytes: Vec<u8>,
    /// How many bytes of [`END_OF_PASTE`] came last.
    of_end: usize,
}

/// What the bytes from an Esc or a text's first byte on are.
#[derive(Debug, PartialEq, Eq)]
enum Found {
    /// Not finished.
    Unfinished,
    /// A key.
    Key(Key),
    /// Finished, and no key of ours.
    Nothing,
    /// The beginning of a paste.
    Paste,
    /// The last byte does not belong to it.
    Broken,
}

impl Decoder {
    /// Takes `bytes` that came at `now`.
    pub fn feed(&mut self, bytes: &[u8], now: Instant) {
        self.expire(now);
        for &byte in bytes {
            if !self.is_waiting() {
                self.came = Some((now, now));
            }
            self.take(byte);
        }
        let first = self.came.map_or(now, |(first, _)| first);
        self.came = self.is_waiting().then_some((first, now));
    }

    /// What was typed next, of what is finished.
    pub fn take_typed(&mut self) -> Option<Typed> {
        self.typed.pop_front()
    }

    /// How many keys and pastes are finished and not taken yet.
    pub fn ready(&self) -> usize {
        self.typed.len()
    }

    /// When what is not finished is given up, if there is such a thing.
    pub fn deadline(&self) -> Option<Instant> {
        let (first, last) = self.came?;
        match self.paste {
            Some(_) => Some(last + GAP_IN_PASTE),
            None => Some((last + GAP).min(first + WHOLE)),
        }
    }

    /// Gives up what has waited too long at `now`.
    pub fn expire(&mut self, now: Instant) {
        if self.deadline().is_none_or(|deadline| now < deadline) {
            return;
        }
        self.came = None;
        match self.paste.take() {
            Some(paste) => self.end_paste(&paste),
            None => self.give_up(),
        }
    }

    fn is_waiting(&self) -> bool {
        !self.pending.is_empty() || self.paste.is_some()
    }

    fn take(&mut self, byte: u8) {
        if let Some(paste) = self.paste.take() {
            return self.take_pasted(paste, byte);
        }
        if self.pending.len() >= LONGEST && is_body(&self.pending, byte) {
            return;
        }
        self.pending.push(byte);
        match found(&self.pending) {
            Found::Unfinished => return,
            Found::Key(key) => self.typed.push_back(Typed::Key(key)),
            Found::Nothing => {}
            Found::Paste => self.paste = Some(Paste::default()),
            Found::Broken => {
                self.pending.pop();
                if self.pending.is_empty() {
                    return; // a byte that begins nothing
                }
                self.give_up();
                return self.take(byte);
            }
        }
        self.pending.clear();
    }

    /// Gives up the sequence that is not finished. Esc, and Esc and one more key, may have been typed; what is longer,
    /// no hand has typed so fast.
    fn give_up(&mut self) {
        let keys: &[u8] = match self.pending.as_slice() {
            [ESC] => &[ESC],
            [ESC, other] if other.is_ascii_graphic() => &[ESC, *other],
            _ => &[],
        };
        let keys = keys.iter().copied().map(|byte| Typed::Key(key_of(byte)));
        self.typed.extend(keys);
        self.pending.clear();
    }

    fn take_pasted(&mut self, mut paste: Paste, byte: u8) {
        if byte == CTRL_C {
            // No terminal pastes it: it is a key, after a paste whose end got lost.
            return self.typed.push_back(Typed::Key(key_of(byte)));
        }
        if byte == END_OF_PASTE[paste.of_end] {
            paste.of_end += 1;
            if paste.of_end == END_OF_PASTE.len() {
                return self.end_paste(&paste);
            }
        } else {
            let no_end = &END_OF_PASTE[..paste.of_end];
            if paste.bytes.len() < LONGEST_PASTE {
                paste.bytes.extend_from_slice(no_end);
            }
            paste.of_end = usize::from(byte == ESC);
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

/// Whether `byte` goes on with the inside of the long sequence `pending`, and can be left out.
fn is_body(pending: &[u8], byte: u8) -> bool {
    match pending {
        [ESC, b'[', ..] => (0x20..0x40).contains(&byte),
        [.., last] => *last != ESC && byte >= 0x20,
        [] => false,
    }
}

fn found(bytes: &[u8]) -> Found {
    match bytes {
        [ESC, rest @ ..] => after_escape(rest),
        [byte @ 0..0x80] => Found::Key(key_of(*byte)),
        bytes => character(bytes),
    }
}

/// A character of more than one byte.
fn character(bytes: &[u8]) -> Found {
    let length = match bytes.first() {
        Some(0xc2..=0xdf) => 2,
        Some(0xe0..=0xef) => 3,
        Some(0xf0..=0xf4) => 4,
        _ => return Found::Broken,
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => text
            .chars()
            .next()
            .map_or(Found::Nothing, |c| Found::Key(Key::Char(c))),
        Err(error) if error.error_len().is_none() && bytes.len() < length => Found::Unfinished,
        Err(_) => Found::Broken,
    }
}

/// What a single byte means.
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

fn after_escape(rest: &[u8]) -> Found {
    match rest {
        [] | [b'O' | b'['] => Found::Unfinished,
        [b'O', letter @ 0x20..0x7f] => known(lettered(*letter, 1)),
        [b'[', rest @ ..] => control_sequence(rest),
        [b'P' | b']' | b'^' | b'_' | b'X', rest @ ..] => string(rest),
        _ => Found::Broken, // Alt and a key look like Esc and a key, and are taken as that
    }
}

fn known(key: Option<Key>) -> Found {
    key.map_or(Found::Nothing, Found::Key)
}

/// A string with which a terminal answers what nobody asked: it ends with `ESC \` or a bell.
fn string(rest: &[u8]) -> Found {
    match rest {
        [.., CTRL_C] => Found::Broken,
        [.., BELL] | [.., ESC, b'\\'] => Found::Nothing,
        [.., ESC, _] => Found::Broken,
        _ => Found::Unfinished,
    }
}

/// The bytes after `ESC [`: parameters, then a last byte from `@` to `~`.
fn control_sequence(rest: &[u8]) -> Found {
    match rest {
        [.., 0..0x20] => Found::Broken,
        // The Linux console's F1 to F5, and an old way to report the mouse: both go on after what looks like an end.
        [] | [b'['] | [b'M'] | [b'M', _] | [b'M', _, _] => Found::Unfinished,
        [b'[', _] | [b'M', ..] => Found::Nothing,
        [.., 0x20..0x40] => Found::Unfinished,
        [parameters @ .., last @ 0x40..0x7f] => meaning(parameters, *last),
        _ => Found::Broken,
    }
}

/// What the whole control sequence means.
fn meaning(parameters: &[u8], last: u8) -> Found {
    let text = std::str::from_utf8(parameters).unwrap_or("?");
    // A number may have parts of its own behind a colon.
    let number = |text: &str| text.split(':').next().and_then(|text| text.parse().ok());
    let mut numbers = text.split(';').map(number);
    let first: Option<u32> = numbers.next().flatten();
    let modifiers = numbers.next().flatten().unwrap_or(1);
    match (first, last) {
        (Some(200), b'~') => Found::Paste,
        (Some(number), b'~') => known(numbered(number)),
        (Some(code), b'u') => known(coded(code, modifiers)),
        (None, _) if !text.is_empty() => Found::Nothing, // the mouse, and other reports
        (_, letter) => known(lettered(letter, modifiers)),
    }
}

fn has_shift(modifiers: u32) -> bool {
    modifiers.saturating_sub(1) & 1 != 0
}

fn has_control(modifiers: u32) -> bool {
    modifiers.saturating_sub(1) & 4 != 0
}

fn lettered(letter: u8, modifiers: u32) -> Option<Key> {
    let shift = has_shift(modifiers);
    Some(match letter {
        b'A' if shift => Key::ShiftUp,
        b'B' if shift => Key::ShiftDown,
        b'C' if shift => Key::ShiftRight,
        b'D' if shift => Key::ShiftLeft,
        b'A' => Key::Up,
        b'B' => Key::Down,
        b'C' => Key::Right,
        b'D' => Key::Left,
        b'H' => Key::Home,
        b'F' => Key::End,
        b'Z' => Key::BackTab,
        // rxvt with Shift.
        b'a' => Key::ShiftUp,
        b'b' => Key::ShiftDown,
        b'c' => Key::ShiftRight,
        b'd' => Key::ShiftLeft,
        _ => return None,
    })
}

fn numbered(number: u32) -> Option<Key> {
    Some(match number {
        1 | 7 => Key::Home,
        4 | 8 => Key::End,
        3 => Key::Delete,
        5 => Key::PageUp,
        6 => Key::PageDown,
        _ => return None,
    })
}

/// A key by its code point, as some terminals send those that have modifiers.
fn coded(code: u32, modifiers: u32) -> Option<Key> {
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What `pieces` say, each as it comes with a moment between.
    fn typed(pieces: &[&[u8]]) -> Vec<Typed> {
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        for (piece, number) in pieces.iter().zip(0..) {
            decoder.feed(piece, begin + Duration::from_millis(number));
        }
        all(&mut decoder)
    }

    fn all(decoder: &mut Decoder) -> Vec<Typed> {
        std::iter::from_fn(|| decoder.take_typed()).collect()
    }

    fn keys(keys: &[Key]) -> Vec<Typed> {
        keys.iter().copied().map(Typed::Key).collect()
    }

    #[test]
    fn every_key_is_known_however_its_sequence_comes_apart() {
        use Key::*;
        let cases: &[(&str, Key)] = &[
            ("a", Char('a')),
            (" ", Char(' ')),
            ("ü", Char('ü')),
            ("速", Char('速')),
            ("🎡", Char('🎡')),
            ("\r", Enter),
            ("\n", Ctrl('j')),
            ("\t", Tab),
            ("\u{7f}", Backspace),
            ("\u{8}", Ctrl('h')),
            ("\u{3}", Ctrl('c')),
            ("\u{1a}", Ctrl('z')),
            ("\0", Ctrl(' ')),
            ("\u{1b}[A", Up),
            ("\u{1b}[B", Down),
            ("\u{1b}[C", Right),
            ("\u{1b}[D", Left),
            ("\u{1b}OA", Up),
            ("\u{1b}OH", Home),
            ("\u{1b}OF", End),
            ("\u{1b}[H", Home),
            ("\u{1b}[F", End),
            ("\u{1b}[1~", Home),
            ("\u{1b}[4~", End),
            ("\u{1b}[7~", Home),
            ("\u{1b}[8~", End),
            ("\u{1b}[3~", Delete),
            ("\u{1b}[5~", PageUp),
            ("\u{1b}[6~", PageDown),
            ("\u{1b}[5;5~", PageUp),
            ("\u{1b}[Z", BackTab),
            ("\u{1b}[1;2A", ShiftUp),
            ("\u{1b}[1;2B", ShiftDown),
            ("\u{1b}[1;2C", ShiftRight),
            ("\u{1b}[1;2D", ShiftLeft),
            ("\u{1b}[1;5C", Right),
            ("\u{1b}[1;6C", ShiftRight),
            ("\u{1b}[1;2:1C", ShiftRight),
            ("\u{1b}[a", ShiftUp),
            ("\u{1b}[99;5u", Ctrl('c')),
            ("\u{1b}[27u", Esc),
            ("\u{1b}[9;2u", BackTab),
            ("\u{1b}[13;5u", Enter),
            ("\u{1b}[252u", Char('ü')),
        ];
        for (text, key) in cases {
            let bytes = text.as_bytes();
            assert_eq!(typed(&[bytes]), keys(&[*key]), "{text:?}");
            let pieces: Vec<_> = bytes.chunks(1).collect();
            assert_eq!(typed(&pieces), keys(&[*key]), "{text:?} byte by byte");
            let twice = [bytes, bytes, b"x"].concat();
            assert_eq!(typed(&[&twice]), keys(&[*key, *key, Char('x')]), "{text:?}");
        }
    }

    #[test]
    fn what_is_no_key_is_passed_over_as_a_whole() {
        for text in [
            "\u{1b}[<0;10;20M",
            "\u{1b}[<35;10;20m",
            "\u{1b}[M !!",
            "\u{1b}[[A",
            "\u{1b}[I",
            "\u{1b}[O",
            "\u{1b}[24;80R",
            "\u{1b}[?62;4c",
            "\u{1b}[?2026;2$y",
            "\u{1b}[15~",
            "\u{1b}[201~",
            "\u{1b}OP",
            "\u{1b}]11;rgb:0000/0000/0000\u{1b}\\",
            "\u{1b}]0;a title\u{7}",
            "\u{1b}P>|a terminal\u{1b}\\",
        ] {
            let with_key = format!("{text}x");
            assert_eq!(
                typed(&[with_key.as_bytes()]),
                keys(&[Key::Char('x')]),
                "{text:?}"
            );
        }
        for garbage in [
            &b"\xff\x80\xc3x"[..],
            b"\xe9\x80x",
            b"\xf4\x90\x80\x80x",
            b"\xc0x",
        ] {
            assert_eq!(typed(&[garbage]), keys(&[Key::Char('x')]), "{garbage:?}");
        }
    }

    #[test]
    fn escape_is_a_key_after_a_moment_and_loses_none_that_follows() {
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        decoder.feed(b"\x1b", begin);
        assert_eq!(
            (decoder.ready(), decoder.deadline()),
            (0, Some(begin + GAP))
        );
        decoder.expire(begin + GAP / 2);
        assert_eq!(decoder.ready(), 0);
        decoder.expire(begin + GAP);
        assert_eq!(all(&mut decoder), keys(&[Key::Esc]));
        assert_eq!(decoder.deadline(), None);
        // A sequence that comes too late is no sequence.
        decoder.feed(b"\x1b", begin);
        decoder.feed(b"[A", begin + 2 * GAP);
        assert_eq!(
            all(&mut decoder),
            keys(&[Key::Esc, Key::Char('['), Key::Char('A')])
        );
        assert_eq!(typed(&[b"\x1bq"]), keys(&[Key::Esc, Key::Char('q')]));
        assert_eq!(typed(&[b"\x1b\x1b[A"]), keys(&[Key::Esc, Key::Up]));
        assert_eq!(typed(&[b"\x1b\x03"]), keys(&[Key::Esc, Key::Ctrl('c')]));
        assert_eq!(
            typed(&["\u{1b}ü".as_bytes()]),
            keys(&[Key::Esc, Key::Char('ü')])
        );
        decoder.feed(b"\x1bP", begin);
        decoder.expire(begin + GAP);
        assert_eq!(all(&mut decoder), keys(&[Key::Esc, Key::Char('P')]));
    }

    #[test]
    fn a_sequence_without_an_end_is_given_up() {
        for begun in [
            "\u{1b}[",
            "\u{1b}[<",
            "\u{1b}[<1;2",
            "\u{1b}]0;a",
            "\u{1b}P",
            "\u{1b}O",
        ] {
            let begun_bytes = begun.as_bytes();
            let both = [begun_bytes, b"\x03"].concat();
            let ends = |typed: &[Typed]| typed.last() == Some(&Typed::Key(Key::Ctrl('c')));
            assert!(ends(&typed(&[&both])), "{begun:?}");
            let (mut decoder, begin) = (Decoder::default(), Instant::now());
            decoder.feed(begun_bytes, begin);
            decoder.expire(begin + GAP);
            all(&mut decoder);
            decoder.feed(b"x", begin + GAP);
            assert_eq!(all(&mut decoder), keys(&[Key::Char('x')]), "{begun:?}");
        }
        // Nor do keys that are held down keep it alive for ever.
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        decoder.feed(b"\x1b]", begin);
        for number in 1..100 {
            decoder.feed(b"j", begin + GAP / 2 * number);
        }
        assert!(decoder.ready() > 70, "{}", decoder.ready());
    }

    #[test]
    fn the_time_of_a_sequence_is_its_own() {
        // Every piece ends within a sequence: none of them waits longer than a moment.
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        decoder.feed(b"\x1b[", begin);
        for number in 1..=100 {
            decoder.feed(b"A\x1b[", begin + GAP / 2 * number);
        }
        assert_eq!(all(&mut decoder), keys(&[Key::Up; 100]));
    }

    #[test]
    fn a_long_sequence_takes_no_room() {
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        for long in ["\u{1b}[<", "\u{1b}]0;"] {
            decoder.feed(long.as_bytes(), begin);
            decoder.feed(&b"1".repeat(1 << 20), begin);
            assert!(decoder.pending.len() <= LONGEST + 2);
            decoder.feed(b"\x1b\\", begin);
            all(&mut decoder);
        }
    }

    #[test]
    fn a_paste_comes_as_one() {
        let paste = |text: &str| vec![Typed::Paste(text.to_owned())];
        let text = "\u{1b}[200~a ü\u{1b}[20q\u{1b}\u{1b}[201~";
        assert_eq!(typed(&[text.as_bytes()]), paste("a ü\u{1b}[20q\u{1b}"));
        let pieces: Vec<_> = text.as_bytes().chunks(1).collect();
        assert_eq!(typed(&pieces), paste("a ü\u{1b}[20q\u{1b}"));
        let unfinished = b"\x1b[200~a\x03";
        assert_eq!(typed(&[unfinished]), keys(&[Key::Ctrl('c')]));
        let (mut decoder, begin) = (Decoder::default(), Instant::now());
        decoder.feed(b"\x1b[200~", begin);
        decoder.feed(&b"1".repeat(1 << 20), begin);
        decoder.expire(begin + GAP);
        assert_eq!(decoder.ready(), 0);
        decoder.expire(begin + GAP_IN_PASTE);
        assert_eq!(all(&mut decoder), paste(&"1".repeat(LONGEST_PASTE)));
    }

    proptest! {
        #[test]
        fn no_bytes_break_it_and_it_always_comes_back(
            pieces in prop::collection::vec(prop::collection::vec(
                prop_oneof![any::<u8>(), prop::sample::select(b"\x1b[O<MP]~;0123".to_vec())], 0..40), 0..20)
        ) {
            let (mut decoder, mut now) = (Decoder::default(), Instant::now());
            for piece in pieces {
                decoder.feed(&piece, now);
                now += Duration::from_millis(7);
            }
            now += GAP_IN_PASTE;
            decoder.expire(now);
            prop_assert_eq!(decoder.deadline(), None);
            while decoder.take_typed().is_some() {}
            decoder.feed(b"x", now);
            prop_assert_eq!(decoder.take_typed(), Some(Typed::Key(Key::Char('x'))));
        }
    }
}
