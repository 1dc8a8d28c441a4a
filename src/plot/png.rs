//! Writes a page as PNG on white paper, with its print size.

use std::io::Write;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Mask, Paint as Ink, PathBuilder, Pixmap, Shader, Stroke,
    StrokeDash, Transform,
};

use super::ink::at;
use super::svg::MITER_LIMIT;
use super::{
    Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, Unwritable, VectorPath,
};
use crate::engine::text::printable::printable;

const MOST_DOTS: f64 = 1e8;
/// Maximum number of dots that are drawn together. A large picture is drawn in bands of 40 MB each.
const DOTS_OF_BAND: u32 = 8_000_000;

/// Writes a page whose coordinates are whole hundredths of a point, with this resolution.
///
/// # Errors
/// Returns an error if the picture is too large.
pub fn written(scene: &PageScene, dots_per_inch: f64) -> Result<Vec<u8>, Unwritable> {
    let [width, height] = [scene.width_pt, scene.height_pt].map(|pt| {
        libm::ceil(pt * dots_per_inch / 72.0 - 1e-6).clamp(1.0, f64::from(u32::MAX)) as u32
    });
    let written = if f64::from(width) * f64::from(height) > MOST_DOTS {
        Err("it is too large".to_owned())
    } else {
        in_bands(scene, (width, height), dots_per_inch).map_err(|error| error.to_string())
    };
    written.map_err(|reason| Unwritable::Picture {
        width,
        height,
        reason,
    })
}

/// Writes the file, in grayscale if all colors are gray.
fn in_bands(
    scene: &PageScene,
    (width, height): (u32, u32),
    dots_per_inch: f64,
) -> Result<Vec<u8>, ::png::EncodingError> {
    let is_grey = scene.items.iter().all(|item| item.paint.color().is_grey());
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, width, height);
    encoder.set_color(if is_grey {
        ::png::ColorType::Grayscale
    } else {
        ::png::ColorType::Rgb
    });
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::High);
    let dots_per_metre = libm::round(dots_per_inch / 0.0254) as u32;
    encoder.set_pixel_dims(Some(::png::PixelDimensions {
        xppu: dots_per_metre,
        yppu: dots_per_metre,
        unit: ::png::Unit::Meter,
    }));
    encoder.add_itxt_chunk("Title".to_owned(), printable(&scene.title).into_owned())?;
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer()?;
    let band = (DOTS_OF_BAND / width).max(1);
    for top in (0..height).step_by(band as usize) {
        let sheet = Pixmap::new(width, band.min(height - top))
            .ok_or(::png::EncodingError::LimitsExceeded)?;
        let sheet = drawn(scene, sheet, top, dots_per_inch);
        let parts = if is_grey { 1 } else { 3 };
        for row in sheet.data().chunks_exact(4 * width as usize) {
            let dots = row.chunks_exact(4).flat_map(|dot| &dot[..parts]);
            rows.write_all(&dots.copied().collect::<Vec<u8>>())?;
        }
    }
    rows.finish()?;
    writer.finish()?;
    Ok(file)
}

/// Draws the part of the page that starts `top` dots below its upper edge onto `sheet`.
fn drawn(scene: &PageScene, sheet: Pixmap, top: u32, dots_per_inch: f64) -> Pixmap {
    let scale = (dots_per_inch / 72.0) as f32;
    let mut easel = Easel {
        sheet,
        transform: Transform::from_row(scale, 0.0, 0.0, scale, 0.0, -(top as f32)),
        clip: None,
    };
    easel.sheet.fill(tiny_skia::Color::WHITE);
    scene.items.iter().for_each(|item| easel.draw(item));
    easel.sheet
}

/// The sheet that is being drawn on.
struct Easel {
    sheet: Pixmap,
    transform: Transform,
    /// The last clip rectangle with its mask, because consecutive items often share it.
    clip: Option<([Point; 2], Mask)>,
}

impl Easel {
    fn draw(&mut self, item: &SceneItem) {
        let Some(path) = outline(&item.path) else {
            return;
        };
        self.set_clip(item.clip);
        let mask = item.clip.and(self.clip.as_ref()).map(|(_, mask)| mask);
        let transform = self.transform;
        let (sheet, ink) = (&mut self.sheet, ink(item.paint.color()));
        match &item.paint {
            Paint::Fill(_) => sheet.fill_path(&path, &ink, FillRule::Winding, transform, mask),
            Paint::Stroke(pen) => sheet.stroke_path(&path, &ink, &stroke(pen), transform, mask),
        }
    }

    fn set_clip(&mut self, wanted: Option<[Point; 2]>) {
        let Some([from, to]) = wanted else {
            return;
        };
        if self.clip.as_ref().map(|(corners, _)| *corners) == wanted {
            return;
        }
        let rectangle = [from, at(to.x, from.y), to, at(from.x, to.y)];
        let mask = Mask::new(self.sheet.width(), self.sheet.height());
        self.clip = mask.map(|mut mask| {
            if let Some(path) = outline(&VectorPath::polygon(rectangle)) {
                mask.fill_path(&path, FillRule::Winding, true, self.transform);
            }
            ([from, to], mask)
        });
    }
}

/// Converts a path; `None` if it has no line.
fn outline(path: &VectorPath) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    for segment in &path.0 {
        match *segment {
            Segment::Move(to) => builder.move_to(to.x as f32, to.y as f32),
            Segment::Line(to) => builder.line_to(to.x as f32, to.y as f32),
            Segment::Quadratic(a, to) => {
                builder.quad_to(a.x as f32, a.y as f32, to.x as f32, to.y as f32);
            }
            Segment::Cubic(a, b, to) => {
                let [a, b, to] = [a, b, to].map(|p| (p.x as f32, p.y as f32));
                builder.cubic_to(a.0, a.1, b.0, b.1, to.0, to.1);
            }
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}

fn ink(Color([red, green, blue]): Color) -> Ink<'static> {
    let color = tiny_skia::Color::from_rgba8(red, green, blue, u8::MAX);
    Ink {
        shader: Shader::SolidColor(color),
        ..Ink::default()
    }
}

fn stroke(pen: &StrokeStyle) -> Stroke {
    // An odd number of lengths is repeated, as in SVG and PDF.
    let twice = 1 + pen.dash_pt.len() % 2;
    let dash = pen
        .dash_pt
        .repeat(twice)
        .into_iter()
        .map(|length| length as f32)
        .collect();
    Stroke {
        width: pen.width_pt as f32,
        miter_limit: MITER_LIMIT as f32,
        line_cap: if pen.has_round_ends() {
            LineCap::Round
        } else {
            LineCap::Butt
        },
        line_join: if pen.is_round {
            LineJoin::Round
        } else {
            LineJoin::Miter
        },
        dash: StrokeDash::new(dash, 0.0),
    }
}
