//! When the next frame is drawn: frames keep to a rate, and to a number of bytes a second that a slow line can carry.
//!
//! A frame may send a share of bytes that depends on the size of the screen. Where it sends more, as the wheel of the 3-D
//! view does, the frames after it are drawn later, so that no motion sends more bytes a second than another.

use std::time::Duration;

/// The share of a frame on a screen of 80x24 cells, and what each further cell adds to it, bytes: at ten frames a second 3
/// kB/s there and 10 kB/s at 200x50.
const FRAME_BYTES: f64 = 280.0;
const SMALL_SCREEN: f64 = 80.0 * 24.0;
const SHARE_OF_CELL: f64 = 0.08;
/// A frame follows the one before within this time however much that one has sent: a motion that stood still for
/// longer would look like a run that has stopped.
const LONGEST_FRAME_GAP: Duration = Duration::from_millis(750);

#[derive(Clone, Copy, Debug, Default)]
pub struct Pacing {
    /// The least time between frames that no key asks for.
    frame: Duration,
    due: Duration,
}

impl Pacing {
    /// Frames at `rate` a second at most.
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

    /// Takes in that a frame of `bytes` was drawn at `now` on a screen of `cells`.
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

    /// Bytes a second when each frame sends `bytes`.
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
    fn frames_that_send_much_are_drawn_less_often() {
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
    fn no_frame_makes_the_next_wait_long() {
        let mut pacing = Pacing::new(10);
        pacing.drawn(Duration::ZERO, 1_000_000, SMALL_SCREEN_CELLS);
        assert_eq!(pacing.wait(Duration::ZERO), LONGEST_FRAME_GAP);
        let mut slow = Pacing::new(1);
        slow.drawn(Duration::ZERO, 1_000_000, SMALL_SCREEN_CELLS);
        assert_eq!(slow.wait(Duration::ZERO), Duration::from_secs(1));
    }
}
