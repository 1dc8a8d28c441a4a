//! Chooses the time that the traces show.
//!
//! The window is a few swings long and shows each of them. While its time passes too fast to be followed, the strips stand
//! still like those of an oscilloscope and are replaced once a second by a window that ends at a maximum of z, so that
//! successive pictures match. A run of few swings, or of none, is shown from its start.

use super::{Player, furthest_s};
use crate::engine::recording::{Extent, RecordedCurve, Recording};
use crate::lab::comparison::Comparison;
use crate::lab::playback::pace::Speed;
use crate::lab::view::View;
use crate::lab::view::window::TimeWindow;
use std::time::Duration;

/// A run of at most this number of swings is shown as a whole.
const FEW_SWINGS: f64 = 16.0;
/// The fewest swings to which the axis of such a run is shortened while the run is short.
const FEWEST_SWINGS: f64 = 4.0;
/// The most times that this axis is halved.
const MOST_HALVINGS: i32 = 3;
/// A period or a height must differ by this share before another window is chosen for it.
const HYSTERESIS: f64 = 0.1;
/// A swing of the traced point that is smaller than this share of its distance from the pivot is no reason for a window:
/// the run is shown as a whole, where slow motion is seen.
const LEAST_SWING: f64 = 5e-4;
/// The least range of values of a strip, as a share of the distance between pivot and traced point; of the tilt, rad.
const LEAST_RANGE: f64 = 2e-3;
/// A window that passes in less wall time than this, s, is held.
const PASSES_S: f64 = 4.0;
/// How long the strips then stand still.
const HOLD: Duration = Duration::from_secs(1);
/// The window jumps by this share of its length where the run leaves it.
const JUMP: f64 = 0.5;
/// By how much a range is extended where the curve leaves it, as a share of the range.
const EXTENSION: f64 = 0.1;

/// The swings of a run as its steps show them.
#[derive(Clone, Copy)]
struct Swing {
    period_s: f64,
    /// How far they carry the traced point, m.
    height_m: f64,
}

impl Player {
    /// Returns the window to show at `now`; `view.window` is the one shown before.
    pub(in crate::lab) fn window(
        &mut self,
        now: Duration,
        view: &View,
        comparison: &Comparison,
    ) -> TimeWindow {
        let swing = self.swing();
        let mut window = self.place_window(now, view, swing);
        window.ranges = self.ranges(&window, &view.window, comparison);
        window
    }

    fn place_window(&mut self, now: Duration, view: &View, swing: Option<Swing>) -> TimeWindow {
        let now_s = self.run.now().time_s;
        let span_s = view.look.window_s;
        let whole_s = self.whole_s().min(span_s);
        let before = &view.window;
        let swing_s = swing.map(|swing| swing.period_s);
        let chosen_s = view.look.detail_s.filter(|chosen_s| *chosen_s < whole_s);
        let automatic_s = match (view.look.detail_s, swing) {
            (None, Some(swing)) if self.is_fast(swing, whole_s, before) => {
                Some(kept(view.swings as f64 * swing.period_s, before.length_s()))
            }
            _ => None,
        };
        let window = |begin_s: f64, length_s: f64, is_held: bool| TimeWindow {
            begin_s,
            end_s: begin_s + length_s,
            swing_s,
            has_overview: chosen_s.or(automatic_s).is_some(),
            is_held,
            ranges: before.ranges,
        };
        let Some(length_s) = chosen_s.or(automatic_s) else {
            if let Some(since_s) = view.since_s {
                return TimeWindow {
                    has_overview: since_s > 0.0,
                    ..window(since_s, whole_s, false)
                };
            }
            let is_whole = view.look.detail_s.is_some();
            let begin_s = follow_by_halves(now_s, whole_s);
            let length_s = if begin_s > 0.0 || is_whole {
                whole_s
            } else {
                halved(whole_s, now_s, swing_s)
            };
            return window(begin_s, length_s, false);
        };
        if let Some(since_s) = view.since_s {
            return window(since_s, length_s, false);
        }
        let passes = match self.speed() {
            _ if !self.is_running() => false,
            Speed::Top => true,
            Speed::Times(speed) => speed * PASSES_S > length_s,
        };
        let is_held = passes && view.cursor.is_none() && now_s > length_s;
        if is_held {
            let is_same = before.is_held && kept(length_s, before.length_s()) == before.length_s();
            if is_same && before.end_s <= now_s && now < self.window_held_at + HOLD {
                return before.clone();
            }
            self.window_held_at = now;
            let end_s = highest_s(self.run.recording(), now_s, swing_s.unwrap_or(0.0));
            return window((end_s - length_s).max(0.0), length_s, true);
        }
        let is_at_end = !self.is_running() && self.step_number() >= self.end_step();
        if is_at_end {
            return window((now_s - length_s).max(0.0), length_s, false);
        }
        window(follow_by_halves(now_s, length_s), length_s, false)
    }

    /// Returns the time at the right end of the overview, s: that of the scenario's run, doubled as often as the run has
    /// continued beyond it.
    pub fn whole_s(&self) -> f64 {
        let end_s = self.end_s.max(f64::MIN_POSITIVE);
        let doublings = libm::log2(furthest_s(&self.run) / end_s * (1.0 - 1e-9)).ceil();
        end_s * libm::exp2(doublings.max(0.0))
    }

    /// Returns true if the run of `whole_s` (s) has more swings than its strips can show, and they can be seen.
    fn is_fast(&self, swing: Swing, whole_s: f64, before: &TimeWindow) -> bool {
        let ease = if before.has_overview {
            1.0 - HYSTERESIS
        } else {
            1.0
        };
        let arm_m = self.run.scenario().arm_m();
        whole_s / swing.period_s > ease * FEW_SWINGS && swing.height_m > ease * LEAST_SWING * arm_m
    }

    /// Returns the swings of the tilt, or those of the traced point if the tilt does not swing.
    fn swing(&self) -> Option<Swing> {
        let recording = self.run.recording();
        let arm_m = self.run.scenario().arm_m();
        let now_s = self.run.now().time_s;
        let height_m = |period_s: f64| {
            let since_s = now_s - 2.0 * period_s;
            let extent = |curve| recording.extent_between(since_s, now_s, curve);
            let tilt_m = extent(RecordedCurve::Tilt)
                .map_or(0.0, |tilt| (tilt.max - tilt.min).to_radians() * arm_m);
            let z_m = extent(RecordedCurve::Z).map_or(0.0, |z| z.max - z.min);
            tilt_m.max(z_m)
        };
        let measured = self.reading.readouts.swing_s().map(|period_s| Swing {
            period_s,
            height_m: height_m(period_s),
        });
        let is_seen = measured.is_some_and(|swing| swing.height_m > LEAST_SWING * arm_m);
        if is_seen {
            return measured;
        }
        self.swing_of_point().or(measured)
    }

    /// Returns the swings of x as they are recorded, over the latest half of the run.
    fn swing_of_point(&self) -> Option<Swing> {
        let recording = self.run.recording();
        let end_s = self.run.now().time_s;
        let bins = recording.since(0.5 * end_s);
        let turns: u32 = bins.map(|bin| bin.turns(RecordedCurve::X)).sum();
        if turns < 3 {
            return None;
        }
        let period_s = end_s / f64::from(turns);
        let x = recording.extent_between(end_s - 2.0 * period_s, end_s, RecordedCurve::X)?;
        Some(Swing {
            period_s,
            height_m: x.max - x.min,
        })
    }

    /// Returns the range of values of each strip. While the run is played, a range grows in steps and shrinks only with
    /// another window.
    fn ranges(
        &self,
        window: &TimeWindow,
        before: &TimeWindow,
        comparison: &Comparison,
    ) -> [Extent; 4] {
        let is_same = (window.begin_s, window.end_s) == (before.begin_s, before.end_s);
        let now_s = self.run.now().time_s;
        let others = [comparison.ghost(), comparison.pinned()];
        RecordedCurve::ALL.map(|curve| {
            let shown = |recording: &Recording, end_s: f64| {
                recording.extent_between(window.begin_s, window.end_s.min(end_s), curve)
            };
            let run = shown(self.run.recording(), now_s);
            let exact = self
                .run
                .overlay()
                .and_then(|exact| shown(&exact.recording, now_s));
            let ghosts = others.into_iter().flatten();
            let extent = ghosts
                .filter_map(|ghost| shown(&ghost.recording, f64::INFINITY))
                .chain(run)
                .chain(exact)
                .reduce(Extent::and)
                .unwrap_or(Extent::single(self.run.now().value(curve)));
            let least = match curve {
                RecordedCurve::Tilt => LEAST_RANGE.to_degrees(),
                _ => LEAST_RANGE * self.run.scenario().arm_m(),
            };
            let tight = widened(extent, least);
            if self.is_running() && is_same {
                extended(before.range(curve), tight)
            } else {
                tight
            }
        })
    }
}

/// Returns `length_s`, or `before_s` if the two differ by little.
fn kept(length_s: f64, before_s: f64) -> f64 {
    let is_near = (length_s - before_s).abs() < HYSTERESIS * before_s;
    if is_near { before_s } else { length_s }
}

/// Returns the beginning of the window of `length_s` that has `now_s` and has jumped by halves of its length (all s).
fn follow_by_halves(now_s: f64, length_s: f64) -> f64 {
    let jumps = ((now_s / length_s * (1.0 - 1e-12) - 1.0) / JUMP).ceil();
    jumps.max(0.0) * JUMP * length_s
}

/// Returns `whole_s`, halved as often as that holds `now_s` and a few swings of `swing_s` (all s).
fn halved(whole_s: f64, now_s: f64, swing_s: Option<f64>) -> f64 {
    let least_s = now_s.max(FEWEST_SWINGS * swing_s.unwrap_or(0.0));
    (0..=MOST_HALVINGS)
        .map(|halvings| whole_s / libm::exp2(f64::from(halvings)))
        .take_while(|length_s| *length_s >= least_s * (1.0 - 1e-9))
        .last()
        .unwrap_or(whole_s)
}

/// Returns the time of the latest maximum of z up to `now_s`, in the last swing of `swing_s` (all s).
fn highest_s(recording: &Recording, now_s: f64, swing_s: f64) -> f64 {
    let bins = recording.between(now_s - swing_s, now_s);
    let highest = bins
        .map(|bin| (bin.extent(RecordedCurve::Z).max, bin.end_s))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    highest.map_or(now_s, |(_, time_s)| time_s)
}

/// Returns `extent` with a range of at least `least`.
fn widened(extent: Extent, least: f64) -> Extent {
    let missing = (least - (extent.max - extent.min)).max(0.0);
    Extent {
        min: extent.min - 0.5 * missing,
        max: extent.max + 0.5 * missing,
    }
}

/// Returns `range`, extended where `extent` leaves it.
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
