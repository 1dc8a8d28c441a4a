//! Names with control sequences for the terminal, wherever the user or the system may supply one: none is printed
//! unescaped.

use crate::support::ground::Ground;
use crate::support::pty::LEAVES_ALTERNATE_SCREEN;
use gyrolab::engine::text::printable::is_steering;
use std::process::Output;

/// Control characters that set a window title, reverse the text direction and hide text.
const NASTY: &str = "x\u{1b}]0;P\u{7}\u{202e}\u{200b}\u{2028}\u{feff}\u{e0041}\u{9b}2Jy";

const BODY: &str = "[[body.point]]\nname = 'top'\nat_m = [0, 0, 1]\nmass_kg = 1\n[[body.point]]\nname = 'a'\n\
                    at_m = [1, 0, 1]\nmass_kg = 1\n[[body.point]]\nname = 'b'\nat_m = [0, 1, 1]\nmass_kg = 1\n\
                    [start]\nmomentum_Js = [0, 0, 9]\n[motion]\ntime_step_s = 0.01\nsteps = 5\n";

#[track_caller]
fn assert_printable(args: &str, output: &Output) {
    for stream in [&output.stdout, &output.stderr] {
        let text = String::from_utf8_lossy(stream);
        let steering = text.chars().find(|&c| c != '\n' && is_steering(c));
        assert_eq!(steering, None, "{args}: {text:?}");
    }
}

#[test]
fn control_sequences_in_arguments_are_escaped() {
    let ground = Ground::named(NASTY);
    let good = format!("{NASTY}.toml");
    std::fs::write(ground.file(&good), format!("title = 'A top'\n{BODY}")).unwrap();
    std::fs::write(ground.file("broken.toml"), format!("title = {NASTY}\n")).unwrap();
    std::fs::write(ground.file(&format!("{NASTY}.csv")), "a,b\n1,2\n").unwrap();
    std::fs::create_dir(ground.file(NASTY)).unwrap();
    for (name, line) in [
        ("title", "title = \"N\""),
        ("key", "title = 'x'\n\"N\" = 1"),
        ("trace", "title = 'x'\ntrace = \"N\""),
        ("scheme", "title = 'x'\nmotion.scheme = \"N\""),
        ("about", "title = 'x'\nabout = \"N\""),
        ("view", "title = 'x'\nview = { look_at = \"N\" }"),
        ("type", "title = [\"N\"]"),
    ] {
        let escaped: String = NASTY
            .chars()
            .map(|c| format!("\\U{:08X}", c as u32))
            .collect();
        let text = format!("{}\n{BODY}", line.replace('N', &escaped));
        std::fs::write(ground.file(&format!("{name}.toml")), text).unwrap();
    }
    let here = format!("./{good}");
    let csv = format!("{NASTY}.csv");
    let [key, value, word, title, option] = [
        format!("{NASTY}=1"),
        format!("motion.time_step_s={NASTY}"),
        format!("motion.scheme={NASTY}"),
        format!("title={NASTY}"),
        format!("--{NASTY}"),
    ];
    let [deep, missing, place] = [
        format!("motion.{NASTY}.a.b={NASTY}"),
        format!("./{NASTY}.d/y"),
        format!("push.{NASTY}=1"),
    ];
    let commands = [
        NASTY.to_owned(),
        format!("{good} --at 3"),
        option.clone(),
        format!("run {NASTY}"),
        format!("run {good}"),
        format!("run {here} -o {NASTY}"),
        format!("run {here} -o {missing}"),
        format!("run {here} -o {csv}"),
        format!("run {here} --json"),
        format!("run {csv}"),
        format!("run {NASTY} {NASTY}"),
        format!("run method-2 --set {NASTY}"),
        format!("run method-2 --set {key}"),
        format!("run method-2 --set {value}"),
        format!("run method-2 --set {word}"),
        format!("run method-2 --set {title}"),
        format!("run method-2 --set {deep}"),
        format!("run method-2 --set {place}"),
        format!("run method-2 --scheme {NASTY}"),
        format!("run method-2 --time-step {NASTY}"),
        format!("run method-2 --steps {NASTY}"),
        format!("run method-2 --every {NASTY}"),
        format!("compare {NASTY}"),
        format!("compare method-2 --schemes {NASTY}"),
        format!("compare {here} --time-steps {NASTY}"),
        format!("compare {here} -o {NASTY}"),
        format!("show {NASTY}"),
        format!("show {here}"),
        format!("show {here} --size {NASTY}"),
        format!("presets {NASTY}"),
        format!("check {NASTY} {good} {here} {csv} broken.toml"),
        "check title.toml key.toml trace.toml scheme.toml about.toml".to_owned(),
        "check view.toml type.toml".to_owned(),
        format!("completions {NASTY}"),
        format!("help {NASTY}"),
        format!("--resume {NASTY}"),
        format!("--color {NASTY}"),
    ];
    for args in &commands {
        assert_printable(args, &ground.run(args));
    }
    let checked = ground.run("check title.toml about.toml view.toml");
    let told = String::from_utf8_lossy(&checked.stderr);
    for named in ["title", "about", "view.look_at"] {
        assert!(told.contains(&format!(" {named} (\"x\\u")), "{told}");
    }
    assert!(told.contains("(here U+001B)"), "{told}");
}

#[test]
fn the_lab_and_its_last_message_escape_names() {
    let ground = Ground::named(NASTY);
    let file = format!("{NASTY}.toml");
    std::fs::write(ground.file(&file), format!("title = 'A top'\n{BODY}")).unwrap();
    let variables = [
        ("TERM", "xterm"),
        ("LANG", "C.UTF-8"),
        ("USER", NASTY),
        ("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22"),
    ];
    let mut terminal = ground.open_with(&[&file, "--paused", "--at", "5"], &variables);
    terminal.wait_for("A top");
    terminal.ask("o", r"x\u{1b}]0;P\u{7}");
    terminal.press("\u{1b}");
    terminal.wait_until("the lab", |terminal| {
        !terminal.words().contains("Enter open")
    });
    terminal.ask("x", "export steps 0 to 5");
    terminal.ask("\r", "wrote");
    terminal.quit();
    terminal.assert_terminal_restored();
    terminal.wait_until("the farewell", |terminal| {
        terminal.sent_text().contains("gyrolab --resume")
    });
    let sent = terminal.sent_text();
    assert!(!sent.contains("]0;P\u{7}"));
    let (_, farewell) = sent.rsplit_once(LEAVES_ALTERNATE_SCREEN).unwrap();
    // The lab's own last sequence restores the cursor.
    let (_, own) = farewell.rsplit_once("\u{1b}[").unwrap();
    let own_end = own.find(|c: char| c.is_ascii_alphabetic()).unwrap();
    let lines: Vec<_> = own[own_end + 1..].lines().collect();
    assert!(
        lines.iter().any(|line| line.contains("no scp command")),
        "{lines:?}"
    );
    assert!(
        lines.iter().any(|line| line.contains(": 6 rows")),
        "{lines:?}"
    );
    for line in lines {
        assert!(!line.chars().any(is_steering), "{line:?}");
    }
}

#[test]
fn argument_errors_on_a_terminal_escape_arguments() {
    let ground = Ground::new();
    // Only a complete sequence: clap removes it from its plain text, but not from its colored text.
    let title = "x\u{1b}]0;P\u{7}y";
    let option = format!("--bo{title}");
    for args in [option, format!("run cusps --scheme {title}")] {
        let mut terminal = ground.open(&args);
        assert_eq!(terminal.wait_for_end().exit_code(), 2, "{args}");
        terminal.wait_until("clap's last line", |terminal| {
            terminal.sent_text().contains("--help")
        });
        let sent = terminal.sent_text();
        assert!(!sent.contains('\u{7}'), "{sent:?}");
        assert!(!sent.contains('\u{1b}'), "{sent:?}");
    }
}
