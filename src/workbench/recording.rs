//! What the traces are drawn from: every step's extremes, however long the run, in bounded memory.
//!
//! Blocks of one step, of two, of four and so on, a few thousand of each size. Two full blocks of one size make
//! one of the next, so that any stretch of the run up to now is covered by blocks of some size, a thousand or more to
//! a window, and no step's minimum or maximum is ever lost to the picture.

use crate::physics::State;
use crate::physics::observables;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// How many blocks of each size are kept.
const KEPT: usize = 2048;

/// The curves that are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// x of the traced point, world frame, m.
    X,
    /// y of the traced point, world frame, m.
    Y,
    /// z of the traced point, world frame, m.
    Z,
    /// Angle of the axle from +z, degrees.
    Tilt,
}

impl Curve {
    /// Every curve, in the order in which blocks hold them.
    pub const ALL: [Self; 4] = [Self::X, Self::Y, Self::Z, Self::Tilt];
}

/// Where the body is at one moment, as far as the pictures go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Time, s.
    pub time_s: f64,
    /// The traced point, world frame, m.
    pub position: Vector3<f64>,
    /// Angle of the axle from +z, degrees.
    pub tilt_deg: f64,
}

impl Moment {
    /// Reads `state`, whose traced point stands at `traced` (body frame, m).
    pub fn new(state: &State, traced: &Vector3<f64>) -> Self {
        Self {
            time_s: state.time_s,
            position: state.orientation * traced,
            tilt_deg: observables::tilt_deg(state),
        }
    }

    fn values(&self) -> [f64; 4] {
        let at = &self.position;
        [at.x, at.y, at.z, self.tilt_deg]
    }
}

/// The smallest and largest value on a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

impl Extent {
    /// The extent of one value.
    pub fn of(value: f64) -> Self {
        Self {
            min: value,
            max: value,
        }
    }

    /// The extent of both.
    pub fn and(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// A stretch of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Time of its first moment, s.
    pub begin_s: f64,
    /// Time of its last moment, s.
    pub end_s: f64,
    /// Extremes of each curve, see [`Curve::ALL`].
    pub extents: [Extent; 4],
    /// The traced point at its last moment, world frame, m.
    pub end: Vector3<f64>,
}

impl Block {
    fn of(moment: &Moment) -> Self {
        Self {
            begin_s: moment.time_s,
            end_s: moment.time_s,
            extents: moment.values().map(Extent::of),
            end: moment.position,
        }
    }

    fn and(&self, later: &Self) -> Self {
        Self {
            begin_s: self.begin_s,
            end_s: later.end_s,
            extents: std::array::from_fn(|curve| self.extents[curve].and(later.extents[curve])),
            end: later.end,
        }
    }
}

/// All blocks of one size.
#[derive(Clone, Debug, Default)]
struct Level {
    blocks: VecDeque<Block>,
    /// The first half of the block of the next size.
    waiting: Option<Block>,
    /// Whether blocks have been dropped, so that this level no longer reaches back to the start.
    dropped: bool,
}

impl Level {
    /// Takes `block`; gives a block of the next size where it completes one.
    fn push(&mut self, block: Block) -> Option<Block> {
        if self.blocks.len() == KEPT {
            self.blocks.pop_front();
            self.dropped = true;
        }
        self.blocks.push_back(block);
        match self.waiting.take() {
            Some(first) => Some(first.and(&block)),
            None => {
                self.waiting = Some(block);
                None
            }
        }
    }

    fn reaches(&self, time_s: f64) -> bool {
        !self.dropped
            || self
                .blocks
                .front()
                .is_some_and(|block| block.begin_s <= time_s)
    }
}

/// The recorded part of a run, from its start to now.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    levels: Vec<Level>,
    whole: Option<Block>,
}

impl Recording {
    /// Takes the next moment.
    pub fn push(&mut self, moment: &Moment) {
        let block = Block::of(moment);
        self.whole = Some(self.whole.map_or(block, |whole| whole.and(&block)));
        let mut carry = Some(block);
        let mut size = 0;
        while let Some(block) = carry {
            if size == self.levels.len() {
                self.levels.push(Level::default());
            }
            carry = self.levels[size].push(block);
            size += 1;
        }
    }

    /// The whole of it as one block; `None` while nothing is recorded.
    pub fn whole(&self) -> Option<&Block> {
        self.whole.as_ref()
    }

    /// Blocks in order of time that cover everything from `since_s` (s) to now, as fine as they are kept.
    ///
    /// A block size that reaches back so far may not have completed its newest block: smaller ones follow it.
    pub fn since(&self, since_s: f64) -> impl Iterator<Item = &Block> {
        let size = self
            .levels
            .iter()
            .position(|level| level.reaches(since_s))
            .unwrap_or(0);
        let covering = self
            .levels
            .get(size..=size)
            .into_iter()
            .flatten()
            .flat_map(|level| &level.blocks);
        let newest = self.levels[..size.min(self.levels.len())].iter().rev();
        let rest = newest.filter_map(|level| level.waiting.as_ref());
        covering
            .skip_while(move |block| block.end_s < since_s)
            .chain(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn moment(step: u64, value: f64) -> Moment {
        Moment {
            time_s: step as f64,
            position: Vector3::new(value, 0.0, 0.0),
            tilt_deg: value,
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
            prop_assert!(blocks.len() <= KEPT + 16);
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

    #[test]
    fn memory_is_bounded() {
        let mut recording = Recording::default();
        (0..1_000_000).for_each(|step| recording.push(&moment(step, 0.0)));
        let kept: usize = recording
            .levels
            .iter()
            .map(|level| level.blocks.len())
            .sum();
        assert!(kept <= KEPT * 11 + 1000, "{kept} blocks");
    }
}
