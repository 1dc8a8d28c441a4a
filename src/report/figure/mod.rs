//! Figures for write-ups: runs, or a table of runs, drawn on paper.
//!
//! - [`of_runs`]: figures of runs: curves over time, from above and in space. [`kind`] names them, and [`course`]
//!   samples the runs in bounded memory, with `path` for paths. `measured` adds measured data. `dense` finds curves and
//!   paths whose turns are too dense. `arcs` computes the motion within long time steps, and `chords` finds paths with
//!   too few points for that. [`labels`] applies requested words and axes,
//!   and `size` separates values from rounding. `job` is a figure that is being drawn.
//! - [`of_table`]: figures of a comparison, a sweep or a fit, read by [`table`](crate::studies::table).
//! - `spec`: the request for a figure.
//! - `page`: the size of the page and of the letters on it.
//! - `source`: the runs or the table of a figure, and their embedding in its file.
//! - `drawing`: draws a figure from its source.
//! - `redraw`: redraws a figure from its file.
//! - [`quantity`]: axis labels of columns and readouts.

pub mod arcs;
mod chords;
pub mod course;
mod dense;
mod drawing;
mod job;
pub mod kind;
pub mod labels;
mod measured;
mod names;
pub mod of_runs;
pub mod of_table;
mod page;
mod path;
pub mod quantity;
mod redraw;
mod setting;
mod size;
mod source;
mod space;
mod spec;

pub use page::{FONT_SIZES_PT, PAGE_STYLE_NAMES, PageStyle};
pub use redraw::redraw;
pub use source::FigureSource;
pub use spec::{FigureSpec, WIDTHS_MM};
