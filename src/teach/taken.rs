//! A lesson that is taken: its page, the predictions of the one who takes it, and what the lab does for it.

use super::class::Place;
use super::clock::{self, Clock};
use super::lesson::{Answer, Asked, Lesson, Page, Predict};
use super::names::value;
use super::predictions::Predictions;
use super::stage::Stage;
use super::stated::Stated;
use super::watch::Watch;
use super::{reading, shipped};
use crate::lab::Lab;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::command::Command;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long the pages before one may take to be carried out: no key is answered meanwhile.
const LONGEST: Duration = Duration::from_secs(5);
const TOO_LONG: &str =
    "the pages before this one take too long: its lab block should open a run of its own";

/// A lesson that is taken.
#[derive(Debug)]
pub struct Taken {
    lesson: Arc<Lesson>,
    /// Its file, where it does not come with the program.
    watch: Option<Watch>,
    place: Place,
    /// The selected answer of the open question, from 0.
    selected: usize,
    /// Whether an answer on this page was selected or given.
    has_come_to_question: bool,
    /// The lines of the checks of this page that have held.
    reached: BTreeSet<usize>,
    /// The texts of this page that the student's own run does not change, with their numbers, by their lines in the file;
    /// `None` until the run has arrived where the page wants it.
    stated: Option<Stated>,
    /// Whether the hints of the page's checks are shown.
    shows_hints: bool,
    /// The block that the lab is carrying out.
    under_way: Option<Block>,
    /// Whether turning the page was refused once, because a prediction is open.
    was_asked: bool,
    /// The clock, where the teacher's notes are shown.
    clock: Option<Clock>,
    /// When the lesson was opened in this lab, on the clock of the lab.
    since: Duration,
    /// How long before that it was opened first.
    gone_before: Duration,
}

/// A block of a page that the lab carries out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Block {
    /// The `lab` block of the page with this number.
    Lab(usize),
    /// Its `task` block.
    Task(usize),
}

impl Taken {
    /// `lesson` at `place`, opened at `now` on the clock of the lab.
    pub(super) fn new(lesson: Lesson, mut place: Place, now: Duration) -> Self {
        place.page = place.page.clamp(1, lesson.pages.len().max(1));
        let unix_s = clock::unix_s();
        if place.began_unix_s == 0 {
            place.began_unix_s = unix_s;
        }
        let gone_before = Duration::from_secs(unix_s.saturating_sub(place.began_unix_s));
        let watch = match shipped::find(&lesson.name) {
            Some(_) => None,
            None => Some(Watch::new(Path::new(&lesson.name))),
        };
        Self {
            lesson: Arc::new(lesson),
            watch,
            place,
            selected: 0,
            has_come_to_question: false,
            reached: BTreeSet::new(),
            stated: None,
            shows_hints: false,
            under_way: None,
            was_asked: false,
            clock: None,
            since: now,
            gone_before,
        }
    }

    /// The lesson.
    pub fn lesson(&self) -> &Lesson {
        &self.lesson
    }

    /// Where it stands.
    pub fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn into_place(self) -> Place {
        self.place
    }

    /// The page that is open.
    pub fn page(&self) -> Option<&Page> {
        self.lesson.page(self.place.page)
    }

    /// The question of the page that is not answered yet; the first of them.
    pub fn asked(&self) -> Option<&Predict> {
        self.place.predictions.open_on(self.page()?).next()
    }

    /// The selected answer of the open question, from 0.
    pub fn selected(&self) -> usize {
        self.selected
    }

    /// Whether an answer on this page was selected or given.
    pub fn has_come_to_question(&self) -> bool {
        self.has_come_to_question
    }

    /// Whether the check at this line of the file has held since the page was opened.
    pub fn has_reached(&self, line: usize) -> bool {
        self.reached.contains(&line)
    }

    /// Whether the lab is still on its way to where the page wants it.
    pub fn is_under_way(&self) -> bool {
        self.stated.is_none()
    }

    /// The text at this line of the file with its numbers, where it is one that the student's own run does not change.
    pub fn stated(&self, line: usize) -> Option<&str> {
        self.stated.as_ref()?.text(line)
    }

    /// Whether the hints of the page's checks are shown.
    pub fn shows_hints(&self) -> bool {
        self.shows_hints
    }

    /// The clock, where the teacher's notes are shown.
    pub fn clock(&self) -> Option<Clock> {
        self.clock
    }

    /// What that clock shows.
    pub fn time(&self, now: Duration) -> Option<String> {
        let since = now.saturating_sub(self.since) + self.gone_before;
        self.clock
            .map(|clock| clock.shown(since, self.lesson.minutes))
    }

    /// Turns to the page `page` (from 1), or stays, and makes the lab stand there.
    ///
    /// # Errors
    /// When there is no such page; nothing has changed then. When an earlier page could not be carried out.
    pub(super) fn go_to(&mut self, page: Option<usize>, lab: &mut Lab) -> Result<(), String> {
        let page = page.unwrap_or(self.place.page);
        if self.lesson.page(page).is_none() {
            let (name, pages) = (&self.lesson.name, self.lesson.pages.len());
            return Err(format!("{name} has the pages 1 to {pages}, not {page}"));
        }
        self.turn_to(page);
        self.stand(lab)
    }

    /// Makes the lab stand on the page, whatever was done before: what the pages before it do is done at once, what the page
    /// itself does as time passes.
    fn stand(&mut self, lab: &mut Lab) -> Result<(), String> {
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        let stages = lesson.stages_to(page, &self.place.kept, &self.place.predictions);
        let last = match stages.last() {
            Some(last) if last.page.number == page => Some(last),
            _ => None,
        };
        let before = stages.len() - usize::from(last.is_some());
        let begin = Instant::now();
        let mut is_late = false;
        for stage in &stages[..before] {
            stage.carry_out(lab, &mut self.place.kept, |_, _| {
                is_late |= begin.elapsed() > LONGEST;
                match is_late {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            })?;
            if is_late {
                return Err(TOO_LONG.to_owned());
            }
        }
        if let Some(stage) = last {
            self.begin(stage, Block::Lab(page), lab);
        }
        Ok(())
    }

    fn begin(&mut self, stage: &Stage<'_>, block: Block, lab: &mut Lab) {
        let commands = stage.commands(lab);
        self.under_way = Some(block);
        lab.take_commands(commands);
        lab.forget_message_of_script();
        self.keep_if_done(lab);
        lab.turn_to_sheet();
    }

    /// Remembers the numbers of the block that was under way, once the lab has carried it out.
    fn keep_if_done(&mut self, lab: &mut Lab) -> bool {
        let Some(block) = self.under_way else {
            return false;
        };
        if !lab.script().is_done() {
            return false;
        }
        self.under_way = None;
        lab.forget_message_of_script();
        let lesson = Arc::clone(&self.lesson);
        let stage = match block {
            Block::Lab(page) => lesson.stage_of(page, &self.place.predictions),
            Block::Task(page) => lesson.task_of(page, &self.place.predictions),
        };
        if let Some(stage) = stage {
            stage.keep(lab, &mut self.place.kept);
        }
        true
    }

    fn turn_to(&mut self, page: usize) {
        self.place.page = page;
        (self.selected, self.was_asked, self.under_way) = (0, false, None);
        (self.has_come_to_question, self.shows_hints) = (false, false);
        self.stated = None;
        self.place.has_ended |= page == self.lesson.pages.len();
        self.reached.clear();
    }

    pub(super) fn act(&mut self, key: LessonKey, lab: &mut Lab) -> Option<Direction> {
        match key {
            LessonKey::Next => self.next(lab),
            LessonKey::Before => self.before(lab),
            LessonKey::Again => {
                self.turn_to(self.place.page);
                let stood = self.stand(lab);
                told(stood, lab);
            }
            LessonKey::ShowTask => self.show_task(lab),
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

    /// Shows the hints of the page, or does its task where they are shown already.
    fn show_task(&mut self, lab: &mut Lab) {
        let has_hint = self.page().is_some_and(|page| {
            let mut checks = page.checks();
            checks.any(|check| !check.hint.is_empty())
        });
        if has_hint && !std::mem::replace(&mut self.shows_hints, true) {
            return;
        }
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        match lesson.task_of(page, &self.place.predictions) {
            Some(stage) => self.begin(&stage, Block::Task(page), lab),
            None => lab.refuse("this page has no task"),
        }
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
    pub(super) fn answer(&mut self, number: f64, lab: &mut Lab) {
        if let Some(predict) = self.asked().cloned() {
            self.lock(&predict, Answer::Number(number), lab);
        }
    }

    /// Locks `answer`. Once nothing on the page is open, what it hides is shown.
    fn lock(&mut self, predict: &Predict, answer: Answer, lab: &mut Lab) {
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
                lab.carry_out_now(&Command::Hide(hidden));
            }
        }
    }

    /// Takes note of what the lab has done, and of a file that has changed. Returns whether the page is another now.
    pub(super) fn advance(&mut self, now: Duration, lab: &mut Lab) -> bool {
        let mut is_new = self.keep_if_done(lab);
        is_new |= self.state(lab);
        if !self.is_under_way() && lab.has_changed() {
            is_new |= self.note_reached(lab);
        }
        if let Some(watch) = &mut self.watch
            && watch.has_changed(now)
        {
            is_new = true;
            match reading::read_again(watch.path()) {
                Ok(lesson) => self.take_file(lesson, lab),
                Err(problems) => {
                    let text = problems.to_string();
                    let first = text.lines().next().unwrap_or_default();
                    lab.tell(format!("the page stays as it was: {first}"));
                }
            }
        }
        is_new
    }

    /// States the page's numbers once the run has arrived.
    fn state(&mut self, lab: &Lab) -> bool {
        let has_arrived = self.under_way.is_none()
            && lab.script().is_done()
            && lab.player().playback().steps_to_go().is_none();
        if self.stated.is_some() || !has_arrived {
            return false;
        }
        self.stated = Some(Stated::of(&self.lesson, &self.place, lab));
        true
    }

    /// Goes on with `lesson`, the file as it is now, on the same page; the run stays where it is.
    fn take_file(&mut self, lesson: Lesson, lab: &mut Lab) {
        let name = self.lesson.name.clone();
        self.place.page = self.place.page.min(lesson.pages.len().max(1));
        self.lesson = Arc::new(Lesson { name, ..lesson });
        self.reached.clear();
        self.stated = None;
        lab.tell("the lesson was read again: R begins the page again");
    }

    /// Takes note of the checks of the page that hold now; returns whether one is new.
    fn note_reached(&mut self, lab: &Lab) -> bool {
        let Some(page) = self.lesson.page(self.place.page) else {
            return false;
        };
        let before = self.reached.len();
        let held = page
            .checks()
            .filter(|check| holds(check, lab, &self.place.kept));
        let held: Vec<_> = held.map(|check| check.line).collect();
        self.reached.extend(held);
        self.reached.len() > before
    }
}

/// Whether `check` holds in `lab`.
fn holds(check: &super::Check, lab: &Lab, kept: &super::Kept) -> bool {
    value(&check.that, lab, kept).is_some_and(|held| held != 0.0)
}

/// Says why a page could not be carried out.
fn told(stood: Result<(), String>, lab: &mut Lab) {
    if let Err(reason) = stood {
        lab.tell(reason);
    }
}
