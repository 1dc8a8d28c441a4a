//! Which strips there are, and where they stand.

use super::content::{Content, of_every_run};
use super::{ALL, NAME, STRIP, Traces, axis};
use crate::observe::recording::Curve;
use crate::observe::strip::Strip;
use ratatui::layout::{Margin, Position, Rect};

/// From this width on the values stand beside the strips, and not on a line above each.
const BESIDE_FROM: u16 = 48;
/// The fewest rows of a strip with measured points, and the shares of the remaining rows that it gets.
const STRIP_WITH_POINTS: u16 = 3;
const WITH_POINTS: u16 = 3;

/// Strips one above the other over the same time, and the axis below them.
pub(super) struct Group {
    pub strips: Vec<(Content, Rect)>,
    pub area: Rect,
    /// Columns beside the strips for their values; none where these stand on a line above each.
    pub beside: u16,
    pub strip: Strip,
}

impl Traces<'_> {
    pub(super) fn beside(&self, inside: Rect) -> u16 {
        if inside.width < BESIDE_FROM {
            return 0;
        }
        let all = of_every_run().chain(self.measured_contents());
        let labels = all.clone().map(|content| {
            let scale = self.scale(content, None);
            let mut labels = axis::values(&scale, 2);
            labels.extend(axis::values(&scale, inside.height as usize));
            labels
        });
        let widest = labels.flatten().map(|(_, label)| label.len() as u16).max();
        self.name_columns() + widest.unwrap_or(0) + 1
    }

    fn name_columns(&self) -> u16 {
        let names = self.measured_contents().into_iter();
        let names = names.map(|content| self.named(content).0.len() as u16 + 1);
        names.fold(NAME, u16::max)
    }

    /// The strips that there is room for, and where they stand.
    pub(super) fn groups(&self, inside: Rect, beside: u16) -> Vec<Group> {
        let across = self.view.marker.dots().0;
        let columns = (inside.width - beside) as usize * across;
        let long = match self.view.since_s {
            Some(since_s) => Strip::new(since_s, self.view.window_s, columns),
            None => Strip::following(self.run.now().time_s, self.view.window_s, columns),
        };
        let at_s = self
            .cursor
            .map_or(self.run.now().time_s, |cursor| cursor.time_s);
        let detail = self.detail.strip(columns, across > 1, at_s);
        let is_magnified = self.is_detail(&detail);
        let least = |content: Content| match (self.points(content), beside > 0) {
            (Some(_), _) => STRIP_WITH_POINTS,
            (None, true) if self.measured.is_none() => 1,
            (None, _) => STRIP,
        };
        let (upper, lower) = self.shown(inside.height, is_magnified, least);
        let axes = 1 + u16::from(!upper.is_empty());
        let rows = inside.height.saturating_sub(axes);
        let weigh = |list: &[Content]| {
            list.iter()
                .map(|content| self.weight(*content))
                .sum::<u16>()
        };
        let all = (weigh(&lower) + upper.len() as u16).max(1);
        let mut y = inside.y;
        let mut groups = Vec::new();
        let parts = [(upper, detail, true), (lower, long, false)];
        let is_shown = |(contents, ..): &(Vec<Content>, Strip, bool)| !contents.is_empty();
        let last = parts.iter().rposition(is_shown);
        for (index, (contents, strip, is_upper)) in parts.into_iter().enumerate() {
            if contents.is_empty() {
                continue;
            }
            let weight = if is_upper {
                contents.len() as u16
            } else {
                weigh(&contents)
            };
            let height = if Some(index) == last {
                inside.bottom() - y
            } else {
                (rows * weight).div_ceil(all) + 1
            };
            let area = Rect {
                y,
                height,
                ..inside
            };
            y += height;
            groups.push(Group {
                strips: self.stacked(&contents, area),
                area,
                beside,
                strip,
            });
        }
        groups
    }

    /// `contents` one above the other on `area`, but for its last row, which the axis has.
    fn stacked(&self, contents: &[Content], area: Rect) -> Vec<(Content, Rect)> {
        let rows = area.height.saturating_sub(1);
        let all: u16 = contents.iter().map(|content| self.weight(*content)).sum();
        let (share, mut spare) = (rows / all.max(1), rows % all.max(1));
        let mut y = area.y;
        let place = |&content: &Content| {
            let weight = self.weight(content);
            let more = spare.min(weight);
            spare -= more;
            let height = share * weight + more;
            let place = Rect { y, height, ..area };
            y += height;
            (content, place)
        };
        contents.iter().map(place).collect()
    }

    fn weight(&self, content: Content) -> u16 {
        match self.points(content) {
            Some(_) => WITH_POINTS,
            None => 1 + u16::from(self.measured.is_some()),
        }
    }

    /// The contents of the strips that fit into `height` rows with their axes, from the top: that of the strip of the fast
    /// motion, and those of the others, in their order. `least` is the fewest rows of a strip with a content. Measured
    /// quantities go before the others. Where there is no room for all of these, z goes before y, and x before both. A
    /// curve that was measured gets a second strip, that of the fast motion, only if no other curve is left out for it.
    fn shown(
        &self,
        height: u16,
        is_magnified: bool,
        least: impl Fn(Content) -> u16,
    ) -> (Vec<Content>, Vec<Content>) {
        let first = Content::Curve(self.detail.curve);
        let measured = self.measured_contents();
        let by_worth = [Curve::X, Curve::Z, Curve::Tilt, Curve::Y].map(Content::Curve);
        let fast = STRIP.min(least(first));
        let room_beside_fast = height.saturating_sub(2 + fast);
        let needed: u16 = if measured.contains(&first) {
            let others = by_worth
                .into_iter()
                .filter(|other| !measured.contains(other));
            measured.iter().copied().chain(others).map(&least).sum()
        } else {
            measured.first().copied().map_or(0, &least)
        };
        let has_fast = is_magnified && height >= 2 + fast && needed <= room_beside_fast;
        let upper: Vec<_> = has_fast.then_some(first).into_iter().collect();
        let is_left = |content: &Content| {
            let is_above = has_fast && *content == first;
            !is_above && !measured.contains(content)
        };
        let lead = [first].into_iter().filter(|_| !has_fast);
        let others = by_worth.into_iter().filter(is_left);
        let mut room = if has_fast {
            room_beside_fast
        } else {
            height.saturating_sub(1)
        };
        let mut chosen: Vec<Content> = Vec::new();
        for content in measured.iter().copied().chain(lead).chain(others) {
            if least(content) <= room && !chosen.contains(&content) {
                room -= least(content);
                chosen.push(content);
            }
        }
        let others = measured.iter().copied();
        let others = others.filter(|content| matches!(content, Content::Measured(_)));
        let mut in_order = of_every_run().chain(others).collect::<Vec<_>>();
        if !is_magnified {
            in_order.sort_by_key(|content| *content != first); // stable
        }
        let lower = in_order
            .into_iter()
            .filter(|content| chosen.contains(content));
        (upper, lower.collect())
    }

    /// Whether `strip` shows less time than the others: the fast motion.
    pub(super) fn is_detail(&self, strip: &Strip) -> bool {
        strip.window_s < ALL * self.view.window_s
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
        let across = self.view.marker.dots().0;
        Some(
            group
                .strip
                .time_s(cell as usize * across + (across - 1) / 2),
        )
    }
}
