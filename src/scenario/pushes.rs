//! The pushes of a moment of a run. Those before and after an edit share what the edit leaves alone, so that a run of
//! many pushes and many edits takes no more room than its file.

use super::model::Push;
use std::ops::Index;

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
