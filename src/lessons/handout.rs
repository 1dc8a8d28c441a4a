//! A lesson on paper: Markdown with the pictures as text and room for predictions; and what a student predicted beside
//! what came out, to hand in.
//!
//! The numbers in the text are those of the run. What a prediction is compared with is left blank, as is the prediction:
//! the student writes both down. Notes are left out, and so is how a task is done.

use super::lesson::{Asked, Block, Compare, Lesson, Page, Predict, Shown};
use super::names::{self, Kept};
use super::play::{GoOn, Walk};
use super::predictions::{PREDICTION, Place, WITH};
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

/// The predictions of `place` beside what came out of `lesson`, which is played in a new `lab`; as Markdown.
pub fn answers(
    lesson: &Lesson,
    place: &Place,
    lab: Lab,
    go_on: GoOn<'_>,
) -> Result<String, Problem> {
    let mut walk = Walk::new(lesson, lab);
    let pages = lesson.pages.len();
    let mut parts = vec![
        format!("# {}", lesson.title),
        format!("Left at page {} of {pages}.", place.page),
    ];
    for page in &lesson.pages {
        walk.enter(page, go_on)?;
        parts.extend(answers_of(lesson, page, place, &walk));
        walk.leave(page, go_on)?;
    }
    parts.push(format!("gyrolab {}", env!("CARGO_PKG_VERSION")));
    Ok(joined(&parts))
}

/// The heading of a page, with what was asked and what came out; nothing where the page has neither.
fn answers_of(lesson: &Lesson, page: &Page, place: &Place, walk: &Walk<'_>) -> Vec<String> {
    let told = page.blocks.iter().filter_map(|block| match block {
        Block::Predict(predict) => predicted(predict, place, walk),
        Block::Compare(compare) => came_out(lesson, compare, place, walk),
        _ => None,
    });
    let mut parts: Vec<_> = told.collect();
    if !parts.is_empty() {
        parts.insert(0, format!("## {}", page.heading));
    }
    parts
}

/// The question with what was predicted; nothing where nothing was.
fn predicted(predict: &Predict, place: &Place, walk: &Walk<'_>) -> Option<String> {
    let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
    let answer = place.predictions.answer(&predict.name)?;
    let answer = answer.in_words(predict);
    Some(format!("**Question.** {ask}\n\n**Predicted.** {answer}"))
}

/// What came out; nothing where nothing was predicted: it would give the answer away.
fn came_out(lesson: &Lesson, compare: &Compare, place: &Place, walk: &Walk<'_>) -> Option<String> {
    place.predictions.answer(&compare.prediction)?;
    let text = compare.filled(lesson, &place.predictions, &walk.lab, &walk.kept);
    Some(format!("**Came out.** {text}"))
}
