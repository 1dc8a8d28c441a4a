//! Measured data compared with a run in the lab, and drawn in figures.

use crate::figures::{least, most};
use crate::support::desk::Desk;
use crate::support::scenarios::{preset, resumed};
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::{has, has_all};
use gyrolab::engine::data::compared::Sum;
use gyrolab::engine::data::{self, ColumnOptions, RunQuantity};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use gyrolab::lab::Lab;
use gyrolab::lab::storage::confined::Confined;
use gyrolab::plot::{Paint, Point, SceneItem};
use gyrolab::report::figure::of_runs::{self, DrawnFigure, FigureRun, KnownNumbers};
use gyrolab::report::figure::{FigureSource, FigureSpec};
use std::fmt::Write;
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Returns a CSV with `columns` of the run of `scenario` at every tenth of 200 steps. Value number n is raised by `off(n)` of
/// its uncertainties.
fn data(scenario: &Scenario, columns: &[(&str, f64)], off: impl Fn(usize) -> f64) -> String {
    let mut text = "t_s".to_owned();
    for (name, _) in columns {
        let (stem, unit) = name.rsplit_once('_').unwrap();
        write!(text, ",{name},{stem}_uncertainty_{unit}").unwrap();
    }
    text.push('\n');
    let mut simulation = Simulation::new(Arc::new(scenario.clone()));
    for number in 0..20 {
        write!(text, "{:?}", simulation.now().time_s()).unwrap();
        for (name, sigma) in columns {
            let value = RunQuantity::find(name).unwrap().value_at(simulation.now());
            write!(text, ",{:?},{sigma}", value + off(number) * sigma).unwrap();
        }
        text.push('\n');
        (0..10).for_each(|_| {
            simulation.step().unwrap();
        });
    }
    text
}

fn file(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.csv");
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn sum(lab: &Lab) -> Sum {
    lab.comparison().data().unwrap().compared.sum.clone()
}

#[test]
fn data_generated_from_a_run_agree_with_it() {
    let scenario = preset("method-2", &[]);
    let columns = [("x_m", 0.01), ("tilt_deg", 0.1), ("spin_rpm", 1.0)];
    let (_folder, path) = file(&data(&scenario, &columns, |_| 0.0));
    let mut desk = Desk::with("method-2", scenario);
    desk.commands(&format!("measured = '{}'\ngo_to = 95", path.display()));
    let early = sum(&desk.lab);
    assert_eq!((early.points, early.compared), (60, 30));
    assert_eq!(early.chi_squared, 0.0);
    desk.commands("go_to = 200");
    assert_eq!(sum(&desk.lab).compared, 60);
    assert_eq!(sum(&desk.lab).chi_squared, 0.0);
    // An edit of the start starts a new run, and undo returns to the previous one.
    desk.commands("set = { 'start.tilt_deg' = 46 }");
    assert_eq!(sum(&desk.lab).compared, 60, "played to the same time");
    let largest = sum(&desk.lab).largest.unwrap();
    assert!(largest.sigmas > 9.0, "{largest:?}");
    desk.commands("undo = 1\ngo_to = 200");
    assert_eq!(sum(&desk.lab).chi_squared, 0.0);
    // An edit of motion takes effect at the current step; the comparison before it is unchanged.
    desk.commands("go_to = 95\nset = { 'motion.gravity_m_per_s2' = 20 }\ngo_to = 200");
    let edited = desk.lab.comparison().data().unwrap().compared.clone();
    let shown = &edited.curves[0];
    assert!(
        shown[..10]
            .iter()
            .all(|shown| shown.residual() == Some(0.0))
    );
    assert!(shown[19].residual().unwrap().abs() > 0.01);
}

#[test]
fn chi_squared_and_largest_residual_are_correct() {
    let scenario = preset("method-2", &[]);
    let (_folder, path) = file(&data(&scenario, &[("z_m", 0.01)], |number| {
        if number == 7 { -3.0 } else { 0.5 }
    }));
    let mut desk = Desk::with("method-2", scenario);
    desk.commands(&format!("measured = '{}'\ngo_to = 200", path.display()));
    let sum = sum(&desk.lab);
    let off = sum.chi_squared - (9.0 + 19.0 * 0.25);
    assert!(off.abs() < 1e-9, "{sum:?}");
    let largest = sum.largest.unwrap();
    assert!((largest.sigmas - 3.0).abs() < 1e-9 && (largest.time_s - 7.0).abs() < 1e-9);
}

#[test]
fn points_are_drawn_in_traces_and_from_above_and_as_residuals() {
    let scenario = preset("method-2", &[]);
    let columns = [("x_m", 0.05), ("y_m", 0.05), ("spin_rpm", 1.0)];
    let (_folder, path) = file(&data(&scenario, &columns, |number| {
        [0.0, 2.0, -1.0][number % 3]
    }));
    for (name, size) in [("small", SMALL), ("large", LARGE)] {
        let mut stage = Stage::open("method-2", &["motion.steps=200"], size);
        stage.commands(&format!(
            "measured = '{}'\npause = true\ngo_to = 120",
            path.display()
        ));
        stage.wait(1.0);
        insta::assert_snapshot!(format!("points_{name}"), stage.picture());
        stage.press("m").wait(6.0);
        insta::assert_snapshot!(format!("residuals_{name}"), stage.picture());
    }
}

#[test]
fn traces_show_measured_quantities_over_the_whole_run() {
    let scenario = preset("cusps", &[]);
    let columns = [("x_m", 0.05), ("tilt_deg", 0.6)];
    let (_folder, path) = file(&data(&scenario, &columns, |_| 0.5));
    let mut stage = Stage::open("cusps", &[], SMALL);
    stage.commands(&format!(
        "pause = true\nmeasured = '{}'\ngo_to = 9000",
        path.display()
    ));
    let picture = stage.picture();
    let names = picture.lines().filter_map(|line| line.split_once(") ─"));
    let names: Vec<_> = names.map(|(name, _)| name).collect();
    assert_eq!(names[..2], ["x (m", "tilt (°"], "{picture}");
    let window = stage.lab.view().window;
    assert_eq!((window.begin_s, window.has_overview), (0.0, false));
    stage.press("m").shows("tilt: data - run (°)");
}

#[test]
fn the_residual_key_without_data_explains_how_to_load_them() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    assert!(!stage.picture().contains("E residuals"));
    stage.press("m");
    assert!(stage.picture().contains("gyrolab --measured FILE"));
    stage.commands("measured = 'heidelberg-spin-decay'");
    assert!(stage.picture().contains("× measured: heidelberg-"));
    stage.commands("measured = 'none'");
    assert!(!stage.picture().contains("× measured"));
}

#[test]
fn tables_of_runs_and_files_outside_the_folder_are_rejected() {
    let mut desk = Desk::open("method-2");
    let refused = |at: &mut Desk, name: &str| {
        let command = crate::support::desk::commands(&format!("measured = '{name}'"));
        at.carry_out(&command[0]).unwrap_err().to_string()
    };
    let why = refused(&mut desk, "heidelberg-nutation");
    has_all(&why, ["table of runs", "gyrolab fit"]);
    let (folder, path) = file("t_s,x_m\n0,1\n");
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).unwrap();
    desk.lab
        .files_mut()
        .confine(Confined::within(&inside).unwrap());
    let outside = refused(&mut desk, path.to_str().unwrap());
    assert!(outside.contains("stays in its folder"), "{outside}");
    assert!(desk.lab.comparison().data().is_none());
    desk.commands("measured = 'heidelberg-spin-decay'");
}

#[test]
fn a_session_saves_the_name_of_the_measured_data() {
    let scenario = preset("method-2", &[]);
    let (folder, path) = file(&data(&scenario, &[("z_m", 0.01)], |_| 1.0));
    let mut desk = Desk::with("method-2", scenario);
    desk.commands(&format!(
        "measured = '{}'\nresiduals = true\ngo_to = 200",
        path.display()
    ));
    let content = desk.lab.content(&Default::default());
    let mut again = Desk::from_lab(resumed(&content));
    again.wait(3);
    assert_eq!(sum(&again.lab).compared, 20);
    assert!(again.lab.view().look.residuals);
    drop(folder);
    let without = resumed(&content);
    assert!(without.comparison().data().is_none());
    let notice = without.notice().unwrap();
    has_all(&notice, ["bench.csv", "no such file"]);
}

#[test]
fn a_scenario_can_name_its_measured_data() {
    let scenario = preset("method-2", &["view.measured=\"heidelberg-spin-decay\""]);
    let mut desk = Desk::with("method-2", scenario);
    desk.lab
        .begin_with_measured(None, &ColumnOptions::default())
        .unwrap();
    assert_eq!(sum(&desk.lab).points, 7);
    desk.commands("open = 'cusps'");
    // The data belonged to the other run.
    assert!(desk.lab.comparison().data().is_none());
    desk.commands("measured = 'heidelberg-spin-decay'\nopen = 'loops'");
    // The data were chosen by the user.
    assert!(desk.lab.comparison().data().is_some());
}

fn figure(kind: Option<&str>, text: &str) -> DrawnFigure {
    figure_with(kind, text, &KnownNumbers::default())
}

fn figure_with(kind: Option<&str>, text: &str, known: &KnownNumbers) -> DrawnFigure {
    let source = FigureSource {
        spec: FigureSpec {
            kind: kind.map(str::to_owned),
            width_pt: Some(250.0),
            ..FigureSpec::default()
        },
        runs: vec![FigureRun {
            scenario: Arc::new(preset("method-2", &["motion.steps=200"])),
            named: "method-2".to_owned(),
        }],
        measured: Some(Arc::new(data::read("bench.csv", text).unwrap())),
        table: None,
    };
    let go_on = |_, _| ControlFlow::Continue(());
    let figures = of_runs::figures(&[source], known, go_on);
    figures.unwrap().unwrap().remove(0)
}

#[test]
fn known_values_of_the_run_are_not_recomputed() {
    let text = "t_s,x_m,azimuth_deg\n1,0.2,350\n2,0.3,20\n";
    let measured = data::read("bench.csv", text).unwrap();
    let run = Arc::new(preset("method-2", &["motion.steps=200"]));
    let said = data::at_times(measured.series().unwrap(), &run, &|| true)
        .unwrap()
        .unwrap();
    let knowing = |numbers: &[Vec<f64>]| KnownNumbers {
        recorded: None,
        said: Some(numbers.to_vec()),
    };
    // Directions shifted by a full turn appear elsewhere, which shows that the given numbers are used.
    let mut turned = said.clone();
    turned[1].iter_mut().for_each(|degrees| *degrees += 360.0);
    let mut moved = said.clone();
    moved[0][0] += 0.1;
    for (kind, other) in [(None, &turned), (Some("residuals"), &moved)] {
        let alone = figure(kind, text);
        let with = |numbers: &[Vec<f64>]| figure_with(kind, text, &knowing(numbers)).scene;
        assert_eq!(with(&said), alone.scene, "{kind:?}");
        assert_ne!(with(other), alone.scene, "{kind:?}");
    }
}

/// Returns the centers of the open circles, without that of the legend.
fn rings(figure: &DrawnFigure) -> Vec<[f64; 2]> {
    let middle = |item: &SceneItem| {
        let points: Vec<_> = item.path.points().collect();
        let ends = |part: fn(&Point) -> f64| {
            let all = || points.iter().map(part);
            (least(all()), most(all()))
        };
        let (x, y) = (ends(|at| at.x), ends(|at| at.y));
        let is_white = matches!(item.paint, Paint::Fill(color) if color.0 == [255; 3]);
        let is_ring = is_white && x.1 - x.0 < 4.0;
        is_ring.then(|| [x, y].map(|(low, high)| 0.5 * (low + high)))
    };
    let mut rings: Vec<_> = figure.scene.items.iter().filter_map(middle).collect();
    rings.pop();
    rings
}

#[test]
fn points_are_drawn_at_their_positions_in_figures() {
    let scenario = preset("method-2", &[]);
    let off = |number: usize| number as f64 % 4.0;
    let text = data(&scenario, &[("x_m", 0.05), ("y_m", 0.05)], off);
    let read = data::read("bench.csv", &text).unwrap();
    let series = read.series().unwrap().clone();
    // Panel by panel, the positions are a linear function of the values.
    let all = rings(&figure(None, &text));
    assert_eq!(all.len(), 40);
    for (rings, curve) in all.chunks(20).zip(&series.curves) {
        let values: Vec<_> = curve.points.iter().map(|point| point.value).collect();
        assert_linear(&series.times_s, rings, 0);
        assert_linear(&values, rings, 1);
    }
    let above = rings(&figure(Some("above"), &text));
    // The last two are the start's, on the path and in the legend.
    assert_eq!(above.len(), 22);
    for part in [0, 1] {
        let points = series.curves[part].points.iter();
        let values: Vec<_> = points.map(|point| point.value).collect();
        assert_linear(&values, &above[..20], part);
    }
    let residuals = rings(&figure(Some("residuals"), &text));
    let off: Vec<f64> = (0..20).map(off).collect();
    assert_linear(&off, &residuals[..20], 1);
}

/// Asserts that the coordinate `part` of `places` is a linear function of `values`; 1 is the vertical coordinate.
#[track_caller]
fn assert_linear(values: &[f64], places: &[[f64; 2]], part: usize) {
    let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
    let least = (0..values.len()).min_by(by_value).unwrap();
    let most = (0..values.len()).max_by(by_value).unwrap();
    let scale = (places[most][part] - places[least][part]) / (values[most] - values[least]);
    assert!(if part == 0 { scale > 0.0 } else { scale < 0.0 }, "{scale}");
    for (value, place) in values.iter().zip(places) {
        let wanted = places[least][part] + scale * (value - values[least]);
        let off = (place[part] - wanted).abs();
        assert!(off < 0.02, "{value} at {place:?}, not {wanted}");
    }
}

#[test]
fn a_point_without_uncertainty_has_no_error_bar() {
    // The ends of an error bar are 3.4 pt long; no tick has this length.
    let ends =
        |figure: &DrawnFigure| {
            figure.scene.items.iter().filter(|item| {
            let points: Vec<_> = item.path.points().collect();
            matches!(points[..], [a, b] if a.y == b.y && ((a.x - b.x).abs() - 3.4).abs() < 1e-6)
        }).count()
        };
    let with = figure(None, "t_s,x_m,x_uncertainty_m\n5,0.5,0.3\n10,0,0.3\n");
    let one = figure(None, "t_s,x_m,x_uncertainty_m\n5,0.5,0.3\n10,0,\n");
    assert_eq!((ends(&with), ends(&one)), (4, 2));
    assert_eq!(rings(&one).len(), 2);
}

#[test]
fn a_figure_without_points_says_so() {
    let warned = |kind: &str| {
        let mut told = figure(Some(kind), "t_s,spin_rpm\n0,5\n1,6\n").warnings;
        told.retain(|told| !told.contains("do not believe"));
        told.join("; ")
    };
    has(warned("traces"), "--kind spin_rpm");
    has(warned("above"), "tilt_deg and azimuth_deg");
    has(warned("3d"), "not drawn in space");
    assert_eq!(warned("spin_rpm"), "");
    // The run lasts 20 s.
    let longer = figure(None, "t_s,x_m\n5,0.5\n25,0.4\n").warnings;
    let words = "the run ends at 20 s, before the last point of bench.csv at 25 s: use --duration 25 to extend the run";
    assert_eq!(longer[1..], [words]);
}

#[test]
fn the_legend_counts_the_drawn_points() {
    // Two positions and three tilts; the width of the legend depends on its text.
    let data = "t_s,x_m,tilt_deg\n1,0.5,45\n2,0.4,45\n3,,45\n";
    let fewer = "t_s,x_m\n1,0.5\n2,0.4\n";
    let paths = |kind: &str, text: &str| -> Vec<String> {
        let items = figure(Some(kind), text).scene.items;
        items.iter().map(|item| format!("{item:?}")).collect()
    };
    assert_eq!(paths("x_m", data), paths("x_m", fewer), "2 points");
    let more = "t_s,x_m\n1,0.5\n2,0.4\n3,0.4\n";
    assert_ne!(paths("x_m", data), paths("x_m", more), "3 points");
}

#[test]
fn data_after_the_end_of_the_run_are_reported_with_a_remedy() {
    let mut stage = Stage::open("heidelberg", &[], SMALL);
    stage.commands("measured = 'heidelberg-spin-decay'");
    stage.commands("go_to = 'end'").wait(1.0);
    stage.shows("(1 of 7 points: g, 720 s)");
    let longer = ["motion.time_step_s=1", "motion.steps=750"];
    let mut played = Stage::open("heidelberg", &longer, SMALL);
    played.commands("measured = 'heidelberg-spin-decay'");
    played.commands("go_to = 'end'").wait(1.0);
    played.shows_no("g, 720 s");
}
