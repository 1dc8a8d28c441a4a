//! The window of time in which the fast motion is drawn swing by swing, while the others show the slow motion.
//!
//! It is about ten swings of the tilt long and begins where the tilt is greatest; where only x swings, it is chosen by x.
//! While the run is played so fast that nobody could follow the window, the window stands still and is replaced by a later
//! one now and then; for a periodic motion the picture then stays the same.

use super::live::LiveRun;
use super::strip::{LEAST_DRAWN_SWING_DEG, Strip};
use crate::engine::analysis::Readouts;
use crate::engine::recording::{RecordedCurve, Recording};
use crate::engine::text::nice_numbers;

const MOST_SWINGS: f64 = 12.0;
/// With this number of swings or fewer in the window, a longer window is taken.
const FEWEST_SWINGS: f64 = 4.0;
/// When the run comes to the end of the window, the window moves on by this share of its length.
const WINDOW_ADVANCE: f64 = 0.25;
/// x is shown once it turns `BECOMES_X` times as often as the tilt, until it turns less than `STAYS_X` times as often.
const BECOMES_X: f64 = 3.0;
const STAYS_X: f64 = 1.5;
/// The fewest columns of dots in which a swing is seen as one: of small dots, and of dots as wide as a cell.
const COLUMNS_OF_SMALL: f64 = 5.0;
const COLUMNS_OF_LARGE: f64 = 8.0;
/// The fewest swings that a part of the window shows, where there is room.
const FEWEST_SEEN: f64 = 3.0;
const LEAST_STEPS: f64 = 10.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// What was chosen, or else the tilt, or x where the tilt does not swing and x does.
    pub curve: RecordedCurve,
    pub begin_s: f64,
    pub window_s: f64,
    /// The period of the swings that its length was chosen by, s; `None` where it was chosen by hand or nothing swings.
    pub swing_s: Option<f64>,
    /// Whether it stands still for a while, because the run is too fast for anyone to follow it.
    pub is_snapshot: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct DetailRequest {
    pub window_s: Option<f64>,
    pub curve: Option<RecordedCurve>,
    /// Length of the long window, s: the longest that it may have.
    pub long_s: f64,
    pub place: Placement,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placement {
    /// The present: the run fills the window, which moves on when it is full.
    Following,
    /// The latest time for a whole window that begins at the top of a swing.
    Latest,
    UpToNow,
    About(f64),
}

impl DetailRequest {
    pub fn following(long_s: f64) -> Self {
        Self {
            window_s: None,
            curve: None,
            long_s,
            place: Placement::Following,
        }
    }
}

impl Detail {
    /// Returns the window for `run` with these `readouts`; `before` is the last one.
    pub fn new(
        run: &LiveRun,
        readouts: &Readouts,
        wanted: &DetailRequest,
        before: Option<&Self>,
    ) -> Self {
        let was_x = before.is_some_and(|before| before.curve == RecordedCurve::X);
        let (chosen, period_s) = match (
            x_period_s(run.recording(), wanted.long_s, was_x),
            readouts.swing_s(),
        ) {
            (Some(of_x), measured) if was_x || measured.is_none() => (RecordedCurve::X, Some(of_x)),
            (_, Some(measured)) => (RecordedCurve::Tilt, Some(measured)),
            (_, None) => (
                RecordedCurve::Tilt,
                tilt_period_s(run.recording(), wanted.long_s),
            ),
        };
        let curve = wanted.curve.unwrap_or(chosen);
        let least_s = LEAST_STEPS * readouts.time_step_s;
        let window_s = wanted.window_s.unwrap_or_else(|| {
            period_s.map_or(wanted.long_s, |period_s| {
                length_s(period_s, before.map(|before| before.window_s))
                    .max(least_s)
                    .min(wanted.long_s)
            })
        });
        let swing_s = period_s.unwrap_or(0.0).min(0.5 * window_s);
        let now_s = run.now().time_s;
        let begin_s = match wanted.place {
            Placement::About(about_s) => about_s - 0.5 * window_s,
            Placement::UpToNow => now_s - window_s,
            Placement::Latest => highest_s(run.recording(), curve, now_s - window_s, swing_s),
            Placement::Following => {
                let pages = ((now_s + swing_s - window_s) / (WINDOW_ADVANCE * window_s)).ceil();
                let begin_s = WINDOW_ADVANCE * window_s * pages.max(0.0);
                highest_s(run.recording(), curve, begin_s, swing_s)
            }
        };
        Self {
            curve,
            begin_s: begin_s.max(0.0),
            window_s,
            swing_s: period_s.filter(|_| wanted.window_s.is_none()),
            is_snapshot: wanted.place == Placement::Latest,
        }
    }

    /// Returns the window on `columns` of dots, `is_small` if a cell has two of them: where it has no room for all
    /// swings of the window, a part of it that has `at_s` (s).
    pub fn strip(&self, columns: usize, is_small: bool, at_s: f64) -> Strip {
        let least = if is_small {
            COLUMNS_OF_SMALL
        } else {
            COLUMNS_OF_LARGE
        };
        let swings = self.swing_s.map_or(1.0, |swing_s| self.window_s / swing_s);
        let needed = swings * least / columns.max(1) as f64;
        // A whole part of the window where that has swings enough.
        let parts = if swings >= FEWEST_SEEN * needed.ceil() {
            needed.ceil()
        } else {
            needed
        };
        let part_s = self.window_s / parts.min(swings.floor()).max(1.0);
        let shown_s = if self.is_snapshot {
            0.0
        } else {
            at_s - self.begin_s
        };
        let part = Strip::following(shown_s.min(self.window_s), part_s, columns);
        let begin_s = part.begin_s.min(self.window_s - part_s);
        Strip::new(self.begin_s + begin_s, part_s, columns)
    }
}

/// Returns the period of x, s, where x swings while the tilt hardly does, in a time short beside `long_s` (s); with
/// `was_x` it has done so before, and the tilt must swing more often to be taken instead.
fn x_period_s(recording: &Recording, long_s: f64, was_x: bool) -> Option<f64> {
    let (time_s, [x, tilt]) = turns(recording, long_s)?;
    let swing_s = 2.0 * time_s / x;
    let more_often = if was_x { STAYS_X } else { BECOMES_X };
    (x > 2.0 && x > more_often * tilt && MOST_SWINGS * swing_s < long_s).then_some(swing_s)
}

/// Returns the period of the tilt, s, as it was recorded in the last `long_s` (s); `None` where it changes by rounding
/// alone.
fn tilt_period_s(recording: &Recording, long_s: f64) -> Option<f64> {
    let (time_s, [_, tilt]) = turns(recording, long_s)?;
    let extent = recording.whole()?.extent(RecordedCurve::Tilt);
    (tilt > 2.0 && extent.max - extent.min > LEAST_DRAWN_SWING_DEG).then_some(2.0 * time_s / tilt)
}

/// Returns the recorded part of the last `long_s`, s, and how often x and the tilt turned in it.
fn turns(recording: &Recording, long_s: f64) -> Option<(f64, [f64; 2])> {
    let end_s = recording.whole()?.end_s;
    let since_s = (end_s - long_s).max(0.0);
    let turns = recording.since(since_s).fold([0, 0], |[x, tilt], bin| {
        [
            x + bin.turns(RecordedCurve::X),
            tilt + bin.turns(RecordedCurve::Tilt),
        ]
    });
    Some((end_s - since_s, turns.map(f64::from)))
}

/// Returns a length of 1, 2 or 5 times a power of ten for swings of `swing_s`; `before_s` as long as that is right (all
/// s).
fn length_s(swing_s: f64, before_s: Option<f64>) -> f64 {
    before_s
        .filter(|length_s| {
            (FEWEST_SWINGS..=MOST_SWINGS + 1.0).contains(&(length_s / swing_s))
                && nice_numbers::at_or_below(*length_s) == *length_s
        })
        .unwrap_or_else(|| nice_numbers::at_or_below(MOST_SWINGS * swing_s))
}

/// Returns the time between `begin_s - swing_s` and `begin_s` (s) at which `curve` is highest; before the first swing
/// the beginning.
fn highest_s(recording: &Recording, curve: RecordedCurve, begin_s: f64, swing_s: f64) -> f64 {
    if begin_s <= swing_s || swing_s <= 0.0 {
        return begin_s;
    }
    let bins = recording.between(begin_s - swing_s, begin_s);
    let highest = bins
        .map(|bin| (bin.extent(curve).max, bin.begin_s))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    highest.map_or(begin_s, |(_, time_s)| time_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn detail(run: &mut LiveRun, wanted: &DetailRequest, before: Option<&Detail>) -> Detail {
        let readouts = run.readouts();
        Detail::new(run, &readouts, wanted, before)
    }

    /// A preset after this many steps, and its window in a long one of `long_s`.
    fn at(preset: &str, steps: u64, long_s: f64) -> (LiveRun, Detail) {
        let mut run = LiveRun::played(preset, steps);
        let detail = detail(&mut run, &DetailRequest::following(long_s), None);
        (run, detail)
    }

    #[test]
    fn it_shows_between_four_and_twelve_swings_on_the_ladder() {
        for (preset, steps) in [
            ("cusps", 2000),
            ("loops", 2000),
            ("method-1", 900),
            ("wobble-push", 180),
        ] {
            let (mut run, detail) = at(preset, steps, 230.0);
            let swings = detail.window_s / run.readouts().swing_s().unwrap();
            assert!((4.0..=12.1).contains(&swings), "{preset}: {swings}");
            assert_eq!(nice_numbers::at_or_below(detail.window_s), detail.window_s);
            let shown = detail.begin_s..=detail.begin_s + detail.window_s;
            assert!(shown.contains(&run.now().time_s), "{preset}");
        }
    }

    #[test]
    fn a_motion_keeps_to_one_curve() {
        // The curve of a free body is x as soon as that is seen to swing; of the others the tilt all the time.
        for (preset, most) in [
            ("poinsot", 0),
            ("method-2", 0),
            ("wobble-push", 0),
            ("wing-nut", 1),
        ] {
            let mut run = LiveRun::played(preset, 0);
            let end_s = run.scenario().steps as f64 * run.scenario().motion.time_step_s;
            let mut before: Option<Detail> = None;
            let mut changes = 0;
            for step in 0..run.scenario().steps.min(2500) {
                run.step().unwrap();
                if step.is_multiple_of(20) {
                    let detail =
                        detail(&mut run, &DetailRequest::following(end_s), before.as_ref());
                    changes += u32::from(before.is_some_and(|before| before.curve != detail.curve));
                    before = Some(detail);
                }
            }
            assert!(changes <= most, "{preset}: {changes} changes");
        }
    }

    #[test]
    fn a_swing_is_at_least_five_small_dots_wide_or_eight_cells() {
        for (preset, steps) in [("method-1", 900), ("wobble-push", 900), ("poinsot", 5000)] {
            let (run, detail) = at(preset, steps, 15.0);
            let now_s = run.now().time_s;
            for (columns, is_small, least) in [(50, true, 5.0), (25, false, 8.0)] {
                let strip = detail.strip(columns, is_small, now_s);
                let swings = strip.window_s / detail.swing_s.unwrap();
                let width = columns as f64 / swings;
                assert!(width >= least, "{preset}: {width} columns a swing");
                assert!(swings >= 3.0, "{preset}: {swings} swings");
                assert!(strip.column(now_s).is_some(), "{preset}: {strip:?}");
            }
        }
    }
}
