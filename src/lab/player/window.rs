//! Chooses the time window of the traces.
//!
//! The window is a few swings long and shows each of them. If it passes too fast to be followed, it stays fixed, as on
//! an oscilloscope. Once a second it changes to a window that ends at a maximum of z, so that successive pictures
//! match. A run with few swings, or none, is shown from its start.

use super::{Player, furthest_s};
use crate::engine::recording::{Extent, RecordedCurve, Recording};
use crate::engine::scenario::Scenario;
use crate::lab::comparison::Comparison;
use crate::lab::playback::pace::Speed;
use crate::lab::view::View;
use crate::lab::view::window::TimeWindow;
use std::sync::Arc;
use std::time::Duration;

/// A run is shown as a whole if it has at most this many times the swings for which the strips have room.
const FEW_WINDOWS: f64 = 2.0;
/// Minimum number of swings on the shortened axis of such a run while the run is short.
const FEWEST_SWINGS: f64 = 4.0;
/// Maximum number of times that this axis is halved.
const MOST_HALVINGS: i32 = 3;
/// The traced point counts as swinging by itself if it turns more than this many times as often as the tilt.
const MORE_TURNS: f64 = 3.0;
/// Relative change of a period or a height at which another window is chosen.
const HYSTERESIS: f64 = 0.1;
/// Minimum swing of the traced point, as a share of its distance from the pivot. A run with smaller swings is shown as
/// a whole, which shows slow motion.
const MIN_WINDOW_SWING: f64 = 5e-4;
/// Minimum range of values of a strip, as a share of the distance between pivot and traced point; for the tilt, rad.
const MIN_STRIP_RANGE: f64 = 2e-3;
/// A window that passes in less wall-clock time than this stays fixed for a while, s.
const PASSES_S: f64 = 4.0;
/// Time for which such a window stays fixed.
const HOLD: Duration = Duration::from_secs(1);
/// Share of its length by which the window jumps when the run leaves it.
const JUMP: f64 = 0.5;
/// Extension of a range when the curve leaves it, as a share of the range.
const EXTENSION: f64 = 0.3;
/// A range is kept for the next window if that window needs more than this share of it, so that successive pictures
/// match.
const KEPT_RANGE: f64 = 0.9;

/// The swings of a run as measured on its steps.
#[derive(Clone, Copy)]
pub(super) struct Swing {
    period_s: f64,
    /// Peak-to-peak distance of the traced point, m.
    height_m: f64,
}

/// The latest swings that were seen in a run, and the time of the run then.
pub(super) struct SeenSwing {
    scenario: Arc<Scenario>,
    swing: Swing,
    now_s: f64,
}

impl Player {
    /// Returns the window to show at `now`. `view.window` is the previous window.
    pub(in crate::lab) fn window(
        &mut self,
        now: Duration,
        view: &View,
        comparison: &Comparison,
    ) -> TimeWindow {
        let swing = self.seen_swing();
        let chosen_s = self.window_length_s(view, swing);
        let swing_s = swing.map(|swing| swing.period_s);
        let (begin_s, length_s, is_held) = match (view.since_s, chosen_s) {
            (Some(since_s), _) => (since_s, chosen_s.unwrap_or(self.span_s(view)), false),
            (None, Some(length_s)) => self.follow(now, view, length_s, swing_s),
            (None, None) => self.follow_whole(view, swing_s),
        };
        let has_overview = chosen_s.is_some() || (begin_s > 0.0 && view.since_s.is_some());
        let (span_begin_s, span_s) = if has_overview {
            let span_s = self.span_s(view);
            (follow_by_halves(self.run.now().time_s, span_s), span_s)
        } else {
            (0.0, self.whole_s())
        };
        let mut window = TimeWindow {
            begin_s,
            end_s: begin_s + length_s,
            swing_s,
            has_overview,
            is_held,
            span_begin_s,
            span_end_s: span_begin_s + span_s,
            ..view.window
        };
        self.set_ranges(&mut window, &view.window, comparison);
        window
    }

    /// Returns the longest time that the traces can show, s: the whole run, or the chosen length.
    fn span_s(&self, view: &View) -> f64 {
        let chosen_s = view.look.window_s.unwrap_or(f64::INFINITY);
        chosen_s.min(self.whole_s())
    }

    /// Returns the length of the window, s; `None` if the window is the whole run.
    fn window_length_s(&self, view: &View, swing: Option<Swing>) -> Option<f64> {
        let span_s = self.span_s(view);
        let before_s = view.window.end_s - view.window.begin_s;
        match (view.look.detail_s, swing) {
            (Some(chosen_s), _) => (chosen_s < span_s).then_some(chosen_s),
            // Measured points are spread over the run.
            (None, Some(swing)) if !view.measured && self.is_fast(swing, span_s, view) => {
                Some(kept(view.swings as f64 * swing.period_s, before_s))
            }
            (None, _) => None,
        }
    }

    /// Returns the start and the length (s) of a window of `length_s` that follows the run, and true if it stays fixed
    /// for a while.
    fn follow(
        &mut self,
        now: Duration,
        view: &View,
        length_s: f64,
        swing_s: Option<f64>,
    ) -> (f64, f64, bool) {
        let now_s = self.run.now().time_s;
        let passes_fast = match self.speed() {
            _ if !self.is_running() => false,
            Speed::Top => true,
            Speed::Times(speed) => speed * PASSES_S > length_s,
        };
        if passes_fast && view.cursor.is_none() && now_s > length_s {
            let before = &view.window;
            let is_same = before.is_held && before.end_s <= now_s && before.length_s() == length_s;
            if is_same && now < self.window_held_at + HOLD {
                return (before.begin_s, length_s, true);
            }
            self.window_held_at = now;
            let end_s = highest_s(self.run.recording(), now_s, swing_s.unwrap_or(0.0));
            return ((end_s - length_s).max(0.0), length_s, true);
        }
        let is_at_end = !self.is_running() && self.step_number() >= self.end_step();
        let begin_s = if is_at_end {
            (now_s - length_s).max(0.0)
        } else {
            follow_by_halves(now_s, length_s)
        };
        (begin_s, length_s, false)
    }

    /// Returns the same for traces that show the whole run.
    fn follow_whole(&self, view: &View, swing_s: Option<f64>) -> (f64, f64, bool) {
        let (now_s, span_s) = (self.run.now().time_s, self.span_s(view));
        let begin_s = follow_by_halves(now_s, span_s);
        let length_s = if begin_s > 0.0 || view.look.detail_s.is_some() {
            span_s
        } else {
            halved(span_s, now_s, swing_s)
        };
        (begin_s, length_s, false)
    }

    /// Returns the time at the right end of the overview, s: the length of the scenario's run, doubled until it
    /// includes the whole played run.
    pub fn whole_s(&self) -> f64 {
        let end_s = self.end_s.max(f64::MIN_POSITIVE);
        let doublings = libm::log2(furthest_s(&self.run) / end_s * (1.0 - 1e-9)).ceil();
        end_s * libm::exp2(doublings.max(0.0))
    }

    /// Returns true if a run of `span_s` (s) has more visible swings than its strips can show.
    fn is_fast(&self, swing: Swing, span_s: f64, view: &View) -> bool {
        let ease = if view.window.has_overview {
            1.0 - HYSTERESIS
        } else {
            1.0
        };
        let few = FEW_WINDOWS * view.swings as f64;
        let arm_m = self.run.scenario().arm_m();
        span_s / swing.period_s > ease * few && swing.height_m > ease * MIN_WINDOW_SWING * arm_m
    }

    /// Returns the swings of the run.
    ///
    /// If none are seen yet, returns those that the same run had later. The panes then stay as they are when the user
    /// goes back to the start.
    fn seen_swing(&mut self) -> Option<Swing> {
        let (scenario, now_s) = (self.run.scenario(), self.run.now().time_s);
        let later = self.seen_swing.as_ref();
        let later =
            later.filter(|seen| Arc::ptr_eq(&seen.scenario, scenario) && now_s < seen.now_s);
        let least_m = MIN_WINDOW_SWING * scenario.arm_m();
        match (self.swing(), later) {
            (Some(swing), None) if swing.height_m > least_m => {
                self.seen_swing = Some(SeenSwing {
                    scenario: Arc::clone(scenario),
                    swing,
                    now_s,
                });
                Some(swing)
            }
            (Some(swing), _) if swing.height_m > least_m => Some(swing),
            (_, Some(seen)) => Some(seen.swing),
            (swing, None) => swing,
        }
    }

    /// Returns the swings of the tilt, or of the traced point if they are faster or the tilt does not swing.
    fn swing(&self) -> Option<Swing> {
        let arm_m = self.run.scenario().arm_m();
        let of_point = self.swing_of_point();
        let of_tilt = self.reading.readouts.swing_s().map(|period_s| Swing {
            period_s,
            height_m: self
                .height_of_swing(RecordedCurve::Tilt, period_s)
                .to_radians()
                * arm_m,
        });
        let (Some(tilt), Some(point)) = (of_tilt, of_point) else {
            return of_tilt.or(of_point);
        };
        let is_seen = |swing: Swing| swing.height_m > MIN_WINDOW_SWING * arm_m;
        let is_of_point = tilt.period_s > MORE_TURNS * point.period_s || !is_seen(tilt);
        Some(if is_of_point && is_seen(point) {
            point
        } else {
            tilt
        })
    }

    /// Returns the swings of x, from the recording of the second half of the run so far.
    fn swing_of_point(&self) -> Option<Swing> {
        let now_s = self.run.now().time_s;
        let bins = self.run.recording().since(0.5 * now_s);
        let turns: u32 = bins.map(|bin| bin.turns(RecordedCurve::X)).sum();
        let period_s = now_s / f64::from(turns);
        (turns > 2).then(|| Swing {
            period_s,
            height_m: self.height_of_swing(RecordedCurve::X, period_s),
        })
    }

    /// Returns the range of `curve` in the last `period_s` (s), in its unit, without its drift since the previous
    /// period.
    fn height_of_swing(&self, curve: RecordedCurve, period_s: f64) -> f64 {
        let now_s = self.run.now().time_s;
        let extent = |end_s: f64| {
            let recording = self.run.recording();
            recording.extent_between(end_s - period_s, end_s, curve)
        };
        match (extent(now_s), extent(now_s - period_s)) {
            (Some(last), Some(before)) => {
                let drift = 0.5 * ((last.max + last.min) - (before.max + before.min)).abs();
                (last.max - last.min - drift).max(0.0)
            }
            _ => 0.0,
        }
    }

    /// Sets the range of values of each strip and of the overview. While the run is played, a range grows in steps, and
    /// the range of a strip shrinks only with another window.
    fn set_ranges(&self, window: &mut TimeWindow, before: &TimeWindow, comparison: &Comparison) {
        let is_same = (window.begin_s, window.end_s) == (before.begin_s, before.end_s);
        window.ranges = RecordedCurve::ALL.map(|curve| {
            let tight = widened(
                self.extent(window, curve, comparison),
                self.least_range(curve),
            );
            let range = before.range(curve);
            if self.is_running() && is_same {
                extended(range, tight)
            } else if window.is_held && before.is_held && nearly_fills(tight, range) {
                range
            } else {
                tight
            }
        });
        let before_it = comparison.ghost().map(|ghost| &ghost.recording);
        let z = [Some(self.run.recording()), before_it]
            .into_iter()
            .flatten()
            .filter_map(|recording| Some(recording.whole()?.extent(RecordedCurve::Z)))
            .reduce(Extent::and);
        let z = z.unwrap_or(Extent::single(self.run.now().value(RecordedCurve::Z)));
        let tight = widened(z, self.least_range(RecordedCurve::Z));
        let is_longer = before.overview.min >= tight.min || before.overview.max <= tight.max;
        window.overview = if self.is_running() && is_longer {
            extended(before.overview, tight)
        } else {
            tight
        };
    }

    /// Returns the minimum and maximum of `curve` in the window, over the run up to now, the exact motion, and the
    /// other runs shown.
    fn extent(&self, window: &TimeWindow, curve: RecordedCurve, comparison: &Comparison) -> Extent {
        let now_s = self.run.now().time_s;
        let shown = |recording: &Recording, end_s: f64| {
            recording.extent_between(window.begin_s, window.end_s.min(end_s), curve)
        };
        let run = shown(self.run.recording(), now_s);
        let exact = self
            .run
            .overlay()
            .and_then(|exact| shown(&exact.recording, now_s));
        let ghosts = [comparison.ghost(), comparison.pinned()]
            .into_iter()
            .flatten();
        ghosts
            .filter_map(|ghost| shown(&ghost.recording, f64::INFINITY))
            .chain(run)
            .chain(exact)
            .reduce(Extent::and)
            .unwrap_or(Extent::single(self.run.now().value(curve)))
    }

    /// Returns the minimum range of a strip, m; degrees for the tilt.
    fn least_range(&self, curve: RecordedCurve) -> f64 {
        match curve {
            RecordedCurve::Tilt => MIN_STRIP_RANGE.to_degrees(),
            _ => MIN_STRIP_RANGE * self.run.scenario().arm_m(),
        }
    }
}

/// Returns `length_s`, or `before_s` if the two are nearly equal.
fn kept(length_s: f64, before_s: f64) -> f64 {
    let is_near = (length_s - before_s).abs() < HYSTERESIS * before_s;
    if is_near { before_s } else { length_s }
}

/// Returns the start of the window of `length_s` that contains `now_s` and jumps by half of its length (all s).
fn follow_by_halves(now_s: f64, length_s: f64) -> f64 {
    let jumps = ((now_s / length_s * (1.0 - 1e-12) - 1.0) / JUMP).ceil();
    jumps.max(0.0) * JUMP * length_s
}

/// Returns `whole_s`, halved as long as the result still contains `now_s` and a few swings of `swing_s` (all s).
fn halved(whole_s: f64, now_s: f64, swing_s: Option<f64>) -> f64 {
    let least_s = now_s.max(FEWEST_SWINGS * swing_s.unwrap_or(0.0));
    (0..=MOST_HALVINGS)
        .map(|halvings| whole_s / libm::exp2(f64::from(halvings)))
        .take_while(|length_s| *length_s >= least_s * (1.0 - 1e-9))
        .last()
        .unwrap_or(whole_s)
}

/// Returns the time of the maximum of z in the last swing, of `swing_s`, up to `now_s` (all s).
fn highest_s(recording: &Recording, now_s: f64, swing_s: f64) -> f64 {
    let bins = recording.between(now_s - swing_s, now_s);
    let highest = bins
        .map(|bin| (bin.extent(RecordedCurve::Z).max, bin.end_s))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    highest.map_or(now_s, |(_, time_s)| time_s)
}

/// Returns `extent`, widened to a range of at least `least`.
fn widened(extent: Extent, least: f64) -> Extent {
    let missing = (least - (extent.max - extent.min)).max(0.0);
    Extent {
        min: extent.min - 0.5 * missing,
        max: extent.max + 0.5 * missing,
    }
}

/// Returns true if `extent` is inside `range` and covers most of it.
fn nearly_fills(extent: Extent, range: Extent) -> bool {
    let is_inside = extent.min >= range.min && extent.max <= range.max;
    is_inside && extent.max - extent.min > KEPT_RANGE * (range.max - range.min)
}

/// Returns `range`, extended on the sides where `extent` leaves it.
fn extended(range: Extent, extent: Extent) -> Extent {
    let more = EXTENSION * (range.max - range.min);
    Extent {
        min: if extent.min < range.min {
            extent.min.min(range.min - more)
        } else {
            range.min
        },
        max: if extent.max > range.max {
            extent.max.max(range.max + more)
        } else {
            range.max
        },
    }
}
