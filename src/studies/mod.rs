//! Studies: many runs at once, or a run compared with other data.
//!
//! The module uses the [`engine`](crate::engine) and draws nothing: figures of its tables belong to
//! [`report`](crate::report). Put a new study here if it computes many runs, or checks a file by recomputing it.
//!
//! - [`sweep`]: a grid of runs, one row per run.
//! - [`table`]: CSVs that do not contain a run: the tables of a comparison, a sweep or a fit.
//! - [`fit`]: fits keys of a scenario to measured data.
//! - [`verify`](mod@verify): recomputes a CSV and compares the rows.
//! - [`own_code`]: compares the rows of a reader's own program with the report's scheme and names the mistake.

pub mod fit;
pub mod own_code;
pub mod sweep;
pub mod table;
pub mod verify;
