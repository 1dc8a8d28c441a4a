//! Figures for write-ups: a run, or a table of runs, drawn on paper.
//!
//! - [`of_runs`]: figures of runs: their curves over time, from above and in space. [`kind`] has the names of these,
//!   [`course`] takes the numbers from stepping through the runs, in bounded memory (`path` those of a path),
//!   `measured` draws what was measured with them, `dense` finds the curves and paths whose turns are not told apart,
//!   `chords` those whose paths have too few points, [`labels`] gives words and axes that were asked for, `size` tells what of a curve is rounding.
//!   `job` is a figure that is being drawn, and what it is once it is drawn.
//! - [`of_table`]: figures of a comparison, of a sweep or of a fit, read by [`table`](crate::studies::table).
//! - `spec`: what a figure shows.
//! - `source`: the runs or the table that a figure shows, what of them its file carries, and the way back.
//! - `drawing`: a figure of runs or of a table is drawn from its source.
//! - `redraw`: a figure, drawn again from its file.
//! - [`quantity`]: columns and readouts as they stand at an axis.

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
mod path;
pub mod quantity;
mod redraw;
mod setting;
mod size;
mod source;
mod space;
mod spec;

pub use redraw::redraw;
pub use source::FigureSource;
pub use spec::{FigureSpec, WIDTHS_MM};
