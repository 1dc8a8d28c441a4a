//! A student's predictions in a lesson. A prediction is locked: it cannot be changed.

use super::lesson::{
    Compare, Lesson, LessonPage, PREDICTION, Predict, PredictionAnswer, Setup, WITH,
};
use super::names::{KeptNumbers, value};
use super::text::TextFormat;
use crate::engine::text::number;
use crate::lab::Lab;
use crate::lab::view::HideablePart;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Locked answers of a lesson by question, in the order in which they were given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Predictions {
    locked: BTreeMap<String, Vec<LockedAnswer>>,
}

/// A locked answer: a vote in a round of a class, or a prediction without a class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LockedAnswer {
    /// Round, from 1; always 1 without a class.
    pub round: u32,
    pub answer: PredictionAnswer,
    /// True if the outcome had been seen or the round was closed.
    pub late: bool,
    /// Page that was open, from 1.
    pub page: usize,
    /// Time of the answer, seconds since 1970 (UTC).
    pub time_unix_s: u64,
}

impl Predictions {
    /// Locks `given` as an answer to `predict`.
    ///
    /// # Errors
    ///
    /// Returns an error, and changes nothing, if the round already has an answer or `given` does not fit the question.
    pub fn lock(&mut self, predict: &Predict, given: LockedAnswer) -> Result<(), String> {
        if self.in_round(predict, given.round).is_some() {
            return Err("is already locked and cannot be changed".to_owned());
        }
        if !predict.asked.accepts(&given.answer) {
            return Err("does not answer this question".to_owned());
        }
        let all = self.locked.entry(predict.name.clone()).or_default();
        all.retain(|other| other.round != given.round);
        all.push(given);
        Ok(())
    }

    pub fn is_empty(&self) -> bool {
        self.locked.is_empty()
    }

    /// Returns all answers, each with the name of its question.
    pub fn all(&self) -> impl Iterator<Item = (&String, &LockedAnswer)> {
        let locked = self.locked.iter();
        locked.flat_map(|(name, all)| all.iter().map(move |given| (name, given)))
    }

    /// Returns the answers to `predict`. Answers that no longer fit the question, because the file was changed, do not
    /// count.
    pub fn to<'a>(
        &'a self,
        predict: &'a Predict,
    ) -> impl DoubleEndedIterator<Item = &'a LockedAnswer> {
        let all = self.locked.get(&predict.name).into_iter().flatten();
        all.filter(|given| predict.asked.accepts(&given.answer))
    }

    pub fn in_round<'a>(&'a self, predict: &'a Predict, round: u32) -> Option<&'a LockedAnswer> {
        self.to(predict).find(|given| given.round == round)
    }

    /// Returns true if `predict` is answered in any round.
    pub fn is_locked(&self, predict: &Predict) -> bool {
        self.to(predict).next().is_some()
    }

    /// Returns the answers to `predict` in words, with their rounds if there are several. Returns `None` without an
    /// answer.
    pub fn in_words(&self, predict: &Predict) -> Option<String> {
        let has_rounds = self.to(predict).any(|given| given.round > 1);
        let mut all = Vec::new();
        for given in self.to(predict) {
            let words = given.answer.in_words(predict);
            all.push(match (has_rounds, given.late, given.round) {
                (false, false, _) => words,
                (false, true, _) => format!("{words} ({LATE})"),
                (true, false, round) => format!("{words} (round {round})"),
                (true, true, round) => format!("{words} (round {round}, {LATE})"),
            });
        }
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// Returns the predictions of `page` that are not locked.
    pub fn open_on<'a>(&'a self, page: &'a LessonPage) -> impl Iterator<Item = &'a Predict> {
        page.predicts().filter(|predict| !self.is_locked(predict))
    }

    /// Returns true if `page` asks for predictions and all of them are locked.
    pub fn are_locked_on(&self, page: &LessonPage) -> bool {
        page.predicts().next().is_some() && self.open_on(page).next().is_none()
    }

    /// Returns the parts that stay hidden once all predictions of `page` are locked: `hidden` without the answers that
    /// the page itself hides.
    pub fn hidden_after_lock(page: &LessonPage, hidden: &[HideablePart]) -> Vec<HideablePart> {
        let own = page.lab().map(Setup::hides).unwrap_or_default();
        let others = hidden
            .iter()
            .copied()
            .filter(|part| !part.is_answer() || !own.contains(part));
        others.collect()
    }
}

impl PredictionAnswer {
    /// Returns the answer in words: the choice, or the number with the unit of `predict`.
    pub fn in_words(&self, predict: &Predict) -> String {
        match (self, &predict.asked) {
            (Self::Choice(words), _) => words.clone(),
            (Self::Number(number), super::AnswerKind::Number { unit }) => {
                format!("{} {unit}", number::shortest(*number))
                    .trim_end()
                    .to_owned()
            }
            (Self::Number(number), super::AnswerKind::Choice(_)) => number::shortest(*number),
        }
    }
}

impl Compare {
    pub fn came_out(&self, lab: &Lab, kept: &KeptNumbers) -> Option<f64> {
        value(self.with.as_ref()?, lab, kept)
    }

    /// Returns the Markdown text with the numbers of `lab` and the prediction. Without a prediction, sentences that
    /// mention it are omitted.
    pub fn filled(
        &self,
        lesson: &Lesson,
        predictions: &Predictions,
        lab: &Lab,
        kept: &KeptNumbers,
    ) -> String {
        let with = self.came_out(lab, kept);
        let predict = lesson.predict(&self.prediction);
        let predicted = predict.and_then(|predict| predictions.in_words(predict));
        let text = self.text.filled(|expression, format: TextFormat| {
            if expression.text().trim() == PREDICTION {
                return predicted.clone().unwrap_or_else(|| NOTHING.to_owned());
            }
            let number = expression.value(|name| match name {
                WITH => with,
                name => super::names::number(name, lab, kept),
            });
            format.written(number)
        });
        match predicted {
            Some(_) => text,
            None => without_sentences(NOTHING, &text),
        }
    }
}

/// Returns `text` without the sentences that contain `part`, or the whole text if nothing else would remain.
fn without_sentences(part: &str, text: &str) -> String {
    let mut rest = text;
    let mut kept = String::new();
    while !rest.is_empty() {
        let (sentence, others) = rest.split_at(end_of_sentence(rest));
        if !sentence.contains(part) {
            kept.push_str(sentence);
        } else if sentence.ends_with("\n\n") {
            kept.push_str("\n\n");
        }
        rest = others;
    }
    match kept.trim_end() {
        "" => text.to_owned(),
        shorter => shorter.to_owned(),
    }
}

/// Returns the end of the first sentence of `text`, including the blanks after it. A list entry counts as a sentence.
fn end_of_sentence(text: &str) -> usize {
    let stops = text.match_indices(['.', '!', '?']);
    let end = stops
        .map(|(at, stop)| at + stop.len())
        .find(|&after| text[after..].starts_with(char::is_whitespace))
        .map_or(text.len(), |after| {
            text.len() - text[after..].trim_start().len()
        });
    let entry = text.find("\n- ").map(|line_end| line_end + 1);
    entry.map_or(end, |entry| entry.min(end))
}

const LATE: &str = "after its outcome was seen";
/// Placeholder for a prediction that was not made.
const NOTHING: &str = "…";

/// A student's progress in a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tried {
    /// The hint was shown, and the task is not done.
    Hint,
    Done,
    DoneAfterHint,
    /// The lab has done the task.
    Shown,
}

impl Tried {
    pub fn words(tried: Option<&Self>) -> &'static str {
        match tried {
            None => "not done",
            Some(Self::Hint) => "not done, with the hint",
            Some(Self::Done) => "done",
            Some(Self::DoneAfterHint) => "done after the hint",
            Some(Self::Shown) => "shown by the lab",
        }
    }
}

/// A student's progress in a lesson, as a session keeps it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LessonProgress {
    /// Number of the page, from 1.
    pub page: usize,
    #[serde(default)]
    pub predictions: Predictions,
    #[serde(default)]
    pub kept: KeptNumbers,
    /// Texts that state numbers of the page's run, by lines of the file. They stay while the student plays.
    #[serde(default)]
    pub stated: Option<BTreeMap<String, String>>,
    /// Predictions whose outcome was seen.
    #[serde(default)]
    pub seen: BTreeSet<String>,
    /// Progress in the tasks, by the headings of their pages.
    #[serde(default)]
    pub tasks: BTreeMap<String, Tried>,
    /// Number with which a task was done, in words, by the heading of its page.
    #[serde(default)]
    pub done_with: BTreeMap<String, String>,
    /// True if the last page was opened.
    #[serde(default)]
    pub has_ended: bool,
    /// Time of the first opening, seconds since 1970 (UTC).
    #[serde(default)]
    pub began_unix_s: u64,
}
