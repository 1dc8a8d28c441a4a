//! What a page states: its texts with the numbers that the run had when it had arrived where the page wants it. They stay
//! as they are while the student plays on.

use super::lesson::{Block, Compare, Lesson};
use super::place::Place;
use crate::lab::Lab;
use std::collections::BTreeMap;

/// The texts of a page that the student's own run does not change, by their lines in the file.
#[derive(Clone, Debug)]
pub(super) struct Stated {
    texts: BTreeMap<usize, String>,
}

impl Stated {
    /// What the page at `place` states of the run in `lab`. What stands behind a task or a check is not among it.
    pub(super) fn of(lesson: &Lesson, place: &Place, lab: &Lab) -> Self {
        let texts = blocks(lesson, place).filter_map(|block| match block {
            Block::Text(text) => Some((text.line, text.with_numbers(lab, &place.kept))),
            Block::Compare(compare) => Some((compare.line, compared(compare, lesson, place, lab))),
            _ => None,
        });
        Self {
            texts: texts.collect(),
        }
    }

    pub(super) fn text(&self, line: usize) -> Option<&str> {
        self.texts.get(&line).map(String::as_str)
    }

    /// Puts the prediction called `name`, which has just been locked, into what is stated about it.
    pub(super) fn take_in(&mut self, name: &str, lesson: &Lesson, place: &Place, lab: &Lab) {
        for block in blocks(lesson, place) {
            if let Block::Compare(compare) = block
                && compare.prediction == name
            {
                let text = compared(compare, lesson, place, lab);
                self.texts.insert(compare.line, text);
            }
        }
    }
}

/// The introduction's blocks, and those of the page up to its task or its first check.
fn blocks<'a>(lesson: &'a Lesson, place: &Place) -> impl Iterator<Item = &'a Block> {
    let page = lesson.page(place.page);
    let blocks = page.into_iter().flat_map(|page| &page.blocks);
    let is_before = |block: &&Block| !matches!(block, Block::Task(_) | Block::Check(_));
    lesson
        .introduction
        .iter()
        .chain(blocks.take_while(is_before))
}

fn compared(compare: &Compare, lesson: &Lesson, place: &Place, lab: &Lab) -> String {
    compare.filled(lesson, &place.predictions, lab, &place.kept)
}
