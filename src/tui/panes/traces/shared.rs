//! The recordings on the columns of a strip, each looked through once for all of its curves that are drawn there.

use crate::observe::recording::{Curve, Recording};
use crate::observe::strip::{Blocks, Column, Strip};

pub(super) struct Shared<'a> {
    pub strip: &'a Strip,
    seen: Vec<(&'a Recording, Blocks)>,
}

impl<'a> Shared<'a> {
    pub fn on(strip: &'a Strip) -> Self {
        Self {
            strip,
            seen: Vec::new(),
        }
    }

    /// `curve` of `recording` in each column, as [`Blocks::columns`] has it.
    pub fn columns(
        &mut self,
        recording: &'a Recording,
        curve: Curve,
        cuts: &[f64],
    ) -> Vec<Option<Column>> {
        let seen = self.seen.iter();
        let mut same = seen.filter(|(other, _)| std::ptr::eq(*other, recording));
        if let Some((_, blocks)) = same.next() {
            return blocks.columns(curve, cuts);
        }
        let blocks = self.strip.blocks(recording);
        let columns = blocks.columns(curve, cuts);
        self.seen.push((recording, blocks));
        columns
    }
}
