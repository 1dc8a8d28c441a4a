//! What stands between a long command and its user: progress on stderr, and signals that end it.

use super::INTERRUPTED;
use crate::export::Destination;
use crate::export::destination::DestinationError;
use crate::export::temporary;
use indicatif::{
    HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle,
};
use signal_hook::consts::{SIGHUP, TERM_SIGNALS};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use std::fmt;
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// What a signal to end does: it raises a flag, and ends the process where that has not been seen after a while.
#[derive(Clone, Debug)]
pub(super) struct Interruption {
    has_come: Arc<AtomicBool>,
    at_once: Arc<AtomicBool>,
}

impl Interruption {
    /// Whether a signal has come.
    pub(super) fn has_come(&self) -> bool {
        self.has_come.load(Ordering::SeqCst)
    }

    /// Whether to go on, for what asks as it works.
    pub(super) fn go_on(&self) -> ControlFlow<()> {
        if self.has_come() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// From now on, with no file to clear away, the first signal ends the process on the spot. Gives whether one has
    /// come before.
    pub(super) fn may_act_at_once(&self) -> bool {
        self.at_once.store(true, Ordering::SeqCst);
        self.has_come()
    }
}

/// How long after a signal the process may go on: a command that has not ended by then computes something that asks nobody.
const PATIENCE: Duration = Duration::from_millis(1500);

impl Interruption {
    /// Waits for the first of `signals`, raises the flag, and ends the process where it has not ended after a while.
    fn listen(&self, signals: &mut Signals) {
        if signals.forever().next().is_none() {
            return;
        }
        self.has_come.store(true, Ordering::SeqCst);
        if !self.at_once.load(Ordering::SeqCst) {
            thread::sleep(PATIENCE);
        }
        temporary::remove_own();
        signal_hook::low_level::exit(INTERRUPTED.into());
    }

    /// The same in the handlers of `signals` themselves, where every second signal ends the process.
    fn listen_without_thread(&self, signals: &[i32]) -> io::Result<()> {
        for &signal in signals {
            for condition in [&self.has_come, &self.at_once] {
                let condition = Arc::clone(condition);
                flag::register_conditional_shutdown(signal, INTERRUPTED.into(), condition)?;
            }
            flag::register(signal, Arc::clone(&self.has_come))?;
        }
        Ok(())
    }
}

/// Opens `path` for writing, if there is one to open, and has signals end what follows.
///
/// The signals must have their handlers before there is a temporary file that one of them could leave behind. But a FIFO
/// is opened first: that may wait for ever, and a signal shall end the wait.
pub(super) fn open(
    path: Option<&Path>,
    replace: bool,
) -> anyhow::Result<(Option<Destination>, Interruption)> {
    let open = || -> Result<_, DestinationError> {
        path.map(|path| Destination::open(path, replace))
            .transpose()
    };
    if path.is_some_and(Destination::may_wait) {
        let output = open()?;
        return Ok((output, interruption()?));
    }
    let interruption = interruption()?;
    Ok((open()?, interruption))
}

/// Has signals raise the flag: on a thread of its own, or without it where the system gives no thread.
///
/// A write past the limit on a file's size (`ulimit -f`) fails like one to a full disk: its signal, left to itself,
/// would end the process with the temporary file still there.
pub(super) fn interruption() -> io::Result<Interruption> {
    let interruption = Interruption {
        has_come: Arc::default(),
        at_once: Arc::default(),
    };
    let hangup = (!hangup_is_ignored()).then_some(SIGHUP);
    let ends: Vec<_> = TERM_SIGNALS.iter().copied().chain(hangup).collect();
    let mut signals = Signals::new(&ends)?;
    let handle = signals.handle();
    let heard = interruption.clone();
    let listener = thread::Builder::new().name("signals".to_owned());
    if listener.spawn(move || heard.listen(&mut signals)).is_err() {
        handle.close();
        interruption.listen_without_thread(&ends)?;
    }
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(interruption)
}

/// Whether the process was started to outlive its terminal (`nohup`): a handler of ours would undo that. Linux says so
/// in the process's status; elsewhere, where nothing says, a hang-up is left to the system.
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}

/// What is going on, on stderr, for work of which nobody knows how much there is: after a second, for somebody who watches.
pub(super) struct Ticker {
    begin: Instant,
    bar: Option<ProgressBar>,
}

impl Ticker {
    pub(super) fn new() -> Self {
        Self {
            begin: Instant::now(),
            bar: None,
        }
    }

    pub(super) fn show(&mut self, text: &str) {
        if self.begin.elapsed() < Meter::QUIET || !io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(4));
            bar.enable_steady_tick(Duration::from_millis(250));
            bar
        });
        bar.set_message(text.to_owned());
    }

    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Steps, rate and time left on stderr, for runs that take more than a second and have somebody to watch them.
pub(super) struct Meter {
    /// What is counted.
    of: &'static str,
    begin: Instant,
    bar: Option<ProgressBar>,
}

impl Meter {
    const QUIET: Duration = Duration::from_secs(1);

    pub(super) fn new() -> Self {
        Self::counting("step")
    }

    /// A meter of other things than steps.
    pub(super) fn counting(of: &'static str) -> Self {
        Self {
            of,
            begin: Instant::now(),
            bar: None,
        }
    }

    /// Shows at once that there are `steps` to come, and none done.
    pub(super) fn begin(&mut self, steps: u64) {
        if io::stderr().is_terminal() {
            self.bar(steps).tick();
        }
    }

    pub(super) fn show(&mut self, step: u64, steps: u64) {
        let is_early = self.bar.is_none() && self.begin.elapsed() < Self::QUIET;
        if is_early || !io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar(steps);
        bar.set_length(steps); // a file of commands goes to one step after the other
        bar.set_position(step);
    }

    fn bar(&mut self, steps: u64) -> &ProgressBar {
        let (of, begin) = (self.of, self.begin);
        self.bar.get_or_insert_with(|| {
            let bar =
                ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(4));
            let template = format!("{{wide_bar}} {of} {{human_pos}} of {{human_len}}{{pace}}");
            let style = ProgressStyle::with_template(&template)
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let pace = move |state: &ProgressState, text: &mut dyn fmt::Write| {
                let left = state.len().unwrap_or_default().saturating_sub(state.pos());
                // What cannot be shown of it is not worth an error.
                let _ = text.write_str(&pace(of, state.pos(), left, state.elapsed()));
            };
            let style = style.with_key("pace", pace).progress_chars("=> ");
            bar.with_style(style).with_elapsed(begin.elapsed())
        })
    }

    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// `, 12/s, 40s left` behind the count of `of`: the rate of all that is `done`, and all the time that it took, since a
/// rate of the last moments would be wrong at first. Nothing before something is done; seconds for each where they are
/// more than one.
fn pace(of: &str, done: u64, left: u64, elapsed: Duration) -> String {
    /// No time left is told to be longer, s: ten years.
    const MOST_S: f64 = 3e8;
    if done == 0 {
        return String::new();
    }
    let each_s = elapsed.as_secs_f64() / done as f64;
    let rest = Duration::from_secs_f64((each_s * left as f64).min(MOST_S));
    let rate = match each_s {
        each_s if each_s < 0.1 => format!("{}/s", HumanCount((1.0 / each_s).round() as u64)),
        each_s if each_s <= 1.0 => format!("{:.1}/s", 1.0 / each_s),
        each_s => format!("{each_s:.1} s a {of}"),
    };
    format!(", {rate}, {:#} left", HumanDuration(rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_told_once_there_is_one_and_never_as_0() {
        let told = |done, left, s| pace("row", done, left, Duration::from_secs_f64(s));
        assert_eq!(told(0, 1000, 1.1), "");
        assert_eq!(told(1000, 9000, 0.5), ", 2,000/s, 5s left");
        assert_eq!(told(5, 5, 2.0), ", 2.5/s, 2s left");
        assert_eq!(told(2, 98, 11.0), ", 5.5 s a row, 9m left");
        assert_eq!(told(10, 0, 20.0), ", 2.0 s a row, 0s left");
    }
}
