//! The pieces of one size.

use super::block::Block;
use std::collections::VecDeque;
use std::ops::Range;

/// The most pieces of one size that reach back to the start.
pub(super) const WHOLE: usize = 16_384;

/// A part of the run that is stored as one: a moment, or a block of several.
pub(super) trait Piece: Copy {
    /// How many pieces of its size are kept once there are more than [`WHOLE`].
    const RECENT: usize;
    /// How many of them make a piece of the next size.
    const IN_NEXT: u64;

    /// Time of its first moment, s.
    fn begin_s(&self) -> f64;

    /// Time of its last moment, s.
    fn end_s(&self) -> f64;

    /// The same as a block.
    fn block(&self) -> Block;
}

/// The pieces of one size, in order and without gaps. The first of the run has the number 0; the oldest may be dropped.
#[derive(Clone, Debug)]
pub(super) struct Level<P> {
    pieces: VecDeque<P>,
    /// How many older pieces of this size have been dropped.
    dropped: u64,
}

impl<P> Default for Level<P> {
    fn default() -> Self {
        Self {
            pieces: VecDeque::new(),
            dropped: 0,
        }
    }
}

impl<P: Piece> Level<P> {
    /// Appends `piece`. Returns whether it completes one of the next size.
    #[inline]
    pub fn push(&mut self, piece: P) -> bool {
        match (self.is_whole(), self.pieces.len()) {
            (true, WHOLE) => self.keep_recent(),
            (false, stored) if stored == P::RECENT => {
                self.pieces.pop_front();
                self.dropped += 1;
            }
            _ => {}
        }
        self.pieces.push_back(piece);
        self.count().is_multiple_of(P::IN_NEXT)
    }

    /// Drops the oldest pieces of the [`WHOLE`], so many that the piece to come makes them [`RECENT`](Piece::RECENT).
    #[cold]
    fn keep_recent(&mut self) {
        let excess = WHOLE + 1 - P::RECENT;
        self.pieces.drain(..excess);
        // A smaller memory is gone through in the processor's nearer caches.
        self.pieces.shrink_to(P::RECENT);
        self.dropped += excess as u64;
    }

    /// The newest `count` pieces.
    #[inline]
    pub fn newest(&self, count: u64) -> impl Iterator<Item = &P> {
        let begin = self.pieces.len().saturating_sub(count as usize);
        self.pieces.range(begin..)
    }

    /// The newest pieces, which are in no piece of the next size yet.
    #[inline]
    pub fn waiting(&self) -> impl Iterator<Item = &P> {
        self.newest(self.count() % P::IN_NEXT)
    }
}

impl<P> Level<P> {
    /// How many pieces are stored.
    #[cfg(test)]
    pub fn stored(&self) -> usize {
        self.pieces.len()
    }

    fn is_whole(&self) -> bool {
        self.dropped == 0
    }
}

/// The pieces of one size, whichever it is.
pub(super) trait Pieces {
    /// How many there have been.
    fn count(&self) -> u64;

    /// How many of them make a piece of the next size.
    fn in_next(&self) -> u64;

    /// Whether they can be cut back to `count`: those that will then be [waiting](Level::waiting) must not have been
    /// dropped.
    fn can_be_cut_to(&self, count: u64) -> bool;

    /// Removes those from number `count` on.
    fn cut_to(&mut self, count: u64);

    /// Whether the one of this number and all later ones are stored, as far as there are any.
    fn has_from(&self, number: u64) -> bool;

    /// Whether all moments from `time_s` (s) on are in stored pieces, but for the newest, which may be in none yet.
    fn reaches(&self, time_s: f64) -> bool;

    /// The numbers of the stored ones that have a moment from `since_s` to `until_s` (s).
    fn between(&self, since_s: f64, until_s: f64) -> Range<u64>;

    /// The one of this number, if it is stored.
    fn get(&self, number: u64) -> Option<Block>;
}

impl<P: Piece> Pieces for Level<P> {
    #[inline]
    fn count(&self) -> u64 {
        self.dropped + self.pieces.len() as u64
    }

    fn in_next(&self) -> u64 {
        P::IN_NEXT
    }

    fn can_be_cut_to(&self, count: u64) -> bool {
        let waiting = count % P::IN_NEXT;
        waiting == 0 || count - waiting >= self.dropped
    }

    fn cut_to(&mut self, count: u64) {
        let kept = count.saturating_sub(self.dropped);
        self.pieces.truncate(kept as usize);
        self.dropped = self.dropped.min(count);
    }

    fn has_from(&self, number: u64) -> bool {
        self.is_whole() || (!self.pieces.is_empty() && self.dropped <= number)
    }

    fn reaches(&self, time_s: f64) -> bool {
        let front = self.pieces.front();
        self.is_whole() || front.is_some_and(|piece| piece.begin_s() <= time_s)
    }

    fn between(&self, since_s: f64, until_s: f64) -> Range<u64> {
        let first = self.pieces.partition_point(|piece| piece.end_s() < since_s);
        let end = self
            .pieces
            .partition_point(|piece| piece.begin_s() <= until_s)
            .max(first);
        self.dropped + first as u64..self.dropped + end as u64
    }

    fn get(&self, number: u64) -> Option<Block> {
        let place = number.checked_sub(self.dropped)?;
        self.pieces.get(place as usize).map(P::block)
    }
}
