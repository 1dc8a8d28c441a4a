//! Tests of the library: physics, files, runs, verdicts, and the lab without a terminal.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
// Tests may use the mathematics of the C library.
#![allow(clippy::disallowed_methods)]
// Expected words may be borrowed or owned.
#![allow(clippy::needless_borrows_for_generic_args)]

#[path = "../support/mod.rs"]
mod support;

mod beside;
mod class;
mod classroom;
mod commands;
mod coverage;
mod every_key;
mod exact;
mod exported;
mod figure_files;
mod figure_pages;
mod figures;
mod finding;
mod fits;
mod flat;
mod flights;
mod friction;
mod handouts;
mod health;
mod journal;
mod kept;
mod keys;
mod laws;
mod lessons;
mod lessons_asked;
mod lessons_played;
mod lessons_taken;
mod limits;
mod mangled;
mod measured;
mod measured_beside;
mod messages;
mod mouse;
mod own_code;
mod parameters;
mod parts;
mod pictures;
mod predictability;
mod present;
mod presets;
mod readouts;
mod reference;
mod refusals;
mod replay;
mod rerun;
mod rooms;
mod run_until;
mod scenes;
mod schemes;
mod small_screens;
mod space;
mod start;
mod step_pane;
mod sweep;
mod sweep_figures;
mod textbook;
mod theory;
mod thrown;
mod traces;
mod truth;
mod undo;
mod values;
mod wobble;
mod words;
mod workbench;
mod workings;
