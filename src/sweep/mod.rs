//! Sweeps: a grid of runs; each run becomes a row.
//!
//! A [`SweepFile`] is the TOML: a scenario, the keys that vary, the readouts. Checked it is a [`Sweep`],
//! which knows its points and computes the row of any of them. [`in_order`] does so on all cores, [`part`] keeps the rows
//! of a sweep that is not whole yet, [`join`] makes one CSV of the shards, [`shipped`] are the sweeps of the program.
//!
//! A row depends on the sweep and on its own point alone: threads, shards and interruptions change no byte of it.

pub mod axis;
mod empty_rows;
pub mod file;
mod grid;
pub mod in_order;
pub mod join;
pub mod part;
pub mod shard;
pub mod shipped;

pub use empty_rows::EmptyRows;
pub use file::SweepFile;
pub use grid::{Sweep, SweepRow};
pub use shard::Shard;
