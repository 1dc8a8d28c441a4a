//! Figures for write-ups: a run, or a table of runs, drawn on paper.
//!
//! - [`letters`]: text as outlines.
//! - [`scene`]: what stands on the page, as filled and stroked paths; no back end is named there.
//! - [`chart`]: what a figure with axes shows; [`layout`] gives its parts their places, and [`draw`] puts them on a page.

pub mod axis;
pub mod chart;
pub mod clip;
pub mod course;
pub mod curve;
pub mod dense;
pub mod draw;
pub mod ink;
pub mod kind;
pub mod layout;
pub mod legend;
pub mod letters;
mod names;
pub mod of_runs;
pub mod over_time;
pub mod quantity;
pub mod scene;
pub mod slope;
mod space;
pub mod ticks;

pub use scene::{Color, Item, Paint, Path, Pen, Point, Scene, Segment};
