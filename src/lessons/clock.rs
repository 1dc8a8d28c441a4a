//! The clock of a lesson.

use chrono::Local;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Returns the time of day, the time since the lesson was opened, and its planned minutes.
pub fn shown(since: Duration, minutes: Option<u32>) -> String {
    let (time, gone) = (Local::now().format("%H:%M"), since.as_secs());
    let of = minutes.map_or(String::new(), |minutes| format!(" of {minutes} min"));
    format!("{time} · {}:{:02}{of}", gone / 60, gone % 60)
}

/// Returns the seconds since 1970 (UTC).
pub fn unix_s() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_secs()
}
