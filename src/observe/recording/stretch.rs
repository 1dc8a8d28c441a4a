//! The pieces that cover a stretch of the run.

use super::block::Block;
use super::level::Pieces;
use super::levels::Levels;
use std::ops::Range;

/// A stretch is given in pieces of the next size where it would have more of those than this.
pub(super) const FINEST: u64 = 2048;

/// Which pieces cover a stretch: those of the smallest size that reaches back to its beginning and has not too many,
/// followed by smaller ones for the newest moments, which are in no piece of that size yet.
pub(super) struct Stretch<'a> {
    levels: &'a Levels,
    /// The smallest size that is suitable.
    size: usize,
    /// The pieces of that size.
    pieces: &'a dyn Pieces,
    /// The numbers of those that cover the stretch.
    numbers: Range<u64>,
    since_s: f64,
    until_s: f64,
}

impl<'a> Stretch<'a> {
    /// The stretch from `since_s` to `until_s` (s).
    pub fn new(levels: &'a Levels, since_s: f64, until_s: f64) -> Self {
        let numbers = |pieces: &dyn Pieces| pieces.between(since_s, until_s);
        let suits = |pieces: &dyn Pieces| {
            let numbers = numbers(pieces);
            let are_few = numbers.end - numbers.start <= FINEST * pieces.in_next();
            pieces.reaches(since_s) && are_few
        };
        let sizes = levels
            .sizes()
            .filter_map(|size| Some((size, levels.of(size)?)));
        let mut suitable = sizes.filter(|(_, pieces)| suits(*pieces));
        let (size, pieces) = suitable.next().unwrap_or((0, levels.moments()));
        Self {
            levels,
            size,
            pieces,
            numbers: numbers(pieces),
            since_s,
            until_s,
        }
    }

    /// Its pieces in order of time.
    pub fn blocks(&self) -> impl Iterator<Item = Block> + use<'a> {
        let pieces = self.pieces;
        let covering = self.numbers.clone();
        let covering = covering.filter_map(move |number| pieces.get(number));
        covering.chain(self.newest())
    }

    /// The same for a picture in columns; `column` says in which one a time (s) is. The pieces of a column that are at its
    /// edges are the same, and those inside are given as larger ones.
    pub fn in_columns(self, column: impl Fn(f64) -> usize) -> impl Iterator<Item = Block> {
        let newest = self.newest();
        let mut next = self.numbers.start;
        let joined = std::iter::from_fn(move || {
            let (block, count) = self.largest(next, &column)?;
            next += count;
            Some(block)
        });
        joined.chain(newest)
    }

    /// The newest moments that are in no piece of its size yet.
    fn newest(&self) -> impl Iterator<Item = Block> + use<'a> {
        let (since_s, until_s) = (self.since_s, self.until_s);
        let newest = self.levels.newest(self.size);
        newest.filter(move |block| block.begin_s <= until_s && block.end_s >= since_s)
    }

    /// The largest piece that begins where the piece `number` of its size does, is inside the stretch and has its
    /// neighbours there in its own column; and how many pieces of its size that one is.
    fn largest(&self, number: u64, column: &impl Fn(f64) -> usize) -> Option<(Block, u64)> {
        let numbers = &self.numbers;
        if number >= numbers.end {
            return None;
        }
        let mut largest = (self.pieces.get(number)?, 1);
        if number == numbers.start {
            return Some(largest);
        }
        let before = column(self.pieces.get(number - 1)?.end_s);
        for size in self.size + 1..self.levels.sizes().end {
            let count = Levels::moments_in(size) / Levels::moments_in(self.size);
            if !number.is_multiple_of(count) || number + count >= numbers.end {
                break;
            }
            let after = self.pieces.get(number + count)?;
            match self.levels.of(size)?.get(number / count) {
                Some(block) if column(after.begin_s) == before => largest = (block, count),
                _ => break,
            }
        }
        Some(largest)
    }
}
