//! A curve drawn block by block into the columns of a strip: as a line, or as a band where its swings are too fast to be
//! drawn one by one.

use super::Column;
use crate::observe::recording::{Block, Curve, Extent};

/// Columns on either side over which the turns of a curve are counted to tell whether its swings can be drawn one by one.
const NEIGHBOURS: usize = 6;

/// Turns on either side over which the mean of a band is taken, so that parts of a swing do not show in it.
const MEAN_TURNS: f64 = 4.0;

/// From so many turns in a column on, swings cannot be drawn one by one: a swing has two turns, and needs five columns.
const MOST_TURNS: f64 = 0.4;

/// The part of a band's width by which slow motion may carry the curve in two swings.
const MOST_CARRIED: f64 = 0.5;

/// A tilt that changes by less than this, degrees, does not swing: it has no more than rounding.
const LEAST_SWING_DEG: f64 = 0.01;

/// What has been drawn in one column.
#[derive(Clone, Copy, Debug, Default)]
struct Drawn {
    /// The extremes of the lines from block to block, in the curve's unit; [`Pen::finish`] adds those of the blocks.
    extent: Option<Extent>,
    /// The extremes of blocks, as they are stored.
    stored: Option<Extent>,
    /// Sum of the means of blocks, each multiplied by the number of its moments in this column.
    sum: f64,
    moments: f64,
    turns: f64,
    /// How often the tilt turns, which swings with every nutation; the curve itself does not turn where slow motion is
    /// faster than its swings.
    turns_of_tilt: f64,
    /// The extremes of the tilt, as they are stored.
    tilt: Option<Extent>,
}

/// Makes `all` include `extent`.
fn include(all: &mut Option<Extent>, extent: Extent) {
    *all = Some(all.map_or(extent, |old| old.and(extent)));
}

/// Draws a curve block by block.
pub(super) struct Pen<'a> {
    columns: Vec<Drawn>,
    curve: Curve,
    cuts: &'a [f64],
    /// Of the previous block: its end, s, its last column and its stored extremes.
    before: Option<(f64, usize, Extent)>,
}

impl<'a> Pen<'a> {
    pub fn new(columns: usize, curve: Curve, cuts: &'a [f64]) -> Self {
        Self {
            columns: vec![Drawn::default(); columns],
            curve,
            cuts,
            before: None,
        }
    }

    /// Draws `block` from column `first` to `last`; columns beyond the right edge are left out.
    pub fn draw(&mut self, block: &Block, first: usize, last: usize) {
        let stored = block.stored(self.curve);
        if let Some((end_s, column, from)) = self.before
            && column < first
            && !self.is_cut(end_s, block.begin_s)
        {
            let [from, to] = [from, stored].map(|stored| self.curve.in_its_unit(stored));
            join(&mut self.columns, (column, from), (first, to));
        }
        let share = 1.0 / (last + 1 - first) as f64;
        let moments = block.moments() as f64 * share;
        let sum = block.mean(self.curve) * moments;
        let turns = f64::from(block.turns(self.curve)) * share;
        let turns_of_tilt = f64::from(block.turns(Curve::Tilt)) * share;
        let tilt = block.stored(Curve::Tilt);
        for drawn in self.columns.iter_mut().take(last + 1).skip(first) {
            include(&mut drawn.stored, stored);
            drawn.sum += sum;
            drawn.moments += moments;
            drawn.turns += turns;
            drawn.turns_of_tilt += turns_of_tilt;
            include(&mut drawn.tilt, tilt);
        }
        self.before = Some((block.end_s, last, stored));
    }

    /// Whether there is a cut at `from_s` or later and before `to_s`.
    fn is_cut(&self, from_s: f64, to_s: f64) -> bool {
        let next = self.cuts.partition_point(|&cut| cut < from_s);
        self.cuts.get(next).is_some_and(|&cut| cut < to_s)
    }

    /// The columns that have something, up to `reach` columns from the column `index`, and how far away they are.
    fn about(&self, index: usize, reach: usize) -> impl Iterator<Item = (usize, &Drawn)> {
        let first = index.saturating_sub(reach);
        let columns = self.columns.iter().enumerate();
        let columns = columns.take(index + reach + 1).skip(first);
        let columns = columns.filter(|(_, drawn)| drawn.extent.is_some());
        columns.map(move |(column, drawn)| (column.abs_diff(index), drawn))
    }

    /// How often the curve turns in a column about the column `index`; where slow motion carries it along, how often the
    /// tilt does, which swings with every nutation.
    fn turns(&self, index: usize) -> f64 {
        let about = || self.about(index, NEIGHBOURS).map(|(_, drawn)| drawn);
        let columns = about().count().max(1) as f64;
        let turns: f64 = about().map(|drawn| drawn.turns).sum();
        let turns_of_tilt: f64 = about().map(|drawn| drawn.turns_of_tilt).sum();
        let tilt = about().filter_map(|drawn| drawn.tilt).reduce(Extent::and);
        match tilt.map(|stored| Curve::Tilt.in_its_unit(stored)) {
            Some(tilt) if tilt.max - tilt.min > LEAST_SWING_DEG => {
                turns.max(turns_of_tilt) / columns
            }
            _ => turns / columns,
        }
    }

    /// The mean of the steps about the column `index`, those further away than `reach` left out and those near to it
    /// counted more: the whole swings and the parts of swings that are within reach then weigh about the same on both sides.
    fn mean(&self, index: usize, reach: usize) -> Option<f64> {
        let weigh = |(away, drawn): (usize, &Drawn)| {
            let weight = (reach + 1 - away) as f64;
            (weight * drawn.sum, weight * drawn.moments)
        };
        let sums = self.about(index, reach).map(weigh);
        let (sum, moments) = sums.fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1));
        (moments > 0.0).then(|| sum / moments)
    }

    /// The curve in each column; `None` where nothing was drawn.
    pub fn finish(mut self) -> Vec<Option<Column>> {
        for drawn in &mut self.columns {
            if let Some(stored) = drawn.stored {
                include(&mut drawn.extent, self.curve.in_its_unit(stored));
            }
        }
        let is_drawn = |drawn: &Drawn| drawn.extent.is_some();
        let first = self.columns.iter().position(is_drawn).unwrap_or(0);
        let last = self.columns.iter().rposition(is_drawn).unwrap_or(0);
        let column = |(index, drawn): (usize, &Drawn)| {
            let extent = drawn.extent?;
            // Near an end of the curve there are turns on one side only: what holds further inside is taken to hold there.
            let inside = index.max((first + NEIGHBOURS).min(last));
            let turns = self.turns(inside.min(last.saturating_sub(NEIGHBOURS).max(first)));
            if turns <= MOST_TURNS {
                let mean = self.mean(index, 0).unwrap_or(extent.min);
                return Some(Column {
                    extent,
                    mean: mean.clamp(extent.min, extent.max),
                    band: None,
                });
            }
            // A swing has two turns: half of one on either side.
            let reach = if turns < 2.0 {
                (1.0 / turns).ceil() as usize
            } else {
                0
            };
            let extents = self
                .about(index, reach)
                .filter_map(|(_, drawn)| drawn.extent);
            let band = extents.fold(extent, Extent::and);
            let mean = |index: usize| {
                let mean = self.mean(index, (MEAN_TURNS / turns) as usize);
                mean.unwrap_or(extent.min)
            };
            // Where slow motion carries the curve further in two swings than it swings, it is drawn as it is.
            let away = (4.0 / turns).ceil() as usize;
            // So are the means.
            let middle = index
                .min(last.saturating_sub(2 * away))
                .max((first + 2 * away).min(last));
            let carried = [middle.saturating_sub(away), (middle + away).min(last)]
                .map(|other| mean(other) - mean(middle));
            let is_band = carried.map(f64::abs).into_iter().fold(0.0, f64::max)
                < MOST_CARRIED * (band.max - band.min);
            Some(Column {
                extent,
                mean: if is_band {
                    mean(index).clamp(band.min, band.max)
                } else {
                    mean(index).clamp(extent.min, extent.max)
                },
                band: is_band.then_some(band),
            })
        };
        self.columns.iter().enumerate().map(column).collect()
    }
}

/// Draws the straight line from one block to the next: over the columns between them, and half a column in each of the
/// blocks' own. It may lead beyond the right edge.
fn join(columns: &mut [Drawn], from: (usize, Extent), to: (usize, Extent)) {
    let ((begin, from), (end, to)) = (from, to);
    let (leave, arrive) = nearest(from, to);
    if !(leave.is_finite() && arrive.is_finite()) {
        return; // the exact motion may overflow where the run does not
    }
    let length = (end - begin) as f64;
    let (low, high) = (leave.min(arrive), leave.max(arrive));
    let at = |place: f64| (leave + (arrive - leave) * (place / length)).clamp(low, high);
    let way = columns.iter_mut().take(end + 1).skip(begin);
    for (place, drawn) in way.enumerate() {
        let place = place as f64;
        let line = Extent::of(at(place - 0.5)).and(Extent::of(at(place + 0.5)));
        include(&mut drawn.extent, line);
    }
}

/// The pair of values, one from each extent, with the smallest distance.
fn nearest(from: Extent, to: Extent) -> (f64, f64) {
    if from.max < to.min {
        (from.max, to.min)
    } else if to.max < from.min {
        (from.min, to.max)
    } else {
        let shared = from.min.max(to.min);
        (shared, shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_joined_to_nothing() {
        let mut columns = vec![Drawn::default(); 8];
        let none = Extent::of(f64::NAN);
        let endless = Extent::of(f64::INFINITY);
        for (from, to) in [
            (none, none),
            (none, Extent::of(1.0)),
            (endless, none),
            (endless, Extent::of(0.0)),
        ] {
            join(&mut columns, (1, from), (5, to));
        }
        let mut extents = columns.iter().filter_map(|drawn| drawn.extent);
        assert!(extents.all(|extent| extent.min.is_finite()), "{columns:?}");
    }
}
