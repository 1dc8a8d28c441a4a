//! The terminal: the main loop, the keys, and the panes.
//!
//! It uses the [`lab`](crate::lab), the [`lessons`](crate::lessons) and the [`class`](crate::class), and draws their state.
//! Keys, panes, and all that a terminal reads or writes belong here. A value that outlives a frame belongs to the lab.
//!
//! ```text
//! key ─keymap→ Command ┬→ lab.carry_out ─→ the part of the lab whose command it is ┐
//! file of [[do]] ──────┘                                                           │
//! key ─keymap→ Action ───→ lab.update (focus, dialogs, lists, leaving) ────────────┤
//! clock ─────────────────→ lab.advance ────────────────────────────────────────────┴→ screen → panes
//! ```
//!
//! - [`app`] is the loop, [`pacing`] says how often it draws, [`terminal`] is the only file that talks to the terminal.
//! - [`keyboard`] takes the terminal's bytes, [`decoder`] makes keys of them; [`mouse`] says what is done where it points.
//! - [`keymap`] is the one table of keys, [`press`](mod@press) carries out what a key means.
//! - [`screen`] puts the panes in their places, [`panes`] draw what they borrow and change nothing; [`mod@svg`] is the picture for a
//!   slide; [`layout`] says which places those are, [`theme`] has the styles of all roles, [`dots`] says what dots
//!   look like, [`points`] what was measured, [`layered_dots`] lines that cross, [`labels`] their names; [`plane`] takes metres to dots and cells,
//!   [`split`] a part of the screen to two.
//! - [`board`] shows lines without a lab, [`projector`](mod@projector) a lab that no key changes. [`job_control`] tells whether Ctrl-Z may stop the program.

pub mod app;
pub mod board;
pub mod decoder;
pub mod dots;
pub mod job_control;
pub mod keyboard;
pub mod keymap;
pub mod labels;
pub mod layered_dots;
pub mod layout;
pub mod mouse;
pub mod pacing;
pub mod panes;
pub mod plane;
pub mod points;
pub mod press;
pub mod projector;
pub mod screen;
pub mod split;
pub mod svg;
pub mod terminal;
pub mod theme;
