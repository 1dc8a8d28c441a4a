//! The age of each part of a path, measured in swings and turns of the motion: the last swings, the last turn, and all
//! before.

use crate::engine::analysis::{MeasuredNumber, Readouts};
use std::f64::consts::TAU;

const RECENT_SWINGS: f64 = 10.0;
/// Where swings are closer together on the picture than this many dots, fewer of them count as recent, but at least
/// `LEAST_SWINGS`.
const CLOSEST_DOTS: f64 = 4.0;
const LEAST_SWINGS: f64 = 2.0;
/// The recent part of a path is at most this share of a turn, so that its beginning and its end can be told apart.
const RECENT_TURN: f64 = 1.0 / 3.0;
/// Where the time of a turn is not known, it is this multiple of the recent time.
const TURN: f64 = 6.0;
/// Lengths of time are rounded up to a power of e to this number: measured periods change a little all the time, and the
/// picture should not.
const GRADE: f64 = 0.1;
/// The recent part of a path begins at a multiple of this share of its length.
const NOTCH: f64 = 1.0 / 16.0;

/// How long a part of a path counts as recent, and as of the last turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ages {
    /// The time that is recent, s; infinite where nothing is known of the motion.
    pub recent_s: f64,
    /// The time of the last turn, s, what is recent included.
    pub turn_s: f64,
    pub swing_s: Option<f64>,
    pub are_crowded: bool,
}

/// The age of a part of a path, the oldest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Age {
    Old,
    Turn,
    Recent,
}

impl Ages {
    /// Where nothing is known of the motion: all of it is recent.
    pub const UNKNOWN: Self = Self {
        recent_s: f64::INFINITY,
        turn_s: f64::INFINITY,
        swing_s: None,
        are_crowded: false,
    };

    /// Returns the ages of the motion with these `readouts`: by the measured precession, or else by that of theory.
    pub fn from_readouts(readouts: &Readouts) -> Self {
        let rate = match readouts.precession.filter(MeasuredNumber::is_settled) {
            Some(measured) => Some(measured.value),
            None => readouts
                .theory_about_z()
                .and_then(|theory| theory.precession),
        };
        let turn_s = rate.map(|rate| TAU / rate.abs());
        Self::new(readouts.swing_s(), turn_s)
    }

    pub fn new(swing_s: Option<f64>, turn_s: Option<f64>) -> Self {
        let [swing_s, turn_s] = [swing_s, turn_s]
            .map(|time_s| time_s.filter(|time_s| time_s.is_finite() && *time_s > 0.0));
        let by_swings = swing_s.map(|swing_s| RECENT_SWINGS * swing_s);
        let by_turn = turn_s.map(|turn_s| RECENT_TURN * turn_s);
        let recent_s = match (by_swings, by_turn) {
            (Some(swings), Some(turn)) => swings.min(turn),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => return Self::UNKNOWN,
        };
        Self {
            recent_s: graded(recent_s),
            turn_s: graded(turn_s.unwrap_or(TURN * recent_s)),
            swing_s,
            are_crowded: false,
        }
    }

    /// Returns the same for a picture on which a turn is `turn_dots` long: where the swings are so close that they
    /// cover each other, fewer of them are recent.
    pub fn on_picture(self, turn_dots: f64) -> Self {
        let Some(swing_s) = self.swing_s else {
            return self;
        };
        let apart = turn_dots * swing_s / self.turn_s;
        let swings = (RECENT_SWINGS * apart / CLOSEST_DOTS).max(LEAST_SWINGS);
        Self {
            recent_s: self.recent_s.min(graded(swings * swing_s)),
            are_crowded: apart < CLOSEST_DOTS,
            ..self
        }
    }

    /// Returns the time at which the part of `age` begins when the run is at `now_s`, s. It moves on in steps and not
    /// in every frame, because each change of the picture has to be sent to the terminal.
    pub fn since(&self, age: Age, now_s: f64) -> f64 {
        let length_s = match age {
            Age::Old => return f64::NEG_INFINITY,
            Age::Turn => self.turn_s,
            Age::Recent => self.recent_s,
        };
        if !length_s.is_finite() {
            return f64::NEG_INFINITY;
        }
        let notch_s = NOTCH * self.recent_s;
        ((now_s - length_s) / notch_s).floor() * notch_s
    }
}

fn graded(length_s: f64) -> f64 {
    libm::exp((libm::log(length_s) / GRADE).ceil() * GRADE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_is_none_says_nothing_of_the_motion() {
        assert_eq!(Ages::new(Some(f64::NAN), Some(0.0)), Ages::UNKNOWN);
    }

    #[test]
    fn recent_begins_at_notches_and_reaches_back_far_enough() {
        let ages = Ages::new(Some(0.1), Some(100.0));
        let begins: Vec<_> = (0..100)
            .map(|frame| ages.since(Age::Recent, 50.0 + 0.01 * f64::from(frame)))
            .collect();
        let moves = begins.windows(2).filter(|pair| pair[0] != pair[1]);
        assert!((10..20).contains(&moves.count()));
        for (begin, frame) in begins.iter().zip(0..) {
            let reaches_back = 50.0 + 0.01 * f64::from(frame) - begin;
            assert!(reaches_back >= ages.recent_s && reaches_back <= 1.07 * ages.recent_s);
        }
    }
}
