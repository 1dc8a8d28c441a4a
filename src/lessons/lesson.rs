//! A parsed lesson: its pages, and their blocks in the order of the file.

use super::names::KeptNumbers;
use super::text::LessonText;
use crate::engine::data::RunQuantity;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::screen::ABOVE;
use crate::lab::command::{Command, LocatedCommand};
use crate::lab::view::HideablePart;
use serde::{Deserialize, Serialize};

/// A lesson.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lesson {
    /// Name of a shipped lesson, or the file as the user named it.
    pub name: String,
    /// File that messages name.
    pub origin: String,
    /// Level-1 heading.
    pub title: String,
    /// Subject in one line; empty if the file does not state it.
    pub about: String,
    /// Duration of the lesson, minutes.
    pub minutes: Option<u32>,
    /// Information for a teacher.
    pub guide: LessonGuide,
    /// Blocks before the first page: text, code to show, and notes.
    pub introduction: Vec<LessonBlock>,
    /// Pages; never empty. The page with the number N (from 1) is `pages[N - 1]`.
    pub pages: Vec<LessonPage>,
}

/// Information for the teacher who chooses and gives the lesson. Fields are empty if the file does not state them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LessonGuide {
    pub level: Option<LessonLevel>,
    /// Names of lessons to take first, and tools such as Python.
    pub needs: Vec<String>,
    /// Goals: abilities of a student after the lesson.
    pub goals: Vec<String>,
    /// Properties of a real top that the model lacks.
    pub leaves_out: Vec<String>,
    /// Minutes of each page, in order. They add up to the minutes of the lesson.
    pub page_minutes: Vec<u32>,
}

impl LessonGuide {
    /// Returns the requirements as a sentence without its full stop, or `None` if there are none.
    pub fn needs_in_words(&self) -> Option<String> {
        (!self.needs.is_empty()).then(|| format!("Needs {}", self.needs.join("; ")))
    }
}

/// Prior knowledge that a lesson requires, lowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LessonLevel {
    /// Forces, and curves over time.
    School,
    /// Vectors, torque, and derivatives.
    FirstYear,
    /// The inertia tensor and Euler's equations.
    MechanicsCourse,
}

impl LessonLevel {
    pub const ALL: [Self; 3] = [Self::School, Self::FirstYear, Self::MechanicsCourse];

    /// Returns the name of the level in lesson files and lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::School => "school",
            Self::FirstYear => "first year",
            Self::MechanicsCourse => "mechanics course",
        }
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }
}

/// A page: a level-2 heading and everything below it.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonPage {
    /// Number of the page, from 1.
    pub number: usize,
    pub heading: String,
    /// Line of the heading in the file, from 1.
    pub line: usize,
    pub blocks: Vec<LessonBlock>,
}

/// A part of a page.
#[derive(Clone, Debug, PartialEq)]
pub enum LessonBlock {
    Text(LessonText),
    /// Commands for the lab when the page is opened; at most one block per page.
    Lab(Setup),
    /// Task of the student. The lab carries it out only on request. At most one per page.
    Task(Setup),
    Predict(Predict),
    /// A prediction with its outcome.
    Compare(Compare),
    /// Condition that holds after the task.
    Check(Check),
    Notes(LessonText),
    Shown(CodeBlock),
}

/// The commands of a `lab` or `task` block.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    pub line: usize,
    /// Commands in the order of execution, with their lines in the file: `open`, `set`, `push`, settings of the view,
    /// then `go_to` or `run_until`.
    pub commands: Vec<LocatedCommand>,
    /// Numbers to remember after the commands.
    pub keep: Vec<Keep>,
}

/// A number to remember for later pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Keep {
    pub name: String,
    pub expression: Expression,
}

/// A question that asks for a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Predict {
    pub line: usize,
    /// Name of the prediction, unique in the lesson.
    pub name: String,
    pub ask: LessonText,
    pub asked: AnswerKind,
    /// Right answer, for the teacher, if the file states it.
    pub right: Option<Right>,
    /// Common wrong answer and its reason, for the teacher; empty if the file does not state it.
    pub expected: String,
    /// Explanation for a class in which few are right, for the teacher; empty if the file does not state it.
    pub explain: String,
    /// Axes on paper in which the answer can be drawn.
    pub draw: Option<DrawnAnswer>,
}

/// Picture that answers a question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawnAnswer {
    /// The path of the traced point from above.
    FromAbove,
    /// CSV column with this name, over time.
    OverTime(&'static str),
}

impl DrawnAnswer {
    /// Returns the picture with this name: `above`, or a CSV column.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            ABOVE => Some(Self::FromAbove),
            column => RunQuantity::find(column).map(|quantity| Self::OverTime(quantity.name)),
        }
    }
}

/// Right answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub enum Right {
    /// Number of the choice, from 1.
    Choice(usize),
    /// A number with the tolerance of an answer.
    Number { value: f64, within: f64 },
}

impl Right {
    /// Returns true if `answer`, a number or the number of a choice, is right.
    pub fn accepts(&self, answer: f64) -> bool {
        match self {
            Self::Choice(number) => answer == *number as f64,
            Self::Number { value, within } => (answer - value).abs() <= *within,
        }
    }
}

/// Kind of answer that a question asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum AnswerKind {
    /// One of these choices; at least two.
    Choice(Vec<String>),
    /// A number in this unit, which is empty for a pure number.
    Number { unit: String },
}

/// A student's answer to a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PredictionAnswer {
    Number(f64),
    Choice(String),
}

/// Names in the text of a comparison: the prediction, and the number that is compared with it.
pub(super) const PREDICTION: &str = "prediction";
pub(super) const WITH: &str = "with";

/// A prediction with its outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    pub line: usize,
    pub prediction: String,
    pub with: Option<Expression>,
    /// Markdown text. `{with}` is replaced by the number, and `{prediction}` by the prediction.
    pub text: LessonText,
}

/// A condition that holds after the task or, if the page has no task, after its `lab` block.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    pub line: usize,
    pub that: Expression,
    /// Goals in words: one text for the whole condition, or one for each part joined by `and`; empty if the file does
    /// not state any.
    pub goals: Vec<String>,
    /// Help for a student who has not reached the goals; empty if the file has none.
    pub hint: String,
}

/// Code or text that the page shows unchanged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeBlock {
    /// Word after the opening fence (`text`, `sh`, `toml`, `csv`, `python`, `matlab`), or empty.
    pub language: String,
    /// Lines, each with a line end.
    pub text: String,
}

impl Lesson {
    /// Returns the page with this number, from 1.
    pub fn page(&self, number: usize) -> Option<&LessonPage> {
        self.pages.get(number.checked_sub(1)?)
    }

    pub fn predict(&self, name: &str) -> Option<&Predict> {
        let mut all = self.pages.iter().flat_map(LessonPage::predicts);
        all.find(|predict| predict.name == name)
    }
}

impl LessonBlock {
    /// Returns the text of the block, which may contain numbers of the run.
    pub fn text(&self) -> Option<&LessonText> {
        match self {
            Self::Text(text) | Self::Notes(text) => Some(text),
            Self::Predict(predict) => Some(&predict.ask),
            Self::Compare(compare) => Some(&compare.text),
            _ => None,
        }
    }

    /// Returns the expressions whose numbers the block states.
    fn expressions(&self) -> impl Iterator<Item = &Expression> {
        let with = match self {
            Self::Compare(compare) => compare.with.as_ref(),
            _ => None,
        };
        let numbers = self.text().into_iter().flat_map(LessonText::numbers);
        numbers.map(|(_, expression)| expression).chain(with)
    }
}

impl LessonPage {
    /// Returns the commands for the lab when the page is opened.
    pub fn lab(&self) -> Option<&Setup> {
        self.blocks.iter().find_map(|block| match block {
            LessonBlock::Lab(setup) => Some(setup),
            _ => None,
        })
    }

    /// Returns the task of the student.
    pub fn task(&self) -> Option<&Setup> {
        self.blocks.iter().find_map(|block| match block {
            LessonBlock::Task(setup) => Some(setup),
            _ => None,
        })
    }

    pub fn predicts(&self) -> impl Iterator<Item = &Predict> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Predict(predict) => Some(predict),
            _ => None,
        })
    }

    /// Returns the conditions that must hold after the task.
    pub fn checks(&self) -> impl Iterator<Item = &Check> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Check(check) => Some(check),
            _ => None,
        })
    }

    /// Returns true if the page asks for the prediction called `name`.
    pub fn asks(&self, name: &str) -> bool {
        self.predicts().any(|predict| predict.name == name)
    }

    pub fn compares(&self) -> impl Iterator<Item = &Compare> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Compare(compare) => Some(compare),
            _ => None,
        })
    }

    /// Returns true if the page plays its run, and shows the blocks after its `lab` block only at the end of the run.
    pub fn plays(&self) -> bool {
        self.lab().is_some_and(Setup::plays)
    }

    /// Returns true if the page states numbers of the current run. Numbers in `kept` do not depend on the current run.
    pub fn states_numbers(&self, kept: &KeptNumbers) -> bool {
        self.blocks
            .iter()
            .filter(|block| !matches!(block, LessonBlock::Notes(_)))
            .flat_map(LessonBlock::expressions)
            .flat_map(Expression::names)
            .any(|name| !kept.contains_key(name) && ![PREDICTION, WITH].contains(&name))
    }

    pub fn notes(&self) -> impl Iterator<Item = &LessonText> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Notes(text) => Some(text),
            _ => None,
        })
    }
}

impl Setup {
    /// Returns true if the block opens a run. It then depends on nothing before it except kept numbers.
    pub fn opens(&self) -> bool {
        self.has_command(|command| matches!(command, Command::Open(_)))
    }

    /// Returns true if the block ends with a run that is played until a condition holds.
    pub fn plays(&self) -> bool {
        self.has_command(|command| matches!(command, Command::RunUntil(_)))
    }

    fn has_command(&self, is_meant: impl Fn(&Command) -> bool) -> bool {
        self.commands.iter().any(|placed| is_meant(&placed.command))
    }

    /// Returns the parts of the screen that the block hides.
    pub fn hides(&self) -> Vec<HideablePart> {
        self.commands
            .iter()
            .find_map(|placed| placed.command.looked("hide"))
            .and_then(|hidden| hidden.clone().try_into().ok())
            .unwrap_or_default()
    }
}

impl AnswerKind {
    /// Returns `answer` as a number (for a choice, its number from 1), or `None` if it does not answer this kind of
    /// question.
    pub fn number(&self, answer: &PredictionAnswer) -> Option<f64> {
        match (self, answer) {
            (Self::Number { .. }, PredictionAnswer::Number(number)) => Some(*number),
            (Self::Choice(all), PredictionAnswer::Choice(words)) => {
                Some(all.iter().position(|choice| choice == words)? as f64 + 1.0)
            }
            _ => None,
        }
    }

    pub fn accepts(&self, answer: &PredictionAnswer) -> bool {
        self.number(answer).is_some_and(f64::is_finite)
    }
}
