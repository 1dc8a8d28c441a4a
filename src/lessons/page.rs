//! The page of a lesson, and the list of lessons, as sheets for the lesson pane.

use super::lesson::{
    AnswerKind, Check, Compare, Lesson, LessonBlock, LessonLevel, LessonPage, Predict,
};
use super::markdown::paragraphs;
use super::open_lesson::OpenLesson;
use super::predictions::{LessonProgress, Tried};
use super::text::LessonText;
use super::{names, opening};
use crate::engine::text::number;
use crate::lab::Lab;
use crate::lab::sheet::{AskedAnswer, Paragraph, Sheet, SheetLineKind};
use std::collections::BTreeMap;
use std::time::Duration;

/// Placeholder for a number that is not known until the run has arrived.
const SOON: &str = "…";

/// Additions of a class to the page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClassOverlay {
    /// Title in the frame, in one form per line, longest first; if empty, the lesson's title.
    pub framed: String,
    /// Text in the lower line of the frame, in one form per line, longest first.
    pub border: String,
    /// True if the page may be turned while its question is open.
    pub is_of_teacher: bool,
    /// True for the projector: votes are shown below an open question, and no key answers it.
    pub is_of_projector: bool,
    /// True if a digit belongs to the class.
    pub asks_digit: bool,
    /// True if the class is followed.
    pub is_followed: bool,
    /// Current rounds of the class's questions by name, each with a flag that it is closed.
    pub rounds: BTreeMap<String, (u32, bool)>,
    /// Paragraphs below the question with this name.
    pub votes: Option<(String, Vec<Paragraph>)>,
    /// Paragraphs that replace the page.
    pub instead: Option<Vec<Paragraph>>,
    /// Paragraphs above the list of lessons while no class is running. The list then fills the screen.
    pub waiting: Option<Vec<Paragraph>>,
}

/// Returns the list of the lessons called `names`, filtered by `filter`, with one `selected`. `left` has the progress
/// in lessons that were begun.
pub(super) fn list(
    names: &[String],
    filter: &str,
    selected: usize,
    left: &BTreeMap<String, LessonProgress>,
    overlay: &ClassOverlay,
) -> Sheet {
    let mut sheet = Sheet {
        title: match filter {
            "" => "lessons: type to filter".to_owned(),
            filter => format!("lessons: {filter}_ ({})", names.len()),
        },
        enter: "open",
        is_list: true,
        is_alone: overlay.waiting.is_some(),
        paragraphs: overlay.waiting.clone().unwrap_or_default(),
        ..Sheet::default()
    };
    let mut level = None;
    for (index, name) in names.iter().enumerate() {
        let lesson = opening::open_again(name).ok();
        let own_level = lesson.as_ref().and_then(|lesson| lesson.guide.level);
        if own_level != level {
            let heading = own_level.map_or("others", LessonLevel::name);
            let caption = Paragraph::new(SheetLineKind::Caption, heading);
            sheet.paragraphs.push(caption);
            level = own_level;
        }
        let mut text = lesson.as_ref().map_or(name, |it| &it.title).clone();
        if let Some(minutes) = lesson.as_ref().and_then(|lesson| lesson.minutes) {
            text += &format!(", {minutes} min");
        }
        if let Some(place) = left.get(name) {
            let pages = lesson.as_ref().map_or(0, |lesson| lesson.pages.len());
            text += &format!(", page {} of {pages}", place.page);
        }
        let has_ended = left.get(name).is_some_and(|place| place.has_ended);
        let choice = SheetLineKind::Choice {
            number: None,
            is_selected: index == selected,
            mark: if has_ended { "done" } else { "" },
        };
        sheet.paragraphs.push(Paragraph::new(choice, text));
        if index == selected {
            let about = lesson.as_ref().map_or("", |lesson| &lesson.about);
            let needs = lesson
                .as_ref()
                .and_then(|lesson| lesson.guide.needs_in_words());
            for line in [about.to_owned(), needs.unwrap_or_default()] {
                if !line.is_empty() {
                    let item = SheetLineKind::Item {
                        mark: "  ".to_owned(),
                        depth: 1,
                    };
                    sheet.paragraphs.push(Paragraph::new(item, line));
                }
            }
            sheet.seen = Some((sheet.paragraphs.len() - 1, sheet.paragraphs.len() - 1));
        }
    }
    if names.is_empty() {
        let none = "no matching lesson; press Esc to clear the filter";
        let hint = Paragraph::new(SheetLineKind::Hint, none);
        sheet.paragraphs.push(hint);
    }
    sheet
}

/// Returns a sheet of `paragraphs` that fills the screen.
pub(super) fn alone(paragraphs: Vec<Paragraph>) -> Sheet {
    Sheet {
        is_alone: true,
        paragraphs,
        ..Sheet::default()
    }
}

/// Returns the page of `open`. `now` is the time since the lab was opened.
pub(super) fn sheet(open: &OpenLesson, overlay: &ClassOverlay, now: Duration, lab: &Lab) -> Sheet {
    let lesson = &open.lesson;
    let (page, pages) = (open.place.page, lesson.pages.len());
    let mut writer = Writer {
        open,
        overlay,
        lab,
        sheet: Sheet {
            framed: overlay.framed.clone(),
            border: overlay.border.clone(),
            title: lesson.title.clone(),
            place: format!("{page} of {pages}"),
            has_next: page < pages && !overlay.is_followed,
            plays: open.plays(),
            ..Sheet::default()
        },
    };
    if let Some(paragraphs) = &overlay.instead {
        writer.extend(paragraphs.clone());
        writer.sheet.takes_digits = overlay.asks_digit;
        writer.sheet.enter = "do it";
        let selected = paragraphs.iter().position(|it| it.kind.is_selected());
        writer.sheet.seen = selected.map(|at| (at, at));
        return writer.sheet;
    }
    writer.notes(now);
    writer.page();
    writer.sheet.takes_digits |= overlay.asks_digit;
    writer.sheet
}

/// Returns the page `number` as text for the teacher: its questions, each followed by `after`, its notes, and the next
/// page.
pub fn for_teacher(lesson: &Lesson, number: usize, after: impl Fn(&Predict) -> String) -> String {
    let mut text = format!("\n== {number} of {} · {}", lesson.pages.len(), lesson.title);
    if let Some(page) = lesson.page(number) {
        text += &format!("\n{}\n", page.heading);
        for predict in page.predicts() {
            text += &format!("\nasked: {}\n", unfilled(&predict.ask));
            if let AnswerKind::Choice(choices) = &predict.asked {
                for (answer, choice) in (1..).zip(choices) {
                    text += &format!("  {answer} {choice}\n");
                }
            }
            text += &after(predict);
        }
        for notes in page.notes() {
            text += &format!("\n{}\n", unfilled(notes).trim());
        }
    }
    text + &match lesson.page(number + 1) {
        Some(next) => format!("\nnext: {}", next.heading),
        None => "\nthis is the last page".to_owned(),
    }
}

/// Returns `text` with placeholders for its numbers.
fn unfilled(text: &LessonText) -> String {
    text.filled(|_, _| SOON.to_owned())
}

struct Writer<'a> {
    open: &'a OpenLesson,
    overlay: &'a ClassOverlay,
    lab: &'a Lab,
    sheet: Sheet,
}

impl Writer<'_> {
    fn page(&mut self) {
        let Some(page) = self.open.page() else {
            return;
        };
        self.add(Paragraph::new(SheetLineKind::Heading, page.heading.clone()));
        if page.number == 1 {
            self.blocks(&self.open.lesson.introduction);
        }
        let mut blocks = page.blocks.as_slice();
        if self.open.plays() {
            let mut parts = blocks.split(|block| matches!(block, LessonBlock::Lab(_)));
            blocks = parts.next().unwrap_or_default();
        }
        let is_open = self.blocks(blocks);
        if !is_open {
            self.next(page.number);
        }
    }

    /// Marks the paragraphs from number `first` on as those to scroll to, unless others are marked already. An outcome
    /// is thus visible with its explanation.
    fn is_seen_from(&mut self, first: usize) {
        let last = self.sheet.paragraphs.len().saturating_sub(1);
        self.sheet.seen.get_or_insert((first, last));
    }

    /// Writes `blocks` up to the first unanswered question. Returns true if there is one.
    fn blocks(&mut self, blocks: &[LessonBlock]) -> bool {
        for block in blocks {
            match block {
                LessonBlock::Text(text) => {
                    let source = match self.open.stated(text.line) {
                        Some(source) => source.to_owned(),
                        None if self.open.is_under_way() => unfilled(text),
                        None => text.with_numbers(self.lab, &self.open.place.kept),
                    };
                    self.extend(paragraphs(&source, &SheetLineKind::Text));
                }
                LessonBlock::Predict(predict) => {
                    self.question(predict);
                    // The class's votes are shown only after the student's own answer.
                    let is_shown = self.overlay.is_of_teacher
                        || self.overlay.is_of_projector
                        || !self.open.is_open(predict);
                    if let Some((name, votes)) = &self.overlay.votes
                        && *name == predict.name
                        && is_shown
                    {
                        let below = self.sheet.paragraphs.len();
                        self.extend(votes.clone());
                        self.sheet.seen = None;
                        self.is_seen_from(below);
                    }
                    if self.open.is_open(predict) {
                        return true;
                    }
                }
                LessonBlock::Compare(compare) => self.comparison(compare),
                LessonBlock::Check(check) => self.goals(check),
                LessonBlock::Shown(shown) => {
                    self.add(Paragraph::new(SheetLineKind::Code, shown.text.clone()));
                }
                LessonBlock::Lab(_) | LessonBlock::Task(_) | LessonBlock::Notes(_) => {}
            }
        }
        false
    }

    /// Writes the goals of a check: each part, marked if it holds now, with its current number. The first line states
    /// if all of it holds, or held before.
    fn goals(&mut self, check: &Check) {
        let first = self.sheet.paragraphs.len();
        let place = &self.open.place;
        let heading = self.open.page().map_or("", |page| page.heading.as_str());
        let tried = place.tasks.get(heading).filter(|it| **it != Tried::Hint);
        let was_done = tried.is_some() || self.open.has_reached(check.line);
        let (lab, kept) = (self.lab, &place.kept);
        let parts = check.that.conjuncts(|name| names::number(name, lab, kept));
        let holds = parts.iter().all(|part| part.holds) && !self.open.is_under_way();
        let done = match (tried, place.done_with.get(heading)) {
            (Some(Tried::Shown), _) => Tried::words(tried).to_owned(),
            (how, _) if holds => how.map_or("done", |how| Tried::words(Some(how))).to_owned(),
            (_, Some(number)) => format!("done before, with {number}"),
            (_, None) => "done before".to_owned(),
        };
        let mut list: Vec<(bool, String)> = Vec::new();
        if check.goals.len() < 2 {
            let goal = check.goals.concat();
            let state = match (holds, was_done) {
                (true, _) => done,
                (false, true) => format!("{done}; not now"),
                (false, false) => "not yet".to_owned(),
            };
            let colon = if goal.is_empty() { "" } else { ": " };
            list.push((holds, format!("{state}{colon}{goal}")));
        } else {
            list.extend((holds || was_done).then_some((true, done)));
            for (goal, part) in check.goals.iter().zip(&parts) {
                let now = part.left.filter(|_| !part.holds);
                let now = now.map(|now| format!(" (now {})", number::significant(now, 4)));
                list.push((part.holds, format!("{goal}{}", now.unwrap_or_default())));
            }
        }
        for (is_reached, text) in list {
            self.add(Paragraph::new(SheetLineKind::Goal { is_reached }, text));
        }
        if !holds && self.open.shows_hints && !check.hint.is_empty() {
            let hint = format!("Hint: {}", check.hint);
            self.add(Paragraph::new(SheetLineKind::Hint, hint));
        }
        self.is_seen_from(first);
    }

    fn comparison(&mut self, compare: &Compare) {
        let (lesson, place) = (&self.open.lesson, &self.open.place);
        let first = self.sheet.paragraphs.len();
        if self.open.is_under_way() {
            self.add(Paragraph::new(SheetLineKind::Result, SOON));
            return;
        }
        let source = match self.open.stated(compare.line) {
            Some(source) => source.to_owned(),
            None => compare.filled(lesson, &place.predictions, self.lab, &place.kept),
        };
        match source.trim_end().rsplit_once(" You said: ") {
            Some((outcome, said)) => {
                let said = format!("You said: {said}");
                self.extend(paragraphs(&said, &SheetLineKind::Said));
                let outcome = format!("Came out: {outcome}");
                self.extend(paragraphs(&outcome, &SheetLineKind::Result));
            }
            None => self.extend(paragraphs(&source, &SheetLineKind::Result)),
        }
        let predict = lesson.predict(&compare.prediction);
        let is_missing = predict.is_some_and(|predict| !place.predictions.is_locked(predict));
        if is_missing && !self.overlay.is_of_teacher && !self.overlay.is_followed {
            let pages = &mut lesson.pages.iter();
            if let Some(page) = pages.find(|page| page.asks(&compare.prediction)) {
                let text = format!("You made no prediction. Page {} asks for it.", page.number);
                self.add(Paragraph::new(SheetLineKind::Hint, text));
            }
        }
        self.is_seen_from(first);
    }

    fn question(&mut self, predict: &Predict) {
        let place = &self.open.place;
        let kept = &place.kept;
        let first = self.sheet.paragraphs.len();
        self.add(Paragraph::new(SheetLineKind::Caption, "Your prediction"));
        let ask = predict.ask.with_numbers(self.lab, kept);
        self.extend(paragraphs(&ask, &SheetLineKind::Question));
        let is_open = self.open.is_open(predict);
        let round = self.open.rounds.get(&predict.name);
        self.sheet.is_round_open |= round.is_some_and(|(_, is_closed)| !is_closed);
        let last = place.predictions.to(predict).next_back();
        let given = last.filter(|_| !is_open).map(|given| &given.answer);
        let chosen = self.open.chosen.get(&predict.name);
        let chosen = chosen.filter(|_| is_open).copied();
        if let AnswerKind::Choice(choices) = &predict.asked {
            for (index, choice) in choices.iter().enumerate() {
                let is_given = given.is_some_and(|given| given.in_words(predict) == *choice);
                let kind = SheetLineKind::Choice {
                    number: Some(index + 1),
                    is_selected: chosen == Some(index),
                    mark: if is_given { "you" } else { "" },
                };
                self.add(Paragraph::new(kind, choice));
            }
        }
        self.rounds_of(predict);
        if is_open {
            self.sheet.takes_digits = !self.overlay.is_of_projector;
            self.sheet.asked = Some(match &predict.asked {
                _ if self.overlay.is_of_projector => AskedAnswer::Elsewhere,
                AnswerKind::Choice(choices) => AskedAnswer::Choice {
                    count: choices.len(),
                    is_chosen: chosen.is_some(),
                },
                AnswerKind::Number { .. } => AskedAnswer::Number,
            });
        }
        // Scroll to the open question, or to the last one if none is open.
        if is_open || self.open.has_answered {
            self.sheet.seen = None;
        }
        self.is_seen_from(first);
    }

    /// Writes the locked answer, and a note if the class asks for another one.
    fn rounds_of(&mut self, predict: &Predict) {
        let said = self.open.place.predictions.in_words(predict);
        let round = self.open.rounds.get(&predict.name);
        let text = match (said, round, self.open.is_open(predict)) {
            (said, Some((round @ 2.., _)), true) => {
                let before = said.map_or(String::new(), |said| format!(" You said: {said}."));
                format!("Round {round}: your teacher asks again.{before}")
            }
            (Some(said), _, false) => format!("Locked: {said}."),
            _ => return,
        };
        self.add(Paragraph::new(SheetLineKind::Hint, text));
    }

    fn next(&mut self, number: usize) {
        let has_task = self.open.page().is_some_and(|page| page.task().is_some());
        let is_last = number == self.open.lesson.pages.len();
        let text = match (self.open.is_under_way(), has_task, is_last) {
            (_, true, _) if self.overlay.is_followed => "k: leave the class to try it; h: hint.",
            _ if self.overlay.is_followed => return,
            _ if self.open.has_left() => "b: restart the page; n: continue.",
            _ if self.open.plays() => "The run is playing. space: pause; n: jump to its end.",
            (true, ..) => "The run is being computed. space: pause.",
            (false, true, _) if !self.open.shows_hints => {
                "h: hint; b: restart the page; n: next page."
            }
            (false, true, false) => "h: show how it is done; b: restart the page; n: next page.",
            (false, true, true) => "h: show how it is done; b: restart the page; L: other lessons.",
            (false, false, false) => return, // the footer names n
            (false, false, true) => "This is the end of the lesson. L: other lessons.",
        };
        self.add(Paragraph::new(SheetLineKind::Hint, text));
    }

    /// Writes the teacher's part: the clock, the notes, and the next page.
    fn notes(&mut self, now: Duration) {
        let Some(time) = self.open.time(now) else {
            return;
        };
        self.add(Paragraph::new(
            SheetLineKind::Heading,
            format!("For the class: {time}"),
        ));
        let lesson = &self.open.lesson;
        for notes in self.open.page().into_iter().flat_map(LessonPage::notes) {
            let source = notes.with_numbers(self.lab, &self.open.place.kept);
            self.extend(paragraphs(&source, &SheetLineKind::Note));
        }
        let next = match lesson.page(self.open.place.page + 1) {
            Some(page) => format!("Next page: {}", page.heading),
            None => "This is the last page.".to_owned(),
        };
        self.add(Paragraph::new(SheetLineKind::Note, next));
    }

    fn add(&mut self, paragraph: Paragraph) {
        self.sheet.paragraphs.push(paragraph);
    }

    fn extend(&mut self, paragraphs: Vec<Paragraph>) {
        self.sheet.paragraphs.extend(paragraphs);
    }
}
