//! A student's lab: it follows the teacher's, and keeps in the files of its seat where it stands and what was voted.

use super::aside::{changes_the_run, commands_the_run};
use super::folder::{Folder, Run, Stage, State};
use super::seat::{Record, Seat, Vote};
use super::{EVERY, unix_ms, votes};
use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::command::{Command, Place};
use crate::lab::view::Part;
use crate::lessons::class::Dress;
use crate::lessons::predictions::Predictions;
use crate::lessons::{Answer, Asked, Block, Class as Lessons, Lesson, Page, Setup};
use crate::playback::pace::Speed;
use crate::scenario::{Document, Scenario};
use crate::storage::shared;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use toml::{Table, Value};

/// A run that plays is put right where it is more than this off, s of wall time.
const OFF_S: f64 = 0.6;

#[derive(Debug)]
pub struct Student {
    folder: Folder,
    seat: Seat,
    /// The word under which this process has the seat open.
    holds: String,
    record: Record,
    /// Whether the record is to be written.
    is_new: bool,
    state: Option<State>,
    seen: Option<SystemTime>,
    /// Whether the teacher's lab is open, and was at the last look.
    is_on: bool,
    /// What of the teacher's run is shown.
    shown: Shown,
    /// Whether a run that was played aside is pinned.
    has_pinned: bool,
    /// Why the lab ends, where it does.
    pub ended: Option<String>,
    pub next_look: Duration,
    pub trouble: Option<String>,
}

#[derive(Debug, Default)]
struct Shown {
    /// The run file, and the scenario as the lab has it.
    run: Option<(String, Arc<Scenario>)>,
    look: Table,
    hidden: Vec<Part>,
    exact: Option<bool>,
    page: usize,
}

impl Student {
    /// The lab of `seat`, which this process has open under the word `holds`; `record` is what its file holds.
    pub fn new(folder: Folder, seat: Seat, holds: String, record: Record) -> Self {
        Self {
            folder,
            seat,
            holds,
            record,
            is_new: true,
            state: None,
            seen: None,
            is_on: false,
            shown: Shown::default(),
            has_pinned: false,
            ended: None,
            next_look: Duration::ZERO,
            trouble: None,
        }
    }

    /// Where the seat stands in its lessons, as its file has it; `None` where nothing is known.
    pub fn lessons(&self) -> Option<Table> {
        Some(self.record.lessons.clone()).filter(|lessons| !lessons.is_empty())
    }

    /// Leaves the seat: the board says so.
    pub fn leave(&self) {
        self.seat.leave(&self.holds);
    }

    pub(super) fn advance(
        &mut self,
        now: Duration,
        lab: &mut Lab,
        lessons: &mut Lessons,
    ) -> ControlFlow<()> {
        self.note(lab, lessons);
        if now >= self.next_look {
            self.next_look = now + EVERY;
            self.look(lab);
            if self.follows() {
                self.follow(lab, lessons);
            } else {
                lessons.unfollow();
            }
            self.ask_again(lessons);
            lab.files_mut().note = self.note_for_exports(lessons);
            let dress = self.dress(lessons);
            lessons.set_dress(dress);
        }
        if self.is_new {
            self.trouble = self.seat.save(&self.record).err();
            self.is_new = self.trouble.is_some();
        }
        if self.ended.is_some() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Whether the lab shows what the teacher's shows.
    fn follows(&self) -> bool {
        let is_followed = self
            .state
            .as_ref()
            .is_some_and(|state| state.shown.is_some());
        self.is_on && is_followed && !self.record.is_aside
    }

    /// Takes note of what was answered, and of the place in the lessons.
    fn note(&mut self, lab: &Lab, lessons: &mut Lessons) {
        if let Some((question, answer)) = lessons.take_vote()
            && let Some(lesson) = lessons.taken().map(|taken| Arc::clone(&taken.lesson))
        {
            self.vote(&lesson, &question, &answer);
        }
        let kept = lab.lessons.as_ref();
        if kept.is_none_or(|kept| *kept == self.record.lessons) {
            return;
        }
        self.record.lessons = kept.cloned().unwrap_or_default();
        self.is_new = true;
        let places = self.record.kept().lessons;
        for (name, place) in &places {
            let all = place.predictions.all();
            let new: Vec<_> = all
                .filter(|(question, _)| self.record.rounds_of(name, question) == 0)
                .collect();
            let lesson = (!new.is_empty()).then(|| self.folder.lesson(name));
            for (question, answer) in new {
                if let Some(Some(lesson)) = &lesson {
                    self.vote(lesson, question, answer);
                }
            }
        }
        for (name, place) in places {
            let furthest = self.record.furthest.entry(name).or_default();
            *furthest = place.page.max(*furthest);
        }
    }

    fn vote(&mut self, lesson: &Lesson, question: &str, answer: &Answer) {
        let Some(predict) = lesson.predict(question) else {
            return;
        };
        let choices: &[String] = match &predict.asked {
            Asked::Choice(choices) => choices,
            Asked::Number { .. } => &[],
        };
        let is_of_class = |state: &&State| self.is_on && state.lesson == lesson.name;
        let state = self.state.as_ref().filter(is_of_class);
        let asked = state.map(|state| state.question(question));
        let asked = asked.unwrap_or_default();
        let mut pages = lesson.pages.iter();
        let asks = |page: &&Page| page.predicts().any(|other| other.name == question);
        let page = pages.find(asks).map_or(1, |page| page.number);
        // The outcome stands on a later page: on its own it comes once the prediction is locked.
        let tells = |block: &Block| matches!(block, Block::Compare(compare) if compare.prediction == question);
        let outcome = pages.find(|page| page.blocks.iter().any(tells));
        let furthest = self.record.furthest.get(&lesson.name).copied();
        let has_seen = outcome.is_some_and(|outcome| furthest >= Some(outcome.number));
        self.record.votes.push(Vote {
            lesson: lesson.name.clone(),
            question: question.to_owned(),
            round: asked.round(),
            choice: Record::number_of(answer, choices),
            late: has_seen || asked.stage == Stage::Closed,
            page,
            time_unix_s: unix_ms() / 1000,
        });
        self.is_new = true;
    }

    /// Looks at the files: whether the seat is still this lab's, and what the teacher shows.
    fn look(&mut self, lab: &mut Lab) {
        if !self.seat.is_held(&self.holds) {
            let ended = "this seat was opened in another lab, which goes on from here";
            self.ended = Some(ended.to_owned());
        }
        let seen = shared::modified(&self.folder.state_file());
        if seen != self.seen {
            match self.folder.state() {
                Ok(state) => self.state = state,
                Err(reason) => {
                    lab.tell(reason);
                    self.state = None;
                }
            }
            self.seen = seen;
        }
        let Some(state) = &self.state else {
            self.is_on = false;
            return;
        };
        if state.closed.contains(&self.seat.word) {
            self.ended = Some("your teacher has closed this seat".to_owned());
        }
        let is_alive = self.folder.is_teacher_alive();
        if self.is_on && !(state.is_on && is_alive) {
            lab.tell(if state.is_on {
                "the teacher's lab is gone: n and N turn pages"
            } else {
                "the class is over: n and N turn pages"
            });
            self.shown = Shown::default();
        }
        self.is_on = state.is_on && is_alive;
    }

    /// Shows what the teacher shows.
    fn follow(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        let Some(state) = self.state.clone() else {
            return;
        };
        let Some(run) = &state.shown else { return };
        let scenario = lab.player().run().scenario();
        let is_same = self
            .shown
            .run
            .as_ref()
            .map(|(file, shown)| (*file == run.run, Arc::ptr_eq(shown, scenario)));
        match is_same {
            Some((_, false)) => return self.step_aside(lab, lessons), // the run was changed by hand
            Some((true, true)) => {}
            _ => {
                let read =
                    Document::parse(&run.name, &run.run).and_then(|document| document.scenario());
                let Ok(scenario) = read else {
                    return lab.tell("the teacher's run cannot be read: n and N turn pages");
                };
                lab.show_run(&run.name, Arc::new(scenario), run.end_s);
                let shown = Arc::clone(lab.player().run().scenario());
                self.shown = Shown {
                    run: Some((run.run.clone(), shown)),
                    page: self.shown.page,
                    ..Shown::default()
                };
            }
        }
        if self.shown.page != state.page {
            self.shown.page = state.page;
            if is_same.is_some() && std::mem::take(&mut self.has_pinned) {
                let _ = lab.carry_out(&Command::Pin(false)); // it belongs to the page before
            }
        }
        let is_there = go_with(run, lab);
        let has_arrived = state.has_arrived && is_there;
        let followed = lessons.follow((&state.lesson, state.page), &state.kept, has_arrived, lab);
        if let Err(reason) = followed {
            lab.tell(reason.lines().next().unwrap_or_default());
        }
        self.show_as(run, lab, lessons);
    }

    /// Shows the run as the teacher does, where that has changed; what the page hides stays hidden until the prediction here
    /// is locked.
    fn show_as(&mut self, run: &Run, lab: &mut Lab, lessons: &Lessons) {
        // What stands so already is left out: a key may be refused where it has no use.
        let own = Table::try_from(&lab.view().look).unwrap_or_default();
        let is_new = |(key, value): &(&String, &Value)| {
            let is_known = |look: &Table| look.get(*key) == Some(value);
            *key != "hide" && !is_known(&self.shown.look) && !is_known(&own)
        };
        let patch: Table = run
            .look
            .iter()
            .filter(is_new)
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect();
        if !patch.is_empty() {
            let _ = lab.carry_out(&Command::Look(patch)); // what suits another screen may not suit this one
        }
        self.shown.look.clone_from(&run.look);
        if self.shown.exact != Some(run.exact) {
            self.shown.exact = Some(run.exact);
            let _ = lab.carry_out(&Command::Exact(run.exact));
        }
        let hidden = run.look.get("hide").cloned();
        let hidden: Vec<Part> = hidden
            .and_then(|hidden| hidden.try_into().ok())
            .unwrap_or_default();
        let page = lessons
            .taken()
            .and_then(|taken| Some((taken.page()?, &taken.place.predictions)))
            .filter(|(page, _)| page.predicts().next().is_some());
        let hidden = page.map_or(hidden.clone(), |(page, predictions)| {
            let mut hidden = Predictions::hidden_after_lock(page, &hidden);
            if !predictions.are_locked_on(page) {
                hidden.extend(page.lab().map(Setup::hides).unwrap_or_default());
            }
            hidden
        });
        if hidden != self.shown.hidden {
            let _ = lab.carry_out(&Command::look("hide", &hidden));
            self.shown.hidden = hidden;
        }
    }

    /// Asks the question of the page again where the class is at another round.
    fn ask_again(&self, lessons: &mut Lessons) {
        let again = self
            .state
            .as_ref()
            .filter(|_| self.is_on)
            .and_then(|state| {
                let taken = lessons.taken();
                let taken = taken.filter(|taken| taken.lesson.name == state.lesson)?;
                let (predict, question) = votes::question(taken.page()?, state)?;
                let voted = self.record.rounds_of(&state.lesson, &predict.name);
                let is_open = question.stage != Stage::Closed && voted < question.round();
                is_open.then(|| predict.name.clone())
            });
        lessons.ask_again(again);
    }

    fn dress(&self, lessons: &Lessons) -> Dress {
        let Some((state, taken)) = self
            .state
            .as_ref()
            .filter(|_| self.is_on)
            .zip(lessons.taken())
        else {
            return Dress::default();
        };
        let (page, pages) = (taken.place.page, taken.lesson.pages.len());
        let question = taken.page().filter(|_| taken.lesson.name == state.lesson);
        let question = question.and_then(|page| votes::question(page, state));
        let asks = state.page == page && question.is_some();
        let framed = if self.record.is_aside {
            let on = format!("the class is on {}", state.page);
            format!("aside · {page} of {pages} · {on}\naside on {page} · {on}")
        } else if !self.follows() {
            format!("{page} of {pages} · the class is on {}", state.page)
        } else if asks {
            let (answered, here) = (state.answered, state.here);
            let of_page = format!("following · {page} of {pages}");
            format!("{of_page} · {answered} of {here} answered\n{of_page} · {answered} of {here}")
        } else {
            format!("following · {page} of {pages}")
        };
        let border = match (state.shown.is_some(), self.record.is_aside) {
            (true, true) => "C: back to the class",
            (true, false) => "C: step aside",
            (false, _) => "",
        };
        let votes = question.filter(|(_, question)| !question.bars.is_empty());
        Dress {
            framed,
            border: border.to_owned(),
            votes: votes.map(|(predict, question)| {
                (predict.name.clone(), vec![votes::drawn(&question.bars)])
            }),
            instead: None,
        }
    }

    pub(super) fn takes(&mut self, action: Action, lab: &mut Lab, lessons: &mut Lessons) -> bool {
        match action {
            Action::Class if !self.is_on => lab.refuse("no class is on"),
            Action::Class if self.record.is_aside => self.come_back(lab),
            Action::Class if self.follows() => self.step_aside(lab, lessons),
            Action::Class => lab.refuse("the class is not followed now: n and N turn pages"),
            Action::Lesson(LessonKey::Notes) if self.is_on => {
                lab.refuse("the notes are the teacher's");
            }
            action if self.follows() && changes_the_run(action) => {
                self.step_aside(lab, lessons);
                return false;
            }
            _ => return false,
        }
        true
    }

    /// Steps aside where `commands` change the run.
    pub(super) fn expect(&mut self, commands: &[Command], lab: &mut Lab, lessons: &mut Lessons) {
        if self.follows() && commands.iter().any(commands_the_run) {
            self.step_aside(lab, lessons);
        }
    }

    fn step_aside(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        (self.record.is_aside, self.is_new) = (true, true);
        self.shown = Shown::default();
        self.next_look = Duration::ZERO;
        lessons.unfollow();
        lab.tell("you have stepped aside: C leads back to the class");
    }

    /// What the header of an export says: the seat, and the page beside which it was made.
    fn note_for_exports(&self, lessons: &Lessons) -> Option<String> {
        let taken = lessons.taken().filter(|_| self.record.is_aside)?;
        let (page, lesson) = (taken.place.page, &taken.lesson.name);
        let (seat, lesson) = (&self.seat.word, self.folder.short(lesson));
        Some(format!("seat {seat}, beside page {page} of {lesson}"))
    }

    /// Follows again. A run that was played meanwhile stays, pinned.
    fn come_back(&mut self, lab: &mut Lab) {
        (self.record.is_aside, self.is_new) = (false, true);
        self.next_look = Duration::ZERO;
        if lab.player().playback.step_number() > 0 && !lab.comparison().is_pinned() {
            let _ = lab.carry_out(&Command::Pin(true));
            self.has_pinned = true;
        }
        lab.refuse("back in the class");
    }
}

/// Brings the run of `lab` to where `run` is by now. Returns whether it stands or plays there.
fn go_with(run: &Run, lab: &mut Lab) -> bool {
    let playback = &lab.player().playback;
    if playback.steps_to_go().is_some() {
        return false;
    }
    let time_step_s = lab.player().motion().time_step_s;
    let since_s = unix_ms().saturating_sub(run.at_ms) as f64 / 1000.0;
    // Steps that the run has gone on since, and that it may be off.
    let (ahead, off) = match run.speed {
        _ if !run.is_running => (0.0, 0.0),
        Speed::Top => (0.0, f64::INFINITY),
        Speed::Times(speed) => (
            speed * since_s / time_step_s,
            speed * OFF_S / time_step_s + 1.0,
        ),
    };
    let wanted = run
        .step
        .saturating_add(ahead as u64)
        .min(playback.end_step());
    let is_off = wanted.abs_diff(playback.step_number()) as f64 > off;
    // A command that is refused leaves the run where it is.
    if playback.speed() != run.speed {
        let _ = lab.carry_out(&Command::Speed(run.speed));
    }
    if is_off {
        let _ = lab.carry_out(&Command::GoTo(Place::Step(wanted)));
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
