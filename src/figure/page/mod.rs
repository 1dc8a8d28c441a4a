//! A page: what stands on it, and the page as the bytes of a file.
//!
//! - [`scene`]: filled and stroked paths; no form of file is named there.
//! - [`ink`]: the pens, marks and lines of text of which figures are made; [`clip`]: lines that end at a frame.
//! - [`letters`]: text as outlines, and as a font of them.
//! - [`thin`]: lines with fewer points, chosen by [`simplify`]; [`cover`]: the outline of what a line covers.
//! - [`format`](mod@format): the forms of file, by [`svg`], [`pdf`] and [`png`].

pub mod clip;
pub mod cover;
pub mod format;
pub mod ink;
pub mod letters;
pub mod pdf;
pub mod png;
pub mod scene;
pub mod simplify;
pub mod svg;
pub mod thin;
mod unwritable;

pub use format::{Format, write};
pub use scene::{Color, Item, Paint, Path, Pen, Point, Scene, Segment};
pub use unwritable::Unwritable;
