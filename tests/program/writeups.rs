//! `gyrolab writeup`: the contents of the folder, byte-for-byte reproduction, and the safety of existing files.

use crate::support::ground::{Ground, code, done, failed, names};
use crate::support::tex;
use crate::support::words::{has, has_all, has_no};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// Returns the name and the bytes of every file in the folder, sorted by name.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    names(folder)
        .into_iter()
        .map(|name| {
            let bytes = fs::read(folder.join(&name)).unwrap();
            (name, bytes)
        })
        .collect()
}

fn row_of(page: &str, what: &str) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with('|'));
    let mut rows = rows.map(|line| line.split('|').map(|cell| cell.trim().to_owned()));
    rows.find_map(|cells| {
        let cells: Vec<String> = cells.collect();
        (cells[1] == what).then_some(cells)
    })
    .unwrap()
}

#[test]
fn a_write_up_describes_and_reproduces_its_run() {
    let lab = Ground::new();
    let set = "push.0.force_N=[0,0,-50]";
    done(lab.run(&format!("writeup wobble-push --set {set} --steps 700 -o w")));
    done(lab.run("writeup w/run.toml -o again"));
    assert_eq!(
        contents(&lab.file("w")),
        contents(&lab.file("again")),
        "the run file of a write-up makes the same write-up"
    );
    done(lab.run("run w/run.toml -o run.csv"));
    assert_eq!(lab.read("w/run.csv"), lab.read("run.csv"));
    let page = lab.read("w/README.md");
    for name in ["traces", "swings", "above", "3d"] {
        assert!(page.contains(&format!("]({name}.svg)")), "{name}: {page}");
        let svg = lab.read(&format!("w/{name}.svg"));
        assert!(svg.contains("width=\"86mm\""), "{name}: {svg:.300}");
        let pdf = fs::read(lab.file("w").join(name).with_extension("pdf")).unwrap();
        assert!(pdf.starts_with(b"%PDF-"), "{name}");
    }
    has_all(
        &page,
        [
            "# The wobble push",
            "force_N = [0.0, 0.0, -50.0]\nfirst_step = 1\nsteps = 200",
            "700 of 0.1 s",
            "Not reliable",
            "are our reading; changed since\n\n",
            "| tilt swing since 20 s |",
            "| nutation period since 20 s |",
            "not resolved: the time step is longer than half a nutation",
            "(`measured_nutation_period_s`)",
            "; since the forces last changed, at t = 20 s (`measured_tilt_swing_deg`)\n",
            // The preset's look_at line describes another run.
            "\n\nDiffers from the preset wobble-push: other pushes\n\n",
            "\n\nOf the preset wobble-push as it was: ",
        ],
    );
    let own = "23 % down and 14 % up";
    assert!(!page.contains(own), "{page}");
    done(lab.run("writeup wobble-push --steps 20 -o own"));
    assert!(lab.read("own/README.md").contains(own));
}

#[test]
fn measured_data_are_compared_with_the_run() {
    let lab = Ground::new();
    done(lab.run("run method-2 --steps 40 -o run.csv --columns x_m"));
    let csv = lab.read("run.csv");
    let x: Vec<f64> = csv.lines().filter_map(|line| line.parse().ok()).collect();
    // Two values that are two uncertainties off, and one after the end of the run at 4 s.
    let data = format!(
        "# our wheel\nt_s,x_m,x_uncertainty_m\n1,{},0.01\n2,{},0.01\n100,0.5,0.01\n",
        x[10] + 0.02,
        x[20] - 0.02
    );
    lab.write("bench.csv", &data);
    done(lab.run("writeup method-2 --steps 40 --measured bench.csv -o w"));
    assert_eq!(lab.read("w/bench.csv"), data);
    let page = lab.read("w/README.md");
    has_all(
        &page,
        [
            "`bench.csv` has 3 measured values. The run ends at 4 s, before 1 of them",
            "*χ*² = 8 for 2 measured values with uncertainties",
            "](measured.svg)",
            "Table 3 compares the run with the measured data.",
            "**Table 3.** Measured data",
            "](residuals.svg)",
            "gyrolab writeup run.csv --measured bench.csv -o again",
        ],
    );
    let row = row_of(&page, "`x_m`");
    assert_eq!(row[2..7], ["2 of 3", "2", "8", "2 at 1 s", "–"]);
    tex::check(&lab.file("w"), "report.tex");
    let json: serde_json::Value = serde_json::from_str(&lab.read("w/readouts.json")).unwrap();
    let told = &json["measured_data"];
    let chi_squared = told["chi_squared"].as_f64().unwrap();
    assert!((chi_squared - 8.0).abs() < 1e-9, "{told}");
    assert_eq!(told["file"], "bench.csv");
    assert_eq!(told["points_in_run"], 2);
    assert_eq!(told["columns"][0]["name"], "x_m");
    has(lab.read("w/measured.svg"), "measured: bench (2 points)");
    done(lab.shell("cd w && \"$G\" writeup run.toml --measured bench.csv -o ../again"));
    assert_eq!(contents(&lab.file("w")), contents(&lab.file("again")));
    // Data that cannot be compared with a run are rejected before the folder is created.
    let refused = |file: &str| lab.run(&format!("writeup method-2 --measured {file} -o no"));
    failed(&refused("heidelberg-precession"), &["is a table of runs"]);
    failed(&refused("nothing.csv"), &["nothing.csv"]);
    assert!(!lab.files().contains(&"no".to_owned()));
}

#[test]
fn the_numbers_of_the_page_equal_those_of_the_summary() {
    let lab = Ground::new();
    done(lab.run("writeup cusps -o w"));
    let page = lab.read("w/README.md");
    let json = lab.json("run cusps --json");
    let number = |name: &str| json[name].as_f64().unwrap();
    let row = row_of(&page, "precession");
    let (digits, error) = row[2].split_once('(').unwrap();
    let decimals = digits.split_once('.').unwrap().1.len();
    let measured = number("measured_precession_rad_per_s");
    assert_eq!(digits, format!("{measured:.decimals$}"));
    let error: f64 = error.trim_end_matches(')').parse().unwrap();
    assert!((10.0..100.0).contains(&error), "two digits: {row:?}");
    let stated = error * 0.1_f64.powi(decimals as i32);
    let sigma = number("measured_precession_uncertainty_rad_per_s");
    assert!((stated / sigma - 1.0).abs() < 0.05, "{stated} for {sigma}");
    let predicted = number("predicted_precession_rad_per_s");
    assert_eq!(row[4], format!("{predicted:.decimals$}"));
    // Theory predicts the swing as the difference between the maximum and the minimum tilt.
    let swing = row_of(&page, "tilt swing");
    let range = number("predicted_highest_tilt_deg") - number("predicted_lowest_tilt_deg");
    let theory: f64 = swing[4].parse().unwrap();
    assert!((theory - range).abs() < 1e-5 * range, "{swing:?}");
    // The exact motion is the run of the scheme exact.
    let exact = lab.json("run cusps --scheme exact --json");
    let readouts: serde_json::Value = serde_json::from_str(&lab.read("w/readouts.json")).unwrap();
    for name in [
        "z_m",
        "measured_highest_tilt_deg",
        "measured_precession_rad_per_s",
    ] {
        let [there, own] = [&readouts["exact_motion"][name], &exact[name]];
        let off = there.as_f64().unwrap() - own.as_f64().unwrap();
        assert!(off.abs() < 1e-9, "{name}: {there}, {own}");
    }
    assert_eq!(row_of(&page, "z at the end")[4], "–");
    has(&row_of(&page, "precession")[6], "agrees");
    // What the clock says differs each time: it is not in the folder.
    assert_eq!(readouts["measured_precession_rad_per_s"], measured);
    assert!(readouts.get("wall_s").is_none() && json.get("wall_s").is_some());
}

#[test]
fn texts_of_changed_scenarios_are_not_attributed_to_the_preset() {
    let lab = Ground::new();
    let cusps = lab.stdout("presets cusps");
    let line = |key: &str| {
        let begin = format!("{key} = ");
        cusps.lines().find(|line| line.starts_with(&begin)).unwrap()
    };
    // The look_at line is unchanged, but it now describes another motion.
    let mine = cusps
        .replace(line("source"), "source = \"my homework\"")
        .replace(line("tilt_deg"), "tilt_deg = 50");
    let (before, about) = mine.split_once("about = \"\"\"").unwrap();
    let (_, after) = about.split_once("\"\"\"").unwrap();
    lab.write("mine.toml", &format!("{before}about = \"My top.\"{after}"));
    let words = "this one differs from the preset cusps: start.tilt_deg 50, not 30";
    has(lab.stdout("check mine.toml"), words);
    done(lab.run("writeup mine.toml --steps 50 -o w"));
    let page = lab.read("w/README.md");
    assert!(page.contains("\n\nMy top.\n\n"), "{page}");
    assert!(page.contains("\n\nSource: my homework\n\n"), "{page}");
    assert!(page.contains("Differs from the preset cusps: "), "{page}");
    // With a new look_at line, the preset's other texts still describe another motion.
    let set = "--set 'view.look_at=My line.' --set start.tilt_deg=50";
    done(lab.run(&format!("writeup cusps --steps 50 -o line {set}")));
    let own_line = lab.read("line/README.md");
    assert!(own_line.contains("\n\nMy line.\n\n"), "{own_line}");
    has(&own_line, "\n\nOf the preset cusps as it was: ");
}

/// Minima and maxima are those of the whole run; theory applies after the push. Page and readouts say so.
#[test]
fn theory_applies_after_the_last_change_of_forces() {
    let lab = Ground::new();
    done(lab.run("writeup wobble-push --time-step 0.01 -o w"));
    let page = lab.read("w/README.md");
    assert_eq!(row_of(&page, "lowest tilt")[4], "–");
    let json: serde_json::Value = serde_json::from_str(&lab.read("w/readouts.json")).unwrap();
    assert_eq!(json["predicted_since_s"], 20.0);
    has_all(
        &page,
        [
            "of the motion since 20 s (`predicted_since_s`)",
            "Tilt from 20 s, when the forces last changed, to 20.",
        ],
    );
}

#[test]
fn a_folder_in_use_is_left_alone_unless_forced() {
    let lab = Ground::new();
    let args = "writeup method-1 --steps 20 -o w";
    fs::create_dir(lab.file("w")).unwrap();
    done(lab.run(args)); // an empty folder is accepted
    lab.write("w/README.md", "mine");
    lab.write("w/notes.txt", "mine too");
    lab.refused(args, 1, &["w holds files", "--force"]);
    assert_eq!(lab.read("w/README.md"), "mine");
    lab.write("w/swings.svg", "of another run");
    let told = lab.stderr(&format!("{args} --force"));
    assert!(lab.read("w/README.md").starts_with("# Method 1"));
    assert_eq!(lab.read("w/notes.txt"), "mine too");
    // Files that do not belong to the new write-up are named.
    let left = "not of this write-up, left as found: notes.txt, swings.svg";
    assert!(told.contains(left), "{told}");
    assert_eq!(lab.files(), ["w"], "no temporary folder is left");
}

#[test]
fn an_unwritable_folder_is_rejected_with_a_reason() {
    let lab = Ground::new();
    let write_to = |folder: &str| lab.run(&format!("writeup method-1 --steps 20 -o {folder}"));
    lab.write("file", "");
    failed(&write_to("file"), &["file is not a folder"]);
    failed(&write_to("none/w"), &["there is no folder none"]);
    failed(&lab.run("writeup nonsense -o w"), &["nonsense"]);
    fs::create_dir(lab.file("closed")).unwrap();
    let mode = |mode| fs::set_permissions(lab.file("closed"), fs::Permissions::from_mode(mode));
    mode(0o500).unwrap();
    let output = write_to("closed/w");
    mode(0o700).unwrap();
    // Root can write everywhere.
    if code(&output) != 0 {
        failed(&output, &["cannot write closed/w", "ermission"]);
    }
    assert_eq!(lab.files(), ["closed", "file"]);
}

#[test]
fn a_run_that_breaks_down_is_written_up_to_that_step() {
    let lab = Ground::new();
    let push = "push.0={point=\"top\", force_N=[1e300,0,0], first_step=25, steps=1}";
    let output = lab.run(&format!("writeup method-2 --set '{push}' -o w"));
    failed(&output, &["at step 25"]);
    let csv = lab.read("w/run.csv");
    assert!(csv.lines().last().unwrap().starts_with("24,"), "{csv}");
    let page = lab.read("w/README.md");
    has(&page, "finite at step 25");
}

#[test]
fn an_unresolved_figure_suggests_a_shorter_time_range() {
    let lab = Ground::new();
    done(lab.run("writeup method-1 -o w"));
    let page = lab.read("w/README.md");
    let begin = "In this figure, about 203 swings are too dense to be drawn on 86 mm";
    let remark = page.lines().find(|line| line.starts_with(begin)).unwrap();
    // The suggested command works.
    let command = remark.split('`').find(|part| part.starts_with("gyrolab "));
    let args = command.unwrap().strip_prefix("gyrolab ").unwrap();
    let said = lab.stderr(&args.replace("run.toml", "w/run.toml"));
    has_no(said, "told apart");
    assert!(lab.file("part.pdf").exists());
}

#[test]
fn a_run_of_the_exact_motion_is_described_as_such() {
    let lab = Ground::new();
    done(lab.run("writeup heidelberg --steps 300 -o w"));
    let page = lab.read("w/README.md");
    has_all(
        &page,
        [
            "The numbers are reliable: the run is the exact motion itself.",
            "x, y and z of the traced point over time. The run is the exact motion itself.",
            "no exact motion to compare with: the run is the exact motion itself.",
        ],
    );
    has_no(&page, "dashed");
    has_no(&page, "cover the paper");
}

#[test]
fn an_unreliable_run_is_marked_in_page_figures_and_csv() {
    let lab = Ground::new();
    done(lab.run("writeup wobble-push --steps 300 -o w"));
    let page = lab.read("w/README.md");
    let caption = page.lines().find(|line| line.starts_with("**Figure 1.**"));
    has(caption.unwrap(), "**Not reliable: ");
    tex::check(&lab.file("w"), "report.tex");
    for figure in ["w/traces.svg", "w/3d.svg"] {
        has(lab.read(figure), "caveats = [\"not reliable: ");
    }
    // The header of the CSV has the warning; the CSV can be run and verified.
    let csv = lab.read("w/run.csv");
    let warning = "# # warning: not reliable: under-sampled from the start";
    assert!(csv.starts_with(warning), "{csv:.200}");
    done(lab.run("run w/run.csv -o again.csv"));
    assert_eq!(lab.read("again.csv"), csv);
    done(lab.run("verify again.csv w"));
    // A CSV from before the warning existed still verifies.
    let (_, older) = csv.split_once('\n').unwrap();
    lab.write("older.csv", older);
    done(lab.run("verify older.csv"));
    done(lab.run("run wobble-push --time-step 0.002 --steps 10 -o fine.csv"));
    has_no(lab.read("fine.csv"), "warning:");
}

#[test]
fn the_csv_of_a_write_up_has_the_requested_rows_and_columns() {
    let lab = Ground::new();
    done(lab.run("writeup cusps --every 100 --columns t_s,z_m --format tex -o w"));
    let csv = lab.read("w/run.csv");
    has(&csv, "\nt_s,z_m\n");
    let files = names(&lab.file("w"));
    assert!(files.contains(&"report.tex".to_owned()));
    assert!(!files.contains(&"README.md".to_owned()), "{files:?}");
    done(lab.run("verify w"));
    done(lab.run("writeup w/run.csv -o again --format tex"));
    assert_eq!(contents(&lab.file("w")), contents(&lab.file("again")));
    done(lab.run("writeup cusps --format md -o md"));
    assert!(!names(&lab.file("md")).contains(&"refs.bib".to_owned()));
    done(lab.run("verify md"));
}

#[test]
fn a_write_up_can_contain_a_fit() {
    let lab = Ground::new();
    let free = "--free friction.spin_viscous_Nms,start.spin_rpm";
    let fit = format!("fit heidelberg-spin-decay --in heidelberg {free} --duration 70 -o fit.csv");
    done(lab.run(&fit));
    done(lab.run("writeup fit.csv -o w"));
    let page = lab.read("w/README.md");
    has_all(
        &page,
        [
            "**Table 1.** The measured quantities.",
            "| `friction.spin_viscous_Nms` |",
            "degrees of freedom",
            "Correlations of the fitted values",
            "](fit.svg)",
            "in units of the last digits [2]",
            "| `start.tilt_deg` ",
        ],
    );
    tex::check(&lab.file("w"), "report.tex");
    let json: serde_json::Value = serde_json::from_str(&lab.read("w/fit.json")).unwrap();
    let value = json["keys"][1]["value"].as_f64().unwrap();
    has(
        &row_of(&page, "`start.spin_rpm`")[2],
        format!("{value:.1}("),
    );
    // The folder holds all that the fit needs.
    done(lab.shell("mv w moved && \"$G\" verify moved && cd moved && \"$G\" verify . fit.csv"));
    let other = "writeup fit.csv --measured lab.csv -o no";
    failed(&lab.run(other), &["a write-up of a fit takes neither"]);
}
