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
//! - [`origin`]: the run, the data and the request that the file of a figure carries.
//! - [`physics`]: body, state, loads, schemes, observables: a crate of its own, in `src/physics`.
//! - [`scenario`]: a TOML file becomes a checked [`Scenario`](scenario::Scenario); every refusal names file,
//!   line, key, value and rule. The shipped presets live here too.
//! - [`run`]: steps a scenario and its edits forward in time. No other module does.
//! - [`journal`]: what the user does to a run, from which the run is computed again: values, pushes, undo; conditions.
//! - [`analysis`]: how reliable a run's numbers are: theory, measurement, health, comparisons.
//! - [`playback`]: a run that is being watched: it plays at a speed, returns to earlier steps, and records its pictures.
//! - [`export`]: output of the program: columns, CSV, summaries, and the files they are written to.
//! - [`data`]: what somebody has measured, read from a CSV, and what a run says of the same quantities.
//! - [`figure`]: pictures of runs on paper: SVG, PDF and PNG.
//! - [`fit`]: keys of a scenario so that its runs come nearest to measured data.
//! - [`sweep`]: a grid of runs, a row each.
//! - [`verify`]: a CSV, computed again and held against its rows.
//! - [`own_code`]: rows that somebody's own program of the report's scheme wrote, held against it: which slip made them?
//! - [`writeup`]: a run as a folder of files for a write-up.
//! - [`storage`]: what the lab keeps on the disk: sessions, exports in the background, the folder it is confined to.
//! - [`lab`]: the lab without a terminal: its state, and the commands that change it.
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

pub mod analysis;
pub mod class;
pub mod cli;
pub mod cores;
pub mod data;
pub mod export;
pub mod figure;
pub mod fit;
pub mod journal;
pub mod lab;
pub mod lessons;
pub mod origin;
pub mod own_code;
pub mod playback;
pub mod run;
pub mod scenario;
pub mod storage;
pub mod sweep;
pub mod text;
pub mod tui;
pub mod verify;
pub mod writeup;

pub use gyrolab_physics as physics;
