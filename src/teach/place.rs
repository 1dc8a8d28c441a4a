//! Where a lesson was left.

use super::Kept;
use super::predictions::Predictions;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// The number of the page, from 1.
    pub page: usize,
    #[serde(default)]
    pub predictions: Predictions,
    #[serde(default)]
    pub kept: Kept,
    /// Whether its last page was opened.
    #[serde(default)]
    pub has_ended: bool,
    /// When it was opened first: seconds since 1970 (UTC).
    #[serde(default)]
    pub began_unix_s: u64,
}
