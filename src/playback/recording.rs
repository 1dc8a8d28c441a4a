//! The least and the largest value of four curves over all steps of a run, in bounded memory however long it is.
//!
//! They are stored for blocks of one moment, of four, of eight, of sixteen and so on. A size that still reaches back to
//! the start has up to 16 384 blocks, and of a smaller size the newest 2048 are kept (4096 of one moment). So any stretch
//! of the run up to now is covered by a thousand blocks or more, or by one for each step if it has fewer steps.
//!
//! A recording can be [cut back](Recording::cut_back) to an earlier moment. Its blocks there are coarser than they were
//! when that moment was the newest; [`coarse_since`](Recording::coarse_since) tells from which moment on it should be
//! recorded again.

mod block;
mod level;

pub use block::{Block, Curve, Extent, Moment};
use level::Level;
use std::ops::Range;

/// A stretch is coarse if it has fewer blocks than this, each of more than one step.
const COARSE: u64 = 256;
/// A stretch is given in blocks of the next size where it would have more of those than this.
const FINEST: u64 = 2048;

#[derive(Clone, Debug, Default)]
pub struct Recording {
    levels: Vec<Level>,
    /// The values of the newest moment, and by how much each curve changed when it last did.
    before: Option<([f64; 4], [f64; 4])>,
}

impl Recording {
    #[inline]
    pub fn push(&mut self, moment: &Moment) {
        self.push_values(moment.time_s, moment.values());
    }

    /// Appends the values of the curves at the next moment, `time_s`.
    #[inline]
    pub fn push_values(&mut self, time_s: f64, values: [f64; 4]) {
        let mut block = Block::of(time_s, values, self.turned(values));
        for level in &mut self.levels {
            level.push(block);
            match level.completed() {
                Some(larger) => block = larger,
                None => return,
            }
        }
        let moments = self.levels.last().map_or(1, Level::moments_in_next);
        let mut largest = Level::new(moments);
        largest.push(block);
        self.levels.push(largest);
    }

    /// For each curve 1 where it turns at the newest moment, before the one that has `values`; else 0.
    #[inline]
    fn turned(&mut self, values: [f64; 4]) -> [u32; 4] {
        let (before, last) = self.before.unwrap_or((values, [0.0; 4]));
        let changes: [f64; 4] = std::array::from_fn(|curve| values[curve] - before[curve]);
        let kept = std::array::from_fn(|curve| {
            let change = changes[curve];
            if change == 0.0 { last[curve] } else { change }
        });
        self.before = Some((values, kept));
        std::array::from_fn(|curve| u32::from(changes[curve] * last[curve] < 0.0))
    }

    pub fn moments(&self) -> u64 {
        self.levels.first().map_or(0, Level::count)
    }

    /// Removes all moments after the first `moments`, and a few more where the small blocks that are needed there have
    /// been dropped. Returns how many remain; the caller pushes the missing ones again.
    pub fn cut_back(&mut self, moments: u64) -> u64 {
        let moments = self.moments().min(moments);
        let mut levels = self.levels.iter().rev();
        let stuck = levels.find(|level| !level.can_be_cut_to(moments / level.moments));
        let whole = stuck.map_or(1, Level::moments_in_next);
        let moments = moments - moments % whole;
        for level in &mut self.levels {
            level.cut_to(moments / level.moments);
        }
        self.levels.retain(|level| level.count() > 0);
        self.before = None; // a turn at the newest moment that is left is not counted
        moments
    }

    /// The moment from which on the run should be recorded again, if some stretch up to now is coarse.
    pub fn coarse_since(&self) -> Option<u64> {
        let moments = self.moments();
        let lengths = (0..u64::BITS).map(|power| 1 << power);
        let lengths = lengths.take_while(|&length| length < moments);
        let coarse = lengths.chain([moments]).filter(|length| {
            let begin = moments - length;
            let mut levels = self.levels.iter();
            let finest = levels.find(|level| level.has_from(begin / level.moments));
            finest.is_some_and(|level| level.moments > 1 && length / level.moments < COARSE)
        });
        coarse.last().map(|length| moments - length)
    }

    /// The whole recording as one block; `None` while nothing is recorded.
    pub fn whole(&self) -> Option<Block> {
        self.newest(self.levels.len()).reduce(Block::and)
    }

    /// The blocks smaller than those of `size` that are in no larger one yet, in order of time.
    fn newest(&self, size: usize) -> impl Iterator<Item = Block> {
        let smaller = self.levels[..size].iter().rev();
        smaller.flat_map(Level::waiting).copied()
    }

    /// Blocks in order of time that cover everything from `since_s` (s) to now, as [`between`](Self::between) has them.
    pub fn since(&self, since_s: f64) -> impl Iterator<Item = Block> {
        self.between(since_s, f64::INFINITY)
    }

    /// Blocks in order of time that cover everything from `since_s` to `until_s` (s): those of the smallest size that
    /// reaches back so far and has not too many, followed by smaller ones for the newest moments.
    pub fn between(&self, since_s: f64, until_s: f64) -> impl Iterator<Item = Block> {
        self.in_columns(since_s, until_s, None::<fn(f64) -> usize>)
    }

    /// The same stretch for a picture in columns; `column` says in which one a time (s) is. Of the blocks of one column
    /// those at its edges are as [`between`](Self::between) has them, and those inside are given as larger ones: of the same
    /// moments, but far fewer.
    pub fn in_columns(
        &self,
        since_s: f64,
        until_s: f64,
        column: Option<impl Fn(f64) -> usize>,
    ) -> impl Iterator<Item = Block> {
        let (size, numbers) = self.stretch(since_s, until_s);
        let mut next = numbers.start;
        let covering = std::iter::from_fn(move || {
            let (block, count) = self.largest(size, &numbers, next, column.as_ref())?;
            next += count;
            Some(block)
        });
        let newest = self.newest(size);
        covering
            .chain(newest.filter(move |block| block.begin_s <= until_s && block.end_s >= since_s))
    }

    /// The size of the blocks that cover a stretch of time (s), and their numbers.
    fn stretch(&self, since_s: f64, until_s: f64) -> (usize, Range<u64>) {
        let levels = self.levels.iter().enumerate();
        let mut suitable = levels.filter_map(|(size, level)| {
            let numbers = level.between(since_s, until_s);
            let are_few = numbers.end - numbers.start <= FINEST * level.in_next;
            (level.reaches(since_s) && are_few).then_some((size, numbers))
        });
        suitable.next().unwrap_or((0, 0..0))
    }

    /// The block `next` of `size`, or the largest one that begins there, is inside of the stretch of these `numbers` and has
    /// its neighbours there in its own column; and how many blocks of `size` that one is.
    fn largest(
        &self,
        size: usize,
        numbers: &Range<u64>,
        next: u64,
        column: Option<&impl Fn(f64) -> usize>,
    ) -> Option<(Block, u64)> {
        let level = self.levels.get(size).filter(|_| next < numbers.end)?;
        let mut largest = (*level.get(next)?, 1);
        let Some(column) = column.filter(|_| next > numbers.start) else {
            return Some(largest);
        };
        let before = column(level.get(next - 1)?.end_s);
        for larger in &self.levels[size + 1..] {
            let count = larger.moments / level.moments;
            if !next.is_multiple_of(count) || next + count >= numbers.end {
                break;
            }
            let after = level.get(next + count)?;
            match larger.get(next / count) {
                Some(block) if column(after.begin_s) == before => largest = (*block, count),
                _ => break,
            }
        }
        Some(largest)
    }

    /// The smallest blocks that are stored of each part of the run, in order of time.
    pub fn finest(&self) -> impl Iterator<Item = Block> {
        let mut covered = 0;
        let levels = self.levels.iter().enumerate().rev();
        levels.flat_map(move |(size, level)| {
            let smaller = size.checked_sub(1).map(|size| &self.levels[size]);
            let end = smaller.map_or(u64::MAX, |smaller| smaller.dropped() * smaller.moments);
            let begin = covered / level.moments;
            let end = end.div_ceil(level.moments).clamp(begin, level.count());
            covered = end * level.moments;
            (begin..end).filter_map(|number| level.get(number).copied())
        })
    }

    /// The extremes of `curve` from `since_s` to `until_s` (s), in its unit; `None` where nothing is recorded.
    pub fn extent_between(&self, since_s: f64, until_s: f64, curve: Curve) -> Option<Extent> {
        let blocks = self.in_columns(since_s, until_s, Some(|_| 0));
        let stored = blocks.map(|block| block.stored(curve)).reduce(Extent::and);
        stored.map(|stored| curve.in_its_unit(stored))
    }
}

#[cfg(test)]
mod tests;
