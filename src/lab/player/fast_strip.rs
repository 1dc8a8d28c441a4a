//! The window of the strip of the fast motion. While it passes too fast to be seen, it is chosen only once in a while.

use crate::engine::analysis::Readouts;
use crate::engine::recording::RecordedCurve;
use crate::engine::run::Clock;
use crate::lab::playback::Playback;
use crate::lab::playback::detail::{Detail, DetailRequest, Placement};
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
    pub(super) fn of(playback: &Playback, reading: &Reading) -> Self {
        let following = DetailRequest::following(Clock::end_s(playback.run().scenario()));
        Self {
            detail: Detail::new(playback.run(), &reading.readouts, &following, None),
            chosen_at: Duration::ZERO,
            is_of_run: true,
        }
    }

    /// Another run was opened: the window says nothing about it.
    pub(super) fn forget(&mut self) {
        self.is_of_run = false;
    }

    /// Chooses the window at `now`, about `cursor_s` where the cursor is shown. Returns a message where it shows another
    /// curve of the same run than before.
    pub(super) fn choose(
        &mut self,
        now: Duration,
        view: &View,
        playback: &Playback,
        readouts: &Readouts,
        cursor_s: Option<f64>,
    ) -> Option<&'static str> {
        let is_fast = match playback.speed() {
            _ if !playback.is_running() => false,
            Speed::Top => true,
            Speed::Times(speed) => speed * PASSES_S > self.detail.window_s,
        };
        let is_held = is_fast && cursor_s.is_none();
        let run = playback.run();
        let is_reached = self.detail.begin_s + self.detail.window_s <= run.now().time_s;
        if is_held && self.is_of_run && is_reached && now < self.chosen_at + HOLD {
            return None;
        }
        let place = match cursor_s {
            Some(cursor_s) => Placement::About(cursor_s),
            None if is_held => Placement::Latest,
            None if playback.is_at_end() => Placement::UpToNow,
            None => Placement::Following,
        };
        let wanted = DetailRequest {
            window_s: view.look.detail_s,
            curve: view.look.detail_of,
            long_s: view.look.window_s,
            place,
        };
        let before = self.is_of_run.then_some(&self.detail);
        let detail = Detail::new(run, readouts, &wanted, before);
        let is_other = before.is_some_and(|before| before.curve != detail.curve);
        (self.detail, self.chosen_at, self.is_of_run) = (detail, now, true);
        // After a jump in time the strip's label says it; only one who watches the run sees the strip change.
        let is_watched = playback.is_running() && view.look.detail_of.is_none();
        (is_other && is_watched).then_some(match self.detail.curve {
            RecordedCurve::Tilt => "the upper strip shows the tilt again",
            _ => "the upper strip shows x now: it swings more often than the tilt",
        })
    }
}
