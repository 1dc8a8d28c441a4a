//! A rehearsal: players take seats and answer the questions of a class, so that a teacher can practice alone.
//!
//! A player writes the files of its seat with the same functions as a student's lab. The teacher's lab, the board and
//! the projector thus work as in a class. A player's actions depend only on its number, the question and the round.
//! Most answer within 20 s. With three players or more, the last one takes 45 s, and the one before it leaves on every
//! page until the teacher gathers the class. About half of the first answers are right, and most later ones.

use super::folder::{ClassFolder, ClassState};
use super::seat::{Seat, SeatRecord};
use super::{CLASS_POLL_INTERVAL, login, unix_ms, votes};
use crate::lessons::clock::unix_s;
use crate::lessons::lesson::Right;
use crate::lessons::predictions::LockedAnswer;
use crate::lessons::state::KeptLessons;
use crate::lessons::{AnswerKind, Lesson, LessonPage, Predict, PredictionAnswer, opening};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use toml::Table;

/// Maximum number of players.
pub const MOST_PLAYERS: u64 = 30;
/// Time of the first usual answer, ms after the question.
const FIRST_ANSWER_MS: u64 = 3_000;
/// Time of the last usual answer, ms after the question.
const LAST_ANSWER_MS: u64 = 20_000;
/// Time of the slow player's answer, ms after the question.
const SLOW_ANSWER_MS: u64 = 45_000;
/// Time at which a player leaves, ms after the page was opened.
const ASIDE_AFTER_MS: u64 = 12_000;
/// Right answers in the first round, percent.
const RIGHT_AT_FIRST: u64 = 45;
/// Right answers in later rounds, percent.
const RIGHT_LATER: u64 = 80;

/// The players of a rehearsal. They stop when this value is dropped.
#[derive(Debug)]
pub struct Players {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Players {
    /// Starts `count` players, who take seats in `folder`.
    ///
    /// # Errors
    ///
    /// Returns an error if a seat cannot be taken.
    pub fn start(folder: &ClassFolder, count: u64) -> Result<Self, String> {
        let players: Result<Vec<_>, _> = (1..=count)
            .map(|number| Player::new(folder, number, count))
            .collect();
        let is_over = Arc::new(AtomicBool::new(false));
        let (mut players, folder, ends) = (players?, folder.clone(), Arc::clone(&is_over));
        let thread = thread::Builder::new().spawn(move || {
            let mut lesson = None;
            while !ends.load(Ordering::Relaxed) {
                play(&folder, &mut lesson, &mut players);
                thread::sleep(CLASS_POLL_INTERVAL);
            }
        });
        Ok(Self {
            is_over,
            thread: Some(thread.map_err(|error| format!("the players cannot start: {error}"))?),
        })
    }
}

impl Drop for Players {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // a thread that panicked has ended too
        }
    }
}

/// Lets every player read the class's state and act. `lesson` caches the class's lesson.
fn play(folder: &ClassFolder, lesson: &mut Option<Lesson>, players: &mut [Player]) {
    let Ok(Some(state)) = folder.state() else {
        return players.iter().for_each(Player::send_heartbeat);
    };
    if lesson.as_ref().is_none_or(|it| it.name != state.lesson) {
        *lesson = opening::open_again(&state.lesson).ok();
    }
    let page = lesson.as_ref().and_then(|lesson| lesson.page(state.page));
    for player in players {
        player.advance(&state, page);
    }
}

/// A simulated student.
#[derive(Debug)]
struct Player {
    number: u64,
    /// Number of players.
    of: u64,
    seat: Seat,
    /// Token under which the seat is open; `None` while the teacher has closed it.
    lock_token: Option<String>,
    record: SeatRecord,
    lessons: KeptLessons,
    /// Page of the class.
    page: (String, usize),
    /// Time at which the page was first seen, ms since 1970.
    page_since_ms: u64,
}

impl Player {
    fn new(folder: &ClassFolder, number: u64, of: u64) -> Result<Self, String> {
        let (seat, _) = login::claim(folder, &format!("player{number}"), unix_s())?;
        Ok(Self {
            number,
            of,
            lock_token: Some(seat.hold()?),
            seat,
            record: SeatRecord::default(),
            lessons: KeptLessons::default(),
            page: (String::new(), 0),
            page_since_ms: 0,
        })
    }

    fn send_heartbeat(&self) {
        if let Some(token) = &self.lock_token {
            self.seat.is_held(token);
        }
    }

    fn is_slow(&self) -> bool {
        self.of >= 3 && self.number == self.of
    }

    fn steps_aside(&self) -> bool {
        self.of >= 3 && self.number + 1 == self.of
    }

    fn advance(&mut self, state: &ClassState, page: Option<&LessonPage>) {
        let is_closed = state.closed.contains(&self.seat.word);
        match (&self.lock_token, is_closed) {
            (Some(token), true) => {
                self.seat.leave(token);
                self.lock_token = None;
            }
            (None, false) => self.lock_token = self.seat.hold().ok(),
            _ => {}
        }
        self.send_heartbeat();
        if is_closed || !state.is_on {
            return;
        }
        let before = self.record.clone();
        let now_ms = unix_ms();
        if (&self.page.0, self.page.1) != (&state.lesson, state.page) {
            self.page = (state.lesson.clone(), state.page);
            self.page_since_ms = now_ms;
        }
        let has_wandered = now_ms >= self.page_since_ms.max(state.gathered_ms) + ASIDE_AFTER_MS;
        if self.record.is_aside && state.gathered_ms > self.record.aside_since_ms {
            self.record.is_aside = false;
        } else if self.steps_aside()
            && !self.record.is_aside
            && has_wandered
            && state.gathered_ms < self.page_since_ms
        {
            (self.record.is_aside, self.record.aside_since_ms) = (true, now_ms);
        }
        if let Some(page) = page {
            self.take_page(state, page, now_ms);
        }
        self.record.lessons = Table::try_from(&self.lessons).unwrap_or_default();
        if self.record != before {
            let _ = self.seat.save(&self.record); // the board reports a full disk
        }
    }

    /// Records the class's `page`, and answers its question when it is time.
    fn take_page(&mut self, state: &ClassState, page: &LessonPage, now_ms: u64) {
        self.lessons.open = Some(state.lesson.clone());
        let lessons = &mut self.lessons.lessons;
        let place = lessons.entry(state.lesson.clone()).or_default();
        place.page = page.number;
        if state.has_arrived {
            let outcomes = page.compares().map(|compare| compare.prediction.clone());
            place.seen.extend(outcomes);
        }
        let Some((predict, question)) = votes::question(page, state) else {
            return;
        };
        let round = question.round();
        let asked_ms = question.since_ms.max(self.page_since_ms);
        let is_time = now_ms >= asked_ms + self.delay_ms(&predict.name, round);
        let is_open = !question.is_closed_at(now_ms);
        if is_open && is_time && !self.record.is_aside {
            self.answer(&state.lesson, predict, round);
        }
    }

    fn answer(&mut self, lesson: &str, predict: &Predict, round: u32) {
        let answer = self.choice(predict, round);
        let Some(place) = self.lessons.lessons.get_mut(lesson) else {
            return;
        };
        let given = LockedAnswer {
            round,
            answer,
            late: place.seen.contains(&predict.name),
            page: place.page,
            time_unix_s: unix_s(),
        };
        let _ = place.predictions.lock(predict, given); // refused if it has already answered
    }

    fn delay_ms(&self, question: &str, round: u32) -> u64 {
        if self.is_slow() {
            return SLOW_ANSWER_MS;
        }
        let range_ms = LAST_ANSWER_MS - FIRST_ANSWER_MS;
        FIRST_ANSWER_MS + self.drawn(question, round, "delay") % range_ms
    }

    fn choice(&self, predict: &Predict, round: u32) -> PredictionAnswer {
        let percent = if round == 1 {
            RIGHT_AT_FIRST
        } else {
            RIGHT_LATER
        };
        let is_right = self.drawn(&predict.name, round, "right") % 100 < percent;
        let drawn = self.drawn(&predict.name, round, "choice");
        match (&predict.asked, &predict.right) {
            (AnswerKind::Choice(all), right) => {
                let answers = all.len() as u64;
                let right_at = match right {
                    Some(Right::Choice(number)) => Some(*number as u64 - 1),
                    _ => None,
                };
                let at = match right_at {
                    Some(at) if is_right => at,
                    Some(at) => (at + 1 + drawn % (answers - 1)) % answers,
                    None => drawn % answers,
                };
                PredictionAnswer::Choice(all[at as usize].clone())
            }
            (AnswerKind::Number { .. }, Some(Right::Number { value, .. })) if is_right => {
                PredictionAnswer::Number(*value)
            }
            (AnswerKind::Number { .. }, Some(Right::Number { value, .. })) => {
                let wrong = [value / 2.0, value * 2.0, value * 1.5, value + 10.0];
                PredictionAnswer::Number(wrong[(drawn % 4) as usize])
            }
            (AnswerKind::Number { .. }, _) => PredictionAnswer::Number((1 + drawn % 9) as f64),
        }
    }

    /// Returns a pseudorandom number that depends only on the player, the question, the round, and its purpose.
    fn drawn(&self, question: &str, round: u32, for_what: &str) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.number, question, round, for_what).hash(&mut hasher);
        hasher.finish()
    }
}
