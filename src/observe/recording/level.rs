//! The blocks of one size.

use super::block::Block;
use std::collections::VecDeque;
use std::ops::Range;

/// The most blocks of one size that reach back to the start.
pub(super) const WHOLE: usize = 16_384;
/// How many blocks of one size are kept once there are more than that.
pub(super) const RECENT: usize = 2048;

/// The blocks of one size, in order and without gaps. The first of the run has the number 0; the oldest may be dropped.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    blocks: VecDeque<Block>,
    /// How many older blocks of this size have been dropped.
    dropped: u64,
}

impl Level {
    /// How many blocks of this size there have been.
    pub fn count(&self) -> u64 {
        self.dropped + self.blocks.len() as u64
    }

    /// How many of them are stored.
    #[cfg(test)]
    pub fn stored(&self) -> usize {
        self.blocks.len()
    }

    /// The newest block, if it is the first half of a block of the next size and still lacks the second half.
    pub fn waiting(&self) -> Option<&Block> {
        self.blocks
            .back()
            .filter(|_| !self.count().is_multiple_of(2))
    }

    /// Appends `block`; returns a block of the next size if this completes one.
    #[inline]
    pub fn push(&mut self, block: &Block) -> Option<Block> {
        let pair = self.waiting().map(|first| first.and(block));
        match (self.is_whole(), self.blocks.len()) {
            (true, WHOLE) => self.keep_recent(),
            (false, RECENT) => {
                self.blocks.pop_front();
                self.dropped += 1;
            }
            _ => {}
        }
        self.blocks.push_back(*block);
        pair
    }

    /// Drops the oldest blocks of the [`WHOLE`], so many that the block to come makes them [`RECENT`].
    #[cold]
    fn keep_recent(&mut self) {
        let excess = WHOLE + 1 - RECENT;
        self.blocks.drain(..excess);
        // A smaller memory is gone through in the processor's nearer caches.
        self.blocks.shrink_to(RECENT);
        self.dropped += excess as u64;
    }

    /// Whether it can be cut back to `count` blocks: if the last of them is a first half, it must not have been dropped.
    pub fn can_be_cut_to(&self, count: u64) -> bool {
        count.is_multiple_of(2) || count > self.dropped
    }

    /// Removes the blocks from number `count` on.
    pub fn cut_to(&mut self, count: u64) {
        let kept = count.saturating_sub(self.dropped);
        self.blocks.truncate(kept as usize);
        self.dropped = self.dropped.min(count);
    }

    /// Whether the block of this number and all later ones are stored, as far as there are any.
    pub fn has_from(&self, number: u64) -> bool {
        self.is_whole() || (!self.blocks.is_empty() && self.dropped <= number)
    }

    /// Whether all moments from `time_s` (s) on are in stored blocks, but for the newest, which may be in none yet.
    pub fn reaches(&self, time_s: f64) -> bool {
        let front = self.blocks.front();
        self.is_whole() || front.is_some_and(|block| block.begin_s <= time_s)
    }

    fn is_whole(&self) -> bool {
        self.dropped == 0
    }

    /// The numbers of the stored blocks that have a moment from `since_s` to `until_s` (s).
    pub fn between(&self, since_s: f64, until_s: f64) -> Range<u64> {
        let first = self.blocks.partition_point(|block| block.end_s < since_s);
        let end = self
            .blocks
            .partition_point(|block| block.begin_s <= until_s)
            .max(first);
        self.dropped + first as u64..self.dropped + end as u64
    }

    /// The block of this number, if it is stored.
    pub fn get(&self, number: u64) -> Option<&Block> {
        let place = number.checked_sub(self.dropped)?;
        self.blocks.get(place as usize)
    }

    /// The blocks of these numbers, as [`between`](Self::between) gives them.
    pub fn blocks<'a>(&'a self, numbers: &Range<u64>) -> impl Iterator<Item = &'a Block> + use<'a> {
        let place = |number: u64| (number - self.dropped) as usize;
        self.blocks.range(place(numbers.start)..place(numbers.end))
    }
}
