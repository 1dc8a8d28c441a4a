//! Compares the swing of the axle's tilt in a run with the swing in the exact motion.
//!
//! The traced point can stay within 1 % of the exact motion although the nutation is wrong, because the nutation of a
//! fast top is smaller than 1 %. So the swing is judged by itself. The run is cut into windows of whole swings. In each
//! window, three numbers of both motions are compared: the minimum tilt, the maximum tilt, and the total path of the
//! tilt. The path is the size of the swing times the number of swings. The phase is not compared here, since the traced
//! point shows an error in it.
//!
//! Both motions are sampled at the run's steps. A swing that the time step is too long to show therefore does not count
//! against a run whose numbers are right.

use crate::physics::State;
use crate::physics::exact::AT_ONCE;
use crate::text::number::{fixed, short};
use std::fmt;

/// Tolerance on the traced point as a fraction of its arm, which is its distance from the pivot. A run within it is
/// accepted. A larger error is visible on a plot.
pub const BELIEVED_WITHIN: f64 = 0.01;
/// Tolerance on the minimum and maximum tilt and on the path of the tilt, as a fraction of the exact swing.
pub const SWING_TOLERANCE: f64 = 0.05;
/// Minimum swing of the exact tilt, degrees. Below it, the tilt does not swing; the summary does not show more digits.
const NO_SWING_DEG: f64 = 1e-4;
/// Tolerance on the tilt if the exact motion does not swing, rad: the same fraction of the traced point's tolerance.
const WHERE_NONE_RAD: f64 = SWING_TOLERANCE * BELIEVED_WITHIN;
/// Number of swings up or down in a window, if the run has enough. With this many, the phase has little influence.
const SWINGS_PER_WINDOW: f64 = 40.0;
/// With fewer swings than this, the path of the tilt tells nothing about the period.
const FEW_SWINGS: f64 = 3.0;
/// Maximum number of bins. Beyond it, pairs of bins are merged.
const MOST_SWING_BINS: usize = 128;

/// Follows the swings of the run and of the exact motion. It must receive every step.
#[derive(Clone, Debug)]
pub(super) struct Swings {
    bins: Vec<SwingBin>,
    /// Steps per bin, at least the number that is recorded at once.
    steps: u64,
    /// Number of steps in the last, unfinished bin.
    last_steps: u64,
    /// Heights of the run's axle and of the exact motion's axle at the last step.
    last: [f64; 2],
}

/// Heights of both axles over consecutive steps.
#[derive(Clone, Copy, Debug)]
struct SwingBin {
    from_s: f64,
    to_s: f64,
    /// Ranges of the run and of the exact motion.
    ranges: [HeightRange; 2],
}

/// Minimum and maximum [height], and the sum of its absolute changes.
#[derive(Clone, Copy, Debug)]
struct HeightRange {
    least: f64,
    greatest: f64,
    length: f64,
}

/// Swing of the tilt in a run and in the exact motion, in the window in which they differ most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingComparison {
    /// Start and end of the window, s. `None` if it is the whole run.
    pub stretch_s: Option<(f64, f64)>,
    /// Minimum and maximum tilt of the run in the window, degrees.
    pub run_deg: (f64, f64),
    /// Minimum and maximum tilt of the exact motion in the window, degrees.
    pub exact_deg: (f64, f64),
    /// Ratio of the run's total path of the tilt, up and down, to the exact one.
    pub way: f64,
    /// True if the minimum or the maximum tilt is wrong.
    pub tilts_differ: bool,
    /// Largest difference, in units of its tolerance.
    pub worst: f64,
}

/// Returns cos|cos| of the tilt of an axle whose z is `cosine`. It needs neither a root nor an arc.
#[inline]
pub(super) fn height(cosine: f64) -> f64 {
    cosine * cosine.abs()
}

/// Returns the [height] of the axle in `state`, which may have lost its unit length. It changes by no more than the
/// tilt does (rad).
#[inline]
pub(super) fn height_in(state: &State) -> f64 {
    let axle = state.axle();
    height(axle.z) / axle.norm_squared()
}

fn tilt_deg(height: f64) -> f64 {
    let cosine = height.abs().sqrt().copysign(height);
    libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees()
}

/// Returns true if a tilt from `least` to `greatest` degrees swings.
fn swings((least, greatest): (f64, f64)) -> bool {
    greatest - least >= NO_SWING_DEG
}

/// Returns the tolerance on tilts next to the exact range `exact_deg`, degrees.
pub fn tilt_tolerance_deg(exact_deg: (f64, f64)) -> f64 {
    if swings(exact_deg) {
        SWING_TOLERANCE * (exact_deg.1 - exact_deg.0)
    } else {
        WHERE_NONE_RAD.to_degrees()
    }
}

impl Swings {
    /// Creates the comparison for a run that begins in `start`, like its exact motion.
    pub fn new(start: &State) -> Self {
        let last = [height_in(start); 2];
        Self {
            bins: vec![SwingBin::new(start.time_s, last)],
            steps: AT_ONCE as u64,
            last_steps: 0,
            last,
        }
    }

    /// Records consecutive steps of the run, with the [heights](height) of the exact motion's axle. The result does not
    /// depend on how many are recorded at once.
    #[inline]
    pub fn record<const N: usize>(&mut self, states: &[State; N], exact: &[f64; N]) {
        let run = states.each_ref().map(height_in);
        let room = (self.steps - self.last_steps).min(N as u64) as usize;
        if room == N {
            self.add_steps(states, [&run, exact]);
        } else {
            self.add_steps(&states[..room], [&run[..room], &exact[..room]]);
            self.begin_bin();
            self.add_steps(&states[room..], [&run[room..], &exact[room..]]);
        }
    }

    #[inline]
    fn add_steps(&mut self, states: &[State], heights: [&[f64]; 2]) {
        let (Some(bin), Some(last)) = (self.bins.last_mut(), states.last()) else {
            return;
        };
        bin.to_s = last.time_s;
        for ((way, previous), values) in bin.ranges.iter_mut().zip(&mut self.last).zip(heights) {
            for height in values {
                way.least = way.least.min(*height);
                way.greatest = way.greatest.max(*height);
                way.length += (height - *previous).abs();
                *previous = *height;
            }
        }
        self.last_steps += states.len() as u64;
    }

    #[cold]
    fn begin_bin(&mut self) {
        if self.bins.len() == MOST_SWING_BINS {
            self.steps *= 2;
            self.bins = self
                .bins
                .chunks(2)
                .map(|two| two[1..].iter().fold(two[0], SwingBin::and))
                .collect();
        }
        self.last_steps = 0;
        let from_s = self.bins.last().map_or(0.0, |bin| bin.to_s);
        self.bins.push(SwingBin::new(from_s, self.last));
    }

    /// Returns the comparison of the window in which the swings differ most.
    pub fn worst(&self) -> Option<SwingComparison> {
        let mut windows: Vec<SwingBin> = Vec::new();
        for bin in &self.bins {
            match windows.last_mut() {
                Some(last) if last.ranges[1].swings() < SWINGS_PER_WINDOW => *last = last.and(bin),
                _ => windows.push(*bin),
            }
        }
        // Swings that remain at the end belong to the window before.
        if let [.., before, rest] = &mut windows[..]
            && rest.ranges[1].swings() < SWINGS_PER_WINDOW
        {
            *before = before.and(rest);
            windows.pop();
        }
        let is_whole_run = windows.len() == 1;
        let swings = windows.iter().map(|bin| bin.swing(is_whole_run));
        swings.reduce(|worst, swing| {
            if swing.worst > worst.worst {
                swing
            } else {
                worst
            }
        })
    }
}

impl SwingBin {
    fn new(from_s: f64, heights: [f64; 2]) -> Self {
        let ranges = heights.map(|height| HeightRange {
            least: height,
            greatest: height,
            length: 0.0,
        });
        Self {
            from_s,
            to_s: from_s,
            ranges,
        }
    }

    /// Merges two consecutive bins.
    fn and(self, next: &Self) -> Self {
        let [run, exact] = self.ranges;
        Self {
            to_s: next.to_s,
            ranges: [run.and(&next.ranges[0]), exact.and(&next.ranges[1])],
            ..self
        }
    }

    fn swing(&self, is_whole_run: bool) -> SwingComparison {
        let [run, exact] = self.ranges;
        let (run_deg, exact_deg) = (run.tilts_deg(), exact.tilts_deg());
        let most_deg = tilt_tolerance_deg(exact_deg);
        let off_deg = (run_deg.0 - exact_deg.0)
            .abs()
            .max((run_deg.1 - exact_deg.1).abs());
        let way = run.length / exact.length;
        let is_there = swings(exact_deg) && exact.swings() >= FEW_SWINGS;
        let path_error = if is_there {
            (way - 1.0).abs() / SWING_TOLERANCE
        } else {
            0.0
        };
        SwingComparison {
            stretch_s: (!is_whole_run).then_some((self.from_s, self.to_s)),
            run_deg,
            exact_deg,
            way,
            tilts_differ: off_deg > most_deg,
            worst: (off_deg / most_deg).max(path_error),
        }
    }
}

impl HeightRange {
    fn and(&self, next: &Self) -> Self {
        Self {
            least: self.least.min(next.least),
            greatest: self.greatest.max(next.greatest),
            length: self.length + next.length,
        }
    }

    /// Returns how often the height has gone up or down; 0 if it has not changed.
    fn swings(&self) -> f64 {
        let range = self.greatest - self.least;
        if range > 0.0 {
            self.length / range
        } else {
            0.0
        }
    }

    /// Returns the minimum and maximum tilt, degrees. The height falls as the tilt grows.
    fn tilts_deg(&self) -> (f64, f64) {
        (tilt_deg(self.greatest), tilt_deg(self.least))
    }
}

impl SwingComparison {
    /// Returns true if the run's swing agrees with the exact one.
    pub fn is_right(&self) -> bool {
        self.worst <= 1.0
    }

    /// Returns true if the exact motion's tilt swings at all.
    pub fn is_there(&self) -> bool {
        swings(self.exact_deg)
    }

    /// Returns the tilts of the run and of the exact motion, degrees, with enough digits to tell them apart.
    fn tilts(&self) -> [String; 4] {
        let digits = -libm::log10(tilt_tolerance_deg(self.exact_deg)).floor();
        let [(a, b), (c, d)] = [self.run_deg, self.exact_deg];
        [a, b, c, d].map(|tilt| fixed(tilt, digits.max(0.0) as usize))
    }

    /// Describes the error in few words: "tilt 29.690..30.000, exact 30.000..30.074".
    pub fn in_short(&self) -> String {
        if !self.tilts_differ {
            return format!("total swing {} times the exact one", short(self.way));
        }
        let [a, b, c, d] = self.tilts();
        format!("tilt {a}..{b}, exact {c}..{d}")
    }
}

impl fmt::Display for SwingComparison {
    /// Describes the error: "the tilt swings from 29.690 to 30.000 degrees, not from 30.000 to 30.074".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((from_s, to_s)) = self.stretch_s {
            write!(f, "from {} to {} s ", short(from_s), short(to_s))?;
        }
        if !self.tilts_differ {
            let (way, are) = (
                short(self.way),
                if self.way < 1.0 {
                    "small or slow"
                } else {
                    "large or fast"
                },
            );
            return write!(
                f,
                "the swings of the tilt add up to {way} times the exact ones, too {are}"
            );
        }
        let [a, b, c, d] = self.tilts();
        write!(f, "the tilt swings from {a} to {b} degrees, ")?;
        if self.is_there() {
            write!(f, "not from {c} to {d}")
        } else {
            write!(f, "and should stay at {c}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Vector3};

    /// Returns the comparison of ten thousand steps of a run, thirty per second, with a [wave] at 30 degrees. The run's
    /// tilt at a time, degrees, is `tilt_of` the time.
    fn beside(tilt_of: impl Fn(f64) -> f64) -> SwingComparison {
        let state = |time_s: f64| State {
            time_s,
            orientation: Rotation3::new(Vector3::x() * tilt_of(time_s).to_radians()).into_inner(),
            momentum: Vector3::z(),
        };
        let mut swings = Swings::new(&state(0.0));
        for step in 1..10_000 {
            let time = f64::from(step) / 30.0;
            let exact = libm::cos((30.0 + wave(time)).to_radians());
            swings.record(&[state(time)], &[height(exact)]);
        }
        swings.worst().unwrap()
    }

    /// Returns a nutation of a tenth of a degree with a period of one second.
    fn wave(time: f64) -> f64 {
        0.05 * (1.0 - libm::cos(std::f64::consts::TAU * time))
    }

    #[test]
    fn size_position_and_period_of_a_swing_count_but_not_its_phase() {
        let is_right = |tilt_of: fn(f64) -> f64| beside(tilt_of).is_right();
        assert!(is_right(|time| 30.0 + wave(time)));
        assert!(is_right(|time| 30.0 + wave(time + 0.3)));
        assert!(is_right(|time| 30.0 + 1.02 * wave(1.02 * time)));
        assert!(!is_right(|time| 30.0 + 1.08 * wave(time)));
        assert!(!is_right(|time| 30.01 + wave(time)));
        assert!(!is_right(|time| 30.0 + wave(1.08 * time)));
        // The nutation decays so slowly that the minimum and maximum tilt of the whole run are right.
        assert!(!is_right(
            |time| 30.05 - (0.05 - wave(time)) * libm::exp(-time / 300.0)
        ));
    }
}
