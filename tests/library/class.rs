//! The folder of a class: seats, wrong codes, votes by round, and what the two accounts write in it.

use gyrolab::class::folder::{Stage, State};
use gyrolab::class::seat::{Presence, Record, all_seats};
use gyrolab::class::votes::{self, Tally, sittings};
use gyrolab::class::{Folder, Seat, login};
use gyrolab::lessons::class::KeptLessons;
use gyrolab::lessons::predictions::{Given, Place};
use gyrolab::lessons::{Answer, Asked, Lesson, reading};
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use tempfile::TempDir;

const LESSON: &str = "is-the-wobble-real";

fn class() -> (TempDir, Folder) {
    let dir = tempfile::tempdir().unwrap();
    let folder = Folder::open(dir.path()).unwrap();
    folder.make_teacher().unwrap();
    (dir, folder)
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().permissions().mode() & 0o7777
}

fn new_seat(folder: &Folder, name: &str) -> Seat {
    let (seat, is_new) = login::take(folder, name, 0).unwrap();
    assert!(is_new);
    seat
}

/// Keeps in `seat` these votes on the question `name` of `lesson`: round, number, and whether it is late.
fn keep(seat: &Seat, lesson: &Lesson, name: &str, votes: &[(u32, f64, bool)]) {
    let predict = lesson.predict(name).unwrap();
    let mut place = Place::default();
    for &(round, number, late) in votes {
        let answer = match &predict.asked {
            Asked::Choice(all) => Answer::Choice(all[number as usize - 1].clone()),
            Asked::Number { .. } => Answer::Number(number),
        };
        let given = Given {
            round,
            answer,
            late,
            page: 2,
            time_unix_s: 1_800_000_000,
        };
        place.predictions.lock(predict, given).unwrap();
    }
    let kept = KeptLessons {
        open: None,
        lessons: [(LESSON.to_owned(), place)].into(),
    };
    let record = Record {
        lessons: toml::Table::try_from(kept).unwrap(),
        ..Record::default()
    };
    seat.save(&record).unwrap();
}

#[test]
fn a_seat_is_found_by_its_word_alone_and_its_modes_are_set() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, " Anna\n");
    assert!(seat.word.starts_with("anna-") && seat.word.len() == 9);
    assert_ne!(new_seat(&folder, "anna").word, seat.word);
    let (back, is_new) = login::take(&folder, &seat.word, 0).unwrap();
    assert!((&back.word, is_new) == (&seat.word, false));
    seat.save(&Record::default()).unwrap();
    seat.hold().unwrap();
    assert_eq!(seat.presence(), Presence::Here);
    folder.publish(&State::default()).unwrap();
    assert_eq!(mode(&folder.teacher()), 0o2750);
    assert_eq!(mode(&folder.seats()), 0o2770);
    assert_eq!(mode(&seat.folder), 0o2770);
    assert_eq!(mode(&seat.file("seat")), 0o640);
    assert_eq!(mode(&folder.teacher().join("state")), 0o640);
}

#[test]
fn hostile_names_make_no_seat() {
    let (_dir, folder) = class();
    let long = "a".repeat(25);
    for name in [
        "",
        "..",
        "a/b",
        ".a",
        "-a",
        "a b",
        "\u{1b}[2J",
        "a\u{202e}b",
        "a\0b",
        "-4711",
        &long,
        "../anna-4711",
        "a;b",
    ] {
        let refused = login::take(&folder, name, 0).unwrap_err();
        assert!(
            refused.contains("letters, digits and hyphens"),
            "{name:?}: {refused}"
        );
        assert!(
            !refused.contains(['\u{1b}', '\u{202e}', '\0']),
            "{refused:?}"
        );
    }
    assert!(all_seats(&folder).is_empty());
}

#[test]
fn five_wrong_codes_lock_a_name_for_a_minute_in_every_login() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let code: u32 = seat.word[5..].parse().unwrap();
    let wrong = format!("anna-{:04}", (code + 1) % 10_000);
    let other = new_seat(&folder, "berta");
    for try_at in 0..5 {
        let refused = login::take(&folder, &wrong, try_at).unwrap_err();
        assert!(refused.contains("no seat of that word"), "{refused}");
    }
    let refused = login::take(&folder, &seat.word, 63).unwrap_err();
    assert!(refused.contains("wait a minute"), "{refused}");
    assert_eq!(login::locked(&folder, 63), ["anna"]);
    login::take(&folder, &other.word, 10).unwrap();
    login::take(&folder, &seat.word, 64).unwrap();
}

#[test]
fn a_class_has_two_hundred_seats() {
    let (_dir, folder) = class();
    for index in 0..login::MOST_SEATS {
        fs::create_dir(folder.seats().join(format!("s{index}-0000"))).unwrap();
    }
    let refused = login::take(&folder, "anna", 0).unwrap_err();
    assert!(refused.contains("200 seats"), "{refused}");
}

#[test]
fn votes_are_counted_by_round_and_late_ones_apart() {
    let (_dir, folder) = class();
    let lesson = reading::open(LESSON).unwrap();
    let predict = lesson.predict("finer").unwrap();
    let all = [(1.0, 2.0, false), (2.0, 2.0, false), (1.0, 1.0, true)];
    for (index, (first, second, late)) in all.into_iter().enumerate() {
        let seat = new_seat(&folder, &format!("seat{index}"));
        let votes = [(1, first, late), (2, second, false)];
        keep(&seat, &lesson, "finer", &votes);
    }
    let seats = sittings(&folder);
    let counts = |round| {
        let tally = Tally::of(&seats, LESSON, predict, round);
        let counts: Vec<_> = tally.bars.iter().map(|(_, count)| *count).collect();
        (counts[..2].to_vec(), tally.late)
    };
    assert_eq!(counts(1), (vec![1, 1], 1));
    assert_eq!(counts(2), (vec![1, 2], 0));
    let drawn = Tally::of(&seats, LESSON, predict, 1).drawn().text();
    assert!(drawn.contains("late:\n1 █"), "{drawn}");
    let csv = votes::csv(&folder).unwrap();
    assert!(
        csv.starts_with("lesson,question,round,seat,choice,late,page,time\n"),
        "{csv}"
    );
    assert!(csv.contains(&format!("{LESSON},finer,2,seat0-")), "{csv}");
    assert!(csv.contains(",1,true,2,2027-01-15T08:00:00Z\n"), "{csv}");
}

#[test]
fn what_is_right_leads_to_advice() {
    let text = "# T\n\n## P\n\n```predict\nname = \"a\"\nask = \"How far?\"\n";
    let choice = "choices = [\"one\", \"two\"]\nright = 2\n```\n";
    let number = "unit = \"deg\"\nright = 2.0\nwithin = 0.5\n```\n";
    for (asked, choices, advice) in [
        (
            choice,
            [2.0, 2.0, 1.0, 2.0],
            "right is 2, 75 % chose it: go on",
        ),
        (
            choice,
            [2.0, 2.0, 1.0, 1.0],
            "right is 2, 50 % chose it: let them talk, then ask again",
        ),
        (
            number,
            [2.5, 1.4, 2.6, 7.0],
            "right is 2 ± 0.5, 25 % chose it: explain, then ask again",
        ),
    ] {
        let lesson = reading::read("t.md", &format!("{text}{asked}")).unwrap();
        let predict = lesson.predict("a").unwrap();
        let (_dir, folder) = class();
        for (index, choice) in choices.into_iter().enumerate() {
            let seat = new_seat(&folder, &format!("seat{index}"));
            keep(&seat, &lesson, "a", &[(1, choice, false)]);
        }
        let tally = Tally::of(&sittings(&folder), LESSON, predict, 1);
        assert_eq!(tally.advice.as_deref(), Some(advice));
    }
}

#[test]
fn another_versions_files_are_named_and_left() {
    let (_dir, folder) = class();
    fs::write(
        folder.teacher().join("state"),
        "gyrolab = \"9.9.9\"\nnew = [1]\n",
    )
    .unwrap();
    let refused = folder.state().unwrap_err();
    let own = env!("CARGO_PKG_VERSION");
    assert!(
        refused.contains("9.9.9") && refused.contains(own),
        "{refused}"
    );
    let seat = new_seat(&folder, "anna");
    fs::write(seat.file("seat"), "format = 99\n").unwrap();
    assert!(seat.record().unwrap_err().contains("another version"));
}

#[test]
fn what_cannot_be_written_leaves_the_old_file() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let record = Record {
        is_aside: true,
        ..Record::default()
    };
    seat.save(&record).unwrap();
    let long = Record {
        lessons: [("a".to_owned(), "x".repeat(2 << 20).into())]
            .into_iter()
            .collect(),
        ..Record::default()
    };
    assert!(seat.save(&long).unwrap_err().contains("1 MB"));
    assert!(seat.record().unwrap().is_aside);
    if rustix_is_root() {
        return; // whom no mode keeps from writing
    }
    let inside = seat.file("");
    fs::set_permissions(&inside, Permissions::from_mode(0o500)).unwrap();
    let refused = seat.save(&Record::default()).unwrap_err();
    assert!(refused.contains("cannot be kept"), "{refused}");
    fs::set_permissions(&inside, Permissions::from_mode(0o700)).unwrap();
    assert!(seat.record().unwrap().is_aside);
}

fn rustix_is_root() -> bool {
    fs::read_to_string("/proc/self/status").is_ok_and(|status| status.contains("\nUid:\t0\t"))
}

#[test]
fn a_question_closes_and_the_state_comes_back() {
    let (_dir, folder) = class();
    let mut state = State {
        gyrolab: env!("CARGO_PKG_VERSION").to_owned(),
        lesson: LESSON.to_owned(),
        page: 4,
        ..State::default()
    };
    let questions = state.questions.entry(LESSON.to_owned()).or_default();
    let question = questions.entry("finer".to_owned()).or_default();
    (question.earlier_rounds, question.stage) = (1, Stage::Closed);
    folder.publish(&state).unwrap();
    let back = folder.state().unwrap().unwrap();
    assert_eq!(back, state);
    assert_eq!(back.question("finer").round(), 2);
    assert_eq!(back.question("another").round(), 1);
}
