//! The mouse in the real program: reports in the encoding of a terminal, and whether lab or terminal has the mouse.

use crate::support::pty::{MOUSE_OFF, MOUSE_ON, Terminal};

/// Encodes a press at the cell `x`, `y`, counted from 1.
fn press((x, y): (u16, u16)) -> String {
    format!("\u{1b}[<0;{x};{y}M\u{1b}[<0;{x};{y}m")
}

/// Returns the first cell of `words` on the screen, counted from 1.
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

/// Returns the lines of the screen without trailing blanks.
fn lines(lab: &Terminal) -> Vec<String> {
    let screen = lab.screen();
    screen
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect()
}

#[test]
fn clicks_act_on_what_is_under_the_pointer() {
    let mut lab = Terminal::open("--paused --at 900");
    lab.wait_for("L lessons");
    lab.wait_until("the mouse", |lab| lab.sent_text().contains(MOUSE_ON));
    // A press in the traces sets the cursor.
    lab.ask(&press((20, 14)), "◊");
    // A press on the rule of a pane selects it.
    let pane = cell(&lab, "values");
    lab.ask(&press(pane), "/ find");
    // A press near the left end of the overview jumps to the start.
    let (_, overview) = cell(&lab, "whole run");
    lab.press(&press((9, overview + 1)));
    lab.wait_until("the start", |lab| lab.step().is_some_and(|step| step < 100));
    let before = lab.step().unwrap();
    // A press on a key in the footer acts like the key: a step, and the list of presets.
    let steps = cell(&lab, ". , step");
    lab.press(&press(steps));
    lab.wait_for_step(before + 1);
    let open = cell(&lab, "o open");
    lab.ask(&press(open), "type to filter");
    let loops = cell(&lab, "loops");
    lab.ask(&press(loops), "> loops");
    lab.press(&press(loops));
    lab.wait_until("Loops", |lab| {
        lab.screen().starts_with("Loops") && !lab.words().contains("type to filter")
    });
    // The wheel over the traces zooms in, and an overview appears.
    lab.press(" ");
    lab.ask("\u{1b}[<64;16;6M", "whole run");
    lab.press("q");
    assert_eq!(lab.wait_for_end().exit_code(), 0);
    lab.assert_terminal_restored();
}

#[test]
fn invalid_mouse_positions_are_ignored() {
    let mut lab = Terminal::open("--paused --at 10");
    lab.wait_for("L lessons");
    lab.wait_for("a: dt 0.002 s");
    let before = lines(&lab);
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
    lab.wait_until("the same picture", |lab| lines(lab) == before);
    lab.quit();
}

#[test]
fn the_mouse_can_be_left_to_the_terminal() {
    let mut lab = Terminal::open("--paused --no-mouse");
    lab.wait_for("L lessons");
    lab.ask(".", "step 1");
    assert!(!lab.sent_text().contains(MOUSE_ON));
    lab.ask("c\x1b[A\r", "mouse controls the lab");
    lab.wait_until("the mouse", |lab| lab.sent_text().contains(MOUSE_ON));
    lab.ask("\r", "mouse selects text in the terminal");
    lab.wait_until("the mouse back", |lab| lab.sent_text().contains(MOUSE_OFF));
    lab.ask("\x1b", "L lessons");
    lab.quit();
    lab.assert_terminal_restored();
}

#[test]
fn the_lab_stops_once_at_the_end_with_and_without_a_name() {
    for name in ["", "method-2"] {
        let mut lab = Terminal::open(&format!("{name} --paused --at 2290"));
        lab.wait_for("L lessons");
        lab.ask(" ", "end of the run: space continues");
        lab.wait_for_step(2300);
        lab.press(" ");
        lab.wait_until("a step beyond the end", |lab| lab.step() > Some(2310));
        lab.quit();
    }
}
