//! Dashes of a line that would use up its strokes and gaps in swings too small to be seen, or fill its own gaps: they are cut
//! by something else than the line's length.

use crate::figure::page::scene::Point;
use std::f64::consts::TAU;

/// The strokes of a dashed line, each of them a line.
pub(super) type Strokes = Vec<Vec<Point>>;

/// Strokes and gaps by turns.
struct Pattern {
    /// Where each of them begins, pt.
    begins: Vec<f64>,
    /// Where it begins anew, pt.
    whole: f64,
}

impl Pattern {
    /// That of strokes and gaps with these lengths, pt.
    fn new(dash_pt: impl Iterator<Item = f64>) -> Self {
        let mut whole = 0.0;
        let begin = |length: f64| {
            whole += length;
            whole - length
        };
        let begins = dash_pt.map(begin).collect();
        Self { begins, whole }
    }

    fn is_stroke(&self, phase: f64) -> bool {
        let within = phase.rem_euclid(self.whole);
        self.begins.partition_point(|begin| *begin <= within) % 2 == 1
    }

    /// Appends to `cuts` where strokes begin and end between `low` and `high`.
    fn cut(&self, low: f64, high: f64, cuts: &mut Vec<f64>) {
        let mut here = (low / self.whole).floor() * self.whole;
        while here < high {
            let begins = self.begins.iter().map(|begin| here + begin);
            cuts.extend(begins.filter(|begin| *begin > low && *begin < high));
            here += self.whole;
        }
    }
}

/// Appends to `strokes` those parts of `points` that are strokes of `pattern`; `phases` are how far along it each point stands, pt.
/// A phase may go back.
fn cut(points: &[Point], phases: &[f64], pattern: &Pattern, strokes: &mut Strokes) {
    let mut stroke: Vec<Point> = Vec::new();
    let mut cuts: Vec<f64> = Vec::new();
    for (pair, phase) in points.windows(2).zip(phases.windows(2)) {
        let (from, to) = (phase[0], phase[1]);
        let (low, high) = (from.min(to), from.max(to));
        cuts.clear();
        pattern.cut(low, high, &mut cuts);
        if from > to {
            cuts.reverse();
        }
        let mut begin = from;
        for end in cuts.iter().copied().chain([to]) {
            let place = |phase: f64| match to == from {
                true => 1.0,
                false => (phase - from) / (to - from),
            };
            let on_the_way = |share: f64| Point {
                x: pair[0].x + share * (pair[1].x - pair[0].x),
                y: pair[0].y + share * (pair[1].y - pair[0].y),
            };
            if pattern.is_stroke(0.5 * (begin + end)) {
                if stroke.is_empty() {
                    stroke.push(match begin == from {
                        true => pair[0],
                        false => on_the_way(place(begin)),
                    });
                }
                stroke.push(on_the_way(place(end)));
            } else if stroke.len() > 1 {
                strokes.push(std::mem::take(&mut stroke));
            }
            begin = end;
        }
    }
    if stroke.len() > 1 {
        strokes.push(stroke);
    }
}

fn cut_one(points: &[Point], phases: &[f64], dash_pt: &[f64]) -> Strokes {
    let mut strokes = Strokes::new();
    let pattern = Pattern::new(dash_pt.iter().copied());
    cut(points, phases, &pattern, &mut strokes);
    strokes
}

fn length(points: &[Point]) -> f64 {
    let pairs = points.windows(2);
    pairs.map(|pair| distance(&pair[0], &pair[1])).sum()
}

fn distance(a: &Point, b: &Point) -> f64 {
    (b.x - a.x).hypot(b.y - a.y)
}

/// The strokes of a line that runs to the right, by their width on the page, where it goes up and down once or more within a
/// stroke and its gap; `None` elsewhere.
pub(super) fn by_width(points: &[Point], dash_pt: &[f64]) -> Option<Strokes> {
    let (first, last) = (points.first()?, points.last()?);
    let (mut turns, mut was_down) = (0_u32, None);
    for pair in points.windows(2) {
        let is_down = pair[1].y > pair[0].y;
        if pair[1].y != pair[0].y {
            turns += u32::from(was_down.replace(is_down).is_some_and(|was| was != is_down));
        }
    }
    let swings = 0.5 * f64::from(turns);
    let is_steep = length(points) > WINDING * (last.x - first.x);
    let is_dense = swings * dash_pt.iter().sum::<f64>() > last.x - first.x;
    if !(is_steep && is_dense) {
        return None;
    }
    let phases: Vec<f64> = points.iter().map(|point| point.x - first.x).collect();
    Some(cut_one(points, &phases, dash_pt))
}

/// A line is steep, or winding, where it is so many times as long as the way that it makes.
const WINDING: f64 = 3.0;

/// A line has gone on where it is so far from where it was last said to be, pt: what it does within is a wiggle.
const WIGGLE_PT: f64 = 1.0;

/// The way that a line has made at each of its `points`, pt.
fn ways(points: impl Iterator<Item = Point>) -> impl Iterator<Item = f64> {
    let mut at: Option<Point> = None;
    let mut way = 0.0;
    points.map(move |point| {
        let gone = at.map_or(f64::INFINITY, |at| distance(&at, &point));
        if gone >= WIGGLE_PT {
            way += if at.is_some() { gone } else { 0.0 };
            at = Some(point);
        }
        way
    })
}

/// The strokes of a line by the way that it makes, where it wiggles so much that its length says nothing; `None` elsewhere.
pub(super) fn by_way(points: &[Point], dash_pt: &[f64]) -> Option<Strokes> {
    let ways: Vec<f64> = ways(points.iter().copied()).collect();
    let way = ways.last().copied()?;
    let is_winding = way > 0.0 && length(points) >= WINDING * way;
    is_winding.then(|| cut_one(points, &ways, dash_pt))
}

/// The part of the page that a line lies on, pt, and whether it covers itself there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ground {
    /// Whether it does: then its dashes would lie in its gaps.
    pub is_covered: bool,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Strokes of lines that cover themselves are so many times as long.
const LONGER: f64 = 1.5;
/// A line goes round where one side of its ground is at least this part of the other.
const ROUND: f64 = 0.25;
/// A line that makes so many times the way around its ground covers itself.
const OFTEN: f64 = 1.3;

impl Ground {
    /// That of the line that consists of `pieces`.
    pub fn of<Piece: Iterator<Item = Point>>(pieces: impl Iterator<Item = Piece> + Clone) -> Self {
        let none = Self {
            is_covered: false,
            left: f64::INFINITY,
            right: f64::NEG_INFINITY,
            top: f64::INFINITY,
            bottom: f64::NEG_INFINITY,
        };
        let ground = pieces.clone().flatten().fold(none, |ground, point| Self {
            is_covered: false,
            left: ground.left.min(point.x),
            right: ground.right.max(point.x),
            top: ground.top.min(point.y),
            bottom: ground.bottom.max(point.y),
        });
        let way: f64 = pieces.map(|piece| ways(piece).last().unwrap_or(0.0)).sum();
        Self {
            is_covered: way > OFTEN * ground.around(),
            ..ground
        }
    }

    fn width(&self) -> f64 {
        self.right - self.left
    }

    fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// The way around it, pt.
    fn around(&self) -> f64 {
        match self.is_round() {
            true => 0.25 * TAU * (self.width() + self.height()),
            false => 2.0 * self.width().max(self.height()),
        }
    }

    fn is_round(&self) -> bool {
        let (width, height) = (self.width(), self.height());
        width.min(height) >= ROUND * width.max(height)
    }

    /// The strokes of `pieces`, which cover themselves, as sectors about its middle, so that the gaps of one turn lie upon those
    /// of the others; of a ground that is long and thin, as parts of its length.
    pub(super) fn strokes(&self, pieces: &[Vec<Point>], dash_pt: &[f64]) -> Strokes {
        let pattern = Pattern::new(dash_pt.iter().map(|length| LONGER * length));
        let mut strokes = Strokes::new();
        // There may be very many pieces.
        let mut phases = Vec::new();
        for piece in pieces {
            phases.clear();
            match self.is_round() {
                true => phases.extend(self.around_middle(piece, pattern.whole)),
                false if self.width() > self.height() => phases.extend(piece.iter().map(|p| p.x)),
                false => phases.extend(piece.iter().map(|p| p.y)),
            }
            cut(piece, &phases, &pattern, &mut strokes);
        }
        strokes
    }

    /// How far along a pattern, which is `whole` pt long and fits a whole number of times around, each of `points` stands by
    /// its direction from the middle.
    fn around_middle(&self, points: &[Point], whole: f64) -> impl Iterator<Item = f64> {
        let (x, y) = (
            0.5 * (self.left + self.right),
            0.5 * (self.top + self.bottom),
        );
        let a_turn = (self.around() / whole).round().max(1.0) * whole;
        let (mut turned, mut last) = (0.0, 0.0);
        points.iter().map(move |point| {
            let here = libm::atan2(point.y - y, point.x - x) / TAU;
            let step = here - std::mem::replace(&mut last, here);
            turned += step - libm::round(step);
            turned * a_turn
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::page::ink::at;

    const DASH: &[f64] = &[3.0, 1.0];

    #[test]
    fn a_steep_line_is_dashed_by_its_width() {
        let zigzag = |i: i32| at(0.1 * f64::from(i), f64::from(i % 2) * 40.0);
        let points: Vec<_> = (0..=400).map(zigzag).collect();
        let strokes = by_width(&points, DASH).unwrap();
        assert_eq!(strokes.len(), 10);
        for (number, stroke) in strokes.iter().enumerate() {
            let begin = 4.0 * number as f64;
            let within = |p: &Point| (begin - 1e-9..=begin + 3.0 + 1e-9).contains(&p.x);
            assert!(stroke.iter().all(within), "{number}");
            let (first, last) = (stroke[0].x, stroke[stroke.len() - 1].x);
            assert!(last - first > 2.999, "{first} to {last}");
        }
        // A few wide swings keep the dashes of their length.
        let wide = |i: i32| at(f64::from(i), 30.0 * libm::sin(0.1 * f64::from(i)));
        assert_eq!(
            by_width(&(0..300).map(wide).collect::<Vec<_>>(), DASH),
            None
        );
        let level: Vec<_> = (0..=400).map(|i| at(f64::from(i), 0.0)).collect();
        assert_eq!(by_width(&level, DASH), None);
    }

    #[test]
    fn a_line_with_small_loops_is_dashed_by_the_way_it_makes() {
        let looping = |i: i32| {
            let turn = f64::from(i);
            at(0.005 * turn + 0.3 * libm::cos(turn), 0.3 * libm::sin(turn))
        };
        let points: Vec<_> = (0..8000).map(looping).collect();
        let strokes = by_way(&points, DASH).unwrap();
        assert!((9..=11).contains(&strokes.len()), "{}", strokes.len());
        let width = |stroke: &Vec<Point>| {
            let x = stroke.iter().map(|point| point.x);
            x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
        };
        assert!(
            strokes[1..8]
                .iter()
                .all(|stroke| (2.0..5.0).contains(&width(stroke)))
        );
        let circle = |i: i32| {
            at(
                50.0 * libm::cos(0.05 * f64::from(i)),
                50.0 * libm::sin(0.05 * f64::from(i)),
            )
        };
        assert_eq!(
            by_way(&(0..200).map(circle).collect::<Vec<_>>(), DASH),
            None
        );
    }

    #[test]
    fn a_line_there_and_back_is_dashed_by_its_place() {
        let there: Vec<_> = (0..=100)
            .map(|i| at(0.4 * f64::from(i), 0.01 * f64::from(i)))
            .collect();
        let back: Vec<_> = there.iter().rev().copied().collect();
        let lines = [there.clone(), back, there];
        let ground = Ground::of(lines.iter().map(|line| line.iter().copied()));
        assert!(ground.is_covered);
        let strokes = ground.strokes(&lines, DASH);
        assert_eq!(strokes.len(), 3 * 7);
        let in_gap =
            |p: &Point| p.x.rem_euclid(6.0) > 4.5 + 1e-9 && p.x.rem_euclid(6.0) < 6.0 - 1e-9;
        assert!(!strokes.iter().flatten().any(in_gap));
    }

    #[test]
    fn a_phase_that_goes_back_over_many_strokes_is_cut_in_its_order() {
        let back = [at(12.0, 0.0), at(0.0, 0.0)];
        let ends = |stroke: &Vec<Point>| (stroke[0].x, stroke[stroke.len() - 1].x);
        let mut strokes = Strokes::new();
        let pattern = Pattern::new(DASH.iter().copied());
        cut(&back, &[12.0, 0.0], &pattern, &mut strokes);
        let strokes: Vec<_> = strokes.iter().map(ends).collect();
        assert_eq!(strokes, [(11.0, 8.0), (7.0, 4.0), (3.0, 0.0)]);
    }

    #[test]
    fn the_gaps_of_many_turns_lie_upon_each_other() {
        // Ten turns, each a little wider, forward and then back.
        let place = |i: i32| {
            let (angle, radius) = (0.02 * f64::from(i), 50.0 + 0.001 * f64::from(i));
            at(radius * libm::cos(angle), radius * libm::sin(angle))
        };
        let there: Vec<_> = (0..3142).map(place).collect();
        let back: Vec<_> = there.iter().rev().copied().collect();
        let turns = [there, back];
        let ground = Ground::of(turns.iter().map(|line| line.iter().copied()));
        assert!(ground.is_covered);
        let strokes = ground.strokes(&turns, DASH);
        let angles: Vec<f64> = strokes
            .iter()
            .flat_map(|stroke| stroke.windows(2))
            .map(|pair| libm::atan2(pair[0].y + pair[1].y, pair[0].x + pair[1].x).rem_euclid(TAU))
            .collect();
        // Of 3600 directions about a quarter has no stroke.
        let mut inked = vec![false; 3600];
        for angle in angles {
            let at = (angle / TAU * 3600.0) as usize;
            // A stroke between two points covers a little on both sides.
            (at.saturating_sub(4)..(at + 5).min(3600)).for_each(|place| inked[place] = true);
        }
        let free = inked.iter().filter(|inked| !**inked).count();
        // Each of them covers a little more than its place above.
        assert!((350..1000).contains(&free), "{free}");
    }
}
