//! `gyrolab compare`: its table, its CSV and its exit codes.

use crate::support::ground::{Ground, done};
use crate::support::words::has;
use gyrolab::physics::scheme::SCHEMES;
use std::process::Output;

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
/// A mass off the axle.
const LUMP: &str = "body.point.2={name='lump',at_m=[0.5,0,1],mass_kg=1}";

/// Runs `gyrolab compare` with `args`, which must succeed without output on stderr, and returns its stdout.
#[track_caller]
fn told(ground: &Ground, args: &str) -> String {
    successful(ground.run(&format!("compare {args}")))
}

#[track_caller]
fn successful(output: Output) -> String {
    assert!(output.stderr.is_empty(), "{output:?}");
    String::from_utf8(done(output).stdout).unwrap()
}

/// Parses the rows of a CSV as text, in the order of `COLUMNS`.
fn rows(csv: &str) -> Vec<Vec<String>> {
    // The run file of the compared scenario precedes them.
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(csv.as_bytes());
    assert!(reader.headers().unwrap().iter().eq(COLUMNS), "{csv}");
    let rows = reader.records().map(Result::unwrap);
    rows.map(|row| row.iter().map(str::to_owned).collect())
        .collect()
}

/// Returns the lines of the table, headings first: those between the two empty lines.
fn table(text: &str) -> Vec<&str> {
    let lines = text.lines().skip_while(|line| !line.is_empty()).skip(1);
    lines.take_while(|line| !line.is_empty()).collect()
}

fn number(row: &[String], column: &str) -> f64 {
    let place = COLUMNS.iter().position(|name| *name == column).unwrap();
    let cell = &row[place];
    cell.parse()
        .unwrap_or_else(|_| panic!("{column} is {cell}"))
}

/// The schemes with a truncation error.
fn inexact_schemes() -> impl Iterator<Item = (&'static str, u32)> {
    let schemes = SCHEMES.iter();
    schemes.filter_map(|scheme| Some((scheme.name, scheme.order?)))
}

/// Time steps at which a scheme of this order converges visibly on the preset cusps.
fn steps_for(order: u32) -> &'static str {
    match order {
        1 => "0.0002,0.0001,0.00005",
        2 => "0.01,0.005,0.0025",
        3 | 4 => "0.004,0.002,0.001",
        _ => "0.1,0.0625,0.04",
    }
}

#[test]
fn the_orders_of_the_schemes_are_in_the_table() {
    let lab = Ground::new();
    for (scheme, whole_order) in inexact_schemes() {
        let (steps, order) = (steps_for(whole_order), f64::from(whole_order));
        let args = format!("cusps --duration 2 --schemes {scheme} --time-steps {steps}");
        let text = told(&lab, &args);
        let last: Vec<_> = table(&text).pop().unwrap().split_whitespace().collect();
        let seen: f64 = last[5].parse().unwrap();
        assert!(last[0] == scheme && (seen - order).abs() < 0.1, "{text}");
        let csv = told(&lab, &format!("{args} -o -"));
        let rows = rows(&csv);
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0][5], "n/a", "no order for the first time step");
        for pair in rows.windows(2) {
            assert!((number(&pair[1], "order") - order).abs() < 0.1, "{csv}");
            assert!(number(&pair[0], "error_m") > number(&pair[1], "error_m"));
        }
    }
}

#[test]
fn the_table_names_scenario_reference_and_columns() {
    let lab = Ground::new();
    let text = told(&lab, "cusps --duration 1");
    let begin = "Cusps, 1 s, against the exact motion (closed form)\n\n";
    assert!(text.starts_with(begin), "{text}");
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let heads = "scheme dt s steps error m at end m order energy L.axle L_z ns/step";
    assert_eq!(words(table(&text)[0]), heads);
    // All schemes with a truncation error, at the scenario's time step and 1/2, 1/4 and 1/8 of it.
    let expected: Vec<_> = inexact_schemes()
        .flat_map(|(scheme, _)| {
            ["0.001 1000", "0.0005 2000", "0.00025 4000", "0.000125 8000"]
                .map(|step| format!("{scheme} {step} "))
        })
        .collect();
    assert_eq!(table(&text).len(), 1 + expected.len());
    for (row, cells) in table(&text)[1..].iter().zip(expected) {
        assert!(words(row).starts_with(&cells), "{cells}: {text}");
    }
    let lopsided = told(&lab, &format!("cusps --duration 1 --set \"{LUMP}\""));
    let by_integration = "Cusps, 1 s, against the exact motion (integration held to 1e-12)\n";
    assert!(lopsided.starts_with(by_integration), "{lopsided}");
}

#[test]
fn the_requested_schemes_and_time_steps_are_compared() {
    let lab = Ground::new();
    let args =
        "method-2 --duration 2 --schemes strang,exact,report --time-steps 0.01,0.05,0.02,0.05 -o -";
    let rows = rows(&told(&lab, args));
    let seen: Vec<_> = rows.iter().map(|row| row[..3].join(" ")).collect();
    let expected: Vec<_> = ["strang", "exact", "report"]
        .iter()
        .flat_map(|scheme| {
            ["0.05 40", "0.02 100", "0.01 200"].map(|step| format!("{scheme} {step}"))
        })
        .collect();
    assert_eq!(seen, expected, "from coarse to fine, each once");
    for row in &rows {
        assert!(number(row, "Lz_drift") < 1e-15 && number(row, "ns_per_step") > 0.0);
        let rounding_has_no_order = number(row, "error_m") < 1e-12 && row[5] == "n/a";
        assert!(row[0] != "exact" || rounding_has_no_order, "{row:?}");
    }
    let one = told(
        &lab,
        "method-2 --duration 2 --scheme rk4 --time-steps 0.001",
    );
    let table = table(&one);
    assert!(table.len() == 2 && table[1].starts_with("rk4 "), "{one}");
}

#[test]
fn the_wobble_shrinks_with_the_time_step() {
    // A push counted in steps still lasts 20 s at every time step.
    let args = "wobble-push --schemes report --time-steps 0.1,0.02,0.01,0.001 -o -";
    let csv = told(&Ground::new(), args);
    // At 0.1 and 0.02 s: 14 % of z0 = 0.8 m up and 23 % down, and as much to the side.
    for (row, expected) in rows(&csv).iter().zip([0.386, 0.391, 1.9e-3, 1.2e-4]) {
        let ratio = number(row, "error_m") / expected;
        assert!((ratio - 1.0).abs() < 0.05, "{csv}");
    }
    assert_eq!(rows(&csv).len(), 4);
}

#[test]
fn a_comparison_file_is_complete_and_not_overwritten() {
    let lab = Ground::new();
    let args = "cusps --duration 0.1 -o table.csv";
    let text = told(&lab, args);
    let csv = lab.read("table.csv");
    assert_eq!(rows(&csv).len(), 4 * inexact_schemes().count());
    has(&text, "ns/step"); // the table is printed as well
    lab.refused(&format!("compare {args}"), 1, &["--force"]);
    assert_eq!(lab.read("table.csv"), csv);
    told(&lab, &format!("{args} --schemes rk4 --force"));
    assert_eq!(rows(&lab.read("table.csv")).len(), 4);
    lab.refused("compare cusps --duration 0.1 -o no/where.csv", 1, &[]);
    assert_eq!(lab.files(), ["table.csv"]);
}

#[test]
fn a_repeated_scheme_is_compared_once() {
    let rows = |schemes: &str| {
        let args = format!("compare torque-free --duration 0.01 -o - --schemes {schemes}");
        rows(&Ground::new().stdout(&args)).len()
    };
    assert_eq!(rows("report,rk4,report"), rows("report,rk4"));
}

#[test]
fn invalid_comparisons_are_rejected() {
    let lab = Ground::new();
    let too_long = format!("cusps --duration 1e7 --set \"{LUMP}\"");
    for (args, code, words) in [
        ("cusps --schemes nonsense", 2, &[][..]),
        ("cusps --schemes rk4,nonsense", 2, &[]),
        ("cusps --time-steps 0", 2, &[]),
        ("cusps --time-steps -0.1", 2, &[]),
        ("cusps --time-steps nan", 2, &[]),
        ("cusps --time-steps 0.1,,0.2", 2, &[]),
        ("cusps --duration 0", 2, &[]),
        ("", 2, &[]),
        ("no-such-preset", 1, &[]),
        ("cusps --set motion.time_step_s=0", 1, &[]),
        (
            &too_long,
            1,
            &["cusps", "too long", "10000000 s", "--duration"],
        ),
        (
            "cusps --time-steps 1e-300",
            1,
            &["--time-steps 1e-300 needs", "use longer time steps"],
        ),
    ] {
        lab.refused(&format!("compare {args}"), code, words);
        let output = lab.run(&format!("compare {args}"));
        assert!(output.stdout.is_empty() && !output.stderr.is_empty());
    }
    assert_eq!(lab.files(), [""; 0]);
}

#[test]
fn a_scheme_with_non_finite_numbers_has_no_error() {
    let lab = Ground::new();
    let args = |momentum: &str| {
        let set = format!("start.momentum_Js=[0,0,{momentum}]");
        format!("cusps --schemes report,rk4 --time-steps 0.1,0.05 --duration 1 --set {set}")
    };
    let text = told(&lab, &args("1e50"));
    assert_eq!(
        text.lines()
            .filter(|line| line.starts_with("rk4") && line.contains("n/a"))
            .count(),
        2,
        "{text}"
    );
    let csv = told(&lab, &format!("{} -o -", args("1e50")));
    for row in rows(&csv) {
        let broke = row[0] == "rk4";
        assert_eq!(broke, number(&row, "steps") < 10.0, "{csv}");
        let none = row[3..6].iter().all(|cell| cell == "n/a");
        assert_eq!(broke, none, "{csv}");
    }
    // There is no error either if the exact motion overflows.
    let unbounded = told(&lab, &format!("{} -o -", args("1e100")));
    assert!(
        rows(&unbounded).iter().all(|row| row[3] == "n/a"),
        "{unbounded}"
    );
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let lab = Ground::new();
    let numbers = |threads: &str| {
        let mut command = lab.command("compare wobble-push --duration 30 -o -");
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        let mut rows = rows(&successful(output));
        rows.iter_mut().for_each(|row| row.truncate(9)); // without the time per step
        rows
    };
    let one = numbers("1");
    assert_eq!(one, numbers("2"));
    assert_eq!(one, numbers("3"));
}

#[test]
fn runs_that_break_down_are_listed_below_the_table() {
    for (scheme, breaks) in [("rk4", true), ("srkn11b", false)] {
        let args = format!("compare method-2 --duration 1 --schemes {scheme}");
        let table = Ground::new().stdout(&args);
        assert_eq!(table.contains("no longer finite after"), breaks, "{table}");
    }
}
