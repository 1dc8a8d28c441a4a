//! A run that is being watched: its playback, its earlier steps, its numbers, and the data of its pictures.
//!
//! - [`live`] steps a run and the exact motion beside it, and returns to earlier steps; [`recording`](crate::engine::recording) and [`path`] store the
//!   data of its pictures.
//! - [`outline`] gives the lines by which a solid part is drawn. [`strip`], [`scale`] and [`camera`](crate::plot::camera) are the geometry of the pictures,
//!   for a screen and for a figure alike: a curve in each column of a window of time, the values at an axis, and the
//!   position of a point in space in a plane picture. [`detail`] is the window of time in which fast motion is seen;
//!   [`ages`] says which parts of a path are old.
//! - [`lookup`] gives the numbers of any earlier step.
//! - [`pace`] is how much simulated time is due. [`reading`] holds the numbers on the screen; [`background`] searches for a setting that makes them reliable.
//! - [`marks`] are the times of pushes and edits; [`ghost`] is the picture of the previous run.

pub mod ages;
pub mod background;
pub mod detail;
pub mod ghost;
pub mod live;
pub mod lookup;
pub mod loop_minimum;
pub mod marks;
pub mod outline;
pub mod pace;
pub mod path;
pub mod reading;
pub mod scale;
pub mod strip;
