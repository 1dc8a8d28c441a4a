//! The program itself, against what it promises: exit codes, what goes to stdout and what to stderr, files that
//! appear whole or not at all, and CSVs that run again to the same bytes.

use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use std::fs;
use std::io::{Read, Write};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};

/// The first columns of every CSV, which programs elsewhere rely on.
const COLUMNS: &str = "step,t_s,x_m,y_m,z_m,Lx_Js,Ly_Js,Lz_Js,wx_rad_per_s,wy_rad_per_s,wz_rad_per_s,tilt_deg,azimuth_deg,energy_J,segment";

/// A CSV: the run file of its header, the header line, and the rows.
fn parts(csv: &str) -> (String, &str, Vec<Vec<f64>>) {
    let mut lines = csv.lines();
    let header: String = lines
        .by_ref()
        .take_while(|line| line.starts_with('#'))
        .map(|line| {
            line.strip_prefix("# ")
                .unwrap_or_else(|| panic!("{line}"))
                .to_owned()
                + "\n"
        })
        .collect();
    let mut lines = csv.lines().skip_while(|line| line.starts_with('#'));
    let columns = lines.next().unwrap();
    let rows = lines
        .map(|line| {
            line.split(',')
                .map(|field| field.parse().unwrap())
                .collect()
        })
        .collect();
    (header, columns, rows)
}

fn steps(csv: &str) -> Vec<f64> {
    parts(csv).2.iter().map(|row| row[0]).collect()
}

#[test]
fn exit_codes() {
    let lab = Ground::new();
    for (args, expected) in [
        (&["run", "method-1", "--steps", "3"][..], 0),
        (&["schemes"], 0),
        (&["--help"], 0),
        (&["--version"], 0),
        (&["run", "no-such-preset"], 1),
        (&["run", "no/such/file.toml"], 1),
        (&["run", "method-1", "--set", "motion.steps=0"], 1),
        (&["presets", "no-such-preset"], 1),
        (&["check", "no-such-file.toml"], 1),
        (&["run"], 2),
        (&["run", "method-1", "--nonsense"], 2),
        (&["run", "method-1", "--steps", "0"], 2),
        (&["run", "method-1", "--steps", "-1"], 2),
        (&["run", "method-1", "--steps", "1e3"], 2),
        (&["run", "method-1", "--every", "0"], 2),
        (&["run", "method-1", "--duration", "0"], 2),
        (&["run", "method-1", "--duration", "nan"], 2),
        (&["run", "method-1", "--duration", "inf"], 2),
        (&["run", "method-1", "--steps", "3", "--duration", "1"], 2),
        (&["run", "method-1", "--scheme", "nonsense"], 2),
        (&["run", "method-1", "-o", ""], 2),
        (&["run", "method-1", "-o", "-", "--json"], 2),
        (&["check"], 2),
        (&["completions", "nonsense"], 2),
    ] {
        let output = lab.run(args);
        assert_eq!(code(&output), expected, "{args:?}: {output:?}");
        assert_eq!(
            output.stderr.is_empty(),
            expected == 0,
            "{args:?}: {output:?}"
        );
    }
    assert_eq!(lab.files(), [""; 0]);
}

#[test]
fn the_summary_is_on_stdout_and_tells_how_the_run_ended() {
    let lab = Ground::new();
    let output = done(lab.run(&["run", "method-2"]));
    assert!(output.stderr.is_empty());
    let words = [
        "Method 2",
        "scheme",
        "report",
        "2300",
        "0.1 s",
        "230 s",
        "0.810940",
        "-707.256771",
        "tilt",
        "energy drift",
        "wall time",
        "steps a second",
    ];
    for word in words {
        assert!(
            stdout(&output).contains(word),
            "{word}: {}",
            stdout(&output)
        );
    }
}

#[test]
fn the_json_has_its_keys() {
    let lab = Ground::new();
    let output = done(lab.run(&[
        "run",
        "method-2",
        "--json",
        "--scheme",
        "rk4",
        "--steps",
        "7",
        "--set",
        "motion.time_step_s=0.001",
    ]));
    assert!(output.stderr.is_empty());
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    for key in [
        "t_s",
        "x_m",
        "y_m",
        "z_m",
        "Lx_Js",
        "Ly_Js",
        "Lz_Js",
        "tilt_deg",
        "energy_drift",
        "wall_s",
        "steps_per_second",
    ] {
        assert!(json[key].is_f64(), "{key}: {json}");
    }
    assert_eq!(json["title"], "Method 2");
    assert_eq!(json["scheme"], "rk4");
    assert_eq!(json["steps"], 7);
    assert_eq!(json["time_step_s"], 0.001);
    assert_eq!(json["t_s"], 7.0 * 0.001);
}

#[test]
fn an_energy_drift_without_a_scale_is_null_and_na() {
    let lab = Ground::new();
    let still = [
        "run",
        "torque-free",
        "--set",
        "start.momentum_Js=[0,0,0]",
        "--steps",
        "3",
    ];
    assert!(stdout(&done(lab.run(&still))).contains("n/a"));
    let json = done(lab.run(&[&still[..], &["--json"]].concat()));
    let json: serde_json::Value = serde_json::from_str(stdout(&json)).unwrap();
    assert!(json["energy_drift"].is_null(), "{json}");
}

#[test]
fn with_a_file_the_summary_goes_to_stderr_and_the_json_to_stdout() {
    let lab = Ground::new();
    let output = done(lab.run(&["run", "method-1", "--steps", "3", "-o", "a.csv"]));
    assert!(output.stdout.is_empty());
    assert!(stderr(&output).contains("Method 1") && stderr(&output).contains("wall time"));
    let output = done(lab.run(&["run", "method-1", "--steps", "3", "-o", "b.csv", "--json"]));
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(json["steps"], 3);
    assert!(stderr(&output).contains("Method 1"));
    let output = done(lab.run(&["run", "method-1", "--steps", "3", "-o", "-"]));
    assert_eq!(stdout(&output), lab.read("a.csv"));
    assert!(stderr(&output).contains("Method 1"));
    assert_eq!(lab.read("a.csv"), lab.read("b.csv"));
}

#[test]
fn the_csv_begins_with_its_run_file_and_the_columns() {
    let lab = Ground::new();
    done(lab.run(&[
        "run",
        "wobble-push",
        "--steps",
        "12",
        "--scheme",
        "rk4",
        "--set",
        "push.0.force_N=[0,0,-50]",
        "--set",
        "motion.time_step_s=0.002",
        "-o",
        "a.csv",
    ]));
    let csv = lab.read("a.csv");
    let (header, columns, rows) = parts(&csv);
    assert!(
        columns == COLUMNS || columns.starts_with(&format!("{COLUMNS},")),
        "{columns}"
    );
    assert_eq!(rows.len(), 13);
    let run: toml::Table = header.parse().unwrap();
    assert!(run["gyrolab"].is_str());
    assert_eq!(run["motion"]["steps"].as_integer(), Some(12));
    assert_eq!(run["motion"]["scheme"].as_str(), Some("rk4"));
    assert_eq!(run["motion"]["time_step_s"].as_float(), Some(0.002));
    assert_eq!(run["push"][0]["force_N"][2].as_float(), Some(-50.0));
    // The header by itself is a scenario file, and that of its own CSV.
    lab.write("run.toml", &header);
    done(lab.run(&["check", "run.toml", "a.csv"]));
    done(lab.run(&["run", "run.toml", "-o", "again.csv"]));
    assert_eq!(lab.read("again.csv"), csv);
}

#[test]
fn numbers_read_back_to_the_same_bits() {
    let lab = Ground::new();
    let csv = done(lab.run(&["run", "method-2", "--steps", "40", "-o", "-"]));
    let (_, _, rows) = parts(stdout(&csv));
    let json = done(lab.run(&["run", "method-2", "--steps", "40", "--json"]));
    let json: serde_json::Value = serde_json::from_str(stdout(&json)).unwrap();
    for (column, key) in [
        (1, "t_s"),
        (2, "x_m"),
        (5, "Lx_Js"),
        (11, "tilt_deg"),
        (13, "energy_J"),
    ] {
        assert_eq!(
            rows[40][column].to_bits(),
            json[key].as_f64().unwrap().to_bits(),
            "{key}"
        );
    }
}

#[test]
fn a_csv_runs_again_to_the_same_bytes() {
    let lab = Ground::new();
    let edited = done(lab.run(&["presets", "wobble-push"]));
    lab.write(
        "edited.toml",
        &format!(
            "{}\n[[edit]]\nstep = 100\nset = {{ \"motion.time_step_s\" = 0.03, \"push.0.force_N\" = [1, 2, 3] }}\n\n[[edit]]\nstep = 150\nset = {{ \"motion.scheme\" = \"rk4\", \"motion.time_step_s\" = 0.001 }}\n",
            stdout(&edited)
        ),
    );
    let names = [
        "method-1",
        "method-2",
        "wobble-push",
        "wobble-push-accumulating",
        "loops",
        "torque-free",
        "edited.toml",
    ];
    for name in names {
        for every in ["1", "7"] {
            done(lab.run(&["run", name, "--every", every, "-o", "first.csv", "--force"]));
            done(lab.run(&[
                "run",
                "first.csv",
                "--every",
                every,
                "-o",
                "second.csv",
                "--force",
            ]));
            assert!(
                lab.read("first.csv") == lab.read("second.csv"),
                "{name} --every {every}"
            );
        }
    }
    // Even in place: the old file is read before the new one takes its name.
    let before = lab.read("first.csv");
    done(lab.run(&[
        "run",
        "first.csv",
        "--every",
        "7",
        "-o",
        "first.csv",
        "--force",
    ]));
    assert!(before == lab.read("first.csv"));
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_change_nothing() {
    let lab = Ground::new();
    done(lab.run(&["run", "method-1", "--steps", "5", "-o", "a.csv"]));
    lab.write(
        "b.csv",
        &format!("\u{feff}{}", lab.read("a.csv").replace('\n', "\r\n")),
    );
    done(lab.run(&["run", "b.csv", "-o", "again.csv"]));
    assert_eq!(lab.read("again.csv"), lab.read("a.csv"));
}

#[test]
fn every_nth_row_and_always_the_last() {
    let lab = Ground::new();
    let run = |steps: &str, every: &str| {
        done(lab.run(&[
            "run", "method-2", "--steps", steps, "--every", every, "-o", "-",
        ]))
    };
    assert_eq!(
        steps(stdout(&run("10", "1"))),
        (0..=10).map(f64::from).collect::<Vec<_>>()
    );
    assert_eq!(steps(stdout(&run("10", "4"))), [0.0, 4.0, 8.0, 10.0]);
    assert_eq!(steps(stdout(&run("12", "4"))), [0.0, 4.0, 8.0, 12.0]);
    assert_eq!(steps(stdout(&run("3", "100"))), [0.0, 3.0]);
    assert_eq!(steps(stdout(&run("1", "18446744073709551615"))), [0.0, 1.0]);
    // Longer than a block of steps between two looks at the signals.
    let (all, some) = (run("10000", "1"), run("10000", "999"));
    let (_, _, all) = parts(stdout(&all));
    let (_, _, some) = parts(stdout(&some));
    let expected: Vec<_> = all
        .iter()
        .filter(|row| row[0] % 999.0 == 0.0 || row[0] == 10000.0)
        .cloned()
        .collect();
    assert_eq!(
        some, expected,
        "--every changes which rows there are, and nothing in them"
    );
}

#[test]
fn a_file_is_replaced_only_with_force_and_keeps_its_rights() {
    let lab = Ground::new();
    lab.write("a.csv", "precious");
    fs::set_permissions(lab.path().join("a.csv"), fs::Permissions::from_mode(0o646)).unwrap();
    failed(
        &lab.run(&["run", "method-1", "--steps", "3", "-o", "a.csv"]),
        &["a.csv", "--force"],
    );
    assert_eq!(lab.read("a.csv"), "precious");
    done(lab.shell("umask 077; \"$G\" run method-1 --steps 3 -o a.csv --force"));
    assert_eq!(steps(&lab.read("a.csv")).len(), 4);
    assert_eq!(lab.mode("a.csv"), 0o646);
    assert_eq!(lab.files(), ["a.csv"]);
}

#[test]
fn a_refused_scenario_leaves_the_old_file_alone_even_with_force() {
    let lab = Ground::new();
    lab.write("a.csv", "precious");
    failed(
        &lab.run(&[
            "run",
            "method-1",
            "--set",
            "motion.steps=0",
            "-o",
            "a.csv",
            "--force",
        ]),
        &["motion.steps"],
    );
    assert_eq!(lab.read("a.csv"), "precious");
}

#[test]
fn a_new_file_has_the_rights_the_umask_leaves() {
    let lab = Ground::new();
    for (umask, mode) in [("022", 0o644), ("002", 0o664), ("077", 0o600)] {
        let name = format!("{umask}.csv");
        done(lab.shell(&format!(
            "umask {umask}; \"$G\" run method-1 --steps 3 -o {name}"
        )));
        assert_eq!(lab.mode(&name), mode, "umask {umask}");
    }
}

#[test]
fn a_link_stays_a_link() {
    let lab = Ground::new();
    fs::create_dir(lab.path().join("data")).unwrap();
    lab.write("data/a.csv", "old");
    symlink("data/a.csv", lab.path().join("link.csv")).unwrap();
    failed(
        &lab.run(&["run", "method-1", "--steps", "3", "-o", "link.csv"]),
        &["--force"],
    );
    done(lab.run(&[
        "run", "method-1", "--steps", "3", "-o", "link.csv", "--force",
    ]));
    assert!(lab.path().join("link.csv").is_symlink());
    assert_eq!(steps(&lab.read("data/a.csv")).len(), 4);
    symlink("nowhere.csv", lab.path().join("dead.csv")).unwrap();
    failed(
        &lab.run(&["run", "method-1", "--steps", "3", "-o", "dead.csv"]),
        &["dead.csv", "link"],
    );
    assert_eq!(lab.files(), ["data", "dead.csv", "link.csv"]);
}

#[test]
fn what_cannot_be_written_is_named_and_leaves_nothing() {
    let lab = Ground::new();
    fs::create_dir(lab.path().join("folder")).unwrap();
    lab.write("file", "");
    for (target, words) in [
        ("none/a.csv", &["none/a.csv", "no folder"][..]),
        ("folder", &["folder", "is a folder"]),
        ("folder/", &["folder", "is a folder"]),
        ("new/", &["new/", "is a folder"]),
        ("new/.", &["new/.", "is a folder"]),
        ("..", &["..", "is a folder"]),
        ("file/a.csv", &["file/a.csv", "file"]),
    ] {
        failed(
            &lab.run(&["run", "method-1", "--steps", "3", "-o", target]),
            words,
        );
    }
    assert_eq!(lab.files(), ["file", "folder"]);
    if Path::new("/dev/full").exists() {
        failed(
            &lab.run(&["run", "method-1", "-o", "/dev/full"]),
            &[
                "/dev/full",
                "free some room, or name a file on another disk",
            ],
        );
        failed(
            &lab.shell("\"$G\" run method-1 -o - > /dev/full"),
            &["stdout", "space"],
        );
        failed(
            &lab.shell("\"$G\" presets > /dev/full"),
            &["stdout", "space"],
        );
    }
}

#[test]
fn a_limit_on_file_sizes_is_a_failed_write() {
    let lab = Ground::new();
    failed(
        &lab.shell("ulimit -f 40; \"$G\" run method-2 --steps 20000 -o a.csv"),
        &["a.csv", "large"],
    );
    assert_eq!(lab.files(), [""; 0]);
    failed(
        &lab.shell("ulimit -f 40; \"$G\" run method-2 --steps 20000 -o - > b.csv"),
        &["stdout", "large"],
    );
}

#[test]
fn a_closed_pipe_is_a_quiet_end() {
    let lab = Ground::new();
    for command in [
        "run method-2 --steps 200000 -o -",
        "run method-2 --steps 200000 --every 3 -o -",
        "man",
        "completions zsh",
        "presets",
    ] {
        // The reader is gone before the first byte, or after it.
        for reader in ["true", "head -c 1 > first"] {
            let output = lab.shell(&format!(
                "{{ \"$G\" {command}; echo $? > code; }} | {reader}"
            ));
            assert_eq!(
                lab.read("code").trim(),
                "0",
                "{command} | {reader}: {output:?}"
            );
            assert_eq!(stderr(&output), "", "{command} | {reader}");
        }
    }
}

#[test]
fn fifos_and_devices_are_written_directly() {
    let lab = Ground::new();
    done(lab.run(&["run", "method-1", "--steps", "3", "-o", "a.csv"]));
    done(lab.run(&["run", "method-1", "--steps", "3", "-o", "/dev/null"]));
    assert_eq!(lab.files(), ["a.csv"]);
    done(
        lab.shell(
            "mkfifo fifo; cat fifo > read.csv & \"$G\" run method-1 --steps 3 -o fifo && wait",
        ),
    );
    assert_eq!(lab.read("read.csv"), lab.read("a.csv"));
    assert_eq!(lab.files(), ["a.csv", "fifo", "read.csv"]);
}

#[test]
fn an_open_file_that_is_named_as_output_is_written_as_it_is() {
    let lab = Ground::new();
    let run = "\"$G\" run method-1 --steps 3";
    done(lab.shell(&format!("{run} -o a.csv")));
    let rows = lab.read("a.csv");
    for name in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link"] {
        if name == "link" {
            symlink("/dev/stdout", lab.path().join("link")).unwrap();
        }
        // What stands in the file stays, and so does the file.
        lab.write("b.csv", "first\n");
        fs::hard_link(lab.path().join("b.csv"), lab.path().join("same.csv")).unwrap();
        done(lab.shell(&format!("{run} -o {name} >> b.csv")));
        assert_eq!(lab.read("same.csv"), format!("first\n{rows}"), "{name}");
        done(lab.shell(&format!("(echo a; {run} -o {name}; echo b) > b.csv")));
        assert_eq!(lab.read("same.csv"), format!("a\n{rows}b\n"), "{name}");
        let both = lab.shell(&format!("{run} --json -o {name}"));
        assert_eq!(code(&both), 2, "{name}");
        fs::remove_file(lab.path().join("same.csv")).unwrap();
    }
    done(lab.shell(&format!("{run} -o /dev/fd/3 3> b.csv")));
    assert_eq!(lab.read("b.csv"), rows);
    done(lab.shell("\"$G\" compare method-1 --steps 3 -o /dev/stdout > b.csv"));
    let table = lab.read("b.csv");
    assert!(
        table.starts_with("# ") && !table.contains("scheme  "),
        "{table}"
    );
    assert_eq!(lab.files(), ["a.csv", "b.csv", "link"]);
}

#[test]
fn a_scenario_comes_from_a_fifo_too() {
    let lab = Ground::new();
    let preset = done(lab.run(&["presets", "cusps"]));
    lab.write("cusps.toml", stdout(&preset));
    for command in [
        "show FILE",
        "FILE",
        "run FILE --steps 3 -o -",
        "compare FILE --steps 3 -o -",
        "check FILE",
    ] {
        let from_file = lab.shell(&format!(
            "\"$G\" {}",
            command.replace("FILE", "./cusps.toml")
        ));
        // A second reading would wait for ever.
        let script = format!(
            "mkfifo fifo.toml; cat cusps.toml > fifo.toml & timeout 20 \"$G\" {}; end=$?; rm fifo.toml; exit $end",
            command.replace("FILE", "./fifo.toml")
        );
        let from_fifo = done(lab.shell(&script));
        if !command.contains("compare") {
            let expected = stdout(&from_file).replace("cusps.toml", "fifo.toml");
            assert_eq!(stdout(&from_fifo), expected, "{command}");
        }
    }
}

#[test]
fn a_replaced_file_keeps_its_rights_but_not_those_of_a_set_user_id() {
    let lab = Ground::new();
    let run = || done(lab.run(&["run", "method-1", "--steps", "3", "-o", "a.csv", "--force"]));
    for (before, after) in [(0o640, 0o640), (0o6755, 0o755), (0o1604, 0o604)] {
        lab.write("a.csv", "old");
        let rights = fs::Permissions::from_mode(before);
        fs::set_permissions(lab.path().join("a.csv"), rights).unwrap();
        run();
        assert_eq!(lab.mode("a.csv"), after, "{before:o}");
    }
    // Only the superuser can leave a file of somebody else's here.
    lab.write("a.csv", "old");
    if std::os::unix::fs::chown(lab.path().join("a.csv"), Some(12345), Some(12345)).is_ok() {
        let rights = fs::Permissions::from_mode(0o6777);
        fs::set_permissions(lab.path().join("a.csv"), rights).unwrap();
        done(lab.shell("umask 027; \"$G\" run method-1 --steps 3 -o a.csv --force"));
        assert_eq!(lab.mode("a.csv"), 0o640);
    }
}

#[test]
fn ctrl_c_acts_at_once_when_the_steps_are_done() {
    let lab = Ground::new();
    // A summary that nobody reads holds the program up after its last step, as a long search for advice does.
    done(lab.shell("mkfifo fifo"));
    let mut child = lab
        .command(&["run", "method-1", "--steps", "3", "-o", "a.csv", "--json"])
        .stdout(
            fs::OpenOptions::new()
                .read(true)
                .write(true)
                .open(lab.path().join("fifo"))
                .map(full)
                .unwrap(),
        )
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !lab.files().contains(&"a.csv".to_owned()) {
        std::thread::yield_now();
    }
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(child.try_wait().unwrap().is_none(), "it waits");
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

/// The FIFO `fifo`, open at both ends, with as much in it as it holds.
fn full(mut fifo: fs::File) -> fs::File {
    let mut other = fifo.try_clone().unwrap();
    let filling = std::thread::spawn(move || other.write_all(&[b'x'; 1 << 16]).unwrap());
    filling.join().unwrap();
    fifo.flush().unwrap();
    fifo
}

#[test]
fn a_signal_ends_the_wait_of_a_comparison_for_the_reader_of_a_fifo() {
    let lab = Ground::new();
    done(lab.shell("mkfifo fifo"));
    let mut child = lab
        .command(&["compare", "cusps", "-o", "fifo"])
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500)); // until it waits
    // SIGTERM: what is started in the background of a shell may ignore SIGINT.
    let kill = Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    assert!(!child.wait().unwrap().success());
}

#[test]
fn ctrl_c_ends_a_run_with_130_and_leaves_nothing() {
    let lab = Ground::new();
    lab.write("old.csv", "precious");
    // A header that takes its time: the signal comes in the midst of it.
    let points =
        (0..50_000).map(|n| format!("[[body.point]]\nname = \"p{n}\"\nat_m = [0, 0, 1]\n"));
    let method_2 = done(lab.run(&["presets", "method-2"]));
    let big = stdout(&method_2).to_owned() + &points.collect::<String>();
    lab.write("big.toml", &big);
    for (scenario, args) in [
        ("method-2", &["-o", "new.csv"][..]),
        ("method-2", &["-o", "old.csv", "--force"]),
        ("big.toml", &["-o", "new.csv"]),
        // Each step integrates for a good part of a second, and 4096 of them are taken without a look at the signal.
        (
            "wing-nut",
            &[
                "--scheme",
                "exact",
                "--set",
                "motion.time_step_s=1e4",
                "-o",
                "new.csv",
            ],
        ),
    ] {
        // The signal comes as soon as there is a temporary file.
        let huge = [
            &[
                "run",
                scenario,
                "--steps",
                "9000000000000000000",
                "--every",
                "1000000",
            ],
            args,
        ]
        .concat();
        let mut child = lab
            .command(&huge)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while !lab.files().iter().any(|name| name.ends_with(".part")) {
            assert!(
                child.try_wait().unwrap().is_none(),
                "it runs until it is told to stop"
            );
            std::thread::yield_now();
        }
        let killed = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status()
            .unwrap();
        assert!(killed.success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 130, "{output:?}");
        assert_eq!(lab.files(), ["big.toml", "old.csv"]);
        assert_eq!(lab.read("old.csv"), "precious");
    }
}

#[test]
fn a_signal_ends_the_wait_for_the_reader_of_a_fifo() {
    let lab = Ground::new();
    assert!(
        Command::new("mkfifo")
            .arg(lab.path().join("fifo"))
            .status()
            .unwrap()
            .success()
    );
    let mut child = lab
        .command(&["run", "method-2", "-o", "fifo"])
        .spawn()
        .unwrap();
    let kill = || {
        Command::new("kill")
            .args(["-TERM", &child.id().to_string()])
            .status()
            .unwrap()
    };
    assert!(kill().success());
    // Were the signal caught and the wait taken up again, this would never come back.
    assert!(!child.wait().unwrap().success());
}

/// Ten million rows kept in memory would be 1.2 GB; a run of a hundred steps takes 5 MB, most of it the program
/// itself, and the limit (on address space, the larger figure) is 50 MB.
#[test]
#[ignore = "makes runs of millions of steps: ten seconds"]
fn memory_does_not_grow_with_the_run() {
    let lab = Ground::new();
    done(
        lab.shell("ulimit -v 51200 2>/dev/null; \"$G\" run method-2 --steps 10000000 -o /dev/null"),
    );
}

/// What is drawn takes 300 MB at most, however long the run and however much was measured.
#[test]
#[ignore = "draws runs of millions of steps: ten seconds"]
fn memory_does_not_grow_with_what_is_drawn() {
    let lab = Ground::new();
    let rows = (0..200_000).map(|row| format!("{row},{}\n", 1000 + row * 41 % 97));
    lab.write(
        "many.csv",
        &("t_s,spin_rpm\n".to_owned() + &rows.collect::<String>()),
    );
    for arguments in [
        "writeup falling --set motion.time_step_s=1e7 --set motion.steps=200 -o falling || [ $? = 1 ]",
        "figure heidelberg --measured many.csv --kind spin_rpm -o many.svg",
        "figure method-1 --steps 2000000 --kind 3d -o path.svg",
        "figure cusps --kind above --width 400mm -o wide.png",
    ] {
        let limited = format!("ulimit -v 300000 && RAYON_NUM_THREADS=2 \"$G\" {arguments}");
        done(lab.shell(&limited));
    }
}

#[test]
fn numbers_that_stop_being_finite_end_the_run_and_keep_its_rows() {
    let lab = Ground::new();
    let push = [
        "--set",
        "push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}",
    ];
    for (preset, scheme) in [("method-2", "report"), ("loops", "rk4")] {
        for (every, expected) in [
            ("1", (0..=24).map(f64::from).collect()),
            ("10", vec![0.0, 10.0, 20.0, 24.0]),
            ("12", vec![0.0, 12.0, 24.0]),
        ] {
            let args = [
                "run", preset, "--scheme", scheme, "--every", every, "-o", "a.csv", "--force",
            ];
            failed(
                &lab.run(&[&args[..], &push].concat()),
                &[preset, "no longer finite at step 25"],
            );
            let csv = lab.read("a.csv");
            assert_eq!(steps(&csv), expected, "--every {every}");
            assert!(
                parts(&csv)
                    .2
                    .iter()
                    .flatten()
                    .all(|number| number.is_finite())
            );
        }
    }
    let output = lab.run(&[&["run", "method-2", "--json"][..], &push].concat());
    failed(&output, &["step 25"]);
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(json["steps"], 24);
}

#[test]
fn durations_are_counted_in_the_time_steps_in_force() {
    let lab = Ground::new();
    let last = |args: &[&str]| {
        let output = done(lab.run(&[&["run"], args, &["--json"]].concat()));
        let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
        (
            json["steps"].as_u64().unwrap(),
            json["t_s"].as_f64().unwrap(),
        )
    };
    assert_eq!(last(&["method-2", "--duration", "4"]), (40, 4.0));
    assert_eq!(
        last(&[
            "method-2",
            "--duration",
            "4",
            "--set",
            "motion.time_step_s=0.05"
        ]),
        (80, 4.0)
    );
    assert_eq!(last(&["method-2", "--duration", "4.01"]), (41, 41.0 * 0.1));
    assert_eq!(last(&["method-2", "--duration", "1e-9"]), (1, 0.1));
    let edited = format!(
        "{}\n[[edit]]\nstep = 20\nset = {{ \"motion.time_step_s\" = 0.5 }}\n[[edit]]\nstep = 24\nset = {{ \"motion.time_step_s\" = 0.25 }}\n",
        stdout(&done(lab.run(&["presets", "method-2"])))
    );
    lab.write("edited.toml", &edited);
    assert_eq!(
        last(&["edited.toml", "--duration", "1.5"]),
        (15, 15.0 * 0.1)
    );
    assert_eq!(last(&["edited.toml", "--duration", "3"]), (22, 3.0));
    assert_eq!(last(&["edited.toml", "--duration", "5"]), (28, 5.0));
    assert_eq!(last(&["edited.toml", "--steps", "26"]), (26, 4.5));
    // The header of such a run holds the steps it came to.
    done(lab.run(&["run", "edited.toml", "--duration", "5", "-o", "a.csv"]));
    assert!(parts(&lab.read("a.csv")).0.contains("steps = 28"));
    assert_eq!(steps(&lab.read("a.csv")).len(), 29);
}

#[test]
fn presets_are_listed_and_printed() {
    let lab = Ground::new();
    let list = done(lab.run(&["presets"]));
    for name in [
        "method-1",
        "method-1-steeper",
        "method-2-slow",
        "method-2",
        "wobble-push",
        "wobble-push-accumulating",
    ] {
        assert!(stdout(&list).contains(name), "{name}");
        let printed = done(lab.run(&["presets", name]));
        let file = format!("presets/{name}.toml");
        let shipped = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        assert_eq!(stdout(&printed), shipped);
    }
    failed(
        &lab.run(&["presets", "metod-2"]),
        &["metod-2", "did you mean method-2?"],
    );
    failed(
        &lab.run(&["run", "metod-2"]),
        &["metod-2", "did you mean method-2?"],
    );
    lab.write("mine", stdout(&done(lab.run(&["presets", "method-2"]))));
    failed(&lab.run(&["run", "mine"]), &["./mine"]);
    done(lab.run(&["run", "./mine", "--steps", "3"]));
}

#[test]
fn schemes_are_listed_with_their_orders() {
    let output = done(Ground::new().run(&["schemes"]));
    for (name, order) in [("report", "order 1"), ("rk4", "order 4")] {
        let is_row = |line: &str| line.starts_with(&format!("{name} ")) && line.contains(order);
        assert!(stdout(&output).lines().any(is_row), "{}", stdout(&output));
    }
}

#[test]
fn check_looks_at_every_file() {
    let lab = Ground::new();
    lab.write(
        "good.toml",
        stdout(&done(lab.run(&["presets", "method-2"]))),
    );
    lab.write(
        "bad.toml",
        &lab.read("good.toml").replace("steps = 2300", "steps = 0"),
    );
    done(lab.run(&["run", "method-1", "--steps", "3", "-o", "good.csv"]));
    let output = done(lab.run(&["check", "good.toml", "good.csv"]));
    assert_eq!(stdout(&output).lines().count(), 2);
    assert!(
        stdout(&output).contains("good.toml: good"),
        "{}",
        stdout(&output)
    );
    let output = lab.run(&["check", "none.toml", "bad.toml", "good.toml"]);
    failed(
        &output,
        &[
            "none.toml: there is no such file",
            "bad.toml:",
            "motion.steps (0) must be 1 or more",
        ],
    );
    assert!(
        stdout(&output).contains("good.toml: good"),
        "the good one after the bad ones is looked at too"
    );
    let output = lab.run(&["check", "cusps"]);
    failed(
        &output,
        &[
            "check takes files, and cusps is a preset",
            "gyrolab run cusps",
        ],
    );
}

#[test]
fn completions_and_the_manual_know_the_commands() {
    let lab = Ground::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = done(lab.run(&["completions", shell]));
        assert!(stdout(&script).contains("gyrolab"), "{shell}");
    }
    lab.write(
        "completion.bash",
        stdout(&done(lab.run(&["completions", "bash"]))),
    );
    if Command::new("bash").arg("--version").output().is_ok() {
        done(lab.shell("bash -n completion.bash"));
    }
    let manual = done(lab.run(&["man"]));
    for word in ["GYROLAB RUN", "--duration", "--force"] {
        assert!(stdout(&manual).contains(word), "{word}");
    }
    done(lab.run(&["man", "--all", "-o", "man1"]));
    assert!(lab.read("man1/gyrolab.1").contains(".TH gyrolab"));
}

#[test]
fn the_talk_about_a_run_does_not_depend_on_stderr_being_open() {
    let lab = Ground::new();
    let mut child = lab
        .command(&["run", "method-1", "--steps", "3", "-o", "a.csv"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stderr.take());
    assert!(child.wait().unwrap().success());
    assert_eq!(steps(&lab.read("a.csv")).len(), 4);
}

#[test]
fn talk_that_cannot_be_written_ends_nothing() {
    let lab = Ground::new();
    for (command, words) in [
        ("run method-2 --steps 5 -o -", "step,t_s"),
        ("method-2 --at 3", "Method 2"),
        ("sessions", ""),
    ] {
        let output = lab.shell(&format!("$G {command} </dev/null 2>/dev/full"));
        assert_eq!(output.status.code(), Some(0), "{command}");
        assert!(stdout(&output).contains(words), "{command}");
    }
    for command in [
        "--help",
        "--version",
        "show cusps --at 1",
        "run cusps --steps 1",
        "schemes",
    ] {
        let output = lab.shell(&format!("$G {command} </dev/null >/dev/full"));
        failed(
            &output,
            &["gyrolab: cannot write to stdout: No space left on device"],
        );
    }
}

#[test]
fn a_scenario_may_come_through_a_pipe() {
    let lab = Ground::new();
    let scenario = done(lab.run(&["presets", "method-2"])).stdout;
    let mut child = lab
        .command(&["run", "/dev/stdin", "--steps", "3", "-o", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(&scenario).unwrap();
    let mut csv = String::new();
    child
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut csv)
        .unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(steps(&csv), [0.0, 1.0, 2.0, 3.0]);
}

#[test]
fn the_measured_extremes_are_those_of_the_csv_and_theory_has_its_own_names() {
    let lab = Ground::new();
    let output = done(lab.run(&["run", "wobble-push", "-o", "a.csv", "--json"]));
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    let csv = lab.read("a.csv");
    let (_, columns, rows) = parts(&csv);
    let column = |name: &str| {
        let index = columns
            .split(',')
            .position(|column| column == name)
            .unwrap();
        rows.iter().map(|row| row[index]).collect::<Vec<f64>>()
    };
    for (name, column) in [("tilt_deg", column("tilt_deg")), ("z_m", column("z_m"))] {
        let least = column.iter().copied().fold(f64::INFINITY, f64::min);
        let most = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(json[format!("measured_lowest_{name}")], least, "{name}");
        assert_eq!(json[format!("measured_highest_{name}")], most, "{name}");
    }
    assert!(json["measured_highest_tilt_deg"].as_f64() > Some(56.0));
    assert!(json["predicted_highest_tilt_deg"].as_f64() < Some(45.1));
    assert!(json.get("lowest_tilt_deg").is_none() && json.get("highest_tilt_deg").is_none());
    let summary = stderr(&output);
    assert!(
        summary.contains("degrees; 36.099381 to 56.945407 in the run"),
        "{summary}"
    );
    assert!(
        summary.contains("z             0.617092542 to 0.914143407 m in the run"),
        "{summary}"
    );
    let listed = done(lab.run(&["readouts"]));
    for name in json.as_object().unwrap().keys() {
        let begins = |line: &str| line.split(' ').next() == Some(name);
        assert!(stdout(&listed).lines().any(begins), "{name}");
    }
}

#[test]
fn the_next_export_removes_what_a_killed_one_has_left() {
    let ground = Ground::new();
    let args = ["run", "method-2", "--steps", "1000000000", "-o", "long.csv"];
    let mut child = ground.command(&args).stderr(Stdio::null()).spawn().unwrap();
    while ground.files().is_empty() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let run = ["run", "cusps", "--steps", "2", "-o"];
    ground.run(&[&run[..], &["1.csv"]].concat());
    assert_eq!(ground.files().len(), 2, "one is being written");
    child.kill().unwrap();
    child.wait().unwrap();
    ground.run(&[&run[..], &["2.csv"]].concat());
    assert_eq!(ground.files(), ["1.csv", "2.csv"]);
}
