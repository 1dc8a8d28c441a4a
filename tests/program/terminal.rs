//! The program itself in a pty: what it does to a terminal, and how it gives it back at every end.

use crate::support::ground::{Args, Ground, done, stderr};
use crate::support::pty::{LEAVES_ALTERNATE_SCREEN, Terminal};
use crate::support::words::has_all;
use std::thread;
use std::time::Duration;

/// The lab in a new working directory, once its keys are on the screen.
fn opened(args: impl Args) -> Terminal {
    let terminal = Terminal::open(args);
    terminal.wait_for("L lessons");
    terminal
}

#[test]
fn it_opens_runs_and_leaves() {
    let mut terminal = opened("");
    terminal.wait_for("Method 2");
    terminal.wait_for("► ×20");
    terminal.quit();
    terminal.has_given_the_terminal_back();
}

#[test]
fn a_screen_is_prepared_in_one_command() {
    let terminal = Terminal::open("cusps --paused --at 500 --set start.tilt_deg=20");
    terminal.wait_for("paused");
    terminal.wait_for("step 500");
    terminal.wait_for("tilt ° 20 ");
}

#[test]
fn not_a_byte_while_it_stands_still() {
    let terminal = opened("--paused");
    thread::sleep(Duration::from_millis(300));
    let before = terminal.sent().len();
    thread::sleep(Duration::from_secs(2));
    assert_eq!(terminal.sent().len(), before);
}

#[test]
fn keys_are_answered_at_top_speed() {
    let mut terminal = opened("--set motion.steps=1000000000");
    terminal.press("99+");
    terminal.wait_for("top ×");
    terminal.press("?");
    terminal.wait_for("help: type");
}

#[test]
fn it_follows_the_size_of_the_screen() {
    let mut terminal = opened("--paused");
    for size in [(200, 50), (40, 10), (1, 1), (120, 40)] {
        terminal.resize(size);
        thread::sleep(Duration::from_millis(200));
    }
    terminal.wait_for("3-D");
    terminal.quit();
}

#[test]
fn a_window_of_any_size_is_drawn_within_little_memory() {
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
fn a_panic_in_the_background_waits_for_the_end_to_be_told() {
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
fn a_lost_line_ends_it() {
    for _ in 0..3 {
        let mut terminal = opened("");
        terminal.lose_line();
        // By the signal, or by the frame that could not be written: whichever comes first.
        assert!([1, 129].contains(&terminal.wait_for_end().exit_code()));
    }
}

#[test]
fn a_line_lost_without_a_signal_ends_it_and_keeps_the_session() {
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
fn keys_in_bulk_are_all_taken_at_once() {
    let mut terminal = opened("--paused");
    terminal.press(&".".repeat(2000));
    terminal.wait_for_step(2000);
    // More than a terminal holds, with sequences that come apart anywhere in it.
    terminal.ask("r", "step 0");
    terminal.press(&"..\u{1b}[6~,\u{1b}[5~".repeat(1000));
    terminal.wait_for_step(1000);
    terminal.quit();
}

#[test]
fn a_sequence_that_never_ends_does_not_swallow_what_follows() {
    let cut_off = |sequence: &str| {
        let mut terminal = opened("--paused");
        // Ctrl-C ends the lab, however soon it follows.
        terminal.press(&format!("{sequence}abc\u{3}"));
        assert_eq!(terminal.wait_for_end().exit_code(), 0, "{sequence:?}");
        let mut another = opened("--paused");
        // And after a while any key means what it says.
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
fn a_paste_into_a_field_is_cut_and_says_so() {
    let mut terminal = opened("--paused --at 10");
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
    // Where nothing is typed, pasted letters are no keys.
    terminal.press("\u{1b}");
    terminal.wait_until("the lab", |terminal| {
        !terminal.words().contains("type to filter")
    });
    terminal.ask(&paste("qqq"), "paste into fields");
    terminal.quit();
}

/// As a terminal pastes them: with Enter at the ends of the lines, and in pieces.
#[test]
fn rows_that_are_pasted_are_judged_until_they_are_taken_back() {
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
    // They are there again, and one undo takes them back.
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
fn without_threads_the_lab_opens_acts_and_ends() {
    // A stack larger than any memory: no thread can be had.
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
        terminal.has_given_the_terminal_back();
        assert!(!terminal.sent_text().contains("panicked"));
    }
}

#[test]
fn nothing_is_saved_where_it_could_hang_the_lab_or_write_over_the_picture() {
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
    // "-" is a name like others: the picture has stdout.
    terminal.ask("s", "save the run file");
    terminal.ask("\u{15}-\r", "the run is in");
    terminal.quit();
    assert_eq!(terminal.ground().files(), ["-", "fifo", "state"]);
}

#[test]
#[ignore = "waits three seconds until the terminal is full"]
fn a_terminal_that_takes_no_bytes_does_not_hold_up_the_end() {
    let mut terminal = opened("--fps 60 --set motion.steps=1000000000");
    terminal.press("99+");
    terminal.set_stopped(true);
    thread::sleep(Duration::from_secs(3)); // until the pty is full and a frame hangs
    terminal.signal("TERM");
    terminal.wait_for_end();
    terminal.set_stopped(false);
}

#[test]
fn ctrl_l_draws_all_of_it_again() {
    let mut terminal = opened("--paused");
    thread::sleep(Duration::from_millis(300));
    terminal.forget();
    terminal.press("\u{c}");
    terminal.wait_for("L lessons");
    terminal.wait_for("Method 2");
}

const CTRL_Z: &str = "\u{1a}";
const NO_SHELL: &str = "no shell to return to";

#[test]
fn ctrl_z_is_refused_where_the_lab_leads_its_session() {
    let mut terminal = opened("--paused");
    terminal.ask(CTRL_Z, NO_SHELL);
    terminal.ask(".", "step 1 ");
    // The signal is no other request than the key.
    terminal.signal("TSTP");
    terminal.wait_for(NO_SHELL);
    terminal.ask(".", "step 2 ");
    terminal.quit();
}

#[test]
fn ctrl_z_is_refused_where_the_process_group_is_orphaned() {
    let ground = Ground::new();
    // A shell without job control that leads the session, as sshd starts it, is in the group of the lab.
    let mut terminal = ground.open_command("--paused; true");
    terminal.wait_for("L lessons");
    terminal.ask(CTRL_Z, NO_SHELL);
    terminal.ask(".", "step 1 ");
    terminal.quit();
}

#[test]
fn a_script_in_a_shell_with_job_control_is_suspended_with_its_lab() {
    let mut shell = Ground::new().open_shell();
    shell.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    shell.press(&format!("sh -c '{program} --paused; true'\r"));
    shell.wait_for("L lessons");
    shell.press(CTRL_Z);
    shell.has_given_the_terminal_back();
    shell.ask("\r", "shell>");
    shell.forget();
    shell.press("fg\r");
    shell.wait_for("L lessons");
    shell.press("q");
    shell.has_given_the_terminal_back();
}

/// Whatever happens, it may not stay stopped. A busy machine may put much time between the two signals: the shell then
/// takes the terminal, and that attempt does not count.
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
        shell.forget();
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
    // The terminal may have been given back before the last `forget`, so that is not counted here.
    shell.forget();
    shell.press("q");
    shell.wait_for("shell>");
}

#[test]
fn no_color_means_no_colour_and_the_selection_still_shows() {
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
fn without_a_terminal_it_shows_the_picture_and_says_so() {
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
fn show_prints_plain_text_of_the_size_asked_for() {
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
fn what_is_wrong_on_the_command_line_is_refused_in_words() {
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
fn a_time_step_is_gone_through_phase_by_phase() {
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
