//! The data of the traces: the extremes of every curve over all steps, in bounded memory however long the run is.
//!
//! They are stored as single moments, and in blocks of four of them, of eight, of sixteen and so on, so that every step's
//! value is within the extremes of some block. A size that still reaches back to the start has up to 16 384 blocks, a
//! smaller one the newest 2048, and of the moments the newest 4096 are kept. So any stretch of the run up to now is covered
//! by a thousand blocks or more, or by one for each step if it has fewer steps.
//!
//! A recording can be [cut back](Recording::cut_back) to an earlier moment. Its blocks there are coarser than they were
//! when that moment was the newest; [`coarse_since`](Recording::coarse_since) tells from which moment on it should be
//! recorded again.

mod block;
mod directions;
mod level;
mod levels;
mod stretch;

use block::Recorded;
pub use block::{Block, Curve, Extent, Moment};
use directions::Directions;
use levels::Levels;
use stretch::Stretch;

/// A stretch is coarse if it has fewer blocks than this, each of more than one step.
const COARSE: u64 = 256;

/// The recorded part of a run, from its start to now.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    levels: Levels,
    directions: Directions,
}

impl Recording {
    /// Appends the next moment.
    #[inline]
    pub fn push(&mut self, moment: &Moment) {
        let turned = self.directions.go_on(moment.values());
        self.levels.push(Recorded::new(moment, turned));
    }

    /// The number of recorded moments.
    pub fn moments(&self) -> u64 {
        self.levels.moments().count()
    }

    /// Removes all moments after the first `moments`, and a few more where the small blocks that are needed there have
    /// been dropped. Returns how many remain; the caller pushes the missing ones again.
    pub fn cut_back(&mut self, moments: u64) -> u64 {
        self.levels.cut_back(self.moments().min(moments));
        // A turn at the newest moment that is left is not counted.
        self.directions = Directions::default();
        self.moments()
    }

    /// The moment from which on the run should be recorded again, if some stretch up to now is coarse.
    pub fn coarse_since(&self) -> Option<u64> {
        let moments = self.moments();
        let lengths = (0..u64::BITS).map(|power| 1 << power);
        let shorter = lengths.take_while(|&length| length < moments);
        let coarse = shorter
            .chain((moments > 0).then_some(moments))
            .filter(|&length| {
                let begin = moments - length;
                let reaches = |size: &usize| {
                    let pieces = self.levels.of(*size);
                    pieces.is_some_and(|pieces| pieces.has_from(begin / Levels::moments_in(*size)))
                };
                let finest = self.levels.sizes().find(reaches);
                finest.is_some_and(|size| size > 0 && length / Levels::moments_in(size) < COARSE)
            });
        coarse.last().map(|length| moments - length)
    }

    /// The whole recording as one block; `None` while nothing is recorded.
    pub fn whole(&self) -> Option<Block> {
        let parts = self.levels.newest(self.levels.sizes().end);
        parts.reduce(|whole, block| whole.and(&block))
    }

    /// Blocks in order of time that cover everything from `since_s` (s) to now, as [`between`](Self::between) has them.
    pub fn since(&self, since_s: f64) -> impl Iterator<Item = Block> {
        self.between(since_s, f64::INFINITY)
    }

    /// Blocks in order of time that cover everything from `since_s` to `until_s` (s): those of the smallest size that
    /// reaches back so far and has not too many, followed by smaller ones for the newest moments.
    pub fn between(&self, since_s: f64, until_s: f64) -> impl Iterator<Item = Block> {
        Stretch::new(&self.levels, since_s, until_s).blocks()
    }

    /// The same stretch for a picture in columns; `column` says in which one a time (s) is. Of the blocks of one column
    /// those at its edges are as [`between`](Self::between) has them, and those inside are given as larger ones: of the same
    /// moments, but far fewer.
    pub fn in_columns(
        &self,
        since_s: f64,
        until_s: f64,
        column: impl Fn(f64) -> usize,
    ) -> impl Iterator<Item = Block> {
        Stretch::new(&self.levels, since_s, until_s).in_columns(column)
    }

    /// The extremes of `curve` from `since_s` to `until_s` (s), in its unit; `None` where nothing is recorded.
    pub fn extent_between(&self, since_s: f64, until_s: f64, curve: Curve) -> Option<Extent> {
        let blocks = self.in_columns(since_s, until_s, |_| 0);
        let stored = blocks.map(|block| block.stored(curve)).reduce(Extent::and);
        stored.map(|stored| curve.in_its_unit(stored))
    }
}

#[cfg(test)]
mod tests;
