//! The live lab in the terminal: it plays a run, watches it and draws it, changes it at the user's word, and keeps it.
//!
//! ```text
//! key ─keymap→ Action ─→ lab.update ┐
//! clock ───────────────→ lab.advance ┴→ Lab { history, live run, pace, view, readouts, ... } ─borrowed→ screen → panes
//!                                            ├ history: journals ─→ scenario ─→ the run, any export, any saved file
//!                                            └ live: simulation ─moment→ recording, path   (exact motion → overlay)
//! ```
//!
//! - [`app`] is the loop, [`terminal`] the only room that knows the terminal, [`surroundings`] what the
//!   environment says about it, [`farewell`] what is done before it is given back, whatever ends the process.
//! - [`keymap`] is the one table of keys, [`action`] what they can mean, [`lab`] the state that actions change.
//! - [`live`] plays a run, [`checkpoints`] lead back into it; [`recording`] and [`path`] keep what the pictures need of
//!   it, [`overlay`] the exact motion beside it; [`pace`] says how fast it is played, [`playback`] plays it as far as
//!   its next stop; [`readouts`] and [`health`] read numbers off it, [`advisor`] finds what would mend them.
//! - [`history`] has the runs one after the other, each with its journal; [`marks`] are the times at which something is
//!   done to a run, [`ghost`] what is kept of the run before.
//! - [`editor`] is the list of what can be edited, [`next_push`] the push to come, [`form`] what is typed into.
//! - [`exporting`] writes a run in the background; [`session`] keeps the lab where it can be come back to.
//! - [`note`] says what there is to see, [`notice`] what has just happened.
//! - [`view`] is how it is looked at, [`layout`] where the panes stand, [`screen`] puts them there, [`panes`] draw.
//!   [`sweep`] and [`camera`] are their geometry, [`dots`], [`markers`] and [`theme`] their ink.

pub mod action;
pub mod advisor;
pub mod app;
pub mod browser;
pub mod camera;
pub mod checkpoints;
pub mod dots;
pub mod editor;
pub mod exporting;
pub mod farewell;
pub mod form;
pub mod ghost;
pub mod health;
pub mod history;
pub mod keymap;
pub mod lab;
pub mod layout;
pub mod live;
pub mod markers;
pub mod marks;
pub mod next_push;
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
