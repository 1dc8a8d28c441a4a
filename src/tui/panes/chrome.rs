//! The rows around the panes: the header, the verdict and the keys.

use super::{lesson, longest, shortened, write};
use crate::engine::analysis::verdict::{Phrase, Verdict, VerdictWord};
use crate::engine::run::Clock;
use crate::engine::text::number::{fixed, significant};
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::action::{Action, LessonKey};
use crate::lab::sheet::AskedAnswer;
use crate::lab::view::Pane;
use crate::lab::view::step::StepPageChoice;
use crate::lab::view::theme::Theme;
use crate::tui::keymap::{BINDINGS, Binding, FooterPriority, Key, KeyEffect, Mode};
use crate::tui::layout::ScreenLayout;
use crate::tui::split::split_columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Columns of a title that are written before scheme and time step get room.
const LEAST_TITLE: usize = 32;
/// Columns of the playback speed, fixed so that the time before it does not move.
const PACE_COLUMNS: usize = 12;
/// Minimum columns between the scheme and the time.
const HEADER_GAP: usize = 6;
/// Minimum width at which phrases and keys are three columns apart instead of two.
const WIDE_FROM: u16 = 100;
/// Separator between phrases.
pub(super) const SEPARATOR: &str = " · ";

/// Draws title, scheme and time step at the left, and time, step and speed at the right, in the longest form that fits.
pub fn header(lab: &Lab, area: Rect, buf: &mut Buffer) {
    if lab.view().look.bare {
        return bare_header(lab, area, buf);
    }
    let theme = &lab.view().theme;
    let motion = &lab.player().reading.motion;
    let name = motion.scheme.name;
    let step = format!("dt {} s", significant(motion.time_step_s, 7));
    let scenario = lab.player().run().scenario();
    let title = &scenario.file.title;
    let least_title = columns(title).min(LEAST_TITLE);
    let forms = [
        (format!("  {name} scheme   {step}"), clock(lab, true)),
        (format!("  {name}   {step}"), clock(lab, true)),
        (format!("  {name}   {step}"), clock(lab, false)),
        (format!("  {step}"), clock(lab, false)),
        (String::new(), clock(lab, false)),
        (
            String::new(),
            short_clock(lab, area.width.into(), least_title),
        ),
    ];
    let width = usize::from(area.width);
    let fits = |form: &(String, String)| {
        least_title + columns(&form.0) + HEADER_GAP + columns(&form.1) <= width
    };
    let [.., last] = &forms;
    let (details, clock) = forms.iter().find(|form| fits(form)).unwrap_or(last);
    let clock_x = width.saturating_sub(columns(clock)) as u16;
    write(area, (clock_x, 0), clock, theme.style(Role::Text), buf);
    let [left, _] = split_columns(area, clock_x.saturating_sub(1));
    let room = usize::from(left.width).saturating_sub(columns(details));
    let short = shortened(title, room);
    let x = write(left, (0, 0), &short, theme.style(Role::Heading), buf);
    write(left, (x, 0), details, theme.style(Role::Label), buf);
}

fn bare_header(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let digits = time_decimals(lab.player().run().scenario().least_time_step_s());
    let time_s = lab.player().reading.readouts.sample.time_s;
    let time = format!("t {:>8} s ", fixed(time_s, digits));
    let x = area.width.saturating_sub(time.len() as u16);
    write(area, (x, 0), &time, theme.style(Role::Text), buf);
    let [left, _] = split_columns(area, x.saturating_sub(1));
    let title = &lab.player().run().scenario().file.title;
    write(left, (0, 0), title, theme.style(Role::Heading), buf);
}

/// Returns the decimals with which the times of all steps differ, if the shortest time step is `time_step_s`.
fn time_decimals(time_step_s: f64) -> usize {
    (-libm::log10(time_step_s)).ceil().clamp(0.0, 6.0) as usize
}

/// Returns time, step and speed in fixed columns, with the number of steps of the whole run if `with_total` is true.
fn clock(lab: &Lab, with_total: bool) -> String {
    let reading = &lab.player().reading;
    let scenario = lab.player().run().scenario();
    let decimals = time_decimals(scenario.least_time_step_s());
    let end = fixed(Clock::end_s(scenario), decimals);
    let time = fixed(reading.readouts.sample.time_s, decimals);
    let time_columns = end.len();
    let (step, steps) = (reading.readouts.sample.step, scenario.steps.to_string());
    let step_columns = steps.len();
    let total = if with_total {
        format!(" of {steps}")
    } else {
        String::new()
    };
    let pace = &reading.pace;
    format!("t {time:>time_columns$} s   step {step:>step_columns$}{total}   {pace:<PACE_COLUMNS$}")
}

/// Returns a shorter [`clock`] for a screen of this `width` on which the title needs `least_title` columns.
fn short_clock(lab: &Lab, width: usize, least_title: usize) -> String {
    let reading = &lab.player().reading;
    let decimals = time_decimals(lab.player().run().scenario().least_time_step_s());
    let (step, pace) = (reading.readouts.sample.step, &reading.pace);
    let time = fixed(reading.readouts.sample.time_s, decimals);
    let moves = pace.split([' ', ',']).next().unwrap_or_default();
    let clocks = [
        format!("t {time} s  step {step}  {pace} "),
        format!("t {time} s step {step} {moves}"),
    ];
    let room = width.saturating_sub(least_title + 2);
    shortened(&longest(clocks, room), width).into_owned()
}

/// Draws the verdict on the run: a word, the reasons, and the key that fixes the run. Reasons are dropped before the
/// key.
///
/// While a question is open, the row shows the keys that answer it.
pub fn verdict(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    if let Some(asked) = lab.view().asked() {
        return answer_keys(asked, theme, area, buf);
    }
    let verdict = Verdict::new(&lab.player().reading.readouts.health);
    let (word, role) = match &verdict.word {
        VerdictWord::Reliable => (" reliable:".to_owned(), Role::Heading),
        VerdictWord::Checking => (" checking ...".to_owned(), Role::Label),
        VerdictWord::Badge(word) => (format!(" {word} "), Role::Badge),
    };
    let cure = lab.adviser().offer(lab.player()).map(|offer| {
        let long = format!("a: rerun with {offer}");
        Phrase::new(long, format!("a: {offer}"))
    });
    let gap = if area.width >= WIDE_FROM { 3 } else { 2 };
    let begin = columns(&word) + 1;
    let room = usize::from(area.width).saturating_sub(begin);
    let texts = fitting_phrases(&verdict, cure.as_ref(), gap, room);
    let mut x = write(area, (0, 0), &word, theme.style(role), buf) + 1;
    for (text, kind) in texts {
        x = match kind {
            PhraseKind::Reason => write(area, (x, 0), &text, theme.style(Role::Text), buf),
            PhraseKind::Hint => write(area, (x, 0), &text, theme.style(Role::Label), buf),
            PhraseKind::Cure => {
                let (key, rest) = text.split_at(1);
                let x = write(area, (x, 0), key, theme.style(Role::Heading), buf);
                write(area, (x, 0), rest, theme.style(Role::Text), buf)
            }
        } + gap as u16;
    }
}

/// Draws the keys that answer the open question of a page.
fn answer_keys(asked: AskedAnswer, theme: &Theme, area: Rect, buf: &mut Buffer) {
    let (numbers, mut keys) = match asked {
        AskedAnswer::Elsewhere => return,
        AskedAnswer::Number => (String::new(), vec![("Enter", "type your prediction")]),
        AskedAnswer::Choice { count, is_chosen } => {
            let numbers: Vec<_> = (1..=count).map(|number| number.to_string()).collect();
            let locks = is_chosen.then_some(("Enter", "lock this prediction"));
            (numbers.join(" "), locks.into_iter().collect())
        }
    };
    keys.push(("n", "skip"));
    let gap = if area.width >= WIDE_FROM { 3 } else { 2 };
    let (of_key, of_word) = (theme.style(Role::Heading), theme.style(Role::Label));
    let mut x = 1;
    if !numbers.is_empty() {
        x = write(area, (x, 0), &numbers, of_key, buf);
        x = write(area, (x, 0), " or ", of_word, buf);
        x = write(area, (x, 0), "↑ ↓", of_key, buf);
        x = write(area, (x, 0), " choose", of_word, buf) + gap;
    }
    for (key, word) in keys {
        x = write(area, (x, 0), key, of_key, buf);
        x = write(area, (x + 1, 0), word, of_word, buf) + gap;
    }
}

#[derive(Clone, Copy, PartialEq)]
enum PhraseKind {
    Reason,
    Hint,
    Cure,
}

/// Returns the phrases of `verdict` and `cure` in at most `room` columns.
///
/// The first form that fits is used: all in full, without the hint, shortened from the first on, and then with fewer
/// reasons.
fn fitting_phrases(
    verdict: &Verdict,
    cure: Option<&Phrase>,
    gap: usize,
    room: usize,
) -> Vec<(String, PhraseKind)> {
    let reasons = verdict.reasons.iter().map(|it| (it, PhraseKind::Reason));
    let hint = verdict.hint.iter().map(|it| (it, PhraseKind::Hint));
    let cure = cure.map(|it| (it, PhraseKind::Cure));
    let mut phrases: Vec<_> = reasons.chain(hint).chain(cure).collect();
    if length_of(&phrases, 0, gap) > room {
        phrases.retain(|(_, kind)| *kind != PhraseKind::Hint);
    }
    let mut in_short = 0;
    while length_of(&phrases, in_short, gap) > room {
        let reason = phrases
            .iter()
            .rposition(|(_, kind)| *kind != PhraseKind::Cure);
        match reason {
            _ if in_short < phrases.len() => in_short += 1,
            Some(last) => drop(phrases.remove(last)),
            None => break,
        }
    }
    let texts = phrases.into_iter().enumerate();
    texts
        .map(|(index, (phrase, kind))| (text_of(phrase, index < in_short).to_owned(), kind))
        .collect()
}

fn text_of(phrase: &Phrase, is_short: bool) -> &str {
    if is_short {
        &phrase.short
    } else {
        &phrase.long
    }
}

/// Returns the columns of `phrases`, `gap` columns apart, if the first `in_short` of them are shortened.
fn length_of(phrases: &[(&Phrase, PhraseKind)], in_short: usize, gap: usize) -> usize {
    let texts = phrases
        .iter()
        .enumerate()
        .map(|(index, (phrase, _))| columns(text_of(phrase, index < in_short)) + gap);
    texts.sum::<usize>().saturating_sub(gap)
}

/// Draws as many keys of the mode as fit.
pub fn keys(lab: &Lab, places: &ScreenLayout, buf: &mut Buffer) {
    let (theme, area) = (&lab.view().theme, places.keys);
    for (at, item) in place_keys(lab, places) {
        let label = item.label();
        let x = write(area, (at, 0), &label, theme.style(Role::Heading), buf);
        write(area, (x + 1, 0), item.word, theme.style(Role::Label), buf);
    }
}

/// Returns the key in the footer at the column `x` of the screen.
pub fn key_at(lab: &Lab, places: &ScreenLayout, x: u16) -> Option<Key> {
    let column = x.checked_sub(places.keys.x)?;
    let mut placed = place_keys(lab, places).into_iter();
    let (at, item) = placed.find(|(at, item)| (*at..at + item.length()).contains(&column))?;
    let mut end = at;
    let mut keys = item.keys.iter().copied();
    let under = keys.find(|key| {
        end += key.to_string().len() as u16 + 1;
        column < end
    });
    under.or(item.keys.first().copied())
}

/// Keys that share a word in the footer.
#[derive(Clone)]
struct FooterItem {
    keys: Vec<Key>,
    word: &'static str,
    worth: FooterPriority,
}

impl FooterItem {
    fn label(&self) -> String {
        let keys: Vec<_> = self.keys.iter().map(Key::to_string).collect();
        keys.join(" ")
    }

    /// Returns the columns of the keys and their word.
    fn length(&self) -> u16 {
        let blank = usize::from(!self.word.is_empty());
        (self.label().len() + blank + self.word.len()) as u16
    }
}

/// Returns true if the lesson's page continues below the visible rows.
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

/// Returns the `items` that fit in `width`, and the columns between them.
///
/// Items of low priority are removed first, from the last on. Then the gaps shrink, and words are removed.
fn fitted(mut items: Vec<FooterItem>, width: u16) -> (Vec<FooterItem>, u16) {
    let mut gap = if width >= WIDE_FROM { 3 } else { 2 };
    loop {
        let whole: u16 = items.iter().map(|item| item.length() + gap).sum();
        if whole.saturating_sub(gap) < width || items.is_empty() {
            return (items, gap);
        }
        let least = items.iter().map(|item| item.worth).min();
        let last_least = items.iter().rposition(|item| Some(item.worth) == least);
        let last_word = items.iter().rposition(|item| !item.word.is_empty());
        match (last_least, last_word) {
            _ if gap > 2 => gap = 2,
            (Some(key), _) if least < Some(FooterPriority::Kept) => drop(items.remove(key)),
            _ if gap > 1 => gap = 1,
            (_, Some(word)) => items[word].word = "",
            _ => drop(items.pop()),
        }
    }
}

/// Returns the keys of the footer, before they are fitted. `goes_on` is true if the page can be scrolled further.
fn footer(lab: &Lab, goes_on: bool) -> Vec<FooterItem> {
    let mode = lab.mode();
    let of_pane = super::keys_of(lab);
    // The keys of a page or of a pane on request have meanings of their own, so they are shown before any is used.
    let focus = lab.view().focus;
    let always = focus == Pane::Lesson || focus.is_on_request();
    let of_touched = of_pane
        .filter(|row| row.modes.contains(&mode))
        .filter(|_| lab.view().is_touched || always);
    let of_lab = BINDINGS
        .iter()
        .filter(|row| {
            let mut own = of_touched.clone();
            own.all(|other| other.keys[0] != row.keys[0])
        })
        .map(|row| (row, row.worth));
    let rows = of_touched
        .clone()
        .map(|row| (row, FooterPriority::Own))
        .chain(of_lab)
        .filter(|(row, _)| row.modes.contains(&mode) && !row.footer.is_empty());
    let items = rows.filter_map(|(row, worth)| {
        let word = footer_word(lab, goes_on, row)?;
        let keys = vec![row.keys[0]];
        Some(FooterItem { keys, word, worth })
    });
    let is_off_page = lab.view().sheet.is_some()
        && (lab.view().fullscreen || lab.view().focus == Pane::Parameters);
    let esc_word = match mode {
        Mode::Lab if is_off_page => Some("to the page"),
        Mode::Lab => None,
        Mode::Help if !lab.popups().help.text.is_empty() => Some("clear"),
        Mode::Browser if !lab.popups().browser.filter.is_empty() => Some("clear"),
        Mode::Find => Some("clear"),
        Mode::Help | Mode::Browser | Mode::Lessons | Mode::Dialog => Some("close"),
    };
    let esc = esc_word.map(|word| FooterItem {
        keys: vec![Key::Esc],
        word,
        worth: FooterPriority::Own,
    });
    let mut all: Vec<_> = esc.into_iter().chain(items).collect();
    all.dedup_by(|next, kept| {
        let is_same = next.word == kept.word && next.worth == kept.worth;
        if is_same {
            kept.keys.append(&mut next.keys);
        }
        is_same
    });
    all
}

/// Returns the word for a key in the footer, or `None` if the key does nothing now.
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
        ("exact" | "fix", _) => !lab.view().hides_answers(),
        // A run whose numbers are no longer finite cannot continue.
        ("pause" | "step", _) => !lab.player().run().simulation().has_ended(),
        (_, Some(Action::Lesson(LessonKey::Take))) => !enter.is_empty(),
        (_, Some(Action::Lesson(LessonKey::Next))) => {
            goes_on || sheet.is_some_and(|sheet| sheet.has_next)
        }
        (_, Some(Action::Move(..))) => !is_why,
        _ => true,
    };
    let word = match (row.footer, action) {
        ("pause", _) if !lab.player().is_running() => "run",
        ("next phase", _) if is_why => "next step",
        ("why sideways", _) if is_why => "phases",
        (_, Some(Action::Lesson(LessonKey::Take))) => enter,
        (_, Some(Action::Lesson(LessonKey::Next))) if goes_on => "more",
        (_, Some(Action::Accept)) if lab.popups().shows_settings() => "change",
        _ => row.footer,
    };
    is_of_use.then_some(word)
}
