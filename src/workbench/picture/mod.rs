//! The picture: [`screen`] puts the panes in their places, [`panes`] draw what they borrow and change nothing.
//! [`sweep`] is the traces' geometry, [`dots`] the ink.

pub mod dots;
pub mod panes;
pub mod screen;
pub mod sweep;
