//! Frame timing: limits frames to a rate, and to a number of bytes per second that a slow line can carry.
//!
//! A frame may send a number of bytes that depends on the size of the screen. After a larger frame, as with the wheel
//! in the 3-D view, the next ones are drawn later. Thus no motion sends more bytes per second than another.

use std::time::Duration;

/// Bytes allowed per frame on a screen of 80x24 cells.
///
/// With [`SHARE_OF_CELL`] for each further cell, ten frames per second send 3 kB/s at 80x24 and 10 kB/s at 200x50.
const FRAME_BYTES: f64 = 280.0;
const SMALL_SCREEN: f64 = 80.0 * 24.0;
/// Further bytes allowed per cell beyond [`SMALL_SCREEN`].
const SHARE_OF_CELL: f64 = 0.08;
/// Longest time between frames, however many bytes the last one sent. After a longer pause, a run would look stopped.
const LONGEST_FRAME_GAP: Duration = Duration::from_millis(750);

#[derive(Clone, Copy, Debug, Default)]
pub struct Pacing {
    /// Minimum time between frames, except after a key.
    frame: Duration,
    /// Time of the next frame.
    due: Duration,
}

impl Pacing {
    /// Creates a pacing with at most `rate` frames per second.
    pub fn new(rate: u32) -> Self {
        let mut pacing = Self::default();
        pacing.set_rate(rate);
        pacing
    }

    pub fn set_rate(&mut self, rate: u32) {
        self.frame = Duration::from_secs(1) / rate.max(1);
    }

    pub fn is_due(&self, now: Duration) -> bool {
        now >= self.due
    }

    pub fn wait(&self, now: Duration) -> Duration {
        self.due.saturating_sub(now)
    }

    /// Records that a frame of `bytes` was drawn at `now` on a screen of `cells`.
    pub fn drawn(&mut self, now: Duration, bytes: usize, cells: u32) {
        let share = FRAME_BYTES + SHARE_OF_CELL * (f64::from(cells) - SMALL_SCREEN).max(0.0);
        let frames = (bytes as f64 / share).max(1.0);
        let longest = LONGEST_FRAME_GAP.max(self.frame);
        self.due = now + self.frame.mul_f64(frames).min(longest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL_SCREEN_CELLS: u32 = 80 * 24;

    /// Returns the bytes per second if each frame sends `bytes`.
    fn rate(frames: u32, bytes: usize, cells: u32) -> f64 {
        let mut pacing = Pacing::new(frames);
        let mut sent = 0;
        for ms in 0..100_000 {
            let now = Duration::from_millis(ms);
            if pacing.is_due(now) {
                sent += bytes;
                pacing.drawn(now, bytes, cells);
            }
        }
        sent as f64 / 100.0
    }

    #[test]
    fn large_frames_are_drawn_less_often() {
        assert_eq!(rate(10, 100, SMALL_SCREEN_CELLS), 1000.0);
        for bytes in [300, 700, 1500] {
            let sent = rate(10, bytes, SMALL_SCREEN_CELLS);
            assert!((2600.0..=3000.0).contains(&sent), "{bytes}: {sent}");
            let large = rate(10, bytes * 3, 200 * 50);
            assert!((9000.0..=10_000.0).contains(&large), "{bytes}: {large}");
        }
        assert!((3900.0..=4500.0).contains(&rate(15, 700, SMALL_SCREEN_CELLS)));
    }

    #[test]
    fn the_gap_between_frames_is_limited() {
        let mut pacing = Pacing::new(10);
        pacing.drawn(Duration::ZERO, 1_000_000, SMALL_SCREEN_CELLS);
        assert_eq!(pacing.wait(Duration::ZERO), LONGEST_FRAME_GAP);
        let mut slow = Pacing::new(1);
        slow.drawn(Duration::ZERO, 1_000_000, SMALL_SCREEN_CELLS);
        assert_eq!(slow.wait(Duration::ZERO), Duration::from_secs(1));
    }
}
