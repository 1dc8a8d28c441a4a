//! A lab at one moment, without what was done before: what a session keeps beside its history, and what a class follows.

use super::Lab;
use super::view::ViewSettings;
use crate::lab::playback::pace::Speed;
use serde::{Deserialize, Serialize};

/// A run at one of its steps, and how it is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The name under which the run was opened. A session has it in its history, as it has the run and its end.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The run file.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub run: String,
    /// When the run ends, s: an edit of the time step does not change it, and the run file does not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_s: Option<f64>,
    pub step: u64,
    pub speed: Speed,
    #[serde(alias = "exact")]
    pub shows_exact: bool,
    pub look: ViewSettings,
}

impl Lab {
    /// Returns the lab as it is now. Who has no history of its runs adds the run.
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
