//! What a student has predicted in a lesson. A prediction is locked: it is not changed any more.

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

/// The locked answers of one lesson, by the names of their questions, in the order in which they were given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Predictions {
    locked: BTreeMap<String, Vec<LockedAnswer>>,
}

/// An answer that was locked: the vote of a round of a class, or the prediction of one who is in none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LockedAnswer {
    /// From 1; without a class it is 1.
    pub round: u32,
    pub answer: PredictionAnswer,
    /// Whether the outcome had been seen, or the question was closed.
    pub late: bool,
    /// The page that was open, from 1.
    pub page: usize,
    /// Seconds since 1970 (UTC).
    pub time_unix_s: u64,
}

impl Predictions {
    /// Locks `given` as an answer to `predict`.
    ///
    /// # Errors
    /// When one is locked already in its round, or it is no answer to it; nothing has changed then.
    pub fn lock(&mut self, predict: &Predict, given: LockedAnswer) -> Result<(), String> {
        if self.in_round(predict, given.round).is_some() {
            return Err("is locked already: a prediction is not changed".to_owned());
        }
        if !predict.asked.accepts(&given.answer) {
            return Err("is no answer to this question".to_owned());
        }
        let all = self.locked.entry(predict.name.clone()).or_default();
        all.retain(|other| other.round != given.round);
        all.push(given);
        Ok(())
    }

    pub fn is_empty(&self) -> bool {
        self.locked.is_empty()
    }

    /// Returns all of them, each with the name of its question.
    pub fn all(&self) -> impl Iterator<Item = (&String, &LockedAnswer)> {
        let locked = self.locked.iter();
        locked.flat_map(|(name, all)| all.iter().map(move |given| (name, given)))
    }

    /// Returns the answers to `predict`. One that it no longer takes, as the file was changed, does not count.
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

    /// Returns whether `predict` is answered, in whatever round.
    pub fn is_locked(&self, predict: &Predict) -> bool {
        self.to(predict).next().is_some()
    }

    /// Returns the answers to `predict` in words, with their rounds where there are several; `None` where there is none.
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

    /// Returns the predictions of `page` that are not locked yet.
    pub fn open_on<'a>(&'a self, page: &'a LessonPage) -> impl Iterator<Item = &'a Predict> {
        page.predicts().filter(|predict| !self.is_locked(predict))
    }

    /// Returns whether `page` asks for predictions, and all of them are locked.
    pub fn are_locked_on(&self, page: &LessonPage) -> bool {
        page.predicts().next().is_some() && self.open_on(page).next().is_none()
    }

    /// Returns what is hidden once all predictions of `page` are locked, if `hidden` is hidden before: all of it but the
    /// answers that the page has hidden itself.
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
    /// It in words: the choice, or the number with the unit that `predict` asks for.
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

    /// Returns what is said, in Markdown, with the numbers of `lab` and the prediction. Where nothing was predicted, the
    /// sentences that tell the prediction are left out.
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
            None => without(NOTHING, &text),
        }
    }
}

/// `text` without the sentences that have `part`; all of it where nothing else would be left.
fn without(part: &str, text: &str) -> String {
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

/// Returns where the first sentence of `text` ends, the blanks after it counted in. An entry of a list counts as one.
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
/// Stands for a prediction that was not made.
const NOTHING: &str = "…";

/// How far a student got with a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tried {
    /// The hint was read, and the task is not done.
    Hint,
    Done,
    DoneAfterHint,
    /// The lab has done it.
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

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LessonProgress {
    /// The number of the page, from 1.
    pub page: usize,
    #[serde(default)]
    pub predictions: Predictions,
    #[serde(default)]
    pub kept: KeptNumbers,
    /// What the page states of the run that its lesson stands on, by lines of the file: it stays while the student plays.
    #[serde(default)]
    pub stated: Option<BTreeMap<String, String>>,
    /// The predictions whose outcome was seen.
    #[serde(default)]
    pub seen: BTreeSet<String>,
    /// How far the student got with the tasks, by the headings of their pages.
    #[serde(default)]
    pub tasks: BTreeMap<String, Tried>,
    /// The number with which a task was done, in words, by the headings of their pages.
    #[serde(default)]
    pub done_with: BTreeMap<String, String>,
    /// Whether its last page was opened.
    #[serde(default)]
    pub has_ended: bool,
    /// When it was opened first: seconds since 1970 (UTC).
    #[serde(default)]
    pub began_unix_s: u64,
}
