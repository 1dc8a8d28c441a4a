//! What a run's numbers are worth: [`theory`] says what the top should do, [`monitor`] and [`extremes`] what the run did,
//! [`report_theory`] what the report's scheme should make of it, [`slowing`] what friction does to it, [`health`] what the
//! time step made of it, [`predictability`] how long the motion can be predicted at all, [`verdict`] and [`remarks`] the same in words.
//! [`readouts`] is the one table of all these numbers under their names, and [`compare`] holds schemes and time steps against the exact motion.
//!
//! These rooms follow a run and read it; none of them changes a number of it.

mod beats;
pub mod compare;
pub mod cost;
pub mod deviation;
mod equations;
pub mod extremes;
mod foot_force;
pub mod health;
pub mod monitor;
mod parabolas;
pub mod predictability;
pub mod readouts;
pub mod remarks;
pub mod report_theory;
pub mod slowing;
mod swings;
pub mod theory;
mod turning_points;
mod turns;
pub mod verdict;

pub use deviation::ExactReference;
pub use extremes::Extremes;
pub use health::Health;
pub use monitor::{Instruments, Monitor};
pub use predictability::Predictability;
pub use readouts::Readouts;
pub use slowing::FrictionEffect;
pub use theory::Theory;
pub use turns::{MeasuredNumber, WithoutNutation};
