//! Plays a lesson to its end without a screen, page after page, with every task done by the lab.

use super::lesson::{Check, Lesson, LessonBlock, LessonPage, Setup};
use super::names::{self, KeptNumbers};
use super::predictions::Predictions;
use super::stage::LessonStage;
use super::structure::on_line;
use super::text::LessonText;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::number::{NOT_AVAILABLE, significant};
use crate::lab::Lab;
use crate::lab::command::Command;
use indicatif::HumanCount;
use std::ops::ControlFlow;

/// Callback that is called several times per second with the run's current and last step. It decides if the run
/// continues.
pub type LessonProgressCallback<'a> = &'a mut dyn FnMut(u64, u64) -> ControlFlow<()>;

/// Maximum steps of earlier pages that are replayed when a page is turned to.
const MOST_BEFORE: u64 = 1_000_000;

/// A lab that goes through a lesson.
pub struct LessonWalk<'a> {
    pub lesson: &'a Lesson,
    pub lab: Lab,
    pub kept: KeptNumbers,
    /// Empty: parts hidden until a prediction stay hidden while the page is open.
    predictions: Predictions,
    /// True once a run of the lesson is open.
    is_open: bool,
}

impl<'a> LessonWalk<'a> {
    /// Starts before the first page of `lesson`, in a new `lab`.
    pub fn new(lesson: &'a Lesson, lab: Lab) -> Self {
        Self {
            lesson,
            lab,
            kept: KeptNumbers::new(),
            predictions: Predictions::default(),
            is_open: false,
        }
    }

    /// Goes to `page` directly, without earlier pages that make no difference to it.
    pub fn jump(
        &mut self,
        page: &'a LessonPage,
        go_on: LessonProgressCallback<'_>,
    ) -> Result<(), Problem> {
        let stages = self
            .lesson
            .stages_to(page.number, &self.kept, &self.predictions);
        for stage in &stages {
            self.carry_out(stage, go_on)?;
        }
        Ok(())
    }

    /// Turns to `page` from the page before, and carries out its `lab` block.
    pub fn enter(
        &mut self,
        page: &'a LessonPage,
        go_on: LessonProgressCallback<'_>,
    ) -> Result<(), Problem> {
        match self.lesson.stage_of(page.number, &self.predictions) {
            Some(stage) => self.carry_out(&stage, go_on),
            None => Ok(()),
        }
    }

    /// Leaves `page`: does its task, and shows the parts that it hides until its prediction.
    pub fn leave(
        &mut self,
        page: &'a LessonPage,
        go_on: LessonProgressCallback<'_>,
    ) -> Result<(), Problem> {
        if let Some(stage) = self.lesson.task_of(page.number, &self.predictions) {
            self.carry_out(&stage, go_on)?;
        }
        if page.predicts().next().is_some() {
            let hidden = Predictions::hidden_after_lock(page, &self.lab.view().look.hide);
            // This command never fails.
            let _ = self.lab.carry_out(&Command::look("hide", hidden));
        }
        Ok(())
    }

    fn carry_out(
        &mut self,
        stage: &LessonStage<'_>,
        go_on: LessonProgressCallback<'_>,
    ) -> Result<(), Problem> {
        self.is_open = true;
        let done = stage.carry_out(&mut self.lab, &mut self.kept, go_on);
        done.map_err(|text| as_problem(&self.lesson.origin, stage.setup.line, &text))
    }

    /// Returns true if `check` holds now. Nothing holds before a run is open.
    fn holds(&self, check: &Check) -> bool {
        let value = names::value(&check.that, &self.lab, &self.kept);
        self.is_open && value.is_some_and(|value| value != 0.0)
    }

    /// Returns the current numbers in `expression`, such as `steps is 10, z_m is 0.8`.
    fn numbers_of(&self, expression: &Expression) -> String {
        let mut all = Vec::new();
        for name in expression.names() {
            all.push(match names::number(name, &self.lab, &self.kept) {
                Some(number) => format!("{name} is {}", significant(number, 6)),
                None => format!("{name} is {NOT_AVAILABLE}"),
            });
        }
        all.join(", ")
    }

    /// Finds the placeholders of `text` whose numbers are not available now.
    fn unstated_in(&self, text: &LessonText, found: &mut Problems) {
        for (line, expression) in text.numbers() {
            let names: Vec<_> = expression.names().collect();
            let is_of_compare = names.contains(&"with") || names.contains(&"prediction");
            if !is_of_compare && names::value(expression, &self.lab, &self.kept).is_none() {
                let rule = format!(
                    "is {NOT_AVAILABLE} on this page: {}",
                    self.numbers_of(expression)
                );
                let key = format!("{{{}}}", expression.text());
                found.add(|| on_line(line, Problem::at(key, rule)));
            }
        }
    }

    fn unstated_on(&self, page: &LessonPage, found: &mut Problems) {
        for block in &page.blocks {
            if let Some(text) = block.text() {
                self.unstated_in(text, found);
            }
            if let LessonBlock::Compare(compare) = block
                && let Some(with) = &compare.with
                && compare.came_out(&self.lab, &self.kept).is_none()
            {
                let rule = format!("is {NOT_AVAILABLE} on this page: {}", self.numbers_of(with));
                found.add(|| on_line(compare.line, Problem::at("compare.with", rule)));
            }
        }
    }
}

/// Plays `lesson` in a new `lab` to its end.
///
/// Returns the numbers of its text that are not available where they are stated, and thus shown as "n/a". Each check
/// must hold after the task of its page (without a task, after its `lab` block), and must not hold before.
///
/// # Errors
///
/// Returns every block that cannot be carried out and every check that fails, with file and line. If `go_on` stopped
/// the lesson, the result has no meaning.
pub fn check(
    lesson: &Lesson,
    lab: Lab,
    go_on: LessonProgressCallback<'_>,
) -> Result<Vec<Problem>, Problems> {
    let mut walk = LessonWalk::new(lesson, lab);
    let (mut found, mut unstated) = (Problems::default(), Problems::default());
    for page in &lesson.pages {
        if let Err(problem) = walk.check_page(page, &mut found, &mut unstated, go_on) {
            found.add(|| problem);
            break; // later pages depend on it
        }
    }
    found.in_file(&lesson.origin).or(unstated.list)
}

impl<'a> LessonWalk<'a> {
    /// Reports a page that states numbers of a run opened earlier, if that run is too long to be replayed whenever the
    /// page is turned to.
    fn refuse_far(&self, page: &LessonPage, found: &mut Problems) {
        let steps = self.lab.player().step_number();
        let opens = page.lab().is_some_and(Setup::opens);
        if !opens && steps > MOST_BEFORE && page.states_numbers(&self.kept) {
            let (steps, most) = (HumanCount(steps), HumanCount(MOST_BEFORE));
            let rule = format!(
                "states numbers of a run of {steps} steps from earlier pages, but at most {most} steps are replayed \
                when it is opened: add a lab block that opens a run"
            );
            found.add(|| on_line(page.line, Problem::at(format!("## {}", page.heading), rule)));
        }
    }

    /// Returns the state of each check of `page`: true if it holds now, and its numbers.
    fn states_of_checks(&self, page: &LessonPage) -> Vec<(bool, String)> {
        let checks = page.checks();
        checks
            .map(|check| (self.holds(check), self.numbers_of(&check.that)))
            .collect()
    }

    fn check_page(
        &mut self,
        page: &'a LessonPage,
        found: &mut Problems,
        unstated: &mut Problems,
        go_on: LessonProgressCallback<'_>,
    ) -> Result<(), Problem> {
        let has_task = page.task().is_some();
        let block = if has_task { "task" } else { "lab block" };
        let mut before = self.states_of_checks(page);
        self.enter(page, go_on)?;
        self.unstated_on(page, unstated);
        self.refuse_far(page, found);
        if has_task {
            before = self.states_of_checks(page);
        }
        self.leave(page, go_on)?;
        let after = self.states_of_checks(page);
        for (check, states) in page.checks().zip(before.into_iter().zip(after)) {
            let rule = match states {
                ((false, _), (true, _)) => continue,
                (_, (false, numbers)) => {
                    format!("does not hold after the {block} of its page: {numbers}")
                }
                ((true, first), (true, last)) => format!(
                    "holds without the {block} of its page too, so it checks nothing: {}",
                    if has_task { first } else { last }
                ),
            };
            let that = toml::Value::from(check.that.text());
            found.add(|| on_line(check.line, Problem::with_value("check.that", &that, rule)));
        }
        Ok(())
    }
}

/// Converts the error `text` of a command, `origin:line: ...`, to a problem. If it names no line, the problem is on
/// `line`.
fn as_problem(origin: &str, line: usize, text: &str) -> Problem {
    let located = text
        .strip_prefix(origin)
        .and_then(|rest| rest.strip_prefix(':'))
        .and_then(|rest| rest.split_once(": "))
        .and_then(|(number, rest)| Some((number.parse().ok()?, rest)));
    let (on, rule) = located.unwrap_or((line, text));
    on_line(on, Problem::at("", rule))
}
