//! `gyrolab run` with selected rows and columns, and `gyrolab verify`.

use crate::support::ground::{Ground, code, done, failed, stdout};
use crate::support::words::{has, has_all};

/// Returns the report of `verify` on `a.csv` with the content `text`, which must differ.
#[track_caller]
fn differs(ground: &Ground, text: &str) -> String {
    ground.write("a.csv", text);
    let output = ground.run("verify a.csv");
    failed(&output, &[]);
    stdout(&output).to_owned()
}

#[test]
fn exports_of_every_kind_are_verified() {
    let ground = Ground::new();
    for (name, options) in [
        ("whole.csv", ""),
        ("part.csv", "--every 7 --from 1 --to 3.5 --columns t_s,z_m"),
        (
            "spin.csv",
            "--columns t_s,spin_rpm,L_axle_Js --scheme strang",
        ),
        ("points.csv", "--points --every 10"),
        ("excel.csv", "--excel --scheme strang"),
    ] {
        let run = format!("$G run wobble-push --steps 40 {options} -o {name}");
        done(ground.shell(&run));
    }
    done(ground.run("compare cusps --duration 0.1 -o errors.csv"));
    let output = done(ground.shell("$G verify *.csv"));
    let told = stdout(&output);
    has_all(
        &told,
        [
            "whole.csv: the same: all 41 rows, recomputed\n    Not reliable: ",
            "part.csv: the same: all 4 rows",
            "spin.csv: the same: all 41 rows",
            "excel.csv: the same: all 41 rows",
            "errors.csv: the same: all 16 rows",
            "ns_per_step and wall_s are measured computing times",
        ],
    );
    // The optional columns agree with the readouts at the end of the run.
    let json = ground.json("run wobble-push --steps 40 --scheme strang --json");
    let ends = [&json["t_s"], &json["spin_rpm"], &json["L_axle_Js"]];
    let spins = ground.read("spin.csv");
    let last = spins.lines().last().unwrap();
    let cells = last.split(',').map(|cell| cell.parse::<f64>().unwrap());
    assert!(
        cells.eq(ends.map(|end| end.as_f64().unwrap())),
        "{last}: {ends:?}"
    );
    assert!(!ground.read("whole.csv").contains("spin_rpm,"));
    let excel = ground.read("excel.csv");
    assert!(excel.starts_with("\u{feff}# # excel = true\n# gyrolab = "));
    assert!(excel.contains("\n40;4,0;"));
    // Each file reproduces itself; options change only what they name.
    for name in [
        "whole.csv",
        "part.csv",
        "spin.csv",
        "points.csv",
        "excel.csv",
    ] {
        done(ground.run(&format!("run {name} -o again.csv --force")));
        assert_eq!(ground.read("again.csv"), ground.read(name), "{name}");
    }
    done(ground.run("run part.csv --every 10 --from 0 --columns t_s,z_m -o again.csv --force"));
    done(ground.run("run whole.csv --every 10 --to 3.5 --columns t_s,z_m -o other.csv"));
    let rows = |name: &str| ground.read(name).split_once("\nt_s,").unwrap().1.to_owned();
    assert_eq!(rows("again.csv"), rows("other.csv"));
    // Rows per step and rows per point have different columns.
    done(ground.run("run part.csv --points -o again.csv --force"));
    done(ground.run("verify again.csv"));
    done(ground.shell("cat part.csv | $G run - -o again.csv --force"));
    assert_eq!(ground.read("again.csv"), ground.read("part.csv"));
}

#[test]
fn differences_are_reported_with_exit_code_1() {
    let ground = Ground::new();
    done(ground.run("run method-2 --steps 40 -o a.csv"));
    let good = ground.read("a.csv");
    ground.write("a.csv", &good.replace("\n12,1.2", "\n12,1.3"));
    ground.write("b.csv", "nothing\n");
    ground.write("c.csv", &good);
    let output = ground.run("verify a.csv b.csv c.csv d.csv");
    let words = "b.csv: is not a CSV from gyrolab";
    failed(&output, &[words, "d.csv: "]);
    let wrong_row = ", the row of step 12: t_s is 1.3";
    has_all(stdout(&output), [wrong_row, "c.csv: the same"]);
    ground.refused("verify", 2, &[]);
    ground.refused("verify /", 1, &[]);
}

#[test]
fn a_difference_ends_the_recomputation_of_a_long_run() {
    let ground = Ground::new();
    done(ground.run("run method-2 --steps 3 -o a.csv"));
    let good = ground.read("a.csv");
    let long = good.replace("# steps = 3\n", "# steps = 2000000000\n");
    let told = differs(&ground, &long);
    has(&told, "it is cut off");
}

#[test]
fn an_edited_header_is_reported_as_such() {
    let ground = Ground::new();
    done(ground.run("run cusps --steps 5 -o a.csv"));
    let good = ground.read("a.csv");
    let changed = good.replace("[0.0, 0.0, 60.0]", "[0.0, 0.0, 61.0]");
    assert_ne!(good, changed);
    let words = "its rows do not belong to the scenario in its header";
    has_all(
        differs(&ground, &changed),
        [words, "the row of step 0: Ly_Js is "],
    );
}

#[test]
fn invalid_rows_and_columns_are_rejected() {
    let ground = Ground::new();
    for (options, exit, words) in [
        (
            "--columns z,t_s -o x.csv",
            2,
            "--columns: no column named z: did you mean z_m?",
        ),
        (
            "--from 5 --to 4 -o x.csv",
            2,
            "--to: 4 s is before the first row's time, 5 s",
        ),
        ("--from -1 -o x.csv", 2, "must be a time in seconds"),
        ("--columns z_m", 2, "--output <FILE>"),
        (
            "--from 500 -o x.csv",
            1,
            "--from leaves no row: the run ends at 230 s",
        ),
        (
            "--from 5.01 --to 5.02 -o x.csv",
            1,
            "there is no row between --from and --to",
        ),
    ] {
        ground.refused(&format!("run method-2 {options}"), exit, &[words]);
    }
    assert!(!ground.file("x.csv").exists());
}

#[test]
fn compare_prints_json() {
    let ground = Ground::new();
    let table = ground.json("compare steady-slow --duration 0.2 --schemes report,exact --json");
    assert_eq!(table["energy_drift_unit"], "M g |c|");
    let rows = table["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 8);
    assert!(rows[1]["order"].is_number() && rows[0]["order"].is_null());
    assert!(rows.iter().all(|row| row["error_m"].is_number()));
    ground.refused("compare cusps --json -o -", 2, &[]);
    let words = "there is no folder no";
    ground.refused("compare cusps --json -o no/where.csv", 1, &[words]);
}

/// A sweep of four runs over a number and a text.
fn small_sweep(ground: &Ground) -> String {
    let sweep = "$G sweep cusps --vary motion.steps=3,5 --vary motion.scheme=report,rk4 --measure z_m,path -o a.csv";
    done(ground.shell(sweep));
    ground.read("a.csv")
}

#[test]
fn the_differing_field_of_a_sweep_is_named() {
    let ground = Ground::new();
    let good = small_sweep(&ground);
    let told = |text: &str| differs(&ground, text);
    let begin = good.find("\n5,report,").unwrap() + "\n5,report,".len();
    let line = good[..begin].lines().count();
    let row = &good[begin..];
    let z_m = row.split(',').next().unwrap();
    let with = |field: &str| format!("{}{field}{}", &good[..begin], &row[z_m.len()..]);
    assert_eq!(
        told(&with("7")),
        format!(
            "a.csv: differs: line {line}, the row of motion.steps 5, motion.scheme report: z_m is 7, computed {z_m}\n"
        )
    );
    let columns = told(&good.replace(",z_m,path,reliable\n", ",path,z_m,reliable\n"));
    has(
        &columns,
        " is \"motion.steps,motion.scheme,path,z_m,reliable\", computed \"motion.steps,motion.scheme,z_m,path,reliable\"",
    );
    // Control sequences are escaped and shortened in every place.
    let steering = format!("\u{1b}]0;title\u{7}{}", "x".repeat(100_000));
    let last = good.trim_end().len();
    for text in [
        with(&steering),
        with(&format!("1,2,3,{steering}")),
        format!("{}\n{steering}\n", &good[..last]),
    ] {
        let told = told(&text);
        assert!(
            !told.contains(['\u{1b}', '\u{7}'])
                && told.contains("\\u{1b}]0;title")
                && told.len() < 500,
            "{told:?}"
        );
    }
}

#[test]
fn line_ends_of_sweeps_and_runs_are_reported_alike() {
    let ground = Ground::new();
    let sweep = small_sweep(&ground);
    done(ground.run("run cusps --steps 4 -o run.csv"));
    let run = ground.read("run.csv");
    for good in [&run, &sweep] {
        let cut = "the last one, is cut off before its end";
        let without = &good[..=good.trim_end().rfind('\n').unwrap()];
        let of_dos = "every row is the same, but the lines end in CR LF from line 1 on";
        for (text, words) in [
            (good.replace('\n', "\r\n").as_str(), of_dos),
            (good.trim_end(), &format!(", {cut}")),
            (&good[..good.len() - 4], cut),
            (without, "it is cut off"),
            (&format!("{good}\n"), "but the computed rows have ended"),
            (&format!("{good} \n"), "but the computed rows have ended"),
            (&format!("{good}x"), "but the computed rows have ended"),
        ] {
            has(differs(&ground, text), words);
        }
        ground.write("a.csv", &format!("\u{feff}{good}"));
        has(ground.stdout("verify a.csv"), "the same: all ");
    }
}

/// The exit code says whether the rows agree, the JSON has the documented keys, and a broken file is rejected.
#[test]
fn the_rows_of_a_users_program_are_compared_with_a_scenario() {
    let ground = Ground::new();
    done(ground.run("run every-slip --steps 50 --columns step,z_m,spin_rpm -o mine.csv"));
    let agrees = done(ground.run("verify mine.csv --against every-slip"));
    let told = [
        "agrees with every-slip in 51 rows",
        "the push's end, at step 200",
        "Ignored columns: spin_rpm",
    ];
    has_all(stdout(&agrees), told);
    let against = "verify mine.csv --against every-slip --set motion.gravity_m_per_s2=9.79";
    let differs = ground.run(&format!("{against} --json"));
    assert_eq!(code(&differs), 1);
    let json: serde_json::Value = serde_json::from_str(stdout(&differs)).unwrap();
    let keys: Vec<_> = json
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    let mut expected = [
        "agrees",
        "precision",
        "digits",
        "rows",
        "rows_compared",
        "offset",
        "first_step",
        "columns",
        "yours",
        "scheme",
        "worst_m",
        "explanations",
        "slips",
        "unseen",
    ];
    expected.sort_unstable();
    let mut keys = keys;
    keys.sort_unstable();
    assert_eq!(keys, expected);
    assert_eq!(
        (&json["agrees"], &json["columns"][0]),
        (&false.into(), &"z_m".into())
    );
    let refused = ground.run("verify mine.csv --against every-slip --map 9=x_m");
    failed(
        &refused,
        &[
            "mine.csv: --map 9=x_m",
            "is not a name or number of a column in the file",
        ],
    );
    assert_eq!(code(&ground.run("verify mine.csv --map 1=step")), 2);
}
