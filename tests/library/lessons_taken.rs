//! Lessons opened in the lab, from the keys to the picture.

use crate::support::scenarios::resumed;
use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::lab::lessons_in;
use gyrolab::lab::sheet::SheetLineKind;
use gyrolab::lab::view::{HideablePart, Pane};
use gyrolab::lessons::predictions::Tried;
use gyrolab::lessons::{Lessons, PredictionAnswer, opening, shipped};
use ratatui::layout::Rect;
use std::fs;

/// A lesson with a question of each kind, a task with a check, and notes.
const LESSON: &str = r#"# Swing

```lesson
about = "A lesson to test by."
minutes = 5
```

## Look

```lab
open = "cusps"
hide = ["health", "predicted"]
go_to = "2 s"
keep = { first = "t_s" }
```

The time is {t_s:.1} s, and **strong** words stand here.

```predict
name = "finer"
ask = "With a finer step the tilt ..."
choices = ["stays", "grows", "shrinks"]
```

It goes on here.

```predict
name = "lag"
ask = "How large is it?"
unit = "deg"
```

```notes
Let two answers be defended.
```

## Compare

```lab
set = { "motion.gravity_m_per_s2" = 5 }
go_to = "3 s"
```

```compare
prediction = "finer"
with = "t_s + first"
text = "It is {with:.1}. You said: it {prediction}."
```

```compare
prediction = "lag"
text = "You said: {prediction}."
```

## Your turn

Go to 4 s.

```task
go_to = "4 s"
keep = { mine = "t_s" }
```

```check
that = "t_s > 3.9"
goal = "be at 4 s"
hint = "g goes to a time."
```

## End

You were at {mine:.1} s.
"#;

/// Opens a stage with [`LESSON`] from a file, on page `page`.
fn open_page(page: usize) -> (Stage, tempfile::TempDir, String) {
    let (mut stage, folder, name) = with(LESSON);
    stage.lesson(&name, page).settle();
    (stage, folder, name)
}

/// Opens a stage and writes a lesson with `text` to a file. Returns the stage, the folder and the path.
fn with(text: &str) -> (Stage, tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("swing.md");
    fs::write(&path, text).unwrap();
    let name = path.display().to_string();
    (Stage::open("method-2", &[], SMALL), folder, name)
}

/// Returns the answer to the question "finer".
fn answer_in(class: &Lessons) -> PredictionAnswer {
    let mut all = class.open_lesson().unwrap().place.predictions.all();
    all.find(|(name, _)| *name == "finer")
        .unwrap()
        .1
        .answer
        .clone()
}

#[test]
fn a_page_opens_its_run_and_shows_its_numbers() {
    let (mut stage, _folder, _) = open_page(1);
    stage
        .shows("Swing ─")
        .shows(" 1 of 4")
        .shows("The time is 2.0 s");
    stage.shows("strong words").shows_no("**");
    assert_eq!(stage.focus(), "lesson");
    assert_eq!(stage.lab.runs().name(), "cusps");
    assert!(stage.lab.view().hides(HideablePart::Health));
}

/// Returns the answers on the page: whether each is chosen, and the mark at its end.
fn listed_answers(stage: &Stage) -> Vec<(bool, &'static str)> {
    let sheet = stage.lab.view().sheet.as_ref().unwrap();
    let kinds = sheet.paragraphs.iter().map(|one| &one.kind);
    kinds
        .filter_map(|kind| match kind {
            SheetLineKind::Choice {
                is_selected, mark, ..
            } => Some((*is_selected, *mark)),
            _ => None,
        })
        .collect()
}

#[test]
fn a_prediction_is_requested_locked_and_compared_with_the_outcome() {
    let (mut stage, _folder, _) = open_page(1);
    stage.shows("Your prediction").shows(" 1  stays");
    stage.shows_no("It goes on here");
    stage.press("\n").shows("choose an answer first");
    stage
        .press("n")
        .shows("write down a prediction first")
        .shows("1 of 4");
    stage.press("↓↓↓↑").shows_no("It goes on");
    assert_eq!(
        listed_answers(&stage),
        [(false, ""), (true, ""), (false, "")]
    );
    stage.press("7").shows("the answers are 1 to 3");
    stage.press("3");
    assert_eq!(
        listed_answers(&stage),
        [(false, ""), (false, ""), (true, "")]
    );
    stage.press("↑\n").shows("Locked: grows.");
    assert_eq!(
        listed_answers(&stage),
        [(false, ""), (false, "you"), (false, "")]
    );
    stage.shows("It goes on here").shows("How large is it?");
    assert!(
        stage.lab.view().hides(HideablePart::Health),
        "one prediction is still open"
    );
    stage.press("\n").shows("your prediction").shows("deg");
    stage.press("much\n").shows("must be a number");
    stage.press("\u{1b}3,5\n").shows("Locked: 3.5 deg");
    assert!(!stage.lab.view().hides(HideablePart::Health));
    assert!(!stage.lab.view().hides(HideablePart::Predicted));
    stage.press("n").settle().shows("2 of 4");
    stage
        .shows("You said: it grows.")
        .shows("Came out: It is 5.0.");
    stage.shows("You said: 3.5 deg.");
    assert_eq!(stage.lab.player().motion().gravity, 5.0);
    stage.press("N").settle().shows("1 of 4");
    assert_eq!(listed_answers(&stage)[1], (false, "you"));
    assert_eq!(
        answer_in(&stage.class),
        PredictionAnswer::Choice("grows".to_owned())
    );
    stage.press("\n").shows("your answer is locked");
}

/// Returns the words in the row of the verdict and in the note below it.
fn rows_below(stage: &Stage) -> [String; 2] {
    let layout = gyrolab::tui::screen::layout(&stage.lab, true, stage.size);
    let picture = stage.picture();
    let row = |at: u16| picture.lines().nth(at.into()).unwrap().trim().to_owned();
    [row(layout.verdict.y), row(layout.note.y)]
}

#[test]
fn an_open_question_hides_its_answer_and_names_its_keys() {
    let text = LESSON.replace("hide = [\"health\", \"predicted\"]\n", "exact = true\n");
    let (mut stage, _folder, name) = with(&text);
    stage.lesson(&name, 1).settle();
    let hidden = "The verdict and the exact motion are hidden until you have predicted.";
    let unchosen = "1 2 3 or ↑ ↓ choose  n skip";
    assert_eq!(rows_below(&stage), [unchosen, hidden]);
    stage.press("2").wait(0.0);
    let chosen = "1 2 3 or ↑ ↓ choose  Enter lock this prediction  n skip";
    assert_eq!(rows_below(&stage), [chosen, hidden]);
    // The exact motion, its numbers and advice are hidden; the run can be played.
    stage.shows_no("reliable");
    let picture = stage.picture();
    stage.commands("exact = false");
    assert_eq!(stage.picture(), picture);
    stage
        .commands("exact = true")
        .press("t")
        .shows("until you have predicted");
    stage.press("a").shows("until you have predicted");
    // The exact column is empty: each row ends with the number of the run.
    stage
        .press("e")
        .shows(" values ")
        .shows("x m       0.879\n");
    stage.press("\u{1b}").wait(6.0);
    let step = stage.step();
    stage.press(" ").wait(1.0).press(" ").wait(6.0);
    assert!(stage.step() > step);
    // After a number is typed and locked, everything is shown again.
    stage.press("\n");
    assert_eq!(rows_below(&stage)[0], "Enter type your prediction  n skip");
    stage.press("3\n").wait(6.0);
    assert!(rows_below(&stage)[0].starts_with("reliable:"));
    stage.shows("exact");
}

#[test]
fn hidden_items_are_hidden_in_every_pane() {
    let mut stage = Stage::open("cusps", &[], LARGE);
    stage.commands("pause = true\ngo_to = '2 s'\nexact = true");
    stage.settle().wait(6.0).shows("reliable:").shows("exact");
    stage.commands("hide = ['health', 'predicted', 'look_at']");
    stage.wait(6.0).shows_no("reliable");
    let picture = stage.picture();
    let row = picture
        .lines()
        .find(|line| line.contains(" precess"))
        .unwrap();
    let numbers = row
        .split_whitespace()
        .filter(|word| word.parse::<f64>().is_ok());
    assert!(numbers.count() <= 1, "only the number of the run: {row}");
    stage.commands("exact = false").wait(6.0);
    assert_eq!(stage.picture(), picture);
}

#[test]
fn the_run_stays_visible_with_every_pane() {
    let (mut stage, _folder, _) = open_page(3);
    let panes = |shown: &Stage| {
        let layout = gyrolab::tui::screen::layout(&shown.lab, true, shown.size);
        let panes = layout.panes.iter();
        panes
            .map(|(pane, place)| (*pane, place.width, place.height))
            .collect::<Vec<_>>()
    };
    let run = [
        (Pane::Lesson, 37, 19),
        (Pane::Traces, 41, 7),
        (Pane::Above, 41, 12),
    ];
    let values = (Pane::Parameters, 41, 12);
    assert_eq!(panes(&stage), run);
    for keys in ["e", "P"] {
        stage.press(keys);
        assert_eq!(panes(&stage), [run[0], run[1], values], "{keys}");
        let step = stage.step();
        stage.press(" ").wait(0.5).press(" p");
        assert!(stage.step() > step, "the run continues from there");
        assert!(!stage.lab.player().run().scenario().pushes.is_empty());
        // This also holds while a value is typed.
        stage.press("e\n").shows("Enter: ");
        assert_eq!(panes(&stage), [run[0], run[1], values], "{keys}");
        stage.press("\u{1b}\u{1b}").wait(6.0);
        assert_eq!(stage.focus(), "lesson");
        assert_eq!(panes(&stage), run);
    }
    stage.size = Rect::new(0, 0, 120, 40);
    gyrolab::tui::screen::fit(&mut stage.lab, stage.size);
    let has = |shown: &Stage| panes(shown).iter().map(|it| it.0).collect::<Vec<_>>();
    let both = [Pane::Lesson, Pane::Traces, Pane::Above, Pane::ThreeD];
    assert_eq!(has(&stage), both);
    stage.press("e");
    assert_eq!(has(&stage)[..3], both[..3]);
    assert_eq!(has(&stage)[3], Pane::Parameters);
}

#[test]
fn a_prediction_can_be_skipped() {
    let (mut stage, _folder, _) = open_page(1);
    stage.press("↓").press("nn").settle().shows("2 of 4");
    stage.shows("It is 5.0.").shows_no("You said: it");
    stage.shows("You made no prediction. Page 1 asks");
    // A missing prediction is shown as a blank, unless the lesson gives other words.
    stage.shows("You said: ….");
    stage.press("N").settle();
    assert_eq!(listed_answers(&stage)[0], (true, ""));
    stage.press("\n").shows("Locked: stays (after its outcome");
}

#[test]
fn the_lab_can_be_used_freely_and_one_key_returns_to_the_page() {
    let (mut stage, _folder, _) = open_page(2);
    let before = stage.step();
    stage.press("p..,,.....").settle();
    assert_ne!(stage.step(), before);
    assert_eq!(stage.lab.runs().journal().later_than(0), 2, "gravity, push");
    stage.press("b").settle();
    assert_eq!(stage.step(), before);
    assert_eq!(stage.lab.runs().journal().later_than(0), 1, "gravity");
    assert_eq!(stage.lab.player().motion().gravity, 5.0);
}

#[test]
fn a_task_can_be_done_by_hand_or_demonstrated() {
    let (mut stage, _folder, _) = open_page(3);
    stage.shows("[ ] not yet: be at 4 s").shows_no("Hint");
    stage.press("h").shows("Hint: g goes to a time.");
    stage.shows("[ ] not yet");
    stage.press("g3.95 s\n").settle();
    stage.shows("[x] done").shows_no("Hint");
    stage.press("n").shows("You were at 4.0 s");
    let kept = &stage.class.open_lesson().unwrap().place.kept;
    assert!((kept["mine"] - 3.95).abs() < 0.01, "{kept:?}");
    stage
        .press("N")
        .settle()
        .shows("[ ] done before; not now: be at 4 s");
    let (mut again, _other_folder, _) = open_page(3);
    again.press("hh").settle().shows("[x] shown by the lab");
    again.press("nn").shows("this is the last page");
    again.press("NNNN").settle().shows("this is the first page");
}

#[test]
fn the_session_saves_page_and_predictions() {
    let (mut stage, _folder, _) = open_page(1);
    stage.press("↓↓\n").press("nn").settle();
    let content = stage.lab.content(stage.class.kept());
    let (class, opened) = Lessons::resumed(lessons_in(&content), &mut resumed(&content));
    opened.unwrap();
    let place = &class.open_lesson().unwrap().place;
    assert_eq!(place.page, 2);
    assert_eq!(
        answer_in(&class),
        PredictionAnswer::Choice("grows".to_owned())
    );
    assert_eq!(place.kept["first"], 2.0);
}

#[test]
fn a_missing_lesson_keeps_the_lab_and_the_predictions() {
    let (mut stage, folder, name) = open_page(1);
    stage.press("↓↓\n");
    let content = stage.lab.content(stage.class.kept());
    drop(folder);
    let (lessons, opened) = Lessons::resumed(lessons_in(&content), &mut resumed(&content));
    assert!(opened.unwrap_err().contains("swing.md"));
    let kept = lessons.kept();
    let place = &kept["lessons"][name.as_str()];
    let answer = &place["predictions"]["finer"][0]["answer"];
    assert_eq!(answer.as_str(), Some("grows"));
}

#[test]
fn a_changed_lesson_is_reloaded_on_the_same_page() {
    let (mut stage, _folder, name) = open_page(2);
    let step = stage.step();
    fs::write(&name, LESSON.replace("It is {with", "Now it is {with")).unwrap();
    stage.wait(2.0).shows("Now it is 5.0").shows("2 of 4");
    assert_eq!(stage.step(), step, "the run stays");
    fs::write(&name, LESSON.replace("```compare", "```compere")).unwrap();
    stage.wait(2.0).shows("the changed lesson has an error");
    stage.shows("Now it is 5.0");
}

#[test]
fn a_lesson_that_is_not_a_regular_file_is_rejected() {
    let (mut stage, folder, name) = open_page(2);
    let fifo = folder.path().join("fifo.md");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status();
    assert!(made.unwrap().success());
    let named = fifo.display().to_string();
    let opened = stage.class.open(&named, None, &mut stage.lab);
    let refusal = opened.unwrap_err();
    assert!(refusal.contains("is not a regular file"), "{refusal}");
    fs::remove_file(&name).unwrap();
    fs::rename(&fifo, &name).unwrap();
    stage.wait(2.0).shows("the changed lesson has an error");
    stage.shows("2 of 4");
}

/// Returns the words of the page on the screen, in one line.
fn page_on_screen(stage: &Stage) -> String {
    let layout = gyrolab::tui::screen::layout(&stage.lab, true, stage.size);
    let place = layout.place_of(Pane::Lesson).unwrap();
    let (x, width) = (place.x.into(), place.width.into());
    let mut text = String::new();
    let picture = stage.picture();
    let rows = picture.lines().skip(usize::from(place.y) + 1);
    for line in rows.take(usize::from(place.height) - 1) {
        text.extend(line.chars().skip(x).take(width));
        text.push('\n');
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// True for lines that must be fully visible when a page opens.
fn is_needed(kind: &SheetLineKind) -> bool {
    matches!(
        kind,
        SheetLineKind::Question
            | SheetLineKind::Choice { .. }
            | SheetLineKind::Said
            | SheetLineKind::Result
            | SheetLineKind::Goal { .. }
    )
}

#[test]
fn every_page_opens_with_its_essential_lines_from_any_state() {
    for lesson in shipped::LESSONS {
        let mut stage = Stage::open("method-2", &[], SMALL);
        let mut wanderer = Stage::open("method-2", &[], SMALL);
        let pages = opening::open(lesson.name).unwrap().pages.len();
        for page in 1..=pages {
            let place = format!("{}, page {page}", lesson.name);
            for (screen, wanders) in [(&mut stage, false), (&mut wanderer, true)] {
                if wanders {
                    screen.commands("open = 'cusps'\npush = {}\nstep = 1000");
                }
                if page == 1 {
                    screen.lesson(lesson.name, 1);
                }
                while page > 1 && screen.class.open_lesson().unwrap().place.page < page {
                    screen.press("n");
                }
                if screen.class.open_lesson().unwrap().plays() {
                    let sheet = screen.lab.view().sheet.clone().unwrap();
                    assert!(
                        !sheet.paragraphs.iter().any(|one| is_needed(&one.kind)),
                        "{place}"
                    );
                    screen.press("n");
                }
                screen.settle();
                assert!(
                    !screen.class.open_lesson().unwrap().is_under_way(),
                    "{place}"
                );
            }
            let of = |screen: &Stage| screen.lab.view().sheet.clone().unwrap();
            assert_eq!(of(&stage), of(&wanderer), "{place}");
            for width in [80, 59] {
                stage.size.width = width;
                gyrolab::tui::screen::fit(&mut stage.lab, stage.size);
                let shown = page_on_screen(&stage);
                for one in of(&stage)
                    .paragraphs
                    .iter()
                    .filter(|one| is_needed(&one.kind))
                {
                    let text = one.text();
                    let words: Vec<&str> = text.split_whitespace().collect();
                    assert!(
                        shown.contains(&words.join(" ")),
                        "{place}, {width}: {text}\n{}",
                        stage.picture()
                    );
                }
            }
            stage.size.width = 80;
            gyrolab::tui::screen::fit(&mut stage.lab, stage.size);
        }
    }
}

#[test]
fn a_page_plays_its_run_and_n_jumps_to_its_end() {
    let text = LESSON
        .replace("go_to = \"3 s\"", "speed = 0.5\nrun_until = \"t_s >= 3\"")
        .replace("## Compare\n", "## Compare\n\nWatch.\n");
    let (mut stage, _folder, name) = with(&text);
    stage.lesson(&name, 1).settle().press("nn").wait(0.5);
    stage
        .shows("Watch.")
        .shows("The run is playing")
        .shows_no("It is");
    stage.press("p").wait(0.1).shows("press b to play it again");
    stage.press("n").shows("2 of 4").shows("It is 5.0.");
    stage.press("b").wait(0.5).shows_no("It is").wait(2.0);
    stage
        .shows("It is 5.0.")
        .press("u")
        .shows("the page began here");
    stage.press("n").settle().shows("3 of 4");
}

#[test]
fn results_of_tasks_and_late_predictions_are_saved() {
    let (mut stage, _folder, _) = open_page(1);
    stage.press("nn").settle().press("N").settle().press("↓\n");
    stage.press("nn").settle().press("n").settle();
    stage.press("hg4 s\n").settle().shows("done: be at 4 s");
    let place = &stage.class.open_lesson().unwrap().place;
    let late = place
        .predictions
        .all()
        .map(|(name, given)| (name.as_str(), given.late));
    assert_eq!(late.collect::<Vec<_>>(), [("finer", true)]);
    assert_eq!(place.tasks["Your turn"], Tried::DoneAfterHint);
}

#[test]
fn a_repeated_push_replaces_the_first() {
    let (mut stage, _folder, _) = open_page(2);
    stage.press("rp10.").settle().press("rp").settle();
    assert_eq!(stage.lab.player().run().scenario().pushes.len(), 1);
}

#[test]
fn lessons_are_opened_from_a_list_and_resumed_at_their_page() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage
        .press("n")
        .shows("n is a key of the pane")
        .shows("L lists the lessons");
    let title = |index: usize| {
        let name = shipped::LESSONS[index].name;
        opening::open(name).unwrap().title
    };
    stage.press("L").shows(&title(0));
    assert!(listed_answers(&stage)[0].0);
    stage.press("↓↓↑↓\n").settle();
    assert_eq!(stage.class.open_lesson().unwrap().lesson.title, title(2));
    stage.press("nn").settle().shows("2 of ");
    stage.press("L").shows(" min, page 2");
    stage.press("\n").settle().shows("2 of ");
    let step = stage.step();
    stage.press("L\n").settle().shows("2 of ");
    assert_eq!(stage.step(), step, "the run stays");
    stage.press("L↓\u{1b}L");
    assert!(listed_answers(&stage)[3].0);
    stage.press("\u{1b}");
    assert!(stage.lab.view().sheet.is_none());
}

#[test]
fn the_teacher_has_notes_the_next_page_and_a_clock() {
    let (mut stage, _folder, _) = open_page(1);
    stage.size = LARGE;
    stage.shows_no("defended");
    stage.press("\u{e}").wait(61.0);
    stage.shows(" · 1:01 of 5 min");
    stage.shows("| Let two answers be defended.");
    stage.shows("Next page: Compare");
    stage.press("\u{e}").shows_no("defended");
}

#[test]
fn a_long_page_starts_at_its_top_and_scrolls() {
    let long = "\n\nOne more paragraph stands here.".repeat(30);
    let text = format!("# Long\n\n## Page\n\n{long}\n\n## Two\n\nx\n\n## Three\n\nLast words.\n");
    let (mut stage, _folder, name) = with(&text);
    stage.lesson(&name, 1);
    stage.shows("\nPage").shows("PgDn: more");
    for _ in 0..20 {
        stage.key(gyrolab::tui::keymap::Key::PageDown);
    }
    stage.wait(0.0).shows("PgUp: back").shows_no("PgDn");
    stage.press("↑").shows("PgDn: more");
}

#[test]
fn stated_numbers_stay_while_the_run_continues() {
    let (mut stage, _folder, _) = open_page(1);
    stage.press("10.").settle().shows("The time is 2.0 s");
    stage.press("g5 s\n").settle().shows("The time is 2.0 s");
    stage.press("b").settle().shows("The time is 2.0 s");
    let (mut open, _other_folder, _) = open_page(2);
    open.shows("It is 5.0.").press("g4 s\n").settle();
    open.shows("It is 5.0.").shows_no("tilt 30 to 36.69");
    assert_eq!(stage.lab.player().reading.readouts.sample.time_s, 2.0);
}

#[test]
fn the_step_pane_next_to_a_page_has_its_keys() {
    let text = r#"# Step

## One

```lab
open = "method-2"
show = ["step", "3d"]
go_to = 1
```

x

## Two

```lab
open = "method-2"
show = ["3d"]
```

x

## Three

x
"#;
    let (mut stage, _folder, name) = with(text);
    stage.lesson(&name, 1).settle();
    stage.shows("phase 1 of 7").shows(". next phase");
    assert_eq!(stage.focus(), "lesson");
    stage.press("..").shows("phase 3 of 7");
    assert_eq!(stage.step(), 1, "no further step was taken");
    stage.press("n").settle().shows("2 of 3").shows("3-D");
    stage.press(".").settle();
    assert_eq!(stage.step(), 1);
}

#[test]
fn closing_the_3d_view_or_a_full_screen_pane_returns_to_the_page() {
    let (mut stage, _folder, _) = open_page(1);
    stage.press("d").shows("3-D").shows("1 of 4");
    assert_eq!(stage.focus(), "3d");
    stage.press("d").shows("1 of 4");
    assert_eq!(stage.focus(), "lesson");
    stage.press("df").shows_no("1 of 4").press("\u{1b}");
    stage.shows("1 of 4");
    assert_eq!(stage.focus(), "lesson");
}

#[test]
fn a_page_fits_screens_of_every_size() {
    let (mut stage, _folder, _) = open_page(1);
    for (width, height) in [(1, 1), (20, 5), (40, 12), (71, 24), (72, 9), (300, 90)] {
        stage.size.width = width;
        stage.size.height = height;
        gyrolab::tui::screen::fit(&mut stage.lab, stage.size);
        stage.wait(0.0).press("\t↓\t");
        assert_eq!(stage.picture().lines().count(), height as usize);
    }
}
