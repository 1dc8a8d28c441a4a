//! What stands between a long command and its user: progress on stderr, and signals that end it.

use super::INTERRUPTED;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use signal_hook::consts::{SIGHUP, TERM_SIGNALS};
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A flag that the first signal to end raises; a second one ends the process on the spot, should it be stuck.
///
/// A write past the limit on a file's size (`ulimit -f`) fails like one to a full disk: its signal, left to itself,
/// would end the process with the temporary file still there.
pub(super) fn interruption() -> io::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let hangup = (!hangup_is_ignored()).then_some(SIGHUP);
    for signal in TERM_SIGNALS.iter().copied().chain(hangup) {
        signal_hook::flag::register_conditional_shutdown(
            signal,
            INTERRUPTED.into(),
            Arc::clone(&flag),
        )?;
        signal_hook::flag::register(signal, Arc::clone(&flag))?;
    }
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(flag)
}

/// Whether the process was started to outlive its terminal (`nohup`): a handler of ours would undo that. Linux says so
/// in the process's status; elsewhere, where nothing says, a hang-up is left to the system.
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}

/// Steps, rate and time left on stderr, for runs that take more than a second and have somebody to watch them.
pub(super) struct Meter {
    begin: Instant,
    bar: Option<ProgressBar>,
}

impl Meter {
    const QUIET: Duration = Duration::from_secs(1);

    pub(super) fn new() -> Self {
        Self {
            begin: Instant::now(),
            bar: None,
        }
    }

    pub(super) fn show(&mut self, step: u64, steps: u64) {
        if self.begin.elapsed() < Self::QUIET || !io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar =
                ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(4));
            let template = "{wide_bar} step {human_pos} of {human_len}, {per_sec}, {eta} left";
            let style = ProgressStyle::with_template(template)
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.with_style(style.progress_chars("=> "))
                .with_elapsed(self.begin.elapsed())
        });
        bar.set_position(step);
    }

    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
