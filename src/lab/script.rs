//! Commands one after the other: the next is carried out when what the one before has begun is at its end.

use super::Lab;
use super::carry_out::UnderWay;
use super::command::{Commands, Placed};
use crate::observe::playback::Halt;
use indicatif::HumanCount;
use std::collections::VecDeque;
use std::thread;
use std::time::Duration;

/// How often a file being written is looked at where there is nothing else to do.
const LOOK: Duration = Duration::from_millis(2);

/// Commands that are still to be carried out.
#[derive(Clone, Debug, Default)]
pub struct Script {
    origin: String,
    left: VecDeque<Placed>,
    /// The command that is under way, and what of it.
    under_way: Option<(Placed, UnderWay)>,
    /// Why it went no further.
    failed: Option<String>,
}

impl Script {
    /// Whether all of it is done.
    pub fn is_done(&self) -> bool {
        self.left.is_empty() && self.under_way.is_none()
    }

    /// `text` with the place of `placed` before it.
    fn at(&self, placed: &Placed, text: &str) -> String {
        let line = placed.line.map_or(String::new(), |line| format!(":{line}"));
        let name = placed
            .command
            .to_table()
            .keys()
            .cloned()
            .collect::<String>();
        format!("{}{line}: {name}: {text}", self.origin)
    }
}

impl Lab {
    /// Carries `commands` out, one after the other, as time passes.
    pub fn take_commands(&mut self, commands: Commands) {
        self.script = Script {
            origin: commands.origin,
            left: commands.list.into(),
            under_way: None,
            failed: None,
        };
        self.go_on_with_script(None);
    }

    /// The commands that are still to be carried out.
    pub fn script(&self) -> &Script {
        &self.script
    }

    /// Carries out what is left of the commands at once, without a clock: nothing is waited for but files.
    ///
    /// # Errors
    /// Which command was refused, and why; those after it are not carried out.
    pub fn finish_script(&mut self) -> Result<(), String> {
        while !self.script.is_done() {
            let halt = self.player.playback.finish();
            if let Some(halt) = halt {
                self.halted(halt);
            }
            if self.is_exporting() {
                thread::sleep(LOOK);
                self.follow_export();
            }
            if let Some((_, UnderWay::Waiting(until))) = &self.script.under_way {
                self.now = self.now.max(*until);
            }
            self.go_on_with_script(halt);
        }
        self.read_now();
        self.script.failed.take().map_or(Ok(()), Err)
    }

    /// Carries out as many commands as can be by now; `halt` says why the run has just stopped by itself, if it has.
    pub(super) fn go_on_with_script(&mut self, halt: Option<Halt>) {
        loop {
            if let Some((placed, under_way)) = self.script.under_way.take() {
                match self.came_to(under_way, halt) {
                    Ok(true) => {}
                    Ok(false) => {
                        self.script.under_way = Some((placed, under_way));
                        return;
                    }
                    Err(reason) => return self.break_off(&placed, &reason),
                }
            }
            let Some(next) = self.script.left.pop_front() else {
                return;
            };
            let answer = self.carry_out(&next.command);
            match &answer {
                Ok(done) => self.script.under_way = done.under_way.map(|way| (next, way)),
                Err(refusal) => return self.break_off(&next, &refusal.to_string()),
            }
            self.tell_answer(answer);
        }
    }

    /// Whether what was begun is at its end.
    fn came_to(&self, under_way: UnderWay, halt: Option<Halt>) -> Result<bool, String> {
        let is_on = match under_way {
            UnderWay::Going => self.player.playback.steps_to_go().is_some(),
            UnderWay::Playing => self.player.playback.is_running_until(),
            UnderWay::Waiting(until) => return Ok(self.now >= until),
            UnderWay::Exporting => return Ok(!self.is_exporting()),
        };
        match (is_on, halt, under_way) {
            (true, ..) => Ok(false),
            (false, Some(Halt::NotFinite(error)), _) => Err(error.to_string()),
            (false, Some(Halt::NotFulfilled(steps)), _) => Err(format!(
                "did not hold on any of {} steps",
                HumanCount(steps)
            )),
            (false, None, UnderWay::Playing) => Err("stopped before it held".to_owned()),
            (false, ..) => Ok(true),
        }
    }

    fn break_off(&mut self, placed: &Placed, reason: &str) {
        let left = self.script.left.len();
        let rest = match left {
            0 => String::new(),
            1 => "; the command after it is not carried out".to_owned(),
            more => format!("; the {more} commands after it are not carried out"),
        };
        let text = self.script.at(placed, reason) + &rest;
        self.notice.keep_saying(text.clone());
        self.script.left.clear();
        self.script.failed = Some(text);
        self.changed = true;
    }

    /// Leaves what is left of the commands; gives how many there were, that under way among them.
    pub(super) fn drop_script(&mut self) -> usize {
        let left = self.script.left.len() + usize::from(self.script.under_way.is_some());
        self.script = Script::default();
        left
    }
}
