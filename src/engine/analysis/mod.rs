//! Measures a run, and judges how reliable its numbers are.
//!
//! - [`theory`]: the predicted motion of the top; [`report_theory`]: the same for the report's scheme.
//! - [`monitor`] and [`extremes`]: measurements of the run; [`slowing`]: the effect of friction.
//! - [`health`]: the effect of the time step; [`predictability`]: how long the motion can be predicted at all.
//! - [`verdict`] and [`remarks`]: the same in words.
//! - [`readouts`]: the table of all these numbers and their names. A new number also gets its row there.
//! - [`compare`]: schemes and time steps compared with the exact motion.
//!
//! These modules read a run. None of them changes its numbers.

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

pub use deviation::{DistanceMeter, ExactReference};
pub use extremes::Extremes;
pub use health::Health;
pub use monitor::{Instruments, Monitor};
pub use predictability::Predictability;
pub use readouts::Readouts;
pub use slowing::FrictionEffect;
pub use theory::Theory;
pub use turns::{MeasuredNumber, WithoutNutation};
