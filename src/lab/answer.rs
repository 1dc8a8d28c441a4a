//! The result of a command: what it has done, or why it was refused.

use crate::engine::scenario::Problems;
use std::path::PathBuf;
use std::time::Duration;

/// The result of a command that was carried out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// The message about it; `None` where the screen shows the result.
    pub said: Option<String>,
    /// Whether the message stays until the next key, instead of a few seconds.
    pub stays: bool,
    /// The action that the command has started and that takes time; `None` if the command is complete.
    pub under_way: Option<PendingAction>,
}

/// An action that takes time; [`Lab::advance`](super::Lab::advance) continues it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PendingAction {
    Going,
    /// The run plays until a condition holds.
    Playing,
    /// The script waits until the clock shows this time.
    Waiting(Duration),
    Exporting,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The file exists and may not be replaced.
    #[error("{0} exists: force = true replaces it, as in {{ path = \"FILE\", force = true }}")]
    Exists(PathBuf),
    #[error("{0}")]
    Because(String),
}

impl From<String> for Refusal {
    fn from(reason: String) -> Self {
        Self::Because(reason)
    }
}

impl From<&str> for Refusal {
    fn from(reason: &str) -> Self {
        Self::Because(reason.to_owned())
    }
}

impl From<Problems> for Refusal {
    fn from(problems: Problems) -> Self {
        Self::Because(problems.in_one_line())
    }
}

impl Done {
    /// The command is complete and there is no message.
    pub(super) const SILENT: Self = Self {
        said: None,
        stays: false,
        under_way: None,
    };

    /// Reports a complete command; the message `text` stays for a few seconds.
    pub(super) fn saying(text: impl Into<String>) -> Self {
        Self::saying_any(Some(text.into()))
    }

    pub(super) fn saying_any(said: Option<String>) -> Self {
        Self {
            said,
            ..Self::SILENT
        }
    }

    pub(super) fn going_on(self, under_way: PendingAction) -> Self {
        Self {
            under_way: Some(under_way),
            ..self
        }
    }
}

pub type ActionResult = Result<Done, Refusal>;
