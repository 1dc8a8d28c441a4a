//! The rows and columns of CSVs, and their verification against the run file in their header.

use crate::support::scenarios::{parse, preset};
use crate::support::words::has;
use gyrolab::engine::analysis::compare;
use gyrolab::engine::analysis::verdict::warning_at_start;
use gyrolab::engine::export::columns::COLUMNS;
use gyrolab::engine::export::layout::LayoutFile;
use gyrolab::engine::export::layout::commented;
use gyrolab::engine::export::{CsvLayout, CsvWriter, stream};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::SchemeInfo;
use gyrolab::studies::verify::{Unverified, Verified, verify};
use nalgebra::Vector3;
use proptest::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Arc, LazyLock};

fn csv(scenario: &Scenario, file: LayoutFile) -> Vec<u8> {
    let scenario = Arc::new(scenario.clone());
    let layout = file.check().unwrap();
    let mut csv = CsvWriter::with_layout(Vec::new(), &scenario, layout).unwrap();
    let mut run = Simulation::new(Arc::clone(&scenario));
    stream::play(
        &mut run,
        scenario.steps,
        Some(&mut csv),
        |_| {},
        |_, _| ControlFlow::Continue(()),
    )
    .unwrap();
    csv.finish().unwrap()
}

fn whole() -> LayoutFile {
    LayoutFile::default()
}

/// The layout with a row for every point.
fn of_points() -> LayoutFile {
    LayoutFile {
        points: true,
        ..whole()
    }
}

fn verified(bytes: &[u8]) -> Result<Verified, Unverified> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, bytes).unwrap();
    verify(&path, no_fit, |_, _| ControlFlow::Continue(()))
}

fn no_fit(_: &str) -> Result<Vec<u8>, Unverified> {
    unreachable!("not a fit")
}

#[track_caller]
fn difference(bytes: &[u8]) -> gyrolab::studies::verify::FileDifference {
    verified(bytes).unwrap().difference.expect("a difference")
}

#[track_caller]
fn refused(bytes: &[u8]) -> String {
    verified(bytes).expect_err("it was verified").to_string()
}

/// Returns the rows of a CSV, preceded by the line of column names.
fn rows(bytes: &[u8]) -> Vec<String> {
    let text = std::str::from_utf8(bytes).unwrap();
    let lines = text.trim_start_matches('\u{feff}').lines();
    let rows = lines.filter(|line| !line.starts_with('#'));
    rows.map(str::to_owned).collect()
}

/// A run with a push, and edits of push, scheme and time step.
fn edited() -> Scenario {
    let text = preset("wobble-push", &["motion.steps=120"]).to_toml()
        + "[[edit]]\nstep = 40\nset = { \"motion.time_step_s\" = 0.05 }\n\
           [[edit]]\nstep = 60\nset = { \"motion.scheme\" = \"strang\", \"push.0.force_N\" = [0, 5, 0] }\n";
    parse(&text)
}

fn names(names: &[&str]) -> Option<Vec<String>> {
    Some(names.iter().map(|name| (*name).to_owned()).collect())
}

#[test]
fn a_partial_csv_has_the_lines_of_the_whole_one() {
    let scenario = preset("method-2", &["motion.steps=100"]);
    let all = rows(&csv(&scenario, whole()));
    let cut = |every: u64, from_s, to_s| {
        let every = every.try_into().ok();
        let file = LayoutFile {
            every,
            from_s,
            to_s,
            ..whole()
        };
        rows(&csv(&scenario, file))[1..].to_vec()
    };
    let of = |steps: &[usize]| -> Vec<String> {
        steps.iter().map(|&step| all[step + 1].clone()).collect()
    };
    // 0.3 s is 3 x 0.1 s.
    assert_eq!(cut(1, Some(0.3), Some(0.5)), of(&[3, 4, 5]));
    assert_eq!(cut(30, None, None), of(&[0, 30, 60, 90, 100]));
    assert_eq!(cut(30, Some(0.1), None), of(&[30, 60, 90, 100]));
    assert_eq!(cut(30, None, Some(9.9)), of(&[0, 30, 60, 90]));
    assert_eq!(cut(30, Some(9.5), None), of(&[100]));
    assert_eq!(cut(1, Some(10.0), Some(20.0)), of(&[100]));
}

#[test]
fn selected_columns_equal_those_of_the_whole_csv() {
    let scenario = edited();
    let whole_rows = rows(&csv(&scenario, whole()));
    let chosen = ["energy_J", "step", "z_m", "segment"];
    let file = LayoutFile {
        columns: names(&chosen),
        ..whole()
    };
    let places: Vec<_> = chosen
        .map(|name| {
            COLUMNS
                .iter()
                .position(|column| column.name == name)
                .unwrap()
        })
        .to_vec();
    for (part, row) in rows(&csv(&scenario, file)).iter().zip(&whole_rows) {
        let fields: Vec<_> = row.split(',').collect();
        let wanted: Vec<_> = places.iter().map(|&place| fields[place]).collect();
        assert_eq!(*part, wanted.join(","));
    }
    let comma = LayoutFile {
        excel: true,
        ..whole()
    };
    let bytes = csv(&scenario, comma);
    assert!(bytes.starts_with("\u{feff}# # excel = true\n".as_bytes()));
    for (with_comma, point) in rows(&bytes).iter().zip(&whole_rows) {
        assert_eq!(with_comma.replace(',', ".").replace(';', ","), *point);
    }
}

#[test]
fn every_point_has_a_row() {
    let scenario = preset("method-2", &["motion.steps=3"]);
    let whole_rows = rows(&csv(&scenario, whole()));
    let points = rows(&csv(&scenario, of_points()));
    let count = scenario.body.mechanics.points().len();
    assert_eq!(points.len(), 1 + 4 * count);
    assert!(points[1].starts_with("0,0.0,rim.0,0.5,"), "{}", points[1]);
    let top = points.iter().filter(|row| row.contains(",top,"));
    for (of_point, of_step) in top.zip(&whole_rows[1..]) {
        let point: Vec<_> = of_point.split(',').collect();
        let row: Vec<_> = of_step.split(',').collect();
        assert_eq!(point[4..7], row[2..5]);
        // Its velocity is w x r.
        let number = |text: &str| text.parse::<f64>().unwrap();
        let [r, w] = [2, 8].map(|at| [0, 1, 2].map(|k| number(row[at + k])));
        let velocity = [
            w[1] * r[2] - w[2] * r[1],
            w[2] * r[0] - w[0] * r[2],
            w[0] * r[1] - w[1] * r[0],
        ];
        assert_eq!([7, 8, 9].map(|at| number(point[at])), velocity);
    }
}

#[test]
fn points_are_named_after_their_parts_and_only_rotor_points_spin() {
    let points = |name: &str| {
        let scenario = preset(name, &["motion.steps=2", "motion.time_step_s=1e-4"]);
        rows(&csv(&scenario, of_points()))
    };
    let ball = points("rugby-pass");
    assert!(ball.iter().any(|row| row.contains(",ball +z,")), "{ball:?}");
    assert!(!ball.iter().any(|row| row.contains(",rim.")), "{ball:?}");
    let gyroscope = points("lab-gyroscope");
    let of = |point: &str| -> Vec<[f64; 6]> {
        let named = format!(",{point},");
        let own = gyroscope.iter().filter(|row| row.contains(&named));
        own.map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            [4, 5, 6, 7, 8, 9].map(|at| cells[at].parse().unwrap())
        })
        .collect()
    };
    // The wheel's points are sqrt(3)/2 of its radius off the axle and turn at 720 rpm; the counterweight only precesses.
    for (point, speed) in [("wheel +x", 7.84), ("counterweight +x", 0.02)] {
        let places = of(point);
        let fast = Vector3::from_column_slice(&places[1][3..]);
        assert!((fast.norm() / speed - 1.0).abs() < 0.05, "{point}: {fast}");
        for axis in 0..3 {
            // The velocity equals the change of the position between rows.
            let went = (places[2][axis] - places[0][axis]) / 2e-4;
            assert!((went - fast[axis]).abs() < 1e-3 * speed, "{point}: {went}");
        }
    }
}

#[test]
fn the_layout_precedes_the_run_file_and_is_read_back() {
    let file = LayoutFile {
        every: 10.try_into().ok(),
        from_s: Some(1.0),
        columns: names(&["t_s", "z_m"]),
        ..whole()
    };
    let scenario = edited();
    let bytes = csv(&scenario, file.clone());
    let run_file = commented(&scenario.to_toml());
    let layout = "# # every = 10\n# # from_s = 1.0\n# # columns = [\"t_s\", \"z_m\"]\n";
    let warning = warning_at_start(&scenario).unwrap();
    let header = format!("{layout}# # warning: {warning}\n{run_file}t_s,z_m\n");
    assert!(bytes.starts_with(header.as_bytes()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, &bytes).unwrap();
    let again = Document::read(&path).unwrap().scenario().unwrap();
    assert_eq!(
        again.to_toml(),
        scenario.to_toml(),
        "the run file is read back"
    );
    let read_back = CsvLayout::read(&header.replace("\n# ", "\n")[2..]).unwrap();
    assert_eq!(*read_back.file(), file);
    let plain = csv(&scenario, whole());
    let plain_header = format!("# # warning: {warning}\n{run_file}step,t_s,");
    assert!(plain.starts_with(plain_header.as_bytes()));
}

#[test]
fn an_invalid_layout_is_rejected_with_a_remedy() {
    let error = |file: LayoutFile| file.check().unwrap_err().to_string();
    let columns = |list: &[&str], points| LayoutFile {
        columns: names(list),
        points,
        ..whole()
    };
    for (list, points, words) in [
        (
            &["t_s", "z"][..],
            false,
            "no column named z: did you mean z_m?",
        ),
        (
            &["tilt_deg"],
            true,
            "no column named tilt_deg: there is step, ",
        ),
        (&["z_m", "z_m"], false, "z_m is named twice"),
        (&[], false, "must name a column"),
    ] {
        has(error(columns(list, points)), words);
    }
    let cut = |from_s, to_s| LayoutFile {
        from_s,
        to_s,
        ..whole()
    };
    assert!(error(cut(Some(5.0), Some(4.0))).starts_with("to_s: 4 s is before"));
    assert!(error(cut(Some(f64::NAN), None)).starts_with("from_s: "));
    assert!(error(cut(None, Some(-1.0))).starts_with("to_s: "));
}

#[test]
fn exports_of_every_layout_pass_verification() {
    let edited = edited();
    let cut = LayoutFile {
        every: 7.try_into().ok(),
        from_s: Some(0.5),
        to_s: Some(4.0),
        ..whole()
    };
    let points = LayoutFile {
        points: true,
        excel: true,
        columns: names(&["point", "z_m", "step"]),
        ..whole()
    };
    for file in [whole(), cut, points] {
        let bytes = csv(&edited, file);
        let result = verified(&bytes).unwrap();
        assert_eq!(result.difference, None);
        assert_eq!(result.rows, rows(&bytes).len() as u64 - 1);
        let [verdict] = &result.notes[..] else {
            panic!("{:?}", result.notes);
        };
        assert!(verdict.starts_with("Not reliable"));
    }
    let good = preset("steady-slow", &["motion.steps=50"]);
    let notes = verified(&csv(&good, whole())).unwrap().notes;
    assert!(
        notes[0].starts_with("The numbers are reliable"),
        "{notes:?}"
    );
}

static GOOD: LazyLock<Vec<u8>> = LazyLock::new(|| csv(&edited(), whole()));

/// Returns the offset of the first row.
fn first_row(bytes: &[u8]) -> usize {
    let text = std::str::from_utf8(bytes).unwrap();
    text.find("step,t_s").unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn one_changed_digit_in_a_row_is_detected(place in any::<prop::sample::Index>(), by in 1..10u8) {
        let mut bytes = GOOD.clone();
        let begin = first_row(&bytes);
        let digits: Vec<usize> = (begin..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
        let at = digits[place.index(digits.len())];
        bytes[at] = b'0' + (bytes[at] - b'0' + by) % 10;
        let line = bytes[..at].iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        prop_assert_eq!(difference(&bytes).line, line);
    }

    #[test]
    fn a_truncated_file_does_not_verify(place in any::<prop::sample::Index>()) {
        let begin = first_row(&GOOD);
        let end = begin + place.index(GOOD.len() - begin);
        let result = verified(&GOOD[..end]);
        prop_assert!(result.map_or(true, |result| result.difference.is_some()), "{end}");
    }
}

#[test]
fn added_or_missing_lines_are_detected() {
    let text = String::from_utf8(GOOD.clone()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let names = lines.iter().position(|line| line.starts_with("step,"));
    let at = names.unwrap() + 30; // the row of step 29
    let joined = |some: &[&str]| (some.join("\n") + "\n").into_bytes();
    let mut twice = lines.clone();
    twice.insert(at, lines[at]);
    let found = difference(&joined(&twice));
    assert_eq!(found.line, at as u64 + 2);
    let words = "the row of step 30: step is 29, computed 30";
    has(found.to_string(), words);
    let mut lost = lines.clone();
    lost.remove(at);
    assert_eq!(difference(&joined(&lost)).line, at as u64 + 1);
    let mut longer = lines.clone();
    longer.push("121,1,2");
    let told = |bytes: &[u8], reason: &str| has(difference(bytes).to_string(), reason);
    told(&joined(&longer), "\"121,1,2\", but the computed rows");
    told(&joined(&lines[..at]), "it is cut off");
    let uneven = text.replace(lines[at], &format!("{},7", lines[at]));
    told(uneven.as_bytes(), " is \"29,");
    // a byte-order mark is valid only at the beginning of a file
    difference(text.replace("\n40,", "\n\u{feff}40,").as_bytes());
    let unended = difference(text.trim_end().as_bytes());
    assert!(unended.to_string().contains("is cut off before its end"));
    assert_eq!(unended.line, lines.len() as u64);
}

#[test]
fn an_edited_header_is_detected_by_its_effect() {
    let text = String::from_utf8(GOOD.clone()).unwrap();
    for (old, new) in [
        ("radius_m = 0.8", "radius_m = 0.81"),
        ("steps = 120", "steps = 121"),
        ("steps = 120", "steps = 119"),
        ("step = 40", "step = 41"),
        ("time_step_s = 0.1", "time_step_s = 0.10"), // not as gyrolab writes it
        ("# title", "# # every = 2\n# title"),       // below the run file's first line: a comment
    ] {
        assert!(text.contains(old), "{old}");
        let result = verified(text.replacen(old, new, 1).as_bytes()).unwrap();
        assert!(result.difference.is_some(), "{old}: {new}");
    }
    let thinned = format!("# # every = 2\n{text}");
    let found = difference(thinned.as_bytes()).to_string();
    has(found, "step is 1, computed 2");
    let other = text.replacen("gyrolab = \"", "gyrolab = \"9.", 1);
    let result = verified(other.as_bytes()).unwrap();
    assert_eq!(result.difference, None);
    let own = env!("CARGO_PKG_VERSION");
    let versions = format!("written by gyrolab 9.{own}, recomputed by gyrolab {own}");
    assert_eq!(result.notes[0], versions);
}

#[test]
fn files_that_cannot_be_recomputed_are_rejected_with_a_reason() {
    let text = String::from_utf8(GOOD.clone()).unwrap();
    let body = &text[first_row(text.as_bytes())..];
    for (bytes, words) in [
        ("", "is empty"),
        ("hello\n", "is not a CSV from gyrolab"),
        ("a,b\n1,2\n", "is not a CSV from gyrolab"),
        ("# title = 'x'\n", "ends within its header"),
        (body, "without a run file in its header"),
        (
            &text.replace("# [motion]", "# [moton]"),
            "unknown key: did you mean motion?",
        ),
        (&text.replace("# title = ", "# title = = "), "title"),
        (&format!("# # evry = 3\n{text}"), "unknown field `evry`"),
        (
            &format!("# # columns = [\"z\"]\n{text}"),
            "no column named z: did you mean z_m?",
        ),
    ] {
        has(refused(bytes.as_bytes()), words);
    }
    let missing = verify("nowhere/a.csv".as_ref(), no_fit, |_, _| {
        ControlFlow::Continue(())
    })
    .unwrap_err()
    .to_string();
    has(missing, "there is no such file");
}

#[test]
fn a_run_that_ends_early_is_verified_up_to_its_end() {
    let sets = [
        "motion.scheme=rk4",
        "motion.time_step_s=5",
        "motion.steps=400",
    ];
    let scenario = preset("method-2", &sets);
    let mut run = Simulation::new(Arc::new(scenario.clone()));
    let end = run.step_to(400).expect_err("a breakdown");
    let result = verified(&csv(&scenario, whole())).unwrap();
    assert_eq!(result.difference, None);
    assert_eq!(result.notes[0], format!("its run ends early: {end}"));
    assert_eq!(result.rows, end.step);
}

#[test]
fn verification_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let scenario = preset("method-2", &["motion.steps=20000"]);
    let thinned = LayoutFile {
        every: 5000.try_into().ok(),
        ..whole()
    };
    std::fs::write(&path, csv(&scenario, thinned)).unwrap();
    let stopped = verify(&path, no_fit, |_, _| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(Unverified::Stopped)));
}

#[test]
fn the_errors_of_a_comparison_are_recomputed() {
    let scenario = preset("cusps", &["motion.steps=200"]);
    let schemes = ["report", "rk4"].map(|name| SchemeInfo::find(name).unwrap());
    let table = compare::compare(&scenario, &schemes, &[0.002, 0.001], |_, _| {
        ControlFlow::Continue(())
    })
    .unwrap();
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in &table {
        writer.serialize(row).unwrap();
    }
    let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
    let good = commented(&scenario.to_toml()) + &text;
    let result = verified(good.as_bytes()).unwrap();
    assert_eq!((result.rows, result.difference), (4, None));
    let error = format!("{:?}", table[2].error_m.unwrap());
    let wrong = good.replacen(&error, &format!("{error}1"), 1);
    let found = difference(wrong.as_bytes()).to_string();
    has(&found, "scheme rk4, time_step_s 0.002: error_m is ");
    let lost: String = good.trim_end().rsplit_once('\n').unwrap().0.to_owned() + "\n";
    difference(lost.as_bytes());
    let unknown = good.replace("\nrk4,", "\nrk5,");
    assert!(refused(unknown.as_bytes()).contains("does not name a scheme"));
}

#[test]
fn distance_from_the_exact_motion_is_an_optional_column() {
    let columns = |names: &[&str]| LayoutFile {
        columns: Some(names.iter().map(|name| (*name).to_owned()).collect()),
        ..whole()
    };
    let text = |scenario: &Scenario| {
        let bytes = csv(
            scenario,
            columns(&["t_s", "x_m", "y_m", "z_m", "distance_m"]),
        );
        let verified = verified(&bytes).unwrap();
        assert!(verified.difference.is_none(), "{:?}", verified.difference);
        String::from_utf8(bytes).unwrap()
    };
    let rows = |written: &str| -> Vec<Vec<Option<f64>>> {
        let lines = written.lines().filter(|line| !line.starts_with('#'));
        lines
            .skip(1)
            .map(|row| row.split(',').map(|cell| cell.parse().ok()).collect())
            .collect()
    };
    let report = rows(&text(&preset(
        "cusps",
        &["motion.scheme=report", "motion.steps=500"],
    )));
    let exact = rows(&text(&preset(
        "cusps",
        &["motion.scheme=exact", "motion.steps=500"],
    )));
    assert_eq!(report.len(), 501);
    for (run, truth) in report.iter().zip(&exact) {
        let place =
            |row: &[Option<f64>]| Vector3::new(row[1].unwrap(), row[2].unwrap(), row[3].unwrap());
        let distance = (place(run) - place(truth)).norm();
        assert!((distance - run[4].unwrap()).abs() < 1e-14, "{run:?}");
        assert!(truth[4].unwrap() < 1e-14, "{truth:?}");
    }
    // A CSV has this column only on request.
    assert!(COLUMNS.iter().all(|column| column.name != "distance_m"));
}
