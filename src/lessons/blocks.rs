//! Parses the TOML in the blocks of a lesson.

mod head;

use super::lesson::{
    AnswerKind, Check, Compare, DrawnAnswer, Keep, PREDICTION, Predict, Right, Setup, WITH,
};
use super::names::KeptNames;
use super::structure::on_line;
use super::text::LessonText;
use crate::engine::data::QUANTITIES;
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::kind::Range::{Any, Positive};
use crate::engine::scenario::kind::ValueKind::{self, By, Line, Lines, Number, Paragraph};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::schema::{Schema, UNKNOWN_KEY, may, must};
use crate::engine::scenario::screen::ABOVE;
use crate::engine::scenario::{Document, Problem, Problems, float};
use crate::lab::command::{COMMANDS, Command, LocatedCommand, RERUN, SET};
use crate::lab::view;
pub(super) use head::head;
use toml::{Table, Value};

/// A kind of block with a meaning in a lesson.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum BlockKind {
    Lesson,
    Lab,
    Task,
    Predict,
    Compare,
    Check,
    Notes,
}

/// Kinds of blocks, each with the word after its opening fence.
const BLOCK_KINDS: [(&str, BlockKind); 7] = [
    ("lesson", BlockKind::Lesson),
    ("lab", BlockKind::Lab),
    ("task", BlockKind::Task),
    ("predict", BlockKind::Predict),
    ("compare", BlockKind::Compare),
    ("check", BlockKind::Check),
    ("notes", BlockKind::Notes),
];

impl BlockKind {
    /// Returns the kind with this word after its opening fence.
    pub fn find(word: &str) -> Option<Self> {
        let row = BLOCK_KINDS.iter().find(|(known, _)| *known == word);
        row.map(|(_, kind)| *kind)
    }

    /// Returns the words of all kinds.
    pub fn words() -> [&'static str; BLOCK_KINDS.len()] {
        BLOCK_KINDS.map(|(word, _)| word)
    }
}

/// Keys of `lab` and `task` other than the `[view]` keys.
///
/// Commands are carried out in the order of the table of commands, those of [`LAST_COMMANDS`] at the end.
const COMMON: [&str; 6] = ["open", "set", "push", "since_s", "magnify", "point_at"];
const LAST_COMMANDS: [&str; 2] = ["wait_s", "go_to"];
const RUN_UNTIL: &str = "run_until";
const KEEP_KEY: &str = "keep";
/// Maximum number of choices of a prediction.
const MOST_CHOICES: usize = 9;
const MOST_BLOCK_PROBLEMS: usize = 20;

/// Type of a nonempty text of one or several lines: Markdown or an expression.
const TEXT: ValueKind = By(|value| match value.as_str() {
    Some("") => Err("must not be empty".to_owned()),
    _ => Paragraph.check(value),
});

#[rustfmt::skip]
const PREDICT: Schema = Schema(&[&[
    must("name", Line, "compare refers to the prediction by it"),
    must("ask", TEXT, "the question"),
    may("choices", By(are_choices), "the answers to choose from"),
    may("unit", By(is_unit), "the unit of a number"),
    may("right", Number(Any), "the right number, or the number of the right choice"),
    may("within", Number(Positive), "tolerance of the right number"),
    may("expected", TEXT, "the common wrong answer, for the teacher"),
    may("explain", TEXT, "explanation if few are right, for the teacher"),
    may("draw", By(is_drawn), "the axes on a worksheet"),
]]);

const COMPARE: Schema = Schema(&[&[
    must(PREDICTION, Line, "the name of a predict block"),
    may(WITH, TEXT, "a number of the run"),
    must("text", TEXT, "the text, with {with:.2} and {prediction}"),
]]);

const CHECK: Schema = Schema(&[&[
    must("that", TEXT, "the condition, such as \"t_s >= 60\""),
    may("goal", By(is_goal), "the goal in words"),
    may("hint", TEXT, "help for a student who is stuck"),
]]);

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

/// Checks a unit, which is empty for a pure number.
fn is_unit(value: &Value) -> Result<(), String> {
    match value.as_str() {
        Some("") => Ok(()),
        _ => Line.check(value),
    }
}

/// Checks a line of text or a list of lines.
fn is_goal(value: &Value) -> Result<(), String> {
    match value {
        Value::Array(_) => Lines.check(value),
        _ => Line.check(value),
    }
}

/// Checks the name of an answer that can be drawn.
fn is_drawn(value: &Value) -> Result<(), String> {
    let name = value.as_str().unwrap_or_default();
    if DrawnAnswer::named(name).is_some() {
        return Ok(());
    }
    let names = QUANTITIES.iter().map(|quantity| quantity.name);
    let near = nearest(name, [ABOVE].into_iter().chain(names));
    Err(format!("must be {ABOVE} or a column of the CSV: {near}"))
}

type BlockResult<T> = Result<T, Vec<Problem>>;

/// A block of the file `origin`.
pub(super) struct BlockReader<'a> {
    pub origin: String,
    /// Word after the opening fence.
    pub word: &'a str,
    /// Text between the fences.
    pub inside: &'a str,
    /// Line of the opening fence in the file.
    pub line: usize,
}

/// The parsed TOML of a block, with the problems found so far.
struct BlockContent<'a> {
    reader: &'a BlockReader<'a>,
    document: Document,
    /// Keys of the block. Texts are trimmed, except in commands.
    keys: Table,
    problems: Vec<Problem>,
}

impl<'a> BlockContent<'a> {
    fn parse(reader: &'a BlockReader<'a>) -> BlockResult<Self> {
        // Add an empty line for each line of the file before the block, so that line numbers are those of the file.
        let text = "\n".repeat(reader.line) + reader.inside;
        let document = Document::parse(&reader.origin, &text).map_err(|problems| problems.list)?;
        let mut content = Self {
            reader,
            keys: document.table().clone(),
            document,
            problems: Vec::new(),
        };
        if content.keys.is_empty() {
            let rule = "is empty: write its keys between the fences";
            content.refuse(Problem::at("", rule));
        }
        Ok(content)
    }

    /// Parses the block and checks its keys against `schema`.
    fn read(reader: &'a BlockReader<'a>, schema: Schema) -> BlockResult<Self> {
        let mut content = Self::parse(reader)?;
        content.keys.iter_mut().for_each(|(_, value)| trim(value));
        content.refuse(schema.check(&content.keys));
        content.finish(())?;
        Ok(content)
    }

    /// Returns the text at `key`, or each text of the list there. Returns none if the key is absent.
    fn texts(&self, key: &str) -> Vec<String> {
        let value = self.keys.get(key);
        let items = match value {
            Some(Value::Array(items)) => items.as_slice(),
            other => other.map_or(&[][..], std::slice::from_ref),
        };
        let texts = items.iter().filter_map(Value::as_str);
        texts.map(str::to_owned).collect()
    }

    fn text(&self, key: &str) -> String {
        self.texts(key).concat()
    }

    /// Adds problems whose keys are relative to the block.
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

    /// Parses the Markdown at `key`.
    fn markdown(&mut self, key: &str, find: impl Fn(&str) -> Result<(), String>) -> LessonText {
        let line = self.line_of(key);
        LessonText::read(&self.text(key), line, find).unwrap_or_else(|problems| {
            let word = self.reader.word;
            self.problems
                .extend(problems.into_iter().map(|problem| Problem {
                    key: format!("{word}.{key} {}", problem.key),
                    ..on_line(line, problem)
                }));
            LessonText::default()
        })
    }

    /// Parses the expression `text` at `key`.
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
    fn finish<T>(&mut self, made: T) -> BlockResult<T> {
        match std::mem::take(&mut self.problems) {
            none if none.is_empty() => Ok(made),
            problems => Err(problems),
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
        return Err("is a comparison: write a number".to_owned());
    }
    Ok(expression)
}

/// Parses a `lab` or `task` block on page `page`. The numbers that it keeps are known from page `known_from`.
pub(super) fn setup(
    reader: &BlockReader<'_>,
    names: &mut KeptNames,
    page: usize,
    known_from: usize,
) -> BlockResult<Setup> {
    let mut content = BlockContent::parse(reader).inspect_err(|_| names.mark_incomplete())?;
    let table = content.keys.clone();
    let known: Vec<_> = COMMANDS
        .iter()
        .map(|row| row.name)
        .filter(|name| COMMON.contains(name) || view::is_key(name))
        .chain(LAST_COMMANDS)
        .chain([RUN_UNTIL, KEEP_KEY, RERUN])
        .collect();
    for name in table.keys() {
        if !known.contains(&name.as_str()) {
            let rule = format!("{UNKNOWN_KEY}: {}", nearest(name, known.iter().copied()));
            content.refuse(Problem::at(name, rule));
        }
    }
    let mut commands = Vec::new();
    for name in known
        .into_iter()
        .filter(|name| ![KEEP_KEY, RERUN].contains(name))
    {
        let rerun = table.get(RERUN).filter(|_| name == SET);
        match table
            .get(name)
            .map(|value| Command::new(name, value)?.with_rerun(rerun))
        {
            Some(Ok(command)) => commands.push(LocatedCommand {
                command,
                line: Some(content.line_of(name)),
            }),
            Some(Err(problems)) => content.refuse(problems),
            None => {}
        }
    }
    if table.contains_key(RERUN) && !table.contains_key(SET) {
        let rule = "applies to set, and this block has no set";
        content.refuse(Problem::at(RERUN, rule));
    }
    if table.contains_key("go_to") && table.contains_key(RUN_UNTIL) {
        let rule = "cannot be combined with go_to: use one of the two";
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
    // Numbers kept by the same block cannot refer to each other.
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
        let number = content.expression(&key, text, false, |known| earlier.find(known, page));
        kept.extend(number.map(|expression| Keep {
            name: name.clone(),
            expression,
        }));
    }
    kept
}

pub(super) fn predict(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Predict> {
    let mut content = BlockContent::read(reader, PREDICT)?;
    let ask = content.markdown("ask", find);
    let [has_choices, has_unit] = ["choices", "unit"].map(|key| content.keys.contains_key(key));
    if has_choices && has_unit {
        let rule = "cannot be combined with choices: a choice has no unit";
        content.refuse(Problem::at("unit", rule));
    } else if !has_choices && !has_unit {
        let rule = "needs choices = [\"...\", \"...\"], or unit = \"deg\" to ask for a number";
        content.refuse(Problem::at("", rule));
    }
    let asked = if has_unit {
        AnswerKind::Number {
            unit: content.text("unit"),
        }
    } else {
        AnswerKind::Choice(content.texts("choices"))
    };
    let [right, within] = ["right", "within"].map(|key| content.keys.get(key).and_then(float));
    let right = read_right(right, within, &asked).unwrap_or_else(|rule| {
        let key = right.map_or("within", |_| "right");
        content.refuse(Problem::at(key, rule));
        None
    });
    content.finish(Predict {
        line: reader.line,
        name: content.text("name"),
        ask,
        asked,
        right,
        expected: content.text("expected"),
        explain: content.text("explain"),
        draw: DrawnAnswer::named(&content.text("draw")),
    })
}

/// Returns the right choice, or the right number with its tolerance.
fn read_right(
    right: Option<f64>,
    within: Option<f64>,
    asked: &AnswerKind,
) -> Result<Option<Right>, &'static str> {
    match (asked, right, within) {
        (_, None, None) => Ok(None),
        (AnswerKind::Choice(choices), right, within) => (1..=choices.len())
            .find(|number| within.is_none() && right == Some(*number as f64))
            .map(|number| Some(Right::Choice(number)))
            .ok_or("must be the number of a choice, counted from 1, without within"),
        (AnswerKind::Number { .. }, Some(value), Some(within)) => {
            Ok(Some(Right::Number { value, within }))
        }
        (AnswerKind::Number { .. }, ..) => {
            Err("needs both right and within: the right number, and its tolerance (above 0)")
        }
    }
}

/// Parses a `compare` block.
pub(super) fn compare(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Compare> {
    let mut content = BlockContent::read(reader, COMPARE)?;
    let has_with = content.keys.contains_key(WITH);
    let with = has_with.then(|| content.expression(WITH, &content.text(WITH), false, &find));
    let text = content.markdown("text", |name| match name {
        WITH if !has_with => Err("there is no with in this block".to_owned()),
        WITH | PREDICTION => Ok(()),
        name => find(name),
    });
    content.finish(Compare {
        line: reader.line,
        prediction: content.text(PREDICTION),
        with: with.flatten(),
        text,
    })
}

/// Parses a `check` block.
pub(super) fn check(
    reader: &BlockReader<'_>,
    find: impl Fn(&str) -> Result<(), String>,
) -> BlockResult<Check> {
    let mut content = BlockContent::read(reader, CHECK)?;
    let Some(that) = content.expression("that", &content.text("that"), true, find) else {
        return Err(content.problems);
    };
    if that.names().next().is_none() {
        let rule = "uses no number of the run: it holds always or never";
        content.refuse(Problem::with_value("that", &that.text().into(), rule));
    }
    let goals = content.texts("goal");
    let parts = that.conjuncts(|_| None).len();
    if goals.len() > 1 && goals.len() != parts {
        let rule = format!(
            "has {} lines, but the condition has {parts} parts joined by and",
            goals.len()
        );
        content.refuse(Problem::at("goal", rule));
    }
    content.finish(Check {
        line: reader.line,
        that,
        goals,
        hint: content.text("hint"),
    })
}
