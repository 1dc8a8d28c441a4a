//! Lessons: parsing, error messages with file and line, and playing without a screen.

use crate::support::desk::Desk;
use crate::support::scenarios::{preset, view};
use crate::support::words::{has, without_lists};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Problem, Problems};
use gyrolab::engine::text::printable::is_steering;
use gyrolab::lab::Lab;
use gyrolab::lab::view::HideablePart;
use gyrolab::lab::view::theme::Marker;
use gyrolab::lessons::play::{self, LessonWalk};
use gyrolab::lessons::predictions::{LockedAnswer, Predictions};
use gyrolab::lessons::{
    KeptNumbers, Lesson, LessonBlock, PredictionAnswer, opening, reading, shipped,
};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// A lesson with a block of every kind.
pub const WHOLE: &str = r#"# The push

Before the first page.

```lesson
about = "A push, and what the time step has to do with it."
minutes = 10
```

## Watch

```lab
open = "wobble-push"
detail_s = 8
hide = ["health", "predicted"]
go_to = "60 s"
keep = { coarse = "measured_highest_tilt_deg - measured_lowest_tilt_deg" }
```

At {t_s:.0} s the top is at z = **{z_m:.4}** m; `{ code }` and \{braces} stay.

```predict
name = "finer"
ask = "With a time step ten times shorter, the wobble ..."
choices = ["stays as it is", "is ten times smaller", "is gone"]
```

```notes
Let two answers be defended.
```

## Run it

```lab
open = "wobble-push"
set = { "motion.time_step_s" = 0.01 }
run_until = "t_s >= 60"
```

```compare
prediction = "finer"
with = "measured_highest_tilt_deg - measured_lowest_tilt_deg"
text = "It was {coarse:.2} degrees and is {with:.2}. You said: {prediction}."
```

```sh
gyrolab run wobble-push
```

## Your turn

Stop the push.

```task
open = "method-2"
go_to = 10
```

```check
that = "steps == 10"
hint = "g, then 10."
```
"#;

pub fn read(text: &str) -> Lesson {
    reading::read("a.md", text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Returns the error message for a lesson with this text.
#[track_caller]
fn unreadable(text: &str) -> String {
    match reading::read("a.md", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(problems) => problems.to_string(),
    }
}

/// [`WHOLE`] with `from` replaced by `to`.
#[track_caller]
fn with(from: &str, to: &str) -> String {
    assert_eq!(WHOLE.matches(from).count(), 1, "{from}");
    WHOLE.replace(from, to)
}

/// Returns the number of the line of [`WHOLE`] that equals `text`.
fn line_of(text: &str) -> usize {
    1 + WHOLE.lines().position(|line| line == text).unwrap()
}

#[test]
fn a_lesson_with_every_kind_of_block_is_parsed() {
    let lesson = read(WHOLE);
    assert_eq!(lesson.title, "The push");
    assert_eq!(lesson.minutes, Some(10));
    assert_eq!(lesson.introduction.len(), 1);
    assert_eq!(lesson.pages.len(), 3);
    for (page, (heading, kinds)) in lesson.pages.iter().zip([
        ("Watch", &["lab", "text", "predict", "notes"][..]),
        ("Run it", &["lab", "compare", "shown"]),
        ("Your turn", &["text", "task", "check"]),
    ]) {
        assert_eq!(page.heading, heading);
        assert_eq!(page.line, line_of(&format!("## {heading}")));
        assert!(page.blocks.iter().map(kind).eq(kinds.iter().copied()));
    }
    let first = lesson.pages[0].lab().unwrap();
    let lines: Vec<_> = first
        .commands
        .iter()
        .map(|placed| placed.line.unwrap())
        .collect();
    let of_keys = ["open = \"wobble-push\"", "detail_s = 8"].map(line_of);
    assert_eq!(lines[..2], of_keys);
}

fn kind(block: &LessonBlock) -> &'static str {
    match block {
        LessonBlock::Text(_) => "text",
        LessonBlock::Lab(_) => "lab",
        LessonBlock::Task(_) => "task",
        LessonBlock::Predict(_) => "predict",
        LessonBlock::Compare(_) => "compare",
        LessonBlock::Check(_) => "check",
        LessonBlock::Notes(_) => "notes",
        LessonBlock::Shown(_) => "shown",
    }
}

/// Texts in [`WHOLE`], each with replacements that are mistakes.
const MISTAKES: &[(&str, &[&str])] = &[
    (
        "open = \"wobble-push\"\ndetail_s = 8",
        &[
            "open = \"wobble-psh\"",
            "set = { \"motion.time_step_s\" = 0.01 }",
        ],
    ),
    (
        "detail_s = 8",
        &[
            "show = [\"trace\"]",
            "detail = 8",
            "export = \"a.csv\"",
            "detail_s = ",
        ],
    ),
    ("hide = [\"health\", \"predicted\"]", &["hide = 3"]),
    (
        "go_to = \"60 s\"",
        &["go_too = \"60 s\"", "go_to = 60\nrun_until = \"t_s > 1\""],
    ),
    (
        "run_until = \"t_s >= 60\"",
        &[
            "run_until = \"t_ss >= 60\"",
            "run_until = \"t_s >= coarse\"",
        ],
    ),
    (
        "{ \"motion.time_step_s\" = 0.01 }",
        &["{ \"motion.time_step\" = 0.01 }"],
    ),
    ("```predict", &["```predikt", "```predict now"]),
    ("```sh\n", &["```rust\n"]),
    (
        "Stop the push.",
        &[
            "- a\n\n  ```task\n  go_to = 1\n  ```",
            "```task\ngo_to = 1\n```",
            "```lesson\nabout = \"x\"\n```",
            "```predict\nname = \"finer\"\nask = \"?\"\nunit = \"\"\n```",
            "{late}",
            "Stop\u{1b}[2J the push.",
            "Stop\u{202e} the push.",
        ],
    ),
    ("hint = \"g, then 10.\"\n```", &["hint = \"g, then 10.\""]),
    ("is gone\"]\n```", &["is gone\"]"]),
    ("wobble-push\n```\n\n## Your", &["wobble-push\n\n## Your"]),
    ("## Run it\n", &["##Run it\n"]),
    ("## Watch\n", &["##\n", ""]),
    ("# The push", &["The push", "# The push\n\n# Again"]),
    ("minutes = 10", &["minutes = 0", "minute = 10"]),
    (
        "{z_m:.4}",
        &["{zz_m:.4}", "{z_m:.4", "{z_m:4}", "{z_m > 1}", "{title}"],
    ),
    ("Before the first page.", &["At {z_m}."]),
    ("name = \"finer\"", &[""]),
    (
        "choices = [\"stays as it is\", \"is ten times smaller\", \"is gone\"]",
        &["choices = [\"yes\"]", "choices = [\"yes\", \"yes\"]", ""],
    ),
    ("choices = [", &["unit = \"m\"\nchoices = ["]),
    (
        "prediction = \"finer\"",
        &["prediction = \"finner\"", "prediction = \"late\""],
    ),
    (
        "with = \"measured_highest_tilt_deg - measured_lowest_tilt_deg\"",
        &["with = \"lowest_tilt_deg\"", ""],
    ),
    ("{coarse:.2}", &["{coarze:.2}"]),
    (
        "that = \"steps == 10\"",
        &[
            "that = \"stepps == 10\"",
            "that = \"steps\"",
            "that = \"1 < 2\"",
            "goal = [\"a\", \"b\"]\nthat = \"steps == 10\"",
            "",
        ],
    ),
    (
        "keep = { coarse =",
        &[
            "keep = { tilt_deg =",
            "keep = { title =",
            "keep = { with =",
            "keep = { \"größer\" =",
        ],
    ),
    (
        "go_to = 10\n",
        &["go_to = 10\nkeep = { coarse = \"t_s\" }\n"],
    ),
];

#[test]
fn mistakes_in_a_lesson_are_reported_with_line_and_nearest_name() {
    let mistakes = MISTAKES
        .iter()
        .flat_map(|(from, all)| all.iter().map(move |to| (from, to)));
    let told = mistakes.map(|(from, to)| {
        let told = unreadable(&with(from, to));
        assert!(!told.replace('\n', "").chars().any(is_steering), "{told}");
        format!("{from:?} as {to:?}\n{}\n\n", without_lists(&told))
    });
    insta::assert_snapshot!("mistakes", told.collect::<String>());
}

#[test]
fn a_prediction_must_be_asked_before_it_is_compared() {
    let late = "```predict\nname = \"late\"\nask = \"?\"\nunit = \"\"\n```";
    let text = WHOLE
        .replace("Stop the push.", late)
        .replace("prediction = \"finer\"", "prediction = \"late\"");
    has(
        unreadable(&text),
        "(\"late\") is asked for only later, on line ",
    );
    let kept_late = WHOLE
        .replace("Stop the push.", "{other}")
        .replace("go_to = 10\n", "go_to = 10\nkeep = { other = \"t_s\" }\n");
    has(unreadable(&kept_late), "other is known from page 4 on");
}

#[test]
fn a_lesson_needs_a_title_and_a_page() {
    for (text, words) in [
        ("", "a.md:1: has no title"),
        ("# A title\n\nText.\n", "a.md:1: has no page"),
        ("# A title\n\n### A small heading\n", "a.md:1: has no page"),
    ] {
        has(unreadable(text), words);
    }
}

#[test]
fn line_ends_byte_order_marks_and_longer_fences_are_handled() {
    let lesson = read(WHOLE);
    let of_windows = format!("\u{feff}{}", WHOLE.replace('\n', "\r\n"));
    assert_eq!(read(&of_windows), lesson);
    let shown = WHOLE.replace(
        "```sh\ngyrolab run wobble-push\n```",
        "````text\n```lab\n```\n````",
    );
    assert_eq!(
        read(&shown).pages[1].blocks.len(),
        3,
        "a longer fence shows a block"
    );
    let commented = WHOLE.replace(
        "Stop the push.",
        "<!-- a {comment}\n\n## no page -->\n\nStop the push.",
    );
    let blocks = |read_lesson: &Lesson| -> Vec<usize> {
        read_lesson
            .pages
            .iter()
            .map(|page| page.blocks.len())
            .collect()
    };
    assert_eq!(blocks(&read(&commented)), blocks(&lesson));
}

#[test]
fn a_lesson_that_is_too_long_is_rejected_with_the_limit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.md");
    let pages = |count: usize| "# A\n\n## B\n\n".repeat(count).into_bytes();
    let lines = [pages(1), vec![b'\n'; 100_000]].concat();
    for (text, words) in [
        (
            pages(1_000_000),
            "long.md: is longer than 1 MiB, the maximum for a lesson",
        ),
        (lines, "at most 20000"),
        (pages(4_000), "more than 1000 pages and blocks"),
        (b"# A\n\n\xff\n".to_vec(), "long.md:3: is not text in UTF-8"),
    ] {
        fs::write(&path, text).unwrap();
        has(opening::read_file(&path).unwrap_err().to_string(), words);
    }
    let told = opening::read_file(folder.path()).unwrap_err();
    has(told.to_string(), "is a folder");
    let unknown = opening::open("no-such-lesson").unwrap_err();
    has(unknown.to_string(), "no lesson of that name");
}

proptest! {
    #[test]
    fn mangled_lessons_never_panic(cut in 0..2000usize, length in 0..60usize, put in 0..NASTY.len(), again in 0..2000usize) {
        let characters: Vec<char> = WHOLE.chars().collect();
        let at = cut.min(characters.len());
        let end = (at + length).min(characters.len());
        let mut mangled: Vec<char> = characters[..at].to_vec();
        mangled.extend(NASTY[put].chars());
        mangled.extend(&characters[end..]);
        let again = again.min(mangled.len());
        mangled.splice(again..again, NASTY[put].chars());
        let text: String = mangled.into_iter().collect();
        if let Err(problems) = reading::read("a.md", &text) {
            let told = problems.to_string();
            prop_assert!(told.lines().all(|line| line.starts_with("a.md") || !line.contains("panicked")));
        }
    }
}

const NASTY: [&str; 16] = [
    "```", "````", "~~~", "{", "}", "`", "\\", "\n", "\"", "# ", "## ", "- ", "> ", "<!--", "é",
    "{z_m:.3}",
];

/// A lab like the one in which the program plays lessons.
pub fn lab() -> Lab {
    let scenario = Arc::new(preset("method-2", &[]));
    let view = view(&scenario, Marker::Ascii, false);
    Lab::new("method-2", scenario, view, false)
}

pub fn on(_: u64, _: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn checked(lesson: &Lesson) -> Result<Vec<Problem>, Problems> {
    play::check(lesson, lab(), &mut on)
}

#[track_caller]
fn not_good(from: &str, to: &str) -> String {
    let lesson = read(&with(from, to));
    checked(&lesson).unwrap_err().to_string()
}

#[test]
fn a_lesson_can_be_played_to_its_end() {
    let played = checked(&read(WHOLE)).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(played, []);
    let told = [
        ("that = \"steps == 10\"", "that = \"steps == 11\""),
        ("that = \"steps == 10\"", "that = \"steps >= 10\""),
        ("open = \"method-2\"", "open = \"./nowhere.toml\""),
        ("go_to = 10", "push = { point = \"nobody\" }\ngo_to = 10"),
    ]
    .map(|(from, to)| format!("{to}\n{}\n\n", not_good(from, to)));
    insta::assert_snapshot!("not_good", told.concat());
}

#[test]
#[ignore = "takes ten million steps: seconds"]
fn a_task_condition_that_never_holds_is_reported_with_its_line() {
    let told = not_good("go_to = 10", "run_until = \"t_s < 0\"");
    let task = line_of("go_to = 10");
    let begin = format!("a.md:{task}: run_until: did not hold on any of 10,000,000 steps");
    assert!(told.starts_with(&begin), "{told}");
}

#[test]
fn a_check_without_a_task_applies_to_the_lab_block() {
    let task = "```task\nopen = \"method-2\"\ngo_to = 10\n```";
    let told = not_good(task, "");
    has(
        &told,
        "does not hold after the lab block of its page: steps is ",
    );
    let lab_block = task.replace("```task", "```lab");
    assert!(checked(&read(&WHOLE.replace(task, &lab_block))).is_ok());
    let first =
        "# A\n\n## B\n\n```lab\nopen = \"method-2\"\n```\n\n```check\nthat = \"steps == 0\"\n```\n";
    assert!(
        checked(&read(first)).is_ok(),
        "no condition holds before a run is open"
    );
}

#[test]
fn set_with_open_keeps_the_seconds_of_run_and_pushes() {
    let text = "# A\n\n## B\n\n```lab\nopen = \"wobble-push\"\nset = { \"motion.time_step_s\" = 0.02 }\ngo_to = \"end\"\n```\n";
    let lesson = read(text);
    let mut walk = LessonWalk::new(&lesson, lab());
    walk.enter(&lesson.pages[0], &mut on).unwrap();
    let mut document = Document::open("wobble-push").unwrap();
    let end_s = document.scenario().unwrap().steps as f64 * 0.1;
    document.set_time_step(0.02).unwrap();
    let mut whole = Simulation::new(Arc::new(document.scenario().unwrap()));
    let steps = whole.scenario().steps;
    for _ in 0..steps {
        whole.step().unwrap();
    }
    let (played, known) = (walk.lab.player().run().now(), whole.sample());
    assert_eq!(walk.lab.player().step_number(), steps);
    assert_eq!(walk.lab.player().end_s, end_s);
    assert!((played.time_s - known.time_s).abs() < 1e-9);
    assert!((played.position - known.position).norm() < 1e-9);
}

#[test]
fn setting_start_and_time_step_together_keeps_the_seconds() {
    let mut desk = Desk::open("method-2");
    let end_s = desk.lab.player().end_s;
    desk.commands("set = { 'start.tilt_deg' = 30, 'motion.time_step_s' = 0.01 }");
    assert_eq!(desk.lab.player().end_s, end_s);
    desk.commands("go_to = 100\nset = { 'motion.time_step_s' = 0.05, 'start.tilt_deg' = 20 }");
    assert_eq!(desk.lab.player().end_s, end_s);
    desk.commands(
        "set = { 'start.tilt_deg' = 30, 'motion.time_step_s' = 0.1, 'motion.steps' = 40 }",
    );
    assert_eq!(desk.lab.player().end_s, 4.0);
    desk.commands("undo = 1");
    assert_eq!(desk.lab.player().end_s, end_s);
}

#[test]
fn paths_in_a_lesson_are_relative_to_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = preset("cusps", &["title=Mine"]).file;
    let scenario = toml::to_string(&scenario).unwrap();
    fs::write(folder.path().join("mine.toml"), scenario).unwrap();
    let path = folder.path().join("a.md");
    let pages = "# A\n\n## B\n\n```lab\nopen = \"mine.toml\"\n```\n\n## C\n\n```lab\nopen = \"cusps\"\n```\n";
    fs::write(&path, pages).unwrap();
    let lesson = opening::read_file(&path).unwrap();
    let mut walk = LessonWalk::new(&lesson, lab());
    for (page, title) in lesson.pages.iter().zip(["Mine", "Cusps"]) {
        walk.enter(page, &mut on)
            .unwrap_or_else(|problem| panic!("{problem}"));
        assert_eq!(walk.lab.player().run().scenario().file.title, title);
    }
}

/// The shipped lessons, the template and [`WHOLE`].
pub fn lessons() -> Vec<Lesson> {
    let shipped = shipped::LESSONS
        .iter()
        .map(|lesson| opening::open(lesson.name));
    let template = reading::read("template.md", shipped::TEMPLATE);
    let all = shipped
        .chain([template])
        .map(|read| read.unwrap_or_else(|problems| panic!("{problems}")));
    all.chain([read(WHOLE)]).collect()
}

#[test]
fn every_lesson_in_the_folder_is_in_the_table() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets/lessons");
    let files: BTreeSet<_> = fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    let table = shipped::LESSONS.iter();
    assert_eq!(
        files,
        table.map(|lesson| format!("{}.md", lesson.name)).collect(),
        "the folder and LESSONS in src/lessons/shipped.rs differ"
    );
}

#[test]
fn every_lesson_plays_and_its_checks_fail_without_their_blocks() {
    for lesson in lessons() {
        assert!(
            lesson.pages.len() >= 3,
            "{} has fewer than three pages",
            lesson.name
        );
        let played = checked(&lesson).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(played, [], "{}", lesson.name);
    }
}

#[test]
fn a_jump_executes_only_the_blocks_that_the_page_needs() {
    let lesson = read(WHOLE);
    let lines = |page: usize, kept: &KeptNumbers| -> Vec<usize> {
        let stages = lesson.stages_to(page, kept, &Predictions::default());
        stages.iter().map(|stage| stage.page.number).collect()
    };
    assert_eq!(lines(1, &KeptNumbers::new()), [1]);
    assert_eq!(
        lines(2, &KeptNumbers::new()),
        [1, 2],
        "page 1 keeps a number"
    );
    let kept = KeptNumbers::from([("coarse".to_owned(), 1.5)]);
    assert_eq!(lines(2, &kept), [2]);
    assert_eq!(
        lines(3, &kept),
        [2],
        "the task on page 3 is left to the student"
    );
    assert!(lesson.stage_of(3, &Predictions::default()).is_none());
    assert!(lesson.task_of(3, &Predictions::default()).is_some());
}

#[test]
fn a_locked_prediction_is_final_and_reveals_hidden_items() {
    let lesson = read(WHOLE);
    let page = &lesson.pages[0];
    let finer = lesson.predict("finer").unwrap();
    let mut predictions = Predictions::default();
    let hidden = [HideablePart::Health, HideablePart::Predicted];
    assert_eq!(page.lab().unwrap().hides(), hidden);
    let given = |round, answer| LockedAnswer {
        round,
        answer,
        late: round == 2,
        page: 1,
        time_unix_s: 0,
    };
    let choice = |round, words: &str| given(round, PredictionAnswer::Choice(words.to_owned()));
    assert!(
        predictions
            .lock(finer, given(1, PredictionAnswer::Number(3.0)))
            .is_err()
    );
    assert!(predictions.lock(finer, choice(1, "whatever")).is_err());
    predictions.lock(finer, choice(1, "is gone")).unwrap();
    assert!(predictions.lock(finer, choice(1, "is gone")).is_err());
    assert_eq!(Predictions::hidden_after_lock(page, &hidden), []);
    // The session stores predictions as TOML.
    let text = toml::to_string(&predictions).unwrap();
    assert_eq!(toml::from_str::<Predictions>(&text).unwrap(), predictions);
    // An answer that is no longer offered does not count.
    let changed = read(&WHOLE.replace("\"is gone\"", "\"has gone\""));
    assert_eq!(predictions.open_on(&changed.pages[0]).count(), 1);
    // Each round of a class has its own answer, and all are listed.
    assert_eq!(predictions.in_words(finer).as_deref(), Some("is gone"));
    predictions
        .lock(finer, choice(2, "stays as it is"))
        .unwrap();
    let all = "is gone (round 1), stays as it is (round 2, after its outcome was seen)";
    assert_eq!(predictions.in_words(finer).as_deref(), Some(all));
}
