//! The result of a command: its effect, or the reason why it was refused.

use crate::engine::scenario::Problems;
use std::path::PathBuf;
use std::time::Duration;

/// The effect of a command that was carried out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// The message; `None` if the screen shows the effect by itself.
    pub said: Option<String>,
    /// True if the message stays until the next key instead of a few seconds.
    pub stays: bool,
    /// The action that the command started and that takes time; `None` if the command is complete.
    pub under_way: Option<PendingAction>,
}

/// An action that takes time. [`Lab::advance`](super::Lab::advance) continues it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PendingAction {
    Going,
    /// The run plays until a condition holds.
    Playing,
    /// The script waits until this time on the lab's clock.
    Waiting(Duration),
    Exporting,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The file exists, and the command does not allow replacing it.
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
    /// A complete command without a message.
    pub(super) const SILENT: Self = Self {
        said: None,
        stays: false,
        under_way: None,
    };

    /// Creates the result of a complete command, with the message `text` for a few seconds.
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
