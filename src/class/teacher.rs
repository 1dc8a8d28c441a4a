//! The teacher's lab: what it shows goes to the class, and the votes of the class come to its pages.

use super::folder::{Folder, LONGEST_RUN, Run, Stage, State, VERSION};
use super::seat::Presence;
use super::votes::{self, FEWEST, Sitting, Tally, sittings};
use super::{EVERY, login, unix_ms};
use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::sheet::{Kind, Paragraph};
use crate::lessons::class::Dress;
use crate::lessons::{Class as Lessons, Page};
use crate::scenario::Scenario;
use std::sync::Arc;
use std::time::Duration;
use toml::Table;

const TOO_LONG: &str = "the run's file is above 64 kB: the class cannot follow it";

#[derive(Debug)]
pub struct Teacher {
    folder: Folder,
    state: State,
    /// The state that the class knows.
    published: Option<State>,
    is_followed: bool,
    menu: Menu,
    seats: Vec<Sitting>,
    /// The run that was shown last, and its file.
    run: Option<(Arc<Scenario>, String)>,
    pub next_look: Duration,
    pub trouble: Option<String>,
}

/// What the class's key has opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Menu {
    Closed,
    Open,
    /// The list of the seats, of which one is selected.
    Seats(usize),
}

/// An entry of the list of seats.
enum Entry {
    Seat(String),
    /// A name that is locked by wrong codes.
    Locked(String),
}

impl Teacher {
    /// The class in `folder`, with the rounds of an earlier lab.
    pub fn new(folder: Folder, before: State) -> Self {
        Self {
            folder,
            state: State {
                gyrolab: VERSION.to_owned(),
                is_on: true,
                ..before
            },
            published: None,
            is_followed: true,
            menu: Menu::Closed,
            seats: Vec::new(),
            run: None,
            next_look: Duration::ZERO,
            trouble: None,
        }
    }

    /// Says to the class that the lab was left.
    pub fn leave(&mut self) -> Result<(), String> {
        self.state.is_on = false;
        self.folder.publish(&self.state)
    }

    pub(super) fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) {
        lessons.waive();
        let open = lessons
            .taken()
            .map(|taken| (taken.lesson.name.clone(), taken.place.page));
        let is_turned = open.is_some_and(|(lesson, page)| {
            (lesson, page) != (self.state.lesson.clone(), self.state.page)
        });
        if now < self.next_look && !is_turned {
            return;
        }
        self.next_look = now + EVERY;
        self.seats = sittings(&self.folder);
        self.trouble = None;
        self.look(lab, lessons);
        if self.published.as_ref() == Some(&self.state) {
            self.folder.touch_state();
        } else {
            match self.folder.publish(&self.state) {
                Ok(()) => self.published = Some(self.state.clone()),
                Err(trouble) => self.trouble = Some(trouble),
            }
        }
        if self.folder.is_full() {
            self.trouble = Some("the disk of the class is full: votes cannot be kept".to_owned());
        }
        let dress = self.dress(lessons);
        lessons.set_dress(dress);
    }

    /// Makes the state that of the lab and of the votes.
    fn look(&mut self, lab: &Lab, lessons: &Lessons) {
        if let Some(taken) = lessons.taken() {
            self.state.lesson.clone_from(&taken.lesson.name);
            self.state.page = taken.place.page;
            self.state.kept.clone_from(&taken.place.kept);
            self.state.has_arrived = !taken.is_under_way();
        }
        self.state.shown = if self.is_followed {
            self.shown(lab)
        } else {
            None
        };
        let is_here = |sitting: &&Sitting| sitting.presence == Presence::Here;
        self.state.here = self.seats.iter().filter(is_here).count();
        self.state.answered = 0;
        if let Some(page) = lessons.taken().and_then(|taken| taken.page())
            && let Some((predict, question)) = votes::question(page, &self.state)
        {
            let (lesson, round) = (self.state.lesson.clone(), question.round());
            let has_answered =
                |sitting: &&Sitting| sitting.record.rounds_of(&lesson, &predict.name) >= round;
            let here = self.seats.iter().filter(is_here);
            self.state.answered = here.filter(has_answered).count();
            let tally = Tally::of(&self.seats, &lesson, predict, round);
            let is_shown = question.stage == Stage::All && tally.votes >= FEWEST;
            self.state.question_mut(&predict.name).bars =
                if is_shown { tally.bars } else { Vec::new() };
        }
    }

    /// The run in `lab`, as the class follows it.
    fn shown(&mut self, lab: &Lab) -> Option<Run> {
        let playback = &lab.player().playback;
        let scenario = playback.run().scenario();
        if !self
            .run
            .as_ref()
            .is_some_and(|(run, _)| Arc::ptr_eq(run, scenario))
        {
            self.run = Some((Arc::clone(scenario), scenario.to_toml()));
        }
        let (_, run) = self.run.as_ref()?;
        if run.len() > LONGEST_RUN {
            self.trouble = Some(TOO_LONG.to_owned());
            return None;
        }
        let is_running = playback.is_running();
        let step = playback.step_number();
        let before = self.state.shown.as_ref();
        let still = before.filter(|before| !is_running && before.step == step);
        Some(Run {
            name: lab.runs().name().to_owned(),
            step,
            end_s: lab.runs().present().end_s,
            at_ms: still.map_or_else(unix_ms, |before| before.at_ms),
            is_running,
            speed: playback.speed(),
            exact: playback.run().shows_exact(),
            look: Table::try_from(&lab.view().look).unwrap_or_default(),
            run: run.clone(),
        })
    }

    /// What the class adds to the page.
    fn dress(&self, lessons: &Lessons) -> Dress {
        let count = |presence| {
            let seats = self.seats.iter();
            seats.filter(|sitting| sitting.presence == presence).count()
        };
        let here =
            |sitting: &&Sitting| sitting.presence == Presence::Here && sitting.record.is_aside;
        let aside = self.seats.iter().filter(here).count();
        let taken = lessons.taken();
        let title = taken.map_or(String::new(), |taken| {
            let (page, pages) = (taken.place.page, taken.lesson.pages.len());
            let (here, lost) = (count(Presence::Here), count(Presence::Lost));
            let title = &taken.lesson.title;
            let counts = format!("{page} of {pages} · {here} here, {lost} lost, {aside} aside");
            format!("{counts} · {title}\n{counts}\n{page} of {pages} · {here}, {lost} lost, {aside} aside")
        });
        let page = taken.and_then(|taken| taken.page());
        Dress {
            framed: title,
            border: match (self.menu, self.is_followed) {
                (Menu::Closed, _) => "C: show, again, follow, seats\nC: class",
                (Menu::Open, true) => "1 show 2 again 3 unfollow 4 seats",
                (Menu::Open, false) => "1 show 2 again 3 follow 4 seats",
                (Menu::Seats(_), _) => "Enter closes, opens; Esc: back",
            }
            .to_owned(),
            votes: page.and_then(|page| self.votes(page)),
            instead: match self.menu {
                Menu::Seats(selected) => Some(self.list(selected)),
                _ => None,
            },
        }
    }

    /// The name of the question that the class is at, and the votes as far as they are shown.
    fn votes(&self, page: &Page) -> Option<(String, Vec<Paragraph>)> {
        let (predict, question) = votes::question(page, &self.state)?;
        let tally = Tally::of(&self.seats, &self.state.lesson, predict, question.round());
        let since_s = unix_ms().saturating_sub(question.since_ms) / 1000;
        let line = format!(
            "round {} · {} of {} · {}:{:02}",
            question.round(),
            self.state.answered,
            self.state.here,
            since_s / 60,
            since_s % 60
        );
        let mut lines = vec![Paragraph::new(Kind::Note, line)];
        if question.stage != Stage::Counted {
            lines.push(votes::drawn(&tally.bars));
            let late = (tally.late > 0).then(|| format!("late: {}", tally.late));
            let seen = match question.stage {
                Stage::All if tally.votes < FEWEST => {
                    Some(format!("under {FEWEST} votes the class sees no bars"))
                }
                Stage::All => Some("the class sees these bars".to_owned()),
                Stage::Closed => Some("closed".to_owned()),
                _ => None,
            };
            let words = [tally.advice(predict), late, seen].into_iter().flatten();
            lines.extend(words.map(|words| Paragraph::new(Kind::Note, words)));
        }
        Some((predict.name.clone(), lines))
    }

    fn entries(&self) -> Vec<Entry> {
        let opened = |name: &str| self.state.opened.get(name).copied().unwrap_or(0);
        let locked = login::locked(&self.folder, opened, unix_ms() / 1000);
        let seats = self
            .seats
            .iter()
            .map(|sitting| Entry::Seat(sitting.seat.word.clone()));
        locked.into_iter().map(Entry::Locked).chain(seats).collect()
    }

    fn list(&self, selected: usize) -> Vec<Paragraph> {
        let line = |(index, entry): (usize, Entry)| {
            let (text, is_given) = match &entry {
                Entry::Locked(name) => (format!("{name}: locked by wrong codes"), true),
                Entry::Seat(word) => {
                    let is_closed = self.state.closed.contains(word);
                    let presence = self.seats.iter().find(|sitting| sitting.seat.word == *word);
                    let presence = presence.map(|sitting| sitting.presence);
                    let state = match (is_closed, presence) {
                        (true, _) => "closed",
                        (_, Some(Presence::Here)) => "here",
                        (_, Some(Presence::Lost)) => "lost",
                        _ => "away",
                    };
                    (format!("{word}: {state}"), is_closed)
                }
            };
            let is_selected = index == selected;
            Paragraph::new(
                Kind::Choice {
                    is_selected,
                    is_given,
                },
                text,
            )
        };
        let mut lines: Vec<_> = self.entries().into_iter().enumerate().map(line).collect();
        if lines.is_empty() {
            lines.push(Paragraph::new(Kind::Hint, "Nobody has taken a seat yet."));
        }
        lines
    }

    /// Takes note that a key carries out commands: it closes the menu, and the class is to see what they do.
    pub(super) fn expect(&mut self) {
        self.next_look = Duration::ZERO;
        if self.menu == Menu::Open {
            self.menu = Menu::Closed;
        }
    }

    pub(super) fn takes(&mut self, action: Action, lab: &mut Lab) -> bool {
        self.next_look = Duration::ZERO;
        match (self.menu, action) {
            (Menu::Closed, Action::Class) => self.menu = Menu::Open,
            (_, Action::Class | Action::Close) if self.menu != Menu::Closed => {
                self.menu = Menu::Closed;
            }
            (Menu::Open, Action::Digit(digit @ 1..=4)) => {
                self.menu = Menu::Closed;
                match digit {
                    1 => self.show_more(lab),
                    2 => self.again(lab),
                    3 => self.is_followed = !self.is_followed,
                    _ => {
                        self.menu = Menu::Seats(0);
                        lab.view_mut().turn_to_sheet();
                    }
                }
            }
            (Menu::Open, _) => {
                self.menu = Menu::Closed;
                return false;
            }
            _ => return false,
        }
        true
    }

    /// The question of the page that the class is at.
    fn question(&self) -> Option<String> {
        let lesson = self.folder.lesson(&self.state.lesson)?;
        let (predict, _) = votes::question(lesson.page(self.state.page)?, &self.state)?;
        Some(predict.name.clone())
    }

    /// Shows the votes to one more: to the teacher, then to all; then closes the question.
    fn show_more(&mut self, lab: &mut Lab) {
        let Some(name) = self.question() else {
            return lab.refuse("this page asks nothing");
        };
        let question = self.state.question_mut(&name);
        question.stage = match question.stage {
            Stage::Counted => Stage::Teacher,
            Stage::Teacher => Stage::All,
            Stage::All => Stage::Closed,
            Stage::Closed => return lab.refuse("closed: C 2 asks it again"),
        };
    }

    /// Asks the question once more.
    fn again(&mut self, lab: &mut Lab) {
        let Some(name) = self.question() else {
            return lab.refuse("this page asks nothing");
        };
        let question = self.state.question_mut(&name);
        question.earlier_rounds += 1;
        (question.stage, question.since_ms) = (Stage::Counted, unix_ms());
        lab.refuse(format!("round {}: the class votes again", question.round()));
    }

    pub(super) fn takes_key(&mut self, key: LessonKey, lab: &mut Lab) -> bool {
        let Menu::Seats(selected) = self.menu else {
            return false;
        };
        self.next_look = Duration::ZERO;
        let entries = self.entries();
        match (key, entries.get(selected)) {
            (LessonKey::Move(direction), _) => {
                let last = entries.len().saturating_sub(1);
                self.menu =
                    Menu::Seats(selected.saturating_add_signed(direction.rows(10)).min(last));
            }
            (LessonKey::Take, Some(Entry::Locked(name))) => {
                self.state.opened.insert(name.clone(), unix_ms() / 1000 + 1);
            }
            (LessonKey::Take, Some(Entry::Seat(word))) => {
                if !self.state.closed.remove(word) {
                    self.state.closed.insert(word.clone());
                    lab.refuse(format!("{word} is closed: Enter opens it again"));
                }
            }
            (LessonKey::Take, None) => {}
            _ => {
                self.menu = Menu::Closed;
                return false;
            }
        }
        true
    }
}
