//! A run: a scenario and its journal of edits, played forward from step 0.
//!
//! [`Simulation`] is the one road forward in time; the command line, the exporters, the tests and any screen all
//! travel on it. [`clock`] says what time a step has, [`pushes`] which forces act on it, [`sample`] what is read off
//! after it. [`truth`] is the exact motion beside it, and [`resample`] the same run at another time step.

pub mod clock;
pub mod pushes;
pub mod resample;
pub mod sample;
pub mod simulation;
pub mod truth;

pub use clock::Clock;
pub use sample::Sample;
pub use simulation::{NotFinite, Simulation};
pub use truth::Truth;
