//! Exports in the background: they write the bytes of `gyrolab run -o`, and leave a complete file or none.

use crate::support::ground::names;
use crate::support::scenarios::preset;
use gyrolab::engine::export::destination::DestinationError;
use gyrolab::engine::export::stream;
use gyrolab::engine::export::{CsvLayout, CsvWriter};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::lab::storage::at_exit::{self, Release};
use gyrolab::lab::storage::exporting::{Exporting, Written, estimate};
use std::fs;
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

fn scenario(name: &str, sets: &[&str]) -> Arc<Scenario> {
    Arc::new(preset(name, sets))
}

fn every(every: u64) -> NonZeroU64 {
    NonZeroU64::new(every).unwrap()
}

fn bytes(scenario: &Arc<Scenario>, every: u64) -> Vec<u8> {
    let layout = CsvLayout::every(NonZeroU64::new(every).unwrap());
    let mut csv = CsvWriter::with_layout(Vec::new(), scenario, layout).unwrap();
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let steps = scenario.steps;
    stream::play(
        &mut simulation,
        steps,
        Some(&mut csv),
        |_| {},
        |_, _| ControlFlow::Continue(()),
    )
    .unwrap();
    csv.finish().unwrap()
}

fn wait(exporting: &mut Exporting) -> Result<Written, String> {
    loop {
        if let Some(outcome) = exporting.outcome() {
            assert!(exporting.outcome().is_none(), "told twice");
            return outcome;
        }
        thread::sleep(Duration::from_millis(1));
    }
}

fn export(scenario: &Arc<Scenario>, path: &Path, n: u64, replace: bool) -> Result<Written, String> {
    let begun = Exporting::begin(
        Arc::clone(scenario),
        path,
        CsvLayout::every(every(n)),
        replace,
    );
    wait(&mut begun.map_err(|error| error.fact())?)
}

/// A run that takes longer than any test.
fn endless() -> Arc<Scenario> {
    scenario("method-2", &["motion.steps=1000000000000"])
}

#[test]
fn an_export_equals_the_file_of_the_run_command() {
    let folder = tempfile::tempdir().unwrap();
    for (preset, n) in PRESETS.iter().flat_map(|preset| [(preset, 1), (preset, 7)]) {
        let scenario = scenario(preset.name, &[]);
        let path = folder.path().join("run.csv");
        let written = export(&scenario, &path, n, true).unwrap();
        let wanted = bytes(&scenario, n);
        assert!(fs::read(&path).unwrap() == wanted, "{} {n}", preset.name);
        let lines = wanted
            .split(|byte| *byte == b'\n')
            .filter(|line| !line.is_empty());
        let rows = lines.filter(|line| !line.starts_with(b"#")).count() as u64 - 1;
        let told = (written.rows, written.bytes, written.path);
        assert_eq!(
            told,
            (Some(rows), wanted.len() as u64, path),
            "{} {n}",
            preset.name
        );
        assert_eq!(written.not_finite, None);
    }
    assert_eq!(names(folder.path()), ["run.csv"]);
}

#[test]
fn the_estimated_size_is_within_5_percent() {
    for (preset, n) in PRESETS.iter().flat_map(|preset| [(preset, 1), (preset, 7)]) {
        let scenario = scenario(preset.name, &[]);
        let told = estimate(&scenario, every(n));
        let wanted = bytes(&scenario, n).len() as f64;
        let rows = scenario.steps.div_ceil(n) + 1;
        assert_eq!(told.rows, rows, "{} {n}", preset.name);
        let off = told.bytes as f64 / wanted - 1.0;
        println!("{} every {n}: {:+.2} %", preset.name, off * 100.0);
        assert!(off.abs() < 0.05, "{} {n}: off by {off}", preset.name);
    }
}

#[test]
fn the_estimate_is_right_for_two_rows() {
    let scenario = scenario("cusps", &["motion.steps=1"]);
    let told = estimate(&scenario, every(1000));
    assert_eq!(told.rows, 2);
    assert!((told.bytes as f64 / bytes(&scenario, 1000).len() as f64 - 1.0).abs() < 0.05);
}

#[test]
fn a_canceled_export_reports_progress_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let mut exporting =
        Exporting::begin(endless(), &path, CsvLayout::every(every(1000)), false).unwrap();
    while exporting.progress().0 == 0 {
        thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(exporting.progress().1, 1_000_000_000_000);
    assert_eq!(names(folder.path()).len(), 1, "the temporary file");
    assert!(exporting.outcome().is_none());
    exporting.cancel();
    assert!(wait(&mut exporting).unwrap_err().contains("stopped"));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_dropped_export_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    drop(Exporting::begin(endless(), &path, CsvLayout::every(every(1000)), false).unwrap());
    assert!(names(folder.path()).is_empty());
}

#[test]
fn an_existing_file_is_replaced_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    fs::write(&path, "old").unwrap();
    let scenario = scenario("cusps", &[]);
    let refused = Exporting::begin(
        Arc::clone(&scenario),
        &path,
        CsvLayout::every(every(1)),
        false,
    );
    let error = refused.err().unwrap();
    assert!(matches!(error, DestinationError::Exists(_)));
    assert_eq!(error.fact(), format!("{} exists", path.display()));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    export(&scenario, &path, 1, true).unwrap();
    assert!(fs::read(&path).unwrap() == bytes(&scenario, 1));
}

#[test]
fn a_file_created_during_the_export_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let scenario = scenario("method-2", &["motion.steps=300000"]);
    let mut exporting =
        Exporting::begin(scenario, &path, CsvLayout::every(every(1)), false).unwrap();
    fs::write(&path, "other").unwrap();
    let error = wait(&mut exporting).unwrap_err();
    assert_eq!(error, format!("{} exists", path.display()));
    assert_eq!(fs::read(&path).unwrap(), b"other");
    assert_eq!(names(folder.path()), ["run.csv"]);
}

#[test]
fn an_unwritable_path_is_rejected_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo");
    let made = Command::new("mkfifo").arg(&fifo).status();
    assert!(made.unwrap().success());
    let cases = [
        (fifo.as_path(), "not a regular file"),
        (Path::new("/dev/full"), "not a regular file"),
        (folder.path(), "is a folder"),
        (
            Path::new("/dev/null/run.csv"),
            "cannot write /dev/null/run.csv",
        ),
        (
            Path::new("/no/such/folder/run.csv"),
            "there is no folder /no/such/folder",
        ),
        (Path::new("/proc/run.csv"), "cannot write /proc/run.csv"),
        (Path::new(""), "folder"),
        (Path::new("./"), "folder"),
    ];
    for (path, words) in cases {
        for replace in [false, true] {
            let refused = Exporting::begin(
                scenario("cusps", &[]),
                path,
                CsvLayout::every(every(1)),
                replace,
            );
            let fact = refused.err().unwrap().fact();
            assert!(fact.contains(words) && !fact.contains("--force"), "{fact}");
        }
    }
}

#[test]
fn the_rows_before_the_first_non_finite_number_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    let sets = [
        "start.momentum_Js=[0,0,1e150]",
        "push.0.force_N=[1e308,0,0]",
    ];
    let scenario = scenario("wobble-push", &sets);
    let written = export(&scenario, &path, 7, false).unwrap();
    let end = written.not_finite.unwrap();
    assert!(fs::read(&path).unwrap() == bytes(&scenario, 7));
    let text = fs::read_to_string(&path).unwrap();
    let rows: Vec<_> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(written.rows, Some(rows.len() as u64 - 1));
    assert!(
        rows.last()
            .unwrap()
            .starts_with(&format!("{},", end.step - 1))
    );
}

#[test]
fn a_dash_is_a_file_name_in_the_lab() {
    let exporting = Exporting::begin(
        endless(),
        Path::new("-"),
        CsvLayout::every(every(1000)),
        false,
    )
    .unwrap();
    assert!(
        names(Path::new("."))
            .iter()
            .any(|name| name.starts_with(".gyrolab-") && name.ends_with(".part"))
    );
    drop(exporting);
}

/// Environment variable that names the folder for the exporting process.
const CHILD: &str = "GYROLAB_TEST_EXPORTING";

/// Not a test by itself, but the body of a child process: it begins an export, continues it after a suspension, and ends.
#[test]
fn child() {
    let Some(folder) = std::env::var_os(CHILD) else {
        return;
    };
    let folder = Path::new(&folder);
    let mut exporting = Exporting::begin(
        endless(),
        &folder.join("run.csv"),
        CsvLayout::every(every(1000)),
        false,
    )
    .unwrap();
    at_exit::run_hooks(Release::Suspend);
    let (step, _) = exporting.progress();
    while exporting.progress().0 == step {
        assert!(exporting.outcome().is_none(), "it does not go on");
        thread::sleep(Duration::from_millis(1));
    }
    assert!(exporting.outcome().is_none());
    assert_eq!(names(folder).len(), 1, "the temporary file");
    at_exit::run_hooks(Release::Exit);
    std::process::exit(42); // runs no destructors
}

#[test]
fn the_exit_hook_removes_the_temporary_file() {
    let folder = tempfile::tempdir().unwrap();
    let status = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "exporting::child"])
        .env(CHILD, folder.path())
        .status();
    assert_eq!(status.unwrap().code(), Some(42));
    assert!(names(folder.path()).is_empty());
}
