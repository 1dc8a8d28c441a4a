//! Charts and pages, and their files in SVG, PDF and PNG. This module knows nothing about runs or bodies.
//!
//! It uses the [`engine`](crate::engine) only for numbers and text, and to embed the provenance of a figure in its
//! file. Put the drawing of any chart here. The choice of curves for a run or a table belongs to
//! [`report`](crate::report).
//!
//! - [`chart`]: the axes, curves, marks and legends of a chart, and their layout on a page.
//! - [`camera`]: the projection of points in space onto a picture.
//! - [`scene`]: filled and stroked paths, independent of file formats.
//! - [`ink`]: the pens, marks and lines of text in figures.
//! - [`letters`]: text as outlines, and as an embedded font.
//! - [`line`](mod@line): clips lines to a frame and reduces their points. [`stroke_outline`]: the outline of a line's
//!   ink.
//! - [`format`](mod@format): the file formats, written by [`svg`], [`pdf`] and [`png`].

pub mod camera;
pub mod chart;
pub mod format;
pub mod ink;
pub mod letters;
pub mod line;
pub mod pdf;
pub mod png;
pub mod scene;
pub mod stroke_outline;
pub mod svg;

pub use format::{PageFormat, write};
pub use scene::{
    Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, Unwritable, VectorPath,
};

/// Points (1/72 inch) of a millimetre.
pub const PT_PER_MM: f64 = 72.0 / 25.4;
/// Width of a column of a journal's page, 86 mm, pt.
pub const COLUMN_PT: f64 = 86.0 * PT_PER_MM;

/// Returns the least and the greatest of `values`; `None` where there is none.
pub fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let ends = values.map(|value| (value, value));
    ends.reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}
