//! Lessons: what is read, and what is refused, with file and line.

use gyrolab::teach::{Block, Lesson, Text, reading};

/// A lesson with a block of every kind.
const WHOLE: &str = r#"# The push

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

fn read(text: &str) -> Lesson {
    reading::read("a.md", text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The refusal of [`WHOLE`] with `from` replaced by `to`.
#[track_caller]
fn refused(from: &str, to: &str) -> String {
    assert_eq!(WHOLE.matches(from).count(), 1, "{from}");
    let text = WHOLE.replace(from, to);
    match reading::read("a.md", &text) {
        Ok(_) => panic!("taken: {from} as {to}"),
        Err(problems) => problems.to_string(),
    }
}

#[test]
fn a_whole_lesson_is_read() {
    let lesson = read(WHOLE);
    assert_eq!(lesson.title, "The push");
    assert_eq!(lesson.minutes, Some(10));
    assert_eq!(lesson.introduction.len(), 1);
    let headings: Vec<_> = lesson
        .pages
        .iter()
        .map(|page| page.heading.as_str())
        .collect();
    assert_eq!(headings, ["Watch", "Run it", "Your turn"]);
    let kinds: Vec<Vec<&str>> = lesson
        .pages
        .iter()
        .map(|page| page.blocks.iter().map(kind).collect())
        .collect();
    assert_eq!(
        kinds,
        [
            vec!["lab", "text", "predict", "notes"],
            vec!["lab", "compare", "shown"],
            vec!["text", "task", "check"],
        ]
    );
    let lines: Vec<_> = lesson.pages.iter().map(|page| page.line).collect();
    let at = |text: &str| WHOLE.lines().position(|line| line == text).unwrap() + 1;
    assert_eq!(lines, ["## Watch", "## Run it", "## Your turn"].map(at));
    let first = lesson.pages[0].lab().unwrap();
    let lines: Vec<_> = first
        .commands
        .iter()
        .map(|placed| placed.line.unwrap())
        .collect();
    let of_keys = ["open = \"wobble-push\"", "detail_s = 8"].map(at);
    assert_eq!(lines[..2], of_keys);
}

fn kind(block: &Block) -> &'static str {
    match block {
        Block::Text(_) => "text",
        Block::Lab(_) => "lab",
        Block::Task(_) => "task",
        Block::Predict(_) => "predict",
        Block::Compare(_) => "compare",
        Block::Check(_) => "check",
        Block::Notes(_) => "notes",
        Block::Shown(_) => "shown",
    }
}

#[test]
fn places_for_numbers_are_found_and_braces_in_code_are_not() {
    let lesson = read(WHOLE);
    let Block::Text(text) = &lesson.pages[0].blocks[1] else {
        panic!("no text")
    };
    let named = |text: &Text| text.filled(|expression, _| format!("<{}>", expression.text()));
    assert_eq!(
        named(text),
        "At <t_s> s the top is at z = **<z_m>** m; `{ code }` and \\{braces} stay."
    );
}

#[test]
fn what_is_broken_is_told_with_its_line_and_the_nearest_right_name() {
    for (from, to, words) in [(
        "go_to = \"60 s\"",
        "go_too = \"60 s\"",
        "a.md:16: lab.go_too: unknown key: did you mean go_to?",
    )] {
        let told = refused(from, to);
        assert!(told.contains(words), "{from} as {to}: {told}");
    }
}
