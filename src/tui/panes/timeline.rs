//! The timeline: a line for the whole run, with the place where it stands, how far it has been, its pushes and its edits.
//!
//! Each has a sign of its own, so that they can be told apart without colours. While a run is played, few cells change:
//! the scale changes only when the run goes on beyond the line's end.

use super::write;
use crate::engine::run::Clock;
use crate::engine::text::number::decimal;
use crate::lab::Lab;
use crate::lab::playback::marks::Marks;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

const AHEAD_LINE: &str = "·";
const REACHED_LINE: &str = "─";
const PUSH_MARK: &str = "═";
const EDIT_MARK: &str = ":";
/// The scenario's end, where the run has gone on beyond it.
const END_MARK: &str = "│";
/// How far the pinned run has been.
const PINNED_MARK: &str = "┤";
const NOW_MARK: &str = "█";
/// The label of the pinned run's sign, and the fewest columns of a line that has it.
const LEGEND: &str = "┤ pinned  ";
const LEGEND_FROM: u16 = 60;
/// Fewest columns of a line that is worth drawing.
const LEAST_TIMELINE_WIDTH: u16 = 16;

#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    /// Where the scenario's run ends, s.
    pub end_s: f64,
    pub now_s: f64,
    /// How far it has been, s.
    pub furthest_s: f64,
    /// How far the pinned run has been, s; `None` where none is pinned.
    pub pinned_s: Option<f64>,
    pub marks: Marks,
}

impl Timeline {
    pub fn new(lab: &Lab) -> Self {
        let run = lab.player().run();
        let (scenario, furthest) = (run.scenario(), run.furthest());
        let now_s = run.now().time_s;
        Self {
            end_s: lab.player().end_s,
            now_s,
            furthest_s: Clock::at(scenario, furthest).time_s(furthest).max(now_s),
            pinned_s: lab.comparison().pinned_end_s(run),
            marks: Marks::new(scenario),
        }
    }

    /// Time at the right end, s: that of the scenario's run, doubled as often as the run has gone on beyond it.
    pub fn whole_s(&self) -> f64 {
        let end_s = self.end_s.max(f64::MIN_POSITIVE);
        let doublings = libm::log2(self.furthest_s / end_s * (1.0 - 1e-9)).ceil();
        end_s * libm::exp2(doublings.max(0.0))
    }

    /// The columns of the line on `area`, between its labels; `None` where there is no room.
    fn line(&self, area: Rect) -> Option<Rect> {
        let label = self.label(area.width).chars().count() as u16;
        let width = area.width.checked_sub(label + 3)?;
        let line = Rect {
            x: area.x + 1,
            width,
            ..area
        };
        (width >= LEAST_TIMELINE_WIDTH && area.height > 0).then_some(line)
    }

    fn label(&self, width: u16) -> String {
        let legend = match self.pinned_s {
            Some(_) if width >= LEGEND_FROM => LEGEND,
            _ => "",
        };
        format!("{legend}{} s", decimal(self.whole_s()))
    }

    /// The column of `time_s` on a line of `width` columns; a time outside is at the nearer end.
    fn column(&self, time_s: f64, width: u16) -> u16 {
        let share = (time_s / self.whole_s()).clamp(0.0, 1.0);
        (share * f64::from(width.saturating_sub(1))).round() as u16
    }

    /// The time at the column `x` of the screen where this timeline is drawn on `area`, s; `None` beside the line.
    pub fn time_s(&self, area: Rect, x: u16) -> Option<f64> {
        let line = self.line(area)?;
        let column = x
            .checked_sub(line.x)
            .filter(|column| *column < line.width)?;
        Some(f64::from(column) / f64::from(line.width - 1) * self.whole_s())
    }

    /// The signs of a line of `width` columns, each with its role.
    fn signs(&self, width: u16) -> Vec<(&'static str, Role)> {
        let reached = self.column(self.furthest_s, width);
        let mut signs: Vec<_> = (0..width)
            .map(|column| {
                if column <= reached && self.furthest_s > 0.0 {
                    (REACHED_LINE, Role::Text)
                } else {
                    (AHEAD_LINE, Role::Quiet)
                }
            })
            .collect();
        let mut put = |column: u16, sign, role| {
            if let Some(cell) = signs.get_mut(column as usize) {
                *cell = (sign, role);
            }
        };
        let whole_s = self.whole_s();
        for &(begin_s, end_s) in self.marks.pushes.iter().filter(|push| push.0 <= whole_s) {
            let (first, last) = (self.column(begin_s, width), self.column(end_s, width));
            (first..=last).for_each(|column| put(column, PUSH_MARK, Role::Push));
        }
        if whole_s > self.end_s {
            put(self.column(self.end_s, width), END_MARK, Role::Text);
        }
        for &edit_s in self.marks.edits.iter().filter(|edit_s| **edit_s <= whole_s) {
            put(self.column(edit_s, width), EDIT_MARK, Role::Heading);
        }
        if let Some(pinned_s) = self.pinned_s {
            put(self.column(pinned_s, width), PINNED_MARK, Role::Pinned);
        }
        put(self.column(self.now_s, width), NOW_MARK, Role::Focus);
        signs
    }
}

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let timeline = Timeline::new(lab);
    let Some(line) = timeline.line(area) else {
        return;
    };
    let theme = &lab.view().theme;
    for ((sign, role), x) in timeline.signs(line.width).into_iter().zip(0..) {
        write(line, (x, 0), sign, theme.style(role), buf);
    }
    let label = timeline.label(area.width);
    let x = line.right() - area.x + 1;
    write(area, (x, 0), &label, theme.style(Role::Quiet), buf);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline(now_s: f64, furthest_s: f64) -> Timeline {
        Timeline {
            end_s: 100.0,
            now_s,
            furthest_s,
            pinned_s: None,
            marks: Marks {
                pushes: vec![(10.0, 30.0)],
                edits: vec![60.0],
            },
        }
    }

    fn drawn(timeline: &Timeline) -> String {
        timeline.signs(21).iter().map(|(sign, _)| *sign).collect()
    }

    #[test]
    fn each_thing_has_a_sign_of_its_own() {
        for (now_s, furthest_s, line) in [
            (40.0, 80.0, "──═════─█───:────····"),
            (0.0, 0.0, "█·═════·····:········"),
            (100.0, 100.0, "──═════─────:───────█"),
            (150.0, 150.0, "─═══──:───│────█·····"), // twice as long
        ] {
            assert_eq!(drawn(&timeline(now_s, furthest_s)), line);
        }
        let mut endless = timeline(0.0, 0.0);
        endless.marks.pushes = vec![(50.0, f64::INFINITY)];
        endless.marks.edits.clear();
        assert_eq!(drawn(&endless), "█·········═══════════");
    }

    #[test]
    fn the_pinned_run_is_marked_where_it_ended() {
        let mut pinned = timeline(40.0, 80.0);
        pinned.pinned_s = Some(50.0);
        assert_eq!(drawn(&pinned), "──═════─█─┤─:────····");
        pinned.pinned_s = Some(500.0);
        assert_eq!(drawn(&pinned), "──═════─█───:────···┤");
        assert_eq!(pinned.label(80), "┤ pinned  100 s");
        assert_eq!(pinned.label(59), "100 s");
    }
}
