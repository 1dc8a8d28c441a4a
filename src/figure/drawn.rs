//! A figure of runs, as it was drawn.

use super::dense::Dense;
use super::page::scene::Scene;

#[derive(Clone, Debug)]
pub struct Figure {
    pub scene: Scene,
    /// Warnings but for that of `dense`, each a sentence without its end.
    pub warnings: Vec<String>,
    /// What covers the paper so densely that it is solid black, where something does.
    pub dense: Option<Dense>,
    /// Which run's numbers stopped being finite, and at which step.
    pub broke: Option<String>,
}

impl Figure {
    /// All that its reader should know of it, each a sentence without its end.
    pub fn told(&self) -> impl Iterator<Item = String> + '_ {
        let dense = self.dense.iter().map(ToString::to_string);
        self.warnings.iter().cloned().chain(dense)
    }
}
