//! A lesson on paper: a worksheet, which asks and has room for what is predicted and seen, or the results for afterwards.
//!
//! A worksheet tells nothing that answers a prediction: from the first one on, numbers in text are blanks to be filled in
//! from the screen, and the pages that show what came out have room in the place of their words. Notes are left out, and
//! so is how a task is done.
//!
//! - `markdown`: a handout as Markdown, with the lab's screen as text.
//! - [`html`]: a handout as one HTML file; its pictures are inline SVG, which `figures` draws.
//! - `answers`: what a student predicted beside what came out.

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

/// Room for a number or some words.
const BLANK: &str = "____________";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paper {
    Worksheet,
    Results,
}

/// What a handout is written as.
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

/// Draws the lab. The folder that draws screens is above this one.
#[derive(Clone, Copy, Debug)]
pub struct LabPictures {
    /// The whole screen as text.
    pub screen: fn(&Lab) -> String,
    /// One pane as SVG.
    pub pane: fn(&Lab, Pane) -> String,
}

/// A handout that is asked for.
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
    /// What is to be reached, each with a box to tick.
    Goals(Vec<String>),
    /// Lines for a prediction and what came out.
    Compared,
    /// Lines for an explanation of what came out.
    Why,
    /// Lines for what the page explains.
    OwnWords,
}

/// A question of a handout.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    /// The name of the prediction.
    name: String,
    /// Markdown.
    ask: String,
    asked: AnswerKind,
    /// Whether it has room to draw and to give a reason.
    has_room: bool,
    /// The empty axes to draw in, if the answer can be drawn.
    frame: Option<Figure>,
}

impl Handout<'_> {
    /// Plays the lesson in a new `lab` and writes its handout.
    ///
    /// # Errors
    /// When a page cannot be played.
    pub fn write(&self, lab: Lab, go_on: LessonProgressCallback<'_>) -> Result<String, Problem> {
        let mut walk = LessonWalk::new(self.lesson, lab);
        let head = head(self.lesson, &walk);
        let mut parts = Vec::new();
        let mut has_asked = false;
        let mut ranges = AxisRanges::new(self.lesson);
        for page in &self.lesson.pages {
            walk.enter(page, go_on)?;
            let asks = page.predicts().next().is_some();
            // After the first question a picture could show what came out.
            let may_be_seen = self.paper == Paper::Results || !has_asked || asks;
            let picture = may_be_seen
                .then(|| self.picture(page, &walk.lab, &mut ranges, go_on))
                .flatten();
            if self.paper == Paper::Worksheet && has_asked {
                parts.extend(blank_page(page, picture));
            } else {
                parts.extend(self.told_page(page, &walk, picture));
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

    /// Returns a page with its words and numbers; on a worksheet, those up to its question.
    fn told_page(
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
                other => parts.extend(told(other, walk)),
            }
        }
        if blocks.len() < page.blocks.len() {
            parts.extend(page.predicts().skip(1).map(blank_question));
        }
        parts
    }

    /// Returns what the lab shows on `page`, if its block makes the lab do something.
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

/// Returns a page of a worksheet after the first prediction: what is asked and what is to be done, and room for the
/// rest.
fn blank_page(page: &LessonPage, mut picture: Option<Part>) -> Vec<Part> {
    let mut parts = vec![Part::Heading(page.heading.clone())];
    let asks = page.predicts().next().is_some();
    // What is to be typed says what to do, unless the page compares it with a prediction.
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

/// Gives the questions that `page` compares with what came out their axes: by then it is known how long that takes.
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

/// Returns the page on which `walk` stands as Markdown, with the lab's screen even where the page itself makes the lab do
/// nothing.
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
            other => parts.extend(told(other, walk)),
        }
    }
    markdown::of_parts(&parts)
}

/// Returns whether it is a command to be typed.
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

/// Returns a question of which no number is told.
fn blank_question(predict: &Predict) -> Part {
    question(predict, predict.ask.filled(|_, _| BLANK.to_owned()), true)
}

fn joined(parts: &[String]) -> String {
    parts.join("\n\n") + "\n"
}

/// What stands above the first page.
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
        introduction: introduction.filter_map(|block| told(block, walk)).collect(),
    }
}

fn told(block: &LessonBlock, walk: &LessonWalk<'_>) -> Option<Part> {
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

/// Returns the comparison with room for the prediction.
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
