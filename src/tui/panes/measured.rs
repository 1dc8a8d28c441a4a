//! The row on the measured data: their mark, their file, and their distance from the run.

use super::chrome::SEPARATOR;
use super::{shortened, write};
use crate::engine::data::RunQuantity;
use crate::engine::data::compared::Sum;
use crate::engine::text::number::{counted, short, shortest};
use crate::engine::text::printable::printable;
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::comparison::DataComparison;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::path::Path;

/// Minimum columns of a shortened file name.
const LEAST_NAME: usize = 12;

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let Some(beside) = lab.comparison().data() else {
        return;
    };
    let theme = &lab.view().theme;
    let mark = lab.view().marker.point().to_string();
    let what = if lab.view().look.residuals {
        " residuals: "
    } else {
        " measured: "
    };
    let before = columns(&mark) + columns(what) + 2;
    let room = (area.width as usize).saturating_sub(before);
    let end_s = lab.player().end_s;
    let (name, counts, parts) = fitting(beside, end_s, room);
    let quiet = theme.style(Role::Label);
    let mut x = write(area, (1, 0), &mark, theme.style(Role::Measured), buf);
    x = write(area, (x, 0), what, quiet, buf);
    x = write(area, (x, 0), &name, theme.style(Role::Text), buf);
    x = write(area, (x, 0), &format!(" {counts}"), quiet, buf);
    for part in parts {
        x = write(area, (x, 0), SEPARATOR, quiet, buf);
        x = write(area, (x, 0), &part, theme.style(Role::Text), buf);
    }
}

/// Returns the name of the data, their counts, and the parts of the row that fit in `room` columns.
///
/// Short forms are tried first, then a shorter name; then the last parts are dropped.
fn fitting(beside: &DataComparison, end_s: f64, room: usize) -> (String, String, Vec<String>) {
    let sum = &beside.compared.sum;
    let name = file_name(&beside.name);
    let [long, short] = reached(beside, sum, end_s);
    let parts = verdict(beside).into_iter().chain(parts(sum));
    let (all, in_short): (Vec<_>, Vec<_>) = parts.map(<_>::from).unzip();
    let mut forms = vec![(long.clone(), all), (long, in_short.clone())];
    let fewer = (0..=in_short.len()).rev();
    forms.extend(fewer.map(|count| (short.clone(), in_short[..count].to_vec())));
    let length = |(counts, shown): &(String, Vec<String>)| {
        let lengths = shown.iter().map(|part| columns(SEPARATOR) + columns(part));
        columns(counts) + lengths.sum::<usize>()
    };
    let (whole, least) = (columns(&name), columns(&name).min(LEAST_NAME));
    let mut first = forms.iter().take(3);
    let found = first
        .position(|form| length(form) + whole <= room)
        .or_else(|| forms.iter().position(|form| length(form) + least <= room));
    let form = forms.swap_remove(found.unwrap_or(forms.len() - 1));
    let rest = room.saturating_sub(length(&form)).max(least);
    (shortened(&name, rest).into_owned(), form.0, form.1)
}

/// Returns the name of the data, or of a file without its folders.
fn file_name(name: &str) -> String {
    let last = Path::new(name)
        .file_name()
        .map_or(name.into(), |last| last.to_string_lossy());
    printable(&last).into_owned()
}

/// Returns the measured quantities, the number of points, and how many of them the run has reached: in full and in
/// short.
///
/// If the data continue after `end_s`, the end of the run, it also names the key that plays the run to their end.
fn reached(beside: &DataComparison, sum: &Sum, end_s: f64) -> [String; 2] {
    let names: Vec<_> = beside.quantities().map(RunQuantity::words).collect();
    let (names, all, reached) = (
        names.join(", "),
        counted(sum.points as u64, "point"),
        sum.compared,
    );
    let last_s = beside.last_s().filter(|&last_s| last_s > end_s);
    let [long, short] = match last_s.map(shortest) {
        Some(last_s) if reached < sum.points => [
            format!("{reached} of {all}; data go beyond the run: press g and type {last_s} s"),
            format!("{reached} of {all}: g, {last_s} s"),
        ],
        _ if reached == 0 || reached == sum.points => [all.clone(), all],
        _ => [
            format!("{all}, {reached} reached so far"),
            format!("{reached} of {all}"),
        ],
    };
    [format!("({names}: {long})"), format!("({short})")]
}

/// Returns the verdict on the rows of the user's own program: in full and in short.
fn verdict(beside: &DataComparison) -> Option<[String; 2]> {
    let verdict = beside.own.as_ref()?.verdict()?;
    let slip = verdict
        .slips
        .first()
        .map(|names| names.join(" + "))
        .map_or_else(String::new, |slip| format!(", {slip}"));
    Some(match verdict.first_step {
        Some(step) => [
            format!("differs at step {step}{slip}: M"),
            format!("differs at {step}: M"),
        ],
        None if verdict.agrees => ["agrees with the scheme", "agrees"].map(str::to_owned),
        None => ["not finite"; 2].map(str::to_owned),
    })
}

/// Returns the distances of the data from the run, the most important first, each in full and in short.
fn parts(sum: &Sum) -> Vec<[String; 2]> {
    if sum.compared == 0 {
        return vec![["none reached yet"; 2].map(str::to_owned)];
    }
    let mut parts = Vec::new();
    if sum.weighed > 0 {
        let (chi, weighed) = (format!("chi² {}", short(sum.chi_squared)), sum.weighed);
        parts.push(if weighed < sum.compared {
            let at_length = format!("{chi} at the {weighed} with an uncertainty");
            [at_length, format!("{chi} at {weighed}")]
        } else {
            [chi.clone(), chi]
        });
    }
    if let Some(largest) = sum.largest {
        let (time, words) = (short(largest.time_s), largest.quantity.words());
        let largest = format!("largest {} sigma", short(largest.sigmas));
        parts.push([format!("{largest} ({words} at {time} s)"), largest]);
    }
    for (quantity, scatter) in &sum.scatter {
        let (words, off, unit) = (quantity.words(), short(*scatter), quantity.unit());
        let at_length = format!("{words} off by {off} {unit} (rms)");
        parts.push([at_length, format!("{words} off {off} {unit}")]);
    }
    parts
}
