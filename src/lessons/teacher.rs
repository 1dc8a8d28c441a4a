//! The teacher's sheet, as Markdown: the goals of a lesson, the minutes of each page, the questions, their outcomes,
//! and common wrong answers.

use super::lesson::{AnswerKind, Compare, Lesson, LessonPage, Predict, Right};
use super::play::{LessonProgressCallback, LessonWalk};
use super::predictions::Predictions;
use crate::engine::scenario::Problem;
use crate::engine::text::number::shortest;
use crate::lab::Lab;
use crate::lab::command::{Command, SET};
use std::collections::BTreeMap;
use toml::{Table, Value};

const HOW_TO_VOTE: &str = "Below 30 % right: explain, then ask again. From 30 to 70 %: let neighbors talk, then ask again. \
    Above 70 %: go on.";

/// A page on the sheet: its questions and tasks, and the notes.
struct SheetPage<'a> {
    page: &'a LessonPage,
    asked: Vec<String>,
    notes: Vec<String>,
}

/// Returns the teacher's sheet of `lesson`, which is played in a new `lab`.
///
/// # Errors
///
/// Returns an error if a page cannot be played.
pub fn sheet(
    lesson: &Lesson,
    lab: Lab,
    go_on: LessonProgressCallback<'_>,
) -> Result<String, Problem> {
    let mut walk = LessonWalk::new(lesson, lab);
    let mut pages = Vec::new();
    let mut outcomes: BTreeMap<&str, String> = BTreeMap::new();
    for page in &lesson.pages {
        walk.enter(page, go_on)?;
        for compare in page.compares() {
            outcomes.insert(&compare.prediction, outcome(lesson, compare, &walk));
        }
        let questions = page.predicts().map(|predict| asked(predict, &walk));
        let notes = page.notes().map(|notes| {
            let text = notes.with_numbers(&walk.lab, &walk.kept);
            format!("*Note.* {}", text.trim())
        });
        pages.push(SheetPage {
            page,
            asked: questions.chain(task(page)).collect(),
            notes: notes.collect(),
        });
        if page.number < lesson.pages.len() {
            walk.leave(page, go_on)?;
        }
    }
    let mut parts = head(lesson);
    parts.push(table(lesson));
    parts.push("## Questions and tasks".to_owned());
    parts.push(HOW_TO_VOTE.to_owned());
    for SheetPage { page, asked, notes } in pages {
        if asked.is_empty() && notes.is_empty() {
            continue;
        }
        parts.push(format!("### Page {}: {}", page.number, page.heading));
        parts.extend(asked);
        for predict in page.predicts() {
            let came_out = outcomes.get(predict.name.as_str());
            parts.extend(expectation(predict, came_out));
        }
        parts.extend(notes);
    }
    let left_out = &lesson.guide.leaves_out;
    parts.extend(listed("What the model leaves out", left_out));
    Ok(parts.join("\n\n") + "\n")
}

/// Returns the title, and the information of the `lesson` block.
fn head(lesson: &Lesson) -> Vec<String> {
    let mut parts = vec![format!("# Teacher's sheet: {}", lesson.title)];
    let level = lesson
        .guide
        .level
        .map(|level| format!("Level: {}.", level.name()));
    let minutes = lesson.minutes.map(|minutes| format!("{minutes} minutes."));
    let needs = lesson.guide.needs_in_words().map(|needs| needs + ".");
    let about = Some(lesson.about.clone()).filter(|about| !about.is_empty());
    let words: Vec<String> = [about, level, minutes, needs]
        .into_iter()
        .flatten()
        .collect();
    parts.extend((!words.is_empty()).then(|| words.join(" ")));
    parts.extend(listed("Goals", &lesson.guide.goals));
    parts
}

/// Returns a heading and a list, or nothing if there are no items.
fn listed(heading: &str, items: &[String]) -> Vec<String> {
    if items.is_empty() {
        return Vec::new();
    }
    let lines: Vec<String> = items.iter().map(|item| format!("- {item}")).collect();
    vec![format!("## {heading}"), lines.join("\n")]
}

/// Returns the table of pages with their minutes and contents.
fn table(lesson: &Lesson) -> String {
    let mut rows = vec![
        "| Page | Heading | Minutes | What happens |".to_owned(),
        "|---:|---|---:|---|".to_owned(),
    ];
    for page in &lesson.pages {
        let minutes = lesson.guide.page_minutes.get(page.number - 1);
        let what = if page.predicts().next().is_some() {
            "question"
        } else if page.task().is_some() {
            "task"
        } else if page.compares().next().is_some() {
            "outcome"
        } else {
            ""
        };
        rows.push(format!(
            "| {} | {} | {} | {what} |",
            page.number,
            page.heading.replace('|', "\\|"),
            minutes.map_or(String::new(), u32::to_string),
        ));
    }
    format!("## Pages\n\n{}", rows.join("\n"))
}

/// Returns the question with its choices. The right one is marked.
fn asked(predict: &Predict, walk: &LessonWalk<'_>) -> String {
    let ask = predict.ask.with_numbers(&walk.lab, &walk.kept);
    let mut text = format!("**Question.** {ask}");
    if let AnswerKind::Choice(choices) = &predict.asked {
        for (number, choice) in (1..).zip(choices) {
            text += if number == 1 { "\n\n" } else { "\n" };
            text += &match predict.right {
                Some(Right::Choice(right)) if right == number => {
                    format!("{number}. **{choice}** (right)")
                }
                _ => format!("{number}. {choice}"),
            };
        }
    }
    text
}

/// Returns the outcome, the answers to expect, and the explanation.
fn expectation(predict: &Predict, came_out: Option<&String>) -> Vec<String> {
    let number = match (&predict.asked, &predict.right) {
        (AnswerKind::Number { unit }, Some(Right::Number { value, within })) => {
            let (value, within) = (shortest(*value), shortest(*within));
            format!("{value} {unit}, to within {within}. ")
        }
        _ => String::new(),
    };
    // A choice without a right answer is a matter of opinion.
    let is_opinion = predict.right.is_none() && matches!(predict.asked, AnswerKind::Choice(_));
    let explain = if is_opinion {
        "Discuss."
    } else {
        "Below 30 %."
    };
    let labeled = [
        ("Comes out.", came_out.map(|text| number + text)),
        ("Expect.", Some(predict.expected.clone())),
        (explain, Some(predict.explain.clone())),
    ];
    labeled
        .into_iter()
        .filter_map(|(label, text)| Some((label, text.filter(|text| !text.is_empty())?)))
        .map(|(label, text)| format!("**{label}** {text}"))
        .collect()
}

/// Returns the outcome in words, without the sentence about a prediction.
fn outcome(lesson: &Lesson, compare: &Compare, walk: &LessonWalk<'_>) -> String {
    compare.filled(lesson, &Predictions::default(), &walk.lab, &walk.kept)
}

/// Returns the goals of the page's task, and one way to do it.
fn task(page: &LessonPage) -> Option<String> {
    let task = page.task()?;
    let goals: Vec<&str> = page
        .checks()
        .flat_map(|check| check.goals.iter().map(String::as_str))
        .collect();
    let opened: Vec<Table> = page
        .lab()
        .iter()
        .flat_map(|lab| &lab.commands)
        .map(|placed| placed.command.to_table())
        .collect();
    let commands = task.commands.iter();
    let solution: Vec<String> = commands
        .flat_map(|placed| changes(&placed.command, &opened))
        .collect();
    let mut text = format!("**Task.** {}.", goals.join("; "));
    if !solution.is_empty() {
        text += &format!(" One way (`h` twice shows it): {}.", solution.join(", "));
    }
    Some(text)
}

/// Returns the changes that `command` of a task makes, compared with the commands `opened` of its page.
fn changes(command: &Command, opened: &[Table]) -> Vec<String> {
    match command {
        Command::Set(keys) | Command::Rerun(keys) => {
            let before = opened.iter().filter_map(|table| table.get(SET)?.as_table());
            let same =
                |key: &str, value: &Value| before.clone().any(|set| set.get(key) == Some(value));
            let changed = keys.iter().filter(|(key, value)| !same(key, value));
            changed
                .map(|(key, value)| format!("`{key} = {value}`"))
                .collect()
        }
        Command::Push(_) => {
            let table = command.to_table();
            let words = table
                .iter()
                .map(|(name, value)| format!("`{name} = {value}`"));
            words.collect()
        }
        _ => Vec::new(),
    }
}
