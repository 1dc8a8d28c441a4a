//! A run: a scenario and its journal of edits, played forward from step 0.
//!
//! [`Simulation`] alone takes a run forward in time; the command line, exports, tests and the screen all use it.
//! [`step`] is what it publishes of each time step, and what its energy drift is measured in. [`clock`] says what time a
//! step has, [`pushes`] which forces act on it, [`marks`] when they do, [`Sample`] what of it leaves the program, [`moment`] what is
//! compared with the exact motion. [`truth`] is the exact motion
//! beside it, and [`resampled`] the same run at another time step.

pub mod clock;
pub mod marks;
pub mod moment;
pub mod pushes;
pub mod simulation;
pub mod step;
pub mod truth;

pub use clock::{Clock, resampled};
pub use moment::Moment;
pub use simulation::{NotFinite, Simulation};
pub use step::{EnergyScale, EnergyUnit, Sample, Step};
pub use truth::Truth;
