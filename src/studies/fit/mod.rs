//! Fits: values for keys of a scenario so that its runs come nearest to what was measured, in the sense of weighted least
//! squares, with what the data say of these values and of the model.
//!
//! [`free`] says which keys are free, from where to where. A [`Model`] computes the runs for given values and holds them
//! against the data. `thrown` says where to begin for a body that flies freely, [`flights`] where a recording has free flights.
//! [`chart`] says in which parameters the search goes on, and within which limits. [`levenberg`] looks for the values, by
//! steps that [`within`] finds; [`weights`] says how much each datum counts, [`solution`] what the minimum says of the keys
//! and of the model, [`edge`] what it says where a limit holds them, [`verdict`] whether the model fits, in a sentence.
//! [`search`] brings these together to a [`Fit`], with each key as [`fitted`], [`report`] writes it for people and programs, and as a CSV.

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
