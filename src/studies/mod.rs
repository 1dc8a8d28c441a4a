//! Studies: many runs at once, or a run compared with other data.
//!
//! - [`sweep`]: a grid of runs, a row each.
//! - [`table`]: the CSVs that are no run: those of a comparison, a sweep or a fit.
//! - [`fit`]: keys of a scenario so that its runs come nearest to measured data.
//! - [`verify`](mod@verify): a CSV, computed again and compared with its rows.
//! - [`own_code`]: rows that somebody's own program of the report's scheme wrote, compared with it: which slip made them?
//!
//! They use the engine and no page: what draws their tables belongs to [`report`](crate::report).

pub mod fit;
pub mod own_code;
pub mod sweep;
pub mod table;
pub mod verify;
