//! The terminal: the main loop, the keys, and the panes.
//!
//! It draws the state of the [`lab`](crate::lab), the [`lessons`](crate::lessons) and the [`class`](crate::class).
//! Keys, panes, and everything that reads from or writes to a terminal belong here. A value that outlives a frame
//! belongs to the lab.
//!
//! ```text
//! key ─keymap→ Command ┬→ lab.carry_out ─→ the part of the lab whose command it is ┐
//! file of [[do]] ──────┘                                                           │
//! key ─keymap→ Action ───→ lab.update (focus, dialogs, lists, leaving) ────────────┤
//! clock ─────────────────→ lab.advance ────────────────────────────────────────────┴→ screen → panes
//! ```
//!
//! - [`app`] is the main loop, [`pacing`] limits how often it draws, and [`terminal`] is the only file that talks to
//!   the terminal.
//! - [`keyboard`] reads the terminal's bytes, and [`decoder`] turns them into keys. [`mouse`] handles clicks and the
//!   wheel.
//! - [`keymap`] is the one table of keys, and [`press`](mod@press) carries out what a key means.
//! - [`layout`] computes the area of each pane, [`screen`] draws the panes there, and [`panes`] draw what they borrow
//!   and change nothing. [`mod@svg`] writes the picture for a slide.
//! - [`theme`] has the style of every role. [`dots`] has the characters of dots, [`layered_dots`] draws lines that
//!   cross, [`points`] draws measured points, and [`labels`] places labels.
//! - [`plane`] converts meters to dots and cells, and [`split`] splits an area in two.
//! - [`board`] shows lines of text without a lab, and [`projector`](mod@projector) shows a lab that no key changes.
//!   [`job_control`] detects whether Ctrl-Z may stop the program.

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
