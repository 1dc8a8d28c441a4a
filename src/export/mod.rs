//! Output of the program: [`columns`] is the table of CSV columns, [`mod@csv`] writes rows, [`stream`] plays a run and
//! writes its rows, [`summary`] describes how a run ended, and [`destination`] is the file or stream that is written,
//! [`folder`] a folder of files.

pub mod columns;
pub mod csv;
pub mod destination;
pub mod folder;
pub mod stream;
pub mod summary;

pub use columns::{COLUMNS, Column};
pub use csv::CsvWriter;
pub use destination::Destination;
pub use folder::Folder;
pub use summary::Summary;
