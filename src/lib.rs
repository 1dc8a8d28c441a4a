//! # gyrolab: the precession of a gyroscope, as a report simulated it and as it is
//!
//! A student's report simulated a gyroscope as a ring of point masses whose axle stands on a pinned foot:
//! inertia from the points, Ω = I⁻¹L, a rotation matrix, a torque from gravity, L updated, again. gyrolab runs
//! that scheme to the letter beside better ones, exports any run as CSV, and says what the time step did to it.
//!
//! The modules; each uses only modules listed before it:
//!
//! - [`physics`]: body, state, loads, schemes, observables: the crate in `src/physics`.
//! - [`engine`]: everything that a run is, without a screen: scenarios, steps, edits, numbers, CSV files: the crate in
//!   `src/engine`.
//! - [`plot`]: charts and pages as SVG, PDF and PNG. It knows no run.
//! - [`studies`]: many runs at once, or a run against other data: sweeps, fits, own programs, CSVs computed again.
//! - [`report`]: figures of runs and tables, and write-ups.
//! - [`lab`]: the lab without a terminal: its state, and the commands that change it; its playback, and what it keeps on disk.
//! - [`lessons`]: Markdown files that say what the lab does, read, checked and played without a terminal.
//! - [`class`]: a teacher's lab and the seats of the students, which know of each other through files in a folder.
//! - [`tui`]: the terminal: keys that lead to commands, the panes that draw the lab, and the loop.
//! - [`cli`]: the commands of the command line.
//!
//! Frames: *world* has its origin at the pivot and +z up; *body* is fixed in the body and equals the world frame
//! in the upright pose. Units are SI throughout: metres, kilograms, seconds, newtons, J s; angles are radians
//! inside and degrees in names that end in `_deg`.

// Elsewhere the crate is empty, and `main.rs` ends the build with one sentence.
#![cfg(unix)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod class;
pub mod cli;
pub mod lab;
pub mod lessons;
pub mod plot;
pub mod report;
pub mod studies;
pub mod tui;

pub use gyrolab_engine as engine;
pub use gyrolab_physics as physics;
