//! The board: the class on a second terminal, for the teacher. Seats, votes, notes, and the clock.

use super::folder::{Folder, Stage, State};
use super::votes::{self, Sitting, Tally, present, sittings};
use super::{login, unix_ms};
use crate::lessons::text::Text;
use crate::lessons::{Asked, Page, Predict, reading};
use crate::text::number::counted;
use crate::text::wrap::{columns, wrapped};
use chrono::Local;

/// The lines of the board, at most `width` columns wide.
pub fn lines(folder: &Folder, width: usize) -> Vec<String> {
    let seats = sittings(folder);
    let [here, lost, aside] = present(&seats);
    let time = Local::now().format("%H:%M");
    let mut board = vec![format!("{time} · {here} here, {lost} lost, {aside} aside")];
    if folder.is_full() {
        board.push("the disk is full: what is answered now cannot be kept".to_owned());
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
                let resumes = "the teacher's lab is gone: gyrolab class --resume --folder DIR";
                board.push(resumes.to_owned());
            }
            board.extend(of_page(&state, &seats));
            board.push(String::new());
            board.extend(of_seats(folder, &state, &seats, width));
        }
    }
    let fitted = |line: &String| match columns(line) {
        fits if fits <= width => vec![line.clone()], // with its blanks
        _ => wrapped(line, width),
    };
    board.iter().flat_map(fitted).collect()
}

/// The page: its questions with their votes, its notes, and the next page.
fn of_page(state: &State, seats: &[Sitting]) -> Vec<String> {
    let lesson = match reading::open(&state.lesson) {
        Ok(lesson) => lesson,
        Err(problems) => return vec![problems.to_string()],
    };
    let Some(page) = lesson.page(state.page) else {
        return Vec::new();
    };
    let (number, pages) = (page.number, lesson.pages.len());
    let heading = format!("{number} of {pages} · {} · {}", page.heading, lesson.title);
    let mut lines = vec![String::new(), heading];
    for predict in page.predicts() {
        lines.extend([String::new(), format!("? {}", blank(&predict.ask))]);
        if let Asked::Choice(choices) = &predict.asked {
            let named = (1..).zip(choices);
            lines.extend(named.map(|(number, choice)| format!("  {number} {choice}")));
        }
        lines.extend(of_rounds(predict, state, seats));
    }
    let notes = page.notes().map(blank);
    lines.extend(notes.flat_map(|notes| [String::new(), format!("| {notes}")]));
    let next = lesson.page(page.number + 1);
    lines.extend(next.map(|next: &Page| format!("next: {}", next.heading)));
    lines
}

/// The votes on `predict`, a round after the other. While a round goes on nobody's choice is shown.
fn of_rounds(predict: &Predict, state: &State, seats: &[Sitting]) -> Vec<String> {
    let question = state.question(&predict.name);
    let round_of = |round| {
        let tally = Tally::of(seats, &state.lesson, predict, round);
        let (votes, late) = (counted(tally.votes as u64, "vote"), tally.late);
        let is_shown = round < question.round() || question.stage != Stage::Counted;
        let bars = votes::drawn(&tally.bars).text();
        let bars = bars.lines().map(str::to_owned).chain(tally.advice);
        let bars = bars.filter(|_| is_shown).map(|bar| format!("    {bar}"));
        let counts = format!("  round {round}: {votes}, {late} late");
        [counts].into_iter().chain(bars).collect::<Vec<_>>()
    };
    (1..=question.round()).flat_map(round_of).collect()
}

fn blank(text: &Text) -> String {
    text.filled(|_, _| "…".to_owned()).trim().to_owned()
}

/// The seats in columns, and the names that are locked.
fn of_seats(folder: &Folder, state: &State, seats: &[Sitting], width: usize) -> Vec<String> {
    let locked = login::locked(folder, unix_ms() / 1000).into_iter();
    let locked = locked.map(|name| format!("{name}: locked by wrong codes"));
    let cell = |sitting: &Sitting| {
        let votes = sitting.record.votes.iter();
        let votes = votes.filter(|vote| vote.lesson == state.lesson).count();
        let votes = counted(votes as u64, "vote");
        format!("{}, {votes}", sitting.in_words(state))
    };
    let cells: Vec<_> = seats.iter().map(cell).collect();
    let widest = cells.iter().map(|cell| columns(cell)).max().unwrap_or(0) + 2;
    let row = |row: &[String]| {
        let row: String = row.iter().map(|cell| format!("{cell:<widest$}")).collect();
        row.trim_end().to_owned()
    };
    let rows = cells.chunks((width / widest).max(1)).map(row);
    locked.chain(rows).collect()
}
