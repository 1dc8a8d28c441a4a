//! What a user does to a scenario: changed values, pushes, and the journal of both with its undo.
//!
//! - [`parameters`] lists and changes the values of a scenario, [`next_push`] those of the push that the user prepares.
//! - [`journal`] records what the user did in one run and computes the run's scenario from it; [`history`] keeps the
//!   journals of all runs of a session and undoes and redoes across them.
//! - [`expression`] reads and evaluates conditions over a run's numbers.
//! - [`mended`] makes the run that follows an advice; [`restart`] makes a scenario that starts where a run stands;
//!   [`changed`] says how a scenario differs from its file.

pub mod changed;
pub mod expression;
pub mod history;
pub mod journal;
pub mod mended;
pub mod next_push;
pub mod parameters;
pub mod restart;
