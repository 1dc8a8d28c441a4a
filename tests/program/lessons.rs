//! `gyrolab lesson`, and `gyrolab check` for lessons.

use crate::support::ground::{Ground, code, done, failed, stderr, stdout};
use crate::support::words::{has, has_all, has_no};
use gyrolab::lessons::shipped::{LESSONS, TEMPLATE};
use std::fs;

/// A working directory with the lesson template as `my.md`.
fn ground() -> Ground {
    let ground = Ground::new();
    ground.write("my.md", TEMPLATE);
    ground
}

/// Returns the number of the template line that begins with `text`.
fn line_of(text: &str) -> usize {
    let line = TEMPLATE.lines().position(|line| line.starts_with(text));
    1 + line.unwrap()
}

#[test]
fn exit_codes_of_lesson_distinguish_failure_and_misuse() {
    let ground = ground();
    for (args, expected) in [
        ("lesson", 0),
        ("lesson --template", 0),
        ("lesson --list", 0),
        ("lesson my.md --list", 2),
        ("lesson my.md --handout", 0),
        ("lesson my.md --teacher", 0),
        ("lesson my.md --teacher --handout", 2),
        ("lesson no-such-lesson", 1),
        ("lesson ./no-such-file.md", 1),
        ("lesson my.md --page 9", 1),
        ("lesson my.md --page 0", 2),
        ("lesson write-it-yourself --frame octave", 0),
        ("lesson why-it-does-not-fall --frame python", 1),
        ("lesson write-it-yourself --frame basic", 2),
        ("lesson --page 1", 2),
        ("lesson --handout", 2),
        ("lesson my.md --handout --page 1", 2),
        ("lesson my.md --template", 2),
        ("lesson --handout --template", 2),
        ("lesson my.md -o paper.md", 2),
        ("lesson my.md --handout --force", 2),
        ("lesson my.md --results", 2),
    ] {
        let output = ground.run(args);
        assert_eq!(code(&output), expected, "{args}: {output:?}");
        let is_silent = output.stderr.is_empty();
        assert_eq!(is_silent, expected == 0, "{args}: {output:?}");
    }
    assert_eq!(ground.files(), ["my.md"]);
}

#[test]
fn a_full_disk_error_names_the_file() {
    let words = "cannot write /dev/full: No space left on device";
    ground().refused("lesson my.md --handout -o /dev/full", 1, &[words]);
}

#[test]
fn lesson_without_a_name_prints_one_line_per_lesson() {
    let known: String = LESSONS
        .iter()
        .map(|lesson| {
            let title = lesson.text.lines().next().unwrap();
            format!("{}: {}\n", lesson.name, title.strip_prefix("# ").unwrap())
        })
        .collect();
    assert_eq!(Ground::new().stdout("lesson"), known);
}

#[test]
fn the_long_list_groups_the_lessons_by_level_in_order() {
    let list = Ground::new().stdout("lesson --list");
    let places: Vec<_> = LESSONS
        .iter()
        .map(|lesson| list.find(&format!("\n  {} ", lesson.name)).unwrap())
        .collect();
    assert!(places.is_sorted());
    has_all(
        &list,
        [
            "school\n  why-it-does-not-fall ",
            "\n\nfirst year\n",
            "\n\nmechanics course\n",
            " 15 min  Why does it not fall?\n",
            "Needs one-step-by-hand; Octave, MATLAB or Python\n",
        ],
    );
}

#[test]
fn the_template_passes_check_and_explains_how_to_start() {
    let ground = Ground::new();
    assert_eq!(ground.stdout("lesson --template"), TEMPLATE);
    done(ground.run("lesson --template -o my.md"));
    assert_eq!(ground.read("my.md"), TEMPLATE);
    let checked = done(ground.run("check my.md"));
    assert!(checked.stderr.is_empty());
    assert_eq!(
        stdout(&checked),
        "my.md: good: \"Does a faster spin precess faster?\", 3 pages, 1 prediction, 1 check\n"
    );
    // The template shows every kind of block once, each with a comment.
    for word in "lesson lab task predict compare check notes text".split(' ') {
        has(TEMPLATE, format!("\n```{word}\n"));
    }
    assert!(TEMPLATE.lines().all(|line| line.chars().count() <= 130));
}

#[test]
fn a_handout_follows_the_rules_for_output_files() {
    let ground = ground();
    let printed = done(ground.run("lesson my.md --handout"));
    let paper = stdout(&printed);
    assert!(printed.stderr.is_empty());
    has_all(
        &paper,
        [
            "# Does a faster spin precess faster?\n",
            "## Watch\n\n```text\n",
            "The axle goes round once in 64 s.",
            "- [ ] 1 twice as fast\n- [ ] 2 as fast as before\n- [ ] 3 half as fast\n",
            "Twice the spin, for 10 s. Watch the axle.\n\nPredicted: ____________\n\nCame out: ____________",
        ],
    );
    for answer in ["defended", "<!--", "as fast as before. You", "Hint"] {
        has_no(&paper, answer);
    }
    let results = ground.stdout("lesson my.md --handout --results");
    has(
        &results,
        "It goes round 0.50 times as fast as before. You said: ____________.",
    );
    assert_eq!(ground.stdout("lesson my.md --handout -o -"), paper);
    done(ground.run("lesson my.md --handout -o paper.md"));
    assert_eq!(ground.read("paper.md"), paper);
    let made = done(ground.run("lesson my.md --handout -o paper.html"));
    assert_eq!(stderr(&made), "gyrolab: wrote paper.html\n");
    has(&ground.read("paper.html"), "<html lang=\"en\">");
    let instead = "write FILE.html and save it as PDF from a browser";
    ground.refused("lesson my.md --handout -o paper.pdf", 2, &[instead]);
    ground.refused("lesson my.md --teacher -o paper.pdf", 2, &[instead]);
    ground.write("paper.md", "mine");
    let words = "paper.md exists; --force replaces it";
    ground.refused("lesson my.md --handout -o paper.md", 1, &[words]);
    assert_eq!(ground.read("paper.md"), "mine");
    done(ground.run("lesson my.md --handout -o paper.md --force"));
    assert_eq!(ground.read("paper.md"), paper);
    let no_folder = "there is no folder nowhere";
    ground.refused(
        "lesson my.md --handout -o nowhere/paper.md",
        1,
        &[no_folder],
    );
    // A lesson that cannot be played leaves no file.
    ground.write(
        "wrong.md",
        &TEMPLATE.replacen("open = \"fast-top\"", "open = \"./nowhere.toml\"", 1),
    );
    let line = line_of("open = \"fast-top\"");
    let told = format!("wrong.md:{line}: open: ./nowhere.toml: there is no such file");
    ground.refused("lesson wrong.md --handout -o wrong-paper.md", 1, &[&told]);
    assert_eq!(
        ground.files(),
        ["my.md", "paper.html", "paper.md", "wrong.md"]
    );
}

#[test]
fn check_reports_mistakes_in_a_lesson_and_plays_it() {
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
    for (file, line, words) in [
        (
            "key.md",
            "hint",
            "check.hin: unknown key: did you mean hint?\n",
        ),
        (
            "readout.md",
            "Its spin",
            "{L_axl_Js:.0}: column 1: there is no number named L_axl_Js: did you mean L_axle_Js?\n",
        ),
        ("fence.md", "```check", "check: is not closed"),
        ("held.md", "```check", "check.that ("),
        (
            "steer.md",
            "Ω",
            "contains the control or invisible character U+001B",
        ),
        (
            "long.md",
            "",
            "is longer than 1 MiB, the maximum for a lesson",
        ),
    ] {
        let place = match line {
            "" => file.to_owned(),
            line => format!("{file}:{}", line_of(line)),
        };
        let refused = ground.run(&format!("check {file}"));
        failed(&refused, &[&format!("{place}: {words}")]);
        assert!(refused.stdout.is_empty());
        assert!(!refused.stderr.contains(&0x1b));
    }
    // Of several files, good ones are reported, and the command fails as a whole.
    let both = ground.run("check my.md key.md");
    assert_eq!(code(&both), 1);
    assert!(stdout(&both).starts_with("my.md: good: "));
    // A number that the run cannot determine is reported, but it is not a mistake.
    ground.write(
        "unstated.md",
        &TEMPLATE.replace("{L_axle_Js:.0}", "{1 / (t_s - t_s):.0}"),
    );
    let told = done(ground.run("check unstated.md"));
    let words = format!(
        "unstated.md:{}: {{1 / (t_s - t_s)}}: is n/a on this page: t_s is 10\n",
        line_of("Its spin")
    );
    assert_eq!(stderr(&told), words);
}

#[test]
fn without_a_terminal_a_page_and_its_picture_are_printed() {
    let ground = ground();
    let first = done(ground.run("lesson my.md"));
    assert!(stderr(&first).contains("page 1 of 3 is printed"));
    let first = stdout(&first);
    assert!(
        first.starts_with("## Watch\n\n```text\nA fast top"),
        "{first}"
    );
    assert!(first.contains("in 64 s.") && !first.contains("## Run it"));
    let third = ground.stdout("lesson my.md --page 3");
    assert!(
        third.starts_with("## Your turn\n\n```text\nA fast top"),
        "{third}"
    );
    has(&third, "t  10.000 s"); // the page continues the run of the previous page
    let words = "--page 4: my.md has the pages 1 to 3";
    ground.refused("lesson my.md --page 4", 1, &[words]);
}
