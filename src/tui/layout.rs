//! Which panes stand where, at every size of the screen.
//!
//! The table of panes says how wide each must be at least, and in which order they join the others: at 80x24 all but the
//! 3-D view stand side by side, from 120 columns on that too. On smaller screens there are fewer, and the hint line says
//! so.

use super::panes::{PaneRow, Width, rows};
use super::split::{split_columns, split_rows};
use crate::lab::view::{HideablePart, Pane, View};
use ratatui::layout::Rect;

/// The width the whole lab wants.
const FULL_LAB_WIDTH: u16 = 80;
/// From this width on two panes stand side by side.
const TWO_FROM: u16 = 52;
/// From this width on a hint fits on one line.
const ONE_LINE_FROM: u16 = 140;
/// The fewest columns of a pane beside one that is shown on request.
const BESIDE_ASKED: u16 = 24;
/// From this width on a page of a lesson stands beside a pane.
const BESIDE_PAGE_FROM: u16 = 72;
/// The fewest and the most columns of a page, and its share of the screen, %.
const LESSON_PAGE_COLUMNS: (u16, u16) = (38, 64);
const PAGE_SHARE: usize = 48;
/// The rows of a page above a pane whose run it plays, where they do not stand side by side.
const PAGE_ROWS: u16 = 8;
/// The height the whole lab wants.
const FULL_LAB_HEIGHT: u16 = 24;
/// From this height on a hint may have two lines.
const TWO_LINES_FROM: u16 = 18;
/// On lower screens the lines below the panes leave at least these rows to the panes, and a hint has at most this many lines.
const ROWS_OF_PANES: u16 = 6;
const MOST_STATUS_LINES: u16 = 3;

/// What the lines below the panes have to say: what there is to see, and whether the numbers are to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinesBelow {
    /// Lines of the hint on a screen of this width.
    pub lines: u16,
    pub warns: bool,
}

/// Where everything stands; what has no place has an empty area.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScreenLayout {
    pub title: Rect,
    /// The panes that have a place, from left to right.
    pub panes: Vec<(Pane, Rect)>,
    pub timeline: Rect,
    pub measured: Rect,
    pub health: Rect,
    /// The lines that say what to look at: one, or two where the screen is narrow.
    pub hint: Rect,
    pub keys: Rect,
    /// Whether the screen is too small for the whole lab.
    pub is_cramped: bool,
}

impl ScreenLayout {
    /// The layout of `area`; `keys` says whether there is a line of keys.
    pub fn new(area: Rect, view: &View, keys: bool) -> Self {
        let said = LinesBelow {
            lines: 1,
            warns: true,
        };
        Self::saying(said, area, view, keys)
    }

    /// The same, with room for what is to be said: on a low screen a hint that is too long for one line has more, and the
    /// line about the numbers' health only where that warns.
    pub fn saying(said: LinesBelow, area: Rect, view: &View, keys: bool) -> Self {
        let mut rest = area;
        let title = cut_top(&mut rest, area.height >= 3);
        if view.look.bare {
            // A message has the last line, over the panes.
            return Self {
                title,
                panes: place_panes(rest, view),
                hint: cut_bottom(&mut rest, area.height >= 6),
                ..Self::default()
            };
        }
        let keys = cut_bottom(&mut rest, keys && area.height >= 7);
        let hint = cut_bottom(&mut rest, area.height >= 6);
        let (lines, has_health) = if view.sheet.is_some() && area.height >= TWO_LINES_FROM {
            // What the lines below have not to say goes to the page.
            let most = 1 + u16::from(area.width < ONE_LINE_FROM);
            (said.lines.clamp(1, most), !view.hides(HideablePart::Health))
        } else if area.height >= TWO_LINES_FROM {
            (1 + u16::from(area.width < ONE_LINE_FROM), true)
        } else {
            on_low_screen(said, area.height, view.hides(HideablePart::Health))
        };
        let hint = (1..lines).fold(hint, |hint, _| hint.union(cut_bottom(&mut rest, true)));
        let health = cut_bottom(&mut rest, has_health);
        // The values have all the lines where they fill a screen that has no more than they need.
        let is_full = area.height == FULL_LAB_HEIGHT && view.is_filled_by(Pane::Parameters);
        let timeline = cut_bottom(&mut rest, area.height >= FULL_LAB_HEIGHT && !is_full);
        let measured = cut_bottom(&mut rest, view.measured && area.height >= 8);
        Self {
            title,
            panes: place_panes(rest, view),
            timeline,
            measured,
            health,
            hint,
            keys,
            is_cramped: area.width < FULL_LAB_WIDTH || area.height < FULL_LAB_HEIGHT,
        }
    }

    pub fn place_of(&self, pane: Pane) -> Option<Rect> {
        self.panes
            .iter()
            .find_map(|&(other, place)| (other == pane).then_some(place))
    }

    /// The panes that stand side by side on `area`, with the lines of the whole lab around them, while none fills it.
    pub fn side_by_side(area: Rect, view: &View) -> Vec<Pane> {
        let unfilled = View {
            fullscreen: false,
            ..view.clone()
        };
        let layout = Self::new(area, &unfilled, true);
        layout.panes.iter().map(|(pane, _)| *pane).collect()
    }
}

/// Lines of the hint on a screen of this `height` that is low, and whether the health of the numbers has a line.
fn on_low_screen(said: LinesBelow, height: u16, hides_health: bool) -> (u16, bool) {
    let below = height.saturating_sub(2 + ROWS_OF_PANES);
    let lines = below
        .saturating_sub(said.warns.into())
        .min(MOST_STATUS_LINES)
        .min(said.lines)
        .max(1);
    let has_health = said.warns || lines == 1;
    (lines, height >= 9 && has_health && !hides_health)
}

/// Takes the first line off `rest` if it is `wanted`.
fn cut_top(rest: &mut Rect, wanted: bool) -> Rect {
    let [line, below] = split_rows(*rest, wanted.into());
    *rest = below;
    line
}

/// Takes the last line off `rest` if it is `wanted`.
fn cut_bottom(rest: &mut Rect, wanted: bool) -> Rect {
    let [above, line] = split_rows(*rest, rest.height.saturating_sub(wanted.into()));
    *rest = above;
    line
}

fn place_panes(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    if area.is_empty() {
        return Vec::new();
    }
    if !view.fullscreen && view.may_show(Pane::Lesson) && area.width >= BESIDE_PAGE_FROM {
        let share = area.width as usize * PAGE_SHARE / 100;
        let [page, rest] = split_columns(
            area,
            (share as u16).clamp(LESSON_PAGE_COLUMNS.0, LESSON_PAGE_COLUMNS.1),
        );
        let mut panes = place_panes(rest, &beside_page(view));
        panes.insert(0, (Pane::Lesson, page));
        return panes;
    }
    if !view.fullscreen && view.may_show(Pane::Lesson) && view.focus == Pane::Lesson {
        let plays = view.sheet.as_ref().is_some_and(|sheet| sheet.plays);
        if !plays || area.height < 2 * PAGE_ROWS {
            return vec![(Pane::Lesson, area)];
        }
        let [page, rest] = split_rows(area, PAGE_ROWS);
        let mut companions = beside_page(view);
        companions.fullscreen = true;
        let mut panes = place_panes(rest, &companions);
        panes.insert(0, (Pane::Lesson, page));
        return panes;
    }
    let joined = panes_with_room(area.width);
    if view.fullscreen || area.width < TWO_FROM {
        vec![(view.focus, area)]
    } else if let Some(asked) = asked(view) {
        with_asked(asked, area, view)
    } else if !usual().all(|row| view.may_show(row.id)) {
        chosen(area, view)
    } else if joined.len() > 2 {
        columns(area, &joined)
    } else {
        halves(area, view.focus)
    }
}

/// The view of the panes beside a lesson's page. If there is room for only one, it is the one that was there before the
/// page had the focus.
fn beside_page(view: &View) -> View {
    let mut without = View {
        sheet: None,
        ..view.clone()
    };
    if without.focus == Pane::Lesson {
        let companion = without
            .companion_pane
            .filter(|pane| without.may_show(*pane));
        let first = without.to_show().first().copied();
        without.focus = companion.or(first).unwrap_or(Pane::Traces);
    }
    without
}

/// The panes that are shown without being asked for, but for the page of a lesson.
fn usual() -> impl Iterator<Item = &'static PaneRow> {
    rows().filter(|row| row.id != Pane::Lesson && !row.id.is_on_request())
}

/// The pane that was asked for; of several the one in focus, or else the first.
fn asked(view: &View) -> Option<&'static PaneRow> {
    rows()
        .filter(|row| row.id.is_on_request() && view.may_show(row.id))
        .min_by_key(|row| row.id != view.focus)
}

/// The panes that have room beside each other on `width` columns, in the table's order: by their ranks, up to the first
/// that has none.
fn panes_with_room(width: u16) -> Vec<&'static PaneRow> {
    usual()
        .filter(|row| {
            let before = usual().filter(|other| other.rank <= row.rank);
            before.map(|other| other.least.0).sum::<u16>() <= width
        })
        .collect()
}

/// The pane of the first rank, and beside it the pane in focus, or else the pane of the second rank.
fn halves(area: Rect, focus: Pane) -> Vec<(Pane, Rect)> {
    let first = rows().find(|row| row.rank == 0);
    let second = rows().find(|row| row.rank == 1);
    let (Some(first), Some(second)) = (first, second) else {
        return vec![(focus, area)];
    };
    let second = if focus == first.id { second.id } else { focus };
    let [left, right] = split_columns(area, area.width - area.width / 2);
    vec![(first.id, left), (second, right)]
}

/// The panes that were chosen, side by side: all of them, or two where there is room for no more.
fn chosen(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    // The panes that would stand side by side if all were shown, on at least the width that the whole lab wants.
    let joined = panes_with_room(area.width.max(FULL_LAB_WIDTH));
    let mut panes: Vec<_> = usual()
        .filter(|row| {
            view.may_show(row.id)
                && (view.look.show.contains(&row.id)
                    || joined.iter().any(|other| other.id == row.id))
        })
        .collect();
    if panes.is_empty() {
        return Vec::new();
    }
    if area.width < FULL_LAB_WIDTH {
        panes[1..].sort_by_key(|row| row.id != view.focus);
        panes.truncate(2);
    }
    let share = area.width / panes.len() as u16;
    side_by_side(area, &panes, share, 0)
}

/// The pane `asked` at the right, as wide as its numbers are, and beside it as many of the other panes that were chosen as
/// have room; where none has, the one in focus.
fn with_asked(asked: &'static PaneRow, area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let mut panes: Vec<_> = rows()
        .filter(|row| ![Pane::Lesson, asked.id].contains(&row.id) && view.may_show(row.id))
        .collect();
    let least = asked.least.0;
    let room = area.width.saturating_sub(least) / BESIDE_ASKED;
    if room == 0 && view.focus != asked.id {
        return vec![(view.focus, area)];
    }
    panes.sort_by_key(|row| row.id != view.focus);
    panes.truncate(room.into());
    panes.sort_by_key(|row| row.id as usize);
    panes.push(asked);
    let count = panes.len() as u16;
    let share = (area.width / count).max(least.min(area.width));
    let each = (area.width - share) / (count - 1).max(1);
    side_by_side(area, &panes, each, panes.len() - 1)
}

/// `panes` side by side, each on at most `share` columns; the pane at the index `rest` has what the others leave.
fn side_by_side(area: Rect, panes: &[&PaneRow], share: u16, rest: usize) -> Vec<(Pane, Rect)> {
    let mut widths: Vec<_> = panes
        .iter()
        .map(|row| match row.width {
            Width::Fixed => share.min(row.least.0),
            Width::Wide => share,
            Width::Round => share.min(2 * area.height),
        })
        .collect();
    widths[rest] = 0;
    widths[rest] = area.width - widths.iter().sum::<u16>();
    let mut right = area;
    panes
        .iter()
        .zip(widths)
        .map(|(row, width)| {
            let [place, others] = split_columns(right, width);
            right = others;
            (row.id, place)
        })
        .collect()
}

/// All of `rows` side by side. Where the screen is high enough, two round ones stand one above the other.
fn columns(area: Rect, rows: &[&PaneRow]) -> Vec<(Pane, Rect)> {
    let (mut rounds, mut wides, mut fixed_columns, mut round_rows) = (0, 0, 0, 0);
    for row in rows {
        match row.width {
            Width::Round => (rounds, round_rows) = (rounds + 1, round_rows + row.least.1),
            Width::Wide => wides += 1,
            Width::Fixed => fixed_columns += row.least.0,
        }
    }
    let rest = area.width - fixed_columns;
    let is_stacked = rounds == 2 && area.height >= round_rows;
    let (round_columns, widest) = if is_stacked {
        (1, area.height * 5 / 4)
    } else {
        (rounds, 2 * area.height)
    };
    let round = (rest / (round_columns + wides).max(1)).min(widest);
    let wide = (rest - round * round_columns) / wides.max(1);
    let mut right = area;
    let mut below = None;
    let mut places = Vec::with_capacity(rows.len());
    for row in rows {
        let is_round = row.width == Width::Round;
        if let Some(place) = below.take_if(|_| is_round) {
            places.push((row.id, place));
            continue;
        }
        let width = match row.width {
            Width::Wide => wide,
            Width::Round => round,
            Width::Fixed => row.least.0,
        };
        let [column, others] = split_columns(right, width);
        right = others;
        if is_round && is_stacked {
            let [upper, lower] = split_rows(column, column.height / 2);
            below = Some(lower);
            places.push((row.id, upper));
        } else {
            places.push((row.id, column));
        }
    }
    places
}
