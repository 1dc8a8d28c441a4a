//! The direction in which each curve goes, up or down: where it changes, the curve turns.

/// The direction in which each curve goes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Directions {
    /// The stored values of the newest moment.
    values: Option<[f64; 4]>,
    /// By how much each curve changed when it last did; 0 before it has changed.
    changes: [f64; 4],
}

impl Directions {
    /// Goes on to `values`, those of the next moment; returns which curves have turned there.
    pub fn go_on(&mut self, values: [f64; 4]) -> [bool; 4] {
        let before = self.values.replace(values).unwrap_or(values);
        std::array::from_fn(|curve| {
            let (change, last) = (values[curve] - before[curve], self.changes[curve]);
            let (is_up, is_down) = (change > 0.0, change < 0.0);
            self.changes[curve] = if is_up | is_down { change } else { last };
            (is_up & (last < 0.0)) | (is_down & (last > 0.0))
        })
    }
}
