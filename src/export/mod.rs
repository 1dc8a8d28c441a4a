//! Output of the program: [`columns`] and [`points`] are the tables of CSV columns, [`layout`] says which rows and columns
//! a CSV has, [`mod@csv`] writes rows, [`comments`] are the lines above them, [`stream`] plays a run and writes its rows,
//! [`summary`] describes how a run ended, [`destination`] is the file or stream that is written, [`folder`] a folder of
//! files.

pub mod columns;
pub mod comments;
pub mod csv;
pub mod destination;
pub mod folder;
pub mod layout;
pub mod points;
pub mod stream;
pub mod summary;
pub mod temporary;

pub use columns::{COLUMNS, Column};
pub use csv::CsvWriter;
pub use destination::Destination;
pub use folder::Folder;
pub use layout::Layout;
pub use summary::Summary;
