//! A script: commands that are carried out one after the other. Each waits until the action that the one before has
//! started is complete.

use super::Lab;
use super::answer::{Done, UnderWay};
use super::command::{Command, Commands, Place, Placed};
use crate::playback::{Halt, MOST_UNTIL};
use indicatif::HumanCount;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::thread;
use std::time::{Duration, Instant};

/// How often to look whether an export is complete while there is nothing else to do.
const LOOK: Duration = Duration::from_millis(2);

/// Why a run that is played until something holds was refused, where a key has stopped it.
pub const STOPPED: &str = "stopped before it held";

/// How long steps are taken before the caller decides whether to go on.
const PART: Duration = Duration::from_millis(100);

#[derive(Clone, Debug, Default)]
pub struct Script {
    /// The file of the commands, as the user named it.
    pub origin: String,
    left: VecDeque<Placed>,
    /// The command whose action takes time, and that action.
    under_way: Option<(Placed, UnderWay)>,
    /// The command that was refused, and why.
    failed: Option<String>,
    /// Whether its commands were dropped before they were complete.
    is_dropped: bool,
    /// Titles of the chapters that were begun and not taken yet.
    chapters: Vec<String>,
    /// Whether the script waits until the user lets it go on: it comes from a session, or was paused.
    pub is_held: bool,
    /// Whether the run played when the script was paused, and plays again when it goes on.
    pub plays_again: bool,
}

impl Script {
    fn new(commands: Commands) -> Self {
        Self {
            origin: commands.origin,
            left: commands.list.into(),
            ..Self::default()
        }
    }

    /// The script of `commands` from a session. It waits until the user lets it go on.
    pub(super) fn held(commands: Commands) -> Self {
        Self {
            is_held: true,
            ..Self::new(commands)
        }
    }

    /// The command that was refused, and why.
    pub fn failure(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    pub(super) fn begin_chapter(&mut self, title: &str) -> Done {
        self.chapters.push(title.to_owned());
        Done::saying(title)
    }

    /// How many commands are not complete, with the one under way.
    pub fn count(&self) -> usize {
        self.left.len() + usize::from(self.under_way.is_some())
    }

    /// The commands after the one under way.
    pub(super) fn left(&self) -> impl Iterator<Item = &Command> {
        self.left.iter().map(|placed| &placed.command)
    }

    /// How many commands are left, and the keys of a script that waits.
    pub(super) fn left_in_words(&self) -> String {
        let origin = &self.origin;
        match self.count() {
            1 => format!("1 command of {origin} is left: space goes on with it, Esc leaves it out"),
            left => format!(
                "{left} commands of {origin} are left: space goes on with them, Esc leaves them out"
            ),
        }
    }

    pub fn is_done(&self) -> bool {
        self.count() == 0
    }

    /// Whether it has ended before its end: it was dropped, or a command was refused.
    pub fn has_broken_off(&self) -> bool {
        self.is_dropped || self.failed.is_some()
    }

    /// Drops all commands; returns how many there were, with the one under way.
    pub(super) fn drop_all(&mut self) -> usize {
        let left = self.count();
        *self = Self {
            is_dropped: left > 0,
            ..Self::default()
        };
        left
    }
}

impl Lab {
    /// Carries out `commands` as time passes, in place of the present script.
    pub fn take_commands(&mut self, commands: Commands) {
        self.script = Script::new(commands);
        self.go_on_with_script(None);
    }

    /// Removes what the commands of the script have said, unless one of them was refused.
    pub fn forget_message_of_script(&mut self) {
        if self.script.failed.is_none() {
            self.on_top.notice.take_back();
            self.changed = true;
        }
    }

    /// The titles of the chapters that were begun since this was asked last.
    pub fn take_chapters(&mut self) -> Vec<String> {
        std::mem::take(&mut self.script.chapters)
    }

    /// Carries out the script at once, without a clock. It waits for exports only.
    ///
    /// # Errors
    /// Which command was refused, and why; the commands after it are not carried out.
    pub fn finish_script(&mut self) -> Result<(), String> {
        self.finish_script_while(|_, _| ControlFlow::Continue(()))
    }

    /// As [`finish_script`](Self::finish_script), and calls `go_on` several times a second with the step at which the
    /// run is and the one at which it will stop. When `go_on` breaks, the other commands are dropped.
    ///
    /// # Errors
    /// As [`finish_script`](Self::finish_script).
    pub fn finish_script_while(
        &mut self,
        mut go_on: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), String> {
        self.release_script();
        let mut steps = 0;
        while !self.script.is_done() {
            let begin = Instant::now();
            let playback = &mut self.player.playback;
            let from = playback.step_number();
            let halt = playback.finish_part(|| begin.elapsed() > PART);
            steps += playback.step_number().abs_diff(from);
            if let Some(halt) = halt {
                self.halted(halt);
            } else if go_on(playback.step_number(), playback.stops_at()).is_break() {
                self.files.drop_export();
                self.script.drop_all();
                break;
            }
            self.pass_time();
            if steps > MOST_UNTIL
                && let Some((placed, _)) = self.script.under_way.take()
            {
                let most = HumanCount(MOST_UNTIL);
                let reason = format!("commands take at most {most} steps in all");
                self.player.pause();
                self.script_has_failed(&placed, &reason);
            }
            self.go_on_with_script(halt);
        }
        self.arrive();
        match self.script.failed.take() {
            Some(text) => {
                self.on_top.notice.take_back(); // the caller says it
                Err(text)
            }
            None => Ok(()),
        }
    }

    /// Lets pass the time for which the command under way waits.
    fn pass_time(&mut self) {
        if self.files.is_exporting() {
            thread::sleep(LOOK);
            self.follow_export();
        }
        if let Some((_, UnderWay::Waiting(until))) = &self.script.under_way {
            self.now = self.now.max(*until);
        }
    }

    /// Brings exact motion, measured data and numbers up to the present step.
    pub(super) fn arrive(&mut self) {
        self.player.playback.catch_up_exact();
        self.player.catch_up_measured();
        self.read_now();
    }

    /// The command under way as it is carried out again: a run goes to the same step or until the same condition holds, a
    /// wait lasts anew, or for what is `left` of it.
    pub(super) fn under_way_again(&self, left: bool) -> Option<Placed> {
        let (placed, under_way) = self.script.under_way.as_ref()?;
        let command = match under_way {
            UnderWay::Going => Command::GoTo(Place::Step(self.player.bound_for()?)),
            UnderWay::Waiting(until) if left => {
                Command::Wait(until.saturating_sub(self.now).as_secs_f64())
            }
            _ => placed.command.clone(),
        };
        let line = placed.line;
        Some(Placed { command, line })
    }

    /// Whether the run plays when the script goes on.
    pub(super) fn plays_again(&self) -> bool {
        let playback = &self.player.playback;
        playback.is_running() && !playback.is_running_until()
    }

    /// Pauses the script. When it goes on, the command under way is carried out again. An export goes on meanwhile.
    pub(super) fn pause_script(&mut self) {
        self.script.is_held = true;
        self.script.plays_again = self.plays_again();
        if let Some((_, UnderWay::Exporting)) = self.script.under_way {
            return;
        }
        if let Some(again) = self.under_way_again(true) {
            self.script.under_way = None;
            self.script.left.push_front(again);
        }
    }

    /// Lets a waiting script go on, as soon as the run is back at the step where a session left it.
    pub(super) fn release_script(&mut self) {
        if !std::mem::take(&mut self.script.is_held) {
            return;
        }
        if std::mem::take(&mut self.script.plays_again) {
            self.player.play();
        }
        if let (Some(step), None) = (self.player.bound_for(), &self.script.under_way) {
            let arrive = Placed {
                command: Command::GoTo(Place::Step(step)),
                line: None,
            };
            self.script.under_way = Some((arrive, UnderWay::Going));
        }
        self.go_on_with_script(None);
    }

    /// Carries out the commands of the script that need not wait any longer. `halt` tells why the run has just stopped by
    /// itself, if it has.
    pub(super) fn go_on_with_script(&mut self, halt: Option<Halt>) {
        while !self.script.is_held {
            if let Some((placed, under_way)) = self.script.under_way.take() {
                match self.is_complete(under_way, halt) {
                    Ok(true) => {}
                    Ok(false) => {
                        self.script.under_way = Some((placed, under_way));
                        return;
                    }
                    Err(reason) => return self.script_has_failed(&placed, &reason),
                }
            }
            let Some(next) = self.script.left.pop_front() else {
                return;
            };
            let answer = self.carry_out(&next.command);
            let to_go = self.player.playback.steps_to_go();
            if to_go.is_some_and(|to_go| to_go > MOST_UNTIL) {
                self.player.pause();
                let most = HumanCount(MOST_UNTIL);
                let reason = format!(
                    "is more than {most} steps away: a longer time step leads there sooner"
                );
                return self.script_has_failed(&next, &reason);
            }
            match &answer {
                Ok(done) => self.script.under_way = done.under_way.map(|way| (next, way)),
                Err(refusal) => return self.script_has_failed(&next, &refusal.to_string()),
            }
            self.tell_answer(answer);
        }
    }

    /// Whether the action `under_way` is complete.
    fn is_complete(&mut self, under_way: UnderWay, halt: Option<Halt>) -> Result<bool, String> {
        let is_on = match under_way {
            UnderWay::Going => self.player.playback.steps_to_go().is_some(),
            UnderWay::Playing => self.player.playback.is_running_until(),
            UnderWay::Waiting(until) => return Ok(self.now >= until),
            UnderWay::Exporting if self.files.is_exporting() => return Ok(false),
            UnderWay::Exporting => return self.files.take_failure().map_or(Ok(true), Err),
        };
        match (is_on, halt, under_way) {
            (true, ..) => Ok(false),
            (false, Some(Halt::NotFinite(error)), _) => Err(error.to_string()),
            (false, Some(Halt::NotFulfilled(steps)), _) => Err(format!(
                "did not hold on any of {} steps",
                HumanCount(steps)
            )),
            (false, None, UnderWay::Playing) => Err(STOPPED.to_owned()),
            (false, ..) => Ok(true),
        }
    }

    /// Drops all commands because `placed` was refused for `reason`.
    fn script_has_failed(&mut self, placed: &Placed, reason: &str) {
        let script = &mut self.script;
        let rest = match script.left.len() {
            0 => String::new(),
            1 => "; the command after it is not carried out".to_owned(),
            more => format!("; the {more} commands after it are not carried out"),
        };
        let line = placed.line.map_or(String::new(), |line| format!(":{line}"));
        let name: String = placed.command.to_table().keys().cloned().collect();
        let text = format!("{}{line}: {name}: {reason}{rest}", script.origin);
        script.left.clear();
        script.failed = Some(text.clone());
        self.tell(text);
    }
}
