//! What leaves the program: [`columns`] names the numbers, [`mod@csv`] writes them, [`stream`] plays a run into it, [`summary`] says how a run ended and [`readouts`] what it is worth,
//! and [`destination`] is where they are written, whole or not at all.

pub mod columns;
pub mod csv;
pub mod destination;
pub mod readouts;
pub mod stream;
pub mod summary;

pub use columns::{COLUMNS, Column};
pub use csv::CsvWriter;
pub use destination::Destination;
pub use readouts::Readouts;
pub use summary::Summary;
