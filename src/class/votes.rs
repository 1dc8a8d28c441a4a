//! The votes on a question: counted, as bars, as advice to the teacher, and as CSV.

use super::ClassFolder;
use super::folder::{ClassState, QuestionState};
use super::seat::{Presence, Seat, SeatRecord, all_seats};
use crate::engine::text::number::{shortest, significant};
use crate::engine::text::printable::printable;
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lessons::lesson::Right;
use crate::lessons::predictions::{LessonProgress, LockedAnswer};
use crate::lessons::state::KeptLessons;
use crate::lessons::{AnswerKind, LessonPage, Predict, PredictionAnswer, opening};
use chrono::{DateTime, Utc};
use std::collections::BTreeMap;

/// Minimum votes for the students to see bars. With fewer, they could guess who voted for what.
pub const FEWEST_VOTES_SHOWN: usize = 5;
/// Maximum number of bars of predicted numbers.
const MOST_BARS: usize = 9;
/// Columns of the longest bar.
const LONGEST_BAR: usize = 28;

/// A seat with its record and its presence.
#[derive(Clone, Debug)]
pub struct SeatStatus {
    pub seat: Seat,
    pub is_aside: bool,
    pub lessons: BTreeMap<String, LessonProgress>,
    pub presence: Presence,
    /// Reason if its file cannot be read. The seat then has no lessons here.
    pub trouble: Option<String>,
}

/// Returns the status of every seat of the class.
///
/// # Errors
///
/// Returns an error if the folder of the seats cannot be read.
pub fn seat_statuses(folder: &ClassFolder) -> Result<Vec<SeatStatus>, String> {
    let seats = all_seats(folder)?.into_iter();
    Ok(seats.map(SeatStatus::read).collect())
}

/// Returns the number of `seats` that are here, and a text with all counts by presence.
pub fn present(seats: &[SeatStatus]) -> (usize, String) {
    let (mut here, mut aside, mut lost, mut away) = (0, 0, 0, 0);
    for seat in seats {
        match seat.presence {
            Presence::Here => here += 1,
            Presence::Lost => lost += 1,
            Presence::Away => away += 1,
        }
        aside += usize::from(seat.is_here() && seat.is_aside);
    }
    let mut words = format!("{here} here");
    for (count, how) in [(aside, "not following"), (lost, "lost"), (away, "away")] {
        if count > 0 {
            words += &format!(", {count} {how}");
        }
    }
    (here, words)
}

impl SeatStatus {
    /// Reads the file of `seat`.
    pub fn read(seat: Seat) -> Self {
        let (places, trouble) = match seat.places() {
            Ok(places) => (places, None),
            Err(trouble) => (<(SeatRecord, KeptLessons)>::default(), Some(trouble)),
        };
        let (record, kept) = places;
        Self {
            is_aside: record.is_aside,
            lessons: kept.lessons,
            presence: seat.presence(),
            seat,
            trouble,
        }
    }

    pub fn is_here(&self) -> bool {
        self.presence == Presence::Here
    }

    /// Returns the answer of the seat to `of`, a question of `lesson`, in this round.
    pub fn vote<'a>(
        &'a self,
        lesson: &str,
        of: &'a Predict,
        round: u32,
    ) -> Option<&'a LockedAnswer> {
        let place = self.lessons.get(lesson)?;
        place.predictions.in_round(of, round)
    }

    /// Returns the standing of the seat in the class, whose current question is `asked`.
    pub fn standing(
        &self,
        state: &ClassState,
        asked: Option<&(&Predict, QuestionState)>,
    ) -> SeatStanding {
        match (self.presence, asked) {
            _ if state.closed.contains(&self.seat.word) => SeatStanding::Closed,
            (Presence::Away, _) => SeatStanding::Away,
            (Presence::Lost, _) => SeatStanding::Lost,
            (Presence::Here, None) => SeatStanding::Here,
            (Presence::Here, Some((predict, question))) => {
                let vote = self.vote(&state.lesson, predict, question.round());
                if vote.is_some() {
                    SeatStanding::Answered
                } else {
                    SeatStanding::NotAnswered
                }
            }
        }
    }

    /// Returns the word of the seat and its standing, as the teacher's lists show them.
    pub fn in_words(&self, standing: SeatStanding) -> String {
        let aside = if self.is_aside && standing.is_here() {
            ", not following"
        } else {
            ""
        };
        let unread = if self.trouble.is_some() {
            ", its file cannot be read"
        } else {
            ""
        };
        let word = &self.seat.word;
        format!("{word}: {}{aside}{unread}", standing.words())
    }
}

/// Standing of a seat in the class, in the order of the teacher's lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SeatStanding {
    NotAnswered,
    Answered,
    /// A student is here, and the page asks nothing.
    Here,
    Lost,
    Away,
    Closed,
}

impl SeatStanding {
    pub fn is_here(self) -> bool {
        matches!(self, Self::NotAnswered | Self::Answered | Self::Here)
    }

    pub fn words(self) -> &'static str {
        match self {
            Self::NotAnswered => "not answered",
            Self::Answered => "answered",
            Self::Here => "here",
            Self::Lost => "lost",
            Self::Away => "away",
            Self::Closed => "closed",
        }
    }
}

/// Returns `seats` with their standings: first those that have not answered, then those that have, then the rest; by
/// name within each group.
pub fn in_order<'a>(
    seats: &'a [SeatStatus],
    state: &ClassState,
    asked: Option<&(&Predict, QuestionState)>,
) -> Vec<(SeatStanding, &'a SeatStatus)> {
    let standings = seats.iter().map(|seat| (seat.standing(state, asked), seat));
    let mut ordered: Vec<_> = standings.collect();
    ordered.sort_by_key(|(standing, _)| *standing); // a stable sort
    ordered
}

/// The votes in one round of a question.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Name and count of each answer.
    pub bars: Vec<(String, usize)>,
    /// Number of votes in time.
    pub votes: usize,
    pub late: usize,
    pub late_bars: Vec<(String, usize)>,
    /// The right answer, the percentage of right votes, and the next action, if the lesson states the right answer.
    pub advice: Option<String>,
}

impl Tally {
    pub fn count(seats: &[SeatStatus], lesson: &str, predict: &Predict, round: u32) -> Self {
        let (mut choices, mut late) = (Vec::new(), Vec::new());
        for vote in seats
            .iter()
            .filter_map(|it| it.vote(lesson, predict, round))
        {
            let numbers = if vote.late { &mut late } else { &mut choices };
            numbers.extend(predict.asked.number(&vote.answer));
        }
        let right = predict.right.as_ref();
        Self {
            votes: choices.len(),
            late: late.len(),
            advice: right.and_then(|right| advice(right, &choices)),
            bars: bars(&predict.asked, choices),
            late_bars: bars(&predict.asked, late),
        }
    }

    /// Returns the bars for the teacher, with those of late votes below.
    pub fn drawn(&self) -> Paragraph {
        let mut text = drawn(&self.bars).text();
        if self.late > 0 {
            text += &format!("late:\n{}", drawn(&self.late_bars).text());
        }
        Paragraph::new(SheetLineKind::Code, text)
    }
}

fn advice(right: &Right, choices: &[f64]) -> Option<String> {
    let hits = choices.iter().filter(|choice| right.accepts(**choice));
    let all = Some(choices.len()).filter(|all| *all > 0)?;
    let percent = (100 * hits.count() + all / 2) / all;
    let next = match percent {
        ..30 => "explain, then ask again",
        30..=70 => "let them talk, then ask again",
        _ => "go on",
    };
    let answer = match right {
        Right::Choice(number) => number.to_string(),
        Right::Number { value, within } => format!("{} ± {}", shortest(*value), shortest(*within)),
    };
    Some(format!("right is {answer}, {percent} % chose it: {next}"))
}

fn bars(asked: &AnswerKind, answers: Vec<f64>) -> Vec<(String, usize)> {
    let AnswerKind::Choice(all) = asked else {
        return bars_of_numbers(answers);
    };
    let mut bars = Vec::new();
    for number in 1..=all.len() {
        let given = answers.iter().filter(|it| **it == number as f64);
        bars.push((number.to_string(), given.count()));
    }
    bars
}

/// Returns the most frequent numbers, rounded to two digits, in ascending order.
fn bars_of_numbers(mut numbers: Vec<f64>) -> Vec<(String, usize)> {
    numbers.sort_by(f64::total_cmp);
    let mut bars: Vec<(String, usize)> = Vec::new();
    for number in numbers {
        let name = significant(number, 2);
        match bars.last_mut() {
            Some((last, count)) if *last == name => *count += 1,
            _ => bars.push((name, 1)),
        }
    }
    let mut counts: Vec<_> = bars.iter().map(|(_, count)| *count).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let least = counts.get(MOST_BARS - 1).copied().unwrap_or(1);
    bars.retain(|(_, count)| *count >= least);
    bars.truncate(MOST_BARS);
    bars
}

/// Returns `bars` as a paragraph with one line per bar.
pub fn drawn(bars: &[(String, usize)]) -> Paragraph {
    let most = bars.iter().map(|bar| bar.1).max().unwrap_or(0).max(1);
    let width = bars.iter().map(|bar| bar.0.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, count) in bars {
        let bar = "━".repeat((count * LONGEST_BAR).div_ceil(most));
        text += &format!("{name:<width$} {bar} {count}\n");
    }
    Paragraph::new(SheetLineKind::Code, text)
}

/// Returns the current question on `page`: the first that is not closed, or else the first.
pub fn question<'a>(
    page: &'a LessonPage,
    state: &ClassState,
) -> Option<(&'a Predict, QuestionState)> {
    let mut all = page.predicts();
    let open = all.find(|it| !state.question(&it.name).is_closed);
    let asked = open.or_else(|| page.predicts().next())?;
    Some((asked, state.question(&asked.name)))
}

const VOTE_COLUMNS: [&str; 8] = [
    "lesson", "question", "round", "seat", "choice", "late", "page", "time",
];

/// Returns the votes of `seats` as CSV, by seat, lesson and question. A choice that the lesson no longer has is written
/// as its text.
pub fn csv(folder: &ClassFolder, seats: &[SeatStatus]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(VOTE_COLUMNS)?;
    let mut read = BTreeMap::new();
    for status in seats {
        for (name, place) in &status.lessons {
            let lesson = read
                .entry(name.clone())
                .or_insert_with(|| opening::open_again(name).ok());
            for (question, given) in place.predictions.all() {
                let predict = lesson.as_ref().and_then(|lesson| lesson.predict(question));
                writer.write_record([
                    printable(folder.short(name)).as_ref(),
                    printable(question).as_ref(),
                    &given.round.to_string(),
                    &status.seat.word,
                    &answer_in_words(predict, given),
                    &given.late.to_string(),
                    &given.page.to_string(),
                    &time(given),
                ])?;
            }
        }
    }
    let bytes = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Returns `given` as a number: the predicted number, or the number of the choice, from 1. A choice that `predict` does
/// not have is written as its text.
pub(super) fn answer_in_words(predict: Option<&Predict>, given: &LockedAnswer) -> String {
    match &given.answer {
        PredictionAnswer::Number(number) => shortest(*number),
        PredictionAnswer::Choice(words) => predict
            .and_then(|predict| predict.asked.number(&given.answer))
            .map_or_else(|| printable(words).into_owned(), shortest),
    }
}

/// Returns the time of `given` in the format of RFC 3339.
fn time(given: &LockedAnswer) -> String {
    let time = DateTime::<Utc>::from_timestamp(given.time_unix_s as i64, 0).unwrap_or_default();
    time.format("%Y-%m-%dT%H:%M:%SZ").to_string()
}
