//! What the seats of a class have predicted beside what came out: for the teacher a file for each seat, for a student over
//! SSH their own.

use super::args::DisplayArgs;
use super::class::unread;
use super::new_lab::{new_lab, refused};
use super::progress::Interruption;
use super::{print, progress, tell};
use crate::class::folder::ClassFolder;
use crate::class::login;
use crate::class::votes::{SeatStatus, seat_statuses};
use crate::engine::export::Destination;
use crate::engine::text::printable::{PrintablePath, printable};
use crate::lessons::clock::unix_s;
use crate::lessons::{handout, opening};
use anyhow::{Context, bail, ensure};
use std::path::Path;
use std::process::ExitCode;

/// The command that a student's ssh may name: `ssh class@HOST answers SEAT`.
const ANSWERS: &str = "answers";

/// Writes the answers of each seat into the folder `output`, a Markdown file for each.
pub(super) fn write_all(
    folder: &ClassFolder,
    output: &Path,
    force: bool,
    look: DisplayArgs,
) -> anyhow::Result<ExitCode> {
    std::fs::create_dir_all(output).with_context(|| PrintablePath(output).to_string())?;
    let interruption = progress::interruption()?;
    let seats = seat_statuses(folder).map_err(anyhow::Error::msg)?;
    let mut code = unread(&seats);
    let mut files = 0;
    for seat in &seats {
        let told = told(seat, look, &interruption)?;
        if told.is_partial {
            code = ExitCode::FAILURE;
        }
        if !told.text.is_empty() {
            let path = output.join(format!("{}.md", seat.seat.word));
            let file = Destination::open_file(&path, force)?;
            file.write_and_keep(told.text.as_bytes())?;
            files += 1;
        }
    }
    tell(format_args!(
        "gyrolab: the answers of {files} seats are in {}",
        PrintablePath(output)
    ));
    Ok(code)
}

/// Prints the answers of the seat that `command`, the command of a student's ssh, names. While a class is on nothing is
/// printed: the answers tell what comes out.
pub(super) fn fetch(
    folder: &ClassFolder,
    command: &str,
    look: DisplayArgs,
) -> anyhow::Result<ExitCode> {
    let words: Vec<_> = command.split_whitespace().collect();
    let [ANSWERS, word] = words[..] else {
        bail!(
            "{}: this login has one command, {ANSWERS} SEAT (SEAT is the word of your seat, such as anna-471108); \
             without a command it opens your lab",
            printable(command)
        );
    };
    let seat = login::find(folder, word, unix_s()).map_err(anyhow::Error::msg)?;
    let is_on = folder
        .state()
        .is_ok_and(|state| state.is_some_and(|state| state.is_on));
    ensure!(
        !(is_on && folder.is_teacher_alive()),
        "a class is on: fetch your answers when it is over"
    );
    let status = SeatStatus::read(seat);
    let code = unread(std::slice::from_ref(&status));
    let told = told(&status, look, &progress::interruption()?)?;
    if told.text.is_empty() {
        bail!(
            "{}: this seat has answered no question yet",
            status.seat.word
        );
    }
    print(&told.text)?;
    Ok(if told.is_partial {
        ExitCode::FAILURE
    } else {
        code
    })
}

/// What a seat has predicted beside what came out.
struct Told {
    /// Markdown; empty where nothing was predicted.
    text: String,
    /// Whether a lesson was left out, because it cannot be opened any more.
    is_partial: bool,
}

fn told(
    status: &SeatStatus,
    look: DisplayArgs,
    interruption: &Interruption,
) -> anyhow::Result<Told> {
    let word = &status.seat.word;
    let mut told = Told {
        text: String::new(),
        is_partial: false,
    };
    for (name, place) in &status.lessons {
        if place.predictions.is_empty() {
            continue;
        }
        let lesson = match opening::open_again(name) {
            Ok(lesson) => lesson,
            Err(problems) => {
                tell(format_args!(
                    "gyrolab: {word}: answers left out: {}",
                    printable(&problems.in_one_line())
                ));
                told.is_partial = true;
                continue;
            }
        };
        let mut meter = interruption.meter();
        if told.text.is_empty() {
            told.text = format!("<!-- seat {word} -->\n");
        }
        told.text += &handout::answers(&lesson, place, new_lab(look)?, &mut meter)
            .map_err(|problem| refused(&lesson, problem))?;
        interruption.may_act_at_once()?;
    }
    Ok(told)
}
