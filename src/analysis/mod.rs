//! What a run's numbers are worth: [`theory`] says what the top should do, [`measure`] and [`extremes`] what the run did,
//! [`frozen`] what the report's scheme should make of it,
//! [`slowing`] what friction does to it,
//! [`health`] what the time step made of it, [`remarks`] the same in words. [`readouts`] is the one table of all these
//! numbers under their names, [`at_end`] reads them off a run at its end, and [`compare`] holds schemes and time steps against the exact motion.
//!
//! These rooms follow a run and read it; none of them changes a number of it.

pub mod at_end;
pub mod beside;
mod between;
pub mod compare;
pub mod cost;
pub mod extremes;
pub mod frozen;
pub mod health;
pub mod measure;
pub mod monitor;
pub mod readouts;
pub mod remarks;
mod rows;
pub mod slowing;
mod swing;
mod swings;
pub mod theory;
mod tilt_swing;
pub mod trial;
mod turns;

pub use beside::Beside;
pub use extremes::Extremes;
pub use health::Health;
pub use measure::{Instruments, Measured};
pub use monitor::Monitor;
pub use readouts::Readouts;
pub use slowing::Slowing;
pub use theory::Theory;
pub use trial::Trial;
