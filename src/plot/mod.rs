//! Charts and pages, and their files in SVG, PDF and PNG. Nothing here knows a run or a body.
//!
//! It uses the [`engine`](crate::engine) for numbers and text only, and to embed the provenance of a figure in its file. The
//! drawing of any chart belongs here. The choice of curves for a run or a table belongs to [`report`](crate::report).
//!
//! - [`chart`]: the axes, curves, marks and legends of a chart, and its place on a page.
//! - [`camera`]: positions in space in a plane picture.
//! - [`scene`]: filled and stroked paths; no form of file is named there.
//! - [`ink`]: the pens, marks and lines of text of which figures are made.
//! - [`letters`]: text as outlines, and as a font of them.
//! - [`line`](mod@line): lines that end at a frame, and lines through fewer points; [`stroke_outline`]: the outline of what a line covers.
//! - [`format`](mod@format): the forms of file, by [`svg`], [`pdf`] and [`png`].

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
