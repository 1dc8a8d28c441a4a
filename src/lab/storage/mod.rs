//! What the lab keeps on the disk: [`session`]s that can be resumed, [`settings`] that the user chose, and [`exporting`] in
//! the background. [`at_exit`] holds the hooks that save or clean up however the process ends; [`confined`] restricts paths
//! to one folder; [`shared`] reads and writes the files that two accounts share.

pub mod at_exit;
pub mod confined;
pub mod exporting;
mod private_files;
pub mod session;
mod session_file;
pub mod settings;
pub mod shared;
