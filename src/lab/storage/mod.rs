//! The lab's data on the disk.
//!
//! - [`session`]: sessions that can be resumed.
//! - [`settings`]: settings that the user chose.
//! - [`exporting`]: exports in the background.
//! - [`at_exit`]: hooks that save or clean up however the process ends.
//! - [`confined`]: restricts paths to one folder.
//! - [`shared`]: reads and writes the files that two accounts share.

pub mod at_exit;
pub mod confined;
pub mod exporting;
mod private_files;
pub mod session;
mod session_file;
pub mod settings;
pub mod shared;
