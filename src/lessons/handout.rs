//! A lesson on paper, as Markdown with the pictures as text: a worksheet, which asks and has room for what is predicted and
//! seen, or the results for afterwards; and what a student predicted beside what came out, to hand in.
//!
//! A worksheet tells nothing that answers a prediction: from the first one on, numbers in text are blanks to be filled in
//! from the screen, and the pages that show what came out have room in the place of their words. Notes are left out, and
//! so is how a task is done.

use super::lesson::{
    AnswerKind, CodeBlock, Compare, Lesson, LessonBlock, LessonPage, PREDICTION, Predict, Right,
    WITH,
};
use super::names::{self, KeptNumbers};
use super::play::{LessonProgressCallback, LessonWalk};
use super::predictions::{LessonProgress, Tried};
use crate::engine::scenario::Problem;
use crate::lab::Lab;

/// Room for a number or some words.
const BLANK: &str = "____________";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paper {
    Worksheet,
    Results,
}

/// `paper` of `lesson`, played in a new `lab`; `picture` is the lab's picture as text.
pub fn handout(
    lesson: &Lesson,
    paper: Paper,
    lab: Lab,
    picture: &dyn Fn(&Lab) -> String,
    go_on: LessonProgressCallback<'_>,
) -> Result<String, Problem> {
    let mut walk = LessonWalk::new(lesson, lab);
    let mut parts = head(lesson, &walk);
    let mut has_asked = false;
    for page in &lesson.pages {
        walk.enter(page, go_on)?;
        if paper == Paper::Worksheet && has_asked {
            parts.extend(blank_page(page, &walk, picture));
        } else {
            let mut all = page.blocks.iter();
            let blocks = match all.position(|block| matches!(block, LessonBlock::Predict(_))) {
                Some(asked) if paper == Paper::Worksheet => &page.blocks[..=asked],
                _ => &page.blocks,
            };
            parts.extend(on_pages(page, blocks, &walk, picture));
            has_asked |= page.predicts().next().is_some();
            if blocks.len() < page.blocks.len() {
                parts.extend(page.predicts().skip(1).map(room_for_blank));
            }
        }
        if page.number < lesson.pages.len() {
            walk.leave(page, go_on)?;
        }
    }
    Ok(joined(&parts))
}

/// Returns a page of a worksheet after the first prediction: what is asked and what is to be done, and room for the rest.
fn blank_page(
    page: &LessonPage,
    walk: &LessonWalk<'_>,
    picture: &dyn Fn(&Lab) -> String,
) -> Vec<String> {
    let mut parts = vec![format!("## {}", page.heading)];
    let asks = page.predicts().next().is_some();
    // What is to be typed says what to do, unless the page compares it with a prediction.
    let is_typed = page.blocks.iter().any(is_shell) && page.compares().next().is_none();
    let is_done = is_typed || page.task().is_some();
    let tells = !asks && !is_done && page.checks().next().is_none();
    let mut is_before = true;
    for block in &page.blocks {
        match block {
            LessonBlock::Lab(_) if asks => parts.push(fenced("text", &picture(&walk.lab))),
            LessonBlock::Lab(_) => is_before = false,
            LessonBlock::Text(text) if is_done || is_before && (!tells || page.lab().is_some()) => {
                parts.push(text.filled(|_, _| BLANK.to_owned()));
            }
            LessonBlock::Predict(predict) => {
                parts.push(room_for_blank(predict));
                is_before = false;
            }
            LessonBlock::Compare(_) => {
                parts.push(format!("Predicted: {BLANK}\n\nCame out: {BLANK}{BLANK}"));
            }
            LessonBlock::Check(check) => {
                parts.extend(check.goals.iter().map(|goal| format!("- [ ] {goal}")));
            }
            LessonBlock::Shown(CodeBlock { language, text }) if !tells || is_shell(block) => {
                parts.push(fenced(language, text));
            }
            _ => {}
        }
    }
    if tells {
        parts.push(format!("Why: {BLANK}{BLANK}{BLANK}"));
    }
    parts
}

/// Returns whether it is a command to be typed.
fn is_shell(block: &LessonBlock) -> bool {
    matches!(block, LessonBlock::Shown(code) if code.language == "sh")
}

/// Returns a question of which no number is told.
fn room_for_blank(predict: &Predict) -> String {
    asked(predict, &predict.ask.filled(|_, _| BLANK.to_owned()))
}

/// One page, as in the handout, and with the picture even where the page itself makes the lab do nothing; `walk` stands on
/// it.
pub fn page(page: &LessonPage, walk: &LessonWalk<'_>, picture: &dyn Fn(&Lab) -> String) -> String {
    let mut parts = on_pages(page, &page.blocks, walk, picture);
    if page.lab().is_none() {
        parts.insert(1, fenced("text", &picture(&walk.lab)));
    }
    joined(&parts)
}

fn joined(parts: &[String]) -> String {
    parts.join("\n\n") + "\n"
}

fn head(lesson: &Lesson, walk: &LessonWalk<'_>) -> Vec<String> {
    let mut parts = vec![format!("# {}", lesson.title)];
    let minutes = lesson.minutes.map(|it| format!("About {it} minutes."));
    let about = format!("{} {}", lesson.about, minutes.unwrap_or_default());
    parts.push(about.trim().to_owned());
    let introduction = lesson.introduction.iter();
    parts.extend(introduction.filter_map(|block| on_paper(block, walk)));
    parts.retain(|part| !part.is_empty());
    parts
}

/// Returns the parts of a page with these of its `blocks`, with a blank line between each and the next.
fn on_pages(
    page: &LessonPage,
    blocks: &[LessonBlock],
    walk: &LessonWalk<'_>,
    picture: &dyn Fn(&Lab) -> String,
) -> Vec<String> {
    let mut parts = vec![format!("## {}", page.heading)];
    for block in blocks {
        match block {
            LessonBlock::Lab(_) => parts.push(fenced("text", &picture(&walk.lab))),
            other => parts.extend(on_paper(other, walk)),
        }
    }
    parts
}

fn on_paper(block: &LessonBlock, walk: &LessonWalk<'_>) -> Option<String> {
    let (lab, kept) = (&walk.lab, &walk.kept);
    match block {
        LessonBlock::Text(text) => Some(text.with_numbers(lab, kept)),
        LessonBlock::Predict(predict) => Some(room_for(predict, lab, kept)),
        LessonBlock::Compare(compare) => Some(blanked(compare, lab, kept)),
        LessonBlock::Check(check) if !check.hint.is_empty() => {
            Some(format!("Hint: {}", check.hint))
        }
        LessonBlock::Shown(CodeBlock { language, text }) => Some(fenced(language, text)),
        _ => None,
    }
}

fn room_for(predict: &Predict, lab: &Lab, kept: &KeptNumbers) -> String {
    asked(predict, &predict.ask.with_numbers(lab, kept))
}

/// Returns the question `ask` with a box for each choice, or room for a number.
fn asked(predict: &Predict, ask: &str) -> String {
    let room: Vec<_> = match &predict.asked {
        AnswerKind::Choice(choices) => (1..)
            .zip(choices)
            .map(|(number, choice)| format!("- [ ] {number} {choice}"))
            .collect(),
        AnswerKind::Number { unit } => vec![format!("{BLANK} {unit}").trim_end().to_owned()],
    };
    format!("**Prediction.** {ask}\n\n{}", room.join("\n"))
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

/// `text` between fences that do not occur in it.
fn fenced(language: &str, text: &str) -> String {
    let ticks = text
        .lines()
        .map(|line| line.len() - line.trim_start_matches('`').len());
    let fence = "`".repeat(ticks.max().unwrap_or(0).max(2) + 1);
    format!(
        "{fence}{language}\n{}\n{fence}",
        text.trim_end_matches('\n')
    )
}

/// Returns the predictions of `place` beside what came out of `lesson`, which is played in a new `lab`; as Markdown.
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

/// Returns the heading of a page, with what was asked, what came out and what became of its task; nothing where it has
/// none of these.
fn answers_of(
    lesson: &Lesson,
    page: &LessonPage,
    place: &LessonProgress,
    walk: &LessonWalk<'_>,
) -> Vec<String> {
    let told = page.blocks.iter().filter_map(|block| match block {
        LessonBlock::Predict(predict) => predicted(predict, place, walk),
        LessonBlock::Compare(compare) => came_out(lesson, compare, place, walk),
        _ => None,
    });
    let mut parts: Vec<_> = told.collect();
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

/// Returns the question with what was predicted; nothing where nothing was.
fn predicted(predict: &Predict, place: &LessonProgress, walk: &LessonWalk<'_>) -> Option<String> {
    let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
    let answer = place.predictions.in_words(predict)?;
    Some(format!("**Question.** {ask}\n\n**Predicted.** {answer}"))
}

/// Returns what came out; nothing where nothing was predicted: it would give the answer away.
fn came_out(
    lesson: &Lesson,
    compare: &Compare,
    place: &LessonProgress,
    walk: &LessonWalk<'_>,
) -> Option<String> {
    let predict = lesson.predict(&compare.prediction)?;
    place.predictions.to(predict).next()?;
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
