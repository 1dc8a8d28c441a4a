//! Fits: finds values of scenario keys whose runs come closest to measured data by weighted least squares, with
//! uncertainties and a test of the model.
//!
//! - Input: [`free`] defines the free keys and their bounds, [`weights`] the weight of each datum. A [`Model`] computes
//!   the runs for given values and compares them with the data.
//! - Start: `thrown` suggests start values for a body that flies freely. [`flights`] finds the free flights in a
//!   recording.
//! - Search: [`chart`] defines the parameters of the search and their limits. [`levenberg`] finds the minimum, in steps
//!   that [`within`] computes.
//! - Result: [`solution`] holds uncertainties and quality, [`edge`] treats keys at a limit, and [`verdict`] says in one
//!   sentence if the model fits.
//!
//! [`search`] combines these into a [`Fit`] whose keys are [`fitted`]. [`report`] writes it as text, JSON and CSV.

pub mod chart;
pub mod edge;
pub mod fitted;
pub mod flights;
pub mod free;
pub mod levenberg;
pub mod model;
pub mod report;
pub mod search;
pub mod solution;
pub mod thrown;
pub mod verdict;
pub mod weights;
pub mod within;

pub use free::Free;
pub use model::Model;
pub use search::{Fit, NoFit, fit};
