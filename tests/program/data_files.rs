//! Files of measured data in common formats, also from standard input, and scenarios with names in wide characters.

use crate::support::ground::{Ground, code, done, stderr, stdout};
use crate::support::words::{has, has_all};
use std::fmt::Write;
use unicode_width::UnicodeWidthStr;

const SYMMETRIC: &str = r#"
title = "free symmetric"
[[body.part]]
shape = "moments"
name = "body"
mass_kg = 1
at_m = [0, 0, 0]
moments_kg_m2 = [1, 1, 1.4]
[start]
omega_rad_per_s = [0.8, 0, 10]
omega_frame = "body"
[motion]
gravity_m_per_s2 = 0
scheme = "exact"
time_step_s = 0.01
steps = 200
"#;

/// The angular rates of the symmetric body with I3 = 1.5 I1, as logged in ms and degrees per second.
fn logged_rates() -> String {
    let mut text = "timestamp_ms,gx_dps,gy_dps,gz_dps\n".to_owned();
    for row in 0..100 {
        let time_s = 0.01 * f64::from(row);
        let angle = 10.0 * 0.5 * time_s;
        let rates = [0.8 * angle.cos(), 0.8 * angle.sin(), 10.0];
        let [x, y, z] = rates.map(f64::to_degrees);
        writeln!(text, "{},{x:.2},{y:.2},{z:.2}", 10 * row).unwrap();
    }
    text
}

#[test]
fn units_in_column_names_are_converted() {
    let ground = Ground::new();
    ground.write("sym.toml", SYMMETRIC);
    ground.write("log.csv", &logged_rates());
    let fit = "fit log.csv --in sym.toml --free body.part.0.moments_kg_m2.2 --json";
    let maps = [
        "",
        " --map timestamp_ms=t_ms,gx_dps=w1_deg_per_s,gy_dps=w2_deg_per_s,gz_dps=w3_deg_per_s",
        " --map timestamp_ms=t_s,gx_dps=w1_rad_per_s",
    ];
    for map in maps {
        let json = ground.json(&format!(
            "{fit}{map} --sigma gx_dps=0.003,gy_dps=0.003,gz_dps=0.003"
        ));
        let found = json["keys"][0]["value"].as_f64().unwrap();
        assert!((found - 1.5).abs() < 1e-4, "{map}: {found}");
        let chi_squared = json["chi_squared"].as_f64().unwrap();
        assert!((200.0..400.0).contains(&chi_squared), "{chi_squared}");
    }
    let told = ground.stderr(&fit.replace(" --json", ""));
    has(told, "timestamp_ms as t_s (times 0.001)");
    let written = format!(
        "{} --sigma gx_dps=1,w2_deg_per_s=1,w3_rad_per_s=0.02 --map gx_dps=w1_deg_per_s -o fit.csv",
        fit.replace(" --json", "")
    );
    done(ground.run(&written));
    done(ground.run("verify fit.csv"));
    done(ground.run("figure fit.csv -o fit.svg"));
}

#[test]
fn data_and_scenarios_are_read_from_standard_input() {
    let ground = Ground::new();
    ground.write("sym.toml", SYMMETRIC);
    ground.write("log.csv", &logged_rates());
    let free = "--free body.part.0.moments_kg_m2.2";
    let from_file = ground.stdout(&format!("fit log.csv --in sym.toml {free} --json"));
    for line in [
        format!("$G fit - --in sym.toml {free} --json < log.csv"),
        format!("$G fit log.csv --in - {free} --json < sym.toml"),
    ] {
        let output = done(ground.shell(&line));
        let value =
            |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap()["keys"].clone();
        assert_eq!(value(stdout(&output)), value(&from_file), "{line}");
    }
    let both = ground.shell(&format!("$G fit - --in - {free} < log.csv"));
    assert_eq!(code(&both), 2);
    has(stderr(&both), "standard input");
    done(ground.shell(&format!(
        "$G fit - --in sym.toml {free} -o fit.csv < log.csv"
    )));
    ground.refused("verify fit.csv", 1, &["standard input"]);
    // Runs of a scenario, and of a CSV whose header is one.
    let rows = ground.stdout("run sym.toml -o -");
    for line in [
        "$G run - -o - < sym.toml",
        "$G run sym.toml -o - | $G run - -o -",
    ] {
        assert_eq!(stdout(&done(ground.shell(line))), rows, "{line}");
    }
    let broken = ground.shell("printf 'title = 1' | $G run -");
    assert_eq!(code(&broken), 1);
    has(stderr(&broken), "standard input:1: title");
}

#[test]
fn one_column_of_repeated_measurements_can_be_fitted() {
    let ground = Ground::new();
    ground.write(
        "periods.csv",
        "predicted_body_cone_period_ms\n1255\n1257\n1256.5\n1258\n1256\n",
    );
    ground.write("sym.toml", SYMMETRIC);
    let fit = "fit periods.csv --in sym.toml --free body.part.0.moments_kg_m2.2";
    let json = ground.json(&format!("{fit} --json"));
    let found = json["keys"][0]["value"].as_f64().unwrap();
    assert!((found - 1.5).abs() < 1e-2, "{found}");
    done(ground.run(&format!("{fit} -o fit.csv")));
    done(ground.run("verify fit.csv"));
}

#[test]
fn rows_outside_the_fitted_time_are_counted() {
    let ground = Ground::new();
    ground.write("sym.toml", SYMMETRIC);
    ground.write("log.csv", &logged_rates().replacen("\n0,", "\n-1.6,", 1));
    let fit = "fit log.csv --in sym.toml --free start.omega_rad_per_s.2 --from 0.1 --to 0.5";
    let told = ground.stderr(fit);
    has_all(
        &told,
        ["1 row before t = 0", "58 rows outside --from and --to"],
    );
}

#[test]
fn implausible_data_are_reported() {
    let ground = Ground::new();
    ground.write(
        "tip.csv",
        "t\tx\ty\n0\t25\t0\n0.01\t24.998\t0.25\n0.02\t24.99\t0.5\n",
    );
    let scenario = SYMMETRIC.replace(
        "[start]",
        "[[body.point]]\nname = 'tip'\nat_m = [0, 0, 0.25]\n[start]",
    );
    ground.write("tip.toml", &scenario);
    for command in [
        "fit tip.csv --in tip.toml --free start.omega_rad_per_s.2",
        "figure tip.toml --measured tip.csv -o tip.svg",
        "writeup tip.toml --measured tip.csv -o folder",
    ] {
        let told = ground.stderr(command);
        assert_eq!(told.matches("from the pivot").count(), 1, "{told}");
        has(told, "--map x=x_cm,y=y_cm");
    }
}

#[test]
fn pictures_with_wide_characters_keep_their_width() {
    let ground = Ground::new();
    let scenario = SYMMETRIC
        .replace("free symmetric", "陀螺仪的进动实验 速い独楽は倒れずに")
        .replace(
            "[start]",
            "[[body.point]]\nname = '轴顶端的小孔'\nat_m = [0, 0, 0.25]\n[start]",
        )
        .replace("\"body\"\nmass", "\"飞轮\"\nmass")
        .replacen(
            "title",
            "about = '一段很长的说明文字,用来检查自动换行的宽度是否正确。'\ntitle",
            1,
        )
        + "[view]\nlook_at = '看陀螺仪的进动:轴顶端的小孔画出一个圆,每一圈需要两秒多;再按一次键可以看到章动。'\n";
    ground.write("wide.toml", &scenario);
    for (width, size) in [(80, "80x24"), (200, "200x50"), (47, "47x20")] {
        let picture = ground.stdout(&format!("show wide.toml --size {size}"));
        let widest = picture.lines().map(UnicodeWidthStr::width).max();
        assert_eq!(widest, Some(width), "{picture}");
        has(&picture, "陀螺仪");
        assert!(!picture.contains("陀 螺"), "{picture}");
    }
    let picture = ground.stdout("show wide.toml --markers ascii");
    assert!(picture.is_ascii() && picture.lines().all(|line| line.len() <= 80));
    let svg = ground.stdout("show wide.toml --svg");
    has(svg, ">陀<");
}
