//! The board: the class on a second terminal, for the teacher, with seats, votes, notes, and the clock.

use super::folder::{ClassFolder, ClassState, VoteStage};
use super::votes::{self, SeatStatus, Tally, in_order, present, seat_statuses};
use super::{login, unix_ms};
use crate::engine::text::number::counted;
use crate::engine::text::wrap::{columns, wrapped};
use crate::lessons::page::for_teacher;
use crate::lessons::{Lesson, LessonPage, Predict, opening};
use chrono::Local;

/// Returns the lines of the board, at most `width` columns wide.
pub fn lines(folder: &ClassFolder, width: usize) -> Vec<String> {
    let (seats, unread) = match seat_statuses(folder) {
        Ok(seats) => (seats, None),
        Err(reason) => (Vec::new(), Some(reason)),
    };
    let time = Local::now().format("%H:%M");
    let mut board = vec![format!("{time} · {}", present(&seats).1)];
    board.extend(unread);
    board.extend(seats.iter().filter_map(|it| it.trouble.clone()));
    for seat in login::waiting(folder, unix_ms() / 1000) {
        board.push(seat.in_words() + "; press k 4 in the teacher's lab to end this");
    }
    if folder.is_full() {
        board.push("the disk is full: new answers cannot be saved".to_owned());
    }
    match folder.state() {
        Err(reason) => board.push(reason),
        Ok(None) => {
            let begins = "no class has begun here: gyrolab class LESSON --folder DIR";
            board.push(begins.to_owned());
        }
        Ok(Some(state)) => {
            if !state.is_on {
                board.push("the class is over".to_owned());
            } else if !folder.is_teacher_alive() {
                let resumes =
                    "the teacher's lab is gone; reopen it with gyrolab class --resume --folder DIR";
                board.push(resumes.to_owned());
            } else if !state.is_followed {
                let alone =
                    "the students work on their own; press k 3 in the teacher's lab to end this";
                board.push(alone.to_owned());
            }
            let lesson = opening::open_again(&state.lesson);
            match &lesson {
                Ok(lesson) => board.extend(page_lines(lesson, &state, &seats)),
                Err(problems) => board.extend(problems.to_string().lines().map(str::to_owned)),
            }
            board.push(String::new());
            let page = lesson.as_ref().ok().and_then(|it| it.page(state.page));
            board.extend(seat_lines(&state, page, &seats, width));
        }
    }
    let mut lines = Vec::new();
    for line in board {
        if columns(&line) <= width {
            lines.push(line); // keeps its blanks
        } else {
            lines.extend(wrapped(&line, width));
        }
    }
    lines
}

/// Returns the page as text, with the votes on its questions.
fn page_lines(lesson: &Lesson, state: &ClassState, seats: &[SeatStatus]) -> Vec<String> {
    let text = for_teacher(lesson, state.page, |predict| {
        round_lines(predict, state, seats)
    });
    text.lines().map(str::to_owned).collect()
}

/// Returns the votes on `predict`, round by round. During a round, no choices are shown.
fn round_lines(predict: &Predict, state: &ClassState, seats: &[SeatStatus]) -> String {
    let question = state.question(&predict.name);
    let mut text = String::new();
    for round in 1..=question.round() {
        let tally = Tally::count(seats, &state.lesson, predict, round);
        let votes = counted(tally.votes as u64, "vote");
        let end = match question.seconds_left(unix_ms()) {
            _ if round < question.round() => String::new(),
            Some(left) => format!(", {left} s left"),
            None if question.is_closed => ", closed".to_owned(),
            None => String::new(),
        };
        text += &format!("  round {round}: {votes}, {} late{end}\n", tally.late);
        if round < question.round() || question.stage != VoteStage::Counted {
            text += &tally.drawn().text();
            text.extend(tally.advice.map(|advice| advice + "\n"));
        }
    }
    text
}

/// Returns the seats in columns, those that have not answered first. `page` is the class's page.
fn seat_lines(
    state: &ClassState,
    page: Option<&LessonPage>,
    seats: &[SeatStatus],
    width: usize,
) -> Vec<String> {
    let asked = page.and_then(|page| votes::question(page, state));
    let ordered = in_order(seats, state, asked.as_ref());
    let mut cells = Vec::new();
    for (standing, status) in &ordered {
        let place = status.lessons.get(&state.lesson);
        let votes = place.map_or(0, |place| place.predictions.all().count());
        let count = counted(votes as u64, "vote");
        cells.push((
            *standing,
            format!("{}, {count}", status.in_words(*standing)),
        ));
    }
    let cell_widths = cells.iter().map(|(_, cell)| columns(cell));
    let widest = cell_widths.max().unwrap_or(0) + 2;
    let mut rows = Vec::new();
    for group in cells.chunk_by(|(one, _), (next, _)| one == next) {
        for row in group.chunks((width / widest).max(1)) {
            let padded = row.iter().map(|(_, cell)| format!("{cell:<widest$}"));
            rows.push(padded.collect::<String>().trim_end().to_owned());
        }
    }
    rows
}
