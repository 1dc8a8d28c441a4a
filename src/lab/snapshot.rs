//! The state of a lab at one moment, without the history of edits. Sessions and classes save it.

use super::Lab;
use super::view::ViewSettings;
use crate::lab::playback::pace::Speed;
use serde::{Deserialize, Serialize};

/// A run at one of its steps, and how it is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The name under which the run was opened. Sessions leave `name`, `run` and `end_s` empty, because their journal
    /// contains them.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The run file, as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub run: String,
    /// Time at which the run ends, s. The run file does not contain it, and an edit of the time step does not change
    /// it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_s: Option<f64>,
    pub step: u64,
    pub speed: Speed,
    #[serde(alias = "exact")]
    pub shows_exact: bool,
    pub look: ViewSettings,
}

impl Lab {
    /// Returns the present state of the lab. A caller that does not save the journal must fill in `name`, `run` and
    /// `end_s`.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            name: String::new(),
            run: String::new(),
            end_s: None,
            step: self.player.step_to_keep(),
            speed: self.player.speed(),
            shows_exact: self.player.run().shows_exact(),
            look: self.view.look.clone(),
        }
    }
}
