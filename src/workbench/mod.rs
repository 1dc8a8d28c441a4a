//! The live lab in the terminal. It plays a run, watches it and draws it; it changes nothing in it.
//!
//! ```text
//! key ─keymap→ Action ─→ lab.update ┐
//! clock ───────────────→ lab.advance ┴→ Lab { live run, pace, view, readouts, browser } ─borrowed→ screen → panes
//!                                            └ live: simulation ─moment→ recording, path   (exact motion → overlay)
//! ```
//!
//! - [`app`] is the loop, [`terminal`] the only room that knows the terminal, [`surroundings`] what the
//!   environment says about it.
//! - [`keymap`] is the one table of keys, [`action`] what they can mean, [`lab`] the state that actions change.
//! - [`live`] plays a run; [`recording`] and [`path`] keep what the pictures need of it, [`overlay`] the exact motion
//!   beside it; [`pace`] says how fast it is played, [`playback`] plays it as far as its next stop; [`readouts`] and [`health`] read numbers off it, [`advisor`] finds what
//!   would mend them.
//! - [`session`] keeps what is needed to come back, [`exporting`] writes a run into a file in the background, and
//!   [`farewell`] lets both bring home what they have before the terminal is given back.
//! - [`note`] says what there is to see, [`notice`] what has just happened.
//! - [`view`] is how it is looked at, [`layout`] where the panes stand, [`screen`] puts them there, [`panes`] draw.
//!   [`sweep`] and [`camera`] are their geometry, [`dots`], [`markers`] and [`theme`] their ink.

pub mod action;
pub mod advisor;
pub mod app;
pub mod browser;
pub mod camera;
pub mod dots;
pub mod exporting;
pub mod farewell;
pub mod health;
pub mod keymap;
pub mod lab;
pub mod layout;
pub mod live;
pub mod markers;
pub mod note;
pub mod notice;
pub mod overlay;
pub mod pace;
pub mod panes;
pub mod path;
pub mod playback;
pub mod readouts;
pub mod recording;
pub mod screen;
pub mod session;
pub mod surroundings;
pub mod sweep;
pub mod terminal;
pub mod theme;
pub mod view;
