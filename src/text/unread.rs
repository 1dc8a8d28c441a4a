//! Why a file cannot be read, with what to do about it.

use std::io::{Error, ErrorKind};

/// What to say where reading a file that the user has named fails with `error`.
pub fn why(error: &Error) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_users_cause_comes_with_what_to_do() {
        let said = |kind: ErrorKind| why(&Error::from(kind));
        assert!(said(ErrorKind::NotFound).contains("check the name"));
        assert!(said(ErrorKind::PermissionDenied).contains("permissions"));
        assert!(said(ErrorKind::TimedOut).starts_with("cannot be read: "));
    }
}
