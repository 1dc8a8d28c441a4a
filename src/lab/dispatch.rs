//! Passes each command to the part of the lab that carries it out.
//!
//! A new command gets its arm in `Lab::dispatch`.

use super::command::{Command, PushChoice};
use super::edits::{Edited, Edits, ScenarioEdit};
use super::player::RunChange;
use super::{ActionResult, Cleared, CommandScript, Done, Lab, Player, comparison};
use crate::engine::text::printable::printable;
use std::sync::Arc;

/// The commands that a key triggers now, or an error that says why it does nothing.
pub type KeyCommands = Result<Vec<Command>, String>;

impl Lab {
    /// Carries out `command`. An action that takes time is only started: [`advance`](Self::advance) continues it.
    ///
    /// # Errors
    /// Returns an error if the command is refused. Nothing has changed then, with one exception: `undo` and `redo` by
    /// more edits than there are have undone or redone all of them.
    pub fn carry_out(&mut self, command: &Command) -> ActionResult {
        if !matches!(command, Command::Nudge { .. }) {
            self.edits.values.forget_nudge();
        }
        let answer = self.dispatch(command);
        self.view.keep_focus();
        self.read_now();
        answer
    }

    /// Passes `command` to the part of the lab that carries it out.
    fn dispatch(&mut self, command: &Command) -> ActionResult {
        let (player, comparison) = (&mut self.player, &mut self.comparison);
        let edits = &mut self.edits;
        let (files, view, script) = (&mut self.files, &mut self.view, &mut self.script);
        match command {
            Command::Step(steps) => player.step(*steps),
            Command::GoTo(target) => player.go_to(*target),
            Command::RunUntil(condition) => player.run_until(condition),
            Command::Run => {
                player.set_running(true);
                Ok(Done::SILENT)
            }
            Command::Pause => Ok(player.pause()),
            Command::Speed(speed) => Ok(player.set_speed(*speed)),
            Command::Exact(is_shown) => Ok(comparison::show_exact(*is_shown, player)),
            Command::Pin(is_pinned) => Ok(comparison.pin(*is_pinned)),
            Command::Measured(name) => comparison.measure(name.as_deref(), player, files),
            Command::Export(export) => files.export(export, &edits.runs, player),
            Command::Figure(figure) => {
                files.draw(figure, &edits.runs, player, comparison.measured())
            }
            Command::Save(save) => files.save_run(save, &edits.runs, player),
            Command::WaitS(seconds) => Ok(CommandScript::wait(*seconds, self.now)),
            Command::Chapter(title) => Ok(script.begin_chapter(title)),
            Command::SinceS(since_s) => Ok(view.set_since(*since_s)),
            Command::Magnify(times) => Ok(view.magnify(*times)),
            Command::Cursor(to) => view.set_cursor(*to, player),
            Command::Fill(pane) => {
                view.fill(*pane);
                Ok(Done::SILENT)
            }
            Command::PointAt(pane) => {
                view.pointed_at = *pane;
                Ok(Done::SILENT)
            }
            Command::Look(patch) => view.look(patch, player, &self.step_pane),
            Command::NextPush(choice) => edits.choose_next_push(choice, player),
            Command::Push(choice) => self.push(choice),
            Command::Undo(times) => self.undo_or_redo(Edits::undo, *times),
            Command::Redo(times) => self.undo_or_redo(Edits::redo, *times),
            Command::Open(name) => {
                let scenario = files.open_scenario(name)?;
                let edit = edits.open(name, Arc::new(scenario), player);
                Ok(self.apply(edit))
            }
            Command::Set(table) => {
                let edit = edits.set(table, false, player)?;
                Ok(self.apply(edit))
            }
            Command::Rerun(table) => {
                let edit = edits.rerun(table, false, player)?;
                Ok(self.apply(edit))
            }
            Command::Nudge { key, times, rerun } => {
                let edit = edits.nudge(key, *times, *rerun, player, self.now)?;
                Ok(self.apply(edit))
            }
            Command::TakeAdvice => {
                let offer = self.adviser.take_offer(player)?;
                let edit = edits.take_offer(offer, player);
                Ok(self.apply(edit))
            }
        }
    }

    /// Starts the push of `choice`. In a lesson, a push that is tried again replaces the previous try.
    fn push(&mut self, choice: &PushChoice) -> ActionResult {
        if self.view.sheet.is_some() && self.edits.is_push_tried_again(choice, &self.player) {
            self.undo_or_redo(Edits::undo, 1)?;
        }
        let edit = self.edits.push(choice, &self.player)?;
        Ok(self.apply(edit))
    }

    /// Undoes or redoes `times` edits.
    fn undo_or_redo(
        &mut self,
        turn: fn(&mut Edits, &Player) -> Edited,
        times: u32,
    ) -> ActionResult {
        let mut done = Done::SILENT;
        for _ in 0..times {
            let edit = turn(&mut self.edits, &self.player)?;
            done = self.apply(edit);
        }
        Ok(done)
    }

    /// Switches every part of the lab to the scenario of `edit`.
    pub(super) fn apply(&mut self, edit: ScenarioEdit) -> Done {
        let (change, scenario) = (edit.change, &edit.scenario);
        let before = Arc::clone(self.player.run().scenario());
        self.adviser.forget();
        if change.is_of_other_name() {
            self.view.fit(scenario);
        }
        self.comparison.leave(&self.player, change, scenario);
        self.player
            .change_run(change, scenario, self.edits.runs.present().end_s);
        self.view.keep_cursor(&self.player);
        if matches!(
            change,
            RunChange::BeginsAnew { .. } | RunChange::Returns { .. }
        ) {
            self.view.swing_mark = None; // it marks a turning point of the previous run
        }
        self.edits.follow(&self.player);
        let now = self.player.run().scenario();
        let names_other_data =
            before.file.viewed_text("measured") != now.file.viewed_text("measured");
        if change == RunChange::Opens || names_other_data {
            let (player, files) = (&self.player, &self.files);
            let measured = self.comparison.measure_as_opened(&before, player, files);
            if let Err(problems) = measured {
                let why = format!("{}: {}", problems.origin, problems.in_one_line());
                self.tell(printable(&why));
            }
        }
        self.edits.answer(edit, &self.player)
    }

    /// Carries out `commands` until one is refused, and shows their messages.
    pub(super) fn carry_out_all(&mut self, commands: &[Command]) {
        for command in commands {
            let answer = self.carry_out(command);
            let is_refused = answer.is_err();
            self.tell_answer(answer);
            if is_refused {
                return;
            }
        }
    }

    /// Shows the message of a command, or the reason why it was refused.
    pub(super) fn tell_answer(&mut self, answer: ActionResult) {
        self.changed |= self.messages.answer(answer, self.now);
    }

    /// Carries out `command` as a key does: replaces the present message by the message of the command.
    pub fn carry_out_now(&mut self, command: &Command) {
        self.clear();
        self.carry_out_all(std::slice::from_ref(command));
    }

    /// Removes the message and the count, as every key does.
    pub fn clear(&mut self) -> Cleared {
        self.messages.clear(self.popups.count.take())
    }

    /// Carries out the commands that a key triggers. `meant` returns them for the count that was typed before the key,
    /// or an error that says why the key does nothing.
    pub fn press(&mut self, meant: impl FnOnce(&Self, Option<u64>) -> KeyCommands) {
        let count = self.clear().count;
        self.edits.values.forget_nudge();
        match meant(self, count) {
            Ok(commands) => self.carry_out_all(&commands),
            Err(reason) => self.say(reason),
        }
        self.view.keep_focus();
        self.read_now();
    }
}
