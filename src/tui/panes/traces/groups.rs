//! Which strips there are, and where they stand.

use super::content::{Content, of_every_run};
use super::{ALL, NAME, STRIP, Traces, axis};
use crate::observe::recording::Curve;
use crate::observe::strip::Strip;
use ratatui::layout::Rect;

/// From this width on the values stand beside the strips, and not on a line above each.
const BESIDE_FROM: u16 = 48;
/// The fewest rows of a strip where something was measured, and the shares of the remaining rows that a strip with
/// points has.
const STRIP_MEASURED: u16 = 3;
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
    /// Columns for the values beside the strips.
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

    /// Columns for the names beside the strips.
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
        let detail = Strip::new(self.detail.begin_s, self.detail.window_s, columns);
        let is_magnified = self.is_detail(&detail);
        let least = match (self.measured.is_some(), beside > 0) {
            (true, _) => STRIP_MEASURED,
            (false, true) => 1,
            (false, false) => STRIP,
        };
        let axes = 1 + u16::from(is_magnified);
        let strips = inside.height.saturating_sub(axes) / least;
        let (upper, lower) = self.shown(strips as usize, is_magnified);
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
            let weight = match is_upper {
                true => contents.len() as u16,
                false => weigh(&contents),
            };
            let height = match Some(index) == last {
                true => inside.bottom() - y,
                false => (rows * weight).div_ceil(all) + 1,
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

    /// How many shares of the height a strip has.
    fn weight(&self, content: Content) -> u16 {
        match self.points(content) {
            Some(_) => WITH_POINTS,
            None => 1 + u16::from(self.measured.is_some()),
        }
    }

    /// The contents for `most` strips, from the top: that of the strip of the fast motion, and those of the others, in
    /// their order. Measured quantities go before the others. Where there is no room for all of these, z goes before y,
    /// and x before both.
    fn shown(&self, most: usize, is_magnified: bool) -> (Vec<Content>, Vec<Content>) {
        let first = Content::Curve(self.detail.curve);
        let measured = self.measured_contents();
        let has_fast = is_magnified && most > usize::from(!measured.is_empty());
        let upper: Vec<_> = has_fast.then_some(first).into_iter().collect();
        let by_worth = [Curve::X, Curve::Z, Curve::Tilt, Curve::Y].map(Content::Curve);
        let is_left = |content: &Content| {
            let is_above = is_magnified && *content == first;
            !is_above && !measured.contains(content)
        };
        let lead = [first].into_iter().filter(|_| !is_magnified && most > 0);
        let others = by_worth.into_iter().filter(is_left);
        let mut chosen: Vec<Content> = Vec::new();
        for content in measured.iter().copied().chain(lead).chain(others) {
            if chosen.len() + upper.len() < most && !chosen.contains(&content) {
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
}
