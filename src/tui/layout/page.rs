//! The page of a lesson beside the panes.

use crate::lab::view::{Pane, View};
use ratatui::layout::Rect;

/// From this width on a page of a lesson stands beside a pane.
const BESIDE_PAGE_FROM: u16 = 72;
/// The fewest and the most columns of a page, and its share of the screen, %.
const PAGE: (u16, u16) = (38, 64);
const PAGE_SHARE: usize = 48;

/// The place of a lesson's page, and the rest of `area`, where there is a page and room for both.
pub(super) fn beside(area: Rect, view: &View) -> Option<(Rect, Rect)> {
    if view.filled || !view.may_show(Pane::LESSON) || area.width < BESIDE_PAGE_FROM {
        return None;
    }
    let share = area.width as usize * PAGE_SHARE / 100;
    let width = (share as u16).clamp(PAGE.0, PAGE.1);
    let page = Rect { width, ..area };
    let rest = Rect {
        x: page.right(),
        width: area.width - width,
        ..area
    };
    Some((page, rest))
}

/// How the panes beside a page are shown: the page is not among them, and where there is room for one, it is the one that
/// was there before the page had the focus.
pub(super) fn without(view: &View) -> View {
    let mut view = view.clone();
    view.sheet = None;
    if view.focus == Pane::LESSON {
        let beside = view.beside.filter(|pane| view.may_show(*pane));
        let first = view.to_show().first().copied();
        view.focus = beside.or(first).unwrap_or(Pane::TRACES);
    }
    view
}
