//! A lab that follows the teacher's: it reads the published state and shows its page, run and view.

use super::folder::{ClassFolder, ClassState, PresentedRun};
use super::unix_ms;
use crate::engine::scenario::Scenario;
use crate::lab::command::{Command, SeekTarget};
use crate::lab::playback::pace::Speed;
use crate::lab::storage::shared;
use crate::lab::view::HideablePart;
use crate::lab::{Lab, Player, Snapshot};
use crate::lessons::open_lesson::OpenLesson;
use crate::lessons::predictions::Predictions;
use crate::lessons::{Lessons, Setup};
use std::sync::Arc;
use std::time::SystemTime;
use toml::Table;

/// Deviation at which a running run is corrected, s of wall time.
const OFF_S: f64 = 0.6;

/// The common part of the labs of students and the projector.
#[derive(Debug, Default)]
pub(super) struct Follower {
    pub(super) folder: ClassFolder,
    state: Option<ClassState>,
    /// Modification time of the state that was read last.
    seen: Option<SystemTime>,
    /// True if the class was running at the last read.
    is_on: bool,
    shown: PresentedView,
}

/// The parts of the teacher's lab that are shown here.
#[derive(Debug, Default)]
struct PresentedView {
    /// Run file, and the scenario made from it.
    run: Option<(String, Arc<Scenario>)>,
    look: Table,
    hidden: Vec<HideablePart>,
    exact: Option<bool>,
    page: usize,
}

/// Result of reading the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClassChange {
    Nothing,
    Begun,
    /// The teacher has ended the class.
    Over,
    /// The teacher's lab has sent no heartbeat.
    Gone,
}

/// Result of showing the teacher's lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    SamePage,
    NewPage,
    /// Nothing was shown, because the run was changed in this lab.
    ChangedHere,
}

impl Follower {
    pub(super) fn new(folder: ClassFolder) -> Self {
        Self {
            folder,
            ..Self::default()
        }
    }

    /// Returns the state that was read last, even if the class is over.
    pub(super) fn state(&self) -> Option<&ClassState> {
        self.state.as_ref()
    }

    /// Returns the state of the class while it is running.
    pub(super) fn class(&self) -> Option<&ClassState> {
        self.state.as_ref().filter(|_| self.is_on)
    }

    /// Returns true if the teacher has ended the class.
    pub(super) fn is_over(&self) -> bool {
        self.state.as_ref().is_some_and(|state| !state.is_on)
    }

    /// Reads the files. If the state cannot be read, `lab` shows the reason.
    pub(super) fn look(&mut self, lab: &mut Lab) -> ClassChange {
        let seen = shared::modified(&self.folder.state_file());
        if seen != self.seen {
            let read = self.folder.state();
            self.state = read.unwrap_or_else(|reason| {
                lab.tell(reason);
                None
            });
            self.seen = seen;
        }
        let was_on = self.is_on;
        self.is_on = self.state.is_some() && !self.is_over() && self.folder.is_teacher_alive();
        if !self.is_on {
            self.forget_shown();
        }
        match (was_on, self.is_on) {
            (false, true) => ClassChange::Begun,
            (true, false) if self.is_over() => ClassChange::Over,
            (true, false) if self.state.is_some() => ClassChange::Gone,
            _ => ClassChange::Nothing,
        }
    }

    /// Makes the next [`show`](Self::show) show everything again.
    pub(super) fn forget_shown(&mut self) {
        self.shown = PresentedView::default();
    }

    /// Shows the page, run and view of the teacher's lab.
    ///
    /// # Errors
    ///
    /// Returns a message if they cannot be shown.
    pub(super) fn show(&mut self, lab: &mut Lab, lessons: &mut Lessons) -> Result<Shown, String> {
        let Some(state) = self.state.clone() else {
            return Ok(Shown::SamePage);
        };
        let Some(run) = &state.shown else {
            return Ok(Shown::SamePage);
        };
        match &self.shown.run {
            Some((_, shown)) if !Arc::ptr_eq(shown, lab.player().run().scenario()) => {
                return Ok(Shown::ChangedHere);
            }
            Some((file, _)) if *file == run.snapshot.run => {}
            _ => {
                if lab.show_run(&run.snapshot).is_err() {
                    return Err(
                        "the teacher's run cannot be read: press n or N to turn pages".to_owned(),
                    );
                }
                let shown = Arc::clone(lab.player().run().scenario());
                self.shown = PresentedView {
                    run: Some((run.snapshot.run.clone(), shown)),
                    page: self.shown.page,
                    ..PresentedView::default()
                };
            }
        }
        let before = std::mem::replace(&mut self.shown.page, state.page);
        let is_there = sync_to_presenter(run, lab);
        let turned = lessons.show_class_page(&state.followed(is_there), lab);
        self.show_as(&run.snapshot, lab, lessons);
        lab.set_undo_floor(true); // undo would return to an earlier presented run
        turned.map_err(|reason| reason.lines().next().unwrap_or_default().to_owned())?;
        Ok(if before == 0 || before == state.page {
            Shown::SamePage
        } else {
            Shown::NewPage
        })
    }

    /// Applies changes of the teacher's view.
    fn show_as(&mut self, presented: &Snapshot, lab: &mut Lab, lessons: &Lessons) {
        // Settings that are already in effect are omitted: a command without effect may be refused.
        let own = Table::try_from(&lab.view().look).unwrap_or_default();
        let look = Table::try_from(&presented.look).unwrap_or_default();
        let mut patch = look.clone();
        patch.retain(|key, value| {
            let known = [self.shown.look.get(key), own.get(key)];
            key != "hide" && !known.contains(&Some(value))
        });
        if !patch.is_empty() {
            let _ = lab.carry_out(&Command::Look(patch)); // settings of another screen may not fit this one
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
}

/// Returns the parts to hide if the teacher's lab hides `presented`.
///
/// Parts that the page hides stay hidden until the predictions here are locked, whatever the teacher sees.
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

/// Returns the step at which `run` should be by now, and the tolerance in steps.
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

/// Brings the run of `lab` to the current state of `run`. Returns true once it has arrived. If a command is refused,
/// the run stays where it is.
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
