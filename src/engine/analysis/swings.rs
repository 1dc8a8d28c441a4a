//! How the axle's tilt swings in a run, and how in the exact motion at the same moments.
//!
//! A traced point can keep within 1 % of the exact motion although its nutation is another's: a fast top's is smaller than
//! that. So the swing is judged by itself. The run is cut into stretches of whole swings. In each the least and the greatest
//! tilt of both are compared, and the way that the tilt goes up and down in all, which is its size times how often it swings.
//! The phase is not compared: it is the traced point's to be right in that.
//!
//! Both are looked at where the run has a step, so that a swing which the time step is too long to show counts against no
//! run whose numbers are right.

use crate::physics::State;
use crate::physics::exact::AT_ONCE;
use crate::text::number::{fixed, short};
use std::fmt;

/// A run is believed while its traced point keeps within this part of its arm (its distance from the pivot) of the
/// exact motion: what an eye sees on a plot.
pub const BELIEVED_WITHIN: f64 = 0.01;
/// A swing holds while its least and its greatest tilt, and the way of the tilt, are right to this part of it.
const SWING_TOLERANCE: f64 = 0.05;
/// Where the exact motion's tilt swings by less than this (degrees) it does not swing; the summary gives no more digits.
const NO_SWING_DEG: f64 = 1e-4;
/// Then the run's tilt may differ from it by so much, rad: by the same part of what the traced point may.
const WHERE_NONE_RAD: f64 = SWING_TOLERANCE * BELIEVED_WITHIN;
/// So many swings up or down make a stretch, where the run has as many: the phase counts for little then.
const SWINGS_PER_WINDOW: f64 = 40.0;
/// With fewer of them the way of the tilt says nothing of a period.
const FEW_SWINGS: f64 = 3.0;
/// The most blocks of steps that are kept; when there are more, two and two become one.
const MOST_SWING_BINS: usize = 128;

/// Both swings so far; to be shown every step.
#[derive(Clone, Debug)]
pub(super) struct Swings {
    blocks: Vec<SwingBin>,
    /// Steps of a block, at least as many as are taken in together, and those that the last one has.
    steps: u64,
    last_steps: u64,
    /// The heights of the run's axle and of the exact motion's at the last step.
    last: [f64; 2],
}

/// What the heights of both axles did on consecutive steps.
#[derive(Clone, Copy, Debug)]
struct SwingBin {
    from_s: f64,
    to_s: f64,
    /// The run's, and the exact motion's.
    ways: [HeightRange; 2],
}

/// Least and greatest [height], and the sum of all changes of it, without their signs.
#[derive(Clone, Copy, Debug)]
struct HeightRange {
    least: f64,
    greatest: f64,
    length: f64,
}

/// The swing of the tilt in a run beside the exact motion's, in the stretch in which they differ most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingComparison {
    /// Where the stretch begins and ends, s; `None` where it is the whole run.
    pub stretch_s: Option<(f64, f64)>,
    /// The run's least and greatest tilt in it, degrees.
    pub run_deg: (f64, f64),
    /// The exact motion's, degrees.
    pub exact_deg: (f64, f64),
    /// How many times as far as the exact motion's the run's tilt goes up and down in all.
    pub way: f64,
    /// Whether the least or the greatest tilt is wrong.
    pub tilts_differ: bool,
    /// The largest difference, in units of what is allowed.
    pub worst: f64,
}

/// cos|cos| of the tilt of an axle whose z is `cosine`: no root or arc has to be taken for it.
#[inline]
pub(super) fn height(cosine: f64) -> f64 {
    cosine * cosine.abs()
}

/// The [height] of the axle in `state`, which may have lost its length. It changes by no more than the tilt does (rad).
#[inline]
pub(super) fn height_in(state: &State) -> f64 {
    let axle = state.axle();
    height(axle.z) / axle.norm_squared()
}

fn tilt_deg(height: f64) -> f64 {
    let cosine = height.abs().sqrt().copysign(height);
    libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees()
}

/// Whether a tilt from `least` to `greatest` degrees swings.
fn swings((least, greatest): (f64, f64)) -> bool {
    greatest - least >= NO_SWING_DEG
}

/// By how much tilts may differ from the exact motion's, which swing so, degrees.
fn allowed_deg(exact_deg: (f64, f64)) -> f64 {
    if swings(exact_deg) {
        SWING_TOLERANCE * (exact_deg.1 - exact_deg.0)
    } else {
        WHERE_NONE_RAD.to_degrees()
    }
}

impl Swings {
    /// Of a run that begins in `start`, as its exact motion does.
    pub fn new(start: &State) -> Self {
        let last = [height_in(start); 2];
        Self {
            blocks: vec![SwingBin::new(start.time_s, last)],
            steps: AT_ONCE as u64,
            last_steps: 0,
            last,
        }
    }

    /// Takes in steps of the run that follow each other, beside the [heights](height) of the exact motion's axle. However
    /// many are taken in together, the numbers are the same.
    #[inline]
    pub fn record<const N: usize>(&mut self, states: &[State; N], exact: &[f64; N]) {
        let run = states.each_ref().map(height_in);
        let room = (self.steps - self.last_steps).min(N as u64) as usize;
        if room == N {
            self.take_in(states, [&run, exact]);
        } else {
            self.take_in(&states[..room], [&run[..room], &exact[..room]]);
            self.begin_block();
            self.take_in(&states[room..], [&run[room..], &exact[room..]]);
        }
    }

    #[inline]
    fn take_in(&mut self, states: &[State], heights: [&[f64]; 2]) {
        let (Some(block), Some(last)) = (self.blocks.last_mut(), states.last()) else {
            return;
        };
        block.to_s = last.time_s;
        for ((way, previous), values) in block.ways.iter_mut().zip(&mut self.last).zip(heights) {
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
    fn begin_block(&mut self) {
        if self.blocks.len() == MOST_SWING_BINS {
            self.steps *= 2;
            self.blocks = self
                .blocks
                .chunks(2)
                .map(|two| two[1..].iter().fold(two[0], SwingBin::and))
                .collect();
        }
        self.last_steps = 0;
        let from_s = self.blocks.last().map_or(0.0, |block| block.to_s);
        self.blocks.push(SwingBin::new(from_s, self.last));
    }

    /// Both swings where they differ most.
    pub fn worst(&self) -> Option<SwingComparison> {
        let mut stretches: Vec<SwingBin> = Vec::new();
        for block in &self.blocks {
            match stretches.last_mut() {
                Some(last) if last.ways[1].swings() < SWINGS_PER_WINDOW => *last = last.and(block),
                _ => stretches.push(*block),
            }
        }
        // What is left at the end belongs to the stretch before.
        if let [.., before, rest] = &mut stretches[..]
            && rest.ways[1].swings() < SWINGS_PER_WINDOW
        {
            *before = before.and(rest);
            stretches.pop();
        }
        let is_whole_run = stretches.len() == 1;
        let swings = stretches.iter().map(|block| block.swing(is_whole_run));
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
        let ways = heights.map(|height| HeightRange {
            least: height,
            greatest: height,
            length: 0.0,
        });
        Self {
            from_s,
            to_s: from_s,
            ways,
        }
    }

    /// Both of two blocks that follow each other.
    fn and(self, next: &Self) -> Self {
        let [run, exact] = self.ways;
        Self {
            to_s: next.to_s,
            ways: [run.and(&next.ways[0]), exact.and(&next.ways[1])],
            ..self
        }
    }

    fn swing(&self, is_whole_run: bool) -> SwingComparison {
        let [run, exact] = self.ways;
        let (run_deg, exact_deg) = (run.tilts_deg(), exact.tilts_deg());
        let most_deg = allowed_deg(exact_deg);
        let off_deg = (run_deg.0 - exact_deg.0)
            .abs()
            .max((run_deg.1 - exact_deg.1).abs());
        let way = run.length / exact.length;
        let is_there = swings(exact_deg) && exact.swings() >= FEW_SWINGS;
        let of_way = if is_there {
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
            worst: (off_deg / most_deg).max(of_way),
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

    /// How often it has gone up or down; 0 where it has not moved.
    fn swings(&self) -> f64 {
        let range = self.greatest - self.least;
        if range > 0.0 {
            self.length / range
        } else {
            0.0
        }
    }

    /// Least and greatest tilt, degrees: the height falls as the tilt grows.
    fn tilts_deg(&self) -> (f64, f64) {
        (tilt_deg(self.greatest), tilt_deg(self.least))
    }
}

impl SwingComparison {
    /// Whether the run's swing is the exact motion's.
    pub fn is_right(&self) -> bool {
        self.worst <= 1.0
    }

    /// Whether the exact motion's tilt swings at all.
    pub fn is_there(&self) -> bool {
        swings(self.exact_deg)
    }

    /// Tilts in degrees, as many digits as tell them apart, of the run and of the exact motion.
    fn tilts(&self) -> [String; 4] {
        let digits = -libm::log10(allowed_deg(self.exact_deg)).floor();
        let [(a, b), (c, d)] = [self.run_deg, self.exact_deg];
        [a, b, c, d].map(|tilt| fixed(tilt, digits.max(0.0) as usize))
    }

    /// What is wrong, in few words: "tilt 29.690..30.000, truly 30.000..30.074".
    pub fn in_short(&self) -> String {
        if !self.tilts_differ {
            return format!("swings add up to {} times", short(self.way));
        }
        let [a, b, c, d] = self.tilts();
        format!("tilt {a}..{b}, truly {c}..{d}")
    }
}

impl fmt::Display for SwingComparison {
    /// What is wrong: "the tilt swings from 29.690 to 30.000 degrees, not from 30.000 to 30.074".
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
                "the swings of the tilt add up to {way} times what they should, too {are}"
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

    /// Ten thousand steps of a run whose tilt, degrees, is `tilt_of` the time, thirty to a second, beside a [wave] at 30 degrees.
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

    /// A nutation of a tenth of a degree and a second.
    fn wave(time: f64) -> f64 {
        0.05 * (1.0 - libm::cos(std::f64::consts::TAU * time))
    }

    #[test]
    fn size_place_and_period_of_the_swing_count_and_its_phase_does_not() {
        let is_right = |tilt_of: fn(f64) -> f64| beside(tilt_of).is_right();
        assert!(is_right(|time| 30.0 + wave(time)));
        assert!(is_right(|time| 30.0 + wave(time + 0.3)));
        assert!(is_right(|time| 30.0 + 1.02 * wave(1.02 * time)));
        assert!(!is_right(|time| 30.0 + 1.08 * wave(time)));
        assert!(!is_right(|time| 30.01 + wave(time)));
        assert!(!is_right(|time| 30.0 + wave(1.08 * time)));
        // It dies so slowly that the whole run's least and greatest tilt are right.
        assert!(!is_right(
            |time| 30.05 - (0.05 - wave(time)) * libm::exp(-time / 300.0)
        ));
    }
}
