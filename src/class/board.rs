//! The board: the class on a second terminal, for the teacher. Seats, votes, notes, and the clock.

use super::folder::{Folder, Stage, State};
use super::seat::Presence;
use super::votes::{self, Sitting, Tally, sittings};
use super::{login, unix_ms};
use crate::lessons::{Asked, Lesson, Page};
use crate::text::number::counted;
use crate::text::wrap::wrapped;
use chrono::Local;

/// The lines of the board, at most `width` columns wide.
pub fn lines(folder: &Folder, width: usize) -> Vec<String> {
    let seats = sittings(folder);
    let mut board = vec![head(&seats)];
    if folder.is_full() {
        board.push("the disk is full: what is answered now cannot be kept".to_owned());
    }
    match folder.state() {
        Err(reason) => board.push(reason),
        Ok(None) => {
            board.push("no class has begun here: gyrolab class LESSON --folder DIR".to_owned())
        }
        Ok(Some(state)) => {
            if !state.is_on {
                board.push("the class is over".to_owned());
            } else if !folder.is_teacher_alive() {
                board.push(
                    "the teacher's lab is gone: gyrolab class --resume --folder DIR".to_owned(),
                );
            }
            let lesson = folder.lesson(&state.lesson);
            let page = lesson
                .as_ref()
                .and_then(|lesson| Some((lesson, lesson.page(state.page)?)));
            if let Some((lesson, page)) = page {
                board.extend(of_page(lesson, page, &state, &seats));
            }
            board.push(String::new());
            board.extend(of_seats(folder, &state, &seats, width));
        }
    }
    let fitted = |line: &String| {
        if line.chars().count() <= width {
            vec![line.clone()] // with its blanks
        } else {
            wrapped(line, width)
        }
    };
    board.iter().flat_map(fitted).collect()
}

fn head(seats: &[Sitting]) -> String {
    let count = |presence| {
        seats
            .iter()
            .filter(|sitting| sitting.presence == presence)
            .count()
    };
    let (here, lost, away) = (
        count(Presence::Here),
        count(Presence::Lost),
        count(Presence::Away),
    );
    let time = Local::now().format("%H:%M");
    format!("{time} · {here} here, {lost} lost, {away} away")
}

fn of_page(lesson: &Lesson, page: &Page, state: &State, seats: &[Sitting]) -> Vec<String> {
    let blank =
        |text: &crate::lessons::text::Text| text.filled(|_, _| "…".to_owned()).trim().to_owned();
    let heading = format!(
        "{} of {} · {} · {}",
        page.number,
        lesson.pages.len(),
        page.heading,
        lesson.title
    );
    let mut lines = vec![String::new(), heading];
    for predict in page.predicts() {
        let question = state.question(&predict.name);
        lines.extend([String::new(), format!("? {}", blank(&predict.ask))]);
        if let Asked::Choice(choices) = &predict.asked {
            let named = choices.iter().enumerate();
            lines.extend(named.map(|(index, choice)| format!("  {} {choice}", index + 1)));
        }
        for round in 1..=question.round() {
            let tally = Tally::of(seats, &state.lesson, predict, round);
            lines.push(format!(
                "  round {round}: {} votes, {} late",
                tally.votes, tally.late
            ));
            // While the round goes on nobody's choice is shown.
            if round < question.round() || question.stage != Stage::Counted {
                let bars = votes::drawn(&tally.bars).text();
                lines.extend(bars.lines().map(|bar| format!("    {bar}")));
                lines.extend(tally.advice(predict).map(|advice| format!("    {advice}")));
            }
        }
    }
    let notes = page.notes().map(|notes| format!("| {}", blank(notes)));
    lines.extend(notes.flat_map(|notes| [String::new(), notes]));
    let next = lesson.page(page.number + 1);
    lines.extend(next.map(|next| format!("next: {}", next.heading)));
    lines
}

fn of_seats(folder: &Folder, state: &State, seats: &[Sitting], width: usize) -> Vec<String> {
    let opened = |name: &str| state.opened.get(name).copied().unwrap_or(0);
    let locked = login::locked(folder, opened, unix_ms() / 1000).into_iter();
    let mut lines: Vec<_> = locked
        .map(|name| format!("{name}: locked by wrong codes"))
        .collect();
    let cell = |sitting: &Sitting| {
        let word = &sitting.seat.word;
        let presence = match (state.closed.contains(word), sitting.presence) {
            (true, _) => "closed",
            (_, Presence::Away) => "away",
            (_, Presence::Lost) => "lost",
            (_, Presence::Here) if sitting.record.is_aside => "aside",
            (_, Presence::Here) => "here",
        };
        let votes = sitting
            .record
            .votes
            .iter()
            .filter(|vote| vote.lesson == state.lesson)
            .count();
        format!("{word} {presence}, {}", counted(votes as u64, "vote"))
    };
    let cells: Vec<_> = seats.iter().map(cell).collect();
    let widest = cells
        .iter()
        .map(|cell| cell.chars().count())
        .max()
        .unwrap_or(0)
        + 2;
    let row = |row: &[String]| {
        let row: String = row.iter().map(|cell| format!("{cell:<widest$}")).collect();
        row.trim_end().to_owned()
    };
    lines.extend(cells.chunks((width / widest).max(1)).map(row));
    lines
}
