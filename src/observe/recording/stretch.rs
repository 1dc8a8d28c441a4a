//! The blocks that cover a stretch of the run.

use super::block::Block;
use super::level::Level;
use std::ops::Range;

/// A stretch is given as at most twice this many blocks of one size.
pub(super) const FINEST: u64 = 2048;

/// Which blocks cover a stretch: those of the smallest size that reaches back to its beginning and has not too many,
/// followed by smaller ones for the newest moments, which are in no block of that size yet.
pub(super) struct Stretch<'a> {
    /// The blocks of every size, those of one moment first.
    levels: &'a [Level],
    /// The smallest size that is suitable, as an index in `levels`.
    size: usize,
    /// The numbers of the blocks of that size.
    numbers: Range<u64>,
    since_s: f64,
    until_s: f64,
}

impl<'a> Stretch<'a> {
    /// The stretch from `since_s` to `until_s` (s).
    pub fn new(levels: &'a [Level], since_s: f64, until_s: f64) -> Self {
        let numbers = |level: &Level| level.between(since_s, until_s);
        let has_few = |numbers: Range<u64>| numbers.end - numbers.start <= 2 * FINEST;
        let suits = |level: &Level| level.reaches(since_s) && has_few(numbers(level));
        let size = levels.iter().position(suits).unwrap_or(0);
        Self {
            levels,
            size,
            numbers: levels.get(size).map_or(0..0, numbers),
            since_s,
            until_s,
        }
    }

    /// Its blocks in order of time.
    pub fn blocks(&self) -> impl Iterator<Item = &'a Block> + use<'a> {
        let of_size = self.levels.get(self.size);
        let covering = of_size.map(|level| level.blocks(&self.numbers));
        covering.into_iter().flatten().chain(self.newest())
    }

    /// The same for a picture in columns; `column` says in which one a time (s) is. The blocks of a column that are at its
    /// edges are the same, and those inside are given as larger ones.
    pub fn in_columns(self, column: impl Fn(f64) -> usize) -> impl Iterator<Item = &'a Block> {
        let newest = self.newest();
        let mut next = self.numbers.start;
        let joined = std::iter::from_fn(move || {
            let (block, count) = self.largest(next, &column)?;
            next += count;
            Some(block)
        });
        joined.chain(newest)
    }

    /// The newest moments that are in no block of its size yet.
    fn newest(&self) -> impl Iterator<Item = &'a Block> + use<'a> {
        let (since_s, until_s) = (self.since_s, self.until_s);
        let smaller = self.levels[..self.size.min(self.levels.len())].iter().rev();
        let newest = smaller.filter_map(Level::waiting);
        newest.filter(move |block| block.begin_s <= until_s && block.end_s >= since_s)
    }

    /// The largest block that begins where the block `number` of its size does, is inside the stretch and has its
    /// neighbours there in its own column; and how many blocks of its size that one is.
    fn largest(&self, number: u64, column: &impl Fn(f64) -> usize) -> Option<(&'a Block, u64)> {
        let numbers = &self.numbers;
        let level = self.levels.get(self.size)?;
        if number >= numbers.end {
            return None;
        }
        let mut largest = (level.get(number)?, 1);
        if number == numbers.start {
            return Some(largest);
        }
        let before = column(level.get(number - 1)?.end_s);
        for larger in &self.levels[self.size + 1..] {
            let count = 2 * largest.1;
            if !number.is_multiple_of(count) || number + count >= numbers.end {
                break;
            }
            let after = level.get(number + count)?;
            match larger.get(number / count) {
                Some(block) if column(after.begin_s) == before => largest = (block, count),
                _ => break,
            }
        }
        Some(largest)
    }
}
