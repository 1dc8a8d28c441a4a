//! How a path fades: what is recent is a line, the last turn is dotted, what came before is dotted sparsely. Where the
//! point has dwelt its dots are denser. All of this is seen without colours too; with them, and by bold and dim type,
//! the ages differ in shade as well.

use crate::engine::recording::Recording;
use crate::lab::playback::ages::{Age, Ages};
use crate::tui::dots::{self, Dots, Ink};
use crate::tui::theme::Role;
use nalgebra::Vector3;

/// The ranks of the dots of a row, from a multiple of five on; the next row is shifted by `SHIFT` dots. A line that is
/// drawn with the dots of the first few ranks has gaps of equal length, whether it is level, upright or slanting.
const RANK: [u8; 5] = [0, 3, 1, 4, 2];
const SHIFT: usize = 3;

/// The point dwelt at a dot where it was found this many times as often as at an average dot.
const DWELT: f64 = 3.0;
/// Fewer times than these are chance.
const LEAST_DWELT: u16 = 5;
/// The longest line between two places of the last turn, dots: the way between them is not known.
const LONGEST_TRAIL_LINE_DOTS: f64 = 8.0;
/// The longest line between two recent places, of the sheet's shorter side.
const LONGEST_RECENT_LINE: f64 = 0.5;

/// Dots of the path up to this distance across and down are near; two lines have fewer near dots than a crowd.
const NEAR_DOTS: usize = 2;
const CROWD: usize = 12;

/// A path on a sheet of dots, each with its age.
pub struct Trail {
    width: usize,
    height: usize,
    ages: Vec<Option<Age>>,
    counts: Vec<u16>,
    around: Around,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Around {
    Nothing,
    /// The body: areas are as sparse as can be, because it is drawn over them, and the path has a colour of its own.
    Body,
}

impl Trail {
    pub fn new(dots: &Dots, around: Around) -> Self {
        let (width, height) = (dots.width(), dots.height());
        Self {
            width,
            height,
            ages: vec![None; width * height],
            counts: vec![0; width * height],
            around,
        }
    }

    fn place(&self, at: (f64, f64)) -> Option<usize> {
        let place = dots::on_sheet(at, (self.width, self.height));
        place.map(|(x, y)| y * self.width + x)
    }

    pub fn dot(&mut self, at: (f64, f64), age: Age) {
        if let Some(place) = self.place(at) {
            self.ages[place] = self.ages[place].max(Some(age));
        }
    }

    /// The path of `recording` until now, when the point is at `now` (s; world frame, m); `to_dot` says where a place is on
    /// the sheet.
    pub fn follow(
        &mut self,
        recording: &Recording,
        ages: &Ages,
        (now_s, now): (f64, &Vector3<f64>),
        to_dot: impl Fn(&Vector3<f64>) -> (f64, f64),
    ) {
        let now = to_dot(now);
        let all: Vec<_> = recording
            .since(f64::NEG_INFINITY)
            .map(|block| (block.end_s, to_dot(&block.end())))
            .inspect(|(_, at)| self.count(*at))
            .collect();
        let old = all.iter().filter(|(end_s, _)| *end_s <= now_s);
        self.pass(
            old.map(|(_, at)| *at).chain([now]),
            LONGEST_TRAIL_LINE_DOTS,
            Age::Old,
        );
        for age in [Age::Turn, Age::Recent] {
            let longest = longest_line((self.width, self.height), age == Age::Recent);
            let since = ages.since(age, now_s);
            let blocks = recording
                .since(since)
                .filter(|block| block.end_s >= since && block.end_s <= now_s);
            let places = blocks.map(|block| to_dot(&block.end()));
            self.pass(places.chain([now]), longest, age);
        }
    }

    fn count(&mut self, at: (f64, f64)) {
        if let Some(place) = self.place(at) {
            self.counts[place] = self.counts[place].saturating_add(1);
        }
    }

    /// The path goes through these dots one after the other; those up to `longest` apart are joined by a line.
    fn pass(&mut self, places: impl Iterator<Item = (f64, f64)>, longest: f64, age: Age) {
        let mut last: Option<(f64, f64)> = None;
        for at in places {
            self.dot(at, age);
            if let Some(last) = last.replace(at)
                && (at.0 - last.0).abs().max((at.1 - last.1).abs()) <= longest
            {
                for (_, dot) in dots::line(last, at, (self.width, self.height)).skip(1) {
                    self.dot(dot, age);
                }
            }
        }
    }

    /// The count from which on a dot is one where the point dwelt.
    fn dwelt(&self) -> u16 {
        let found = self.counts.iter().filter(|count| **count > 0);
        let (dots, sum) = found.fold((0u32, 0u32), |(dots, sum), count| {
            (dots + 1, sum + u32::from(*count))
        });
        let average = f64::from(sum) / f64::from(dots.max(1));
        ((DWELT * average).ceil() as u16).max(LEAST_DWELT)
    }

    fn age(&self, x: usize, y: usize) -> Option<Age> {
        let inside = x < self.width && y < self.height;
        inside.then(|| self.ages[y * self.width + x]).flatten()
    }

    /// Whether the path covers an area at a dot, and is no line: it is on all four sides of the dot, or, around a body that
    /// is to be seen through it, on many of the dots near it.
    fn is_covered(&self, x: usize, y: usize) -> bool {
        if self.around == Around::Body {
            let columns = x.saturating_sub(NEAR_DOTS)..=x + NEAR_DOTS;
            let rows = y.saturating_sub(NEAR_DOTS)..=y + NEAR_DOTS;
            let dots = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
            return dots
                .filter(|&(column, row)| self.age(column, row).is_some())
                .count()
                >= CROWD;
        }
        let (left, above) = (x.wrapping_sub(1), y.wrapping_sub(1));
        let around = [(left, y), (x + 1, y), (x, above), (x, y + 1)];
        around
            .into_iter()
            .all(|(column, row)| self.age(column, row).is_some())
    }

    fn is_beside_recent(&self, x: usize, y: usize) -> bool {
        let columns = [x.wrapping_sub(1), x, x + 1];
        let rows = [y.wrapping_sub(1), y, y + 1];
        rows.iter().any(|row| {
            columns
                .iter()
                .any(|column| self.age(*column, *row) == Some(Age::Recent))
        })
    }

    pub fn draw(&self, dots: &mut Dots) {
        let dwelt = self.dwelt();
        // The strongest last: it decides how a cell looks in which there are dots of more than one age.
        for age in [Age::Old, Age::Turn, Age::Recent] {
            let of_age = self.ages.iter().enumerate();
            for (place, _) in of_age.filter(|(_, is)| **is == Some(age)) {
                let (x, y) = (place % self.width, place / self.width);
                // What is beside a recent line is left out, so that it is seen as one.
                if age != Age::Recent && self.is_beside_recent(x, y) {
                    continue;
                }
                let is_area = self.is_covered(x, y);
                let is_drawn = match self.around {
                    _ if age == Age::Recent || self.counts[place] >= dwelt => true,
                    Around::Body if is_area => is_in_area(x, y, Age::Old),
                    Around::Nothing if is_area => is_in_area(x, y, age),
                    _ => is_in_line(x, y, age),
                };
                if is_drawn {
                    dots.set(x as f64, y as f64, self.ink(age, is_area));
                }
            }
        }
    }

    fn ink(&self, age: Age, is_area: bool) -> Ink {
        let [recent, turn, old] = match self.around {
            Around::Nothing => [Role::Recent, Role::Path, Role::Old],
            Around::Body => [Role::Focus, Role::Track, Role::OldTrack],
        };
        match age {
            Age::Recent => Ink::Strong(recent),
            // The exact motion is seen through it.
            Age::Turn if is_area => Ink::Under(turn),
            Age::Turn => Ink::Strong(turn),
            Age::Old => Ink::Under(old),
        }
    }
}

/// The longest line between two places of the last turn, recent or not, on a sheet of `width` and `height` dots.
pub fn longest_line((width, height): (usize, usize), is_recent: bool) -> f64 {
    if is_recent {
        LONGEST_RECENT_LINE * width.min(height) as f64
    } else {
        LONGEST_TRAIL_LINE_DOTS
    }
}

/// Whether a dot of a line is drawn: four of five where it is of the last turn, else two.
fn is_in_line(x: usize, y: usize, age: Age) -> bool {
    let drawn = if age == Age::Turn { 4 } else { 2 };
    RANK[(x + SHIFT * y) % RANK.len()] < drawn
}

/// Whether a dot of an area is drawn: one of four where it is of the last turn, else one of eight.
fn is_in_area(x: usize, y: usize, age: Age) -> bool {
    let is_corner = x.is_multiple_of(2) && y.is_multiple_of(2);
    is_corner && (age == Age::Turn || (x / 2 + y / 2).is_multiple_of(2))
}
