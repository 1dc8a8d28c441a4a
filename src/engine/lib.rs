//! Runs of a gyroscope, independent of any terminal: scenarios, time steps, the user's edits, and the numbers derived
//! from them.
//!
//! This crate uses the crate [`physics`]. Code belongs here if it needs neither a screen nor a page. Code that draws,
//! or that asks the user, belongs to the program.
//!
//! The modules follow. Each uses only modules listed before it.
//!
//! - [`text`](mod@text): numbers and words as people read them, free of control characters that a terminal would obey.
//! - [`cores`]: work on all cores.
//! - [`provenance`]: embeds the run, the data and the request in the file of a figure, and extracts them.
//! - [`physics`]: body, state, loads, schemes, observables; a separate crate.
//! - [`scenario`]: turns a TOML file into a checked [`Scenario`](scenario::Scenario). Every error message names file,
//!   line, key, value and rule. The shipped presets live here too.
//! - [`run`]: steps a scenario and its edits forward in time. No other module does.
//! - [`journal`]: the user's edits of a run (values, pushes, undo), from which the run is recomputed; conditions.
//! - [`analysis`]: theory, measurements, comparisons, and how reliable a run's numbers are.
//! - [`recording`]: the curves of a run, as minimum and maximum of each bin of steps.
//! - [`export`]: the output of a run: columns, CSV, summaries, and the files they are written to.
//! - [`data`]: measured values read from a CSV, and the same quantities of a run.

#![cfg(unix)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod analysis;
pub mod cores;
pub mod data;
pub mod export;
pub mod journal;
pub mod provenance;
pub mod recording;
pub mod run;
pub mod scenario;
pub mod text;

pub use gyrolab_physics as physics;
