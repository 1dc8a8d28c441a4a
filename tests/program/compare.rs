//! `gyrolab compare`: its table, its CSV, and how it ends.

use crate::support::ground::{Ground, code, done};
use std::fs;
use std::io::Read;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const COLUMNS: [&str; 11] = [
    "scheme",
    "time_step_s",
    "steps",
    "error_m",
    "error_at_end_m",
    "order",
    "energy_drift",
    "L_axle_drift",
    "Lz_drift",
    "ns_per_step",
    "wall_s",
];

fn comparing(ground: &Ground, args: &[&str]) -> Command {
    ground.command(&[&["compare"], args].concat())
}

fn compare(ground: &Ground, args: &[&str]) -> Output {
    comparing(ground, args).output().unwrap()
}

#[track_caller]
fn told(output: Output) -> String {
    assert!(output.stderr.is_empty(), "{output:?}");
    String::from_utf8(done(output).stdout).unwrap()
}

/// The rows of a CSV, as text, in the order of `COLUMNS`.
fn rows(csv: &str) -> Vec<Vec<String>> {
    // Above them stands the run file of the scenario that was compared.
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(csv.as_bytes());
    assert_eq!(
        reader.headers().unwrap().iter().collect::<Vec<_>>(),
        COLUMNS
    );
    reader
        .records()
        .map(|row| row.unwrap().iter().map(str::to_owned).collect())
        .collect()
}

/// The table's lines, heads first: what stands between the two empty lines.
fn table(text: &str) -> Vec<&str> {
    let lines = text.lines().skip_while(|line| !line.is_empty()).skip(1);
    lines.take_while(|line| !line.is_empty()).collect()
}

fn number(row: &[String], column: &str) -> f64 {
    let place = COLUMNS.iter().position(|name| *name == column).unwrap();
    row[place]
        .parse()
        .unwrap_or_else(|_| panic!("{column} is {}", row[place]))
}

/// Time steps at which each scheme shows its order on the cusps, and the order.
const ORDERS: [(&str, &str, f64); 4] = [
    ("report", "0.0002,0.0001,0.00005", 1.0),
    ("rk4", "0.004,0.002,0.001", 4.0),
    ("strang", "0.01,0.005,0.0025", 2.0),
    ("srkn11b", "0.1,0.0625,0.04", 6.0),
];

/// A stack larger than any memory: no thread can be had.
#[test]
fn without_threads_it_takes_one_core() {
    let compare = |least_stack: &str| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_gyrolab"))
            .args(["compare", "cusps", "--steps", "100"])
            .env("RUST_MIN_STACK", least_stack)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        // All but the last column, which is the time it took.
        let lines = text
            .lines()
            .map(|line| line.get(..78).unwrap_or(line).to_owned());
        lines.collect::<Vec<_>>()
    };
    assert_eq!(compare("4611686018427387904"), compare("2097152"));
}

#[test]
fn the_orders_of_the_schemes_are_in_the_table() {
    let lab = Ground::new();
    for (scheme, steps, order) in ORDERS {
        let args = [
            "cusps",
            "--duration",
            "2",
            "--schemes",
            scheme,
            "--time-steps",
            steps,
        ];
        let text = told(compare(&lab, &args));
        let last: Vec<_> = table(&text).pop().unwrap().split_whitespace().collect();
        let seen: f64 = last[5].parse().unwrap();
        assert!(last[0] == scheme && (seen - order).abs() < 0.1, "{text}");
        let csv = told(compare(&lab, &[&args[..], &["-o", "-"]].concat()));
        let rows = rows(&csv);
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0][5], "n/a", "there is none before the first");
        for row in &rows[1..] {
            assert!((number(row, "order") - order).abs() < 0.1, "{csv}");
        }
        assert!(
            rows.windows(2)
                .all(|pair| number(&pair[0], "error_m") > number(&pair[1], "error_m"))
        );
    }
}

#[test]
fn the_table_names_scenario_kind_and_columns() {
    let lab = Ground::new();
    let text = told(compare(&lab, &["cusps", "--duration", "1"]));
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "Cusps, 1 s, against the exact motion (closed form)"
    );
    assert_eq!(lines.next().unwrap(), "");
    let header: Vec<_> = lines.next().unwrap().split_whitespace().collect();
    assert_eq!(
        header,
        [
            "scheme", "dt", "s", "steps", "error", "m", "at", "end", "m", "order", "energy",
            "L.axle", "L_z", "ns/step"
        ]
    );
    let rows: Vec<Vec<_>> = table(&text)[1..]
        .iter()
        .map(|line| line.split_whitespace().collect())
        .collect();
    // All schemes that make an error; the scenario's time step, a half, a quarter, an eighth.
    let expected = ["report", "rk4", "strang", "srkn11b"]
        .iter()
        .flat_map(|scheme| {
            ["0.001 1000", "0.0005 2000", "0.00025 4000", "0.000125 8000"]
                .map(|step| format!("{scheme} {step}"))
        });
    let seen = rows.iter().map(|row| row[..3].join(" "));
    assert!(seen.eq(expected), "{text}");
    let lopsided = told(compare(
        &lab,
        &[
            "cusps",
            "--duration",
            "1",
            "--set",
            "body.point.2={name='lump',at_m=[0.5,0,1],mass_kg=1}",
        ],
    ));
    assert!(
        lopsided.starts_with("Cusps, 1 s, against the exact motion (integration held to 1e-12)\n"),
        "{lopsided}"
    );
}

#[test]
fn schemes_and_time_steps_are_those_asked_for() {
    let lab = Ground::new();
    let args = [
        "method-2",
        "--duration",
        "2",
        "--schemes",
        "strang,exact,report",
        "--time-steps",
        "0.01,0.05,0.02,0.05",
        "-o",
        "-",
    ];
    let rows = rows(&told(compare(&lab, &args)));
    let seen: Vec<_> = rows.iter().map(|row| row[..3].join(" ")).collect();
    let expected = ["strang", "exact", "report"].iter().flat_map(|scheme| {
        ["0.05 40", "0.02 100", "0.01 200"].map(|step| format!("{scheme} {step}"))
    });
    assert_eq!(
        seen,
        expected.collect::<Vec<_>>(),
        "from coarse to fine, each once"
    );
    for row in rows.iter().filter(|row| row[0] == "exact") {
        assert!(
            number(row, "error_m") < 1e-12 && row[5] == "n/a",
            "rounding has no order: {row:?}"
        );
    }
    assert!(
        rows.iter()
            .all(|row| number(row, "Lz_drift") < 1e-15 && number(row, "ns_per_step") > 0.0)
    );
    let one = told(compare(
        &lab,
        &[
            "method-2",
            "--duration",
            "2",
            "--scheme",
            "rk4",
            "--time-steps",
            "0.001",
        ],
    ));
    assert!(
        table(&one).len() == 2 && table(&one)[1].starts_with("rk4 "),
        "{one}"
    );
}

#[test]
fn the_numbers_of_the_table_are_those_of_the_wobble() {
    // A push that is counted in steps keeps its 20 s at every time step.
    let lab = Ground::new();
    let csv = told(compare(
        &lab,
        &[
            "wobble-push",
            "--schemes",
            "report",
            "--time-steps",
            "0.1,0.02,0.01,0.001",
            "-o",
            "-",
        ],
    ));
    let errors: Vec<_> = rows(&csv)
        .iter()
        .map(|row| number(row, "error_m"))
        .collect();
    // 14 % up of z0 = 0.8 m and 23 % down at 0.1 and 0.02 s, and aside as much again.
    let expected = [0.386, 0.391, 1.9e-3, 1.2e-4];
    for (error, expected) in errors.iter().zip(expected) {
        assert!((error / expected - 1.0).abs() < 0.05, "{csv}");
    }
}

#[test]
fn a_file_is_written_whole_and_not_written_over() {
    let lab = Ground::new();
    let args = ["cusps", "--duration", "0.1", "-o", "table.csv"];
    let text = told(compare(&lab, &args));
    let csv = fs::read_to_string(lab.path().join("table.csv")).unwrap();
    assert_eq!(rows(&csv).len(), 16);
    assert!(
        text.contains("ns/step"),
        "the table is for the reader all the same"
    );
    let again = compare(&lab, &args);
    assert_eq!(code(&again), 1);
    assert!(
        String::from_utf8_lossy(&again.stderr).contains("--force"),
        "{again:?}"
    );
    assert_eq!(
        fs::read_to_string(lab.path().join("table.csv")).unwrap(),
        csv
    );
    let shorter = [
        "cusps",
        "--duration",
        "0.1",
        "--schemes",
        "rk4",
        "-o",
        "table.csv",
        "--force",
    ];
    told(compare(&lab, &shorter));
    assert_eq!(
        rows(&fs::read_to_string(lab.path().join("table.csv")).unwrap()).len(),
        4
    );
    assert_eq!(lab.files(), ["table.csv"]);
    let nowhere = compare(&lab, &["cusps", "--duration", "0.1", "-o", "no/where.csv"]);
    assert_eq!(code(&nowhere), 1);
}

#[test]
fn a_scheme_that_is_named_twice_is_compared_once() {
    let rows = |schemes: &str| {
        let usual = [
            "compare",
            "torque-free",
            "--duration",
            "0.01",
            "-o",
            "-",
            "--schemes",
        ];
        let output = Ground::new().run(&[&usual[..], &[schemes]].concat());
        assert!(output.status.success());
        let csv = String::from_utf8(output.stdout).unwrap();
        csv.lines().filter(|line| !line.starts_with('#')).count()
    };
    assert_eq!(rows("report,rk4,report"), rows("report,rk4"));
}

#[test]
fn wrong_usage_is_refused() {
    let lab = Ground::new();
    for (args, expected) in [
        (&["cusps", "--schemes", "nonsense"][..], 2),
        (&["cusps", "--schemes", "rk4,nonsense"], 2),
        (&["cusps", "--time-steps", "0"], 2),
        (&["cusps", "--time-steps", "-0.1"], 2),
        (&["cusps", "--time-steps", "nan"], 2),
        (&["cusps", "--time-steps", "0.1,,0.2"], 2),
        (&["cusps", "--duration", "0"], 2),
        (&[], 2),
        (&["no-such-preset"], 1),
        (&["cusps", "--set", "motion.time_step_s=0"], 1),
    ] {
        let output = compare(&lab, args);
        assert_eq!(code(&output), expected, "{args:?}: {output:?}");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            !said.is_empty() && !said.contains("panicked"),
            "{args:?}: {said}"
        );
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_lopsided_run_that_would_take_too_long_is_refused_with_a_remedy() {
    let lab = Ground::new();
    let lump = "body.point.2={name='lump',at_m=[0.5,0,1],mass_kg=1}";
    let output = compare(&lab, &["cusps", "--duration", "1e7", "--set", lump]);
    assert_eq!(code(&output), 1, "{output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    for word in ["cusps", "too long", "10000000 s", "--duration"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    assert_eq!(lab.files(), [""; 0]);
}

#[test]
fn a_scheme_whose_numbers_break_has_no_error_to_show() {
    let lab = Ground::new();
    let args = [
        "cusps",
        "--schemes",
        "report,rk4",
        "--time-steps",
        "0.1,0.05",
        "--duration",
        "1",
        "--set",
        "start.momentum_Js=[0,0,1e50]",
    ];
    let text = told(compare(&lab, &args));
    assert_eq!(
        text.lines()
            .filter(|line| line.starts_with("rk4") && line.contains("n/a"))
            .count(),
        2,
        "{text}"
    );
    let csv = told(compare(&lab, &[&args[..], &["-o", "-"]].concat()));
    for row in rows(&csv) {
        let broke = row[0] == "rk4";
        assert_eq!(broke, number(&row, "steps") < 10.0, "{csv}");
        assert_eq!(
            broke,
            row[3] == "n/a" && row[4] == "n/a" && row[5] == "n/a",
            "{csv}"
        );
    }
    // Nor has one beside an exact motion that leaves the range of numbers.
    let csv = told(compare(
        &lab,
        &[&args[..8], &["start.momentum_Js=[0,0,1e100]", "-o", "-"]].concat(),
    ));
    assert!(rows(&csv).iter().all(|row| row[3] == "n/a"), "{csv}");
}

#[test]
fn a_signal_ends_it_with_130_and_leaves_no_file() {
    let lab = Ground::new();
    // One scheme whose looks are far apart, and many on all cores.
    for args in [
        &[
            "method-2",
            "--schemes",
            "report",
            "--time-steps",
            "1e-12",
            "-o",
            "t.csv",
        ][..],
        &["cusps", "--duration", "1e5", "-o", "t.csv"],
    ] {
        let mut child = comparing(&lab, args)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while lab.files().is_empty() {
            assert!(
                child.try_wait().unwrap().is_none(),
                "{args:?} has ended by itself"
            );
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(200));
        let kill = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status()
            .unwrap();
        assert!(kill.success());
        let status = child.wait().unwrap();
        let mut said = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut said)
            .unwrap();
        assert_eq!(status.code(), Some(130), "{args:?}: {said}");
        assert_eq!(lab.files(), [""; 0], "{args:?}");
    }
}

#[test]
fn one_core_and_two_give_the_same_numbers() {
    let lab = Ground::new();
    let numbers = |threads: &str| {
        let mut command = comparing(&lab, &["wobble-push", "--duration", "30", "-o", "-"]);
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        rows(&told(output))
            .into_iter()
            .map(|mut row| {
                row.truncate(9); // all but what it cost
                row
            })
            .collect::<Vec<_>>()
    };
    let one = numbers("1");
    assert_eq!(one.len(), 16);
    assert_eq!(one, numbers("2"));
    assert_eq!(one, numbers("3"));
}

#[test]
fn time_steps_that_cannot_be_counted_are_refused_with_a_remedy() {
    let output = Ground::new().run(&["compare", "cusps", "--time-steps", "1e-300"]);
    assert_eq!(code(&output), 1);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        stderr.contains("--time-steps 1e-300 would be")
            && stderr.contains("give longer time steps"),
        "{stderr}"
    );
}

#[test]
fn runs_that_break_down_are_told_below_the_table() {
    let lab = Ground::new();
    let told = |scheme: &str| {
        let table = done(lab.run(&[
            "compare",
            "method-2",
            "--duration",
            "1",
            "--schemes",
            scheme,
        ]));
        String::from_utf8(table.stdout)
            .unwrap()
            .contains("the run broke down")
    };
    assert!(told("rk4"));
    assert!(!told("srkn11b"));
}
