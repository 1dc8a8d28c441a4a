//! The list of presets and files, with a preview of the selected one.

use super::{below_rule, longest, popup_rule, write};
use crate::engine::scenario::Scenario;
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::wrapped;
use crate::lab::Lab;
use crate::lab::browser::Browser;
use crate::lab::view::theme::Theme;
use crate::tui::split::{split_columns, split_rows};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use std::path::Path;

const TITLE: &str = "open a preset or a file";
/// Width of the list, columns. The preview has the rest.
const LIST: u16 = 30;

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let browser = &lab.popups().browser;
    let title = match browser.folder() {
        None => TITLE.to_owned(),
        Some(folder) => format!("{TITLE} in {}", folder.display()),
    };
    let inside = popup_rule(&title, area, theme, buf);
    if inside.is_empty() {
        return;
    }
    let [top, below] = split_rows(inside, 1);
    let width = if below.width >= 2 * LIST {
        LIST
    } else {
        below.width
    };
    let [places, rest] = split_columns(below, width);
    filter_line(browser, theme, top, buf);
    list(browser, theme, places, buf);
    preview(browser, theme, rest, buf);
}

/// Returns the number of the first visible entry, so that the selected one is visible.
fn first_shown(browser: &Browser, height: usize) -> usize {
    let selected = browser.selected;
    selected.saturating_sub(height.saturating_sub(1))
}

/// Returns the number of the entry at the cell `at` of the screen if `browser` is drawn on `area`.
pub fn row_at(browser: &Browser, area: Rect, at: Position) -> Option<usize> {
    let inside = below_rule(area);
    let line = at.y.checked_sub(inside.y + 1)?;
    let is_in_list = inside.contains(at) && at.x - inside.x < LIST;
    let height = inside.height.saturating_sub(1) as usize;
    let row = first_shown(browser, height) + line as usize;
    (is_in_list && row < browser.shown().len()).then_some(row)
}

/// Returns the keys of the list and, if it fits in `width` columns, the number of files in the folder.
fn keys(files: usize, others: usize, width: usize) -> String {
    const BROWSER_KEYS: &str = "type to filter, Enter opens";
    let with_files = format!("{BROWSER_KEYS}; files here: {files} with a run, {others} without");
    longest([with_files, BROWSER_KEYS.to_owned()], width)
}

fn filter_line(browser: &Browser, theme: &Theme, area: Rect, buf: &mut Buffer) {
    let (text, role) = match browser.filter.as_str() {
        "" => {
            let room = area.width.saturating_sub(2) as usize;
            let text = keys(browser.files(), browser.others, room);
            (text, Role::Label)
        }
        filter => {
            let shown = browser.shown().len();
            (format!("{filter}_  ({shown})"), Role::Heading)
        }
    };
    write(area, (1, 0), &text, theme.style(role), buf);
}

fn list(browser: &Browser, theme: &Theme, area: Rect, buf: &mut Buffer) {
    let shown = browser.shown();
    if shown.is_empty() {
        let text = "no matching preset or file";
        write(area, (1, 0), text, theme.style(Role::Text), buf);
    }
    let height = area.height as usize;
    let first = first_shown(browser, height);
    let [places, _] = split_columns(area, LIST - 1);
    let entries = shown.iter().enumerate().skip(first);
    for ((index, entry), place) in entries.zip(places.rows()) {
        let (role, mark) = if index == browser.selected {
            (Role::Selected, ">")
        } else {
            (Role::Text, " ")
        };
        let name = below(&entry.name, browser.folder());
        let line = format!("{mark} {name:<width$}", width = LIST as usize - 4);
        write(place, (0, 0), &line, theme.style(role), buf);
    }
}

fn preview(browser: &Browser, theme: &Theme, area: Rect, buf: &mut Buffer) {
    let width = area.width.saturating_sub(2) as usize;
    if width == 0 {
        return;
    }
    let lines = match browser.preview() {
        Some(Ok(scenario)) => described(scenario, width),
        Some(Err(problem)) => refused(problem, width),
        None if browser.choice().is_some_and(|entry| entry.is_folder) => {
            vec![(
                "folder; press Enter to list its files".to_owned(),
                Role::Label,
            )]
        }
        None => Vec::new(),
    };
    let more = lines.len() > area.height as usize;
    let [places, _] = split_columns(area, area.width - 1);
    for ((text, role), (y, place)) in lines.iter().zip((1..).zip(places.rows())) {
        let rest = if more && y == area.height { " ..." } else { "" };
        let text = format!("{}{rest}", text.trim_start());
        write(place, (1, 0), &text, theme.style(*role), buf);
    }
}

/// Returns `name` without its `folder`, which the title names.
fn below<'a>(name: &'a str, folder: Option<&Path>) -> &'a str {
    let rest = folder
        .and_then(Path::to_str)
        .and_then(|folder| name.strip_prefix(folder))
        .map(|rest| rest.trim_start_matches('/'));
    rest.filter(|rest| !rest.is_empty()).unwrap_or(name)
}

fn described(scenario: &Scenario, width: usize) -> Vec<(String, Role)> {
    let file = &scenario.file;
    let look_at = file.viewed_text("look_at");
    let motion = &scenario.motion;
    let run = format!(
        "{} scheme, {} steps of {} s",
        motion.scheme.name, scenario.steps, motion.time_step_s
    );
    let paragraphs = [
        (file.title.as_str(), Role::Heading),
        (file.about.as_deref().unwrap_or_default(), Role::Text),
        (look_at.unwrap_or_default(), Role::Text),
        (run.as_str(), Role::Label),
        (file.source.as_deref().unwrap_or_default(), Role::Label),
    ];
    let mut lines = Vec::new();
    for (text, role) in paragraphs.into_iter().filter(|(text, _)| !text.is_empty()) {
        let text = wrapped(&printable(&text.replace('\n', " ")), width);
        lines.extend(text.into_iter().map(|line| (line, role)));
        lines.push((String::new(), Role::Text));
    }
    lines
}

fn refused(problem: &str, width: usize) -> Vec<(String, Role)> {
    let begin = ("cannot be opened".to_owned(), Role::Off);
    let lines = problem
        .lines()
        .flat_map(|line| wrapped(line, width))
        .map(|line| (line, Role::Text));
    std::iter::once(begin).chain(lines).collect()
}
