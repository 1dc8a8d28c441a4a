//! The table of readouts: names, values, and that no text of the program shows NaN or infinity.

use crate::support::desk::Desk;
use crate::support::dice::Dice;
use crate::support::scenarios::preset;
use crate::support::words::{has, has_no};
use gyrolab::engine::analysis::Predictability;
use gyrolab::engine::analysis::compare::{ComparisonTable, compare};
use gyrolab::engine::analysis::readouts::{READOUTS, ReadoutValue, find, names, nearest};
use gyrolab::engine::analysis::theory::TheoryAxis;
use gyrolab::engine::analysis::verdict::Verdict;
use gyrolab::engine::analysis::{Monitor, Readouts};
use gyrolab::engine::export::{COLUMNS, RunSummary};
use gyrolab::engine::run::{EnergyScale, EnergyUnit, Simulation};
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::scheme::{SCHEMES, true_to};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// Returns the readouts at the end of the run, and all its rows.
fn played(scenario: &Scenario) -> (Readouts, Vec<gyrolab::engine::run::Sample>) {
    let scenario = Arc::new(scenario.clone());
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    let mut rows = vec![simulation.sample()];
    while simulation.step_number() < scenario.steps && simulation.step().is_ok() {
        monitor.record(simulation.now());
        rows.push(simulation.sample());
    }
    let health = monitor.health(simulation.now());
    let readouts = Readouts::new(&simulation, &mut monitor, &health, None);
    (readouts, rows)
}

fn readouts(scenario: &Scenario) -> Readouts {
    played(scenario).0
}

fn summary(readouts: Readouts) -> RunSummary {
    RunSummary::new(readouts, Duration::from_secs(1))
}

fn json(readouts: &Readouts) -> serde_json::Value {
    serde_json::to_value(readouts).unwrap()
}

#[test]
fn names_of_readouts_are_unique_and_end_with_their_units() {
    let unique: BTreeSet<_> = names().collect();
    assert_eq!(unique.len(), READOUTS.len());
    for readout in READOUTS {
        let ending = match readout.unit {
            "" => "",
            "J s" => "_Js",
            "rad/s" => "_rad_per_s",
            "1/s" => "_per_second",
            unit => &format!("_{unit}"),
        };
        assert!(
            readout.name.ends_with(ending),
            "{} does not end with {ending}: a unit of another ending has its arm in tests/library/readouts.rs",
            readout.name
        );
        assert!(readout.meaning.len() > 3, "{}", readout.name);
    }
    assert_eq!(nearest("tilt"), "did you mean tilt_deg?");
    assert_eq!(
        nearest("lowest_tilt_deg"),
        "did you mean measured_lowest_tilt_deg or predicted_lowest_tilt_deg?"
    );
    assert!(find("lowest_tilt_deg").is_none());
}

#[test]
fn csv_columns_equal_the_readouts_of_the_same_name() {
    let scenario = preset("wobble-push", &[]);
    let (readouts, rows) = played(&scenario);
    let last = rows.last().unwrap();
    for column in COLUMNS.iter().filter(|column| column.name != "step") {
        let number = readouts.number(column.name);
        assert_eq!(
            number,
            Some(column.value(&scenario, last)),
            "{}",
            column.name
        );
    }
    assert_eq!(readouts.number("steps"), Some(2300.0));
    assert_eq!(readouts.number("title"), None);
    let object = json(&readouts);
    for readout in READOUTS {
        match readout.read_from(&readouts) {
            ReadoutValue::Nothing => {
                assert!(object[readout.name].is_null(), "{}: {object}", readout.name);
            }
            value => assert_eq!(object[readout.name], serde_json::to_value(value).unwrap()),
        }
    }
}

/// Returns the minimum and maximum of one number over the rows.
fn extremes(
    rows: &[gyrolab::engine::run::Sample],
    of: fn(&gyrolab::engine::run::Sample) -> f64,
) -> [f64; 2] {
    let numbers = || rows.iter().map(of);
    let least = numbers().fold(f64::INFINITY, f64::min);
    [least, numbers().fold(f64::NEG_INFINITY, f64::max)]
}

const EXTREMES: [&str; 4] = [
    "measured_lowest_tilt_deg",
    "measured_highest_tilt_deg",
    "measured_lowest_z_m",
    "measured_highest_z_m",
];

fn expected_extremes(rows: &[gyrolab::engine::run::Sample]) -> [f64; 4] {
    let tilt = extremes(rows, |row| row.tilt_deg);
    let z = extremes(rows, |row| row.position.z);
    [tilt[0], tilt[1], z[0], z[1]]
}

#[test]
fn extremes_equal_those_of_the_columns() {
    for preset in PRESETS {
        let friction = self::preset(preset.name, &[]).friction;
        for scheme in true_to(friction) {
            let scheme = format!("motion.scheme={}", scheme.name);
            let mut scenario = self::preset(preset.name, &[&scheme]);
            scenario.steps = scenario.steps.min(3000);
            let (readouts, rows) = played(&scenario);
            let told = EXTREMES.map(|name| readouts.number(name).unwrap());
            assert_eq!(told, expected_extremes(&rows), "{}, {scheme}", preset.name);
        }
    }
    // Near the vertical and the horizontal, where the cosine or sine of the tilt is insensitive.
    let mut dice = Dice(0x9E37_79B9_7F4A_7C15);
    for _ in 0..100 {
        let tilt = dice.pick(&[0.0, 90.0, 180.0]) + dice.pick(&[0.0, 1e-9, 1e-5, -1e-7]);
        let tilt = format!("start.tilt_deg={}", f64::abs(tilt));
        let aside = dice.pick(&[0.0, 1e-12, 1e-6]);
        let aside = format!("start.momentum_Js=[{aside},0,60]");
        let set = [&tilt, &aside, "motion.steps=300"];
        let (readouts, rows) = played(&preset("sleeping", &set));
        let told = EXTREMES.map(|name| readouts.number(name).unwrap());
        assert_eq!(told, expected_extremes(&rows), "{set:?}");
    }
}

#[test]
fn extremes_are_right_after_seeking_back_and_forth() {
    let scenario = preset("method-2", &[]);
    let (_, rows) = played(&scenario);
    let mut desk = Desk::with("method-2", scenario);
    for step in [2000_u64, 3, 700, 0, 1500, 1499, 256, 2300, 10] {
        desk.press(&[Key::Char('r')]);
        desk.type_text(&format!("{step}g"));
        desk.wait(2);
        let readouts = &desk.lab.player().reading.readouts;
        assert_eq!(readouts.sample.step, step);
        let told = EXTREMES.map(|name| readouts.number(name).unwrap());
        let known = expected_extremes(&rows[..=step as usize]);
        assert_eq!(told, known, "at step {step}");
    }
}

/// Readouts of theory that refer to an axis.
const ABOUT_THE_AXIS: &[&str] = &[
    "path",
    "predicted_lowest_tilt_deg",
    "predicted_highest_tilt_deg",
    "predicted_precession_rad_per_s",
    "predicted_nutation_period_s",
    "slow_precession_rad_per_s",
    "cusp_tilt_deg",
    "sleeping_limit_Js",
];

#[test]
fn theory_states_its_axis() {
    let upright = readouts(&preset("cusps", &[]));
    assert_eq!(json(&upright)["theory_axis"], "+z");
    assert!((upright.number("predicted_lowest_tilt_deg").unwrap() - 30.0).abs() < 1e-9);
    let text = summary(upright).in_full(true).to_string();
    assert!(text.contains("tilt 30.0000 to 36.6891 degrees\n"), "{text}");

    let free = readouts(&preset("cusps", &["motion.gravity_m_per_s2=0"]));
    let sideways = "push.0={point='top',force_N=[10,0,0],from_s=0,for_s=1000}";
    let pushed = readouts(&preset("cusps", &[sideways]));
    for (readouts, axis, words) in [
        (&free, "L", "degrees from L\n"),
        (
            &pushed,
            "the forces' vertical (-0.293, 0.000, 0.956)",
            "degrees from the forces' vertical (-0.293, 0.000, 0.956)\n",
        ),
    ] {
        let object = json(readouts);
        assert_eq!(object["theory_axis"], axis);
        for name in ABOUT_THE_AXIS {
            assert!(object[*name].is_null(), "{axis}: {name}: {object}");
        }
        let in_full = summary(readouts.clone()).in_full(true).to_string();
        assert!(in_full.contains(words), "{in_full}");
        assert!(in_full.contains("in this run about +z"), "{in_full}");
        assert!(!in_full.contains("to 0.0000 degrees\n"), "{in_full}");
    }
    // Without gravity, but with L along +z, the axle circles +z.
    let torque_free = readouts(&preset("torque-free", &[]));
    assert_eq!(torque_free.theory.unwrap().axis, TheoryAxis::Z);
    assert!(
        (torque_free
            .number("predicted_precession_rad_per_s")
            .unwrap()
            - 60.0 / 6.6)
            .abs()
            < 1e-9
    );
}

const FREE: &str = "motion.gravity_m_per_s2=0";

#[test]
fn an_under_sampled_nutation_is_reported_with_and_without_theory() {
    let resolved = |scenario: &Scenario| json(&readouts(scenario))["nutation_is_resolved"].clone();
    let lopsided = |spin: &str, step: &str| {
        let spin = format!("start.momentum_Js=[0,0,{spin}]");
        let step = format!("motion.time_step_s={step}");
        let mut set = vec!["body.point.2.at_m=[0.3,0,0]", "body.point.2.mass_kg=0.5"];
        set.extend([spin.as_str(), step.as_str(), "motion.steps=200"]);
        preset("cusps", &set)
    };
    let strobed = lopsided("1000", "0.1");
    assert_eq!(resolved(&strobed), false);
    let text = summary(readouts(&strobed)).to_string();
    let words = " in this run: under-sampled, the steps are too far apart to see it";
    has(&text, words);
    assert!(resolved(&lopsided("60", "0.001")).is_null());
    for scheme in SCHEMES {
        let scheme = format!("motion.scheme={}", scheme.name);
        let free = |step: &str| {
            let step = format!("motion.time_step_s={step}");
            preset("cusps", &[FREE, &step, &scheme, "motion.steps=20"])
        };
        assert_eq!(resolved(&free("1")), false, "{scheme}");
        // The axle circles L at 60/6.6 rad/s, faster or slower than the body turns.
        assert_eq!(resolved(&free("0.36")), false, "{scheme}");
        assert!(resolved(&free("0.001")).is_null(), "{scheme}");
        // The axle of a flat body circles L faster than the body turns: 3.6 rad per step, and 2.7.
        let flat = [
            FREE,
            "body.rim.height_m=0.3",
            "start.momentum_Js=[10,0,59]",
            "start.momentum_frame=world",
            "motion.time_step_s=0.125",
            "motion.steps=20",
            &scheme,
        ];
        assert_eq!(resolved(&preset("cusps", &flat)), false, "{scheme}");
        let method_2 = preset("method-2", &[&scheme, "motion.steps=200"]);
        assert_eq!(resolved(&method_2), false, "{scheme}");
    }
    assert_eq!(resolved(&preset("cusps", &[])), true);
}

#[test]
fn the_drift_of_a_balanced_body_is_relative_to_kinetic_energy() {
    let balanced = |height: &str, momentum: &str| {
        let height = format!("body.rim.height_m={height}");
        let momentum = format!("start.momentum_Js={momentum}");
        let motion = ["motion.time_step_s=0.01", "motion.steps=1000"];
        preset("cusps", &[&[&*height, &momentum], &motion[..]].concat())
    };
    for height in ["0", "1e-15", "1e-11"] {
        let scenario = balanced(height, "[0,-30,60]");
        let scale = EnergyScale::find(&scenario).unwrap();
        assert_eq!(scale.unit, EnergyUnit::KineticAtStart, "{height}");
        let off = readouts(&scenario).number("energy_drift").unwrap().abs();
        println!("rim at {height} m: {off:e}");
        assert!(off < 1e-2, "{height}: {off:e}");
        let text = summary(readouts(&scenario)).to_string();
        has(&text, "of the kinetic energy at the start");
        let rk4 = gyrolab::physics::SchemeInfo::find("rk4").unwrap();
        let rows = compare(&scenario, &[rk4], &[0.01], |_, _| ControlFlow::Continue(())).unwrap();
        assert!(rows[0].energy_drift.unwrap() < 1e-2);
        let table = ComparisonTable {
            rows: &rows,
            energy_unit: Some(scale.unit),
            predictability: Predictability::default(),
        };
        has(table.to_string(), "of the kinetic energy at the start");
    }
    let heavy = EnergyScale::find(&balanced("1", "[0,-30,60]")).unwrap();
    assert_eq!(heavy.unit, EnergyUnit::Weight);
    assert!((heavy.size - 49.0).abs() < 1e-9);
    // At rest and balanced up to rounding, there is no energy scale.
    let rest = balanced("1e-16", "[0,0,0]");
    assert_eq!(EnergyScale::find(&rest), None);
    assert_eq!(readouts(&rest).health.energy_drift, None);
}

/// Returns the first NaN, infinity, null or overlong number in a text, if any.
fn find_bad_number(text: &str) -> Option<String> {
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || "._+-".contains(c)));
    words
        .find(|word| {
            let bare = word.trim_matches(['+', '-', '.']).to_lowercase();
            let numbers = word.split(|c: char| !c.is_ascii_digit());
            let digits = numbers.map(str::len).max();
            ["nan", "inf", "-inf", "null"].contains(&bare.as_str()) || digits > Some(30)
        })
        .map(str::to_owned)
}

#[test]
fn theory_of_an_upward_pulled_top_is_about_z_like_the_measurement() {
    let names: Vec<_> = "precession_rad_per_s nutation_period_s lowest_tilt_deg highest_tilt_deg"
        .split(' ')
        .collect();
    let set = ["motion.gravity_m_per_s2=-9.8", "motion.scheme=exact"];
    let hanging = preset("loops", &set);
    for (scenario, some) in [(preset("earth", &[]), &names[..1]), (hanging, &names)] {
        let readouts = readouts(&scenario);
        assert_eq!(readouts.theory.unwrap().axis, TheoryAxis::Z);
        for name in some {
            let [predicted, measured] = ["predicted", "measured"].map(|by| {
                let number = readouts.number(&format!("{by}_{name}"));
                number.unwrap_or_else(|| panic!("{by}_{name}"))
            });
            let off = (predicted / measured - 1.0).abs();
            assert!(off < 1e-5, "{name}: {predicted}, {measured}");
        }
        let text = summary(readouts).in_full(true).to_string();
        has(&text, "stable even without spin");
        has_no(&text, "about");
    }
}

/// Settings that bring the numbers of a preset to the limits of their range.
const EXTREME: &[&[&str]] = &[
    &["motion.gravity_m_per_s2=5e-324"],
    &["motion.gravity_m_per_s2=1e300"],
    &["motion.gravity_m_per_s2=-1e-300"],
    &["motion.time_step_s=1e308"],
    &["motion.time_step_s=1e300", "motion.gravity_m_per_s2=0"],
    &["motion.time_step_s=5e-324"],
    &["motion.time_step_s=1e-300"],
    &["push.0={point='top',force_N=[1e300,0,0],steps=3}"],
    &["push.0={point='top',force_N=[0,0,1e300],steps=3}"],
    &[
        "push.0={point='top',force_N=[0,0,5e-324],steps=3}",
        "motion.gravity_m_per_s2=0",
    ],
    &["push.0={point='top',force_N=[0,0,1],from_s=1e307,for_s=1e300}"],
    &["start.momentum_Js=[0,0,1e154]"],
    &["start.momentum_Js=[0,1e154,1e154]"],
    &["start.momentum_Js=[1e150,0,0]", "motion.gravity_m_per_s2=0"],
    &[
        "start.momentum_Js=[0,0,5e-324]",
        "motion.gravity_m_per_s2=0",
    ],
    &["start.momentum_Js=[0,0,0]", "motion.gravity_m_per_s2=0"],
    &["start.momentum_Js=[0,0,0]", "start.tilt_deg=0"],
    &[
        "start.momentum_Js=[0,0,1e-200]",
        "motion.gravity_m_per_s2=1e-200",
    ],
    &["start.momentum_Js=[0,0,1e100]"],
    &["body.rim.point_mass_kg=1e290"],
    &["body.rim.point_mass_kg=1e-290"],
    &[
        "body.rim.radius_m=1e-100",
        "body.rim.height_m=1e-100",
        "trace=foot",
    ],
    &["body.rim.height_m=1e100", "body.rim.radius_m=1e100"],
    &["body.point.1.at_m=[0,0,1e300]", "trace=top"],
    &["body.point.1.at_m=[0,0,1e-300]", "trace=top"],
];

/// The presets that are brought to these limits.
const BEGUN_FROM: [&str; 3] = ["cusps", "method-2", "torque-free"];

/// Returns each preset with each of the settings and `more`, without rejected combinations.
fn extreme_scenarios(more: &[&str]) -> Vec<(String, Scenario)> {
    let all = BEGUN_FROM
        .iter()
        .flat_map(|name| EXTREME.iter().map(move |set| (name, set)));
    all.filter_map(|(name, set)| {
        let mut document = Document::open(name).unwrap();
        let set = [set, more].concat();
        let is_set = set.iter().try_for_each(|set| document.set(set));
        let scenario = is_set.and_then(|()| document.scenario()).ok()?;
        Some((format!("{name} {set:?}"), scenario))
    })
    .collect()
}

#[test]
fn no_text_shows_nan_or_infinity() {
    let mut looked_at = 0;
    for scheme in SCHEMES {
        let scheme = format!("motion.scheme={}", scheme.name);
        for (case, scenario) in extreme_scenarios(&[&scheme, "motion.steps=40"]) {
            looked_at += 1;
            let readouts = readouts(&scenario);
            let text = summary(readouts.clone()).to_string();
            assert_eq!(find_bad_number(&text), None, "{case}\n{text}");
            let numbers = serde_json::to_string(&readouts)
                .unwrap()
                .replace(":null", ":none");
            assert_eq!(find_bad_number(&numbers), None, "{case}\n{numbers}");
            let picture = picture(&scenario);
            assert_eq!(find_bad_number(&picture), None, "{case}\n{picture}");
            for reason in Verdict::new(&readouts.health).reasons {
                assert_eq!(find_bad_number(&reason.long), None, "{case}: {reason:?}");
            }
        }
    }
    assert!(looked_at > 200, "{looked_at}");
}

/// Returns the picture of the lab on a large screen at the end of the run.
fn picture(scenario: &Scenario) -> String {
    let mut desk = Desk::with("x.toml", scenario.clone());
    let _ = desk
        .lab
        .begin_at(scenario.steps, |_, _| ControlFlow::Continue(())); // stops at the last finite step
    screen::text(&desk.lab, true, (200, 50))
}

#[test]
fn no_table_shows_nan_or_infinity() {
    for (case, scenario) in extreme_scenarios(&["motion.steps=8"]) {
        let schemes: Vec<_> = SCHEMES.iter().collect();
        let step = scenario.motion.time_step_s;
        if step / 2.0 == 0.0 {
            continue;
        }
        let rows = compare(&scenario, &schemes, &[step, step / 2.0], |_, _| {
            ControlFlow::Continue(())
        })
        .unwrap();
        let energy_unit = EnergyScale::find(&scenario).map(|scale| scale.unit);
        let table = ComparisonTable {
            rows: &rows,
            energy_unit,
            predictability: Predictability::default(),
        };
        let text = table.to_string();
        assert_eq!(find_bad_number(&text), None, "{case}\n{text}");
        let mut csv = csv::Writer::from_writer(Vec::new());
        rows.iter().for_each(|row| csv.serialize(row).unwrap());
        let written = String::from_utf8(csv.into_inner().unwrap()).unwrap();
        let is_finite = !written.contains("NaN") && !written.contains("inf");
        assert!(is_finite, "{case}\n{written}");
    }
}
