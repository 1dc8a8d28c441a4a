//! The TOML in the blocks of a lesson.

use super::lesson::{
    AnswerKind, Check, Compare, Keep, LessonBlock, PREDICTION, Predict, Right, Setup, WITH,
};
use super::names::KeptNames;
use super::structure::on_line;
use super::text::LessonText;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::kind::Range::{Any, Positive};
use crate::engine::scenario::kind::ValueKind::{self, By, Line, Lines, Number, Paragraph, Whole};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::schema::{Schema, UNKNOWN_KEY, may, must};
use crate::engine::scenario::{Document, Problem, Problems};
use crate::lab::command::{COMMANDS, Command, LocatedCommand};
use crate::lab::view;
use serde::Deserialize;
use serde::de::DeserializeOwned;
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
const LONGEST_LESSON: i64 = 600;
const MOST_BLOCK_PROBLEMS: usize = 20;

/// Markdown, not empty.
const MARKDOWN: ValueKind = By(|value| match value.as_str() {
    Some("") => Err("must not be empty".to_owned()),
    _ => Paragraph.check(value),
});

const HEAD: Schema = Schema(&[&[
    may("about", Line, "what the lesson is about"),
    may("minutes", Whole(1, LONGEST_LESSON), "how long it takes"),
]]);

const PREDICT: Schema = Schema(&[&[
    must("name", Line, "compare calls the prediction by it"),
    must("ask", MARKDOWN, "the question"),
    may("choices", By(are_choices), "the answers to choose from"),
    may("unit", By(is_unit), "the unit of a number"),
    may(
        "right",
        Number(Any),
        "the number that comes out, or of the choice",
    ),
    may("within", Number(Positive), "how far off is right too"),
]]);

const COMPARE: Schema = Schema(&[&[
    must(PREDICTION, Line, "the name of a predict block"),
    may(WITH, Line, "a number of the run"),
    must(
        "text",
        MARKDOWN,
        "what is said, with {with:.2} and {prediction}",
    ),
]]);

const CHECK: Schema = Schema(&[&[
    must("that", Line, "the condition, such as \"t_s >= 60\""),
    may("goal", By(is_goal), "what is to be reached"),
    may("hint", MARKDOWN, "help for one who has not got there"),
]]);

#[derive(Deserialize)]
struct HeadKeys {
    #[serde(default)]
    about: String,
    minutes: Option<u32>,
}

#[derive(Deserialize)]
struct PredictKeys {
    name: String,
    ask: String,
    choices: Option<Vec<String>>,
    unit: Option<String>,
    right: Option<f64>,
    within: Option<f64>,
}

#[derive(Deserialize)]
struct CompareKeys {
    prediction: String,
    with: Option<String>,
    text: String,
}

#[derive(Deserialize)]
struct CheckKeys {
    that: String,
    goal: Option<Goal>,
    #[serde(default)]
    hint: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Goal {
    Whole(String),
    Parts(Vec<String>),
}

fn are_choices(value: &Value) -> Result<(), String> {
    Lines.check(value)?;
    let choices = value.as_array().map_or(&[][..], Vec::as_slice);
    match choices.len() {
        0 | 1 => Err("must be a list of at least two answers in quotes".to_owned()),
        count if count > MOST_CHOICES => Err(format!("are too many: at most {MOST_CHOICES}")),
        count if (1..count).any(|at| choices[..at].contains(&choices[at])) => {
            Err("must differ from each other".to_owned())
        }
        _ => Ok(()),
    }
}

/// A unit, which is empty for a pure number.
fn is_unit(value: &Value) -> Result<(), String> {
    match value.as_str() {
        Some("") => Ok(()),
        _ => Line.check(value),
    }
}

/// A line of text, or a list of them.
fn is_goal(value: &Value) -> Result<(), String> {
    match value {
        Value::Array(_) => Lines.check(value),
        _ => Line.check(value),
    }
}

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

/// The TOML of a block, and what is wrong with it.
struct BlockContent<'a> {
    reader: &'a BlockReader<'a>,
    document: Document,
    problems: Vec<Problem>,
}

impl<'a> BlockContent<'a> {
    fn parse(reader: &'a BlockReader<'a>) -> BlockResult<Self> {
        // As many empty lines before it as there are lines before it in the file: every line has its number there.
        let text = "\n".repeat(reader.line) + reader.inside;
        let document = Document::parse(&reader.origin, &text).map_err(|problems| problems.list)?;
        let mut content = Self {
            reader,
            document,
            problems: Vec::new(),
        };
        if content.document.table().is_empty() {
            let rule = "holds nothing: its keys stand between the fences";
            content.refuse(Problem::at("", rule));
        }
        Ok(content)
    }

    /// Parses the block, and its keys, which `schema` lists. Texts lose the blanks around them.
    fn read<T: DeserializeOwned>(
        reader: &'a BlockReader<'a>,
        schema: Schema,
    ) -> BlockResult<(Self, T)> {
        let mut content = Self::parse(reader)?;
        let mut table = content.document.table().clone();
        table.iter_mut().for_each(|(_, value)| trim(value));
        content.refuse(schema.check(&table));
        match table.try_into() {
            Ok(keys) if content.problems.is_empty() => return Ok((content, keys)),
            Err(error) if content.problems.is_empty() => {
                content.refuse(Problem::at("", error.message()));
            }
            _ => {}
        }
        Err(content.problems)
    }

    /// Adds problems, whose keys are those of the TOML.
    fn refuse(&mut self, problems: impl Into<Problems>) {
        for problem in self.document.placed(problems).list {
            if self.problems.len() < MOST_BLOCK_PROBLEMS {
                let mut problem = problem.inside(self.reader.word);
                let line = self.reader.line;
                problem.place.get_or_insert_with(|| format!("line {line}"));
                self.problems.push(problem);
            }
        }
    }

    fn line_of(&self, key: &str) -> usize {
        let lines = self.document.lines_of(std::iter::once(key.to_owned()));
        let line = lines.into_iter().flatten().next();
        line.unwrap_or(self.reader.line)
    }

    /// Reads the Markdown `source` at `key`.
    fn text(
        &mut self,
        key: &str,
        source: &str,
        find: impl Fn(&str) -> Result<(), String>,
    ) -> LessonText {
        let line = self.line_of(key);
        LessonText::read(source, line, find).unwrap_or_else(|problems| {
            let word = self.reader.word;
            self.problems
                .extend(problems.into_iter().map(|problem| Problem {
                    key: format!("{word}.{key} {}", problem.key),
                    ..on_line(line, problem)
                }));
            LessonText::default()
        })
    }

    /// Reads the expression `text` at `key`.
    fn expression(
        &mut self,
        key: &str,
        text: &str,
        is_condition: bool,
        find: impl Fn(&str) -> Result<(), String>,
    ) -> Option<Expression> {
        expression(text, is_condition, find)
            .map_err(|rule| self.refuse(Problem::with_value(key, &text.into(), rule)))
            .ok()
    }

    /// Returns `Ok(made)` if no problem was found.
    fn finish<T>(self, made: T) -> BlockResult<T> {
        if self.problems.is_empty() {
            Ok(made)
        } else {
            Err(self.problems)
        }
    }
}

fn trim(value: &mut Value) {
    match value {
        Value::String(text) => *text = text.trim().to_owned(),
        Value::Array(items) => items.iter_mut().for_each(trim),
        _ => {}
    }
}

fn expression(
    text: &str,
    is_condition: bool,
    find: impl Fn(&str) -> Result<(), String>,
) -> Result<Expression, String> {
    let parse: fn(&str) -> _ = if is_condition {
        Expression::condition
    } else {
        Expression::parse
    };
    let expression = parse(text).map_err(|fault| fault.to_string())?;
    expression.bind(find).map_err(|fault| fault.to_string())?;
    if expression.is_condition() && !is_condition {
        return Err("compares: a number must stand here".to_owned());
    }
    Ok(expression)
}

/// What the lesson is about, and how many minutes it takes.
pub(super) fn head(reader: &BlockReader<'_>) -> BlockResult<(String, Option<u32>)> {
    let (_, HeadKeys { about, minutes }) = BlockContent::read(reader, HEAD)?;
    Ok((about, minutes))
}

/// What the lab does: a `lab` or `task` block of page `page`, whose kept numbers are known from the page `known_from` on.
pub(super) fn setup(
    reader: &BlockReader<'_>,
    names: &mut KeptNames,
    page: usize,
    known_from: usize,
) -> BlockResult<Setup> {
    let mut content = BlockContent::parse(reader).inspect_err(|_| names.mark_incomplete())?;
    let table = content.document.table().clone();
    let known: Vec<_> = COMMANDS
        .iter()
        .map(|row| row.name)
        .filter(|name| COMMON.contains(name) || view::is_key(name))
        .chain(LAST_COMMANDS)
        .chain([RUN_UNTIL, KEEP_KEY])
        .collect();
    for name in table.keys() {
        if !known.contains(&name.as_str()) {
            let rule = format!("{UNKNOWN_KEY}: {}", nearest(name, known.iter().copied()));
            content.refuse(Problem::at(name, rule));
        }
    }
    let mut commands = Vec::new();
    for name in known.into_iter().filter(|name| *name != KEEP_KEY) {
        match table.get(name).map(|value| Command::new(name, value)) {
            Some(Ok(command)) => commands.push(LocatedCommand {
                command,
                line: Some(content.line_of(name)),
            }),
            Some(Err(problems)) => content.refuse(problems),
            None => {}
        }
    }
    if table.contains_key("go_to") && table.contains_key(RUN_UNTIL) {
        let rule = "has no place beside go_to: one of the two ends a block";
        content.refuse(Problem::at(RUN_UNTIL, rule));
    }
    let keep = match table.get(KEEP_KEY) {
        None => Vec::new(),
        Some(Value::Table(table)) => keep(&mut content, table, names, page, known_from),
        Some(other) => {
            let rule = "must be a table of names and expressions, { coarse = \"most_distance_m\" }";
            content.refuse(Problem::with_value(KEEP_KEY, other, rule));
            Vec::new()
        }
    };
    content.finish(Setup {
        line: reader.line,
        commands,
        keep,
    })
}

fn keep(
    content: &mut BlockContent<'_>,
    table: &Table,
    names: &mut KeptNames,
    page: usize,
    known_from: usize,
) -> Vec<Keep> {
    // Numbers that are kept at the same time do not know each other.
    let earlier = names.clone();
    let mut kept = Vec::new();
    for (name, value) in table {
        let key = join(KEEP_KEY, name);
        if let Err(rule) = names.keep(name, known_from) {
            content.refuse(Problem::at(key, rule));
            continue;
        }
        let Some(text) = value.as_str() else {
            let rule = "must be an expression in quotes";
            content.refuse(Problem::with_value(key, value, rule));
            continue;
        };
        let number = content.expression(&key, text, false, |name| earlier.find(name, page));
        kept.extend(number.map(|expression| Keep {
            name: name.clone(),
            expression,
        }));
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
    let (mut content, keys) = BlockContent::read::<PredictKeys>(reader, PREDICT)?;
    let ask = content.text("ask", &keys.ask, find);
    let asked = match (keys.choices, keys.unit) {
        (Some(choices), None) => AnswerKind::Choice(choices),
        (None, Some(unit)) => AnswerKind::Number { unit },
        (Some(_), Some(_)) => {
            let rule = "has no place beside choices: a choice has no unit";
            content.refuse(Problem::at("unit", rule));
            return Err(content.problems);
        }
        (None, None) => {
            let rule =
                "lacks choices = [\"...\", \"...\"], or unit = \"deg\" where a number is asked for";
            content.refuse(Problem::at("", rule));
            return Err(content.problems);
        }
    };
    let right = match right(keys.right, keys.within, &asked) {
        Ok(right) => right,
        Err(rule) => {
            let key = keys.right.map_or("within", |_| "right");
            content.refuse(Problem::at(key, rule));
            None
        }
    };
    content.finish(Predict {
        line: reader.line,
        name: keys.name,
        ask,
        asked,
        right,
    })
}

/// The number of the right choice; or the right number, and how far off an answer may be.
fn right(
    right: Option<f64>,
    within: Option<f64>,
    asked: &AnswerKind,
) -> Result<Option<Right>, &'static str> {
    match (asked, right, within) {
        (_, None, None) => Ok(None),
        (AnswerKind::Choice(choices), right, within) => (1..=choices.len())
            .find(|number| within.is_none() && right == Some(*number as f64))
            .map(|number| Some(Right::Choice(number)))
            .ok_or("must be the number of a choice, counted from 1, and within has no place there"),
        (AnswerKind::Number { .. }, Some(value), Some(within)) => {
            Ok(Some(Right::Number { value, within }))
        }
        (AnswerKind::Number { .. }, ..) => Err(
            "must come together: right is the number that comes out, within (above 0) how far off is right too",
        ),
    }
}

/// A prediction beside what happened.
fn compare(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Compare> {
    let (mut content, keys) = BlockContent::read::<CompareKeys>(reader, COMPARE)?;
    let with = keys.with.as_ref();
    let number = with.and_then(|with| content.expression(WITH, with, false, &find));
    let text = content.text("text", &keys.text, |name| match name {
        WITH if with.is_none() => Err("there is no with in this block".to_owned()),
        WITH | PREDICTION => Ok(()),
        name => find(name),
    });
    content.finish(Compare {
        line: reader.line,
        prediction: keys.prediction,
        with: number,
        text,
    })
}

/// What holds once the student has done the task.
fn check(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Check> {
    let (mut content, keys) = BlockContent::read::<CheckKeys>(reader, CHECK)?;
    let Some(that) = content.expression("that", &keys.that, true, find) else {
        return Err(content.problems);
    };
    if that.names().next().is_none() {
        let rule = "names no number of the run: it holds always or never";
        content.refuse(Problem::with_value("that", &that.text().into(), rule));
    }
    let goals = match keys.goal {
        None => Vec::new(),
        Some(Goal::Whole(goal)) => vec![goal],
        Some(Goal::Parts(goals)) => goals,
    };
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
        hint: keys.hint,
    })
}
