//! Which panes stand where, at every size of the screen.
//!
//! The table of panes says how wide each must be at least, and in which order they join the others: at 80x24 all but the
//! 3-D view stand side by side, from 120 columns on that too. On smaller screens there are fewer, and the hint line says
//! so.

mod below;
mod page;

use super::panes::{PANES, PaneRow, Width};
use crate::lab::view::{Pane, Part, View};
pub use below::Said;
use ratatui::layout::Rect;

/// The width the whole lab wants.
const WIDTH: u16 = 80;
/// From this width on two panes stand side by side.
const TWO_FROM: u16 = 52;
/// From this width on a hint fits on one line.
const ONE_LINE_FROM: u16 = 140;
/// The fewest columns of a pane beside the step pane.
const BESIDE_STEP: u16 = 24;
/// The height the whole lab wants.
const HEIGHT: u16 = 24;
/// From this height on a hint may have two lines.
const TWO_LINES_FROM: u16 = 18;

/// Where everything stands; what has no place has an empty area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub title: Rect,
    /// The panes that have a place, from left to right.
    pub panes: Vec<(Pane, Rect)>,
    /// The line of the whole run.
    pub timeline: Rect,
    pub measured: Rect,
    /// The line about the numbers' health.
    pub health: Rect,
    /// The lines that say what to look at: one, or two where the screen is narrow.
    pub hint: Rect,
    pub keys: Rect,
    /// Whether the screen is too small for the whole lab.
    pub is_cramped: bool,
}

impl Layout {
    /// The layout of `area`; `keys` says whether there is a line of keys.
    pub fn new(area: Rect, view: &View, keys: bool) -> Self {
        let said = Said {
            lines: 1,
            warns: true,
        };
        Self::saying(said, area, view, keys)
    }

    /// The same, with room for what is to be said: on a low screen a hint that is too long for one line has more, and the
    /// line about the numbers' health only where that warns.
    pub fn saying(said: Said, area: Rect, view: &View, keys: bool) -> Self {
        if view.bare {
            return Self::bare(area, view);
        }
        let mut rest = area;
        let title = cut(&mut rest, area.height >= 3, false);
        let keys = cut(&mut rest, keys && area.height >= 7, true);
        let hint = cut(&mut rest, area.height >= 6, true);
        let (lines, has_health) = if area.height >= TWO_LINES_FROM {
            (1 + u16::from(area.width < ONE_LINE_FROM), true)
        } else {
            below::on_low_screen(said, area.height, view.hides(Part::Health))
        };
        let hint = (1..lines).fold(hint, |hint, _| hint.union(cut(&mut rest, true, true)));
        let health = cut(&mut rest, has_health, true);
        // The values have all the lines where they fill a screen that has no more than they need.
        let is_full = area.height == HEIGHT && view.is_filled_by(Pane::PARAMETERS);
        let timeline = cut(&mut rest, area.height >= HEIGHT && !is_full, true);
        let measured = cut(&mut rest, view.measured && area.height >= 8, true);
        let is_cramped = area.width < WIDTH || area.height < HEIGHT;
        Self {
            title,
            panes: panes(rest, view),
            timeline,
            measured,
            health,
            hint,
            keys,
            is_cramped,
        }
    }

    /// The layout of a bare screen: the title and the panes. A message has the last line, over the panes.
    fn bare(area: Rect, view: &View) -> Self {
        let mut rest = area;
        let title = cut(&mut rest, area.height >= 3, false);
        let hint = cut(&mut rest.clone(), area.height >= 6, true);
        let none = Rect { height: 0, ..hint };
        Self {
            title,
            panes: panes(rest, view),
            timeline: none,
            measured: none,
            health: none,
            hint,
            keys: none,
            is_cramped: false,
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
    if let Some((page, rest)) = page::beside(area, view) {
        let mut panes = panes(rest, &page::without(view));
        panes.insert(0, (Pane::LESSON, page));
        return panes;
    }
    let joined = joined(area.width);
    if view.filled || area.width < TWO_FROM {
        vec![(view.focus, area)]
    } else if view.may_show(Pane::STEP) {
        with_step(area, view)
    } else if !usual().all(|row| view.may_show(row.id)) {
        chosen(area, view)
    } else if joined.len() > 2 {
        columns(area, &joined)
    } else {
        halves(area, view.focus)
    }
}

/// The panes that are shown without being asked for: all but the page of a lesson and the step pane.
fn usual() -> impl Iterator<Item = &'static PaneRow> {
    let extra = [Pane::LESSON, Pane::STEP];
    PANES.iter().filter(move |row| !extra.contains(&row.id))
}

/// The panes that have room beside each other on `width` columns, in the table's order: by their ranks, up to the first
/// that has none.
fn joined(width: u16) -> Vec<&'static PaneRow> {
    let mut ranked: Vec<_> = usual().collect();
    ranked.sort_by_key(|row| row.rank);
    let mut taken = 0;
    let has_room = |row: &&PaneRow| {
        taken += row.least.0;
        taken <= width
    };
    let last = ranked.iter().copied().take_while(has_room).count();
    let is_joined = |row: &&PaneRow| ranked[..last].iter().any(|other| other.id == row.id);
    usual().filter(is_joined).collect()
}

/// The pane of the first rank, and beside it the one in focus or else that of the second rank.
fn halves(area: Rect, focus: Pane) -> Vec<(Pane, Rect)> {
    let ranked = |rank| PANES.iter().find(|row| row.rank == rank);
    let (Some(first), Some(second)) = (ranked(0), ranked(1)) else {
        return vec![(focus, area)];
    };
    let second = if focus == first.id { second.id } else { focus };
    let left = Rect {
        width: area.width - area.width / 2,
        ..area
    };
    let right = Rect {
        x: left.right(),
        width: area.width / 2,
        ..area
    };
    vec![(first.id, left), (second, right)]
}

/// The panes that were chosen, side by side: all of them, or two where there is room for no more.
fn chosen(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    // What stands side by side with all others on a screen of the least width that the whole lab wants.
    let joined = joined(area.width.max(WIDTH));
    let is_named = |row: &&PaneRow| view.shown.contains(&row.id);
    let has_room = |row: &&PaneRow| joined.iter().any(|other| other.id == row.id);
    let is_chosen = |row: &&PaneRow| view.may_show(row.id) && (is_named(row) || has_room(row));
    let mut panes: Vec<_> = usual().filter(is_chosen).collect();
    if area.width < WIDTH {
        let rest = panes.iter().skip(1).copied();
        let second = rest
            .clone()
            .find(|row| row.id == view.focus)
            .or_else(|| rest.clone().next());
        panes.truncate(1);
        panes.extend(second);
    }
    let Some((_, others)) = panes.split_first() else {
        return Vec::new();
    };
    let share = area.width / panes.len() as u16;
    let round = share.min(2 * area.height);
    let width = |row: &&PaneRow| match row.width {
        Width::Fixed => share.min(row.least.0),
        Width::Wide => share,
        Width::Round => round,
    };
    let mut widths: Vec<_> = others.iter().map(width).collect();
    widths.insert(0, area.width - widths.iter().sum::<u16>()); // the first has what the others leave
    beside(area, &panes, &widths)
}

/// The step pane at the right, as wide as its numbers are, and beside it as many of the other panes that were chosen as
/// have room; where none has, the one in focus.
fn with_step(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let rows = || {
        let rows = PANES.iter().filter(|row| row.id != Pane::LESSON);
        rows.filter(|row| view.may_show(row.id))
    };
    let Some(step) = rows().find(|row| row.id == Pane::STEP) else {
        return Vec::new();
    };
    let room = area.width.saturating_sub(step.least.0) / BESIDE_STEP;
    let mut others: Vec<_> = rows().filter(|row| row.id != Pane::STEP).collect();
    if room == 0 && view.focus != Pane::STEP {
        return vec![(view.focus, area)];
    }
    others.sort_by_key(|row| row.id != view.focus);
    others.truncate(room.into());
    let is_kept = |row: &&PaneRow| others.iter().any(|other| other.id == row.id);
    let panes: Vec<_> = rows()
        .filter(|row| row.id == Pane::STEP || is_kept(row))
        .collect();
    let count = panes.len() as u16;
    let share = (area.width / count).max(step.least.0.min(area.width));
    let each = (area.width - share) / (count - 1).max(1);
    let width = |row: &&PaneRow| match row.width {
        _ if row.id == Pane::STEP => 0,
        Width::Fixed => each.min(row.least.0),
        Width::Wide => each,
        Width::Round => each.min(2 * area.height),
    };
    let mut widths: Vec<_> = panes.iter().map(width).collect();
    let left = area.width - widths.iter().sum::<u16>(); // the step pane, the last, has what the others leave
    if let Some(last) = widths.last_mut() {
        *last = left;
    }
    beside(area, &panes, &widths)
}

fn beside(area: Rect, panes: &[&PaneRow], widths: &[u16]) -> Vec<(Pane, Rect)> {
    let mut x = area.x;
    let place = |(row, &width): (&&PaneRow, &u16)| {
        let place = Rect { x, width, ..area };
        x += width;
        (row.id, place)
    };
    panes.iter().zip(widths).map(place).collect()
}

/// All of `rows` side by side. Where the screen is high enough, the round ones stand in pairs, one above the other.
fn columns(area: Rect, rows: &[&PaneRow]) -> Vec<(Pane, Rect)> {
    let of = |width| rows.iter().filter(move |row| row.width == width);
    let fixed: u16 = of(Width::Fixed).map(|row| row.least.0).sum();
    let rest = area.width - fixed;
    let rounds = of(Width::Round).count() as u16;
    let pair: u16 = of(Width::Round).take(2).map(|row| row.least.1).sum();
    let is_stacked = rounds > 1 && area.height >= pair;
    let (in_a_column, widest) = if is_stacked {
        (2, area.height * 5 / 4)
    } else {
        (1, 2 * area.height)
    };
    let round_columns = rounds.div_ceil(in_a_column);
    let wides = of(Width::Wide).count() as u16;
    let round = (rest / (round_columns + wides).max(1)).min(widest);
    let wide = (rest - round * round_columns) / wides.max(1);
    let mut x = area.x;
    let mut rounds_before = 0;
    let mut places = Vec::with_capacity(rows.len());
    for row in rows {
        let width = match row.width {
            Width::Wide => wide,
            Width::Round => round,
            Width::Fixed => row.least.0,
        };
        let column = Rect { x, width, ..area };
        if row.width != Width::Round {
            places.push((row.id, column));
            x += width;
            continue;
        }
        rounds_before += 1;
        let is_upper = is_stacked && rounds_before % 2 == 1 && rounds_before < rounds;
        let is_lower = is_stacked && rounds_before % 2 == 0;
        let upper = column.height / 2;
        places.push((
            row.id,
            match (is_upper, is_lower) {
                (true, _) => Rect {
                    height: upper,
                    ..column
                },
                (_, true) => Rect {
                    y: column.y + upper,
                    height: column.height - upper,
                    ..column
                },
                _ => column,
            },
        ));
        x += if is_upper { 0 } else { width };
    }
    places
}
