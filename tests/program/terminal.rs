//! The real program in a pty: how it uses a terminal, and how it restores it whenever it ends.

use crate::support::ground::{Args, Ground, done, stderr};
use crate::support::pty::{LEAVES_ALTERNATE_SCREEN, Terminal};
use crate::support::words::has_all;
use std::thread;
use std::time::Duration;

/// Opens the lab in a new working directory, and waits until its footer is on the screen.
fn open_lab(args: impl Args) -> Terminal {
    let terminal = Terminal::open(args);
    terminal.wait_for("L lessons");
    terminal
}

#[test]
fn the_lab_opens_runs_and_quits() {
    let mut terminal = open_lab("");
    terminal.wait_for("Method 2");
    terminal.wait_for("► ×20");
    terminal.quit();
    terminal.assert_terminal_restored();
}

#[test]
fn one_command_prepares_the_screen() {
    let terminal = Terminal::open("cusps --paused --at 500 --set start.tilt_deg=20");
    terminal.wait_for("paused");
    terminal.wait_for("step 500");
    terminal.wait_for("tilt ° 20 ");
}

#[test]
fn a_paused_lab_sends_no_bytes() {
    let terminal = open_lab("--paused");
    thread::sleep(Duration::from_millis(300));
    let before = terminal.sent().len();
    thread::sleep(Duration::from_secs(2));
    assert_eq!(terminal.sent().len(), before);
}

#[test]
fn keys_are_answered_at_top_speed() {
    let mut terminal = open_lab("--set motion.steps=1000000000");
    terminal.press("99+");
    terminal.wait_for("top ×");
    terminal.press("?");
    terminal.wait_for("help: type");
}

#[test]
fn the_lab_follows_resizes() {
    let mut terminal = open_lab("--paused");
    for size in [(200, 50), (40, 10), (1, 1), (120, 40)] {
        terminal.resize(size);
        thread::sleep(Duration::from_millis(200));
    }
    terminal.wait_for("3-D");
    terminal.quit();
}

#[test]
fn a_huge_window_is_drawn_in_little_memory() {
    let mut shell = Ground::new().open_shell();
    shell.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    shell.press("stty cols 65535 rows 65535; ulimit -v 600000\r");
    shell.press(&format!("{program} --paused; echo ended $?\r"));
    shell.wait_until("a picture", |shell| shell.sent().len() > 10_000);
    shell.press("q");
    shell.wait_for("ended 0");
}

#[test]
#[cfg(debug_assertions)]
fn a_panic_of_a_background_thread_is_reported_at_the_end() {
    let variables = [("TERM", "xterm"), ("GYROLAB_PANIC_ASIDE_AFTER_MS", "300")];
    let mut terminal = Terminal::open_with(&[], &variables);
    terminal.wait_for("L lessons");
    thread::sleep(Duration::from_secs(1));
    terminal.wait_for("L lessons");
    assert!(!terminal.sent_text().contains(LEAVES_ALTERNATE_SCREEN));
    assert!(!terminal.sent_text().contains("asked for"));
    terminal.quit();
    terminal.wait_until("the message", |terminal| {
        let sent = terminal.sent_text();
        let farewell = sent.rfind(LEAVES_ALTERNATE_SCREEN);
        farewell.is_some_and(|farewell| sent[farewell..].contains("a panic was asked for aside"))
    });
}

#[test]
fn a_lost_line_ends_the_lab() {
    for _ in 0..3 {
        let mut terminal = open_lab("");
        terminal.lose_line();
        // Ended by the signal or by the failed write of a frame, whichever comes first.
        assert!([1, 129].contains(&terminal.wait_for_end().exit_code()));
    }
}

#[test]
fn a_line_lost_without_a_signal_ends_the_lab_and_saves_the_session() {
    for args in [&["--paused"][..], &[]] {
        let ground = Ground::new();
        let mut terminal = ground.open_uncontrolled(args);
        terminal.wait_for("L lessons");
        terminal.press("120g");
        terminal.wait_until("the step", |terminal| terminal.step() >= Some(120));
        terminal.lose_line();
        assert_eq!(terminal.wait_for_end().exit_code(), 1);
        let mut again = ground.open("--resume");
        again.wait_for("L lessons");
        again.wait_until("the step where it was left", |again| {
            again.step() >= Some(120)
        });
        again.quit();
    }
}

#[test]
fn thousands_of_keys_at_once_are_all_handled() {
    let mut terminal = open_lab("--paused");
    terminal.press(&".".repeat(2000));
    terminal.wait_for_step(2000);
    // More bytes than a terminal buffers, with escape sequences that may be split anywhere.
    terminal.ask("r", "step 0");
    terminal.press(&"..\u{1b}[6~,\u{1b}[5~".repeat(1000));
    terminal.wait_for_step(1000);
    terminal.quit();
}

#[test]
fn an_unfinished_escape_sequence_does_not_swallow_later_keys() {
    let cut_off = |sequence: &str| {
        let mut terminal = open_lab("--paused");
        // Ctrl-C ends the lab even immediately after the sequence.
        terminal.press(&format!("{sequence}abc\u{3}"));
        assert_eq!(terminal.wait_for_end().exit_code(), 0, "{sequence:?}");
        let mut another = open_lab("--paused");
        // After a while, every key has its usual effect.
        another.press(sequence);
        thread::sleep(Duration::from_millis(3500));
        another.ask("?", "help: type");
        another.kill();
    };
    thread::scope(|scope| {
        for begun in ["[200~", "[<", "[1;", "]0;", "P", "O"] {
            scope.spawn(move || cut_off(&format!("\u{1b}{begun}")));
        }
    });
}

#[test]
fn a_long_paste_into_a_field_is_truncated_with_a_message() {
    let mut terminal = open_lab("--paused --at 10");
    let paste = |text: &str| format!("\u{1b}[200~{text}\u{1b}[201~");
    terminal.ask("x", "export steps 0 to 10");
    terminal.ask(&paste(&"q".repeat(20_000)), "at most 1000 characters");
    terminal.ask("\u{15}", "file");
    terminal.ask(&paste("from-the\n-clipboard.csv"), "from-the-clipboard.csv");
    terminal.ask("\r", "wrote 11 rows");
    let files = ["from-the-clipboard.csv", "state"];
    assert_eq!(terminal.ground().files(), files);
    terminal.ask("o", "type to filter");
    terminal.ask(&paste(&"x".repeat(20_000)), "xxxxx...");
    terminal.wait_for("no matching preset or file");
    terminal.ask("\u{15}\u{1b}", "type to filter");
    // Without a text field, pasted letters do not act as keys.
    terminal.press("\u{1b}");
    terminal.wait_until("the lab", |terminal| {
        !terminal.words().contains("type to filter")
    });
    terminal.ask(&paste("qqq"), "paste into fields");
    terminal.quit();
}

/// The rows are pasted like from a terminal: with Enter at the ends of lines, and in pieces.
#[test]
fn pasted_rows_are_judged_until_they_are_undone() {
    let ground = Ground::new();
    let mut terminal = ground.open("method-1 --paused");
    terminal.wait_for("L lessons");
    let rows = "step,x_m,y_m,z_m\r0,0,0,1.131\r1,0,0,1.131\r";
    terminal.press(&format!("\u{1b}[200~{rows}"));
    thread::sleep(Duration::from_millis(1500));
    terminal.ask("2,0,0,1.131\r\u{1b}[201~", "pasted.csv differs at step 1");
    assert_eq!(ground.files(), ["pasted.csv", "state"]);
    terminal.ask("M", "step 1");
    terminal.quit();
    // The rows are restored with the session, and one undo removes them.
    let mut again = ground.open("--resume");
    again.wait_for("L lessons");
    again.ask("M", "step 1");
    again.ask("u", "undone");
    again.ask("M", "no rows of your own program");
    for (pasted, told) in [
        (&*"0,1\r".repeat(250_001), "longer than 1 MB"),
        ("step,x_m\r0,\u{7f}1\r", "control characters"),
        ("1,2\r3,4\r", "has no line of names"),
    ] {
        again.ask(&format!("\u{1b}[200~{pasted}\u{1b}[201~"), told);
    }
    assert_eq!(ground.files(), ["pasted.csv", "state"]);
    let gap = "step,t_s,x_m\r0,0,0\r1,0.001,\r";
    let told = "no verdict: pasted data:3: x_m: is missing";
    again.ask(&format!("\u{1b}[200~{gap}\u{1b}[201~"), told);
    again.quit();
}

#[test]
fn the_lab_works_without_threads() {
    // A thread stack larger than the memory: no thread can be created.
    let variables = [
        ("TERM", "xterm"),
        ("LANG", "C.UTF-8"),
        ("RUST_MIN_STACK", "4611686018427387904"),
    ];
    for (signal, code) in [("", 0), ("TERM", 143), ("INT", 130)] {
        let mut terminal = Terminal::open_with(&["--paused"], &variables);
        terminal.wait_for("L lessons");
        terminal.ask("30.", "step 30");
        terminal.resize((100, 30));
        terminal.ask("x\r", "cannot write");
        terminal.ask("\u{1b}", "step 30");
        match signal {
            "" => terminal.press("q"),
            signal => terminal.signal(signal),
        }
        assert_eq!(terminal.wait_for_end().exit_code(), code, "{signal}");
        terminal.assert_terminal_restored();
        assert!(!terminal.sent_text().contains("panicked"));
    }
}

#[test]
fn fifos_and_devices_are_rejected_as_files_to_save() {
    let mut terminal = Terminal::open("--paused --at 10");
    terminal.ground().make_fifo("fifo");
    terminal.wait_for("L lessons");
    for (key, title) in [
        ("s", "save the run file"),
        ("S", "save the present state"),
        ("x", "export steps"),
    ] {
        for path in ["fifo", "/dev/tty", "/dev/stdout", "/dev/fd/1", "/dev/null"] {
            terminal.ask(key, title);
            terminal.ask(&format!("\u{15}{path}\r"), "not a regular file");
            terminal.press("\u{1b}");
            terminal.wait_until("the lab", |terminal| !terminal.words().contains(title));
        }
    }
    // "-" is a file name here, since stdout shows the lab.
    terminal.ask("s", "save the run file");
    terminal.ask("\u{15}-\r", "the run is in");
    terminal.quit();
    assert_eq!(terminal.ground().files(), ["-", "fifo", "state"]);
}

#[test]
#[ignore = "waits three seconds until the terminal is full"]
fn a_stopped_terminal_does_not_block_the_exit() {
    let mut terminal = open_lab("--fps 60 --set motion.steps=1000000000");
    terminal.press("99+");
    terminal.set_stopped(true);
    thread::sleep(Duration::from_secs(3)); // until the pty is full and a frame hangs
    terminal.signal("TERM");
    terminal.wait_for_end();
    terminal.set_stopped(false);
}

#[test]
fn ctrl_l_redraws_the_screen() {
    let mut terminal = open_lab("--paused");
    thread::sleep(Duration::from_millis(300));
    terminal.clear_output();
    terminal.press("\u{c}");
    terminal.wait_for("L lessons");
    terminal.wait_for("Method 2");
}

const CTRL_Z: &str = "\u{1a}";
const NO_SHELL: &str = "no shell to return to";

#[test]
fn ctrl_z_is_rejected_if_the_lab_is_the_session_leader() {
    let mut terminal = open_lab("--paused");
    terminal.ask(CTRL_Z, NO_SHELL);
    terminal.ask(".", "step 1 ");
    // The signal is handled like the key.
    terminal.signal("TSTP");
    terminal.wait_for(NO_SHELL);
    terminal.ask(".", "step 2 ");
    terminal.quit();
}

#[test]
fn ctrl_z_is_rejected_in_an_orphaned_process_group() {
    let ground = Ground::new();
    // The lab shares its process group with a shell without job control that leads the session, as under sshd.
    let mut terminal = ground.open_command("--paused; true");
    terminal.wait_for("L lessons");
    terminal.ask(CTRL_Z, NO_SHELL);
    terminal.ask(".", "step 1 ");
    terminal.quit();
}

#[test]
fn ctrl_z_suspends_a_script_together_with_its_lab() {
    let mut shell = Ground::new().open_shell();
    shell.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    shell.press(&format!("sh -c '{program} --paused; true'\r"));
    shell.wait_for("L lessons");
    shell.press(CTRL_Z);
    shell.assert_terminal_restored();
    shell.ask("\r", "shell>");
    shell.clear_output();
    shell.press("fg\r");
    shell.wait_for("L lessons");
    shell.press("q");
    shell.assert_terminal_restored();
}

/// The lab must never stay stopped. On a busy machine, the shell may take the terminal between the two signals; such an
/// attempt does not count.
#[test]
fn a_sigcont_soon_after_a_sigtstp_leaves_the_lab_running() {
    let mut shell = Ground::new().open_shell();
    shell.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    shell.press(&format!("{program} --paused\r"));
    shell.wait_for("L lessons");
    let found = shell
        .ground()
        .shell(&format!("pgrep -P {}", shell.child.process_id().unwrap()));
    let lab = String::from_utf8(found.stdout).unwrap().trim().to_owned();
    let is_left_running = (0..3).any(|_| {
        shell.clear_output();
        let both = format!("kill -TSTP {lab}; kill -CONT {lab}");
        assert!(shell.ground().shell(&both).status.success());
        shell.wait_until("a picture or a prompt", |shell| {
            let words = shell.words();
            words.contains("L lessons") || words.contains("shell>")
        });
        let is_running = !shell.sent_text().contains("shell>");
        if !is_running {
            shell.press("fg\r");
            shell.wait_for("L lessons");
        }
        is_running
    });
    assert!(is_left_running);
    shell.wait_for("L lessons");
    shell.ask(".", "step 1 ");
    // The terminal may have been restored before the last `clear_output`, so this is not checked here.
    shell.clear_output();
    shell.press("q");
    shell.wait_for("shell>");
}

#[test]
fn no_color_disables_colors_and_the_selection_is_still_visible() {
    let variables = [("TERM", "xterm"), ("LANG", "C.UTF-8"), ("NO_COLOR", "1")];
    let mut terminal = Terminal::open_with(&["--paused"], &variables);
    terminal.wait_for("L lessons");
    terminal.press("o");
    terminal.wait_for("> method-2");
    let sent = terminal.sent_text();
    let is_coloured = sent.contains("\u{1b}[38;") || sent.contains("\u{1b}[48;");
    assert!(!is_coloured);
    assert!(sent.contains("\u{1b}[7m"), "no reversed selection");
}

#[test]
fn a_locale_without_utf8_gets_ascii() {
    for variables in [
        [("TERM", "xterm"), ("LANG", "C")],
        [("TERM", "linux"), ("LANG", "POSIX")],
    ] {
        let terminal = Terminal::open_with(&["--paused", "--at", "100"], &variables);
        terminal.wait_for("L lessons");
        assert!(terminal.sent().is_ascii());
    }
}

#[test]
fn without_a_terminal_the_picture_is_printed_with_a_note() {
    let ground = Ground::new();
    let shown = done(ground.run("cusps"));
    let words = ["no terminal", "at the end of the run"];
    has_all(stderr(&shown), words);
    let early = ground.stderr("cusps --at 3");
    has_all(early, ["no terminal", "at step 3"]);
    let same = ground.run("show cusps");
    assert_eq!(shown.stdout, same.stdout);
    assert!(same.stderr.is_empty());
}

#[test]
fn show_prints_plain_text_of_the_requested_size() {
    let ground = Ground::new();
    for (size, lines, columns) in [("80x24", 24, 80), ("200x50", 50, 200), ("1x1", 1, 1)] {
        let text = ground.stdout(&format!("show method-2 --size {size}"));
        assert_eq!(text.lines().count(), lines, "{size}");
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= columns && !line.contains('\u{1b}')),
            "{size}"
        );
    }
    has_all(
        &ground.stdout("show method-2"),
        ["step 2300 of 2300", "z m        0.811"],
    );
    has_all(
        &ground.stdout("show wing-nut --size 200x50"),
        ["turns over"],
    );
}

#[test]
fn errors_on_the_command_line_are_reported() {
    for (args, code, words) in [
        ("no-such-preset", 1, "no preset of that name"),
        ("show", 2, "SCENARIO"),
        ("show cusps --size 0x9", 2, "80x24"),
        ("show cusps --size 1000x501", 2, "1000x500"),
        ("--scheme euler", 2, "report"),
        ("--at x", 2, "a whole number of steps"),
        (
            "--set motion.time_step_s=-1",
            1,
            "must be greater than zero",
        ),
    ] {
        Ground::new().refused(args, code, &[words]);
    }
}

#[test]
fn the_step_pane_advances_phase_by_phase() {
    let mut lab = Terminal::open("--paused");
    lab.wait_for("L lessons");
    lab.ask("v", "No time step has been taken yet");
    lab.ask(".", "phase 1 of 7");
    lab.ask(".", "phase 2 of 7");
    lab.ask(",,", "No time step has been taken yet");
    lab.ask(".......", "phase 7 of 7");
    lab.ask(".", "step 1 → 2");
    lab.ask("y", "why sideways, not down?");
    lab.ask("v", "from above");
    lab.quit();
}
