//! A lesson on paper: Markdown with the pictures as text and room for predictions.
//!
//! The numbers in the text are those of the run. What a prediction is compared with is left blank, as is the prediction:
//! the student writes both down. Notes are left out, and so is how a task is done.

use super::lesson::{Asked, Block, Compare, Lesson, Page, Predict, Shown};
use super::names::{self, Kept};
use super::play::{GoOn, Walk};
use super::predictions::{PREDICTION, WITH};
use crate::lab::Lab;
use crate::scenario::Problem;

/// Room for a number or some words.
const BLANK: &str = "____________";

/// The handout of `lesson`, played in a new `lab`; `picture` is the lab's picture as text.
pub fn handout(
    lesson: &Lesson,
    lab: Lab,
    picture: &dyn Fn(&Lab) -> String,
    go_on: GoOn<'_>,
) -> Result<String, Problem> {
    let mut walk = Walk::new(lesson, lab);
    let mut parts = head(lesson, &walk);
    for page in &lesson.pages {
        walk.enter(page, go_on)?;
        parts.extend(paper(page, &walk, picture));
        if page.number < lesson.pages.len() {
            walk.leave(page, go_on)?;
        }
    }
    Ok(joined(&parts))
}

/// One page, as in the handout, and with the picture even where the page itself makes the lab do nothing; `walk` stands on
/// it.
pub fn page(page: &Page, walk: &Walk<'_>, picture: &dyn Fn(&Lab) -> String) -> String {
    let mut parts = paper(page, walk, picture);
    if page.lab().is_none() {
        parts.insert(1, fenced("text", &picture(&walk.lab)));
    }
    joined(&parts)
}

fn joined(parts: &[String]) -> String {
    parts.join("\n\n") + "\n"
}

fn head(lesson: &Lesson, walk: &Walk<'_>) -> Vec<String> {
    let mut parts = vec![format!("# {}", lesson.title)];
    let minutes = lesson
        .minutes
        .map(|minutes| format!("About {minutes} minutes."));
    let told = Some(lesson.about.clone()).filter(|about| !about.is_empty());
    let told: Vec<_> = told.into_iter().chain(minutes).collect();
    parts.push(told.join(" "));
    parts.extend(
        lesson
            .introduction
            .iter()
            .filter_map(|block| on_paper(block, walk)),
    );
    parts.retain(|part| !part.is_empty());
    parts
}

/// The parts of a page, with a blank line between each and the next.
fn paper(page: &Page, walk: &Walk<'_>, picture: &dyn Fn(&Lab) -> String) -> Vec<String> {
    let mut parts = vec![format!("## {}", page.heading)];
    for block in &page.blocks {
        match block {
            Block::Lab(_) => parts.push(fenced("text", &picture(&walk.lab))),
            other => parts.extend(on_paper(other, walk)),
        }
    }
    parts
}

fn on_paper(block: &Block, walk: &Walk<'_>) -> Option<String> {
    let (lab, kept) = (&walk.lab, &walk.kept);
    match block {
        Block::Text(text) => Some(text.with_numbers(lab, kept)),
        Block::Predict(predict) => Some(room_for(predict, lab, kept)),
        Block::Compare(compare) => Some(blanked(compare, lab, kept)),
        Block::Check(check) if !check.hint.is_empty() => Some(format!("Hint: {}", check.hint)),
        Block::Shown(Shown { language, text }) => Some(fenced(language, text)),
        Block::Lab(_) | Block::Task(_) | Block::Check(_) | Block::Notes(_) => None,
    }
}

fn room_for(predict: &Predict, lab: &Lab, kept: &Kept) -> String {
    let ask = predict.ask.with_numbers(lab, kept);
    let room: Vec<_> = match &predict.asked {
        Asked::Choice(choices) => choices
            .iter()
            .map(|choice| format!("- [ ] {choice}"))
            .collect(),
        Asked::Number { unit } => vec![format!("{BLANK} {unit}").trim_end().to_owned()],
    };
    format!("**Prediction.** {ask}\n\n{}", room.join("\n"))
}

/// The comparison with room for the number that came out and for the prediction.
fn blanked(compare: &Compare, lab: &Lab, kept: &Kept) -> String {
    compare.text.filled(|expression, format| {
        let is_answer = |name| [WITH, PREDICTION].contains(&name);
        if expression.names().any(is_answer) {
            BLANK.to_owned()
        } else {
            format.written(names::value(expression, lab, kept))
        }
    })
}

/// `text` between fences that do not occur in it.
fn fenced(language: &str, text: &str) -> String {
    let longest = text
        .lines()
        .map(|line| line.chars().take_while(|c| *c == '`').count());
    let fence = "`".repeat(longest.max().unwrap_or(0).max(2) + 1);
    format!(
        "{fence}{language}\n{}\n{fence}",
        text.trim_end_matches('\n')
    )
}
