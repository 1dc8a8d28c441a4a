//! The table of letters: outlines, advances and kerning of the font STIX Two Text, regular and italic.
//!
//! `make.py` made the data files in this folder and describes their format. Copyright and license, the SIL Open Font
//! License, are in `OFL.txt`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::plot::scene::at;
use crate::plot::scene::{Point, Segment, VectorPath};

/// Size of a letter in the tables: lengths are in thousandths of it.
pub const UNITS_PER_EM: f64 = 1000.0;

/// A letter. Lengths are in thousandths of its size, y down from the baseline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Letter {
    /// Distance from its origin to the next letter's origin.
    pub advance: f64,
    pub outline: VectorPath,
}

#[derive(Default)]
pub struct FontStyle {
    lines: BTreeMap<u32, &'static str>,
    /// The kerning classes of letters on the left and on the right of a pair.
    classes: [BTreeMap<u32, u32>; 2],
    kerning: BTreeMap<(u32, u32), f64>,
}

pub static REGULAR: LazyLock<FontStyle> = LazyLock::new(|| {
    FontStyle::new(
        include_str!("regular.txt"),
        include_str!("regular.kern.txt"),
    )
});
/// Italic letters, as for the names of quantities.
pub static ITALIC: LazyLock<FontStyle> =
    LazyLock::new(|| FontStyle::new(include_str!("italic.txt"), include_str!("italic.kern.txt")));

impl FontStyle {
    fn new(letters: &'static str, kerning: &str) -> Self {
        let mut style = Self {
            lines: letters.lines().filter_map(numbered).collect(),
            ..Self::default()
        };
        let mut counts = [0; 2];
        for line in kerning.lines() {
            let (word, members) = line.split_once(' ').unwrap_or_default();
            let side = ["left", "right"].iter().position(|side| *side == word);
            if let Some(side) = side {
                let classed = codes(members).map(|code| (code, counts[side]));
                style.classes[side].extend(classed);
                counts[side] += 1;
            } else {
                style.kerning.extend(kerned(line));
            }
        }
        style
    }

    /// Returns the letter, if this style has it.
    pub fn letter(&self, letter: char) -> Option<Letter> {
        self.numbered(letter.into())
    }

    /// Returns the shift of the right letter of a pair to the right, in thousandths of their size; 0 for most pairs.
    pub fn kerning(&self, left: char, right: char) -> f64 {
        let [lefts, rights] = &self.classes;
        let classes = lefts.get(&left.into()).zip(rights.get(&right.into()));
        let kerning = classes.and_then(|(before, after)| self.kerning.get(&(*before, *after)));
        kerning.copied().unwrap_or(0.0)
    }

    fn numbered(&self, code: u32) -> Option<Letter> {
        let line = self.lines.get(&code)?;
        let (advance, outline) = line.split_once(' ').unwrap_or((line, ""));
        let outline = if outline.starts_with('+') {
            self.put_together(outline)?
        } else {
            read_outline(outline)?
        };
        Some(Letter {
            advance: advance.parse().ok()?,
            outline,
        })
    }

    /// Composes the outline of a letter from other letters, each given as `+CODE,RIGHT,UP`.
    fn put_together(&self, parts: &str) -> Option<VectorPath> {
        let mut whole = VectorPath::default();
        for part in parts.split(' ') {
            let mut fields = part.strip_prefix('+')?.split(',');
            let code = u32::from_str_radix(fields.next()?, 16).ok()?;
            let right: f64 = fields.next()?.parse().ok()?;
            let up: f64 = fields.next()?.parse().ok()?;
            let outline = self.numbered(code)?.outline;
            whole
                .0
                .extend(outline.mapped(|p| at(p.x + right, p.y - up)).0);
        }
        Some(whole)
    }
}

/// Splits a line into its first field, a hexadecimal number, and the rest.
fn numbered(line: &str) -> Option<(u32, &str)> {
    let (code, rest) = line.split_once(' ')?;
    Some((u32::from_str_radix(code, 16).ok()?, rest))
}

fn codes(members: &str) -> impl Iterator<Item = u32> {
    members
        .split(' ')
        .filter_map(|code| u32::from_str_radix(code, 16).ok())
}

/// Parses a line `LEFT RIGHT THOUSANDTHS`.
fn kerned(line: &str) -> Option<((u32, u32), f64)> {
    let mut fields = line.split(' ');
    let pair = (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    Some((pair, fields.next()?.parse().ok()?))
}

/// Parses SVG path data with the commands m, l, h, v, q and z, y up. Returns `None` if it is invalid.
fn read_outline(data: &str) -> Option<VectorPath> {
    let mut numbers = PackedIntegers(data);
    let mut path = VectorPath::default();
    let (mut here, mut start) = (at(0.0, 0.0), at(0.0, 0.0));
    let mut command = ' ';
    while let Some(next) = numbers.0.chars().next() {
        if next.is_ascii_alphabetic() {
            command = next;
            numbers.0 = &numbers.0[1..];
        }
        let segment = match command {
            'm' => Segment::Move(numbers.point(here)?),
            'l' => Segment::Line(numbers.point(here)?),
            'h' => Segment::Line(at(here.x + numbers.next()?, here.y)),
            'v' => Segment::Line(at(here.x, here.y - numbers.next()?)),
            'q' => Segment::Quadratic(numbers.point(here)?, numbers.point(here)?),
            'z' => Segment::Close,
            _ => return None,
        };
        here = segment.end().unwrap_or(start);
        if let Segment::Move(to) = segment {
            start = to;
        }
        if segment == Segment::Close {
            // A number after z would be parsed as another z, forever.
            command = ' ';
        }
        path.0.push(segment);
    }
    Some(path)
}

/// Whole numbers, separated by a blank or by the minus sign of the next number.
struct PackedIntegers<'a>(&'a str);

impl PackedIntegers<'_> {
    fn next(&mut self) -> Option<f64> {
        let text = self.0.trim_start_matches(' ');
        let digits = text.strip_prefix('-').unwrap_or(text);
        let sign = text.len() - digits.len();
        let end = digits
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(digits.len());
        let (number, rest) = text.split_at(sign + end);
        self.0 = rest;
        number.parse().ok()
    }

    /// Parses a point relative to `here`, y up.
    fn point(&mut self, here: Point) -> Option<Point> {
        let (right, up) = (self.next()?, self.next()?);
        Some(at(here.x + right, here.y - up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_table_is_a_letter() {
        for (style, least) in [(&*REGULAR, 780), (&*ITALIC, 740)] {
            assert!(style.lines.len() > least, "{}", style.lines.len());
            for code in style.lines.keys() {
                let letter = style.numbered(*code).unwrap_or_else(|| panic!("{code:X}"));
                assert!((0.0..2600.0).contains(&letter.advance), "{code:X}");
                let is_blank = char::from_u32(*code).is_some_and(char::is_whitespace);
                assert_eq!(letter.outline.0.is_empty(), is_blank, "{code:X}");
            }
        }
    }

    #[test]
    fn outlines_are_parsed_like_svg_paths() {
        let path = read_outline("m1 2l3-4 1 1h-5v6q1 1-2 0zm9 9").unwrap();
        let expected = vec![
            Segment::Move(at(1.0, -2.0)),
            Segment::Line(at(4.0, 2.0)),
            Segment::Line(at(5.0, 1.0)),
            Segment::Line(at(0.0, 1.0)),
            Segment::Line(at(0.0, -5.0)),
            Segment::Quadratic(at(1.0, -6.0), at(-2.0, -5.0)),
            Segment::Close,
            Segment::Move(at(10.0, -11.0)),
        ];
        assert_eq!(path.0, expected);
        for broken in ["m1", "x", "m1 2z3", "1 2"] {
            assert_eq!(read_outline(broken), None, "{broken}");
        }
    }

    #[test]
    fn kerning_is_applied_to_listed_pairs() {
        assert!(REGULAR.kerning('A', 'V') < -50.0);
        assert!(ITALIC.kerning('A', 'V') < -50.0);
        assert_eq!(REGULAR.kerning('H', 'H'), 0.0);
        assert_eq!(REGULAR.kerning('→', '\u{10ffff}'), 0.0);
    }
}
