//! What to carry out to stand on a page of a lesson.
//!
//! A page stands on the `lab` and `task` blocks of the pages before it, then on its own `lab`. As a block that opens a run
//! leaves nothing of the runs before it, what stands before the last such block is carried out only where it keeps numbers
//! that are not known yet.

use super::lesson::{Lesson, LessonPage, Setup};
use super::names::{KeptNumbers, value};
use super::predictions::Predictions;
use crate::lab::Lab;
use crate::lab::command::{Command, Commands, LocatedCommand};
use crate::plot::camera::{Camera, Zoom};
use std::ops::ControlFlow;

#[derive(Clone, Debug, PartialEq)]
pub struct LessonStage<'a> {
    pub lesson: &'a Lesson,
    pub page: &'a LessonPage,
    pub setup: &'a Setup,
    /// Whether what its `hide` names is hidden.
    pub is_hiding: bool,
}

impl Lesson {
    /// Returns what to carry out to stand on the page `number` (from 1), from nothing: a jump. `kept` has the numbers that
    /// are known already. What the page hides is shown where its predictions are locked; earlier pages hide nothing that
    /// they hide until their prediction.
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

    /// Returns what to carry out on turning to the page `number` from the page before: its own `lab` block, where it has
    /// one.
    pub fn stage_of<'a>(
        &'a self,
        number: usize,
        predictions: &Predictions,
    ) -> Option<LessonStage<'a>> {
        self.stage(number, LessonPage::lab, predictions)
    }

    /// Returns what to carry out on the page `number` to show how its task is done.
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

/// Returns those of `stages` that are needed: the last run, and the runs that keep numbers which `kept` lacks.
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
    /// Returns whether it keeps numbers that are not among the `kept` ones.
    fn lacks(&self, kept: &KeptNumbers) -> bool {
        let mut names = self.setup.keep.iter();
        names.any(|keep| !kept.contains_key(&keep.name))
    }

    /// Returns the commands, for the lab as it stands. Where a run is opened, what the lab shows otherwise than at first
    /// is put back before, so that the page looks the same whatever was done before.
    pub fn commands(&self, lab: &Lab) -> Commands {
        let mut list = Vec::new();
        if self.setup.opens() {
            let line = Some(self.setup.line);
            let before = put_back(lab).into_iter();
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

    /// Remembers in `kept` the numbers that the block keeps, once it is carried out.
    pub fn keep(&self, lab: &Lab, kept: &mut KeptNumbers) {
        for keep in &self.setup.keep {
            let number = value(&keep.expression, lab, kept);
            kept.insert(keep.name.clone(), number.unwrap_or(f64::NAN));
        }
    }

    /// Carries the block out to its end at once, without a clock, and keeps its numbers. `go_on` is called several times a
    /// second with the step that the run is at and the one at which it stops; the rest is dropped when that breaks.
    pub fn carry_out(
        &self,
        lab: &mut Lab,
        kept: &mut KeptNumbers,
        go_on: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<(), String> {
        let commands = self.commands(lab);
        lab.take_commands(commands);
        lab.finish_script_while(go_on)?;
        lab.messages_mut().take_back(); // nobody has asked for what the block has done
        self.keep(lab, kept);
        Ok(())
    }
}

/// Returns the commands that put back how the lab shows runs, where it is otherwise than at first.
fn put_back(lab: &Lab) -> Vec<Command> {
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
