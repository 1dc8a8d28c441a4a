//! What a student predicted in a lesson beside what came out, to hand in.

use super::lesson::{Block, Compare, Lesson, Page, Predict};
use super::play::{GoOn, Walk};
use super::predictions::Place;
use crate::lab::Lab;
use crate::scenario::Problem;

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
        parts.extend(of_page(lesson, page, place, &walk));
        walk.leave(page, go_on)?;
    }
    parts.push(format!("gyrolab {}", env!("CARGO_PKG_VERSION")));
    Ok(parts.join("\n\n") + "\n")
}

/// The heading of a page, with what was asked and what came out; nothing where the page has neither.
fn of_page(lesson: &Lesson, page: &Page, place: &Place, walk: &Walk<'_>) -> Vec<String> {
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
