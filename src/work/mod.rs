//! What a user makes of a scenario: values changed one at a time, pushes, and the journal of both with its undo.
//!
//! - [`parameters`] lists and changes the values of a scenario, [`next_push`] those of the push to come.
//! - [`journal`] holds what was done in one run and makes a scenario of it, [`history`] the runs of a session, for undo
//!   and redo.
//! - [`expression`] reads and evaluates conditions over a run's numbers.
//! - [`restart`] makes a scenario that starts where a run stands; [`changed`] says in which way a scenario differs from
//!   its file.

pub mod changed;
pub mod expression;
pub mod history;
pub mod journal;
pub mod next_push;
pub mod parameters;
pub mod restart;

pub use parameters::Parameter;
