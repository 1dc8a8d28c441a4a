//! The whole screen: every pane in its place, with the open popup on top. It is drawn on a terminal, as text, or as the
//! bytes that a terminal would receive.

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

/// Fits `lab` to a screen of this size and requests a full redraw.
pub fn fit(lab: &mut Lab, size: Rect) {
    let panes = ScreenLayout::side_by_side(size, lab.view());
    lab.view_mut().set_side_by_side(panes);
    let swings = swings(lab, size);
    lab.show_swings(swings);
}

/// Fits `lab` to a screen of this size again, if other panes are shown than before.
pub fn refit(lab: &mut Lab, size: Rect) {
    let panes = ScreenLayout::side_by_side(size, lab.view());
    if panes != lab.view().side_by_side || swings(lab, size) != lab.view().swings {
        fit(lab, size);
    }
}

/// Returns the number of swings for which the traces have room on a screen of this size.
fn swings(lab: &Lab, size: Rect) -> usize {
    let place = layout(lab, true, size).place_of(Pane::Traces);
    place.map_or(lab.view().swings, |place| {
        traces::swings(place.width, lab.view().marker)
    })
}

/// Scrolls the lesson's page on a screen of this size.
pub fn scroll_page(lab: &mut Lab, direction: Direction, size: Rect) {
    if let Some(place) = layout(lab, true, size).place_of(Pane::Lesson) {
        lesson::scroll(lab, direction, place);
    }
}

/// Returns true if the lesson's page continues below the visible rows of a screen of this size.
pub fn page_goes_on(lab: &Lab, size: Rect) -> bool {
    chrome::page_goes_on(lab, &layout(lab, true, size))
}

/// Returns the layout of `lab` on `area`, with a row of keys if `keys` is true.
pub fn layout(lab: &Lab, keys: bool, area: Rect) -> ScreenLayout {
    let note_rows = hint::lines_of_note(lab, area.width);
    ScreenLayout::new(area, lab.view(), note_rows, keys)
}

/// Draws `lab` on `area`, with a row of keys if `keys` is true.
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

/// Gives blank cells the invisible color of the run.
///
/// Without it, a slow line carries two changes of color for each cell of a moving curve.
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
            // A value is edited in its row of the values pane.
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

/// Returns the area of a popup: the panes and the overview, without the rows of a message. A dialog keeps a lesson's
/// page and the overview visible.
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

/// Replaces characters that the fonts of the Linux console lack.
fn to_console(area: Rect, buf: &mut Buffer) {
    for position in area.positions() {
        if let Some(cell) = buf.cell_mut(position)
            && let Some(symbol) = dots::on_console(cell.symbol())
        {
            cell.set_symbol(symbol);
        }
    }
}

/// Replaces every character that is not ASCII, including those of a scenario's title.
pub(super) fn to_ascii(area: Rect, buf: &mut Buffer) {
    for position in area.positions() {
        let cell = buf.cell_mut(position);
        if let Some(cell) = cell.filter(|cell| !cell.symbol().is_ascii()) {
            let ascii = dots::ascii(cell.symbol());
            cell.set_symbol(ascii);
        }
    }
}

/// Returns the picture of `lab` on a screen of this width and height as plain text, without blanks at the ends of
/// lines.
pub fn text(lab: &Lab, keys: bool, (width, height): (u16, u16)) -> String {
    let area = Rect::new(0, 0, width, height);
    let mut buf = Buffer::empty(area);
    draw(lab, keys, area, &mut buf);
    (area.top()..area.bottom())
        .map(|y| line_of(&buf, y))
        .collect()
}

/// Returns the text of line `y` of `buf`, without blanks at its end.
fn line_of(buf: &Buffer, y: u16) -> String {
    let (mut line, mut x) = (String::new(), buf.area.left());
    while let Some(cell) = buf.cell((x, y)).filter(|_| x < buf.area.right()) {
        line += cell.symbol();
        // The cell after a wide character belongs to that character.
        x += columns(cell.symbol()).max(1) as u16;
    }
    line.trim_end().to_owned() + "\n"
}

/// Draws the lab without a terminal, as the bytes that a terminal would receive.
pub struct ScreenRecorder {
    sent: Vec<u8>,
    shown: Buffer,
}

impl ScreenRecorder {
    /// Creates a recorder for a terminal of this size and fits `lab` to it. Its first bytes clear the terminal and hide
    /// the cursor.
    ///
    /// # Errors
    ///
    /// Returns an error if the bytes cannot be written.
    pub fn new(lab: &mut Lab, (columns, lines): (u16, u16)) -> io::Result<Self> {
        // NO_COLOR does not change the recording.
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

    /// Draws `lab` if its picture has changed. Returns the bytes for the terminal: only the cells that differ.
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
