//! Errors of a verification, and the remark on files of another version.

use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::io_errors::unread;
use crate::engine::text::printable::printable;
use std::io;

#[derive(Debug, thiserror::Error)]
pub enum Unverified {
    /// The file is not a CSV from gyrolab, or its header cannot be recomputed.
    #[error("{0}")]
    Refused(Problems),
    #[error("stopped")]
    Stopped,
}

impl From<Problems> for Unverified {
    fn from(problems: Problems) -> Self {
        Self::Refused(problems)
    }
}

impl From<String> for Unverified {
    fn from(rule: String) -> Self {
        Problems::one("", Problem::at("", rule)).into()
    }
}

impl From<io::Error> for Unverified {
    fn from(error: io::Error) -> Self {
        unread(&error).into()
    }
}

/// Returns a remark if another version of gyrolab wrote the file.
pub fn other_version(version: &str) -> Option<String> {
    let own = env!("CARGO_PKG_VERSION");
    let version = printable(version);
    (version != own).then(|| format!("written by gyrolab {version}, recomputed by gyrolab {own}"))
}
