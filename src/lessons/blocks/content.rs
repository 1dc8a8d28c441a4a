//! The TOML of a block, and what is wrong with it.

use super::{BlockReader, BlockResult, expression};
use crate::engine::journal::expression::Expression;
use crate::engine::scenario::dotted::join;
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Document, Problem};
use crate::engine::text::printable::is_steering;
use crate::lab::command::COMMANDS;
use crate::lessons::structure::on_line;
use crate::lessons::text::LessonText;
use toml::Value;

/// The longest line of text in a block, characters.
const LONGEST_BLOCK_LINE: usize = 500;
const MOST_BLOCK_PROBLEMS: usize = 20;

pub(super) struct BlockContent {
    document: Document,
    word: String,
    pub(super) line: usize,
    pub(super) problems: Vec<Problem>,
}

impl BlockReader<'_> {
    /// The TOML of the block, of which only the keys `known` may be there.
    pub(super) fn content(&self, known: &[&str]) -> BlockResult<BlockContent> {
        // As many empty lines before it as there are lines before it in the file: every line has its number there.
        let text = "\n".repeat(self.line) + self.inside;
        let document = Document::parse(&self.origin, &text).map_err(|problems| problems.list)?;
        let mut content = BlockContent {
            document,
            word: self.word.to_owned(),
            line: self.line,
            problems: Vec::new(),
        };
        let keys: Vec<String> = content.document.table().keys().cloned().collect();
        for key in keys.iter().filter(|key| !known.contains(&key.as_str())) {
            let near = nearest(key, known.iter().copied());
            let what = if COMMANDS.iter().any(|row| row.name == key) {
                "is no key of this block"
            } else {
                "unknown key"
            };
            content.refuse(Problem::at(key, format!("{what}: {near}")));
        }
        if keys.is_empty() {
            content.refuse_whole("holds nothing: its keys stand between the fences");
        }
        Ok(content)
    }
}

impl BlockContent {
    /// Notes that `problem` was found; its key is that of the TOML.
    pub(super) fn refuse(&mut self, problem: Problem) {
        if self.problems.len() >= MOST_BLOCK_PROBLEMS {
            return;
        }
        let key = problem.key.clone();
        for mut problem in self.document.placed(vec![problem]).list {
            problem.key = format!("{}.{key}", self.word);
            problem
                .place
                .get_or_insert_with(|| format!("line {}", self.line));
            self.problems.push(problem);
        }
    }

    /// The same of a problem whose key is one inside of the key `outer`.
    pub(super) fn refuse_in(&mut self, outer: &str, problem: Problem) {
        let key = join(outer, &problem.key).trim_end_matches('.').to_owned();
        self.refuse(Problem { key, ..problem });
    }

    pub(super) fn refuse_whole(&mut self, rule: &str) {
        let problem = Problem::at(self.word.clone(), rule);
        self.problems.push(on_line(self.line, problem));
    }

    pub(super) fn get(&self, key: &str) -> Option<Value> {
        self.document.table().get(key).cloned()
    }

    pub(super) fn line_of(&self, key: &str) -> usize {
        let lines = self.document.lines_of(std::iter::once(key.to_owned()));
        lines.into_iter().flatten().next().unwrap_or(self.line)
    }

    /// The text at `key`, empty where there is none; `may_wrap` allows line ends.
    pub(super) fn line(&mut self, key: &str, may_wrap: bool) -> String {
        let Some(value) = self.get(key) else {
            return String::new();
        };
        let rule = match value.as_str() {
            None => "must be text in quotes",
            Some(text) if text.trim().is_empty() => "must not be empty",
            Some(text) if text.chars().any(|c| c != '\n' && is_steering(c)) => {
                "must hold no control or invisible characters"
            }
            Some(text) if !may_wrap && text.contains('\n') => "must be one line",
            Some(text) if text.chars().count() > LONGEST_BLOCK_LINE && !may_wrap => "is too long",
            Some(text) => return text.trim().to_owned(),
        };
        self.refuse(Problem::with_value(key, &value, rule));
        String::new()
    }

    /// As [`line`](Self::line), of a key that must be there.
    pub(super) fn needed(&mut self, key: &str, may_wrap: bool, meaning: &str) -> String {
        if self.get(key).is_none() {
            self.refuse_whole(&format!("lacks {key}: {meaning}"));
        }
        self.line(key, may_wrap)
    }

    pub(super) fn text(
        &mut self,
        key: &str,
        meaning: &str,
        find: impl Fn(&str) -> Result<(), String>,
    ) -> LessonText {
        let source = self.needed(key, true, meaning);
        let line = self.line_of(key);
        let read = LessonText::read(&source, line, find);
        read.unwrap_or_else(|problems| {
            self.problems
                .extend(problems.into_iter().map(|problem| Problem {
                    key: format!("{}.{key} {}", self.word, problem.key),
                    ..on_line(line, problem)
                }));
            LessonText::default()
        })
    }

    pub(super) fn expression(
        &mut self,
        key: &str,
        is_condition: bool,
        find: impl Fn(&str) -> Result<(), String>,
    ) -> Option<Expression> {
        let value = self.get(key)?;
        let Some(text) = value.as_str() else {
            let rule = "must be text in quotes, such as \"t_s >= 60\"";
            self.refuse(Problem::with_value(key, &value, rule));
            return None;
        };
        expression(text, is_condition, find)
            .map_err(|rule| self.refuse(Problem::with_value(key, &value, rule)))
            .ok()
    }

    /// `made`, unless something was refused.
    pub(super) fn finish<T>(self, made: T) -> BlockResult<T> {
        if self.problems.is_empty() {
            Ok(made)
        } else {
            Err(self.problems)
        }
    }
}
