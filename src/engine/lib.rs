//! Runs of a gyroscope, without a terminal: what a scenario file says, its steps, the user's edits, and the numbers.
//!
//! It uses the crate [`physics`]. All that a run is belongs here, if it needs neither a screen nor a page. A module that draws or
//! asks the user belongs to the program.
//!
//! The modules; each uses only modules listed before it:
//!
//! - [`text`](mod@text): numbers and words as people read them, without control characters that a terminal would obey.
//! - [`cores`]: work on all cores.
//! - [`provenance`]: the run, the data and the request that the file of a figure carries.
//! - [`physics`]: body, state, loads, schemes, observables: a crate of its own.
//! - [`scenario`]: a TOML file becomes a checked [`Scenario`](scenario::Scenario); every refusal names file,
//!   line, key, value and rule. The shipped presets live here too.
//! - [`run`]: steps a scenario and its edits forward in time. No other module does.
//! - [`journal`]: the user's edits of a run, from which the run is computed again: values, pushes, undo; conditions.
//! - [`analysis`]: how reliable a run's numbers are: theory, measurement, health, comparisons.
//! - [`recording`]: the curves of a run, as the least and greatest value of each bin of steps.
//! - [`export`]: output of a run: columns, CSV, summaries, and the files they are written to.
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
