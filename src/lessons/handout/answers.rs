//! A student's predictions with their outcomes, to hand in.

use super::joined;
use crate::engine::scenario::Problem;
use crate::lab::Lab;
use crate::lessons::lesson::{
    AnswerKind, Compare, Lesson, LessonBlock, LessonPage, Predict, Right,
};
use crate::lessons::play::{LessonProgressCallback, LessonWalk};
use crate::lessons::predictions::{LessonProgress, Tried};

/// Returns the predictions in `place` with the outcomes of `lesson`, which is played in a new `lab`, as Markdown.
///
/// # Errors
///
/// Returns an error if a page cannot be played.
pub fn answers(
    lesson: &Lesson,
    place: &LessonProgress,
    lab: Lab,
    go_on: LessonProgressCallback<'_>,
) -> Result<String, Problem> {
    let mut walk = LessonWalk::new(lesson, lab);
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

/// Returns the heading of a page with its predictions, their outcomes, and the progress of its task. Returns nothing if
/// the page has none of these.
fn answers_of(
    lesson: &Lesson,
    page: &LessonPage,
    place: &LessonProgress,
    walk: &LessonWalk<'_>,
) -> Vec<String> {
    let entries = page.blocks.iter().filter_map(|block| match block {
        LessonBlock::Predict(predict) => predicted(predict, place, walk),
        LessonBlock::Compare(compare) => came_out(lesson, compare, place, walk),
        _ => None,
    });
    let mut parts: Vec<_> = entries.collect();
    if page.task().is_some() {
        let tried = Tried::words(place.tasks.get(&page.heading));
        let checks = page.checks();
        let goals: Vec<_> = checks.flat_map(|check| check.goals.clone()).collect();
        let task = format!("**Task.** {}: {tried}", goals.join(", "));
        parts.push(task.replace("** :", "**"));
    }
    if !parts.is_empty() {
        parts.insert(0, format!("## {}", page.heading));
    }
    parts
}

/// Returns the question with the prediction, if one was made.
fn predicted(predict: &Predict, place: &LessonProgress, walk: &LessonWalk<'_>) -> Option<String> {
    let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
    let answer = place.predictions.in_words(predict)?;
    Some(format!("**Question.** {ask}\n\n**Predicted.** {answer}"))
}

/// Returns the outcome.
///
/// Without a prediction there is none. If the student has not seen the page yet, a note replaces the outcome, which
/// would give the answer away.
fn came_out(
    lesson: &Lesson,
    compare: &Compare,
    place: &LessonProgress,
    walk: &LessonWalk<'_>,
) -> Option<String> {
    let predict = lesson.predict(&compare.prediction)?;
    place.predictions.to(predict).next()?;
    if !place.seen.contains(&compare.prediction) {
        return Some("**Came out.** You have not seen this page yet.".to_owned());
    }
    let text = compare.filled(lesson, &place.predictions, &walk.lab, &walk.kept);
    let right = match (&predict.asked, &predict.right) {
        (AnswerKind::Choice(choices), Some(Right::Choice(right))) => choices.get(right - 1),
        _ => None,
    };
    Some(match right {
        Some(choice) => format!("**Came out.** {choice}. {text}"),
        None => format!("**Came out.** {text}"),
    })
}
