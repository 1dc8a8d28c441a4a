//! Sets letters in a line: kerning, scripts, and the space after an italic letter.

use super::SetLabel;
use super::table::{self, ITALIC, REGULAR, UNITS_PER_EM};
use crate::plot::scene::PlacedLetter;
use crate::plot::scene::VectorPath;
use crate::plot::scene::at;

/// Size of a subscript or superscript, relative to its text.
const SCRIPT: f64 = 0.7;
/// Distance of a subscript's baseline below the text's baseline, relative to the text's size.
const SUBSCRIPT_DROP: f64 = 0.18;
/// Distance of a superscript's baseline above the text's baseline, relative to the text's size.
const SUPERSCRIPT_RISE: f64 = 0.36;
/// Advance of the box that replaces a missing letter, in thousandths of the size.
pub const BOX: f64 = 600.0;

/// A subscript or superscript that has begun and not yet ended.
struct RaisedText {
    is_above: bool,
    /// Start of the script, and end of the text before it, pt.
    began_pt: f64,
    behind_pt: f64,
    /// Length of `words` before the script.
    words_before: usize,
    /// Size and baseline of the surrounding text, pt.
    outer_size_pt: f64,
    outer_baseline_pt: f64,
}

/// The previous letter, if it is in the same line as the next one.
struct PrecedingLetter {
    letter: char,
    is_italic: bool,
    /// Distance of its ink beyond its advance, pt.
    overhang_pt: f64,
}

#[derive(Default)]
pub struct Setter {
    label: SetLabel,
    /// Start of the next letter, pt.
    x_pt: f64,
    size_pt: f64,
    /// Current baseline, below the baseline of the whole label, pt.
    baseline_pt: f64,
    pub is_italic: bool,
    scripts: Vec<RaisedText>,
    before: Option<PrecedingLetter>,
    /// The script that has just ended. A script on the other side of the line starts at the same position.
    ended: Option<RaisedText>,
}

impl Setter {
    pub fn new(size_pt: f64) -> Self {
        Self {
            size_pt,
            ..Self::default()
        }
    }

    /// Returns the space between the previous letter and the next one, pt.
    fn gap(&mut self, style: &table::FontStyle, letter: char) -> f64 {
        match self.before.take() {
            Some(before) if before.is_italic == self.is_italic => {
                self.size_pt / UNITS_PER_EM * style.kerning(before.letter, letter)
            }
            Some(before) if !letter.is_whitespace() => before.overhang_pt,
            _ => 0.0,
        }
    }

    /// Sets a letter, or a box if the table does not have it.
    pub fn letter(&mut self, letter: char) {
        let style = if self.is_italic { &*ITALIC } else { &*REGULAR };
        let slanted = ITALIC.letter(letter).filter(|_| self.is_italic);
        let is_italic = slanted.is_some();
        let drawn = slanted
            .or_else(|| REGULAR.letter(letter))
            .unwrap_or_else(missing);
        let scale = self.size_pt / UNITS_PER_EM;
        self.x_pt += self.gap(style, letter);
        let origin = at(self.x_pt, self.baseline_pt);
        let outline = drawn
            .outline
            .mapped(|p| at(origin.x + p.x * scale, origin.y + p.y * scale));
        self.x_pt += drawn.advance * scale;
        let mut right_pt = self.x_pt;
        for point in outline.points() {
            self.label.ascent_pt = self.label.ascent_pt.max(-point.y);
            self.label.descent_pt = self.label.descent_pt.max(point.y);
            right_pt = right_pt.max(point.x);
        }
        let is_slanted = f64::from(u8::from(self.is_italic));
        self.before = Some(PrecedingLetter {
            letter,
            is_italic: self.is_italic,
            overhang_pt: is_slanted * (right_pt - self.x_pt),
        });
        self.ended = None;
        self.label.path.0.extend(outline.0);
        self.label.words.push(letter);
        self.label.letters.push(PlacedLetter {
            letter,
            is_italic,
            origin,
            size_pt: self.size_pt,
        });
    }

    pub fn is_in_script(&self) -> bool {
        !self.scripts.is_empty()
    }

    /// Starts a smaller script above or below the line.
    pub fn begin_script(&mut self, is_above: bool) {
        let overhang_pt = self.before.take().map_or(0.0, |before| before.overhang_pt);
        let (began_pt, behind_pt) = match self.ended.take() {
            Some(other) if other.is_above != is_above => (other.began_pt, self.x_pt),
            _ if is_above => (self.x_pt + overhang_pt, self.x_pt),
            _ => (self.x_pt, self.x_pt),
        };
        self.x_pt = began_pt;
        self.scripts.push(RaisedText {
            is_above,
            began_pt,
            behind_pt,
            words_before: self.label.words.len(),
            outer_size_pt: self.size_pt,
            outer_baseline_pt: self.baseline_pt,
        });
        self.baseline_pt += self.size_pt
            * if is_above {
                -SUPERSCRIPT_RISE
            } else {
                SUBSCRIPT_DROP
            };
        self.size_pt *= SCRIPT;
    }

    /// Returns to the line around the script.
    pub fn end_script(&mut self) {
        let Some(script) = self.scripts.pop() else {
            return;
        };
        self.x_pt = self.x_pt.max(script.behind_pt);
        (self.size_pt, self.baseline_pt) = (script.outer_size_pt, script.outer_baseline_pt);
        let words = self.label.words.split_off(script.words_before);
        self.label.words += &script_words(&words, script.is_above);
        self.before = None;
        self.ended = Some(script);
    }

    /// Ends all open scripts and returns the label.
    pub fn finish(mut self) -> SetLabel {
        while !self.scripts.is_empty() {
            self.end_script();
        }
        let overhang_pt = self.before.map_or(0.0, |before| before.overhang_pt);
        SetLabel {
            width_pt: self.x_pt + overhang_pt,
            ..self.label
        }
    }
}

/// Returns an upright box, drawn as a frame: the inner contour runs opposite to the outer one.
pub fn missing() -> table::Letter {
    let outer = [
        at(70.0, 0.0),
        at(530.0, 0.0),
        at(530.0, -656.0),
        at(70.0, -656.0),
    ];
    let inner = [
        at(110.0, -40.0),
        at(110.0, -616.0),
        at(490.0, -616.0),
        at(490.0, -40.0),
    ];
    let mut outline = VectorPath::polygon(outer);
    outline.0.extend(VectorPath::polygon(inner).0);
    table::Letter {
        advance: BOX,
        outline,
    }
}

/// Writes a script in a line of plain text: `⁻³`, `₂`, `_p`, `^(a+b)`.
fn script_words(words: &str, is_above: bool) -> String {
    let characters: Option<String> = words
        .chars()
        .map(|c| script_character(c, is_above))
        .collect();
    let sign = if is_above { '^' } else { '_' };
    characters.unwrap_or_else(|| match words.chars().nth(1) {
        None => format!("{sign}{words}"),
        Some(_) => format!("{sign}({words})"),
    })
}

/// Returns the superscript or subscript character for a digit or sign.
fn script_character(c: char, is_above: bool) -> Option<char> {
    let above = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁻";
    let below = "₀₁₂₃₄₅₆₇₈₉₊₋₋";
    let place = "0123456789+-\u{2212}"
        .chars()
        .position(|known| known == c)?;
    (if is_above { above } else { below }).chars().nth(place)
}
