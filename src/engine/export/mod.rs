//! Output of the program: [`columns`] are the tables of CSV columns and the rows of the body's points, [`layout`] says which
//! rows and columns a CSV has and what stands above them, [`mod@csv`] writes rows, [`stream`] plays a run and writes its rows, [`played`] is a run at its end,
//! [`summary`] describes how a run ended, [`destination`] is the file, folder or stream that is written.

pub mod columns;
pub mod csv;
pub mod destination;
pub mod layout;
pub mod played;
pub mod stream;
pub mod summary;
pub mod temporary;

pub use columns::{COLUMNS, CsvColumn};
pub use csv::CsvWriter;
pub use destination::{Destination, OutputFolder};
pub use layout::CsvLayout;
pub use played::PlayedRun;
pub use summary::RunSummary;
