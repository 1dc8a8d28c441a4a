//! What many runs say, and what an exported run is worth: sweeps, verification, write-ups.
//!
//! - [`writeup`]: a run as a folder of files for a write-up.

pub mod writeup;
