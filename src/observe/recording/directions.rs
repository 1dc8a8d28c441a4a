//! The direction in which each curve goes, up or down: where it changes, the curve turns.

/// The direction in which each curve goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directions {
    /// The stored values of the newest moment; before the first no numbers.
    values: [f64; 4],
    /// By how much each curve changed when it last did; before that no number, or 0.
    changes: [f64; 4],
}

impl Default for Directions {
    fn default() -> Self {
        Self {
            values: [f64::NAN; 4],
            changes: [0.0; 4],
        }
    }
}

impl Directions {
    /// Goes on to `values`, those of the next moment; returns for each curve 1 where it has turned there, and 0 where it has
    /// not.
    #[inline]
    pub fn go_on(&mut self, values: [f64; 4]) -> [u32; 4] {
        let before = std::mem::replace(&mut self.values, values);
        std::array::from_fn(|curve| {
            let (change, last) = (values[curve] - before[curve], self.changes[curve]);
            self.changes[curve] = if change == 0.0 { last } else { change };
            u32::from(change * last < 0.0)
        })
    }
}
