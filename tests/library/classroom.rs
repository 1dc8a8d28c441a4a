//! A class in one process: the labs of teacher and students and the projector, on screens without a terminal.

use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::{has, has_no};
use gyrolab::class::projector::Projector;
use gyrolab::class::rehearsal::Players;
use gyrolab::class::student::Student;
use gyrolab::class::teacher::Teacher;
use gyrolab::class::votes::{self, seat_statuses};
use gyrolab::class::{ClassFolder, ClassRole, Seat, board, login};
use gyrolab::lab::LabRequest;
use gyrolab::lab::action::LessonKey;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::press::press;
use gyrolab::tui::{app, screen};
use ratatui::layout::Rect;
use std::fs;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const LESSON: &str = r#"# A test of the class

## Begin

```lab
open = "method-2"
```

Words.

## The question

```predict
name = "q"
ask = "What happens next?"
choices = ["as before", "the right way", "another way"]
right = 2
```

```notes
This note is the teacher's alone.
```

## The run

```lab
open = "method-2"
speed = 1
run_until = "t_s >= 3"
```

It was run.

## The end

Nothing more.
"#;

/// The folder of a class with the lesson above.
struct Class {
    dir: TempDir,
    folder: ClassFolder,
}

impl Class {
    fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("test.md"), LESSON).unwrap();
        let folder = ClassFolder::open(dir.path()).unwrap();
        folder.make_teacher().unwrap();
        Self { dir, folder }
    }

    fn lesson(&self) -> String {
        self.folder.root.join("test.md").display().to_string()
    }

    /// Opens the teacher's lab on `page`.
    fn teach(&self, page: usize) -> ClassLab {
        let before = self.folder.state().unwrap().unwrap_or_default();
        let mut lab = ClassLab::new(Teacher::new(self.folder.clone(), before), SMALL);
        lab.stage.lesson(&self.lesson(), page);
        lab.pass();
        lab
    }

    fn sit(&self, name: &str) -> ClassLab {
        let (seat, _) = login::claim(&self.folder, name, 0).unwrap();
        self.sit_again(seat)
    }

    fn sit_again(&self, seat: Seat) -> ClassLab {
        let token = seat.hold().unwrap();
        let record = seat.record().unwrap();
        let student = Student::new(self.folder.clone(), seat, token, record);
        ClassLab::new(student, SMALL)
    }

    fn project(&self) -> ClassLab {
        ClassLab::new(Projector::new(self.folder.clone()), SMALL)
    }

    /// Returns the votes without the lesson and the columns after `late`.
    fn votes(&self) -> Vec<String> {
        let seats = seat_statuses(&self.folder).unwrap();
        let csv = votes::csv(&self.folder, &seats).unwrap();
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let records = reader.records().map(Result::unwrap);
        records
            .map(|row| {
                let (name, _) = row[3].split_once('-').unwrap();
                format!("{} {} {name} {} {}", &row[1], &row[2], &row[4], &row[5])
            })
            .collect()
    }
}

struct ClassLab {
    stage: Stage,
    role: Box<dyn ClassRole>,
}

impl ClassLab {
    fn new(role: impl ClassRole + 'static, size: Rect) -> Self {
        Self {
            stage: Stage::open("method-2", &[], size),
            role: Box::new(role),
        }
    }

    /// Advances the clock by a third of a second.
    fn pass(&mut self) -> &mut Self {
        let Stage {
            lab,
            class,
            now,
            size,
            ..
        } = &mut self.stage;
        *now += Duration::from_millis(350);
        let mut looks = 0;
        let mut clock = || {
            looks += 1;
            *now + Duration::from_micros(50) * looks
        };
        lab.advance(&mut clock);
        let _ = self.role.advance(*now, lab, class);
        class.update(*now, lab);
        screen::refit(lab, *size);
        self
    }

    /// Handles `keys` like the main loop.
    fn press(&mut self, keys: &str) -> &mut Self {
        for c in keys.chars() {
            let key = match c {
                '\n' => Key::Enter,
                '\u{1b}' => Key::Esc,
                '↓' => Key::Down,
                c => Key::Char(c),
            };
            let Stage {
                lab, class, size, ..
            } = &mut self.stage;
            let request = press(key, lab);
            match request {
                Some(LabRequest::Lesson(meant))
                    if !app::scrolls_page(meant, lab, *size)
                        && self.role.intercept(meant, lab, class) => {}
                Some(LabRequest::Class) => self.role.on_class_key(lab, class),
                Some(other) => drop(app::do_in_class(other, lab, class, *size)),
                None => {}
            }
            self.role.after_keys(lab, class);
            self.pass();
        }
        self
    }

    #[track_caller]
    fn shows(&mut self, words: &str) -> &mut Self {
        has(single_spaced(&self.stage.picture()), words);
        self
    }

    #[track_caller]
    fn shows_no(&mut self, words: &str) -> &mut Self {
        has_no(single_spaced(&self.stage.picture()), words);
        self
    }
}

fn single_spaced(picture: &str) -> String {
    picture.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Advances all `labs`, the teacher's first, until each has seen the changes of the others.
fn settle(labs: &mut [&mut ClassLab]) {
    for _ in 0..4 {
        sleep(Duration::from_millis(6)); // longer than the resolution of file times
        for lab in &mut *labs {
            lab.pass();
        }
    }
}

fn settle_with(teacher: &mut ClassLab, seats: &mut [ClassLab], projector: &mut ClassLab) {
    let mut labs = vec![teacher];
    labs.extend(seats);
    labs.push(projector);
    settle(&mut labs);
}

#[test]
fn next_asks_for_confirmation_while_votes_are_missing() {
    let class = Class::new();
    let (mut teacher, mut anna, mut ben) = (class.teach(2), class.sit("anna"), class.sit("ben"));
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    anna.shows("following · 2 of 4").press("1\n");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    teacher.press("n");
    teacher.shows("1 of 2 have answered; press n again to go on");
    teacher.press("w").press("n"); // after another key, it asks again
    teacher
        .shows("1 of 2 have answered; press n again")
        .shows("The question");
    teacher.press("n").shows("The run");
    // It does not ask if everyone has answered.
    teacher.press("N");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    ben.press("2\n");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    teacher.press("n").shows("The run");
}

#[test]
fn next_asks_for_confirmation_while_a_run_plays() {
    let class = Class::new();
    let mut teacher = class.teach(3);
    teacher.pass();
    teacher.press("n");
    teacher.shows("the run is still playing for the class; press n again to jump to its end");
    teacher.shows_no("It was run.");
    teacher.press("n").shows("It was run.");
    teacher.press("n").shows("Nothing more.");
    teacher.press(" ").press("N").shows("The run");
    // A teacher whose class works on its own is not asked.
    teacher.press("k3").press("n").shows("It was run.");
}

#[test]
fn a_marked_answer_counts_when_the_teacher_turns_the_page() {
    let class = Class::new();
    let (mut teacher, mut anna, mut ben) = (class.teach(2), class.sit("anna"), class.sit("ben"));
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    anna.press("3");
    // A student who turns the page without the class leaves the answer open.
    ben.press("1nn").shows("left, k: rejoin · 3");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    assert!(class.votes().is_empty());
    teacher.press("nn");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    assert_eq!(class.votes(), ["q 1 anna 3 false"]);
    anna.shows("following · 3 of 4");
}

#[test]
fn a_marked_answer_counts_when_its_round_is_closed_or_asked_again() {
    let class = Class::new();
    let (mut teacher, mut anna) = (class.teach(2), class.sit("anna"));
    settle(&mut [&mut teacher, &mut anna]);
    anna.press("3");
    teacher.press("k1k1k1");
    settle(&mut [&mut teacher, &mut anna]);
    assert_eq!(class.votes(), ["q 1 anna 3 false"]);
    anna.shows("the round is over: your answer 3 counts");
    teacher.press("k2");
    settle(&mut [&mut teacher, &mut anna]);
    anna.press("1");
    teacher.press("k2");
    settle(&mut [&mut teacher, &mut anna]);
    assert_eq!(class.votes(), ["q 1 anna 3 false", "q 2 anna 1 false"]);
    anna.shows("Round 3: your teacher asks again.");
    // The mark of the previous round does not count in this one.
    teacher.press("nn");
    settle(&mut [&mut teacher, &mut anna]);
    assert_eq!(class.votes().len(), 2);
}

#[test]
fn a_marked_answer_survives_the_end_of_the_teachers_lab() {
    let class = Class::new();
    let (mut teacher, mut anna) = (class.teach(2), class.sit("anna"));
    settle(&mut [&mut teacher, &mut anna]);
    anna.press("3");
    drop(teacher); // like a kill, without a farewell
    sleep(Duration::from_millis(4100));
    anna.pass().pass().shows("the teacher's lab is gone");
    assert!(class.votes().is_empty());
    let mut again = class.teach(2);
    settle(&mut [&mut again, &mut anna]);
    again.press("nn");
    settle(&mut [&mut again, &mut anna]);
    assert_eq!(class.votes(), ["q 1 anna 3 false"]);
}

#[test]
fn a_seat_without_a_class_waits_and_hides_the_run() {
    let class = Class::new();
    let (mut anna, mut ben) = (class.sit("anna"), class.sit("ben"));
    for size in [SMALL, LARGE] {
        anna.stage.size = size;
        anna.pass();
        anna.shows("Your seat is anna-")
            .shows("The class starts here when your teacher starts it.");
        anna.shows("Why does it not fall?");
        for words in ["reliable", "checking", "45.00", "exact", "dt 0.1"] {
            anna.shows_no(words);
        }
    }
    // Homework can be a lesson or a free lab.
    ben.pass()
        .press("\u{1b}")
        .shows("Method 2")
        .shows("press k to return to the waiting page");
    ben.press("k")
        .shows("The class starts here")
        .press("\n")
        .shows("n next");
    let mut teacher = class.teach(2);
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    anna.shows("following · 2 of 4");
    ben.shows("the class is on: press k to join it")
        .shows("left, k: rejoin");
    ben.press("k");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    ben.shows("following · 2 of 4").shows("What happens next?");
    // The page remains after the class has ended.
    teacher.role.leave().unwrap();
    settle(&mut [&mut anna, &mut ben]);
    anna.shows("the class is over: press n or N to turn pages")
        .shows("class over · 2 of 4");
}

#[test]
fn a_free_lab_keeps_showing_that_the_class_is_on() {
    let class = Class::new();
    let mut anna = class.sit("anna");
    anna.pass().press("\u{1b}");
    let mut teacher = class.teach(1);
    settle(&mut [&mut teacher, &mut anna]);
    anna.press("w");
    settle(&mut [&mut teacher, &mut anna]);
    anna.stage.now += Duration::from_secs(6);
    settle(&mut [&mut teacher, &mut anna]);
    anna.shows("the class is on: press k to join it");
    anna.press("k");
    settle(&mut [&mut teacher, &mut anna]);
    anna.shows("following · 1 of 4");
}

#[test]
fn the_teacher_gathers_students_who_have_left() {
    let class = Class::new();
    let (mut teacher, mut anna, mut ben) = (class.teach(1), class.sit("anna"), class.sit("ben"));
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    anna.press("n").shows("left, k: rejoin · 2");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    teacher.shows("1 not following").press("k5");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    anna.shows("following · 1 of 4")
        .shows("your teacher has gathered the class");
    teacher.shows("2 here").shows_no("not following");
    // A student who had left when the line dropped is gathered on reconnecting.
    ben.press("n");
    settle(&mut [&mut teacher, &mut anna, &mut ben]);
    let seat = seat_statuses(&class.folder).unwrap().remove(1).seat;
    drop(ben);
    sleep(Duration::from_millis(2));
    teacher.press("k5");
    let mut again = class.sit_again(seat);
    settle(&mut [&mut teacher, &mut again]);
    again.shows("following · 1 of 4");
}

#[test]
fn students_working_on_their_own_are_told_and_regathered() {
    let class = Class::new();
    let (mut teacher, mut anna, mut projector) =
        (class.teach(1), class.sit("anna"), class.project());
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    teacher.press("k3");
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    anna.shows("you now work on your own: press n or N to turn pages");
    anna.press("n").shows("alone · 2 of 4 · class on 1");
    teacher.press("nn");
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    projector.shows("2 of 4"); // the projector follows the teacher
    anna.press("N").shows("alone · 1 of 4 · class on 2");
    teacher.press("k3");
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    anna.shows("following · 2 of 4");
}

#[test]
fn the_projector_hides_what_is_for_the_teacher() {
    let class = Class::new();
    let mut projector = class.project();
    projector
        .pass()
        .shows("The class has not begun.")
        .shows_no("Method 2");
    let mut teacher = class.teach(2);
    let names = ["anna", "ben", "carl", "dora", "emil"];
    let mut seats = names.map(|name| class.sit(name));
    for seat in &mut seats {
        settle(&mut [&mut teacher, seat]);
    }
    settle_with(&mut teacher, &mut seats, &mut projector);
    projector
        .shows("What happens next?")
        .shows("0 of 5 have answered");
    seats[0].press("1\n");
    settle_with(&mut teacher, &mut seats, &mut projector);
    projector.shows("1 of 5 have answered").shows_no("━");
    for seat in &mut seats[1..] {
        seat.press("2\n");
    }
    teacher.press("k1");
    settle_with(&mut teacher, &mut seats, &mut projector);
    teacher.shows("right is 2, 80 % chose it: go on");
    projector.shows("5 of 5 have answered").shows_no("━");
    teacher.press("k1");
    settle_with(&mut teacher, &mut seats, &mut projector);
    projector.shows("2 ━━━━━━━━━━━━━━━━━━━━━━━━━━━━ 4");
    seats[0].shows("2 ━━━━━━━━━━━━━━━━━━━━━━━━━━━━ 4");
    // The bars remain after the round is closed.
    teacher.press("k1");
    settle_with(&mut teacher, &mut seats, &mut projector);
    projector
        .shows("5 of 5 have answered · closed")
        .shows("━ 4");
    for words in ["right", "note", "anna", "choose", "Locked", "seat"] {
        let other = projector.stage.picture().replace("the right way", "");
        has_no(other, words);
    }
    // The run is shown while it plays, and then the page.
    teacher.press("n");
    for _ in 0..4 {
        settle_with(&mut teacher, &mut seats, &mut projector);
    }
    projector.shows("It was run.").shows("t 3.0 s");
}

#[test]
fn a_countdown_is_shown_to_everyone_and_can_be_stopped() {
    let class = Class::new();
    let (mut teacher, mut anna, mut projector) =
        (class.teach(2), class.sit("anna"), class.project());
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    anna.press("3");
    teacher.press("k6");
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    teacher.shows("30 s left");
    anna.shows("the round closes in 30 s");
    projector.shows("30 s left · 0 of 1 have answered");
    teacher
        .press("k")
        .shows("stop the countdown: 30 s left")
        .press("6");
    settle(&mut [&mut teacher, &mut anna, &mut projector]);
    for lab in [&mut teacher, &mut anna, &mut projector] {
        lab.shows_no("closes in").shows_no("s left");
    }
    // Ends the countdown without waiting: the resumed teacher's lab reads this state.
    let mut state = class.folder.state().unwrap().unwrap();
    let question = state.questions.get_mut(&class.lesson()).unwrap();
    question.get_mut("q").unwrap().closes_at_ms = Some(1);
    class.folder.publish(&state).unwrap();
    let mut resumed = class.teach(2);
    settle(&mut [&mut resumed, &mut anna, &mut projector]);
    resumed.shows("closed");
    projector.shows("1 of 1 have answered · closed");
    assert_eq!(class.votes(), ["q 1 anna 3 false"]);
}

#[test]
fn seats_without_an_answer_come_first_and_lists_scroll() {
    let class = Class::new();
    let mut teacher = class.teach(2);
    let mut seats: Vec<_> = (10..40)
        .map(|number| class.sit(&format!("s{number}")))
        .collect();
    for seat in seats.iter_mut().take(28) {
        settle(&mut [&mut teacher, seat]);
        seat.press("2\n");
    }
    settle(&mut [&mut teacher]);
    teacher.press("k4").shows("> s38-").shows_no("s37-");
    let lines = board::lines(&class.folder, 80);
    let at = |word: &str| lines.iter().position(|line| line.contains(word)).unwrap();
    assert!(
        at("s38-") < at("s10-") && at("s39-") < at("s10-"),
        "{lines:?}"
    );
    has(&lines[at("s38-")], "not answered");
    // The selected row stays visible and selected when the order changes.
    teacher
        .press(&"↓".repeat(29))
        .shows("> s37-")
        .shows_no("s38-");
    settle(&mut [&mut teacher, &mut seats[28]]);
    seats[28].press("1\n");
    settle(&mut [&mut teacher, &mut seats[28]]);
    teacher.shows("> s37-").press("\n");
    let state = class.folder.state().unwrap().unwrap();
    assert!(
        state.closed.iter().all(|word| word.starts_with("s37-")),
        "{:?}",
        state.closed
    );
    assert_eq!(state.closed.len(), 1);
}

#[test]
fn a_new_group_starts_without_seats_and_archives_the_old_ones() {
    let class = Class::new();
    let (mut teacher, mut anna) = (class.teach(2), class.sit("anna"));
    settle(&mut [&mut teacher, &mut anna]);
    anna.press("2\n");
    teacher.role.leave().unwrap();
    anna.role.leave().unwrap();
    let kept = class.folder.keep_as_earlier("2026-11-28").unwrap().unwrap();
    assert_eq!(kept, class.folder.root.join(".gyrolab/earlier/2026-11-28"));
    let earlier = ClassFolder::at(&kept).unwrap();
    let csv = votes::csv(&earlier, &seat_statuses(&earlier).unwrap()).unwrap();
    has(csv, ",q,1,anna-");
    assert!(class.votes().is_empty());
    assert_eq!(class.folder.state().unwrap(), None);
    assert_eq!(class.folder.keep_as_earlier("2026-11-29").unwrap(), None);
    ClassFolder::open(class.dir.path()).unwrap();
    class.folder.make_teacher().unwrap();
    let mut again = class.teach(1);
    again.shows("0 here");
}

#[test]
fn simulated_students_answer_leave_and_are_gathered() {
    let class = Class::new();
    let mut teacher = class.teach(2);
    let players = Players::start(&class.folder, 4).unwrap();
    let begin = Instant::now();
    while class.votes().len() < 2 || !teacher.stage.picture().contains("not following") {
        assert!(
            begin.elapsed() < Duration::from_secs(30),
            "{:?}",
            class.votes()
        );
        sleep(Duration::from_millis(100));
        teacher.pass();
    }
    teacher.press("n").shows("have answered; press n again");
    teacher.press("k5");
    while teacher.stage.picture().contains("not following") {
        assert!(begin.elapsed() < Duration::from_secs(40));
        sleep(Duration::from_millis(100));
        teacher.pass();
    }
    drop(players);
    let seats = seat_statuses(&class.folder).unwrap();
    assert_eq!(seats.len(), 4);
    assert!(
        seats
            .iter()
            .all(|seat| seat.seat.word.starts_with("player"))
    );
}

#[test]
fn only_the_teacher_can_read_the_notes() {
    let class = Class::new();
    let (mut teacher, mut anna) = (class.teach(2), class.sit("anna"));
    settle(&mut [&mut teacher, &mut anna]);
    let Stage {
        lab,
        class: lessons,
        ..
    } = &mut anna.stage;
    assert!(anna.role.intercept(LessonKey::Notes, lab, lessons));
    anna.pass()
        .shows("the notes are only for the teacher")
        .shows_no("This note");
}
