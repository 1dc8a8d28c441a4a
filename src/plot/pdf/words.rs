//! Writes the words of a page as text that can be searched and copied, in embedded fonts that contain only the letters
//! of the page.

use crate::plot::letters::CAP_HEIGHT;
use crate::plot::letters::font::Font;
use crate::plot::letters::table::{ITALIC, REGULAR};
use crate::plot::scene::PlacedLetter;
use crate::plot::scene::{PageScene, TextItem};
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::writers::Resources;
use pdf_writer::{Content, Filter, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeSet;

/// The first object number of the first font, and the number of objects per font.
const FIRST_FONT_OBJECT: i32 = 6;
const OBJECTS: i32 = 5;
/// Lengths that differ by less than this are equal, in thousandths of the font size.
const SAME_LENGTH: f64 = 0.5;
/// Angle of the italic letters, degrees, as in the original font.
const SLANT_DEG: f32 = -14.0;

pub struct Fonts([OfPage; 2]);

struct OfPage {
    /// `None` if the page has no letter in this style.
    font: Option<Font>,
    /// The names of the font on the page and in the file.
    names: (&'static [u8], String),
    is_italic: bool,
}

impl Fonts {
    pub fn from_scene(scene: &PageScene) -> Self {
        Self([false, true].map(|is_italic| {
            let letters: BTreeSet<char> = scene
                .items
                .iter()
                .filter_map(|item| item.words.as_ref())
                .flat_map(|words| &words.letters)
                .filter(|letter| letter.is_italic == is_italic)
                .map(|letter| letter.letter)
                .collect();
            let (style, name, end) = if is_italic {
                (&*ITALIC, &b"I"[..], "Italic")
            } else {
                (&*REGULAR, &b"R"[..], "Regular")
            };
            OfPage {
                names: (name, format!("{}+STIXTwoText-{end}", tag(&letters))),
                font: (!letters.is_empty()).then(|| Font::subset(style, &letters)),
                is_italic,
            }
        }))
    }

    fn used(&self) -> impl Iterator<Item = (Ref, &OfPage, &Font)> {
        let fonts = (FIRST_FONT_OBJECT..).step_by(OBJECTS as usize).zip(&self.0);
        fonts
            .filter_map(|(first, of_page)| Some((Ref::new(first), of_page, of_page.font.as_ref()?)))
    }

    /// Adds the names of the fonts to the page's resources.
    pub fn name_in(&self, resources: &mut Resources<'_>) {
        let mut names = resources.fonts();
        for (id, of_page, _) in self.used() {
            names.pair(Name(of_page.names.0), id);
        }
    }

    pub fn write(&self, pdf: &mut Pdf, packed: impl Fn(&[u8]) -> Vec<u8>) {
        for (id, of_page, font) in self.used() {
            of_page.write(id, font, pdf, &packed);
        }
    }

    /// Writes `words` at their position. y points down.
    pub fn put(&self, words: &TextItem, content: &mut Content) {
        content.begin_text();
        for line in words
            .letters
            .chunk_by(|a: &PlacedLetter, b: &PlacedLetter| {
                let [a_line, b_line] = [a, b].map(|it| it.along_and_across(words.is_upward).1);
                (a.is_italic, a.size_pt, a_line) == (b.is_italic, b.size_pt, b_line)
            })
        {
            self.put_line(line, words.is_upward, content);
        }
        content.end_text();
    }

    /// Writes letters of one font and size on one baseline.
    fn put_line(&self, line: &[PlacedLetter], is_upward: bool, content: &mut Content) {
        let Some(first) = line.first() else {
            return;
        };
        let of_page = &self.0[usize::from(first.is_italic)];
        let Some(font) = &of_page.font else {
            return;
        };
        let (x, y) = (first.origin.x as f32, first.origin.y as f32);
        content.set_font(Name(of_page.names.0), first.size_pt as f32);
        content.set_text_matrix(if is_upward {
            [0.0, -1.0, -1.0, 0.0, x, y]
        } else {
            [1.0, 0.0, 0.0, -1.0, x, y]
        });
        let advances: Vec<f32> = font.advances().collect();
        let mut shown = content.show_positioned();
        let mut items = shown.items();
        let mut glyphs: Vec<u8> = Vec::new();
        let (mut next, _) = first.along_and_across(is_upward);
        for letter in line {
            let (along, _) = letter.along_and_across(is_upward);
            let off = (along - next) * 1000.0 / letter.size_pt;
            if off.abs() > SAME_LENGTH {
                items.show(Str(&glyphs)).adjust(-libm::round(off) as f32);
                glyphs.clear();
                next += libm::round(off) * letter.size_pt / 1000.0;
            }
            let glyph = font.glyph(letter.letter);
            glyphs.extend(glyph.to_be_bytes());
            next += f64::from(advances[usize::from(glyph)]) * letter.size_pt / 1000.0;
        }
        items.show(Str(&glyphs));
    }
}

impl OfPage {
    fn write(&self, id: Ref, font: &Font, pdf: &mut Pdf, packed: &impl Fn(&[u8]) -> Vec<u8>) {
        let [of_glyphs, descriptor, file, letters] =
            [1, 2, 3, 4].map(|place| Ref::new(id.get() + place));
        let name = Name(self.names.1.as_bytes());
        let system = SystemInfo {
            registry: Str(b"Adobe"),
            ordering: Str(b"Identity"),
            supplement: 0,
        };
        pdf.type0_font(id)
            .base_font(name)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(of_glyphs)
            .to_unicode(letters);
        let mut glyphs = pdf.cid_font(of_glyphs);
        glyphs
            .subtype(CidFontType::Type2)
            .base_font(name)
            .system_info(system)
            .font_descriptor(descriptor)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        glyphs.widths().consecutive(0, font.advances());
        drop(glyphs);
        self.describe(descriptor, font, pdf, file);
        let bytes = font.file();
        pdf.stream(file, &packed(&bytes))
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), bytes.len() as i32);
        let mut map = UnicodeCmap::<u16>::new(Name(b"Letters"), system);
        for (glyph, letter) in font.letters() {
            map.pair(glyph, letter);
        }
        pdf.stream(letters, &packed(map.finish().as_slice()))
            .filter(Filter::FlateDecode);
    }

    fn describe(&self, descriptor: Ref, font: &Font, pdf: &mut Pdf, file: Ref) {
        let [left, low, right, high] = font.bounds().map(f32::from);
        let flags = FontFlags::SERIF | FontFlags::SYMBOLIC;
        let (flags, angle_deg) = if self.is_italic {
            (flags | FontFlags::ITALIC, SLANT_DEG)
        } else {
            (flags, 0.0)
        };
        pdf.font_descriptor(descriptor)
            .name(Name(self.names.1.as_bytes()))
            .flags(flags)
            .bbox(Rect::new(left, low, right, high))
            .italic_angle(angle_deg)
            .ascent(high)
            .descent(low)
            .cap_height(CAP_HEIGHT as f32 * 1000.0)
            .stem_v(80.0)
            .font_file2(file);
    }
}

/// Returns six capital letters that identify a subset of a font.
fn tag(letters: &BTreeSet<char>) -> String {
    // FNV-1a: Fowler, Noll and Vo.
    let mixed = letters.iter().fold(0xcbf2_9ce4_8422_2325_u64, |mixed, &c| {
        (mixed ^ u64::from(c)).wrapping_mul(0x0100_0000_01b3)
    });
    (0..6)
        .map(|place: u32| char::from(b'A' + (mixed / 26_u64.pow(place) % 26) as u8))
        .collect()
}
