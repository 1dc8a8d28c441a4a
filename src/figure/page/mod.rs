//! A page: what stands on it, and the page as the bytes of a file.
//!
//! - [`scene`]: filled and stroked paths; no form of file is named there.
//! - [`ink`]: the pens, marks and lines of text of which figures are made.
//! - [`letters`]: text as outlines, and as a font of them.
//! - [`line`](mod@line): lines that end at a frame, and lines through fewer points; [`cover`]: the outline of what a line covers.
//! - [`format`](mod@format): the forms of file, by [`svg`], [`pdf`] and [`png`].

pub mod cover;
pub mod format;
pub mod ink;
pub mod letters;
pub mod line;
pub mod pdf;
pub mod png;
pub mod scene;
pub mod svg;

pub use format::{PageFormat, write};
pub use scene::{
    Color, PageScene, Paint, Point, SceneItem, Segment, StrokeStyle, Unwritable, VectorPath,
};
