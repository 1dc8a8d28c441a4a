//! The projector: the teacher's page, run and bars for the whole class. It takes no seat and cannot vote. It shows no
//! notes, no names of seats, and no right answers.

use super::folder::{ClassFolder, ClassState};
use super::following::{ClassChange, Follower, Shown};
use super::{CLASS_POLL_INTERVAL, ClassRole, LEAST_WAIT, unix_ms, votes};
use crate::lab::Lab;
use crate::lab::sheet::{Paragraph, SheetLineKind};
use crate::lessons::Lessons;
use crate::lessons::page::ClassOverlay;
use std::ops::ControlFlow;
use std::time::Duration;

/// The role of the projector's lab.
#[derive(Debug)]
pub struct Projector {
    follower: Follower,
    next_look: Duration,
}

impl Projector {
    pub fn new(folder: ClassFolder) -> Self {
        Self {
            follower: Follower::new(folder),
            next_look: Duration::ZERO,
        }
    }

    /// Shows the teacher's lab; a second time if this lab was changed meanwhile.
    fn show(&mut self, lab: &mut Lab, lessons: &mut Lessons) {
        let mut shown = self.follower.show(lab, lessons);
        if shown == Ok(Shown::ChangedHere) {
            self.follower.forget_shown();
            shown = self.follower.show(lab, lessons);
        }
        if let Err(reason) = shown {
            lab.tell(reason);
        }
    }

    fn overlay(&self, lessons: &Lessons) -> ClassOverlay {
        let mut overlay = ClassOverlay {
            is_followed: true,
            is_of_projector: true,
            ..ClassOverlay::default()
        };
        let Some(open) = lessons.open_lesson() else {
            overlay.instead = Some(vec![
                Paragraph::new(SheetLineKind::Heading, "The projector"),
                Paragraph::new(SheetLineKind::Text, "The class has not begun."),
                Paragraph::new(
                    SheetLineKind::Hint,
                    "Its page appears here when it begins. q: quit.",
                ),
            ]);
            return overlay;
        };
        let of = format!("{} of {}", open.place.page, open.lesson.pages.len());
        let title = &open.lesson.title;
        let Some(state) = self.follower.class() else {
            let ends = if self.follower.is_over() {
                ["the class is over", "class over"]
            } else {
                ["waiting for the teacher's lab", "waiting"]
            };
            overlay.framed = ends.map(|end| format!("{of} · {end}")).join("\n");
            return overlay;
        };
        overlay.framed = format!("{of} · {title}");
        let page = open.page().filter(|_| open.lesson.name == state.lesson);
        overlay.votes = page.and_then(|page| {
            let (predict, _) = votes::question(page, state)?;
            Some((predict.name.clone(), vote_lines(state, &predict.name)))
        });
        overlay
    }
}

/// Returns the number of answers to the question `name`, the countdown of its round, and the bars if the class may see
/// them.
fn vote_lines(state: &ClassState, name: &str) -> Vec<Paragraph> {
    let question = state.question(name);
    let (countdown, end) = match question.seconds_left(unix_ms()) {
        Some(left) => (format!("{left} s left · "), ""),
        None if question.is_closed => (String::new(), " · closed"),
        None => (String::new(), ""),
    };
    let round = match question.round() {
        1 => String::new(),
        round => format!("round {round} · "),
    };
    let counted = format!(
        "{countdown}{round}{} of {} have answered{end}",
        state.answered, state.here
    );
    let mut lines = vec![Paragraph::new(SheetLineKind::Note, counted)];
    if !question.bars.is_empty() {
        lines.push(votes::drawn(&question.bars));
    }
    lines
}

impl ClassRole for Projector {
    fn advance(&mut self, now: Duration, lab: &mut Lab, lessons: &mut Lessons) -> ControlFlow<()> {
        if now >= self.next_look {
            self.next_look = now + CLASS_POLL_INTERVAL;
            if self.follower.look(lab) == ClassChange::Begun {
                lab.refuse("the class is on");
            }
            if self.follower.class().is_some() {
                self.show(lab, lessons);
            }
            lessons.set_overlay(self.overlay(lessons), lab);
        }
        ControlFlow::Continue(())
    }

    fn on_class_key(&mut self, _lab: &mut Lab, _lessons: &mut Lessons) {}

    fn wait(&self, now: Duration) -> Duration {
        self.next_look.saturating_sub(now).max(LEAST_WAIT)
    }
}
