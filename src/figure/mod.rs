//! Figures for write-ups: a run, or a table of runs, drawn on paper.
//!
//! - [`page`]: what stands on a page, and the page as SVG, PDF and PNG.
//! - [`chart`]: what a figure with axes shows, and its place on a page.
//! - [`of_runs`]: figures of runs: their curves over time, from above and in space. [`kind`] has the names of these,
//!   [`course`] takes the numbers from stepping through the runs, in bounded memory (`path` those of a path),
//!   `measured` draws what was measured with them, `dense` finds the curves and paths whose turns are not told apart,
//!   `chords` those whose paths have too few points, [`labels`] gives words and axes that were asked for, `size` tells what of a curve is rounding.
//!   `request` says what is asked for, and what a figure is once it is drawn.
//! - [`of_table`]: figures of a comparison, of a sweep or of a fit, read by [`table`].
//! - `source`: the runs or the table that a figure shows, what of them its file carries, and the way back.
//! - [`quantity`]: columns and readouts as they stand at an axis.

pub mod chart;
mod chords;
pub mod course;
mod dense;
pub mod kind;
pub mod labels;
mod measured;
mod names;
pub mod of_runs;
pub mod of_table;
pub mod page;
mod path;
pub mod quantity;
mod request;
mod size;
mod source;
mod space;
pub mod table;

/// Points (1/72 inch) of a millimetre.
pub const PT_PER_MM: f64 = 72.0 / 25.4;
/// Width of a column of a journal's page, 86 mm, pt.
pub const COLUMN_PT: f64 = 86.0 * PT_PER_MM;

/// The least and the greatest of `values`; `None` where there is none.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let ends = values.map(|value| (value, value));
    ends.reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}

pub use source::{FigureOptions, FigureSource, WIDTHS_MM};

pub use page::{
    Color, PageFormat, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, Unwritable,
    VectorPath, write,
};
