//! The file formats of a page.

use std::path::Path as FilePath;

use super::scene::{LARGEST_PT, Unwritable, at, hundredths};
use super::{PageScene, Paint, Point, SceneItem};
use super::{pdf, png, svg};
use crate::engine::provenance::{self, Origin};
use crate::engine::text::printable::PrintablePath;

/// Dots per inch of a PNG, as journals require for drawings with lines and letters.
pub const DOTS_PER_INCH: f64 = 600.0;
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum PageFormat {
    Svg,
    /// SVG with text elements, which can be selected and use a font of the reader's system.
    SvgText,
    Pdf,
    /// Portable Network Graphics with [`DOTS_PER_INCH`].
    Png,
}

impl PageFormat {
    /// Returns the format for the extension of a file name, regardless of case.
    ///
    /// # Errors
    /// Returns an error if the extension is not svg, pdf or png.
    pub fn from_path(file: &FilePath) -> Result<Self, Unwritable> {
        let ending = file.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("pdf") => Ok(Self::Pdf),
            Some("png") => Ok(Self::Png),
            _ => Err(Unwritable::Ending(PrintablePath(file).to_string())),
        }
    }
}

/// Returns the bytes of a file that shows a page, with its `origin` embedded if given.
///
/// The bytes of SVG and PDF and the pixels of PNG are the same on every machine. Positions and widths are first rounded
/// to hundredths of a point in all formats.
///
/// # Errors
/// Returns an error if the page has no size, is too large for the format, or has a coordinate that is not a number.
/// Also if the origin is too long.
pub fn write(
    scene: &PageScene,
    format: PageFormat,
    origin: Option<&Origin>,
) -> Result<Vec<u8>, Unwritable> {
    let scene = rounded(scene)?;
    let version = origin.map_or(env!("CARGO_PKG_VERSION"), |origin| &origin.gyrolab);
    let picture = match format {
        PageFormat::Svg => svg::written(&scene, false).into_bytes(),
        PageFormat::SvgText => svg::written(&scene, true).into_bytes(),
        PageFormat::Pdf => pdf::written(&scene, version),
        PageFormat::Png => png::written(&scene, DOTS_PER_INCH)?,
    };
    match origin {
        Some(origin) => provenance::embed(&picture, origin).ok_or(Unwritable::Origin),
        None => Ok(picture),
    }
}

/// Rounds the page to hundredths of a point, checks that a file can hold all numbers, and removes empty paths.
///
/// # Errors
/// Returns an error if the page has no size, is too large, or has a coordinate that is not a number.
pub fn rounded(scene: &PageScene) -> Result<PageScene, Unwritable> {
    let (width_pt, height_pt) = (scene.width_pt, scene.height_pt);
    let is_side = [width_pt, height_pt].map(|pt| hundredths(pt) > 0.0 && pt <= LARGEST_PT);
    if is_side != [true, true] {
        return Err(Unwritable::Size {
            width_pt,
            height_pt,
        });
    }
    let numbered = scene
        .items
        .iter()
        .enumerate()
        .filter(|(_, item)| !item.path.0.is_empty());
    Ok(PageScene {
        width_pt: hundredths(width_pt),
        height_pt: hundredths(height_pt),
        title: scene.title.clone(),
        decimal_comma: scene.decimal_comma,
        caveats: scene.caveats.clone(),
        items: numbered
            .map(|(index, item)| rounded_item(item).ok_or(Unwritable::Place(index)))
            .collect::<Result<_, _>>()?,
    })
}

fn rounded_item(item: &SceneItem) -> Option<SceneItem> {
    let mut item = item.clone().mapped(hundredths_of);
    item.clip = item.clip.map(|corners| corners.map(hundredths_of));
    if let Paint::Stroke(pen) = &mut item.paint {
        let lengths = 0.0..=LARGEST_PT;
        let are_dashes = pen.dash_pt.iter().all(|length| lengths.contains(length));
        if !(lengths.contains(&pen.width_pt) && are_dashes) {
            return None;
        }
        pen.width_pt = hundredths(pen.width_pt);
        pen.dash_pt
            .iter_mut()
            .for_each(|length| *length = hundredths(*length));
        // Dashes of length 0 would never end. Dashes too short to be seen are replaced by a solid line.
        if pen.dash_pt.iter().sum::<f64>() <= 0.0 {
            pen.dash_pt.clear();
        }
    }
    let clip = item.clip.into_iter().flatten();
    let is_sound = item
        .path
        .points()
        .chain(clip)
        .all(|p| p.x.abs() <= LARGEST_PT && p.y.abs() <= LARGEST_PT);
    is_sound.then_some(item)
}

fn hundredths_of(point: Point) -> Point {
    at(hundredths(point.x), hundredths(point.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Color, StrokeStyle, VectorPath};

    fn page(items: Vec<SceneItem>) -> PageScene {
        PageScene {
            width_pt: 100.0,
            height_pt: 50.0,
            title: String::new(),
            caveats: Vec::new(),
            items,
            decimal_comma: false,
        }
    }

    fn line(x: f64, y: f64, pen: StrokeStyle) -> SceneItem {
        SceneItem {
            path: VectorPath::polyline([at(0.0, 0.0), at(x, y)]),
            paint: Paint::Stroke(pen),
            clip: None,
            words: None,
        }
    }

    fn pen(width_pt: f64, dash_pt: &[f64]) -> StrokeStyle {
        StrokeStyle {
            width_pt,
            color: Color([0; 3]),
            dash_pt: dash_pt.to_vec(),
            is_round: false,
        }
    }

    #[test]
    fn the_extension_determines_the_format() {
        let of = |name: &str| PageFormat::from_path(FilePath::new(name));
        assert_eq!(of("a.svg"), Ok(PageFormat::Svg));
        assert_eq!(of("dir.png/A.B.PDF"), Ok(PageFormat::Pdf));
        assert_eq!(of("x.Png"), Ok(PageFormat::Png));
        for wrong in ["", "svg", ".svg", "a.jpg", "a.svg.gz", "a.png/b"] {
            let message = of(wrong).unwrap_err().to_string();
            assert!(
                message.starts_with(&format!("{wrong}: a figure is written as .svg")),
                "{message}"
            );
        }
    }

    #[test]
    fn coordinates_that_no_format_can_store_are_rejected() {
        for bad in [f64::NAN, f64::INFINITY, -1e300, 20_001.0] {
            let lines = [1.0, bad].map(|x| line(x, 1.0, pen(1.0, &[])));
            let scene = page(lines.to_vec());
            for format in [PageFormat::Svg, PageFormat::Pdf, PageFormat::Png] {
                assert_eq!(write(&scene, format, None), Err(Unwritable::Place(1)));
            }
            for broken in [pen(bad, &[]), pen(1.0, &[1.0, bad])] {
                let of_pen = page(vec![line(1.0, 1.0, broken)]);
                assert_eq!(rounded(&of_pen), Err(Unwritable::Place(0)));
            }
        }
        for (width_pt, height_pt) in [
            (0.0, 1.0),
            (1.0, -1.0),
            (f64::NAN, 1.0),
            (1.0, 1e9),
            (0.004, 1.0),
        ] {
            let scene = PageScene {
                width_pt,
                height_pt,
                ..page(vec![])
            };
            assert!(matches!(rounded(&scene), Err(Unwritable::Size { .. })));
        }
    }

    #[test]
    fn a_page_is_rounded_to_hundredths() {
        let scene = page(vec![line(1.23456, -0.001, pen(0.555, &[2.0001, 0.999]))]);
        let round = rounded(&scene).unwrap();
        assert_eq!(round.items[0], line(1.23, 0.0, pen(0.56, &[2.0, 1.0])));
        assert!(round.items[0].path.points().all(|p| p.y.is_sign_positive()));
        assert_eq!(rounded(&round), Ok(round.clone()));
        let dots = rounded(&page(vec![line(1.0, 1.0, pen(1.0, &[0.001, 0.001]))]));
        assert_eq!(dots.unwrap().items[0], line(1.0, 1.0, pen(1.0, &[])));
    }
}
