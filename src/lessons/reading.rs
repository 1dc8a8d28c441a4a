//! Parses a lesson from its Markdown.
//!
//! A lesson begins with its title, a level-1 heading. Each level-2 heading begins a page. A fenced block marked
//! `lesson`, `lab`, `task`, `predict`, `compare` or `check` contains TOML; one marked `notes` contains Markdown for the
//! teacher. Blocks marked `text`, `sh`, `toml`, `csv`, `python` or `matlab`, and unmarked ones, are shown unchanged.
//! Any other word is an error. An HTML comment on lines of its own is ignored.

use super::blocks::{self, BlockKind, BlockReader};
use super::lesson::{CodeBlock, Compare, Lesson, LessonBlock, LessonPage, Setup};
use super::names::KeptNames;
use super::structure::{Element, LANGUAGES, Lines, PieceKind, on_line, structure};
use super::text::LessonText;
use crate::engine::scenario::problem::{listed, nearest};
use crate::engine::scenario::{Problem, Problems};
use crate::engine::text::printable::is_steering;
use std::collections::BTreeSet;

const MOST_LESSON_LINES: usize = 20_000;
/// Maximum number of blocks and pages of a lesson.
const MOST_LESSON_BLOCKS: usize = 1000;

/// Parses `text`, the content of the file `origin`, as a lesson.
///
/// # Errors
///
/// Returns all problems found, each with its line.
pub fn read(origin: &str, text: &str) -> Result<Lesson, Problems> {
    let plain = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
    let source = plain.replace('\t', "    ");
    let elements = elements(&source).map_err(|problem| Problems::one(origin, problem))?;
    let mut assembly = Assembly::default();
    assembly.lesson.origin = origin.to_owned();
    assembly.lesson.name = origin.to_owned();
    assembly.read_setups(&elements);
    for element in &elements {
        assembly.add(element);
    }
    assembly.finish()
}

/// Returns the pages and blocks of a lesson's `text`.
fn elements(text: &str) -> Result<Vec<Element<'_>>, Problem> {
    let lines = Lines::index(text);
    check_text(text, &lines)?;
    let elements = structure(text, &lines, &BlockKind::words())?;
    if elements.len() > MOST_LESSON_BLOCKS {
        let rule = format!(
            "has more than {MOST_LESSON_BLOCKS} pages and blocks, the maximum for a lesson"
        );
        return Err(Problem::at("", rule));
    }
    Ok(elements)
}

/// Checks that `text` is short enough and contains no character that could control a terminal.
fn check_text(text: &str, lines: &Lines) -> Result<(), Problem> {
    let count = text.matches('\n').count();
    if count > MOST_LESSON_LINES {
        let rule = format!("has {count} lines: a lesson has at most {MOST_LESSON_LINES}");
        return Err(Problem::at("", rule));
    }
    let mut characters = text.char_indices();
    match characters.find(|(_, c)| *c != '\n' && is_steering(*c)) {
        None => Ok(()),
        Some((at, c)) => {
            let rule = format!(
                "contains the control or invisible character U+{:04X}: remove it",
                u32::from(c)
            );
            Err(on_line(lines.at(at), Problem::at("", rule)))
        }
    }
}

/// A lesson that is assembled from the elements of its file.
#[derive(Default)]
struct Assembly {
    lesson: Lesson,
    has_title: bool,
    /// The `lab` and `task` blocks by line. They are read first, because they define the names of kept numbers.
    setups: Vec<Setup>,
    names: KeptNames,
    predictions: BTreeSet<String>,
    compares: Vec<Compare>,
    has_head: bool,
    /// Line of the `lesson` block.
    head_line: usize,
    found: Problems,
}

impl Assembly {
    fn refuse(&mut self, line: usize, problem: Problem) {
        self.found.add(|| on_line(line, problem));
    }

    fn reader<'a>(&self, word: &'a str, inside: &'a str, line: usize) -> BlockReader<'a> {
        BlockReader {
            origin: self.lesson.origin.clone(),
            word,
            inside,
            line,
        }
    }

    fn refuse_all(&mut self, problems: Vec<Problem>) {
        for problem in problems {
            self.found.add(|| problem);
        }
    }

    fn read_setups(&mut self, elements: &[Element<'_>]) {
        let mut page = 0;
        let mut is_opened = false;
        for element in elements {
            let (word, inside) = match element.kind {
                PieceKind::Heading(_) => {
                    page += 1;
                    continue;
                }
                PieceKind::Fenced(word @ ("lab" | "task"), inside) => (word, inside),
                _ => continue,
            };
            let known_from = page + usize::from(word == "task");
            self.names.open_from(page);
            let reader = self.reader(word, inside, element.line);
            match blocks::setup(&reader, &mut self.names, page, known_from) {
                Ok(setup) => {
                    if !is_opened && !setup.opens() {
                        let rule = "opens no run, and no block before it does: add open = \"method-2\" or another run";
                        self.refuse(element.line, Problem::at(word, rule));
                    }
                    self.setups.push(setup);
                }
                Err(problems) => self.refuse_all(problems),
            }
            is_opened = true;
        }
    }

    fn add(&mut self, element: &Element<'_>) {
        let line = element.line;
        match &element.kind {
            PieceKind::Title(words) => self.add_title(words, line),
            PieceKind::Heading(words) => {
                if words.is_empty() {
                    let rule = "is a page without a heading: write one after ##";
                    self.refuse(line, Problem::at("##", rule));
                }
                self.need_title(line);
                self.lesson.pages.push(LessonPage {
                    number: self.lesson.pages.len() + 1,
                    heading: words.clone(),
                    line,
                    blocks: Vec::new(),
                });
            }
            PieceKind::Text(text) => {
                self.need_title(line);
                if let Some(text) = self.text(text, line) {
                    self.push_block(LessonBlock::Text(text));
                }
            }
            PieceKind::Fenced(word, inside) => self.add_fenced(word, inside, line),
        }
    }

    fn add_title(&mut self, words: &str, line: usize) {
        if self.has_title {
            let rule = "is a second title: a lesson has one, and a page begins with ##";
            return self.refuse(line, Problem::at("#", rule));
        }
        if words.is_empty() {
            let rule = "is an empty title: write it after #";
            self.refuse(line, Problem::at("#", rule));
        }
        self.has_title = true;
        words.clone_into(&mut self.lesson.title);
    }

    /// Adds a problem, once, if the file has no title so far.
    fn need_title(&mut self, line: usize) {
        if !self.has_title {
            let rule = "comes before the title: a lesson begins with # and its title";
            self.refuse(line, Problem::at("", rule));
            self.has_title = true;
        }
    }

    fn text(&mut self, source: &str, line: usize) -> Option<LessonText> {
        let page = self.lesson.pages.len();
        let read = LessonText::read(source, line, |name| self.names.find(name, page));
        read.map_err(|problems| self.refuse_all(problems)).ok()
    }

    fn push_block(&mut self, block: LessonBlock) {
        match self.lesson.pages.last_mut() {
            Some(page) => page.blocks.push(block),
            None => self.lesson.introduction.push(block),
        }
    }

    fn add_fenced(&mut self, word: &str, inside: &str, line: usize) {
        self.need_title(line);
        if word.is_empty() || LANGUAGES.contains(&word) {
            return self.push_block(LessonBlock::Shown(CodeBlock {
                language: word.to_owned(),
                text: inside.to_owned(),
            }));
        }
        let Some(kind) = BlockKind::find(word) else {
            let near = nearest(word, BlockKind::words().into_iter().chain(LANGUAGES));
            let also = if near.starts_with("did you mean") {
                format!(" (shown unchanged: {})", listed(LANGUAGES.into_iter()))
            } else {
                String::new()
            };
            let rule = format!("is not a lesson block: {near}{also}");
            return self.refuse(line, Problem::at(word, rule));
        };
        let needs_page = !matches!(kind, BlockKind::Lesson | BlockKind::Notes);
        if needs_page && self.lesson.pages.is_empty() {
            let rule = "is before the first page: write a heading, ## ..., above it";
            return self.refuse(line, Problem::at(word, rule));
        }
        self.add_block(kind, &self.reader(word, inside, line));
    }

    fn add_block(&mut self, kind: BlockKind, reader: &BlockReader<'_>) {
        let line = reader.line;
        let page = self.lesson.pages.len();
        let find = |name: &str| self.names.find(name, page);
        let read = match kind {
            BlockKind::Lesson => return self.add_head(reader),
            BlockKind::Lab => return self.add_setup(reader, LessonPage::lab, LessonBlock::Lab),
            BlockKind::Task => return self.add_setup(reader, LessonPage::task, LessonBlock::Task),
            BlockKind::Notes => return self.add_notes(reader),
            BlockKind::Predict => blocks::predict(reader, find).map(LessonBlock::Predict),
            BlockKind::Compare => blocks::compare(reader, find).map(LessonBlock::Compare),
            BlockKind::Check => blocks::check(reader, find).map(LessonBlock::Check),
        };
        let block = match read {
            Ok(block) => block,
            Err(problems) => return self.refuse_all(problems),
        };
        match &block {
            LessonBlock::Predict(predict) if !self.predictions.insert(predict.name.clone()) => {
                let rule = "is the name of an earlier prediction: choose another";
                let name = toml::Value::from(predict.name.as_str());
                self.refuse(line, Problem::with_value("predict.name", &name, rule));
            }
            LessonBlock::Compare(compare) => self.compares.push(compare.clone()),
            _ => {}
        }
        self.push_block(block);
    }

    fn add_head(&mut self, reader: &BlockReader<'_>) {
        let line = reader.line;
        if self.has_head {
            let rule = "occurs twice: a lesson has only one such block";
            return self.refuse(line, Problem::at("lesson", rule));
        }
        if !self.lesson.pages.is_empty() {
            let rule = "is on a page: move it below the title";
            return self.refuse(line, Problem::at("lesson", rule));
        }
        self.has_head = true;
        match blocks::head(reader) {
            Ok(head) => {
                self.lesson.about = head.about;
                self.lesson.minutes = head.minutes;
                self.lesson.guide = head.guide;
                self.head_line = line;
            }
            Err(problems) => self.refuse_all(problems),
        }
    }

    /// Adds a setup that was read before. `same` returns the setup of this kind that a page already has.
    fn add_setup(
        &mut self,
        reader: &BlockReader<'_>,
        same: fn(&LessonPage) -> Option<&Setup>,
        make: fn(Setup) -> LessonBlock,
    ) {
        if self.lesson.pages.last().and_then(same).is_some() {
            let rule = "occurs twice on this page: begin another page with ##";
            return self.refuse(reader.line, Problem::at(reader.word, rule));
        }
        let mut setups = self.setups.iter();
        if let Some(setup) = setups.find(|setup| setup.line == reader.line) {
            self.push_block(make(setup.clone()));
        }
    }

    fn add_notes(&mut self, reader: &BlockReader<'_>) {
        if let Some(text) = self.text(reader.inside.trim_end(), reader.line + 1) {
            self.push_block(LessonBlock::Notes(text));
        }
    }

    fn finish(mut self) -> Result<Lesson, Problems> {
        for compare in std::mem::take(&mut self.compares) {
            self.check_compare(&compare);
        }
        if !self.has_title {
            let rule = "has no title: a lesson begins with # and its title";
            self.refuse(1, Problem::at("", rule));
        }
        if self.lesson.pages.is_empty() {
            let rule = "has no page: each begins with ## and its heading";
            self.refuse(1, Problem::at("", rule));
        }
        let (timed, pages) = (
            self.lesson.guide.page_minutes.len(),
            self.lesson.pages.len(),
        );
        if ![0, pages].contains(&timed) {
            let rule = format!("has {timed} numbers, and the lesson has {pages} pages");
            self.refuse(self.head_line, Problem::at("lesson.page_minutes", rule));
        }
        if self.found.list.is_empty() {
            return Ok(self.lesson);
        }
        self.found.list.sort_by_key(line_of);
        Err(self.found.in_file(self.lesson.origin))
    }

    /// Checks that the prediction of `compare` is asked for before it.
    fn check_compare(&mut self, compare: &Compare) {
        let rule = match self.lesson.predict(&compare.prediction) {
            Some(asked) if asked.line < compare.line => return,
            Some(asked) => format!("is asked for only later, on line {}", asked.line),
            None if self.predictions.is_empty() => {
                "is not asked for: add a predict block with this name".to_owned()
            }
            None => {
                let known = self.predictions.iter().map(String::as_str);
                format!("is not asked for: {}", nearest(&compare.prediction, known))
            }
        };
        let name = toml::Value::from(compare.prediction.as_str());
        let problem = Problem::with_value("compare.prediction", &name, rule);
        self.refuse(compare.line, problem);
    }
}

fn line_of(problem: &Problem) -> usize {
    let line = problem
        .place
        .as_deref()
        .and_then(|it| it.strip_prefix("line "));
    line.and_then(|line| line.parse().ok()).unwrap_or_default()
}
