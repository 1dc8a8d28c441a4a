//! Studies: many runs at once, or a run compared with other data.
//!
//! It uses the [`engine`](crate::engine), and draws nothing: figures of its tables belong to [`report`](crate::report). A new
//! study that computes many runs, or checks a file by computing it again, belongs here.
//!
//! - [`sweep`]: a grid of runs, a row each.
//! - [`table`]: the CSVs that are no run: those of a comparison, a sweep or a fit.
//! - [`fit`]: keys of a scenario so that its runs come nearest to measured data.
//! - [`verify`](mod@verify): a CSV, computed again and compared with its rows.
//! - [`own_code`]: rows that somebody's own program of the report's scheme wrote, compared with it: which slip made them?

pub mod fit;
pub mod own_code;
pub mod sweep;
pub mod table;
pub mod verify;
