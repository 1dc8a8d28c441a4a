//! Recording of a path in bounded memory: repeated parts are stored only once.

use nalgebra::Vector3;
use std::collections::HashSet;
use std::f64::consts::TAU;

const MOST_PATH_POINTS: usize = 1 << 19;
/// Number of cells along each side of the first grid: finer than the dots of a page at 600 dots per inch.
const FINEST_PATH_CELLS: f64 = 4096.0;

/// Recorder of the path of a point.
///
/// Every point of a short path is kept. Of a long path, only points that lead from one grid cell to another in a new
/// way are kept; if it is drawn as points, each cell keeps one. The cells grow with the number of points. They have a
/// separate height, since a picture in space may stretch z.
#[derive(Clone, Debug)]
pub struct PathRecorder {
    is_line: bool,
    path: TracedPath,
    low: [f64; 3],
    high: [f64; 3],
    /// The last point, if the path is thinned.
    last: Option<[f64; 3]>,
    /// Number of cells along each side; `None` as long as every point is kept.
    cells: Option<f64>,
    size: [f64; 3],
    gone: HashSet<[[i32; 3]; 2]>,
    left_out: u64,
}

#[derive(Clone, Debug, Default)]
pub struct TracedPath {
    /// Points of the path, world frame, m. NaN interrupts the line where it repeats an earlier part.
    pub points: Vec<[f64; 3]>,
    /// Approximate length of the whole path, as a multiple of the stored path.
    pub times: f64,
    /// Number of points per turn, if there are too few to look round.
    pub few_a_turn: Option<f64>,
}

impl TracedPath {
    /// Returns the lines of the path, with each point converted by `place`.
    pub fn lines<Place>(&self, place: impl Fn(&[f64; 3]) -> Place) -> Vec<Vec<Place>> {
        let lines = self.points.split(|point| point[0].is_nan());
        lines
            .map(|line| line.iter().map(&place).collect())
            .collect()
    }
}

impl PathRecorder {
    /// Creates a recorder. With `is_line`, the path is drawn as a line even if it has few points.
    pub fn new(is_line: bool) -> Self {
        Self {
            is_line,
            path: TracedPath::default(),
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            last: None,
            cells: None,
            size: [0.0; 3],
            gone: HashSet::default(),
            left_out: 0,
        }
    }

    pub fn push(&mut self, point: [f64; 3]) {
        for (axis, value) in point.into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(value);
            self.high[axis] = self.high[axis].max(value);
        }
        if self.cells.is_none() {
            self.path.points.push(point);
        } else {
            self.keep(point, true);
        }
        if self.path.points.len() > MOST_PATH_POINTS {
            self.coarsen();
        }
    }

    /// Stores `point` if it is new. `is_joined` is true if a line leads to it.
    fn keep(&mut self, point: [f64; 3], is_joined: bool) {
        let to = self.cell(&point);
        if self.is_dots() {
            if self.gone.insert([to, to]) {
                self.path.points.push(point);
            } else {
                self.left_out += 1;
            }
            return;
        }
        let last = *self.last.get_or_insert(point);
        let from = self.cell(&last);
        if from == to {
            return;
        }
        self.last = Some(point);
        if !is_joined {
            return;
        }
        if !self.gone.insert([from.min(to), from.max(to)]) {
            self.left_out += 1;
            return;
        }
        let end = self.path.points.last();
        let is_far = end.is_none_or(|end| {
            let cell = self.cell(end);
            (0..3).any(|axis| cell[axis].abs_diff(from[axis]) > 2)
        });
        if is_far {
            let gap = end.map(|_| [f64::NAN; 3]);
            self.path.points.extend(gap.into_iter().chain([last]));
        }
        self.path.points.push(point);
    }

    fn is_dots(&self) -> bool {
        self.path.few_a_turn.is_some() && !self.is_line
    }

    fn cell(&self, point: &[f64; 3]) -> [i32; 3] {
        [0, 1, 2].map(|axis| (point[axis] / self.size[axis]).floor() as i32)
    }

    /// Thins the path until it has at most half the maximum number of points.
    fn coarsen(&mut self) {
        if self.cells.is_none() {
            self.path.few_a_turn = points_a_turn(&self.path.points);
        }
        while self.path.points.len() > MOST_PATH_POINTS / 2 {
            let cells = self.cells.map_or(FINEST_PATH_CELLS, |cells| 0.5 * cells);
            self.cells = Some(cells);
            let [x, y, z] = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
            self.size = [x.max(y), x.max(y), z].map(|side| (side / cells).max(f64::MIN_POSITIVE));
            self.last = None;
            self.gone.clear();
            let mut is_joined = true;
            for point in std::mem::take(&mut self.path.points) {
                if point[0].is_nan() {
                    is_joined = false;
                } else {
                    self.keep(point, std::mem::replace(&mut is_joined, true));
                }
            }
        }
    }

    pub fn end(mut self) -> TracedPath {
        if self.cells.is_none() {
            self.path.few_a_turn = points_a_turn(&self.path.points);
        } else if self.path.points.is_empty() {
            self.path.points.extend(self.last); // the point never moved
        }
        let kept = self.path.points.len().max(1) as f64;
        self.path.times = 1.0 + self.left_out as f64 / kept;
        self.path
    }
}

/// A path with more points per turn than this looks round: the chords deviate from it by 1.5 % of its radius.
const ROUND: f64 = 18.0;
/// Chords that deviate by less than this fraction of the picture's width look round too: about 0.15 pt.
const UNSEEN_CHORD: f64 = 7e-4;
/// Minimum number of bends for an average.
const FEWEST_BENDS: u32 = 3;
/// Approximate number of points of a path that are examined.
const LOOKED_AT: usize = 50_000;

/// Returns the number of points per turn of `path` (m), if they are too few to look round.
fn points_a_turn(path: &[[f64; 3]]) -> Option<f64> {
    let bends = path.windows(3).step_by(1 + path.len() / LOOKED_AT);
    let bends = bends.filter_map(|three| {
        let [a, b, c] = [0, 1, 2].map(|place| Vector3::from(three[place]));
        let moves = a != b && b != c;
        moves.then(|| {
            let (angle, chord) = ((b - a).angle(&(c - b)), (b - a).norm());
            (angle, 0.5 * chord * libm::tan(0.25 * angle))
        })
    });
    let none = (0, 0.0, 0.0);
    let (count, angles, heights) = bends.fold(none, |(count, angles, heights), (angle, height)| {
        (count + 1, angles + angle, heights + height)
    });
    let a_turn = TAU * f64::from(count) / angles;
    let is_seen = heights > UNSEEN_CHORD * f64::from(count) * width(path);
    (count >= FEWEST_BENDS && a_turn < ROUND && is_seen).then_some(a_turn)
}

/// Returns the largest extent of `path` along an axis, m.
fn width(path: &[[f64; 3]]) -> f64 {
    let far = Vector3::repeat(f64::INFINITY);
    let (low, high) = path.iter().fold((far, -far), |(low, high), at| {
        let at = Vector3::from(*at);
        (low.inf(&at), high.sup(&at))
    });
    (high - low).max()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(is_line: bool, points: impl Iterator<Item = [f64; 3]>) -> TracedPath {
        let mut recorder = PathRecorder::new(is_line);
        points.for_each(|point| recorder.push(point));
        recorder.end()
    }

    /// A circle, with small loops on it.
    fn looping(number: usize) -> [f64; 3] {
        let (slow, fast) = (1e-5 * number as f64, 0.3 * number as f64);
        let (x, y) = (
            libm::cos(slow) + 2e-4 * libm::cos(fast),
            libm::sin(slow) + 2e-4 * libm::sin(fast),
        );
        [x, y, 1e-6 * libm::cos(fast)]
    }

    #[test]
    fn a_short_path_is_kept_in_full_and_a_long_one_is_thinned() {
        let short: Vec<_> = (0..2000).map(looping).collect();
        assert_eq!(recorded(false, short.iter().copied()).points, short);
        let long = recorded(true, (0..3_000_000).map(looping));
        assert!(long.points.len() <= MOST_PATH_POINTS && long.times > 2.0);
        let off = |angle: f64| {
            let (x, y) = (libm::cos(angle), libm::sin(angle));
            let off = long
                .points
                .iter()
                .map(|at| libm::hypot(at[0] - x, at[1] - y));
            off.fold(f64::INFINITY, f64::min)
        };
        // Nowhere on the way round is it farther off than a line is wide on paper, 1/300 of a page.
        let places = (0..628).map(|number| off(0.01 * f64::from(number)));
        let most = places.fold(0.0, f64::max);
        assert!(most < 2.0 / 300.0, "{most}");
        let bounded = |step: f64| {
            let angle = |number: u32| step * f64::from(number);
            let point = |turned: f64| [libm::cos(turned), libm::sin(turned), 0.0];
            recorded(false, (0..600_000).map(|number| point(angle(number))))
        };
        // Chords that are never repeated become points; a path that stands still is one point.
        let chords = bounded(2.0_f64.sqrt());
        assert!(chords.points.len() <= MOST_PATH_POINTS && chords.few_a_turn.is_some());
        assert!(chords.points.iter().all(|point| point[0].is_finite()));
        assert_eq!(bounded(0.0).points.len(), 1);
    }

    #[test]
    fn coarsely_sampled_circles_are_recognized() {
        let circle = |a_turn: f64| -> Vec<[f64; 3]> {
            let angles = (0..100).map(|step| f64::from(step) * TAU / a_turn);
            angles
                .map(|angle| [libm::cos(angle), libm::sin(angle), 1.0])
                .collect()
        };
        assert!((points_a_turn(&circle(10.0)).unwrap() - 10.0).abs() < 1e-9);
        assert_eq!(points_a_turn(&circle(40.0)), None);
        // Bends that are far smaller than the picture.
        let wavy: Vec<_> = (0..4000)
            .map(|step| [f64::from(step), 0.3 * f64::from(step % 2), 1.0])
            .collect();
        assert_eq!(points_a_turn(&wavy), None);
        let standing = vec![[1.0, 0.0, 0.0]; 100];
        let straight: Vec<_> = (0..100).map(|step| [f64::from(step), 0.0, 0.0]).collect();
        assert_eq!(points_a_turn(&standing), None);
        assert_eq!(points_a_turn(&straight), None);
        assert_eq!(points_a_turn(&[]), None);
    }
}
