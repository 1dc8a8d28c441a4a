//! Converts Markdown to the paragraphs of a page.

use crate::lab::sheet::{Emphasis, Paragraph, SheetLineKind, StyledText};
use pulldown_cmark::{Event, Parser, Tag, TagEnd};

/// Returns the paragraphs of `source`. Plain paragraphs get the kind `kind`.
pub fn paragraphs(source: &str, kind: &SheetLineKind) -> Vec<Paragraph> {
    let mut pen = MarkdownReader {
        kind,
        done: Vec::new(),
        words: Vec::new(),
        emphasis: Emphasis::Plain,
        lists: Vec::new(),
        mark: String::new(),
        block: None,
    };
    for event in Parser::new(source) {
        pen.read_event(event);
    }
    pen.end();
    pen.done
}

/// The state of the conversion.
struct MarkdownReader<'a> {
    kind: &'a SheetLineKind,
    done: Vec<Paragraph>,
    words: Vec<StyledText>,
    emphasis: Emphasis,
    /// Open lists, each with the number of its next entry if it is numbered.
    lists: Vec<Option<u64>>,
    /// Mark of the current entry; a blank after its first paragraph.
    mark: String,
    /// Kind of the current paragraph if it is code or a heading.
    block: Option<SheetLineKind>,
}

impl MarkdownReader<'_> {
    fn read_event(&mut self, event: Event<'_>) {
        match event {
            Event::Start(tag) => self.start(&tag),
            Event::End(tag) => self.stop(tag),
            Event::Text(text) => self.write(&text, self.emphasis),
            Event::Code(code) => self.write(&code, Emphasis::Code),
            Event::SoftBreak | Event::HardBreak => self.write(" ", self.emphasis),
            // Other elements have no text.
            _ => {}
        }
    }

    fn start(&mut self, tag: &Tag<'_>) {
        match tag {
            Tag::Strong | Tag::Emphasis => self.emphasis = Emphasis::Strong,
            Tag::List(first) => {
                self.end();
                self.lists.push(*first);
            }
            Tag::Item => {
                self.end();
                let number = self.lists.last_mut().and_then(Option::as_mut);
                self.mark = number.map_or("-".to_owned(), |number| {
                    *number += 1;
                    format!("{}.", *number - 1)
                });
            }
            Tag::CodeBlock(_) => self.begin(Some(SheetLineKind::Code)),
            Tag::Heading { .. } => self.begin(Some(SheetLineKind::Heading)),
            Tag::Paragraph => self.begin(None),
            _ => {}
        }
    }

    fn stop(&mut self, tag: TagEnd) {
        match tag {
            TagEnd::Strong | TagEnd::Emphasis => self.emphasis = Emphasis::Plain,
            TagEnd::List(_) => {
                self.end();
                self.lists.pop();
            }
            TagEnd::Item | TagEnd::Paragraph | TagEnd::CodeBlock | TagEnd::Heading(_) => {
                self.begin(None);
            }
            _ => {}
        }
    }

    /// Ends the current paragraph and begins one of this kind, or a plain one.
    fn begin(&mut self, block: Option<SheetLineKind>) {
        self.end();
        self.block = block;
    }

    fn write(&mut self, text: &str, emphasis: Emphasis) {
        match self.words.last_mut() {
            Some(words) if words.emphasis == emphasis => words.text.push_str(text),
            _ => self.words.push(StyledText {
                text: text.to_owned(),
                emphasis,
            }),
        }
    }

    /// Ends the current paragraph.
    fn end(&mut self) {
        let words = std::mem::take(&mut self.words);
        if words.iter().all(|words| words.text.trim().is_empty()) {
            return;
        }
        let depth = self.lists.len() as u16;
        let mark = std::mem::replace(&mut self.mark, " ".to_owned());
        let kind = match &self.block {
            Some(block) => block.clone(),
            None if depth > 0 => SheetLineKind::Item { mark, depth },
            None => self.kind.clone(),
        };
        self.done.push(Paragraph { kind, words });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converts_the_markdown_that_lessons_use() {
        let source =
            "The **fast** top\nturns `p`.\n\n1. one\n2. two\n   - deep\n\n```text\na  b\n```\n";
        let read = paragraphs(source, &SheetLineKind::Text);
        let item = |mark: &str, depth| SheetLineKind::Item {
            mark: mark.to_owned(),
            depth,
        };
        let kinds_and_texts = read.iter().map(|read| (read.kind.clone(), read.text()));
        let expected = [
            (SheetLineKind::Text, "The fast top turns p."),
            (item("1.", 1), "one"),
            (item("2.", 1), "two"),
            (item("-", 2), "deep"),
            (SheetLineKind::Code, "a  b\n"),
        ];
        assert!(
            kinds_and_texts.eq(expected.map(|(kind, text)| (kind, text.to_owned()))),
            "{read:?}"
        );
        let looks: Vec<_> = read[0].words.iter().map(|words| words.emphasis).collect();
        let plain = Emphasis::Plain;
        assert_eq!(
            looks,
            [plain, Emphasis::Strong, plain, Emphasis::Code, plain]
        );
    }
}
