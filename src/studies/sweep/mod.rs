//! Sweeps: a grid of runs; each run becomes a row.
//!
//! A [`SweepFile`] is the TOML: a scenario, the keys that vary, the readouts. Checked it is a [`Sweep`],
//! which knows its points and computes the row of any of them. [`in_order`] does so on all cores, [`part`] keeps the rows
//! of a sweep that is not whole yet, [`join`] makes one CSV of the shards.
//!
//! A row depends on the sweep and on its own point alone: threads, shards and interruptions change no byte of it.

pub mod axis;
pub mod file;
mod grid;
pub mod in_order;
pub mod join;
pub mod part;

use crate::engine::text::shipped::{Shipped, shipped};
pub use file::{MAP, Shard, SweepFigure, SweepFile};
pub use grid::{Reliability, Sweep, SweepRow, TIME_STEP};
pub use part::{EmptyRows, ReliabilityCount, RowTally};

/// The sweeps that come with the program, compiled in.
pub const SWEEPS: &[Shipped] = shipped!["../../../presets/sweeps", "toml":
    "wobble-over-time-step"
    "precession-over-momentum"
    "precession-over-tilt"
];

pub fn find(name: &str) -> Option<&'static Shipped> {
    Shipped::find(SWEEPS, name)
}
