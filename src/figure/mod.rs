//! Figures for write-ups: a run, or a table of runs, drawn on paper.
//!
//! - [`format`](mod@format): a page as the bytes of a file, by [`svg`], [`pdf`] and [`png`].
//! - [`letters`]: text as outlines.
//! - [`thin`]: lines with fewer points; [`cover`]: the outline of what a line covers.
//! - [`scene`]: what stands on the page, as filled and stroked paths; no back end is named there.
//! - [`chart`]: what a figure with axes shows; [`layout`] gives its parts their places, and [`draw`] puts them on a page.
//! - [`of_runs`]: figures of runs, whose numbers [`course`] takes from stepping through them; [`kind`] has their names.
//! - [`of_table`]: figures of a comparison or of a sweep, read by [`table`].

pub mod axis;
pub mod chart;
pub mod clip;
pub mod course;
pub mod cover;
pub mod curve;
pub mod dense;
pub mod draw;
pub mod format;
pub mod ink;
pub mod kind;
pub mod layout;
pub mod legend;
pub mod letters;
mod names;
pub mod of_runs;
pub mod of_table;
pub mod over_time;
pub mod pdf;
pub mod png;
pub mod quantity;
pub mod scene;
pub mod slope;
mod space;
pub mod svg;
pub mod table;
pub mod thin;
pub mod ticks;

/// Width of a column of a journal's page, 86 mm, pt.
pub const COLUMN_PT: f64 = 86.0 * 72.0 / 25.4;

pub use format::{Format, Unwritable, write};
pub use scene::{Color, Item, Paint, Path, Pen, Point, Scene, Segment};
