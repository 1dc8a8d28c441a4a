//! Why a file cannot be written, with what to do about it.

use std::io::{Error, ErrorKind};

/// What to say where writing a file that the user has named fails with `error`: the system's words, and what would help.
pub fn why(error: &Error) -> String {
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

/// `error` with what would help.
pub fn advised(error: &Error) -> Error {
    Error::new(error.kind(), why(error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_users_can_mend_comes_with_what_to_do() {
        let said = |kind: ErrorKind| why(&Error::from(kind));
        assert!(
            said(ErrorKind::PermissionDenied)
                .ends_with(": name a file in a folder that you may write to")
        );
        assert!(said(ErrorKind::StorageFull).contains("free some room"));
        assert_eq!(
            said(ErrorKind::TimedOut),
            Error::from(ErrorKind::TimedOut).to_string()
        );
    }
}
