//! `gyrolab figure`: its files and its exit codes.

use crate::support::ground::{Ground, code, done, failed, stderr};
use std::fs;

#[track_caller]
fn draw(ground: &Ground, args: &[&str]) -> String {
    let output = ground.run(&[&["figure"], args].concat());
    assert!(output.stdout.is_empty(), "{output:?}");
    stderr(&done(output)).to_owned()
}

#[test]
fn a_figure_is_written_in_every_format() {
    let ground = Ground::new();
    for (file, begin) in [
        ("a.svg", &b"<"[..]),
        ("a.pdf", b"%PDF-"),
        ("a.png", b"\x89PNG"),
    ] {
        let told = draw(&ground, &["method-2", "--steps", "300", "-o", file]);
        assert!(told.contains("86 mm x") && told.contains(file), "{told}");
        let bytes = fs::read(ground.file(file)).unwrap();
        assert!(bytes.starts_with(begin), "{file}");
    }
    assert!(ground.read("a.svg").contains("width=\"86mm\""));
    draw(
        &ground,
        &[
            "method-2", "--steps", "9", "--width", "178mm", "-o", "wide.svg",
        ],
    );
    assert!(ground.read("wide.svg").contains("width=\"178mm\""));
}

#[test]
fn an_existing_figure_is_replaced_only_with_force() {
    let ground = Ground::new();
    ground.write("a.svg", "mine");
    let figure = ["figure", "method-2", "--steps", "9", "-o", "a.svg"];
    failed(&ground.run(&figure), &["a.svg exists", "--force"]);
    assert_eq!(ground.read("a.svg"), "mine");
    done(ground.run(&[&figure[..], &["--force"]].concat()));
    assert!(ground.read("a.svg").contains("86mm"));
    assert_eq!(ground.files(), ["a.svg"]);
}

#[test]
fn invalid_figures_are_rejected_and_write_no_files() {
    let ground = Ground::new();
    let figure = |args: &[&str]| ground.run(&[&["figure"], args].concat());
    failed(
        &figure(&["method-2", "-o", "a.gif"]),
        &["a.gif", ".svg, .pdf or .png"],
    );
    failed(&figure(&["method-9", "-o", "a.svg"]), &["method-9"]);
    failed(
        &figure(&["method-2", "-o", "no/a.svg"]),
        &["there is no folder no"],
    );
    failed(
        &figure(&["method-2", "--from", "300", "-o", "a.svg"]),
        &["--from 300", "230 s"],
    );
    failed(
        &figure(&["method-2", "--from", "1e300", "-o", "a.svg"]),
        &["--from 1e300 is not before the end of the run, 230 s"],
    );
    failed(
        &figure(&["method-2", "--from", "9", "--to", "3", "-o", "a.svg"]),
        &["--from 9", "--to 3"],
    );
    let misused = |args: &[&str], words: &str| {
        let output = figure(args);
        assert_eq!(code(&output), 2, "{output:?}");
        assert!(stderr(&output).contains(words), "{output:?}");
    };
    misused(
        &["method-2", "--kind", "tilt_dg", "-o", "a.svg"],
        "tilt_deg",
    );
    misused(&["method-2", "--kind", "abov", "-o", "a.svg"], "above");
    misused(&["method-2", "--width", "9km", "-o", "a.svg"], "86mm");
    misused(&["method-2", "--schemes", "rk5", "-o", "a.svg"], "rk4");
    misused(&["method-2"], "--output");
    misused(&["-o", "a.svg"], "RUN");
    assert_eq!(ground.files(), [""; 0]);
}

#[test]
fn a_run_with_non_finite_numbers_is_drawn_up_to_them() {
    let ground = Ground::new();
    let push = "push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}";
    let broken = ["figure", "method-2", "--set", push, "-o", "a.svg"];
    failed(&ground.run(&broken), &["method-2", "at step 25"]);
    assert!(ground.read("a.svg").contains("86mm"));
}

#[test]
fn exported_runs_and_comparisons_are_drawn_from_their_files() {
    let ground = Ground::new();
    done(ground.run("run method-2 --steps 40 -o run.csv"));
    draw(&ground, &["run.csv", "--kind", "tilt_deg", "-o", "run.svg"]);
    let steps = "0.1,0.05,0.025";
    let compare = [
        "compare",
        "cusps",
        "--duration",
        "0.5",
        "--schemes",
        "rk4,strang",
    ];
    done(ground.run(&[&compare[..], &["--time-steps", steps, "-o", "error.csv"]].concat()));
    draw(&ground, &["error.csv", "-o", "error.svg"]);
    assert!(ground.read("error.svg").contains("largest error"));
    let alone = ["figure", "error.csv", "method-2", "-o", "both.svg"];
    failed(&ground.run(&alone), &["alone"]);
    let exact = ["figure", "error.csv", "--exact", "-o", "exact.svg"];
    failed(&ground.run(&exact), &["as they are"]);
}

#[test]
fn a_path_has_a_mark_at_its_start_if_it_shows_the_start() {
    let ground = Ground::new();
    for (from, count) in [("0", 1), ("2", 0)] {
        let kind = ["--kind", "above", "--text", "--from", from];
        let figure = [&["cusps"], &kind[..], &["-o", "a.svg", "--force"]];
        draw(&ground, &figure.concat());
        assert_eq!(
            ground.read("a.svg").matches(">start</tspan>").count(),
            count
        );
    }
}
