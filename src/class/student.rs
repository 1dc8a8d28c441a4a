//! A student's lab: it follows the teacher's, and keeps in the files of its seat where it stands and what was voted.

use super::folder::{ClassFolder, ClassState, PresentedRun, VoteStage};
use super::seat::{Seat, SeatRecord};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, unix_ms, votes};
use crate::engine::scenario::Scenario;
use crate::lab::action::LessonKey;
use crate::lab::command::{Command, SeekTarget};
use crate::lab::playback::pace::Speed;
use crate::lab::storage::shared;
use crate::lab::view::HideablePart;
use crate::lab::{Lab, Player, Snapshot};
use crate::lessons::open_lesson::OpenLesson;
use crate::lessons::page::ClassOverlay;
use crate::lessons::predictions::Predictions;
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
    lock_token: String,
    record: SeatRecord,
    /// Whether the record is to be written.
    is_new: bool,
    state: Option<ClassState>,
    seen: Option<SystemTime>,
    /// Whether the teacher's lab was open at the last look.
    is_on: bool,
    /// What of the teacher's run is shown.
    shown: PresentedView,
    last_snapshot: Option<PlaybackSnapshot>,
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
    /// Returns the lab of `seat`, which this process has open under the word `lock_token`; `record` is what its file
    /// holds.
    pub fn new(folder: ClassFolder, seat: Seat, lock_token: String, record: SeatRecord) -> Self {
        Self {
            folder,
            seat,
            lock_token,
            record,
            is_new: true,
            ..Self::default()
        }
    }

    /// Returns whether the lab shows what the teacher's shows.
    fn follows(&self) -> bool {
        let state = self.state.as_ref();
        let is_followed = state.is_some_and(|state| state.shown.is_some());
        self.is_on && is_followed && !self.record.is_aside
    }

    /// Returns the state of the class, while it is on.
    fn class(&self) -> Option<&ClassState> {
        self.state.as_ref().filter(|_| self.is_on)
    }

    /// Takes note of the place in the lessons, with what was answered.
    fn note(&mut self, lessons: &Lessons) {
        let kept = lessons.kept();
        if !kept.is_empty() && *kept != self.record.lessons {
            self.record.lessons.clone_from(kept);
            self.is_new = true;
        }
    }

    /// Looks at the files: whether the seat is still this lab's, and what the teacher shows.
    fn look(&mut self, lab: &mut Lab) {
        if !self.seat.is_held(&self.lock_token) {
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
    fn show_presented(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        let Some(state) = self.state.clone() else {
            return;
        };
        let Some(run) = &state.shown else { return };
        match &self.shown.run {
            Some((_, shown)) if !Arc::ptr_eq(shown, lab.player().run().scenario()) => {
                return self.step_aside(lab); // the run was changed here
            }
            Some((file, _)) if *file == run.snapshot.run => {}
            _ => {
                if lab.show_run(&run.snapshot).is_err() {
                    return lab.tell("the teacher's run cannot be read: n and N turn pages");
                }
                let shown = Arc::clone(lab.player().run().scenario());
                self.shown = PresentedView {
                    run: Some((run.snapshot.run.clone(), shown)),
                    page: self.shown.page,
                    ..PresentedView::default()
                };
            }
        }
        if self.shown.page != state.page {
            let is_turned = std::mem::replace(&mut self.shown.page, state.page) != 0;
            if is_turned && std::mem::take(&mut self.has_pinned) {
                let _ = lab.carry_out(&Command::Pin(false)); // it belongs to the page before
            }
        }
        let is_there = sync_to_presenter(run, lab);
        if let Err(reason) = lessons.show_class_page(&state.followed(is_there), lab) {
            lab.tell(reason.lines().next().unwrap_or_default());
        }
        self.show_as(&run.snapshot, lab, lessons);
        lab.set_undo_floor(true); // undo would lead to a run that was shown before
    }

    /// Shows the run as the teacher does, where that has changed.
    fn show_as(&mut self, presented: &Snapshot, lab: &mut Lab, lessons: &Lessons) {
        // What stands so already is left out: a key may be refused where it has no use.
        let own = Table::try_from(&lab.view().look).unwrap_or_default();
        let look = Table::try_from(&presented.look).unwrap_or_default();
        let mut patch = look.clone();
        patch.retain(|key, value| {
            let known = [self.shown.look.get(key), own.get(key)];
            key != "hide" && !known.contains(&Some(value))
        });
        if !patch.is_empty() {
            let _ = lab.carry_out(&Command::Look(patch)); // what suits another screen may not suit this one
        }
        self.shown.look = look;
        let shows_exact = presented.shows_exact;
        if self.shown.exact.replace(shows_exact) != Some(shows_exact) {
            let _ = lab.carry_out(&Command::Exact(shows_exact));
        }
        let hidden = hidden(&presented.look.hide, lessons.open_lesson());
        if hidden != self.shown.hidden {
            let _ = lab.carry_out(&Command::look("hide", &hidden));
            self.shown.hidden = hidden;
        }
    }

    /// Returns what the class adds to the page.
    fn overlay(&self, lessons: &Lessons) -> ClassOverlay {
        let Some(open) = lessons.open_lesson().filter(|_| self.has_begun) else {
            return ClassOverlay::default();
        };
        let Some(state) = self.class() else {
            return ClassOverlay {
                framed: self.title(open, false),
                ..ClassOverlay::default()
            };
        };
        let page = open.page().filter(|_| open.lesson.name == state.lesson);
        let asked = page.and_then(|page| votes::question(page, state));
        let mut overlay = ClassOverlay {
            framed: self.title(open, asked.is_some()),
            is_followed: self.follows(),
            ..ClassOverlay::default()
        };
        if overlay.is_followed {
            overlay.border = "k: step aside".to_owned();
        }
        for (name, question) in state.questions.get(&open.lesson.name).into_iter().flatten() {
            let is_closed = question.stage == VoteStage::Closed;
            let round = (question.round(), is_closed);
            overlay.rounds.insert(name.clone(), round);
        }
        if let Some((predict, question)) = asked
            && !question.bars.is_empty()
        {
            overlay.votes = Some((predict.name.clone(), vec![votes::drawn(&question.bars)]));
        }
        overlay
    }

    /// Returns the title of the page, a form a line; `asks` says whether the page has a question.
    fn title(&self, open: &OpenLesson, asks: bool) -> String {
        let page = open.place.page;
        let of = format!("{page} of {}", open.lesson.pages.len());
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
            && player.step_number() > 0
            && shown.is_some_and(|shown| shown.snapshot.run != own);
        if is_own && lab.carry_out(&Command::Pin(true)).is_ok() {
            self.has_pinned = true;
            let pinned =
                "back in the class; your own run is pinned beside its run: i takes it away";
            return lab.tell(pinned);
        }
        lab.refuse("back in the class");
    }

    /// Returns what the header of an export says: the seat, and the page beside which it was made.
    fn note_for_exports(&self, lessons: &Lessons) -> Option<String> {
        let open = lessons.open_lesson().filter(|_| self.record.is_aside)?;
        let (page, lesson) = (open.place.page, &open.lesson.name);
        let (seat, lesson) = (&self.seat.word, self.folder.short(lesson));
        Some(format!("seat {seat}, beside page {page} of {lesson}"))
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
        self.note(lessons);
        if now >= self.next_look || self.is_new && !was_new {
            self.next_look = now + CLASS_POLL_INTERVAL;
            self.look(lab);
            if self.follows() {
                self.show_presented(lab, lessons);
            }
            lab.files_mut().note = self.note_for_exports(lessons);
            lessons.set_overlay(self.overlay(lessons), lab);
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

    fn on_class_key(&mut self, lab: &mut Lab, _lessons: &mut Lessons) {
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

    fn intercept(&mut self, key: LessonKey, lab: &mut Lab, _lessons: &Lessons) -> bool {
        let is_of_teacher = key == LessonKey::Notes && self.is_on;
        if is_of_teacher {
            lab.refuse("the notes are the teacher's");
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
        let back = format!("Your seat is {word}: type that when you come back.");
        saved.map_err(|reason| {
            format!("{reason}\nYour last answers are lost: tell your teacher. {back}")
        })?;
        Ok(back)
    }
}

/// Returns what is hidden where the teacher's lab hides `presented`: what the page hides stays so until the predictions
/// here are locked, whatever the teacher sees.
fn hidden(presented: &[HideablePart], open: Option<&OpenLesson>) -> Vec<HideablePart> {
    let page = open.and_then(|open| Some((open.page()?, &open.place.predictions)));
    let Some((page, predictions)) = page.filter(|(page, _)| page.predicts().next().is_some())
    else {
        return presented.to_vec();
    };
    let mut hidden = Predictions::hidden_after_lock(page, presented);
    if !predictions.are_locked_on(page) {
        hidden.extend(page.lab().map(Setup::hides).unwrap_or_default());
    }
    hidden
}

/// Returns the step at which `run` is by now, and how many steps it may be off.
fn expected_step(run: &PresentedRun, player: &Player, time_step_s: f64) -> (u64, f64) {
    let since_s = unix_ms().saturating_sub(run.at_ms) as f64 / 1000.0;
    let (ahead, off) = match run.snapshot.speed {
        _ if !run.is_running => (0.0, 0.0),
        Speed::Top => (0.0, f64::INFINITY),
        Speed::Times(speed) => (
            speed * since_s / time_step_s,
            speed * OFF_S / time_step_s + 1.0,
        ),
    };
    let step = run.snapshot.step.saturating_add(ahead as u64);
    (step.min(player.end_step()), off)
}

/// Brings the run of `lab` to where `run` is by now. Returns whether it stands or plays there. A command that is refused
/// leaves it where it is.
fn sync_to_presenter(run: &PresentedRun, lab: &mut Lab) -> bool {
    let player = lab.player();
    if player.steps_to_go().is_some() {
        return false;
    }
    let (step, off) = expected_step(run, player, player.motion().time_step_s);
    let is_off = step.abs_diff(player.step_number()) as f64 > off;
    let speed = run.snapshot.speed;
    if player.speed() != speed {
        let _ = lab.carry_out(&Command::Speed(speed));
    }
    if is_off {
        let _ = lab.carry_out(&Command::GoTo(SeekTarget::Step(step)));
    }
    let there = lab.player();
    if there.steps_to_go().is_some() {
        return false;
    }
    let is_running = run.is_running && there.step_number() < there.end_step();
    if is_running != there.is_running() {
        let command = if is_running {
            Command::Run
        } else {
            Command::Pause
        };
        let _ = lab.carry_out(&command);
    }
    true
}
