//! The lab as a session left it.

use super::{KeptPinned, KeptPlace, KeptScript, KeptWork, Unreadable, read};
use crate::lab::command::{self, Commands};
use crate::lab::view::View;
use crate::lab::{Lab, Script, Work, opening};
use crate::scenario::{Document, Problems, Scenario, keys};
use crate::storage::confined::Confined;
use crate::storage::session::Content;
use std::path::Path;
use std::sync::Arc;
use toml::Value;

impl Lab {
    /// The lab with `content`: on its way to the step where it stood, and paused there. `view` returns how its run is
    /// shown on this screen. If `confined` is given, the lab reads and writes in that folder only.
    pub fn resumed(
        content: &Content,
        confined: Option<&Confined>,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        let work: KeptWork = read("the run", &content.work)?;
        let place: KeptPlace = read("the place in it", &content.place)?;
        let unreadable = |problems: Problems| Unreadable(problems.in_one_line());
        work.history.check().map_err(unreadable)?;
        let scenario = work.history.scenario().map_err(unreadable)?;
        let present = work.history.present();
        let mut view = view(&scenario);
        place.restore(&mut view, scenario.motion.time_step_s)?;
        let mut lab = Self::new(&present.name.clone(), scenario, view, false);
        if let Some(folder) = confined {
            lab.files.confine(folder.clone());
        }
        let file = lab.file_as_opened();
        lab.work = Work::resumed(work.history, &file);
        lab.values.next_push = place.next_push.clone();
        lab.values.suit(lab.player.run().scenario());
        let playback = &mut lab.player.playback;
        playback.set_end(lab.work.present().end_s);
        playback.set_speed(place.speed);
        playback.set_exact(place.shows_exact);
        lab.player.return_to(place.step);
        lab.scenario_has_changed();
        lab.take_up(place, work.pinned);
        lab.read_now();
        Ok(lab)
    }

    /// Takes up what may be lost without the run: the script, the pinned run, the measured data and the lesson. Says what
    /// is there again, and what is lost.
    fn take_up(&mut self, place: KeptPlace, pinned: Option<KeptPinned>) {
        let mut told = match &place.exporting {
            Some(path) => {
                format!("as it was left; the export to {path} was cut off, x begins another")
            }
            None => "as it was left; space goes on".to_owned(),
        };
        match place.script.map(|kept| kept.commands()) {
            None => {}
            Some(Ok(commands)) => {
                self.script = Script::held(commands);
                told = self.script.left_in_words();
            }
            Some(Err(problems)) => {
                let reason = problems.in_one_line();
                told += &format!("; the rest of its script is lost: {reason}");
            }
        }
        match pinned.map(KeptPinned::reference) {
            None => {}
            Some(Ok(reference)) => self.player.pin_again(reference),
            Some(Err(problems)) => {
                told += &format!("; the pinned run is lost: {}", problems.in_one_line());
            }
        }
        if let Some(name) = &place.measured {
            told += &self.measure_as_kept(name).unwrap_or_default();
        }
        self.lessons = place.lessons;
        self.tell(told);
    }

    /// The scenario as the user opened it, if its file can still be read; otherwise the present one.
    fn file_as_opened(&self) -> Arc<Scenario> {
        let (name, run) = (self.work.name(), self.player.run());
        if self.files.admit_reading(Path::new(name)).is_err() {
            return Arc::clone(run.scenario());
        }
        let file = opening::read(name).and_then(|document| document.scenario());
        file.map_or_else(|_| Arc::clone(run.scenario()), Arc::new)
    }
}

impl KeptPlace {
    /// Shows in `view` what the session showed. A window of less than two time steps of the run, `time_step_s`, is passed
    /// over.
    fn restore(&self, view: &mut View, time_step_s: f64) -> Result<(), Unreadable> {
        let look = Value::try_from(&self.look).map_err(|error| Unreadable(error.to_string()))?;
        if let Some(problem) = keys::check_part(&look, "view").list.first() {
            return Err(Unreadable(problem.to_string()));
        }
        let mut look = self.look.clone();
        if look.window_s < 2.0 * time_step_s {
            look.window_s = view.window_s;
        }
        view.take(look);
        let focus = view.panes.iter().find(|pane| pane.id() == self.focus);
        let unknown = || Unreadable(format!("there is no pane {}", self.focus));
        view.focus = *focus.ok_or_else(unknown)?;
        view.filled = self.filled;
        Ok(())
    }
}

impl KeptScript {
    /// The commands to be carried out.
    fn commands(&self) -> Result<Commands, Problems> {
        let document = Document::parse(&self.origin, &self.commands)?;
        let mut commands = command::read(&document)?;
        for placed in &mut commands.list {
            placed.line = None; // the line in the user's file is not kept
        }
        Ok(commands)
    }
}
