//! Writes a page as PDF 1.4: paths and words, without external fonts, a date or an identifier.

mod words;

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};

use super::scene::{at, hundredths};
use super::svg::MITER_LIMIT;
use super::{Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, VectorPath};
use crate::engine::text::printable::printable;
use words::Fonts;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFORMATION: Ref = Ref::new(5);
const PDF_COMPRESSION: u8 = 9;

/// Writes a page whose coordinates are whole hundredths of a point. `version` is the program's version; the page's
/// title becomes the file's title.
pub fn written(scene: &PageScene, version: &str) -> Vec<u8> {
    let fonts = Fonts::from_scene(scene);
    let mut pdf = Pdf::new();
    // Every pdflatex includes this version without a warning.
    pdf.set_version(1, 4);
    pdf.catalog(CATALOG).pages(PAGES);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut page = pdf.page(PAGE);
    let sheet = Rect::new(0.0, 0.0, scene.width_pt as f32, scene.height_pt as f32);
    page.media_box(sheet).parent(PAGES).contents(CONTENT);
    fonts.name_in(&mut page.resources());
    page.finish();
    let content = packed(&content(scene, &fonts));
    pdf.stream(CONTENT, &content).filter(Filter::FlateDecode);
    fonts.write(&mut pdf, packed);
    let mut information = pdf.document_info(INFORMATION);
    information.title(TextStr(&printable(&scene.title)));
    information.producer(TextStr(&format!("gyrolab {}", printable(version))));
    information.finish();
    pdf.finish()
}

fn content(scene: &PageScene, fonts: &Fonts) -> Vec<u8> {
    let mut content = Content::new();
    // Moves the origin to the upper left corner, y down.
    content.transform([1.0, 0.0, 0.0, -1.0, 0.0, scene.height_pt as f32]);
    content.set_miter_limit(MITER_LIMIT as f32);
    for group in scene.groups() {
        put_group(&mut content, group, fonts);
    }
    content.finish().into_vec()
}

/// Writes items with the same paint and clip rectangle.
fn put_group(content: &mut Content, items: &[SceneItem], fonts: &Fonts) {
    let Some(first) = items.first() else {
        return;
    };
    content.save_state();
    if let Some([from, to]) = first.clip {
        let (width, height) = (to.x - from.x, to.y - from.y);
        content.rect(from.x as f32, from.y as f32, width as f32, height as f32);
        content.clip_nonzero().end_path();
    }
    put_color(content, &first.paint);
    if let Paint::Stroke(pen) = &first.paint {
        put_pen(content, pen);
    }
    for item in items {
        if let Some(words) = &item.words {
            // Plain text for reading aloud and copying: the letters alone do not show which of them are superscripts.
            let mut span = content.begin_marked_content_with_properties(Name(b"Span"));
            let text = printable(&words.text);
            span.properties().actual_text(TextStr(&text));
            drop(span);
            fonts.put(words, content);
            content.end_marked_content();
            continue;
        }
        put_path(content, &item.path);
        match item.paint {
            Paint::Fill(_) => content.fill_nonzero(),
            Paint::Stroke(_) => content.stroke(),
        };
    }
    content.restore_state();
}

fn put_color(content: &mut Content, paint: &Paint) {
    let color = paint.color();
    let [red, green, blue] = shares(color);
    match (paint, color.is_grey()) {
        (Paint::Fill(_), true) => content.set_fill_gray(red),
        (Paint::Fill(_), false) => content.set_fill_rgb(red, green, blue),
        (Paint::Stroke(_), true) => content.set_stroke_gray(red),
        (Paint::Stroke(_), false) => content.set_stroke_rgb(red, green, blue),
    };
}

fn put_pen(content: &mut Content, pen: &StrokeStyle) {
    content.set_line_width(pen.width_pt as f32);
    if !pen.dash_pt.is_empty() {
        content.set_dash_pattern(pen.dash_pt.iter().map(|length| *length as f32), 0.0);
    }
    if pen.is_round {
        content.set_line_join(LineJoinStyle::RoundJoin);
    }
    if pen.has_round_ends() {
        content.set_line_cap(LineCapStyle::RoundCap);
    }
}

/// Returns red, green and blue as fractions of white, rounded to thousandths, which is enough for 256 levels.
fn shares(Color(parts): Color) -> [f32; 3] {
    parts.map(|part| (libm::round(f64::from(part) / 0.255) / 1000.0) as f32)
}

fn put_path(content: &mut Content, path: &VectorPath) {
    let mut at = at(0.0, 0.0);
    for segment in &path.0 {
        match *segment {
            Segment::Move(to) => content.move_to(to.x as f32, to.y as f32),
            Segment::Line(to) => content.line_to(to.x as f32, to.y as f32),
            Segment::Quadratic(control, to) => put_cubic(
                content,
                [two_thirds(at, control), two_thirds(to, control), to],
            ),
            Segment::Cubic(first, second, to) => put_cubic(content, [first, second, to]),
            Segment::Close => content.close_path(),
        };
        at = segment.end().unwrap_or(at);
    }
}

fn put_cubic(content: &mut Content, points: [Point; 3]) -> &mut Content {
    let [a, b, to] = points.map(|p| (p.x as f32, p.y as f32));
    content.cubic_to(a.0, a.1, b.0, b.1, to.0, to.1)
}

/// Returns a control point, in hundredths, of the cubic curve that equals the parabola with this `control` point.
fn two_thirds(end: Point, control: Point) -> Point {
    at(
        hundredths(end.x + (control.x - end.x) * 2.0 / 3.0),
        hundredths(end.y + (control.y - end.y) * 2.0 / 3.0),
    )
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, PDF_COMPRESSION)
}
