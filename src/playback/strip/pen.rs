//! A curve drawn block by block into the columns of a strip: as a line, or as a band where its swings are too fast to be
//! drawn one by one.

use super::{Column, LEAST_SWING_DEG};
use crate::playback::recording::{Block, Curve, Extent};

/// Columns on either side over which the turns of a curve are counted to tell whether its swings can be drawn one by one.
const NEIGHBOURS: usize = 6;

/// With more turns in a column than this, swings cannot be drawn one by one: a swing has two turns and needs five columns.
const MOST_TURNS: f64 = 0.4;

/// The part of a band's width by which slow motion may carry the curve in two swings.
const MOST_CARRIED: f64 = 0.5;

#[derive(Clone, Copy, Debug, Default)]
struct Drawn {
    /// The extremes of the lines from block to block, in the curve's unit; [`Pen::finish`] adds those of the blocks.
    extent: Option<Extent>,
    stored: Option<Extent>,
    turns: f64,
    /// How often the tilt turns, which swings with every nutation; the curve itself does not turn where slow motion is
    /// faster than its swings.
    turns_of_tilt: f64,
    tilt: Option<Extent>,
}

fn include(all: &mut Option<Extent>, extent: Extent) {
    *all = Some(all.map_or(extent, |old| old.and(extent)));
}

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
        let turns = f64::from(block.turns(self.curve)) * share;
        let turns_of_tilt = f64::from(block.turns(Curve::Tilt)) * share;
        let tilt = block.stored(Curve::Tilt);
        for drawn in self.columns.iter_mut().take(last + 1).skip(first) {
            include(&mut drawn.stored, stored);
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

    /// The columns that have something, up to `reach` columns from the column `index`.
    fn about(&self, index: usize, reach: usize) -> impl Iterator<Item = (usize, &Drawn)> {
        let first = index.saturating_sub(reach);
        let columns = self.columns.iter().enumerate();
        let columns = columns.take(index + reach + 1).skip(first);
        columns.filter(|(_, drawn)| drawn.extent.is_some())
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

    /// The curve in each column; `None` where nothing was drawn.
    pub fn finish(mut self) -> Vec<Option<Column>> {
        for drawn in &mut self.columns {
            if let Some(stored) = drawn.stored {
                include(&mut drawn.extent, self.curve.in_its_unit(stored));
            }
        }
        let is_drawn = |drawn: &Drawn| drawn.extent.is_some();
        let first = self.columns.iter().position(is_drawn).unwrap_or(0);
        let ends = (first, self.columns.iter().rposition(is_drawn).unwrap_or(0));
        let all = 0..self.columns.len();
        let turns: Vec<_> = all
            .clone()
            .map(|index| self.turns(inside(index, NEIGHBOURS, ends)))
            .collect();
        // A swing has two turns: half of one on either side.
        let reach = |index: usize| ((1.0 / turns[index]).ceil() as usize).min(NEIGHBOURS);
        let swings: Vec<_> = all
            .clone()
            .map(|index| self.extent_about(index, reach(index)))
            .collect();
        let fast: Vec<_> = all
            .map(|index| is_fast(index, turns[index], &swings, ends))
            .collect();
        let column = |(index, drawn): (usize, &Drawn)| {
            let extent = drawn.extent?;
            // As most of the columns about it are, lest line and band take turns.
            let about = self.about(inside(index, NEIGHBOURS, ends), NEIGHBOURS);
            let (count, bands) = about.fold((0, 0), |(count, bands), (column, _)| {
                (count + 1, bands + usize::from(fast[column]))
            });
            // The mean of the extremes of all swings that have the column in them: it goes straight from one swing to the
            // next where they grow or shrink.
            let band = mean(&swings, index, reach(index)).filter(|_| 2 * bands > count);
            Some(Column {
                extent,
                band: band.map(|band| band.and(extent)),
            })
        };
        self.columns.iter().enumerate().map(column).collect()
    }

    fn extent_about(&self, index: usize, reach: usize) -> Option<Extent> {
        let extents = self
            .about(index, reach)
            .filter_map(|(_, drawn)| drawn.extent);
        extents.reduce(Extent::and)
    }
}

/// The column `index`, or the one `away` columns inside of the nearer of the curve's `ends`: near an end there are turns on
/// one side only.
fn inside(index: usize, away: usize, (first, last): (usize, usize)) -> usize {
    index
        .max((first + away).min(last))
        .min(last.saturating_sub(away).max(first))
}

/// Whether a curve with these `turns` in a column about the column `index` is too fast to be drawn swing by swing; `swings`
/// are its extremes over a swing about each column. Where slow motion carries it further in two swings than it swings,
/// before and after, it is drawn as it is.
fn is_fast(index: usize, turns: f64, swings: &[Option<Extent>], ends: (usize, usize)) -> bool {
    if turns <= MOST_TURNS {
        return false;
    }
    let middle = |index: usize| swings[index].map_or(0.0, |swing| 0.5 * (swing.min + swing.max));
    let away = (4.0 / turns).ceil() as usize;
    let here = inside(index, 2 * away, ends);
    let before = here.saturating_sub(away).max(ends.0);
    let after = (here + away).min(ends.1);
    let carried = [before, after].map(|other| (middle(other) - middle(here)).abs());
    let carried = carried[0].min(carried[1]);
    swings[index].is_some_and(|swing| carried < MOST_CARRIED * (swing.max - swing.min))
}

/// The mean lowest and the mean highest value of `extents` up to `reach` from `index`.
fn mean(extents: &[Option<Extent>], index: usize, reach: usize) -> Option<Extent> {
    let about = extents
        .iter()
        .take(index + reach + 1)
        .skip(index.saturating_sub(reach));
    let (min, max, count) = about
        .flatten()
        .fold((0.0, 0.0, 0.0), |(min, max, count), extent| {
            (min + extent.min, max + extent.max, count + 1.0)
        });
    (count > 0.0).then_some(Extent {
        min: min / count,
        max: max / count,
    })
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
