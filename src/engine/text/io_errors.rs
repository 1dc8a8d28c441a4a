//! Why a file that the user has named cannot be read or written, with what to do about it.

use std::io::{Error, ErrorKind};

/// What to say where reading a file fails with `error`.
pub fn unread(error: &Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => {
            "there is no such file: check the name, and the folder you are in".to_owned()
        }
        ErrorKind::PermissionDenied => {
            "may not be read by you: change its permissions, or ask its owner".to_owned()
        }
        _ => format!("cannot be read: {error}"),
    }
}

/// What to say where writing a file fails with `error`: the system's words, and what would help.
pub fn unwritten(error: &Error) -> String {
    let advice = match error.kind() {
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "name a file in a folder that you may write to"
        }
        ErrorKind::NotFound => "name a file in a folder that exists",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "free some room, or name a file on another disk"
        }
        _ => return error.to_string(),
    };
    format!("{error}: {advice}")
}

/// `error` of writing a file, with what would help.
pub fn advised(error: &Error) -> Error {
    Error::new(error.kind(), unwritten(error))
}
