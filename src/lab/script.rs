//! A script: commands that are carried out one after the other. Each waits until the action of the previous one is
//! complete.

use super::answer::{ActionResult, Done, PendingAction};
use super::command::{Command, Commands, LocatedCommand, SeekTarget};
use super::files::Files;
use super::player::{Halt, MOST_UNTIL, Player};
use indicatif::HumanCount;
use std::collections::VecDeque;
use std::time::Duration;

/// The reason for a failed `run_until` that a key has stopped. `was_stopped` recognizes it.
const STOPPED_TEXT: &str = "stopped before it held";

#[derive(Clone, Debug, Default)]
pub struct CommandScript {
    /// The file of the commands, as the user named it.
    pub origin: String,
    left: VecDeque<LocatedCommand>,
    /// The command in progress and its action.
    under_way: Option<(LocatedCommand, PendingAction)>,
    /// The message about the command that was refused.
    failed: Option<String>,
    /// True if the commands were dropped before they were complete.
    is_dropped: bool,
    /// Titles of the chapters that were begun since [`take_chapters`](Self::take_chapters) was last called.
    chapters: Vec<String>,
    /// True if the script is paused and waits for the user to continue it.
    pub(super) waits: bool,
    /// True if the run played when the script was paused. It plays again when the script continues.
    plays_again: bool,
}

impl CommandScript {
    pub(super) fn new(commands: Commands) -> Self {
        Self {
            origin: commands.origin,
            left: commands.list.into(),
            ..Self::default()
        }
    }

    /// Returns the message about the command that was refused.
    pub fn failure(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    /// Returns the message about the command that was refused, and forgets it.
    pub(super) fn take_failure(&mut self) -> Option<String> {
        self.failed.take()
    }

    /// Returns the titles of the chapters that were begun since the last call.
    pub fn take_chapters(&mut self) -> Vec<String> {
        std::mem::take(&mut self.chapters)
    }

    /// Delays the next command until `seconds` after `now`.
    pub(super) fn wait(seconds: f64, now: Duration) -> Done {
        let until = now + Duration::try_from_secs_f64(seconds).unwrap_or_default();
        Done::SILENT.going_on(PendingAction::Waiting(until))
    }

    pub(super) fn begin_chapter(&mut self, title: &str) -> Done {
        self.chapters.push(title.to_owned());
        Done::saying(title)
    }

    /// Returns the number of commands that are not complete, including the one in progress.
    pub fn count(&self) -> usize {
        self.left.len() + usize::from(self.under_way.is_some())
    }

    /// Returns a message with the number of commands left and the keys of a paused script.
    pub(super) fn left_in_words(&self) -> String {
        let origin = &self.origin;
        match self.count() {
            1 => format!("1 command of {origin} is left: space continues, Esc drops it"),
            left => {
                format!("{left} commands of {origin} are left: space continues, Esc drops them")
            }
        }
    }

    pub fn is_done(&self) -> bool {
        self.count() == 0
    }

    /// Returns true if the script ended early: it was dropped, or a command was refused.
    pub fn has_broken_off(&self) -> bool {
        self.is_dropped || self.failed.is_some()
    }

    /// Returns true if a key ended the script early: it dropped the commands, or stopped the run that one of them
    /// played.
    pub fn was_stopped(&self) -> bool {
        self.has_broken_off() && self.failure().is_none_or(|why| why.ends_with(STOPPED_TEXT))
    }

    /// Drops all commands, and returns a message with their number.
    pub(super) fn drop_all(&mut self) -> String {
        let left = self.count();
        *self = Self {
            is_dropped: left > 0,
            ..Self::default()
        };
        match left {
            1 => "stopped: 1 command was dropped".to_owned(),
            left => format!("stopped: {left} commands were dropped"),
        }
    }

    /// Returns the time until which the command in progress waits.
    pub(super) fn waits_until(&self) -> Option<Duration> {
        match self.under_way {
            Some((_, PendingAction::Waiting(until))) => Some(until),
            _ => None,
        }
    }

    /// Returns the command with which the one in progress continues after a pause.
    ///
    /// A run goes to the same step or until the same condition holds. A wait lasts for the rest of its time at `now`.
    fn resumed_command(&self, player: &Player, now: Duration) -> Option<LocatedCommand> {
        let (placed, under_way) = self.under_way.as_ref()?;
        let command = match under_way {
            PendingAction::Going => {
                let (here, to_go) = (player.step_number(), player.steps_to_go()?);
                Command::GoTo(SeekTarget::Step(here.saturating_add(to_go)))
            }
            PendingAction::Waiting(until) => {
                Command::WaitS(until.saturating_sub(now).as_secs_f64())
            }
            _ => placed.command.clone(),
        };
        let line = placed.line;
        Some(LocatedCommand { command, line })
    }

    /// Pauses the script at `now`. When it continues, the command in progress is carried out again. An export continues
    /// meanwhile.
    pub(super) fn pause(&mut self, player: &Player, now: Duration) {
        self.waits = true;
        self.plays_again = player.is_running() && !player.seeks_condition();
        if let Some((_, PendingAction::Exporting)) = self.under_way {
            return;
        }
        if let Some(again) = self.resumed_command(player, now) {
            self.under_way = None;
            self.left.push_front(again);
        }
    }

    /// Continues a paused script.
    pub(super) fn release(&mut self, player: &mut Player) {
        if std::mem::take(&mut self.plays_again) {
            player.set_running(true);
        }
        self.waits = false;
    }

    /// Returns the next command to carry out; `None` if there is none or it must wait. `halt` is the reason if the run
    /// has just stopped by itself.
    ///
    /// # Errors
    /// Returns an error if the command in progress has failed. The others are then dropped.
    pub(super) fn next(
        &mut self,
        halt: Option<Halt>,
        now: Duration,
        player: &Player,
        files: &mut Files,
    ) -> Result<Option<LocatedCommand>, String> {
        if self.waits {
            return Ok(None);
        }
        if let Some((placed, under_way)) = self.under_way.take() {
            match is_complete(under_way, halt, now, player, files) {
                Ok(true) => {}
                Ok(false) => {
                    self.under_way = Some((placed, under_way));
                    return Ok(None);
                }
                Err(reason) => return Err(self.fail(&placed, &reason)),
            }
        }
        Ok(self.left.pop_front())
    }

    /// Records the `answer` to the command `placed`, and returns the effect of the command.
    ///
    /// # Errors
    /// Returns an error if the command was refused or its step is too far away. The others are then dropped.
    pub(super) fn take_answer(
        &mut self,
        placed: LocatedCommand,
        answer: ActionResult,
        player: &mut Player,
    ) -> Result<Done, String> {
        let to_go = player.steps_to_go();
        if to_go.is_some_and(|to_go| to_go > MOST_UNTIL) {
            player.pause();
            let most = HumanCount(MOST_UNTIL);
            let reason = format!("is more than {most} steps away: use a longer time step");
            return Err(self.fail(&placed, &reason));
        }
        match answer {
            Ok(done) => {
                self.under_way = done.under_way.map(|way| (placed, way));
                Ok(done)
            }
            Err(refusal) => Err(self.fail(&placed, &refusal.to_string())),
        }
    }

    /// Stops the command in progress if the commands need too many `steps` in total.
    ///
    /// # Errors
    /// Returns an error if that is so. The other commands are then dropped.
    pub(super) fn limit(&mut self, steps: u64, player: &mut Player) -> Result<(), String> {
        match self.under_way.take_if(|_| steps > MOST_UNTIL) {
            Some((placed, _)) => {
                let most = HumanCount(MOST_UNTIL);
                player.pause();
                Err(self.fail(
                    &placed,
                    &format!("commands take at most {most} steps in total"),
                ))
            }
            None => Ok(()),
        }
    }

    /// Drops all commands because `placed` was refused for `reason`, and returns the message about it.
    fn fail(&mut self, placed: &LocatedCommand, reason: &str) -> String {
        let rest = match self.left.len() {
            0 => String::new(),
            1 => "; the command after it is not carried out".to_owned(),
            more => format!("; the {more} commands after it are not carried out"),
        };
        let line = placed.line.map_or(String::new(), |line| format!(":{line}"));
        let name = placed.command.name();
        let text = format!("{}{line}: {name}: {reason}{rest}", self.origin);
        self.left.clear();
        self.failed = Some(text.clone());
        text
    }
}

fn is_complete(
    under_way: PendingAction,
    halt: Option<Halt>,
    now: Duration,
    player: &Player,
    files: &mut Files,
) -> Result<bool, String> {
    let is_on = match under_way {
        PendingAction::Going => player.steps_to_go().is_some(),
        PendingAction::Playing => player.seeks_condition(),
        PendingAction::Waiting(until) => return Ok(now >= until),
        PendingAction::Exporting if files.is_exporting() => return Ok(false),
        PendingAction::Exporting => return files.take_failure().map_or(Ok(true), Err),
    };
    match (is_on, halt, under_way) {
        (true, ..) => Ok(false),
        (false, Some(Halt::NotFinite(error)), _) => Err(error.to_string()),
        (false, Some(Halt::GaveUp), _) => Err(format!(
            "did not hold on any of {} steps",
            HumanCount(MOST_UNTIL)
        )),
        (false, None, PendingAction::Playing) => Err(STOPPED_TEXT.to_owned()),
        (false, ..) => Ok(true),
    }
}
