//! The commands that bring the lab to the state of a page.
//!
//! A page builds on the `lab` and `task` blocks of the pages before it, and then on its own `lab` block. A block that
//! opens a run makes earlier blocks irrelevant. These are carried out only if they keep numbers that are not known yet.

use super::lesson::{Lesson, LessonPage, Setup};
use super::names::{KeptNumbers, value};
use super::predictions::Predictions;
use crate::lab::Lab;
use crate::lab::command::{Command, Commands, LocatedCommand};
use crate::plot::camera::{Camera, Zoom};
use std::ops::ControlFlow;

/// A block to carry out for a page.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonStage<'a> {
    pub lesson: &'a Lesson,
    pub page: &'a LessonPage,
    pub setup: &'a Setup,
    /// True if the parts named by its `hide` are hidden.
    pub is_hiding: bool,
}

impl Lesson {
    /// Returns the blocks that bring the lab to the state of page `number` (from 1) from any state.
    ///
    /// `kept` has the numbers that are already known. The page shows its hidden parts if its predictions are locked.
    /// Earlier pages hide nothing if they have a prediction.
    pub fn stages_to<'a>(
        &'a self,
        number: usize,
        kept: &KeptNumbers,
        predictions: &Predictions,
    ) -> Vec<LessonStage<'a>> {
        let mut stages = Vec::new();
        for page in self.pages.iter().take(number.saturating_sub(1)) {
            for setup in page.lab().into_iter().chain(page.task()) {
                stages.push(LessonStage {
                    lesson: self,
                    page,
                    setup,
                    is_hiding: page.predicts().next().is_none(),
                });
            }
        }
        stages.extend(self.stage_of(number, predictions));
        needed(stages, kept)
    }

    /// Returns the `lab` block of page `number`, if any: the block to carry out when the page is turned to from the
    /// page before.
    pub fn stage_of<'a>(
        &'a self,
        number: usize,
        predictions: &Predictions,
    ) -> Option<LessonStage<'a>> {
        self.stage(number, LessonPage::lab, predictions)
    }

    /// Returns the `task` block of page `number`, if any. It shows how the task is done.
    pub fn task_of<'a>(
        &'a self,
        number: usize,
        predictions: &Predictions,
    ) -> Option<LessonStage<'a>> {
        self.stage(number, LessonPage::task, predictions)
    }

    fn stage(
        &self,
        number: usize,
        setup: impl Fn(&LessonPage) -> Option<&Setup>,
        predictions: &Predictions,
    ) -> Option<LessonStage<'_>> {
        let page = self.page(number)?;
        Some(LessonStage {
            lesson: self,
            page,
            setup: setup(page)?,
            is_hiding: !predictions.are_locked_on(page),
        })
    }
}

/// Returns the necessary `stages`: those of the last run, and of runs that keep numbers missing in `kept`.
fn needed<'a>(stages: Vec<LessonStage<'a>>, kept: &KeptNumbers) -> Vec<LessonStage<'a>> {
    let mut runs: Vec<Vec<LessonStage<'a>>> = Vec::new();
    for stage in stages {
        match runs.last_mut() {
            Some(run) if !stage.setup.opens() => run.push(stage),
            _ => runs.push(vec![stage]),
        }
    }
    let last = runs.pop().unwrap_or_default();
    for run in &mut runs {
        let end = run.iter().rposition(|stage| stage.lacks(kept));
        run.truncate(end.map_or(0, |at| at + 1));
    }
    runs.into_iter().flatten().chain(last).collect()
}

impl LessonStage<'_> {
    /// Returns true if the block keeps numbers that are missing in `kept`.
    fn lacks(&self, kept: &KeptNumbers) -> bool {
        let mut names = self.setup.keep.iter();
        names.any(|keep| !kept.contains_key(&keep.name))
    }

    /// Returns the commands for `lab` in its current state.
    ///
    /// If the block opens a run, changes of the view are undone first, so that the page looks the same whatever was
    /// done before.
    pub fn commands(&self, lab: &Lab) -> Commands {
        let mut list = Vec::new();
        if self.setup.opens() {
            let line = Some(self.setup.line);
            let before = reset_view(lab).into_iter();
            list.extend(before.map(|command| LocatedCommand { command, line }));
        }
        for placed in &self.setup.commands {
            let mut shown = placed.clone();
            if !self.is_hiding && placed.command.looked("hide").is_some() {
                let hidden = self.setup.hides().into_iter();
                let others: Vec<_> = hidden.filter(|part| !part.is_answer()).collect();
                shown.command = Command::look("hide", others);
            }
            list.push(shown);
        }
        Commands {
            origin: self.lesson.origin.clone(),
            list,
        }
    }

    /// Stores the numbers that the block keeps in `kept`. Call it after the block was carried out.
    pub fn keep(&self, lab: &Lab, kept: &mut KeptNumbers) {
        for keep in &self.setup.keep {
            let number = value(&keep.expression, lab, kept);
            kept.insert(keep.name.clone(), number.unwrap_or(f64::NAN));
        }
    }

    /// Carries the block out to its end at once, without a clock, and keeps its numbers.
    ///
    /// `go_on` is called several times per second with the run's current and last step. If it breaks, the rest is
    /// dropped.
    ///
    /// # Errors
    ///
    /// Returns the message of the command that failed.
    pub fn carry_out(
        &self,
        lab: &mut Lab,
        kept: &mut KeptNumbers,
        go_on: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), String> {
        let commands = self.commands(lab);
        lab.take_commands(commands);
        lab.finish_script_while(go_on)?;
        lab.messages_mut().take_back(); // the user did not ask for the block's messages
        self.keep(lab, kept);
        Ok(())
    }
}

/// Returns the commands that reset those parts of the view that differ from their defaults.
fn reset_view(lab: &Lab) -> Vec<Command> {
    let view = lab.view();
    let shows_exact = lab.player().run().shows_exact();
    let all = [
        (view.fullscreen, Command::Fill(None)),
        (view.look.bare, Command::look("bare", false)),
        (view.pointed_at.is_some(), Command::PointAt(None)),
        (
            view.look.camera.is_some(),
            Command::look("camera", Camera::default()),
        ),
        (
            view.look.zoom != Zoom::default(),
            Command::look("zoom", Zoom::default()),
        ),
        (shows_exact, Command::Exact(false)),
        (lab.comparison().is_pinned(), Command::Pin(false)),
    ];
    let other = all.into_iter().filter(|(is_other, _)| *is_other);
    other.map(|(_, command)| command).collect()
}
