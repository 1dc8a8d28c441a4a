//! The TOML in the blocks of a lesson.

mod content;

use super::lesson::{AnswerKind, Check, Compare, Keep, LessonBlock, Predict, Right, Setup};
use super::names::KeptNames;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::Problem;
use crate::engine::scenario::dotted::join;
use crate::engine::text::printable::is_steering;
use crate::lab::command::{COMMANDS, Command, LocatedCommand};
use crate::lab::view;
use content::BlockContent;
use toml::{Table, Value};

/// The words behind a fence that mean something in a lesson.
pub(super) const BLOCK_WORDS: [&str; 7] = [
    "lesson", "lab", "task", "predict", "compare", "check", "notes",
];

/// The keys of `lab` and `task` besides those of `[view]`. They are carried out in the order of the table of commands, the
/// last at the end.
const COMMON: [&str; 6] = ["open", "set", "push", "since_s", "magnify", "point_at"];
const LAST_COMMANDS: [&str; 2] = ["wait_s", "go_to"];
const RUN_UNTIL: &str = "run_until";
const KEEP_KEY: &str = "keep";
/// The most choices of a prediction.
const MOST_CHOICES: usize = 9;
const LONGEST_LESSON: u32 = 600;

type BlockResult<T> = Result<T, Vec<Problem>>;

/// A block of the file `origin`.
pub(super) struct BlockReader<'a> {
    pub origin: String,
    /// The word behind its fence.
    pub word: &'a str,
    /// What stands between its fences.
    pub inside: &'a str,
    /// The line of its fence.
    pub line: usize,
}

fn expression(
    text: &str,
    is_condition: bool,
    find: impl Fn(&str) -> Result<(), String>,
) -> Result<Expression, String> {
    let read = if is_condition {
        Expression::condition(text)
    } else {
        Expression::parse(text)
    };
    let read = read.map_err(|fault| fault.to_string())?;
    read.bind(find).map_err(|fault| fault.to_string())?;
    if read.is_condition() && !is_condition {
        Err("compares: a number must stand here".to_owned())
    } else {
        Ok(read)
    }
}

/// What the lesson is about, and how many minutes it takes.
pub(super) fn head(reader: &BlockReader<'_>) -> BlockResult<(String, Option<u32>)> {
    let mut content = reader.content(&["about", "minutes"])?;
    let about = content.line("about", false);
    let stated = content.get("minutes");
    let minutes = stated.as_ref().and_then(|value| {
        let whole = u32::try_from(value.as_integer()?).ok()?;
        Some(whole).filter(|minutes| (1..=LONGEST_LESSON).contains(minutes))
    });
    if let (Some(value), None) = (stated, minutes) {
        let rule = format!("must be a whole number from 1 to {LONGEST_LESSON}");
        content.refuse(Problem::with_value("minutes", &value, rule));
    }
    content.finish((about, minutes))
}

/// What the lab does: a `lab` or `task` block of page `page`, whose kept numbers are known from the page `known_from` on.
pub(super) fn setup(
    reader: &BlockReader<'_>,
    names: &mut KeptNames,
    page: usize,
    known_from: usize,
) -> BlockResult<Setup> {
    let rows = COMMANDS.iter().map(|row| row.name);
    let rows = rows.filter(|name| COMMON.contains(name) || view::is_key(name));
    let order: Vec<_> = rows.chain(LAST_COMMANDS).chain([RUN_UNTIL]).collect();
    let known: Vec<_> = order.iter().copied().chain([KEEP_KEY]).collect();
    let mut content = reader.content(&known).inspect_err(|_| names.lose())?;
    let mut commands = Vec::new();
    for name in order {
        let Some(value) = content.get(name) else {
            continue;
        };
        match Command::new(name, &value) {
            Ok(command) => commands.push(LocatedCommand {
                command,
                line: Some(content.line_of(name)),
            }),
            Err(problems) => problems
                .into_iter()
                .for_each(|problem| content.refuse_in(name, problem)),
        }
    }
    if content.get("go_to").is_some() && content.get(RUN_UNTIL).is_some() {
        let rule = "has no place beside go_to: one of the two ends a block";
        content.refuse(Problem::at(RUN_UNTIL, rule));
    }
    let keep = keep(&mut content, names, page, known_from);
    content.finish(Setup {
        line: reader.line,
        commands,
        keep,
    })
}

fn keep(
    content: &mut BlockContent,
    names: &mut KeptNames,
    page: usize,
    known_from: usize,
) -> Vec<Keep> {
    let table = match content.get(KEEP_KEY) {
        None => return Vec::new(),
        Some(Value::Table(table)) => table,
        Some(other) => {
            let rule = "must be a table of names and expressions, { coarse = \"most_distance_m\" }";
            content.refuse(Problem::with_value(KEEP_KEY, &other, rule));
            Table::new()
        }
    };
    // What is kept at the same time is not known yet to each other.
    let earlier = names.clone();
    let mut kept = Vec::new();
    for (name, value) in table {
        let key = join(KEEP_KEY, &name);
        if let Err(rule) = names.keep(&name, known_from) {
            content.refuse(Problem::at(key, rule));
            continue;
        }
        let read = match value.as_str() {
            None => Err("must be an expression in quotes".to_owned()),
            Some(text) => expression(text, false, |name| earlier.find(name, page)),
        };
        match read {
            Ok(expression) => kept.push(Keep { name, expression }),
            Err(rule) => content.refuse(Problem::with_value(key, &value, rule)),
        }
    }
    kept
}

/// A block that stands on a page as often as one likes.
pub(super) fn block(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<LessonBlock> {
    match reader.word {
        "predict" => predict(reader, find).map(LessonBlock::Predict),
        "compare" => compare(reader, find).map(LessonBlock::Compare),
        _ => check(reader, find).map(LessonBlock::Check),
    }
}

fn predict(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Predict> {
    let mut content = reader.content(&["name", "ask", "choices", "unit", "right", "within"])?;
    let name = content.needed("name", false, "compare calls the prediction by it");
    let ask = content.text("ask", "the question", find);
    let asked = match (content.get("choices"), content.get("unit")) {
        (Some(_), Some(_)) => {
            let rule = "has no place beside choices: a choice has no unit";
            content.refuse(Problem::at("unit", rule));
            AnswerKind::Choice(Vec::new())
        }
        (Some(value), None) => AnswerKind::Choice(choices(&mut content, &value)),
        (None, Some(Value::String(unit))) if unit.is_empty() => AnswerKind::Number { unit },
        (None, Some(_)) => AnswerKind::Number {
            unit: content.line("unit", false),
        },
        (None, None) => {
            content.refuse_whole(
                "lacks choices = [\"...\", \"...\"], or unit = \"deg\" where a number is asked for",
            );
            AnswerKind::Choice(Vec::new())
        }
    };
    let right = right(&mut content, &asked);
    content.finish(Predict {
        line: reader.line,
        name,
        ask,
        asked,
        right,
    })
}

/// The number of the right choice; or the right number, and how far off an answer may be.
fn right(content: &mut BlockContent, asked: &AnswerKind) -> Option<Right> {
    let (right, within) = (content.get("right"), content.get("within"));
    let key = if right.is_some() { "right" } else { "within" };
    let value = right.as_ref().or(within.as_ref())?;
    let number = |value: &Option<Value>| {
        let value = value.as_ref()?;
        let whole = value.as_integer().map(|whole| whole as f64);
        value.as_float().or(whole).filter(|it| it.is_finite())
    };
    let (read, rule) = match asked {
        AnswerKind::Choice(choices) => {
            let choice = (1..=choices.len()).find(|it| number(&right) == Some(*it as f64));
            let rule =
                "must be the number of a choice, counted from 1, and within has no place there";
            (choice.filter(|_| within.is_none()).map(Right::Choice), rule)
        }
        AnswerKind::Number { .. } => {
            let within = number(&within).filter(|within| *within > 0.0);
            let number = number(&right).zip(within);
            let rule = "must come together: right is the number that comes out, within (above 0) how far off is right too";
            (
                number.map(|(value, within)| Right::Number { value, within }),
                rule,
            )
        }
    };
    if read.is_none() {
        let problem = Problem::with_value(key, value, rule);
        content.refuse(problem);
    }
    read
}

fn choices(content: &mut BlockContent, value: &Value) -> Vec<String> {
    let items = value.as_array().cloned().unwrap_or_default();
    let words: Vec<String> = items
        .iter()
        .filter_map(|item| Some(item.as_str()?.trim().to_owned()))
        .filter(|text| !text.is_empty() && !text.chars().any(is_steering))
        .collect();
    let mut different = words.clone();
    different.sort();
    different.dedup();
    let rule = match words.len() {
        count if count != items.len() => "must be lines of text, none of them empty",
        0 | 1 => "must be a list of at least two answers in quotes",
        count if count > MOST_CHOICES => "are too many: at most 9",
        count if count != different.len() => "must differ from each other",
        _ => return words,
    };
    content.refuse(Problem::with_value("choices", value, rule));
    Vec::new()
}

/// A prediction beside what happened.
fn compare(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Compare> {
    let mut content = reader.content(&["prediction", "with", "text"])?;
    let prediction = content.needed("prediction", false, "the name of a predict block");
    let has_with = content.get("with").is_some();
    let with = content.expression("with", false, &find);
    let text = content.text(
        "text",
        "what is said, with {with:.2} and {prediction}",
        |name| match name {
            "with" if has_with => Ok(()),
            "with" => Err("there is no with in this block".to_owned()),
            "prediction" => Ok(()),
            name => find(name),
        },
    );
    content.finish(Compare {
        line: reader.line,
        prediction,
        with,
        text,
    })
}

/// What holds once the student has done the task.
fn check(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Check> {
    let mut content = reader.content(&["that", "goal", "hint"])?;
    let hint = content.line("hint", true);
    let goals = goals(&mut content);
    if content.get("that").is_none() {
        content.refuse_whole("lacks that: the condition, such as \"t_s >= 60\"");
    }
    let Some(that) = content.expression("that", true, find) else {
        return Err(content.problems);
    };
    if that.names().next().is_none() {
        let rule = "names no number of the run: it holds always or never";
        content.refuse(Problem::with_value("that", &that.text().into(), rule));
    }
    let parts = that.conjuncts(|_| None).len();
    if goals.len() > 1 && goals.len() != parts {
        let rule = format!(
            "has {} lines, and that joins {parts} parts with and",
            goals.len()
        );
        content.refuse(Problem::at("goal", rule));
    }
    content.finish(Check {
        line: reader.line,
        that,
        goals,
        hint,
    })
}

/// What is to be reached: a line of text, or a list of them.
fn goals(content: &mut BlockContent) -> Vec<String> {
    let Some(value) = content.get("goal") else {
        return Vec::new();
    };
    let Some(items) = value.as_array() else {
        return vec![content.line("goal", false)];
    };
    let lines: Vec<String> = items
        .iter()
        .filter_map(|item| Some(item.as_str()?.trim().to_owned()))
        .collect();
    if lines.len() != items.len()
        || lines
            .iter()
            .any(|line| line.is_empty() || line.chars().any(is_steering))
    {
        let rule = "must be lines of text, one for each part of that";
        content.refuse(Problem::with_value("goal", &value, rule));
    }
    lines
}
