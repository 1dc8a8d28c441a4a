//! Which strips there are, and where they stand.

use super::{STRIP, STRIP_NAME_WIDTH, Traces, WHOLE_TIME_SHARE, axis};
use crate::engine::recording::RecordedCurve;
use crate::lab::playback::strip::Strip;
use crate::tui::split::split_rows;
use crate::tui::theme::Role;
use ratatui::layout::{Margin, Position, Rect};

/// From this width on the values stand beside the strips, and not on a line above each.
const BESIDE_FROM: u16 = 48;
/// The fewest rows of a strip with measured points, and the shares of the remaining rows that it gets.
const STRIP_WITH_POINTS: u16 = 3;
const WITH_POINTS: u16 = 3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StripContent {
    Curve(RecordedCurve),
    /// The quantity of this index among the measured ones, where it is none of those curves.
    Measured(usize),
}

impl StripContent {
    pub fn of_every_run() -> [Self; 4] {
        RecordedCurve::ALL.map(Self::Curve)
    }

    pub fn role(self) -> Role {
        match self {
            Self::Curve(RecordedCurve::X) => Role::X,
            Self::Curve(RecordedCurve::Y) => Role::Y,
            Self::Curve(RecordedCurve::Z) => Role::Z,
            Self::Curve(RecordedCurve::Tilt) | Self::Measured(_) => Role::Path,
        }
    }
}

/// Strips one above the other over the same time, and the axis below them.
pub(super) struct Group {
    pub strips: Vec<(StripContent, Rect)>,
    pub area: Rect,
    pub strip: Strip,
    /// Whether it shows less time than the other group: the fast motion.
    pub is_zoom: bool,
}

impl Traces<'_> {
    /// Columns beside the strips for their values; none where these stand on a line above each.
    pub(super) fn beside(&self, inside: Rect) -> u16 {
        if inside.width < BESIDE_FROM {
            return 0;
        }
        let measured = self.measured_contents();
        let labels = StripContent::of_every_run()
            .into_iter()
            .chain(measured.clone())
            .flat_map(|content| {
                let scale = self.scale(content, None);
                let few = axis::values(&scale, 2);
                few.into_iter()
                    .chain(axis::values(&scale, inside.height.into()))
            });
        let widest = labels.map(|(_, label)| label.len() as u16).max();
        let names = measured
            .into_iter()
            .map(|content| self.named(content).0.len() as u16 + 1);
        names.fold(STRIP_NAME_WIDTH, u16::max) + widest.unwrap_or(0) + 1
    }

    /// The strips that there is room for, and where they stand.
    pub(super) fn groups(&self, inside: Rect, beside: u16) -> Vec<Group> {
        let across = self.0.view.marker.dots().0;
        let columns = (inside.width - beside) as usize * across;
        let now_s = self.0.run.now().time_s;
        let long = match self.0.view.since_s {
            Some(since_s) => Strip::new(since_s, self.0.view.look.window_s, columns),
            None => Strip::following(now_s, self.0.view.look.window_s, columns),
        };
        let at_s = self.0.cursor.map_or(now_s, |cursor| cursor.time_s);
        let short = self.0.detail.strip(columns, across > 1, at_s);
        let has_zoom = short.window_s < WHOLE_TIME_SHARE * self.0.view.look.window_s;
        let (upper, lower) = self.shown(inside.height, has_zoom, beside > 0);
        let weight: u16 = lower.iter().map(|content| self.weight(*content)).sum();
        let height = match (upper.is_empty(), lower.is_empty()) {
            (true, _) => 0,
            (false, true) => inside.height,
            (false, false) => inside.height.saturating_sub(2).div_ceil(weight + 1) + 1,
        };
        let [above, below] = split_rows(inside, height);
        [(upper, short, above, true), (lower, long, below, false)]
            .into_iter()
            .filter(|(contents, ..)| !contents.is_empty())
            .map(|(contents, strip, area, is_zoom)| Group {
                strips: self.stacked(&contents, area),
                area,
                strip,
                is_zoom,
            })
            .collect()
    }

    /// `contents` one above the other on `area`, but for its last row, which the axis has.
    fn stacked(&self, contents: &[StripContent], area: Rect) -> Vec<(StripContent, Rect)> {
        let rows = area.height.saturating_sub(1);
        let all: u16 = contents.iter().map(|content| self.weight(*content)).sum();
        let (share, mut spare) = (rows / all.max(1), rows % all.max(1));
        let mut rest = area;
        let mut places = Vec::with_capacity(contents.len());
        for &content in contents {
            let weight = self.weight(content);
            let more = spare.min(weight);
            spare -= more;
            let [place, below] = split_rows(rest, share * weight + more);
            rest = below;
            places.push((content, place));
        }
        places
    }

    fn weight(&self, content: StripContent) -> u16 {
        match self.points(content) {
            Some(_) => WITH_POINTS,
            None => 1 + u16::from(self.0.measured.is_some()),
        }
    }

    /// The contents of the strips that fit into `height` rows with their axes, from the top: that of the strip of the fast
    /// motion, and those of the others, in their order. Measured quantities go before the others. Where there is no room
    /// for all of these, z goes before y, and x before both. A curve that was measured gets a second strip, that of the
    /// fast motion, only if no other curve is left out for it.
    fn shown(
        &self,
        height: u16,
        has_zoom: bool,
        is_beside: bool,
    ) -> (Vec<StripContent>, Vec<StripContent>) {
        let least = |content: &StripContent| match (self.points(*content), is_beside) {
            (Some(_), _) => STRIP_WITH_POINTS,
            (None, true) if self.0.measured.is_none() => 1,
            (None, _) => STRIP,
        };
        let first = StripContent::Curve(self.0.detail.curve);
        let measured = self.measured_contents();
        let mut by_worth = rank_by_worth(&measured, self.0.detail.curve);
        let fast = STRIP.min(least(&first));
        let needed: u16 = if measured.contains(&first) {
            by_worth.iter().map(least).sum()
        } else {
            measured.first().map_or(0, least)
        };
        let has_fast = has_zoom && height >= 2 + fast + needed;
        let mut room = height.saturating_sub(if has_fast { 2 + fast } else { 1 });
        if has_fast && !measured.contains(&first) {
            by_worth.retain(|content| *content != first);
        }
        by_worth.retain(|content| {
            let fits = least(content) <= room;
            room -= if fits { least(content) } else { 0 };
            fits
        });
        let mut lower = StripContent::of_every_run().to_vec();
        lower.extend(
            measured
                .into_iter()
                .filter(|content| matches!(content, StripContent::Measured(_))),
        );
        if !has_zoom {
            lower.sort_by_key(|content| *content != first); // stable
        }
        lower.retain(|content| by_worth.contains(content));
        (has_fast.then_some(first).into_iter().collect(), lower)
    }

    /// The time that the cell `at` of the screen shows where the traces are drawn on `area`, s; `None` beside the strips.
    pub fn time_s(&self, area: Rect, at: Position) -> Option<f64> {
        let inside = area.inner(Margin::new(1, 1));
        if !inside.contains(at) {
            return None;
        }
        let beside = self.beside(inside);
        let groups = self.groups(inside, beside);
        let group = groups.iter().find(|group| group.area.contains(at))?;
        let cell = (at.x - inside.x).checked_sub(beside)?;
        let across = self.0.view.marker.dots().0;
        let column = cell as usize * across + (across - 1) / 2;
        Some(group.strip.time_s(column))
    }
}

/// All contents, the most important first: what was `measured`, the curve of the fast motion, and the others.
fn rank_by_worth(measured: &[StripContent], fast: RecordedCurve) -> Vec<StripContent> {
    let mut contents = measured.to_vec();
    let curves = [
        fast,
        RecordedCurve::X,
        RecordedCurve::Z,
        RecordedCurve::Tilt,
        RecordedCurve::Y,
    ];
    for content in curves.map(StripContent::Curve) {
        if !contents.contains(&content) {
            contents.push(content);
        }
    }
    contents
}
