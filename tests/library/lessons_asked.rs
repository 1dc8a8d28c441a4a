//! Pages with a question: nothing on the screen reveals the answer early.

use crate::support::stage::{SMALL, Stage};
use gyrolab::lab::view::Pane;
use gyrolab::lessons::page::ClassOverlay;
use gyrolab::lessons::{AnswerKind, PredictionAnswer, opening, shipped};

/// Words of the lab about the exact motion, reliability and theory.
const ANSWERS: [&str; 6] = [
    "reliable",
    "exact under run",
    "╌╌ exact",
    "off exact",
    "previous run",
    "a: rerun",
];

/// Opens a lesson on `page` and waits until its run is ready.
fn on_page(lesson: &str, page: usize) -> Stage {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.lesson(lesson, page).settle();
    stage
}

#[track_caller]
fn assert_nothing_revealed(stage: &Stage, place: &str) {
    let picture = stage.picture();
    for answer in ANSWERS {
        assert!(!picture.contains(answer), "{place}: {answer}\n{picture}");
    }
}

#[test]
fn questions_are_not_revealed_before_the_reader_answers() {
    let mut questions = 0;
    for lesson in shipped::LESSONS {
        let pages = opening::open(lesson.name).unwrap().pages;
        for page in pages.iter().filter(|page| page.predicts().next().is_some()) {
            let place = format!("{} {}", lesson.name, page.number);
            let mut stage = on_page(lesson.name, page.number);
            assert!(stage.lab.view().asked().is_some(), "{place}");
            // The run was not played beyond the shown step.
            assert_eq!(stage.lab.player().run().furthest(), stage.step(), "{place}");
            assert_nothing_revealed(&stage, &place);
            let before = stage.lab.player().run().scenario().clone();
            stage
                .press("\t")
                .press("t")
                .shows("hidden until you have predicted");
            stage.press("a").shows("until you have predicted").wait(6.0);
            let after = stage.lab.player().run().scenario();
            assert_eq!(before.motion, after.motion, "{place}");
            assert_nothing_revealed(&stage, &place);
            while stage.lab.view().focus != Pane::Lesson {
                stage.press("\t");
            }
            while let Some(asked) = stage.class.open_lesson().unwrap().asked() {
                let is_number = matches!(asked.asked, AnswerKind::Number { .. });
                stage.press(if is_number { "7\n" } else { "1\n" });
                questions += 1;
            }
            assert!(!stage.lab.view().hides_answers(), "{place}");
        }
    }
    assert!(questions >= 50, "{questions}");
}

/// Opens the page of a lesson that asks for a force in N.
fn open_force_question() -> Stage {
    on_page("what-holds-the-weight-up", 5)
}

fn locked(stage: &Stage) -> Vec<PredictionAnswer> {
    let predictions = &stage.class.open_lesson().unwrap().place.predictions;
    predictions
        .all()
        .map(|(_, given)| given.answer.clone())
        .collect()
}

#[test]
fn number_answers_accept_compatible_units() {
    for (typed, newtons) in [
        ("99", 99.0),
        ("99 N", 99.0),
        ("98,5N", 98.5),
        ("9.9e1 N", 99.0),
        ("99000 mN", 99.0),
        ("-3 N", -3.0),
        (".5", 0.5),
    ] {
        let mut stage = open_force_question();
        stage.press(typed).press("\n");
        assert_eq!(
            locked(&stage),
            [PredictionAnswer::Number(newtons)],
            "{typed}"
        );
    }
    for (typed, said) in [
        ("99 kg", "must be in N, not in kg"),
        ("9 about", "must be in N, not in about"),
        ("9..9", "must be in N, not in"),
        ("--", "must be a number"),
    ] {
        let mut stage = open_force_question();
        stage.press(typed).press("\n").shows(said);
        assert_eq!(locked(&stage), [], "{typed}");
    }
}

#[test]
fn letters_at_a_number_question_are_not_lab_keys() {
    let mut stage = open_force_question();
    stage.press("p").shows("type a number, then press Enter");
    stage.press("about");
    assert!(stage.lab.player().run().scenario().pushes.is_empty());
    assert_eq!(stage.class.open_lesson().unwrap().place.page, 5);
    // In the lab, the letters act as keys.
    stage.press("\t").press("p");
    assert_eq!(stage.lab.player().run().scenario().pushes.len(), 1);
}

/// Makes the stage a follower of a class at `round` of the question.
fn follow_class(stage: &mut Stage, round: u32, is_closed: bool) {
    let overlay = ClassOverlay {
        rounds: [("mean".to_owned(), (round, is_closed))].into(),
        ..ClassOverlay::default()
    };
    stage.class.set_overlay(overlay, &mut stage.lab);
    stage.wait(6.0);
}

#[test]
fn answers_stay_hidden_while_a_round_is_open() {
    let mut stage = on_page("what-holds-the-weight-up", 1);
    stage.commands("step = 50");
    follow_class(&mut stage, 1, false);
    stage.press("1\n").wait(6.0);
    assert_nothing_revealed(&stage, "answered, and the round is open");
    stage.press("t").shows("until the round is over").wait(6.0);
    follow_class(&mut stage, 1, true);
    stage.shows("reliable");
    follow_class(&mut stage, 2, false);
    assert_nothing_revealed(&stage, "asked again");
    stage.press("2\n").wait(6.0);
    assert_nothing_revealed(&stage, "answered again");
    follow_class(&mut stage, 2, true);
    stage.shows("reliable");
}

#[test]
fn followers_see_sentences_that_name_keys() {
    let mut stage = on_page("cusps-loops-and-waves", 1);
    let overlay = ClassOverlay {
        is_followed: true,
        ..ClassOverlay::default()
    };
    stage.class.set_overlay(overlay, &mut stage.lab);
    stage.wait(0.0).shows("Press space, and - to play");
}
