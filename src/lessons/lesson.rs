//! A lesson as it was read: its pages, and the blocks of each in the order of the file.

use super::names::KeptNumbers;
use super::text::LessonText;
use crate::engine::data::RunQuantity;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::screen::ABOVE;
use crate::lab::command::{Command, LocatedCommand};
use crate::lab::view::HideablePart;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lesson {
    /// The name of a shipped lesson, or the file as the user named it.
    pub name: String,
    /// The file that messages name.
    pub origin: String,
    /// Its level-1 heading.
    pub title: String,
    /// What it is about, one line; empty where the file does not say it.
    pub about: String,
    pub minutes: Option<u32>,
    /// What a teacher plans with.
    pub guide: LessonGuide,
    /// The blocks before the first page: text, code that is shown as it is, and notes.
    pub introduction: Vec<LessonBlock>,
    /// The pages; never empty. The page with the number N (from 1) is `pages[N - 1]`.
    pub pages: Vec<LessonPage>,
}

/// What a teacher wants to know before the lesson is chosen, and in front of the class. Empty where the file does not say it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LessonGuide {
    pub level: Option<LessonLevel>,
    /// Names of lessons to take first, and tools such as Python.
    pub needs: Vec<String>,
    /// What a student can do or explain afterwards.
    pub goals: Vec<String>,
    /// What a real top does and the model does not.
    pub leaves_out: Vec<String>,
    /// Minutes of each page, in order; they add up to the minutes of the lesson.
    pub page_minutes: Vec<u32>,
}

impl LessonGuide {
    /// Returns what it needs as a sentence without its full stop; none if it needs nothing.
    pub fn needs_in_words(&self) -> Option<String> {
        (!self.needs.is_empty()).then(|| format!("Needs {}", self.needs.join("; ")))
    }
}

/// What a lesson takes for granted, from little to much.
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

    /// Returns its name in lesson files and lists.
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

/// A page: a level-2 heading and all that stands below it.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonPage {
    /// Its number, from 1.
    pub number: usize,
    pub heading: String,
    /// The heading's line in the file, from 1.
    pub line: usize,
    pub blocks: Vec<LessonBlock>,
}

/// A part of a page.
#[derive(Clone, Debug, PartialEq)]
pub enum LessonBlock {
    Text(LessonText),
    /// What the lab does when the page is opened; at most one on a page.
    Lab(Setup),
    /// What the student is to do; the lab does it only when it is asked to show it. At most one on a page.
    Task(Setup),
    Predict(Predict),
    /// A prediction beside what happened.
    Compare(Compare),
    /// What holds once the student has done the task.
    Check(Check),
    Notes(LessonText),
    Shown(CodeBlock),
}

/// What a `lab` or `task` block makes the lab do.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    pub line: usize,
    /// The commands in the order in which they are carried out, with their lines in the file: `open`, `set`, `push`, how
    /// the run is shown, then `go_to` or `run_until`.
    pub commands: Vec<LocatedCommand>,
    /// The numbers that are remembered once all of this is done.
    pub keep: Vec<Keep>,
}

/// A number that is remembered for later pages.
#[derive(Clone, Debug, PartialEq)]
pub struct Keep {
    pub name: String,
    pub expression: Expression,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Predict {
    pub line: usize,
    /// Its name; no other prediction of the lesson has it.
    pub name: String,
    pub ask: LessonText,
    pub asked: AnswerKind,
    /// What comes out, for the teacher; where the file says it.
    pub right: Option<Right>,
    /// For the teacher: which wrong answer is common, and why. Empty where the file does not say it.
    pub expected: String,
    /// For the teacher: what to show or say if few are right. Empty where the file does not say it.
    pub explain: String,
    /// On paper: the axes in which the answer can be drawn.
    pub draw: Option<DrawnAnswer>,
}

/// The picture that answers a question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawnAnswer {
    /// The path of the traced point from above.
    FromAbove,
    /// The column of the CSV with this name, over time.
    OverTime(&'static str),
}

impl DrawnAnswer {
    /// Returns the picture with this name: `above`, or a column of the CSV.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            ABOVE => Some(Self::FromAbove),
            column => RunQuantity::find(column).map(|quantity| Self::OverTime(quantity.name)),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Right {
    /// The number of the choice, from 1.
    Choice(usize),
    /// A number, and how far off an answer may be.
    Number { value: f64, within: f64 },
}

impl Right {
    /// Returns whether `answer` is right: a number, or the number of a choice.
    pub fn accepts(&self, answer: f64) -> bool {
        match self {
            Self::Choice(number) => answer == *number as f64,
            Self::Number { value, within } => (answer - value).abs() <= *within,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum AnswerKind {
    /// One of these; at least two.
    Choice(Vec<String>),
    /// A number in this unit, which is empty for a pure number.
    Number { unit: String },
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum PredictionAnswer {
    Number(f64),
    Choice(String),
}

/// In the text of a comparison: the prediction, and the number that it is compared with.
pub(super) const PREDICTION: &str = "prediction";
pub(super) const WITH: &str = "with";

/// A prediction beside what happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    pub line: usize,
    pub prediction: String,
    pub with: Option<Expression>,
    /// What is said, in Markdown; `{with}` stands for that number and `{prediction}` for the prediction.
    pub text: LessonText,
}

/// What holds once the student has done the task; where the page has no task, once its `lab` block is carried out.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    pub line: usize,
    pub that: Expression,
    /// What is to be reached, in words: one text for all of it, or one for each part that `and` joins; empty where the
    /// file does not say it.
    pub goals: Vec<String>,
    /// Help for one who has not got there; empty where the file has none.
    pub hint: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeBlock {
    /// The word behind its fence (`text`, `sh`, `toml`, `csv`, `python`, `matlab`), or none.
    pub language: String,
    /// Its lines, with a line end after each.
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
    /// Returns the text in it, which may hold numbers of the run.
    pub fn text(&self) -> Option<&LessonText> {
        match self {
            Self::Text(text) | Self::Notes(text) => Some(text),
            Self::Predict(predict) => Some(&predict.ask),
            Self::Compare(compare) => Some(&compare.text),
            _ => None,
        }
    }

    /// Returns the numbers that it states.
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
    /// Returns what the lab does when the page is opened.
    pub fn lab(&self) -> Option<&Setup> {
        self.blocks.iter().find_map(|block| match block {
            LessonBlock::Lab(setup) => Some(setup),
            _ => None,
        })
    }

    /// Returns what the student is to do.
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

    /// Returns what must hold once the student has done the task.
    pub fn checks(&self) -> impl Iterator<Item = &Check> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Check(check) => Some(check),
            _ => None,
        })
    }

    /// Returns whether it asks for the prediction called `name`.
    pub fn asks(&self, name: &str) -> bool {
        self.predicts().any(|predict| predict.name == name)
    }

    pub fn compares(&self) -> impl Iterator<Item = &Compare> {
        self.blocks.iter().filter_map(|block| match block {
            LessonBlock::Compare(compare) => Some(compare),
            _ => None,
        })
    }

    /// Returns whether its run is played, and what stands behind its `lab` block comes once that has arrived.
    pub fn plays(&self) -> bool {
        self.lab().is_some_and(Setup::plays)
    }

    /// Returns whether it states numbers of the run that a student has in hand: what `kept` names is known whatever that
    /// is.
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
    /// Returns whether it opens a run: it then depends on nothing before it but kept numbers.
    pub fn opens(&self) -> bool {
        self.has_command(|command| matches!(command, Command::Open(_)))
    }

    /// Returns whether it ends with a run that is played until a condition holds.
    pub fn plays(&self) -> bool {
        self.has_command(|command| matches!(command, Command::RunUntil(_)))
    }

    fn has_command(&self, is_meant: impl Fn(&Command) -> bool) -> bool {
        self.commands.iter().any(|placed| is_meant(&placed.command))
    }

    /// Returns the parts of the screen that its `hide` names.
    pub fn hides(&self) -> Vec<HideablePart> {
        self.commands
            .iter()
            .find_map(|placed| placed.command.looked("hide"))
            .and_then(|hidden| hidden.clone().try_into().ok())
            .unwrap_or_default()
    }
}

impl AnswerKind {
    /// `answer` as a number, such as that of its choice from 1; `None` where it is no answer to this.
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
