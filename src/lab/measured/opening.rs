//! Putting measured data beside the run, and taking them away.

use crate::data::{self, Measured, shipped};
use crate::export::Destination;
use crate::lab::Lab;
use crate::lab::answer::{Answer, Done};
use crate::lab::files::Files;
use crate::lab::measured::Beside;
use crate::lab::player::Player;
use crate::scenario::{Problem, Problems, Scenario};
use crate::text::printable::printable;
use std::path::Path;

impl Files {
    /// Reads the measured data `name`: those that come with the program, or a file. `may_wait` says whether it may be a
    /// FIFO or a device, which is read for any length of time.
    fn open_measured(&self, name: &str, may_wait: bool) -> Result<Measured, Problems> {
        if shipped::find(name).is_none() {
            let refused = |rule: String| Problems::one(name, Problem::at("", rule));
            let path = Path::new(name);
            self.admit(path).map_err(refused)?;
            if !may_wait && Destination::may_wait(path) {
                let rule = "is not a regular file: gyrolab --measured can read it";
                return Err(refused(rule.to_owned()));
            }
        }
        data::open(name)
    }
}

impl Player {
    /// What is said of residuals that are shown from now on, or no longer.
    ///
    /// # Errors
    /// Where there are no measured data.
    pub(in crate::lab) fn residuals_in_words(&self, shown: bool) -> Result<&'static str, String> {
        if self.measured.is_none() {
            return Err(
                "there are no measured data beside the run: gyrolab --measured FILE".to_owned(),
            );
        }
        Ok(if shown {
            "measured less run, where something was measured; m shows both again"
        } else {
            "measured values and the run"
        })
    }
}

impl Lab {
    /// Puts the measured data `name` beside the run, as the command line wants it, or else those that the scenario's
    /// `[view]` names.
    pub fn begin_with_measured(&mut self, name: Option<&str>) -> Result<(), Problems> {
        let file = self.player.run().scenario().file.view.as_ref();
        let of_file = file.and_then(|view| view.measured.clone());
        let Some(name) = name.map(str::to_owned).or(of_file) else {
            return Ok(());
        };
        self.put_beside(&name, true)
    }

    /// Reads the measured data `name` and puts them beside the run.
    fn put_beside(&mut self, name: &str, may_wait: bool) -> Result<(), Problems> {
        let measured = self.files.open_measured(name, may_wait)?;
        if let Some(left_out) = measured.left_out_in_words() {
            self.tell(left_out);
        }
        self.player.measured = Some(Beside::new(name, measured, self.player.run().scenario())?);
        self.view.measured = true;
        self.player.catch_up_measured();
        self.read_now();
        Ok(())
    }

    /// Puts the measured data `name` beside the run, or takes away those that are there.
    pub(in crate::lab) fn measure(&mut self, name: Option<&str>) -> Answer {
        let Some(name) = name else {
            return Ok(Done::saying(if self.take_measured_away() {
                "the measured data are taken away"
            } else {
                "there are no measured data beside the run"
            }));
        };
        let put = self.put_beside(name, false);
        put.map_err(|problems| format!("{}: {}", problems.origin, problems.in_one_line()))?;
        Ok(Done::SILENT)
    }

    /// Takes the measured data away; returns whether there were any.
    fn take_measured_away(&mut self) -> bool {
        self.view.measured = false;
        self.player.measured.take().is_some()
    }

    /// To be called after another scenario was opened in place of `before`. Puts the data that its `[view]` names
    /// beside its run, and removes those that the `[view]` of `before` named.
    pub(in crate::lab) fn measure_as_opened(&mut self, before: &Scenario) {
        let named = |scenario: &Scenario| scenario.file.view.as_ref()?.measured.clone();
        let scenario = self.player.run().scenario();
        let shown = self.player.measured().map(|beside| beside.name.clone());
        let wanted = named(scenario);
        if wanted == shown || (wanted.is_none() && shown != named(before)) {
            return;
        }
        self.take_measured_away();
        if let Some(name) = wanted
            && let Err(problems) = self.put_beside(&name, false)
        {
            let why = format!("{}: {}", problems.origin, problems.in_one_line());
            self.tell(printable(&why));
        }
    }

    /// The name of the measured data beside the run, for a session. A file has its full path, unless the lab is
    /// confined to a folder.
    pub(in crate::lab) fn measured_to_keep(&self) -> Option<String> {
        let name = &self.player.measured()?.name;
        let is_whole = shipped::find(name).is_some() || self.files.confined().is_some();
        let whole = std::path::absolute(name).ok().filter(|_| !is_whole);
        let whole = whole.and_then(|path| path.to_str().map(str::to_owned));
        Some(whole.unwrap_or_else(|| name.clone()))
    }

    /// Puts the measured data of a session beside the run again. Returns a message where that is not possible.
    pub(in crate::lab) fn measure_as_kept(&mut self, name: &str) -> Option<String> {
        let problems = self.put_beside(name, false).err()?;
        let why = problems.in_one_line();
        Some(format!(
            "; the measured data {} are not beside it: {why}",
            printable(name)
        ))
    }
}
