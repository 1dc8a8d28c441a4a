//! The table of a class for a gradebook: one row per seat, with its answers and tasks.

use super::ClassFolder;
use super::seat::name_of;
use super::votes::{SeatStatus, answer_in_words};
use crate::engine::text::printable::printable;
use crate::lessons::lesson::{Lesson, LessonPage, Predict};
use crate::lessons::opening;
use crate::lessons::predictions::{LessonProgress, Tried};
use std::collections::{BTreeMap, BTreeSet};

/// Columns before those of questions and tasks. Moodle's grade import finds a student by `username`.
const FIRST_COLUMNS: [&str; 7] = [
    "username",
    "seat",
    "questions_answered",
    "questions_right",
    "answers_late",
    "tasks_done",
    "tasks_shown",
];

/// A column of the table: the answers to a question in one round, or the progress in a task.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum TableColumn {
    Answer {
        lesson: String,
        question: String,
        round: u32,
    },
    Task {
        lesson: String,
        heading: String,
    },
}

/// Totals of a seat over all its lessons.
#[derive(Clone, Copy, Debug, Default)]
struct Totals {
    answered: usize,
    right: usize,
    late: usize,
    tasks_done: usize,
    tasks_shown: usize,
}

/// Returns the table of `seats` as CSV.
///
/// It has a row for each seat, a column for each round of each answered question, and one for each task that anyone
/// tried. A choice is written as its number, from 1. A late answer counts only in `answers_late`, and its cell is
/// empty. A question is right if the answer of its last round is.
pub fn csv(folder: &ClassFolder, seats: &[SeatStatus]) -> Result<String, csv::Error> {
    let names: BTreeSet<_> = seats.iter().flat_map(|seat| seat.lessons.keys()).collect();
    let lessons: BTreeMap<_, _> = names
        .into_iter()
        .filter_map(|name| Some((name.clone(), opening::open_again(name).ok()?)))
        .collect();
    let columns: BTreeSet<_> = seats.iter().flat_map(columns).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let titles = columns.iter().map(|column| column.title(folder));
    writer.write_record(FIRST_COLUMNS.map(str::to_owned).into_iter().chain(titles))?;
    for seat in seats {
        let totals = Totals::of(seat, &lessons);
        let word = &seat.seat.word;
        let first = [
            name_of(word).unwrap_or(word).to_owned(),
            word.clone(),
            totals.answered.to_string(),
            totals.right.to_string(),
            totals.late.to_string(),
            totals.tasks_done.to_string(),
            totals.tasks_shown.to_string(),
        ];
        let cells = columns.iter().map(|column| column.cell(seat, &lessons));
        writer.write_record(first.into_iter().chain(cells))?;
    }
    let bytes = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Returns the columns in which `seat` has a value.
fn columns(seat: &SeatStatus) -> Vec<TableColumn> {
    let mut columns = Vec::new();
    for (lesson, place) in &seat.lessons {
        for (question, given) in place.predictions.all() {
            columns.push(TableColumn::Answer {
                lesson: lesson.clone(),
                question: question.clone(),
                round: given.round,
            });
        }
        for heading in place.tasks.keys() {
            columns.push(TableColumn::Task {
                lesson: lesson.clone(),
                heading: heading.clone(),
            });
        }
    }
    columns
}

impl TableColumn {
    fn title(&self, folder: &ClassFolder) -> String {
        let title = match self {
            Self::Answer {
                lesson,
                question,
                round,
            } => format!("{}: {question}, round {round}", folder.short(lesson)),
            Self::Task { lesson, heading } => {
                format!("{}: task \"{heading}\"", folder.short(lesson))
            }
        };
        printable(&title).into_owned()
    }

    fn cell(&self, seat: &SeatStatus, lessons: &BTreeMap<String, Lesson>) -> String {
        match self {
            Self::Answer {
                lesson,
                question,
                round,
            } => {
                let place = seat.lessons.get(lesson);
                let answers = place.into_iter().flat_map(|place| place.predictions.all());
                let mut on_time = answers.filter(|(_, given)| !given.late);
                let found =
                    on_time.find(|(name, given)| *name == question && given.round == *round);
                let predict = lessons.get(lesson).and_then(|it| it.predict(question));
                found.map_or_else(String::new, |(_, given)| answer_in_words(predict, given))
            }
            Self::Task { lesson, heading } => {
                let place = seat.lessons.get(lesson);
                let tried = place.and_then(|place| place.tasks.get(heading));
                tried.map_or_else(String::new, |tried| Tried::words(Some(tried)).to_owned())
            }
        }
    }
}

impl Totals {
    fn of(seat: &SeatStatus, lessons: &BTreeMap<String, Lesson>) -> Self {
        let mut totals = Self::default();
        for (name, place) in &seat.lessons {
            let lesson = lessons.get(name);
            let predicts = lesson.into_iter().flat_map(|lesson| &lesson.pages);
            for predict in predicts.flat_map(LessonPage::predicts) {
                totals.add_question(predict, place);
            }
            for tried in place.tasks.values() {
                match tried {
                    Tried::Done | Tried::DoneAfterHint => totals.tasks_done += 1,
                    Tried::Shown => totals.tasks_shown += 1,
                    Tried::Hint => {}
                }
            }
        }
        totals
    }

    fn add_question(&mut self, predict: &Predict, place: &LessonProgress) {
        let answers = place.predictions.to(predict);
        self.late += answers.filter(|given| given.late).count();
        let on_time = place.predictions.to(predict).filter(|given| !given.late);
        let Some(last) = on_time.max_by_key(|given| given.round) else {
            return;
        };
        self.answered += 1;
        let judged = predict
            .asked
            .number(&last.answer)
            .zip(predict.right.as_ref());
        self.right += usize::from(judged.is_some_and(|(number, right)| right.accepts(number)));
    }
}
