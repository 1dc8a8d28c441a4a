//! The lines around the panes: title, health and keys.

use super::{shortened, write};
use crate::analysis::remarks::{Remark, remarks};
use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::view::Part;
use crate::lab::view::step::Page;
use crate::observe::reading::Reading;
use crate::text::number::{fixed, shortest};
use crate::tui::keymap::{BINDINGS, Binding, Key, Mode};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// A title of up to so many columns is written whole before scheme and time step have room.
const LEAST_TITLE: usize = 32;
/// Remarks before what would mend the numbers: the turns in a step and the distance.
const BEFORE_OFFER: usize = 2;
/// Between two remarks.
pub(super) const SEPARATOR: &str = " · ";

/// Title, scheme and time step on the left, what fits of it; time, step and pace on the right, in fixed columns.
pub fn title(lab: &Lab, area: Rect, buf: &mut Buffer) {
    if lab.view().bare {
        return bare_title(lab, area, buf);
    }
    let theme = &lab.view().theme;
    let motion = lab.player().motion();
    let step = shortest(motion.time_step_s);
    let clock = clock(
        lab.player().reading(),
        lab.player().run().scenario().least_time_step_s(),
        area.width as usize,
    );
    let clock_x = area.width.saturating_sub(clock.chars().count() as u16);
    write(area, (clock_x, 0), &clock, theme.style(Role::Text), buf);
    let left = Rect {
        width: clock_x.saturating_sub(1),
        ..area
    };
    let room = left.width.saturating_sub(1) as usize;
    let details = [
        format!(" · {} scheme · dt {step} s", motion.scheme.name),
        format!(" · {} · dt {step} s", motion.scheme.name),
        format!(" · {} scheme", motion.scheme.name), // the values have the time step too
        format!(" · {}", motion.scheme.name),
        String::new(),
    ];
    let title = &lab.player().run().scenario().file.title;
    let least = title.chars().count().min(LEAST_TITLE);
    let found = details
        .iter()
        .map(|details| (details, details.chars().count()))
        .find(|(_, length)| length + least <= room);
    if let Some((details, length)) = found {
        let title = shortened(title, room - length);
        let x = write(left, (1, 0), &title, theme.style(Role::Heading), buf);
        write(left, (x, 0), details, theme.style(Role::Quiet), buf);
    }
}

/// Title and time.
fn bare_title(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let digits = digits(lab.player().run().scenario().least_time_step_s());
    let time_s = lab.player().reading().readouts.sample.time_s;
    let time = format!("t {:>8} s ", fixed(time_s, digits));
    let x = area.width.saturating_sub(time.len() as u16);
    write(area, (x, 0), &time, theme.style(Role::Text), buf);
    let left = Rect {
        width: x.saturating_sub(1),
        ..area
    };
    let title = &lab.player().run().scenario().file.title;
    write(left, (1, 0), title, theme.style(Role::Heading), buf);
}

/// Digits after the point of a time that tell every step from the next, of a run whose shortest step is `time_step_s`.
fn digits(time_step_s: f64) -> usize {
    (-time_step_s.log10()).ceil().clamp(0.0, 6.0) as usize
}

/// Time, step and pace in fixed columns, or closer together where `width` is short of them.
fn clock(reading: &Reading, time_step_s: f64, width: usize) -> String {
    let digits = digits(time_step_s);
    let (t, step) = (reading.readouts.sample.time_s, reading.readouts.sample.step);
    let (t, pace) = (fixed(t, digits), &reading.pace);
    let moves = pace.split([' ', ',']).next().unwrap_or_default();
    let clocks = [
        format!("t {t:>8} s  step {step:<8} {pace:<11}"),
        format!("t {t} s  step {step}  {pace} "),
        format!("t {t} s step {step} {moves}"),
    ];
    let fits = |clock: &&String| clock.chars().count() <= width;
    match clocks.iter().find(fits) {
        Some(clock) => clock.clone(),
        None => shortened(&clocks[2], width).into_owned(),
    }
}

/// What the time step makes of the numbers, in words: at length if all of it fits, else in short, as much as fits.
pub fn health(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let mut remarks = remarks(&lab.player().reading().readouts.health, None);
    let player = lab.player();
    if let (Some(long), Some(short)) = (player.offer(), player.offer_in_short()) {
        let offer = Remark {
            long,
            short,
            warns: false,
        };
        remarks.insert(BEFORE_OFFER.min(remarks.len()), offer);
    }
    let length = |text: &String| text.chars().count() + SEPARATOR.chars().count();
    let whole: usize = remarks.iter().map(|remark| length(&remark.long)).sum();
    let mut x = 1;
    for remark in &remarks {
        let text = if whole <= area.width as usize {
            &remark.long
        } else {
            &remark.short
        };
        if x > 1 && x as usize + length(text) > area.width as usize {
            return;
        }
        if x > 1 {
            x = write(area, (x, 0), SEPARATOR, theme.style(Role::Quiet), buf);
        }
        let role = if remark.warns {
            Role::Warning
        } else {
            Role::Text
        };
        x = write(area, (x, 0), text, theme.style(role), buf);
    }
}

/// Whether the line about the numbers' health warns of something.
pub fn warns(lab: &Lab) -> bool {
    let remarks = remarks(&lab.player().reading().readouts.health, None);
    remarks.iter().any(|remark| remark.warns) && !lab.view().hides(Part::Health)
}

/// The keys of the mode, as many as fit; help and quit always.
pub fn keys(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    for (x, key, word) in placed(lab, area.width) {
        let x = write(
            area,
            (x, 0),
            &key.to_string(),
            theme.style(Role::Focus),
            buf,
        );
        write(area, (x + 1, 0), word, theme.style(Role::Quiet), buf);
    }
}

/// The key that the line of keys on `area` names at the column `x` of the screen.
pub fn key_at(lab: &Lab, area: Rect, x: u16) -> Option<Key> {
    let x = x.checked_sub(area.x)?;
    let mut placed = placed(lab, area.width).into_iter();
    let found = placed.find(|(at, key, word)| (*at..at + length(*key, word)).contains(&x));
    found.map(|(_, key, _)| key)
}

/// Each key of the line with its column and its word.
fn placed(lab: &Lab, width: u16) -> Vec<(u16, Key, &'static str)> {
    let mut x = 1;
    let place = |(key, word)| {
        let at = x;
        x += length(key, word) + 2;
        (at, key, word)
    };
    footer(lab, width as usize).into_iter().map(place).collect()
}

/// Columns of a key and its word.
fn length(key: Key, word: &str) -> u16 {
    (key.to_string().len() + 1 + word.len()) as u16
}

fn footer(lab: &Lab, width: usize) -> Vec<(Key, &'static str)> {
    let (mode, is_running) = (lab.on_top().mode(), lab.player().playback().is_running());
    let is_why = lab.view().page == Page::Why;
    let sheet = lab.view().sheet.as_ref();
    let (enter, has_next) = sheet.map_or(("", false), |sheet| (sheet.enter, sheet.has_next));
    let of_pane = super::keys_of(lab);
    let of_mode = of_pane.clone().filter(|row| row.modes.contains(&mode));
    let is_new = |row: &&Binding| of_mode.clone().all(|other| other.keys[0] != row.keys[0]);
    let rows = of_pane
        .chain(BINDINGS.iter().filter(is_new))
        .filter(|row| row.modes.contains(&mode) && !row.footer.is_empty())
        .filter(|row| row.action != Action::ToggleResiduals || lab.player().measured().is_some())
        .filter(|row| row.action != Action::Lesson(LessonKey::Take) || !enter.is_empty())
        .filter(|row| row.action != Action::Lesson(LessonKey::Next) || has_next)
        .filter(|row| !is_why || !matches!(row.action, Action::Move(_)))
        .filter(|row| !goes_on(row.action) || !lab.player().run().simulation().has_ended());
    let mut words: Vec<_> = rows
        .map(|row| {
            let word = match row.action {
                Action::TogglePause if !is_running => "go on",
                Action::Lesson(LessonKey::Take) => enter,
                Action::NextPhase if is_why => "next step",
                Action::Why if is_why => "phases",
                _ => row.footer,
            };
            (row.keys[0], word, worth(row.action, lab))
        })
        .collect();
    if mode != Mode::Lab {
        let searches = match mode {
            Mode::Help => !lab.on_top().help().text().is_empty(),
            Mode::Filter | Mode::Find => true,
            _ => false,
        };
        let word = if searches { "clear" } else { "close" };
        words.insert(0, (Key::Esc, word, Worth::Kept));
    } else if lab.view().filled && lab.view().sheet.is_some() {
        words.insert(0, (Key::Esc, "to the page", Worth::Kept));
    }
    let whole = |words: &[(Key, &str, Worth)]| {
        let lengths = words.iter().map(|(key, word, _)| length(*key, word) + 2);
        lengths.sum::<u16>() as usize
    };
    while words.len() > 2 && whole(&words) > width {
        let others = &words[..words.len() - 2]; // the last two are help and quit
        let least = others.iter().map(|(_, _, worth)| *worth).min();
        let last = others
            .iter()
            .rposition(|(_, _, worth)| Some(*worth) == least);
        words.remove(last.unwrap_or_default());
    }
    words
        .into_iter()
        .map(|(key, word, _)| (key, word))
        .collect()
}

/// Whether `action` plays the run on, which a run whose numbers are no longer finite cannot.
fn goes_on(action: Action) -> bool {
    matches!(action, Action::TogglePause | Action::Step)
}

/// How long the footer names a key where there is not room for all: the least go first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Worth {
    Spare,
    Useful,
    Open,
    Look,
    Kept,
}

/// How long the footer names the key of `action` in `lab`.
fn worth(action: Action, lab: &Lab) -> Worth {
    use Action::{
        Accept, Browse, Choose, Export, Help, Lesson, NarrowerWindow, NextPhase, Pan, Parameters,
        PhaseBack, Push, Quit, Step, ToggleExact, TogglePause, ToggleResiduals, ToggleStep,
        WholeView, Why, ZoomIn,
    };
    match action {
        ToggleExact | Export => Worth::Useful,
        Browse => Worth::Open,
        NarrowerWindow | Pan(_) => Worth::Look,
        ToggleResiduals => Worth::Kept,
        Lesson(LessonKey::Take | LessonKey::Next)
        | TogglePause
        | Step
        | NextPhase
        | ToggleStep
        | PhaseBack
        | Why
        | Parameters
        | Push
        | Choose
        | Accept
        | ZoomIn
        | Help
        | Quit => Worth::Kept,
        // What takes zoom and pan back, as long as there is something to take back.
        WholeView if !lab.shows_whole_view() => Worth::Look,
        _ => Worth::Spare,
    }
}
