//! # gyrolab: the precession of a gyroscope, as a report simulated it and as it is
//!
//! A student's report simulated a gyroscope as a ring of point masses whose axle stands on a pinned foot:
//! inertia from the points, Ω = I⁻¹L, a rotation matrix, a torque from gravity, L updated, again. gyrolab runs
//! that scheme to the letter beside better ones, exports any run as CSV, and says what the time step did to it.
//!
//! The modules; each uses only modules listed before it:
//!
//! - [`text`](mod@text): numbers and words as people read them, without control characters that a terminal would obey.
//! - [`cores`]: work on all cores.
//! - [`physics`]: body, state, loads, schemes, observables: a crate of its own, in `src/physics`.
//! - [`scenario`]: a TOML file becomes a checked [`Scenario`](scenario::Scenario); every refusal names file,
//!   line, key, value and rule. The shipped presets live here too.
//! - [`run`]: steps a scenario and its edits forward in time. No other module does.
//! - [`work`]: what the user changes in a scenario: values, pushes, the journal of both, undo; conditions over a run.
//! - [`analysis`]: how reliable a run's numbers are: theory, measurement, health, comparisons.
//! - [`observe`]: a run that is being watched: its playback, its earlier steps, and the data of its pictures.
//! - [`export`]: output of the program: columns, CSV, summaries, and the files they are written to.
//! - [`measured`]: data that somebody has measured, read from a CSV, and what a run says of the same quantities.
//! - [`figure`]: pictures of runs on paper: SVG, PDF and PNG.
//! - [`study`]: what many runs say, and what a run that was exported is worth: sweeps, verification, write-ups.
//! - [`storage`]: what the lab keeps on the disk: sessions, exports in the background, the folder it is confined to.
//! - [`lab`]: the lab without a terminal: its state, and the commands that change it.
//! - [`teach`]: lessons: Markdown files that say what the lab does, read, checked and played without a terminal.
//! - [`tui`]: the terminal: keys that lead to commands, the panes that draw the lab, and the loop.
//! - [`cli`]: the commands of the command line.
//!
//! Frames: *world* has its origin at the pivot and +z up; *body* is fixed in the body and equals the world frame
//! in the upright pose. Units are SI throughout: metres, kilograms, seconds, newtons, J s; angles are radians
//! inside and degrees in names that end in `_deg`.

#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod analysis;
pub mod cli;
pub mod cores;
pub mod export;
pub mod figure;
pub mod lab;
pub mod measured;
pub mod observe;
pub mod run;
pub mod scenario;
pub mod storage;
pub mod study;
pub mod teach;
pub mod text;
pub mod tui;
pub mod work;

pub use gyrolab_physics as physics;
