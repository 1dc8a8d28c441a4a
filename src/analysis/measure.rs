//! What a run did, measured on its steps as they come: precession and nutation, each with its uncertainty.
//!
//! Method. The axle's height turns back twice in every nutation. Nutation is the mean time from one such point to the
//! next of its kind, precession the change of azimuth from the first to the last over the time between them.
//!
//! Of a symmetric top each nutation is like the one before, and its second half the mirror image of the first. Where the
//! time step is short enough to follow it, a turning point is found between two rows by the equations of motion, from
//! either of them: the difference is what the scheme's step has done otherwise. With rounding, and with the distance of
//! the turning points from a steady rate, it makes the uncertainty. Half a nutation is enough then.
//!
//! Of other runs, those of a lopsided body, under a load aside, whose time step is too long, or whose nutation is no larger
//! than the error of a scheme of the first order, a parabola through three rows gives the highest points, and it takes four
//! nutations to say how much they differ, of a lopsided body sixteen. Rows so few that a nutation may lie unseen between
//! them give no period. A run without nutation has its precession from the whole way of the azimuth. Where less was seen
//! than that there is no number.
//!
//! A turning point is read by interpolation between two rows, and how far that reading is off is known from the equations
//! of motion. It is stated in the uncertainty and not taken away from the value. Taken away, the value would no longer be
//! read off the rows but computed from the equations that it is to be compared with: it would agree with theory to rounding
//! however coarse the rows are, and nothing would be left that the uncertainty could be compared with.
//!
//! What is measured is the run as its steps show it: the error of its scheme is not in the uncertainty, and a nutation of
//! less than two time steps is seen as a slower one, as it is on the screen.

use super::between::Between;
use super::rows::Rows;
pub use super::turns::Measured;
use crate::run::Step;

/// The instruments that follow a run; to be shown every step of it.
#[derive(Clone, Debug)]
pub enum Instruments {
    Between(Box<Between>),
    Rows(Box<Rows>),
}

impl Instruments {
    /// Instruments that begin to follow a run at `step`.
    pub fn new(step: &Step) -> Self {
        match Between::new(step) {
            Some(between) => Self::Between(Box::new(between)),
            None => Self::Rows(Box::new(Rows::new(step))),
        }
    }

    #[inline]
    pub fn follow(&mut self, step: &Step) {
        match self {
            Self::Between(between) => between.follow(step),
            Self::Rows(rows) => rows.follow(step),
        }
    }

    /// Nutation period of the run so far, s; `None` where too little of it was seen to say how well it is known.
    pub fn nutation_period_s(&self) -> Option<Measured> {
        match self {
            Self::Between(between) => between.nutation_period_s(),
            Self::Rows(rows) => rows.nutation_period_s(),
        }
    }

    /// Precession of the run so far, rad/s; `None` likewise, and where the axle passes through the vertical.
    pub fn precession_rad_per_s(&self) -> Option<Measured> {
        match self {
            Self::Between(between) => between.precession_rad_per_s(),
            Self::Rows(rows) => rows.precession_rad_per_s(),
        }
    }
}
