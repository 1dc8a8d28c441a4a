//! Error messages for files that cannot be read or written, with advice.

use std::io::{Error, ErrorKind};

/// Returns the message for an `error` of reading a file.
pub fn unread(error: &Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => {
            "there is no such file: check the name and the current folder".to_owned()
        }
        ErrorKind::PermissionDenied => {
            "cannot be read, because you lack permission: change its permissions, or ask its owner"
                .to_owned()
        }
        _ => format!("cannot be read: {error}"),
    }
}

/// Returns the message for an `error` of writing a file: the system's words and advice.
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

/// Returns the `error` of writing a file with advice added to its message.
pub fn advised(error: &Error) -> Error {
    Error::new(error.kind(), unwritten(error))
}
