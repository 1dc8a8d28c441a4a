//! The whole picture: every pane in its place, and on top what has been opened; drawn on a terminal, as text, or as the
//! bytes that a terminal would be sent.

use super::panes::{
    self, browser, chrome, form::FormPane, help, hint, lesson, measured, overview, traces,
};
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::action::Direction;
use crate::lab::view::theme::{Marker, Theme};
use crate::lab::view::{HideablePart, Pane};
use crate::tui::dots;
use crate::tui::keymap::Mode;
use crate::tui::layout::ScreenLayout;
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use crossterm::style;
use ratatui::backend::{Backend, ClearType, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;
use std::{io, mem};

/// Fits `lab` to a screen of this size; all of it is to be drawn again.
pub fn fit(lab: &mut Lab, size: Rect) {
    let panes = ScreenLayout::side_by_side(size, lab.view());
    lab.view_mut().set_side_by_side(panes);
    let swings = swings(lab, size);
    lab.show_swings(swings);
}

/// Fits `lab` to a screen of this size again where other panes are shown than before.
pub fn refit(lab: &mut Lab, size: Rect) {
    let panes = ScreenLayout::side_by_side(size, lab.view());
    if panes != lab.view().side_by_side || swings(lab, size) != lab.view().swings {
        fit(lab, size);
    }
}

/// Returns how many swings the traces have room for on a screen of this size.
fn swings(lab: &Lab, size: Rect) -> usize {
    let place = layout(lab, true, size).place_of(Pane::Traces);
    place.map_or(lab.view().swings, |place| {
        traces::swings(place.width, lab.view().marker)
    })
}

/// Scrolls the page of the lesson, on a screen of this size.
pub fn scroll_page(lab: &mut Lab, direction: Direction, size: Rect) {
    if let Some(place) = layout(lab, true, size).place_of(Pane::Lesson) {
        lesson::scroll(lab, direction, place);
    }
}

/// Whether the page of the lesson goes on below what a screen of this size shows of it.
pub fn page_goes_on(lab: &Lab, size: Rect) -> bool {
    chrome::page_goes_on(lab, &layout(lab, true, size))
}

/// Where everything of `lab` stands on `area`; `keys` says whether there is a line of keys.
pub fn layout(lab: &Lab, keys: bool, area: Rect) -> ScreenLayout {
    let note_rows = hint::lines_of_note(lab, area.width);
    ScreenLayout::new(area, lab.view(), note_rows, keys)
}

/// Draws `lab` on `area`; `keys` says whether with the line of keys.
pub fn draw(lab: &Lab, keys: bool, area: Rect, buf: &mut Buffer) {
    let places = layout(lab, keys, area);
    for &(pane, place) in &places.panes {
        draw_pane(lab, pane, place, buf);
        if matches!(pane, Pane::Traces | Pane::Above) {
            color_blanks(place, &lab.view().theme, buf);
        }
        if lab.view().pointed_at == Some(pane) {
            point_at(lab, place, buf);
        }
    }
    chrome::header(lab, places.header, buf);
    overview::draw(lab, places.overview, buf);
    measured::draw(lab, places.measured, buf);
    let place = hint::place(lab, &places);
    let share_a_row = places.note == places.verdict;
    let has_message = hint::has_message(lab);
    let is_covered = place != places.note || share_a_row && has_message;
    let has_verdict = !lab.view().hides(HideablePart::Health) || lab.view().asked().is_some();
    if has_verdict && !is_covered {
        chrome::verdict(lab, places.verdict, buf);
    }
    if has_message || !lab.view().look.bare && !share_a_row {
        hint::draw(lab, keys && places.is_cramped, place, buf);
    }
    chrome::keys(lab, &places, buf);
    draw_popup(lab, &places, buf);
    match lab.view().marker {
        Marker::Ascii => to_ascii(area, buf),
        Marker::HalfBlock => to_console(area, buf),
        Marker::Braille | Marker::Octant | Marker::Dot => {}
    }
}

/// Gives blank cells the color of the run, which nobody sees: without it a slow line carries two changes of color for each
/// cell of a curve that moves.
fn color_blanks(area: Rect, theme: &Theme, buf: &mut Buffer) {
    let color = theme.style(Role::Run).fg.unwrap_or_default();
    for position in area.positions() {
        let cell = buf.cell_mut(position);
        if let Some(cell) = cell.filter(|cell| cell.symbol() == " " && cell.modifier.is_empty()) {
            cell.fg = color;
        }
    }
}

fn point_at(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let style = lab.view().theme.style(Role::Push);
    for position in split_rows(area, 1)[0].positions() {
        let cell = buf.cell_mut(position);
        if let Some(cell) = cell.filter(|cell| cell.symbol() == "─") {
            cell.set_symbol("━").set_style(style);
        }
    }
}

pub fn draw_pane(lab: &Lab, pane: Pane, area: Rect, buf: &mut Buffer) {
    (panes::row(pane).draw)(lab, area, buf);
}

fn draw_popup(lab: &Lab, places: &ScreenLayout, buf: &mut Buffer) {
    let area = popup_place(lab, places);
    let theme = &lab.view().theme;
    match lab.popups().mode {
        Mode::Lab | Mode::Lessons | Mode::Find => {}
        Mode::Dialog => {
            let on_screen = places.place_of(Pane::Parameters).is_some();
            // A value is typed in its row of the values pane.
            let dialog = lab.popups().dialog();
            if let Some(dialog) = dialog.filter(|dialog| !(dialog.is_of_value() && on_screen)) {
                let form = &dialog.form;
                FormPane { form, theme }.render(area, buf);
            }
        }
        Mode::Browser => browser::draw(lab, area, buf),
        Mode::Help => help::draw(lab, area, buf),
    }
}

/// The area of a popup: the panes and the overview, without the rows that a message takes. A dialog leaves the page of a
/// lesson in view, and the overview.
pub(super) fn popup_place(lab: &Lab, layout: &ScreenLayout) -> Rect {
    let is_dialog = lab.popups().mode == Mode::Dialog;
    let is_alone = layout.panes.len() == 1;
    let panes = layout
        .panes
        .iter()
        .filter(|(pane, _)| !is_dialog || is_alone || *pane != Pane::Lesson)
        .map(|(_, area)| *area);
    let covered = panes.reduce(Rect::union).unwrap_or_default();
    let body = if is_dialog || layout.overview.is_empty() {
        covered
    } else {
        covered.union(layout.overview)
    };
    let message = hint::place(lab, layout);
    if message.is_empty() {
        body
    } else {
        split_rows(body, message.y.saturating_sub(body.y))[0]
    }
}

/// Nothing that the fonts of the Linux console lack.
fn to_console(area: Rect, buf: &mut Buffer) {
    for position in area.positions() {
        if let Some(cell) = buf.cell_mut(position)
            && let Some(symbol) = dots::on_console(cell.symbol())
        {
            cell.set_symbol(symbol);
        }
    }
}

/// Nothing but ASCII, whatever a scenario's title holds.
pub(super) fn to_ascii(area: Rect, buf: &mut Buffer) {
    for position in area.positions() {
        let cell = buf.cell_mut(position);
        if let Some(cell) = cell.filter(|cell| !cell.symbol().is_ascii()) {
            let ascii = dots::ascii(cell.symbol());
            cell.set_symbol(ascii);
        }
    }
}

/// The picture of `lab` on a screen of this width and height as plain text, a line each, without blanks at their ends.
pub fn text(lab: &Lab, keys: bool, (width, height): (u16, u16)) -> String {
    let area = Rect::new(0, 0, width, height);
    let mut buf = Buffer::empty(area);
    draw(lab, keys, area, &mut buf);
    (area.top()..area.bottom())
        .map(|y| line_of(&buf, y))
        .collect()
}

/// The text in the line `y` of `buf`, without blanks at its end.
fn line_of(buf: &Buffer, y: u16) -> String {
    let (mut line, mut x) = (String::new(), buf.area.left());
    while let Some(cell) = buf.cell((x, y)).filter(|_| x < buf.area.right()) {
        line += cell.symbol();
        // The cell behind a wide character is a part of it.
        x += columns(cell.symbol()).max(1) as u16;
    }
    line.trim_end().to_owned() + "\n"
}

/// The lab drawn without a terminal, as the bytes that a terminal would be sent.
pub struct ScreenRecorder {
    sent: Vec<u8>,
    shown: Buffer,
}

impl ScreenRecorder {
    /// A terminal of so many columns and lines, and what clears it and hides its cursor. `lab` is fitted to it.
    pub fn new(lab: &mut Lab, (columns, lines): (u16, u16)) -> io::Result<Self> {
        // The recording is the same whatever NO_COLOR says.
        style::force_color_output(true);
        let area = Rect::new(0, 0, columns, lines);
        let mut sent = Vec::new();
        let mut backend = CrosstermBackend::new(&mut sent);
        backend.clear_region(ClearType::All)?;
        backend.hide_cursor()?;
        fit(lab, area);
        let shown = Buffer::empty(area);
        Ok(Self { sent, shown })
    }

    /// Draws `lab` if its picture has changed, and gives what the terminal is sent for that: only what differs.
    pub fn draw(&mut self, lab: &mut Lab) -> io::Result<String> {
        let area = self.shown.area;
        if lab.has_changed() {
            refit(lab, area);
        }
        if lab.take_changed() {
            let mut next = Buffer::empty(area);
            draw(lab, true, area, &mut next);
            let mut backend = CrosstermBackend::new(&mut self.sent);
            backend.draw(self.shown.diff(&next).into_iter())?;
            self.shown = next;
        }
        let sent = mem::take(&mut self.sent);
        Ok(String::from_utf8_lossy(&sent).into_owned())
    }
}
