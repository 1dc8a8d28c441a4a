//! The class menu in the teacher's lab: actions on votes and seats, and the list of seats.

use super::Teacher;
use crate::class::folder::VoteStage;
use crate::class::votes::{self, FEWEST_VOTES_SHOWN, SeatStanding, SeatStatus, in_order};
use crate::class::{login, unix_ms};
use crate::lab::Lab;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lessons::LessonPage;
use crate::lessons::open_lesson::OpenLesson;

/// Length of a countdown, ms.
const COUNTDOWN_MS: u64 = 30_000;
const CLOSED: &str = "the round is closed";
const CLOSED_ASK_AGAIN: &str = "the round is closed: press k 2 to ask again";

/// State of the class menu.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum ClassMenu {
    #[default]
    Closed,
    /// The menu, with this entry (from 0) selected.
    Open(usize),
    /// The list of seats. The selection is a seat's key, because the order changes with every vote; `None` is the
    /// first.
    Seats(Option<String>),
}

/// An action in the menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClassAct {
    Question(QuestionAct),
    Follow,
    Seats,
    Gather,
}

/// An action on the question of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum QuestionAct {
    Show,
    AskAgain,
    Countdown,
}

/// Entries of the menu, in the order of their digits, from 1.
const ACTS: [ClassAct; 6] = [
    ClassAct::Question(QuestionAct::Show),
    ClassAct::Question(QuestionAct::AskAgain),
    ClassAct::Follow,
    ClassAct::Seats,
    ClassAct::Gather,
    ClassAct::Question(QuestionAct::Countdown),
];

/// A line of the list of seats.
enum SeatEntry<'a> {
    Waiting(login::WaitingSeat),
    Seat(SeatStanding, &'a SeatStatus),
}

impl SeatEntry<'_> {
    /// Returns a key that identifies this line.
    fn key(&self) -> String {
        match self {
            Self::Waiting(seat) => format!("{} waits", seat.word),
            Self::Seat(_, status) => status.seat.word.clone(),
        }
    }
}

impl ClassMenu {
    /// Returns the text in the border of the page, one form per line.
    pub(super) fn border(&self) -> &'static str {
        match self {
            Self::Closed => "k: votes, seats, gather, countdown\nk: class menu\nk: class",
            Self::Open(_) => "digit or Enter: do it; Esc: back\nEsc: back",
            Self::Seats(_) => "Enter: close, reopen; Esc: back\nEsc: back",
        }
    }
}

fn moved(at: usize, direction: Direction, entries: usize) -> usize {
    let last = entries.saturating_sub(1);
    at.saturating_add_signed(direction.rows(10)).min(last)
}

impl Teacher {
    /// Returns the paragraphs that replace the page while the menu is open.
    pub(super) fn menu_page(&self, page: Option<&LessonPage>) -> Option<Vec<Paragraph>> {
        match &self.menu {
            ClassMenu::Closed => None,
            ClassMenu::Open(selected) => Some(self.act_lines(*selected, page)),
            ClassMenu::Seats(selected) => Some(self.seat_lines(selected.as_deref(), page)),
        }
    }

    /// Handles `key` while the menu is open. Returns true if the lesson must not handle it.
    pub(super) fn on_menu_key(
        &mut self,
        key: LessonKey,
        lab: &mut Lab,
        open: Option<&OpenLesson>,
    ) -> bool {
        let page = open.and_then(OpenLesson::page);
        match (self.menu.clone(), key) {
            (ClassMenu::Open(_), LessonKey::Digit(digit)) => {
                let at = usize::from(digit).checked_sub(1);
                match at.and_then(|at| ACTS.get(at)) {
                    Some(act) => self.act(*act, lab, open),
                    None => lab.refuse("the entries are 1 to 6"),
                }
            }
            (ClassMenu::Open(selected), LessonKey::Take) => {
                if let Some((_, act)) = self.acts(page).get(selected) {
                    self.act(*act, lab, open);
                }
            }
            (ClassMenu::Open(selected), LessonKey::Move(direction)) => {
                let entries = self.acts(page).len();
                self.menu = ClassMenu::Open(moved(selected, direction, entries));
            }
            (ClassMenu::Seats(selected), LessonKey::Move(direction)) => {
                let entries = self.entries(page);
                let at = selected_at(&entries, selected.as_deref());
                let to = entries.get(moved(at, direction, entries.len()));
                let word = to.map(SeatEntry::key);
                self.menu = ClassMenu::Seats(word);
            }
            (ClassMenu::Seats(selected), LessonKey::Take) => {
                self.close_or_open(selected.as_deref(), lab, page);
            }
            (_, other) => {
                self.menu = ClassMenu::Closed;
                return other == LessonKey::Leave;
            }
        }
        true
    }

    /// Returns the actions on `page`, with their digits.
    fn acts(&self, page: Option<&LessonPage>) -> Vec<(usize, ClassAct)> {
        let asks = page.is_some_and(|page| votes::question(page, &self.state).is_some());
        let acts = (1..).zip(ACTS);
        acts.filter(|(_, act)| asks || !matches!(act, ClassAct::Question(_)))
            .collect()
    }

    fn act_lines(&self, selected: usize, page: Option<&LessonPage>) -> Vec<Paragraph> {
        let mut lines = vec![Paragraph::new(SheetLineKind::Heading, "The class")];
        for (index, (digit, act)) in self.acts(page).into_iter().enumerate() {
            let kind = SheetLineKind::Choice {
                number: Some(digit),
                is_selected: index == selected,
                mark: "",
            };
            lines.push(Paragraph::new(kind, self.act_words(act, page)));
        }
        if let Some(rehearsal) = &self.rehearsal {
            let about = rehearsal.about.clone();
            lines.push(Paragraph::new(SheetLineKind::Hint, about));
        }
        lines
    }

    /// Returns the current effect of `act` in words.
    fn act_words(&self, act: ClassAct, page: Option<&LessonPage>) -> String {
        let asked = page.and_then(|page| votes::question(page, &self.state));
        let question = asked.map(|(_, question)| question).unwrap_or_default();
        let words = match act {
            ClassAct::Question(QuestionAct::Show) => match question.stage {
                VoteStage::Counted => "show the votes to you only",
                VoteStage::Teacher if self.state.answered < FEWEST_VOTES_SHOWN => {
                    return format!(
                        "show the votes to all (bars from {FEWEST_VOTES_SHOWN} votes on)"
                    );
                }
                VoteStage::Teacher => "show the votes to all",
                VoteStage::All if question.is_closed => CLOSED,
                VoteStage::All => "close the round",
            },
            ClassAct::Question(QuestionAct::AskAgain) => {
                return format!("ask again: round {}", question.round() + 1);
            }
            ClassAct::Question(QuestionAct::Countdown) => match question.seconds_left(unix_ms()) {
                Some(left) => return format!("stop the countdown: {left} s left"),
                None if question.is_closed => CLOSED,
                None => return format!("close in {} s", COUNTDOWN_MS / 1000),
            },
            ClassAct::Follow if self.is_followed => "let the students work on their own",
            ClassAct::Follow => "let the class follow you again",
            ClassAct::Seats => "list the seats",
            ClassAct::Gather => "gather everyone on this page",
        };
        words.to_owned()
    }

    fn act(&mut self, act: ClassAct, lab: &mut Lab, open: Option<&OpenLesson>) {
        self.menu = ClassMenu::Closed;
        match act {
            ClassAct::Question(of_question) => self.act_on_question(of_question, lab, open),
            ClassAct::Follow => {
                self.is_followed = !self.is_followed;
                lab.refuse(if self.is_followed {
                    "the class follows you"
                } else {
                    "the students work on their own: press k 3 to let them follow you again"
                });
            }
            ClassAct::Seats => self.menu = ClassMenu::Seats(None),
            ClassAct::Gather => {
                self.is_followed = true;
                self.state.gathered_ms = unix_ms();
                lab.refuse("everyone is now brought to this page");
            }
        }
    }

    fn act_on_question(&mut self, act: QuestionAct, lab: &mut Lab, open: Option<&OpenLesson>) {
        let page = open.and_then(OpenLesson::page);
        let asked = page.and_then(|page| votes::question(page, &self.state));
        let Some((predict, _)) = asked else {
            return lab.refuse("this page asks no question");
        };
        let is_seen = open.is_some_and(|it| it.place.seen.contains(&predict.name));
        let question = self.state.question_mut(&predict.name);
        match act {
            QuestionAct::AskAgain => {
                question.ask_again();
                let round = format!("round {}: the class votes again", question.round());
                let late = if is_seen {
                    "; its outcome was seen, so votes count as late"
                } else {
                    ""
                };
                lab.refuse(round + late);
            }
            QuestionAct::Show => match question.stage {
                VoteStage::Counted => question.stage = VoteStage::Teacher,
                VoteStage::Teacher => question.stage = VoteStage::All,
                VoteStage::All if question.is_closed => lab.refuse(CLOSED_ASK_AGAIN),
                VoteStage::All => question.close(),
            },
            QuestionAct::Countdown if question.closes_at_ms.take().is_some() => {
                lab.refuse("the countdown has stopped: the round stays open");
            }
            QuestionAct::Countdown if question.is_closed => lab.refuse(CLOSED_ASK_AGAIN),
            QuestionAct::Countdown => {
                question.closes_at_ms = Some(unix_ms() + COUNTDOWN_MS);
                let seconds = COUNTDOWN_MS / 1000;
                lab.refuse(format!(
                    "the round closes in {seconds} s; press k 6 to stop the countdown"
                ));
            }
        }
    }

    /// Returns the seats that accept no code, then all seats.
    fn entries(&self, page: Option<&LessonPage>) -> Vec<SeatEntry<'_>> {
        let waiting = login::waiting(&self.folder, unix_ms() / 1000).into_iter();
        let asked = page.and_then(|page| votes::question(page, &self.state));
        let seats = in_order(&self.seats, &self.state, asked.as_ref()).into_iter();
        let seats = seats.map(|(standing, status)| SeatEntry::Seat(standing, status));
        waiting.map(SeatEntry::Waiting).chain(seats).collect()
    }

    fn seat_lines(&self, selected: Option<&str>, page: Option<&LessonPage>) -> Vec<Paragraph> {
        let mut list = vec![Paragraph::new(SheetLineKind::Heading, "The seats")];
        let entries = self.entries(page);
        let at = selected_at(&entries, selected);
        for (index, entry) in entries.into_iter().enumerate() {
            let (text, is_closed) = match entry {
                SeatEntry::Waiting(seat) => (seat.in_words(), true),
                SeatEntry::Seat(standing, status) => {
                    (status.in_words(standing), standing == SeatStanding::Closed)
                }
            };
            let kind = SheetLineKind::Choice {
                number: None,
                is_selected: index == at,
                mark: if is_closed { "closed" } else { "" },
            };
            list.push(Paragraph::new(kind, text));
        }
        let legend = if self.seats.is_empty() {
            "No seat is taken yet."
        } else {
            "Enter closes or reopens a seat. lost: no sign for 10 s; away: has quit."
        };
        list.push(Paragraph::new(SheetLineKind::Hint, legend));
        list
    }

    /// Closes or opens the selected seat, or ends the wait of a seat that accepts no code.
    fn close_or_open(&mut self, selected: Option<&str>, lab: &mut Lab, page: Option<&LessonPage>) {
        let entries = self.entries(page);
        let at = selected_at(&entries, selected);
        let word = match entries.into_iter().nth(at) {
            None => return,
            Some(SeatEntry::Waiting(seat)) => return self.folder.forget_wrong_codes(&seat.word),
            Some(SeatEntry::Seat(_, status)) => status.seat.word.clone(),
        };
        self.menu = ClassMenu::Seats(Some(word.clone()));
        if self.state.closed.remove(&word) {
            lab.refuse(format!("{word} is open again"));
        } else {
            lab.refuse(format!("{word} is closed: press Enter to reopen it"));
            self.state.closed.insert(word);
        }
    }
}

/// Returns the position of the entry `selected`, or 0 if it is gone.
fn selected_at(entries: &[SeatEntry<'_>], selected: Option<&str>) -> usize {
    let found = selected.and_then(|key| entries.iter().position(|entry| entry.key() == key));
    found.unwrap_or(0)
}
