//! Fits: the statistics of least squares, the Heidelberg data, and messages about undetermined keys.

use crate::support::dice::Dice;
use crate::support::words::{has, has_all, has_no};
use gyrolab::engine::data::{DataKind, MeasuredData, at_times, open, read};
use gyrolab::engine::scenario::{Document, Problems};
use gyrolab::report::figure::of_table::{self, TableView};
use gyrolab::studies::fit::report::FitReport;
use gyrolab::studies::fit::{Fit, Free, Model, NoFit, fit};
use rayon::prelude::*;
use std::sync::Arc;

/// The model of the preset `name` with the settings `set`, under `exact`, with the keys `free`.
#[track_caller]
fn model(name: &str, set: &[&str], free: &[&str], measured: MeasuredData) -> Model {
    let mut document = Document::open(name).unwrap();
    document.set("motion.scheme=exact").unwrap();
    set.iter().for_each(|set| document.set(set).unwrap());
    model_of(&document, free, measured)
}

#[track_caller]
fn model_of(document: &Document, free: &[&str], measured: MeasuredData) -> Model {
    try_model(document, free, measured).unwrap_or_else(|problems| panic!("{problems}"))
}

fn try_model(
    document: &Document,
    free: &[&str],
    measured: MeasuredData,
) -> Result<Model, Problems> {
    let free = free.iter().map(|key| Free::parse(key, document).unwrap());
    Model::new(document, free.collect(), measured)
}

fn found(model: &Model) -> Result<Fit, NoFit> {
    fit(model, &|| true, &|_, _| {})
}

#[track_caller]
fn fitted(model: &Model) -> Fit {
    found(model).unwrap_or_else(|error| panic!("{error}"))
}

/// The model of [`TOP`] with these settings.
#[track_caller]
fn top(set: &[&str], free: &[&str], data: &str) -> Model {
    model_of(&top_with(set), free, read("lab.csv", data).unwrap())
}

#[track_caller]
fn top_with(set: &[&str]) -> Document {
    let mut document = Document::parse("top.toml", TOP).unwrap();
    set.iter().for_each(|set| document.set(set).unwrap());
    document
}

#[track_caller]
fn is_near(what: &str, value: f64, wanted: f64, within: f64) {
    assert!(
        (value - wanted).abs() <= within,
        "{what}: {value}, not {wanted} +- {within}"
    );
}

/// Returns a standard normal deviate (Box-Muller).
fn normal(dice: &mut Dice) -> f64 {
    let (radius, angle) = (dice.between(1e-300, 1.0), dice.unit());
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

/// A top with a closed-form motion that is cheap to compute.
const TOP: &str = r#"
title = "A top"
trace = "wheel"
[[body.part]]
name = "wheel"
shape = "cylinder"
mass_kg = 1
radius_m = 0.1
at_m = [0, 0, 0.2]
[start]
tilt_deg = 30
spin_rpm = 3000
[motion]
scheme = "exact"
time_step_s = 0.01
steps = 100
"#;

/// Tilt and azimuth of the top at twelve times, with noise of 0.1 and 0.2 degrees.
fn noisy(seed: u64) -> String {
    const TIMES: [f64; 12] = [
        0.0, 0.03, 0.07, 0.1, 0.14, 0.21, 0.3, 0.33, 0.41, 0.52, 0.6, 0.77,
    ];
    let mut dice = Dice(seed);
    for _ in 0..10 {
        dice.unit();
    }
    let values = truth();
    let head = "t_s,tilt_deg,tilt_uncertainty_deg,x_m,x_uncertainty_m\n".to_owned();
    TIMES
        .iter()
        .enumerate()
        .map(|(index, time_s)| {
            let tilt_deg = values[0][index] + 0.1 * normal(&mut dice);
            let x_m = values[1][index] + 0.002 * normal(&mut dice);
            format!("{time_s},{tilt_deg},0.1,{x_m},0.002\n")
        })
        .fold(head, |text, row| text + &row)
}

/// Tilt (degrees) and x (m) of the top without noise.
fn truth() -> &'static Vec<Vec<f64>> {
    static TRUTH: std::sync::OnceLock<Vec<Vec<f64>>> = std::sync::OnceLock::new();
    TRUTH.get_or_init(|| {
        let times = "0,0.03,0.07,0.1,0.14,0.21,0.3,0.33,0.41,0.52,0.6,0.77";
        let rows = times.split(',').map(|time| format!("{time},0,0\n"));
        let text = format!("t_s,tilt_deg,x_m\n{}", rows.collect::<String>());
        let DataKind::Series(series) = read("lab.csv", &text).unwrap().data else {
            panic!("no series")
        };
        let scenario = top_with(&[]).scenario().unwrap();
        at_times(&series, &Arc::new(scenario), &|| true)
            .unwrap()
            .unwrap()
    })
}

const FREE: [&str; 2] = ["start.tilt_deg", "start.spin_rpm"];
const TRUE: [f64; 2] = [30.0, 3000.0];

fn fit_of_noise(seed: u64) -> Fit {
    // The search starts a few uncertainties off.
    let set = ["start.tilt_deg=30.4", "start.spin_rpm=2950"];
    fitted(&top(&set, &FREE, &noisy(seed)))
}

#[test]
fn two_sigma_intervals_cover_the_truth_at_the_expected_rate() {
    const TRIALS: u64 = 1000;
    let fits: Vec<Fit> = (1..=TRIALS)
        .into_par_iter()
        .map(|seed| fit_of_noise(seed * 0x9E37_79B9))
        .collect();
    for (index, truth) in TRUE.into_iter().enumerate() {
        let off = |fit: &&Fit| {
            let key = &fit.keys[index];
            ((key.value - truth) / key.sigma.unwrap()).abs()
        };
        let covered = fits.iter().filter(|fit| off(fit) <= 2.0).count();
        assert!((930..=980).contains(&covered), "{}: {covered}", FREE[index]);
        let within_one = fits.iter().filter(|fit| off(fit) <= 1.0).count();
        let is_so = (640..=725).contains(&within_one);
        assert!(is_so, "{}: {within_one}", FREE[index]);
    }
    let mean = |of: &dyn Fn(&Fit) -> f64| fits.iter().map(of).sum::<f64>() / TRIALS as f64;
    // 24 data minus 2 keys; the mean of a thousand chi^2/22 has a standard deviation of 0.0095.
    let each = mean(&|fit| fit.quality.chi_squared.unwrap() / 22.0);
    assert!(fits.iter().all(|fit| fit.quality.degrees_of_freedom == 22));
    is_near("chi^2 per degree of freedom", each, 1.0, 0.03);
    let probability = mean(&|fit| fit.quality.probability.unwrap());
    is_near("mean probability", probability, 0.5, 0.03);
    let fits_count = fits
        .iter()
        .filter(|fit| fit.quality.fits() == Some(true))
        .count();
    assert!((980..=1000).contains(&fits_count), "{fits_count}");
}

#[test]
fn the_scatter_of_fits_matches_their_stated_covariance() {
    let fits: Vec<Fit> = (1..=60_u64)
        .map(|seed| fit_of_noise(seed * 77_777))
        .collect();
    let count = fits.len() as f64;
    let deviation = |fit: &Fit, index: usize| fit.keys[index].value - TRUE[index];
    let covariance = |i: usize, j: usize| {
        let products = fits.iter().map(|fit| deviation(fit, i) * deviation(fit, j));
        products.sum::<f64>() / count
    };
    let correlation = covariance(0, 1) / (covariance(0, 0) * covariance(1, 1)).sqrt();
    let stated = fits[0].solution.correlation(0, 1).unwrap();
    // With sixty pairs, the correlation has a standard deviation of (1 - r^2)/sqrt(60) = 0.13 at most.
    is_near("correlation", correlation, stated, 0.4);
    for (index, name) in FREE.into_iter().enumerate() {
        let ratio = covariance(index, index).sqrt() / fits[0].keys[index].sigma.unwrap();
        is_near(name, ratio, 1.0, 0.35);
    }
}

#[test]
fn data_without_noise_recover_the_keys() {
    let text = noisy(1);
    let mut exact = "t_s,tilt_deg,x_m\n".to_owned();
    for (index, line) in text.lines().skip(1).enumerate() {
        let time = line.split(',').next().unwrap();
        exact += &format!("{time},{},\n", truth()[0][index]);
    }
    let fit = fitted(&top(&["start.spin_rpm=2700"], &FREE, &exact));
    for (key, truth) in fit.keys.iter().zip(TRUE) {
        is_near(&key.free.key, key.value, truth, 1e-7 * truth);
    }
    assert_eq!(fit.quality.chi_squared, None);
    assert!(fit.quality.scatter.unwrap() < 1e-7);
}

const MOMENT: &str = "body.part.0.moments_kg_m2.2";

/// Fits shipped data; the weights are off the rod unless a column sets them.
fn heidelberg(name: &str, free: &[&str], rows: &dyn Fn(usize) -> bool) -> (Model, Fit) {
    let mut measured = open(name).unwrap();
    measured.keep_rows(rows);
    let model = model("heidelberg", &["body.point.0.at_m.2=0"], free, measured);
    let fit = fitted(&model);
    (model, fit)
}

#[test]
fn heidelberg_two_methods_give_the_same_ratio_of_moments() {
    for (name, ratio, sigma) in [
        ("heidelberg-body-cone", 1.0666, 0.0010),
        ("heidelberg-nutation", 1.0663, 0.0077),
    ] {
        let (_, fit) = heidelberg(name, &[MOMENT], &|_| true);
        // I1 is fixed at 0.004 kg m^2: only the ratio matters.
        let found = 4.0e-3 / fit.keys[0].value;
        is_near(name, found, ratio, 5e-5);
        let relative = fit.keys[0].sigma.unwrap() / fit.keys[0].value;
        is_near(name, found * relative, sigma, 0.02 * sigma);
    }
}

#[test]
fn heidelberg_the_spin_decays_in_24_minutes() {
    let measured = open("heidelberg-spin-decay").unwrap();
    let free = ["start.spin_rpm", "friction.spin_viscous_Nms"];
    // The decay of L along the axle does not depend on the motion of the axle, so long steps of a splitting scheme suffice.
    let set = [
        "body.point.0.at_m.2=0",
        "motion.scheme=strang",
        "motion.time_step_s=2",
    ];
    let fit = fitted(&model("heidelberg", &set, &free, measured));
    let viscous = &fit.keys[1];
    let minutes = 3.75e-3 / viscous.value / 60.0;
    is_near("decay time, min", minutes, 23.97, 0.01);
    let sigma = minutes * viscous.sigma.unwrap() / viscous.value;
    is_near("its uncertainty", sigma, 0.70, 0.01);
}

/// Selects the rows with one or two weights at 15 or 20 cm; the four cases alternate.
fn torque(which: usize) -> impl Fn(usize) -> bool {
    move |row| row % 4 == which
}

#[test]
fn heidelberg_one_weight_and_two_give_different_moments() {
    // Without the uncertainties of the spin: the published ones include only those of the period.
    let text = gyrolab::engine::data::find_shipped("heidelberg-precession")
        .unwrap()
        .text;
    let without: String = text
        .lines()
        .map(|line| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if !line.starts_with('#') {
                cells.remove(3);
            }
            cells.join(",") + "\n"
        })
        .collect();
    let published = [
        (3.765, 0.047),
        (3.871, 0.062),
        (4.284, 0.096),
        (4.335, 0.125),
    ];
    for (which, (moment, sigma)) in published.into_iter().enumerate() {
        let mut measured = read("precession.csv", &without).unwrap();
        measured.keep_rows(torque(which));
        let fit = fitted(&model("heidelberg", &[], &[MOMENT], measured));
        is_near("I3, g m^2", 1e3 * fit.keys[0].value, moment, 0.001);
        let found = 1e3 * fit.keys[0].sigma.unwrap();
        is_near("its uncertainty", found, sigma, 0.001);
        // With them, no value moves by more than a fraction of its uncertainty.
        let (_, with_spin) = heidelberg("heidelberg-precession", &[MOMENT], &torque(which));
        is_near(
            "I3, g m^2",
            1e3 * with_spin.keys[0].value,
            moment,
            0.1 * sigma,
        );
        assert_eq!(with_spin.quality.fits(), Some(true));
    }
}

#[test]
fn heidelberg_the_joint_fit_is_reported_as_poor() {
    let (model, fit) = heidelberg("heidelberg-precession", &[MOMENT], &|_| true);
    is_near("chi^2", fit.quality.chi_squared.unwrap(), 33.5, 0.5);
    assert_eq!(fit.quality.degrees_of_freedom, 15);
    assert_eq!(
        fit.sentence(&model),
        "The model does not fit: chi^2 33.6 at 15 degrees of freedom, which chance gives once in 260 times; no single row is more than 2.5 sigma off, but together they deviate more than chance explains."
    );
}

#[test]
fn heidelberg_explanations_of_the_poor_fit_can_be_tested() {
    // An extra torque from a ball whose center is off the pivot; M g = 41.2 N.
    let free = [MOMENT, "body.part.0.at_m.2"];
    let (_, fit) = heidelberg("heidelberg-precession", &free, &|_| true);
    is_near("chi^2", fit.quality.chi_squared.unwrap(), 3.4, 0.4);
    is_near("I3, g m^2", 1e3 * fit.keys[0].value, 4.8, 0.1);
    let torque = |height: f64| 1e3 * 4.2 * 9.81 * height;
    is_near("torque, mN m", torque(fit.keys[1].value), 4.2, 0.2);
    let sigma = fit.keys[1].sigma.unwrap();
    is_near("its uncertainty", torque(sigma), 0.9, 0.15);
    // Two weights that together are lighter than twice one.
    let weights = [MOMENT, "body.point.1.mass_kg"];
    let (_, heavier) = heidelberg("heidelberg-precession", &weights, &|_| true);
    is_near("chi^2", heavier.quality.chi_squared.unwrap(), 3.0, 0.4);
    is_near("I3, g m^2", 1e3 * heavier.keys[0].value, 3.8, 0.05);
    is_near("weights", 1.0 + heavier.keys[1].value / 9.85e-3, 1.77, 0.03);
}

#[test]
fn degenerate_keys_are_named_and_have_no_uncertainty() {
    let free = [MOMENT, "motion.gravity_m_per_s2"];
    let (_, fit) = heidelberg("heidelberg-precession", &free, &|_| true);
    assert!(fit.keys.iter().all(|key| key.sigma.is_none()));
    assert_eq!(fit.quality.degrees_of_freedom, 15);
    let remarks = fit.remarks();
    assert_eq!(
        remarks[0],
        "The data cannot tell body.part.0.moments_kg_m2.2 and motion.gravity_m_per_s2 apart: changing body.part.0.moments_kg_m2.2 by +1.00 % and motion.gravity_m_per_s2 by +1.00 % together changes no measured number."
    );
    let turned = [MOMENT, "start.turn_deg"];
    let (_, unmoved) = heidelberg("heidelberg-precession", &turned, &|_| true);
    assert!(unmoved.keys[0].sigma.is_some() && unmoved.keys[1].sigma.is_none());
    assert_eq!(
        unmoved.remarks()[0],
        "The data do not depend on start.turn_deg and cannot determine it."
    );
}

#[test]
fn a_key_at_its_bound_is_reported() {
    let bounded = format!("{MOMENT}=0.003..0.0038");
    let (model, fit) = heidelberg("heidelberg-precession", &[&bounded], &|_| true);
    let key = &fit.keys[0];
    assert_eq!((key.value, key.is_held, key.sigma), (0.0038, true, None));
    let report = FitReport {
        fit: &fit,
        model: &model,
        instead_of: Some("rk4"),
    };
    let told = report.to_string();
    // CSV, JSON and text may be quoted separately, so each names the scheme.
    let json = serde_json::to_value(report).unwrap();
    let remark = "The fitted runs use the scheme exact; the scenario's scheme is rk4 (use --scheme rk4 to fit with it).";
    assert_eq!(json["remarks"][0], remark);
    assert!(told.contains(remark), "{told}");
    has(
        &told,
        "body.part.0.moments_kg_m2.2 is at its bound 0.0038: the fit would be better beyond it, and the key has no uncertainty. With another start value (--set), the search may find a better fit within the bounds.",
    );
    // A value inside its bounds is not reported as held.
    let inside = format!("{MOMENT}=0.003..0.005");
    let (_, inside_fit) = heidelberg("heidelberg-precession", &[&inside], &|_| true);
    assert!(inside_fit.keys[0].sigma.is_some() && !inside_fit.remarks().concat().contains("bound"));
}

/// The data determine only the ratio of moment and gravity, 0.00392 to 9.81.
#[test]
fn bounds_hold_degenerate_keys_only_if_they_exclude_the_best_ratio() {
    let moment = format!("{MOMENT}=0.003..0.0038");
    let fit_within = |gravity: &str| {
        let gravity = format!("motion.gravity_m_per_s2={gravity}");
        heidelberg("heidelberg-precession", &[&moment, &gravity], &|_| true).1
    };
    // Many pairs inside the bounds have the best ratio, so no bound worsens the fit and neither value is determined.
    let fit = fit_within("9.0..9.82");
    is_near(
        "ratio",
        fit.keys[0].value / fit.keys[1].value,
        0.00392 / 9.81,
        1e-6,
    );
    assert!(
        fit.keys
            .iter()
            .all(|key| !key.is_held && key.sigma.is_none())
    );
    assert!(
        fit.remarks()[0].contains("cannot tell"),
        "{:?}",
        fit.remarks()
    );
    // No pair has the best ratio: both bounds worsen the fit.
    let at_both = fit_within("9.7..9.82");
    assert_eq!([0, 1].map(|key| at_both.keys[key].value), [0.0038, 9.7]);
    assert!(
        at_both
            .keys
            .iter()
            .all(|key| key.is_held && key.sigma.is_none())
    );
}

#[test]
fn data_without_uncertainties_are_weighted_by_their_scatter() {
    let noisy = noisy(5);
    let text: String = noisy
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            format!("{},{}\n", cells[0], cells[1])
        })
        .collect();
    let model = top(&["start.spin_rpm=2950"], &FREE, &text);
    let fit = fitted(&model);
    // Twelve deviates of 0.1 degrees minus two fitted keys: the scatter is known to 22 %.
    is_near("scatter", fit.quality.scatter.unwrap(), 0.1, 0.06);
    assert_eq!((fit.quality.chi_squared, fit.quality.fits()), (None, None));
    assert!(
        fit.sentence(&model)
            .contains("cannot be judged, since the data have no uncertainties")
    );
    let tilt = &fit.keys[0];
    is_near("tilt", tilt.value, 30.0, 4.0 * tilt.sigma.unwrap());
}

#[test]
fn few_data_without_uncertainties_use_students_factor() {
    const KEYS: [(&str, f64); 2] = [("start.tilt_deg", 30.0), ("start.turn_deg", 20.0)];
    for (data, words) in [(5, "1.65 (Student's factor for 3 degrees"), (6, "1.43 (")] {
        let off = |seed: u64| {
            let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
            (0..20).for_each(|_| {
                dice.unit();
            });
            let mut text = "t_s,tilt_deg,azimuth_deg\n".to_owned();
            for row in 0..3 {
                let [tilt, azimuth] = [30.0, -70.0].map(|angle| angle + 0.1 * normal(&mut dice));
                let azimuth = (2 * row + 1 < data).then_some(azimuth.to_string());
                text += &format!("0,{tilt},{}\n", azimuth.unwrap_or_default());
            }
            let model = top(&[], &KEYS.map(|(key, _)| key), &text);
            let fit = fitted(&model);
            has(fit.sentence(&model), words);
            [0, 1]
                .map(|key| (fit.keys[key].value - KEYS[key].1).abs() / fit.keys[key].sigma.unwrap())
        };
        let offs: Vec<[f64; 2]> = (1..=1000_u64).into_par_iter().map(off).collect();
        for (key, (name, _)) in KEYS.into_iter().enumerate() {
            let covered = offs.iter().filter(|one| one[key] <= 2.0).count();
            println!("{data} data, {name}: {covered} of 1000");
            let is_so = (930..=980).contains(&covered);
            assert!(is_so, "{data} data, {name}: {covered}");
        }
    }
}

#[test]
fn an_aliased_minimum_of_evenly_sampled_azimuths_is_reported() {
    let remarks = |times_s: [f64; 4]| {
        let rows = times_s.map(|time_s| format!("{time_s},{}\n", (-90.0 + 60.0 * time_s) % 360.0));
        let text = format!("t_s,azimuth_deg\n{}", rows.concat());
        let model = top(&[], &["start.spin_rpm"], &text);
        let fit = fitted(&model);
        let report = FitReport {
            fit: &fit,
            model: &model,
            instead_of: None,
        };
        serde_json::to_string(&report).unwrap()
    };
    let words = "a precession faster or slower by 180 deg/s";
    let (even, uneven) = (remarks([0.0, 2.0, 4.0, 8.0]), remarks([0.0, 2.0, 4.7, 8.0]));
    has(&even, words);
    has_no(&uneven, "faster or slower");
}

#[test]
fn two_keys_can_share_one_value() {
    // Both moments across the axle, which must stay equal for the body to be symmetric.
    let across = "body.part.0.moments_kg_m2.0+body.part.0.moments_kg_m2.1";
    let (_, fit) = heidelberg("heidelberg-body-cone", &[across], &|_| true);
    is_near("I1/I3", fit.keys[0].value / 3.75e-3, 1.0666, 5e-5);
    let measured = open("heidelberg-body-cone").unwrap();
    let set = ["body.point.0.at_m.2=0"];
    let free = ["body.part.0.moments_kg_m2.0"];
    let one = model("heidelberg", &set, &free, measured);
    let told = found(&one).unwrap_err().to_string();
    has(&told, "can be changed neither up nor down from 0.004: ");
    let document = Document::open("heidelberg").unwrap();
    let unlike = "body.part.0.moments_kg_m2.0+body.part.0.moments_kg_m2.2";
    assert_eq!(
        Free::parse(unlike, &document).unwrap_err().to_string(),
        "--free body.part.0.moments_kg_m2.0+body.part.0.moments_kg_m2.2: body.part.0.moments_kg_m2.0 is 0.004 and body.part.0.moments_kg_m2.2 is 0.00375: keys that share one value must start from the same value"
    );
}

#[test]
fn a_key_without_effect_stays_and_has_no_uncertainty() {
    let free = [MOMENT, "body.part.0.mass_kg"];
    let (_, fit) = heidelberg("heidelberg-precession", &free, &|_| true);
    assert_eq!((fit.keys[1].value, fit.keys[1].sigma), (4.2, None));
    is_near("I3", fit.keys[0].value, 3.92e-3, 1e-5);
}

#[test]
fn the_csv_of_a_fit_opens_as_the_fitted_run() {
    use gyrolab::studies::fit::report::{self, FitCommand};
    let (model, fit) = heidelberg("heidelberg-precession", &[MOMENT], &|_| true);
    let report = FitReport {
        fit: &fit,
        model: &model,
        instead_of: None,
    };
    let asked = FitCommand {
        scheme: report.model.scheme.to_owned(),
        command: "gyrolab fit".to_owned(),
        measured: "heidelberg-precession".to_owned(),
        scenario: "heidelberg".to_owned(),
        free: vec![MOMENT.to_owned()],
        rows: None,
        chi_squared: fit.quality.chi_squared,
        degrees_of_freedom: 15,
        scatter: None,
        verdict: fit.sentence(&model),
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fit.csv");
    let scenario = model.scenario(&[fit.keys[0].value]).unwrap();
    let file = std::fs::File::create(&path).unwrap();
    report::write_csv(file, &report, &scenario, asked).unwrap();
    let again = Document::read(&path).unwrap().scenario().unwrap();
    let moments = again.file.body.part[0].moments_kg_m2.unwrap();
    assert_eq!(moments[2], fit.keys[0].value);
    let text = std::fs::read_to_string(&path).unwrap();
    let lines = text.lines().filter_map(|line| line.strip_prefix("# # "));
    let header: String = lines.flat_map(|line| [line, "\n"]).collect();
    let header: report::Header = toml::from_str(&header).unwrap();
    assert_eq!(header.key[0].uncertainty, fit.keys[0].sigma);
    assert_eq!(header.fit.chi_squared, fit.quality.chi_squared);
    // Its figure has the values with error bars on the model, and the residuals below.
    let table = gyrolab::studies::table::TableSource::read(&path)
        .unwrap()
        .unwrap();
    let chart = of_table::chart(&table, &TableView::of_columns(&[], 240.0)).unwrap();
    let [values, residuals] = &chart.panels[..] else {
        panic!("{} panels", chart.panels.len())
    };
    assert_eq!(header.fit.scheme, "exact");
    assert_eq!(values.series[1].name, "scheme: exact");
    let drawn = values.series.iter().filter(|it| !it.points.is_empty());
    assert_eq!(drawn.count(), 8, "four settings, each with its model");
    // Every value is labeled with its key.
    let stated = fit.keys[0].stated();
    let model_name = format!("model: moments *z* of ball = {stated} kg m^{{2}}");
    assert_eq!(values.series[0].name, model_name);
    let place = "*z* of weight = 0.1555 m, *z* of second weight = 0 m";
    assert_eq!(values.series[2].name, place);
    // On a narrow page, the values appear alone.
    let narrow = of_table::chart(&table, &TableView::of_columns(&[], 120.0)).unwrap();
    assert_eq!(narrow.panels[0].series[2].name, "0.1555, 0");
    let points = |panel: &gyrolab::plot::chart::Panel| -> usize {
        let series = panel.series.iter();
        let marked = series.filter(|series| series.style.mark.is_some());
        marked.map(|one| one.points.len()).sum()
    };
    assert_eq!((points(values), points(residuals)), (16, 16));
    let errors = &values.series[2].errors[1];
    assert!(!errors.is_empty() && errors.iter().all(|error| (2.0..2.5).contains(error)));
    assert!(residuals.y.unit.contains('σ'));
}

/// Returns the number of steps of the run of a fit of [`TOP`] to data up to `last_s`.
fn steps_written(last_s: f64) -> u64 {
    let text = format!("t_s,tilt_deg\n0,30\n{last_s},30\n");
    let model = top(&[], &["start.spin_rpm"], &text);
    model.as_long_as_measured(&[3000.0]).unwrap().steps
}

#[test]
fn the_run_of_a_fit_covers_the_measured_time() {
    let own = top_with(&[]).scenario().unwrap();
    let end_s = own.steps as f64 * own.motion.time_step_s;
    assert_eq!(steps_written(0.5 * end_s), own.steps);
    assert_eq!(steps_written(12.0 * end_s), 12 * own.steps);
}

#[test]
fn two_data_without_uncertainties_give_no_uncertainties() {
    let fit_of = |text: &str| {
        let model = top(&[], &["start.tilt_deg"], text);
        let fit = fitted(&model);
        let sentence = fit.sentence(&model);
        (fit, sentence)
    };
    // Two data that agree by chance give no uncertainty.
    let (fit, sentence) = fit_of("t_s,tilt_deg\n0,30\n0,30.0001\n");
    assert_eq!(fit.quality.degrees_of_freedom, 1);
    assert_eq!((fit.keys[0].sigma, fit.variance), (None, None));
    has_all(
        &sentence,
        [
            "1 datum more than fitted values is too few",
            "Measure at least 3 more",
        ],
    );
    let (sure, of_four) = fit_of("t_s,tilt_deg\n0,30\n0,30.1\n0,29.9\n0,30.1\n");
    assert!(sure.keys[0].sigma.is_some(), "{of_four}");
}

#[test]
fn a_very_poor_fit_warns_of_a_local_minimum() {
    let sentence = |sigma: f64| {
        let text = format!("t_s,tilt_deg,tilt_uncertainty_deg\n0,30,{sigma}\n0,31,{sigma}\n");
        let model = top(&[], &["start.tilt_deg"], &text);
        fitted(&model).sentence(&model)
    };
    let words = "There may be a better fit elsewhere: start the search at other values of the free keys with --set";
    let (poor, rare) = (sentence(0.1), sentence(0.25));
    has_all(&poor, ["does not fit", words]);
    has(&rare, "does not fit");
    has_no(&rare, words);
}

#[test]
fn no_other_start_is_suggested_if_no_key_affects_the_data() {
    let text = "t_s,spin_rpm,spin_uncertainty_rpm\n1,10,1\n2,10,1\n3,10,1\n";
    let model = top(&[], &["start.turn_deg"], text);
    let fit = fitted(&model);
    assert_eq!(fit.solution.silent.len(), 1);
    let alone = fit.sentence(&model);
    has(&alone, "No value of the free keys improves it");
    has_no(&alone, "elsewhere");
}

#[test]
fn impossible_fits_are_rejected_with_a_remedy() {
    let mut told = String::new();
    for (free, data) in [
        (&FREE[..], "t_s,tilt_deg\n0,30\n"),
        (
            &FREE[..],
            "start.spin_rpm,predicted_nutation_period_s\n3000,1\n3000,1\n",
        ),
        (
            &FREE[..1],
            "start.spin_rpm,predicted_body_cone_period_s\n3000,1\n2000,2\n",
        ),
        (
            &FREE[..1],
            "t_s,tilt_deg,tilt_uncertainty_deg\n0,30,1\n1,30,\n",
        ),
        (&FREE[..1], "t_s,tilt_deg,x_m\n0,30,1\n1,30,1\n"),
    ] {
        let measured = read("lab.csv", data).unwrap();
        let refused = match try_model(&top_with(&[]), free, measured) {
            Err(problems) => problems.to_string(),
            Ok(model) => found(&model).unwrap_err().to_string(),
        };
        told += &format!("{data}{refused}\n\n");
    }
    for argument in [
        "start.spin_rp",
        "body.part.0.at_m",
        "motion.scheme",
        "view.speed",
        "start.spin_rpm=1..2..3",
        "start.spin_rpm=4000..5000",
        "start.spin_rpm=5..1",
        "friction.spin_viscous_Nms=-1..0",
        "start.momentum_Js.2",
    ] {
        let refused = Free::parse(argument, &top_with(&[])).unwrap_err();
        told += &format!("{refused}\n");
    }
    insta::assert_snapshot!("refusals", told);
}

#[test]
fn a_single_outlier_is_named_by_its_row() {
    // The datum does not depend on the key, so there is one degree of freedom.
    let text = "t_s,spin_rpm,spin_uncertainty_rpm\n1,3028,10\n";
    let model = top(&[], &["start.turn_deg"], text);
    let told = fitted(&model).sentence(&model);
    assert!(told.contains("; row 1 is 2.8 sigma off."), "{told}");
}

#[test]
fn a_key_between_its_bound_and_the_possible_range_is_rejected() {
    let measured = open("heidelberg-body-cone").unwrap();
    // The third moment equals the sum of the others and cannot be larger.
    let set = [
        "body.point.0.at_m.2=0",
        "body.part.0.moments_kg_m2=[0.002, 0.002, 0.004]",
    ];
    let free = ["body.part.0.moments_kg_m2.2=0.004..0.005"];
    let stuck = model("heidelberg", &set, &free, measured);
    let told = found(&stuck).unwrap_err().to_string();
    has(
        &told,
        "body.part.0.moments_kg_m2.2 can be changed neither up nor down from 0.004: ",
    );
}

/// The effect of a setting of 0 that cannot be negative is computed from above.
#[test]
fn an_uncertain_setting_may_be_at_the_edge_of_its_range() {
    let fit = |friction: f64| {
        let text = format!(
            "friction.spin_viscous_Nms,friction.spin_viscous_uncertainty_Nms,spin_rpm,spin_uncertainty_rpm\n\
             {friction},1e-5,3000,1\n{friction},1e-5,3001,1\n"
        );
        fitted(&top(&[], &["start.spin_rpm"], &text))
    };
    let (edge, inside) = (fit(0.0), fit(1e-4));
    assert!(edge.weights.count_settings && inside.weights.count_settings);
    let sigma = inside.weights.sigma[0];
    assert!(sigma > 2.0, "{sigma}");
    is_near("sigma", edge.weights.sigma[0] / sigma, 1.0, 0.05);
}

#[test]
fn data_later_than_any_run_are_rejected_with_the_limit() {
    let document = Document::open("cusps").unwrap();
    let far = read("far.csv", "t_s,tilt_deg\n0,20\n1e300,20\n").unwrap();
    let told = try_model(&document, &["start.tilt_deg"], far)
        .unwrap_err()
        .to_string();
    has_all(&told, ["far.csv:3: t_s", "10 000 000 steps"]);
}
