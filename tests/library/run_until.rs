//! `run_until`: the numbers allowed in a condition, and the step at which the run stops.

use crate::support::desk::{Desk, commands};
use crate::support::scenarios::preset;
use gyrolab::engine::analysis::readouts::{READOUTS, ReadoutValue};
use gyrolab::engine::export::columns::CsvColumn;
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::lab::command;
use gyrolab::lab::playback::live::LiveRun;
use std::sync::Arc;

/// Plays `name` until `condition` in a lab without a clock.
fn played(name: &str, condition: &str) -> (Desk, Result<(), String>) {
    let mut desk = Desk::open(name);
    let text = format!("[[do]]\nrun_until = \"{condition}\"");
    let document = Document::parse("demo.toml", &text).unwrap();
    desk.lab.take_commands(command::read(&document).unwrap());
    let end = desk
        .lab
        .finish_script_while(|_, _| std::ops::ControlFlow::Continue(()));
    (desk, end)
}

/// Returns the error message for a command file with this condition.
fn refusal(condition: &str) -> String {
    let text = format!("[[do]]\nrun_until = \"{condition}\"");
    let document = Document::parse("demo.toml", &text).unwrap();
    command::read(&document).unwrap_err().to_string()
}

#[test]
fn run_until_stops_at_the_first_row_above_a_limit() {
    let (desk, end) = played("wobble-push", "measured_highest_tilt_deg > 50");
    assert_eq!(end, Ok(()));
    let tilt = CsvColumn::find("tilt_deg").unwrap();
    let mut run = Simulation::new(Arc::new(preset("wobble-push", &[])));
    let mut highest = f64::NEG_INFINITY;
    let first = loop {
        highest = highest.max(tilt.value(run.scenario(), &run.sample()));
        if highest > 50.0 {
            break run.step_number();
        }
        run.step().unwrap();
    };
    assert!(first > 1, "{first}");
    assert_eq!(desk.step(), first);
}

#[test]
fn conditions_may_use_theory_the_exact_motion_and_measurements() {
    for (name, condition) in [
        ("wobble-push", "distance_m > 0.05"),
        ("cusps", "measured_nutation_period_s > 0"),
        (
            "cusps",
            "abs(measured_nutation_period_s / predicted_nutation_period_s - 1) < 0.01",
        ),
        ("cusps", "tilt_deg > predicted_highest_tilt_deg - 0.01"),
        ("method-2", "L_axle_Js < 999.9 or steps >= 50"),
        (
            "method-2",
            "steps == 7 and time_step_s == motion.time_step_s",
        ),
    ] {
        let (mut desk, end) = played(name, condition);
        assert_eq!(end, Ok(()), "{condition}");
        let holds = |now: &Desk| {
            let readouts = &now.lab.player().reading.readouts;
            let expression =
                gyrolab::engine::journal::expression::Expression::parse(condition).unwrap();
            let motion = now.lab.player().motion();
            expression.value(|word| match word {
                "motion.time_step_s" => Some(motion.time_step_s),
                _ => readouts.number(word),
            }) == Some(1.0)
        };
        assert!(desk.step() > 0 && holds(&desk), "{condition}");
        let step = desk.step();
        desk.carry_out(&commands("step = -1").remove(0)).unwrap();
        assert_eq!(desk.step(), step - 1);
        assert!(!holds(&desk), "{condition} holds a step before");
    }
}

#[test]
fn a_name_without_a_number_is_rejected_with_the_nearest_name() {
    for (condition, told) in [
        (
            "distance > 1",
            "column 1: there is no number named distance: did you mean distance_m?",
        ),
        (
            "t_s > 1 and lowest_tilt_deg < 3",
            "column 13: there is no number named lowest_tilt_deg: did you mean measured_lowest_tilt_deg or predicted_lowest_tilt_deg?",
        ),
        ("health == 1", "column 1: health is a text"),
        (
            "motion.scheme == 1",
            "column 1: there is no number named motion.scheme: that key holds no number",
        ),
        ("wall_s > 3", "column 1: wall_s is not available in the lab"),
        ("motion.time_step > 1", "did you mean motion.time_step_s?"),
    ] {
        let refusal = refusal(condition);
        assert!(refusal.contains(told), "{condition}: {refusal}");
    }
}

#[test]
fn a_readout_read_alone_equals_the_one_read_with_all() {
    for (name, steps) in [("wobble-push", 300), ("cusps", 500), ("method-2", 120)] {
        let mut run = LiveRun::new(Arc::new(preset(name, &[])));
        let first = run.readouts();
        for step in 0..steps {
            run.step().unwrap();
            if step % 7 > 0 {
                continue;
            }
            let whole = run.readouts();
            for readout in READOUTS {
                let is_text = matches!(readout.read_from(&whole), ReadoutValue::Text(_));
                assert!(readout.is_text || !is_text, "{}", readout.name);
                let mut again = first.clone();
                run.read_again(&mut again, readout.source);
                let (again, whole) = (readout.read_from(&again), readout.read_from(&whole));
                assert!(
                    readout.is_text || again == whole,
                    "{name}: {}",
                    readout.name
                );
            }
        }
    }
}
