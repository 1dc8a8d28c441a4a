//! Text as outlines, from a table of letters in the program. Figures look the same without an installed font, and their
//! files refer to no font.
//!
//! Labels use a small markup: `*t* (s)` has an italic t, `10^{-3}` a superscript and `*Ω*_{p}` a subscript. Pass text
//! from users through [`escape`]. A hyphen stays a hyphen; for a minus sign, write U+2212.

pub mod font;
mod setter;
pub mod table;
mod user;

use self::setter::Setter;
pub use self::user::markup;
use super::scene::{PlacedLetter, VectorPath};
use crate::engine::text::printable::printable;

/// Height of capital letters and digits, relative to the font size.
pub const CAP_HEIGHT: f64 = 0.656;

/// Texts are cut to this number of characters before they are measured: no page is that wide.
const LONGEST_LABEL: usize = 2000;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetLabel {
    /// Outline to be filled by the non-zero rule, pt. The origin is the left end of the baseline, y down.
    pub path: VectorPath,
    /// Distance from the origin to the start of a following text, pt.
    pub width_pt: f64,
    pub ascent_pt: f64,
    pub descent_pt: f64,
    /// The text without markup: superscripts as characters or after `^`, subscripts after `_`.
    pub words: String,
    pub letters: Vec<PlacedLetter>,
}

/// Converts markup to outlines. A character that is not in the table is drawn as a box. Unclosed markup ends with the
/// text; an unmatched brace is drawn as a brace.
pub fn label(markup: &str, size_pt: f64) -> SetLabel {
    let mut setter = Setter::new(size_pt);
    let mut rest = markup.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\\' => setter.letter(rest.next().unwrap_or('\\')),
            '*' => setter.is_italic = !setter.is_italic,
            '_' | '^' if rest.next_if_eq(&'{').is_some() => setter.begin_script(c == '^'),
            '}' if setter.is_in_script() => setter.end_script(),
            _ => setter.letter(c),
        }
    }
    setter.finish()
}

/// Escapes a text so that none of it is markup, and spells out control characters.
pub fn escape(text: &str) -> String {
    let mut markup = String::with_capacity(text.len());
    for c in printable(text).chars() {
        if matches!(c, '\\' | '*' | '_' | '^' | '{' | '}') {
            markup.push('\\');
        }
        markup.push(c);
    }
    markup
}

/// Escapes a text, and cuts it with "…" if it is wider than `width_pt`.
pub fn shortened(text: &str, size_pt: f64, width_pt: f64) -> String {
    cut(text, size_pt, width_pt, escape)
}

/// Converts the [markup of a user](markup), and cuts the text with "…" if it is wider than `width_pt`.
pub fn marked(text: &str, size_pt: f64, width_pt: f64) -> String {
    cut(text, size_pt, width_pt, markup)
}

/// Converts the longest beginning of `text` that is not wider than `width_pt`, with "…" if some of it is missing.
fn cut(text: &str, size_pt: f64, width_pt: f64, convert: fn(&str) -> String) -> String {
    let letters: Vec<char> = text.chars().take(LONGEST_LABEL + 1).collect();
    let beginning = |length: usize| {
        let dots = if length < letters.len() { "…" } else { "" };
        convert(&letters[..length].iter().collect::<String>()) + dots
    };
    let whole = beginning(letters.len());
    if letters.len() <= LONGEST_LABEL && label(&whole, size_pt).width_pt <= width_pt {
        return whole;
    }
    let lengths: Vec<usize> = (1..letters.len()).collect();
    let longest =
        lengths.partition_point(|length| label(&beginning(*length), size_pt).width_pt <= width_pt);
    beginning(longest)
}

#[cfg(test)]
mod tests {
    use super::setter::{BOX, missing};
    use super::table::{ITALIC, REGULAR};
    use super::*;

    /// Advance of each digit.
    const DIGIT: f64 = 495.0;

    /// In thousandths of the size, without the last digits of its sums.
    fn width(markup: &str) -> f64 {
        libm::round(label(markup, 1000.0).width_pt * 1e6) / 1e6
    }

    #[test]
    fn widths_follow_the_font_and_scripts() {
        let (a, v) = (width("A"), width("V"));
        let f = ITALIC.letter('f').unwrap().advance;
        for (markup, expected) in [
            ("", 0.0),
            ("0", DIGIT),
            ("00", 2.0 * DIGIT),
            ("Δ", REGULAR.letter('Δ').unwrap().advance),
            ("HH", 2.0 * width("H")),
            ("AV", a + v + REGULAR.kerning('A', 'V')),
            ("0^{0}", DIGIT * 1.7),
            // Both begin behind the letter.
            ("0_{00}^{0}", DIGIT * 2.4),
            ("0^{0}_{00}0", DIGIT * 3.4),
            // Two of one kind follow one another.
            ("0^{0}^{0}", DIGIT * 2.4),
            ("*f*_{0}", f + 0.7 * DIGIT),
        ] {
            assert_eq!(width(markup), expected, "{markup}");
        }
        assert_eq!(label("0", 8.0).width_pt, DIGIT * 8.0 / 1000.0);
        assert!(width("AV") < a + v - 50.0);
        let (mixed, apart) = (width("*A*V"), width("*A*") + v);
        assert!(mixed >= apart, "no kerning from one style to another");
    }

    #[test]
    fn scripts_are_smaller_and_raised_or_lowered() {
        let size = 1000.0;
        let (plain, above, below) = (label("H", size), label("H^{H}", size), label("H_{H}", size));
        assert!((above.ascent_pt - (360.0 + 0.7 * plain.ascent_pt)).abs() < 1e-9);
        assert!((below.descent_pt - 180.0).abs() < 1e-9);
        assert_eq!((plain.descent_pt, above.descent_pt), (0.0, 0.0));
        assert!((plain.ascent_pt / size - CAP_HEIGHT).abs() < 0.003);
    }

    #[test]
    fn slanted_letters_do_not_touch_the_next_letter() {
        let f = ITALIC.letter('f').unwrap();
        assert!(width("*f*") > f.advance, "its end is among its width");
        assert!(width("*f*)") > f.advance + width(")"));
        assert!(width("*f*^{0}") > width("*f*_{0}"));
    }

    #[test]
    fn the_plain_text_of_a_label_has_no_markup() {
        for (markup, words) in [
            ("*t* (10^{3} s)", "t (10³ s)"),
            ("*Ω*_{p} (rad s^{−1})", "Ω_p (rad s⁻¹)"),
            ("*x*_{12}^{a+b}", "x₁₂^(a+b)"),
            ("a\\*b\\_{c\\}", "a*b_{c}"),
            ("a_b^c}d\\", "a_b^c}d\\"),
            ("open^{2", "open²"),
        ] {
            assert_eq!(label(markup, 8.0).words, words, "{markup}");
        }
    }

    #[test]
    fn an_escaped_text_has_no_markup() {
        let words = |text: &str| label(&escape(text), 8.0).words;
        for text in ["*a*", "x_{1}^{2}", "\\", "\\*", "}{", "速い独楽 🌀"] {
            assert_eq!(words(text), text);
        }
        let signs = "50 % * 3 < 4 & \"q\"";
        assert_eq!(words(signs), signs);
        assert_eq!(words("a\nb\u{1b}[0m"), "a\\nb\\u{1b}[0m");
    }

    #[test]
    fn unknown_characters_are_drawn_as_a_box() {
        for text in ["速", "🌀", "\u{7}", "\u{e000}", "\u{10ffff}"] {
            for markup in [text.to_owned(), format!("*{text}*")] {
                let drawn = label(&markup, 1000.0);
                assert_eq!(drawn.path, missing().outline, "{text:?}");
                assert_eq!(drawn.width_pt, BOX);
            }
        }
    }

    #[test]
    fn every_letter_used_in_figures_exists() {
        let needed = "0123456789−–—-+±×·°′″‴µΩωθφψΔαβγλτσΣπ→←↑↓≤≥≈≠√∞∝⊥∥‘’“”„‚«»…%‰§†‡•½ⁿ⁻¹₀₉\
                      ÄÖÜäöüßÉéèêëàâçñøåæœŒŠšŽžŁłŘřĞğİıȘșȚțĐđẞŐőŰűẽếữỲДЖяЇґЄ€№ℓℏ′";
        for letter in needed.chars() {
            assert!(REGULAR.letter(letter).is_some(), "{letter}");
            let slanted = label(&format!("*{letter}*"), 1000.0).path;
            assert_ne!(slanted, missing().outline, "{letter}");
        }
    }

    #[test]
    fn a_long_text_is_shortened_to_fit() {
        assert_eq!(shortened("short *", 7.0, 100.0), "short \\*");
        for length in [200, 2000, 100_000] {
            let markup = shortened(&"wide_".repeat(length), 7.0, 100.0);
            assert!(markup.ends_with('…'));
            let width_pt = label(&markup, 7.0).width_pt;
            assert!((85.0..=100.0).contains(&width_pt), "{width_pt}");
        }
        assert_eq!(shortened("nothing fits", 7.0, 0.0), "…");
        let endless = shortened(&"i".repeat(10 * LONGEST_LABEL), 7.0, f64::INFINITY);
        assert!(endless.ends_with('…'));
    }
}
