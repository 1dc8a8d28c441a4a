//! The teacher's lab: what it shows goes to the class, and the votes of the class come to its pages.

use super::folder::{CLASS_VERSION, ClassFolder, ClassState, LONGEST_RUN, PresentedRun, VoteStage};
use super::votes::{self, FEWEST_VOTES_SHOWN, SeatStatus, Tally, present, seat_statuses};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, login, unix_ms};
use crate::engine::data::find_shipped;
use crate::engine::scenario::Scenario;
use crate::engine::text::printable::PrintablePath;
use crate::lab::action::LessonKey;
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lab::{Lab, Snapshot};
use crate::lessons::open_lesson::OpenLesson;
use crate::lessons::page::ClassOverlay;
use crate::lessons::{LessonPage, Lessons};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

#[derive(Debug, Default)]
pub struct Teacher {
    folder: ClassFolder,
    state: ClassState,
    /// The state that the class knows.
    published: Option<ClassState>,
    is_followed: bool,
    menu: ClassMenu,
    seats: Vec<SeatStatus>,
    /// The run that was shown last, and its file.
    run: Option<(Arc<Scenario>, String)>,
    next_look: Duration,
    trouble: Option<String>,
}

/// What the class's key has opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ClassMenu {
    #[default]
    Closed,
    Open,
    /// The list of the seats, of which one is selected.
    Seats(usize),
}

/// A line of the list of the seats.
enum SeatEntry<'a> {
    Waiting(login::WaitingSeat),
    Seat(&'a SeatStatus),
}

impl Teacher {
    /// Returns the class in `folder`, with the rounds of an earlier lab.
    pub fn new(folder: ClassFolder, before: ClassState) -> Self {
        let state = ClassState {
            gyrolab: CLASS_VERSION.to_owned(),
            is_on: true,
            ..before
        };
        Self {
            folder,
            state,
            is_followed: true,
            ..Self::default()
        }
    }

    fn publish(&mut self) {
        if self.published.as_ref() == Some(&self.state) {
            return self.folder.touch_state();
        }
        match self.folder.publish(&self.state) {
            Ok(()) => self.published = Some(self.state.clone()),
            Err(trouble) => {
                self.trouble = Some(trouble);
                self.folder.touch_state(); // the lab is there
            }
        }
    }

    /// Makes the state that of the lab and of the votes.
    fn look(&mut self, lab: &Lab, lessons: &Lessons) {
        match seat_statuses(&self.folder) {
            Ok(seats) => {
                self.trouble = seats.iter().find_map(|seat| seat.trouble.clone());
                self.seats = seats;
            }
            Err(trouble) => self.trouble = Some(trouble),
        }
        if let Some(open) = lessons.open_lesson() {
            self.state.lesson.clone_from(&open.lesson.name);
            self.state.page = open.place.page;
            self.state.kept.clone_from(&open.place.kept);
            self.state.has_arrived = !open.is_under_way();
        }
        self.state.shown = self.is_followed.then(|| self.shown(lab)).flatten();
        self.state.here = present(&self.seats).0;
        self.state.answered = 0;
        let page = lessons.open_lesson().and_then(|open| open.page());
        if let Some((predict, question)) = page.and_then(|page| votes::question(page, &self.state))
        {
            let (lesson, round) = (&self.state.lesson, question.round());
            let here = self.seats.iter().filter(|status| status.is_here());
            self.state.answered = here
                .filter(|status| status.vote(lesson, predict, round).is_some())
                .count();
            let tally = Tally::count(&self.seats, lesson, predict, round);
            let is_shown = question.stage == VoteStage::All && tally.votes >= FEWEST_VOTES_SHOWN;
            let bars = if is_shown { tally.bars } else { Vec::new() };
            self.state.question_mut(&predict.name).bars = bars;
        }
    }

    /// Returns the run in `lab`, as the class follows it.
    fn shown(&mut self, lab: &Lab) -> Option<PresentedRun> {
        let player = lab.player();
        let scenario = player.run().scenario();
        let known = self.run.as_ref().map(|(known, _)| known);
        if !known.is_some_and(|known| Arc::ptr_eq(known, scenario)) {
            self.run = Some((Arc::clone(scenario), published(scenario)));
        }
        let (_, run) = self.run.as_ref()?;
        if run.len() > LONGEST_RUN {
            let rule = "the run's file is above 64 kB: the class cannot follow it";
            self.trouble = Some(rule.to_owned());
            return None;
        }
        let (step, is_running) = (player.step_number(), player.is_running());
        let before = self.state.shown.as_ref();
        let still = before.filter(|shown| !is_running && shown.snapshot.step == step);
        Some(PresentedRun {
            snapshot: Snapshot {
                name: lab.runs().name().to_owned(),
                run: run.clone(),
                end_s: Some(lab.runs().present().end_s),
                step,
                ..lab.snapshot()
            },
            at_ms: still.map_or_else(unix_ms, |shown| shown.at_ms),
            is_running,
        })
    }

    /// Returns what the class adds to the page.
    fn overlay(&self, lessons: &Lessons) -> ClassOverlay {
        let (here, counts) = present(&self.seats);
        let framed = lessons.open_lesson().map(|open| {
            let (page, pages) = (open.place.page, open.lesson.pages.len());
            let lead = if self.is_followed {
                ""
            } else {
                "not followed · "
            };
            let of = format!("{lead}{page} of {pages}");
            let title = &open.lesson.title;
            format!("{of} · {counts} · {title}\n{of} · {counts}\n{of} · {here} here")
        });
        let page = lessons.open_lesson().and_then(|open| open.page());
        let border = match (self.menu, self.is_followed) {
            (ClassMenu::Closed, _) => "k: show, again, follow, seats\nk: class",
            (ClassMenu::Open, true) => "1 show 2 again 3 unfollow 4 seats",
            (ClassMenu::Open, false) => "1 show 2 again 3 follow 4 seats",
            (ClassMenu::Seats(_), _) => "Enter closes, opens; Esc: back",
        };
        ClassOverlay {
            framed: framed.unwrap_or_default(),
            border: border.to_owned(),
            is_of_teacher: true,
            asks_digit: self.menu == ClassMenu::Open,
            votes: page.and_then(|page| self.votes(page)),
            instead: match self.menu {
                ClassMenu::Seats(selected) => Some(self.list(selected)),
                _ => None,
            },
            ..ClassOverlay::default()
        }
    }

    /// Returns the name of the question that the class is at, and the votes as far as they are shown.
    fn votes(&self, page: &LessonPage) -> Option<(String, Vec<Paragraph>)> {
        let (predict, question) = votes::question(page, &self.state)?;
        let (round, answered, here) = (question.round(), self.state.answered, self.state.here);
        let since_s = unix_ms().saturating_sub(question.since_ms) / 1000;
        let (minutes, seconds) = (since_s / 60, since_s % 60);
        let tally = Tally::count(&self.seats, &self.state.lesson, predict, round);
        let seen = match question.stage {
            VoteStage::Counted | VoteStage::Teacher => "",
            VoteStage::All if tally.votes < FEWEST_VOTES_SHOWN => {
                " · students see no bars: under 5 votes"
            }
            VoteStage::All => " · shown",
            VoteStage::Closed => " · closed",
        };
        let late = match tally.late {
            0 => String::new(),
            late => format!(" · {late} late"),
        };
        let counted = format!("round {round} · {answered} of {here}");
        let line = format!("{counted} · {minutes}:{seconds:02}{late}{seen}");
        let mut lines = vec![Paragraph::new(SheetLineKind::Note, line)];
        if question.stage != VoteStage::Counted {
            lines.push(tally.drawn());
            let advice = tally.advice.into_iter();
            lines.extend(advice.map(|words| Paragraph::new(SheetLineKind::Note, words)));
        }
        Some((predict.name.clone(), lines))
    }

    /// Returns the seats that accept no code, then all seats.
    fn entries(&self) -> Vec<SeatEntry<'_>> {
        let waiting = login::waiting(&self.folder, unix_ms() / 1000).into_iter();
        let seats = self.seats.iter().map(SeatEntry::Seat);
        waiting.map(SeatEntry::Waiting).chain(seats).collect()
    }

    fn list(&self, selected: usize) -> Vec<Paragraph> {
        let mut list = vec![Paragraph::new(SheetLineKind::Heading, "The seats")];
        for (index, entry) in self.entries().into_iter().enumerate() {
            let (text, is_closed) = match entry {
                SeatEntry::Waiting(seat) => (seat.in_words(), true),
                SeatEntry::Seat(status) => (
                    status.in_words(&self.state),
                    self.state.closed.contains(&status.seat.word),
                ),
            };
            let kind = SheetLineKind::Choice {
                number: None,
                is_selected: index == selected,
                mark: if is_closed { "closed" } else { "" },
            };
            list.push(Paragraph::new(kind, text));
        }
        let legend = if self.seats.is_empty() {
            "No seat is taken yet."
        } else {
            "Enter opens a seat that is closed. lost: no sign for 10 s; away: left."
        };
        list.push(Paragraph::new(SheetLineKind::Hint, legend));
        list
    }

    /// Does what the menu has under `digit`.
    fn choose(&mut self, digit: u8, lab: &mut Lab, open: Option<&OpenLesson>) {
        self.menu = ClassMenu::Closed;
        match digit {
            1 | 2 => {
                let page = open.and_then(OpenLesson::page);
                let asked = page.and_then(|page| votes::question(page, &self.state));
                let Some((predict, _)) = asked else {
                    return lab.refuse("this page asks nothing");
                };
                let is_seen = open.is_some_and(|it| it.place.seen.contains(&predict.name));
                let question = self.state.question_mut(&predict.name);
                if digit == 2 {
                    question.earlier_rounds = question.round();
                    (question.stage, question.since_ms) = (VoteStage::Counted, unix_ms());
                    let round = format!("round {}: the class votes again", question.round());
                    let late = "; its outcome was seen, so votes count apart, as late";
                    return lab.refuse(round + if is_seen { late } else { "" });
                }
                question.stage = match question.stage {
                    VoteStage::Counted => VoteStage::Teacher,
                    VoteStage::Teacher => VoteStage::All,
                    VoteStage::All => VoteStage::Closed,
                    VoteStage::Closed => return lab.refuse("closed: k 2 asks it again"),
                };
            }
            3 => {
                self.is_followed = !self.is_followed;
                lab.refuse(if self.is_followed {
                    "the class follows"
                } else {
                    "the class does not follow: k 3 lets it follow again"
                });
            }
            4 => self.menu = ClassMenu::Seats(0),
            _ => lab.refuse("1 shows the votes, 2 asks again, 3 lets the class follow, 4: seats"),
        }
    }

    /// Closes the selected seat, or opens it; ends the wait of a seat that accepts no code.
    fn close_or_open(&mut self, selected: usize, lab: &mut Lab) {
        let word = match self.entries().into_iter().nth(selected) {
            None => return,
            Some(SeatEntry::Waiting(seat)) => return self.folder.forget_wrong_codes(&seat.word),
            Some(SeatEntry::Seat(status)) => status.seat.word.clone(),
        };
        if !self.state.closed.remove(&word) {
            lab.refuse(format!("{word} is closed: Enter opens it again"));
            self.state.closed.insert(word);
        }
    }
}

impl ClassRole for Teacher {
    fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) -> ControlFlow<()> {
        let is_new = lessons.open_lesson().is_some_and(|open| {
            (&open.lesson.name, open.place.page) != (&self.state.lesson, self.state.page)
        });
        if now >= self.next_look || is_new {
            self.next_look = now + CLASS_POLL_INTERVAL;
            self.trouble = None;
            self.look(lab, lessons);
            self.publish();
            lessons.set_overlay(self.overlay(lessons), lab);
        }
        ControlFlow::Continue(())
    }

    fn on_class_key(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        self.menu = match self.menu {
            ClassMenu::Closed => ClassMenu::Open,
            _ => ClassMenu::Closed,
        };
        lessons.set_overlay(self.overlay(lessons), lab);
        lab.view_mut().turn_to_sheet();
    }

    fn intercept(&mut self, key: LessonKey, lab: &mut Lab, lessons: &Lessons) -> bool {
        match (self.menu, key) {
            (ClassMenu::Closed, _) => return false,
            (ClassMenu::Open, LessonKey::Digit(digit)) => {
                self.choose(digit, lab, lessons.open_lesson());
            }
            (ClassMenu::Seats(selected), LessonKey::Move(direction)) => {
                let last = self.entries().len().saturating_sub(1);
                let moved = selected.saturating_add_signed(direction.rows(10));
                self.menu = ClassMenu::Seats(moved.min(last));
            }
            (ClassMenu::Seats(selected), LessonKey::Take) => self.close_or_open(selected, lab),
            (_, key) => {
                self.menu = ClassMenu::Closed;
                return key == LessonKey::Leave;
            }
        }
        true
    }

    fn after_keys(&mut self, _lab: &mut Lab, _lessons: &Lessons) {
        self.next_look = Duration::ZERO;
    }

    fn wait(&self, now: Duration) -> Duration {
        self.next_look.saturating_sub(now).max(LEAST_WAIT)
    }

    fn trouble(&self) -> Option<String> {
        self.trouble.clone()
    }

    fn leave(&mut self) -> Result<String, String> {
        self.state.is_on = false;
        self.folder.publish(&self.state)?;
        let root = PrintablePath(&self.folder.root);
        Ok(format!("gyrolab class --resume --folder {root} goes on"))
    }
}

/// Returns the run file as the class gets it: without measured data that are a file of the teacher's.
fn published(scenario: &Scenario) -> String {
    let mut run = scenario.clone();
    let named = run.file.viewed_text("measured");
    let is_own = named.is_some_and(|name| find_shipped(name).is_none());
    if let Some(view) = run.file.view.as_mut().filter(|_| is_own) {
        view.remove("measured");
    }
    run.to_toml()
}
