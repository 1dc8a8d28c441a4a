//! What leaves the program: [`columns`] names the numbers, [`mod@csv`] writes them, [`stream`] plays a run into it, [`summary`] says how a
//! run ended, and [`destination`] is where they are written, whole or not at all.

pub mod columns;
pub mod csv;
pub mod destination;
pub mod stream;
pub mod summary;

pub use columns::{COLUMNS, Column};
pub use csv::CsvWriter;
pub use destination::Destination;
pub use summary::Summary;
