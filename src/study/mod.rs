//! What many runs say, and what an exported run is worth: sweeps, verification, write-ups.

pub mod verify;
