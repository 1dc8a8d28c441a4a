//! Progress of a long command on stderr, and the signals that end it.

use super::{INTERRUPTED, is_quiet};
use crate::engine::export::Destination;
use crate::engine::export::temporary;
use indicatif::{HumanCount, HumanDuration};
use signal_hook::consts::{SIGHUP, TERM_SIGNALS};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use std::env;
use std::io::{self, IsTerminal, Stderr, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// A signal to end raises a flag; where the command has not ended after a while, the process ends.
#[derive(Clone, Debug, Default)]
pub(super) struct Interruption {
    /// [`WORKING`], [`INTERRUPTED`] or [`KEEPING`]: it leaves the first once, so that a file is kept or the command is
    /// interrupted, and never both.
    stage: Arc<AtomicU8>,
    at_once: Arc<AtomicBool>,
}

const WORKING: u8 = 0;
/// A signal has come.
const INTERRUPTED_BY_SIGNAL: u8 = 1;
/// The result gets its name. A signal comes too late.
const KEEPING: u8 = 2;

impl Interruption {
    pub(super) fn has_come(&self) -> bool {
        self.stage.load(Ordering::SeqCst) == INTERRUPTED_BY_SIGNAL
    }

    /// Enters the last stage of a command that writes a file or a folder. From now on the command ends as if no signal
    /// came.
    ///
    /// # Errors
    /// When one has come before: the result must not be kept.
    pub(super) fn may_keep(&self) -> Result<(), Interrupted> {
        match self.leave_working_for(KEEPING) {
            Err(INTERRUPTED_BY_SIGNAL) => Err(Interrupted),
            _ => Ok(()),
        }
    }

    /// Writes `bytes`, the whole result, to `output`, and keeps it unless a signal has come.
    pub(super) fn keep(&self, mut output: Destination, bytes: &[u8]) -> anyhow::Result<()> {
        output.write_whole(bytes)?;
        self.may_keep()?;
        Ok(output.keep()?)
    }

    fn leave_working_for(&self, next: u8) -> Result<u8, u8> {
        let order = Ordering::SeqCst;
        self.stage.compare_exchange(WORKING, next, order, order)
    }

    /// Whether to go on, for what asks as it works.
    pub(super) fn go_on(&self) -> ControlFlow<()> {
        if self.has_come() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// From now on, with no file to clear away, the first signal ends the process on the spot.
    ///
    /// # Errors
    /// When one has come before.
    pub(super) fn may_act_at_once(&self) -> Result<(), Interrupted> {
        self.at_once.store(true, Ordering::SeqCst);
        if self.has_come() {
            Err(Interrupted)
        } else {
            Ok(())
        }
    }

    /// Shows the step reached and the last one, and says whether to go on; for work that is long in the whole.
    pub(super) fn meter(&self) -> impl Fn(u64, u64) -> ControlFlow<()> + Sync {
        let meter = Meter::counting("step");
        move |step, steps| {
            meter.show(step, steps);
            self.go_on()
        }
    }

    /// Waits for the first of `signals`, raises the flag, and ends the process where it has not ended after a while.
    fn listen(&self, signals: &mut Signals) {
        if signals.forever().next().is_none() {
            return;
        }
        let is_late = self.leave_working_for(INTERRUPTED_BY_SIGNAL).is_err();
        if is_late || !self.at_once.load(Ordering::SeqCst) {
            thread::sleep(SIGNAL_EXIT_LIMIT);
        }
        temporary::remove_own();
        signal_hook::low_level::exit(INTERRUPTED.into());
    }
}

/// A signal has ended the command; what it was writing is gone with its temporary name.
#[derive(Debug, thiserror::Error)]
#[error("interrupted")]
pub(super) struct Interrupted;

/// The longest time from a signal to the end of the process: some computations do not look at the flag.
const SIGNAL_EXIT_LIMIT: Duration = Duration::from_millis(1500);

/// Opens `path` for writing, if there is one to open, and has signals end what follows.
pub(super) fn open(
    path: Option<&Path>,
    replace: bool,
) -> anyhow::Result<(Option<Destination>, Interruption)> {
    let Some(path) = path else {
        return Ok((None, interruption()?));
    };
    let (output, interruption) = open_for(path, replace)?;
    Ok((Some(output), interruption))
}

/// Opens `path` for writing, and has signals end what follows.
///
/// The signals must have their handlers before there is a temporary file that one of them could leave behind. But a FIFO
/// is opened first: that may wait for ever, and a signal shall end the wait.
pub(super) fn open_for(path: &Path, replace: bool) -> anyhow::Result<(Destination, Interruption)> {
    if Destination::may_wait(path) {
        let output = Destination::open(path, replace)?;
        return Ok((output, interruption()?));
    }
    let from_now = interruption()?;
    Ok((Destination::open(path, replace)?, from_now))
}

/// Has signals raise the flag, on a thread of its own. Where the system gives no thread, a signal ends the process at once.
///
/// A write past the limit on a file's size (`ulimit -f`) fails like one to a full disk: its signal, left to itself,
/// would end the process with the temporary file still there.
pub(super) fn interruption() -> io::Result<Interruption> {
    let interruption = Interruption::default();
    let hangup = (!hangup_is_ignored()).then_some(SIGHUP);
    let ends: Vec<_> = TERM_SIGNALS.iter().copied().chain(hangup).collect();
    let mut signals = Signals::new(&ends)?;
    let heard = interruption.clone();
    let listener = thread::Builder::new().name("signals".to_owned());
    if listener.spawn(move || heard.listen(&mut signals)).is_err() {
        for signal in ends {
            flag::register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::new(true.into()))?;
        }
    }
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(interruption)
}

/// Whether the process was started to outlive its terminal (`nohup`): a handler of ours would undo that. Linux says so
/// in the process's status; elsewhere, where nothing says, a hang-up is left to the system.
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_none_or(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}

/// After this time a command says how far it is.
const QUIET: Duration = Duration::from_secs(1);

/// The longest time for which a changed line is not written.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);
/// The columns of a line that changes: a longer one would be wrapped, and its first part would stay.
const PROGRESS_WIDTH: usize = 79;

/// Makes a command write its progress for a program that reads stderr.
const PROGRESS_VARIABLE: &str = "GYROLAB_PROGRESS";

/// Who reads the progress, and how it is written for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Watcher {
    /// A person: each text replaces the one before.
    Person,
    /// A program: each text is a line after a carriage return; the last one is empty.
    Program,
}

/// Returns who watches the progress on stderr.
fn watcher() -> Option<Watcher> {
    if env::var_os(PROGRESS_VARIABLE).is_some_and(|value| value == "lines") {
        return Some(Watcher::Program);
    }
    let is_watched = !is_quiet() && io::stderr().is_terminal();
    is_watched.then_some(Watcher::Person)
}

/// The last line of a terminal, which is written anew. indicatif's bar is not used: it computes its rate with the C
/// library's `exp` and `pow`, and nothing in this program shall.
pub(super) struct LiveLine<T>
where
    for<'a> &'a T: Write,
{
    terminal: T,
    watcher: Watcher,
    written: Mutex<Option<Instant>>,
}

impl<T> LiveLine<T>
where
    for<'a> &'a T: Write,
{
    /// A line on a terminal.
    pub(super) fn new(terminal: T) -> Self {
        Self::watched_by(Watcher::Person, terminal)
    }

    fn watched_by(watcher: Watcher, terminal: T) -> Self {
        Self {
            terminal,
            watcher,
            written: Mutex::default(),
        }
    }

    /// Shows `text`, unless another one was shown a moment ago.
    pub(super) fn show(&self, text: &str) {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        if written.is_none_or(|at| at.elapsed() >= PROGRESS_INTERVAL) {
            *written = Some(Instant::now());
            self.write(&text.chars().take(PROGRESS_WIDTH).collect::<String>());
        }
    }

    /// Prints `text`, of whole lines, above the line.
    pub(super) fn print_above(&self, text: &str) {
        self.write(&(text.to_owned() + "\n"));
    }

    /// What cannot be shown is not worth an error.
    fn write(&self, text: &str) {
        let mut terminal = &self.terminal;
        let _ = match self.watcher {
            Watcher::Person => write!(terminal, "\r\x1b[K{text}"),
            Watcher::Program => writeln!(terminal, "\r{text}"),
        }
        .and_then(|()| terminal.flush());
    }

    fn is_shown(&self) -> bool {
        let written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        written.is_some()
    }
}

impl<T> Drop for LiveLine<T>
where
    for<'a> &'a T: Write,
{
    fn drop(&mut self) {
        if self.is_shown() {
            self.write("");
        }
    }
}

/// Does `work`, which says nothing of how far it is. Meanwhile shows `what` it is and how long it has taken so far, after a
/// second and for somebody who watches.
pub(super) fn with_clock<T>(what: &str, work: impl FnOnce() -> T) -> T {
    if watcher().is_none() {
        return work();
    }
    let (working, is_done) = mpsc::channel::<()>();
    thread::scope(|scope| {
        // If the system gives no thread, nothing is shown.
        let _ = thread::Builder::new().spawn_scoped(scope, move || {
            let meter = Meter::counting("second");
            while is_done.recv_timeout(PROGRESS_INTERVAL) == Err(RecvTimeoutError::Timeout) {
                let elapsed = HumanDuration(meter.begin.elapsed());
                meter.say(&format!("{what}: {elapsed:#}"));
            }
        });
        let result = work();
        drop(working);
        result
    })
}

/// What is going on, on stderr: after a second, for somebody who watches.
pub(super) struct Meter {
    of: &'static str,
    /// How many an earlier command has done. They say nothing about the time that the others take.
    done_before: u64,
    begin: Instant,
    /// `None` if nobody watches.
    line: Option<LiveLine<Stderr>>,
}

impl Meter {
    /// A meter of steps, rows and the like.
    pub(super) fn counting(of: &'static str) -> Self {
        let line = watcher().map(|watcher| LiveLine::watched_by(watcher, io::stderr()));
        Self {
            of,
            done_before: 0,
            begin: Instant::now(),
            line,
        }
    }

    /// Shows at once that `done_before` of `steps` are done, by an earlier command, and the others are to come.
    pub(super) fn begin(&mut self, done_before: u64, steps: u64) {
        self.done_before = done_before;
        if let Some(line) = &self.line {
            line.show(&self.count(done_before, steps));
        }
    }

    /// Shows how many there are, with rate and time left.
    pub(super) fn show(&self, step: u64, steps: u64) {
        if let Some(line) = self.due_line() {
            line.show(&self.count(step, steps));
        }
    }

    /// Shows `text`; for work of unknown length.
    pub(super) fn say(&self, text: &str) {
        if let Some(line) = self.due_line() {
            line.show(text);
        }
    }

    /// Returns the line if somebody watches and the work has taken a while.
    fn due_line(&self) -> Option<&LiveLine<Stderr>> {
        let line = self.line.as_ref()?;
        (line.is_shown() || self.begin.elapsed() >= QUIET).then_some(line)
    }

    fn count(&self, step: u64, steps: u64) -> String {
        let left = steps.saturating_sub(step);
        let done = step.saturating_sub(self.done_before);
        let pace = rate_and_rest(self.of, done, left, self.begin.elapsed());
        let (of, step, steps) = (self.of, HumanCount(step), HumanCount(steps));
        format!("{of} {step} of {steps}{pace}")
    }
}

/// `, 12/s, 40s left` behind the count of `of`: the rate of all that is `done`, and all the time that it took, since a
/// rate of the last moments would be wrong at first. Nothing before something is done; seconds for each where they are
/// more than one.
fn rate_and_rest(of: &str, done: u64, left: u64, elapsed: Duration) -> String {
    /// The longest time left that is shown, s: ten years.
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
    fn a_result_is_either_kept_or_interrupted() {
        let kept = Interruption::default();
        assert!(kept.may_keep().is_ok() && kept.may_keep().is_ok());
        assert!(kept.leave_working_for(INTERRUPTED_BY_SIGNAL).is_err());
        assert!(!kept.has_come() && kept.may_act_at_once().is_ok());
        let interrupted = Interruption::default();
        assert!(interrupted.leave_working_for(INTERRUPTED_BY_SIGNAL).is_ok());
        assert!(interrupted.has_come() && interrupted.may_keep().is_err());
    }

    #[test]
    fn a_rate_is_shown_once_known_and_never_as_0() {
        let told = |done, left, s| rate_and_rest("row", done, left, Duration::from_secs_f64(s));
        assert_eq!(told(0, 1000, 1.1), "");
        assert_eq!(told(1000, 9000, 0.5), ", 2,000/s, 5s left");
        assert_eq!(told(5, 5, 2.0), ", 2.5/s, 2s left");
        assert_eq!(told(2, 98, 11.0), ", 5.5 s a row, 9m left");
        assert_eq!(told(10, 0, 20.0), ", 2.0 s a row, 0s left");
    }

    #[test]
    fn a_resumed_count_shows_the_total_and_the_current_rate() {
        let resumed = Meter {
            done_before: 990,
            begin: Instant::now() - Duration::from_secs(10),
            ..Meter::counting("row")
        };
        assert_eq!(
            resumed.count(995, 1000),
            "row 995 of 1,000, 2.0 s a row, 10s left"
        );
    }
}
