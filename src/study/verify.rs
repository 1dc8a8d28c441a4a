//! Is a CSV what its header says? The run, or the table of errors, in the header is computed again and held against the
//! file line by line, so that memory does not grow with it.

mod comparison;
mod lines;
mod of_sweep;
mod row;

use crate::analysis::Monitor;
use crate::export::layout::LayoutError;
use crate::export::stream::{self, Ended};
use crate::export::{CsvWriter, Layout};
use crate::run::{NotFinite, Simulation, Step};
use crate::scenario::head::Head;
use crate::scenario::{Document, Problem, Problems, Scenario};
use crate::study::sweep::Sweep;
use crate::text::printable::printable;
use crate::text::unread;
pub use lines::{Difference, What};
use lines::{Held, Lines};
pub use row::Field;
use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// What has come out for one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    /// What the file is.
    pub kind: Kind,
    /// Rows that are the same, up to the first that differs.
    pub rows: u64,
    /// The first thing that differs; `None` where all is the same.
    pub difference: Option<Difference>,
    /// The version that wrote the file, where it is not this one.
    pub written_by: Option<String>,
    /// Whether to believe the run, in one sentence; empty for a table of runs.
    pub verdict: String,
    /// Where the run's numbers stop being finite, if they do.
    pub not_finite: Option<NotFinite>,
}

/// What a CSV is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The rows of a run.
    Run,
    /// The errors of schemes and time steps, by `gyrolab compare -o`.
    Comparison,
    /// The readouts of many runs, by `gyrolab sweep -o`.
    Sweep {
        /// How many of them failed, and have empty rows.
        failures: u64,
    },
}

/// Why a file was not verified.
#[derive(Debug, thiserror::Error)]
pub enum Unverified {
    /// It is no CSV of gyrolab's, or what its header holds cannot be run.
    #[error("{0}")]
    Refused(Problems),
    /// It ended before it was done, as the watcher wanted.
    #[error("stopped")]
    Stopped,
}

/// Holds the file `path` against what its header says. `watch` is told the steps taken so far, of how many, and says
/// whether to go on.
///
/// # Errors
/// When the file cannot be recomputed, and why; or when `watch` said no.
pub fn verify(
    path: &Path,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Verified, Unverified> {
    let origin = path.display().to_string();
    let refused = |problem| Unverified::Refused(Problems::one(origin.as_str(), problem));
    let cannot_read = |error: io::Error| refused(whole(unread::why(&error)));
    if path.is_dir() {
        return Err(refused(whole("is a folder: name a CSV in it".to_owned())));
    }
    let mut file = BufReader::new(File::open(path).map_err(cannot_read)?);
    let head = Head::read(&mut file).map_err(cannot_read)?;
    let text = run_file(&head).map_err(refused)?;
    let lines = Lines::new(io::Cursor::new(head.bytes().to_vec()).chain(file));
    let document = Document::parse(&origin, &text).map_err(Unverified::Refused)?;
    let version = document.table().get("gyrolab");
    let version = version.and_then(|version| version.as_str().map(str::to_owned));
    let verified = match head.names() {
        names if names.starts_with(comparison::FIRST_COLUMNS) => {
            let scenario = document.scenario().map_err(Unverified::Refused)?;
            comparison::verify(&scenario, lines, watch).map_err(|stopped| match stopped {
                Some(problem) => refused(problem),
                None => Unverified::Stopped,
            })?
        }
        names if names.ends_with(FIT_COLUMNS) => {
            let rule = "is the CSV of a fit, which is not computed again: its data stand in another file. The line command at its top makes the fit again: give it -o again.csv, and compare the two files";
            return Err(refused(whole(rule.to_owned())));
        }
        _ if document.table().contains_key("vary") => {
            let sweep = Sweep::open(&document).map_err(Unverified::Refused)?;
            let verified = of_sweep::verify(&sweep, &head, lines, watch);
            verified.map_err(cannot_read)?.ok_or(Unverified::Stopped)?
        }
        _ => {
            let layout = Layout::read(&text).map_err(|error| refused(of_layout(&error)))?;
            let scenario = document.scenario().map_err(Unverified::Refused)?;
            let verified = verify_run(&Arc::new(scenario), layout, lines, watch);
            verified.map_err(cannot_read)?.ok_or(Unverified::Stopped)?
        }
    };
    let written_by = version.filter(|version| version != env!("CARGO_PKG_VERSION"));
    Ok(Verified {
        written_by: written_by.map(|version| printable(&version).into_owned()),
        ..verified
    })
}

/// A run with more steps left than this is not played on for its verdict alone, once a difference has been found.
const MOST_FOR_VERDICT: u64 = 2_000_000;

/// The last columns of the CSV of a fit.
const FIT_COLUMNS: &[u8] = b",residual,residual_sigmas";

fn whole(rule: String) -> Problem {
    Problem::at("", rule)
}

fn of_layout(error: &LayoutError) -> Problem {
    whole(format!("{error} (in its header)"))
}

/// The run file in the head of a CSV that gyrolab wrote.
fn run_file(head: &Head) -> Result<String, Problem> {
    if head.bytes().is_empty() {
        return Err(whole("is empty: there is nothing to verify".to_owned()));
    }
    if head.is_of_csv() {
        return head.run_file();
    }
    let is_cut = head.bytes().ends_with(b"\n") && head.names().is_empty();
    let rule = match is_cut && head.bytes().starts_with(b"# ") {
        true => "ends in its header: there are no rows to verify",
        false => {
            "is no CSV that gyrolab wrote: those begin with the run file in \"# \" lines, and name their columns below it"
        }
    };
    Err(whole(rule.to_owned()))
}

/// Holds the rows of `scenario` against `lines`; `None` where `watch` stopped it.
///
/// # Errors
/// When the file cannot be read.
fn verify_run<R: Read>(
    scenario: &Arc<Scenario>,
    layout: Layout,
    lines: Lines<R>,
    watch: impl Fn(u64, u64) -> ControlFlow<()>,
) -> io::Result<Option<Verified>> {
    let held = Held::new(lines, layout.delimiter());
    let (differs, given_up) = (held.differs(), Cell::new(None));
    let mut csv = CsvWriter::with_layout(held, scenario, layout)?;
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let monitor = RefCell::new(Monitor::new(simulation.now()));
    let each = |step: &Step| monitor.borrow_mut().follow_ahead(step);
    let (ended, _) = stream::play(
        &mut simulation,
        scenario.steps,
        Some(&mut csv),
        each,
        |progress| {
            monitor.borrow_mut().catch_up();
            watch(progress.step, progress.steps)?;
            let left = progress.steps.saturating_sub(progress.step);
            if differs.get() && left > MOST_FOR_VERDICT {
                given_up.set(Some(left));
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        },
    )?;
    if ended == Ended::Stopped && given_up.get().is_none() {
        return Ok(None);
    }
    let (rows, difference) = csv.finish()?.end()?;
    let verdict = match given_up.get() {
        None => monitor.into_inner().health(simulation.now()).sentence(None),
        Some(left) => format!("not judged: {left} of its steps were left to compute"),
    };
    Ok(Some(Verified {
        kind: Kind::Run,
        rows,
        difference,
        written_by: None,
        verdict,
        not_finite: match ended {
            Ended::NotFinite(error) => Some(error),
            Ended::Done | Ended::Stopped => None,
        },
    }))
}
