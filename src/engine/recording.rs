//! Minimum and maximum of four curves over all steps of a run, in bounded memory.
//!
//! They are stored for bins of one sample, four, eight, sixteen and so on. A size that still covers the whole run has
//! up to 16 384 bins. Of a smaller size, only the newest 2048 bins are kept (4096 of one sample). So any time interval
//! up to now is covered by a thousand bins or more, or by one bin per step if it has fewer steps.
//!
//! A recording can be [cut back](Recording::cut_back) to an earlier sample. The bins there are then coarser than they
//! were when that sample was the newest. [`coarse_since`](Recording::coarse_since) returns the sample from which on it
//! should be recorded again.

mod bin;

pub use bin::{Extent, RecordedCurve, RecordedSample, RecordingBin};
use std::collections::VecDeque;
use std::ops::Range;

/// Minimum number of bins in an interval. With fewer bins of more than one step, the interval is coarse.
const COARSE: u64 = 256;
/// Maximum number of bins of the next size in an interval. With more, that next size is used.
const MOST_STRETCH_BINS: u64 = 2048;

#[derive(Clone, Debug, Default)]
pub struct Recording {
    levels: Vec<Level>,
    /// Values of the newest sample, and the last nonzero change of each curve.
    before: Option<([f64; 4], [f64; 4])>,
}

impl Recording {
    #[inline]
    pub fn push(&mut self, sample: &RecordedSample) {
        self.push_values(sample.time_s, sample.values());
    }

    /// Appends the values of the curves at the next sample, at `time_s`.
    #[inline]
    pub fn push_values(&mut self, time_s: f64, values: [f64; 4]) {
        let mut bin = RecordingBin::new(time_s, values, self.turned(values));
        for level in &mut self.levels {
            level.push(bin);
            match level.completed() {
                Some(larger) => bin = larger,
                None => return,
            }
        }
        let samples = self.levels.last().map_or(1, Level::samples_in_next);
        let mut largest = Level::new(samples);
        largest.push(bin);
        self.levels.push(largest);
    }

    /// Returns 1 for each curve that turns at the newest sample, before the sample with `values`; otherwise 0.
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

    pub fn samples(&self) -> u64 {
        self.levels.first().map_or(0, Level::count)
    }

    /// Removes all samples after the first `samples`, and a few more if the small bins needed there have been dropped.
    /// Returns the number that remains. The caller must push the missing samples again.
    pub fn cut_back(&mut self, samples: u64) -> u64 {
        let wanted = self.samples().min(samples);
        let mut levels = self.levels.iter().rev();
        let stuck = levels.find(|level| !level.can_be_cut_to(wanted / level.samples));
        let remaining = wanted - wanted % stuck.map_or(1, Level::samples_in_next);
        for level in &mut self.levels {
            let count = remaining / level.samples;
            let kept = count.saturating_sub(level.dropped);
            level.bins.truncate(kept as usize);
            level.dropped = level.dropped.min(count);
        }
        self.levels.retain(|level| level.count() > 0);
        self.before = None; // a turn at the last remaining sample is not counted
        remaining
    }

    /// Returns the sample from which on the run should be recorded again, if some interval up to now is coarse.
    pub fn coarse_since(&self) -> Option<u64> {
        let samples = self.samples();
        (0..u64::BITS)
            .map(|power| 1 << power)
            .take_while(|&length| length < samples)
            .chain([samples])
            .filter(|length| {
                let begin = samples - length;
                let mut levels = self.levels.iter();
                let finest = levels.find(|level| level.has_from(begin / level.samples));
                finest.is_some_and(|level| level.samples > 1 && length / level.samples < COARSE)
            })
            .last()
            .map(|length| samples - length)
    }

    /// Returns the whole recording as one bin. `None` if nothing is recorded.
    pub fn whole(&self) -> Option<RecordingBin> {
        self.newest(self.levels.len()).reduce(RecordingBin::and)
    }

    /// Returns the bins below the size `size` that are not yet in a larger bin, in order of time.
    fn newest(&self, size: usize) -> impl Iterator<Item = RecordingBin> {
        let smaller = self.levels[..size].iter().rev();
        smaller.flat_map(Level::waiting).copied()
    }

    /// Returns bins in order of time that cover everything from `since_s` (s) to now; see [`between`](Self::between).
    pub fn since(&self, since_s: f64) -> impl Iterator<Item = RecordingBin> {
        self.between(since_s, f64::INFINITY)
    }

    /// Returns bins in order of time that cover everything from `since_s` to `until_s` (s). They have the smallest size
    /// that reaches back far enough and is not too numerous, followed by smaller bins for the newest samples.
    pub fn between(&self, since_s: f64, until_s: f64) -> impl Iterator<Item = RecordingBin> {
        self.in_columns(since_s, until_s, None::<fn(f64) -> usize>)
    }

    /// Returns the same bins, merged for a picture in columns. `column` returns the column of a time (s). The bins at
    /// the edges of a column are those of [`between`](Self::between). Those inside it are replaced by far fewer, larger
    /// bins with the same samples.
    pub fn in_columns(
        &self,
        since_s: f64,
        until_s: f64,
        column: Option<impl Fn(f64) -> usize>,
    ) -> impl Iterator<Item = RecordingBin> {
        let (size, numbers) = self.bins_covering(since_s, until_s);
        let mut next = numbers.start;
        let covering = std::iter::from_fn(move || {
            let (bin, count) = self.largest(size, &numbers, next, column.as_ref())?;
            next += count;
            Some(bin)
        });
        let newest = self.newest(size);
        covering.chain(newest.filter(move |bin| bin.begin_s <= until_s && bin.end_s >= since_s))
    }

    /// Returns the size of the bins that cover a time interval (s), and their numbers.
    fn bins_covering(&self, since_s: f64, until_s: f64) -> (usize, Range<u64>) {
        let levels = self.levels.iter().enumerate();
        let mut suitable = levels.filter_map(|(size, level)| {
            let numbers = level.between(since_s, until_s);
            let are_few = numbers.end - numbers.start <= MOST_STRETCH_BINS * level.in_next;
            (level.reaches(since_s) && are_few).then_some((size, numbers))
        });
        suitable.next().unwrap_or((0, 0..0))
    }

    /// Returns the bin `next` of `size`, or the largest bin that begins there, together with its length in bins of
    /// `size`. The larger bin must lie inside the interval of `numbers`, and its neighbors must be in the same column.
    fn largest(
        &self,
        size: usize,
        numbers: &Range<u64>,
        next: u64,
        column: Option<&impl Fn(f64) -> usize>,
    ) -> Option<(RecordingBin, u64)> {
        let level = self.levels.get(size).filter(|_| next < numbers.end)?;
        let mut largest = (*level.get(next)?, 1);
        let Some(column) = column.filter(|_| next > numbers.start) else {
            return Some(largest);
        };
        let before = column(level.get(next - 1)?.end_s);
        for larger in &self.levels[size + 1..] {
            let count = larger.samples / level.samples;
            if !next.is_multiple_of(count) || next + count >= numbers.end {
                break;
            }
            let after = level.get(next + count)?;
            match larger.get(next / count) {
                Some(bin) if column(after.begin_s) == before => largest = (*bin, count),
                _ => break,
            }
        }
        Some(largest)
    }

    /// Returns the smallest stored bins of each part of the run, in order of time.
    pub fn finest(&self) -> impl Iterator<Item = RecordingBin> {
        let mut covered = 0;
        let levels = self.levels.iter().enumerate().rev();
        levels.flat_map(move |(size, level)| {
            let smaller = size.checked_sub(1).map(|size| &self.levels[size]);
            let since = smaller.map_or(u64::MAX, |smaller| smaller.dropped * smaller.samples);
            let begin = covered / level.samples;
            let end = since.div_ceil(level.samples).clamp(begin, level.count());
            covered = end * level.samples;
            (begin..end).filter_map(|number| level.get(number).copied())
        })
    }

    /// Returns the extremes of `curve` from `since_s` to `until_s` (s), in its unit. `None` if nothing is recorded.
    pub fn extent_between(
        &self,
        since_s: f64,
        until_s: f64,
        curve: RecordedCurve,
    ) -> Option<Extent> {
        let bins = self.in_columns(since_s, until_s, Some(|_| 0));
        let stored = bins.map(|bin| bin.stored(curve)).reduce(Extent::and);
        stored.map(|stored| curve.in_its_unit(stored))
    }
}

const WHOLE_RUN_BINS: usize = 16_384;
/// Once a level drops its oldest bins, it keeps this number times `in_next`. With more, steps would take longer,
/// because the bins would not stay in the processor's nearer caches.
const RECENT: usize = 1024;

/// Bins of one size, in order and without gaps. The first of the run has the number 0. The oldest ones may be dropped.
#[derive(Clone, Debug)]
struct Level {
    bins: VecDeque<RecordingBin>,
    dropped: u64,
    pub samples: u64,
    /// Number of bins that make one of the next size; a power of two.
    pub in_next: u64,
}

impl Level {
    pub fn new(samples: u64) -> Self {
        Self {
            bins: VecDeque::new(),
            dropped: 0,
            samples,
            in_next: if samples == 1 { 4 } else { 2 },
        }
    }

    #[inline]
    pub fn push(&mut self, bin: RecordingBin) {
        let recent = RECENT * self.in_next as usize;
        let stored = self.bins.len();
        if self.dropped == 0 && stored == WHOLE_RUN_BINS {
            self.keep_recent(recent - 1);
        } else if self.dropped > 0 && stored == recent {
            self.bins.pop_front();
            self.dropped += 1;
        }
        self.bins.push_back(bin);
    }

    #[cold]
    fn keep_recent(&mut self, kept: usize) {
        let excess = WHOLE_RUN_BINS - kept;
        self.bins.drain(..excess);
        // Smaller memory stays in the processor's nearer caches.
        self.bins.shrink_to(kept + 1);
        self.dropped += excess as u64;
    }

    /// Returns the bin of the next size that the newest bins have just completed, if any.
    #[inline]
    pub fn completed(&self) -> Option<RecordingBin> {
        if self.count() & (self.in_next - 1) != 0 {
            return None;
        }
        self.newest(self.in_next).copied().reduce(RecordingBin::and)
    }

    #[inline]
    fn newest(&self, count: u64) -> impl Iterator<Item = &RecordingBin> {
        let begin = self.bins.len().saturating_sub(count as usize);
        self.bins.range(begin..)
    }

    /// Returns the newest bins that are not yet in a bin of the next size.
    pub fn waiting(&self) -> impl Iterator<Item = &RecordingBin> {
        self.newest(self.count() & (self.in_next - 1))
    }

    #[inline]
    pub fn count(&self) -> u64 {
        self.dropped + self.bins.len() as u64
    }

    pub fn samples_in_next(&self) -> u64 {
        self.samples * self.in_next
    }

    /// Returns true if the level can be cut back to `count` bins. The bins that will then be [waiting](Self::waiting)
    /// must not have been dropped.
    pub fn can_be_cut_to(&self, count: u64) -> bool {
        let waiting = count & (self.in_next - 1);
        waiting == 0 || count - waiting >= self.dropped
    }

    /// Returns true if the bin of this number and all later ones are stored, as far as they exist.
    pub fn has_from(&self, number: u64) -> bool {
        self.dropped == 0 || (!self.bins.is_empty() && self.dropped <= number)
    }

    /// Returns true if all samples from `time_s` (s) on are in stored bins. The newest samples may not be in a bin yet.
    pub fn reaches(&self, time_s: f64) -> bool {
        let front = self.bins.front();
        self.dropped == 0 || front.is_some_and(|bin| bin.begin_s <= time_s)
    }

    /// Returns the numbers of the stored bins with samples from `since_s` to `until_s` (s).
    pub fn between(&self, since_s: f64, until_s: f64) -> Range<u64> {
        let first = self.bins.partition_point(|bin| bin.end_s < since_s);
        let end = self.bins.partition_point(|bin| bin.begin_s <= until_s);
        self.dropped + first as u64..self.dropped + end.max(first) as u64
    }

    pub fn get(&self, number: u64) -> Option<&RecordingBin> {
        self.bins.get(number.checked_sub(self.dropped)? as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn push(recording: &mut Recording, step: u64, value: f64) {
        recording.push_values(step as f64, [value, 0.0, 0.0, -value]);
    }

    fn recorded(values: &[f64]) -> Recording {
        let mut recording = Recording::default();
        let values = values.iter().zip(0..);
        values.for_each(|(&value, step)| push(&mut recording, step, value));
        recording
    }

    /// Checks that `bins` begin at `since` or before, and follow each other without gaps. Returns the end of the last
    /// one.
    fn end_of(bins: &[RecordingBin], since: f64) -> f64 {
        assert!(bins[0].begin_s <= since);
        for pair in bins.windows(2) {
            assert_eq!(pair[0].end_s + 1.0, pair[1].begin_s);
        }
        bins[bins.len() - 1].end_s
    }

    proptest! {
        #[test]
        fn bins_cover_every_step_exactly_once(length in 1usize..20_000, share in 0.0..1.0f64) {
            let recording = recorded(&vec![0.0; length]);
            let since = (share * length as f64).floor();
            let bins: Vec<_> = recording.since(since).collect();
            prop_assert_eq!(end_of(&bins, since), (length - 1) as f64);
            prop_assert!(bins.len() <= 4 * MOST_STRETCH_BINS as usize + 16);
        }

        #[test]
        fn columns_have_the_same_samples_in_fewer_bins(
            length in 1usize..40_000, columns in 1usize..300, ends in (0.0..1.0f64, 0.0..1.2f64)
        ) {
            let values: Vec<f64> = (0..length).map(|step| libm::sin(step as f64 * 0.37)).collect();
            let recording = recorded(&values);
            let [since, until] = [ends.0, ends.1].map(|share| (share * length as f64).floor());
            let column = |time_s: f64| (time_s / length as f64 * columns as f64) as usize;
            let single: Vec<_> = recording.between(since, until).collect();
            let joined: Vec<_> = recording.in_columns(since, until, Some(column)).collect();
            let mut rest = single.iter();
            for bin in &joined {
                let parts: Vec<_> = rest.by_ref().take_while(|part| part.end_s < bin.end_s).collect();
                // take_while() has consumed the last part too.
                prop_assert!(parts.first().is_none_or(|part| part.begin_s == bin.begin_s));
                prop_assert!(parts.is_empty() || column(bin.begin_s) == column(bin.end_s));
            }
            prop_assert_eq!(rest.count(), 0);
            let samples = |bins: &[RecordingBin]| bins.iter().map(RecordingBin::samples).sum::<u64>();
            prop_assert_eq!(samples(&single), samples(&joined));
            // The first and last bin of each column are the same, so the lines from column to column are too.
            for pair in joined.windows(2).filter(|pair| column(pair[0].end_s) != column(pair[1].begin_s)) {
                prop_assert!(single.contains(&pair[0]) && single.contains(&pair[1]));
            }
            let most = single.len().min(columns.min(single.len()) * 26 + 16);
            prop_assert!(joined.len() <= most, "{} of {} in {columns}", joined.len(), single.len());
            let extent = single.iter().map(|bin| bin.extent(RecordedCurve::X)).reduce(Extent::and);
            prop_assert_eq!(recording.extent_between(since, until, RecordedCurve::X), extent);
        }

        #[test]
        fn no_extreme_is_lost(at in 0usize..9_000, length in 9_000usize..10_000) {
            let mut values = vec![0.0; length];
            values[at] = 7.0;
            let recording = recorded(&values);
            let largest = recording.since(0.0).map(|bin| bin.extents[0].max).fold(0.0, f64::max);
            prop_assert_eq!(largest, 7.0);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn a_refilled_recording_is_as_fine_as_before(
            length in 1u64..200_000, shares in prop::collection::vec(0.0..1.0f64, 1..4), at in 0.0..1.0f64
        ) {
            let value = |step: u64| if step == (at * length as f64) as u64 { 7.0 } else { libm::sin(step as f64 * 0.01) };
            let mut recording = Recording::default();
            (0..length).for_each(|step| push(&mut recording, step, value(step)));
            prop_assert_eq!(recording.coarse_since(), None);
            for share in shares {
                let wanted = 1 + (share * (length - 1) as f64) as u64;
                let mut kept = recording.cut_back(wanted);
                prop_assert!(kept <= wanted);
                if let Some(from) = recording.coarse_since() {
                    prop_assert!(wanted - from <= length / 8, "{} of {}", wanted - from, length);
                    kept = recording.cut_back(from);
                }
                (kept..wanted).for_each(|step| push(&mut recording, step, value(step)));
                prop_assert_eq!(recording.samples(), wanted);
                prop_assert_eq!(recording.coarse_since(), None);
                for since in [0.0, 0.4, 0.9, 0.999] {
                    let since = (since * wanted as f64).floor();
                    let bins: Vec<_> = recording.since(since).collect();
                    prop_assert_eq!(end_of(&bins, since), (wanted - 1) as f64);
                    let (bins, steps) = (bins.len() as f64, wanted as f64 - since);
                    prop_assert!(bins >= steps.min(0.45 * COARSE as f64), "{bins} since {since} of {wanted}");
                }
                let largest = (0..wanted).map(value).fold(-1.0, f64::max);
                prop_assert_eq!(recording.whole().unwrap().extents[0].max, largest);
                (wanted..length).for_each(|step| push(&mut recording, step, value(step)));
                let bins: Vec<_> = recording.since(0.0).collect();
                prop_assert_eq!(end_of(&bins, 0.0), (recording.samples() - 1) as f64);
            }
        }
    }

    #[test]
    fn bins_count_the_turns_of_a_curve() {
        let turns = |recording: &Recording| recording.whole().unwrap().turns(RecordedCurve::X);
        // Ten swings of a triangle about 5, from 0 to 10 and back in 20 steps each.
        let values: Vec<f64> = (0..=200)
            .map(|step: u64| (10.0 - (step % 20) as f64).abs())
            .collect();
        let recording = recorded(&values);
        assert_eq!(recording.whole().unwrap().samples(), 201);
        assert_eq!(turns(&recording), 19);
        let bins = recording.since(0.0).map(|bin| bin.turns(RecordedCurve::X));
        assert_eq!(bins.sum::<u32>(), 19);
        // A pause before continuing in the same direction is not a turn.
        assert_eq!(turns(&recorded(&[0.0, 1.0, 1.0, 2.0, 2.0, 1.0])), 1);
    }

    #[test]
    fn an_early_interval_has_finer_bins_than_the_whole_run() {
        let values: Vec<f64> = (0..100_000).map(f64::from).collect();
        let recording = recorded(&values);
        let bins: Vec<_> = recording.between(10_000.0, 11_000.0).collect();
        assert!(end_of(&bins, 10_000.0) >= 11_000.0);
        assert!((100..200).contains(&bins.len()), "{}", bins.len());
    }

    #[test]
    fn memory_is_bounded() {
        let recording = recorded(&vec![0.0; 1_000_000]);
        let stored = |level: &Level| level.count() - level.dropped;
        let stored: Vec<u64> = recording.levels.iter().map(stored).collect();
        assert_eq!(stored[0], 4096);
        let larger: u64 = stored[1..].iter().sum();
        assert!(
            larger <= 2048 * 8 + 2 * WHOLE_RUN_BINS as u64,
            "{larger} bins"
        );
        // The smallest bins cover the run without a gap.
        let bins: Vec<_> = recording.finest().collect();
        assert_eq!(end_of(&bins, 0.0), 999_999.0);
        let newest = &bins[bins.len() - 4000..];
        assert!(newest.iter().all(|bin| bin.samples() == 1));
    }
}
