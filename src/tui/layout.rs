//! Which panes stand where, at every size of the screen.
//!
//! From 80x24 on all of them stand side by side, from 120 columns on with the 3-D view; on smaller screens there are
//! fewer, the most important first, and the hint line says so.

use crate::lab::view::{Pane, View};
use ratatui::layout::Rect;

/// From this width on all panes but 3-D stand side by side.
const ALL_FROM: u16 = 80;
/// From this width on the 3-D view stands among them.
const THREE_D_FROM: u16 = 120;
/// From this width on two panes stand side by side.
const TWO_FROM: u16 = 52;
/// From this height of the panes on, the view from above and the 3-D view stand one above the other.
const STACKED_FROM: u16 = 36;
/// From this width on a hint fits on one line.
const ONE_LINE_FROM: u16 = 140;
/// Width of the parameters.
const PARAMETERS: u16 = 26;
/// The height the whole lab wants.
const HEIGHT: u16 = 24;
/// From this height on a hint may have two lines.
const TWO_LINES_FROM: u16 = 18;

/// Where everything stands; what has no place has an empty area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The line on top.
    pub title: Rect,
    /// The panes that have a place, from left to right.
    pub panes: Vec<(Pane, Rect)>,
    /// The line about the numbers' health.
    pub health: Rect,
    /// The lines that say what to look at: one, or two where the screen is narrow.
    pub hint: Rect,
    /// The line of keys.
    pub keys: Rect,
    /// Whether the screen is too small for the whole lab.
    pub is_cramped: bool,
}

impl Layout {
    /// The layout of `area`; `keys` says whether there is a line of keys.
    pub fn new(area: Rect, view: &View, keys: bool) -> Self {
        let mut rest = area;
        let title = cut(&mut rest, area.height >= 3, false);
        let keys = cut(&mut rest, keys && area.height >= 7, true);
        let hint = cut(&mut rest, area.height >= 6, true);
        let hint = match area.height >= TWO_LINES_FROM && area.width < ONE_LINE_FROM {
            true => hint.union(cut(&mut rest, true, true)),
            false => hint,
        };
        let health = cut(&mut rest, area.height >= 9, true);
        let is_cramped = area.width < ALL_FROM || area.height < HEIGHT;
        Self {
            title,
            panes: panes(rest, view),
            health,
            hint,
            keys,
            is_cramped,
        }
    }

    /// The panes that stand side by side on `area`, with the lines of the whole lab around them, while none fills it.
    pub fn side_by_side(area: Rect, view: &View) -> Vec<Pane> {
        let unfilled = View {
            filled: false,
            ..view.clone()
        };
        let layout = Self::new(area, &unfilled, true);
        layout.panes.iter().map(|(pane, _)| *pane).collect()
    }
}

/// Takes a line off `rest`, at its bottom or its top, if it is `wanted`.
fn cut(rest: &mut Rect, wanted: bool, bottom: bool) -> Rect {
    let height = u16::from(wanted && rest.height > 0);
    rest.height -= height;
    let y = if bottom { rest.y + rest.height } else { rest.y };
    if !bottom {
        rest.y += height;
    }
    Rect { y, height, ..*rest }
}

fn panes(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    if area.is_empty() {
        return Vec::new();
    }
    if view.filled || area.width < TWO_FROM {
        return vec![(view.focus, area)];
    }
    if !Pane::ALL.into_iter().all(|pane| view.may_show(pane)) {
        return chosen(area, view);
    }
    if area.width < ALL_FROM {
        let widths = [area.width - area.width / 2, area.width / 2];
        let second = if view.focus == Pane::Traces {
            Pane::FromAbove
        } else {
            view.focus
        };
        return beside(area, &[Pane::Traces, second], &widths);
    }
    let rest = area.width - PARAMETERS;
    if area.width < THREE_D_FROM {
        let round = (rest / 2).min(2 * area.height);
        let widths = [rest - round, round, PARAMETERS];
        return beside(
            area,
            &[Pane::Traces, Pane::FromAbove, Pane::Parameters],
            &widths,
        );
    }
    if area.height < STACKED_FROM {
        let round = (rest / 3).min(2 * area.height);
        return beside(
            area,
            &Pane::ALL,
            &[rest - 2 * round, round, round, PARAMETERS],
        );
    }
    stacked(area, (rest / 2).min(area.height))
}

/// The panes that were chosen, side by side: all of them, or two where there is room for no more.
fn chosen(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let is_named = |pane: &Pane| view.shown.contains(pane);
    let has_room = |pane: &Pane| *pane != Pane::ThreeD || area.width >= THREE_D_FROM;
    let is_chosen = |pane: &Pane| view.may_show(*pane) && (is_named(pane) || has_room(pane));
    let mut panes: Vec<_> = Pane::ALL.into_iter().filter(is_chosen).collect();
    if area.width < ALL_FROM {
        let rest = panes.iter().skip(1).copied();
        let second = rest
            .clone()
            .find(|pane| *pane == view.focus)
            .or_else(|| rest.clone().next());
        panes.truncate(1);
        panes.extend(second);
    }
    let Some((_, others)) = panes.split_first() else {
        return Vec::new();
    };
    let share = area.width / panes.len() as u16;
    let round = share.min(2 * area.height);
    let width = |pane: &Pane| match pane {
        Pane::Parameters => share.min(PARAMETERS),
        Pane::Traces => share,
        Pane::FromAbove | Pane::ThreeD => round,
    };
    let mut widths: Vec<_> = others.iter().map(width).collect();
    widths.insert(0, area.width - widths.iter().sum::<u16>()); // the first has what the others leave
    beside(area, &panes, &widths)
}

fn beside(area: Rect, panes: &[Pane], widths: &[u16]) -> Vec<(Pane, Rect)> {
    let mut x = area.x;
    let place = |(&pane, &width)| {
        let place = Rect { x, width, ..area };
        x += width;
        (pane, place)
    };
    panes.iter().zip(widths).map(place).collect()
}

/// The two round panes, `round` wide, one above the other between traces and parameters.
fn stacked(area: Rect, round: u16) -> Vec<(Pane, Rect)> {
    let rest = area.width - PARAMETERS - round;
    let columns = beside(
        area,
        &[Pane::Traces, Pane::FromAbove, Pane::Parameters],
        &[rest, round, PARAMETERS],
    );
    let mut places = Vec::with_capacity(columns.len() + 1);
    for (pane, place) in columns {
        if pane != Pane::FromAbove {
            places.push((pane, place));
            continue;
        }
        let upper = place.height / 2;
        places.push((
            pane,
            Rect {
                height: upper,
                ..place
            },
        ));
        places.push((
            Pane::ThreeD,
            Rect {
                y: place.y + upper,
                height: place.height - upper,
                ..place
            },
        ));
    }
    places
}
