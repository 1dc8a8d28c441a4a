//! The list of presets and files, with a preview of what is selected.

use super::{frame_on_top, write};
use crate::lab::browser::Browser;
use crate::lab::preview::Preview;
use crate::lab::view::theme::Theme;
use crate::scenario::Scenario;
use crate::text::printable::printable;
use crate::text::wrap::wrapped;
use crate::tui::keymap::Mode;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::widgets::Widget;
use std::path::Path;

const TITLE: &str = "open a preset or a file";
/// Width of the list; the preview has the rest.
const LIST: u16 = 30;

/// The browser on top of the panes.
pub struct BrowserPane<'a> {
    /// Its state.
    pub browser: &'a Browser,
    /// Whether the filter is being typed.
    pub mode: Mode,
    /// Colours.
    pub theme: &'a Theme,
}

impl Widget for BrowserPane<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let title = match self.browser.folder() {
            None => TITLE.to_owned(),
            Some(folder) => format!("{TITLE} of {}", folder.display()),
        };
        let inside = frame_on_top(&title, area, self.theme, buf);
        if inside.is_empty() {
            return;
        }
        self.filter_line(
            Rect {
                height: 1,
                ..inside
            },
            buf,
        );
        let below = Rect {
            y: inside.y + 1,
            height: inside.height - 1,
            ..inside
        };
        let width = if below.width >= 2 * LIST {
            LIST
        } else {
            below.width
        };
        self.list(Rect { width, ..below }, buf);
        let rest = Rect {
            x: below.x + width,
            width: below.width - width,
            ..below
        };
        self.preview(rest, buf);
    }
}

/// The number of the first entry in a list of `height` lines.
fn first_shown(browser: &Browser, height: usize) -> usize {
    let selected = browser.selected;
    selected.saturating_sub(height.saturating_sub(1))
}

/// The number of the entry at the cell `at` of the screen where `browser` is drawn on `area`.
pub fn row_at(browser: &Browser, area: Rect, at: Position) -> Option<usize> {
    let inside = area.inner(Margin::new(1, 1));
    let line = at.y.checked_sub(inside.y + 1)?;
    let is_in_list = inside.contains(at) && at.x - inside.x < LIST;
    let height = inside.height.saturating_sub(1) as usize;
    let row = first_shown(browser, height) + line as usize;
    (is_in_list && row < browser.shown().len()).then_some(row)
}

/// The keys of the list, and what it contains beside the presets, in as many words as fit in `width` columns.
fn keys(files: usize, others: usize, width: usize) -> String {
    const KEYS: &str = "/ filters by name, Enter opens";
    let files = match files {
        0 => "no file of this folder holds a run".to_owned(),
        1 => "below: a file of this folder".to_owned(),
        _ => format!("below: {files} files of this folder"),
    };
    let others = match others {
        0 => String::new(),
        _ => format!(", {others} more hold no run"),
    };
    let forms = [
        format!("{KEYS}; {files}{others}"),
        format!("/ filters, Enter opens; {files}{others}"),
        format!("{KEYS}; {files}"),
        format!("/ filters, Enter opens; {files}"),
    ];
    let fits = |form: &&String| form.len() <= width;
    forms
        .iter()
        .find(fits)
        .map_or(KEYS, String::as_str)
        .to_owned()
}

impl BrowserPane<'_> {
    fn filter_line(&self, area: Rect, buf: &mut Buffer) {
        let shown = self.browser.shown().len();
        let (text, role) = match (self.mode, self.browser.filter.as_str()) {
            (Mode::Filter, filter) => (format!("/{filter}_  ({shown})"), Role::Focus),
            (_, "") => {
                let (files, others) = (self.browser.files(), self.browser.others);
                let room = area.width.saturating_sub(2) as usize;
                (keys(files, others, room), Role::Quiet)
            }
            (_, filter) => (format!("/{filter}  ({shown})"), Role::Text),
        };
        write(area, (1, 0), &text, self.theme.style(role), buf);
    }

    fn list(&self, area: Rect, buf: &mut Buffer) {
        let shown = self.browser.shown();
        if shown.is_empty() {
            write(
                area,
                (1, 0),
                "nothing has that in its name",
                self.theme.style(Role::Text),
                buf,
            );
        }
        let height = area.height as usize;
        let first = first_shown(self.browser, height);
        for ((index, entry), y) in shown.iter().enumerate().skip(first).zip(0..area.height) {
            let selected = index == self.browser.selected;
            let role = if selected { Role::Selected } else { Role::Text };
            let mark = if selected { ">" } else { " " };
            let name = below(&entry.name, self.browser.folder());
            let line = format!("{mark} {name:<width$}", width = LIST as usize - 4);
            let room = Rect {
                width: area.width.min(LIST - 1),
                ..area
            };
            write(room, (0, y), &line, self.theme.style(role), buf);
        }
    }

    fn preview(&self, area: Rect, buf: &mut Buffer) {
        let width = area.width.saturating_sub(2) as usize;
        if width == 0 {
            return;
        }
        let lines = match self.browser.preview() {
            Some(Preview::Known(known)) => match known.as_ref() {
                Ok(scenario) => described(scenario, width),
                Err(problem) => refused(problem, width),
            },
            Some(Preview::Loading) => vec![("reading ...".to_owned(), Role::Quiet)],
            None if self.browser.choice().is_some_and(|entry| entry.is_folder) => {
                vec![("a folder: Enter lists its files".to_owned(), Role::Quiet)]
            }
            None => Vec::new(),
        };
        let more = lines.len() > area.height as usize;
        for ((text, role), y) in lines.iter().zip(0..area.height) {
            let last = more && y + 1 == area.height;
            let text = if last {
                format!("{text} ...")
            } else {
                text.clone()
            };
            let room = area.width - 1;
            let line = Rect {
                width: room,
                ..area
            };
            write(
                line,
                (1, y),
                text.trim_start(),
                self.theme.style(*role),
                buf,
            );
        }
    }
}

/// `name` without the `folder` in which it is, which the frame names.
fn below<'a>(name: &'a str, folder: Option<&Path>) -> &'a str {
    let folder = folder.and_then(Path::to_str);
    let rest = folder
        .and_then(|folder| name.strip_prefix(folder))
        .map(|rest| rest.trim_start_matches('/'));
    rest.filter(|rest| !rest.is_empty()).unwrap_or(name)
}

fn described(scenario: &Scenario, width: usize) -> Vec<(String, Role)> {
    let file = &scenario.file;
    let look_at = file
        .view
        .as_ref()
        .and_then(|view| view.look_at.as_deref())
        .unwrap_or_default();
    let motion = &scenario.motion;
    let run = format!(
        "{} scheme, {} steps of {} s",
        motion.scheme.name, scenario.steps, motion.time_step_s
    );
    let paragraphs = [
        (file.title.as_str(), Role::Heading),
        (file.about.as_deref().unwrap_or_default(), Role::Text),
        (look_at, Role::Text),
        (run.as_str(), Role::Quiet),
        (file.source.as_deref().unwrap_or_default(), Role::Quiet),
    ];
    let mut lines = Vec::new();
    for (text, role) in paragraphs.into_iter().filter(|(text, _)| !text.is_empty()) {
        lines.extend(
            wrapped(&printable(&text.replace('\n', " ")), width)
                .into_iter()
                .map(|line| (line, role)),
        );
        lines.push((String::new(), Role::Text));
    }
    lines
}

fn refused(problem: &str, width: usize) -> Vec<(String, Role)> {
    let begin = ("cannot be opened".to_owned(), Role::Warning);
    let lines = problem
        .lines()
        .flat_map(|line| wrapped(line, width))
        .map(|line| (line, Role::Text));
    std::iter::once(begin).chain(lines).collect()
}
