//! A student's lab: it follows the teacher's, and keeps in the files of its seat where it stands and what was voted.

use super::folder::{ClassFolder, ClassState, PresentedRun, QuestionState, VoteStage};
use super::seat::{Record, Seat};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, unix_ms, votes};
use crate::engine::scenario::{Document, Scenario};
use crate::lab::Lab;
use crate::lab::action::LessonKey;
use crate::lab::command::{Command, SeekTarget};
use crate::lab::playback::Playback;
use crate::lab::playback::pace::Speed;
use crate::lab::storage::shared;
use crate::lab::view::HideablePart;
use crate::lessons::page::ClassOverlay;
use crate::lessons::predictions::Predictions;
use crate::lessons::taken::OpenLesson;
use crate::lessons::{Lessons, Setup};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use toml::Table;

/// A run that plays is put right where it is more than this off, s of wall time.
const OFF_S: f64 = 0.6;

#[derive(Debug, Default)]
pub struct Student {
    folder: ClassFolder,
    seat: Seat,
    /// The word under which this process has the seat open.
    holds: String,
    record: Record,
    /// Whether the record is to be written.
    is_new: bool,
    state: Option<ClassState>,
    seen: Option<SystemTime>,
    /// Whether the teacher's lab was open at the last look.
    is_on: bool,
    /// What of the teacher's run is shown.
    shown: PresentedView,
    stood: Option<PlaybackSnapshot>,
    /// Whether a run that was played aside is pinned.
    has_pinned: bool,
    /// Whether a class was on in this lab.
    has_begun: bool,
    /// Why the lab ends, where it does.
    ended: Option<&'static str>,
    next_look: Duration,
    trouble: Option<String>,
}

#[derive(Debug, Default)]
struct PresentedView {
    /// The run file, and the scenario as the lab has it.
    run: Option<(String, Arc<Scenario>)>,
    look: Table,
    hidden: Vec<HideablePart>,
    exact: Option<bool>,
    page: usize,
}

/// What a key changes that leads away from the class's run or page: run, step, goal, whether it plays, speed, page.
type PlaybackSnapshot = (
    (usize, usize),
    u64,
    Option<u64>,
    bool,
    Speed,
    Option<(String, usize)>,
);

fn stand(lab: &Lab, lessons: &Lessons) -> PlaybackSnapshot {
    let playback = &lab.player().playback;
    (
        lab.runs().depth(),
        playback.step_number(),
        playback.steps_to_go(),
        playback.is_running() || !lab.script().is_done(),
        playback.speed(),
        lessons
            .taken()
            .map(|taken| (taken.lesson.name.clone(), taken.place.page)),
    )
}

impl Student {
    /// The lab of `seat`, which this process has open under the word `holds`; `record` is what its file holds.
    pub fn new(folder: ClassFolder, seat: Seat, holds: String, record: Record) -> Self {
        Self {
            folder,
            seat,
            holds,
            record,
            is_new: true,
            ..Self::default()
        }
    }

    /// Whether the lab shows what the teacher's shows.
    fn follows(&self) -> bool {
        let state = self.state.as_ref();
        let is_followed = state.is_some_and(|state| state.shown.is_some());
        self.is_on && is_followed && !self.record.is_aside
    }

    /// The state of the class, while it is on.
    fn class(&self) -> Option<&ClassState> {
        self.state.as_ref().filter(|_| self.is_on)
    }

    /// Takes note of the place in the lessons, with what was answered.
    fn note(&mut self, lab: &Lab) {
        if let Some(kept) = &lab.lessons
            && *kept != self.record.lessons
        {
            self.record.lessons.clone_from(kept);
            self.is_new = true;
        }
    }

    /// Looks at the files: whether the seat is still this lab's, and what the teacher shows.
    fn look(&mut self, lab: &mut Lab) {
        if !self.seat.is_held(&self.holds) {
            self.ended =
                Some("this seat was opened in another lab, which goes on from here, or it is gone");
        }
        let seen = shared::modified(&self.folder.state_file());
        if seen != self.seen {
            let read = self.folder.state();
            self.state = read.unwrap_or_else(|reason| {
                lab.tell(reason);
                None
            });
            self.seen = seen;
        }
        let state = self.state.as_ref();
        if state.is_some_and(|state| state.closed.contains(&self.seat.word)) {
            let closed =
                "your teacher has closed this seat: once it is open again, its word leads back";
            self.ended = Some(closed);
        }
        let was_on = self.is_on;
        let is_over = state.is_some_and(|state| !state.is_on);
        self.is_on = state.is_some() && !is_over && self.folder.is_teacher_alive();
        if self.is_on && !was_on {
            lab.refuse("the class is on");
            self.has_begun = true;
        } else if was_on && !self.is_on && self.state.is_some() {
            let what = if is_over {
                "the class is over"
            } else {
                "the teacher's lab is gone"
            };
            lab.tell(format!("{what}: n and N turn pages"));
        }
        if !self.is_on {
            self.shown = PresentedView::default();
        }
    }

    /// Shows what the teacher shows.
    fn follow(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        let Some(state) = self.state.clone() else {
            return;
        };
        let Some(run) = &state.shown else { return };
        let scenario = lab.player().run().scenario();
        let is_own = |(_, shown): &(_, _)| !Arc::ptr_eq(shown, scenario);
        if self.shown.run.as_ref().is_some_and(is_own) {
            return self.step_aside(lab); // the run was changed here
        }
        if self
            .shown
            .run
            .as_ref()
            .is_none_or(|(file, _)| *file != run.run)
            && let Err(reason) = self.open(run, lab)
        {
            return lab.tell(reason);
        }
        if self.shown.page != state.page {
            let is_turned = std::mem::replace(&mut self.shown.page, state.page) != 0;
            if is_turned && std::mem::take(&mut self.has_pinned) {
                let _ = lab.carry_out(&Command::Pin(false)); // it belongs to the page before
            }
        }
        let is_there = go_with(run, lab);
        if let Err(reason) = lessons.follow(&state.followed(is_there), lab) {
            lab.tell(reason.lines().next().unwrap_or_default());
        }
        self.show_as(run, lab, lessons);
        lab.set_undo_floor(true); // undo would lead to a run that was shown before
    }

    /// Opens the run of the teacher.
    fn open(&mut self, run: &PresentedRun, lab: &mut Lab) -> Result<(), &'static str> {
        let read = Document::parse(&run.name, &run.run);
        let scenario = read.and_then(|document| document.scenario());
        let unread = "the teacher's run cannot be read: n and N turn pages";
        let scenario = scenario.map_err(|_| unread)?;
        lab.show_run(&run.name, Arc::new(scenario), run.end_s);
        let shown = Arc::clone(lab.player().run().scenario());
        self.shown = PresentedView {
            run: Some((run.run.clone(), shown)),
            page: self.shown.page,
            ..PresentedView::default()
        };
        Ok(())
    }

    /// Shows the run as the teacher does, where that has changed.
    fn show_as(&mut self, run: &PresentedRun, lab: &mut Lab, lessons: &Lessons) {
        // What stands so already is left out: a key may be refused where it has no use.
        let own = Table::try_from(&lab.view().look).unwrap_or_default();
        let mut patch = run.look.clone();
        patch.retain(|key, value| {
            let is_known = |look: &Table| look.get(key) == Some(value);
            key != "hide" && !is_known(&self.shown.look) && !is_known(&own)
        });
        if !patch.is_empty() {
            let _ = lab.carry_out(&Command::Look(patch)); // what suits another screen may not suit this one
        }
        self.shown.look.clone_from(&run.look);
        if self.shown.exact != Some(run.exact) {
            self.shown.exact = Some(run.exact);
            let _ = lab.carry_out(&Command::Exact(run.exact));
        }
        let hidden = hidden(run, lessons.taken());
        if hidden != self.shown.hidden {
            let _ = lab.carry_out(&Command::look("hide", &hidden));
            self.shown.hidden = hidden;
        }
    }

    /// What the class adds to the page.
    fn dress(&self, lessons: &Lessons) -> ClassOverlay {
        let Some(taken) = lessons.taken().filter(|_| self.has_begun) else {
            return ClassOverlay::default();
        };
        let Some(state) = self.class() else {
            return ClassOverlay {
                framed: self.title(taken, false),
                ..ClassOverlay::default()
            };
        };
        let asked = taken.page().filter(|_| taken.lesson.name == state.lesson);
        let asked = asked.and_then(|page| votes::question(page, state));
        let border = if self.follows() { "k: step aside" } else { "" };
        let of_lesson = state.questions.get(&taken.lesson.name).into_iter();
        let round = |(name, question): (&String, &QuestionState)| {
            let is_closed = question.stage == VoteStage::Closed;
            (name.clone(), (question.round(), is_closed))
        };
        let shown = asked
            .as_ref()
            .filter(|(_, question)| !question.bars.is_empty());
        ClassOverlay {
            framed: self.title(taken, asked.is_some()),
            border: border.to_owned(),
            is_followed: self.follows(),
            rounds: of_lesson.flatten().map(round).collect(),
            votes: shown.map(|(predict, question)| {
                (predict.name.clone(), vec![votes::drawn(&question.bars)])
            }),
            ..ClassOverlay::default()
        }
    }

    /// The title of the page, a form a line; `asks` says whether the page has a question.
    fn title(&self, taken: &OpenLesson, asks: bool) -> String {
        let page = taken.place.page;
        let of = format!("{page} of {}", taken.lesson.pages.len());
        let Some(state) = self.class() else {
            let is_over = self.state.as_ref().is_some_and(|state| !state.is_on);
            let gone = ["teacher's lab gone", "class over"][usize::from(is_over)];
            return format!("{gone} · {of}");
        };
        let on = format!("the class is on {}", state.page);
        if self.record.is_aside && state.shown.is_some() {
            let short = format!("aside, k: back · {page}, class on {}", state.page);
            format!("aside, k: back · {of} · {on}\n{short}\naside, k: back · {page}")
        } else if !self.follows() {
            format!("not followed · {of} · {on}\n{of} · {on}")
        } else if state.page == page && asks {
            let counts = format!("following · {of} · {}", state.answered);
            format!("{counts} of {} answered\n{counts} answered", state.here)
        } else {
            format!("following · {of}")
        }
    }

    fn step_aside(&mut self, lab: &mut Lab) {
        (self.record.is_aside, self.is_new) = (true, true);
        self.shown = PresentedView::default();
        self.next_look = Duration::ZERO;
        lab.tell("you have stepped aside: k leads back to the class");
    }

    /// Follows again. A run of one's own that was played meanwhile stays, pinned.
    fn come_back(&mut self, lab: &mut Lab) {
        (self.record.is_aside, self.is_new) = (false, true);
        let player = lab.player();
        let own = player.run().scenario().to_toml();
        let shown = self.state.as_ref().and_then(|state| state.shown.as_ref());
        let is_own = lab.runs().is_above_floor()
            && player.playback.step_number() > 0
            && shown.is_some_and(|shown| shown.run != own);
        if is_own && lab.carry_out(&Command::Pin(true)).is_ok() {
            self.has_pinned = true;
            let pinned =
                "back in the class; your own run is pinned beside its run: i takes it away";
            return lab.tell(pinned);
        }
        lab.refuse("back in the class");
    }

    /// What the header of an export says: the seat, and the page beside which it was made.
    fn note_for_exports(&self, lessons: &Lessons) -> Option<String> {
        let taken = lessons.taken().filter(|_| self.record.is_aside)?;
        let (page, lesson) = (taken.place.page, &taken.lesson.name);
        let (seat, lesson) = (&self.seat.word, self.folder.short(lesson));
        Some(format!("seat {seat}, beside page {page} of {lesson}"))
    }
}

impl ClassRole for Student {
    fn begin(&mut self, lab: &mut Lab) {
        if !self.record.lessons.is_empty() {
            lab.lessons = Some(self.record.lessons.clone()); // never older than the session
        }
    }

    fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) -> ControlFlow<()> {
        let was_new = self.is_new;
        self.note(lab);
        if now >= self.next_look || self.is_new && !was_new {
            self.next_look = now + CLASS_POLL_INTERVAL;
            self.look(lab);
            if self.follows() {
                self.follow(lab, lessons);
            }
            lab.files_mut().note = self.note_for_exports(lessons);
            lessons.set_dress(self.dress(lessons), lab);
            if self.is_new && self.ended.is_none() {
                self.trouble = self.seat.save(&self.record).err();
                self.is_new = self.trouble.is_some();
            }
        }
        self.stood = Some(stand(lab, lessons));
        if self.ended.is_some() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn act(&mut self, lab: &mut Lab, _lessons: &mut Lessons) {
        if self.class().is_none() {
            lab.refuse("no class is on");
        } else if self.record.is_aside {
            self.come_back(lab);
        } else if self.follows() {
            self.step_aside(lab);
        } else {
            lab.refuse("the class is not followed now: n and N turn pages");
        }
        self.next_look = Duration::ZERO;
    }

    fn takes(&mut self, key: LessonKey, lab: &mut Lab, _lessons: &Lessons) -> bool {
        let is_of_teacher = key == LessonKey::Notes && self.is_on;
        if is_of_teacher {
            lab.refuse("the notes are the teacher's");
        }
        is_of_teacher
    }

    fn acted(&mut self, lab: &mut Lab, lessons: &Lessons) {
        let stood = self.stood.as_ref();
        let is_other = stood.is_some_and(|stood| *stood != stand(lab, lessons));
        if is_other && self.follows() {
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
        self.seat.leave(&self.holds);
        if let Some(ended) = self.ended {
            return Ok(ended.to_owned());
        }
        let word = &self.seat.word;
        let back = format!("Your seat is {word}: type that when you come back.");
        saved.map_err(|reason| {
            format!("{reason}\nYour last answers are lost: tell your teacher. {back}")
        })?;
        Ok(back)
    }
}

/// What is hidden: what the page hides stays so until the predictions here are locked, whatever the teacher sees.
fn hidden(run: &PresentedRun, taken: Option<&OpenLesson>) -> Vec<HideablePart> {
    let shown = run.look.get("hide").cloned();
    let shown: Vec<HideablePart> = shown
        .and_then(|hidden| hidden.try_into().ok())
        .unwrap_or_default();
    let page = taken.and_then(|taken| Some((taken.page()?, &taken.place.predictions)));
    let Some((page, predictions)) = page.filter(|(page, _)| page.predicts().next().is_some())
    else {
        return shown;
    };
    let mut hidden = Predictions::hidden_after_lock(page, &shown);
    if !predictions.are_locked_on(page) {
        hidden.extend(page.lab().map(Setup::hides).unwrap_or_default());
    }
    hidden
}

/// The step at which `run` is by now, and how many steps it may be off.
fn wanted(run: &PresentedRun, playback: &Playback, time_step_s: f64) -> (u64, f64) {
    let since_s = unix_ms().saturating_sub(run.at_ms) as f64 / 1000.0;
    let (ahead, off) = match run.speed {
        _ if !run.is_running => (0.0, 0.0),
        Speed::Top => (0.0, f64::INFINITY),
        Speed::Times(speed) => (
            speed * since_s / time_step_s,
            speed * OFF_S / time_step_s + 1.0,
        ),
    };
    let step = run.step.saturating_add(ahead as u64);
    (step.min(playback.end_step()), off)
}

/// Brings the run of `lab` to where `run` is by now. Returns whether it stands or plays there. A command that is refused
/// leaves it where it is.
fn go_with(run: &PresentedRun, lab: &mut Lab) -> bool {
    let playback = &lab.player().playback;
    if playback.steps_to_go().is_some() {
        return false;
    }
    let (wanted, off) = wanted(run, playback, lab.player().motion().time_step_s);
    let is_off = wanted.abs_diff(playback.step_number()) as f64 > off;
    if playback.speed() != run.speed {
        let _ = lab.carry_out(&Command::Speed(run.speed));
    }
    if is_off {
        let _ = lab.carry_out(&Command::GoTo(SeekTarget::Step(wanted)));
    }
    let playback = &lab.player().playback;
    if playback.steps_to_go().is_some() {
        return false;
    }
    let is_running = run.is_running && playback.step_number() < playback.end_step();
    if is_running != playback.is_running() {
        let command = if is_running {
            Command::Run
        } else {
            Command::Pause
        };
        let _ = lab.carry_out(&command);
    }
    true
}
