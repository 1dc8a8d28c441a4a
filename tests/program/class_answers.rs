//! The answers of a class after it has ended: the gradebook table, and students who download their answers over SSH.

use crate::support::ground::{Ground, code, done, stderr, stdout};
use crate::support::words::has_all;
use std::collections::BTreeMap;
use std::fs;

const LESSON: &str = "is-the-wobble-real";
const RIGHT: &str = "is more than a hundred times smaller";
const WRONG: &str = "is larger";

/// Creates the seat `word` with locked `answers` to the first question: round, words, and whether it came late. `tasks` are
/// lines of TOML.
fn seat(ground: &Ground, word: &str, answers: &[(u32, &str, bool)], tasks: &str) {
    seat_that_saw("\"finer\"", ground, word, answers, tasks);
}

/// Creates a seat, as `seat` does, that has seen the outcomes of the questions `seen`: quoted, separated by commas.
fn seat_that_saw(
    seen: &str,
    ground: &Ground,
    word: &str,
    answers: &[(u32, &str, bool)],
    tasks: &str,
) {
    let mut text = format!("format = 2\n[lessons.lessons.{LESSON}]\npage = 3\nseen = [{seen}]\n");
    for (round, answer, late) in answers {
        text += &format!(
            "[[lessons.lessons.{LESSON}.predictions.finer]]\nround = {round}\nanswer = \"{answer}\"\n\
             late = {late}\npage = 2\ntime_unix_s = 1800000000\n"
        );
    }
    text += &format!("[lessons.lessons.{LESSON}.tasks]\n{tasks}");
    let inner = format!(".gyrolab/seats/{word}/.gyrolab");
    fs::create_dir_all(ground.file(&inner)).unwrap();
    ground.write(&format!("{inner}/seat"), &text);
}

/// Parses the rows of a CSV, each as a map from column names to values.
fn rows(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.deserialize().map(Result::unwrap).collect()
}

#[test]
fn the_table_has_a_row_for_each_seat() {
    let ground = Ground::new();
    let empty = ground.stdout("class --table --folder .");
    assert_eq!(
        empty,
        "username,seat,questions_answered,questions_right,answers_late,tasks_done,tasks_shown\n"
    );
    let changed_their_mind = [(1, WRONG, false), (2, RIGHT, false)];
    seat(
        &ground,
        "anna-471108",
        &changed_their_mind,
        "\"Your turn\" = \"done\"\n",
    );
    seat(&ground, "ben-000001", &[(1, RIGHT, true)], "");
    seat(
        &ground,
        "cleo-000002",
        &[(1, RIGHT, false), (2, WRONG, false)],
        "\"Your turn\" = \"shown\"\n",
    );
    let table = rows(&ground.stdout("class --table --folder ."));
    let column = |name: &str| -> Vec<&str> { table.iter().map(|row| row[name].as_str()).collect() };
    assert_eq!(column("username"), ["anna", "ben", "cleo"]);
    assert_eq!(column("questions_answered"), ["1", "0", "1"]);
    assert_eq!(column("questions_right"), ["1", "0", "0"]);
    assert_eq!(column("answers_late"), ["0", "1", "0"]);
    assert_eq!(column("tasks_done"), ["1", "0", "0"]);
    assert_eq!(column("tasks_shown"), ["0", "0", "1"]);
    assert_eq!(column(&format!("{LESSON}: finer, round 1")), ["4", "", "3"]);
    assert_eq!(column(&format!("{LESSON}: finer, round 2")), ["3", "", "4"]);
    let task = format!("{LESSON}: task \"Your turn\"");
    assert_eq!(column(&task), ["done", "", "shown by the lab"]);
}

/// Runs the login of the class like sshd for `ssh class@HOST COMMAND`.
fn ssh(ground: &Ground, command: &str) -> std::process::Output {
    let mut login = ground.command("--folder . --seat");
    login.env("SSH_ORIGINAL_COMMAND", command).output().unwrap()
}

#[test]
fn a_student_can_download_only_their_own_answers() {
    let ground = Ground::new();
    seat(&ground, "anna-471108", &[(1, WRONG, false)], "");
    let answers = done(ssh(&ground, "answers anna-471108"));
    has_all(
        stdout(&answers),
        &[
            "seat anna-471108",
            "**Predicted.** is larger",
            "**Came out.**",
        ],
    );
    seat_that_saw("", &ground, "ben-000001", &[(1, WRONG, false)], "");
    let not_seen = done(ssh(&ground, "answers ben-000001"));
    has_all(
        stdout(&not_seen),
        &[
            "**Predicted.** is larger",
            "You have not seen this page yet",
        ],
    );
    assert!(!stdout(&not_seen).contains(RIGHT), "it tells the answer");
    for (command, message) in [
        ("answers", "answers SEAT"),
        ("answers anna", "the word of your seat"),
        ("answers anna-000000", "no seat of that word"),
        ("answers ../anna-471108", "the word of your seat"),
        ("cat /etc/passwd", "answers SEAT"),
        ("", "answers SEAT"),
    ] {
        let output = ssh(&ground, command);
        assert_eq!(code(&output), 1, "{command}");
        assert!(stdout(&output).is_empty(), "{command}");
        has_all(stderr(&output), &[message]);
    }
}

#[test]
fn answers_cannot_be_downloaded_during_class() {
    let ground = Ground::new();
    seat(&ground, "anna-471108", &[(1, WRONG, false)], "");
    let mut teacher = ground.open(&format!("class {LESSON} --folder ."));
    teacher.wait_for("1 of 10");
    let output = ssh(&ground, "answers anna-471108");
    assert!(stdout(&output).is_empty());
    has_all(stderr(&output), &["a class is running"]);
    teacher.quit();
    done(ssh(&ground, "answers anna-471108"));
}
