//! The clock of a lesson: how long it has taken, how much of its time is left, or the time of the day.

use chrono::Local;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The time since the lesson was opened.
    Up,
    /// What is left of the lesson's minutes.
    Down,
    Day,
}

impl Clock {
    /// The next kind of clock; `None` after the last. A lesson without a length has none that counts down.
    pub fn next(self, minutes: Option<u32>) -> Option<Self> {
        match self {
            Self::Up if minutes.is_some() => Some(Self::Down),
            Self::Up | Self::Down => Some(Self::Day),
            Self::Day => None,
        }
    }

    /// What it shows when the lesson was opened `since` ago and should take `minutes`.
    pub fn shown(self, since: Duration, minutes: Option<u32>) -> String {
        let whole = u64::from(minutes.unwrap_or_default()) * 60;
        let gone = since.as_secs();
        match self {
            Self::Up => format!("{} since the beginning", in_minutes(gone)),
            Self::Down if gone <= whole => format!(
                "{} left of {} min",
                in_minutes(whole - gone),
                minutes.unwrap_or_default()
            ),
            Self::Down => format!("{} over time", in_minutes(gone - whole)),
            Self::Day => Local::now().format("%H:%M").to_string(),
        }
    }
}

/// Seconds since 1970 (UTC).
pub fn unix_s() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_secs()
}

fn in_minutes(seconds: u64) -> String {
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_counts_up_and_down() {
        for (clock, minutes, shown) in [
            (Clock::Up, None, "1:01 since the beginning"),
            (Clock::Down, Some(2), "0:59 left of 2 min"),
            (Clock::Down, Some(1), "0:01 over time"),
        ] {
            assert_eq!(clock.shown(Duration::from_secs(61), minutes), shown);
        }
        assert_eq!(Clock::Day.shown(Duration::ZERO, None).len(), 5);
        assert_eq!(Clock::Up.next(None), Some(Clock::Day));
        assert_eq!(Clock::Up.next(Some(5)), Some(Clock::Down));
        assert_eq!(Clock::Day.next(Some(5)), None);
    }
}
