//! Layout of the screen at every size.
//!
//! There are three arrangements. Narrow screens (80x24) have three columns: the traces, a view of the path, and the
//! values. If the panes have 27 rows or more, the path is shown from above and, below that, in 3-D. Large screens
//! (160x44 or more) have the values in a band below both views. A blank column separates the panes, and the overview of
//! the whole run is below them. Smaller screens show fewer parts. The verdict and the keys are dropped last.

use super::split::{split_columns, split_rows};
use crate::lab::view::{HideablePart, Pane, View};
use ratatui::layout::Rect;

/// Minimum size of the whole lab, columns and rows. Smaller screens omit parts.
pub const FULL_LAB: (u16, u16) = (80, 24);
/// Minimum size at which the values are a band below the views of the path.
const LARGE_LAB: (u16, u16) = (160, 44);
/// Minimum width for two panes side by side, columns.
const TWO_FROM: u16 = 48;
/// Minimum height for a scrub line, rows.
const SCRUB_FROM: u16 = 14;
/// Minimum height for a note with rows of its own.
const NOTE_FROM: u16 = 12;
/// Rows of the overview (a rule, the curve and a ruler), each with the minimum height of the screen: (height, rows).
const OVERVIEW_ROWS: [(u16, u16); 3] = [(44, 6), (36, 5), (24, 4)];
/// Widths below which the note has up to three rows (first) and up to two rows (second).
pub const NOTE_COLUMNS: (u16, u16) = (60, 120);

/// Minimum and maximum columns of the traces.
const TRACES_COLUMNS: (u16, u16) = (28, 96);
/// Share of the screen for the traces at 80 and at 120 columns, per mille.
const TRACES_SHARE: (u32, u32) = (350, 420);
/// Columns of the values: on narrow screens, and on screens of at least [`WIDE_VALUES_FROM`] columns.
const VALUES_COLUMNS: (u16, u16) = (24, 30);
const WIDE_VALUES_FROM: u16 = 110;
/// Rows of the values below the views of the path.
const VALUES_ROWS: u16 = 13;
/// Minimum columns of a view of the path next to another one.
const VIEW_COLUMNS: u16 = 26;
/// Minimum rows of two views, one above the other.
const STACKED_FROM: u16 = 27;
/// Minimum columns of a view of the path if the user chose both.
const CHOSEN_VIEW_COLUMNS: u16 = 20;

/// Minimum and maximum columns of a lesson's page.
const PAGE_COLUMNS: (u16, u16) = (37, 64);
/// Share of the screen for the page, percent.
const PAGE_SHARE: u32 = 39;
/// Minimum width of the screen for a page next to the run, columns.
const BESIDE_PAGE_FROM: u16 = 72;
/// Rows of a page above the run that it plays, on narrower screens.
const PAGE_ROWS: u16 = 8;
/// Minimum and maximum columns of the step pane.
const STEP_COLUMNS: (u16, u16) = (44, 84);
/// Share of the screen for the step pane, percent.
const STEP_SHARE: u32 = 62;
/// Minimum width of the screen for the run next to the step pane, columns.
const BESIDE_STEP_FROM: u16 = 100;
/// Minimum columns of the panes next to a page or to the step pane.
const COMPANION_COLUMNS: u16 = 24;
/// Minimum columns for two such panes, one above the other; their minimum rows follow.
const COMPANION_OF_TWO: u16 = 36;
const COMPANION_ROWS: u16 = 16;

/// Areas of a screen. A part that is not shown has an empty area.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScreenLayout {
    /// Title, time step, time and speed: one row.
    pub header: Rect,
    /// Visible panes, in the order in which Tab visits them.
    pub panes: Vec<(Pane, Rect)>,
    /// Overview of the whole run: a rule, its curve and a ruler; or one row, the scrub line.
    pub overview: Rect,
    pub measured: Rect,
    /// Reliability of the run: one row.
    pub verdict: Rect,
    /// Note on what to look at: one to three rows. On low screens it is the row of the verdict, and shows only
    /// messages.
    pub note: Rect,
    pub keys: Rect,
    /// True if the screen is too small for the whole lab.
    pub is_cramped: bool,
}

impl ScreenLayout {
    /// Returns the layout of `area` with a note that needs `note_rows`. There is a row of keys if `keys` is true.
    pub fn new(area: Rect, view: &View, note_rows: u16, keys: bool) -> Self {
        let mut rest = area;
        if view.sheet.as_ref().is_some_and(|sheet| sheet.is_alone) {
            return Self::of_sheet_alone(rest, keys);
        }
        let header = cut_top(&mut rest, u16::from(area.height >= 3));
        if view.look.bare {
            // A message is shown in the last row, over the panes.
            return Self {
                header,
                panes: place_panes(rest, area.height, view),
                note: cut_bottom(&mut rest, u16::from(area.height >= 6)),
                ..Self::default()
            };
        }
        let keys = cut_bottom(&mut rest, u16::from(keys && area.height >= 6));
        let most_note_rows = match area.width {
            width if width < NOTE_COLUMNS.0 => 3,
            width if width < NOTE_COLUMNS.1 => 2,
            _ => 1,
        };
        let note_rows = if area.height < NOTE_FROM {
            0
        } else {
            note_rows.clamp(1, most_note_rows)
        };
        let note = cut_bottom(&mut rest, note_rows);
        // While a question is open, the row of the verdict names the keys that answer it.
        let is_free = view.hides(HideablePart::Health) && view.asked().is_none() && note_rows > 0;
        let has_verdict = area.height >= 5 && !is_free;
        let verdict = cut_bottom(&mut rest, has_verdict.into());
        let overview = cut_bottom(&mut rest, overview_rows(area.height, view));
        let measured = cut_bottom(&mut rest, u16::from(view.measured && area.height >= 8));
        Self {
            header,
            panes: place_panes(rest, area.height, view),
            overview,
            measured,
            verdict,
            note: if note.is_empty() { verdict } else { note },
            keys,
            is_cramped: area.width < FULL_LAB.0 || area.height < FULL_LAB.1,
        }
    }

    pub fn place_of(&self, pane: Pane) -> Option<Rect> {
        self.panes
            .iter()
            .find_map(|&(other, place)| (other == pane).then_some(place))
    }

    /// Returns the layout if a sheet fills the screen: the sheet, the row of messages, and the keys.
    fn of_sheet_alone(mut rest: Rect, keys: bool) -> Self {
        let height = rest.height;
        let keys = cut_bottom(&mut rest, u16::from(keys && height >= 6));
        let note = cut_bottom(&mut rest, u16::from(height >= 5));
        Self {
            panes: vec![(Pane::Lesson, rest)],
            note,
            keys,
            ..Self::default()
        }
    }

    /// Returns the panes that are shown side by side while none fills the screen.
    pub fn side_by_side(area: Rect, view: &View) -> Vec<Pane> {
        let unfilled = View {
            fullscreen: false,
            ..view.clone()
        };
        let layout = Self::new(area, &unfilled, 1, true);
        layout.panes.iter().map(|(pane, _)| *pane).collect()
    }
}

fn overview_rows(height: u16, view: &View) -> u16 {
    let full = OVERVIEW_ROWS.iter().find(|(from, _)| height >= *from);
    // Next to a page or a step on 24 rows there is room for the scrub line only.
    let is_reading = view.sheet.is_some() || view.may_show(Pane::Step);
    let has_room = !view.fullscreen && (!is_reading || height >= OVERVIEW_ROWS[1].0);
    match full {
        Some((_, rows)) if view.window.has_overview && has_room => *rows,
        _ => u16::from(height >= SCRUB_FROM),
    }
}

/// Removes the first `rows` from `rest` and returns them.
fn cut_top(rest: &mut Rect, rows: u16) -> Rect {
    let [top, below] = split_rows(*rest, rows);
    *rest = below;
    top
}

/// Removes the last `rows` from `rest` and returns them.
fn cut_bottom(rest: &mut Rect, rows: u16) -> Rect {
    let [above, bottom] = split_rows(*rest, rest.height.saturating_sub(rows));
    *rest = above;
    bottom
}

/// Splits `area` after `width` columns, with a blank column between the two parts.
fn apart(area: Rect, width: u16) -> [Rect; 2] {
    let [left, rest] = split_columns(area, width);
    let [_, right] = split_columns(rest, 1);
    [left, right]
}

/// Splits `area` into two columns of equal width, with a blank column between them.
fn halves(area: Rect) -> [Rect; 2] {
    apart(area, area.width.saturating_sub(1) / 2)
}

/// Splits `area` after `height` rows, with a blank row between the two parts.
fn stacked(area: Rect, height: u16) -> [Rect; 2] {
    let [above, rest] = split_rows(area, height);
    let [_, below] = split_rows(rest, 1);
    [above, below]
}

fn percent(width: u16, share: u32, (least, most): (u16, u16)) -> u16 {
    ((u32::from(width) * share / 100) as u16).clamp(least, most)
}

/// Places the panes on `area` of a screen of this `height`.
fn place_panes(area: Rect, height: u16, view: &View) -> Vec<(Pane, Rect)> {
    if area.is_empty() {
        Vec::new()
    } else if view.fullscreen {
        vec![(view.focus, area)]
    } else if view.may_show(Pane::Lesson) {
        with_page(area, height, view)
    } else {
        without_page(area, height, view)
    }
}

fn without_page(area: Rect, height: u16, view: &View) -> Vec<(Pane, Rect)> {
    if view.may_show(Pane::Step) {
        with_step(area, view)
    } else {
        arranged(area, height, view)
    }
}

/// Places a lesson's page, and next to it the run.
fn with_page(area: Rect, height: u16, view: &View) -> Vec<(Pane, Rect)> {
    let beside = View {
        focus: beside_page(view),
        ..view.clone()
    };
    if area.width >= BESIDE_PAGE_FROM {
        let [page, rest] = apart(area, percent(area.width, PAGE_SHARE, PAGE_COLUMNS));
        // A second blank column makes the page easier to read.
        let [_, rest] = split_columns(rest, 1);
        let mut panes = if rest.width >= FULL_LAB.0 || view.may_show(Pane::Step) {
            without_page(rest, height, &beside)
        } else {
            companion(rest, &beside)
        };
        panes.insert(0, (Pane::Lesson, page));
        return panes;
    }
    if view.focus != Pane::Lesson {
        return without_page(area, height, &beside);
    }
    let plays = view.sheet.as_ref().is_some_and(|sheet| sheet.plays);
    if !plays || area.height < 2 * PAGE_ROWS {
        return vec![(Pane::Lesson, area)];
    }
    let [page, rest] = split_rows(area, PAGE_ROWS);
    vec![(Pane::Lesson, page), (beside.focus, rest)]
}

/// Returns the pane to show next to a page if there is room for only one.
fn beside_page(view: &View) -> Pane {
    if view.focus != Pane::Lesson {
        return view.focus;
    }
    let shown = view.to_show();
    let mut others = shown.iter().filter(|pane| **pane != Pane::Lesson);
    let first = others.next().copied();
    let beside = view.beside.filter(|pane| shown.contains(pane));
    beside.or(first).unwrap_or(Pane::Traces)
}

/// Places the step pane, and next to it the run. If the tables of the step need all columns, it is alone.
fn with_step(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let step_columns = percent(area.width, STEP_SHARE, STEP_COLUMNS);
    let is_alone = !usual(view).any(|_| true);
    let least = match view.sheet {
        Some(_) => step_columns + 1 + COMPANION_COLUMNS,
        None => BESIDE_STEP_FROM,
    };
    if is_alone || area.width < least {
        let pane = if is_alone { Pane::Step } else { view.focus };
        return vec![(pane, area)];
    }
    let [step, rest] = apart(area, step_columns);
    // A second blank column separates the tables from the run.
    let [_, rest] = split_columns(rest, 1);
    let mut panes = beside_step(rest, view);
    panes.insert(0, (Pane::Step, step));
    panes
}

/// Places the run next to a step: the 3-D view, which shows the step, above, and the traces below.
fn beside_step(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let has_both = view.may_show(Pane::Traces) && !views(view).is_empty();
    let is_of_values = view.focus == Pane::Parameters;
    if !has_both || is_of_values || area.height < COMPANION_ROWS {
        return companion(area, view);
    }
    let [above, below] = split_rows(area, area.height - area.height * 11 / 31);
    let mut panes = place_views(above, view);
    panes.push((Pane::Traces, below));
    panes
}

/// Returns the panes that are shown by default, if they may be shown.
fn usual(view: &View) -> impl Iterator<Item = Pane> {
    [Pane::Traces, Pane::Above, Pane::ThreeD, Pane::Parameters]
        .into_iter()
        .filter(|pane| view.may_show(*pane))
}

/// Returns the views of the path that may be shown, the last one looked at first.
fn views(view: &View) -> Vec<Pane> {
    let mut views: Vec<_> = usual(view)
        .filter(|pane| [Pane::Above, Pane::ThreeD].contains(pane))
        .collect();
    let first = match view.focus {
        Pane::Above | Pane::ThreeD => view.focus,
        _ => view.path_view,
    };
    views.sort_by_key(|pane| *pane != first);
    views
}

/// Places the run next to a page or a step: the traces above, and the views of the path below. The values replace the
/// views while they have the focus.
fn companion(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let shown: Vec<_> = usual(view).collect();
    let (Some(first), Some(last)) = (shown.first(), shown.last()) else {
        return Vec::new();
    };
    if first == last || area.height < COMPANION_ROWS || area.width < COMPANION_OF_TWO {
        let views = views(view);
        let focus = shown.iter().find(|pane| **pane == view.focus);
        return vec![(*focus.or(views.first()).unwrap_or(first), area)];
    }
    let is_about_values =
        *last == Pane::Parameters && (view.focus == Pane::Parameters || views(view).is_empty());
    if !shown.contains(&Pane::Traces) && !is_about_values {
        return place_views(area, view);
    }
    let [above, below] = split_rows(area, companion_traces_rows(area.height));
    let mut panes = if shown.contains(&Pane::Traces) {
        vec![(Pane::Traces, above)]
    } else {
        place_views(above, view)
    };
    if is_about_values && below.width > 2 * VIEW_COLUMNS && !views(view).is_empty() {
        // The values replace one of the two views.
        let [left, right] = halves(below);
        panes.push((views(view)[0], left));
        panes.push((Pane::Parameters, right));
    } else if is_about_values {
        panes.push((Pane::Parameters, below));
    } else {
        panes.extend(place_views(below, view));
    }
    panes
}

/// Returns the rows of the traces above a view of the path or the values: 7 of 19, and 14 of 31.
fn companion_traces_rows(rows: u16) -> u16 {
    match rows.checked_sub(19) {
        Some(more) => 7 + more * 7 / 12,
        None => rows * 2 / 5,
    }
}

/// Places two views of the path side by side or one above the other if there is room; else the last one looked at.
fn place_views(area: Rect, view: &View) -> Vec<(Pane, Rect)> {
    let views = views(view);
    let is_chosen = views.iter().all(|pane| view.look.show.contains(pane));
    let is_wide = area.width > 2 * VIEW_COLUMNS;
    let is_high = area.height >= STACKED_FROM;
    match views[..] {
        [] => Vec::new(),
        [_, _] if is_high && !is_wide => {
            let [above, below] = stacked(area, ((area.height - 1) * 14 + 15) / 30);
            vec![(Pane::Above, above), (Pane::ThreeD, below)]
        }
        [_, _] if is_wide || is_chosen && area.width > 2 * CHOSEN_VIEW_COLUMNS => {
            let [left, right] = halves(area);
            vec![(Pane::Above, left), (Pane::ThreeD, right)]
        }
        [first, ..] => vec![(first, area)],
    }
}

/// Places the traces, the views of the path and the values as the size of the screen suggests.
fn arranged(area: Rect, height: u16, view: &View) -> Vec<(Pane, Rect)> {
    let shown: Vec<_> = usual(view).collect();
    if area.width < TWO_FROM || shown.len() < 2 {
        let focus = shown.iter().find(|pane| **pane == view.focus);
        let pane = focus.or(shown.first());
        return pane.map(|pane| (*pane, area)).into_iter().collect();
    }
    if area.width < FULL_LAB.0 {
        return two_columns(area, &shown, view);
    }
    let has = |pane| shown.contains(&pane);
    let has_views = has(Pane::Above) || has(Pane::ThreeD);
    let mut rest = area;
    let mut panes = Vec::new();
    if has(Pane::Traces) {
        let [traces, others] = apart(area, traces_columns(area.width));
        panes.push((Pane::Traces, traces));
        rest = others;
    }
    if !has(Pane::Parameters) {
        panes.extend(place_views(rest, view));
    } else if !has_views {
        panes.push((Pane::Parameters, rest));
    } else if area.width >= LARGE_LAB.0 && height >= LARGE_LAB.1 {
        let [views, values] = stacked(rest, rest.height.saturating_sub(VALUES_ROWS + 1));
        panes.extend(place_views(views, view));
        panes.push((Pane::Parameters, values));
    } else {
        let values_columns = if area.width < WIDE_VALUES_FROM {
            VALUES_COLUMNS.0
        } else {
            VALUES_COLUMNS.1
        };
        let [views, values] = apart(rest, rest.width - values_columns - 1);
        panes.extend(place_views(views, view));
        panes.push((Pane::Parameters, values));
    }
    panes
}

/// Places the first pane of `shown`, and next to it the pane in focus or else the last view looked at.
fn two_columns(area: Rect, shown: &[Pane], view: &View) -> Vec<(Pane, Rect)> {
    let first = shown[0];
    let views = views(view);
    let second = match shown.iter().find(|pane| **pane == view.focus) {
        Some(focus) if *focus != first => *focus,
        _ => *views
            .iter()
            .find(|pane| **pane != first)
            .unwrap_or(&shown[1]),
    };
    let [left, right] = apart(area, area.width / 2);
    vec![(first, left), (second, right)]
}

fn traces_columns(width: u16) -> u16 {
    let beyond = u32::from(width.clamp(80, 120)) - 80;
    let share = TRACES_SHARE.0 + (TRACES_SHARE.1 - TRACES_SHARE.0) * beyond / 40;
    let columns = (u32::from(width) * share / 1000) as u16;
    columns.clamp(TRACES_COLUMNS.0, TRACES_COLUMNS.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::scenario::Document;
    use crate::lab::view::theme::{Marker, Theme};

    fn view() -> View {
        let scenario = Document::open("method-2").unwrap().scenario().unwrap();
        View::new(&scenario, Marker::Braille, Theme::PLAIN)
    }

    fn shown(width: u16, height: u16, has_overview: bool, view: &View) -> ScreenLayout {
        let mut seen = view.clone();
        seen.window.has_overview = has_overview;
        ScreenLayout::new(Rect::new(0, 0, width, height), &seen, 1, true)
    }

    /// Returns the columns and rows of every pane.
    fn sizes(layout: &ScreenLayout) -> Vec<(Pane, u16, u16)> {
        let panes = layout.panes.iter();
        panes
            .map(|(pane, area)| (*pane, area.width, area.height))
            .collect()
    }

    #[test]
    fn the_three_arrangements_have_the_designed_sizes() {
        use Pane::{Above, Parameters, ThreeD, Traces};
        let view = view();
        let small = shown(80, 24, true, &view);
        let columns = [(Traces, 28, 16), (Above, 26, 16), (Parameters, 24, 16)];
        assert_eq!(sizes(&small), columns);
        assert_eq!(small.overview, Rect::new(0, 17, 80, 4));
        let medium = shown(120, 40, true, &view);
        let stacked = [
            (Traces, 50, 31),
            (Above, 38, 14),
            (ThreeD, 38, 16),
            (Parameters, 30, 31),
        ];
        assert_eq!(sizes(&medium), stacked);
        let large = shown(200, 50, true, &view);
        let band = [
            (Traces, 84, 40),
            (Above, 57, 26),
            (ThreeD, 57, 26),
            (Parameters, 115, 13),
        ];
        assert_eq!(sizes(&large), band);
        // Without an overview, the panes take its rows except for the scrub line.
        for (width, height, rows) in [(80, 24, 19), (120, 40, 35), (200, 50, 45)] {
            let layout = shown(width, height, false, &view);
            assert_eq!(layout.panes[0].1.height, rows, "{width}x{height}");
            assert_eq!(layout.overview.height, 1);
        }
    }

    #[test]
    fn parts_never_overlap_and_verdict_and_keys_remain() {
        let view = view();
        for width in (10..=220).step_by(3) {
            for height in 6..=60 {
                let layout = shown(width, height, height % 2 == 0, &view);
                let panes = layout.panes.iter().map(|(_, area)| *area);
                let rows = [layout.header, layout.overview, layout.verdict, layout.keys];
                let note = Some(layout.note).filter(|note| *note != layout.verdict);
                let all: Vec<_> = panes.chain(rows).chain(note).collect();
                let screen = Rect::new(0, 0, width, height);
                for (index, area) in all.iter().enumerate() {
                    let is_free = all[..index].iter().all(|other| !other.intersects(*area));
                    assert!(is_free, "{width}x{height}: {layout:?}");
                    assert_eq!(area.intersection(screen), *area, "{width}x{height}");
                }
                assert_eq!((layout.verdict.height, layout.keys.height), (1, 1));
            }
        }
    }

    #[test]
    fn the_last_view_in_focus_is_shown_if_only_one_fits() {
        let mut view = view();
        view.turn_to(Pane::ThreeD);
        assert!(shown(80, 24, true, &view).place_of(Pane::ThreeD).is_some());
        view.turn_to(Pane::Parameters);
        let layout = shown(80, 24, true, &view);
        assert!(layout.place_of(Pane::ThreeD).is_some());
        assert!(layout.place_of(Pane::Above).is_none());
    }
}
