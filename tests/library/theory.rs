//! Theory for the textbook's tops, and the measurements in their runs.

use crate::support::scenarios::preset as opened;
use crate::support::words::{has, has_all, has_no};
use gyrolab::engine::analysis::theory::AxlePath;
use gyrolab::engine::analysis::{Health, MeasuredNumber, Monitor, Readouts, Theory};
use gyrolab::engine::export::RunSummary;
use gyrolab::engine::run::resampled;
use gyrolab::engine::run::{Simulation, Truth};
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::SchemeInfo;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Duration;

fn preset(name: &str, set: &[&str]) -> Arc<Scenario> {
    Arc::new(opened(name, set))
}

fn theory(scenario: &Arc<Scenario>, time_s: f64) -> Option<Theory> {
    let simulation = Simulation::new(Arc::clone(scenario));
    Monitor::new(simulation.now()).theory(time_s)
}

/// Plays a run to its end, and returns it with the monitor that recorded it.
fn play_monitored(scenario: &Arc<Scenario>) -> (Simulation, Monitor) {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < scenario.steps {
        simulation.step().unwrap();
        monitor.record(simulation.now());
    }
    (simulation, monitor)
}

/// Values of a preset from elliptic integrals and L_z / L3.
struct Row {
    name: &'static str,
    tilts_deg: [f64; 2],
    /// L3, J s.
    spin: f64,
    period_s: f64,
    /// Mean precession, rad/s.
    precession: f64,
    cusp_deg: Option<f64>,
    path: AxlePath,
}

/// Preset, tilt range (degrees), L3 (J s), nutation period (s), mean precession (rad/s), cusp tilt (degrees), path.
const TABLE: &str = "\
cusps             30.0 36.689122  60.0 0.82252109 0.88603286 30.0      Cusps
loops             30.0 43.326768  60.0 0.80972164 0.87293538 32.751441 Loops
waves             30.0 33.300271  60.0 0.82751810 0.89019512 28.535008 Waves
steady-slow       30.0 30.0       60.0 0.83131382 0.89255885 27.054942 Circle
steady-fast       30.0 30.0       60.0 0.70252998 9.60471877 -         Circle
sleeping          1.0  2.283364   40.0 2.36591637 1.70342095 1.0       Cusps
sleeping-unstable 1.0  38.187812  34.0 8.72583595 2.36684257 1.0       Cusps
falling           10.0 130.944391 15.0 2.93780582 1.61148135 10.0      Cusps
";

fn table() -> impl Iterator<Item = Row> {
    TABLE.lines().map(|line| {
        let cells: Vec<_> = line.split_whitespace().collect();
        let [low, high, spin, period_s, precession] = [1, 2, 3, 4, 5].map(|at| number(cells[at]));
        Row {
            name: cells[0],
            tilts_deg: [low, high],
            spin,
            period_s,
            precession,
            cusp_deg: (cells[6] != "-").then(|| number(cells[6])),
            path: match cells[7] {
                "Cusps" => AxlePath::Cusps,
                "Loops" => AxlePath::Loops,
                "Waves" => AxlePath::Waves,
                "Circle" => AxlePath::Circle,
                other => panic!("{other}"),
            },
        }
    })
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

fn close(what: &str, seen: f64, known: f64, within: f64) {
    assert!((seen - known).abs() < within, "{what}: {seen}, not {known}");
}

#[test]
fn theory_agrees_with_the_textbook() {
    for row in table() {
        let scenario = preset(row.name, &[]);
        for time in [0.0, 3.7] {
            let theory = theory(&scenario, time).unwrap();
            let limit = theory.sleeping_limit.unwrap();
            assert_eq!(
                theory.axle_momentum.abs() > limit,
                row.spin > 35.967,
                "{}",
                row.name
            );
            let fast_top = theory.fast_top_precession.unwrap();
            let (low, high) = theory.tilt_range_deg;
            for (what, seen, known, within) in [
                ("load", theory.load, 49.0, 1e-12),
                ("L3", theory.axle_momentum, row.spin, 1e-12),
                ("sleeping limit", limit, 35.967, 5e-4),
                ("fast-top precession", fast_top, 49.0 / row.spin, 1e-12),
                (
                    "fast-top nutation",
                    theory.fast_top_nutation,
                    row.spin / 6.6,
                    1e-12,
                ),
                ("least tilt", low, row.tilts_deg[0], 1e-6),
                ("greatest tilt", high, row.tilts_deg[1], 1e-6),
                (
                    "period",
                    theory.nutation_period_s.unwrap(),
                    row.period_s,
                    1e-8,
                ),
                (
                    "precession",
                    theory.precession.unwrap(),
                    row.precession,
                    1e-8,
                ),
            ] {
                close(&format!("{}: {what}", row.name), seen, known, within);
            }
            let cusps = [theory.cusp_tilt_deg, row.cusp_deg];
            assert_eq!(cusps[0].is_some(), cusps[1].is_some(), "{}", row.name);
            let [seen, known] = cusps.map(|cusp| cusp.unwrap_or(0.0));
            close("cusp", seen, known, 1e-6);
            assert_eq!(theory.path, row.path, "{}", row.name);
        }
    }
}

#[test]
fn steady_roots_belong_to_the_current_tilt() {
    // 6.6 cos(tilt) w^2 - 60 w + 49 = 0.
    let mut monitor = Monitor::new(Simulation::new(preset("cusps", &[])).now());
    let mut truth = Truth::new(preset("cusps", &[]));
    for time in [0.0, 0.41, 0.82252109, 5.0] {
        let theory = monitor.theory(time).unwrap();
        let cosine = truth.state_at(time).axle().z;
        for root in [theory.slow_precession, theory.fast_precession] {
            let w = root.unwrap();
            close("root", 6.6 * cosine * w * w - 60.0 * w + 49.0, 0.0, 1e-11);
        }
    }
    let start = theory(&preset("cusps", &[]), 0.0).unwrap();
    close("slow", start.slow_precession.unwrap(), 0.8925, 1e-4);
    close("fast", start.fast_precession.unwrap(), 9.6047, 1e-4);
    let slow = theory(&preset("sleeping-unstable", &[]), 0.0).unwrap();
    let roots = (slow.slow_precession, slow.fast_precession);
    assert_eq!(roots, (None, None), "too slow for steady precession");
    let level = theory(&preset("cusps", &["start.tilt_deg=90"]), 0.0).unwrap();
    let level_slow = level.slow_precession.unwrap();
    close("level: slow", level_slow, 49.0 / 60.0, 1e-12);
    assert_eq!(level.fast_precession, None);
}

#[test]
fn path_names_match_the_azimuth() {
    for Row { name, path, .. } in table() {
        let theory = theory(&preset(name, &[]), 0.0).unwrap();
        let Some(period) = theory
            .nutation_period_s
            .filter(|_| path != AxlePath::Circle)
        else {
            continue;
        };
        let mut truth = Truth::new(preset(name, &[]));
        // By finite differences over one nutation.
        let mut azimuth = |time: f64| {
            let axle = truth.state_at(time).axle();
            axle.y.atan2(axle.x)
        };
        let rates: Vec<f64> = (0..400)
            .map(|k| {
                let time = 3.0 * period + f64::from(k) / 400.0 * period;
                let change = azimuth(time + 1e-4) - azimuth(time);
                (change - TAU * (change / TAU).round()) / 1e-4
            })
            .collect();
        let most = rates.iter().copied().fold(f64::MIN, f64::max);
        let least = rates.iter().copied().fold(f64::MAX, f64::min) / most;
        match path {
            AxlePath::Loops => assert!(least < -0.1, "{name}: {least}"),
            AxlePath::Cusps => assert!(least.abs() < 2e-3, "{name}: {least}"),
            _ => assert!(least > 0.1, "{name}: {least}"),
        }
    }
}

#[test]
fn the_azimuth_reverses_at_the_cusp_tilt() {
    let mut truth = Truth::new(preset("loops", &[]));
    let theory = theory(&preset("loops", &[]), 0.0).unwrap();
    let look = |motion: &mut Truth, time: f64| {
        let axle = motion.state_at(time).axle();
        (axle.y.atan2(axle.x), axle.z.acos().to_degrees())
    };
    let mut turned = 0;
    for k in 0..8000 {
        let time = f64::from(k) * 1e-4;
        let [a, b, c] = [time, time + 1e-4, time + 2e-4].map(|time| look(&mut truth, time));
        if (b.0 - a.0) * (c.0 - b.0) < 0.0 {
            let known = theory.cusp_tilt_deg.unwrap();
            close("tilt where it turns", b.1, known, 0.01);
            turned += 1;
        }
    }
    assert_eq!(turned, 2, "two reversals per loop");
}

#[test]
fn special_motions_have_their_own_path_names() {
    let free = theory(&preset("torque-free", &[]), 1.0).unwrap();
    assert_eq!(
        (free.path, free.nutation_period_s, free.cusp_tilt_deg),
        (AxlePath::Circle, None, None)
    );
    close("about L", free.precession.unwrap(), 60.0 / 6.6, 1e-12);
    close("steadily", free.fast_precession.unwrap(), 60.0 / 6.6, 1e-12);
    close("tilt from L", free.tilt_range_deg.0, 30.0, 1e-9);
    for (name, set, time_s) in [
        ("cusps", "start.tilt_deg=0", 1.0),
        ("cusps", "start.tilt_deg=180", 1.0),
        ("method-1", "title=x", 0.01),
        ("method-1-steeper", "title=x", 0.01),
    ] {
        let through = theory(&preset(name, &[set]), time_s).unwrap();
        let seen = (through.path, through.precession);
        assert_eq!(seen, (AxlePath::ThroughVertical, None), "{name} {set}");
    }
    let pendulum = preset("cusps", &["start.momentum_Js=[0,0,0]", "start.tilt_deg=80"]);
    let pendulum = theory(&pendulum, 1.0).unwrap();
    let seen = (pendulum.path, pendulum.fast_top_precession);
    assert_eq!(seen, (AxlePath::ThroughVertical, None));
}

const LOPSIDED: [&str; 2] = ["body.point.2.at_m=[0.3,0,0]", "body.point.2.mass_kg=0.5"];
const SIDEWAYS: &str = "push.0={point='top',force_N=[20,10,0],from_s=2,for_s=4}";

#[test]
fn under_a_sideways_push_theory_is_about_the_tilted_vertical() {
    let scenario = preset("cusps", &[SIDEWAYS]);
    let simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    let during = monitor.theory(3.0).unwrap();
    let load = nalgebra::Vector3::new(30.0, 15.0, -49.0);
    close("load", during.load, load.norm(), 1e-12);
    let mut truth = Truth::new(scenario);
    let (mut least, mut most) = (180.0_f64, 0.0_f64);
    for k in 0..=4000 {
        let axle = truth.state_at(2.0 + f64::from(k) * 1e-3).axle();
        let tilt = axle.angle(&-load).to_degrees();
        (least, most) = (least.min(tilt), most.max(tilt));
    }
    close("least", least, during.tilt_range_deg.0, 1e-3);
    close("greatest", most, during.tilt_range_deg.1, 1e-3);
    let state = truth.state_at(3.0);
    let (across, spin) = (
        6.6 * state.axle().angle(&-load).cos(),
        state.momentum.dot(&state.axle()),
    );
    let w = during.slow_precession.unwrap();
    let rest = across * w * w - spin * w + load.norm();
    close("steadily", rest, 0.0, 1e-11);
    let cusp = state.momentum.angle(&-load).cos() * state.momentum.norm() / spin;
    let seen = during.cusp_tilt_deg.unwrap();
    close("cusp", seen, cusp.acos().to_degrees(), 1e-9);
    // Before the push, after it, before it again, and during it.
    for time in [1.0, 7.0, 1.0, 3.0] {
        let load = if time == 3.0 { load.norm() } else { 49.0 };
        close("load", monitor.theory(time).unwrap().load, load, 1e-12);
    }
}

fn summary(scenario: &Arc<Scenario>) -> RunSummary {
    let (simulation, mut monitor) = play_monitored(scenario);
    let health: Health = monitor.health(simulation.now());
    let readouts = Readouts::new(&simulation, &mut monitor, &health, None);
    RunSummary::new(readouts, Duration::from_secs(1))
}

#[test]
fn theory_is_absent_or_explained_where_it_does_not_apply() {
    let [place, mass] = LOPSIDED;
    let lopsided = preset("cusps", &[place, mass, "motion.steps=2000"]);
    assert_eq!(theory(&lopsided, 1.0), None);
    let text = summary(&lopsided).to_string();
    has_all(
        &text,
        [
            "precession    none by theory, which covers symmetric bodies only, ",
            "nutation      none by theory, which covers symmetric bodies only",
        ],
    );

    let side = "body.point.3={name='side',at_m=[0.5,0,1]}";
    let push = "push.0={point='side',force_N=[0,0,-1],from_s=1,for_s=1}";
    let off_axle = preset("cusps", &[side, push, "motion.steps=1500"]);
    assert!(theory(&off_axle, 0.5).is_some() && theory(&off_axle, 2.5).is_some());
    // During a push off the axle.
    assert_eq!(theory(&off_axle, 1.5), None);
    let pushed = summary(&off_axle).to_string();
    has(&pushed, "precession    none by theory, ");
    has_no(&pushed, "lopsided");

    // An existing nutation that cannot be determined is not reported as none.
    let told = |file: &str, steps: u64| {
        let mut document = Document::parse("lopsided.toml", file).unwrap();
        document.set(&format!("motion.steps={steps}")).unwrap();
        summary(&Arc::new(document.scenario().unwrap())).to_string()
    };
    let beats = told(include_str!("../reference/lopsided/beats.toml"), 1000);
    has(&beats, "not measured in this run: too few were seen");
    let uneven = told(include_str!("../reference/lopsided/uneven.toml"), 3999);
    has(
        &uneven,
        "not measured in this run: its swings are too uneven",
    );

    let free = summary(&preset("torque-free", &[])).to_string();
    has(&free, "nutation      none by theory, none in this run");
    let cusps = summary(&preset("cusps", &[])).to_string();
    has(
        &cusps,
        "precession    0.886033 rad/s by theory, 0.886033 +- ",
    );
    has(&cusps, "nutation      0.822521 s by theory, 0.822521 +- ");
}

/// Returns the difference from theory and its tolerance.
fn off(measured: Option<MeasuredNumber>, theory: f64, scheme: f64) -> (f64, f64) {
    let measured = measured.unwrap();
    let allowed = 5.0 * measured.uncertainty + scheme * theory.abs();
    ((measured.value - theory).abs(), allowed)
}

fn measurement_is_theory(name: &str, scenario: &Arc<Scenario>, scheme: f64) {
    let theory = theory(scenario, 0.0).unwrap();
    let (_, monitor) = play_monitored(scenario);
    let instruments = monitor.instruments;
    let period = theory.nutation_period_s;
    let Some(period) = period.filter(|_| theory.path != AxlePath::Circle) else {
        assert!(instruments.nutation_period_s().is_err(), "{name}");
        let measured = instruments.precession_rad_per_s().unwrap();
        let (off, rate) = (measured.value - theory.precession.unwrap(), measured.value);
        assert!(measured.uncertainty > 0.0 && measured.nutations == 0);
        let allowed = 5.0 * measured.uncertainty + scheme * rate.abs();
        assert!(off.abs() < allowed, "{name}: {off}");
        return;
    };
    let nutation = off(instruments.nutation_period_s().ok(), period, scheme);
    let predicted = theory.precession.unwrap();
    let precession = off(instruments.precession_rad_per_s(), predicted, scheme);
    assert!(nutation.0 < nutation.1, "{name}: {nutation:?}");
    assert!(precession.0 < precession.1, "{name}: {precession:?}");
}

#[test]
fn measurements_of_the_exact_motion_agree_with_theory() {
    let names = table()
        .map(|row| row.name)
        .chain(["torque-free", "fast-top"]);
    for name in names {
        let scenario = preset(name, &[]);
        let step = scenario.motion.time_step_s;
        for scheme in ["exact", "srkn11b"] {
            let scenario = resampled(&scenario, step, SchemeInfo::find(scheme).unwrap());
            measurement_is_theory(name, &Arc::new(scenario), 1e-13);
        }
        // The shipped rk4 runs lag by psi^4/120 per radian and are damped by psi^5/144 per step, where psi is the turn in
        // a time step.
        let shipped = preset(name, &[]);
        let psi = shipped.start.momentum.norm() / 3.2 * step;
        measurement_is_theory(name, &shipped, psi.powi(4) / 24.0);
    }
}

#[test]
fn uncertainties_are_right_with_few_steps_per_nutation() {
    let exact = SchemeInfo::find("exact").unwrap();
    // For nutation and for precession.
    let (mut worst, mut precise) = ([0.0_f64; 2], [0; 2]);
    for (name, cases) in [
        ("cusps", 50),
        ("loops", 50),
        ("waves", 50),
        ("sleeping", 30),
    ] {
        for k in 0..=cases {
            let dt = 0.02 + 0.23 * f64::from(k) / f64::from(cases);
            let scenario = preset(name, &["motion.steps=60000"]);
            let scenario = Arc::new(resampled(&scenario, dt, exact));
            let theory = theory(&scenario, 0.0).unwrap();
            let (_, monitor) = play_monitored(&scenario);
            let instruments = monitor.instruments;
            let measured = [
                instruments.nutation_period_s().ok(),
                instruments.precession_rad_per_s(),
            ];
            let known = [theory.nutation_period_s, theory.precession];
            for which in [0, 1] {
                let (measured, known) = (measured[which].unwrap(), known[which].unwrap());
                let errors = (measured.value - known).abs() / measured.uncertainty;
                worst[which] = worst[which].max(errors);
                precise[which] += usize::from(measured.uncertainty < 1e-3 * known);
            }
        }
    }
    println!("at most {worst:?} standard errors; {precise:?} of 184 known to a thousandth");
    for which in [0, 1] {
        assert!(worst[which] < 5.0, "honest");
        assert!(
            worst[which] > 0.2 && precise[which] > 80,
            "uncertainties not too large"
        );
    }
}

#[test]
fn uncertainties_match_repeated_measurements() {
    // An aliased run, and one without any period: both halves must agree within their uncertainties.
    let aliased = preset("method-2", &["motion.steps=4600"]);
    let motion = [
        "motion.steps=200000",
        "motion.scheme=srkn11b",
        "motion.time_step_s=0.01",
    ];
    let lopsided = preset("cusps", &[&LOPSIDED[..], &motion].concat());
    for scenario in [aliased, lopsided] {
        let mut simulation = Simulation::new(Arc::clone(&scenario));
        let halves = [1, 2].map(|half| {
            let mut monitor = Monitor::new(simulation.now());
            while simulation.step_number() < half * scenario.steps / 2 {
                simulation.step().unwrap();
                monitor.record(simulation.now());
            }
            let instruments = monitor.instruments;
            [
                instruments.nutation_period_s().unwrap(),
                instruments.precession_rad_per_s().unwrap(),
            ]
        });
        for (a, b) in halves[0].iter().zip(&halves[1]) {
            let apart = (a.value - b.value).abs() / a.uncertainty.hypot(b.uncertainty);
            println!("{a:?}, {b:?}: {apart} standard errors apart");
            assert!(apart < 5.0, "{a:?} {b:?}");
        }
    }
}

/// The Heidelberg ball with `moments` about its center, g m².
fn ball(moments: [f64; 3]) -> Arc<Scenario> {
    let moments = moments.map(|moment| 1e-3 * moment);
    let moments = format!("body.part.0.moments_kg_m2={moments:?}");
    preset(
        "heidelberg",
        &[
            &moments,
            "start.steady=false",
            "start.tilt_deg=70",
            "motion.steps=3000",
        ],
    )
}

#[test]
fn theory_of_a_nearly_symmetric_body_uses_its_mean_moment() {
    for [a, b] in [[4.0, 4.001], [4.01, 4.0], [4.0, 4.04]] {
        let scenario = ball([a, b, 3.0]);
        let (simulation, mut monitor) = play_monitored(&scenario);
        let theory = monitor.theory(simulation.now().time_s()).unwrap();
        // The weight adds 0.00985 kg at 15.55 cm along the axle.
        let weight = 0.00985 * 0.1555 * 0.1555 * 1e3;
        let asymmetry = (a - b).abs() / (0.5 * (a + b) + weight);
        close("asymmetry", theory.asymmetry, asymmetry, 1e-12);
        let mean = followed_theory(&ball([0.5 * (a + b), 0.5 * (a + b), 3.0]));
        assert_eq!((mean.asymmetry, mean.path), (0.0, theory.path));
        let instruments = &monitor.instruments;
        for (what, predicted, of_mean, measured) in [
            (
                "precession",
                theory.precession,
                mean.precession,
                instruments.precession_rad_per_s(),
            ),
            (
                "nutation",
                theory.nutation_period_s,
                mean.nutation_period_s,
                instruments.nutation_period_s().ok(),
            ),
        ] {
            let (predicted, measured) = (predicted.unwrap(), measured.unwrap());
            close(what, predicted, of_mean.unwrap(), 1e-9 * predicted.abs());
            let within = 0.5 * asymmetry * predicted.abs() + 5.0 * measured.uncertainty;
            close(what, measured.value, predicted, within);
        }
        let extremes = monitor.extremes.tilt;
        let (low, high) = theory.tilt_range_deg;
        let within = 1.5 * asymmetry.to_degrees();
        close("lowest tilt", extremes.lowest_deg, low, within);
        close("highest tilt", extremes.highest_deg, high, within);
    }
    let text = summary(&ball([4.0, 4.01, 3.75])).to_string();
    has(&text, "0.24 %; theory uses the mean moment across the axle");
    has_no(&text, "none by theory");
}

fn followed_theory(scenario: &Arc<Scenario>) -> Theory {
    theory(scenario, 0.0).unwrap()
}

#[test]
fn there_is_no_theory_for_a_large_asymmetry() {
    let has_theory = |moments| theory(&ball(moments), 0.0).is_some();
    assert!(has_theory([4.0, 4.042, 3.0]) && !has_theory([4.0, 4.044, 3.0]));
    // The moment along the axle is between the other two, or close to them.
    assert!(!has_theory([4.0, 4.01, 4.24]) && !has_theory([4.0, 4.01, 4.2]));
    // A mass off the axle by 1e-7 and by 10 % of the radius of gyration.
    let aside = |x: &str| preset("cusps", &["body.point.2.mass_kg=0.5", x]);
    let aside = |x: &str| theory(&aside(&format!("body.point.2.at_m=[{x},0,0]")), 0.0);
    assert!(aside("1e-6").unwrap().asymmetry > 0.0);
    assert!(aside("0.3").is_none());
    assert_eq!(aside("0").unwrap().asymmetry, 0.0);
}
