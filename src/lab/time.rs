//! Advances the lab with time: steps, exact motion, measured data, exports and the script.

use super::command::{Command, Commands};
use super::messages::{self, halt_in_words};
use super::player::Halt;
use super::{CommandScript, Lab};
use crate::engine::run::NotFinite;
use std::ops::ControlFlow;
use std::thread;
use std::time::Duration;

/// Interval at which a running export is checked while there is nothing else to do.
const EXPORT_POLL: Duration = Duration::from_millis(2);
/// Duration of stepping before the caller decides whether to continue.
const STEPPING_BUDGET: Duration = Duration::from_millis(100);

impl Lab {
    /// Advances everything that changes with time up to now.
    ///
    /// `clock` returns the time since the lab was opened. It is read several times, so that the steps of a fast run end
    /// in time for the next frame.
    pub fn advance(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let now = clock();
        let wall = now.saturating_sub(self.now);
        self.now = now;
        self.changed |= self.messages.expire(now);
        let (halt, is_new) = self.player.advance(now, wall, clock);
        self.changed |= is_new
            | self.comparison.advance(&self.player, clock)
            | self.adviser.advance(&self.player);
        if let Some(halt) = halt {
            self.on_halt(halt);
        }
        let (is_judged, verdict) = self.comparison.judge(self.edits.runs.name(), &self.player);
        self.changed |= is_judged;
        if let Some(verdict) = verdict {
            self.tell(verdict);
        }
        self.follow_export();
        self.continue_script(halt);
        if self.changed && self.player.is_due(now) {
            self.read_now();
        } else if self.changed {
            self.choose_window();
        }
    }

    /// Takes the run to `step` before returning, unless `go_on` breaks, and turns the camera to the axle there.
    ///
    /// Each window of the traces depends on the previous one. It is chosen after 1, 2, 4 and so on steps, so that the
    /// picture does not depend on the speed of the computer.
    ///
    /// # Errors
    /// Returns an error if the numbers stop being finite on the way.
    pub fn begin_at(
        &mut self,
        step: u64,
        go_on: impl Fn(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), NotFinite> {
        let mut part = 1_u64;
        loop {
            let next = self.player.step_number().saturating_add(part).min(step);
            let mut stepped = Ok(());
            while stepped.is_ok()
                && self.player.step_number() < next
                && go_on(self.player.step_number(), step).is_continue()
            {
                stepped = self.player.step_to(next, STEPPING_BUDGET);
            }
            self.catch_up();
            let reached = self.player.step_number();
            if stepped.is_err() || reached >= step || reached < next {
                self.view.forget_camera();
                self.view.turn_camera(&self.player);
                return stepped;
            }
            part = part.saturating_mul(2);
        }
    }

    /// Updates exact motion, measured data and numbers to the present step.
    fn catch_up(&mut self) {
        self.player.run.follow_exact(|| false);
        self.comparison.catch_up(&self.player);
        self.read_now();
    }

    fn on_halt(&mut self, halt: Halt) {
        self.read_now();
        let next = messages::next(&self.view, &self.edits.runs, &self.player);
        let Some(text) = halt_in_words(halt, next.as_deref()) else {
            return;
        };
        if let Halt::NotFinite(_) = halt {
            let edits = self.edits.runs.journal();
            let is_edited = edits.count_by(self.player.step_number()) > 0;
            let offer = self.adviser.offer(&self.player);
            let cure = offer.map(|offer| format!("a: rerun with {offer}"));
            self.messages
                .tell_of_break(&text, cure.as_deref(), is_edited);
            self.changed = true;
        } else {
            self.tell(text);
        }
    }

    fn follow_export(&mut self) {
        self.changed |= self.files.is_exporting();
        if let Some(text) = self.files.follow_export() {
            self.tell(text);
        }
    }

    /// Pauses the run or starts it. Continues a script that waits for a key.
    pub(super) fn toggle_pause(&mut self) {
        match (self.script.is_done(), self.script.waits) {
            (false, true) => {
                self.script.release(&mut self.player);
                self.continue_script(None);
            }
            (false, false) => {
                self.script.pause(&self.player, self.now);
                self.carry_out_all(&[Command::Pause]);
                let is_of_page = self.view.sheet.as_ref().is_some_and(|sheet| sheet.plays);
                self.tell(if is_of_page {
                    "paused: space continues".to_owned()
                } else {
                    format!("paused: {}", self.script.left_in_words())
                });
            }
            (true, _) if self.player.is_moving() => self.carry_out_all(&[Command::Pause]),
            (true, _) => self.carry_out_all(&[Command::Run]),
        }
    }

    /// Replaces the present script by `commands`, which are carried out as time passes.
    pub fn take_commands(&mut self, commands: Commands) {
        self.script = CommandScript::new(commands);
        self.continue_script(None);
    }

    /// Removes the messages of the script's commands, unless one of them was refused.
    pub fn forget_message_of_script(&mut self) {
        if self.script.failure().is_none() {
            self.messages.take_back();
            self.changed = true;
        }
    }

    /// Carries out the commands of the script that need not wait any longer. `halt` is the reason if the run has just
    /// stopped by itself.
    fn continue_script(&mut self, halt: Option<Halt>) {
        if let Err(text) = self.carry_out_script(halt) {
            self.tell(text);
        }
    }

    fn carry_out_script(&mut self, halt: Option<Halt>) -> Result<(), String> {
        while let Some(next) = self
            .script
            .next(halt, self.now, &self.player, &mut self.files)?
        {
            let answer = self.carry_out(&next.command);
            let done = self.script.take_answer(next, answer, &mut self.player)?;
            self.tell_answer(Ok(done));
        }
        Ok(())
    }

    /// Carries out the script at once, without a clock. It waits only for exports.
    ///
    /// Calls `go_on` several times a second with the present step and the step at which the run will stop. When `go_on`
    /// breaks, the remaining commands are dropped.
    ///
    /// # Errors
    /// Returns an error if a command is refused: which one, and why. The commands after it are not carried out.
    pub fn finish_script_while(
        &mut self,
        mut go_on: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), String> {
        let mut steps = 0;
        while !self.script.is_done() {
            let from = self.player.step_number();
            let halt = self.player.advance_to_goal(STEPPING_BUDGET);
            steps += self.player.step_number().abs_diff(from);
            if let Some(halt) = halt {
                self.on_halt(halt);
            } else if go_on(self.player.step_number(), self.player.stop()).is_break() {
                self.files.drop_export();
                self.script.drop_all();
                break;
            }
            self.pass_time();
            if let Err(text) = self.script.limit(steps, &mut self.player) {
                self.tell(text);
            }
            self.continue_script(halt);
        }
        self.catch_up();
        self.script.take_failure().map_or(Ok(()), |text| {
            self.messages.take_back(); // the caller reports it
            Err(text)
        })
    }

    /// Waits for the running export, and moves the lab's time to the end of a `wait_s` command.
    fn pass_time(&mut self) {
        if self.files.is_exporting() {
            thread::sleep(EXPORT_POLL);
            self.follow_export();
        }
        if let Some(until) = self.script.waits_until() {
            self.now = self.now.max(until);
        }
    }
}
