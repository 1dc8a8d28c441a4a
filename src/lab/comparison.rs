//! Everything with which the run is compared: the exact motion, the run before an edit (its ghost), a pinned run, and
//! measured data.

mod column;
mod data;
mod own_code;

use super::answer::{ActionResult, Done};
use super::command::{Command, SeekTarget};
use super::files::Files;
use super::player::{Player, RunChange, furthest_s};
use super::runs::Reference;
use super::view::{Pane, View};
use crate::engine::analysis::cost;
use crate::engine::data::{ColumnOptions, MeasuredData, RunQuantity, doubts, find_shipped};
use crate::engine::scenario::{Problems, Scenario};
use crate::lab::playback::ghost::{Ghost, PendingGhost};
use crate::lab::playback::live::LiveRun;
use crate::studies::own_code::rows;
pub use column::RecordedColumn;
pub use data::DataComparison;
pub use own_code::OwnCode;
use std::sync::Arc;
use std::time::Duration;

/// Minimum length of a run that replaces its ghost, as a share of the ghost's length. A shorter run was not played far
/// enough.
const SHORT_RUN_SHARE: f64 = 0.1;
/// Computing time for reading the run at the measured times in each round of the main loop, while the run moves, and
/// while it is paused (`PAUSED_BUDGET`).
const MEASURED_BUDGET: Duration = Duration::from_millis(6);
const PAUSED_BUDGET: Duration = Duration::from_millis(40);

enum Pinned {
    /// The present run, unchanged since it was pinned.
    Present,
    /// An earlier run, or the present run before an edit.
    Before(Box<Ghost>),
    /// An earlier run from a session. Its pictures are being recomputed.
    Returning(PendingGhost),
}

#[derive(Default)]
pub struct Comparison {
    ghost: Option<Ghost>,
    pinned: Option<Pinned>,
    data: Option<DataComparison>,
    /// The CSV column in the fourth strip of the traces.
    column: Option<RecordedColumn>,
}

/// Returns the computing time for following the run of `player` in one round of the main loop.
fn computing_share(player: &Player) -> Duration {
    if player.is_moving() {
        MEASURED_BUDGET
    } else {
        PAUSED_BUDGET
    }
}

impl Comparison {
    /// Prepares for the change of the run of `player` to `scenario`, and must be called before it.
    ///
    /// Keeps the pictures of the run as ghost or pinned run, and starts comparing the data with `scenario`.
    pub(super) fn leave(&mut self, player: &Player, change: RunChange, scenario: &Arc<Scenario>) {
        let run = player.run();
        match change {
            RunChange::Described => {}
            RunChange::GoesOn => self.keep_pinned(run),
            RunChange::ContinuesAt(0) => self.leave_ghost(run, false),
            RunChange::ContinuesAt(_) => self.keep_pinned(run),
            RunChange::BeginsAnew { is_again, .. } => {
                self.leave_ghost(run, is_again && player.has_just_restarted());
            }
            _ if change.is_of_other_name() => {
                self.keep_pinned(run);
                self.ghost = None;
            }
            RunChange::Returns { .. } | RunChange::Opens => {
                self.ghost = None;
                self.leave_ghost(run, false);
            }
        }
        let is_ghost = self
            .ghost
            .as_ref()
            .is_some_and(|ghost| Arc::ptr_eq(&ghost.scenario, run.scenario()));
        let branches_at = match change {
            RunChange::Described => return,
            RunChange::GoesOn => Some(player.step_number()),
            RunChange::ContinuesAt(step) => Some(step),
            _ => None,
        };
        if let Some(data) = &mut self.data {
            match branches_at {
                Some(step) => data.branch(scenario, step),
                None if is_ghost => data.begin_after_ghost(scenario),
                None => data.begin(scenario),
            }
        }
        if let Some(column) = &mut self.column {
            match branches_at {
                Some(step) => column.branch(scenario, step),
                None if is_ghost => column.begin_after_ghost(scenario),
                None => column.begin(scenario),
            }
        }
    }

    /// Starts recording `quantity` of the run of `player` from its start, or stops recording.
    pub(super) fn record_column(
        &mut self,
        quantity: Option<&'static RunQuantity>,
        player: &Player,
    ) {
        let recorded = self.column.as_ref().map(|column| column.quantity.name);
        if quantity.map(|quantity| quantity.name) == recorded {
            return;
        }
        let scenario = player.run().scenario();
        self.column = quantity.map(|wanted| RecordedColumn::new(wanted, scenario));
    }

    /// Keeps `run` as the ghost if it was played far enough, unless `keeps_ghost` is true. A pinned run does not become
    /// the ghost, because it is drawn as the pinned run.
    fn leave_ghost(&mut self, run: &LiveRun, keeps_ghost: bool) {
        let is_pinned = matches!(self.pinned, Some(Pinned::Present));
        self.keep_pinned(run);
        if keeps_ghost {
            return;
        }
        if is_pinned {
            self.ghost = None;
            return;
        }
        let left = Ghost::capture(run);
        let before_s = self.ghost.as_ref().map_or(0.0, Ghost::end_s);
        if left.end_s() > 0.0 && left.end_s() >= SHORT_RUN_SHARE * before_s {
            self.ghost = Some(left);
        }
    }

    /// Keeps the pictures of `run`, which is about to change, if it is pinned.
    fn keep_pinned(&mut self, run: &LiveRun) {
        if matches!(self.pinned, Some(Pinned::Present)) {
            self.pinned = Some(Pinned::Before(Box::new(Ghost::capture(run))));
        }
    }

    pub(super) fn pin(&mut self, pinned: bool) -> Done {
        let was_pinned = self.is_pinned();
        self.pinned = pinned.then_some(Pinned::Present);
        Done::saying(match (pinned, was_pinned) {
            (true, false) => {
                "this run is pinned: it stays visible, in long and short dashes; i unpins it"
            }
            (true, true) => "this run is pinned now, instead of the previous one",
            (false, true) => "the run is unpinned",
            (false, false) => "no run is pinned",
        })
    }

    /// Shows the measured data `name` with the run, or removes the present ones.
    pub(super) fn measure(
        &mut self,
        name: Option<&str>,
        player: &Player,
        files: &Files,
    ) -> ActionResult {
        let Some(name) = name else {
            return Ok(Done::saying(if self.data.take().is_some() {
                "the measured data are removed"
            } else {
                "there are no measured data to remove"
            }));
        };
        let put = self.put_beside(name, &ColumnOptions::default(), player, files, false);
        let notes =
            put.map_err(|problems| format!("{}: {}", problems.origin, problems.in_one_line()))?;
        Ok(notes.map_or(Done::SILENT, Done::saying))
    }

    /// Reads the measured data `name` and shows them with the run. Returns notes about ignored columns and implausible
    /// values.
    ///
    /// If `may_wait` is true, the data may be a FIFO or a device, which can take any length of time to read.
    ///
    /// # Errors
    /// Returns an error if the data cannot be read or are not a time series.
    pub(super) fn put_beside(
        &mut self,
        name: &str,
        options: &ColumnOptions,
        player: &Player,
        files: &Files,
        may_wait: bool,
    ) -> Result<Option<String>, Problems> {
        let text = files.measured_text(name, may_wait)?;
        let scenario = player.run().scenario();
        let (measured, own) = OwnCode::read(name, &text, options, scenario)?;
        let notes = [doubts(&measured, scenario), measured.notes()].concat();
        let mut data = DataComparison::new(name, options, measured, scenario)?;
        data.own = own;
        self.data = Some(data);
        self.catch_up(player);
        Ok((!notes.is_empty()).then(|| notes.join(" · ")))
    }

    /// Checks that `text`, the file `name`, can be compared with the run. Returns the reason if it cannot be judged as
    /// rows of the user's own program.
    ///
    /// # Errors
    /// Returns an error if `text` is not a time series.
    pub(super) fn check(
        &self,
        name: &str,
        text: &str,
        player: &Player,
    ) -> Result<Option<Problems>, Problems> {
        let (measured, own) = OwnCode::read(
            name,
            text,
            &ColumnOptions::default(),
            player.run().scenario(),
        )?;
        measured.series()?;
        let time_step_s = player.motion().time_step_s;
        Ok(own
            .is_none()
            .then(|| rows::read(text, &[], None, time_step_s).err())
            .flatten())
    }

    /// Shows the data that the `[view]` of the run names, and removes the data that the `[view]` of `before` named.
    /// Must be called after the run has changed from `before` to another scenario or another `[view]`.
    ///
    /// # Errors
    /// Returns an error if the data cannot be shown.
    pub(super) fn measure_as_opened(
        &mut self,
        before: &Scenario,
        player: &Player,
        files: &Files,
    ) -> Result<(), Problems> {
        let shown = self.data.as_ref().map(|data| data.name.as_str());
        let wanted = player.run().scenario().file.viewed_text("measured");
        if wanted == shown || (wanted.is_none() && shown != before.file.viewed_text("measured")) {
            return Ok(());
        }
        self.data = None;
        let Some(name) = wanted else {
            return Ok(());
        };
        self.put_beside(name, &ColumnOptions::default(), player, files, false)
            .map(drop)
    }

    /// Continues comparing the data with the run, for at most its share of the computing time, and takes the pictures
    /// of a pinned run once they are recomputed. Returns true if there was something to do.
    pub(super) fn advance(&mut self, player: &Player, clock: &mut dyn FnMut() -> Duration) -> bool {
        self.follow(player, clock) | self.follow_column(player, clock) | self.take_pinned()
    }

    fn follow_column(&mut self, player: &Player, clock: &mut dyn FnMut() -> Duration) -> bool {
        let step = player.step_number();
        let column = self.column.as_mut();
        let Some(column) = column.filter(|column| column.is_behind(step)) else {
            return false;
        };
        let deadline = clock() + computing_share(player);
        column.follow(step, || clock() >= deadline);
        true
    }

    fn follow(&mut self, player: &Player, clock: &mut dyn FnMut() -> Duration) -> bool {
        let (step, is_moving) = (player.step_number(), player.is_moving());
        let data = self.data.as_mut();
        let Some(data) = data.filter(|data| data.is_behind(step)) else {
            return false;
        };
        let deadline = clock() + computing_share(player);
        data.follow(step, || clock() >= deadline);
        // While the run moves, numbers are read only a few times a second.
        if !is_moving {
            self.compare(player);
        }
        true
    }

    fn take_pinned(&mut self) -> bool {
        if let Some(Pinned::Returning(run)) = &self.pinned
            && let Some(ghost) = run.made()
        {
            self.pinned = Some(Pinned::Before(Box::new(ghost)));
            return true;
        }
        false
    }

    /// Compares the rows of the user's own program with the run of `player`, which is called `name`. Returns true if a
    /// verdict has just been found, and the first verdict in words.
    pub(super) fn judge(&mut self, name: &str, player: &Player) -> (bool, Option<String>) {
        let data = self.data.as_mut();
        let Some((data, own)) = data.and_then(|data| Some((&data.name, data.own.as_mut()?))) else {
            return (false, None);
        };
        let is_found = own.judge(name, player.run().scenario());
        (is_found, is_found.then(|| own.first_told(data)).flatten())
    }

    /// Returns the rows of the user's own program, if the measured data are such rows.
    pub fn own_code(&self) -> Option<&OwnCode> {
        self.data.as_ref()?.own.as_ref()
    }

    /// Returns the commands that go to the first step at which such rows differ, and show the step pane.
    ///
    /// # Errors
    /// Returns an error if there are no such rows or no difference was found.
    pub fn to_difference(&self, view: &View) -> Result<Vec<Command>, String> {
        let none = "no rows of your own program to compare with a run of the report's scheme: gyrolab method-1 --measured mine.csv";
        let data = self.data.as_ref().ok_or(none)?;
        let own = data.own.as_ref().ok_or(none)?;
        let first = own
            .verdict()
            .and_then(|verdict| verdict.first_step)
            .ok_or_else(|| own.told(&data.name))?;
        let step = u64::try_from(first).unwrap_or(0);
        let mut commands = vec![Command::GoTo(SeekTarget::Step(step))];
        if !view.shows(Pane::Step) {
            commands.extend(view.toggled(Pane::Step));
        }
        Ok(commands)
    }

    /// Follows the run to the present step, however long that takes.
    pub(super) fn catch_up(&mut self, player: &Player) {
        if let Some(data) = &mut self.data {
            data.follow(player.step_number(), || false);
        }
        if let Some(column) = &mut self.column {
            column.follow(player.step_number(), || false);
        }
    }

    /// Compares the data with the run up to its present time.
    pub(super) fn compare(&mut self, player: &Player) {
        let step = player.step_number();
        if let Some(data) = &mut self.data {
            if !data.is_behind(step) {
                data.follow(step, || true);
            }
            data.compare(player.run().now().time_s);
        }
    }

    /// Returns the previous run, if an edit restarted the run.
    pub fn ghost(&self) -> Option<&Ghost> {
        self.ghost.as_ref()
    }

    pub fn data(&self) -> Option<&DataComparison> {
        self.data.as_ref()
    }

    pub fn column(&self) -> Option<&RecordedColumn> {
        self.column.as_ref()
    }

    pub(super) fn measured(&self) -> Option<Arc<MeasuredData>> {
        self.data.as_ref().map(|data| Arc::clone(&data.measured))
    }

    pub fn is_pinned(&self) -> bool {
        self.pinned.is_some()
    }

    /// Returns the pictures of the pinned run; `None` if there is none, if it is the present run, or if its pictures
    /// are not ready.
    pub fn pinned(&self) -> Option<&Ghost> {
        match &self.pinned {
            Some(Pinned::Before(run)) => Some(run),
            Some(Pinned::Present | Pinned::Returning(_)) | None => None,
        }
    }

    /// Returns the time that the pinned run had reached, s; `None` if there is none or its pictures are not ready.
    /// `run` is the present run.
    pub fn pinned_end_s(&self, run: &LiveRun) -> Option<f64> {
        match &self.pinned {
            Some(Pinned::Present) => Some(furthest_s(run)),
            Some(Pinned::Before(ghost)) => Some(ghost.end_s()),
            Some(Pinned::Returning(_)) | None => None,
        }
    }

    /// Returns the data about the pinned run for a session.
    pub(super) fn reference(&self) -> Option<Reference> {
        let (scenario, step) = match self.pinned.as_ref()? {
            Pinned::Present => return Some(Reference::default()),
            Pinned::Before(run) => (&run.scenario, run.furthest),
            Pinned::Returning(run) => (&run.scenario, run.furthest),
        };
        let run = Some(Arc::clone(scenario));
        Some(Reference { step, run })
    }

    /// Pins `reference` again, if there is one. Its pictures are recomputed in the background.
    pub(super) fn pin_again(&mut self, reference: Option<Reference>) {
        self.pinned = reference.map(|Reference { step, run }| {
            run.map_or(Pinned::Present, |run| {
                Pinned::Returning(PendingGhost::begin(run, step))
            })
        });
    }

    /// Returns the name of the measured data for a session. A file is given by its full path, unless the lab is
    /// confined to a folder.
    pub(super) fn data_to_keep(&self, files: &Files) -> Option<String> {
        let name = &self.data.as_ref()?.name;
        let is_whole = find_shipped(name).is_some() || files.confined().is_some();
        let whole = std::path::absolute(name)
            .ok()
            .filter(|_| !is_whole)
            .and_then(|path| path.to_str().map(str::to_owned));
        Some(whole.unwrap_or_else(|| name.clone()))
    }
}

/// Shows or hides the exact motion.
pub(super) fn show_exact(shown: bool, player: &mut Player) -> Done {
    if shown != player.run().shows_exact() {
        player.run.set_overlay(shown);
    }
    if !shown {
        return Done::saying("the exact motion is hidden");
    }
    Done::saying(match cost::why_exact_unavailable(player.run().scenario()) {
        Some(why) => format!("{why}: it is not shown; try a shorter run"),
        None => "the exact motion (same start, same pushes) is dashed; t hides it".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn a_replaced_run_becomes_the_previous_run() {
        let (mut player, mut comparison) = (Player::new(scenario(), false), Comparison::default());
        let mut go_over = |from: &mut Player, change| {
            let scenario = scenario();
            comparison.leave(from, change, &scenario);
            from.change_run(
                change,
                &scenario,
                crate::engine::run::Clock::end_s(&scenario),
            );
            comparison.ghost().map(Ghost::end_s)
        };
        let anew = RunChange::BeginsAnew {
            is_act: false,
            is_again: false,
        };
        assert_eq!(go_over(&mut player, anew), None, "it stood at its start");
        player.step(100).unwrap();
        let end_s = go_over(&mut player, anew);
        assert!(end_s.is_some_and(|end_s| (end_s - 10.0).abs() < 1e-9));
        assert_eq!(player.step_number(), 100, "to the same time");
        player.restart(&scenario()); // a run that was stopped on its way there
        player.step(1).unwrap();
        assert_eq!(go_over(&mut player, anew), end_s, "one step is no run");
        assert_eq!(go_over(&mut player, RunChange::Opens), None);
    }
}
