//! Writes a page as SVG 1.1 with paths only: no fonts, scripts or style sheets. On request, text is written as text.

use std::fmt::Write; // cannot fail on a `String`

use super::scene::{TextAnchor, TextItem};
use super::{Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, VectorPath};
use crate::engine::text::printable::xml;
use crate::plot::PT_PER_MM;

/// Maximum length of a sharp corner, relative to half the line width: the default of SVG.
pub const MITER_LIMIT: f64 = 4.0;

/// Writes a page whose coordinates are whole hundredths of a point. The words of a text are its label for screen
/// readers; with `has_text` they are written as text.
pub fn written(scene: &PageScene, has_text: bool) -> String {
    let mut out = String::new();
    let (width, height) = (number(scene.width_pt), number(scene.height_pt));
    let sides_mm = [scene.width_pt, scene.height_pt].map(|pt| number(pt / PT_PER_MM));
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {width} {height}\" role=\"img\">",
        sides_mm[0], sides_mm[1]
    );
    let _ = writeln!(out, "<title>{}</title>", xml(&scene.title));
    let _ = writeln!(out, "<path fill=\"#fff\" d=\"M0 0h{width}v{height}H0z\"/>");
    for clip in clips(scene) {
        let id = name(&clip);
        let [left, top, right, bottom] = [clip[0].x, clip[0].y, clip[1].x, clip[1].y].map(number);
        let _ = writeln!(
            out,
            "<clipPath id=\"{id}\"><path d=\"M{left} {top}H{right}V{bottom}H{left}z\"/></clipPath>"
        );
    }
    for group in scene.groups() {
        put_group(&mut out, group, has_text);
    }
    out += "</svg>\n";
    out
}

/// Returns the clip rectangles, each once.
fn clips(scene: &PageScene) -> Vec<[Point; 2]> {
    let mut clips: Vec<[Point; 2]> = Vec::new();
    for clip in scene.items.iter().filter_map(|item| item.clip) {
        if !clips.contains(&clip) {
            clips.push(clip);
        }
    }
    clips
}

/// Names a clip rectangle by its coordinates, so that equal names mean the same rectangle if two figures are put into
/// one document.
fn name(clip: &[Point; 2]) -> String {
    let parts = clip.iter().flat_map(|p| [p.x, p.y]).map(number);
    format!("clip_{}", parts.collect::<Vec<_>>().join("_"))
}

/// Writes items with the same paint and clip rectangle.
fn put_group(out: &mut String, items: &[SceneItem], has_text: bool) {
    let Some(first) = items.first() else {
        return;
    };
    *out += "<g";
    if let Some(clip) = &first.clip {
        let _ = write!(out, " clip-path=\"url(#{})\"", name(clip));
    }
    match &first.paint {
        Paint::Fill(color) => *out += &format!(" fill=\"{}\"", hex(*color)),
        Paint::Stroke(pen) => put_pen(out, pen),
    }
    *out += ">\n";
    for item in items {
        if let Some(words) = item.words.as_ref().filter(|_| has_text) {
            put_text(out, words);
            continue;
        }
        *out += "<path";
        if let Some(words) = &item.words {
            let words = xml(&words.text);
            let _ = write!(out, " role=\"img\" aria-label=\"{words}\"");
        }
        let _ = writeln!(out, " d=\"{}\"/>", data(&item.path));
    }
    *out += "</g>\n";
}

/// Fonts for text; the first is the font of the outlines.
const SVG_TEXT_FONTS: &str =
    "STIX Two Text,STIXTwoText,Times New Roman,Times,Liberation Serif,serif";

/// Writes words as text, aligned as on the page: the reader's fonts may be wider or narrower than the outlines. Parts of one
/// style follow each other; a script is shifted across the line.
fn put_text(out: &mut String, words: &TextItem) {
    let Point { x, y } = words.place;
    let ((x, y), turned) = if words.is_upward {
        ((-y, x), " transform=\"rotate(-90)\"")
    } else {
        ((x, y), "")
    };
    let anchor = match words.anchor {
        TextAnchor::Start => "",
        TextAnchor::Middle => " text-anchor=\"middle\"",
        TextAnchor::End => " text-anchor=\"end\"",
    };
    let (x, baseline) = (number(x), number(y));
    let _ = write!(
        out,
        "<text xml:space=\"preserve\" x=\"{x}\" y=\"{baseline}\" font-family=\"{SVG_TEXT_FONTS}\"{anchor}{turned}>"
    );
    let mut line = hundredths(y);
    for part in words.letters.chunk_by(|a, b| {
        let [a_line, b_line] = [a, b].map(|it| hundredths(it.along_and_across(words.is_upward).1));
        (a.is_italic, a.size_pt, a_line) == (b.is_italic, b.size_pt, b_line)
    }) {
        let own = hundredths(part[0].along_and_across(words.is_upward).1);
        let shift = match own - std::mem::replace(&mut line, own) {
            0 => String::new(),
            shift => format!(" dy=\"{}\"", number(shift as f64 / 100.0)),
        };
        let size = number(part[0].size_pt);
        let style = if part[0].is_italic {
            " font-style=\"italic\""
        } else {
            ""
        };
        let text: String = part.iter().map(|placed| placed.letter).collect();
        let text = xml(&text);
        let _ = write!(
            out,
            "<tspan font-size=\"{size}\"{shift}{style}>{text}</tspan>"
        );
    }
    *out += "</text>\n";
}

fn put_pen(out: &mut String, pen: &StrokeStyle) {
    let (color, width) = (hex(pen.color), number(pen.width_pt));
    let _ = write!(
        out,
        " fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\""
    );
    if !pen.dash_pt.is_empty() {
        let lengths: Vec<String> = pen.dash_pt.iter().copied().map(number).collect();
        let _ = write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "));
    }
    if pen.is_round {
        *out += " stroke-linejoin=\"round\"";
    }
    if pen.has_round_ends() {
        *out += " stroke-linecap=\"round\"";
    }
}

/// Writes the data of a path. Each line starts at an absolute position and continues in relative steps, which are
/// shorter numbers.
fn data(path: &VectorPath) -> String {
    let mut data = PathData::default();
    for segment in &path.0 {
        match *segment {
            Segment::Move(to) => {
                data.at = [0, 0];
                data.step('M', &[to], &[0, 1]);
                data.start = data.at;
            }
            Segment::Line(to) if hundredths(to.y) == data.at[1] => data.step('h', &[to], &[0]),
            Segment::Line(to) if hundredths(to.x) == data.at[0] => data.step('v', &[to], &[1]),
            Segment::Line(to) => data.step('l', &[to], &[0, 1]),
            Segment::Quadratic(control, to) => data.step('q', &[control, to], &[0, 1]),
            Segment::Cubic(first, second, to) => data.step('c', &[first, second, to], &[0, 1]),
            Segment::Close => {
                data.step('z', &[], &[]);
                data.at = data.start;
            }
        }
    }
    data.text
}

#[derive(Default)]
struct PathData {
    text: String,
    /// The last command, which is implied if only numbers follow.
    command: char,
    /// Current position and start of the current line, in hundredths.
    at: [i64; 2],
    start: [i64; 2],
}

impl PathData {
    /// Writes a command with the relative coordinates of `points`, the last of which becomes the current position.
    /// `axes` lists the coordinates that the command needs: x (0) and y (1).
    fn step(&mut self, command: char, points: &[Point], axes: &[usize]) {
        if command != self.command || axes.is_empty() || command == 'M' {
            self.text.push(command);
            self.command = command;
        }
        let from = self.at;
        for point in points {
            self.at = [hundredths(point.x), hundredths(point.y)];
            for &axis in axes {
                let step = number((self.at[axis] - from[axis]) as f64 / 100.0);
                // A blank separates two numbers that would otherwise run together.
                if self.text.ends_with(|c: char| c.is_ascii_digit()) && !step.starts_with('-') {
                    self.text.push(' ');
                }
                self.text += &step;
            }
        }
    }
}

fn hundredths(pt: f64) -> i64 {
    libm::round(pt * 100.0) as i64
}

/// Formats a number with at most two decimals, as short as possible: `12.5`, `-.25`, `0`.
fn number(value: f64) -> String {
    let cents = hundredths(value);
    let (whole, rest) = (cents.abs() / 100, cents.abs() % 100);
    let sign = if cents < 0 { "-" } else { "" };
    match rest {
        0 => format!("{sign}{whole}"),
        _ => sign.to_owned() + format!("{whole}.{rest:02}").trim_matches('0'),
    }
}

/// Formats a color as `#rgb` if possible, else as `#rrggbb`.
fn hex(Color([red, green, blue]): Color) -> String {
    if [red, green, blue].iter().all(|part| part % 17 == 0) {
        format!("#{:x}{:x}{:x}", red / 17, green / 17, blue / 17)
    } else {
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}
