//! The open lesson: its page, its reader's predictions, and its effects on the lab.

mod keys;

use super::KeptNumbers;
use super::clock;
use super::lesson::{Check, Compare, Lesson, LessonBlock, LessonPage, Predict};
use super::names::value;
use super::predictions::{LessonProgress, Tried};
use super::stage::LessonStage;
use super::watch::Watch;
use super::{opening, shipped};
use crate::engine::analysis::readouts;
use crate::engine::text::number;
use crate::engine::text::unit::Unit;
use crate::lab::Lab;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest time for carrying out the pages before a page. No key is handled meanwhile.
const LONGEST_PAGE_REPLAY: Duration = Duration::from_secs(5);
const REPLAY_TOO_LONG: &str =
    "the pages before this one take too long: its lab block should open a run of its own";

/// The open lesson.
#[derive(Debug)]
pub struct OpenLesson {
    pub lesson: Arc<Lesson>,
    /// Watched file, unless the lesson comes with the program.
    watch: Option<Watch>,
    pub place: LessonProgress,
    /// Chosen answers (from 0) that Enter locks, by the names of their questions.
    pub chosen: BTreeMap<String, usize>,
    /// True if an answer on this page has been locked.
    pub has_answered: bool,
    /// Lines of the checks of this page that have held.
    reached: BTreeSet<usize>,
    /// State of the lab when it had carried out the blocks of the page: number of acts, and step.
    arrived_at: Option<(usize, u64)>,
    /// True if the hints of the page's checks are shown.
    pub shows_hints: bool,
    under_way: Option<PendingBlock>,
    /// Set while a class is followed: true if the class's run has arrived at the state of the page.
    pub(super) follows: Option<bool>,
    /// Current rounds of the class's questions by name, each with a flag that it is closed.
    pub(super) rounds: BTreeMap<String, (u32, bool)>,
    /// Set after the first `n` on a page with an open prediction.
    pub(super) was_asked: bool,
    /// True if the teacher's notes and the clock are shown.
    pub shows_notes: bool,
    /// Time at which the lesson was opened in this lab, on the clock of the lab.
    since: Duration,
    /// Time from the first opening of the lesson until `since`.
    gone_before: Duration,
}

/// The state of a lesson in a followed class.
///
/// `has_arrived` is true if the class's run has arrived at the state of the page.
#[derive(Clone, Copy, Debug)]
pub struct ClassPage<'a> {
    pub lesson: &'a str,
    pub page: usize,
    pub kept: &'a KeptNumbers,
    pub has_arrived: bool,
}

/// A block of a page that the lab is carrying out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PendingBlock {
    Lab(usize),
    Task(usize),
    /// The student has stopped the block before its end.
    Left,
}

impl OpenLesson {
    /// Opens `lesson` at `place`. `now` is the time on the clock of the lab.
    pub(super) fn new(lesson: Lesson, mut place: LessonProgress, now: Duration) -> Self {
        place.page = place.page.clamp(1, lesson.pages.len().max(1));
        let unix_s = clock::unix_s();
        if place.began_unix_s == 0 {
            place.began_unix_s = unix_s;
        }
        let gone_before = Duration::from_secs(unix_s.saturating_sub(place.began_unix_s));
        let is_file = shipped::find(&lesson.name).is_none();
        let watch = is_file.then(|| Watch::new(Path::new(&lesson.name)));
        Self {
            lesson: Arc::new(lesson),
            watch,
            place,
            chosen: BTreeMap::new(),
            has_answered: false,
            reached: BTreeSet::new(),
            arrived_at: None,
            shows_hints: false,
            under_way: None,
            follows: None,
            rounds: BTreeMap::new(),
            was_asked: false,
            shows_notes: false,
            since: now,
            gone_before,
        }
    }

    pub(super) fn into_place(self) -> LessonProgress {
        self.place
    }

    pub fn page(&self) -> Option<&LessonPage> {
        self.lesson.page(self.place.page)
    }

    /// Returns the first question of the page that is not answered.
    pub fn asked(&self) -> Option<&Predict> {
        self.page()?
            .predicts()
            .find(|predict| self.is_open(predict))
    }

    /// Returns true if an answer to the open question is chosen but not locked.
    fn has_chosen(&self) -> bool {
        let asked = self.asked();
        asked.is_some_and(|it| self.chosen.contains_key(&it.name))
    }

    /// Returns true if `predict` needs an answer: it has none, or none in the current round of the class.
    pub fn is_open(&self, predict: &Predict) -> bool {
        let predictions = &self.place.predictions;
        match self.rounds.get(&predict.name) {
            Some((round, false)) if predictions.in_round(predict, *round).is_none() => true,
            _ => !predictions.is_locked(predict),
        }
    }

    /// Shows the page of `class` without changing the run. Returns true if the page is new.
    pub(super) fn show_class_page(&mut self, class: &ClassPage<'_>) -> bool {
        let page = class.page.clamp(1, self.lesson.pages.len().max(1));
        let before = self.follows.replace(class.has_arrived);
        let is_new = self.place.page != page || before.is_none();
        if is_new {
            self.turn_to(page);
        }
        self.place.kept.extend(class.kept.clone());
        is_new
    }

    /// Leaves the class. If the class's run had not arrived, the page counts as left before the end of its own run.
    pub(super) fn leave_class(&mut self) {
        let is_left = self.follows.take() == Some(false) && self.is_under_way();
        self.under_way = is_left.then_some(PendingBlock::Left).or(self.under_way);
    }

    /// Returns true if the check at this line of the file has held since the page was opened.
    pub fn has_reached(&self, line: usize) -> bool {
        self.reached.contains(&line)
    }

    /// Returns true until the lab has arrived at the state of the page.
    pub fn is_under_way(&self) -> bool {
        self.place.stated.is_none()
    }

    /// Returns true if the page plays its run, which has not arrived yet.
    pub fn plays(&self) -> bool {
        self.is_under_way() && self.page().is_some_and(LessonPage::plays)
    }

    /// Returns true if the student has stopped the page's run before its end.
    pub fn has_left(&self) -> bool {
        self.under_way == Some(PendingBlock::Left)
    }

    /// Resumes a page whose run had not ended when the page was left, or was stopped before its end.
    pub(super) fn resume_page(&mut self, lab: &Lab) {
        if self.is_under_way() && !lab.script().is_done() {
            self.under_way = Some(PendingBlock::Lab(self.place.page));
        } else if self.plays() {
            self.under_way = Some(PendingBlock::Left);
        }
    }

    /// Returns true if the lab is no longer in the state in which the page's numbers were stated.
    fn has_wandered(&self, lab: &Lab) -> bool {
        self.arrived_at != Some(place_of(lab))
    }

    /// Returns the text at this line of the file with its numbers, if the student's own run does not change them.
    pub fn stated(&self, line: usize) -> Option<&str> {
        let texts = self.place.stated.as_ref()?;
        texts.get(&line.to_string()).map(String::as_str)
    }

    pub fn time(&self, now: Duration) -> Option<String> {
        let since = now.saturating_sub(self.since) + self.gone_before;
        self.shows_notes
            .then(|| clock::shown(since, self.lesson.minutes))
    }

    /// Turns to the page `page` (from 1), or stays on the current page, and brings the lab to its state.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such page; nothing changes then. Returns an error if an earlier page cannot be
    /// carried out.
    pub(super) fn go_to(&mut self, page: Option<usize>, lab: &mut Lab) -> Result<(), String> {
        let page = page.unwrap_or(self.place.page);
        if self.lesson.page(page).is_none() {
            let (name, pages) = (&self.lesson.name, self.lesson.pages.len());
            return Err(format!(
                "{name} has no page {page}: its pages are 1 to {pages}"
            ));
        }
        self.turn_to(page);
        self.replay_page(false, lab)
    }

    /// Brings the lab to the state of the page, whatever was done before.
    ///
    /// The blocks of earlier pages are carried out at once. The block of this page is carried out as time passes, or at
    /// once if `at_once` is true.
    fn replay_page(&mut self, at_once: bool, lab: &mut Lab) -> Result<(), String> {
        let lesson = Arc::clone(&self.lesson);
        let page = self.place.page;
        let mut stages = lesson.stages_to(page, &self.place.kept, &self.place.predictions);
        let last = stages.pop_if(|last| last.page.number == page && !at_once);
        let begin = Instant::now();
        lab.set_undo_floor(false);
        for stage in &stages {
            stage.carry_out(lab, &mut self.place.kept, |_, _| {
                if begin.elapsed() > LONGEST_PAGE_REPLAY {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })?;
            if begin.elapsed() > LONGEST_PAGE_REPLAY {
                return Err(REPLAY_TOO_LONG.to_owned());
            }
        }
        match last {
            Some(stage) => self.start_block(&stage, PendingBlock::Lab(page), lab),
            None => {
                self.arrive(lab);
                lab.view_mut().turn_to_sheet();
            }
        }
        Ok(())
    }

    /// Records that the lab has arrived at the state of the page.
    fn arrive(&mut self, lab: &mut Lab) {
        self.under_way = None;
        self.arrived_at = Some(place_of(lab));
        lab.set_undo_floor(true);
    }

    fn start_block(&mut self, stage: &LessonStage<'_>, block: PendingBlock, lab: &mut Lab) {
        let commands = stage.commands(lab);
        self.under_way = Some(block);
        lab.take_commands(commands);
        lab.forget_message_of_script();
        self.keep_if_done(lab);
        lab.view_mut().turn_to_sheet();
    }

    /// Keeps the numbers of the pending block once the lab has carried it out. Returns true if the page must be
    /// redrawn.
    fn keep_if_done(&mut self, lab: &mut Lab) -> bool {
        let Some(block) = self.under_way else {
            return false;
        };
        if !lab.script().is_done() || block == PendingBlock::Left {
            return false;
        }
        if lab.script().has_broken_off() {
            self.under_way = Some(PendingBlock::Left).filter(|_| self.is_under_way());
            if self.plays() && lab.script().was_stopped() {
                lab.tell("you left the page's run: press b to play it again, n to jump to its end");
            }
            return true;
        }
        self.arrive(lab);
        lab.set_undo_floor(matches!(block, PendingBlock::Lab(_)));
        lab.forget_message_of_script();
        let lesson = Arc::clone(&self.lesson);
        let stage = match block {
            PendingBlock::Lab(page) => lesson.stage_of(page, &self.place.predictions),
            PendingBlock::Task(page) => lesson.task_of(page, &self.place.predictions),
            PendingBlock::Left => None,
        };
        if let Some(stage) = stage {
            stage.keep(lab, &mut self.place.kept);
        }
        true
    }

    fn turn_to(&mut self, page: usize) {
        self.place.page = page;
        (self.was_asked, self.under_way) = (false, None);
        (self.has_answered, self.shows_hints) = (false, false);
        self.place.stated = None;
        self.place.has_ended |= page == self.lesson.pages.len();
        self.reached.clear();
    }

    /// Reacts to changes of the lab and of the lesson's file. Returns true if the page has changed.
    pub(super) fn update(&mut self, now: Duration, lab: &mut Lab) -> bool {
        let mut is_new = self.keep_if_done(lab);
        is_new |= self.state(lab);
        if !self.is_under_way() && lab.has_changed() {
            is_new |= self.note_reached(lab);
        }
        if let Some(watch) = &mut self.watch
            && watch.has_changed(now)
        {
            is_new = true;
            match opening::read_again(&watch.path) {
                Ok(lesson) => self.take_file(lesson, lab),
                Err(problems) => {
                    let text = problems.to_string();
                    let first = text.lines().next().unwrap_or_default();
                    lab.tell(format!("the changed lesson has an error: {first}"));
                }
            }
        }
        is_new
    }

    /// States the page's numbers once the run has arrived. The outcomes on the page count as seen from the start of its
    /// run.
    fn state(&mut self, lab: &Lab) -> bool {
        if !self.is_under_way() {
            return false;
        }
        let page = self.lesson.page(self.place.page);
        for compare in page.into_iter().flat_map(LessonPage::compares) {
            // The outcome of a question on this page is seen only after its answer.
            if !page.is_some_and(|page| page.asks(&compare.prediction)) {
                self.place.seen.insert(compare.prediction.clone());
            }
        }
        let has_arrived = self.follows.unwrap_or(true)
            && self.under_way.is_none()
            && lab.script().is_done()
            && lab.player().steps_to_go().is_none();
        if has_arrived {
            self.place.stated = Some(stated(&self.lesson, &self.place, lab));
        }
        has_arrived
    }

    /// Replaces the lesson by `lesson`, the changed file, on the same page. The run stays at its step.
    fn take_file(&mut self, lesson: Lesson, lab: &mut Lab) {
        let name = self.lesson.name.clone();
        self.place.page = self.place.page.min(lesson.pages.len().max(1));
        self.lesson = Arc::new(Lesson { name, ..lesson });
        self.reached.clear();
        self.place.stated = None;
        lab.tell("lesson reloaded; press b to restart the page");
    }

    /// Records the checks of the page that hold now, and reports the task as done once all have held. Returns true if a
    /// check is new.
    fn note_reached(&mut self, lab: &mut Lab) -> bool {
        let lesson = Arc::clone(&self.lesson);
        let Some(page) = lesson.page(self.place.page) else {
            return false;
        };
        let before = self.reached.len();
        for check in page.checks() {
            if holds(check, lab, &self.place.kept) {
                self.reached.insert(check.line);
            }
        }
        let is_new = self.reached.len() > before;
        if is_new && self.reached.len() == page.checks().count() {
            let goals: Vec<_> = page.checks().flat_map(|it| it.goals.clone()).collect();
            lab.tell(format!("done: {}", goals.join(", ")));
            if page.task().is_some() {
                let number = page.checks().find_map(|check| main_number(check, lab));
                let heading = page.heading.clone();
                self.place
                    .done_with
                    .extend(number.map(|words| (heading, words)));
                self.note_tried(if self.shows_hints {
                    Tried::DoneAfterHint
                } else {
                    Tried::Done
                });
            }
        }
        is_new
    }

    /// Records the student's progress in the page's task. A task that was done or shown keeps that record.
    fn note_tried(&mut self, tried: Tried) {
        let Some(page) = self.lesson.page(self.place.page) else {
            return;
        };
        let tasks = &mut self.place.tasks;
        let known = tasks.entry(page.heading.clone()).or_insert(tried);
        if *known == Tried::Hint {
            *known = tried;
        }
    }
}

/// Returns the state of the lab: the number of acts, and the step.
fn place_of(lab: &Lab) -> (usize, u64) {
    (lab.runs().journal().done(), lab.player().step_number())
}

/// Returns the main number of `check` in words, such as `Lx = 173.6 J s`. Returns `None` if it names only times and
/// values of the scenario.
fn main_number(check: &Check, lab: &Lab) -> Option<String> {
    let readouts = check.that.names().filter_map(readouts::find);
    let mut numbers = readouts.filter(|one| !["t_s", "steps", "step"].contains(&one.name));
    let readout = numbers.find(|one| !one.name.starts_with("time_step"))?;
    let value = lab.player().number(readout.name)?;
    let end = Unit::from_name(readout.name).map_or("", |unit| unit.end);
    let stem = readout.name.strip_suffix(end).unwrap_or(readout.name);
    let words = stem.strip_prefix("measured_").unwrap_or(stem);
    let text = format!(
        "{} = {} {}",
        words.replace('_', " "),
        number::significant(value, 4),
        readout.unit
    );
    Some(text.trim_end().to_owned())
}

fn holds(check: &Check, lab: &Lab, kept: &super::KeptNumbers) -> bool {
    value(&check.that, lab, kept).is_some_and(|held| held != 0.0)
}

/// Returns the texts of the page at `place` that the student's own run does not change, by their lines in the file.
/// Texts after a task or a check are not included.
fn stated(lesson: &Lesson, place: &LessonProgress, lab: &Lab) -> BTreeMap<String, String> {
    let mut texts = BTreeMap::new();
    for block in before_task(lesson, place) {
        let (line, text) = match block {
            LessonBlock::Text(text) => (text.line, text.with_numbers(lab, &place.kept)),
            LessonBlock::Compare(compare) => (compare.line, compared(compare, lesson, place, lab)),
            _ => continue,
        };
        texts.insert(line.to_string(), text);
    }
    texts
}

/// Returns the blocks of the introduction, and those of the page before its task or its first check.
fn before_task<'a>(
    lesson: &'a Lesson,
    place: &LessonProgress,
) -> impl Iterator<Item = &'a LessonBlock> {
    let page = lesson.page(place.page);
    let blocks = page.into_iter().flat_map(|page| &page.blocks);
    let before =
        blocks.take_while(|block| !matches!(block, LessonBlock::Task(_) | LessonBlock::Check(_)));
    lesson.introduction.iter().chain(before)
}

fn compared(compare: &Compare, lesson: &Lesson, place: &LessonProgress, lab: &Lab) -> String {
    compare.filled(lesson, &place.predictions, lab, &place.kept)
}
