//! A run: a scenario and its edits, played forward from step 0.
//!
//! - [`Simulation`]: takes a run forward in time. No other type does: the command line, exports, tests and the screen
//!   all use it.
//! - [`step`]: the record of one time step, and the unit of its energy error.
//! - [`clock`]: the time of a step; [`resampled`] is the same run at another time step.
//! - [`pushes`]: the forces on a step; [`marks`]: the times at which they act.
//! - [`Sample`]: the numbers of a step for output. [`moment`]: the numbers that are compared with the exact motion.
//! - [`truth`]: the exact motion of the same scenario.

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
