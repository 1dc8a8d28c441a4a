//! The blocks of one size.

use super::block::Block;
use std::collections::VecDeque;
use std::ops::Range;

pub(super) const WHOLE: usize = 16_384;
/// How many are kept once there are more, for each one that a block of the next size has. With more of them a step would
/// take longer: they would not stay in the processor's nearer caches.
const RECENT: usize = 1024;

/// The blocks of one size, in order and without gaps. The first of the run has the number 0; the oldest may be dropped.
#[derive(Clone, Debug)]
pub(super) struct Level {
    blocks: VecDeque<Block>,
    dropped: u64,
    pub moments: u64,
    /// How many of them make a block of the next size; a power of two.
    pub in_next: u64,
}

impl Level {
    pub fn new(moments: u64) -> Self {
        Self {
            blocks: VecDeque::new(),
            dropped: 0,
            moments,
            in_next: if moments == 1 { 4 } else { 2 },
        }
    }

    #[inline]
    pub fn push(&mut self, block: Block) {
        let recent = RECENT * self.in_next as usize;
        let stored = self.blocks.len();
        if self.dropped == 0 && stored == WHOLE {
            self.keep_recent(recent - 1);
        } else if self.dropped > 0 && stored == recent {
            self.blocks.pop_front();
            self.dropped += 1;
        }
        self.blocks.push_back(block);
    }

    #[cold]
    fn keep_recent(&mut self, kept: usize) {
        let excess = WHOLE - kept;
        self.blocks.drain(..excess);
        // A smaller memory is gone through in the processor's nearer caches.
        self.blocks.shrink_to(kept + 1);
        self.dropped += excess as u64;
    }

    /// The block of the next size that the newest blocks make, where they just make one.
    #[inline]
    pub fn completed(&self) -> Option<Block> {
        if self.count() & (self.in_next - 1) != 0 {
            return None;
        }
        self.newest(self.in_next).copied().reduce(Block::and)
    }

    #[inline]
    fn newest(&self, count: u64) -> impl Iterator<Item = &Block> {
        let begin = self.blocks.len().saturating_sub(count as usize);
        self.blocks.range(begin..)
    }

    /// The newest blocks, which are in no block of the next size yet.
    pub fn waiting(&self) -> impl Iterator<Item = &Block> {
        self.newest(self.count() & (self.in_next - 1))
    }

    #[inline]
    pub fn count(&self) -> u64 {
        self.dropped + self.blocks.len() as u64
    }

    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    pub fn moments_in_next(&self) -> u64 {
        self.moments * self.in_next
    }

    /// Whether it can be cut back to `count` blocks: those that will then be [waiting](Self::waiting) must not have been
    /// dropped.
    pub fn can_be_cut_to(&self, count: u64) -> bool {
        let waiting = count & (self.in_next - 1);
        waiting == 0 || count - waiting >= self.dropped
    }

    pub fn cut_to(&mut self, count: u64) {
        let kept = count.saturating_sub(self.dropped);
        self.blocks.truncate(kept as usize);
        self.dropped = self.dropped.min(count);
    }

    /// Whether the block of this number and all later ones are stored, as far as there are any.
    pub fn has_from(&self, number: u64) -> bool {
        self.dropped == 0 || (!self.blocks.is_empty() && self.dropped <= number)
    }

    /// Whether all moments from `time_s` (s) on are in stored blocks, but for the newest, which may be in none yet.
    pub fn reaches(&self, time_s: f64) -> bool {
        let front = self.blocks.front();
        self.dropped == 0 || front.is_some_and(|block| block.begin_s <= time_s)
    }

    /// The numbers of the stored blocks that have a moment from `since_s` to `until_s` (s).
    pub fn between(&self, since_s: f64, until_s: f64) -> Range<u64> {
        let first = self.blocks.partition_point(|block| block.end_s < since_s);
        let end = self
            .blocks
            .partition_point(|block| block.begin_s <= until_s);
        self.dropped + first as u64..self.dropped + end.max(first) as u64
    }

    pub fn get(&self, number: u64) -> Option<&Block> {
        self.blocks.get(number.checked_sub(self.dropped)? as usize)
    }
}
