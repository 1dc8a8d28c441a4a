//! The line about the measured data beside the run: their mark and their file, and how far they are from the run.

use super::{shortened, write};
use crate::lab::Lab;
use crate::lab::measured::{Beside, Sum};
use crate::measured::Quantity;
use crate::text::number::{short, shortest};
use crate::text::printable::printable;
use crate::text::wrap::columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::path::Path;

const SEPARATOR: &str = " · ";
/// The fewest columns to which a file's name is shortened.
const LEAST_NAME: usize = 12;

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let Some(beside) = lab.player().measured() else {
        return;
    };
    let theme = &lab.view().theme;
    let mark = lab.view().marker.point().to_string();
    let what = if lab.view().residuals {
        " residuals: "
    } else {
        " measured: "
    };
    let room = area.width.saturating_sub(1) as usize;
    let room = room.saturating_sub(columns(&mark) + columns(what) + 1);
    let end_s = lab.player().playback.end_s();
    let (name, counts, parts) = fitting(beside, end_s, room);
    let quiet = theme.style(Role::Quiet);
    let mut x = write(area, (1, 0), &mark, theme.style(Role::Measured), buf);
    x = write(area, (x, 0), what, quiet, buf);
    x = write(area, (x, 0), &name, theme.style(Role::Text), buf);
    x = write(area, (x, 0), &format!(" {counts}"), quiet, buf);
    for part in parts {
        x = write(area, (x, 0), SEPARATOR, quiet, buf);
        x = write(area, (x, 0), &part, theme.style(Role::Text), buf);
    }
}

/// The name of the data, their counts and the parts of the line that fit in `room` columns: short forms make room for the
/// rest, then a shorter name, then the last parts give way.
fn fitting(beside: &Beside, end_s: f64, room: usize) -> (String, String, Vec<String>) {
    let sum = &beside.compared.sum;
    let name = file_name(&beside.name);
    let [long, short] = counted(beside, sum, end_s);
    let [all, mut short_parts] = [parts(sum, false), parts(sum, true)];
    let mut forms = vec![(long.clone(), all), (long, short_parts.clone())];
    forms.push((short.clone(), short_parts.clone()));
    while short_parts.pop().is_some() {
        forms.push((short.clone(), short_parts.clone()));
    }
    let length = |counts: &str, parts: &[String]| {
        let parts = parts.iter().map(|part| columns(SEPARATOR) + columns(part));
        columns(counts) + parts.sum::<usize>()
    };
    let (whole, least) = (columns(&name), columns(&name).min(LEAST_NAME));
    let fits = |form: &(String, Vec<String>), name| length(&form.0, &form.1) + name <= room;
    let found = forms.iter().take(3).position(|form| fits(form, whole));
    let found = found.or_else(|| forms.iter().position(|form| fits(form, least)));
    let (counts, parts) = forms.swap_remove(found.unwrap_or(forms.len() - 1));
    let rest = room.saturating_sub(length(&counts, &parts)).max(least);
    (shortened(&name, rest).into_owned(), counts, parts)
}

/// The name of data, or of a file without its folders.
fn file_name(name: &str) -> String {
    let last = Path::new(name).file_name();
    let last = last.map_or(name.into(), |last| last.to_string_lossy());
    printable(&last).into_owned()
}

fn points(count: usize) -> String {
    match count {
        1 => "1 point".to_owned(),
        _ => format!("{count} points"),
    }
}

/// What was measured, how many values there are, and how many of them the run has reached: at length and in short.
/// Where data go on after `end_s`, the end of the run, it says so, and the key that plays the run up to there.
fn counted(beside: &Beside, sum: &Sum, end_s: f64) -> [String; 2] {
    let names: Vec<_> = beside.quantities().map(Quantity::words).collect();
    let (names, all) = (names.join(", "), points(sum.points));
    let last_s = beside.last_s().filter(|&last_s| last_s > end_s);
    match sum.compared {
        reached
            if let Some(last_s) = last_s
                && reached < sum.points =>
        {
            let last_s = shortest(last_s);
            [
                format!(
                    "({names}: {reached} of {all}, they go on after the run: g and {last_s} s play it to there)"
                ),
                format!("({reached} of {all}: g, {last_s} s)"),
            ]
        }
        0 => [format!("({names}: {all})"), format!("({all})")],
        reached if reached == sum.points => [format!("({names}: {all})"), format!("({all})")],
        reached => [
            format!("({names}: {all}, {reached} reached so far)"),
            format!("({reached} of {all})"),
        ],
    }
}

/// How far the data are from the run, the most important first: at length, or in short.
fn parts(sum: &Sum, in_short: bool) -> Vec<String> {
    if sum.compared == 0 {
        return vec!["none of them reached yet".to_owned()];
    }
    let mut parts = Vec::new();
    if sum.weighed > 0 {
        let chi = short(sum.chi_squared);
        parts.push(match (sum.weighed < sum.compared, in_short) {
            (false, _) => format!("chi² {chi}"),
            (true, true) => format!("chi² {chi} at {}", sum.weighed),
            (true, false) => format!("chi² {chi} at the {} with an uncertainty", sum.weighed),
        });
    }
    if let Some(largest) = sum.largest {
        let (sigmas, words) = (short(largest.sigmas), largest.quantity.words());
        parts.push(if in_short {
            format!("largest {sigmas} sigma")
        } else {
            format!(
                "largest {sigmas} sigma ({words} at {} s)",
                short(largest.time_s)
            )
        });
    }
    for (quantity, scatter) in &sum.scatter {
        let (words, off) = (quantity.words(), short(*scatter));
        let unit = quantity.unit();
        parts.push(if in_short {
            format!("{words} off {off} {unit}")
        } else {
            format!("{words} off by {off} {unit} (rms)")
        });
    }
    parts
}
