//! The structure of a lesson's Markdown: headings, fenced blocks, and the text between them.

use crate::engine::scenario::Problem;
use pulldown_cmark::{CodeBlockKind, Event, HeadingLevel, Parser, Tag, TagEnd};
use std::ops::Range;

/// Words after the opening fence of blocks that are shown unchanged.
pub(super) const LANGUAGES: [&str; 6] = ["text", "sh", "toml", "csv", "python", "matlab"];

/// An element of a lesson's file.
#[derive(Debug)]
pub(super) struct Element<'a> {
    pub(super) kind: PieceKind<'a>,
    /// First line of the element, from 1.
    pub(super) line: usize,
}

#[derive(Debug)]
pub(super) enum PieceKind<'a> {
    Title(String),
    Heading(String),
    /// A fenced block: the word after the opening fence, and the text between the fences.
    Fenced(&'a str, &'a str),
    Text(&'a str),
}

/// Offsets of the line ends of a text.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    pub(super) fn index(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(at, _)| at).collect())
    }

    /// Returns the line of the byte at `offset`, from 1.
    pub(super) fn at(&self, offset: usize) -> usize {
        self.0.partition_point(|&end| end < offset) + 1
    }
}

/// Returns `problem` with this line as its place.
pub(super) fn on_line(line: usize, mut problem: Problem) -> Problem {
    problem.place = Some(format!("line {line}"));
    problem
}

/// Returns the elements of `text` in order. `words` are the words after a fence that have a meaning in a lesson.
pub(super) fn structure<'a>(
    text: &'a str,
    lines: &Lines,
    words: &[&str],
) -> Result<Vec<Element<'a>>, Problem> {
    let mut walk = FileWalk {
        text,
        lines,
        words,
        elements: Vec::new(),
        end: 0,
    };
    let mut depth = 0_usize;
    let mut heading: Option<(HeadingLevel, Range<usize>, String)> = None; // the heading being read
    for (event, range) in Parser::new(text).into_offset_iter() {
        match event {
            Event::Start(tag) => {
                match tag {
                    Tag::Heading { level, .. } if depth == 0 => {
                        heading = Some((level, range, String::new()));
                    }
                    Tag::CodeBlock(CodeBlockKind::Fenced(info)) => {
                        walk.fenced(&info, range, depth == 0)?;
                    }
                    Tag::HtmlBlock if depth == 0 && text[range.clone()].starts_with("<!--") => {
                        walk.exclude(range);
                    }
                    _ => {}
                }
                depth += 1;
            }
            Event::End(tag) => {
                depth = depth.saturating_sub(1);
                if let (TagEnd::Heading(_), Some((level, whole, title))) =
                    (tag, heading.take_if(|_| depth == 0))
                {
                    walk.heading(level, whole, &title);
                }
            }
            Event::Text(part) | Event::Code(part) => {
                if let Some((_, _, title)) = &mut heading {
                    title.push_str(&part);
                }
            }
            _ => {}
        }
    }
    walk.text_up_to(text.len());
    Ok(walk.elements)
}

/// The state of the scan through a file.
struct FileWalk<'a, 'b> {
    text: &'a str,
    lines: &'b Lines,
    words: &'b [&'b str],
    elements: Vec<Element<'a>>,
    end: usize,
}

impl<'a> FileWalk<'a, '_> {
    /// Adds the text between the last element and `begin` as an element.
    fn text_up_to(&mut self, begin: usize) {
        let between = &self.text[self.end.min(begin)..begin];
        let blank: usize = between
            .split_inclusive('\n')
            .take_while(|line| line.trim().is_empty())
            .map(str::len)
            .sum();
        let text = between[blank..].trim_end();
        if !text.is_empty() {
            self.elements.push(Element {
                kind: PieceKind::Text(text),
                line: self.lines.at(self.end.min(begin) + blank),
            });
        }
        self.end = begin;
    }

    /// Excludes `range` from the text.
    fn exclude(&mut self, range: Range<usize>) {
        self.text_up_to(range.start);
        self.end = range.end;
    }

    fn add(&mut self, kind: PieceKind<'a>, range: Range<usize>) {
        let line = self.lines.at(range.start);
        self.exclude(range);
        self.elements.push(Element { kind, line });
    }

    fn heading(&mut self, level: HeadingLevel, range: Range<usize>, words: &str) {
        match level {
            HeadingLevel::H1 => self.add(PieceKind::Title(words.trim().to_owned()), range),
            HeadingLevel::H2 => self.add(PieceKind::Heading(words.trim().to_owned()), range),
            _ => {}
        }
    }

    /// Adds the fenced block at `range`. `is_alone` is false inside a list or a quotation.
    fn fenced(&mut self, info: &str, range: Range<usize>, is_alone: bool) -> Result<(), Problem> {
        let line = self.lines.at(range.start);
        let mut words = info.split_whitespace();
        let word = words.next().unwrap_or_default();
        let is_of_lessons = self.words.contains(&word);
        if !is_alone && is_of_lessons {
            let rule = "is in a list or a quotation: move it to the left margin";
            return Err(on_line(line, Problem::at(word, rule)));
        }
        if !is_alone {
            return Ok(());
        }
        let text = self.text;
        let block = &text[range.clone()];
        let inside = between_fences(block).ok_or_else(|| {
            let rule = format!("is not closed: end it with a line {}", fence_of(block));
            on_line(line, Problem::at(name_in_messages(word), rule))
        })?;
        if let Some(extra) = words.next().filter(|_| is_of_lessons) {
            let rule = format!("must be the only word after its fence: remove {extra}");
            return Err(on_line(line, Problem::at(word, rule)));
        }
        if let Some(at) = another_fence(inside, fence_of(block), self.words) {
            let begin = line + 1 + at;
            let rule = format!(
                "is not closed before line {begin}, where another block begins: end it with a line {}",
                fence_of(block)
            );
            return Err(on_line(line, Problem::at(name_in_messages(word), rule)));
        }
        let at = block.find(word).unwrap_or_default();
        let fenced = PieceKind::Fenced(&block[at..at + word.len()], inside);
        self.add(fenced, range);
        Ok(())
    }
}

/// Returns the name in messages of a block with this word after its fence.
fn name_in_messages(word: &str) -> &str {
    match word {
        "" => "```",
        word => word,
    }
}

/// Returns the opening fence of `block`.
fn fence_of(block: &str) -> &str {
    let begun = block.trim_start();
    let sign = begun.chars().next().unwrap_or('`');
    let rest = begun.trim_start_matches(sign);
    &begun[..begun.len() - rest.len()]
}

/// Returns the text between the fences of `block`, or `None` if the closing fence is missing.
fn between_fences(block: &str) -> Option<&str> {
    let fence = fence_of(block);
    let sign = fence.chars().next()?;
    let lines = block.trim_end_matches('\n');
    let begin = lines.find('\n')? + 1;
    let last = lines.rfind('\n')? + 1;
    let closing = lines[last..].trim();
    let closes = closing.len() >= fence.len() && closing.chars().all(|c| c == sign);
    (closes && last >= begin).then(|| &lines[begin..last])
}

/// Returns the line of `inside`, from 0, where another lesson block begins, with a fence at least as long as `fence`.
fn another_fence(inside: &str, fence: &str, words: &[&str]) -> Option<usize> {
    inside.lines().position(|line| {
        let rest = line.strip_prefix(fence);
        let word = rest.map(|rest| rest.trim_start_matches(['`', '~']).trim());
        word.is_some_and(|word| words.contains(&word))
    })
}
