//! Creates a TrueType font with only the letters of a page, for a file whose text can be searched and copied.
//!
//! Source: Microsoft, OpenType specification 1.9: otff, head, hhea, hmtx, maxp, loca, glyf.

use super::setter::missing;
use super::table::{FontStyle, Letter, UNITS_PER_EM};
use crate::plot::{Point, Segment};
use std::collections::BTreeSet;

/// A font with some letters. Glyph 0 is the box for missing letters; the letters follow in the order of their codes.
pub struct Font {
    letters: Vec<char>,
    glyphs: Vec<Glyph>,
}

/// Coordinates x, y, and true if the point is on the outline.
type ContourPoint = (i16, i16, bool);

/// A letter in the units of the font, y up.
struct Glyph {
    advance: u16,
    /// The contours, without a repeated first point at the end.
    contours: Vec<Vec<ContourPoint>>,
    /// Bounding box: left, bottom, right, top.
    bounds: [i16; 4],
}

impl Font {
    pub fn subset(style: &FontStyle, letters: &BTreeSet<char>) -> Self {
        let known = letters
            .iter()
            .filter_map(|&letter| Some((letter, style.letter(letter)?)));
        let (drawn_letters, mut glyphs): (Vec<_>, Vec<_>) = known
            .map(|(letter, drawn)| (letter, Glyph::from_letter(&drawn)))
            .unzip();
        glyphs.insert(0, Glyph::from_letter(&missing()));
        Self {
            letters: drawn_letters,
            glyphs,
        }
    }

    /// Returns the glyph number of a letter; 0 if the font does not have it.
    pub fn glyph(&self, letter: char) -> u16 {
        let place = self.letters.binary_search(&letter);
        place.map_or(0, |place| place as u16 + 1)
    }

    pub fn letters(&self) -> impl Iterator<Item = (u16, char)> + '_ {
        (1..).zip(self.letters.iter().copied())
    }

    /// Returns the advance of each glyph, in thousandths of the size.
    pub fn advances(&self) -> impl Iterator<Item = f32> + '_ {
        self.glyphs.iter().map(|glyph| f32::from(glyph.advance))
    }

    /// Returns the bounding box of all letters (left, bottom, right, top), in thousandths of the size.
    pub fn bounds(&self) -> [i16; 4] {
        let all = self.glyphs.iter().map(|glyph| glyph.bounds);
        all.fold([0; 4], |[left, low, right, high], b| {
            let (left, low) = (left.min(b[0]), low.min(b[1]));
            [left, low, right.max(b[2]), high.max(b[3])]
        })
    }

    pub fn file(&self) -> Vec<u8> {
        let (mut outlines, mut places) = (Vec::new(), Vec::new());
        for glyph in &self.glyphs {
            places.extend((outlines.len() as u32).to_be_bytes());
            glyph.write(&mut outlines);
        }
        places.extend((outlines.len() as u32).to_be_bytes());
        let widths = self.glyphs.iter().flat_map(|glyph| {
            let left = glyph.bounds[0].to_be_bytes();
            [glyph.advance.to_be_bytes(), left].concat()
        });
        // Sorted by name, as the specification requires.
        file([
            (*b"glyf", outlines),
            (*b"head", self.head()),
            (*b"hhea", self.hhea()),
            (*b"hmtx", widths.collect()),
            (*b"loca", places),
            (*b"maxp", self.maxp()),
        ])
    }

    fn head(&self) -> Vec<u8> {
        shorts(&[
            &[1, 0], // version
            &[1, 0], // revision of the font
            &[0, 0], // the checksum of the file, which is not needed in an embedded font
            &[0x5F0F, 0x3CF5],
            &[0b11], // the baseline is at 0, and letters begin at 0
            &[UNITS_PER_EM as u16],
            &[0; 8], // dates
            &self.bounds().map(|bound| bound as u16),
            &[0, 6],    // no style; legible from 6 dots
            &[2, 1, 0], // left to right; long offsets; the only outline format
        ])
    }

    fn hhea(&self) -> Vec<u8> {
        let [left, low, right, high] = self.bounds().map(|bound| bound as u16);
        let widest = self.glyphs.iter().map(|glyph| glyph.advance).max();
        shorts(&[
            &[1, 0, high, low, 0, widest.unwrap_or(0), left, 0, right, 1],
            &[0; 7], // upright cursor at 0; reserved fields
            &[self.glyphs.len() as u16],
        ])
    }

    fn maxp(&self) -> Vec<u8> {
        let contours = self.glyphs.iter().map(|glyph| glyph.contours.len());
        let points = self
            .glyphs
            .iter()
            .map(|glyph| glyph.contours.iter().map(Vec::len).sum::<usize>());
        let count = self.glyphs.len() as u16;
        // No composite letters, no instructions.
        shorts(&[
            &[
                1,
                0,
                count,
                points.max().unwrap_or(0) as u16,
                contours.max().unwrap_or(0) as u16,
                0,
                0,
                2,
            ],
            &[0; 8],
        ])
    }
}

fn shorts(parts: &[&[u16]]) -> Vec<u8> {
    let numbers = parts.iter().copied().flatten();
    numbers.flat_map(|number| number.to_be_bytes()).collect()
}

fn contour_point(p: Point, is_on: bool) -> ContourPoint {
    (p.x as i16, -p.y as i16, is_on)
}

impl Glyph {
    fn from_letter(letter: &Letter) -> Self {
        let mut contours: Vec<Vec<ContourPoint>> = Vec::new();
        for segment in &letter.outline.0 {
            if let Segment::Move(_) = segment {
                contours.push(Vec::new());
            }
            let contour = contours.last_mut().into_iter();
            let points = match *segment {
                Segment::Move(to) | Segment::Line(to) => vec![contour_point(to, true)],
                Segment::Quadratic(control, to) => {
                    vec![contour_point(control, false), contour_point(to, true)]
                }
                // The table has no cubic curves, and contours close automatically.
                Segment::Cubic(..) | Segment::Close => vec![],
            };
            contour.for_each(|contour| contour.extend(&points));
        }
        for contour in &mut contours {
            if contour.len() > 1 && contour.first() == contour.last() {
                contour.pop();
            }
        }
        let sides: [fn(&ContourPoint) -> i16; 2] = [|p| p.0, |p| p.1];
        let [(left, right), (low, high)] = sides.map(|side| {
            let places = contours.iter().flatten().map(side);
            (places.clone().min().unwrap_or(0), places.max().unwrap_or(0))
        });
        Self {
            advance: letter.advance as u16,
            bounds: [left, low, right, high],
            contours,
        }
    }

    /// Appends the glyph to the table of outlines. A blank has no outline.
    fn write(&self, table: &mut Vec<u8>) {
        if self.contours.is_empty() {
            return;
        }
        table.extend((self.contours.len() as i16).to_be_bytes());
        table.extend(self.bounds.into_iter().flat_map(i16::to_be_bytes));
        let mut count = 0;
        for contour in &self.contours {
            count += contour.len() as u16;
            table.extend((count - 1).to_be_bytes());
        }
        table.extend([0, 0]); // no instructions
        let points = self.contours.iter().flatten();
        table.extend(points.clone().map(|point| u8::from(point.2)));
        let sides: [fn(&ContourPoint) -> i16; 2] = [|p| p.0, |p| p.1];
        for side in sides {
            let mut before = 0;
            for place in points.clone().map(side) {
                table.extend((place - before).to_be_bytes());
                before = place;
            }
        }
        table.resize(table.len().next_multiple_of(4), 0);
    }
}

fn file<const N: usize>(tables: [([u8; 4], Vec<u8>); N]) -> Vec<u8> {
    let largest = N.ilog2() as u16; // exponent of the largest power of two up to N
    let range = 16 << largest;
    let mut file = 0x0001_0000_u32.to_be_bytes().to_vec();
    let counts = [N as u16, range, largest, 16 * N as u16 - range];
    file.extend(counts.into_iter().flat_map(u16::to_be_bytes));
    let mut place = 12 + 16 * N;
    for (name, table) in &tables {
        file.extend(name);
        let numbers = [sum(table), place as u32, table.len() as u32];
        file.extend(numbers.into_iter().flat_map(u32::to_be_bytes));
        place += table.len().next_multiple_of(4);
    }
    for (_, mut table) in tables {
        table.resize(table.len().next_multiple_of(4), 0);
        file.extend(table);
    }
    file
}

/// Returns the checksum of a table: the sum of its four-byte numbers.
fn sum(table: &[u8]) -> u32 {
    table.chunks(4).fold(0, |sum: u32, chunk| {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        sum.wrapping_add(u32::from_be_bytes(word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::extent;
    use crate::plot::letters::table::REGULAR;

    /// Returns the tables of a font file with their names.
    fn tables(file: &[u8]) -> Vec<(String, &[u8])> {
        let word = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        let count = usize::from(file[5]);
        let entry = |number: usize| {
            let at = 12 + 16 * number;
            let name = String::from_utf8_lossy(&file[at..at + 4]).into_owned();
            let table = &file[word(at + 8)..][..word(at + 12)];
            assert_eq!(sum(table) as usize, word(at + 4), "{name}");
            (name, table)
        };
        (0..count).map(entry).collect()
    }

    #[test]
    fn a_font_subset_has_exactly_its_letters_and_the_box() {
        let font = Font::subset(&REGULAR, &"Äo 速".chars().collect());
        assert_eq!(
            ["Ä", "o", " ", "速"].map(|c| font.glyph(c.chars().next().unwrap())),
            [3, 2, 1, 0]
        );
        let file = font.file();
        let tables = tables(&file);
        let names: Vec<_> = tables.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["glyf", "head", "hhea", "hmtx", "loca", "maxp"]);
        let sizes: Vec<_> = tables.iter().map(|(_, table)| table.len()).collect();
        assert_eq!(sizes[1..], [54, 36, 4 * 4, 4 * 5, 32]);
        let (glyphs, places) = (tables[0].1, tables[4].1);
        let places: Vec<usize> = places
            .chunks(4)
            .map(|place| u32::from_be_bytes(place.try_into().unwrap()) as usize)
            .collect();
        assert_eq!((places[0], places[4]), (0, glyphs.len()));
        assert_eq!(places[1], places[2], "a blank has no outline");
        // The letter with two dots has a separate contour for each dot.
        assert_eq!([0, 2, 3].map(|glyph| glyphs[places[glyph] + 1]), [2, 2, 4]);
    }

    #[test]
    fn glyph_outlines_equal_those_of_the_table() {
        let drawn = REGULAR.letter('g').unwrap();
        let glyph = Glyph::from_letter(&drawn);
        let [left, low, right, high] = glyph.bounds;
        let points = || drawn.outline.points();
        let (x, y) = (
            extent(points().map(|p| p.x)),
            extent(points().map(|p| -p.y)),
        );
        assert_eq!(x, Some((left.into(), right.into())));
        assert_eq!(y, Some((low.into(), high.into())));
        assert_eq!(f64::from(glyph.advance), drawn.advance);
        assert!(glyph.contours.iter().all(|contour| contour[0].2));
    }
}
