//! The data of the traces: the extremes of every curve over all steps, in bounded memory however long the run is.
//!
//! They are stored in blocks of one step, of two, of four and so on. Two blocks of one size make one of the next, so that
//! every step's value is within the extremes of some block. A size that still reaches back to the start has up to 16 384
//! blocks, a smaller one the newest 2048; any stretch of the run up to now is covered by a thousand blocks or more, or by
//! one for each step if it has fewer steps.
//!
//! A recording can be [cut back](Recording::cut_back) to an earlier moment. Its blocks there are coarser than they were
//! when that moment was the newest; [`coarse_since`](Recording::coarse_since) tells from which moment on it should be
//! recorded again.

mod block;
mod directions;
mod level;
mod stretch;

pub use block::{Block, Curve, Extent, Moment};
use directions::Directions;
use level::Level;
use stretch::Stretch;

/// A stretch is coarse if it has fewer blocks than this, each of more than one step.
const COARSE: u64 = 256;

/// The recorded part of a run, from its start to now.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// The blocks of every size, those of one step first.
    levels: Vec<Level>,
    moments: u64,
    whole: Option<Block>,
    directions: Directions,
}

impl Recording {
    /// Appends the next moment.
    pub fn push(&mut self, moment: &Moment) {
        let block = Block::of(moment, self.directions.go_on(moment.values()));
        match &mut self.whole {
            Some(whole) => whole.take_in(&block),
            None => self.whole = Some(block),
        }
        self.moments += 1;
        let mut carry = Some(block);
        let mut size = 0;
        while let Some(block) = &carry {
            if size == self.levels.len() {
                self.levels.push(Level::default());
            }
            carry = self.levels[size].push(block);
            size += 1;
        }
    }

    /// The number of recorded moments.
    pub fn moments(&self) -> u64 {
        self.moments
    }

    /// Removes all moments after the first `moments`, and a few more where the small blocks that are needed there have
    /// been dropped. Returns how many remain; the caller pushes the missing ones again.
    pub fn cut_back(&mut self, moments: u64) -> u64 {
        let wanted = self.moments.min(moments);
        let sizes = self.levels.iter().enumerate().rev();
        let mut stuck = sizes.filter(|(size, level)| !level.can_be_cut_to(wanted >> size));
        let size = stuck.next().map_or(0, |(size, _)| size + 1);
        self.moments = wanted >> size << size;
        for (size, level) in self.levels.iter_mut().enumerate() {
            level.cut_to(self.moments >> size);
        }
        self.levels.retain(|level| level.count() > 0);
        self.whole = self
            .since(f64::NEG_INFINITY)
            .copied()
            .reduce(|whole, block| whole.and(&block));
        // A turn at the newest moment that is left is not counted.
        self.directions = Directions::default();
        self.moments
    }

    /// The moment from which on the run should be recorded again, if some stretch up to now is coarse.
    pub fn coarse_since(&self) -> Option<u64> {
        let lengths = (0..u64::BITS).map(|power| 1 << power);
        let shorter = lengths.take_while(|&length| length < self.moments);
        let coarse = shorter
            .chain((self.moments > 0).then_some(self.moments))
            .filter(|&length| {
                let begin = self.moments - length;
                let reaches = |(size, level): &(usize, &Level)| level.has_from(begin >> size);
                let finest = self.levels.iter().enumerate().find(reaches);
                finest.is_some_and(|(size, _)| size > 0 && length >> size < COARSE)
            });
        coarse.last().map(|length| self.moments - length)
    }

    /// The whole recording as one block; `None` while nothing is recorded.
    pub fn whole(&self) -> Option<&Block> {
        self.whole.as_ref()
    }

    /// Blocks in order of time that cover everything from `since_s` (s) to now, as [`between`](Self::between) has them.
    pub fn since(&self, since_s: f64) -> impl Iterator<Item = &Block> {
        self.between(since_s, f64::INFINITY)
    }

    /// Blocks in order of time that cover everything from `since_s` to `until_s` (s): those of the smallest size that
    /// reaches back so far and has not too many, followed by smaller ones for the newest moments.
    pub fn between(&self, since_s: f64, until_s: f64) -> impl Iterator<Item = &Block> {
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
    ) -> impl Iterator<Item = &Block> {
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
