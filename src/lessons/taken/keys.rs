//! The keys of a lesson: turning its pages, predicting, and asking for help.

use super::{Taken, UnderWay, holds};
use crate::lab::Lab;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::command::Command;
use crate::lessons::clock::Clock;
use crate::lessons::lesson::{Answer, Asked, Predict};
use crate::lessons::predictions::Predictions;
use std::sync::Arc;

impl Taken {
    pub(in crate::lessons) fn act(&mut self, key: LessonKey, lab: &mut Lab) -> Option<Direction> {
        match key {
            LessonKey::Next => self.next(lab),
            LessonKey::Before => self.before(lab),
            LessonKey::Again => {
                self.turn_to(self.place.page);
                let stood = self.stand(lab);
                told(stood, lab);
            }
            LessonKey::ShowTask => return self.show_task(lab),
            LessonKey::Notes => {
                self.clock = match self.clock {
                    None => Some(Clock::Up),
                    Some(clock) => clock.next(self.lesson.minutes),
                };
            }
            LessonKey::Move(direction @ (Direction::Up | Direction::Down)) => {
                return self.select(direction);
            }
            LessonKey::Move(direction) => return Some(direction),
            LessonKey::Take => self.take(lab),
            LessonKey::List | LessonKey::Leave => {}
        }
        None
    }

    /// Turns to the next page. Where a prediction is open, it asks for it once.
    fn next(&mut self, lab: &mut Lab) {
        if self.place.page >= self.lesson.pages.len() {
            lab.refuse("this is the last page: L lists the lessons, N turns back");
            return;
        }
        if self.asked().is_some() && !std::mem::replace(&mut self.was_asked, true) {
            lab.refuse("predict first: what you write down you see better. n again leaves it open");
            return;
        }
        self.keep_own_task(lab);
        let page = self.place.page + 1;
        self.turn_to(page);
        lab.turn_to_sheet();
        let has_own = self.page().is_some_and(|page| page.lab().is_some());
        // A page without a block of its own leaves the lab as the student has it.
        if has_own {
            let stood = self.stand(lab);
            told(stood, lab);
        }
    }

    /// Where the student has done the task of the page, its numbers are those of the student's run.
    fn keep_own_task(&mut self, lab: &Lab) {
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        let is_done = lesson.page(page).is_some_and(|page| {
            let mut checks = page.checks();
            page.checks().next().is_some()
                && checks.all(|check| holds(check, lab, &self.place.kept))
        });
        if let (true, Some(stage)) = (is_done, lesson.task_of(page, &self.place.predictions)) {
            stage.keep(lab, &mut self.place.kept);
        }
    }

    fn before(&mut self, lab: &mut Lab) {
        if self.place.page <= 1 {
            lab.refuse("this is the first page");
            return;
        }
        let page = self.place.page - 1;
        let stood = self.go_to(Some(page), lab);
        told(stood, lab);
        lab.turn_to_sheet();
    }

    /// Shows the hints of the page and scrolls down to them, or does its task where they are shown already or there are none.
    fn show_task(&mut self, lab: &mut Lab) -> Option<Direction> {
        let has_hint = self.page().is_some_and(|page| {
            let mut checks = page.checks();
            checks.any(|check| !check.hint.is_empty())
        });
        if has_hint && !std::mem::replace(&mut self.shows_hints, true) {
            return Some(Direction::PageDown);
        }
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        match lesson.task_of(page, &self.place.predictions) {
            Some(stage) => self.begin(&stage, UnderWay::Task(page), lab),
            None => lab.refuse("this page has no task"),
        }
        None
    }

    /// Selects the answer above or below; scrolls where none is to be chosen.
    fn select(&mut self, direction: Direction) -> Option<Direction> {
        let Some(Asked::Choice(choices)) = self.asked().map(|predict| &predict.asked) else {
            return Some(direction);
        };
        let last = choices.len().saturating_sub(1);
        self.has_come_to_question = true;
        self.selected = match direction {
            Direction::Up => self.selected.saturating_sub(1),
            _ => (self.selected + 1).min(last),
        };
        None
    }

    /// Locks the selected answer, or asks for a number.
    fn take(&mut self, lab: &mut Lab) {
        let Some(predict) = self.asked().cloned() else {
            lab.refuse("nothing is asked here: n turns the page");
            return;
        };
        match &predict.asked {
            Asked::Choice(choices) => {
                if let Some(choice) = choices.get(self.selected) {
                    self.lock(&predict, Answer::Choice(choice.clone()), lab);
                }
            }
            Asked::Number { unit } => {
                let label = if unit.is_empty() { "number" } else { unit };
                let about = "Enter locks it: a prediction is not changed";
                lab.ask_number("your prediction", label, about);
            }
        }
    }

    /// Locks `number` as the answer to the open question.
    pub(in crate::lessons) fn answer(&mut self, number: f64, lab: &mut Lab) {
        if let Some(predict) = self.asked().cloned() {
            self.lock(&predict, Answer::Number(number), lab);
        }
    }

    /// Locks `answer`. Once nothing on the page is open, what it hides is shown.
    fn lock(&mut self, predict: &Predict, answer: Answer, lab: &mut Lab) {
        if self.place.predictions.is_locked(predict)
            && self.again.take_if(|again| *again == predict.name).is_some()
        {
            self.voted = Some((predict.name.clone(), answer));
            self.selected = 0;
            lab.refuse("your vote of this round is in; your first answer stays beside it");
            return;
        }
        if let Err(reason) = self.place.predictions.lock(predict, answer) {
            lab.refuse(reason);
            return;
        }
        (self.selected, self.has_come_to_question) = (0, true);
        if let Some(stated) = &mut self.stated {
            stated.take_in(&predict.name, &self.lesson, &self.place, lab);
        }
        let Some(page) = self.page() else {
            return;
        };
        if self.place.predictions.are_locked_on(page) {
            let hidden = lab.view().hidden.clone();
            let hidden = Predictions::hidden_after_lock(page, &hidden);
            if hidden != lab.view().hidden {
                lab.carry_out_now(&Command::look("hide", hidden));
            }
        }
    }
}

/// Says why a page could not be carried out.
fn told(stood: Result<(), String>, lab: &mut Lab) {
    if let Err(reason) = stood {
        lab.tell(reason);
    }
}
