//! Every key of the table in every pane, on screens of four sizes. Each pane keeps its rule, nothing is drawn between
//! panes, and no message is cut within a word.

use crate::support::stage::Stage;
use gyrolab::lab::Mode;
use gyrolab::lab::view::Pane;
use gyrolab::tui::keymap::{BINDINGS, Binding, Key};
use gyrolab::tui::panes::{self, hint};
use gyrolab::tui::screen;
use ratatui::layout::Rect;
use std::time::Duration;

/// Time after which a message has disappeared.
const SAID: Duration = Duration::from_secs(30);

/// The screen as columns of rows.
struct Picture {
    rows: Vec<Vec<char>>,
}

impl Picture {
    fn of(stage: &Stage) -> Self {
        let width = stage.size.width as usize;
        let text = stage.picture();
        let rows: Vec<_> = text
            .lines()
            .map(|line| {
                let mut row: Vec<char> = line.chars().collect();
                assert!(row.len() <= width, "wider than the screen:\n{text}");
                row.resize(width, ' ');
                row
            })
            .collect();
        assert!(rows.len() <= stage.size.height as usize, "{text}");
        Self { rows }
    }

    fn at(&self, x: usize, y: usize) -> char {
        let sign = self.rows.get(y).and_then(|row| row.get(x));
        sign.copied().unwrap_or(' ')
    }

    /// All words, separated by single blanks.
    fn words(&self) -> String {
        let rows = self.rows.iter().map(|row| row.iter().collect::<String>());
        without_blanks(&rows.collect::<Vec<_>>().join(" "))
    }
}

fn without_blanks(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns the first defect in the picture of `stage`, if any.
fn find_defect(stage: &Stage) -> Option<String> {
    let picture = Picture::of(stage);
    let is_ascii = stage.lab.view().marker == gyrolab::lab::view::theme::Marker::Ascii;
    let is_plain = stage.lab.popups().mode == Mode::Lab && !hint::has_message(&stage.lab);
    let mut title = picture.rows.first().into_iter().flatten();
    if is_plain && title.all(|sign| *sign == ' ') {
        return Some("there is no title".to_owned());
    }
    if !is_ascii && is_plain {
        let places = screen::layout(&stage.lab, true, stage.size).panes;
        for (pane, place) in &places {
            let mut rule = place.columns().map(|column| column.x.into());
            if !rule.any(|x| "─━".contains(picture.at(x, place.y.into()))) {
                return Some(format!("{} has no rule", pane.id()));
            }
        }
        for (left, right) in places
            .iter()
            .flat_map(|one| places.iter().map(move |it| (one.1, it.1)))
        {
            let gap = usize::from(left.right());
            let is_beside = usize::from(right.x) == gap + 1;
            let mut rows = left.top().max(right.top())..left.bottom().min(right.bottom());
            if is_beside && let Some(y) = rows.find(|y| picture.at(gap, (*y).into()) != ' ') {
                return Some(format!("something is drawn between panes at {gap}, {y}"));
            }
        }
    }
    find_footer_defect(stage, &picture).or_else(|| find_notice_defect(stage, &picture))
}

/// Returns a message if the last line contains anything but keys of the table and their labels.
fn find_footer_defect(stage: &Stage, picture: &Picture) -> Option<String> {
    if stage.lab.view().look.bare {
        return None; // there is no footer
    }
    let last: String = picture
        .rows
        .get(stage.size.height as usize - 1)?
        .iter()
        .collect();
    let rows = || {
        let of_panes = panes::rows().flat_map(|pane| pane.keys);
        BINDINGS.iter().chain(of_panes)
    };
    let words = |row: &Binding| {
        let otherwise = match row.footer {
            "pause" => "run",
            "next phase" => "next step",
            "why sideways" => "phases",
            "apply" => "change",
            "next" => "more",
            always => always,
        };
        let key = row.keys[0];
        // If there is little room, a key is shown without its label.
        let [usual, other] = [row.footer, otherwise].map(|word| format!("{key} {word}"));
        [usual, other, key.to_string()]
    };
    let esc = ["Esc close", "Esc clear", "Esc to the page"].map(str::to_owned);
    let mut items: Vec<_> = rows().flat_map(words).chain(esc).collect();
    items.sort_by_key(|item| std::cmp::Reverse(item.len()));
    let mut left = last.trim();
    while !left.is_empty() {
        let item = items.iter().find_map(|item| {
            let rest = left.strip_prefix(item.as_str())?;
            (rest.is_empty() || rest.starts_with(' ')).then_some(rest)
        });
        match item {
            Some(rest) => left = rest.trim_start(),
            None => return Some(format!("{left:?} in the line of keys")),
        }
    }
    None
}

/// Returns a message if the notice is neither shown whole nor shortened with dots.
fn find_notice_defect(stage: &Stage, picture: &Picture) -> Option<String> {
    let notice = stage.lab.notice()?;
    let (notice, words) = (without_blanks(&notice), picture.words());
    let is_cut = || {
        let mut begins = notice
            .char_indices()
            .map(|(end, _)| &notice[..end])
            .filter(|begin| begin.len() > 10);
        begins.any(|begin| words.contains(&format!("{}...", begin.trim_end())))
    };
    (!words.contains(&notice) && !is_cut()).then(|| format!("{notice:?} is cut off"))
}

#[track_caller]
fn check(stage: &Stage, done: &str) {
    if let Some(defect) = find_defect(stage) {
        let (size, picture) = (stage.size.as_size(), stage.picture());
        panic!("{done} at {size}: {defect}\n{picture}");
    }
}

/// Opens a lab of the given size with `pane` in focus.
fn stage(pane: Pane, (width, height): (u16, u16)) -> Stage {
    let mut stage = Stage::open("wobble-push", &[], Rect::new(0, 0, width, height));
    stage.wait(0.5).commands("pause = true");
    if pane == Pane::Lesson {
        stage.lesson("is-the-wobble-real", 1);
    }
    focus(&mut stage, pane);
    stage
}

/// Closes all windows and focuses `pane`.
fn focus(stage: &mut Stage, pane: Pane) {
    for _ in 0..4 {
        stage.key(Key::Esc);
    }
    stage.now += SAID;
    stage.wait(0.0);
    for _ in 0..Pane::ALL.len() {
        if stage.focus() == pane.id() {
            return;
        }
        stage.key(Key::Tab);
    }
    if pane == Pane::Lesson {
        stage.lesson("is-the-wobble-real", 1);
        return;
    }
    stage.commands(&format!("show = ['{}']", pane.id()));
    stage.wait(0.0);
}

/// Returns all keys with a meaning in `mode`, including those of `pane` if it has the focus.
fn keys(mode: Mode, pane: Pane) -> Vec<Key> {
    let own = match mode {
        Mode::Lab => panes::row(pane).keys,
        _ => &[],
    };
    let rows = own
        .iter()
        .chain(BINDINGS)
        .filter(|row| row.modes.contains(&mode));
    let mut keys: Vec<Key> = Vec::new();
    for key in rows.flat_map(|row| row.keys) {
        if !keys.contains(key) {
            keys.push(*key);
        }
    }
    keys.push(Key::Char('7'));
    keys
}

#[test]
fn no_key_breaks_the_picture_at_40x12() {
    press_everything((40, 12));
}

#[test]
fn no_key_breaks_the_picture_at_80x24() {
    press_everything((80, 24));
}

#[test]
fn no_key_breaks_the_picture_at_120x40() {
    press_everything((120, 40));
}

#[test]
fn no_key_breaks_the_picture_at_200x50() {
    press_everything((200, 50));
}

/// Presses every key twice or more in every pane.
fn press_everything(size: (u16, u16)) {
    for pane in Pane::ALL {
        let mut stage = stage(pane, size);
        check(&stage, pane.id());
        for key in keys(Mode::Lab, pane) {
            for time in 1..=2 {
                let done = format!("{key} for the {time}. time in {}", pane.id());
                stage.key(key);
                stage.wait(0.0);
                check(&stage, &done);
                let mode = stage.lab.popups().mode;
                if mode != Mode::Lab {
                    if time == 1 {
                        press_all(&mut stage, mode, &done);
                    }
                    focus(&mut stage, pane);
                    continue;
                }
                stage.now += SAID;
                stage.wait(0.0);
                check(&stage, &format!("{done}, a while later"));
            }
            focus(&mut stage, pane);
        }
    }
}

/// Presses all keys of an open window.
fn press_all(stage: &mut Stage, mode: Mode, done: &str) {
    for key in keys(mode, Pane::Traces) {
        if stage.lab.popups().mode != mode {
            return;
        }
        stage.key(key);
        stage.wait(0.0);
        check(stage, &format!("{done}, then {key}"));
    }
}
