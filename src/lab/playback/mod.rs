//! A run on the screen: its steps, which it can return to, its numbers, and the data of its pictures.
//!
//! - [`live`] steps a run and the exact motion beside it, and returns to earlier steps. The player
//!   ([`Player`](crate::lab::Player)) says where it goes and when; [`pace`] is how much simulated time is due.
//! - [`recording`](crate::engine::recording) and [`path`] store the data of its pictures; [`marks`](crate::engine::run::marks) are the times of
//!   pushes and edits; [`ghost`] is the picture of the previous run.
//! - [`strip`], [`scale`] and [`camera`](crate::plot::camera) are the geometry of the pictures, for a screen and for a
//!   figure alike: a curve in each column of a window of time, the values at an axis, and the position of a point in space
//!   in a plane picture. [`envelope`] says where swings are unresolved;
//!   [`outline`] gives the lines by which a solid part is drawn.
//! - [`reading`] holds the numbers on the screen; [`lookup`] computes those of any earlier step, [`loop_minimum`] how the
//!   axle dips at first; [`background`] searches for a setting that makes the numbers reliable.

pub mod background;
pub mod envelope;
pub mod ghost;
pub mod live;
pub mod lookup;
pub mod loop_minimum;
pub mod outline;
pub mod pace;
pub mod path;
pub mod reading;
pub mod scale;
pub mod strip;
