//! Carries commands out. Each returns what it has done, or why it was refused.

use super::Lab;
use super::answer::{Answer, Done, UnderWay};
use super::command::{Command, Force, PushChoice};
use super::values::listed::ListedValue;
use super::work::Way;
use crate::scenario::problem::nearest;
use crate::scenario::{Scenario, keys};
use crate::work::journal::Act;
use crate::work::next_push::NextPush;
use std::sync::Arc;
use std::time::Duration;

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
            Command::Set(table) => self.set_all(table),
            Command::Nudge { key, times } => self.nudge(key, *times),
            Command::Push(choice) => self.push(choice),
            Command::NextPush(choice) => {
                self.choose_next_push(self.chosen(choice)?);
                Ok(Done::SILENT)
            }
            Command::Step(steps) => self.player.step(*steps),
            Command::GoTo(place) => self.player.go_to(*place),
            Command::RunUntil(condition) => self.player.run_until(condition),
            Command::Run => {
                self.player.play();
                Ok(Done::SILENT)
            }
            Command::Pause => Ok(self.player.pause()),
            Command::Wait(seconds) => {
                let until = self.now + Duration::try_from_secs_f64(*seconds).unwrap_or_default();
                Ok(Done::SILENT.going_on(UnderWay::Waiting(until)))
            }
            Command::Chapter(title) => {
                self.script.begin_chapter(title);
                Ok(Done::saying(title))
            }
            Command::Undo(times) => self.turn(Way::Back, *times),
            Command::Redo(times) => self.turn(Way::On, *times),
            Command::Export {
                path,
                layout,
                to_step,
                force,
            } => {
                let scenario = self.work.marked(&self.run_up_to(*to_step, "export")?);
                let path = self.files.path_of(path);
                self.files.export(&scenario, &path, layout.clone(), *force)
            }
            Command::Figure {
                path,
                kind,
                exact,
                to_step,
                force,
            } => {
                let scenario = self.run_up_to(*to_step, "draw")?;
                let path = self.files.path_of(path);
                let beside = self.player.measured();
                let measured = beside.map(|beside| Arc::clone(&beside.measured));
                let what = (kind.as_str(), *exact);
                self.files.draw(&scenario, &path, what, measured, *force)
            }
            Command::Save {
                path,
                from_here,
                to_step,
                force,
            } => {
                let path = self.files.path_of(path);
                match from_here {
                    true => {
                        let content = self.player.present_as_text()?;
                        self.files.save("the scenario", &content, &path, *force)
                    }
                    false => {
                        let run = self.work.marked(&self.run_up_to(*to_step, "save")?);
                        self.files.save("the run", &run.to_toml(), &path, *force)
                    }
                }
            }
            Command::Speed(speed) => Ok(self.player.set_speed(*speed)),
            Command::Exact(shown) => Ok(self.player.set_exact(*shown)),
            Command::Measured(name) => self.measure(name.as_deref()),
            Command::Residuals(shown) => self.show_residuals(*shown),
            Command::TakeAdvice => self.follow_advice(),
            Command::Pin(pinned) => Ok(self.player.set_pinned(*pinned)),
            _ => self.look(command),
        }
    }

    /// Carries out a command that only changes how the run is shown.
    fn look(&mut self, command: &Command) -> Answer {
        match command {
            Command::LookAt(text) => self.view.look_at = Some(text.clone()),
            Command::Next(text) => self.view.next = Some(text.clone()),
            Command::Bare(bare) => {
                self.view.bare = *bare;
                if *bare {
                    return Ok(Done::saying("a bare screen: c brings the rest back"));
                }
            }
            Command::Detail(detail_s) => return self.set_detail(*detail_s),
            Command::DetailOf(curve) => {
                self.view.detail_of = *curve;
                return Ok(Done::saying(match curve {
                    Some(curve) => format!("the upper strip shows {}", curve.name()),
                    None => "the upper strip shows what swings: the tilt, or x".to_owned(),
                }));
            }
            Command::Since(since_s) => return self.set_since(*since_s),
            Command::Magnify(times) => return self.magnify(*times),
            Command::Cursor(to) => return self.set_cursor(*to),
            Command::Window(window_s) => return self.set_window(*window_s),
            Command::Show(panes) => self.view.show(panes),
            Command::Hide(parts) => self.view.hidden.clone_from(parts),
            Command::Fill(pane) => self.view.fill(*pane),
            Command::PointAt(pane) => self.view.pointed_at = *pane,
            Command::Phase(page) => return self.show_page(*page),
            Command::SumTo(rows) => self.view.sum_to = *rows,
            Command::Camera(camera) => self.view.look_from(*camera),
            Command::Zoom(zoom) => self.view.zoom = *zoom,
            _ => {}
        }
        Ok(Done::SILENT)
    }

    fn open_named(&mut self, name: &str) -> Answer {
        self.files.admit(std::path::Path::new(name))?;
        match super::opening::read(name).and_then(|document| document.scenario()) {
            Ok(scenario) => {
                self.open(name, Arc::new(scenario));
                Ok(Done::SILENT)
            }
            Err(problems) => Err(format!("{}: {}", problems.origin, problems.in_one_line()).into()),
        }
    }

    /// Sets all keys of `table` as one act. Keys of body and start begin a new run; the others act from the next step on.
    fn set_all(&mut self, table: &toml::Table) -> Answer {
        let is_of_a_new_run = |key: &str| keys::Effect::of(key) == keys::Effect::NewRun;
        let (new, rest): (toml::Table, toml::Table) = table
            .clone()
            .into_iter()
            .partition(|(key, _)| is_of_a_new_run(key));
        let acts = acts(rest);
        if new.is_empty() {
            let made_way = self.act_all(acts, false)?;
            let done = Done::saying(made_way.unwrap_or_else(|| match table.len() {
                1 => table.keys().map(|key| self.said_of(key)).collect(),
                more => format!("{more} values; u takes them back"),
            }));
            Ok(self.on_its_way(done))
        } else {
            self.begin_with(&new, acts, false)
        }
    }

    fn nudge(&mut self, key: &str, times: i32) -> Answer {
        let Some(parameter) = self.values.parameter(key).cloned() else {
            let listed = self.values.list.values.iter();
            let known = listed.filter_map(ListedValue::key);
            return Err(format!(
                "{key} is no value of this scenario: {}",
                nearest(key, known)
            )
            .into());
        };
        let value = parameter
            .nudged(times)
            .map_err(|reason| format!("{} {reason}", parameter.label))?;
        let now = self.now;
        let is_again = self.values.is_nudged_again(key, now);
        let table = toml::Table::from_iter([(key.to_owned(), value)]);
        let done = match keys::Effect::of(key) {
            keys::Effect::NewRun => self.begin_with(&table, Vec::new(), is_again)?,
            keys::Effect::FromHere | keys::Effect::None => {
                let made_way = self.act_all(acts(table), is_again)?;
                let said = made_way.unwrap_or_else(|| self.said_of(key));
                self.on_its_way(Done::saying(said))
            }
        };
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
fn acts(table: toml::Table) -> Vec<Act> {
    let is_idle = |key: &str| keys::Effect::of(key) == keys::Effect::None;
    let (idle, acting): (toml::Table, toml::Table) =
        table.into_iter().partition(|(key, _)| is_idle(key));
    let edit = (!acting.is_empty()).then_some(Act::Edit(acting));
    let description = (!idle.is_empty()).then_some(Act::Describe(idle));
    edit.into_iter().chain(description).collect()
}
