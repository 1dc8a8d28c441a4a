//! The exact motion of a scenario, with which a run is compared.
//!
//! It has the scenario's start, and its pushes and edits of gravity at the same times in seconds. It never uses a state
//! that the scheme has computed, and does not depend on edits of the time step or the scheme.

use super::Clock;
use super::pushes::{self, Counting, Stretch};
use crate::physics::exact::{AT_ONCE, ExactMethod};
use crate::physics::{ExactMotion, Loads, State};
use crate::scenario::{Pushes, Scenario};
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// Exact motion of one scenario, at any time.
#[derive(Clone, Debug)]
pub struct Truth {
    scenario: Arc<Scenario>,
    /// State at t = 0.
    start: State,
    /// Time intervals between edits of gravity and pushes, in order. The first begins at 0.
    eras: Vec<Era>,
    /// Motion since the forces last changed.
    piece: ExactMotion,
    end_s: f64,
    loads: Loads,
    pieces: u64,
}

#[derive(Clone, Debug)]
struct Era {
    begin_s: f64,
    gravity: f64,
    pushes: Pushes,
}

impl Truth {
    pub fn new(scenario: Arc<Scenario>) -> Self {
        let start = scenario.start;
        Self::from_start(scenario, start)
    }

    /// Returns the exact motion under the forces of `scenario`, with the state `start` at t = 0.
    pub fn from_start(scenario: Arc<Scenario>, start: State) -> Self {
        let mut truth = Self {
            eras: eras(&scenario),
            piece: ExactMotion::new(&scenario.body.mechanics, &Loads::default(), &start),
            end_s: 0.0,
            loads: Loads::default(),
            pieces: 0,
            scenario,
            start,
        };
        truth.begin_piece(start);
        truth
    }

    /// Returns the state at `time_s`, s, which must not be negative. Later times cost little. For a time before the
    /// last change of forces, the motion is computed again from the start.
    pub fn state_at(&mut self, time_s: f64) -> State {
        self.go_to(time_s);
        self.piece.at(time_s)
    }

    /// Returns only the orientation of [`state_at`](Self::state_at), in half the time.
    #[inline]
    pub fn orientation_at(&mut self, time_s: f64) -> Matrix3<f64> {
        self.go_to(time_s);
        self.piece.orientation_at(time_s)
    }

    /// Returns the positions of the body's point `at` (body frame, m) at `times` (s, in order): x, y and z, m, world
    /// frame. They are accurate to a few units of rounding of its distance from the pivot. `None` if there is no such
    /// fast computation, or the forces change before the last time.
    pub fn positions_near(
        &self,
        at: &Vector3<f64>,
        times: &[f64; AT_ONCE],
    ) -> Option<[[f64; AT_ONCE]; 3]> {
        let is_here = self.piece.begin_s() <= times[0] && times[AT_ONCE - 1] <= self.end_s;
        is_here
            .then(|| self.piece.positions_near(at, times))
            .flatten()
    }

    /// Goes to the piece of the motion that contains `time_s`.
    #[inline]
    fn go_to(&mut self, time_s: f64) {
        if time_s < self.piece.begin_s() {
            self.pieces = 0;
            self.begin_piece(self.start);
        }
        while time_s > self.end_s {
            let state = self.piece.at(self.end_s);
            self.begin_piece(state);
        }
    }

    /// Continues as the exact motion of `scenario`, which has the same past up to the last requested time.
    pub fn branch(&mut self, scenario: &Arc<Scenario>) {
        self.eras = eras(scenario);
        self.scenario = Arc::clone(scenario);
        let begin_s = self.piece.begin_s();
        self.end_s = self.end_of_piece(begin_s);
        // An edit at the beginning of the piece, as at the start, applies to the whole piece.
        if self.loads_from(begin_s) != self.loads {
            let state = if begin_s == 0.0 {
                self.start
            } else {
                self.piece.at(begin_s)
            };
            self.begin_piece(state);
        }
    }

    pub fn scenario(&self) -> &Arc<Scenario> {
        &self.scenario
    }

    /// Returns the exact motion under the forces at the last requested time.
    pub fn motion(&self) -> &ExactMotion {
        &self.piece
    }

    /// Returns the forces at the last requested time.
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Returns the time of the next change of forces after the last requested time, s. Infinity if they never change.
    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Returns the method that gives the motion at the last requested time.
    pub fn kind(&self) -> ExactMethod {
        self.piece.kind()
    }

    /// Returns the number of changes of the forces so far. A copy of [`motion`](Self::motion) is valid while this
    /// number stays the same.
    pub fn changes(&self) -> u64 {
        self.pieces
    }

    fn era_at(&self, time_s: f64) -> usize {
        let begun = self.eras.partition_point(|era| era.begin_s <= time_s);
        begun.saturating_sub(1)
    }

    /// Returns the time of the next change of forces after `begin` (s).
    fn end_of_piece(&self, begin: f64) -> f64 {
        let index = self.era_at(begin);
        let counting = Counting::in_seconds(&self.scenario);
        let next_push = pushes::next_after(&self.eras[index].pushes, counting, begin);
        let next_era = self
            .eras
            .get(index + 1)
            .map_or(f64::INFINITY, |era| era.begin_s);
        next_push.min(next_era)
    }

    /// Returns the forces of the piece from `begin` to [`end_s`](Self::end_s), s.
    fn loads_from(&self, begin: f64) -> Loads {
        let era = &self.eras[self.era_at(begin)];
        let stretch = Stretch {
            step: 1,
            begin,
            end: self.end_s,
        };
        let mut loads = Loads {
            gravity: era.gravity,
            pushes: Vec::new(),
            friction: self.scenario.friction,
        };
        pushes::acting(
            &era.pushes,
            Counting::in_seconds(&self.scenario),
            &stretch,
            &mut loads.pushes,
        );
        loads
    }

    fn begin_piece(&mut self, state: State) {
        let begin = state.time_s;
        self.end_s = self.end_of_piece(begin);
        self.loads = self.loads_from(begin);
        self.piece = ExactMotion::new(&self.scenario.body.mechanics, &self.loads, &state);
        self.pieces += 1;
    }
}

fn eras(scenario: &Scenario) -> Vec<Era> {
    let mut eras = vec![Era {
        begin_s: 0.0,
        gravity: scenario.motion.gravity,
        pushes: scenario.pushes.clone(),
    }];
    for (begin_s, edit) in Clock::edits(scenario) {
        // An edit of the time step or the scheme changes no force, and therefore not the exact motion.
        match eras.last() {
            Some(last) if last.gravity == edit.motion.gravity && last.pushes == edit.pushes => {}
            _ => eras.push(Era {
                begin_s,
                gravity: edit.motion.gravity,
                pushes: edit.pushes.clone(),
            }),
        }
    }
    eras
}
