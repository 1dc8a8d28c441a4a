//! `gyrolab lesson`, and `check` of lessons.

use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use gyrolab::teach::shipped::{LESSONS, TEMPLATE};
use std::fs;

/// A ground with the template as `my.md`.
fn ground() -> Ground {
    let ground = Ground::new();
    ground.write("my.md", TEMPLATE);
    ground
}

#[test]
fn exit_codes() {
    let ground = ground();
    for (args, expected) in [
        (&["lesson"][..], 0),
        (&["lesson", "--template"], 0),
        (&["lesson", "my.md", "--handout"], 0),
        (&["lesson", "no-such-lesson"], 1),
        (&["lesson", "./no-such-file.md"], 1),
        (&["lesson", "my.md", "--page", "9"], 1),
        (&["lesson", "my.md", "--page", "0"], 2),
        (&["lesson", "--page", "1"], 2),
        (&["lesson", "--handout"], 2),
        (&["lesson", "my.md", "--handout", "--page", "1"], 2),
        (&["lesson", "my.md", "--template"], 2),
        (&["lesson", "--handout", "--template"], 2),
        (&["lesson", "my.md", "-o", "paper.md"], 2),
        (&["lesson", "my.md", "--handout", "--force"], 2),
    ] {
        let output = ground.run(args);
        assert_eq!(code(&output), expected, "{args:?}: {output:?}");
        assert_eq!(
            output.stderr.is_empty(),
            expected == 0,
            "{args:?}: {output:?}"
        );
    }
    assert_eq!(ground.files(), ["my.md"]);
}

#[test]
fn a_full_disk_is_told_with_the_file() {
    let output = ground().run(&["lesson", "my.md", "--handout", "-o", "/dev/full"]);
    failed(
        &output,
        &["cannot write /dev/full: No space left on device"],
    );
}

#[test]
fn without_a_name_there_is_a_line_for_each_lesson_and_nothing_else() {
    let listed = done(Ground::new().run(&["lesson"]));
    let listed: Vec<_> = stdout(&listed).lines().map(str::to_owned).collect();
    let names: Vec<_> = listed
        .iter()
        .filter_map(|line| line.split_once(": "))
        .collect();
    assert_eq!(names.len(), listed.len(), "{listed:?}");
    let known: Vec<_> = LESSONS.iter().map(|lesson| lesson.name).collect();
    assert_eq!(
        names.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
        known
    );
    for ((name, title), lesson) in names.into_iter().zip(LESSONS) {
        assert!(
            lesson.text.starts_with(&format!("# {title}\n")),
            "{name}: {title}"
        );
    }
}

#[test]
fn the_template_passes_its_own_check_and_says_how_to_begin() {
    let ground = Ground::new();
    let printed = done(ground.run(&["lesson", "--template"]));
    assert_eq!(stdout(&printed), TEMPLATE);
    done(ground.run(&["lesson", "--template", "-o", "my.md"]));
    assert_eq!(ground.read("my.md"), TEMPLATE);
    let checked = done(ground.run(&["check", "my.md"]));
    assert!(checked.stderr.is_empty());
    assert_eq!(
        stdout(&checked),
        "my.md: good: \"Does a faster spin precess faster?\", 3 pages, 1 prediction, 1 check\n"
    );
    // Every kind of block is shown once, with a comment of its own.
    for word in [
        "lesson", "lab", "task", "predict", "compare", "check", "notes", "text",
    ] {
        assert!(TEMPLATE.contains(&format!("\n```{word}\n")), "{word}");
    }
    assert!(TEMPLATE.lines().all(|line| line.chars().count() <= 130));
}

#[test]
fn a_handout_obeys_the_rules_for_files() {
    let ground = ground();
    let printed = done(ground.run(&["lesson", "my.md", "--handout"]));
    let paper = stdout(&printed);
    assert!(printed.stderr.is_empty());
    for words in [
        "# Does a faster spin precess faster?\n",
        "## Watch\n\n```text\n",
        "The axle goes round once in 64 s.",
        "- [ ] twice as fast\n- [ ] as fast as before\n- [ ] half as fast\n",
        "It goes round ____________ times as fast as before. You said: ____________.",
    ] {
        assert!(paper.contains(words), "{words}\n{paper}");
    }
    assert!(
        !paper.contains("defended") && !paper.contains("<!--"),
        "{paper}"
    );
    assert_eq!(
        stdout(&done(ground.run(&[
            "lesson",
            "my.md",
            "--handout",
            "-o",
            "-"
        ]))),
        paper
    );
    done(ground.run(&["lesson", "my.md", "--handout", "-o", "paper.md"]));
    assert_eq!(ground.read("paper.md"), paper);
    ground.write("paper.md", "mine");
    let refused = ground.run(&["lesson", "my.md", "--handout", "-o", "paper.md"]);
    failed(&refused, &[]);
    assert!(stderr(&refused).contains("paper.md exists; --force replaces it"));
    assert_eq!(ground.read("paper.md"), "mine");
    done(ground.run(&["lesson", "my.md", "--handout", "-o", "paper.md", "--force"]));
    assert_eq!(ground.read("paper.md"), paper);
    let refused = ground.run(&["lesson", "my.md", "--handout", "-o", "nowhere/paper.md"]);
    failed(&refused, &[]);
    assert!(stderr(&refused).contains("there is no folder nowhere"));
    // A lesson that cannot be played leaves nothing behind.
    ground.write(
        "wrong.md",
        &TEMPLATE.replacen("open = \"fast-top\"", "open = \"./nowhere.toml\"", 1),
    );
    let line = 1 + TEMPLATE
        .lines()
        .position(|line| line == "open = \"fast-top\"")
        .unwrap();
    let refused = ground.run(&["lesson", "wrong.md", "--handout", "-o", "wrong-paper.md"]);
    failed(&refused, &[]);
    let told = format!("wrong.md:{line}: open: ./nowhere.toml: there is no such file");
    assert!(stderr(&refused).contains(&told), "{refused:?}");
    assert_eq!(ground.files(), ["my.md", "paper.md", "wrong.md"]);
}

#[test]
fn check_tells_what_is_wrong_with_a_lesson_and_plays_it() {
    let ground = ground();
    ground.write("key.md", &TEMPLATE.replace("hint = ", "hin = "));
    ground.write(
        "readout.md",
        &TEMPLATE.replace("{L_axle_Js:.0}", "{L_axl_Js:.0}"),
    );
    ground.write("fence.md", TEMPLATE.trim_end().trim_end_matches('`'));
    ground.write("held.md", &TEMPLATE.replace(" - 2) < 0.1", " - 2) < 100"));
    ground.write("steer.md", &TEMPLATE.replace("Ω", "\u{1b}[2J"));
    fs::write(ground.file("long.md"), vec![b'a'; 10_000_000]).unwrap();
    let line = |text: &str| {
        1 + TEMPLATE
            .lines()
            .position(|line| line.starts_with(text))
            .unwrap()
    };
    for (file, words) in [
        (
            "key.md",
            format!(
                "key.md:{}: check.hin: unknown key: did you mean hint?\n",
                line("hint")
            ),
        ),
        (
            "readout.md",
            format!(
                "readout.md:{}: {{L_axl_Js:.0}}: column 1: there is no number named L_axl_Js: did you mean L_axle_Js?\n",
                line("Its spin")
            ),
        ),
        (
            "fence.md",
            format!("fence.md:{}: check: is not closed", line("```check")),
        ),
        (
            "held.md",
            format!("held.md:{}: check.that (", line("```check")),
        ),
        (
            "steer.md",
            format!(
                "steer.md:{}: holds the control or invisible character U+001B",
                line("Ω")
            ),
        ),
        (
            "long.md",
            "long.md: is 10000000 bytes long: a lesson has at most 1 MiB".to_owned(),
        ),
    ] {
        let refused = ground.run(&["check", file]);
        failed(&refused, &[]);
        assert!(stderr(&refused).contains(&words), "{words}\n{refused:?}");
        assert!(refused.stdout.is_empty());
        assert!(!refused.stderr.contains(&0x1b));
    }
    // One after the other: what is good is said, and the whole has failed.
    let both = ground.run(&["check", "my.md", "key.md"]);
    failed(&both, &[]);
    assert!(stdout(&both).starts_with("my.md: good: "));
    // A number that cannot be stated is told, and is no mistake.
    ground.write(
        "unstated.md",
        &TEMPLATE.replace("{L_axle_Js:.0}", "{1 / (t_s - t_s):.0}"),
    );
    let told = done(ground.run(&["check", "unstated.md"]));
    let words = format!(
        "unstated.md:{}: {{1 / (t_s - t_s)}}: is n/a on this page: t_s is 10\n",
        line("Its spin")
    );
    assert_eq!(stderr(&told), words);
}

#[test]
fn without_a_terminal_a_page_is_printed_with_its_picture() {
    let ground = ground();
    let first = done(ground.run(&["lesson", "my.md"]));
    assert!(stderr(&first).contains("page 1 of 3 is printed"));
    let first = stdout(&first);
    assert!(
        first.starts_with("## Watch\n\n```text\n A fast top"),
        "{first}"
    );
    assert!(first.contains("in 64 s.") && !first.contains("## Run it"));
    let third = stdout(&done(ground.run(&["lesson", "my.md", "--page", "3"]))).to_owned();
    assert!(
        third.starts_with("## Your turn\n\n```text\n A fast top"),
        "{third}"
    );
    assert!(
        third.contains("t   10.000 s"),
        "the page stands on the one before"
    );
    let refused = ground.run(&["lesson", "my.md", "--page", "4"]);
    failed(&refused, &[]);
    assert!(stderr(&refused).contains("--page 4: my.md has the pages 1 to 3"));
}
