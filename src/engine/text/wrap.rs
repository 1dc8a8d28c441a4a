//! Wraps text to a width in columns of a terminal. A Chinese or Japanese character takes two columns.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};
use unicode_width::UnicodeWidthStr;

pub fn columns(text: &str) -> usize {
    text.width()
}

/// Wraps `text` into lines of at most `width` columns, broken between words. A wider word, or a text in a script
/// without spaces, is broken at the end of the line. An empty text gives one empty line.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let joined = words.join(" ");
    let options = Options::new(width.max(1))
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .wrap_algorithm(WrapAlgorithm::FirstFit);
    let lines = textwrap::wrap(&joined, options);
    lines.into_iter().map(Into::into).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        let lines = wrapped("a fast  top\nsleeps", 6);
        assert_eq!(lines, ["a fast", "top", "sleeps"]);
        assert_eq!(wrapped("", 6), [""]);
        assert_eq!(wrapped("half-turn", 6), ["half-t", "urn"]);
    }

    #[test]
    fn japanese_text_wraps_without_loss() {
        let text = "速い独楽は倒れずにゆっくりと首を振り、その円は時間の刻みによらない。";
        let lines = wrapped(text, 20);
        assert!(lines.iter().all(|line| columns(line) <= 20), "{lines:?}");
        assert_eq!(lines.concat(), text);
    }
}
