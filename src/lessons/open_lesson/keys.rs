//! The keys of a lesson: turning pages, predicting, and asking for help.

use super::{OpenLesson, PendingBlock, before_task, compared, holds};
use crate::lab::Lab;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::command::Command;
use crate::lessons::clock;
use crate::lessons::lesson::{AnswerKind, LessonBlock, LessonPage, Predict, PredictionAnswer};
use crate::lessons::predictions::{LockedAnswer, Predictions, Tried};
use std::collections::BTreeMap;
use std::sync::Arc;

const LOCKED: &str = "your answer is locked and cannot be changed";

impl OpenLesson {
    pub(in crate::lessons) fn on_key(
        &mut self,
        key: LessonKey,
        lab: &mut Lab,
    ) -> Option<Direction> {
        match key {
            LessonKey::Next => self.next(lab),
            LessonKey::Before => self.before(lab),
            LessonKey::Again => {
                self.turn_to(self.place.page);
                let result = self.replay_page(false, lab);
                report(result, lab);
            }
            LessonKey::ShowTask => return self.show_task(lab),
            LessonKey::Notes => self.shows_notes ^= true,
            LessonKey::Move(direction @ (Direction::Up | Direction::Down)) => {
                return self.select(direction);
            }
            LessonKey::Move(direction) => return Some(direction),
            LessonKey::Take => self.confirm_answer(lab),
            LessonKey::Digit(digit) => self.answer_by_digit(digit, lab),
            LessonKey::Sign(sign) => self.ask_number(Some(sign), lab),
            LessonKey::List | LessonKey::Leave | LessonKey::Select(_) | LessonKey::Filter(_) => {}
        }
        None
    }

    /// Turns to the next page. If a prediction is open, the first press only reminds the user of it.
    fn next(&mut self, lab: &mut Lab) {
        if self.plays() {
            // Play the page's run to its end at once.
            let result = self.replay_page(true, lab);
            if result.is_err() {
                // The page is shown as far as it got; the next `n` turns it.
                self.place.stated = Some(BTreeMap::new());
            }
            return report(result, lab);
        }
        if self.place.page >= self.lesson.pages.len() {
            lab.refuse("this is the last page: L lists the lessons, N turns back");
            return;
        }
        if self.asked().is_some() && !std::mem::replace(&mut self.was_asked, true) {
            lab.refuse(if self.has_chosen() {
                "press Enter to lock your answer, or n again to skip"
            } else {
                "write down a prediction first, or press n again to skip"
            });
            return;
        }
        self.keep_own_task(lab);
        // The next page builds on this page's task as the lesson does it.
        let has_wandered =
            self.has_wandered(lab) || self.page().is_some_and(|page| page.task().is_some());
        self.turn_to(self.place.page + 1);
        lab.view_mut().turn_to_sheet();
        // A page without a `lab` block and without numbers leaves the lab as the student has it.
        if let Some(page) = self.page()
            && (page.lab().is_some() || has_wandered && page.states_numbers(&self.place.kept))
        {
            let result = self.replay_page(false, lab);
            report(result, lab);
        }
    }

    /// Keeps the numbers of the student's run, if the student has done the task of the page.
    fn keep_own_task(&mut self, lab: &Lab) {
        let lesson = Arc::clone(&self.lesson);
        let number = self.place.page;
        let checks: Vec<_> = lesson
            .page(number)
            .map_or(vec![], |page| page.checks().collect());
        let is_done = checks
            .iter()
            .all(|check| holds(check, lab, &self.place.kept));
        if !checks.is_empty()
            && is_done
            && let Some(stage) = lesson.task_of(number, &self.place.predictions)
        {
            stage.keep(lab, &mut self.place.kept);
        }
    }

    fn before(&mut self, lab: &mut Lab) {
        if self.place.page <= 1 {
            lab.refuse("this is the first page");
            return;
        }
        let page = self.place.page - 1;
        let result = self.go_to(Some(page), lab);
        report(result, lab);
        lab.view_mut().turn_to_sheet();
    }

    /// Shows the hints of the page and scrolls down to them. If they are shown already or there are none, does the
    /// task.
    fn show_task(&mut self, lab: &mut Lab) -> Option<Direction> {
        let has_hint = (self.page().into_iter().flat_map(LessonPage::checks))
            .any(|check| !check.hint.is_empty());
        if has_hint && !std::mem::replace(&mut self.shows_hints, true) {
            self.note_tried(Tried::Hint);
            return Some(Direction::PageDown);
        }
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        match lesson.task_of(page, &self.place.predictions) {
            Some(stage) => {
                self.note_tried(Tried::Shown);
                self.start_block(&stage, PendingBlock::Task(page), lab);
            }
            None => lab.refuse("this page has no task"),
        }
        None
    }

    /// Chooses the answer above or below. Scrolls if there is no choice.
    fn select(&mut self, direction: Direction) -> Option<Direction> {
        let Some(predict) = self.asked().cloned() else {
            return Some(direction);
        };
        let AnswerKind::Choice(choices) = &predict.asked else {
            return Some(direction);
        };
        let last = choices.len().saturating_sub(1);
        let at = match (self.chosen.get(&predict.name), direction) {
            (None, Direction::Up) => last,
            (None, _) => 0,
            (Some(at), Direction::Up) => at.saturating_sub(1),
            (Some(at), _) => (at + 1).min(last),
        };
        self.chosen.insert(predict.name, at);
        None
    }

    /// Locks the chosen answer, or asks for a number.
    fn confirm_answer(&mut self, lab: &mut Lab) {
        let Some(predict) = self.asked().cloned() else {
            let mut asked = self.page().into_iter().flat_map(LessonPage::predicts);
            return lab.refuse(match asked.next() {
                Some(_) => LOCKED,
                None => "this page asks no question",
            });
        };
        let AnswerKind::Choice(choices) = &predict.asked else {
            return self.ask_number(None, lab);
        };
        let chosen = self.chosen.get(&predict.name);
        match chosen.and_then(|at| choices.get(*at)) {
            None => lab.refuse("choose an answer first: type its number, or press Up and Down"),
            Some(choice) => self.lock(&predict, PredictionAnswer::Choice(choice.clone()), lab),
        }
    }

    /// Chooses the answer with this number, or begins to type a number with this digit.
    fn answer_by_digit(&mut self, digit: u8, lab: &mut Lab) {
        let Some(predict) = self.asked().cloned() else {
            return;
        };
        match (&predict.asked, usize::from(digit)) {
            (AnswerKind::Number { .. }, _) => {
                self.ask_number(Some(char::from(b'0' + digit % 10)), lab);
            }
            (AnswerKind::Choice(all), number) if (1..=all.len()).contains(&number) => {
                self.chosen.insert(predict.name, number - 1);
            }
            (AnswerKind::Choice(all), _) => {
                lab.refuse(format!("the answers are 1 to {}", all.len()));
            }
        }
    }

    fn ask_number(&self, typed: Option<char>, lab: &mut Lab) {
        if let Some(AnswerKind::Number { unit }) = self.asked().map(|predict| &predict.asked) {
            let about = "Enter locks it; it cannot be changed later";
            lab.popups_mut()
                .ask_number("your prediction", unit, about, typed);
        }
    }

    /// Locks `number` as the answer to the open question.
    pub(in crate::lessons) fn answer(&mut self, number: f64, lab: &mut Lab) {
        if let Some(predict) = self.asked().cloned() {
            self.lock(&predict, PredictionAnswer::Number(number), lab);
        }
    }

    /// Locks `answer` as the vote of the current round.
    fn lock(&mut self, predict: &Predict, answer: PredictionAnswer, lab: &mut Lab) {
        let class_round = self.rounds.get(&predict.name).copied();
        let (round, is_closed) = class_round.unwrap_or((1, false));
        self.lock_in_round(predict, answer, (round, is_closed), lab);
    }

    /// Locks the chosen answer to the question `name` of the page, as a vote of `round` in time. Returns the number of
    /// the answer, if one is chosen.
    pub(in crate::lessons) fn lock_chosen(
        &mut self,
        name: &str,
        round: u32,
        lab: &mut Lab,
    ) -> Option<String> {
        let predict = self.page()?.predicts().find(|it| it.name == name)?.clone();
        let AnswerKind::Choice(choices) = &predict.asked else {
            return None;
        };
        let at = self.chosen.get(name).copied()?;
        let answer = PredictionAnswer::Choice(choices.get(at)?.clone());
        self.lock_in_round(&predict, answer, (round, false), lab);
        Some((at + 1).to_string())
    }

    /// Locks `answer` in a round, which may be closed. Once all questions of the page are answered, shows the parts
    /// that the page hides.
    fn lock_in_round(
        &mut self,
        predict: &Predict,
        answer: PredictionAnswer,
        (round, is_closed): (u32, bool),
        lab: &mut Lab,
    ) {
        let given = LockedAnswer {
            round,
            answer,
            late: is_closed || self.place.seen.contains(&predict.name),
            page: self.place.page,
            time_unix_s: clock::unix_s(),
        };
        if let Err(reason) = self.place.predictions.lock(predict, given) {
            return lab.refuse(reason);
        }
        self.chosen.remove(&predict.name);
        self.has_answered = true;
        self.state_again(&predict.name, lab);
        let Some(page) = self.page() else {
            return;
        };
        if self.place.predictions.are_locked_on(page) {
            let hidden = Predictions::hidden_after_lock(page, &lab.view().look.hide);
            if hidden != lab.view().look.hide {
                lab.carry_out_now(&Command::look("hide", hidden));
            }
        }
    }
}

impl OpenLesson {
    /// Updates the page's texts on the prediction called `name`, which has just been locked.
    fn state_again(&mut self, name: &str, lab: &Lab) {
        let mut texts = Vec::new();
        for block in before_task(&self.lesson, &self.place) {
            if let LessonBlock::Compare(compare) = block
                && compare.prediction == name
            {
                let text = compared(compare, &self.lesson, &self.place, lab);
                texts.push((compare.line.to_string(), text));
            }
        }
        if let Some(stated) = &mut self.place.stated
            && !texts.is_empty()
        {
            self.place.seen.insert(name.to_owned());
            stated.extend(texts);
        }
    }
}

/// Shows why a page could not be carried out.
fn report(result: Result<(), String>, lab: &mut Lab) {
    if let Err(reason) = result {
        lab.tell(reason);
    }
}
