//! The lab as a session left it.

use super::{KeptCamera, KeptPinned, KeptPlace, KeptScript, KeptWork, Unreadable, read};
use crate::lab::command::{self, Commands};
use crate::lab::script::{GO_ON_WITH_IT, GO_ON_WITH_THEM};
use crate::lab::view::step::Page;
use crate::lab::view::{Part, View};
use crate::lab::{Lab, Script, Work, opening};
use crate::observe::camera::{Camera, Zoom};
use crate::observe::pace::Speed;
use crate::observe::recording::Curve;
use crate::scenario::{Document, Problems, Scenario};
use crate::storage::confined::Confined;
use crate::storage::session::Content;
use std::path::Path;
use std::sync::Arc;

impl Lab {
    /// The lab with `content`: on its way to the step where it stood, and paused there. `view` returns how its run is
    /// shown on this screen.
    pub fn resumed(
        content: &Content,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        Self::resumed_in(content, None, view)
    }

    /// As [`resumed`](Self::resumed), for a lab that reads and writes in the folder `confined` only, if one is given.
    pub fn resumed_in(
        content: &Content,
        confined: Option<&Confined>,
        view: impl FnOnce(&Scenario) -> View,
    ) -> Result<Self, Unreadable> {
        let mut work: KeptWork = read("the run", &content.work)?;
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
        let pinned = work.pinned.take().map(KeptPinned::reference);
        lab.work = Work::resumed(work.history, &file);
        lab.values.set_next_push(place.next_push);
        lab.values.suit(lab.player.run().scenario());
        lab.player.playback.set_end(lab.work.present().end_s);
        lab.player
            .playback
            .set_speed(place.speed.map_or(Speed::Top, Speed::Times));
        lab.player.playback.set_exact(place.shows_exact);
        lab.player.return_to(place.step);
        lab.scenario_has_changed();
        let mut told = match &place.exporting {
            Some(path) => {
                format!("as it was left; the export to {path} was cut off, x begins another")
            }
            None => "as it was left; space goes on".to_owned(),
        };
        match place.script.map(|kept| kept.commands()) {
            None => {}
            Some(Ok(commands)) => {
                told = left_of(&commands);
                lab.script = Script::held(commands);
            }
            Some(Err(problems)) => {
                let reason = problems.in_one_line();
                told += &format!("; the rest of its script is lost: {reason}");
            }
        }
        match pinned {
            None => {}
            Some(Ok(reference)) => lab.player.pin_again(reference),
            Some(Err(problems)) => {
                told += &format!("; the pinned run is lost: {}", problems.in_one_line());
            }
        }
        if let Some(name) = &place.measured {
            told += &lab.measure_as_kept(name).unwrap_or_default();
        }
        lab.lessons = place.lessons;
        lab.tell(told);
        lab.read_now();
        Ok(lab)
    }

    /// The scenario as the user opened it, if its file can still be read; otherwise the present one.
    fn file_as_opened(&self) -> Arc<Scenario> {
        let (name, run) = (self.work.name(), self.player.run());
        if self.files.admit(Path::new(name)).is_err() {
            return Arc::clone(run.scenario());
        }
        let file = opening::read(name).and_then(|document| document.scenario());
        file.map_or_else(|_| Arc::clone(run.scenario()), Arc::new)
    }
}

impl KeptPlace {
    /// Shows in `view` what the session showed. A number of it that makes no sense is passed over; `time_step_s` is the
    /// run's, s.
    fn restore(&self, view: &mut View, time_step_s: f64) -> Result<(), Unreadable> {
        view.focus = view
            .kept_as(&self.focus)
            .ok_or_else(|| Unreadable(format!("there is no pane {}", self.focus)))?;
        view.filled = self.filled;
        if let Some(ids) = &self.show {
            view.shown = ids.iter().filter_map(|id| view.kept_as(id)).collect();
            view.side_by_side = view.to_show();
        }
        if let Some(ids) = &self.hide {
            view.hidden = ids.iter().filter_map(|id| Part::named(id)).collect();
        }
        (view.look_at, view.next) = (self.look_at.clone(), self.next.clone());
        view.bare = self.bare.unwrap_or(false);
        view.residuals = self.residuals.unwrap_or(false);
        view.page = self.phase.as_ref().and_then(Page::of).unwrap_or_default();
        view.sum_to = self.sum_to;
        if let Some(KeptCamera { yaw_deg, pitch_deg }) = self.camera
            && yaw_deg.is_finite()
            && (-90.0..=90.0).contains(&pitch_deg)
        {
            view.look_from(Camera { yaw_deg, pitch_deg });
        }
        if let Some(zoom) = self.zoom {
            view.zoom = Zoom::of(zoom);
        }
        if self.window_s.is_finite() && self.window_s >= 2.0 * time_step_s {
            view.window_s = self.window_s;
        }
        let is_time = |time_s: &f64| time_s.is_finite() && *time_s > 0.0;
        view.detail_s = self.detail_s.filter(is_time).or(view.detail_s);
        let detail_of = self.detail_of.as_deref().and_then(Curve::of_name);
        view.detail_of = detail_of.or(view.detail_of);
        Ok(())
    }
}

/// What is said of `commands`, those of a script that are not carried out yet.
fn left_of(commands: &Commands) -> String {
    let origin = &commands.origin;
    match commands.list.len() {
        1 => format!("1 command of {origin} is left: {GO_ON_WITH_IT}"),
        count => format!("{count} commands of {origin} are left: {GO_ON_WITH_THEM}"),
    }
}

impl KeptScript {
    /// The commands to be carried out.
    fn commands(&self) -> Result<Commands, Problems> {
        let read = |text: &str| {
            let document = Document::parse(&self.origin, text)?;
            command::read(&document)
        };
        let mut commands = read(&self.first)?;
        commands.list.extend(read(&self.left)?.list);
        for placed in &mut commands.list {
            placed.line = None; // the line in the user's file is not kept
        }
        Ok(commands)
    }
}
