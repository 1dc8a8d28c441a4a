//! The line about the measured data beside the run: their mark and their file, and how far they are from the run.

use super::{shortened, write};
use crate::lab::Lab;
use crate::lab::measured::{Beside, Sum};
use crate::text::number::short;
use crate::text::printable::printable;
use crate::text::wrap::columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::path::Path;

/// Between two parts of the line.
const SEPARATOR: &str = " · ";
/// The fewest columns of a file's name.
const LEAST_NAME: usize = 12;

/// Draws the line about the data in `lab`, if there are any.
pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let Some(beside) = lab.player().measured() else {
        return;
    };
    let theme = &lab.view().theme;
    let sum = &beside.compared().sum;
    let room = area.width.saturating_sub(1) as usize;
    let mark = lab.view().marker.point().to_string();
    let what = match lab.view().residuals {
        true => " residuals: ",
        false => " measured: ",
    };
    let counts = [counted(beside, sum), format!("({})", points(sum.points))];
    let parts = [parts(sum, false), parts(sum, true)];
    let name = file_name(beside.name());
    let length = |counts: &str, parts: &[String]| {
        let parts = parts.iter().map(|part| columns(SEPARATOR) + columns(part));
        columns(&mark) + columns(what) + 1 + columns(counts) + parts.sum::<usize>()
    };
    // Short forms make room for the rest, then a shorter name, then the last parts.
    let mut forms = vec![(&counts[0], &parts[0][..]), (&counts[0], &parts[1][..])];
    forms.extend(
        (0..=parts[1].len())
            .rev()
            .map(|count| (&counts[1], &parts[1][..count])),
    );
    let (whole, least) = (columns(&name), columns(&name).min(LEAST_NAME));
    let fits =
        |name: usize, &(counts, parts): &(&String, &[String])| length(counts, parts) + name <= room;
    let with_all = forms.iter().take(3).find(|form| fits(whole, form));
    let found = with_all.or_else(|| forms.iter().find(|form| fits(least, form)));
    let &(counts, parts) = found.unwrap_or(&forms[forms.len() - 1]);
    let rest = room.saturating_sub(length(counts, parts));
    let mut x = write(area, (1, 0), &mark, theme.style(Role::Measured), buf);
    let quiet = theme.style(Role::Quiet);
    x = write(area, (x, 0), what, quiet, buf);
    x = write(
        area,
        (x, 0),
        &shortened(&name, rest.max(least)),
        theme.style(Role::Text),
        buf,
    );
    x = write(area, (x, 0), &format!(" {counts}"), quiet, buf);
    for part in parts {
        x = write(area, (x, 0), SEPARATOR, quiet, buf);
        x = write(area, (x, 0), part, theme.style(Role::Text), buf);
    }
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

/// What was measured, and how many values there are.
fn counted(beside: &Beside, sum: &Sum) -> String {
    let quantities = beside.quantities();
    let names: Vec<_> = quantities.map(|quantity| quantity.words()).collect();
    format!("({}: {})", names.join(", "), points(sum.points))
}

/// How far the data are from the run, the most important first: at length, or in short.
fn parts(sum: &Sum, in_short: bool) -> Vec<String> {
    if sum.compared == 0 {
        return vec!["none of them reached yet".to_owned()];
    }
    let mut parts = Vec::new();
    let reached = match (sum.compared == sum.points, in_short) {
        (true, _) => String::new(),
        (false, true) => format!(" at {}", sum.compared),
        (false, false) => format!(" at the {} reached so far", sum.compared),
    };
    if sum.weighed > 0 {
        let of_some = sum.weighed < sum.compared;
        let weighed = match (of_some, in_short) {
            (false, _) => reached.clone(),
            (true, true) => format!(" at {}", sum.weighed),
            (true, false) => format!(" at the {} with an uncertainty", sum.weighed),
        };
        parts.push(format!("chi² {}{weighed}", short(sum.chi_squared)));
    }
    if let Some(largest) = sum.largest {
        let (sigmas, words) = (short(largest.sigmas), largest.quantity.words());
        parts.push(match in_short {
            true => format!("largest {sigmas} sigma"),
            false => format!(
                "largest {sigmas} sigma ({words} at {} s)",
                short(largest.time_s)
            ),
        });
    }
    for (quantity, scatter) in &sum.scatter {
        let off = format!("{} {}", short(*scatter), quantity.unit());
        parts.push(match (in_short, sum.weighed > 0) {
            (true, _) => format!("{} off {off}", quantity.words()),
            (false, true) => format!("{} off by {off} (rms)", quantity.words()),
            (false, false) => format!("{} off by {off} (rms){reached}", quantity.words()),
        });
    }
    parts
}
