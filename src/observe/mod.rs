//! A run as it is watched: played at its pace, gone back into, read off, and what is kept of it for the pictures.
//!
//! - [`live`] plays a run, [`checkpoints`] lead back into it; [`recording`] and [`path`] keep what the pictures need of
//!   it, [`overlay`] the exact motion beside it.
//! - [`sweep`] and [`camera`] are the geometry of the pictures, for a screen and for a figure alike: what happens in
//!   each column of a window of time, and where a point in space stands in a plane picture.
//! - [`pace`] says how fast it is played, [`playback`] plays it as far as its next stop.
//! - [`reading`] reads numbers off it, [`advisor`] finds what would mend them.
//! - [`marks`] are the times at which something is done to a run, [`ghost`] what is kept of the run before.

pub mod advisor;
pub mod camera;
pub mod checkpoints;
pub mod ghost;
pub mod live;
pub mod marks;
pub mod overlay;
pub mod pace;
pub mod path;
pub mod playback;
pub mod reading;
pub mod recording;
pub mod sweep;
