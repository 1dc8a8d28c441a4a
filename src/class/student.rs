//! A student's lab: follows the teacher's lab, and keeps progress and votes in the files of its seat.
//!
//! An answer that is chosen but not locked counts as a vote when its round ends. A round ends when the teacher turns
//! the page, closes the round or asks again, or when the countdown is over. Nothing is locked when a student turns the
//! page.

use super::folder::{ClassFolder, ClassState};
use super::following::{ClassChange, Follower, Shown};
use super::seat::{Seat, SeatRecord};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, unix_ms, votes};
use crate::lab::Lab;
use crate::lab::action::LessonKey;
use crate::lab::command::Command;
use crate::lab::playback::pace::Speed;
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lessons::Lessons;
use crate::lessons::open_lesson::OpenLesson;
use crate::lessons::page::ClassOverlay;
use std::ops::ControlFlow;
use std::time::Duration;
use toml::Table;

const GO_ON_ALONE: &str = "you now work on your own: press n or N to turn pages";

/// The role of a student's lab.
#[derive(Debug, Default)]
pub struct Student {
    follower: Follower,
    seat: Seat,
    /// Token under which this process has the seat open.
    lock_token: String,
    record: SeatRecord,
    /// True if the record must be written.
    is_new: bool,
    last_snapshot: Option<PlaybackSnapshot>,
    /// True if the student's own run is pinned after rejoining.
    has_pinned: bool,
    /// True once a class was running in this lab.
    has_begun: bool,
    waiting: WaitingPage,
    /// Rounds that were open at the last read.
    open_rounds: Option<OpenRounds>,
    /// True if the students worked on their own at the last read.
    is_alone: bool,
    /// Reason why the lab ends, if it does.
    ended: Option<&'static str>,
    next_look: Duration,
    trouble: Option<String>,
}

/// State of the waiting page: the list of lessons with a text above it, shown until the class begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum WaitingPage {
    /// Not shown yet.
    #[default]
    Unseen,
    Open,
    Left,
}

/// The questions of the class's page whose rounds are open.
#[derive(Clone, Debug, PartialEq, Eq)]
struct OpenRounds {
    lesson: String,
    page: usize,
    /// Names of the questions, with their rounds.
    rounds: Vec<(String, u32)>,
}

impl OpenRounds {
    /// Returns the open rounds of `state`, if its lesson is open here.
    fn of(state: &ClassState, lessons: &Lessons) -> Option<Self> {
        let open = lessons.open_lesson();
        let lesson = &open.filter(|open| open.lesson.name == state.lesson)?.lesson;
        let now_ms = unix_ms();
        let mut rounds = Vec::new();
        for predict in lesson.page(state.page)?.predicts() {
            let question = state.question(&predict.name);
            if !question.is_closed_at(now_ms) {
                rounds.push((predict.name.clone(), question.round()));
            }
        }
        Some(Self {
            lesson: state.lesson.clone(),
            page: state.page,
            rounds,
        })
    }

    /// Returns the rounds that have ended, now that `open` are open.
    fn ended<'a>(&'a self, open: Option<&'a Self>) -> impl Iterator<Item = &'a (String, u32)> {
        let same_page = open.filter(|open| (&open.lesson, open.page) == (&self.lesson, self.page));
        let is_open = move |round| same_page.is_some_and(|same| same.rounds.contains(round));
        self.rounds.iter().filter(move |round| !is_open(round))
    }
}

/// State of the playback that a key may change. A change leads away from the class's run or page.
///
/// Number of acts, step, steps to go, true if playing, speed, page.
type PlaybackSnapshot = (
    usize,
    u64,
    Option<u64>,
    bool,
    Speed,
    Option<(String, usize)>,
);

fn playback_snapshot(lab: &Lab, lessons: &Lessons) -> PlaybackSnapshot {
    let player = lab.player();
    let open = lessons.open_lesson();
    (
        lab.runs().journal().done(),
        player.step_number(),
        player.steps_to_go(),
        player.is_running() || !lab.script().is_done(),
        player.speed(),
        open.map(|open| (open.lesson.name.clone(), open.place.page)),
    )
}

impl Student {
    /// Returns the role of `seat`, which this process has open under `lock_token`. `record` is the content of its file.
    pub fn new(folder: ClassFolder, seat: Seat, lock_token: String, record: SeatRecord) -> Self {
        Self {
            follower: Follower::new(folder),
            seat,
            lock_token,
            record,
            is_new: true,
            ..Self::default()
        }
    }

    /// Returns true if the lab shows the teacher's lab.
    fn follows(&self) -> bool {
        let class = self.follower.class();
        let is_led = class.is_some_and(|state| state.is_followed && state.shown.is_some());
        is_led && !self.record.is_aside
    }

    /// Records the progress in the lessons, with the answers.
    fn record_progress(&mut self, lessons: &Lessons) {
        let kept = lessons.kept();
        if !kept.is_empty() && *kept != self.record.lessons {
            self.record.lessons.clone_from(kept);
            self.is_new = true;
        }
    }

    /// Reads the files: the seat may be opened elsewhere, and the teacher's state may have changed.
    fn look(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        if !self.seat.is_held(&self.lock_token) {
            self.ended = Some(if self.seat.is_there() {
                "this seat was opened in another lab: continue there"
            } else {
                "this seat is gone: ask your teacher, or take a new seat"
            });
        }
        let change = self.follower.look(lab);
        let state = self.follower.state();
        if state.is_some_and(|state| state.closed.contains(&self.seat.word)) {
            let closed =
                "your teacher has closed this seat: once it is open again, type its word to return";
            self.ended = Some(closed);
        }
        match change {
            ClassChange::Nothing => {}
            ClassChange::Begun => {
                self.has_begun = true;
                if self.record.is_aside {
                    lab.tell("the class is on: press k to join it");
                } else {
                    lab.refuse("the class is on");
                }
            }
            ClassChange::Over => lab.tell("the class is over: press n or N to turn pages"),
            ClassChange::Gone => lab.tell("the teacher's lab is gone: press n or N to turn pages"),
        }
        self.end_rounds(lab, lessons);
        self.detect_working_alone(lab);
        let gathered_ms = self.follower.class().map(|class| class.gathered_ms);
        if self.record.is_aside && gathered_ms > Some(self.record.aside_since_ms) {
            self.rejoin("your teacher has gathered the class", lab);
        }
    }

    /// Locks chosen answers of rounds that have ended since the last read, before the page turns here too.
    fn end_rounds(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        if self.follower.class().is_none() && !self.follower.is_over() {
            return; // the teacher's lab is gone; its rounds continue when it returns
        }
        let class = self.follower.class();
        let open = class.and_then(|state| OpenRounds::of(state, lessons));
        let before = std::mem::replace(&mut self.open_rounds, open);
        let Some(before) = before else { return };
        for (name, round) in before.ended(self.open_rounds.as_ref()) {
            let page = (before.lesson.as_str(), before.page);
            if let Some(answer) = lessons.lock_chosen(page, name, *round, lab) {
                lab.tell(format!("the round is over: your answer {answer} counts"));
            }
        }
    }

    /// Detects when the teacher lets the students work on their own, or ends that, and reports it.
    fn detect_working_alone(&mut self, lab: &mut Lab) {
        let class = self.follower.class();
        let is_alone = class.is_some_and(|state| !state.is_followed);
        let was_alone = std::mem::replace(&mut self.is_alone, is_alone);
        if is_alone && !was_alone && !self.record.is_aside {
            self.follower.forget_shown();
            lab.tell(GO_ON_ALONE);
        } else if was_alone && self.follows() {
            self.rejoin("your teacher continues the class", lab);
        }
    }

    /// Shows the waiting page, and detects when the student leaves it for homework. Such a student rejoins the class
    /// with one key.
    fn wait_for_class(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        if self.waiting == WaitingPage::Unseen && !self.has_begun {
            lessons.set_overlay(self.overlay(lessons), lab);
            lessons.on_key(LessonKey::List, lab);
        }
        let waits = lessons.is_listing();
        match (self.waiting, waits) {
            (WaitingPage::Open, false) => {
                self.set_aside(true);
                self.waiting = WaitingPage::Left;
                if lessons.open_lesson().is_none() {
                    lab.tell("a free lab for homework: press k to return to the waiting page");
                }
            }
            (WaitingPage::Unseen | WaitingPage::Left, true) => {
                self.set_aside(false);
                self.waiting = WaitingPage::Open;
            }
            (WaitingPage::Open, true) | (_, false) => {}
        }
    }

    /// Returns the text above the list of lessons while no class is running.
    fn waiting_words(&self) -> Vec<Paragraph> {
        let word = &self.seat.word;
        let seat = format!("Your seat is {word}.");
        let starts = "The class starts here when your teacher starts it.";
        let offer = "Until then, press Enter to open a lesson as homework, Esc for a free lab, or Ctrl-C to quit.";
        vec![
            Paragraph::new(SheetLineKind::Heading, seat),
            Paragraph::new(SheetLineKind::Text, starts),
            Paragraph::new(SheetLineKind::Hint, offer),
        ]
    }

    /// Shows the run, the page and the view of the teacher's lab.
    fn show_presented(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        match self.follower.show(lab, lessons) {
            Ok(Shown::ChangedHere) => self.step_aside(lab),
            Ok(Shown::NewPage) if std::mem::take(&mut self.has_pinned) => {
                let _ = lab.carry_out(&Command::Pin(false)); // it belongs to the previous page
            }
            Ok(Shown::NewPage | Shown::SamePage) => {}
            Err(reason) => lab.tell(reason),
        }
    }

    /// Returns the additions of the class to the page.
    fn overlay(&self, lessons: &Lessons) -> ClassOverlay {
        let Some(state) = self.follower.class() else {
            return ClassOverlay {
                framed: self.title_without_class(lessons),
                waiting: Some(self.waiting_words()),
                ..ClassOverlay::default()
            };
        };
        let Some(open) = lessons.open_lesson() else {
            return ClassOverlay::default();
        };
        let page = open.page().filter(|_| open.lesson.name == state.lesson);
        let asked = page.and_then(|page| votes::question(page, state));
        let mut overlay = ClassOverlay {
            framed: self.title(open, state, asked.is_some()),
            is_followed: self.follows(),
            ..ClassOverlay::default()
        };
        if overlay.is_followed {
            overlay.border = "k: leave the class\nk: leave".to_owned();
        }
        let now_ms = unix_ms();
        for (name, question) in state.questions.get(&open.lesson.name).into_iter().flatten() {
            let round = (question.round(), question.is_closed_at(now_ms));
            overlay.rounds.insert(name.clone(), round);
        }
        if let Some((predict, question)) = asked {
            if let Some(left) = question.seconds_left(now_ms) {
                overlay.border = format!("the round closes in {left} s\n{left} s left");
            } else if question.is_closed_at(now_ms) && open.is_open(predict) {
                overlay.border = "closed: an answer now counts as late\nclosed".to_owned();
            }
            if !question.bars.is_empty() {
                overlay.votes = Some((predict.name.clone(), vec![votes::drawn(&question.bars)]));
            }
        }
        overlay
    }

    /// Returns the title of the page while no class is running; empty if none has begun.
    fn title_without_class(&self, lessons: &Lessons) -> String {
        let Some(open) = lessons.open_lesson().filter(|_| self.has_begun) else {
            return String::new();
        };
        let gone = if self.follower.is_over() {
            "class over"
        } else {
            "teacher's lab gone"
        };
        let (page, pages) = (open.place.page, open.lesson.pages.len());
        format!("{gone} · {page} of {pages}")
    }

    /// Returns the title of the page, one form per line. `asks` is true if the page has a question.
    fn title(&self, open: &OpenLesson, state: &ClassState, asks: bool) -> String {
        let page = open.place.page;
        let of = format!("{page} of {}", open.lesson.pages.len());
        let on = format!("the class is on {}", state.page);
        if self.record.is_aside {
            let short = format!("left, k: rejoin · {page}, class on {}", state.page);
            format!("left, k: rejoin · {of} · {on}\n{short}\nleft, k: rejoin · {page}")
        } else if !self.follows() {
            format!(
                "on your own · {of} · {on}\nalone · {of} · class on {}",
                state.page
            )
        } else if state.page == page && asks {
            let counts = format!("following · {of} · {}", state.answered);
            let answered = format!("{counts} of {} answered\n{counts} answered", state.here);
            format!("{answered}\nfollowing · {of}\n{of}")
        } else {
            format!("following · {of}\n{of}")
        }
    }

    fn set_aside(&mut self, is_aside: bool) {
        if self.record.is_aside != is_aside {
            self.record.is_aside = is_aside;
            self.record.aside_since_ms = unix_ms();
            self.is_new = true;
        }
    }

    fn step_aside(&mut self, lab: &mut Lab) {
        self.set_aside(true);
        self.follower.forget_shown();
        self.next_look = Duration::ZERO;
        lab.tell("you have left the class: press k to rejoin");
    }

    /// Rejoins the class for the reason `why`. A run that the student has played meanwhile is pinned.
    fn rejoin(&mut self, why: &str, lab: &mut Lab) {
        self.set_aside(false);
        self.follower.forget_shown();
        let player = lab.player();
        let own = player.run().scenario().to_toml();
        let shown = self.follower.state().and_then(|state| state.shown.as_ref());
        let is_own = lab.runs().is_above_floor()
            && player.step_number() > 0
            && shown.is_some_and(|shown| shown.snapshot.run != own);
        if is_own && lab.carry_out(&Command::Pin(true)).is_ok() {
            self.has_pinned = true;
            return lab.tell(format!(
                "{why}; your own run is pinned for comparison: press i to unpin it"
            ));
        }
        lab.refuse(why);
    }

    /// Returns the note for the header of an export: the seat, and the page that was open.
    fn note_for_exports(&self, lessons: &Lessons) -> Option<String> {
        let open = lessons.open_lesson().filter(|_| self.record.is_aside)?;
        let (page, lesson) = (open.place.page, &open.lesson.name);
        let lesson = self.follower.folder.short(lesson);
        Some(format!("seat {}, page {page} of {lesson}", self.seat.word))
    }
}

impl ClassRole for Student {
    fn lessons(&self, kept: Table) -> Table {
        if self.record.lessons.is_empty() {
            return kept;
        }
        self.record.lessons.clone() // never older than the session
    }

    fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) -> ControlFlow<()> {
        let was_new = self.is_new;
        self.record_progress(lessons);
        if now >= self.next_look || self.is_new && !was_new {
            self.next_look = now + CLASS_POLL_INTERVAL;
            if self.waiting != WaitingPage::Unseen && self.follower.class().is_none() {
                self.wait_for_class(lab, lessons); // effects of keys since the last read
            }
            self.look(lab, lessons);
            if self.follows() {
                self.show_presented(lab, lessons);
            } else if self.follower.class().is_none() {
                self.wait_for_class(lab, lessons);
            } else if self.record.is_aside
                && lessons.open_lesson().is_none()
                && lab.notice().is_none()
            {
                lab.tell("the class is on: press k to join it");
            }
            lab.files_mut().note = self.note_for_exports(lessons);
            lessons.set_overlay(self.overlay(lessons), lab);
            self.record_progress(lessons); // a chosen answer may be locked now
            if self.is_new && self.ended.is_none() {
                self.trouble = self.seat.save(&self.record).err();
                self.is_new = self.trouble.is_some();
            }
        }
        self.last_snapshot = Some(playback_snapshot(lab, lessons));
        if self.ended.is_some() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn on_class_key(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        if self.follower.class().is_none() {
            lessons.on_key(LessonKey::List, lab);
        } else if self.record.is_aside {
            self.rejoin("you have rejoined the class", lab);
        } else if self.follows() {
            self.step_aside(lab);
        } else {
            lab.refuse(GO_ON_ALONE);
        }
        self.next_look = Duration::ZERO;
    }

    fn intercept(&mut self, key: LessonKey, lab: &mut Lab, _lessons: &Lessons) -> bool {
        let is_of_teacher = key == LessonKey::Notes && self.follower.class().is_some();
        if is_of_teacher {
            lab.refuse("the notes are only for the teacher");
        }
        is_of_teacher
    }

    fn after_keys(&mut self, lab: &mut Lab, lessons: &Lessons) {
        let now = Some(playback_snapshot(lab, lessons));
        if self.last_snapshot.is_some() && self.last_snapshot != now && self.follows() {
            self.step_aside(lab);
        }
    }

    fn wait(&self, now: Duration) -> Duration {
        self.next_look.saturating_sub(now).max(LEAST_WAIT)
    }

    fn trouble(&self) -> Option<String> {
        self.trouble.clone()
    }

    fn leave(&mut self) -> Result<String, String> {
        let is_unsaved = self.is_new && self.ended.is_none();
        let saved = if is_unsaved {
            self.seat.save(&self.record)
        } else {
            Ok(())
        };
        self.seat.leave(&self.lock_token);
        if let Some(ended) = self.ended {
            return Ok(ended.to_owned());
        }
        let word = &self.seat.word;
        let back = format!("Your seat is {word}: type this word to return.");
        saved.map_err(|reason| {
            format!("{reason}\nYour last answers are lost: tell your teacher. {back}")
        })?;
        Ok(back)
    }
}
