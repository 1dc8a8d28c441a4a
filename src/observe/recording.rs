//! The data of the traces: the extremes of every curve over all steps, in bounded memory however long the run is.
//!
//! They are stored in blocks of one step, of two, of four and so on. Two blocks of one size make one of the next, so that
//! every step's value is within the extremes of some block. A size that still reaches back to the start has up to 16 384
//! blocks, a smaller one the newest 2048; any stretch of the run up to now is covered by a thousand blocks or more.
//!
//! A recording can be [cut back](Recording::cut_back) to an earlier moment. Its blocks there are coarser than they were
//! when that moment was the newest; [`coarse_since`](Recording::coarse_since) tells from which moment on it should be
//! recorded again.

mod block;

pub use block::{Block, Curve, Extent, Moment};
use std::collections::VecDeque;
use std::ops::Range;

/// The most blocks of one size that reach back to the start.
const WHOLE: usize = 16_384;
/// How many blocks of one size are kept once there are more than that.
const RECENT: usize = 2048;
/// A stretch is given as at most twice this many blocks of one size.
const FINEST: usize = 2048;
/// A stretch is coarse if it has fewer blocks than this, each of more than one step.
const COARSE: u64 = 256;

/// The blocks of one size, in order and without gaps.
#[derive(Clone, Debug, Default)]
struct Level {
    blocks: VecDeque<Block>,
    /// How many older blocks of this size have been dropped.
    dropped: u64,
}

impl Level {
    /// How many blocks of this size there have been.
    fn count(&self) -> u64 {
        self.dropped + self.blocks.len() as u64
    }

    /// The newest block, if it is the first half of a block of the next size and still lacks the second half.
    fn waiting(&self) -> Option<&Block> {
        self.blocks
            .back()
            .filter(|_| !self.count().is_multiple_of(2))
    }

    /// Appends `block`; returns a block of the next size if this completes one.
    #[inline]
    fn push(&mut self, block: &Block) -> Option<Block> {
        let pair = self.waiting().map(|first| first.and(block));
        let most = if self.dropped == 0 { WHOLE } else { RECENT };
        if self.blocks.len() == most {
            self.drop_old(most);
        }
        self.blocks.push_back(*block);
        pair
    }

    /// Makes room for one more block among the newest.
    fn drop_old(&mut self, stored: usize) {
        let excess = stored + 1 - RECENT;
        if excess == 1 {
            self.blocks.pop_front();
        } else {
            self.blocks.drain(..excess);
            // A smaller memory is gone through in the processor's nearer caches.
            self.blocks.shrink_to(RECENT);
        }
        self.dropped += excess as u64;
    }

    /// Whether it can be cut back to `count` blocks: if the last of them is a first half, it must not have been dropped.
    fn can_be_cut_to(&self, count: u64) -> bool {
        count.is_multiple_of(2) || count > self.dropped
    }

    fn cut_to(&mut self, count: u64) {
        let kept = count.saturating_sub(self.dropped);
        self.blocks.truncate(kept as usize);
        self.dropped = self.dropped.min(count);
    }

    fn is_whole(&self) -> bool {
        self.dropped == 0
    }

    /// The index of the first stored block that ends at `time_s` or later.
    fn first_since(&self, time_s: f64) -> usize {
        self.blocks.partition_point(|block| block.end_s < time_s)
    }

    /// The index of the first stored block that begins later than `time_s`.
    fn first_from(&self, time_s: f64) -> usize {
        self.blocks.partition_point(|block| block.begin_s <= time_s)
    }

    fn reaches(&self, time_s: f64) -> bool {
        let front = self.blocks.front();
        self.is_whole() || front.is_some_and(|block| block.begin_s <= time_s)
    }
}

/// The recorded part of a run, from its start to now.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    levels: Vec<Level>,
    moments: u64,
    whole: Option<Block>,
    course: Course,
}

/// In which direction each curve goes.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// The stored values of the newest moment.
    values: Option<[f64; 4]>,
    /// By how much each curve changed when it last did; 0 before it has changed.
    changes: [f64; 4],
}

impl Course {
    /// Goes on to `values`; gives which curves have turned.
    fn go_on(&mut self, values: [f64; 4]) -> [bool; 4] {
        let before = self.values.replace(values).unwrap_or(values);
        std::array::from_fn(|curve| {
            let (change, last) = (values[curve] - before[curve], self.changes[curve]);
            let (is_up, is_down) = (change > 0.0, change < 0.0);
            self.changes[curve] = if is_up | is_down { change } else { last };
            (is_up & (last < 0.0)) | (is_down & (last > 0.0))
        })
    }
}

impl Recording {
    /// Appends the next moment.
    pub fn push(&mut self, moment: &Moment) {
        let block = Block::of(moment, self.course.go_on(moment.values()));
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
        // A turn at the very place of the cut is not counted.
        self.course = Course::default();
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
                let reaches = |(size, level): &(usize, &Level)| {
                    level.is_whole() || (!level.blocks.is_empty() && level.dropped << size <= begin)
                };
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
        let (size, range) = self.covering(since_s, until_s);
        let covering = self.levels.get(size..=size).into_iter().flatten();
        let covering = covering.flat_map(move |level| level.blocks.range(range.clone()));
        covering.chain(self.newest(size, since_s, until_s))
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
        let (size, range) = self.covering(since_s, until_s);
        let mut next = range.start;
        let joined = std::iter::from_fn(move || {
            let (block, count) = self.largest(size, next, &range, &column)?;
            next += count;
            Some(block)
        });
        joined.chain(self.newest(size, since_s, until_s))
    }

    /// The extremes of `curve` from `since_s` to `until_s` (s), in its unit; `None` where nothing is recorded.
    pub fn extent_between(&self, since_s: f64, until_s: f64, curve: Curve) -> Option<Extent> {
        let blocks = self.in_columns(since_s, until_s, |_| 0);
        let stored = blocks.map(|block| block.stored(curve)).reduce(Extent::and);
        stored.map(|stored| curve.in_its_unit(stored))
    }

    /// The smallest size of blocks that reaches back to `since_s` and has not too many up to `until_s` (s), and which of its
    /// stored blocks those are.
    fn covering(&self, since_s: f64, until_s: f64) -> (usize, Range<usize>) {
        let range = |level: &Level| {
            let first = level.first_since(since_s);
            first..level.first_from(until_s).max(first)
        };
        let suits = |level: &Level| level.reaches(since_s) && range(level).len() <= 2 * FINEST;
        let size = self.levels.iter().position(suits).unwrap_or(0);
        (size, self.levels.get(size).map_or(0..0, range))
    }

    /// The newest moments from `since_s` to `until_s` (s) that are in no block of `size` yet.
    fn newest(&self, size: usize, since_s: f64, until_s: f64) -> impl Iterator<Item = &Block> {
        let newest = self.levels[..size.min(self.levels.len())].iter().rev();
        let newest = newest.filter_map(Level::waiting);
        newest.filter(move |block| block.begin_s <= until_s && block.end_s >= since_s)
    }

    /// The largest block that begins where the stored block `at` of `size` does, is inside `range` and has its neighbours
    /// there in its own column; and how many blocks of `size` it is.
    fn largest(
        &self,
        size: usize,
        at: usize,
        range: &Range<usize>,
        column: &impl Fn(f64) -> usize,
    ) -> Option<(&Block, usize)> {
        let level = self.levels.get(size).filter(|_| at < range.end)?;
        let mut largest = (level.blocks.get(at)?, 1);
        if at == range.start {
            return Some(largest);
        }
        let before = column(level.blocks[at - 1].end_s);
        let index = level.dropped + at as u64;
        for larger in &self.levels[size + 1..] {
            let count = 2 * largest.1;
            let (place, rest) = (index / count as u64, index % count as u64);
            if rest != 0 || at + count >= range.end {
                break;
            }
            let stored = place.checked_sub(larger.dropped);
            let stored = stored.and_then(|place| larger.blocks.get(place as usize));
            match stored {
                Some(block) if column(level.blocks[at + count].begin_s) == before => {
                    largest = (block, count);
                }
                _ => break,
            }
        }
        Some(largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn moment(step: u64, value: f64) -> Moment {
        Moment {
            time_s: step as f64,
            position: Vector3::new(value, 0.0, 0.0),
            axle_height: value,
        }
    }

    fn recorded(values: &[f64]) -> Recording {
        let mut recording = Recording::default();
        values
            .iter()
            .zip(0..)
            .for_each(|(&value, step)| recording.push(&moment(step, value)));
        recording
    }

    proptest! {
        #[test]
        fn every_step_is_in_exactly_one_block_of_a_stretch(length in 1usize..20_000, share in 0.0..1.0f64) {
            let recording = recorded(&vec![0.0; length]);
            let since = (share * length as f64).floor();
            let blocks: Vec<_> = recording.since(since).collect();
            prop_assert!(blocks[0].begin_s <= since);
            prop_assert_eq!(blocks[blocks.len() - 1].end_s, (length - 1) as f64);
            for pair in blocks.windows(2) {
                prop_assert_eq!(pair[0].end_s + 1.0, pair[1].begin_s);
            }
            prop_assert!(blocks.len() <= 2 * FINEST + 16);
        }

        #[test]
        fn columns_have_the_same_moments_in_fewer_blocks(
            length in 1usize..40_000, columns in 1usize..300, ends in (0.0..1.0f64, 0.0..1.2f64)
        ) {
            let values: Vec<f64> = (0..length).map(|step| (step as f64 * 0.37).sin()).collect();
            let recording = recorded(&values);
            let [since, until] = [ends.0, ends.1].map(|share| (share * length as f64).floor());
            let column = |time_s: f64| (time_s / length as f64 * columns as f64) as usize;
            let single: Vec<_> = recording.between(since, until).collect();
            let joined: Vec<_> = recording.in_columns(since, until, column).collect();
            let is_inside = |block: &&&Block| column(block.begin_s) == column(block.end_s);
            let mut rest = single.iter();
            for block in &joined {
                let parts: Vec<_> = rest.by_ref().take_while(|part| part.end_s < block.end_s).collect();
                // take_while() has taken the last part too.
                prop_assert!(parts.first().is_none_or(|part| part.begin_s == block.begin_s));
                prop_assert!(parts.is_empty() || is_inside(&block));
            }
            prop_assert_eq!(rest.count(), 0);
            let moments = |blocks: &[&Block]| blocks.iter().map(|block| block.moments()).sum::<u64>();
            prop_assert_eq!(moments(&single), moments(&joined));
            // The first and the last of every column are the same, so that lines from column to column are.
            for pair in joined.windows(2).filter(|pair| column(pair[0].end_s) != column(pair[1].begin_s)) {
                prop_assert!(single.contains(&pair[0]) && single.contains(&pair[1]));
            }
            let most = single.len().min(columns.min(single.len()) * 26 + 16);
            prop_assert!(joined.len() <= most, "{} of {} in {columns}", joined.len(), single.len());
            let extent = single.iter().map(|block| block.extent(Curve::X)).reduce(Extent::and);
            prop_assert_eq!(recording.extent_between(since, until, Curve::X), extent);
        }

        #[test]
        fn no_extreme_is_lost(at in 0usize..9_000, length in 9_000usize..10_000) {
            let mut values = vec![0.0; length];
            values[at] = 7.0;
            let recording = recorded(&values);
            let largest = recording.since(0.0).map(|block| block.extents[0].max).fold(0.0, f64::max);
            prop_assert_eq!(largest, 7.0);
        }
    }

    /// Checks that from `since` on every moment is in exactly one block, and that the blocks are in order.
    fn covers(recording: &Recording, since: f64) -> Result<(), TestCaseError> {
        let blocks: Vec<_> = recording.since(since).collect();
        prop_assert!(blocks[0].begin_s <= since);
        prop_assert_eq!(
            blocks[blocks.len() - 1].end_s,
            (recording.moments() - 1) as f64
        );
        for pair in blocks.windows(2) {
            prop_assert_eq!(pair[0].end_s + 1.0, pair[1].begin_s);
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn cut_back_and_filled_it_is_as_fine_as_ever(
            length in 1u64..200_000, shares in prop::collection::vec(0.0..1.0f64, 1..4), at in 0.0..1.0f64
        ) {
            let value = |step: u64| if step == (at * length as f64) as u64 { 7.0 } else { (step as f64 * 0.01).sin() };
            let mut recording = Recording::default();
            (0..length).for_each(|step| recording.push(&moment(step, value(step))));
            prop_assert_eq!(recording.coarse_since(), None);
            for share in shares {
                let wanted = 1 + (share * (length - 1) as f64) as u64;
                let mut kept = recording.cut_back(wanted);
                prop_assert!(kept <= wanted);
                if let Some(from) = recording.coarse_since() {
                    prop_assert!(wanted - from <= length / 8, "{} of {}", wanted - from, length);
                    kept = recording.cut_back(from);
                }
                (kept..wanted).for_each(|step| recording.push(&moment(step, value(step))));
                prop_assert_eq!(recording.moments(), wanted);
                prop_assert_eq!(recording.coarse_since(), None);
                for since in [0.0, 0.4, 0.9, 0.999] {
                    let since = (since * wanted as f64).floor();
                    covers(&recording, since)?;
                    let blocks = recording.since(since).count() as f64;
                    prop_assert!(blocks >= (wanted as f64 - since).min(0.45 * COARSE as f64), "{blocks} since {since} of {wanted}");
                }
                let largest = (0..wanted).map(value).fold(-1.0, f64::max);
                prop_assert_eq!(recording.whole().unwrap().extents[0].max, largest);
                (wanted..length).for_each(|step| recording.push(&moment(step, value(step))));
                covers(&recording, 0.0)?;
            }
        }
    }

    #[test]
    fn a_block_knows_its_mean_and_how_often_the_curve_turns() {
        // Ten swings of a triangle about 5, from 0 to 10 and back in 20 steps each.
        let triangle = |step: u64| (10.0 - (step % 20) as f64).abs();
        let values: Vec<f64> = (0..=200).map(triangle).collect();
        let recording = recorded(&values);
        let whole = recording.whole().unwrap();
        assert_eq!((whole.moments(), whole.turns(Curve::X)), (201, 19));
        let mean = values.iter().sum::<f64>() / 201.0;
        assert!((whole.mean(Curve::X) - mean).abs() < 1e-12);
        let turns: u32 = recording
            .since(0.0)
            .map(|block| block.turns(Curve::X))
            .sum();
        assert_eq!(turns, 19);
        // It stands still, and goes on in the same direction: no turn.
        assert_eq!(
            recorded(&[0.0, 1.0, 1.0, 2.0, 2.0, 1.0])
                .whole()
                .unwrap()
                .turns(Curve::X),
            1
        );
    }

    #[test]
    fn a_stretch_long_ago_has_more_blocks_than_a_part_of_all() {
        let values: Vec<f64> = (0..100_000).map(f64::from).collect();
        let recording = recorded(&values);
        let blocks: Vec<_> = recording.between(10_000.0, 11_000.0).collect();
        assert!(blocks[0].begin_s <= 10_000.0 && blocks[blocks.len() - 1].end_s >= 11_000.0);
        assert!(
            blocks
                .windows(2)
                .all(|pair| pair[0].end_s + 1.0 == pair[1].begin_s)
        );
        assert!((100..200).contains(&blocks.len()), "{}", blocks.len());
    }

    #[test]
    fn memory_is_bounded() {
        let mut recording = Recording::default();
        (0..1_000_000).for_each(|step| recording.push(&moment(step, 0.0)));
        let kept: usize = recording
            .levels
            .iter()
            .map(|level| level.blocks.len())
            .sum();
        assert!(kept <= RECENT * 10 + 2 * WHOLE, "{kept} blocks");
    }
}
