//! Sweeps in the library: the shipped sweeps, shards, and verification of rows.

use gyrolab::engine::scenario::Document;
use gyrolab::studies::sweep::{SWEEPS, Shard, Sweep, find};
use gyrolab::studies::verify::{Unverified, verify};
use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

fn shipped(name: &str) -> Sweep {
    let text = find(name).unwrap().text;
    Sweep::open(&Document::parse(name, text).unwrap()).unwrap()
}

fn parsed(text: &str) -> Sweep {
    Sweep::open(&Document::parse("sweep.toml", text).unwrap()).unwrap()
}

const SMALL: &str = "scenario = \"cusps\"\nmeasure = [\"z_m\", \"path\"]\n\
    [[vary]]\nkey = \"motion.steps\"\nvalues = [1, 20, 3]\n\
    [[vary]]\nkey = \"start.momentum_Js.2\"\nfrom = 10\nto = 60\ncount = 2\n";

fn no_fit(_: &str) -> Result<Vec<u8>, Unverified> {
    unreachable!("not a fit")
}

fn csv(sweep: &Sweep) -> String {
    let rows: String = (0..sweep.rows())
        .map(|row| sweep.row(row, &|| true).unwrap().line)
        .collect();
    sweep.header() + &rows
}

#[test]
fn every_sweep_in_the_folder_is_in_the_table() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets/sweeps");
    let files: BTreeSet<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let names = SWEEPS.iter().map(|sweep| format!("{}.toml", sweep.name));
    assert_eq!(
        files,
        names.collect(),
        "the folder and SWEEPS in src/studies/sweep/mod.rs differ"
    );
    for sweep in SWEEPS {
        let about = shipped(sweep.name).about().unwrap_or_default().to_owned();
        assert!(
            about.len() > 100 && about.lines().all(|line| line.len() <= 80),
            "{}",
            sweep.name
        );
    }
}

/// Checks the claims of the sweep files at a few of their points.
#[test]
fn shipped_sweeps_support_their_claims() {
    let cells = |sweep: &Sweep, row: u64| -> Vec<f64> {
        let row = sweep.row(row, &|| true).unwrap();
        assert!(!row.has_failed);
        let cells = row.line.trim_end().split(',');
        cells.map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    };
    let wobble = shipped("wobble-over-time-step");
    assert_eq!(wobble.rows(), 219);
    // 0.1 s is 4.97 turns per step, 0.0905 s is 4.50: a tooth of the comb, and the gap before it.
    let [tooth, gap] = [198, 179].map(|row| cells(&wobble, row));
    assert!((tooth[0] - 0.1).abs() < 1e-12 && (gap[0] - 0.0905).abs() < 1e-12);
    assert!((tooth[1] - 4.974).abs() < 1e-2 && (gap[1] - 4.501).abs() < 1e-2);
    assert!(tooth[4] > 10.0 * gap[4], "{tooth:?} {gap:?}");
    assert!((tooth[3] / tooth[4] - 1.0).abs() < 0.03, "{tooth:?}");

    let momentum = shipped("precession-over-momentum");
    let [slow, fast] = [0, momentum.rows() - 1].map(|row| cells(&momentum, row));
    for row in [&slow, &fast] {
        assert!(
            (row[1] - row[3]).abs() <= 4.0 * row[2] + 1e-6 * row[3],
            "{row:?}"
        );
    }
    assert!(
        (slow[3] / slow[4] - 1.0).abs() > 0.05,
        "a slow top is not a fast top: {slow:?}"
    );
    assert!((fast[3] / fast[4] - 1.0).abs() < 0.01, "{fast:?}");

    let tilt = shipped("precession-over-tilt");
    let rate = |row| cells(&tilt, row)[2];
    // Tilts of 15 and 75 degrees, with the report's scheme and the exact motion.
    let [report, exact] = [[2, 14], [19, 31]].map(|[low, high]| rate(low) / rate(high) - 1.0);
    assert!((exact / 5e-5 - 1.0).abs() < 0.3, "{exact}");
    assert!(report < -5e-3, "{report}");
}

#[test]
fn shards_contain_the_rows_of_the_whole_sweep() {
    let whole = parsed(SMALL);
    let rows: Vec<_> = (0..6)
        .map(|row| whole.row(row, &|| true).unwrap().line)
        .collect();
    let mut there = rows.iter();
    for number in 1..=4 {
        let shard: Shard = format!("{number}/4").parse().unwrap();
        let part = whole.clone().with_shard(shard);
        assert!(part.header().contains(&format!("shard = \"{number}/4\"")));
        for row in 0..part.rows() {
            let there = there.next().unwrap();
            assert_eq!(part.row(row, &|| true).unwrap().line, *there);
            assert!(part.parse_row(row, there.as_bytes()).is_some());
        }
    }
    assert_eq!(there.next(), None);
}

#[test]
fn a_row_needs_a_valid_value_in_every_field() {
    let sweep = parsed(&SMALL.replace(
        "\"z_m\", \"path\"",
        "\"z_m\", \"steps\", \"nutation_is_resolved\", \"path\", \"scheme\"",
    ));
    let good = sweep.row(0, &|| true).unwrap().line;
    let is_row = |line: &str| sweep.parse_row(0, line.as_bytes()).is_some();
    assert!(is_row(&good), "{good}");
    let cells: Vec<_> = good.trim_end().split(',').collect();
    let with = |place: usize, cell: &str| {
        let mut cells = cells.clone();
        cells[place] = cell;
        cells.join(",") + "\n"
    };
    assert!(cells.len() == 8 && is_row(&with(2, "")), "{good}");
    let wrong: [(usize, &[&str]); 7] = [
        (0, &["", "2", "1.0"]),
        (1, &["", "10", "10.1"]),
        (
            2,
            &[
                "x", "53.67.1", "nan", "inf", "1e999", "+1.5", "1.50", " 1.5", "1.5 ", "0x1", "-",
                "1,5", "\"1.5\"", "true", "1.5\0", "1.5\r", "15",
            ],
        ),
        (3, &["x", "1.5", "-1", "01", "18446744073709551616"]),
        (4, &["x", "tru", "1", "True"]),
        (5, &["cusp", "cusps ", "\"cusps\"", "1"]),
        (6, &["repor", "x", "report,x", "\"report"]),
    ];
    for (place, bad) in wrong {
        for cell in bad {
            assert!(!is_row(&with(place, cell)), "{cell:?} at {place}");
        }
    }
    // A truncated line, a line without its end, and two lines in one.
    for end in 0..good.len() - 1 {
        let torn = format!("{}\n", &good[..end]);
        // An empty field means that the readout could not be determined.
        let is_empty = torn.ends_with(",\n") && torn.matches(',').count() == 7;
        assert!(!is_row(&good[..end]) && is_row(&torn) == is_empty, "{torn}");
    }
    assert!(!is_row(&good[..good.len() - 1]) && !is_row(&good.repeat(2)));
    assert!(sweep.parse_row(0, &[200, 10]).is_none());
}

#[test]
fn verification_detects_one_changed_digit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.csv");
    let good = csv(&parsed(SMALL));
    let verified = |text: &str| {
        fs::write(&path, text).unwrap();
        verify(&path, no_fit, |_, _| ControlFlow::Continue(())).unwrap()
    };
    let same = verified(&good);
    assert_eq!((same.rows, same.difference), (6, None));
    assert!(same.notes.is_empty(), "{:?}", same.notes);
    let other_version = good.replace("# gyrolab = \"", "# gyrolab = \"9.");
    let other = verified(&other_version);
    assert_eq!((other.rows, other.difference), (6, None));
    assert!(other.notes[0].starts_with("written by gyrolab 9."));
    let last = good.lines().last().unwrap();
    let cells: Vec<&str> = last.split(',').collect();
    let digit = if cells[2].ends_with('5') { "6" } else { "5" };
    let changed = format!("{}{digit}", &cells[2][..cells[2].len() - 1]);
    let wrong = format!(
        "{}{}\n",
        &good[..good.len() - last.len() - 1],
        last.replace(cells[2], &changed)
    );
    let difference = |text: &str, rows: u64| {
        let found = verified(text);
        assert_eq!(found.rows, rows);
        let found = found.difference.unwrap();
        (found.line as usize, found.to_string())
    };
    let lines = good.lines().count();
    let computed = cells[2];
    let field = format!(
        "line {lines}, the row of motion.steps 3, start.momentum_Js.2 60.0: z_m is {changed}, computed {computed}"
    );
    assert_eq!(difference(&wrong, 5), (lines, field));
    let end = good.len() - last.len() - 1;
    assert_eq!(difference(&good[..end], 5).0, lines);
    assert_eq!(difference(&format!("{good}x\n"), 6).0, lines + 1);
    fs::write(&path, &good).unwrap();
    let stopped = verify(&path, no_fit, |_, _| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(Unverified::Stopped)), "{stopped:?}");
    let (line, _) = difference(&good.replace("z_m,path", "path,z_m"), 0);
    assert_eq!(line, lines - 6);
}

#[test]
fn a_row_that_looks_like_a_header_line_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.csv");
    let good = csv(&parsed(
        "scenario = \"cusps\"\nmeasure = [\"z_m\"]\n\
         [[vary]]\nkey = \"about\"\nvalues = [\"# 1\", \"# gyrolab = 2\"]\n",
    ));
    let verified = |text: &str| {
        fs::write(&path, text).unwrap();
        verify(&path, no_fit, |_, _| ControlFlow::Continue(())).unwrap()
    };
    let same = verified(&good);
    assert_eq!((same.rows, same.difference), (2, None));
    let end = good.trim_end().rfind(',').unwrap();
    let wrong = verified(&format!("{},1\n", &good[..end]));
    assert!(wrong.rows == 1 && wrong.difference.is_some(), "{wrong:?}");
}
