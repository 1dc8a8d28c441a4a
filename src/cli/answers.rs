//! Predictions of the seats of a class next to the results: one file per seat for the teacher, or a student's own
//! answers over SSH.

use super::args::DisplayArgs;
use super::class::unread;
use super::new_lab::{new_lab, refused};
use super::progress::Interruption;
use super::{print, progress, tell, warn};
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

/// The command in a student's ssh call: `ssh class@HOST answers SEAT`.
const ANSWERS: &str = "answers";

/// Writes the answers of each seat into the folder `output`, one Markdown file per seat.
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
        let seat_answers = seat_answers(seat, look, &interruption)?;
        if seat_answers.is_partial {
            code = ExitCode::FAILURE;
        }
        if !seat_answers.text.is_empty() {
            let path = output.join(format!("{}.md", seat.seat.word));
            let file = Destination::open_file(&path, force)?;
            file.write_and_keep(seat_answers.text.as_bytes())?;
            files += 1;
        }
    }
    tell(format_args!(
        "gyrolab: the answers of {files} seats are in {}",
        PrintablePath(output)
    ));
    Ok(code)
}

/// Prints the answers of the seat in `command`, the command of a student's ssh call. Fails while a class is running,
/// because the answers contain the results.
pub(super) fn fetch(
    folder: &ClassFolder,
    command: &str,
    look: DisplayArgs,
) -> anyhow::Result<ExitCode> {
    let words: Vec<_> = command.split_whitespace().collect();
    let [ANSWERS, word] = words[..] else {
        bail!(
            "{}: unknown command; this login has only {ANSWERS} SEAT (SEAT is the word of your seat, such as anna-471108); \
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
        "a class is running: fetch your answers after it has ended"
    );
    let status = SeatStatus::read(seat);
    let code = unread(std::slice::from_ref(&status));
    let seat_answers = seat_answers(&status, look, &progress::interruption()?)?;
    if seat_answers.text.is_empty() {
        bail!(
            "{}: this seat has not answered a question yet",
            status.seat.word
        );
    }
    print(&seat_answers.text)?;
    Ok(if seat_answers.is_partial {
        ExitCode::FAILURE
    } else {
        code
    })
}

/// Predictions of a seat next to the results.
struct SeatAnswers {
    /// Markdown; empty without predictions.
    text: String,
    /// True if a lesson is missing because it cannot be opened any more.
    is_partial: bool,
}

fn seat_answers(
    status: &SeatStatus,
    look: DisplayArgs,
    interruption: &Interruption,
) -> anyhow::Result<SeatAnswers> {
    let word = &status.seat.word;
    let mut seat_answers = SeatAnswers {
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
                warn(format_args!(
                    "gyrolab: {word}: answers are missing: {}",
                    printable(&problems.in_one_line())
                ));
                seat_answers.is_partial = true;
                continue;
            }
        };
        let mut meter = interruption.meter();
        if seat_answers.text.is_empty() {
            seat_answers.text = format!("<!-- seat {word} -->\n");
        }
        seat_answers.text += &handout::answers(&lesson, place, new_lab(look)?, &mut meter)
            .map_err(|problem| refused(&lesson, problem))?;
        interruption.may_act_at_once()?;
    }
    Ok(seat_answers)
}
