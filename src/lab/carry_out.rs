//! Carrying commands out: each answers with what it did, or why it did nothing.

use super::Lab;
use super::command::{Command, Force, PushChoice};
use crate::lab::view::Pane;
use crate::scenario::keys;
use crate::scenario::problem::nearest;
use crate::work::journal::Act;
use crate::work::next_push::NextPush;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// What a command has done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// In words, where there is something to say that is not to be seen.
    pub said: Option<String>,
    /// Whether that stands until the next key.
    pub stays: bool,
    /// What goes on after the command, where it does.
    pub under_way: Option<UnderWay>,
}

/// What a command has begun, and time brings to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnderWay {
    /// The run is on its way to a step.
    Going,
    /// The run plays until a condition holds.
    Playing,
    /// The clock goes on to this time.
    Waiting(Duration),
    /// A file is being written.
    Exporting,
}

/// Why a command has done nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The file exists.
    #[error("{0} exists: force = true replaces it")]
    Exists(PathBuf),
    /// For this reason.
    #[error("{0}")]
    Because(String),
}

impl From<String> for Refusal {
    fn from(reason: String) -> Self {
        Self::Because(reason)
    }
}

impl From<&str> for Refusal {
    fn from(reason: &str) -> Self {
        Self::Because(reason.to_owned())
    }
}

impl Done {
    /// Nothing is to be said of it.
    pub(super) const SILENT: Self = Self {
        said: None,
        stays: false,
        under_way: None,
    };

    /// Says `text` for a while.
    pub(super) fn saying(text: impl Into<String>) -> Self {
        Self {
            said: Some(text.into()),
            ..Self::SILENT
        }
    }

    pub(super) fn going_on(self, under_way: UnderWay) -> Self {
        Self {
            under_way: Some(under_way),
            ..self
        }
    }
}

/// What became of a command.
pub type Answer = Result<Done, Refusal>;

impl Lab {
    /// Carries `command` out; says in words what it did, or why it did nothing. What it begins goes on as time passes.
    ///
    /// # Errors
    /// Why nothing was done.
    pub fn carry_out(&mut self, command: &Command) -> Answer {
        if !matches!(command, Command::Nudge { .. }) {
            self.values.forget_nudge();
        }
        let answer = self.done(command);
        self.keep_focus();
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
                self.player.playback.set_running(true);
                Ok(Done::SILENT)
            }
            Command::Pause => Ok(self.player.pause()),
            Command::Wait(seconds) => {
                let until = self.now + Duration::try_from_secs_f64(*seconds).unwrap_or_default();
                Ok(Done::SILENT.going_on(UnderWay::Waiting(until)))
            }
            Command::Undo(times) => self.undo(*times),
            Command::Redo(times) => self.redo(*times),
            Command::Export {
                path,
                every,
                to_step,
                force,
            } => {
                let scenario = self.run_until_step(*to_step, "export")?;
                let path = self.files.path_of(path);
                self.files.export(&scenario, &path, *every, *force)
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
                        let content = self.present_as_text()?;
                        self.files.save("the scenario", &content, &path, *force)
                    }
                    false => {
                        let run = self.run_until_step(*to_step, "save")?;
                        self.files.save("the run", &run.to_toml(), &path, *force)
                    }
                }
            }
            Command::Speed(speed) => Ok(self.player.set_speed(*speed)),
            Command::LookAt(text) => {
                self.view.look_at = Some(text.clone());
                Ok(Done::SILENT)
            }
            Command::Window(window_s) => self.set_window(*window_s),
            Command::Exact(shown) => Ok(self.player.set_exact(*shown)),
            Command::Show(panes) => {
                self.view.shown.clone_from(panes);
                Ok(Done::SILENT)
            }
            Command::Hide(parts) => {
                self.view.hidden.clone_from(parts);
                Ok(Done::SILENT)
            }
            Command::Fill(pane) => {
                self.view.fill(*pane);
                Ok(Done::SILENT)
            }
            Command::Camera(camera) => {
                self.view.camera = *camera;
                Ok(Done::SILENT)
            }
        }
    }

    fn open_named(&mut self, name: &str) -> Answer {
        self.files.admit(std::path::Path::new(name))?;
        match super::opening::again(name).and_then(|document| document.scenario()) {
            Ok(scenario) => {
                self.open(name, Arc::new(scenario));
                Ok(Done::SILENT)
            }
            Err(problems) => Err(format!("{}: {}", problems.origin, problems.in_one_line()).into()),
        }
    }

    /// Sets every key of `table`: those of body and start in a new run, the others from here on.
    fn set_all(&mut self, table: &toml::Table) -> Answer {
        let is_of_a_new_run = |key: &str| keys::Effect::of(key) == keys::Effect::NewRun;
        let (new, rest): (toml::Table, toml::Table) = table
            .clone()
            .into_iter()
            .partition(|(key, _)| is_of_a_new_run(key));
        let acts = acts(rest);
        match new.is_empty() {
            false => self.begin_with(&new, acts, false),
            true => {
                let made_way = self.act_all(acts, false)?;
                Ok(Done::saying(made_way.unwrap_or_else(
                    || match table.len() {
                        1 => table.keys().map(|key| self.said_of(key)).collect(),
                        more => format!("{more} values; u takes them back"),
                    },
                )))
            }
        }
    }

    fn nudge(&mut self, key: &str, times: i32) -> Answer {
        let Some(parameter) = self.values.parameter(key).cloned() else {
            let known = self.values.editor().lines().iter();
            let known = known
                .map(|line| line.key.as_str())
                .filter(|key| !key.is_empty());
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
                Done::saying(made_way.unwrap_or_else(|| self.said_of(key)))
            }
        };
        self.values.note_nudge(key, now);
        Ok(done)
    }

    fn chosen(&self, choice: &PushChoice) -> Result<NextPush, String> {
        let time_step_s = self.motion().time_step_s;
        self.values
            .chosen(choice, self.run().scenario(), time_step_s)
    }

    /// Gives the push to come, with what `choice` has of its own, from here on.
    fn push(&mut self, choice: &PushChoice) -> Answer {
        let push = self.chosen(choice)?;
        let run = self.run();
        let mut given = push.given(run.scenario(), run.simulation().state())?;
        if let Some(Force::Vector(vector)) = choice.force_N {
            given.force_N = vector; // as it was written, to the last digit
        }
        let said = format!(
            "pushed: {}; u takes it back, P chooses another",
            push.in_words()
        );
        let made_way = self.act_all(vec![Act::Push(given)], false)?;
        Ok(Done::saying(made_way.unwrap_or(said)))
    }

    fn set_window(&mut self, window_s: f64) -> Answer {
        let least_s = 2.0 * self.run().simulation().motion().time_step_s;
        if window_s < least_s {
            return Err(format!("the traces show two time steps at least: {least_s} s").into());
        }
        self.view.window_s = window_s;
        Ok(Done::saying(format!("the traces show {window_s} s")))
    }

    /// Whether `pane` fills the screen.
    pub(super) fn is_filled_by(&self, pane: Pane) -> bool {
        self.view.filled && self.view.focus == pane
    }
}

/// What setting the keys of `table` comes to: an edit, a description, or both.
fn acts(table: toml::Table) -> Vec<Act> {
    let is_idle = |key: &str| keys::Effect::of(key) == keys::Effect::None;
    let (idle, acting): (toml::Table, toml::Table) =
        table.into_iter().partition(|(key, _)| is_idle(key));
    let edit = (!acting.is_empty()).then_some(Act::Edit(acting));
    let description = (!idle.is_empty()).then_some(Act::Describe(idle));
    edit.into_iter().chain(description).collect()
}
