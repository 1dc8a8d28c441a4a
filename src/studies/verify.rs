//! Is a CSV what its header says? What it holds, a run, a sweep, a comparison or a fit, is computed again and held against
//! the file line by line; a figure is drawn again.

mod against;
mod unverified;

use crate::engine::analysis::compare::{self, ComparisonRow};
use crate::engine::analysis::{Monitor, cost};
use crate::engine::export::layout::{above_run_file, commented};
use crate::engine::export::stream::{self, Ended};
use crate::engine::export::{CsvLayout, CsvWriter};
use crate::engine::run::{Clock, Simulation};
use crate::engine::scenario::csv::{self, Csv};
use crate::engine::scenario::head::Head;
use crate::engine::scenario::rescale::MOST_RUN_STEPS_BY_TIME;
use crate::engine::scenario::{Document, Problem, Problems, Scenario};
use crate::physics::SchemeInfo;
use crate::studies::fit::report::Header;
use crate::studies::sweep::Sweep;
use crate::studies::sweep::in_order::in_order;
pub use against::{Against, FileDifference, first_difference};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
pub use unverified::{Unverified, other_version};

#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    pub rows: u64,
    /// The first thing that differs; `None` where all is the same.
    pub difference: Option<FileDifference>,
    /// What else there is to say, a line each: another version, where the run ends early, whether to believe it.
    pub notes: Vec<String>,
}

/// How the line of names begins in the CSV of a comparison.
const OF_COMPARISON: &[u8] = b"scheme,time_step_s,";
/// How the line of names ends in the CSV of a fit.
const FIT_COLUMNS_END: &[u8] = b",residual,residual_sigmas";
/// The columns of a comparison that hold times by the clock.
const BY_THE_CLOCK: [&str; 2] = ["ns_per_step", "wall_s"];
const OF_THE_CLOCK: &str =
    "a comparison: ns_per_step and wall_s are times by the clock, which nothing can compute again";
/// The most values of a table that is taken as a comparison.
const MOST_COMPARISON_VALUES: usize = 1_000_000;

/// Computes the file `path` again and compares. `fit` makes the fit of a command line again and gives its CSV. `watch` gets
/// the steps taken so far (of a sweep the rows) and their number in all, and says whether to go on.
pub fn verify(
    path: &Path,
    fit: impl FnOnce(&str) -> Result<Vec<u8>, Unverified>,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Verified, Unverified> {
    let mut file = BufReader::new(File::open(path)?);
    let head = Head::read(&mut file)?;
    let text = run_file(&head)?;
    let document = Document::parse_header(&path.display().to_string(), &text)?;
    let (mut against, mut notes) = (Against::new(&head, file), Vec::new());
    let mut verdict = None;
    if head.names().starts_with(OF_COMPARISON) {
        (against.keys, against.left_out) = (2, &BY_THE_CLOCK);
        against.write_all(&comparison(&document.scenario()?, path, watch)?)?;
        notes.push(OF_THE_CLOCK.to_owned());
    } else if head.names().ends_with(FIT_COLUMNS_END) {
        let header: Header = toml::from_str(&above_run_file(&text))
            .map_err(|error| format!("{} (in its header)", error.message()))?;
        against.write_all(&fit(&header.fit.command)?)?;
    } else if document.table().contains_key("vary") {
        play_sweep(&Sweep::open(&document)?, &mut against, watch, &mut notes)?;
    } else {
        let layout = CsvLayout::read(&text).map_err(|error| format!("{error} (in its header)"))?;
        let scenario = Arc::new(document.scenario()?);
        verdict = play_run(&scenario, layout, &mut against, watch, &mut notes)?;
    }
    let (rows, difference) = against.end()?;
    notes.extend(verdict);
    let version = document
        .table()
        .get("gyrolab")
        .and_then(toml::Value::as_str);
    notes.splice(0..0, version.and_then(other_version));
    Ok(Verified {
        rows,
        difference,
        notes,
    })
}

/// The run file in the head of a CSV that gyrolab wrote.
fn run_file(head: &Head) -> Result<String, Problems> {
    if head.is_of_csv() {
        return head
            .run_file()
            .map_err(|problem| Problems::one("", problem));
    }
    let bytes = head.bytes();
    let rule = if bytes.is_empty() {
        "is empty: there is nothing to verify"
    } else if bytes.starts_with(b"# ") && bytes.ends_with(b"\n") && head.names().is_empty() {
        "ends in its header: there are no rows to verify"
    } else {
        "is no CSV that gyrolab wrote: those begin with the run file in \"# \" lines, and name their columns below it (a write-up is verified by its folder)"
    };
    Err(Problems::one("", Problem::at("", rule)))
}

/// Plays `scenario`, and compares its rows. Gives the verdict on the run, where they are the same.
fn play_run(
    scenario: &Arc<Scenario>,
    layout: CsvLayout,
    against: &mut Against,
    watch: impl Fn(u64, u64) -> ControlFlow<()>,
    notes: &mut Vec<String>,
) -> Result<Option<String>, Unverified> {
    against.delimiter = if layout.file().excel { b';' } else { b',' };
    against.keys = 1;
    let difference = against.difference();
    let differs = || difference.get().is_some();
    let mut csv = CsvWriter::with_layout(against, scenario, layout)?;
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let monitor = RefCell::new(Monitor::new(simulation.now()));
    let go_on = |step, steps: u64| {
        let mut go_on = || watch(step, steps);
        monitor.borrow_mut().catch_up(&mut go_on)?;
        if differs() {
            return ControlFlow::Break(());
        }
        go_on()
    };
    let steps = scenario.steps;
    let (ended, _) = stream::play(
        &mut simulation,
        steps,
        Some(&mut csv),
        |step| monitor.borrow_mut().record_ahead(step),
        go_on,
    )?;
    if ended == Ended::Stopped && !differs() {
        return Err(Unverified::Stopped);
    }
    csv.finish()?;
    if let Ended::NotFinite(end) = ended {
        notes.push(format!("its run ends early: {end}"));
    }
    Ok((!differs()).then(|| monitor.into_inner().health(simulation.now()).sentence(None)))
}

/// Computes the rows of `sweep` on all cores, and compares them.
fn play_sweep(
    sweep: &Sweep,
    against: &mut Against,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
    notes: &mut Vec<String>,
) -> Result<(), Unverified> {
    against.keys = sweep.axes.len();
    against.write_all(sweep.header().as_bytes())?;
    let difference = against.difference();
    let differs = || difference.get().is_some();
    let (done, total) = (AtomicU64::new(0), sweep.rows());
    let (mut failures, mut written) = (0, Ok(()));
    in_order(
        0..if differs() { 0 } else { total },
        |row: u64, goes_on| {
            sweep.row(row, &|| {
                goes_on() && watch(done.load(Ordering::Relaxed), total).is_continue()
            })
        },
        |rows| {
            for row in rows {
                failures += u64::from(row.has_failed);
                written = against.write_all(row.line.as_bytes());
                if written.is_err() || differs() {
                    return ControlFlow::Break(());
                }
                done.fetch_add(1, Ordering::Relaxed);
            }
            ControlFlow::Continue(())
        },
    );
    written?;
    if !differs() && done.into_inner() < total {
        return Err(Unverified::Stopped);
    }
    if failures > 0 {
        notes.push(format!("runs that failed, and have empty rows: {failures}"));
    }
    Ok(())
}

/// Compares schemes and time steps again, those of the table in the file `path`, and gives the CSV.
fn comparison(
    scenario: &Scenario,
    path: &Path,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Vec<u8>, Unverified> {
    let cannot = |why: String| Unverified::from(format!("cannot be recomputed: {why}"));
    if !cost::is_affordable(scenario) {
        let why = "the exact motion of its run would take too long";
        return Err(cannot(why.to_owned()));
    }
    let text = csv::text(path).map_err(|problem| Problems::one("", problem))?;
    let table = Csv::parse(&text, MOST_COMPARISON_VALUES)?;
    let (mut schemes, mut time_steps) = (Vec::<&SchemeInfo>::new(), BTreeMap::new());
    for (line, row) in &table.rows {
        let scheme = SchemeInfo::find(&row[0]);
        let step = row[1].parse::<f64>().ok();
        let step = step.filter(|step| *step > 0.0 && step.is_finite());
        let (Some(scheme), Some(step)) = (scheme, step) else {
            return Err(cannot(format!("line {line} names no scheme and time step")));
        };
        if Clock::end_s(scenario) / step > MOST_RUN_STEPS_BY_TIME {
            let why = format!("line {line} has more time steps than can be counted");
            return Err(cannot(why));
        }
        if !schemes.iter().any(|known| known.name == scheme.name) {
            schemes.push(scheme);
        }
        time_steps.insert(step.to_bits(), step); // the bits of positive numbers are in their order
    }
    // From coarse to fine, as the order is measured.
    let time_steps: Vec<f64> = time_steps.into_values().rev().collect();
    let rows = compare::compare(scenario, &schemes, &time_steps, watch);
    Ok(csv_of_comparison(
        scenario,
        &rows.ok_or(Unverified::Stopped)?,
    )?)
}

/// The CSV of a comparison: its `rows` below the run file of `scenario`.
pub fn csv_of_comparison(scenario: &Scenario, rows: &[ComparisonRow]) -> io::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(commented(&scenario.to_toml()).into_bytes());
    for row in rows {
        writer.serialize(row).map_err(io::Error::other)?;
    }
    writer
        .into_inner()
        .map_err(::csv::IntoInnerError::into_error)
}
