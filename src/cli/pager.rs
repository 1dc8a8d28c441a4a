//! Long text on a terminal: shown by a pager, as git shows its own.

use super::print;
use rustix::termios::tcgetwinsize;
use signal_hook::consts::SIGINT;
use signal_hook::flag;
use std::env;
use std::io::{self, IsTerminal, Write};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The pager where PAGER names none, and its options where LESS is not set: less ends at once where all fits on the
/// screen, passes colours on, and leaves the text there.
const LESS: (&str, &str) = ("less", "FRX");

/// Shows `text`: by the pager that the user has, where stdout is a terminal on which it does not fit; else, and where that
/// pager fails, it is printed.
///
/// # Errors
/// When it cannot be printed.
pub(super) fn show(text: &str) -> anyhow::Result<ExitCode> {
    let pager = is_longer_than_screen(text).then(pager).flatten();
    if pager.is_some_and(|pager| shown_by(pager, text).unwrap_or(false)) {
        return Ok(ExitCode::SUCCESS);
    }
    print(text)
}

/// Whether `program`, which reads `text` and shows it on this terminal, has done so. A user who leaves it early has seen
/// what there was to see.
pub(super) fn shown_by(mut program: Command, text: &str) -> io::Result<bool> {
    // A Ctrl-C is for the program: were it to end this process, both the shell and the program would read the keys.
    let (has_come, may_end) = (Arc::<AtomicBool>::default(), Arc::<AtomicBool>::default());
    flag::register_conditional_default(SIGINT, Arc::clone(&may_end))?;
    flag::register(SIGINT, Arc::clone(&has_come))?;
    let ended = program.stdin(Stdio::piped()).spawn().and_then(|mut child| {
        if let Some(mut input) = child.stdin.take() {
            let _ = input.write_all(text.as_bytes()); // that nobody reads on is no failure
        }
        child.wait()
    });
    may_end.store(true, Ordering::SeqCst);
    Ok(ended?.success() || has_come.load(Ordering::SeqCst))
}

/// The pager that the user has; `None` where PAGER asks for none.
fn pager() -> Option<Command> {
    let named = env::var("PAGER").unwrap_or_else(|_| LESS.0.to_owned());
    let words = shlex::split(&named)?;
    let (program, arguments) = words.split_first()?;
    let mut pager = Command::new(program);
    pager.args(arguments);
    if env::var_os("LESS").is_none() {
        pager.env("LESS", LESS.1);
    }
    (program != "cat").then_some(pager)
}

/// Whether `text` needs more lines than the terminal has on which stdout is; it has any number where it does not tell.
fn is_longer_than_screen(text: &str) -> bool {
    let stdout = io::stdout();
    if !stdout.is_terminal() {
        return false;
    }
    let Ok(size) = tcgetwinsize(&stdout) else {
        return true;
    };
    let columns = usize::from(size.ws_col.max(1));
    let lines = text
        .lines()
        .map(|line| line.chars().count().div_ceil(columns).max(1));
    lines.sum::<usize>() >= usize::from(size.ws_row)
}
