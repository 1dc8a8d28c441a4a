//! `gyrolab compare`: compares schemes and time steps with the exact motion.

use super::args::{LengthArgs, ScenarioArgs, scenario_of};
use super::argument_values::positive;
use super::progress::{self, Interrupted};
use super::{one_on_stdout, print};
use crate::engine::analysis::compare::{ComparisonTable, compare as table_of};
use crate::engine::analysis::cost;
use crate::engine::analysis::predictability::predictability;
use crate::engine::run::{Clock, EnergyScale, Truth};
use crate::engine::scenario::Scenario;
use crate::engine::scenario::rescale::MOST_RUN_STEPS_BY_TIME;
use crate::engine::text::number::{short, shortest};
use crate::physics::{SchemeInfo, scheme};
use crate::studies::verify::csv_of_comparison;
use anyhow::bail;
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::collections::HashSet;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    #[command(flatten)]
    pub(super) scenario: ScenarioArgs,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    /// The schemes to compare [default: all that have an error]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(super) schemes: Vec<String>,

    /// The time steps, s [default: the scenario's time step, and 1/2, 1/4 and 1/8 of it]
    #[arg(long, value_name = "0.1,0.05", value_delimiter = ',', value_parser = positive)]
    pub(super) time_steps: Vec<f64>,

    /// Write the table as CSV to this file, or to stdout for -
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Print the table as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

pub(super) fn compare(args: &CompareArgs) -> anyhow::Result<ExitCode> {
    let on_stdout = one_on_stdout("compare", args.output.as_deref(), args.json);
    let scenario = scenario_of(&args.scenario, &args.length)?;
    if let Some(why) = cost::why_exact_unavailable(&scenario) {
        bail!(
            "{}: {why}: use a shorter --duration",
            args.scenario.scenario
        );
    }
    let schemes = chosen_schemes(args, &scenario)?;
    let time_steps = chosen_time_steps(args, &scenario)?;
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let rows =
        table_of(&scenario, &schemes, &time_steps, interruption.meter()).ok_or(Interrupted)?;
    if let Some(output) = output {
        interruption.keep(output, &csv_of_comparison(&scenario, &rows)?)?;
    }
    if on_stdout {
        return Ok(ExitCode::SUCCESS);
    }
    interruption.may_act_at_once()?;
    let duration_s = Clock::end_s(&scenario);
    let table = ComparisonTable {
        rows: &rows,
        energy_unit: EnergyScale::find(&scenario).map(|scale| scale.unit),
        predictability: predictability(&Arc::new(scenario.clone()), duration_s),
    };
    let truth = kind_of_truth(&scenario, duration_s);
    let title = scenario.file.title.as_str();
    if args.json {
        return print(&format!("{}\n", table.json(title, duration_s, &truth)?));
    }
    let duration = shortest(duration_s);
    print(&format!(
        "{title}, {duration} s, against the exact motion ({truth})\n\n{table}"
    ))
}

/// Returns the schemes named on the command line, or all that support the friction of `scenario`.
///
/// # Errors
/// Returns an error if a named scheme does not support the friction.
fn chosen_schemes(
    args: &CompareArgs,
    scenario: &Scenario,
) -> anyhow::Result<Vec<&'static SchemeInfo>> {
    let friction = &scenario.friction;
    let mut seen = HashSet::new(); // a scheme named twice is compared once
    let chosen: Vec<_> = args
        .schemes
        .iter()
        .chain(&args.scenario.changes.scheme)
        .filter(|name| seen.insert(name.as_str()))
        .filter_map(|name| SchemeInfo::find(name))
        .collect();
    let able = scheme::true_to(*friction).filter(|scheme| scheme.order.is_some());
    if chosen.is_empty() {
        return Ok(able.collect());
    }
    let unable = chosen
        .iter()
        .find_map(|scheme| Some((scheme.name, scheme.admits.why_not(friction)?)));
    if let Some((name, why)) = unable {
        let names: Vec<_> = able.map(|scheme| scheme.name).collect();
        bail!(
            "{}: --schemes {name} does not support this friction: it {why}; use one of {}",
            args.scenario.scenario,
            names.join(", ")
        );
    }
    Ok(chosen)
}

/// Returns the time steps to compare, s, longest first.
///
/// # Errors
/// Returns an error if a time step is so short that the run would have too many steps to count.
fn chosen_time_steps(args: &CompareArgs, scenario: &Scenario) -> anyhow::Result<Vec<f64>> {
    let mut steps = args.time_steps.clone();
    if steps.is_empty() {
        steps = [1.0, 2.0, 4.0, 8.0]
            .map(|part| scenario.motion.time_step_s / part)
            .to_vec();
    }
    // The order is measured from long to short time steps.
    steps.sort_by(|a, b| b.total_cmp(a));
    steps.dedup();
    let duration = Clock::end_s(scenario);
    if let Some(&step) = steps
        .iter()
        .find(|&&step| duration / step > MOST_RUN_STEPS_BY_TIME)
    {
        bail!(
            "{}: --time-steps {} needs {} steps for {} s, but at most {MOST_RUN_STEPS_BY_TIME:e} are possible: use longer time steps, or a shorter --duration",
            args.scenario.scenario,
            shortest(step),
            short(duration / step),
            shortest(duration)
        );
    }
    Ok(steps)
}

/// Describes how the exact motion of `scenario` is computed.
fn kind_of_truth(scenario: &Scenario, duration_s: f64) -> String {
    let mut truth = Truth::new(Arc::new(scenario.clone()));
    truth.state_at(duration_s);
    truth.kind().to_string()
}
