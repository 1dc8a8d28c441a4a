//! The window of the strip of the fast motion. While it passes too fast to be seen, it is chosen only once in a while.

use super::Player;
use crate::engine::recording::RecordedCurve;
use crate::engine::run::Clock;
use crate::lab::playback::detail::{Detail, DetailRequest, Placement};
use crate::lab::playback::live::LiveRun;
use crate::lab::playback::pace::Speed;
use crate::lab::playback::reading::Reading;
use crate::lab::view::View;
use std::time::Duration;

/// If the window passes in less wall time than this, s, the strip stands still for a while.
const PASSES_S: f64 = 8.0;
/// How long the strip then stands still.
const HOLD: Duration = Duration::from_secs(1);

pub(super) struct FastStrip {
    pub(super) detail: Detail,
    chosen_at: Duration,
    /// Whether `detail` is of the run that was opened last.
    is_of_run: bool,
}

impl FastStrip {
    pub(super) fn new(run: &LiveRun, reading: &Reading) -> Self {
        let following = DetailRequest::following(Clock::end_s(run.scenario()));
        Self {
            detail: Detail::new(run, &reading.readouts, &following, None),
            chosen_at: Duration::ZERO,
            is_of_run: true,
        }
    }

    /// Notes that another run was opened: the window says nothing about it.
    pub(super) fn forget(&mut self) {
        self.is_of_run = false;
    }
}

impl Player {
    /// Chooses the window of the strip at `now`, about the cursor where it is shown. Returns a message where the strip
    /// shows another curve of the same run than before.
    pub(super) fn choose_strip(&mut self, now: Duration, view: &View) -> Option<&'static str> {
        let FastStrip {
            detail,
            chosen_at,
            is_of_run,
        } = &self.strip;
        let cursor_s = self.cursor().map(|cursor| cursor.time_s);
        let is_fast = match self.speed() {
            _ if !self.is_running() => false,
            Speed::Top => true,
            Speed::Times(speed) => speed * PASSES_S > detail.window_s,
        };
        let is_at_end = !self.is_running() && self.step_number() >= self.end_step();
        let is_held = is_fast && cursor_s.is_none();
        let is_reached = detail.begin_s + detail.window_s <= self.run.now().time_s;
        if is_held && *is_of_run && is_reached && now < *chosen_at + HOLD {
            return None;
        }
        let request = DetailRequest {
            window_s: view.look.detail_s,
            curve: view.look.detail_of,
            long_s: view.look.window_s,
            place: match cursor_s {
                Some(cursor_s) => Placement::About(cursor_s),
                None if is_held => Placement::Latest,
                None if is_at_end => Placement::UpToNow,
                None => Placement::Following,
            },
        };
        let before = is_of_run.then_some(detail);
        let chosen = Detail::new(&self.run, &self.reading.readouts, &request, before);
        let is_other = before.is_some_and(|before| before.curve != chosen.curve);
        self.strip = FastStrip {
            detail: chosen,
            chosen_at: now,
            is_of_run: true,
        };
        // After a jump in time the strip's label says it; only one who watches the run sees the strip change.
        let is_watched = self.is_running() && view.look.detail_of.is_none();
        (is_other && is_watched).then_some(match chosen.curve {
            RecordedCurve::Tilt => "the upper strip shows the tilt again",
            _ => "the upper strip shows x now: it swings more often than the tilt",
        })
    }
}
