//! Figures with an embedded run: used as scenarios, redrawn, and verified after changes.

use crate::support::dice::Dice;
use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use crate::support::words::{has, has_all};
use std::fs;

/// Draws `figure` with the arguments `what`. Asserts that its file alone reproduces the same bytes and passes `verify`, and
/// that `verify` detects each of `flips` single-bit changes.
#[track_caller]
fn assert_reproducible(ground: &Ground, what: &str, figure: &str, flips: u32, dice: &mut Dice) {
    done(ground.run(&format!("figure {what} -o {figure}")));
    let again = format!("again-{figure}");
    done(ground.run(&format!("figure {figure} -o {again} --force")));
    let bytes = fs::read(ground.file(figure)).unwrap();
    assert!(
        bytes == fs::read(ground.file(&again)).unwrap(),
        "{what} in {figure}"
    );
    has(
        stdout(&done(ground.run(&format!("verify {figure}")))),
        "the same: redrawn",
    );
    for _ in 0..flips {
        let mut changed = bytes.clone();
        let (place, bit) = (
            dice.whole(0, bytes.len() as u64 - 1) as usize,
            dice.whole(0, 7),
        );
        changed[place] ^= 1 << bit;
        fs::write(ground.file(&again), &changed).unwrap();
        let verified = ground.run(&format!("verify {again}"));
        assert_eq!(
            code(&verified),
            1,
            "{what} in {figure}: bit {bit} of byte {place}"
        );
    }
}

/// Writes tables of each kind, and measured data.
fn write_inputs(ground: &Ground) {
    done(ground.run("sweep cusps --vary start.tilt_deg=10..40:4 --measure measured_tilt_swing_deg,tilt_deg -o sweep.csv"));
    done(ground.run("compare cusps --duration 0.1 --schemes report,rk4 -o compare.csv"));
    let fit =
        "fit heidelberg-precession --in heidelberg --free body.part.0.moments_kg_m2.2 -o fit.csv";
    done(ground.run(fit));
}

#[test]
fn figures_of_every_format_are_reproduced_from_their_files() {
    let (ground, mut dice) = (Ground::new(), Dice(31));
    write_inputs(&ground);
    for (what, figure) in [
        ("cusps --steps 300 --schemes report,rk4 --kind z_m", "a.svg"),
        (
            "cusps --steps 300 --kind tilt_deg --text --title 'A<&%]]>' --label %3c",
            "b.svg",
        ),
        (
            "heidelberg --measured heidelberg-spin-decay --steps 50",
            "c.pdf",
        ),
        ("sweep.csv --width 30mm", "d.png"),
        ("fit.csv", "e.svg"),
        ("compare.csv --log x", "f.pdf"),
    ] {
        assert_reproducible(&ground, what, figure, 3, &mut dice);
    }
}

#[test]
#[ignore = "draws 200 figures of every kind and form, twice each: minutes"]
fn two_hundred_figures_are_reproduced_from_their_files() {
    let (ground, mut dice) = (Ground::new(), Dice(200));
    write_inputs(&ground);
    let options = [
        "--kind traces",
        "--kind above --exact",
        "--kind 3d",
        "--kind tilt_deg,energy_J --exact --from 0.5",
        "--kind spin_rpm --scheme strang --title 'Spin, % & <more>' --y-label rate",
        "--kind z_m --schemes report,strang,exact --label a --label b --label c",
        "--kind azimuth_deg --set start.tilt_deg=20 --width 178mm --x-label time",
        "--kind L_axle_Js --log y --time-step 0.02",
    ];
    let presets = [
        "method-2",
        "method-1",
        "cusps",
        "wobble-push",
        "heidelberg",
        "life-of-a-top",
        "loops",
    ];
    let mut whats: Vec<String> = Vec::new();
    for preset in presets {
        whats.extend(
            options
                .iter()
                .map(|option| format!("{preset} --duration 2 {option}")),
        );
    }
    for kind in ["", "--kind residuals", "--kind traces --exact", "--from 1"] {
        let data = "--measured heidelberg-spin-decay";
        whats.push(format!("heidelberg --duration 3 {data} {kind}"));
    }
    whats.extend(
        [
            "sweep.csv",
            "sweep.csv --kind tilt_deg",
            "compare.csv",
            "fit.csv",
        ]
        .map(str::to_owned),
    );
    whats.extend(
        [
            "method-2-slow --kind 3d",
            "method-2 --scheme exact",
            "cusps method-1",
        ]
        .map(str::to_owned),
    );
    let forms = ["svg", "svg --text", "pdf"];
    let mut count = 0;
    for (index, what) in whats.iter().enumerate() {
        for form in forms.iter().chain((index % 6 == 0).then_some(&"png")) {
            let (ending, text) = form.split_at(3);
            assert_reproducible(
                &ground,
                &format!("{what}{text}"),
                &format!("{count}.{ending}"),
                1,
                &mut dice,
            );
            count += 1;
        }
    }
    assert!(count >= 200, "{count}");
}

#[test]
fn a_figure_can_be_used_as_a_scenario() {
    let ground = Ground::new();
    done(ground.run(
        "figure wobble-push --set start.tilt_deg=3 --steps 40 --schemes strang,report -o a.pdf",
    ));
    done(ground.run("run wobble-push --set start.tilt_deg=3 --steps 40 --scheme strang -o a.csv"));
    done(ground.run("run a.pdf -o b.csv"));
    assert_eq!(ground.read("a.csv"), ground.read("b.csv"));
    has(stdout(&done(ground.run("check a.pdf"))), "a.pdf: good: ");
    has(stdout(&done(ground.run("show a.pdf"))), "strang");
    // Given options override those of the figure.
    done(ground.run("figure a.pdf --kind above --title New -o b.svg"));
    has_all(
        ground.read("b.svg"),
        [
            "kind = \"above\"",
            "title = \"New\"",
            "name = \"wobble-push\"",
        ],
    );
    done(ground.run("show a.pdf --svg -o screen.svg"));
    has(stdout(&done(ground.run("run screen.svg"))), "strang");
    failed(&ground.run("verify screen.svg"), &["the lab's screen"]);
}

#[test]
fn figures_contain_no_folder_names() {
    let ground = Ground::new();
    done(ground.run("run cusps --steps 9 -o run.csv"));
    let path = ground.file("run.csv").display().to_string();
    done(ground.run(&format!("figure {path} {path} -o a.svg")));
    let svg = ground.read("a.svg");
    let folder = ground.path().display().to_string();
    assert!(svg.contains("name = \"run.csv\"") && !svg.contains(&folder));
}

#[test]
fn figures_without_a_valid_run_are_rejected() {
    let ground = Ground::new();
    done(ground.run("figure cusps --steps 9 -o a.svg"));
    let svg = ground.read("a.svg");
    let (picture, metadata) = svg.split_once("<metadata>").unwrap();
    ground.write("stripped.svg", &format!("{picture}</svg>\n"));
    let twice = format!(
        "{picture}<metadata>{}",
        metadata.replace("</svg>", &format!("<metadata>{metadata}"))
    );
    ground.write("twice.svg", &twice);
    ground.write("run.svg", &svg.replace("tilt_deg = 30", "tilt_deg = 31"));
    ground.write(
        "picture.svg",
        &svg.replace("role=\"img\">\n<title>", "role=\"img\">\n<title>New "),
    );
    done(ground.run("figure a.svg -o a.pdf"));
    let pdf = fs::read(ground.file("a.pdf")).unwrap();
    fs::write(ground.file("after.pdf"), [&pdf[..], b"more"].concat()).unwrap();
    for (file, words) in [
        ("stripped.svg", "contains no run"),
        ("twice.svg", "metadata of two figures"),
        ("run.svg", "its run was changed"),
    ] {
        for command in ["verify", "run", "check"] {
            failed(&ground.run(&format!("{command} {file}")), &[words]);
        }
    }
    for (file, words) in [
        ("picture.svg", "differs: its picture was changed"),
        ("after.pdf", "differs: its file was changed"),
    ] {
        let verified = ground.run(&format!("verify {file}"));
        assert_eq!(code(&verified), 1, "{file}");
        has(stdout(&verified), words);
        done(ground.run(&format!("run {file}")));
    }
}

#[test]
fn data_too_large_to_embed_must_be_supplied() {
    let ground = Ground::new();
    let mut dice = Dice(4);
    let mut number = || dice.unit();
    let rows =
        (0..60_000).map(|row| format!("{},{},{}\n", 1e-4 * f64::from(row), number(), number()));
    ground.write(
        "large.csv",
        &format!("t_s,x_m,z_m\n{}", rows.collect::<String>()),
    );
    let drawn = done(ground.run("figure cusps --steps 9 --measured large.csv -o a.pdf"));
    has(stderr(&drawn), "large.csv: more than 1 MB");
    done(ground.run("verify a.pdf"));
    ground.write("large.csv", "t_s,x_m\n0,1\n");
    failed(&ground.run("verify a.pdf"), &["needs large.csv (SHA-256 "]);
    fs::remove_file(ground.file("large.csv")).unwrap();
    failed(
        &ground.run("figure a.pdf -o b.pdf"),
        &["needs large.csv (SHA-256 "],
    );
    done(ground.run("run a.pdf"));
}

#[test]
fn verify_checks_a_write_up_as_a_whole() {
    let ground = Ground::new();
    let heidelberg = "writeup heidelberg --steps 60 --measured heidelberg-spin-decay -o w";
    done(ground.run(heidelberg));
    let told = done(ground.run("verify w"));
    let told = stdout(&told);
    has_all(
        told,
        [
            "w/run.csv: the same",
            "w/traces.svg: the same",
            "w/measured.pdf: the same",
            "w/README.md: the same",
            "w/readouts.json: the same",
        ],
    );
    has(told, "w/heidelberg-spin-decay.csv: the same: measured data");
    // A file added by the student is named, but it is not a difference.
    ground.write("w/notes.txt", "mine");
    let again = done(ground.run("verify w"));
    has(
        stdout(&again),
        "w: 1 file not part of the write-up: notes.txt",
    );
    let page = ground.read("w/README.md");
    ground.write(
        "w/README.md",
        &page
            .replacen("The run ", "A run ", 1)
            .replacen("kg", "g", 1),
    );
    fs::remove_file(ground.file("w/above.svg")).unwrap();
    done(ground.run("figure cusps --steps 60 -o w/traces.svg --force"));
    let verified = ground.run("verify w");
    assert_eq!(code(&verified), 1);
    has_all(
        stdout(&verified),
        [
            "w/README.md: differs: lines 15 to ",
            "differ; line 15 is \"| body | 4.2197 g;",
            "w/above.svg: differs: it is missing",
            "w/traces.svg: differs: it is a figure of another run",
            "w/traces.pdf: the same",
        ],
    );
    failed(
        &ground.run("verify w/README.md"),
        &["to verify a write-up, name its folder"],
    );
    fs::remove_file(ground.file("w/run.toml")).unwrap();
    failed(&ground.run("verify w"), &["is not a write-up"]);
}
