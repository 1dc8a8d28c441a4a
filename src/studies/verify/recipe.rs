//! The recipe of a CSV: the data that its rows are computed from, and the computation.

use super::{FileComparison, Unverified};
use crate::engine::analysis::compare::{self, ComparisonRow};
use crate::engine::analysis::cost;
use crate::engine::export::layout::{above_run_file, commented};
use crate::engine::export::stream::Ended;
use crate::engine::export::{CsvLayout, CsvWriter, PlayedRun};
use crate::engine::physics::SchemeInfo;
use crate::engine::run::Clock;
use crate::engine::scenario::csv::{self, Csv};
use crate::engine::scenario::head::Head;
use crate::engine::scenario::rescale::MOST_RUN_STEPS_BY_TIME;
use crate::engine::scenario::{Document, Problems, Scenario};
use crate::studies::fit::report::Header;
use crate::studies::sweep::Sweep;
use crate::studies::sweep::in_order::in_order;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Start of the line of column names in the CSV of a comparison.
const COMPARISON_COLUMNS_START: &[u8] = b"scheme,time_step_s,";
/// End of the line of column names in the CSV of a fit.
const FIT_COLUMNS_END: &[u8] = b",residual,residual_sigmas";
/// Columns of a comparison that hold measured computing times.
const CLOCK_COLUMNS: [&str; 2] = ["ns_per_step", "wall_s"];
const CLOCK_NOTE: &str =
    "a comparison: ns_per_step and wall_s are measured computing times and cannot be verified";
/// Maximum number of values in the table of a comparison.
const MOST_COMPARISON_VALUES: usize = 1_000_000;

/// The input of a CSV's computation, from its header and, for a comparison, its rows.
pub(super) enum CsvRecipe {
    Run {
        scenario: Arc<Scenario>,
        layout: CsvLayout,
    },
    Sweep(Box<Sweep>),
    Comparison {
        scenario: Arc<Scenario>,
        schemes: Vec<&'static SchemeInfo>,
        /// In descending order, s.
        time_steps_s: Vec<f64>,
    },
    Fit {
        command: String,
    },
}

impl CsvRecipe {
    /// Reads the recipe of the CSV `path` with this `head`. `document` is the run file or sweep file in its `header`.
    pub fn read(
        path: &Path,
        head: &Head,
        header: &str,
        document: &Document,
    ) -> Result<Self, Unverified> {
        if head.names().starts_with(COMPARISON_COLUMNS_START) {
            return Self::of_comparison(path, document.scenario()?);
        }
        if head.names().ends_with(FIT_COLUMNS_END) {
            let header: Header = toml::from_str(&above_run_file(header))
                .map_err(|error| format!("{} (in its header)", error.message()))?;
            let command = header.fit.command;
            return Ok(Self::Fit { command });
        }
        if document.table().contains_key("vary") {
            return Ok(Self::Sweep(Box::new(Sweep::open(document)?)));
        }
        Ok(Self::Run {
            layout: CsvLayout::read(header).map_err(|error| format!("{error} (in its header)"))?,
            scenario: Arc::new(document.scenario()?),
        })
    }

    /// Returns the recipe of a comparison, with the schemes and time steps in the table of the file `path`.
    fn of_comparison(path: &Path, scenario: Scenario) -> Result<Self, Unverified> {
        if !cost::is_affordable(&scenario) {
            return Err(cannot("the exact motion of its run would take too long"));
        }
        let text = csv::text(path).map_err(|problem| Problems::one("", problem))?;
        let table = Csv::parse(&text, MOST_COMPARISON_VALUES)?;
        let (mut schemes, mut time_steps) = (Vec::<&SchemeInfo>::new(), BTreeMap::new());
        for (line, row) in &table.rows {
            let time_step = row[1].parse::<f64>().ok();
            let (Some(scheme), Some(step)) = (
                SchemeInfo::find(&row[0]),
                time_step.filter(|step| *step > 0.0 && step.is_finite()),
            ) else {
                return Err(cannot(&format!(
                    "line {line} does not name a scheme and a time step"
                )));
            };
            if Clock::end_s(&scenario) / step > MOST_RUN_STEPS_BY_TIME {
                let why = format!("line {line} needs more time steps than can be counted");
                return Err(cannot(&why));
            }
            if !schemes.iter().any(|known| known.name == scheme.name) {
                schemes.push(scheme);
            }
            time_steps.insert(step.to_bits(), step); // the bits of positive numbers sort like the numbers
        }
        Ok(Self::Comparison {
            scenario: Arc::new(scenario),
            schemes,
            time_steps_s: time_steps.into_values().rev().collect(),
        })
    }

    /// Tells `comparison` the delimiter, the key columns and the ignored columns of this CSV.
    pub fn describe_columns(&self, comparison: &mut FileComparison) {
        match self {
            Self::Run { layout, .. } => {
                comparison.keys = 1;
                comparison.delimiter = layout.delimiter();
            }
            Self::Sweep(sweep) => comparison.keys = sweep.keys().count(),
            Self::Comparison { .. } => {
                comparison.keys = 2;
                comparison.left_out = &CLOCK_COLUMNS;
            }
            Self::Fit { .. } => {}
        }
    }

    /// Computes the CSV and writes it to `out`. Adds remarks to `notes`. `fit` and `watch` are the arguments of
    /// [`verify`](super::verify).
    pub fn recompute(
        &self,
        mut out: impl Write,
        notes: &mut Vec<String>,
        fit: impl FnOnce(&str) -> Result<Vec<u8>, Unverified>,
        watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
    ) -> Result<(), Unverified> {
        match self {
            Self::Run { scenario, layout } => {
                let mut csv = CsvWriter::with_layout(out, scenario, layout.clone())?;
                let mut played = PlayedRun::play(scenario, Some(&mut csv), |_| {}, watch)?;
                if played.ended == Ended::Stopped {
                    return Err(Unverified::Stopped);
                }
                csv.finish()?;
                if let Ended::NotFinite(end) = played.ended {
                    notes.push(format!("its run ends early: {end}"));
                }
                notes.push(played.health().sentence(None));
            }
            Self::Sweep(sweep) => {
                out.write_all(sweep.header().as_bytes())?;
                let failures = write_rows(sweep, out, watch)?;
                if failures > 0 {
                    notes.push(format!("failed runs, with empty rows: {failures}"));
                }
            }
            Self::Comparison {
                scenario,
                schemes,
                time_steps_s,
            } => {
                notes.push(CLOCK_NOTE.to_owned());
                let rows = compare::compare(scenario, schemes, time_steps_s, watch)
                    .ok_or(Unverified::Stopped)?;
                out.write_all(&csv_of_comparison(scenario, &rows)?)?;
            }
            Self::Fit { command } => out.write_all(&fit(command)?)?,
        }
        Ok(())
    }
}

/// Computes the rows of `sweep` on all cores, writes them to `out`, and returns the number of failed runs.
pub fn write_rows(
    sweep: &Sweep,
    mut out: impl Write,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<u64, Unverified> {
    let (done, total) = (AtomicU64::new(0), sweep.rows());
    let (mut failures, mut written) = (0, Ok(()));
    in_order(
        0..total,
        |row, goes_on: &dyn Fn() -> bool| {
            sweep.row(row, &|| {
                goes_on() && watch(done.load(Ordering::Relaxed), total).is_continue()
            })
        },
        |rows| {
            for row in rows {
                failures += u64::from(row.has_failed);
                written = out.write_all(row.line.as_bytes());
                if written.is_err() {
                    return ControlFlow::Break(());
                }
                done.fetch_add(1, Ordering::Relaxed);
            }
            ControlFlow::Continue(())
        },
    );
    written?;
    if done.into_inner() < total {
        return Err(Unverified::Stopped);
    }
    Ok(failures)
}

fn cannot(why: &str) -> Unverified {
    format!("cannot be recomputed: {why}").into()
}

/// Returns the CSV of a comparison: its `rows` below the run file of `scenario`.
pub fn csv_of_comparison(scenario: &Scenario, rows: &[ComparisonRow]) -> io::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(commented(&scenario.to_toml()).into_bytes());
    for row in rows {
        writer.serialize(row).map_err(io::Error::other)?;
    }
    writer
        .into_inner()
        .map_err(::csv::IntoInnerError::into_error)
}
