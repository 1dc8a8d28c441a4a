//! The pages of the manual, and completion in the installed shells.

use crate::support::ground::{GYROLAB, Ground, done, stdout};
use crate::support::words::{has, has_all, has_no};
use std::process::Command;

#[test]
fn every_command_has_a_page_with_examples() {
    let ground = Ground::new();
    let commands = ground.subcommands();
    assert!(commands.contains(&"verify".to_owned()), "{commands:?}");
    done(ground.run("man --all -o man1"));
    for command in &commands {
        let page = ground.read(&format!("man1/gyrolab-{command}.1"));
        has(&page, &format!("\n.TH gyrolab-{command} 1 "));
        has_all(
            &page,
            [".SH SYNOPSIS", ".SH EXAMPLES", ".SH \"EXIT STATUS\""],
        );
        has(ground.stdout(&format!("{command} --help")), "Examples:\n");
    }
    let whole = ground.read("man1/gyrolab.1");
    for section in "ENVIRONMENT|FILES|\"EXIT STATUS\"|\"KEYS IN THE LAB\"".split('|') {
        has(&whole, format!(".SH {section}\n"));
    }
    has_no(&whole, "gyrolab\\-help"); // there is no such page
    let words = "man1/gyrolab.1 exists; --force replaces it";
    ground.refused("man --all -o man1", 1, &[words]);
    done(ground.run("man --all -o man1 --force"));
    ground.refused("man verfy", 1, &["did you mean verify?"]);
}

/// `man` prints plain text; only `--all` writes roff.
#[test]
fn the_manual_is_printed_as_plain_text() {
    let ground = Ground::new();
    let whole = ground.stdout("man");
    let page = ground.stdout("man run");
    has(&whole, "\n\nGYROLAB RUN\n\n");
    has(&page, "\nUsage: gyrolab run [OPTIONS] <SCENARIO>\n");
    for text in [&whole, &page] {
        assert_eq!(
            text.lines()
                .find(|line| line.starts_with(".S") || line.contains("\\f")),
            None
        );
    }
    for section in ["ENVIRONMENT", "FILES", "EXIT STATUS", "KEYS IN THE LAB"] {
        has(&whole, format!("\n{section}\n"));
    }
    // A topic with the name of a command says where its options are listed.
    let topic = ground.stdout("man sweep");
    let words = "The options of the command: gyrolab sweep --help.";
    assert_eq!(topic.lines().last(), Some(words));
}

#[test]
fn topics_are_at_most_80_columns_wide() {
    let ground = Ground::new();
    let topics = " class csv fit friction glossary lab numbers own-code scenario schemes sweep run";
    for topic in topics.split(' ') {
        let text = ground.stdout(&format!("man {topic}"));
        assert_eq!(
            text.lines()
                .find(|line| line.chars().count() > 80 && !line.starts_with("Usage: ")),
            None,
            "{topic}"
        );
    }
}

/// Skips checkers that are not installed.
#[test]
fn manual_pages_pass_the_installed_checkers() {
    let ground = Ground::new();
    done(ground.run("man --all -o man1"));
    for checker in ["mandoc -Tlint -W warning", "man -l --warnings"] {
        let program = checker.split(' ').next().unwrap();
        if Command::new(program).arg("--version").output().is_err() {
            continue;
        }
        let script = format!(
            "for page in man1/*.1; do {checker} \"$page\" 2>&1 >/dev/null; done; \
             [ {program} = man ] || for page in man1/*.1; do {checker} \"$page\" 2>&1; done"
        );
        let output = ground.shell(&script);
        assert_eq!(stdout(&output), "", "{checker}");
    }
}

#[test]
fn the_topics_contain_the_tables_of_the_program() {
    let ground = Ground::new();
    for (topic, words) in [
        ("scenario", "motion.time_step_s (required)"),
        ("csv", "wz_rad_per_s   angular velocity"),
        ("csv", "vx_m_per_s "),
        ("schemes", "srkn11b"),
        ("numbers", "measured_precession_rad_per_s (rad/s)"),
        ("glossary", "  pivot         the foot of the axle"),
        ("lab", "See how one time step is computed"),
    ] {
        let page = ground.stdout(&format!("man {topic}"));
        has(&page, words);
        assert!(
            !page
                .lines()
                .any(|line| line.starts_with('{') && line.ends_with('}')),
            "{topic}"
        );
    }
}

/// Returns bash's completions of `line`, split into words like bash does.
fn complete_in_bash(ground: &Ground, line: &str) -> String {
    let words = line.replace('=', " = ");
    let script = format!(
        "gyrolab() {{ \"$G\" \"$@\"; }}; compopt() {{ :; }}; . ./completion.bash; \
         set -- {words}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMP_TYPE=9; \
         _gyrolab gyrolab \"${{@: -1}}\"; printf '%s ' \"${{COMPREPLY[@]}}\""
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .env("G", GYROLAB)
        .current_dir(ground.path())
        .output()
        .unwrap();
    stdout(&output).trim_end().to_owned()
}

#[test]
fn bash_completes_presets_files_keys_values_and_names() {
    if Command::new("bash").arg("--version").output().is_err() {
        return;
    }
    let ground = Ground::new();
    ground.write("completion.bash", &ground.stdout("completions bash"));
    ground.write("mine.toml", "");
    ground.write("mine.txt", "");
    ground.write("a file's.toml", "");
    for (line, wanted) in [
        ("gyrolab run cus", "cusps"),
        ("gyrolab run mine", "mine.toml"),
        ("gyrolab run cusps --set motion.sch", "motion.scheme="),
        ("gyrolab run cusps --set motion.scheme=sr", "srkn11b"),
        ("gyrolab run cusps --set view.bare=", "true false"),
        ("gyrolab run cusps --columns t_s,energ", "t_s,energy_J"),
        ("gyrolab run cusps --scheme rk", "rk4"),
        ("gyrolab run a", "a\\ file\\'s.toml"),
        (
            "gyrolab sweep wob",
            "wobble-over-time-step wobble-push wobble-push-accumulating",
        ),
        ("gyrolab presets precession-over-t", "precession-over-tilt"),
        ("gyrolab presets heidelberg-p", "heidelberg-precession"),
        (
            "gyrolab run cusps --set body.point.1.n",
            "body.point.1.name=",
        ),
        ("gyrolab run cusps --set push.12.po", "push.12.point="),
        (
            "gyrolab sweep cusps --vary start.momentum_Js.",
            "start.momentum_Js.0= start.momentum_Js.1= start.momentum_Js.2=",
        ),
        (
            "gyrolab sweep cusps --vary motion.scheme=report,sr",
            "report,srkn11b",
        ),
        ("gyrolab figure cusps --kind ab", "above"),
        ("gyrolab figure cusps --kind z_m,tilt", "z_m,tilt_deg"),
        ("gyrolab lesson kap", "kappa-and-the-scheme"),
        ("gyrolab man num", "numbers"),
        ("gyrolab ver", "verify"),
    ] {
        assert_eq!(complete_in_bash(&ground, line), wanted, "{line}");
    }
}

#[test]
fn zsh_and_fish_complete_keys() {
    let ground = Ground::new();
    for shell in ["zsh", "fish"] {
        let script = ground.stdout(&format!("completions {shell}"));
        ground.write(&format!("completion.{shell}"), &script);
        if Command::new(shell).arg("--version").output().is_err() {
            continue;
        }
        done(ground.shell(&format!("{shell} -n completion.{shell}")));
    }
    // The requests of the scripts, and the replies.
    let ask = |shell: &str, index: &str| {
        let mut command = ground.command("-- gyrolab run cusps --set motion.sch");
        command
            .env("GYROLAB_COMPLETE", shell)
            .env("_CLAP_COMPLETE_INDEX", index);
        stdout(&done(command.output().unwrap())).to_owned()
    };
    assert!(ask("zsh", "4").starts_with("motion.scheme=:"));
    assert!(ask("fish", "4").starts_with("motion.scheme=\t"));
}
