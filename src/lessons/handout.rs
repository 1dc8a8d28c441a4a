//! A lesson on paper: a worksheet with room for predictions and observations, or the results for afterwards.
//!
//! A worksheet does not reveal the answer to a prediction. After the first prediction, numbers in the text are blanks
//! to fill in from the screen. Pages that explain an outcome have room to write instead of their text. Notes and the
//! solutions of tasks are omitted.
//!
//! - `markdown`: a handout as Markdown, with the lab's screen as text.
//! - [`html`]: a handout as one HTML file with inline SVG pictures, which `figures` draws.
//! - `answers`: a student's predictions with their outcomes.

mod answers;
mod figures;
pub mod html;
mod markdown;

pub use answers::answers;

use super::lesson::{
    AnswerKind, CodeBlock, Compare, Lesson, LessonBlock, LessonPage, PREDICTION, Predict, WITH,
};
use super::names::{self, KeptNumbers};
use super::play::{LessonProgressCallback, LessonWalk};
use crate::engine::scenario::Problem;
use crate::lab::Lab;
use crate::lab::view::Pane;
use figures::{AxisRanges, Figure};

/// Blank for a number or a few words.
const BLANK: &str = "____________";

/// Kind of a handout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paper {
    Worksheet,
    Results,
}

/// File format of a handout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaperFormat {
    Markdown,
    Html,
}

impl PaperFormat {
    /// Returns `markdown` in this format, with this `title`.
    pub fn written(self, title: &str, markdown: String) -> String {
        match self {
            Self::Markdown => markdown,
            Self::Html => html::from_markdown(title, &markdown),
        }
    }
}

/// Functions that draw the lab. They are passed in because the folder that draws screens is above this one.
#[derive(Clone, Copy, Debug)]
pub struct LabPictures {
    /// The whole screen as text.
    pub screen: fn(&Lab) -> String,
    /// One pane as SVG.
    pub pane: fn(&Lab, Pane) -> String,
}

/// A request for a handout.
#[derive(Clone, Copy, Debug)]
pub struct Handout<'a> {
    pub lesson: &'a Lesson,
    pub paper: Paper,
    pub format: PaperFormat,
    pub pictures: LabPictures,
}

/// A part of a handout, in the order of the paper.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    Heading(String),
    /// Markdown.
    Text(String),
    Shown(CodeBlock),
    /// The lab's screen as text.
    Screen(String),
    Figures(Vec<Figure>),
    Question(Question),
    /// Goals, each with a box to tick.
    Goals(Vec<String>),
    /// Lines for a prediction and its outcome.
    Compared,
    /// Lines for an explanation of the outcome.
    Why,
    /// Lines for the page's explanation in the reader's own words.
    OwnWords,
}

/// A question of a handout.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    /// Name of the prediction.
    name: String,
    /// Markdown.
    ask: String,
    asked: AnswerKind,
    /// True if there is room to draw and to give a reason.
    has_room: bool,
    /// Empty axes to draw in, if the answer can be drawn.
    frame: Option<Figure>,
}

impl Handout<'_> {
    /// Plays the lesson in a new `lab` and writes its handout.
    ///
    /// # Errors
    ///
    /// Returns an error if a page cannot be played.
    pub fn write(&self, lab: Lab, go_on: LessonProgressCallback<'_>) -> Result<String, Problem> {
        let mut walk = LessonWalk::new(self.lesson, lab);
        let head = head(self.lesson, &walk);
        let mut parts = Vec::new();
        let mut has_asked = false;
        let mut ranges = AxisRanges::new(self.lesson);
        for page in &self.lesson.pages {
            walk.enter(page, go_on)?;
            let asks = page.predicts().next().is_some();
            // After the first question, a picture could show the outcome.
            let may_be_seen = self.paper == Paper::Results || !has_asked || asks;
            let picture = may_be_seen
                .then(|| self.picture(page, &walk.lab, &mut ranges, go_on))
                .flatten();
            if self.paper == Paper::Worksheet && has_asked {
                parts.extend(blank_page(page, picture));
            } else {
                parts.extend(self.full_page(page, &walk, picture));
                has_asked |= asks;
            }
            if self.paper == Paper::Worksheet {
                add_frames(&mut parts, page, &walk, &ranges);
            }
            if page.number < self.lesson.pages.len() {
                walk.leave(page, go_on)?;
            }
        }
        Ok(match self.format {
            PaperFormat::Markdown => markdown::written(&head, &parts, self.paper),
            PaperFormat::Html => html::written(&head, &parts, self.paper),
        })
    }

    /// Returns a page with its text and numbers. On a worksheet, it ends with the page's question.
    fn full_page(
        &self,
        page: &LessonPage,
        walk: &LessonWalk<'_>,
        mut picture: Option<Part>,
    ) -> Vec<Part> {
        let is_worksheet = self.paper == Paper::Worksheet;
        let mut all = page.blocks.iter();
        let blocks = match all.position(|block| matches!(block, LessonBlock::Predict(_))) {
            Some(asked) if is_worksheet => &page.blocks[..=asked],
            _ => &page.blocks,
        };
        let mut parts = vec![Part::Heading(page.heading.clone())];
        for block in blocks {
            match block {
                LessonBlock::Lab(_) => parts.extend(picture.take()),
                LessonBlock::Predict(predict) => {
                    let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
                    parts.push(question(predict, ask, is_worksheet));
                }
                other => parts.extend(block_part(other, walk)),
            }
        }
        if blocks.len() < page.blocks.len() {
            parts.extend(page.predicts().skip(1).map(blank_question));
        }
        parts
    }

    /// Returns the picture of the lab on `page`, if the page has a `lab` block.
    fn picture(
        &self,
        page: &LessonPage,
        lab: &Lab,
        ranges: &mut AxisRanges,
        go_on: LessonProgressCallback<'_>,
    ) -> Option<Part> {
        page.lab()?;
        if self.format == PaperFormat::Markdown {
            return Some(Part::Screen((self.pictures.screen)(lab)));
        }
        let is_asked = page.predicts().next().is_some();
        let figures = figures::of_lab(lab, self.pictures.pane, is_asked, ranges, go_on);
        (!figures.is_empty()).then_some(Part::Figures(figures))
    }
}

/// Returns a page of a worksheet after the first prediction: questions and tasks, and room for the rest.
fn blank_page(page: &LessonPage, mut picture: Option<Part>) -> Vec<Part> {
    let mut parts = vec![Part::Heading(page.heading.clone())];
    let asks = page.predicts().next().is_some();
    // Commands to type tell the reader what to do, unless the page compares their outcome with a prediction.
    let is_typed = page.blocks.iter().any(is_shell) && page.compares().next().is_none();
    let is_done = is_typed || page.task().is_some();
    let tells = !asks && !is_done && page.checks().next().is_none();
    let mut is_before = true;
    for block in &page.blocks {
        match block {
            LessonBlock::Lab(_) if asks => parts.extend(picture.take()),
            LessonBlock::Lab(_) => is_before = false,
            LessonBlock::Text(text) if is_done || is_before && (!tells || page.lab().is_some()) => {
                parts.push(Part::Text(text.filled(|_, _| BLANK.to_owned())));
            }
            LessonBlock::Predict(predict) => {
                parts.push(blank_question(predict));
                is_before = false;
            }
            LessonBlock::Compare(_) => parts.push(Part::Compared),
            LessonBlock::Check(check) => parts.push(Part::Goals(check.goals.clone())),
            LessonBlock::Shown(code) if !tells || is_shell(block) => {
                parts.push(Part::Shown(code.clone()));
            }
            _ => {}
        }
    }
    if tells {
        let is_compared = page.compares().next().is_some();
        parts.push(if is_compared {
            Part::Why
        } else {
            Part::OwnWords
        });
    }
    parts
}

/// Adds axes to the questions whose outcome `page` shows. Only now is the duration of the run known.
fn add_frames(parts: &mut [Part], page: &LessonPage, walk: &LessonWalk<'_>, ranges: &AxisRanges) {
    for compare in page.compares() {
        let asked = walk.lesson.predict(&compare.prediction);
        let drawn = asked.and_then(|predict| predict.draw);
        for part in &mut *parts {
            if let (Part::Question(question), Some(drawn)) = (part, drawn)
                && question.name == compare.prediction
            {
                question.frame = ranges.frame(drawn, &walk.lab);
            }
        }
    }
}

/// Returns the current page of `walk` as Markdown, with the lab's screen even if the page has no `lab` block.
pub fn page(page: &LessonPage, walk: &LessonWalk<'_>, screen: fn(&Lab) -> String) -> String {
    let mut parts = vec![Part::Heading(page.heading.clone())];
    if page.lab().is_none() {
        parts.push(Part::Screen(screen(&walk.lab)));
    }
    for block in &page.blocks {
        match block {
            LessonBlock::Lab(_) => parts.push(Part::Screen(screen(&walk.lab))),
            LessonBlock::Predict(predict) => {
                let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
                parts.push(question(predict, ask, false));
            }
            other => parts.extend(block_part(other, walk)),
        }
    }
    markdown::of_parts(&parts)
}

/// Returns true if the block is a command to type in a shell.
fn is_shell(block: &LessonBlock) -> bool {
    matches!(block, LessonBlock::Shown(code) if code.language == "sh")
}

fn question(predict: &Predict, ask: String, has_room: bool) -> Part {
    Part::Question(Question {
        name: predict.name.clone(),
        ask,
        asked: predict.asked.clone(),
        has_room,
        frame: None,
    })
}

/// Returns a question with blanks for its numbers.
fn blank_question(predict: &Predict) -> Part {
    question(predict, predict.ask.filled(|_, _| BLANK.to_owned()), true)
}

fn joined(parts: &[String]) -> String {
    parts.join("\n\n") + "\n"
}

/// Text above the first page.
struct Head {
    title: String,
    /// Markdown.
    about: String,
    introduction: Vec<Part>,
}

fn head(lesson: &Lesson, walk: &LessonWalk<'_>) -> Head {
    let minutes = lesson.minutes.map(|it| format!("About {it} minutes."));
    let about = format!("{} {}", lesson.about, minutes.unwrap_or_default());
    let introduction = lesson.introduction.iter();
    Head {
        title: lesson.title.clone(),
        about: about.trim().to_owned(),
        introduction: introduction
            .filter_map(|block| block_part(block, walk))
            .collect(),
    }
}

/// Returns the part of the handout that shows a block, if it is shown.
fn block_part(block: &LessonBlock, walk: &LessonWalk<'_>) -> Option<Part> {
    let (lab, kept) = (&walk.lab, &walk.kept);
    match block {
        LessonBlock::Text(text) => Some(Part::Text(text.with_numbers(lab, kept))),
        LessonBlock::Compare(compare) => Some(Part::Text(blanked(compare, lab, kept))),
        LessonBlock::Check(check) if !check.hint.is_empty() => {
            Some(Part::Text(format!("Hint: {}", check.hint)))
        }
        LessonBlock::Shown(code) => Some(Part::Shown(code.clone())),
        _ => None,
    }
}

/// Returns the comparison with a blank for the prediction.
fn blanked(compare: &Compare, lab: &Lab, kept: &KeptNumbers) -> String {
    let with = compare.came_out(lab, kept);
    compare.text.filled(|expression, format| {
        if expression.names().any(|name| name == PREDICTION) {
            return BLANK.to_owned();
        }
        format.written(expression.value(|name| match name {
            WITH => with,
            name => names::number(name, lab, kept),
        }))
    })
}
