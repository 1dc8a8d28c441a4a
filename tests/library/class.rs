//! The folder of a class: seats, wrong codes, votes by round, and the files of the two accounts.

use gyrolab::class::board;
use gyrolab::class::folder::{ClassState, VoteStage};
use gyrolab::class::seat::{Presence, SeatRecord, all_seats};
use gyrolab::class::student::Student;
use gyrolab::class::votes::{self, Tally, seat_statuses};
use gyrolab::class::{ClassFolder, ClassRole, Seat, login};
use gyrolab::lessons::predictions::{LessonProgress, LockedAnswer};
use gyrolab::lessons::state::KeptLessons;
use gyrolab::lessons::{AnswerKind, Lesson, PredictionAnswer, opening, reading};
use std::fs::{self, File, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

const LESSON: &str = "is-the-wobble-real";

fn class() -> (TempDir, ClassFolder) {
    let dir = tempfile::tempdir().unwrap();
    let folder = ClassFolder::open(dir.path()).unwrap();
    folder.make_teacher().unwrap();
    (dir, folder)
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().permissions().mode() & 0o7777
}

fn new_seat(folder: &ClassFolder, name: &str) -> Seat {
    let (seat, is_new) = login::claim(folder, name, 0).unwrap();
    assert!(is_new);
    seat
}

/// Saves in `seat` these votes on the question `name` of `lesson`: round, number, and whether it is late.
fn keep(seat: &Seat, lesson: &Lesson, name: &str, votes: &[(u32, f64, bool)]) {
    let predict = lesson.predict(name).unwrap();
    let mut place = LessonProgress::default();
    for &(round, number, late) in votes {
        let answer = match &predict.asked {
            AnswerKind::Choice(all) => PredictionAnswer::Choice(all[number as usize - 1].clone()),
            AnswerKind::Number { .. } => PredictionAnswer::Number(number),
        };
        let given = LockedAnswer {
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
    let record = SeatRecord {
        lessons: toml::Table::try_from(kept).unwrap(),
        ..SeatRecord::default()
    };
    seat.save(&record).unwrap();
}

#[test]
fn a_seat_is_found_only_by_its_word_and_has_restricted_modes() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, " Anna\n");
    assert!(seat.word.starts_with("anna-") && seat.word.len() == 11);
    assert_ne!(new_seat(&folder, "anna").word, seat.word);
    let (back, is_new) = login::claim(&folder, &seat.word, 0).unwrap();
    assert!((&back.word, is_new) == (&seat.word, false));
    seat.save(&SeatRecord::default()).unwrap();
    seat.hold().unwrap();
    assert_eq!(seat.presence(), Presence::Here);
    folder.publish(&ClassState::default()).unwrap();
    assert_eq!(mode(&folder.teacher()), 0o2750);
    assert_eq!(mode(&folder.seats()), 0o2770);
    assert_eq!(mode(&seat.folder), 0o2770);
    assert_eq!(mode(&seat.file("seat")), 0o640);
    assert_eq!(mode(&folder.teacher().join("state")), 0o640);
}

#[test]
fn invalid_names_are_rejected_for_seats() {
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
        "-471108",
        &long,
        "../anna-471108",
        "a;b",
    ] {
        let refused = login::claim(&folder, name, 0).unwrap_err();
        assert!(
            refused.contains("letters, digits and hyphens"),
            "{name:?}: {refused}"
        );
        assert!(
            !refused.contains(['\u{1b}', '\u{202e}', '\0']),
            "{refused:?}"
        );
    }
    assert_eq!(all_seats(&folder).unwrap().len(), 0);
}

/// Returns a word for `name` that belongs to none of `seats`.
fn wrong_word(name: &str, seats: &[&Seat]) -> String {
    let words = (0..).map(|code| format!("{name}-{code:06}"));
    words
        .into_iter()
        .find(|word| seats.iter().all(|seat| seat.word != *word))
        .unwrap()
}

#[track_caller]
fn refused(folder: &ClassFolder, word: &str, at_s: u64, reason: &str) -> String {
    let refused = login::claim(folder, word, at_s).unwrap_err();
    assert!(refused.contains(reason), "{word} at {at_s} s: {refused}");
    refused
}

const NO_SEAT: &str = "no seat of that word";
const TOO_MANY: &str = "too many wrong codes for anna";

#[test]
fn wrong_codes_delay_further_attempts_increasingly() {
    let (_dir, folder) = class();
    let (anna, berta) = (new_seat(&folder, "anna"), new_seat(&folder, "berta"));
    let wrong = wrong_word("anna", &[&anna]);
    for _ in 0..5 {
        refused(&folder, &wrong, 0, NO_SEAT);
    }
    let mut now_s = 0;
    for wait_s in [60, 120, 240, 480, 960, 1920, 3600, 3600] {
        refused(&folder, &anna.word, now_s + wait_s - 1, TOO_MANY);
        now_s += wait_s;
        refused(&folder, &wrong, now_s, NO_SEAT);
    }
    login::claim(&folder, &berta.word, 0).unwrap();
    login::claim(&folder, &anna.word, now_s + 3600).unwrap();
    for _ in 0..5 {
        refused(&folder, &wrong, now_s + 3600, NO_SEAT);
    }
}

#[test]
fn a_right_code_resets_only_the_count_of_its_own_seat() {
    let (_dir, folder) = class();
    let (own, other) = (new_seat(&folder, "anna"), new_seat(&folder, "anna"));
    let wrong = wrong_word("anna", &[&own, &other]);
    for _ in 0..5 {
        login::claim(&folder, &own.word, 0).unwrap();
        refused(&folder, &wrong, 0, NO_SEAT);
    }
    login::claim(&folder, &own.word, 1).unwrap();
    let waiting = login::waiting(&folder, 1);
    let words: Vec<_> = waiting.iter().map(|seat| seat.word.as_str()).collect();
    assert_eq!(words, [&other.word]);
    assert_eq!(waiting[0].wrong.count, 5);
    // The reply for a delayed seat does not reveal whether the code is right.
    let to_right = refused(&folder, &other.word, 2, TOO_MANY);
    assert_eq!(to_right, refused(&folder, &wrong, 2, TOO_MANY));
}

#[test]
fn guesses_of_several_logins_are_counted_together() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let wrong = wrong_word("anna", &[&seat]);
    let tried = || {
        let answers = (0..20).map(|_| login::claim(&folder, &wrong, 0).unwrap_err());
        answers.filter(|answer| answer.contains(NO_SEAT)).count()
    };
    let compared: usize = std::thread::scope(|scope| {
        let logins: Vec<_> = (0..6).map(|_| scope.spawn(tried)).collect();
        logins.into_iter().map(|login| login.join().unwrap()).sum()
    });
    assert_eq!(compared, 5);
}

#[test]
fn a_code_that_cannot_be_counted_is_not_compared() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    // No file can replace a folder.
    fs::create_dir_all(wrong_codes(&folder, &seat).join("inner")).unwrap();
    let uncounted = "no code can be tried now";
    let to_right = refused(&folder, &seat.word, 0, uncounted);
    let wrong = wrong_word("anna", &[&seat]);
    assert_eq!(to_right, refused(&folder, &wrong, 0, uncounted));
}

fn wrong_codes(folder: &ClassFolder, seat: &Seat) -> PathBuf {
    folder.root.join(".gyrolab/wrong").join(&seat.word)
}

#[test]
fn a_damaged_count_of_wrong_codes_does_not_block() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let count = wrong_codes(&folder, &seat);
    let fifo = || {
        assert!(
            Command::new("mkfifo")
                .arg(&count)
                .status()
                .unwrap()
                .success()
        );
    };
    let link = || symlink("/dev/zero", &count).unwrap();
    let long = || File::create(&count).unwrap().set_len(3 << 30).unwrap();
    for make in [&fifo as &dyn Fn(), &link, &long] {
        make();
        assert_eq!(login::waiting(&folder, 0), []);
        board::lines(&folder, 80);
        refused(&folder, &wrong_word("anna", &[&seat]), 0, NO_SEAT);
        login::claim(&folder, &seat.word, 0).unwrap();
        assert!(
            fs::symlink_metadata(&count).is_err(),
            "the count was replaced"
        );
    }
}

#[test]
fn seats_of_older_versions_keep_their_four_digit_codes() {
    let (_dir, folder) = class();
    fs::create_dir(folder.seats().join("anna-4711")).unwrap();
    let (seat, is_new) = login::claim(&folder, "anna-4711", 0).unwrap();
    assert!((seat.word.as_str(), is_new) == ("anna-4711", false));
    // A code with a missing digit is not accepted as the name of a new seat.
    refused(&folder, "anna-47110", 0, NO_SEAT);
}

#[test]
fn damaged_seats_are_reported_by_name() {
    let (_dir, folder) = class();
    let (anna, berta) = (new_seat(&folder, "anna"), new_seat(&folder, "berta"));
    berta.save(&SeatRecord::default()).unwrap();
    for damaged in ["format = ", "format = 2\n[lessons]\nlessons = 7\n", "\u{0}"] {
        fs::write(anna.file("seat"), damaged).unwrap();
        let seats = seat_statuses(&folder).unwrap();
        let troubles: Vec<_> = seats
            .iter()
            .filter_map(|seat| seat.trouble.as_ref())
            .collect();
        assert_eq!(troubles.len(), 1, "{damaged:?}");
        assert!(troubles[0].contains(&anna.word), "{}", troubles[0]);
        let board = board::lines(&folder, 200).join("\n");
        assert!(board.contains(troubles[0]), "{board}");
    }
}

#[test]
fn unsaved_answers_are_reported_on_leaving() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let holds = seat.hold().unwrap();
    let mut student = Student::new(folder, seat.clone(), holds, SeatRecord::default());
    fs::remove_dir_all(&seat.folder).unwrap();
    let told = student.leave().unwrap_err();
    assert!(told.contains("your answers cannot be saved"), "{told}");
    assert!(told.contains(&seat.word), "{told}");
}

#[test]
fn a_class_has_at_most_two_hundred_seats() {
    let (_dir, folder) = class();
    for index in 0..login::MOST_SEATS {
        fs::create_dir(folder.seats().join(format!("s{index}-000000"))).unwrap();
    }
    let refused = login::claim(&folder, "anna", 0).unwrap_err();
    assert!(refused.contains("200 seats"), "{refused}");
}

#[test]
fn votes_are_counted_by_round_and_late_votes_separately() {
    let (_dir, folder) = class();
    let lesson = opening::open(LESSON).unwrap();
    let predict = lesson.predict("finer").unwrap();
    let all = [(1.0, 2.0, false), (2.0, 2.0, false), (1.0, 1.0, true)];
    for (index, (first, second, late)) in all.into_iter().enumerate() {
        let seat = new_seat(&folder, &format!("seat{index}"));
        let votes = [(1, first, late), (2, second, false)];
        keep(&seat, &lesson, "finer", &votes);
    }
    let seats = seat_statuses(&folder).unwrap();
    let counts = |round| {
        let tally = Tally::count(&seats, LESSON, predict, round);
        let counts: Vec<_> = tally.bars.iter().map(|(_, count)| *count).collect();
        (counts[..2].to_vec(), tally.late)
    };
    assert_eq!(counts(1), (vec![1, 1], 1));
    assert_eq!(counts(2), (vec![1, 2], 0));
    let drawn = Tally::count(&seats, LESSON, predict, 1).drawn().text();
    assert!(drawn.contains("late:\n1 ━"), "{drawn}");
    let csv = votes::csv(&folder, &seat_statuses(&folder).unwrap()).unwrap();
    assert!(
        csv.starts_with("lesson,question,round,seat,choice,late,page,time\n"),
        "{csv}"
    );
    assert!(csv.contains(&format!("{LESSON},finer,2,seat0-")), "{csv}");
    assert!(csv.contains(",1,true,2,2027-01-15T08:00:00Z\n"), "{csv}");
}

#[test]
fn the_share_of_right_answers_determines_the_advice() {
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
        for (index, chosen) in choices.into_iter().enumerate() {
            let seat = new_seat(&folder, &format!("seat{index}"));
            keep(&seat, &lesson, "a", &[(1, chosen, false)]);
        }
        let tally = Tally::count(&seat_statuses(&folder).unwrap(), LESSON, predict, 1);
        assert_eq!(tally.advice.as_deref(), Some(advice));
    }
}

#[test]
fn files_of_another_version_are_named_and_left_alone() {
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
fn a_failed_write_keeps_the_old_file() {
    let (_dir, folder) = class();
    let seat = new_seat(&folder, "anna");
    let record = SeatRecord {
        is_aside: true,
        ..SeatRecord::default()
    };
    seat.save(&record).unwrap();
    let long = SeatRecord {
        lessons: [("a".to_owned(), "x".repeat(2 << 20).into())]
            .into_iter()
            .collect(),
        ..SeatRecord::default()
    };
    assert!(seat.save(&long).unwrap_err().contains("1 MB"));
    assert!(seat.record().unwrap().is_aside);
    if rustix_is_root() {
        return; // root can write despite the mode
    }
    let inside = seat.file("");
    fs::set_permissions(&inside, Permissions::from_mode(0o500)).unwrap();
    let refused = seat.save(&SeatRecord::default()).unwrap_err();
    assert!(refused.contains("cannot be saved"), "{refused}");
    fs::set_permissions(&inside, Permissions::from_mode(0o700)).unwrap();
    assert!(seat.record().unwrap().is_aside);
}

fn rustix_is_root() -> bool {
    fs::read_to_string("/proc/self/status").is_ok_and(|status| status.contains("\nUid:\t0\t"))
}

#[test]
fn the_state_of_closed_questions_is_read_back() {
    let (_dir, folder) = class();
    let mut state = ClassState {
        gyrolab: env!("CARGO_PKG_VERSION").to_owned(),
        lesson: LESSON.to_owned(),
        page: 4,
        ..ClassState::default()
    };
    let questions = state.questions.entry(LESSON.to_owned()).or_default();
    let question = questions.entry("finer".to_owned()).or_default();
    (question.earlier_rounds, question.stage) = (1, VoteStage::All);
    question.is_closed = true;
    folder.publish(&state).unwrap();
    let back = folder.state().unwrap().unwrap();
    assert_eq!(back, state);
    assert_eq!(back.question("finer").round(), 2);
    assert_eq!(back.question("another").round(), 1);
}
