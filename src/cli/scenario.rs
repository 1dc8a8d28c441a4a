//! The scenario that the command line means.

use super::args::{Changes, LengthArgs, ScenarioArgs};
use crate::run::Simulation;
use crate::scenario::rescale::MOST_STEPS;
use crate::scenario::{Document, Problem, Problems, Scenario};

/// The scenario with all that the command line changes in it, so that its run file tells the whole run.
pub(super) fn scenario_of(args: &ScenarioArgs, length: &LengthArgs) -> Result<Scenario, Problems> {
    let mut document = Document::open(&args.scenario)?;
    change(&mut document, &args.changes)?;
    if let Some(steps) = length.steps {
        document.set(&format!("motion.steps={steps}"))?;
    }
    let scenario = document.scenario()?;
    let Some(duration) = length.duration else {
        return Ok(scenario);
    };
    if duration / scenario.motion.time_step_s > MOST_STEPS {
        let rule = format!("{duration:e} s are more than {MOST_STEPS:e} time steps");
        let problem = Problem::at("--duration", rule);
        return Err(Problems::one(args.scenario.clone(), problem));
    }
    let steps = Simulation::step_at(&scenario, duration).max(1);
    document.set(&format!("motion.steps={steps}"))?;
    document.scenario()
}

/// Changes in `document` what the command line changes.
pub(super) fn change(document: &mut Document, changes: &Changes) -> Result<(), Problems> {
    for set in &changes.set {
        document.set(set)?;
    }
    if let Some(scheme) = &changes.scheme {
        document.set(&format!("motion.scheme={scheme}"))?;
    }
    if let Some(time_step_s) = changes.time_step {
        document.set_time_step(time_step_s)?;
    }
    Ok(())
}
