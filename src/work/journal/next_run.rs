//! A new run that begins with the present settings of the old one.

use super::{Act, Journal};
use crate::scenario::dotted::number_of_push;
use crate::scenario::file::ScenarioFile;
use crate::scenario::{Document, Problems, Scenario, rescale};
use crate::work::parameters;
use std::sync::Arc;
use toml::{Table, Value};

impl Journal {
    /// A new run with the values of `set` and an empty journal. From its start on it has the gravity, scheme, time step and
    /// pushes that this run has at `step`.
    ///
    /// # Errors
    /// Why the values are refused.
    pub fn begun_with(&self, step: u64, set: &Table) -> Result<(Self, Arc<Scenario>), Problems> {
        let scenario = Arc::new(parameters::changed_all(&self.settings_at(step)?, set)?);
        Ok((Self::of_checked(&scenario), scenario))
    }

    /// The base with gravity, scheme, time step and its own pushes as they are at `step`, without added pushes. The base
    /// keeps its time step where its pushes cannot be rescaled to the new one.
    fn settings_at(&self, step: u64) -> Result<ScenarioFile, Problems> {
        let mut document = Document::from_file("the run", &self.base)?;
        let mut time_step_s = self.base.motion.time_step_s;
        for entry in self.in_force_by(step) {
            let (Act::Edit(set) | Act::Describe(set)) = &entry.act else {
                continue;
            };
            for (key, value) in set {
                if key == "motion.time_step_s" {
                    time_step_s = number(value).unwrap_or(time_step_s);
                } else if !self.is_of_an_added_push(key) {
                    document.write(key, value.clone())?;
                }
            }
        }
        let file = document.file()?;
        Ok(if time_step_s == file.motion.time_step_s {
            file
        } else {
            rescale::at_time_step(&file, time_step_s).unwrap_or(file)
        })
    }

    fn is_of_an_added_push(&self, key: &str) -> bool {
        number_of_push(key).is_some_and(|number| number >= self.base.push.len())
    }
}

fn number(value: &Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| Some(value.as_integer()? as f64))
}
