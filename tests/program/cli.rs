//! The promises of the command line: exit codes, the use of stdout and stderr, files that appear complete or not at all,
//! and CSVs that reproduce themselves byte for byte.

use crate::support::ground::{Ground, code, done, failed, refused, stderr, stdout};
use crate::support::pty::signal;
use crate::support::words::{has, has_all, has_no};
use std::fs;
use std::io::Write;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Stdio;

/// The first columns of every CSV. Other programs rely on them.
const COLUMNS: &str = "step,t_s,x_m,y_m,z_m,Lx_Js,Ly_Js,Lz_Js,wx_rad_per_s,wy_rad_per_s,wz_rad_per_s,tilt_deg,azimuth_deg,energy_J,segment";

/// A short run.
const RUN: &str = "run method-1 --steps 3";

/// Splits a CSV into the run file in its header, the line of column names, and the rows.
fn parts(csv: &str) -> (String, &str, Vec<Vec<f64>>) {
    let is_header = |line: &&str| line.starts_with('#');
    let header = csv.lines().take_while(is_header).map(|line| {
        let text = line.strip_prefix("# ");
        text.unwrap_or_else(|| panic!("{line}")).to_owned() + "\n"
    });
    let mut lines = csv.lines().skip_while(is_header);
    let columns = lines.next().unwrap();
    let rows = lines.map(|line| {
        line.split(',')
            .map(|field| field.parse().unwrap())
            .collect()
    });
    (header.collect(), columns, rows.collect())
}

fn steps(csv: &str) -> Vec<f64> {
    parts(csv).2.iter().map(|row| row[0]).collect()
}

/// Waits until `is_so` returns true. Panics if the program ends before.
fn wait_until(child: &mut std::process::Child, is_so: impl Fn() -> bool) {
    while !is_so() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::yield_now();
    }
}

#[test]
fn exit_codes_distinguish_success_failure_and_misuse() {
    let lab = Ground::new();
    for (args, expected) in [
        (RUN, 0),
        ("schemes", 0),
        ("--help", 0),
        ("--version", 0),
        ("run no-such-preset", 1),
        ("run no/such/file.toml", 1),
        ("run method-1 --set motion.steps=0", 1),
        ("presets no-such-preset", 1),
        ("check no-such-file.toml", 1),
        ("run", 2),
        ("run method-1 --nonsense", 2),
        ("run method-1 --steps -1", 2),
        ("run method-1 --every 0", 2),
        ("run method-1 --duration 0", 2),
        ("run method-1 --duration nan", 2),
        ("run method-1 --steps 3 --duration 1", 2),
        ("run method-1 --scheme nonsense", 2),
        ("run method-1 -o ''", 2),
        ("run method-1 -o - --json", 2),
        ("check", 2),
        ("completions nonsense", 2),
    ] {
        let output = lab.run(args);
        assert_eq!(code(&output), expected, "{args}: {output:?}");
        let is_silent = output.stderr.is_empty();
        assert_eq!(is_silent, expected == 0, "{args}: {output:?}");
    }
    assert_eq!(lab.files(), [""; 0]);
}

#[test]
fn the_summary_on_stdout_describes_the_end_of_the_run() {
    let output = done(Ground::new().run("run method-2"));
    assert!(output.stderr.is_empty());
    let words = "Method 2|scheme|report|2300|0.1 s|230 s|0.810940|-707.256771|tilt|energy drift|wall time|steps a second";
    has_all(stdout(&output), words.split('|'));
}

#[test]
fn the_json_has_the_documented_keys() {
    let args = "run method-2 --json --scheme rk4 --steps 7 --set motion.time_step_s=0.001";
    let output = done(Ground::new().run(args));
    assert!(output.stderr.is_empty());
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    let keys = "t_s x_m y_m z_m Lx_Js Ly_Js Lz_Js tilt_deg energy_drift wall_s steps_per_second";
    for key in keys.split(' ') {
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
    let still = "run torque-free --set start.momentum_Js=[0,0,0] --steps 3";
    has(lab.stdout(still), "n/a");
    let json = lab.json(&format!("{still} --json"));
    assert!(json["energy_drift"].is_null(), "{json}");
}

#[test]
fn with_an_output_file_the_summary_goes_to_stderr_and_json_to_stdout() {
    let lab = Ground::new();
    let output = done(lab.run(&format!("{RUN} -o a.csv")));
    assert!(output.stdout.is_empty());
    has_all(stderr(&output), ["Method 1", "wall time"]);
    let with_json = done(lab.run(&format!("{RUN} -o b.csv --json")));
    let json: serde_json::Value = serde_json::from_str(stdout(&with_json)).unwrap();
    assert_eq!(json["steps"], 3);
    has(stderr(&with_json), "Method 1");
    let to_stdout = done(lab.run(&format!("{RUN} -o -")));
    assert_eq!(stdout(&to_stdout), lab.read("a.csv"));
    has(stderr(&to_stdout), "Method 1");
    assert_eq!(lab.read("a.csv"), lab.read("b.csv"));
}

#[test]
fn the_csv_begins_with_its_run_file_and_the_columns() {
    let lab = Ground::new();
    let set = "--set push.0.force_N=[0,0,-50] --set motion.time_step_s=0.002";
    lab.stderr(&format!(
        "run wobble-push --steps 12 --scheme rk4 {set} -o a.csv"
    ));
    let csv = lab.read("a.csv");
    let (header, columns, rows) = parts(&csv);
    let begins = columns.strip_prefix(COLUMNS);
    let is_known = begins.is_some_and(|more| more.is_empty() || more.starts_with(','));
    assert!(is_known, "{columns}");
    assert_eq!(rows.len(), 13);
    let run: toml::Table = header.parse().unwrap();
    assert!(run["gyrolab"].is_str());
    assert_eq!(run["motion"]["steps"].as_integer(), Some(12));
    assert_eq!(run["motion"]["scheme"].as_str(), Some("rk4"));
    assert_eq!(run["motion"]["time_step_s"].as_float(), Some(0.002));
    assert_eq!(run["push"][0]["force_N"][2].as_float(), Some(-50.0));
    // The header alone is a scenario file that produces the same CSV.
    lab.write("run.toml", &header);
    lab.stdout("check run.toml a.csv");
    lab.stderr("run run.toml -o again.csv");
    assert_eq!(lab.read("again.csv"), csv);
}

#[test]
fn csv_numbers_read_back_bit_for_bit() {
    let lab = Ground::new();
    let csv = lab.stdout("run method-2 --steps 40 -o -");
    let (_, _, rows) = parts(&csv);
    let json = lab.json("run method-2 --steps 40 --json");
    for (column, key) in [
        (1, "t_s"),
        (2, "x_m"),
        (5, "Lx_Js"),
        (11, "tilt_deg"),
        (13, "energy_J"),
    ] {
        let known = json[key].as_f64().unwrap();
        assert_eq!(rows[40][column].to_bits(), known.to_bits(), "{key}");
    }
}

#[test]
fn a_csv_reproduces_itself_byte_for_byte() {
    let lab = Ground::new();
    let preset = lab.stdout("presets wobble-push");
    let edits = "\n[[edit]]\nstep = 100\nset = { \"motion.time_step_s\" = 0.03, \"push.0.force_N\" = [1, 2, 3] }\n\
        \n[[edit]]\nstep = 150\nset = { \"motion.scheme\" = \"rk4\", \"motion.time_step_s\" = 0.001 }\n";
    lab.write("edited.toml", &format!("{preset}{edits}"));
    for name in [
        "method-1",
        "method-2",
        "wobble-push",
        "wobble-push-accumulating",
        "loops",
        "torque-free",
        "edited.toml",
    ] {
        for every in [1, 7] {
            let run = |what: &str, to: &str| {
                lab.stderr(&format!("run {what} --every {every} -o {to} --force"));
            };
            run(name, "first.csv");
            run("first.csv", "second.csv");
            let (first, second) = (lab.read("first.csv"), lab.read("second.csv"));
            assert!(first == second, "{name} --every {every}");
            // This works even in place: the old file is read before the new one replaces it.
            run("first.csv", "first.csv");
            assert!(first == lab.read("first.csv"), "{name} --every {every}");
        }
    }
}

#[test]
fn line_ends_and_byte_order_marks_do_not_change_a_run() {
    let lab = Ground::new();
    lab.stderr("run method-1 --steps 5 -o a.csv");
    let of_windows = format!("\u{feff}{}", lab.read("a.csv").replace('\n', "\r\n"));
    lab.write("b.csv", &of_windows);
    lab.stderr("run b.csv -o again.csv");
    assert_eq!(lab.read("again.csv"), lab.read("a.csv"));
}

#[test]
fn the_every_option_writes_every_nth_row_and_the_last() {
    let lab = Ground::new();
    let run = |steps: u64, every: u64| {
        lab.stdout(&format!(
            "run method-2 --steps {steps} --every {every} -o -"
        ))
    };
    let all: Vec<f64> = (0..=10).map(f64::from).collect();
    for (count, every, expected) in [
        (10, 1, &all[..]),
        (10, 4, &[0.0, 4.0, 8.0, 10.0]),
        (12, 4, &[0.0, 4.0, 8.0, 12.0]),
        (3, 100, &[0.0, 3.0]),
        (1, u64::MAX, &[0.0, 1.0]),
    ] {
        assert_eq!(steps(&run(count, every)), expected, "{count} {every}");
    }
    // More steps than are computed between two checks for signals.
    let (every_row, few_rows) = (run(10000, 1), run(10000, 999));
    let mut expected = parts(&every_row).2;
    expected.retain(|row| row[0] % 999.0 == 0.0 || row[0] == 10000.0);
    // --every selects rows and does not change their contents.
    assert_eq!(parts(&few_rows).2, expected);
}

#[test]
fn a_file_is_replaced_only_with_force_and_keeps_its_permissions() {
    let lab = Ground::new();
    lab.write("a.csv", "precious");
    fs::set_permissions(lab.file("a.csv"), fs::Permissions::from_mode(0o646)).unwrap();
    lab.refused(&format!("{RUN} -o a.csv"), 1, &["a.csv", "--force"]);
    assert_eq!(lab.read("a.csv"), "precious");
    // A rejected scenario does not replace it either.
    let refused = "run method-1 --set motion.steps=0 -o a.csv --force";
    lab.refused(refused, 1, &["motion.steps"]);
    assert_eq!(lab.read("a.csv"), "precious");
    done(lab.shell("umask 077; \"$G\" run method-1 --steps 3 -o a.csv --force"));
    assert_eq!(steps(&lab.read("a.csv")).len(), 4);
    assert_eq!(lab.mode("a.csv"), 0o646);
    assert_eq!(lab.files(), ["a.csv"]);
}

#[test]
fn a_new_file_has_permissions_from_the_umask() {
    let lab = Ground::new();
    for (umask, mode) in [("022", 0o644), ("002", 0o664), ("077", 0o600)] {
        let name = format!("{umask}.csv");
        done(lab.shell(&format!("umask {umask}; \"$G\" {RUN} -o {name}")));
        assert_eq!(lab.mode(&name), mode, "umask {umask}");
    }
}

#[test]
fn writing_through_a_link_keeps_the_link() {
    let lab = Ground::new();
    fs::create_dir(lab.file("data")).unwrap();
    lab.write("data/a.csv", "old");
    symlink("data/a.csv", lab.file("link.csv")).unwrap();
    lab.refused(&format!("{RUN} -o link.csv"), 1, &["--force"]);
    lab.stderr(&format!("{RUN} -o link.csv --force"));
    assert!(lab.file("link.csv").is_symlink());
    assert_eq!(steps(&lab.read("data/a.csv")).len(), 4);
    symlink("nowhere.csv", lab.file("dead.csv")).unwrap();
    lab.refused(&format!("{RUN} -o dead.csv"), 1, &["dead.csv", "link"]);
    assert_eq!(lab.files(), ["data", "dead.csv", "link.csv"]);
}

#[test]
fn an_unwritable_output_is_named_and_leaves_no_files() {
    let lab = Ground::new();
    fs::create_dir(lab.file("folder")).unwrap();
    lab.write("file", "");
    for (target, words) in [
        ("none/a.csv", &["none/a.csv", "no folder"]),
        ("folder", &["folder", "is a folder"]),
        ("folder/", &["folder", "is a folder"]),
        ("new/", &["new/", "is a folder"]),
        ("new/.", &["new/.", "is a folder"]),
        ("..", &["..", "is a folder"]),
        ("file/a.csv", &["file/a.csv", "file"]),
    ] {
        lab.refused(&format!("{RUN} -o {target}"), 1, words);
    }
    assert_eq!(lab.files(), ["file", "folder"]);
    if Path::new("/dev/full").exists() {
        let words = "free some room, or name a file on another disk";
        lab.refused("run method-1 -o /dev/full", 1, &["/dev/full", words]);
        for command in ["run method-1 -o -", "presets"] {
            let full = lab.shell(&format!("\"$G\" {command} > /dev/full"));
            failed(&full, &["stdout", "space"]);
        }
    }
}

#[test]
fn a_file_size_limit_fails_the_write() {
    let lab = Ground::new();
    for (output, name) in [("a.csv", "a.csv"), ("- > b.csv", "stdout")] {
        let run = format!("ulimit -f 40; \"$G\" run method-2 --steps 20000 -o {output}");
        failed(&lab.shell(&run), &[name, "large"]);
        assert!(!lab.file("a.csv").exists());
    }
    assert_eq!(lab.files(), ["b.csv"]);
}

#[test]
fn quiet_silences_all_but_errors() {
    let lab = Ground::new();
    for command in [
        "run method-2 --steps 9 -o run.csv",
        "sweep cusps --steps 2 --vary start.tilt_deg=10,20 --measure z_m -o sweep.csv",
        "figure cusps -o figure.svg",
        "fit heidelberg-nutation --in heidelberg --free body.part.0.moments_kg_m2.2 -o fit.csv",
    ] {
        assert_ne!(lab.stderr(command), "", "{command}");
        assert_eq!(
            lab.stderr(&format!("{command} --force -q")),
            "",
            "{command}"
        );
    }
    lab.refused("run nothing --quiet", 1, &["nothing"]);
    lab.refused("check run.toml --quiet", 1, &["run.toml"]);
}

#[test]
fn a_closed_pipe_ends_the_program_silently() {
    let lab = Ground::new();
    for command in [
        "run method-2 --steps 200000 -o -",
        "run method-2 --steps 200000 --every 3 -o -",
        "man",
        "completions zsh",
        "presets",
    ] {
        // The reader closes the pipe before or after the first byte.
        for reader in ["true", "head -c 1 > first"] {
            let pipe = format!("{{ \"$G\" {command}; echo $? > code; }} | {reader}");
            let output = lab.shell(&pipe);
            assert_eq!(lab.read("code").trim(), "0", "{pipe}: {output:?}");
            assert_eq!(stderr(&output), "", "{pipe}");
        }
    }
}

#[test]
fn fifos_and_devices_are_written_directly() {
    let lab = Ground::new();
    lab.stderr(&format!("{RUN} -o a.csv"));
    lab.stderr(&format!("{RUN} -o /dev/null"));
    assert_eq!(lab.files(), ["a.csv"]);
    lab.make_fifo("fifo");
    done(lab.shell(&format!(
        "cat fifo > read.csv & \"$G\" {RUN} -o fifo && wait"
    )));
    assert_eq!(lab.read("read.csv"), lab.read("a.csv"));
    assert_eq!(lab.files(), ["a.csv", "fifo", "read.csv"]);
}

#[test]
fn stdout_named_as_a_path_is_appended_to() {
    let lab = Ground::new();
    let run = &format!("\"$G\" {RUN}");
    done(lab.shell(&format!("{run} -o a.csv")));
    let rows = lab.read("a.csv");
    symlink("/dev/stdout", lab.file("link")).unwrap();
    for name in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link"] {
        // The file keeps its contents and its identity.
        lab.write("b.csv", "first\n");
        fs::hard_link(lab.file("b.csv"), lab.file("same.csv")).unwrap();
        done(lab.shell(&format!("{run} -o {name} >> b.csv")));
        assert_eq!(lab.read("same.csv"), format!("first\n{rows}"), "{name}");
        done(lab.shell(&format!("(echo a; {run} -o {name}; echo b) > b.csv")));
        assert_eq!(lab.read("same.csv"), format!("a\n{rows}b\n"), "{name}");
        let both = lab.shell(&format!("{run} --json -o {name}"));
        assert_eq!(code(&both), 2, "{name}");
        fs::remove_file(lab.file("same.csv")).unwrap();
    }
    done(lab.shell(&format!("{run} -o /dev/fd/3 3> b.csv")));
    assert_eq!(lab.read("b.csv"), rows);
    done(lab.shell("\"$G\" compare method-1 --steps 3 -o /dev/stdout > b.csv"));
    let table = lab.read("b.csv");
    assert!(table.starts_with("# "), "{table}");
    has_no(&table, "scheme  ");
    assert_eq!(lab.files(), ["a.csv", "b.csv", "link"]);
}

#[test]
fn a_scenario_can_be_read_from_a_fifo() {
    let lab = Ground::new();
    lab.write("cusps.toml", &lab.stdout("presets cusps"));
    for command in [
        "show FILE",
        "FILE",
        "run FILE --steps 3 -o -",
        "compare FILE --steps 3 -o -",
        "check FILE",
    ] {
        let from_file = lab.run(&command.replace("FILE", "./cusps.toml"));
        // A second read would block forever.
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
fn a_replaced_file_keeps_its_permissions_without_set_id_bits() {
    let lab = Ground::new();
    let set_mode = |mode| {
        fs::set_permissions(lab.file("a.csv"), fs::Permissions::from_mode(mode)).unwrap();
    };
    for (before, after) in [(0o640, 0o640), (0o6755, 0o755), (0o1604, 0o604)] {
        lab.write("a.csv", "old");
        set_mode(before);
        lab.stderr(&format!("{RUN} -o a.csv --force"));
        assert_eq!(lab.mode("a.csv"), after, "{before:o}");
    }
    // Only root can create a file of another user here.
    lab.write("a.csv", "old");
    if std::os::unix::fs::chown(lab.file("a.csv"), Some(12345), Some(12345)).is_ok() {
        set_mode(0o6777);
        done(lab.shell("umask 027; \"$G\" run method-1 --steps 3 -o a.csv --force"));
        assert_eq!(lab.mode("a.csv"), 0o640);
    }
}

#[test]
fn ctrl_c_acts_at_once_after_the_last_step() {
    let lab = Ground::new();
    // A summary that nobody reads blocks the program after its last step, like a long search for advice.
    lab.make_fifo("fifo");
    let mut both_ends = fs::OpenOptions::new();
    let mut fifo = both_ends
        .read(true)
        .write(true)
        .open(lab.file("fifo"))
        .unwrap();
    fifo.write_all(&[b'x'; 1 << 16]).unwrap(); // as much as it holds
    let mut command = lab.command(&format!("{RUN} -o a.csv --json"));
    let mut child = command.stdout(fifo).stderr(Stdio::null()).spawn().unwrap();
    while !lab.files().contains(&"a.csv".to_owned()) {
        std::thread::yield_now();
    }
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(child.try_wait().unwrap().is_none(), "it waits");
    signal(child.id(), "INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_signal_ends_the_wait_for_the_reader_of_a_fifo() {
    let lab = Ground::new();
    lab.make_fifo("fifo");
    for args in ["run method-2 -o fifo", "compare cusps -o fifo"] {
        let mut child = lab.command(args).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(500)); // until it waits
        // SIGTERM, because processes started in the background of a shell may ignore SIGINT.
        signal(child.id(), "TERM");
        // If the signal were caught and the wait resumed, this would never return.
        assert!(!child.wait().unwrap().success(), "{args}");
    }
}

#[test]
fn a_signal_ends_a_command_with_130_and_leaves_no_files() {
    let lab = Ground::new();
    lab.write("old.csv", "precious");
    // A header that takes long to write, so that the signal arrives while it is written.
    let points =
        (0..50_000).map(|n| format!("[[body.point]]\nname = \"p{n}\"\nat_m = [0, 0, 1]\n"));
    let big = lab.stdout("presets method-2") + &points.collect::<String>();
    lab.write("big.toml", &big);
    // Nine million steps of a scheme that steps by milliseconds, in every run of a fit.
    lab.write("long.csv", "t_s,tilt_deg\n0,20\n9000,20\n");
    // Only the first and the last row are written, so no difference is found before the last step is computed.
    let short = lab.stdout("run method-2 --steps 2 --every 2000000000 -o -");
    lab.write(
        "rows.csv",
        &short.replace("# steps = 2\n", "# steps = 2000000000\n"),
    );
    let there = lab.files();
    let steps = "--steps 9000000000000000000 --every 1000000";
    for (args, is_written) in [
        (&*format!("run method-2 {steps} -o new.csv"), true),
        (&*format!("run method-2 {steps} -o old.csv --force"), true),
        (&*format!("run big.toml {steps} -o new.csv"), true),
        // Each step takes a large part of a second, and 4096 steps are computed between two checks for signals.
        (
            &*format!(
                "run wing-nut {steps} --scheme exact --set motion.time_step_s=1e4 -o new.csv"
            ),
            true,
        ),
        (
            "writeup wing-nut --steps 9000 --scheme exact --set motion.time_step_s=1e4 -o folder",
            true,
        ),
        // One scheme that rarely checks for signals, and many schemes on all cores.
        (
            "compare method-2 --schemes report --time-steps 1e-12 -o new.csv",
            true,
        ),
        ("compare cusps --duration 1e5 -o new.csv", true),
        ("writeup method-2 --steps 100000000 -o folder", true),
        (
            "fit long.csv --in cusps --scheme rk4 --free start.tilt_deg -o new.csv",
            false,
        ),
        ("verify rows.csv", false),
    ] {
        let mut command = lab.command(args);
        let pipes = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = pipes.spawn().unwrap();
        if is_written {
            // The signal is sent as soon as the temporary file exists.
            wait_until(&mut child, || lab.files() != there);
        } else {
            std::thread::sleep(std::time::Duration::from_millis(500));
        }
        signal(child.id(), "INT");
        let output = child.wait_with_output().unwrap();
        refused(args, &output, 130, &[]);
        assert_eq!(
            (stdout(&output), lab.files()),
            ("", there.clone()),
            "{args}"
        );
        assert_eq!(lab.read("old.csv"), "precious");
    }
}

/// A thread stack larger than the memory makes every creation of a thread fail.
#[test]
fn results_are_the_same_without_threads() {
    let lab = Ground::new();
    for command in [
        "compare cusps --steps 100",
        "fit heidelberg-nutation --in heidelberg --free body.part.0.moments_kg_m2.2",
    ] {
        let told = |least_stack: &str| {
            let mut command = lab.command(command);
            let output = done(command.env("RUST_MIN_STACK", least_stack).output().unwrap());
            // The last column of a comparison is the time per step, which varies.
            let lines = stdout(&output)
                .lines()
                .map(|line| line.get(..78).unwrap_or(line));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(told("4611686018427387904"), told("2097152"), "{command}");
    }
}

/// Ten million rows in memory would take 1.2 GB. A run of a hundred steps takes 5 MB, mostly for the program itself. The
/// limit, on address space, is 50 MB.
#[test]
#[ignore = "makes runs of millions of steps: ten seconds"]
fn memory_does_not_grow_with_the_length_of_the_run() {
    let long = "run method-2 --steps 10000000 -o /dev/null";
    done(Ground::new().shell(&format!("ulimit -v 51200 2>/dev/null; \"$G\" {long}")));
}

/// Drawing takes at most 300 MB for any length of the run and any number of measured rows.
#[test]
#[ignore = "draws runs of millions of steps: ten seconds"]
fn memory_of_figures_does_not_grow_with_the_data() {
    let lab = Ground::new();
    let rows = (0..200_000)
        .map(|row| format!("{row},{}\n", 1000 + row * 41 % 97))
        .collect::<String>();
    lab.write("many.csv", &format!("t_s,spin_rpm\n{rows}"));
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
    let push = "--set 'push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}'";
    let all: Vec<f64> = (0..=24).map(f64::from).collect();
    for (preset, scheme) in [("method-2", "report"), ("loops", "rk4")] {
        for (every, expected) in [
            (1, &all[..]),
            (10, &[0.0, 10.0, 20.0, 24.0]),
            (12, &[0.0, 12.0, 24.0]),
        ] {
            let args = format!("run {preset} --scheme {scheme} --every {every} -o a.csv --force");
            let words = [preset, "at step 25"];
            lab.refused(&format!("{args} {push}"), 1, &words);
            let csv = lab.read("a.csv");
            assert_eq!(steps(&csv), expected, "--every {every}");
            let rows = parts(&csv).2;
            assert!(rows.iter().flatten().all(|number| number.is_finite()));
        }
    }
    let output = lab.run(&format!("run method-2 --json {push}"));
    failed(&output, &["step 25"]);
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(json["steps"], 24);
}

#[test]
fn durations_use_the_time_step_in_force() {
    let lab = Ground::new();
    let edits = "\n[[edit]]\nstep = 20\nset = { \"motion.time_step_s\" = 0.5 }\n\
        [[edit]]\nstep = 24\nset = { \"motion.time_step_s\" = 0.25 }\n";
    let edited = lab.stdout("presets method-2") + edits;
    lab.write("edited.toml", &edited);
    for (args, steps, end_s) in [
        ("method-2 --duration 4", 40, 4.0),
        (
            "method-2 --duration 4 --set motion.time_step_s=0.05",
            80,
            4.0,
        ),
        ("method-2 --duration 4.01", 41, 41.0 * 0.1),
        ("method-2 --duration 1e-9", 1, 0.1),
        ("edited.toml --duration 1.5", 15, 15.0 * 0.1),
        ("edited.toml --duration 3", 22, 3.0),
        ("edited.toml --duration 5", 28, 5.0),
        ("edited.toml --steps 26", 26, 4.5),
    ] {
        let json = lab.json(&format!("run {args} --json"));
        assert_eq!(json["steps"], steps, "{args}");
        assert_eq!(json["t_s"], end_s, "{args}");
    }
    // The header of such a run states the resulting number of steps.
    lab.stderr("run edited.toml --duration 5 -o a.csv");
    has(parts(&lab.read("a.csv")).0, "steps = 28");
    assert_eq!(steps(&lab.read("a.csv")).len(), 29);
}

#[test]
fn presets_are_listed_and_printed() {
    let lab = Ground::new();
    let list = lab.stdout("presets");
    for name in [
        "method-1",
        "method-1-steeper",
        "method-2-slow",
        "method-2",
        "wobble-push",
        "wobble-push-accumulating",
    ] {
        has(&list, name);
        let file = format!("presets/{name}.toml");
        let shipped = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        assert_eq!(lab.stdout(&format!("presets {name}")), shipped);
    }
    for command in ["presets metod-2", "run metod-2"] {
        lab.refused(command, 1, &["metod-2", "did you mean method-2?"]);
    }
    lab.write("mine", &lab.stdout("presets method-2"));
    lab.refused("run mine", 1, &["./mine"]);
    lab.stdout("run ./mine --steps 3");
}

#[test]
fn check_reports_on_every_file() {
    let lab = Ground::new();
    let good = lab.stdout("presets method-2");
    lab.write("good.toml", &good);
    lab.write("bad.toml", &good.replace("steps = 2300", "steps = 0"));
    lab.stderr(&format!("{RUN} -o good.csv"));
    let told = lab.stdout("check good.toml good.csv");
    assert_eq!(told.lines().count(), 2);
    has(&told, "good.toml: good");
    let output = lab.run("check none.toml bad.toml good.toml");
    failed(&output, &["none.toml: ", "bad.toml:", "motion.steps (0)"]);
    // The good file after the bad ones is checked too.
    has(stdout(&output), "good.toml: good");
    let words = "check needs files, but cusps is a preset";
    lab.refused("check cusps", 1, &[words, "gyrolab run cusps"]);
}

#[test]
fn every_shell_has_completions() {
    let lab = Ground::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        has(lab.stdout(&format!("completions {shell}")), "gyrolab");
    }
}

#[test]
fn a_closed_stderr_does_not_fail_a_run() {
    let lab = Ground::new();
    let mut command = lab.command(&format!("{RUN} -o a.csv"));
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert!(child.wait().unwrap().success());
    assert_eq!(steps(&lab.read("a.csv")).len(), 4);
}

#[test]
fn a_full_stderr_does_not_fail_a_command() {
    let lab = Ground::new();
    for (command, words) in [
        ("run method-2 --steps 5 -o -", "step,t_s"),
        ("method-2 --at 3", "Method 2"),
        ("sessions", ""),
    ] {
        let output = lab.shell(&format!("$G {command} </dev/null 2>/dev/full"));
        assert_eq!(output.status.code(), Some(0), "{command}");
        has(stdout(&output), words);
    }
    for command in [
        "--help",
        "--version",
        "show cusps --at 1",
        "run cusps --steps 1",
        "schemes",
    ] {
        let output = lab.shell(&format!("$G {command} </dev/null >/dev/full"));
        let words = "gyrolab: cannot write to stdout: No space left on device";
        failed(&output, &[words]);
    }
}

#[test]
fn the_summary_shows_extremes_and_json_keys_are_documented() {
    let lab = Ground::new();
    let json = lab.json("run wobble-push --json");
    // Theory applies to the time after the push, so it predicts no tilt of the whole run.
    assert!(json["predicted_highest_tilt_deg"].is_null());
    has_all(
        lab.stdout("run wobble-push"),
        [
            "degrees; 36.099381 to 56.945407 in the run",
            "z             0.617092542 to 0.914143407 m in the run",
        ],
    );
    let listed = lab.stdout("readouts");
    for name in json.as_object().unwrap().keys() {
        assert!(
            listed
                .lines()
                .any(|line| line.split(' ').next() == Some(name)),
            "{name}"
        );
    }
}

#[test]
fn an_export_removes_the_temporary_files_of_killed_ones() {
    let ground = Ground::new();
    let mut command = ground.command("run method-2 --steps 1000000000 -o long.csv");
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    wait_until(&mut child, || !ground.files().is_empty());
    ground.stderr("run cusps --steps 2 -o 1.csv");
    assert_eq!(ground.files().len(), 2, "one file is being written");
    child.kill().unwrap();
    child.wait().unwrap();
    ground.stderr("run cusps --steps 2 -o 2.csv");
    assert_eq!(ground.files(), ["1.csv", "2.csv"]);
}

/// The last bits of the C library's sine, root and so on differ between systems. gyrolab and all its dependencies use the
/// crate libm instead.
#[test]
#[cfg(target_os = "linux")]
fn no_number_depends_on_the_c_library() {
    let program = fs::read(env!("CARGO_BIN_EXE_gyrolab")).unwrap();
    let needs = |name: &str| program.windows(name.len()).any(|at| at == name.as_bytes());
    assert!(needs("libc.so"), "the program names the libraries it needs");
    assert!(!needs("libm.so"), "nm -D shows which functions it needs");
}
