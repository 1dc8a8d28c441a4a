//! Carries commands out. Each returns what it has done, or why it was refused.

use super::Lab;
use super::answer::{Answer, Done, UnderWay};
use super::command::{Command, Export, Figure, Force, PushChoice, Save};
use super::work::Way;
use crate::journal::Act;
use crate::journal::next_push::NextPush;
use crate::scenario::problem::nearest;
use crate::scenario::{Scenario, keys};
use std::sync::Arc;
use std::time::Duration;
use toml::Table;

impl Lab {
    /// Carries `command` out. An action that takes time is only started: [`advance`](Self::advance) continues it.
    ///
    /// # Errors
    /// Why the command was refused. It has then changed nothing; but `undo` and `redo` of more acts than there are have
    /// undone or redone all.
    pub fn carry_out(&mut self, command: &Command) -> Answer {
        if !matches!(command, Command::Nudge { .. }) {
            self.values.forget_nudge();
        }
        let answer = self.done(command);
        self.view.keep_focus();
        self.read_now();
        answer
    }

    fn done(&mut self, command: &Command) -> Answer {
        match command {
            Command::Open(name) => self.open_named(name),
            Command::Set(table) => self.set_all(table, false),
            Command::Nudge { key, times } => self.nudge(key, *times),
            Command::Push(choice) => self.push(choice),
            Command::NextPush(choice) => Ok(self.choose_next_push(self.chosen(choice)?)),
            Command::Step(steps) => self.player.step(*steps),
            Command::GoTo(place) => self.player.go_to(*place),
            Command::RunUntil(condition) => self.player.run_until(condition),
            Command::Run => Ok(self.player.play()),
            Command::Pause => Ok(self.player.pause()),
            Command::Wait(seconds) => Ok(self.wait(*seconds)),
            Command::Chapter(title) => Ok(self.script.begin_chapter(title)),
            Command::Undo(times) => self.turn(Way::Back, *times),
            Command::Redo(times) => self.turn(Way::On, *times),
            Command::Export(export) => self.export(export),
            Command::Figure(figure) => self.draw(figure),
            Command::Save(save) => self.save(save),
            Command::Speed(speed) => Ok(self.player.set_speed(*speed)),
            Command::Since(since_s) => Ok(self.view.set_since(*since_s)),
            Command::Magnify(times) => Ok(self.view.magnify(*times)),
            Command::Cursor(to) => self.set_cursor(*to),
            Command::Exact(shown) => Ok(self.player.set_exact(*shown)),
            Command::Measured(name) => self.measure(name.as_deref()),
            Command::TakeAdvice => self.follow_advice(),
            Command::Pin(pinned) => Ok(self.player.set_pinned(*pinned)),
            Command::Fill(pane) => Ok(self.view.fill(*pane)),
            Command::PointAt(pane) => Ok(self.view.point_at(*pane)),
            Command::Look(patch) => self.look(patch),
        }
    }

    fn wait(&self, seconds: f64) -> Done {
        let until = self.now + Duration::try_from_secs_f64(seconds).unwrap_or_default();
        Done::SILENT.going_on(UnderWay::Waiting(until))
    }

    /// Shows the run as `patch`, keys of `[view]` and their values, says.
    fn look(&mut self, patch: &Table) -> Answer {
        let mut look = self.view.look.patched(patch)?;
        let least_s = 2.0 * self.player.motion().time_step_s;
        let short = |what| Err(format!("the {what} two time steps at least: {least_s} s").into());
        let mut said = None;
        for key in patch.keys() {
            said = match key.as_str() {
                "window_s" if look.window_s < least_s => return short("traces show"),
                "window_s" => Some(format!(
                    "the traces show {} s; Home shows the usual time",
                    look.window_s
                )),
                "detail_s" if look.detail_s < Some(least_s) => return short("strip shows"),
                "detail_s" => look
                    .detail_s
                    .map(|detail_s| format!("the strip of the fast motion shows {detail_s} s")),
                "detail_of" => Some(match look.detail_of {
                    Some(curve) => format!("the upper strip shows {}", curve.name()),
                    None => "the upper strip shows what swings: the tilt, or x".to_owned(),
                }),
                "phase" => {
                    self.player.may_show(look.page)?;
                    look.sum_to = None; // all rows of its table
                    None
                }
                "residuals" => Some(self.player.residuals_in_words(look.residuals)?.to_owned()),
                "bare" if look.bare => Some("a bare screen: c brings the rest back".to_owned()),
                _ => None,
            };
        }
        self.view.take(look);
        Ok(Done::saying_any(said))
    }

    fn export(&mut self, export: &Export) -> Answer {
        let mut layout = export.layout.clone();
        layout.note.clone_from(&self.files.note);
        let layout = layout.check();
        let layout = layout.map_err(|error| error.to_string())?;
        let scenario = self.run_up_to(export.to_step, "export")?;
        let scenario = self.work.marked(&scenario);
        let path = self.files.path_of(&export.path);
        self.files.export(&scenario, &path, layout, export.force)
    }

    fn draw(&mut self, figure: &Figure) -> Answer {
        let scenario = self.run_up_to(figure.to_step, "draw")?;
        let path = self.files.path_of(&figure.path);
        let beside = self.player.measured();
        let measured = beside.map(|beside| Arc::clone(&beside.measured));
        let what = (figure.kind.as_str(), figure.exact);
        self.files
            .draw(&scenario, &path, what, measured, figure.force)
    }

    fn save(&mut self, save: &Save) -> Answer {
        let path = self.files.path_of(&save.path);
        if save.from_here {
            let content = self.player.present_as_text()?;
            return self.files.save("the scenario", &content, &path, save.force);
        }
        let run = self.run_up_to(save.to_step, "save")?;
        let run = self.work.marked(&run).to_toml();
        self.files.save("the run", &run, &path, save.force)
    }

    fn open_named(&mut self, name: &str) -> Answer {
        self.files.admit_reading(std::path::Path::new(name))?;
        match super::opening::read(name).and_then(|document| document.scenario()) {
            Ok(scenario) => {
                self.open(name, Arc::new(scenario));
                Ok(Done::SILENT)
            }
            Err(problems) => Err(format!("{}: {}", problems.origin, problems.in_one_line()).into()),
        }
    }

    /// Sets all keys of `table` as one act, with `is_again` together with the act before. Keys of body and start begin a new
    /// run; the others act from the next step on.
    fn set_all(&mut self, table: &Table, is_again: bool) -> Answer {
        let is_of_a_new_run = |key: &str| keys::Effect::of(key) == keys::Effect::NewRun;
        let (new, rest): (Table, Table) = table
            .clone()
            .into_iter()
            .partition(|(key, _)| is_of_a_new_run(key));
        let acts = acts(rest);
        if new.is_empty() {
            let made_way = self.act_all(acts, is_again)?;
            let done = Done::saying(made_way.unwrap_or_else(|| match table.len() {
                1 => table.keys().map(|key| self.said_of(key)).collect(),
                more => format!("{more} values; u takes them back"),
            }));
            Ok(self.on_its_way(done))
        } else {
            self.begin_with(&new, acts, is_again)
        }
    }

    fn nudge(&mut self, key: &str, times: i32) -> Answer {
        let Some(parameter) = self.values.parameter(key).cloned() else {
            let listed = self.values.list.values.iter();
            let near = nearest(key, listed.filter_map(|value| value.key.as_deref()));
            return Err(format!("{key} is no value of this scenario: {near}").into());
        };
        let value = parameter
            .nudged(times)
            .map_err(|reason| format!("{} {reason}", parameter.label))?;
        let now = self.now;
        let is_again = self.values.is_nudged_again(key, now);
        let table = Table::from_iter([(key.to_owned(), value)]);
        let done = self.set_all(&table, is_again)?;
        self.values.note_nudge(key, now);
        Ok(done)
    }

    fn chosen(&self, choice: &PushChoice) -> Result<NextPush, String> {
        let time_step_s = self.player.motion().time_step_s;
        self.values
            .chosen(choice, self.player.run().scenario(), time_step_s)
    }

    /// Pushes from the next step on: with the push to come, but for the values that `choice` has.
    fn push(&mut self, choice: &PushChoice) -> Answer {
        let push = self.chosen(choice)?;
        let run = self.player.run();
        let mut given = push.given(run.scenario(), run.simulation().state())?;
        if let Some(Force::Vector(vector)) = choice.force_N {
            given.force_N = vector; // exactly as it was written: norm and direction would round it
        }
        let said = format!(
            "pushed: {}; u takes it back, P chooses another",
            push.in_words()
        );
        let made_way = self.act_all(vec![Act::Push(given)], false)?;
        Ok(Done::saying(made_way.unwrap_or(said)))
    }

    /// The scenario of the run from step 0 to `to_step`, or to the present step; `to` says what it is for.
    pub(super) fn run_up_to(
        &self,
        to_step: Option<u64>,
        to: &str,
    ) -> Result<Arc<Scenario>, String> {
        let here = self.player.playback.step_number();
        self.work.run_up_to(to_step.unwrap_or(here), to)
    }
}

/// The acts that set the keys of `table`: an edit, a description, or both.
fn acts(table: Table) -> Vec<Act> {
    let is_idle = |key: &str| keys::Effect::of(key) == keys::Effect::None;
    let (idle, acting): (Table, Table) = table.into_iter().partition(|(key, _)| is_idle(key));
    let edit = (!acting.is_empty()).then_some(Act::Edit(acting));
    let description = (!idle.is_empty()).then_some(Act::Describe(idle));
    edit.into_iter().chain(description).collect()
}
