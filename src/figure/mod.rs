//! Figures for write-ups: a run, or a table of runs, drawn on paper.
//!
//! - [`letters`]: text as outlines.
//! - [`scene`]: what stands on the page, as filled and stroked paths; no back end is named there.

pub mod letters;
pub mod scene;

pub use scene::{Color, Item, Paint, Path, Pen, Point, Scene, Segment};
