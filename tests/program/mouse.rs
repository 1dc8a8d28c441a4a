//! The mouse in the real program: reports as a terminal sends them, and the modes that the terminal is left in.

use crate::support::ground::Ground;
use crate::support::pty::{LEAVES_ALTERNATE_SCREEN, Terminal};

const ON: &str = "\u{1b}[?1000h\u{1b}[?1002h\u{1b}[?1006h";
const OFF: &str = "\u{1b}[?1006l\u{1b}[?1002l\u{1b}[?1000l";
const CTRL_Z: &str = "\u{1a}";

/// The report of a press at the cell `x`, `y`, counted from 1.
fn press(x: u16, y: u16) -> String {
    format!("\u{1b}[<0;{x};{y}M\u{1b}[<0;{x};{y}m")
}

/// The first cell of `words` on the screen, counted from 1.
#[track_caller]
fn cell(lab: &Terminal, words: &str) -> (u16, u16) {
    let screen = lab.screen();
    let mut lines = screen.lines().zip(1..);
    let found = lines.find_map(|(line, y)| {
        let (before, _) = line.split_once(words)?;
        Some((before.chars().count() as u16 + 1, y))
    });
    found.unwrap_or_else(|| panic!("no {words} in\n{screen}"))
}

/// Whether the mouse was asked for and given back as often, and last given back before the screen was.
fn has_given_the_mouse_back(lab: &Terminal) {
    lab.has_given_the_terminal_back();
    let sent = lab.sent_text();
    assert!(!sent.contains("\u{1b}[?1003h"), "moves are not asked for");
    assert_eq!(sent.matches(ON).count(), sent.matches(OFF).count());
    assert!(sent.rfind(OFF) > sent.rfind(ON));
    assert!(sent.rfind(OFF) < sent.rfind(LEAVES_ALTERNATE_SCREEN));
}

#[test]
fn what_is_pressed_is_done() {
    let mut lab = Terminal::open("--paused --at 900");
    lab.wait_for("q quit");
    lab.wait_until("the mouse", |lab| lab.sent_text().contains(ON));
    // The traces: the cursor.
    lab.ask(&press(6, 18), "┌ step ");
    // A pane, by its frame.
    let (x, y) = cell(&lab, "parameters");
    lab.ask(&press(x, y), "parameters 1 of");
    // The timeline: its first column is the start.
    let (_, y) = cell(&lab, " 230 s");
    lab.press(&press(2, y));
    lab.wait_for_step(0);
    // The footer: a step, and the list of presets.
    let (x, y) = cell(&lab, ". step");
    lab.press(&press(x + 3, y));
    lab.wait_for_step(1);
    let (x, y) = cell(&lab, "o ?");
    lab.ask(&press(x, y), "/ filters by name");
    let (x, y) = cell(&lab, "loops");
    lab.ask(&press(x, y), "> loops");
    lab.press(&press(x, y));
    lab.wait_until("Loops", |lab| {
        lab.screen().starts_with(" Loops") && !lab.words().contains("/ filters by name")
    });
    // The wheel over the traces shows less time.
    lab.press(" ");
    lab.ask("\u{1b}[<64;6;6M", "the traces show 5 s");
    let (x, y) = cell(&lab, "q quit");
    lab.press(&press(x, y));
    assert_eq!(lab.wait_for_end().exit_code(), 0);
    has_given_the_mouse_back(&lab);
}

#[test]
fn hostile_places_do_nothing() {
    let mut lab = Terminal::open("--paused --at 10");
    lab.wait_for("q quit");
    let before = lab.screen();
    for place in [
        "0;0",
        "0;5",
        "5;0",
        "81;3",
        "3;25",
        "65535;65535",
        "65536;1",
        "99999999999999999999;1",
        "-1;-1",
        "1",
        "1;1;1",
        "",
        ";;",
    ] {
        for button in ["0", "32", "64", "65", "35", "255"] {
            lab.press(&format!("\u{1b}[<{button};{place}M"));
        }
    }
    lab.press("..");
    lab.wait_for_step(12);
    lab.press(",,");
    lab.wait_for_step(10);
    lab.wait_until("the same picture", |lab| lab.screen() == before);
    lab.quit();
}

#[test]
fn the_terminal_has_its_mouse_back_after_every_end() {
    let mut lab = Terminal::open("--paused");
    lab.wait_for("q quit");
    lab.quit();
    has_given_the_mouse_back(&lab);
    for signal in ["TERM", "HUP"] {
        let mut lab = Terminal::open(&[]);
        lab.wait_for("q quit");
        lab.signal(signal);
        lab.wait_for_end();
        has_given_the_mouse_back(&lab);
    }
}

#[test]
#[cfg(debug_assertions)]
fn the_terminal_has_its_mouse_back_after_a_panic() {
    let variables = [("TERM", "xterm"), ("GYROLAB_PANIC_AFTER_MS", "600")];
    let mut lab = Terminal::open_with(&[], &variables);
    lab.wait_for("q quit");
    assert_eq!(lab.wait_for_end().exit_code(), 101);
    has_given_the_mouse_back(&lab);
}

#[test]
fn the_shell_has_the_mouse_while_the_lab_is_stopped() {
    let ground = Ground::new();
    let mut lab = ground.open_shell();
    lab.wait_for("shell>");
    lab.press(&format!(
        "{} --paused --at 30\r",
        env!("CARGO_BIN_EXE_gyrolab")
    ));
    lab.wait_for("q quit");
    lab.press(CTRL_Z);
    has_given_the_mouse_back(&lab);
    lab.ask("\r", "shell>");
    lab.forget();
    lab.press("fg\r");
    lab.wait_for("q quit");
    lab.wait_until("the mouse", |lab| lab.sent_text().contains(ON));
    lab.press("q");
    has_given_the_mouse_back(&lab);
}

#[test]
fn the_mouse_can_stay_with_the_terminal() {
    let mut lab = Terminal::open("--paused --no-mouse");
    lab.wait_for("q quit");
    lab.ask(".", "step 1");
    assert!(!lab.sent_text().contains(ON));
    lab.ask("c\x1b[A\r", "mouse acts on the lab");
    lab.wait_until("the mouse", |lab| lab.sent_text().contains(ON));
    lab.ask("\r", "mouse selects the terminal's text");
    lab.wait_until("the mouse back", |lab| lab.sent_text().contains(OFF));
    lab.ask("\x1b", "q quit");
    lab.quit();
    has_given_the_mouse_back(&lab);
}

#[test]
fn without_a_name_the_lab_goes_on_at_the_end() {
    let mut lab = Terminal::open("--paused --at 2290");
    lab.wait_for("q quit");
    lab.press(" ");
    lab.wait_until("a step beyond the end", |lab| lab.step() > Some(2400));
    lab.wait_for("t draws the exact motion");
    lab.quit();
    let mut lab = Terminal::open("method-2 --paused --at 2290");
    lab.wait_for("q quit");
    lab.ask(" ", "end of the run: space goes on");
    lab.wait_for_step(2300);
    lab.quit();
}
