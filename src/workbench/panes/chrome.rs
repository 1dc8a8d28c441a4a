//! The lines around the panes: title, health, hint and keys.

use super::{wrapped, write};
use crate::workbench::health::remarks;
use crate::workbench::keymap::{BINDINGS, Mode};
use crate::workbench::lab::Lab;
use crate::workbench::readouts::Readouts;
use crate::workbench::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Columns without which a title is none: the clock goes first then.
const LEAST_TITLE: u16 = 12;
/// Between two remarks.
const SEPARATOR: &str = " · ";

/// Title and scheme on the left, as much as fits; time, step and pace on the right, in fixed columns.
pub fn title(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let motion = lab.run().simulation().motion();
    let clock = clock(lab.readouts(), motion.time_step_s);
    let clock_x = area
        .width
        .checked_sub(clock.chars().count() as u16)
        .filter(|&x| x >= LEAST_TITLE);
    let left = Rect {
        width: clock_x.unwrap_or(area.width),
        ..area
    };
    let mut x = write(
        left,
        (1, 0),
        &lab.run().scenario().file.title,
        theme.style(Role::Heading),
        buf,
    );
    let details = [
        format!(" · {} scheme", motion.scheme.name),
        format!(" · dt {} s", motion.time_step_s),
    ];
    for detail in details {
        if x as usize + detail.chars().count() < left.width as usize {
            x = write(left, (x, 0), &detail, theme.style(Role::Quiet), buf);
        }
    }
    if let Some(x) = clock_x {
        write(area, (x, 0), &clock, theme.style(Role::Text), buf);
    }
}

fn clock(readouts: &Readouts, time_step_s: f64) -> String {
    let digits = (-time_step_s.log10()).ceil().clamp(0.0, 6.0) as usize;
    let sample = &readouts.sample;
    format!(
        "t {:>8.digits$} s  step {:<8} {:<11}",
        sample.time_s, sample.step, readouts.pace
    )
}

/// What the time step makes of the numbers, in words: at length if all of it fits, else in short, as much as fits.
pub fn health(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let remarks = remarks(&lab.readouts().health, lab.advice());
    let length = |text: &String| text.chars().count() + SEPARATOR.chars().count();
    let whole: usize = remarks.iter().map(|remark| length(&remark.long)).sum();
    let mut x = 1;
    for remark in &remarks {
        let text = if whole <= area.width as usize {
            &remark.long
        } else {
            &remark.short
        };
        if x > 1 && x as usize + length(text) > area.width as usize {
            return;
        }
        if x > 1 {
            x = write(area, (x, 0), SEPARATOR, theme.style(Role::Quiet), buf);
        }
        let role = if remark.warns {
            Role::Warning
        } else {
            Role::Text
        };
        x = write(area, (x, 0), text, theme.style(role), buf);
    }
}

/// What is to be said now; else what there is to see; on a small screen, that there would be more.
pub fn hint(lab: &Lab, is_cramped: bool, area: Rect, buf: &mut Buffer) {
    let cramped = format!(
        "{}x{}: 80x24 shows all panes; Tab goes through them",
        lab.size().width,
        lab.size().height
    );
    let (text, role) = match (lab.count(), lab.notice(), is_cramped) {
        (Some(count), ..) => (
            format!("{count}: now the key, such as . for that many steps; Esc forgets it"),
            Role::Focus,
        ),
        (_, Some(notice), _) => (notice, Role::Focus),
        (_, _, true) => (cramped, Role::Quiet),
        (_, _, false) => (lab.note().to_owned(), Role::Text),
    };
    let style = lab.view().theme.style(role);
    for (line, y) in wrapped(&text, area.width.saturating_sub(2) as usize)
        .iter()
        .zip(0..area.height)
    {
        write(area, (1, y), line, style, buf);
    }
}

/// The keys of the mode, as many as fit; help and quit always.
pub fn keys(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let mut x = 1;
    for (key, word) in footer(lab.mode(), lab.playback().is_running(), area.width as usize) {
        x = write(area, (x, 0), &key, theme.style(Role::Focus), buf);
        x = write(area, (x + 1, 0), word, theme.style(Role::Quiet), buf) + 2;
    }
}

fn footer(mode: Mode, is_running: bool, width: usize) -> Vec<(String, &'static str)> {
    let rows = BINDINGS
        .iter()
        .filter(|row| row.modes.contains(&mode) && !row.footer.is_empty());
    let mut words: Vec<_> = rows
        .map(|row| {
            let word = if row.footer == "pause" && !is_running {
                "go on"
            } else {
                row.footer
            };
            (row.keys[0].to_string(), word)
        })
        .collect();
    if mode != Mode::Lab {
        words.insert(0, ("Esc".to_owned(), "close"));
    }
    let length = |words: &[(String, &str)]| {
        words
            .iter()
            .map(|(key, word)| key.len() + word.len() + 3)
            .sum::<usize>()
    };
    while words.len() > 2 && length(&words) > width {
        words.remove(words.len() - 3); // the last two are help and quit
    }
    words
}
