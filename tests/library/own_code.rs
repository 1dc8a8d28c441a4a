//! Users' programs with the report's scheme: mistakes are identified, correct programs pass, broken files are rejected.
//!
//! `tests/own_code` contains the files, and `program.py`, which produced them and is independent of gyrolab.

use crate::support::desk::Desk;
use crate::support::ground::names;
use crate::support::scenarios::preset;
use crate::support::words::has_all;
use gyrolab::physics::workings::WorkedValue;
use gyrolab::studies::own_code::{self, Explanations, Precision, ProgramRows, Verdict, rows};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/own_code")
        .join(name)
}

/// Returns the names of the files in a folder without their extensions, and their texts.
fn files(name: &str) -> Vec<(String, String)> {
    let folder = folder(name);
    let all: Vec<_> = names(&folder)
        .into_iter()
        .map(|file| {
            let text = fs::read_to_string(folder.join(&file)).unwrap();
            (file.trim_end_matches(".csv").to_owned(), text)
        })
        .collect();
    assert!(all.len() >= 10, "{name}: {}", all.len());
    all
}

fn read(text: &str, map: &str, every: Option<u64>, dt: f64) -> Result<ProgramRows, String> {
    let pairs = map.split(',').filter_map(|pair| pair.split_once('='));
    let columns: Vec<_> = pairs
        .map(|(own, ours)| (own.to_owned(), ours.to_owned()))
        .collect();
    rows::read(text, &columns, every, dt)
        .map_err(|problems| problems.in_file("mine.csv").to_string())
}

fn judge(text: &str, against: &str, sets: &[&str]) -> Verdict {
    let scenario = Arc::new(preset(against, sets));
    let rows = read(text, "", None, scenario.motion.time_step_s).unwrap();
    own_code::compare(&rows, against, &scenario, &|| true).unwrap()
}

/// Returns the expected mistakes of a file: those in its name.
fn expected_slips(file: &str) -> Vec<&str> {
    file.split('+')
        .map(|slip| slip.split('_').next().unwrap())
        .collect()
}

/// True if the verdict explains the rows of `file` by the mistakes in its name, and calls this explanation unique only if
/// it is.
fn is_explained(verdict: &Verdict, file: &str) -> bool {
    let mut expected = expected_slips(file);
    expected.sort_unstable();
    let slips: Vec<_> = verdict
        .slips
        .iter()
        .cloned()
        .map(|mut slips| {
            slips.sort_unstable();
            slips
        })
        .collect();
    let is_unique = verdict.explanations == Explanations::Unique;
    slips.contains(&expected) && (!is_unique || slips.len() == 1)
}

/// Files whose rows have more than one explanation, or too few rows before rounding dominates.
const SEVERAL: &[&str] = &[
    "every-slip/L-kept",
    "every-slip/L-turned_only",
    "every-slip/gravity-up",
    "every-slip/torque-reversed",
    "every-slip/push-reversed",
    "every-slip/omega-squared_axis",
    "every-slip/rotation-without-E",
    "every-slip/rotation-without-E_left-out",
    "every-slip/start-of-another-preset_push",
    "every-slip/torque-about-cm",
    "every-slip/torque-of-centre_all",
    "method-1/no-gravity",
    "method-1/points-in-place",
    "wobble-push/gravity-up",
    "wobble-push/torque-reversed",
];

#[test]
fn every_single_mistake_is_identified() {
    for scenario in ["every-slip", "method-1", "method-2", "wobble-push"] {
        for (file, text) in files(scenario) {
            let verdict = judge(&text, scenario, &[]);
            let path = format!("{scenario}/{file}");
            assert!(
                !verdict.agrees && is_explained(&verdict, &file),
                "{path}: {:?}",
                verdict.lines
            );
            let is_unique = verdict.explanations == Explanations::Unique;
            let expected = !SEVERAL.contains(&&*path);
            assert_eq!(is_unique, expected, "{path}: {:?}", verdict.lines);
        }
    }
}

#[test]
fn pairs_of_mistakes_are_identified() {
    let files = files("pairs");
    assert_eq!(files.len(), 32);
    for (file, text) in files {
        let verdict = judge(&text, "every-slip", &[]);
        if file == "inertia-product-sign+dt-forgotten" {
            // Rounding dominates from the third row on.
            assert_eq!(verdict.explanations, Explanations::None);
            continue;
        }
        assert!(is_explained(&verdict, &file), "{file}: {:?}", verdict.lines);
    }
}

/// The expected verdict on a file of `tests/own_code/cases`: the file, its scenario, whether it agrees, one of its
/// explanations, and words of the verdict.
type Case<'a> = (&'a str, &'a str, bool, &'a [&'a str], &'a str);

#[test]
fn explanations_cover_all_rows_within_the_digits() {
    let cases: [Case<'_>; 12] = [
        (
            "g-9.80665-4-decimals",
            "method-1",
            true,
            &[],
            "With 4 decimals",
        ),
        (
            "mean-torque",
            "method-2-slow",
            false,
            &["torque-before-turn"],
            "These rows are also produced by",
        ),
        (
            "g-9.80665-3-decimals",
            "method-2-slow",
            false,
            &[],
            "With 3 decimals",
        ),
        ("twelve-masses", "method-2-slow", false, &[], "None of"),
        (
            "P-forgotten",
            "method-2",
            false,
            &["projector-missing"],
            "is not a rotation: the top is 1.131371 m from the pivot at step 0 and 0 m at step 1",
        ),
        (
            "push-up",
            "wobble-push",
            false,
            &["push-reversed"],
            "opposite sign",
        ),
        (
            "push-on-hub",
            "every-slip",
            false,
            &["push-on-another-point"],
            "the center of the rim",
        ),
        (
            "literal-cm",
            "method-2",
            false,
            &["torque-about-cm"],
            "formula (1)",
        ),
        (
            "torque-about-cm",
            "every-slip",
            false,
            &["torque-about-cm"],
            "all 401 rows",
        ),
        (
            "weight-5kg-each",
            "method-2",
            false,
            &["total-mass-on-each"],
            "dt-missing-in-torque",
        ),
        (
            "dt-twice",
            "method-2",
            false,
            &["dt-squared"],
            "torque-of-centre",
        ),
        (
            "inertia-sums-up",
            "every-slip",
            false,
            &["inertia-sums-up"],
            "adds up over the steps",
        ),
    ];
    for (file, scenario, agrees, slips, told) in cases {
        let text = fs::read_to_string(folder("cases").join(format!("{file}.csv"))).unwrap();
        let verdict = judge(&text, scenario, &[]);
        let lines = verdict.lines.join("\n");
        assert_eq!(verdict.agrees, agrees, "{file}: {lines}");
        has_all(&lines, [told]);
        assert!(!lines.contains("single"), "{file}: {lines}");
        match slips {
            [] => assert_ne!(
                verdict.explanations,
                Explanations::Unique,
                "{file}: {lines}"
            ),
            slips => assert!(
                verdict.slips.iter().any(|it| it == slips),
                "{file}: {lines}"
            ),
        }
        let is_short =
            file.starts_with("g-") || file.starts_with("mean") || file.starts_with("twelve");
        let precision = if is_short {
            Precision::Unknown
        } else {
            Precision::Double
        };
        assert_eq!(verdict.precision, precision, "{file}: {lines}");
    }
}

/// A constant column counts with the digits that it is written with.
#[test]
fn two_rows_of_few_digits_agree_with_unknown_precision() {
    let text = "step,Lx_Js,Lz_Js\n0,400.0,2000.0\n1,400.0,2000.0\n";
    let verdict = judge(text, "method-1", &[]);
    assert!(verdict.agrees, "{:?}", verdict.lines);
    assert_eq!((verdict.precision, verdict.digits), (Precision::Unknown, 4));
    has_all(&verdict.lines.join("\n"), ["write 7 or more"]);
}

#[test]
fn mistakes_in_single_precision_are_identified_as_such() {
    for file in ["gravity-9.81", "torque-before-turn"] {
        let text = fs::read_to_string(folder("single").join(format!("{file}.csv"))).unwrap();
        let verdict = judge(&text, "every-slip", &[]);
        let lines = verdict.lines.join("\n");
        assert_eq!(verdict.precision, Precision::Single, "{file}: {lines}");
        assert!(
            !verdict.agrees && is_explained(&verdict, file),
            "{file}: {lines}"
        );
        has_all(&lines, ["single precision", file]);
    }
}

/// The first row differs from the start of the program that produced the others.
#[test]
fn an_explanation_must_cover_every_row() {
    let text = fs::read_to_string(folder("every-slip/gravity-10.csv")).unwrap();
    let moved = text.replacen("\n0,0,0,", "\n0,0,0.5,", 1);
    assert_ne!(moved, text);
    let verdict = judge(&moved, "every-slip", &[]);
    assert!(
        !verdict.agrees && verdict.slips.is_empty(),
        "{:?}",
        verdict.lines
    );
}

#[test]
fn correct_programs_agree_with_any_number_of_digits() {
    for (file, text) in files("right") {
        let (scenario, kind) = file.rsplit_once('-').unwrap();
        let verdict = judge(&text, scenario, &[]);
        let precision = match verdict.digits {
            ..7 => Precision::Unknown,
            _ if kind == "single" => Precision::Single,
            _ => Precision::Double,
        };
        assert!(
            verdict.agrees && verdict.slips.is_empty(),
            "{file}: {:?}",
            verdict.lines
        );
        assert_eq!((verdict.precision, verdict.rows), (precision, 51), "{file}");
        if kind == "17g" && scenario == "every-slip" {
            assert!(verdict.unseen.is_empty(), "{:?}", verdict.unseen);
        }
        if kind == "17g" && scenario == "method-1" {
            let hidden = [
                "inertia-kept",
                "inertia-diagonal",
                "tilt-in-radians",
                "push-late",
            ];
            assert!(
                hidden.iter().all(|slip| verdict.unseen.contains(slip)),
                "{:?}",
                verdict.unseen
            );
        }
    }
}

/// Rows need no times in the lab, and a background thread computes the verdict.
#[test]
fn the_lab_shows_the_mistaken_numbers_of_the_first_differing_step() {
    let text = fs::read_to_string(folder("every-slip/torque-before-turn.csv")).unwrap();
    let verdict = judge(&text, "every-slip", &[]);
    let bare = tempfile::NamedTempFile::new().unwrap();
    let without_times = text.replacen("t_s", "clock", 1);
    fs::write(&bare, without_times).unwrap();
    let mut desk = Desk::open("every-slip");
    desk.commands(&format!("measured = '{}'", bare.path().display()));
    let is_found = |at: &Desk| at.lab.comparison().own_code().unwrap().verdict().is_some();
    while !is_found(&desk) {
        desk.wait(1);
        std::thread::yield_now();
    }
    let own = desk.lab.comparison().own_code().unwrap();
    assert_eq!(own.verdict().unwrap().lines[..2], verdict.lines[..2]);
    let first = verdict.first_step.unwrap() as u64;
    desk.press(&[Key::Char('M')]);
    assert_eq!(desk.step(), first);
    desk.commands("phase = 'torque'");
    let shown = screen::text(&desk.lab, false, (80, 50));
    has_all(&shown, ["torque-before-turn", "yours", "differs at"]);
    // The shown numbers equal those of the row.
    let found = desk.lab.comparison().own_code().unwrap();
    let numbers = found.trial().unwrap().numbers(first).unwrap();
    let momentum = numbers.iter().find(|(_, it)| it.symbol == "new L").unwrap();
    let WorkedValue::Vector(momentum) = momentum.1.value else {
        panic!("{momentum:?}")
    };
    let row = text
        .lines()
        .find(|line| line.starts_with(&format!("{first},")))
        .unwrap();
    let written: f64 = row.split(',').nth(5).unwrap().parse().unwrap();
    assert!((written - momentum.x).abs() < 1e-9, "{row}: {}", momentum.x);
}

#[test]
fn rows_without_an_explanation_are_reported() {
    let text = fs::read_to_string(folder("right/every-slip-17g.csv")).unwrap();
    for set in ["push.0.force_N.2=-99", "start.momentum_Js.0=4"] {
        let verdict = judge(&text, "every-slip", &[set]);
        assert!(!verdict.agrees && verdict.slips.is_empty(), "{set}");
        has_all(&verdict.lines.join("\n"), ["These rows are every-slip's"]);
    }
    let (rows, _) = text.split_at(text.find("\n1000,").unwrap());
    for (last, told) in [
        ("1000,1,0.1,0.2,0.3,1,2,3", "not a rotation"),
        ("1000,1,-0.7,-0.45,1.82,-20,-3,50", "alone or in pairs"),
    ] {
        let verdict = judge(&format!("{rows}\n{last}\n"), "every-slip", &[]);
        assert!(!verdict.agrees && verdict.slips.is_empty(), "{last}");
        has_all(&verdict.lines.join("\n"), ["None of", told]);
    }
    let elsewhere = judge("step,x_m,y_m,z_m\n0,0,0,1.5\n", "every-slip", &[]);
    let told = ["Its top starts 1.50 m from the pivot", "2.00 m"];
    has_all(&elsewhere.lines.join("\n"), told);
}

#[test]
fn a_program_without_motion_does_not_agree() {
    let text = "step,x_m,y_m,z_m\n0,0,0,1.131370849898476\n1,0,0,1.131370849898476\n";
    let verdict = judge(text, "method-1", &[]);
    assert_eq!((verdict.agrees, verdict.first_step), (false, Some(1)));
}

/// A file is read in any number format, and may lack its first row or repeat it.
#[test]
fn the_same_rows_agree_in_every_number_format() {
    let text = fs::read_to_string(folder("right/every-slip-10g.csv")).unwrap();
    let (names, rows) = text.split_once('\n').unwrap();
    let parted = |cells: &str, separator: &str, point: &str| {
        cells.replace(',', separator).replace('.', point)
    };
    let by_number = "1=step,2=t_s,3=x_m,4=y_m,5=z_m,6=Lx_Js,7=Ly_Js,8=Lz_Js";
    let foreign = "n, time, X, Y, Z, LX, LY, LZ";
    let by_name = "n=step,time=t_s,X=x_m,Y=y_m,Z=z_m,LX=Lx_Js,LY=Ly_Js,LZ=Lz_Js";
    for (printed, map, offset) in [
        (text.clone(), "", 0),
        (parted(&text, ";", ","), "", 0),
        (parted(&text, "\t", ","), "", 0),
        (parted(&text, "   ", "."), "", 0),
        (parted(rows, "  ", ","), by_number, 0),
        (rows.replace(',', ", "), by_number, 0),
        (format!("{foreign}\n{rows}"), by_name, 0),
        (format!("# {names}\n{rows}"), by_number, 0),
        (
            rows.split_once('\n').unwrap().1.to_owned(),
            "3=x_m,4=y_m",
            1,
        ),
        (
            format!("{}\n{rows}", rows.split_once('\n').unwrap().0),
            "3=x_m,4=y_m,8=Lz_Js",
            -1,
        ),
    ] {
        let scenario = Arc::new(preset("every-slip", &[]));
        let own = read(&printed, map, Some(40), scenario.motion.time_step_s).unwrap();
        let verdict = own_code::compare(&own, "every-slip", &scenario, &|| true).unwrap();
        assert!(
            verdict.agrees && verdict.rows >= 50,
            "{map}: {:?}",
            verdict.lines
        );
        assert_eq!(verdict.offset, offset, "{printed:.200}");
    }
}

#[test]
fn broken_files_are_rejected_with_line_and_remedy() {
    for (text, map, told) in [
        ("", "", ["mine.csv", "has no columns"]),
        ("step,x_m\n", "", ["mine.csv", "has no rows"]),
        ("1,2\n3,4\n", "", ["no line of names", "--map"]),
        ("a,b\n1,2\n", "", ["none of the columns", "--map a=x_m"]),
        (
            "a,b\n1,2\n",
            "c=x_m",
            [
                "--map c=x_m",
                "is not a name or number of a column in the file",
            ],
        ),
        (
            "a,b\n1,2\n",
            "3=x_m",
            [
                "--map 3=x_m",
                "is not a name or number of a column in the file",
            ],
        ),
        (
            "a,b\n1,2\n",
            "a=X",
            ["--map a=X", "is not a known column name"],
        ),
        ("x_m,x_m\n1,2\n", "", ["mine.csv:1: x_m", "leave one out"]),
        (
            "step,x_m\n0,1\n1,2,3\n",
            "",
            ["mine.csv:3", "cells: 3, columns: 2"],
        ),
        (
            "step,x_m\n0,1\n1,high\n",
            "",
            ["mine.csv:3: x_m (high)", "must be a number"],
        ),
        (
            "step,x_m\n0,1\n1,\n",
            "",
            ["mine.csv:3: x_m", "write a number in every row"],
        ),
        (
            "step,x_m\n0,NaN\n",
            "",
            ["mine.csv:2: x_m", "nothing to compare"],
        ),
        (
            "step,x_m\n0,1\n0.5,1\n",
            "",
            ["mine.csv:3: step (0.5)", "the number of a step"],
        ),
        (
            "step,x_m\n1,1\n0,1\n",
            "",
            ["mine.csv:3: step (0)", "greater than in the row above"],
        ),
        (
            "step,x_m\n1e12,1\n",
            "",
            ["mine.csv:2: step", "the number of a step"],
        ),
        (
            "t_s,x_m\n0,1\n0.0015,1\n0.0301,1\n",
            "",
            ["mine.csv: t_s", "the number of the step too"],
        ),
    ] {
        let refused = read(text, map, None, 1e-3).expect_err(text);
        has_all(&refused, told);
    }
}

/// The rows before the first non-finite number are compared, and the file does not agree.
#[test]
fn a_run_that_ends_in_nan_does_not_agree() {
    let text = fs::read_to_string(folder("right/method-1-17g.csv")).unwrap();
    let verdict = judge(&(text + "2040,2.04,NaN,1,1,1,1,1\n"), "method-1", &[]);
    assert!(!verdict.agrees && verdict.slips.is_empty());
    has_all(&verdict.lines.join("\n"), ["not finite", "line 53"]);
}
