//! Huge files, and files that are expensive to reject: the cost grows at most linearly with their size.

use crate::support::scenarios::preset;
use crate::support::words::has;
use gyrolab::engine::scenario::{Document, Problems, Scenario};
use gyrolab::lab::playback::live::LiveRun;
use std::fmt::Write as _;
use std::fs;
use std::sync::Arc;

/// A valid scenario with three points.
const GOOD: &str = "title = 'x'\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 1]\nmass_kg = 1\n[[body.point]]\n\
                    name = 'a'\nat_m = [1, 0, 1]\nmass_kg = 1\n[[body.point]]\nname = 'b'\nat_m = [0, 1, 1]\n\
                    mass_kg = 1\n[start]\nmomentum_Js = [0, 0, 9]\n[motion]\ntime_step_s = 0.01\nsteps = 5\n";

const PUSH: &str = "[[push]]\npoint = 'a'\nforce_N = [0, 0, 1]\nsteps = 1\n";

fn checked(text: &str) -> Result<Scenario, Problems> {
    Document::parse("file.toml", text).and_then(|document| document.scenario())
}

#[track_caller]
fn refusal(text: &str) -> String {
    checked(text).map(drop).unwrap_err().to_string()
}

#[test]
fn the_length_of_texts_is_limited() {
    let long = |count: usize| "x".repeat(count);
    let titled = |title: &str| GOOD.replace("'x'", &format!("'{title}'"));
    checked(&titled(&long(1000))).unwrap();
    has(
        &refusal(&titled(&long(1001))),
        "must be at most 1000 characters long, not 1001",
    );
    let about = |count| format!("about = '{}'\n{GOOD}", long(count));
    checked(&about(20_000)).unwrap();
    has(
        &refusal(&about(100_000)),
        "must be at most 20000 characters long, not 100000",
    );
    for line in [
        "source = 'N'\n",
        "trace = 'N'\n",
        "view = { look_at = 'N' }\n",
    ] {
        has(
            &refusal(&(line.replace('N', &long(30_000)) + GOOD)),
            "characters long, not 30000",
        );
    }
    has(
        &refusal(&GOOD.replace("'a'", &format!("'{}'", long(2000)))),
        "body.point.1.name",
    );
}

#[test]
fn a_file_that_is_too_large_is_rejected_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    fs::write(&path, GOOD).unwrap();
    let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
    file.set_len(1 << 40).unwrap(); // sparse, and never read
    let told = || Document::read(&path).map(drop).unwrap_err().to_string();
    assert!(told().contains("is larger than 4 MB"), "{}", told());
    fs::write(&path, ",".repeat(800_000)).unwrap();
    let refused = "has more than 120000 tables (a dot in a key counts as one) or 800000 values";
    assert!(told().contains(refused), "{}", told());
}

#[test]
fn the_number_of_pushes_and_edits_is_limited() {
    let edits =
        |count: usize| "[[edit]]\nstep = 1\nset.'motion.gravity_m_per_s2' = 7\n".repeat(count);
    let pushed = |count: usize| GOOD.to_owned() + &PUSH.repeat(count);
    checked(&pushed(10_000)).unwrap();
    let told = refusal(&(pushed(10_001) + "[[push]]\n"));
    assert!(
        told.ends_with("push: 10002 pushes are too many: at most 10000 are allowed; remove some"),
        "{told}"
    );
    assert_eq!(
        checked(&(pushed(97) + &edits(10_000))).unwrap().edits.len(),
        10_000
    );
    has(
        &refusal(&(pushed(0) + &edits(10_001))),
        "edit: 10001 edits are too many: at most 10000 are allowed; remove some",
    );
    has(
        &refusal(&(pushed(98) + &edits(10_000))),
        "10000 edits of 101 points, parts and pushes are too many",
    );
    let added =
        "[[edit]]\nstep = 2\nset.'push.97' = { point = 'a', force_N = [0, 0, 1], steps = 1 }\n";
    has(
        &refusal(&(pushed(97) + &edits(9_999) + added)),
        "10000 edits of 101 points, parts and pushes are too many",
    );
}

#[test]
fn problems_beyond_a_limit_are_counted() {
    let mut text = String::new();
    for index in 0..10_000 {
        let _ = writeln!(text, "titl{index} = 0");
    }
    text += GOOD;
    let problems = checked(&text).map(drop).unwrap_err();
    assert_eq!((problems.list.len(), problems.more), (100, 9_900));
    assert!(problems.list[0].rule.contains("did you mean title?"));
    assert!(problems.to_string().ends_with("and 9988 more"));
    let edits: String = (0..150)
        .map(|index| format!("'push.{index}.steps' = -1, "))
        .collect();
    let of_edit = checked(&format!(
        "{GOOD}{}[[edit]]\nstep = 1\nset = {{ {edits} }}\n",
        PUSH.repeat(150)
    ))
    .map(drop)
    .unwrap_err();
    assert_eq!((of_edit.list.len(), of_edit.more), (100, 50));
}

#[test]
fn each_of_many_edits_changes_only_its_own_push() {
    const COUNT: usize = 900;
    let mut text = GOOD.to_owned() + &PUSH.repeat(COUNT);
    for index in 0..COUNT {
        let _ = writeln!(
            text,
            "[[edit]]\nstep = {index}\nset.'push.{index}.steps' = 7"
        );
    }
    let scenario = checked(&text).unwrap();
    assert_eq!(
        (scenario.pushes.len(), scenario.edits.len()),
        (COUNT, COUNT)
    );
    for (index, edit) in scenario.edits.iter().enumerate() {
        assert_eq!(edit.set_pushes, [index]);
        assert_eq!(edit.pushes.len(), COUNT);
        assert_ne!(edit.pushes[index], scenario.pushes[index]);
        assert_eq!(edit.pushes.get(index + 1), scenario.pushes.get(index + 1));
        assert_eq!(edit.pushes[0], scenario.edits[0].pushes[0]);
    }
}

#[test]
fn errors_in_an_edit_name_the_key_that_it_sets() {
    for (set, key) in [
        ("'push.1.steps' = -1", "edit.0.set.push.1.steps"),
        ("'push.1' = { point = 'a' }", "edit.0.set.push.1.force_N"),
        ("'push.1' = 3", "edit.0.set.push.1"),
        ("'push.1.from_s' = 3", "edit.0.set.push.1"),
        ("'push.0.point' = 'c'", "edit.0.set.push.0.point"),
        ("'push.3.steps' = 1", "edit.0.set.push.3"),
        ("'push.x' = 1", "edit.0.set.push"),
        ("'motion.scheme' = 'euler'", "edit.0.set.motion.scheme"),
        ("'push.0.colour' = 1", "edit.0.set.push.0.colour"),
    ] {
        let problems = checked(&format!(
            "{GOOD}{PUSH}{PUSH}[[edit]]\nstep = 1\nset = {{ {set} }}\n"
        ))
        .map(drop)
        .unwrap_err();
        assert!(problems.list[0].key.starts_with(key), "{set}: {problems}");
    }
}

#[test]
fn files_that_need_too_much_memory_are_rejected_before_parsing() {
    for nested in [
        "x.a.b.c.d.e.f.g=1\n".repeat(35_000),
        (0..35_000).fold(String::new(), |text, k| {
            format!("{text}[x{k}.a.b.c.d.e.f]\n")
        }),
        format!("x=[{}]\n", "{a=1},".repeat(250_000)),
        format!("x=[{}]\n", "[1],".repeat(1_700_000)),
    ] {
        // The limit is reported before the syntax error in the last line.
        let told = refusal(&(nested + "]"));
        assert!(told.contains("has more than 120000 tables"), "{told}");
    }
    let decimals = "[[expected]]\nreadout='a.b.c'\nx=[0.1, 0.2, 0.3]\n".repeat(70_000);
    assert!(!refusal(&decimals).contains("has more than"));
}

/// A push that makes every step expensive from 0.07 s on, without any sign before.
const HARD_PUSH: &str = "push.0={point='camera',force_N=[0,0,-1e9],from_s=0.07,for_s=1}";

#[test]
fn the_clock_is_checked_after_every_integrated_step() {
    // A body at rest needs no integration until the push starts.
    let at_rest = "start.omega_rad_per_s=[0,0,0]";
    for (name, set, looks_expected) in [
        ("phone", &[HARD_PUSH, at_rest][..], 50),
        ("method-2", &[], 0),
    ] {
        let mut run = LiveRun::new(Arc::new(preset(name, set)));
        let mut looks = 0;
        run.step_to(50, || {
            looks += 1;
            false
        })
        .unwrap();
        assert_eq!(looks, looks_expected, "{name}");
    }
}
