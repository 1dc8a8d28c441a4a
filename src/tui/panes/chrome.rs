//! The lines around the panes: title, health and keys.

use super::{lesson, longest, shortened, write};
use crate::engine::analysis::remarks::{Remark, remarks};
use crate::engine::text::number::{fixed, significant};
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::playback::reading::Reading;
use crate::lab::view::step::StepPageChoice;
use crate::lab::view::{HideablePart, Pane};
use crate::tui::keymap::{BINDINGS, Binding, FooterPriority, Key, KeyEffect, Mode};
use crate::tui::layout::ScreenLayout;
use crate::tui::split::split_columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// A title of up to this many columns is written whole before scheme and time step have room.
const LEAST_TITLE: usize = 32;
/// Remarks before what would mend the numbers: the turns in a step and the distance.
const BEFORE_OFFER: usize = 2;
pub(super) const SEPARATOR: &str = " · ";

/// Title, scheme and time step on the left, what fits of it; time, step and pace on the right, in fixed columns.
pub fn title(lab: &Lab, area: Rect, buf: &mut Buffer) {
    if lab.view().look.bare {
        return bare_title(lab, area, buf);
    }
    let theme = &lab.view().theme;
    let motion = lab.player().motion();
    let step = significant(motion.time_step_s, 7);
    let clock = clock_text(
        &lab.player().reading,
        lab.player().run().scenario().least_time_step_s(),
        area.width as usize,
    );
    let clock_x = area.width.saturating_sub(columns(&clock) as u16);
    write(area, (clock_x, 0), &clock, theme.style(Role::Text), buf);
    let [left, _] = split_columns(area, clock_x.saturating_sub(1));
    let room = left.width.saturating_sub(1) as usize;
    let details = [
        format!(" · {} scheme · dt {step} s", motion.scheme.name),
        format!(" · {} · dt {step} s", motion.scheme.name),
        format!(" · {} scheme", motion.scheme.name), // the values have the time step too
        format!(" · {}", motion.scheme.name),
        String::new(),
    ];
    let title = &lab.player().run().scenario().file.title;
    let least = columns(title).min(LEAST_TITLE);
    let fitting = details.iter().find(|text| columns(text) + least <= room);
    if let Some(detail) = fitting {
        let short = shortened(title, room - columns(detail));
        let x = write(left, (1, 0), &short, theme.style(Role::Heading), buf);
        write(left, (x, 0), detail, theme.style(Role::Quiet), buf);
    }
}

fn bare_title(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let digits = time_decimals(lab.player().run().scenario().least_time_step_s());
    let time_s = lab.player().reading.readouts.sample.time_s;
    let time = format!("t {:>8} s ", fixed(time_s, digits));
    let x = area.width.saturating_sub(time.len() as u16);
    write(area, (x, 0), &time, theme.style(Role::Text), buf);
    let [left, _] = split_columns(area, x.saturating_sub(1));
    let title = &lab.player().run().scenario().file.title;
    write(left, (1, 0), title, theme.style(Role::Heading), buf);
}

/// Digits after the point of a time that tell every step from the next, of a run whose shortest step is `time_step_s`.
fn time_decimals(time_step_s: f64) -> usize {
    (-libm::log10(time_step_s)).ceil().clamp(0.0, 6.0) as usize
}

/// Time, step and pace in fixed columns, or closer together where `width` is short of them.
fn clock_text(reading: &Reading, time_step_s: f64, width: usize) -> String {
    let digits = time_decimals(time_step_s);
    let (t, step) = (reading.readouts.sample.time_s, reading.readouts.sample.step);
    let (t, pace) = (fixed(t, digits), &reading.pace);
    let moves = pace.split([' ', ',']).next().unwrap_or_default();
    let clocks = [
        format!("t {t:>8} s  step {step:<8} {pace:<11}"),
        format!("t {t} s  step {step}  {pace} "),
        format!("t {t} s step {step} {moves}"),
    ];
    shortened(&longest(clocks, width), width).into_owned()
}

/// What the time step makes of the numbers, in words: at length if all of it fits, else in short, as much as fits.
pub fn health(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let mut shown = remarks(&lab.player().reading.readouts.health, None);
    if let Some([long, short]) = lab.adviser().offer(lab.player()) {
        let offer = Remark {
            long,
            short,
            warns: false,
        };
        shown.insert(BEFORE_OFFER.min(shown.len()), offer);
    }
    let whole: usize = shown
        .iter()
        .map(|remark| columns(&remark.long) + columns(SEPARATOR))
        .sum();
    let mut x = 1;
    for remark in &shown {
        let text = if whole <= area.width as usize {
            &remark.long
        } else {
            &remark.short
        };
        if x > 1 && x as usize + columns(text) + columns(SEPARATOR) > area.width as usize {
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
    let health = &lab.player().reading.readouts.health;
    !lab.view().hides(HideablePart::Health)
        && remarks(health, None).iter().any(|remark| remark.warns)
}

/// The keys of the mode, as many as fit; help and quit always.
pub fn keys(lab: &Lab, places: &ScreenLayout, buf: &mut Buffer) {
    let (theme, area) = (&lab.view().theme, places.keys);
    for (x, item) in place_keys(lab, places) {
        let (key, focus) = (item.key.to_string(), theme.style(Role::Focus));
        let x = write(area, (x, 0), &key, focus, buf);
        write(area, (x + 1, 0), item.word, theme.style(Role::Quiet), buf);
    }
}

/// The key that the line of keys names at the column `x` of the screen.
pub fn key_at(lab: &Lab, places: &ScreenLayout, x: u16) -> Option<Key> {
    let column = x.checked_sub(places.keys.x)?;
    let mut placed = place_keys(lab, places).into_iter();
    let found = placed.find(|(at, item)| (*at..at + item.length()).contains(&column));
    found.map(|(_, item)| item.key)
}

#[derive(Clone, Copy)]
struct FooterItem {
    key: Key,
    word: &'static str,
    worth: FooterPriority,
}

impl FooterItem {
    /// Columns of the key and its word.
    fn length(&self) -> u16 {
        let blank = usize::from(!self.word.is_empty());
        (self.key.to_string().len() + blank + self.word.len()) as u16
    }
}

/// Returns whether the page of the lesson continues below what the screen shows of it.
pub fn page_goes_on(lab: &Lab, places: &ScreenLayout) -> bool {
    let place = places.place_of(Pane::Lesson);
    place.is_some_and(|place| lesson::has_more(lab, place))
}

fn place_keys(lab: &Lab, places: &ScreenLayout) -> Vec<(u16, FooterItem)> {
    let (items, gap) = fitted(footer(lab, page_goes_on(lab, places)), places.keys.width);
    let mut x = 1;
    items
        .into_iter()
        .map(|item| {
            let at = x;
            x += item.length() + gap;
            (at, item)
        })
        .collect()
}

/// As many of `items` as `width` has room for, and the columns between two of them. The spare keys give way first, then
/// every second blank, then the words of the keys that every pane has, and last keys; help and quit stay.
fn fitted(mut items: Vec<FooterItem>, width: u16) -> (Vec<FooterItem>, u16) {
    let mut gap = 2;
    loop {
        let whole: u16 = items.iter().map(|item| item.length() + gap).sum();
        if whole.saturating_sub(gap) < width || items.len() <= 2 {
            return (items, gap);
        }
        let others = &items[..items.len() - 2]; // the last two are help and quit
        let least = others.iter().map(|item| item.worth).min();
        let has_spare = least == Some(FooterPriority::Spare);
        let last_word = others
            .iter()
            .rposition(|item| item.worth < FooterPriority::Own && !item.word.is_empty());
        let last_least = others.iter().rposition(|item| Some(item.worth) == least);
        if gap > 1 && least.is_some() && !has_spare {
            gap = 1;
        } else if let Some(word) = last_word.filter(|_| !has_spare) {
            items[word].word = "";
        } else if let Some(key) = last_least {
            items.remove(key);
        }
    }
}

/// The keys that the footer names where there is room for all; `goes_on` says whether the page has more to be scrolled to.
fn footer(lab: &Lab, goes_on: bool) -> Vec<FooterItem> {
    let mode = lab.popups().mode;
    let of_pane = super::keys_of(lab);
    let of_mode = of_pane.clone().filter(|row| row.modes.contains(&mode));
    // The keys of a page and of a pane that was asked for differ in meaning from those of the run, touched or not.
    let focus = lab.view().focus;
    let always = focus == Pane::Lesson || focus.is_on_request();
    let of_touched = of_pane.filter(|_| lab.view().is_touched || always);
    let of_lab = BINDINGS
        .iter()
        .filter(|row| of_mode.clone().all(|other| other.keys[0] != row.keys[0]))
        .map(|row| (row, row.worth));
    let rows = of_touched
        .map(|row| (row, FooterPriority::Own))
        .chain(of_lab)
        .filter(|(row, _)| row.modes.contains(&mode) && !row.footer.is_empty());
    let items = rows.filter_map(|(row, worth)| {
        let word = footer_word(lab, goes_on, row)?;
        let key = row.keys[0];
        Some(FooterItem { key, word, worth })
    });
    let esc_word = match mode {
        Mode::Lab if lab.view().fullscreen && lab.view().sheet.is_some() => Some("to the page"),
        Mode::Lab => None,
        Mode::Help if lab.popups().help.text.is_empty() => Some("close"),
        Mode::Help | Mode::Filter | Mode::Find => Some("clear"),
        Mode::Browser | Mode::Dialog => Some("close"),
    };
    let esc = esc_word.map(|word| FooterItem {
        key: Key::Esc,
        word,
        worth: FooterPriority::Own,
    });
    esc.into_iter().chain(items).collect()
}

/// What the footer says of a key now; `None` where the key does nothing.
fn footer_word(lab: &Lab, goes_on: bool, row: &Binding) -> Option<&'static str> {
    let is_why = lab.view().look.phase == StepPageChoice::Why;
    let sheet = lab.view().sheet.as_ref();
    let enter = sheet.map_or("", |sheet| sheet.enter);
    let action = match row.does {
        KeyEffect::Action(action) => Some(action),
        KeyEffect::Commands(_) => None,
    };
    let is_of_use = match (row.footer, action) {
        ("residuals", _) => lab.comparison().data().is_some(),
        // A run whose numbers are no longer finite cannot go on.
        ("pause" | "step", _) => !lab.player().run().simulation().has_ended(),
        (_, Some(Action::Lesson(LessonKey::Take))) => !enter.is_empty(),
        (_, Some(Action::Lesson(LessonKey::Next))) => {
            goes_on || sheet.is_some_and(|sheet| sheet.has_next)
        }
        (_, Some(Action::Move(..))) => !is_why,
        _ => true,
    };
    let word = match (row.footer, action) {
        ("pause", _) if !lab.player().is_running() => "go on",
        ("next phase", _) if is_why => "next step",
        ("why sideways", _) if is_why => "phases",
        (_, Some(Action::Lesson(LessonKey::Take))) => enter,
        (_, Some(Action::Lesson(LessonKey::Next))) if goes_on => "more",
        (_, Some(Action::Accept)) if lab.popups().shows_settings() => "change",
        _ => row.footer,
    };
    is_of_use.then_some(word)
}
