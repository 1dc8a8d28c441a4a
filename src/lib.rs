//! # gyrolab: the precession of a gyroscope, as a report simulated it and as it is
//!
//! A student's report simulated a gyroscope as a ring of point masses whose axle stands on a pinned foot:
//! inertia from the points, Ω = I⁻¹L, a rotation matrix, a torque from gravity, L updated, again. gyrolab runs
//! that scheme to the letter beside better ones, exports any run as CSV, and says what the time step did to it.
//!
//! The rooms, in the order in which data flows through them:
//!
//! - [`text`](mod@text): numbers and words as people read them, with nothing in them that steers a terminal; every room
//!   writes with it.
//! - [`physics`]: body, state, loads, schemes, observables. It knows no file, no clock on the wall, no terminal.
//! - [`scenario`]: a TOML file becomes a checked [`Scenario`](scenario::Scenario); every refusal names file,
//!   line, key, value and rule. The shipped presets live here too.
//! - [`run`]: a scenario and its journal of edits, played forward step by step. It is the one road forward in time.
//! - [`work`]: what a user makes of a scenario: changed values, pushes, the journal of both, undo.
//! - [`analysis`]: what a run's numbers are worth: theory, measurement, health, comparisons.
//! - [`export`]: what leaves the program: columns, CSV, summaries, and the files they are written to.
//! - [`observe`]: a run as it is watched: played at its pace, gone back into, and what the pictures need of it.
//! - [`storage`]: what outlasts the screen: sessions, and exports in the background.
//! - [`lab`]: what the user is working on, and everything that can be done to it.
//! - [`tui`]: the terminal: keys that lead to actions, and the panes that draw the lab.
//! - [`cli`]: the commands, and what each does with the rooms above.
//!
//! Frames: *world* has its origin at the pivot and +z up; *body* is fixed in the body and equals the world frame
//! in the upright pose. Units are SI throughout: metres, kilograms, seconds, newtons, J s; angles are radians
//! inside and degrees in names that end in `_deg`.

#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod analysis;
pub mod cli;
pub mod export;
pub mod lab;
pub mod observe;
pub mod physics;
pub mod run;
pub mod scenario;
pub mod storage;
pub mod text;
pub mod tui;
pub mod work;
