//! Figures of runs and tables: the contents of the page and their positions.

use crate::support::scenarios::preset;
use crate::support::words::has;
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::plot::chart::{Chart, ChartAxis, ChartSeries, EXACT_COLOR, Panel, SeriesStyle};
use gyrolab::plot::ink::WHITE;
use gyrolab::plot::{PageFormat, PageScene, Paint, Point, SceneItem, write};
use gyrolab::report::figure::course::{RunSampler, SampleRequest, SampledRun};
use gyrolab::report::figure::kind::{FIGURE_KIND_NAMES, FigureKind, RESIDUALS};
use gyrolab::report::figure::labels::FigureLabels;
use gyrolab::report::figure::of_runs::{self, DrawnFigure, FigureRun, KnownNumbers};
use gyrolab::report::figure::of_table::{self, TableKind, TableView};
use gyrolab::report::figure::{FigureSource, FigureSpec};
use gyrolab::studies::table::TableSource;
use nalgebra::Vector3;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Width of a page of 86 mm, pt.
const COLUMN_PT: f64 = 86.0 * 72.0 / 25.4;
/// Number of steps of a preset that is enough for its figure in a test.
const STEPS: u64 = 250;

fn scenario(name: &str, set: &[&str]) -> Arc<Scenario> {
    Arc::new(preset(name, set))
}

pub(crate) fn run(preset: &str, set: &[&str]) -> FigureRun {
    FigureRun {
        scenario: scenario(preset, set),
        named: preset.to_owned(),
    }
}

pub(crate) fn spec(kind: &str) -> FigureSpec {
    FigureSpec {
        kind: Some(kind.to_owned()),
        ..FigureSpec::default()
    }
}

/// A figure of the given kind with the exact motion.
pub(crate) fn with_exact(kind: &str) -> FigureSpec {
    FigureSpec {
        exact: true,
        ..spec(kind)
    }
}

fn source(runs: &[FigureRun], spec: &FigureSpec) -> FigureSource {
    FigureSource {
        spec: spec.clone(),
        runs: runs.to_vec(),
        ..FigureSource::default()
    }
}

fn go_on(_: u64, _: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

pub(crate) fn drawn(runs: &[FigureRun], spec: &FigureSpec) -> DrawnFigure {
    source(runs, spec).draw(go_on).unwrap().unwrap()
}

pub(crate) fn refusal(runs: &[FigureRun], spec: &FigureSpec) -> String {
    source(runs, spec).draw(go_on).unwrap_err()
}

/// Returns all remarks on a figure.
fn told(figure: &DrawnFigure) -> Vec<String> {
    figure.told().map(|told| told.to_string()).collect()
}

pub(crate) fn least(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(f64::INFINITY, f64::min)
}

pub(crate) fn most(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the left, upper, right and lower end of all lines in a panel.
pub(crate) fn extent_of_lines(scene: &PageScene, panel: [Point; 2]) -> [f64; 4] {
    let ends: Vec<_> = lines(scene, panel).into_iter().map(extent).collect();
    let side = |side: usize| ends.iter().map(move |end| end[side]);
    [least(side(0)), least(side(1)), most(side(2)), most(side(3))]
}

/// Returns the position of the traced point after each step of the run.
fn places(run: &FigureRun) -> Vec<Vector3<f64>> {
    let mut simulation = Simulation::new(Arc::clone(&run.scenario));
    let mut seen = vec![*simulation.now().position()];
    while simulation.step_number() < run.scenario.steps {
        seen.push(*simulation.step().unwrap().position());
    }
    seen
}

pub(crate) fn words(scene: &PageScene) -> Vec<&str> {
    let words = scene.items.iter().filter_map(|item| item.words.as_ref());
    words.map(|words| words.text.as_str()).collect()
}

#[track_caller]
pub(crate) fn says(scene: &PageScene, wanted: &[&str]) {
    let words = words(scene);
    for one in wanted {
        assert!(words.contains(one), "{one} is not among {words:?}");
    }
}

/// Returns the left, upper, right and lower end of the visible part of an item.
fn extent(item: &SceneItem) -> [f64; 4] {
    let x = || item.path.points().map(|p| p.x);
    let y = || item.path.points().map(|p| p.y);
    let all = [least(x()), least(y()), most(x()), most(y())];
    match item.clip {
        None => all,
        Some([a, b]) => [
            all[0].max(a.x),
            all[1].max(a.y),
            all[2].min(b.x),
            all[3].min(b.y),
        ],
    }
}

/// Checks that nothing leaves the page and no labels overlap.
pub(crate) fn check_overlaps(scene: &PageScene) -> Result<(), String> {
    let mut texts: Vec<(&str, [f64; 4])> = Vec::new();
    for item in &scene.items {
        let here = extent(item);
        let [left, top, right, bottom] = here;
        if item.path.0.is_empty() || (left > right && item.clip.is_some()) {
            continue;
        }
        let is_inside = left >= -0.01
            && top >= -0.01
            && right <= scene.width_pt + 0.01
            && bottom <= scene.height_pt + 0.01;
        if !is_inside {
            return Err(format!("{:?} leaves the page: {here:?}", item.words));
        }
        let Some(words) = &item.words else { continue };
        let word = words.text.as_str();
        for (other, there) in &texts {
            let apart =
                right <= there[0] || there[2] <= left || bottom <= there[1] || there[3] <= top;
            if !apart {
                return Err(format!("{word} stands upon {other}"));
            }
        }
        texts.push((word, here));
    }
    Ok(())
}

/// Returns the clip rectangles: one per panel.
pub(crate) fn panels(scene: &PageScene) -> Vec<[Point; 2]> {
    let mut clips: Vec<[Point; 2]> = Vec::new();
    for clip in scene.items.iter().filter_map(|item| item.clip) {
        if !clips.contains(&clip) {
            clips.push(clip);
        }
    }
    clips
}

/// Returns the lines in a panel.
pub(crate) fn lines(scene: &PageScene, panel: [Point; 2]) -> Vec<&SceneItem> {
    let is_line =
        |item: &&SceneItem| item.clip == Some(panel) && matches!(item.paint, Paint::Stroke(_));
    scene.items.iter().filter(is_line).collect()
}

/// Returns the indices of the dashed lines of the exact motion.
fn exact_lines(scene: &PageScene) -> Vec<usize> {
    let is_exact = |item: &SceneItem| match &item.paint {
        Paint::Stroke(pen) => {
            item.clip.is_some() && pen.color == EXACT_COLOR && !pen.dash_pt.is_empty()
        }
        Paint::Fill(_) => false,
    };
    let items = scene.items.iter().enumerate();
    let lines = items.filter(|(_, item)| is_exact(item));
    lines.map(|(index, _)| index).collect()
}

#[test]
fn every_preset_has_a_figure_of_every_kind_without_overlaps() {
    for name in PRESETS.iter().map(|preset| preset.name) {
        let steps = scenario(name, &[]).steps.min(STEPS);
        let runs = [run(name, &[&format!("motion.steps={steps}")])];
        // Residuals need measured data.
        let kinds = FIGURE_KIND_NAMES
            .into_iter()
            .filter(|kind| *kind != RESIDUALS);
        for kind in kinds.chain(["tilt_deg", "energy_J,Lx_Js,azimuth_deg,step,segment"]) {
            for (width_mm, exact) in [(178.0, true), (40.0, false)] {
                let asked = FigureSpec {
                    exact,
                    width_pt: Some(width_mm * 72.0 / 25.4),
                    ..spec(kind)
                };
                let figure = drawn(&runs, &asked);
                check_overlaps(&figure.scene)
                    .unwrap_or_else(|why| panic!("{name} {kind} {width_mm}: {why}"));
                assert!(
                    !write(&figure.scene, PageFormat::Svg, None)
                        .unwrap()
                        .is_empty()
                );
            }
        }
    }
}

#[test]
fn traces_show_x_y_and_z_with_units_and_every_extreme() {
    let runs = [run("wobble-push", &[])];
    let figure = drawn(&runs, &spec("traces"));
    let axes = ["x (m)", "y (m)", "z (m)", "t (s)"];
    says(&figure.scene, &axes);
    says(&figure.scene, &["0", "200", "−1.0", "0.8"]);
    let panels = panels(&figure.scene);
    assert_eq!(panels.len(), 3);
    let left = panels[0][0].x;
    assert!(
        panels.iter().all(|panel| panel[0].x == left),
        "a common left edge"
    );
    let seen = places(&runs[0]);
    for (axis, [top_left, bottom_right]) in panels.into_iter().enumerate() {
        let values = || seen.iter().map(|position| position[axis]);
        let (least, most) = (least(values()), most(values()));
        let (low, high) = ChartAxis::default().range_of(values());
        let place = |value: f64| {
            bottom_right.y - (value - low) / (high - low) * (bottom_right.y - top_left.y)
        };
        let panel = [top_left, bottom_right];
        let [_, top, _, bottom] = extent_of_lines(&figure.scene, panel);
        assert!((top - place(most)).abs() < 1e-6, "{top} {axis}");
        assert!((bottom - place(least)).abs() < 1e-6, "{bottom} {axis}");
    }
}

#[test]
fn a_path_from_above_has_equal_scales() {
    let runs = [run("cusps", &[])];
    let figure = drawn(&runs, &spec("above"));
    says(&figure.scene, &["x (m)", "y (m)"]);
    let panels = panels(&figure.scene);
    assert_eq!(panels.len(), 1);
    // The axes include the origin.
    let mut seen = places(&runs[0]);
    seen[0] = Vector3::zeros();
    let [wide, high] = [0, 1].map(|axis| {
        let values = || seen.iter().map(|at| at[axis]);
        most(values()) - least(values())
    });
    let [left, top, right, bottom] = extent_of_lines(&figure.scene, panels[0]);
    let (across, up) = ((right - left) / wide, (bottom - top) / high);
    assert!((across / up - 1.0).abs() < 2e-3, "{across} {up}");
}

#[test]
fn a_path_in_space_has_three_axes_and_a_shadow() {
    let figure = drawn(&[run("cusps", &[])], &spec("3d"));
    says(&figure.scene, &["x (m)", "y (m)", "z (m)"]);
    let greys: BTreeSet<u8> = figure
        .scene
        .items
        .iter()
        .filter_map(|item| match &item.paint {
            Paint::Stroke(pen) if item.path.0.len() > 20 => Some(pen.color.0[0]),
            _ => None,
        })
        .collect();
    assert!(greys.len() >= 5, "depths and a shadow: {greys:?}");
}

#[test]
fn the_exact_motion_is_dashed_and_drawn_over_every_run() {
    for (preset, step) in [("wobble-push", "0.1"), ("cusps", "0.01")] {
        let set = format!("motion.time_step_s={step}");
        let runs = [run(preset, &["motion.steps=400", &set])];
        let scene = drawn(&runs, &with_exact("z_m")).scene;
        says(&scene, &["exact motion"]);
        let panel = scene.items[exact_lines(&scene)[0]].clip.unwrap();
        let all = lines(&scene, panel);
        let widths: Vec<f64> = all
            .iter()
            .filter_map(|item| match &item.paint {
                Paint::Stroke(pen) if pen.color != WHITE => Some(pen.width_pt),
                _ => None,
            })
            .collect();
        assert!(widths.iter().all(|width| *width == widths[0]), "{widths:?}");
        let is_dashed =
            |item: &SceneItem| matches!(&item.paint, Paint::Stroke(pen) if !pen.dash_pt.is_empty());
        assert!(
            is_dashed(all.last().unwrap()),
            "{preset}: the exact motion is on top"
        );
        assert!(!is_dashed(all[0]), "{preset}: the run is solid");
    }
}

#[test]
fn coinciding_runs_are_one_line_with_both_names() {
    let [rk4, strang] = ["rk4", "strang"].map(|scheme| {
        let set = format!("motion.scheme=\"{scheme}\"");
        run("cusps", &["motion.steps=500", &set])
    });
    let far = run("loops", &["motion.steps=500"]);
    let runs = [rk4, strang, far];
    let scene = drawn(&runs, &spec("z_m,tilt_deg")).scene;
    says(&scene, &["Cusps, rk4 and Cusps, strang"]);
    let apart = drawn(&runs[1..], &spec("z_m,tilt_deg")).scene;
    assert!(!words(&apart).iter().any(|word| word.contains(" and ")));
}

#[test]
fn runs_of_one_preset_are_named_after_differing_settings() {
    let tilted = |tilt: &str| {
        run(
            "cusps",
            &["motion.steps=20", &format!("start.tilt_deg={tilt}")],
        )
    };
    let runs = [tilted("20"), tilted("30"), tilted("40")];
    let scene = drawn(&runs, &spec("tilt_deg")).scene;
    says(&scene, &["θ₀ = 20°", "θ₀ = 30°", "θ₀ = 40°"]);
    // Runs without any difference have the names that the user typed.
    let same = [tilted("20"), tilted("20")];
    says(&drawn(&same, &spec("tilt_deg")).scene, &["cusps"]);
}

#[test]
fn the_duration_of_a_push_is_shaded_and_labeled_once() {
    let push = |preset: &str| {
        let scene = drawn(&[run(preset, &["motion.steps=400"])], &with_exact("traces")).scene;
        words(&scene).iter().filter(|word| **word == "push").count()
    };
    assert_eq!(push("wobble-push"), 1);
    assert_eq!(push("method-2"), 0);
}

#[test]
fn a_path_with_fewer_than_two_steps_per_turn_is_drawn_as_points() {
    for kind in ["above", "3d"] {
        // The body turns by 4.5 rad in a step.
        let runs = [run(
            "method-1",
            &["motion.steps=200", "motion.time_step_s=0.007"],
        )];
        let coarse = drawn(&runs, &with_exact(kind));
        let name = "the report's scheme, Δt = 7 ms, every step";
        says(&coarse.scene, &[name, "exact motion"]);
        has(told(&coarse).join("; "), "time steps per turn");
        // Nothing is drawn between steps.
        let is_dot = |item: &&SceneItem| matches!(&item.paint, Paint::Stroke(pen) if pen.width_pt >= 0.5 && pen.dash_pt.is_empty());
        let dots = coarse
            .scene
            .items
            .iter()
            .filter(is_dot)
            .map(extent)
            .filter(|[left, top, right, bottom]| right - left < 0.03 && bottom - top < 0.03);
        assert!(dots.count() >= 200, "{kind}");
        let fine = drawn(&[run("cusps", &[])], &with_exact(kind));
        says(&fine.scene, &["rk4, Δt = 1 ms", "exact motion"]);
        assert_eq!(fine.told().next(), None);
    }
}

#[test]
fn the_label_of_the_limit_circles_covers_none_of_them() {
    for preset in ["method-1", "cusps"] {
        let runs = [run(preset, &["motion.steps=300"])];
        let figure = drawn(&runs, &with_exact("above"));
        says(&figure.scene, &["limits of exact motion"]);
        let circles: Vec<_> = figure
            .scene
            .items
            .iter()
            .filter(|item| {
                item.clip.is_some()
                    && matches!(item.paint, Paint::Stroke(ref pen) if pen.width_pt == 0.4)
            })
            .collect();
        assert!(!circles.is_empty(), "{preset}");
        for legend in figure
            .scene
            .items
            .iter()
            .filter(|item| matches!(item.paint, Paint::Fill(color) if color == WHITE))
            .map(extent)
            // not the mark at the start, which is on a limit of method-1
            .filter(|[left, _, right, _]| right - left > 10.0)
        {
            for circle in &circles {
                assert!(
                    !circle.path.points().any(|p| {
                        (legend[0]..=legend[2]).contains(&p.x)
                            && (legend[1]..=legend[3]).contains(&p.y)
                    }),
                    "{preset}"
                );
            }
        }
    }
}

#[test]
fn a_run_of_the_exact_motion_is_not_drawn_twice() {
    let exact = run("cusps", &["motion.scheme=\"exact\""]);
    let asked = with_exact("tilt_deg");
    let figure = drawn(std::slice::from_ref(&exact), &asked);
    assert!(
        exact_lines(&figure.scene).is_empty(),
        "the run is the only curve"
    );
    says(&figure.scene, &["exact motion"]);
    let [only] = &told(&figure)[..] else {
        panic!("{:?}", told(&figure))
    };
    has(only, "exact motion itself");
    // With another scheme, it is the exact motion of both runs and has its own curve.
    let both = drawn(&[run("cusps", &[]), exact], &asked);
    assert_eq!(exact_lines(&both.scene).len(), 1);
}

#[test]
fn the_3d_figure_states_the_stretch_of_z() {
    let stretched = |preset: &str| {
        let figure = drawn(&[run(preset, &[])], &spec("3d"));
        check_overlaps(&figure.scene).unwrap();
        let mut words = words(&figure.scene).into_iter();
        let stretched = words.find(|words| words.starts_with("z stretched"));
        stretched.map(str::to_owned)
    };
    assert_eq!(stretched("cusps").as_deref(), Some("z stretched 13-fold"));
    assert!(stretched("fast-top").is_some());
}

#[test]
fn several_runs_are_named_after_their_differences() {
    let figure = |runs: &[FigureRun]| drawn(runs, &spec("z_m")).scene;
    let cusps = |set: &str| run("cusps", &[set, "motion.steps=300"]);
    let schemes = ["report", "rk4"].map(|name| cusps(&format!("motion.scheme={name}")));
    let schemes = figure(&schemes);
    says(&schemes, &["the report's scheme", "rk4"]);
    assert!(!words(&schemes).iter().any(|word| word.contains('Δ')));
    let steps = [0.001, 0.01].map(|dt| cusps(&format!("motion.time_step_s={dt}")));
    says(&figure(&steps), &["Δt = 1 ms", "Δt = 10 ms"]);
    let titles = ["waves", "loops"].map(|name| run(name, &["motion.steps=300"]));
    let two = figure(&titles);
    let names = words(&two);
    for run in &titles {
        let begin: String = run.scenario.file.title.chars().take(4).collect();
        let is_named = names.iter().any(|word| word.starts_with(&begin));
        assert!(is_named, "{begin} {names:?}");
    }
}

#[test]
fn a_time_range_is_drawn_and_one_outside_the_run_is_rejected() {
    let runs = [run("wobble-push", &[])];
    let part = |from_s: f64, to_s: Option<f64>| FigureSpec {
        from_s,
        to_s,
        ..spec("z_m")
    };
    let figure = drawn(&runs, &part(50.0, Some(60.0)));
    says(&figure.scene, &["50", "60"]);
    let panel = panels(&figure.scene)[0];
    let [left, _, right, _] = extent_of_lines(&figure.scene, panel);
    assert!((left - panel[0].x).abs() < 0.01 && (right - panel[1].x).abs() < 0.01);
    for (from_s, to_s, words) in [
        (230.0, None, "230 s"),
        (20.0, Some(10.0), "--to 10"),
        (10.0, Some(10.0), "--to 10"),
        // A range between two steps contains nothing to draw.
        (0.01, Some(0.02), "no step"),
    ] {
        has(refusal(&runs, &part(from_s, to_s)), words);
    }
}

#[test]
fn a_run_of_one_step_has_a_figure() {
    let runs = [run("method-2", &["motion.steps=1"])];
    for kind in ["traces", "above", "3d"] {
        let figure = drawn(&runs, &spec(kind));
        check_overlaps(&figure.scene).unwrap();
        write(&figure.scene, PageFormat::Svg, None).unwrap();
    }
}

#[test]
fn a_constant_curve_has_an_axis_with_room() {
    let figure = drawn(&[run("torque-free", &[])], &spec("Lz_Js"));
    check_overlaps(&figure.scene).unwrap();
    assert!(words(&figure.scene).len() > 6);
}

/// The axle of this wheel is level, so z is zero up to rounding.
#[test]
fn rounding_noise_is_drawn_as_a_flat_line() {
    let runs = [run("heidelberg", &["motion.steps=2000"])];
    for kind in ["z_m", "traces", "3d"] {
        let figure = drawn(&runs, &spec(kind));
        assert_eq!(figure.told().next(), None, "{kind}");
        says(&figure.scene, &["z (m)"]);
        let [.., last] = panels(&figure.scene)[..] else {
            assert_eq!(kind, "3d");
            continue;
        };
        for line in lines(&figure.scene, last) {
            let [_, top, _, bottom] = extent(line);
            assert!(bottom - top < 1e-6, "{kind}: {top} {bottom}");
        }
    }
    let upright = [run("heidelberg", &["start.tilt_deg=0", "motion.steps=200"])];
    let figure = drawn(&upright, &spec("above"));
    says(&figure.scene, &["x (m)", "y (m)"]);
}

#[test]
fn an_unresolved_figure_suggests_a_time_range_that_is_resolved() {
    for (name, kind) in [
        ("method-1", "traces"),
        ("method-2-slow", "3d"),
        ("fast-top", "3d"),
    ] {
        let runs = [run(name, &[])];
        let figure = drawn(&runs, &spec(kind));
        let told = |drawing: &DrawnFigure| -> Vec<String> {
            let mut told = told(drawing);
            told.retain(|told| !told.contains("not joined"));
            told
        };
        let [warning] = &told(&figure)[..] else {
            panic!("{name} {kind}: {:?}", figure.warnings)
        };
        has(&warning, "too dense");
        let (_, proposed) = warning.split_once("--to ").unwrap();
        let to_s: f64 = proposed.split(' ').next().unwrap().parse().unwrap();
        let part = FigureSpec {
            to_s: Some(to_s),
            ..spec(kind)
        };
        assert!(told(&drawn(&runs, &part)).is_empty(), "{name} {kind}");
    }
    for (name, kind) in [
        ("wobble-push", "traces"),
        ("wobble-push", "3d"),
        ("cusps", "above"),
        ("cusps", "3d"),
    ] {
        let figure = drawn(&[run(name, &[])], &spec(kind));
        assert_eq!(figure.dense, None, "{name} {kind}");
    }
}

#[test]
fn indistinguishable_curves_are_bands_next_to_a_magnified_range() {
    let runs = [run("method-1", &[])];
    let scene = drawn(&runs, &with_exact("traces")).scene;
    check_overlaps(&scene).unwrap();
    let run = "the report's scheme, Δt = 1 ms";
    says(
        &scene,
        &[run, "exact motion", "right: 0 to 0.1 s, magnified"],
    );
    let panels = panels(&scene);
    assert_eq!(panels.len(), 6);
    let seen = places(&runs[0]);
    for (axis, panel) in panels[..3].iter().enumerate() {
        // The edges of the band are the extremes at any length.
        let bands: Vec<_> = scene
            .items
            .iter()
            .filter(|item| item.clip == Some(*panel) && matches!(item.paint, Paint::Fill(_)))
            .collect();
        assert_eq!(bands.len(), 2);
        let values = || seen.iter().map(|place| place[axis]);
        let (low, high) = ChartAxis::default().range_of(values());
        let [_, top, _, bottom] = extent(bands[1]);
        let is_whole = (bottom - top) / (panel[1].y - panel[0].y);
        let share = (most(values()) - least(values())) / (high - low);
        assert!((is_whole / share - 1.0).abs() < 0.01, "{is_whole} {share}");
        // Lines of the magnified range have the same axis and more than a few points.
        let beside = panels[axis + 3];
        assert_eq!((beside[0].y, beside[1].y), (panel[0].y, panel[1].y));
        let points = lines(&scene, beside);
        assert!(points.iter().map(|line| line.path.0.len()).sum::<usize>() > 300);
    }
}

#[test]
fn the_exact_motion_is_drawn_between_its_steps() {
    let set = ["motion.scheme=exact", "motion.steps=2300"];
    let figure = drawn(&[run("method-2", &set)], &spec("tilt_deg"));
    // Its nutation of 0.0201 s must not appear as a swing of 3.85 s.
    let told = told(&figure).join("; ");
    has(told, "about 11");
    assert!(figure.dense.unwrap().to_s <= 0.5);
}

#[test]
fn labels_and_axes_can_be_chosen() {
    let runs = [
        run("cusps", &["motion.steps=300"]),
        run("loops", &["motion.steps=300"]),
    ];
    let own = FigureLabels {
        title: Some("Two tops_1".to_owned()),
        names: ["first", "second"].map(str::to_owned).to_vec(),
        x: Some("time in s".to_owned()),
        y: vec!["height in m".to_owned()],
        is_log: [true, true],
        y_range: Some((0.5, 2.0)),
        ..FigureLabels::default()
    };
    let asked = |kind: &str, labels: &FigureLabels| FigureSpec {
        labels: labels.clone(),
        ..spec(kind)
    };
    let figure = drawn(&runs, &asked("z_m", &own));
    check_overlaps(&figure.scene).unwrap();
    let labels = [
        "Two tops_1",
        "first",
        "second",
        "time in s",
        "height in m",
        "10⁻¹",
    ];
    says(&figure.scene, &labels);
    assert_eq!(figure.scene.title, "Two tops_1");
    has(told(&figure).join(""), "no place on a logarithmic axis");
    let text = String::from_utf8(write(&figure.scene, PageFormat::SvgText, None).unwrap()).unwrap();
    assert!(text.contains(">height in m</tspan>") && text.contains("serif"));
    let many = FigureLabels {
        y: vec![String::new(); 2],
        ..FigureLabels::default()
    };
    let log = FigureLabels {
        is_log: [false, true],
        ..FigureLabels::default()
    };
    let below = FigureLabels {
        y_range: Some((-1.0, 1.0)),
        ..log.clone()
    };
    let empty = FigureLabels {
        y_range: Some((5.0, 6.0)),
        ..FigureLabels::default()
    };
    let unknown = FigureLabels {
        y_ranges: [("w_m".to_owned(), (0.0, 1.0))].into(),
        ..FigureLabels::default()
    };
    for (kind, given, words) in [
        (
            "z_m",
            &empty,
            "--y-range 5..6 shows nothing: the values of z_m are from ",
        ),
        (
            "x_m,z_m",
            &unknown,
            "has no panel of that name, but x_m, z_m",
        ),
        ("z_m", &many, "--y-label is given 2 times"),
        ("above", &log, "not for a path from above"),
        ("3d", &log, "not for a path in space"),
        ("z_m", &below, "begins above 0"),
    ] {
        has(refusal(&runs, &asked(kind, given)), words);
    }
}

#[test]
fn figures_warn_about_unreliable_runs() {
    let early = FigureSpec {
        to_s: Some(40.0),
        ..spec("traces")
    };
    has(
        told(&drawn(&[run("wobble-push", &[])], &early)).join(""),
        "off the exact motion in the first 40 s;",
    );
    let runs = [run("wobble-push", &[]), run("cusps", &[])];
    for asked in [spec("traces"), spec("above"), with_exact("tilt_deg")] {
        let told = told(&drawn(&runs, &asked));
        let [only] = &told[..] else {
            panic!("{told:?}")
        };
        let begin = "do not believe wobble-push with the scheme report at 0.1 s: its traced point is up to 0.389 m (34.4 % of its arm)";
        assert!(only.starts_with(begin), "{only}");
        assert_eq!(only.contains("--exact draws that"), !asked.exact);
    }
}

#[test]
fn figures_warn_about_too_few_steps_per_nutation() {
    let told = |time_step: &str, kind: &str| {
        let set = [time_step, "motion.steps=500", "motion.scheme=exact"];
        told(&drawn(&[run("fast-top", &set)], &spec(kind)))
    };
    let begin = "fast-top has 4.16 time steps in a nutation of 0.0831 s: ";
    let few = |time_step: &str, kind: &str| {
        let mut all = told(time_step, kind).into_iter();
        all.find(|warning| warning.starts_with(begin))
    };
    let only = few("motion.time_step_s=0.02", "tilt_deg,step").unwrap();
    has(only, "; a time step of 0.002 s would show the nutation");
    assert_eq!(few("motion.time_step_s=0.001", "tilt_deg,step"), None);
    // The exact motion is known between its steps, so its curves show the nutation, except the curve of `step`.
    assert_eq!(few("motion.time_step_s=0.02", "tilt_deg"), None);
}

#[test]
fn twelve_curves_are_distinct_and_thirteen_are_rejected() {
    let set = |tilt: usize| {
        run(
            "cusps",
            &["motion.steps=20", &format!("start.tilt_deg={tilt}")],
        )
    };
    let runs: Vec<FigureRun> = (20..33).map(set).collect();
    let styles: BTreeSet<String> = (0..12)
        .map(|index| {
            let style = SeriesStyle::curve(index, 12);
            format!("{:?} {:?}", style.color, style.dash_pt)
        })
        .collect();
    assert_eq!(styles.len(), 12, "in color");
    let marks: BTreeSet<String> = (0..12)
        .map(|index| format!("{:?}", SeriesStyle::curve(index, 12).sparse_mark.unwrap()))
        .collect();
    assert_eq!(marks.len(), 12, "in gray");
    assert!(
        drawn(&runs[..12], &spec("tilt_deg"))
            .told()
            .next()
            .is_none()
    );
    let refused = refusal(&runs, &spec("tilt_deg"));
    has(refused, "13 curves: a figure shows at most 12");
}

#[test]
fn an_error_in_the_last_digits_is_drawn_as_a_flat_line() {
    // A steady precession keeps its tilt; the scheme changes only its tenth digit.
    let runs = [run("steady-slow", &[])];
    for kind in ["tilt_deg", "3d", "traces"] {
        let figure = drawn(&runs, &spec(kind));
        let words = words(&figure.scene);
        assert!(!words.iter().any(|word| word.contains("10⁻")), "{words:?}");
    }
}

#[test]
fn the_exact_motion_is_smooth_even_with_few_steps() {
    let asked = FigureSpec {
        from_s: 0.5,
        to_s: Some(0.52),
        ..with_exact("z_m")
    };
    let figure = drawn(&[run("method-1", &[])], &asked);
    let exact = exact_lines(&figure.scene)
        .into_iter()
        .map(|index| &figure.scene.items[index]);
    // 0.02 s are two nutations with 20 steps in all.
    let points: usize = exact.map(|line| line.path.points().count()).sum();
    assert!(points > 200, "{points}");
}

#[test]
fn figures_drawn_together_equal_those_drawn_alone() {
    let runs = [run("wobble-push", &[]), run("method-2", &[])];
    let part = FigureSpec {
        to_s: Some(20.0),
        ..spec("tilt_deg")
    };
    let [energy, above, traces] = ["energy_J", "above", "traces"].map(spec);
    let specs = [energy, part, above, traces];
    let sources = specs.each_ref().map(|spec| source(&runs, spec));
    let mut ends = 0;
    let together = of_runs::figures(&sources, &KnownNumbers::default(), |step, last| {
        ends += u32::from(step == last);
        ControlFlow::Continue(())
    })
    .unwrap()
    .unwrap();
    // Each run is played once in full and once for its beginning.
    assert!(ends <= 4, "{ends}");
    assert_eq!(together.len(), sources.len());
    for (figure, spec) in together.iter().zip(&specs) {
        let alone = drawn(&runs, spec);
        assert_eq!(figure.scene, alone.scene);
        assert_eq!(figure.warnings, alone.warnings);
    }
}

#[test]
fn a_run_that_breaks_down_is_drawn_up_to_that_step() {
    let push = "push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}";
    let figure = drawn(&[run("method-2", &[push])], &spec("traces"));
    let broke = figure.broke.unwrap();
    assert!(broke.contains("no longer finite at step 25"), "{broke}");
    says(&figure.scene, &["x (m)", "2.0"]);
    // If it breaks before the requested range, there is no figure.
    let late = FigureSpec {
        from_s: 10.0,
        ..spec("traces")
    };
    let refusal = refusal(&[run("method-2", &[push])], &late);
    assert!(refusal.contains("step 25"), "{refusal}");
}

/// Returns the samples of `run` that a recorder of traces, tilt and path has stored.
pub(crate) fn recorded(run: &FigureRun) -> SampledRun {
    let kinds = [FigureKind::traces(), FigureKind::named("tilt_deg").unwrap()];
    let wanted = SampleRequest {
        columns: kinds
            .iter()
            .flat_map(FigureKind::columns)
            .copied()
            .collect(),
        path: true,
        from_s: 0.0,
        to_s: None,
    };
    let mut simulation = Simulation::new(Arc::clone(&run.scenario));
    let mut recorder = RunSampler::new(&run.scenario, wanted);
    recorder.follow(simulation.now());
    for _ in 0..run.scenario.steps {
        match simulation.step() {
            Ok(step) => recorder.follow(step),
            Err(broke) => return recorder.end(Some(broke)),
        }
    }
    recorder.end(None)
}

#[test]
fn recorded_columns_are_not_recomputed() {
    let breaks = "push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}";
    for (name, set, end_s) in [
        ("wobble-push", "motion.steps=250", 25.0),
        ("method-2", breaks, 2.4),
    ] {
        let runs = [run(name, &[set])];
        let known = KnownNumbers {
            recorded: Some(recorded(&runs[0])),
            said: None,
        };
        // Only a run that was played is compared with the exact motion, and may have caveats.
        // In another order than recorded, to the end and to the time of the end.
        for (kind, to_s) in [
            ("tilt_deg,z_m", None),
            ("above", None),
            ("3d", Some(end_s)),
            ("x_m", Some(end_s)),
        ] {
            let asked = FigureSpec { to_s, ..spec(kind) };
            let sources = [source(&runs, &asked)];
            let mut calls = 0;
            let figures = of_runs::figures(&sources, &known, |_, _| {
                calls += 1;
                ControlFlow::Continue(())
            });
            let alone = drawn(&runs, &asked);
            assert_eq!(
                figures.unwrap().unwrap()[0].scene.items,
                alone.scene.items,
                "{kind}"
            );
            assert_eq!(calls, 0, "{name}: {kind} was played");
        }
        // Columns that were not recorded are computed.
        let begins_later = FigureSpec {
            from_s: 1.0,
            ..spec("z_m")
        };
        let ends_earlier = FigureSpec {
            to_s: Some(2.0),
            ..spec("z_m")
        };
        for asked in [spec("energy_J"), begins_later, ends_earlier] {
            let sources = [source(&runs, &asked)];
            let figures = of_runs::figures(&sources, &known, go_on);
            let alone = drawn(&runs, &asked);
            assert_eq!(
                figures.unwrap().unwrap()[0].scene.items,
                alone.scene.items,
                "{name}"
            );
        }
        // With two runs, the recording could belong to either.
        let two = [run("method-2", &["motion.steps=250"]), runs[0].clone()];
        let together = of_runs::figures(&[source(&two, &spec("z_m"))], &known, go_on);
        let alone = drawn(&two, &spec("z_m"));
        assert_eq!(
            together.unwrap().unwrap()[0].scene.items,
            alone.scene.items,
            "{name}"
        );
    }
}

#[test]
fn drawing_can_be_stopped() {
    let long = [run("method-2", &["motion.steps=20000"])];
    let figure = source(&long, &spec("traces")).draw(|_, _| ControlFlow::Break(()));
    assert!(figure.is_ok_and(|figure| figure.is_none()));
}

pub(crate) fn table(text: &str) -> TableSource {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("table.csv");
    fs::write(&file, text).unwrap();
    TableSource::read(&file).unwrap().unwrap()
}

const COMPARISON: &str = "\
# title = \"Cusps\"
scheme,time_step_s,steps,error_m,error_at_end_m,order,energy_drift
rk4,0.1,10,1e-1,1e-1,n/a,1e-3
rk4,0.05,20,6.25e-3,1e-1,4.0,1e-4
rk4,0.025,40,3.9e-4,1e-1,4.0,1e-5
rk4,0.0125,80,2.44e-5,1e-1,4.0,1e-6
exact,0.1,10,3e-15,1e-1,n/a,1e-16
exact,0.05,20,4e-15,1e-1,n/a,1e-16
exact,0.025,40,n/a,1e-1,n/a,1e-16
exact,0.0125,80,0,1e-1,n/a,1e-16
";

#[test]
fn the_figure_of_a_comparison_shows_the_slope() {
    let chart =
        of_table::chart(&table(COMPARISON), &TableView::of_columns(&[], COLUMN_PT)).unwrap();
    let scene = chart.scene();
    check_overlaps(&scene).unwrap();
    let axes = ["largest error (m)", "Δt (s)"];
    says(&scene, &axes);
    says(&scene, &["rk4, slope 4", "exact"]);
    let told = of_table::warning(&table(COMPARISON), &chart).unwrap();
    assert!(told.starts_with("2 of 8 values have no point: "), "{told}");
    // Each column alone.
    let other = of_table::chart(
        &table(COMPARISON),
        &TableView::of_columns(&["energy_drift"], COLUMN_PT),
    )
    .unwrap();
    assert_eq!(of_table::warning(&table(COMPARISON), &other), None);
    says(&other.scene(), &["relative energy drift"]);
    // A scheme without any error has no point on a logarithmic axis.
    let none = COMPARISON
        .replace("3e-15", "0")
        .replace("4e-15", "0")
        .replace("40,n/a", "40,0");
    for (text, name) in [(COMPARISON, "exact"), (&none, "")] {
        let of_text =
            of_table::chart(&table(text), &TableView::of_columns(&[], COLUMN_PT)).unwrap();
        assert_eq!(of_text.panels[0].series[1].name, name);
    }
    let wrong = of_table::chart(
        &table(COMPARISON),
        &TableView::of_columns(&["eror_m"], COLUMN_PT),
    )
    .unwrap_err();
    assert!(wrong.contains("error_m"), "{wrong}");
}

#[test]
fn a_work_precision_figure_shows_error_over_computing_time() {
    let text = COMPARISON
        .replace(",energy_drift\n", ",energy_drift,ns_per_step\n")
        .replace("e-16\n", "e-16,300\n")
        .replace("e-3\n", "e-3,100\n")
        .replace("e-4\n", "e-4,100\n")
        .replace("e-5\n", "e-5,100\n")
        .replace("e-6\n", "e-6,100\n");
    let view = TableView {
        kind: TableKind::WorkPrecision,
        ..TableView::of_columns(&[], COLUMN_PT)
    };
    let chart = of_table::chart(&table(&text), &view).unwrap();
    assert!(chart.x.is_log && chart.panels[0].y.is_log);
    let rk4 = &chart.panels[0].series[0];
    assert_eq!(rk4.name, "rk4");
    assert!((rk4.points[0][0] / 1e-6 - 1.0).abs() < 1e-12 && rk4.points[0][1] == 0.1);
    says(
        &chart.scene(),
        &["computing time (10⁻⁶ s)", "largest error (m)"],
    );
}

#[test]
fn the_axis_of_errors_over_time_ends_at_rounding() {
    let schemes = |names: &[&str]| -> Vec<FigureRun> {
        let set = names.iter().map(|name| format!("motion.scheme={name}"));
        set.map(|set| run("cusps", &[&set])).collect()
    };
    let kind = FigureKind::named("error").unwrap();
    assert_eq!(kind.name(), "error");
    let figure = drawn(&schemes(&["report", "strang"]), &spec("error"));
    check_overlaps(&figure.scene).unwrap();
    says(
        &figure.scene,
        &[
            "distance from exact motion (m)",
            "the report's scheme",
            "strang",
        ],
    );
    assert!(!words(&figure.scene).contains(&"rounding"));
    let finest = drawn(&schemes(&["report", "srkn11b"]), &spec("error"));
    check_overlaps(&finest.scene).unwrap();
    says(&finest.scene, &["rounding", "srkn11b"]);
}

#[test]
fn a_run_is_not_read_as_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.csv");
    fs::write(&file, "# title = \"x\"\nstep,t_s,x_m\n0,0,0\n").unwrap();
    assert!(TableSource::read(&file).unwrap().is_none());
    for (rows, words) in [("1\n", ":4: this row"), ("", "no rows")] {
        fs::write(&file, format!("# [[vary]]\n# key = \"a\"\na,b\n{rows}")).unwrap();
        has(TableSource::read(&file).unwrap_err().to_string(), words);
    }
}

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -10.0..10.0,
        Just(0.0),
        Just(1e300),
        Just(-1e300),
        Just(1e-300),
        Just(f64::NAN)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn charts_of_any_numbers_have_no_overlaps(
        points in prop::collection::vec([value(), value()], 0..40),
        errors in prop::collection::vec(value(), 0..40),
        logs in any::<(bool, bool)>(),
        names in (0_usize..5, "\\PC{0,60}"),
        width_mm in 40.0..200.0_f64,
    ) {
        let series = (0..names.0).map(|index| ChartSeries {
            name: gyrolab::plot::letters::shortened(&names.1, 7.0, gyrolab::plot::chart::legend::longest_name(width_mm * 72.0 / 25.4) - 6.0) + &index.to_string(),
            points: points.clone(),
            errors: [Vec::new(), errors.iter().map(|error| error.abs()).collect()],
            band: Vec::new(),
            style: if index % 2 == 0 { SeriesStyle::curve(index, 5) } else { SeriesStyle::marked_line(index) },
        });
        let chart = Chart {
            title: names.1.clone(),
            width_pt: width_mm * 72.0 / 25.4,
            x: ChartAxis { is_log: logs.0, ..ChartAxis::new("*t*", "s") },
            panels: vec![Panel::new(ChartAxis { is_log: logs.1, ..ChartAxis::new("*x*", "m") }, series.collect())],
            is_true_to_scale: false,
            magnified: None,
            are_read_off: true,
            ..Chart::default()
        };
        let scene = chart.scene();
        if let Err(why) = check_overlaps(&scene) {
            prop_assert!(false, "{why}");
        }
        prop_assert!(write(&scene, PageFormat::Svg, None).is_ok());
    }
}
