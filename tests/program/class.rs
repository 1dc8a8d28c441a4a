//! A class in ptys: following, voting, and recovery after labs are killed.

use crate::support::dice::Dice;
use crate::support::ground::{Ground, code, stderr};
use crate::support::pty::Terminal;
use crate::support::words::has_all;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

const LESSON: &str = "is-the-wobble-real";

fn open_teacher(ground: &Ground, args: &str) -> Terminal {
    ground.open(&format!("class {args} --folder ."))
}

/// Opens the teacher's lab and plays the run of its first page to the end.
fn begin_class(ground: &Ground) -> Terminal {
    let mut teacher = open_teacher(ground, LESSON);
    teacher.wait_for("1 of 10");
    teacher.wait_for("► ×10");
    teacher.ask(
        "n",
        "the run is still playing for the class; press n again to jump to its end",
    );
    teacher.ask("n", "that wobbles?");
    teacher
}

/// Opens a student's lab in a new seat. Returns it with the seat's word.
fn take_seat(ground: &Ground, name: &str) -> (Terminal, String) {
    let mut lab = ground.open("--folder . --seat");
    lab.wait_for("A name for your seat");
    lab.ask(&format!("{name}\r"), "Press Enter to continue.");
    let words = lab.words();
    let (_, word) = words.split_once("Your seat is ").unwrap();
    let word = word.split(':').next().unwrap().to_owned();
    lab.press("\r");
    lab.wait_for("following · 1 of 10");
    (lab, word)
}

/// Votes for the second choice.
fn cast_vote(lab: &mut Terminal) {
    lab.wait_for("1 2 3 4 or ↑ ↓ choose");
    lab.ask("2", "lock this prediction");
    lab.ask("\r", "2 is about fifty times smaller you");
}

#[test]
fn a_class_follows_the_teacher_votes_and_loses_nothing() {
    let ground = Ground::new();
    let header = "lesson,question,round,seat,choice,late,page,time\n";
    assert_eq!(ground.stdout("class --votes --folder ."), header);
    let mut teacher = begin_class(&ground);
    let (mut anna, word) = take_seat(&ground, "anna");
    let (mut ben, _) = take_seat(&ground, "ben");
    teacher.wait_for("2 here");
    teacher.press("n");
    for lab in [&mut anna, &mut ben] {
        lab.wait_for("following · 2 of 10");
    }
    cast_vote(&mut anna);
    anna.kill();
    teacher.wait_for("round 1 · 1 of 2");
    let votes = ground.stdout("class --votes --folder .");
    has_all(&votes, &[&format!("{LESSON},finer,1,{word},2,false,2,")]);
    // A student leaves while the class continues.
    ben.ask("n", "write down a prediction");
    ben.ask("n", "left, k: rejoin · 3, class on 2");
    teacher.ask("n", "1 of 2 have answered; press n again to go on");
    teacher.press("n");
    ben.wait_for("class on 3");
    teacher.press("N");
    ben.wait_for("class on 2");
    ben.ask("k", "following · 2 of 10");
    // The seat's word reopens the seat, with its page and prediction.
    let mut back = ground.open("--folder . --seat");
    back.ask(&format!("{word}\r"), "following · 2 of 10");
    back.wait_for("2 is about fifty times smaller you");
    // When the seat is opened elsewhere, the earlier lab ends.
    let mut again = ground.open("--folder . --seat");
    again.ask(&format!("{word}\r"), "following · 2 of 10");
    back.wait_for_end();
    assert!(back.sent_text().contains("opened in another lab"));
    // A second round, during which the teacher's lab is killed.
    teacher.ask("k", "ask again: round 2");
    teacher.press("2");
    cast_vote(&mut again);
    teacher.wait_for("round 2 · 1 of 2");
    teacher.kill();
    ben.wait_for("the teacher's lab is gone: press n or N to turn pages");
    let mut resumed = open_teacher(&ground, "--resume");
    resumed.wait_for("2 of 10");
    resumed.wait_for("round 2 · 1 of 2");
    ben.wait_for("following · 2 of 10");
    resumed.ask("n", "1 of 2 have answered; press n again to go on");
    resumed.press("n");
    again.wait_for("following · 3 of 10");
    let board = ground.stdout("class --board --folder .");
    has_all(&board, &["2 here", &word, "3 of 10"]);
    resumed.end_class();
    ben.wait_for("the class is over");
    // Starting the class a second time by mistake must not send everyone back to the first page.
    let mut mistaken = open_teacher(&ground, LESSON);
    mistaken.wait_for_end();
    let said = mistaken.sent_text();
    assert!(said.contains("--resume without the lesson"), "{said}");
    ground.stdout("class --answers --folder . -o answers");
    let answers = ground.read(&format!("answers/{word}.md"));
    has_all(&answers, &["**Predicted.** is about fifty times smaller"]);
}

#[test]
fn a_seat_cannot_access_the_files_of_another() {
    let ground = Ground::new();
    ground.write("secret.csv", "t_s,x_m\n0,1\n");
    let mut teacher = begin_class(&ground);
    let (mut anna, word) = take_seat(&ground, "anna");
    anna.press("x");
    for name in ["../ben-0001/run.csv", "/tmp/run.csv", ".gyrolab/seat"] {
        anna.press(&format!("\x15{name}\r"));
        anna.wait_until("a refusal", |lab| {
            let words = lab.words();
            words.contains("stays in its folder") || words.contains("reserved for the lab")
        });
    }
    anna.press("\x15mine.csv\r");
    anna.wait_for("mine.csv: your teacher has it");
    let seat = ground.file(&format!(".gyrolab/seats/{word}/mine.csv"));
    assert!(seat.exists());
    // The teacher closes the seat.
    teacher.ask("k", "list the seats");
    teacher.ask("4", &format!("{word}: here"));
    teacher.press("\r");
    anna.wait_for_end();
    assert!(anna.sent_text().contains("closed this seat"));
    let mut again = ground.open("--folder . --seat");
    again.ask(&format!("{word}\r"), "this seat is closed");
}

#[test]
#[ignore = "thirty labs and two hundred kills take minutes"]
fn two_hundred_kills_lose_no_votes_or_pages_of_thirty_seats() {
    let ground = Ground::new();
    let mut teacher = begin_class(&ground);
    let mut seats: Vec<_> = (0..30)
        .map(|number| take_seat(&ground, &format!("seat{number}")))
        .collect();
    teacher.press("n");
    for (lab, _) in &mut seats {
        cast_vote(lab);
    }
    let mut dice = Dice(7);
    let mut page = 2;
    for kill in 0..200 {
        if kill % 20 == 19 {
            teacher.kill();
            teacher = open_teacher(&ground, "--resume");
            teacher.wait_for(&format!("{page} of 10"));
        } else {
            let (lab, word) = &mut seats[dice.whole(0, 29) as usize];
            lab.kill();
            *lab = ground.open("--folder . --seat");
            lab.ask(&format!("{word}\r"), &format!("following · {page} of 10"));
        }
        if kill % 50 == 25 {
            page = 5 - page;
            teacher.press(if page == 3 { "n" } else { "N" });
            for (lab, _) in &seats {
                lab.wait_for(&format!("following · {page} of 10"));
            }
        }
    }
    let votes = ground.stdout("class --votes --folder .");
    assert_eq!(
        votes.matches(&format!("{LESSON},finer,1,")).count(),
        30,
        "{votes}"
    );
}

#[test]
fn a_damaged_seat_is_named_with_exit_code_1() {
    let ground = Ground::new();
    let seats = ground.path().join(".gyrolab/seats");
    for (word, text) in [("anna-471108", "format = "), ("ben-000001", "format = 2\n")] {
        let inner = seats.join(word).join(".gyrolab");
        fs::create_dir_all(&inner).unwrap();
        fs::write(inner.join("seat"), text).unwrap();
    }
    for what in ["--votes", "--board", "--answers -o out"] {
        let output = ground.run(&format!("class {what} --folder ."));
        assert_eq!(code(&output), 1, "{what}");
        has_all(
            stderr(&output),
            &["the file of the seat anna-471108: is damaged"],
        );
        assert!(!stderr(&output).contains("ben"), "{what}");
    }
}

#[test]
#[ignore = "two hundred kills take minutes"]
fn two_hundred_kills_during_a_vote_lose_no_locked_votes() {
    let ground = Ground::new();
    let mut teacher = begin_class(&ground);
    let mut seats: Vec<_> = (0..5)
        .map(|number| take_seat(&ground, &format!("seat{number}")))
        .collect();
    teacher.press("n");
    for (lab, _) in &seats {
        lab.wait_for("following · 2 of 10");
    }
    let mut dice = Dice(11);
    let (mut locked, mut open, mut kills) = (0, 0, 0);
    for round in 1..=40 {
        for (lab, word) in &mut seats {
            lab.wait_for("1 2 3 4 or ↑ ↓ choose");
            if round > 1 {
                lab.wait_for(&format!("Round {round}: your teacher asks again."));
            }
            lab.press(&format!("{}\r", dice.whole(1, 4)));
            thread::sleep(Duration::from_millis(dice.whole(0, 60)));
            lab.kill();
            kills += 1;
            // A vote that the screen showed as locked was saved.
            let was_locked = !lab.words().contains("1 2 3 4 or ↑ ↓ choose");
            let row = format!("{LESSON},finer,{round},{word},");
            let votes = ground.stdout("class --votes --folder .");
            assert!(
                votes.contains(&row) || !was_locked,
                "{word}, round {round}:\n{votes}"
            );
            locked += u32::from(was_locked);
            open += u32::from(!votes.contains(&row));
            *lab = ground.open("--folder . --seat");
            lab.ask(&format!("{word}\r"), "following · 2 of 10");
            if !votes.contains(&row) {
                lab.wait_for("1 2 3 4 or ↑ ↓ choose");
                lab.press("2\r");
            }
            lab.wait_until("a locked vote", |lab| {
                !lab.words().contains("1 2 3 4 or ↑ ↓ choose")
            });
        }
        teacher.wait_for(&format!("round {round} · 5 of 5 answered"));
        teacher.ask("k", "ask again");
        teacher.press("2");
    }
    let votes = ground.stdout("class --votes --folder .");
    let rows = votes.matches(&format!("{LESSON},finer,")).count();
    assert_eq!(rows, 200, "{votes}");
    println!(
        "{kills} kills, {locked} after the vote was seen as locked, {open} before it was saved"
    );
}

#[test]
fn a_seat_and_the_projector_wait_for_the_class_and_follow_it() {
    let ground = Ground::new();
    let mut anna = ground.open("--folder . --seat");
    anna.wait_for("A name for your seat");
    anna.ask("anna\r", "Press Enter to continue.");
    anna.ask("\r", "The class starts here when your teacher starts it.");
    let mut projector = ground.open("class --projector --folder .");
    projector.wait_for("The class has not begun.");
    let mut teacher = begin_class(&ground);
    anna.wait_for("following · 1 of 10");
    projector.wait_for("1 of 10 · Is the wobble real?");
    teacher.press("n");
    projector.wait_for("0 of 1 have answered");
    // A marked answer counts when the teacher turns the page.
    anna.ask("3", "Enter lock this prediction");
    teacher.ask("n", "0 of 1 have answered; press n again to go on");
    teacher.press("n");
    projector.wait_for("3 of 10");
    anna.wait_for("following · 3 of 10");
    let votes = ground.stdout("class --votes --folder .");
    has_all(&votes, &[&format!("{LESSON},finer,1,anna-"), ",3,false,2,"]);
    // The projector ignores keys. Then the teacher's lab is restarted.
    projector.press("npLx");
    teacher.kill();
    projector.wait_for("waiting");
    let mut resumed = open_teacher(&ground, "--resume");
    resumed.wait_for("3 of 10");
    projector.wait_for("3 of 10 · Is the wobble real?");
    resumed.end_class();
    projector.wait_for("class is over");
    projector.quit();
    anna.quit();
}

#[test]
fn a_new_group_keeps_the_votes_of_the_previous_one() {
    let ground = Ground::new();
    let mut teacher = begin_class(&ground);
    let (mut anna, word) = take_seat(&ground, "anna");
    teacher.press("n");
    cast_vote(&mut anna);
    let refused = ground.run("class --new --folder .");
    assert_eq!(code(&refused), 1);
    has_all(stderr(&refused), &["a class is running in"]);
    teacher.end_class();
    anna.wait_for("the class is over");
    let kept = ground.run("class --new --folder .");
    assert_eq!(code(&kept), 0);
    let told = stderr(&kept);
    let (_, folder) = told.rsplit_once("--folder ").unwrap();
    let row = format!("{LESSON},finer,1,{word},2,false,2,");
    let earlier = ground.stdout(&format!("class --votes --folder {}", folder.trim()));
    has_all(&earlier, &[&row]);
    assert_eq!(ground.stdout("class --votes --folder .").lines().count(), 1);
    // A lab whose seat was open writes nothing into the new group.
    anna.wait_for_end();
    assert!(anna.sent_text().contains("this seat is gone"));
    assert!(!ground.file(&format!(".gyrolab/seats/{word}")).exists());
    let mut again = ground.open("--folder . --seat");
    again.ask(&format!("{word}\r"), "there is no seat of that word");
}

#[test]
fn a_rehearsal_leaves_no_files() {
    let ground = Ground::new();
    fs::create_dir(ground.path().join("full")).unwrap();
    ground.write("full/file.txt", "");
    let lines = [
        "class is-the-wobble-real --rehearse 31",
        "class is-the-wobble-real --rehearse 2 --new --folder .",
    ];
    for wrong in lines {
        assert_eq!(code(&ground.run(wrong)), 2, "{wrong}");
    }
    let mut refused = ground.open(&format!("class {LESSON} --rehearse 2 --folder full"));
    refused.wait_for("name an empty folder for the rehearsal");
    refused.wait_for_end();
    for end in ["q", "TERM"] {
        let mut teacher = ground.open(&format!("class {LESSON} --rehearse 2"));
        teacher.wait_for("A rehearsal with 2 players.");
        let words = teacher.words();
        let (_, rest) = words.split_once("--folder ").unwrap();
        let folder = rest.split([',', ' ']).next().unwrap().to_owned();
        teacher.wait_for("2 here");
        teacher.wait_for("that wobbles?");
        assert!(Path::new(&folder).is_dir(), "{folder}");
        teacher.press("n");
        teacher.wait_until("a vote", |lab| !lab.words().contains("0 of 2 answered"));
        let mut zoe = ground.open(&format!("--folder {folder} --seat"));
        zoe.wait_for("A name for your seat");
        zoe.ask("zoe\r", "Press Enter to continue.");
        zoe.ask("\r", "following · 2 of 10");
        if end == "q" {
            teacher.quit();
        } else {
            teacher.signal(end);
            teacher.wait_for_end();
        }
        zoe.wait_for_end();
        assert!(!Path::new(&folder).exists(), "{folder} after {end}");
    }
}
