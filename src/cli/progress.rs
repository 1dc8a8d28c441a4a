//! What stands between a long command and its user: progress on stderr, and signals that end it.

use super::INTERRUPTED;
use crate::export::Destination;
use crate::export::destination::DestinationError;
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

/// What a signal to end does: the first one raises a flag, a later one ends the process on the spot, should it be stuck.
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
        match self.has_come() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// From now on, with no file to clear away, the first signal ends the process on the spot. Gives whether one has
    /// come before.
    pub(super) fn may_act_at_once(&self) -> bool {
        self.at_once.store(true, Ordering::SeqCst);
        self.has_come()
    }
}

/// A signal that comes again within this time is the same one: `timeout` sends its own to the process and then to the
/// process group. A user who has seen that nothing happens takes longer.
const SAME: Duration = Duration::from_millis(200);

impl Interruption {
    /// Waits for `signals`: the first raises the flag, and one that comes later ends the process.
    fn listen(&self, signals: &mut Signals) {
        let mut first: Option<Instant> = None;
        for _ in signals.forever() {
            let is_second = first.is_some_and(|first| first.elapsed() > SAME);
            if is_second || self.at_once.load(Ordering::SeqCst) {
                signal_hook::low_level::exit(INTERRUPTED.into());
            }
            self.has_come.store(true, Ordering::SeqCst);
            first.get_or_insert_with(Instant::now);
        }
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

/// Has signals raise the flag: on a thread of its own, which tells a signal that is sent twice at once from a second one, or
/// without it where the system gives no thread.
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
    /// No time left is told to be longer, s: ten years.
    const MOST_SECONDS: f64 = 3e8;

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

    pub(super) fn show(&mut self, step: u64, steps: u64) {
        if self.begin.elapsed() < Self::QUIET || !io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar =
                ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(4));
            let of = self.of;
            let template = format!(
                "{{wide_bar}} {of} {{human_pos}} of {{human_len}}, {{rate}}/s, {{rest}} left"
            );
            let style = ProgressStyle::with_template(&template)
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            // Of all that is done, and all the time that it took: a rate of the last moments would be wrong at first.
            let each =
                |state: &ProgressState| state.elapsed().as_secs_f64() / state.pos().max(1) as f64;
            // What cannot be shown of them is not worth an error.
            let rate = move |state: &ProgressState, text: &mut dyn fmt::Write| {
                let _ = write!(text, "{}", HumanCount((1.0 / each(state)).round() as u64));
            };
            let rest = move |state: &ProgressState, text: &mut dyn fmt::Write| {
                let count = state.len().unwrap_or_default().saturating_sub(state.pos());
                let seconds = (each(state) * count as f64).min(Self::MOST_SECONDS);
                let _ = write!(
                    text,
                    "{:#}",
                    HumanDuration(Duration::from_secs_f64(seconds))
                );
            };
            let style = style.with_key("rate", rate).with_key("rest", rest);
            bar.with_style(style.progress_chars("=> "))
                .with_elapsed(self.begin.elapsed())
        });
        bar.set_length(steps); // a file of commands goes to one step after the other
        bar.set_position(step);
    }

    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
