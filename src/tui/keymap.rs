//! The one table of keys: what is pressed, in which mode, what it means, and what the footer and the help say of it.

pub use crate::lab::Mode;
use crate::lab::action::{Action, Direction, FieldEdit, LessonKey};
use Key::{
    BackTab, Backspace, Char, Ctrl, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp,
    Right, ShiftDown, ShiftLeft, ShiftRight, ShiftUp, Tab, Up,
};
use Mode::{Browser, Dialog, Filter, Find, Help, Lab};

/// A key, as no terminal library names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    Char(char),
    Ctrl(char),
    Enter,
    Esc,
    Tab,
    BackTab,
    Backspace,
    Delete,
    Home,
    End,
    Up,
    Down,
    Left,
    Right,
    ShiftUp,
    ShiftDown,
    ShiftLeft,
    ShiftRight,
    PageUp,
    PageDown,
}

#[derive(Debug)]
pub struct Binding {
    pub modes: &'static [Mode],
    /// Which keys; the first is the one that is shown.
    pub keys: &'static [Key],
    pub action: Action,
    /// What the footer says, empty where it says nothing.
    pub footer: &'static str,
    pub help: &'static str,
    /// Further words by which the help finds it.
    pub search: &'static str,
}

/// The keys that zoom a round picture while it has the focus.
#[rustfmt::skip]
pub const ZOOM_KEYS: &[Binding] = &[
    row(&[Lab], &[Char('z')], Action::ZoomIn, "zoom", "show it larger, around what moves; 3z three notches"),
    row(&[Lab], &[Char('Z')], Action::ZoomOut, "", "show it smaller"),
    row(&[Lab], &[Home], Action::ZoomToWhole, "", "show the whole of it"),
];

pub const fn row(
    modes: &'static [Mode],
    keys: &'static [Key],
    action: Action,
    footer: &'static str,
    help: &'static str,
) -> Binding {
    Binding {
        modes,
        keys,
        action,
        footer,
        help,
        search: "",
    }
}

impl Binding {
    /// The row with further `words` by which the help finds it.
    const fn found_by(self, words: &'static str) -> Self {
        Self {
            search: words,
            ..self
        }
    }
}

/// Every binding but digits and typed text, in the order of footer and help.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    row(&[Lab], &[Char(' ')], Action::TogglePause, "pause", "stop the run, or let it go on"),
    row(&[Lab], &[Char('.')], Action::Step, "step", "one time step on; 10. takes ten"),
    row(&[Lab], &[Char('p')], Action::Push, "push", "give the push that is chosen, now").found_by("kick force hit"),
    row(&[Lab], &[Char('t')], Action::ToggleExact, "exact", "the exact motion beside the run, and how far apart they are").found_by("compare truth true overlay dashed"),
    row(&[Lab], &[Char('e')], Action::Parameters, "edit", "to the values of the scenario: Up, Down choose, Left, Right nudge").found_by("parameters dt time step scheme mass gravity friction change"),
    row(&[Lab], &[Enter], Action::Edit, "", "type the value that is selected"),
    row(&[Lab], &[Char('x')], Action::Export, "export", "write the run up to here as CSV"),
    row(&[Lab], &[Char('f')], Action::FillScreen, "fill", "fill the screen with the pane, or show all panes again"),
    row(&[Lab], &[Char('o')], Action::Browse, "open", "open a preset or a file"),
    row(&[Lab], &[Char(',')], Action::StepBack, "back", "one time step back; 10, goes ten"),
    row(&[Lab], &[Char('+'), Char('='), PageUp], Action::Faster, "faster", "play faster").found_by("speed"),
    row(&[Lab], &[Char('-'), PageDown], Action::Slower, "slower", "play slower; the time step stays as it is").found_by("speed"),
    row(&[Lab], &[Char('g')], Action::GoTo, "go to", "go to a step or a time; 400g goes to step 400"),
    row(&[Lab], &[Char('r')], Action::Restart, "restart", "back to step 0; what was done stays"),
    row(&[Lab], &[Char('P')], Action::ChoosePush, "", "choose the push: point, force, direction, length"),
    row(&[Lab], &[Char('u')], Action::Undo, "undo", "take back what was done last"),
    row(&[Lab], &[Char('U'), Ctrl('r')], Action::Redo, "", "do it again"),
    row(&[Lab], &[Char('m')], Action::ToggleResiduals, "residuals", "residuals: measured data less the run, or both again; --measured FILE puts data beside a run"),
    row(&[Lab], &[Char('i')], Action::TogglePin, "", "pin this run as the reference beside every other, or take it away").found_by("compare keep"),
    row(&[Lab], &[Char('a')], Action::TakeAdvice, "", "take the advice about the numbers: the run from the start with what mends them"),
    row(&[Lab], &[Char('X')], Action::Figure, "", "figure of the run up to here (a plot, a graph): SVG, PDF or PNG").found_by("screenshot picture image"),
    row(&[Lab], &[Char('s')], Action::SaveRun, "", "save the run file: scenario and all that was done"),
    row(&[Lab], &[Char('S')], Action::SavePresent, "", "save the present state as a scenario"),
    row(&[Lab], &[Char('L')], Action::Lesson(LessonKey::List), "lessons", "the list of lessons; again: back to where one was"),
    row(&[Lab], &[Char('C')], Action::Class, "", "in a class: the teacher's acts; for a student: step aside, and back"),
    row(&[Lab], &[Tab], Action::NextPane, "pane", "the next pane"),
    row(&[Lab], &[BackTab], Action::PreviousPane, "", "the pane before"),
    row(&[Lab], &[Char('d')], Action::ThreeD, "3-D", "fill the screen with the 3-D view, or show all panes again"),
    row(&[Lab], &[Char('v')], Action::ToggleStep, "", "one time step, phase by phase, with its numbers; v takes it away again"),
    row(&[Lab], &[Char('c')], Action::Settings, "settings", "settings: colours, dots, frames a second, the mouse, a bare screen, what is hidden").found_by("colors theme light dark background markers braille ascii fps health"),
    row(&[Lab], &[Char('/')], Action::FindValue, "", "find a value of the scenario by a part of its name"),
    row(&[Lab, Browser, Filter, Find, Help], &[Up], Action::Move(Direction::Up), "", "up: in lists and values; in 3-D the camera"),
    row(&[Lab, Browser, Filter, Find, Help], &[Down], Action::Move(Direction::Down), "", "down"),
    row(&[Lab], &[Left], Action::Move(Direction::Left), "", "values: nudge down; 3-D: turn the camera left"),
    row(&[Lab], &[Right], Action::Move(Direction::Right), "", "values: nudge up; 3-D: turn the camera right"),
    row(&[Lab], &[ShiftLeft], Action::MoveFar(Direction::Left), "", "the same ten times; a count does it too: 10 Left"),
    row(&[Lab], &[ShiftRight], Action::MoveFar(Direction::Right), "", "the same ten times"),
    row(&[Lab, Browser, Find, Help], &[ShiftUp], Action::MoveFar(Direction::Up), "", "ten lines up"),
    row(&[Lab, Browser, Find, Help], &[ShiftDown], Action::MoveFar(Direction::Down), "", "ten lines down"),
    row(&[Browser, Filter, Help], &[PageUp], Action::Move(Direction::PageUp), "", "a page up"),
    row(&[Browser, Filter, Help], &[PageDown], Action::Move(Direction::PageDown), "", "a page down"),
    row(&[Lab], &[Char('w')], Action::WiderWindow, "", "traces: show twice the time"),
    row(&[Lab], &[Char('W')], Action::NarrowerWindow, "", "traces: show half the time"),
    row(&[Browser, Filter], &[Enter], Action::Choose, "open", "open what is selected"),
    row(&[Browser], &[Char('/')], Action::Filter, "filter", "type a part of a name"),
    row(&[Find], &[Left], Action::Move(Direction::Left), "nudge", "nudge the value down"),
    row(&[Find], &[Right], Action::Move(Direction::Right), "", "nudge the value up"),
    row(&[Find], &[Enter], Action::Edit, "type it", "type the value that is found"),
    row(&[Help], &[Enter], Action::DoEntry, "do it", "do the entry that is selected"),
    row(&[Filter, Find, Help, Dialog], &[Backspace, Ctrl('h')], Action::InField(FieldEdit::Erase), "", "take the last character away"),
    row(&[Dialog], &[Enter], Action::Accept, "take it", "take what is typed"),
    row(&[Dialog], &[Delete, Ctrl('d')], Action::InField(FieldEdit::Delete), "", "take the character at the cursor away"),
    row(&[Filter, Find, Help, Dialog], &[Ctrl('u')], Action::InField(FieldEdit::Clear), "", "take all of it away"),
    row(&[Dialog], &[Left, Ctrl('b')], Action::InField(FieldEdit::Left), "", "the cursor to the left"),
    row(&[Dialog], &[Right, Ctrl('f')], Action::InField(FieldEdit::Right), "", "the cursor to the right"),
    row(&[Dialog], &[Home, Ctrl('a')], Action::InField(FieldEdit::Home), "", "to the beginning"),
    row(&[Dialog], &[End, Ctrl('e')], Action::InField(FieldEdit::End), "", "to the end"),
    row(&[Dialog], &[Down, Tab], Action::InField(FieldEdit::Next), "", "the next line"),
    row(&[Dialog], &[Up, BackTab], Action::InField(FieldEdit::Previous), "", "the line before"),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Esc], Action::Close, "", "close what lies on top; first it clears what is searched for"),
    row(&[Lab, Browser, Help], &[Char('?')], Action::Help, "help", "this list, and away again: type to search it"),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('l')], Action::Redraw, "", "draw the whole screen again"),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('z')], Action::Suspend, "", "back to the shell; fg returns"),
    row(&[Lab, Browser], &[Char('q')], Action::Quit, "quit", "leave the lab: exit"),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('c')], Action::Quit, "", "leave the lab"),
];

/// What `key` means in `mode` where the pane in focus adds these `keys`, which come before the others.
pub fn action(
    keys: impl IntoIterator<Item = &'static Binding>,
    mode: Mode,
    key: Key,
) -> Option<Action> {
    let bound = keys
        .into_iter()
        .chain(BINDINGS)
        .find(|row| row.modes.contains(&mode) && row.keys.contains(&key));
    match (bound, mode, key) {
        (Some(row), _, _) => Some(row.action),
        (None, Lab, Char(digit)) => digit.to_digit(10).map(|digit| Action::Digit(digit as u8)),
        (None, Filter | Find | Help | Dialog, Char(typed)) => {
            Some(Action::InField(FieldEdit::Type(typed)))
        }
        _ => None,
    }
}

/// What is to be said of `key`, which means nothing in `mode`.
pub fn refusal(mode: Mode, key: Key) -> String {
    match (mode, key) {
        (Filter, _) => format!("no key {key} here; Enter opens, Esc clears the filter"),
        (Find, _) => format!("no key {key} here; Enter types the value, Esc shows all values"),
        (Help, _) => format!("no key {key} here; Enter does the entry, Esc closes"),
        (Dialog, _) => format!("no key {key} here; Enter takes what is typed, Esc leaves it"),
        _ => format!("no key {key} here; ? lists them"),
    }
}

impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Char(' ') => f.write_str("space"),
            Char(c) => write!(f, "{c}"),
            Ctrl(c) => write!(f, "Ctrl-{}", c.to_ascii_uppercase()),
            BackTab => f.write_str("Shift-Tab"),
            ShiftUp => f.write_str("Shift-Up"),
            ShiftDown => f.write_str("Shift-Down"),
            ShiftLeft => f.write_str("Shift-Left"),
            ShiftRight => f.write_str("Shift-Right"),
            PageUp => f.write_str("PgUp"),
            PageDown => f.write_str("PgDn"),
            other => write!(f, "{other:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_whole_and_no_key_is_bound_twice_in_a_mode() {
        for row in BINDINGS {
            let is_bound = !row.keys.is_empty() && !row.modes.is_empty();
            assert!(is_bound && !row.help.is_empty(), "{row:?}");
        }
        for mode in [Lab, Browser, Filter, Find, Help, Dialog] {
            let keys: Vec<_> = BINDINGS
                .iter()
                .filter(|row| row.modes.contains(&mode))
                .flat_map(|row| row.keys)
                .collect();
            for (index, key) in keys.iter().enumerate() {
                assert!(!keys[..index].contains(key), "{key} in {mode:?}");
                assert!(!matches!(key, Char('0'..='9')), "{key} is a count");
            }
        }
    }
}
