//! Measured data shown with a run in the real program.

use crate::support::ground::{Ground, code, stderr, stdout};
use crate::support::words::{has, has_all, has_no};

#[test]
fn one_key_shows_the_residuals() {
    let ground = Ground::new();
    let text = "t_s,x_m,x_uncertainty_m\n0,0.02,0.01\n1,0.04,0.01\n2,0.09,0.01\n";
    ground.write("bench.csv", text);
    let mut lab = ground.open("--paused --at 15 --measured bench.csv");
    lab.wait_for("× measured: bench.csv (2 of 3 points)");
    lab.ask("m", "× residuals: bench.csv");
    lab.ask("m", "× measured: bench.csv");
    lab.press("q");
}

/// Commands that accept no measured data name those that do.
#[test]
fn commands_without_measured_data_name_those_with_it() {
    let ground = Ground::new();
    for command in ["run", "compare", "fit"] {
        let ran = ground.run(&format!("{command} method-2 --measured bench.csv"));
        let told = stderr(&ran);
        assert_eq!(code(&ran), 2, "{told}");
        has_all(
            &told,
            [
                "gyrolab SCENARIO --measured FILE",
                "figure and writeup",
                "gyrolab fit FILE",
            ],
        );
        has_no(&told, "similar argument");
        has_no(&told, "Usage");
    }
}

#[test]
fn broken_data_are_rejected_before_the_screen_opens() {
    let ground = Ground::new();
    ground.write("bad.csv", "t_s,tilt_deg\n0,1\n1,high\n");
    for command in ["method-2", "show method-2"] {
        let ran = ground.run(&format!("{command} --measured bad.csv"));
        assert_eq!((code(&ran), stdout(&ran)), (1, ""));
        has(stderr(&ran), "bad.csv:3: tilt_deg");
    }
}
