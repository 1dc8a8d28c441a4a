//! The terminal: the loop, the keys, and what is drawn of the lab.
//!
//! ```text
//! key ─keymap→ Action ─→ lab.update ─→ Command ┐
//! file of [[do]] ─script────────────→ Command ┴→ lab.carry_out ┐
//! clock ─────────────────────────────────────→ lab.advance ────┴→ Lab { player, values, files, view, ... } ─→ screen → panes
//! ```
//!
//! - [`app`] is the loop, [`pacing`] says how often it draws, [`terminal`] is the only file that talks to the terminal,
//!   [`surroundings`] what the environment says about it.
//! - [`keyboard`] takes the terminal's bytes, [`decoder`] makes keys of them; [`mouse`] says what is done where it points.
//! - [`keymap`] is the one table of keys, [`press`](mod@press) carries out what a key stands for.
//! - [`screen`] puts the panes in their places, [`panes`] draw what they borrow and change nothing; [`layout`] says which
//!   places those are, [`theme`] what colours look like, [`dots`] sets dots and says what they look like,
//!   [`points`] what was measured, [`trail`] a path that fades, [`scene`] lines in space; [`plane`] takes metres to dots and cells.
//! - [`board`] shows lines without a lab.
//! - [`recorder`] draws the lab into memory.

pub mod app;
pub mod board;
pub mod decoder;
pub mod dots;
pub mod keyboard;
pub mod keymap;
pub mod labels;
pub mod layout;
pub mod mouse;
pub mod pacing;
pub mod panes;
pub mod plane;
pub mod points;
pub mod press;
pub mod recorder;
pub mod scene;
pub mod screen;
pub mod surroundings;
pub mod terminal;
pub mod theme;
pub mod trail;
