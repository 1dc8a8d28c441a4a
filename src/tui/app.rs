//! The main loop: handles keys, advances the run with time, and draws a frame when something has changed.

use crate::class::ClassRole;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::storage::session::Session;
use crate::lab::{Lab, LabRequest};
use crate::lessons::Lessons;
use crate::tui::decoder::Typed;
use crate::tui::job_control::{NO_SHELL, can_be_resumed};
use crate::tui::mouse::Pointer;
use crate::tui::pacing::Pacing;
use crate::tui::press::press;
use crate::tui::screen;
use crate::tui::terminal::{Event, Screen};
use ratatui::layout::Rect;
use std::io;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Longest wait for events while nothing changes.
const LONGEST_IDLE_WAIT: Duration = Duration::from_millis(500);
/// Longest wait for events during a background job: an export or a search for advice.
const ATTENTIVE: Duration = Duration::from_millis(100);

/// Runs `lab` with its `lessons` and its `role` in a class on the terminal, until the user leaves.
///
/// It saves the state of the lab in `session`, if given.
///
/// # Errors
///
/// Returns an error if the terminal cannot be opened, read or written.
pub fn run(
    lab: &mut Lab,
    lessons: &mut Lessons,
    role: &mut dyn ClassRole,
    session: Option<&Session>,
) -> io::Result<()> {
    let (mut screen, mut pointer) = (Screen::enter()?, Pointer::default());
    let mut pacing = Pacing::new(lab.view().fps);
    let begin = Instant::now();
    screen::fit(lab, screen.size()?);
    if lab.settings.asks_background {
        screen.ask_background()?;
    }
    loop {
        screen.set_mouse(lab.view().mouse)?;
        pacing.set_rate(lab.view().fps);
        let until_frame = idle_time(lab, lessons, pacing.wait(begin.elapsed()));
        let events = screen.events(until_frame.min(role.wait(begin.elapsed())))?;
        let acted = !events.is_empty();
        for event in events {
            let (screen, pointer) = (&mut screen, &mut pointer);
            if handle(event, lab, lessons, role, screen, pointer, session)?.is_break() {
                return Ok(());
            }
            role.after_keys(lab, lessons);
        }
        #[cfg(debug_assertions)]
        panic_if_asked(begin.elapsed());
        let (has_arrived, is_over) = advance_all(lab, lessons, role, begin);
        if lab.has_changed() {
            screen::refit(lab, screen.size()?);
        }
        keep(lab, lessons, role, session);
        if is_over {
            return Ok(());
        }
        // Draw the answer to a key, or the requested step, at once instead of waiting for the next frame.
        let now = begin.elapsed();
        if (acted || has_arrived || pacing.is_due(now)) && lab.take_changed() {
            let bytes = screen.draw(|area, buf| screen::draw(lab, true, area, buf))?;
            pacing.drawn(now, bytes, screen.size()?.area());
        }
    }
}

/// Advances run, class and lessons.
///
/// The first result is true if the run has just reached its target, the second if the lab must end.
pub(super) fn advance_all(
    lab: &mut Lab,
    lessons: &mut Lessons,
    role: &mut dyn ClassRole,
    begin: Instant,
) -> (bool, bool) {
    let was_on_its_way = lab.player().steps_to_go().is_some();
    lab.advance(&mut || begin.elapsed());
    let has_arrived = was_on_its_way && lab.player().steps_to_go().is_none();
    let is_over = role.advance(begin.elapsed(), lab, lessons).is_break();
    lessons.update(begin.elapsed(), lab);
    (has_arrived, is_over)
}

/// Saves the state of `lab` in `session`, and shows a message while saving fails.
fn keep(lab: &mut Lab, lessons: &Lessons, role: &dyn ClassRole, session: Option<&Session>) {
    let Some(session) = session else {
        return;
    };
    session.note(lab.content(lessons.kept()));
    lab.set_trouble(role.trouble().or_else(|| session.trouble()));
}

/// Panics on request, for tests of how the program ends. Compiled with debug assertions only.
///
/// `GYROLAB_PANIC_AFTER_MS=1000` makes this thread panic after a second, and `GYROLAB_PANIC_ASIDE_AFTER_MS=1000` a
/// background thread.
#[cfg(debug_assertions)]
#[expect(clippy::panic, reason = "it is what the tests ask for")]
fn panic_if_asked(elapsed: Duration) {
    static ASIDE: std::sync::Once = std::sync::Once::new();
    fn is_time(name: &str, elapsed: Duration) -> bool {
        let after_ms = std::env::var(name).ok().and_then(|ms| ms.parse().ok());
        after_ms.is_some_and(|ms| elapsed >= Duration::from_millis(ms))
    }
    if is_time("GYROLAB_PANIC_AFTER_MS", elapsed) {
        panic!("a panic was asked for");
    }
    if is_time("GYROLAB_PANIC_ASIDE_AFTER_MS", elapsed) {
        ASIDE.call_once(|| drop(std::thread::spawn(|| panic!("a panic was asked for aside"))));
    }
}

/// Returns how long to wait for events if the next frame is due in `to_frame`.
pub(super) fn idle_time(lab: &Lab, lessons: &Lessons, to_frame: Duration) -> Duration {
    if lab.player().is_flat_out() {
        Duration::ZERO
    } else if lab.player().is_busy() || lab.has_changed() {
        // Wait at least 1 ms: a run too slow to change anything by the next frame must not keep the processor busy.
        to_frame.max(Duration::from_millis(1))
    } else {
        let is_attentive =
            lab.files().is_exporting() || lab.adviser().is_seeking() || !lab.script().is_done();
        let rest = if is_attentive {
            ATTENTIVE
        } else {
            LONGEST_IDLE_WAIT
        };
        let rest = lessons.wait().unwrap_or(rest).min(rest);
        lab.notice_ends_in().unwrap_or(rest).min(rest)
    }
}

fn handle(
    event: Event,
    lab: &mut Lab,
    lessons: &mut Lessons,
    role: &mut dyn ClassRole,
    screen: &mut Screen,
    pointer: &mut Pointer,
    session: Option<&Session>,
) -> io::Result<ControlFlow<()>> {
    let is_signal = event == Event::Suspend;
    let request = request_of(event, lab, screen, pointer)?;
    if matches!(request, Some(LabRequest::Quit | LabRequest::Suspend)) {
        keep(lab, lessons, role, session); // includes the effect of the keys pressed just before
    }
    let size = screen.size()?;
    let request = match request {
        Some(LabRequest::Lesson(key))
            if !scrolls_page(key, lab, size) && role.intercept(key, lab, lessons) =>
        {
            None
        }
        request => request.and_then(|request| do_in_class(request, lab, lessons, size)),
    };
    match request {
        None | Some(LabRequest::Lesson(_) | LabRequest::Answer(_)) => {
            return Ok(ControlFlow::Continue(()));
        }
        Some(LabRequest::Class) => {
            role.on_class_key(lab, lessons);
            return Ok(ControlFlow::Continue(()));
        }
        Some(LabRequest::Quit) => return Ok(ControlFlow::Break(())),
        Some(LabRequest::Redraw) => screen.forget()?,
        Some(LabRequest::Suspend) if !can_be_resumed() => lab.refuse(NO_SHELL),
        Some(LabRequest::Suspend) => screen.suspend(!is_signal)?,
    }
    screen::fit(lab, screen.size()?); // redraw everything at the current size
    Ok(ControlFlow::Continue(()))
}

/// Carries out `event` in the lab. Returns a request if only the main loop can fulfill it.
fn request_of(
    event: Event,
    lab: &mut Lab,
    screen: &mut Screen,
    pointer: &mut Pointer,
) -> io::Result<Option<LabRequest>> {
    Ok(match event {
        Event::Typed(Typed::Key(key)) => press(key, lab),
        Event::Typed(Typed::Paste(text)) => {
            lab.paste(&text);
            None
        }
        Event::Typed(Typed::Background(background)) => {
            lab.view_mut().theme.background = background;
            None
        }
        Event::Typed(Typed::Mouse(mouse)) => pointer.act(mouse, screen.size()?, lab),
        Event::Suspend => Some(LabRequest::Suspend),
        // A screen that was smaller for a moment has lost some of its content, even if it has its old size again.
        Event::Resized => Some(LabRequest::Redraw),
        Event::Resumed => {
            screen.resume()?;
            Some(LabRequest::Redraw)
        }
    })
}

/// Returns true if `key` scrolls the page: the next-page key does so until the end of the page is visible.
pub fn scrolls_page(key: LessonKey, lab: &Lab, size: Rect) -> bool {
    key == LessonKey::Next && screen::page_goes_on(lab, size)
}

/// Carries out a `request` to the lessons on a screen of this `size`. Returns any other request unchanged.
pub fn do_in_class(
    request: LabRequest,
    lab: &mut Lab,
    lessons: &mut Lessons,
    size: Rect,
) -> Option<LabRequest> {
    match request {
        LabRequest::Lesson(key) if scrolls_page(key, lab, size) => {
            screen::scroll_page(lab, Direction::PageDown, size);
        }
        LabRequest::Lesson(key) => {
            if let Some(direction) = lessons.on_key(key, lab) {
                screen::scroll_page(lab, direction, size);
            }
        }
        LabRequest::Answer(number) => lessons.answer(number, lab),
        other => return Some(other),
    }
    None
}
