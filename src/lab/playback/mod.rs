//! A run on the screen: its steps, including earlier ones, its numbers, and the data of its pictures.
//!
//! The run:
//! - [`live`] steps a run and the exact motion, and returns to earlier steps. The player
//!   ([`Player`](crate::lab::Player)) decides where it goes and when.
//! - [`pace`] computes how much simulated time is due.
//!
//! Its pictures:
//! - The [`recording`](crate::engine::recording) and [`path`] store the data.
//! - [`marks`](crate::engine::run::marks) are the times of pushes and edits.
//! - [`ghost`] is the picture of the previous run.
//! - [`strip`], [`scale`] and [`camera`](crate::plot::camera) are the geometry, on a screen and in a figure: a curve on
//!   the columns of a time window, values on an axis, and a point in space on a plane.
//! - [`envelope`] finds unresolved swings.
//! - [`outline`] returns the lines of a solid part.
//!
//! Its numbers:
//! - [`reading`] holds the numbers on the screen.
//! - [`lookup`] computes the numbers at any earlier step.
//! - [`loop_minimum`] computes the first dip of the axle.
//! - [`background`] runs computations in the background.

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
