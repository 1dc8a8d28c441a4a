//! A lesson that is taken: its page, the predictions of the one who takes it, and what the lab does for it.

mod keys;

use super::Kept;
use super::clock::{self, Clock};
use super::lesson::{Answer, Block, Compare, Lesson, Page, Predict};
use super::names::value;
use super::predictions::Place;
use super::stage::Stage;
use super::watch::Watch;
use super::{reading, shipped};
use crate::lab::Lab;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long the pages before one may take to be carried out: no key is answered meanwhile.
const LONGEST: Duration = Duration::from_secs(5);
const TOO_LONG: &str =
    "the pages before this one take too long: its lab block should open a run of its own";

#[derive(Debug)]
pub struct Taken {
    pub lesson: Arc<Lesson>,
    /// Its file, where it does not come with the program.
    watch: Option<Watch>,
    pub place: Place,
    /// The selected answer of the open question, from 0.
    pub selected: usize,
    /// Whether an answer on this page was selected or given.
    pub has_come_to_question: bool,
    /// The lines of the checks of this page that have held.
    reached: BTreeSet<usize>,
    /// The texts of this page that the student's own run does not change, with their numbers, by their lines in the file;
    /// `None` until the run has arrived where the page wants it.
    stated: Option<Stated>,
    /// Whether the hints of the page's checks are shown.
    pub shows_hints: bool,
    under_way: Option<UnderWay>,
    /// In a class that is followed: whether its run has arrived where the page wants it.
    pub(super) follows: Option<bool>,
    /// The question that is asked once more, though it is answered.
    pub(super) again: Option<String>,
    /// The answer to that question, and its name.
    pub(super) voted: Option<(String, Answer)>,
    /// Whether turning the page was refused once, because a prediction is open.
    pub(super) was_asked: bool,
    /// The clock, where the teacher's notes are shown.
    pub clock: Option<Clock>,
    /// When the lesson was opened in this lab, on the clock of the lab.
    since: Duration,
    /// How long before that it was opened first.
    gone_before: Duration,
}

/// A block of a page that the lab carries out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum UnderWay {
    Lab(usize),
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
        let is_file = shipped::find(&lesson.name).is_none();
        let watch = is_file.then(|| Watch::new(Path::new(&lesson.name)));
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
            follows: None,
            again: None,
            voted: None,
            was_asked: false,
            clock: None,
            since: now,
            gone_before,
        }
    }

    pub(super) fn into_place(self) -> Place {
        self.place
    }

    pub fn page(&self) -> Option<&Page> {
        self.lesson.page(self.place.page)
    }

    /// The question of the page that is not answered yet; the first of them.
    pub fn asked(&self) -> Option<&Predict> {
        self.page()?
            .predicts()
            .find(|predict| self.is_open(predict))
    }

    /// Whether an answer to `predict` is wanted: it is not locked, or it is asked once more.
    pub fn is_open(&self, predict: &Predict) -> bool {
        !self.place.predictions.is_locked(predict) || self.again.as_ref() == Some(&predict.name)
    }

    /// Shows the page `page` without touching the run. Returns whether that is new.
    pub(super) fn follow(&mut self, page: usize, kept: &Kept, has_arrived: bool) -> bool {
        let page = page.clamp(1, self.lesson.pages.len().max(1));
        let is_new = self.place.page != page || self.follows.is_none();
        if is_new {
            self.turn_to(page);
        }
        self.follows = Some(has_arrived);
        self.place.kept.extend(kept.clone());
        is_new
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
        let last = stages.last().filter(|last| last.page.number == page);
        let before = stages.len() - usize::from(last.is_some());
        let begin = Instant::now();
        let is_late = || begin.elapsed() > LONGEST;
        for stage in &stages[..before] {
            stage.carry_out(lab, &mut self.place.kept, |_, _| {
                if is_late() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })?;
            if is_late() {
                return Err(TOO_LONG.to_owned());
            }
        }
        if let Some(stage) = last {
            self.begin(stage, UnderWay::Lab(page), lab);
        }
        Ok(())
    }

    fn begin(&mut self, stage: &Stage<'_>, block: UnderWay, lab: &mut Lab) {
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
            UnderWay::Lab(page) => lesson.stage_of(page, &self.place.predictions),
            UnderWay::Task(page) => lesson.task_of(page, &self.place.predictions),
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
            match reading::read_again(&watch.path) {
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
        let has_arrived = self.follows.unwrap_or(true)
            && self.under_way.is_none()
            && lab.script().is_done()
            && lab.player().playback.steps_to_go().is_none();
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
        lab.tell("the lesson was read again: b begins the page again");
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

fn holds(check: &super::Check, lab: &Lab, kept: &super::Kept) -> bool {
    value(&check.that, lab, kept).is_some_and(|held| held != 0.0)
}

/// The texts of a page that the student's own run does not change, by their lines in the file.
#[derive(Clone, Debug)]
pub(super) struct Stated {
    texts: BTreeMap<usize, String>,
}

impl Stated {
    /// What the page at `place` states of the run in `lab`. What stands behind a task or a check is not among it.
    pub(super) fn of(lesson: &Lesson, place: &Place, lab: &Lab) -> Self {
        let texts = before_task(lesson, place).filter_map(|block| match block {
            Block::Text(text) => Some((text.line, text.with_numbers(lab, &place.kept))),
            Block::Compare(compare) => Some((compare.line, compared(compare, lesson, place, lab))),
            _ => None,
        });
        Self {
            texts: texts.collect(),
        }
    }

    pub(super) fn text(&self, line: usize) -> Option<&str> {
        self.texts.get(&line).map(String::as_str)
    }

    /// Puts the prediction called `name`, which has just been locked, into what is stated about it.
    pub(super) fn take_in(&mut self, name: &str, lesson: &Lesson, place: &Place, lab: &Lab) {
        for block in before_task(lesson, place) {
            if let Block::Compare(compare) = block
                && compare.prediction == name
            {
                let text = compared(compare, lesson, place, lab);
                self.texts.insert(compare.line, text);
            }
        }
    }
}

/// The introduction's blocks, and those of the page up to its task or its first check.
fn before_task<'a>(lesson: &'a Lesson, place: &Place) -> impl Iterator<Item = &'a Block> {
    let page = lesson.page(place.page);
    let blocks = page.into_iter().flat_map(|page| &page.blocks);
    let is_before = |block: &&Block| !matches!(block, Block::Task(_) | Block::Check(_));
    lesson
        .introduction
        .iter()
        .chain(blocks.take_while(is_before))
}

fn compared(compare: &Compare, lesson: &Lesson, place: &Place, lab: &Lab) -> String {
    compare.filled(lesson, &place.predictions, lab, &place.kept)
}
