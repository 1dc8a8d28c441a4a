//! The live lab in the terminal: it plays a run, watches it and draws it, changes it at the user's word, and keeps it.
//!
//! ```text
//! key ─keymap→ Action ─→ lab.update ┐
//! clock ───────────────→ lab.advance ┴→ Lab { history, live run, pace, view, readouts, ... } ─borrowed→ screen → panes
//!                                            ├ history: journals ─→ scenario ─→ the run, any export, any saved file
//!                                            └ live: simulation ─moment→ recording, path   (exact motion → overlay)
//! ```
//!
//! - [`app`] is the loop, [`terminal`] the only room that knows the terminal, [`surroundings`] what the environment says
//!   about it.
//! - [`keymap`] is the one table of keys, [`action`] what they can mean, [`lab`] the state that actions change.
//! - [`watch`] is the run as it is played and watched, [`view`] how it is looked at, [`picture`] what is drawn of both.
//! - [`keep`] is what outlasts the screen: sessions and exports.

pub mod action;
pub mod app;
pub mod keep;
pub mod keymap;
pub mod lab;
pub mod picture;
pub mod surroundings;
pub mod terminal;
pub mod view;
pub mod watch;
