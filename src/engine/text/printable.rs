//! Makes text safe to print. A name or message can then neither control the terminal that shows it, nor look like
//! another one.
//!
//! All text for the screen that does not come from the program itself passes through here: arguments, names of files,
//! users and machines, and values in files.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

/// Returns true if `c` is a control character, changes the direction of text, ends a line, or is invisible. A text with
/// such a character does not look like its contents.
///
/// Variation selectors (U+FE00 to U+FE0F) choose between pictures of the character before them, and are allowed.
pub fn is_steering(c: char) -> bool {
    let bidirectional = matches!(c,
        '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let line_separator = matches!(c, '\u{2028}' | '\u{2029}');
    let invisible = matches!(c,
        '\u{00ad}' | '\u{034f}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200d}' | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}'
        | '\u{fff0}'..='\u{fffb}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
        | '\u{e0000}'..='\u{e0fff}');
    c.is_control() || bidirectional || line_separator || invisible
}

/// Returns `text` on one line, with steering characters replaced by escapes such as `\u{1b}` and `\n`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, |_| false)
}

/// Returns `text` with its line ends, and with all other steering characters replaced by escapes.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c == '\n')
}

fn escaped(text: &str, is_allowed: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_safe = |c: char| !is_steering(c) || is_allowed(c);
    if text.chars().all(is_safe) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_safe(c) {
            safe.push(c);
        } else {
            safe.extend(c.escape_default());
        }
    }
    Cow::Owned(safe)
}

/// A path for printing: [`printable`], and with U+FFFD for bytes that are not text.
#[derive(Clone, Copy, Debug)]
pub struct PrintablePath<'a>(pub &'a Path);

impl fmt::Display for PrintablePath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&printable(&self.0.to_string_lossy()))
    }
}

/// Returns `text` made printable and cut to at most `most` characters, because a message must stay readable.
pub fn brief(text: &str, most: usize) -> String {
    let end = text.char_indices().nth(most).map(|(at, _)| at);
    let beginning = &text[..end.unwrap_or(text.len())];
    let rest = if end.is_some() { "..." } else { "" };
    printable(beginning).into_owned() + rest
}

/// Escapes `text` for an XML element or an attribute in double quotes. Characters that XML cannot contain are written
/// as escapes or become U+FFFD.
pub fn xml(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in printable(text).chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printable_text_has_no_steering_or_hidden_characters() {
        let nasty = "a\u{1b}]0;x\u{7}b\u{202e}c\rd\u{9b}e\u{200b}\u{2028}\u{feff}\u{e0041}\u{7f}\n";
        for safe in [
            printable(nasty).into_owned(),
            brief(nasty, 80),
            PrintablePath(Path::new(nasty)).to_string(),
        ] {
            assert!(!safe.chars().any(is_steering), "{safe}");
        }
        let lines = printable_lines(nasty);
        assert!(lines.chars().all(|c| c == '\n' || !is_steering(c)));
        assert!(lines.ends_with("\\u{7f}\n"), "{lines}");
    }

    #[test]
    fn ordinary_text_is_unchanged() {
        for text in "Kreisel, 3 µm|速い独楽|Ω = I⁻¹L|e\u{301}|\u{2600}\u{fe0f}".split('|')
        {
            assert_eq!(printable(text), text);
            assert_eq!(brief(text, 80), text);
        }
    }

    #[test]
    fn shortened_text_ends_with_dots() {
        assert_eq!(brief("abcdef", 3), "abc...");
        assert_eq!(brief("abc", 3), "abc");
        assert_eq!(brief("\n\nc", 2), "\\n\\n...");
    }
}
