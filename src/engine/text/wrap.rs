//! Text in lines of a width, in columns of a terminal: a Chinese or Japanese character takes two.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};
use unicode_width::UnicodeWidthStr;

pub fn columns(text: &str) -> usize {
    text.width()
}

/// `text` in lines of at most `width` columns, broken between words; a word wider than that, or a text of a script without
/// spaces, is broken where the line ends. An empty text is one empty line.
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
    fn japanese_keeps_its_end() {
        let text = "速い独楽は倒れずにゆっくりと首を振り、その円は時間の刻みによらない。";
        let lines = wrapped(text, 20);
        assert!(lines.iter().all(|line| columns(line) <= 20), "{lines:?}");
        assert_eq!(lines.concat(), text);
    }
}
