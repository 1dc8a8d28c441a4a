//! What a run's numbers are worth: [`theory`] says what the top should do, [`measure`] what the run did, [`health`] what
//! the time step made of it, in one sentence, and [`compare`] holds schemes and time steps against the exact motion.
//!
//! These rooms follow a run and read it; none of them changes a number of it.

pub mod compare;
pub mod cost;
pub mod health;
pub mod measure;
pub mod monitor;
pub mod theory;
pub mod trial;

pub use health::Health;
pub use measure::{Instruments, Measured};
pub use monitor::Monitor;
pub use theory::Theory;
pub use trial::Trial;
