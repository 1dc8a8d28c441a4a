//! The pieces of every size: moments, blocks of four, of eight, of sixteen and so on.

use super::block::{Block, Recorded};
use super::level::{Level, Piece, Pieces};
use std::ops::Range;

/// How many moments the smallest blocks have.
const SMALLEST: u64 = Recorded::IN_NEXT;

impl Piece for Recorded {
    // A stretch of more moments than these is given in blocks of four, a thousand of them or more. Twice as many would not
    // stay in the processor's nearer caches: a step would take 17 ns longer.
    const RECENT: usize = 4096;
    const IN_NEXT: u64 = 4;

    fn begin_s(&self) -> f64 {
        self.time_s
    }

    fn end_s(&self) -> f64 {
        self.time_s
    }

    fn block(&self) -> Block {
        Block::of(self)
    }
}

impl Piece for Block {
    const RECENT: usize = 2048;
    const IN_NEXT: u64 = 2;

    fn begin_s(&self) -> f64 {
        self.begin_s
    }

    fn end_s(&self) -> f64 {
        self.end_s
    }

    fn block(&self) -> Block {
        *self
    }
}

/// The pieces of every size. A size is an index: 0 for moments, 1 for blocks of four, 2 for blocks of eight and so on.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels {
    moments: Level<Recorded>,
    blocks: Vec<Level<Block>>,
}

impl Levels {
    /// How many moments a piece of `size` has.
    pub fn moments_in(size: usize) -> u64 {
        match size.checked_sub(1) {
            None => 1,
            Some(doubled) => SMALLEST << doubled,
        }
    }

    /// The sizes of which there are pieces.
    pub fn sizes(&self) -> Range<usize> {
        0..1 + self.blocks.len()
    }

    /// The pieces of `size`.
    pub fn of(&self, size: usize) -> Option<&dyn Pieces> {
        match size.checked_sub(1) {
            None => Some(&self.moments),
            Some(doubled) => Some(self.blocks.get(doubled)?),
        }
    }

    /// The pieces of the smallest size.
    pub fn moments(&self) -> &dyn Pieces {
        &self.moments
    }

    /// How many pieces of each size are stored.
    #[cfg(test)]
    pub fn stored(&self) -> impl Iterator<Item = usize> {
        let blocks = self.blocks.iter().map(Level::stored);
        std::iter::once(self.moments.stored()).chain(blocks)
    }

    /// Appends `moment`.
    #[inline]
    pub fn push(&mut self, moment: Recorded) {
        if self.moments.push(moment)
            && let Some(block) = Block::of_all(self.moments.newest(SMALLEST))
        {
            self.join(block);
        }
    }

    /// Appends a block of the smallest size, and the larger ones that it completes.
    fn join(&mut self, mut block: Block) {
        for level in &mut self.blocks {
            let first = level.waiting().next().copied();
            level.push(block);
            match first {
                Some(first) => block = first.and(&block),
                None => return,
            }
        }
        let mut largest = Level::default();
        largest.push(block);
        self.blocks.push(largest);
    }

    /// The pieces smaller than `size` that are in no larger one yet, in order of time. They follow the pieces of `size`;
    /// those of all sizes are the whole recording.
    pub fn newest(&self, size: usize) -> impl Iterator<Item = Block> + use<'_> {
        let doubled = size.saturating_sub(1).min(self.blocks.len());
        let blocks = self.blocks[..doubled].iter().rev();
        let blocks = blocks.flat_map(Level::waiting).copied();
        let moments = (size > 0).then(|| self.moments.waiting().map(Piece::block));
        blocks.chain(moments.into_iter().flatten())
    }

    /// Removes all moments after the first `wanted`, and a few more where the small pieces that are needed there have been
    /// dropped.
    pub fn cut_back(&mut self, wanted: u64) {
        let is_stuck = |size: &usize| {
            let pieces = self.of(*size);
            pieces.is_some_and(|pieces| !pieces.can_be_cut_to(wanted / Self::moments_in(*size)))
        };
        let stuck = self.sizes().rev().find(is_stuck);
        let least = Self::moments_in(stuck.map_or(0, |size| size + 1));
        let moments = wanted - wanted % least;
        self.moments.cut_to(moments);
        for (level, size) in self.blocks.iter_mut().zip(1..) {
            level.cut_to(moments / Self::moments_in(size));
        }
        self.blocks.retain(|level| level.count() > 0);
    }
}
