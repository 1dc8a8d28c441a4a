//! Files of absurd size, and files that would be costly to refuse: what they cost does not grow faster than they do.

use gyrolab::scenario::{Document, Problems, Scenario};
use std::fmt::Write as _;
use std::fs;

/// A good scenario of three points.
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
fn texts_are_limited_and_the_limit_is_told() {
    let long = |count: usize| "x".repeat(count);
    let titled = |title: &str| GOOD.replace("'x'", &format!("'{title}'"));
    checked(&titled(&long(1000))).unwrap();
    let told = refusal(&titled(&long(1001)));
    assert!(
        told.contains("must be at most 1000 characters long, not 1001"),
        "{told}"
    );
    let about = |count| format!("about = '{}'\n{GOOD}", long(count));
    checked(&about(20_000)).unwrap();
    let told = refusal(&about(100_000));
    assert!(
        told.contains("must be at most 20000 characters long, not 100000"),
        "{told}"
    );
    for line in [
        "source = 'N'\n",
        "trace = 'N'\n",
        "view = { look_at = 'N' }\n",
    ] {
        let told = refusal(&(line.replace('N', &long(30_000)) + GOOD));
        assert!(told.contains("characters long, not 30000"), "{told}");
    }
    let told = refusal(&GOOD.replace("'a'", &format!("'{}'", long(2000))));
    assert!(told.contains("body.point.1.name"), "{told}");
}

#[test]
fn a_file_that_is_too_large_is_refused_by_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    fs::write(&path, GOOD).unwrap();
    let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
    file.set_len(1 << 40).unwrap(); // takes no room: it is never read
    let told = Document::read(&path).map(drop).unwrap_err().to_string();
    assert!(told.contains("is 1099511627776 bytes long"), "{told}");
    assert!(told.contains("longer than 16 MiB"), "{told}");
}

#[test]
fn lines_are_limited() {
    let told = refusal(&("#\n".repeat(2_000_001) + GOOD));
    assert!(told.contains("at most 2000000 are allowed"), "{told}");
    checked(&("#\n".repeat(1000) + GOOD)).unwrap();
}

#[test]
fn many_problems_are_counted() {
    let mut text = String::new();
    for index in 0..100_000 {
        let _ = writeln!(text, "titl{index} = 0");
    }
    text += GOOD;
    let problems = checked(&text).map(drop).unwrap_err();
    assert_eq!((problems.list.len(), problems.more), (100, 99_900));
    assert!(problems.list[0].rule.contains("did you mean title?"));
    assert!(problems.to_string().ends_with("and 99988 more"));
}

#[test]
fn many_pushes_with_many_edits_are_what_their_edits_make_of_them() {
    const COUNT: usize = 6000;
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
    // Pushes that an edit does not change are kept once, not once for each edit.
    let [first, last] = [&scenario.edits[0], &scenario.edits[COUNT / 2]].map(|edit| &edit.pushes);
    let is_shared = |place: usize| std::ptr::eq(&raw const first[place], &raw const last[place]);
    assert!((COUNT / 2 + 1..COUNT).all(is_shared));
}

#[test]
fn an_edit_is_refused_for_what_it_sets() {
    let text = |set: &str| format!("{GOOD}{PUSH}{PUSH}[[edit]]\nstep = 1\nset = {{ {set} }}\n");
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
        let problems = checked(&text(set)).map(drop).unwrap_err();
        assert!(problems.list[0].key.starts_with(key), "{set}: {problems}");
    }
}

#[test]
fn a_file_of_more_tables_than_any_scenario_needs_is_refused_at_their_line() {
    // Each asks for 400 000 tables in other words; only then is the last line no TOML.
    let many = |line: &dyn Fn(usize) -> String, count: usize| {
        let mut text: String = (0..count).map(line).collect();
        text.push_str("]\n");
        refusal(&text)
    };
    for told in [
        many(&|k| format!("x{k}.a.b.c.d=1\n"), 100_000),
        many(&|k| format!("[x{k}.a.b.c]\n"), 100_000),
        many(&|k| format!("x{k}={{a={{}}}}\n"), 200_000),
        many(&|_| "[[edit]]\nset.a.b=1.5\n".to_owned(), 140_000),
    ] {
        assert!(told.contains("asks for more than 300000 tables"), "{told}");
        assert!(told.starts_with("file.toml:"), "{told}");
    }
}

#[test]
fn decimals_strings_and_repeated_headings_ask_for_no_tables() {
    let mut text = "x = [\n".to_owned();
    text.push_str(&"1.5, 'a.b.c={', 2.5,\n".repeat(200_000));
    text.push_str("]\n# a.b.c.d = 1\n");
    text.push_str(&"[[body.point]]\nat_m = [0.1, 0.2, 0.3]\n".repeat(200_000));
    let told = refusal(&text);
    assert!(!told.contains("tables, the most"), "{told}");
}
