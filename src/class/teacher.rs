//! The teacher's lab: publishes what it shows, and shows the votes of the class on its pages.

mod menu;

use super::folder::{CLASS_VERSION, ClassFolder, ClassState, LONGEST_RUN, PresentedRun, VoteStage};
use super::votes::{self, FEWEST_VOTES_SHOWN, SeatStatus, Tally, present, seat_statuses};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, unix_ms};
use crate::engine::data::find_shipped;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::counted;
use crate::engine::text::printable::PrintablePath;
use crate::lab::action::LessonKey;
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lab::{Lab, Snapshot};
use crate::lessons::open_lesson::OpenLesson;
use crate::lessons::page::ClassOverlay;
use crate::lessons::{LessonPage, Lessons};
use menu::ClassMenu;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// The role of the teacher's lab.
#[derive(Debug, Default)]
pub struct Teacher {
    folder: ClassFolder,
    state: ClassState,
    /// State that was published last.
    published: Option<ClassState>,
    is_followed: bool,
    menu: ClassMenu,
    next_page: NextPageQuestion,
    seats: Vec<SeatStatus>,
    /// Run that was shown last, and its file.
    run: Option<(Arc<Scenario>, String)>,
    next_look: Duration,
    trouble: Option<String>,
    /// Texts of the rehearsal, if this is one.
    rehearsal: Option<Rehearsal>,
}

/// Texts for the teacher of a rehearsal.
#[derive(Clone, Debug)]
pub struct Rehearsal {
    /// Text at the start and in the menu.
    pub about: String,
    /// Text at the end.
    pub at_end: String,
}

/// State of the question that `n` asks if the class is not ready for the next page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum NextPageQuestion {
    #[default]
    NotAsked,
    /// The current key press has asked.
    JustAsked,
    Asked,
}

impl Teacher {
    /// Returns the role for the class in `folder`, with the rounds of an earlier lab in `before`.
    pub fn new(folder: ClassFolder, before: ClassState) -> Self {
        let state = ClassState {
            gyrolab: CLASS_VERSION.to_owned(),
            is_on: true,
            ..before
        };
        Self {
            folder,
            state,
            is_followed: true,
            ..Self::default()
        }
    }

    /// Makes this the teacher of a rehearsal.
    pub fn rehearsing(self, rehearsal: Rehearsal) -> Self {
        Self {
            rehearsal: Some(rehearsal),
            ..self
        }
    }

    /// Returns the warning before `q` ends the class while students are here.
    fn quit_warning(&self) -> Option<String> {
        let here = self.state.here as u64;
        let is_needed = here > 0 && self.rehearsal.is_none();
        is_needed.then(|| {
            format!(
                "{} here: press q again to end the class",
                counted(here, "seat")
            )
        })
    }

    fn publish(&mut self) {
        if self.published.as_ref() == Some(&self.state) {
            return self.folder.touch_state();
        }
        match self.folder.publish(&self.state) {
            Ok(()) => self.published = Some(self.state.clone()),
            Err(trouble) => {
                self.trouble = Some(trouble);
                self.folder.touch_state(); // heartbeat
            }
        }
    }

    /// Updates the state from the lab and the votes.
    fn look(&mut self, lab: &Lab, lessons: &Lessons) {
        match seat_statuses(&self.folder) {
            Ok(seats) => {
                self.trouble = seats.iter().find_map(|seat| seat.trouble.clone());
                self.seats = seats;
            }
            Err(trouble) => self.trouble = Some(trouble),
        }
        if let Some(open) = lessons.open_lesson() {
            self.state.lesson.clone_from(&open.lesson.name);
            self.state.page = open.place.page;
            self.state.kept.clone_from(&open.place.kept);
            self.state.has_arrived = !open.is_under_way();
        }
        self.close_in_time();
        self.state.is_followed = self.is_followed;
        self.state.shown = self.shown(lab);
        self.state.here = present(&self.seats).0;
        self.state.answered = 0;
        let page = lessons.open_lesson().and_then(|open| open.page());
        if let Some((predict, question)) = page.and_then(|page| votes::question(page, &self.state))
        {
            let (lesson, round) = (&self.state.lesson, question.round());
            let here = self.seats.iter().filter(|status| status.is_here());
            self.state.answered = here
                .filter(|status| status.vote(lesson, predict, round).is_some())
                .count();
            let tally = Tally::count(&self.seats, lesson, predict, round);
            let is_shown = question.stage == VoteStage::All && tally.votes >= FEWEST_VOTES_SHOWN;
            let bars = if is_shown { tally.bars } else { Vec::new() };
            self.state.question_mut(&predict.name).bars = bars;
        }
    }

    /// Returns the run of `lab` for the class.
    fn shown(&mut self, lab: &Lab) -> Option<PresentedRun> {
        let player = lab.player();
        let scenario = player.run().scenario();
        let known = self.run.as_ref().map(|(known, _)| known);
        if !known.is_some_and(|known| Arc::ptr_eq(known, scenario)) {
            self.run = Some((Arc::clone(scenario), published(scenario)));
        }
        let (_, run) = self.run.as_ref()?;
        if run.len() > LONGEST_RUN {
            let rule = "the run's file exceeds 64 kB: the class cannot follow it";
            self.trouble = Some(rule.to_owned());
            return None;
        }
        let (step, is_running) = (player.step_number(), player.is_running());
        let before = self.state.shown.as_ref();
        let still = before.filter(|shown| !is_running && shown.snapshot.step == step);
        Some(PresentedRun {
            snapshot: Snapshot {
                name: lab.runs().name().to_owned(),
                run: run.clone(),
                end_s: Some(lab.runs().present().end_s),
                step,
                ..lab.snapshot()
            },
            at_ms: still.map_or_else(unix_ms, |shown| shown.at_ms),
            is_running,
        })
    }

    /// Returns the additions of the class to the page.
    fn overlay(&self, lessons: &Lessons) -> ClassOverlay {
        let (here, counts) = present(&self.seats);
        let framed = lessons.open_lesson().map(|open| {
            let (page, pages) = (open.place.page, open.lesson.pages.len());
            let lead = if self.is_followed {
                ""
            } else {
                "not followed · "
            };
            let of = format!("{lead}{page} of {pages}");
            let title = &open.lesson.title;
            format!("{of} · {counts} · {title}\n{of} · {counts}\n{of} · {here} here")
        });
        let page = lessons.open_lesson().and_then(|open| open.page());
        ClassOverlay {
            framed: framed.unwrap_or_default(),
            border: self.menu.border().to_owned(),
            is_of_teacher: true,
            asks_digit: matches!(self.menu, ClassMenu::Open(_)),
            votes: page.and_then(|page| self.votes(page)),
            instead: self.menu_page(page),
            ..ClassOverlay::default()
        }
    }

    /// Returns the name of the current question, and the votes as far as they are shown.
    fn votes(&self, page: &LessonPage) -> Option<(String, Vec<Paragraph>)> {
        let (predict, question) = votes::question(page, &self.state)?;
        let (round, answered, here) = (question.round(), self.state.answered, self.state.here);
        let since_s = unix_ms().saturating_sub(question.since_ms) / 1000;
        let (minutes, seconds) = (since_s / 60, since_s % 60);
        let tally = Tally::count(&self.seats, &self.state.lesson, predict, round);
        let seen = match question.stage {
            VoteStage::Counted | VoteStage::Teacher => "",
            VoteStage::All if tally.votes < FEWEST_VOTES_SHOWN => {
                " · students see no bars: under 5 votes"
            }
            VoteStage::All => " · shown",
        };
        let end = match question.seconds_left(unix_ms()) {
            Some(left) => format!(" · {left} s left"),
            None if question.is_closed => " · closed".to_owned(),
            None => String::new(),
        };
        let late = match tally.late {
            0 => String::new(),
            late => format!(" · {late} late"),
        };
        let counted = format!("round {round} · {answered} of {here} answered");
        let line = format!("{counted} · {minutes}:{seconds:02}{late}{seen}{end}");
        let mut lines = vec![Paragraph::new(SheetLineKind::Note, line)];
        if question.stage != VoteStage::Counted {
            lines.push(tally.drawn());
            let advice = tally.advice.into_iter();
            lines.extend(advice.map(|words| Paragraph::new(SheetLineKind::Note, words)));
        }
        Some((predict.name.clone(), lines))
    }

    /// Closes the questions whose countdowns are over.
    fn close_in_time(&mut self) {
        let now_ms = unix_ms();
        let lessons = self.state.questions.values_mut();
        for question in lessons.flat_map(BTreeMap::values_mut) {
            if question.is_closed_at(now_ms) {
                question.close();
            }
        }
    }

    /// Returns the reason why the class is not ready for the next page: missing votes, or a run that still plays.
    fn why_wait(&self, lab: &Lab, open: &OpenLesson) -> Option<String> {
        let page = open.page()?;
        if let Some((predict, question)) = votes::question(page, &self.state)
            && !question.is_closed
        {
            let here = self.seats.iter().filter(|status| status.is_here());
            let (lesson, round) = (&open.lesson.name, question.round());
            let (mut answered, mut all) = (0, 0);
            for status in here {
                all += 1;
                answered += usize::from(status.vote(lesson, predict, round).is_some());
            }
            if answered < all {
                return Some(format!(
                    "{answered} of {all} have answered; press n again to go on"
                ));
            }
        }
        let next = if open.plays() {
            "jump to its end"
        } else {
            "go on"
        };
        (self.is_followed && lab.player().is_running())
            .then(|| format!("the run is still playing for the class; press n again to {next}"))
    }

    /// Asks the teacher before the page is turned while votes are missing or a run plays. Returns true if it asks.
    fn asks_before_next(&mut self, lab: &mut Lab, lessons: &Lessons) -> bool {
        let is_confirmed = self.next_page == NextPageQuestion::Asked;
        let open = lessons.open_lesson().filter(|_| !is_confirmed);
        let Some(why) = open.and_then(|open| self.why_wait(lab, open)) else {
            return false;
        };
        self.next_page = NextPageQuestion::JustAsked;
        lab.refuse(why);
        true
    }
}

impl ClassRole for Teacher {
    fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) -> ControlFlow<()> {
        let is_new = lessons.open_lesson().is_some_and(|open| {
            (&open.lesson.name, open.place.page) != (&self.state.lesson, self.state.page)
        });
        if now >= self.next_look || is_new {
            if let Some(rehearsal) = self.rehearsal.as_ref().filter(|_| self.published.is_none()) {
                lab.tell(rehearsal.about.clone());
            }
            self.next_look = now + CLASS_POLL_INTERVAL;
            self.trouble = None;
            self.look(lab, lessons);
            self.publish();
            lessons.set_overlay(self.overlay(lessons), lab);
            lab.set_quit_warning(self.quit_warning());
        }
        ControlFlow::Continue(())
    }

    fn on_class_key(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        self.menu = match self.menu {
            ClassMenu::Closed => ClassMenu::Open(0),
            _ => ClassMenu::Closed,
        };
        lessons.set_overlay(self.overlay(lessons), lab);
        lab.view_mut().turn_to_sheet();
    }

    fn intercept(&mut self, key: LessonKey, lab: &mut Lab, lessons: &Lessons) -> bool {
        if self.menu == ClassMenu::Closed {
            return key == LessonKey::Next && self.asks_before_next(lab, lessons);
        }
        self.on_menu_key(key, lab, lessons.open_lesson())
    }

    fn after_keys(&mut self, _lab: &mut Lab, _lessons: &Lessons) {
        self.next_page = match self.next_page {
            NextPageQuestion::JustAsked => NextPageQuestion::Asked,
            _ => NextPageQuestion::NotAsked,
        };
        self.next_look = Duration::ZERO;
    }

    fn wait(&self, now: Duration) -> Duration {
        self.next_look.saturating_sub(now).max(LEAST_WAIT)
    }

    fn trouble(&self) -> Option<String> {
        self.trouble.clone()
    }

    fn leave(&mut self) -> Result<String, String> {
        self.state.is_on = false;
        let published = self.folder.publish(&self.state);
        if let Some(rehearsal) = &self.rehearsal {
            return Ok(rehearsal.at_end.clone()); // its folder may already be removed
        }
        published?;
        let root = PrintablePath(&self.folder.root);
        Ok(format!(
            "to continue the class: gyrolab class --resume --folder {root}"
        ))
    }
}

/// Returns the run file for the class, without measured data from a file of the teacher.
fn published(scenario: &Scenario) -> String {
    let mut run = scenario.clone();
    let named = run.file.viewed_text("measured");
    let is_own = named.is_some_and(|name| find_shipped(name).is_none());
    if let Some(view) = run.file.view.as_mut().filter(|_| is_own) {
        view.remove("measured");
    }
    run.to_toml()
}
