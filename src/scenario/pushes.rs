//! A push, and the list of pushes that a run has at one time. The lists before and after an edit share the pushes that
//! the edit does not change, so that a run of many pushes and many edits takes no more memory than its file.

use super::file::PushFile;
use nalgebra::Vector3;
use std::ops::Index;

/// A force on one point for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the pushed point.
    pub point: usize,
    /// Force, world frame, N.
    pub force: Vector3<f64>,
    /// When it acts.
    pub window: Window,
    /// Whether it is the report's line taken literally: j times the force on its j-th step, and kept to the end.
    pub accumulates: bool,
}

/// When a push acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// On `count` steps from step `first` on; step 1 ends at t = dt.
    Steps {
        /// The first step on which it acts.
        first: u64,
        /// On how many.
        count: u64,
    },
    /// From one time for so long, s.
    Time {
        /// The beginning, s.
        from_s: f64,
        /// The length, s.
        for_s: f64,
    },
}

/// A list of pushes; a clone takes no room of its own, and a change to it room for what it changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pushes(rpds::VectorSync<Push>);

impl Pushes {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The first of them.
    pub fn first(&self) -> Option<&Push> {
        self.0.first()
    }

    /// The one at `place`, from 0.
    pub fn get(&self, place: usize) -> Option<&Push> {
        self.0.get(place)
    }

    /// All of them in order.
    pub fn iter(&self) -> impl Iterator<Item = &Push> {
        self.0.iter()
    }

    /// Puts `push` at `place`, or after the last where there is none at `place`.
    pub(super) fn put(&mut self, place: usize, push: Push) {
        if !self.0.set_mut(place, push) {
            self.0.push_back_mut(push);
        }
    }

    /// Drops all from `place` on.
    pub(super) fn cut_back(&mut self, place: usize) {
        while self.0.len() > place {
            self.0.drop_last_mut();
        }
    }
}

/// The pushes of a [`Pushes`] as a file would give them, as cheap to clone and to change.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PushFiles(rpds::VectorSync<PushFile>);

impl PushFiles {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The one at `place`, from 0.
    pub(super) fn get(&self, place: usize) -> Option<&PushFile> {
        self.0.get(place)
    }

    /// All of them in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &PushFile> {
        self.0.iter()
    }

    /// Puts `push` at `place`, or after the last where there is none at `place`.
    pub(super) fn put(&mut self, place: usize, push: PushFile) {
        match self.0.get(place) {
            Some(_) => _ = self.0.set_mut(place, push),
            None => self.0.push_back_mut(push),
        }
    }

    /// Drops all from `place` on.
    pub(super) fn cut_back(&mut self, place: usize) {
        while self.0.len() > place {
            self.0.drop_last_mut();
        }
    }
}

impl FromIterator<PushFile> for PushFiles {
    fn from_iter<I: IntoIterator<Item = PushFile>>(pushes: I) -> Self {
        Self(pushes.into_iter().collect())
    }
}

impl Index<usize> for Pushes {
    type Output = Push;

    fn index(&self, place: usize) -> &Push {
        &self.0[place]
    }
}

impl FromIterator<Push> for Pushes {
    fn from_iter<I: IntoIterator<Item = Push>>(pushes: I) -> Self {
        Self(pushes.into_iter().collect())
    }
}
