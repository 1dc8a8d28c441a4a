//! Exports a run to a CSV file, or draws a figure of it, in the background. Also estimates the size of the CSV, and
//! creates the command that copies a file from this machine.

use super::at_exit::{self, Registered, Release};
use crate::engine::export::destination::{Destination, DestinationError};
use crate::engine::export::stream::{self, Ended};
use crate::engine::export::{COLUMNS, CsvLayout, CsvWriter};
use crate::engine::run::{Clock, NotFinite, Sample, Simulation};
use crate::engine::scenario::Scenario;
use crate::engine::text::printable::printable;
use crate::lab::playback::live::integration_cost;
use crate::plot::PageFormat;
use crate::report::figure::FigureSource;
use crate::report::figure::of_runs::EXACT_BESIDE;
use std::ffi::OsStr;
use std::io;
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// An export in progress, or a finished one. Dropping it cancels an export in progress and removes its temporary file.
pub struct Exporting {
    path: PathBuf,
    shared: Arc<Shared>,
    worker: Option<JoinHandle<Result<Written, String>>>,
    _at_end: Registered,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    pub path: PathBuf,
    pub rows: Option<u64>,
    pub bytes: u64,
    pub warnings: Vec<String>,
    /// The step at which the numbers stopped being finite, if they did. The file contains the rows before it.
    pub not_finite: Option<NotFinite>,
}

#[derive(Default)]
struct Shared {
    step: AtomicU64,
    steps: u64,
    is_cancelled: AtomicBool,
    has_ended: AtomicBool,
    /// True if the end of the process has cancelled it.
    is_cut_off: AtomicBool,
}

impl Exporting {
    /// Starts writing the run of `scenario`, from step 0 to its last step, to the file `path`.
    ///
    /// It writes the same bytes as `gyrolab run -o`, with the rows and columns of `layout`. The file appears once it is
    /// complete.
    pub fn begin(
        scenario: Arc<Scenario>,
        path: &Path,
        layout: CsvLayout,
        replace: bool,
    ) -> Result<Self, DestinationError> {
        let destination = Destination::open_file(path, replace)?;
        let refused = |error| DestinationError::refused(path, error);
        let csv = CsvWriter::with_layout(destination, &scenario, layout).map_err(refused)?;
        let full = std::path::absolute(path).map_err(refused)?;
        let (steps, written) = (scenario.steps, full.clone());
        Self::spawn(full, steps, move |shared| {
            write(scenario, csv, written, shared)
        })
        .map_err(refused)
    }

    /// Starts drawing the figure of `source` to the file `path` in `format`.
    ///
    /// It writes the same bytes as `gyrolab figure -o`. The file appears once it is complete.
    pub fn begin_figure(
        source: FigureSource,
        path: &Path,
        format: PageFormat,
        replace: bool,
    ) -> Result<Self, DestinationError> {
        let output = Destination::open_file(path, replace)?;
        let refused = |error| DestinationError::refused(path, error);
        let full = std::path::absolute(path).map_err(refused)?;
        let steps = source.runs.iter().map(|run| run.scenario.steps).max();
        let written = full.clone();
        Self::spawn(full, steps.unwrap_or_default(), move |shared| {
            draw(&source, output, written, format, shared)
        })
        .map_err(refused)
    }

    fn spawn(
        path: PathBuf,
        steps: u64,
        write: impl FnOnce(&Shared) -> Result<Written, String> + Send + 'static,
    ) -> io::Result<Self> {
        let shared = Arc::new(Shared {
            steps,
            ..Shared::default()
        });
        let (at_work, at_end) = (Arc::clone(&shared), Arc::clone(&shared));
        let worker = thread::Builder::new()
            .name("export".to_owned())
            .spawn(move || {
                let result = write(&at_work);
                at_work.has_ended.store(true, Ordering::SeqCst);
                result
            })?;
        Ok(Self {
            path,
            shared,
            worker: Some(worker),
            _at_end: at_exit::hook(move |release| at_end.prepare_for(release)),
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the step that the export has reached, and the run's last step.
    pub fn progress(&self) -> (u64, u64) {
        (self.shared.step.load(Ordering::Relaxed), self.shared.steps)
    }

    /// Asks the export to stop and to remove its temporary file. [`outcome`](Self::outcome) reports when it has.
    pub fn cancel(&self) {
        self.shared.cancel();
    }

    /// Returns the description of the written file, or the reason why there is none.
    ///
    /// Returns `None` while the export is in progress and after the result was returned once. It also returns `None` if
    /// the end of the process cuts the export off: the session then records that it was in progress.
    pub fn outcome(&mut self) -> Option<Result<Written, String>> {
        if self.shared.is_cut_off.load(Ordering::SeqCst) {
            return None;
        }
        let worker = self.worker.take_if(|worker| worker.is_finished())?;
        let broken = Err("the export failed, and nothing was written".to_owned());
        Some(worker.join().unwrap_or(broken))
    }
}

impl Drop for Exporting {
    fn drop(&mut self) {
        self.cancel();
        if let Some(worker) = self.worker.take() {
            let _ = worker.join();
        }
    }
}

impl Shared {
    fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::SeqCst);
    }

    /// Records that `step` has been reached. Breaks if the export has been cancelled.
    fn reach(&self, step: u64) -> ControlFlow<()> {
        self.step.store(step.min(self.steps), Ordering::Relaxed);
        if self.is_cancelled.load(Ordering::SeqCst) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Cancels the export before the process ends, and waits until its temporary file is removed. A suspended process
    /// continues its export when it is resumed.
    fn prepare_for(&self, release: Release) {
        if release == Release::Suspend {
            return;
        }
        if !self.has_ended.load(Ordering::SeqCst) {
            self.is_cut_off.store(true, Ordering::SeqCst);
        }
        self.cancel();
        let begin = Instant::now();
        while !self.has_ended.load(Ordering::SeqCst) && begin.elapsed() < release.patience() {
            thread::sleep(Duration::from_millis(2));
        }
    }
}

/// Plays the run of `scenario` and writes its rows to `csv`, which becomes the file `path`.
fn write(
    scenario: Arc<Scenario>,
    mut csv: CsvWriter<Destination>,
    path: PathBuf,
    shared: &Shared,
) -> Result<Written, String> {
    let mut simulation = Simulation::new(scenario);
    let cannot_write = |error| DestinationError::refused(&path, error).fact();
    let (ended, _) = stream::play(
        &mut simulation,
        shared.steps,
        Some(&mut csv),
        |_| {},
        |step, _| shared.reach(step),
    )
    .map_err(cannot_write)?;
    let rows = csv.count();
    let destination = csv.finish().map_err(cannot_write)?;
    if ended == Ended::Stopped || shared.reach(simulation.step_number()).is_break() {
        return Err("the export was stopped, and nothing was written".to_owned());
    }
    let bytes = destination.bytes().map_err(cannot_write)?;
    destination.keep().map_err(|error| error.fact())?;
    Ok(Written {
        path,
        rows: Some(rows),
        warnings: Vec::new(),
        bytes,
        not_finite: ended.not_finite(),
    })
}

/// Draws the figure of `source` on `output`, which becomes the file `path`.
fn draw(
    source: &FigureSource,
    output: Destination,
    path: PathBuf,
    format: PageFormat,
    shared: &Shared,
) -> Result<Written, String> {
    let figure = source
        .draw(|step, _| shared.reach(step))?
        .filter(|_| shared.reach(shared.steps).is_continue())
        .ok_or("the figure was stopped, and nothing was written")?;
    let bytes = source
        .write(&figure.scene, format)
        .map_err(|error| error.to_string())?;
    output
        .write_and_keep(&bytes)
        .map_err(|error| error.fact())?;
    let told = figure.broke.iter().cloned().chain(figure.told());
    Ok(Written {
        path,
        rows: None,
        bytes: bytes.len() as u64,
        warnings: told
            .map(|text| text.replace(EXACT_BESIDE, "t, then X draws it too"))
            .collect(),
        not_finite: None,
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Number of rows. The export has fewer only if the numbers stop being finite.
    pub rows: u64,
    /// Number of bytes, within a few percent.
    pub bytes: u64,
}

/// Estimates the size of the export of `scenario` with every `every`-th row.
///
/// It takes a few milliseconds: it writes 64 rows with numbers from the beginning of the run, and with steps and times
/// spread over the whole run.
pub fn estimate(scenario: &Arc<Scenario>, every: NonZeroU64) -> Estimate {
    let rows = rows(scenario.steps, every.get());
    let csv = sample_rows(scenario, every.get()).unwrap_or_default(); // writing to memory does not fail
    let (mut few, mut bytes) = (0, 0);
    for line in csv.split_inclusive(|&byte| byte == b'\n').rev() {
        if line.starts_with(COLUMNS[0].name.as_bytes()) {
            break;
        }
        (few, bytes) = (few + 1, bytes + line.len());
    }
    let row = bytes as f64 / f64::from(few.max(1));
    Estimate {
        rows,
        bytes: ((row * rows as f64).round() as u64).saturating_add((csv.len() - bytes) as u64),
    }
}

/// Returns the number of rows of a run that ends at step `last`: rows 0, `every`, 2 `every` and so on, and the last.
fn rows(last: u64, every: u64) -> u64 {
    last / every + 1 + u64::from(!last.is_multiple_of(every))
}

/// Returns a CSV of 64 rows with numbers from the beginning of the run, and with steps and times spread over the whole
/// run.
fn sample_rows(scenario: &Arc<Scenario>, every: u64) -> io::Result<Vec<u8>> {
    const ROWS_PER_SLICE: u64 = 64;
    const MOST_INTEGRATION: u64 = 50_000_000; // about 0.1 s
    let mut left = MOST_INTEGRATION;
    let points = scenario.body.mechanics.points().len() as u64;
    // Steps between rows; a step of a larger body takes longer.
    let apart = ((1 << 15) / points)
        .clamp(4, 32)
        .min(scenario.steps / ROWS_PER_SLICE)
        .max(1);
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut csv = CsvWriter::new(Vec::new(), scenario)?;
    for row in 0..ROWS_PER_SLICE {
        let part = row as f64 / (ROWS_PER_SLICE - 1) as f64;
        let step = (part * scenario.steps as f64) as u64 / every * every;
        csv.write(&Sample {
            step,
            time_s: Clock::at(scenario, step).time_s(step),
            ..simulation.sample()
        })?;
        // If the numbers stop being finite, or steps take long, the last state is repeated.
        for _ in simulation.step_number()..((row + 1) * apart).min(scenario.steps) {
            left = left.saturating_sub(integration_cost(&simulation, 0));
            if left == 0 || simulation.step().is_err() {
                break;
            }
        }
    }
    csv.finish()
}

/// Returns the `scp` command that the user types on their own machine to fetch the file `path`; `None` if the lab does
/// not run over SSH.
///
/// If the name of the file, the user or the machine cannot be typed in a shell, returns a message that says so.
pub fn scp_line(path: &Path) -> Option<String> {
    // ssh sets it to "CLIENT CLIENT_PORT SERVER SERVER_PORT".
    let connection = std::env::var("SSH_CONNECTION").ok()?;
    let user = std::env::var_os("USER").or_else(|| std::env::var_os("LOGNAME"));
    let port = connection.split(' ').nth(3).unwrap_or_default();
    let system = rustix::system::uname();
    let host = OsStr::from_bytes(system.nodename().to_bytes());
    let made = scp_line_from(port, &user.unwrap_or_default(), host, path.as_os_str());
    Some(made.unwrap_or_else(|what| {
        format!("no scp command: {what} contains characters that cannot be typed in a shell")
    }))
}

/// Returns the command. An empty `user` is omitted.
///
/// # Errors
/// Returns an error if a part of it cannot be typed: the name of that part.
fn scp_line_from(
    port: &str,
    user: &OsStr,
    host: &OsStr,
    path: &OsStr,
) -> Result<String, &'static str> {
    let option = match port.parse::<u16>() {
        Ok(22) | Err(_) => String::new(),
        Ok(port) => format!("-P {port} "),
    };
    let mut place = String::new();
    if !user.is_empty() {
        place += &format!("{}@", name(user).ok_or("the user's name")?);
    }
    place += name(host).ok_or("this machine's name")?;
    let path_text = path.to_str().filter(|text| printable(text) == *text);
    place += &format!(":{}", path_text.ok_or("its name")?);
    let quoted = shlex::try_quote(&place).map_err(|_| "its name")?;
    Ok(format!("scp {option}{quoted} ."))
}

/// Returns `text` if it is a name of a user or a machine that scp does not mistake for an option or a path.
fn name(text: &OsStr) -> Option<&str> {
    text.to_str().filter(|name| {
        !name.is_empty()
            && !name.starts_with('-')
            && name
                .chars()
                .all(|c| c.is_alphanumeric() || "._-@+%\\$".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns an export that does nothing until it is cancelled.
    fn waiting() -> Exporting {
        Exporting::spawn(PathBuf::from("run.csv"), 10, |shared| {
            while shared.reach(0).is_continue() {
                thread::yield_now();
            }
            Err("stopped".to_owned())
        })
        .unwrap()
    }

    fn wait(exporting: &Exporting) {
        let worker = exporting.worker.as_ref().unwrap();
        while !worker.is_finished() {
            thread::yield_now();
        }
    }

    #[test]
    fn only_exports_stopped_by_the_user_have_an_outcome() {
        let mut stopped = waiting();
        stopped.cancel();
        wait(&stopped);
        assert_eq!(stopped.outcome(), Some(Err("stopped".to_owned())));
        let mut suspended = waiting();
        suspended.shared.prepare_for(Release::Suspend);
        assert!(suspended.shared.reach(0).is_continue());
        let mut cut_off = waiting();
        cut_off.shared.prepare_for(Release::Exit);
        wait(&cut_off);
        assert_eq!((suspended.outcome(), cut_off.outcome()), (None, None));
    }

    fn line(port: &str, user: &str, host: &str, path: &str) -> Result<String, &'static str> {
        let [user, host, path] = [user, host, path].map(OsStr::new);
        scp_line_from(port, user, host, path)
    }

    #[test]
    fn an_scp_command_is_quoted_for_the_shell() {
        assert_eq!(
            line("22", "ada", "lab.example.org", "/home/ada/run-1.csv").unwrap(),
            "scp ada@lab.example.org:/home/ada/run-1.csv ."
        );
        for path in [
            "/tmp/Ada's run $1.csv",
            "/tmp/a\"b`c!d\\e;f&g|h<i>j(k)l*m?n[o]p{q}r~s#t.csv",
            "/tmp/速い.csv",
        ] {
            let line = line("2222", "", "lab", path).unwrap();
            let words = ["scp", "-P", "2222", &format!("lab:{path}"), "."];
            assert_eq!(shlex::split(&line).unwrap(), words, "{line}");
        }
    }

    #[test]
    fn unprintable_names_give_no_scp_command() {
        for (user, host, path) in [
            ("ada", "lab", "/tmp/a\u{1b}]0;x\u{7}.csv"),
            ("ada", "lab", "/tmp/a\nb.csv"),
            ("ada", "lab", "/tmp/a\u{200b}.csv"),
            ("a\u{1b}[2Jda", "lab", "/tmp/a.csv"),
            ("-oProxyCommand=sh", "lab", "/tmp/a.csv"),
            ("ada", "la\u{202e}b", "/tmp/a.csv"),
            ("ada", "", "/tmp/a.csv"),
        ] {
            line("22", user, host, path).unwrap_err();
        }
    }
}
