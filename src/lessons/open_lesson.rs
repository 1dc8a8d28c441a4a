//! The open lesson: its page, the predictions of its reader, and what the lab does for it.

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

/// How long the pages before one may take to be carried out: no key is answered meanwhile.
const LONGEST_PAGE_REPLAY: Duration = Duration::from_secs(5);
const REPLAY_TOO_LONG: &str =
    "the pages before this one take too long: its lab block should open a run of its own";

#[derive(Debug)]
pub struct OpenLesson {
    pub lesson: Arc<Lesson>,
    /// Its file, where it does not come with the program.
    watch: Option<Watch>,
    pub place: LessonProgress,
    /// By the names of open questions: the answer that is chosen, from 0, which Enter locks.
    pub chosen: BTreeMap<String, usize>,
    /// Whether an answer on this page was given.
    pub has_answered: bool,
    /// The lines of the checks of this page that have held.
    reached: BTreeSet<usize>,
    /// Where the lab stood when it had carried out the blocks that the page stands on: acts done, and step.
    arrived_at: Option<(usize, u64)>,
    /// Whether the hints of the page's checks are shown.
    pub shows_hints: bool,
    under_way: Option<PendingBlock>,
    /// In a class that is followed: whether its run has arrived where the page wants it.
    pub(super) follows: Option<bool>,
    /// The present rounds of the class's questions, by their names, and whether they are closed.
    pub(super) rounds: BTreeMap<String, (u32, bool)>,
    /// Whether turning the page was refused once, because a prediction is open.
    pub(super) was_asked: bool,
    /// Whether the teacher's notes and the clock are shown.
    pub shows_notes: bool,
    /// When the lesson was opened in this lab, on the clock of the lab.
    since: Duration,
    /// How long before that it was opened first.
    gone_before: Duration,
}

/// What a class that is followed shows of a lesson: its name, the page, the numbers that were kept, and whether its run
/// has arrived where the page wants it.
#[derive(Clone, Copy, Debug)]
pub struct ClassPage<'a> {
    pub lesson: &'a str,
    pub page: usize,
    pub kept: &'a KeptNumbers,
    pub has_arrived: bool,
}

/// A block of a page that the lab carries out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PendingBlock {
    Lab(usize),
    Task(usize),
    /// The student has left it before it was complete.
    Left,
}

impl OpenLesson {
    /// `lesson` at `place`, opened at `now` on the clock of the lab.
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

    /// Returns the question of the page that is not answered yet; the first of them.
    pub fn asked(&self) -> Option<&Predict> {
        self.page()?
            .predicts()
            .find(|predict| self.is_open(predict))
    }

    /// Returns whether an answer to the open question is chosen, and not locked.
    fn has_chosen(&self) -> bool {
        let asked = self.asked();
        asked.is_some_and(|it| self.chosen.contains_key(&it.name))
    }

    /// Returns whether an answer to `predict` is wanted: there is none, or none of the round that a class is at.
    pub fn is_open(&self, predict: &Predict) -> bool {
        let predictions = &self.place.predictions;
        match self.rounds.get(&predict.name) {
            Some((round, false)) if predictions.in_round(predict, *round).is_none() => true,
            _ => !predictions.is_locked(predict),
        }
    }

    /// Shows the page of `class` without touching the run. Returns whether that is new.
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

    /// Goes on without the class. Where its run had not arrived, the page is left as if its own run had been.
    pub(super) fn leave_class(&mut self) {
        let is_left = self.follows.take() == Some(false) && self.is_under_way();
        self.under_way = is_left.then_some(PendingBlock::Left).or(self.under_way);
    }

    /// Returns whether the check at this line of the file has held since the page was opened.
    pub fn has_reached(&self, line: usize) -> bool {
        self.reached.contains(&line)
    }

    /// Returns whether the lab is still on its way to where the page wants it.
    pub fn is_under_way(&self) -> bool {
        self.place.stated.is_none()
    }

    /// Returns whether the page's run is played, and has not arrived yet.
    pub fn plays(&self) -> bool {
        self.is_under_way() && self.page().is_some_and(LessonPage::plays)
    }

    /// Returns whether the student has left the page's run before it arrived.
    pub fn has_left(&self) -> bool {
        self.under_way == Some(PendingBlock::Left)
    }

    /// Goes on with a page whose run was on its way when the page was left, or had been left before it arrived.
    pub(super) fn resume_page(&mut self, lab: &Lab) {
        if self.is_under_way() && !lab.script().is_done() {
            self.under_way = Some(PendingBlock::Lab(self.place.page));
        } else if self.plays() {
            self.under_way = Some(PendingBlock::Left);
        }
    }

    /// Returns whether the student has left the place where the page's numbers were stated.
    fn has_wandered(&self, lab: &Lab) -> bool {
        self.arrived_at != Some(place_of(lab))
    }

    /// Returns the text at this line of the file with its numbers, where it is one that the student's own run does not
    /// change.
    pub fn stated(&self, line: usize) -> Option<&str> {
        let texts = self.place.stated.as_ref()?;
        texts.get(&line.to_string()).map(String::as_str)
    }

    pub fn time(&self, now: Duration) -> Option<String> {
        let since = now.saturating_sub(self.since) + self.gone_before;
        self.shows_notes
            .then(|| clock::shown(since, self.lesson.minutes))
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
        self.replay_page(false, lab)
    }

    /// Makes the lab stand on the page, whatever was done before: what the pages before it do is done at once, what the page
    /// itself does as time passes; `at_once` the same way.
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

    /// Takes note that the lab stands where the page wants it.
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

    /// Remembers the numbers of the block that was under way, once the lab has carried it out.
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
                lab.tell("you have left the page's run: b plays it again, n goes to its end");
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

    /// Takes note of what the lab has done, and of a file that has changed. Returns whether the page is another now.
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
                    lab.tell(format!("the page stays as it was: {first}"));
                }
            }
        }
        is_new
    }

    /// States the page's numbers once the run has arrived. The outcomes that it shows count as seen from the start of its run.
    fn state(&mut self, lab: &Lab) -> bool {
        if !self.is_under_way() {
            return false;
        }
        let page = self.lesson.page(self.place.page);
        for compare in page.into_iter().flat_map(LessonPage::compares) {
            // What the page itself asks for comes out once it is answered.
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

    /// Goes on with `lesson`, the file as it is now, on the same page; the run stays where it is.
    fn take_file(&mut self, lesson: Lesson, lab: &mut Lab) {
        let name = self.lesson.name.clone();
        self.place.page = self.place.page.min(lesson.pages.len().max(1));
        self.lesson = Arc::new(Lesson { name, ..lesson });
        self.reached.clear();
        self.place.stated = None;
        lab.tell("the lesson was read again: b begins the page again");
    }

    /// Takes note of the checks of the page that hold now, and says that the task is done once all have held; returns
    /// whether one is new.
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

    /// Notes how far the student got with the page's task; what was done or shown stays so.
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

/// Returns where the lab stands: the number of acts done, and the step.
fn place_of(lab: &Lab) -> (usize, u64) {
    (lab.runs().journal().done(), lab.player().step_number())
}

/// Returns the number of the run that `check` is mainly about, in words: `Lx = 173.6 J s`; `None` if it names times and
/// values of the scenario alone.
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

/// Returns the texts of the page at `place` that the student's own run does not change, by their lines in the file. What
/// stands behind a task or a check is not among them.
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

/// Returns the introduction's blocks, and those of the page up to its task or its first check.
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
