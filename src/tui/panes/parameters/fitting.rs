//! Which lines are shown where there is not room for all, and how groups of them are put into columns.

use super::lines::{Line, PREDICTED, heading, now_lines, watched_lines};
use crate::lab::view::{Part, View};
use crate::observe::reading::Reading;

/// The readouts for `room` lines: all of them, or those to watch.
pub(super) fn read_lines(view: &View, reading: &Reading, room: usize) -> Vec<Line> {
    let all = shown(view, now_lines(reading));
    if all.len() <= room {
        return all;
    }
    let mut watched = vec![heading("now")];
    watched.extend(shown(view, watched_lines(reading).into()));
    let mut lines = fitting(watched, room);
    lines.truncate(room);
    lines
}

/// `lines` without those that are hidden.
pub(super) fn shown(view: &View, mut lines: Vec<Line>) -> Vec<Line> {
    if view.hides(Part::Predicted) {
        lines.retain(|line| line.label != PREDICTED);
    }
    lines
}

/// `lines` in columns of at most `height` that begin with a heading; `None` where a group is higher than that.
pub(super) fn by_group(lines: &[Line], height: usize) -> Option<Vec<&[Line]>> {
    let mut columns = Vec::new();
    let (mut begin, mut end) = (0, 0);
    for group in lines.chunk_by(|_, next| !next.is_heading()) {
        if end + group.len() - begin > height {
            columns.push(&lines[begin..end]);
            begin = end;
        }
        end += group.len();
    }
    columns.push(&lines[begin..]);
    columns
        .iter()
        .all(|lines| lines.len() <= height)
        .then_some(columns)
}

/// The lines for which there is room, the least important left out.
pub(super) fn fitting(mut lines: Vec<Line>, room: usize) -> Vec<Line> {
    while lines.len() > room {
        let ranks = lines.iter().map(|line| line.rank).enumerate();
        match ranks.max_by_key(|&(_, rank)| rank) {
            Some((index, 1..)) => drop(lines.remove(index)),
            _ => break, // all of it matters: the rest is cut off
        }
        lines = without_empty_groups(lines);
    }
    lines
}

/// `lines` without those that have no value, the headings kept.
pub(super) fn without_dashes(mut lines: Vec<Line>) -> Vec<Line> {
    lines.retain(|line| line.is_heading() || line.value != "-");
    without_empty_groups(lines)
}

/// No heading stands alone.
fn without_empty_groups(lines: Vec<Line>) -> Vec<Line> {
    let alone = |index: usize| {
        lines[index].is_heading() && lines.get(index + 1).is_none_or(Line::is_heading)
    };
    let keep: Vec<bool> = (0..lines.len()).map(|index| !alone(index)).collect();
    let kept = lines.into_iter().zip(keep).filter(|&(_, keep)| keep);
    kept.map(|(line, _)| line).collect()
}

#[cfg(test)]
mod tests {
    use super::super::lines::value;
    use super::*;

    #[test]
    fn groups_stay_together_where_they_fit() {
        let line = |label| value(0, label, String::new(), "");
        let lines = [heading("a"), line("1"), heading("b"), line("2"), line("3")];
        let columns = |height| by_group(&lines, height).map(|columns| columns.len());
        assert_eq!(columns(5), Some(1));
        assert_eq!(columns(3), Some(2));
        assert_eq!(columns(2), None);
    }
}
