//! A handout as Markdown.

use super::{BLANK, Head, Paper, Part, Question, joined};
use crate::lessons::lesson::AnswerKind;

/// Returns the whole handout.
pub(super) fn written(head: &Head, parts: &[Part], paper: Paper) -> String {
    let mut all = vec![format!("# {}", head.title), head.about.clone()];
    if paper == Paper::Worksheet {
        all.push(format!("Name: {BLANK} Seat: {BLANK} Date: {BLANK}"));
    }
    all.extend(head.introduction.iter().map(part));
    all.extend(parts.iter().map(part));
    all.retain(|text| !text.is_empty());
    joined(&all)
}

pub(super) fn of_parts(parts: &[Part]) -> String {
    let texts: Vec<String> = parts.iter().map(part).collect();
    joined(&texts)
}

fn part(part: &Part) -> String {
    match part {
        Part::Heading(heading) => format!("## {heading}"),
        Part::Text(text) => text.clone(),
        Part::Shown(code) => fenced(&code.language, &code.text),
        Part::Screen(text) => fenced("text", text),
        // Figures are drawn for HTML only.
        Part::Figures(_) => String::new(),
        Part::Question(asked) => question(asked),
        Part::Goals(goals) => {
            let boxes: Vec<String> = goals.iter().map(|goal| format!("- [ ] {goal}")).collect();
            boxes.join("\n")
        }
        Part::Compared => format!("Predicted: {BLANK}\n\nCame out: {BLANK}{BLANK}"),
        Part::Why => format!("Why: {BLANK}{BLANK}{BLANK}"),
        Part::OwnWords => format!("In your own words: {BLANK}{BLANK}{BLANK}"),
    }
}

/// Returns the question with a box for each choice, or with a blank for a number.
fn question(question: &Question) -> String {
    let room: Vec<String> = match &question.asked {
        AnswerKind::Choice(choices) => (1..)
            .zip(choices)
            .map(|(number, choice)| format!("- [ ] {number} {choice}"))
            .collect(),
        AnswerKind::Number { unit } => vec![format!("{BLANK} {unit}").trim_end().to_owned()],
    };
    let mut text = format!("**Prediction.** {}\n\n{}", question.ask, room.join("\n"));
    if question.has_room {
        text += &format!("\n\nReason: {BLANK}{BLANK}{BLANK}");
    }
    text
}

/// Returns `text` between fences that do not occur in it.
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
