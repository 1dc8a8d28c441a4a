//! Opening a preset or a file while the lab is on the screen.

use crate::export::Destination;
use crate::scenario::{Document, Problem, Problems, presets};
use std::path::Path;

/// Reads the preset or the file called `name`. A FIFO or a device is refused: reading it may wait for any length of time,
/// which only the command line can do.
///
/// # Errors
/// Why it cannot be read.
pub(super) fn read(name: &str) -> Result<Document, Problems> {
    if presets::find(name).is_none() && Destination::may_wait(Path::new(name)) {
        let rule = "is not a regular file: it can be opened at the command line only";
        return Err(Problems::one(name, Problem::at("", rule)));
    }
    Document::open(name)
}
