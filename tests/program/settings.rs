//! Settings: the lab remembers choices, and the user's own file overrides them. The real program runs in a pty.

use crate::support::ground::{Ground, stdout};
use crate::support::pty::Terminal;
use crate::support::words::has_all;
use std::fs;
use std::path::PathBuf;

const PLAIN: [&str; 2] = ["method-2", "--paused"];
const BLUE: &str = "\u{1b}[38;";

/// Returns the path of the settings file that the program writes.
fn settings_file(ground: &Ground) -> PathBuf {
    ground.state().join("gyrolab/settings.toml")
}

fn configure(ground: &Ground, text: &str) {
    fs::create_dir_all(ground.config().join("gyrolab")).unwrap();
    fs::write(ground.config().join("gyrolab/config.toml"), text).unwrap();
}

fn open(ground: &Ground, args: &[&str]) -> Terminal {
    let lab = ground.open(&[&PLAIN, args].concat());
    lab.wait_for("L lessons");
    lab
}

fn is_ascii(lab: &Terminal) -> bool {
    lab.screen().contains("--") && !lab.screen().contains('─')
}

fn has_colors(lab: &Terminal) -> bool {
    lab.sent_text().contains(BLUE)
}

#[test]
fn choices_are_restored_at_the_next_start() {
    let ground = Ground::new();
    let mut lab = open(&ground, &[]);
    assert!(!is_ascii(&lab) && has_colors(&lab));
    lab.ask("c\x1b[B\x1b[B\x1b[B\x1b[D", "markers ascii");
    lab.ask("\x1b[B\x1b[D", "colors off");
    lab.ask("\x1b[B\x1b[B\r", "frames per second 30 at most");
    lab.ask("\x1b", "L lessons");
    lab.quit();
    let text = fs::read_to_string(settings_file(&ground)).unwrap();
    has_all(
        &text,
        ["marker = \"ascii\"", "color = \"never\"", "fps = 30"],
    );
    assert_eq!(ground.mode("state/gyrolab/settings.toml"), 0o600);
    for args in [&[][..], &["--resume"]] {
        let mut again = match args {
            [] => open(&ground, &[]),
            args => ground.open(args),
        };
        again.wait_for("L lessons");
        assert!(
            is_ascii(&again) && !has_colors(&again),
            "{}",
            again.screen()
        );
        again.quit();
    }
    // Options override remembered choices.
    let mut with_options = open(&ground, &["--markers", "braille", "--color", "always"]);
    assert!(!is_ascii(&with_options) && has_colors(&with_options));
    with_options.quit();
    // A printed picture does not depend on remembered choices.
    let shown = ground.run("show method-2");
    assert!(stdout(&shown).contains('─'));
}

#[test]
fn the_users_own_file_takes_precedence_and_is_never_written() {
    let ground = Ground::new();
    let text = "marker = 'ascii'\ncolour = 'never' # mine\nfps = 5\n";
    configure(&ground, text);
    let mut lab = open(&ground, &[]);
    assert!(is_ascii(&lab) && !has_colors(&lab));
    lab.ask("c\x1b[B\x1b[B\x1b[B\r", "markers braille");
    lab.ask("\x1b", "L lessons");
    lab.quit();
    assert!(
        fs::read_to_string(settings_file(&ground))
            .unwrap()
            .contains("braille")
    );
    let mut again = open(&ground, &[]);
    assert!(is_ascii(&again), "{}", again.screen());
    again.quit();
    let file = ground.config().join("gyrolab/config.toml");
    assert_eq!(fs::read_to_string(file).unwrap(), text);
    let shown = ground.run("show method-2");
    assert!(stdout(&shown).contains('─'));
}

#[test]
fn broken_settings_are_reported_and_the_lab_still_opens() {
    let ground = Ground::new();
    configure(
        &ground,
        "marker = 'ascii'\nfbs = 5\ncolor = 'never'\nmouse = 1\n",
    );
    let mut lab = open(&ground, &[]);
    lab.wait_for("config.toml:2: fbs: unknown key: did you mean fps?; config.toml:4: mouse");
    lab.wait_for("ignored; correct the file");
    assert!(!has_colors(&lab));
    assert!(is_ascii(&lab));
    lab.quit();
    assert!(lab.sent_text().contains("gyrolab/config.toml:2: fbs"));
    configure(&ground, "");

    let folder = ground.state().join("gyrolab");
    fs::create_dir_all(&folder).unwrap();
    for text in ["marker = [", "marker = 'dots'", "\u{1b}]0;x\u{7}"] {
        fs::write(folder.join("settings.toml"), text).unwrap();
        let mut broken = open(&ground, &[]);
        broken.wait_for("settings.toml:1: ");
        broken.wait_for("ignored until you choose it again");
        broken.ask("c\x1b[B\x1b[B\x1b[B\r\r", "markers half-block");
        broken.ask("\x1b", "L lessons");
        broken.quit();
        let mut mended = open(&ground, &[]);
        assert!(
            !mended.words().contains("ignored until"),
            "{}",
            mended.screen()
        );
        mended.quit();
        fs::remove_file(folder.join("settings.toml")).unwrap();
    }
}

#[test]
fn a_confined_lab_uses_only_the_settings_in_its_folder() {
    let ground = Ground::new();
    configure(&ground, "marker = 'ascii'\n");
    fs::create_dir(ground.file("inside")).unwrap();
    let mut lab = open(&ground, &["--folder", "inside"]);
    assert!(!is_ascii(&lab));
    lab.ask("c\x1b[B\x1b[B\x1b[B\r\r", "markers half-block");
    lab.ask("\x1b", "L lessons");
    lab.quit();
    let kept = ground.read("inside/.gyrolab/settings.toml");
    assert!(
        kept.contains("half-block") && !settings_file(&ground).exists(),
        "{kept}"
    );
}

#[test]
fn markers_remembered_from_a_better_terminal_are_ignored() {
    let ground = Ground::new();
    let mut lab = open(&ground, &["--markers", "ascii"]);
    lab.ask("c\x1b[B\x1b[B\x1b[B\r", "markers braille");
    lab.ask("\x1b", "L lessons");
    lab.quit();
    let mut plain = ground.open_with(&PLAIN, &[("TERM", "xterm"), ("LANG", "C")]);
    plain.wait_for("L lessons");
    assert!(is_ascii(&plain));
    plain.quit();
}
