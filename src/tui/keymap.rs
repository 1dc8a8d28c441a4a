//! The one table of keys: what is pressed, in which mode, which commands or which action it means, and what the footer and
//! the help say of it.

pub use crate::lab::Mode;
use crate::lab::action::{Action, Ask, Direction, FieldEdit, LessonKey, SHIFT_FACTOR, repeated};
use crate::lab::command::{Command, PushChoice, SeekTarget};
use crate::lab::view::Pane;
use crate::lab::{KeyCommands, Lab as TheLab};
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
    pub does: KeyEffect,
    /// What the footer says, empty where it says nothing.
    pub footer: &'static str,
    pub help: &'static str,
    /// Further words by which the help finds it.
    pub search: &'static str,
    /// The group of the help in which a key of the lab is listed.
    pub purpose: &'static str,
    pub worth: FooterPriority,
}

/// What a key does.
#[derive(Clone, Copy, Debug)]
pub enum KeyEffect {
    /// The commands that this function returns for the count that was typed before the key are carried out.
    Commands(fn(&TheLab, Option<u64>) -> KeyCommands),
    Action(Action),
}

/// How long the footer names a key where there is not room for all: the least go first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FooterPriority {
    Spare,
    Useful,
    Kept,
    /// A key of the pane in focus.
    Own,
}

const PLAY: &str = "play";
const LOOK_GROUP: &str = "look";
const CHANGE_GROUP: &str = "change the values";
const PUSH_GROUP: &str = "push";
const KEEP_GROUP: &str = "keep and export";
const OPEN_GROUP: &str = "open another run";
const LEAVE: &str = "help, close, leave";
/// The groups of the keys of the lab, in order.
pub const PURPOSES: [&str; 7] = [
    PLAY,
    LOOK_GROUP,
    CHANGE_GROUP,
    PUSH_GROUP,
    KEEP_GROUP,
    OPEN_GROUP,
    LEAVE,
];

/// The keys that zoom a round picture while it has the focus.
#[rustfmt::skip]
pub const ZOOM_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('z')], zoomed_in, "zoom", "show it larger, around what moves; 3z three notches"),
    does(&[Lab], &[Char('Z')], zoomed_out, "", "show it smaller"),
    does(&[Lab], &[Home], |lab, _| one(lab.view().zoom_to(1.0)?), "", "show the whole of it"),
];

pub fn zoomed_in(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_zoom(repeated(count))?)
}

pub fn zoomed_out(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_zoom(-repeated(count))?)
}

pub fn wider(lab: &TheLab, _: Option<u64>) -> KeyCommands {
    one(lab.view().other_window(true, lab.player())?)
}

pub fn narrower(lab: &TheLab, _: Option<u64>) -> KeyCommands {
    one(lab.view().other_window(false, lab.player())?)
}

/// One time step, or as many as the count says, on with 1 and back with -1.
fn stepped(count: Option<u64>, sign: i64) -> KeyCommands {
    let steps = i64::try_from(count.unwrap_or(1)).unwrap_or(i64::MAX);
    one(match steps {
        0 => Command::Pause,
        steps => Command::Step(sign * steps),
    })
}

fn restarted(lab: &TheLab, _: Option<u64>) -> KeyCommands {
    let run = lab.player().is_running().then_some(Command::Run);
    let start = Command::GoTo(SeekTarget::Start);
    Ok([start].into_iter().chain(run).collect())
}

/// What a key means that means one command.
pub fn one(command: Command) -> KeyCommands {
    Ok(vec![command])
}

/// A key that means an action.
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
        does: KeyEffect::Action(action),
        footer,
        help,
        search: "",
        purpose: LOOK_GROUP,
        worth: FooterPriority::Spare,
    }
}

/// A key that means commands.
pub const fn does(
    modes: &'static [Mode],
    keys: &'static [Key],
    meant: fn(&TheLab, Option<u64>) -> KeyCommands,
    footer: &'static str,
    help: &'static str,
) -> Binding {
    Binding {
        does: KeyEffect::Commands(meant),
        ..row(modes, keys, Action::DoEntry, footer, help)
    }
}

impl Binding {
    const fn to(self, purpose: &'static str) -> Self {
        Self { purpose, ..self }
    }

    const fn worth(self, worth: FooterPriority) -> Self {
        Self { worth, ..self }
    }

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
    row(&[Lab], &[Char(' ')], Action::TogglePause, "pause", "stop the run, or let it go on").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('.')], |_, count| stepped(count, 1), "step", "one time step on; 10. takes ten").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('p')], |_, _| one(Command::Push(PushChoice::default())), "push", "give the push that is chosen, now").found_by("kick force hit").to(PUSH_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('t')], |lab, _| one(Command::Exact(!lab.player().run().shows_exact())), "exact", "the exact motion beside the run, and how far apart they are").found_by("compare truth true overlay dashed").worth(FooterPriority::Useful),
    row(&[Lab], &[Char('e')], Action::Parameters, "edit", "to the values of the scenario: Up, Down choose, Left, Right nudge").found_by("parameters dt time step scheme mass gravity friction change").to(CHANGE_GROUP).worth(FooterPriority::Useful),
    row(&[Lab], &[Enter], Action::Edit, "", "type the value that is selected").to(CHANGE_GROUP),
    row(&[Lab], &[Char('x')], Action::Ask(Ask::Export), "export", "write the run up to here as CSV").to(KEEP_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('f')], |lab, _| one(lab.view().fill_toggled()), "fill", "fill the screen with the pane, or show all panes again").worth(FooterPriority::Useful),
    row(&[Lab], &[Char('o')], Action::Browse, "open", "open a preset or a file").to(OPEN_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char(',')], |_, count| stepped(count, -1), "back", "one time step back; 10, goes ten").to(PLAY),
    does(&[Lab], &[Char('+'), Char('='), PageUp], |lab, count| one(lab.player().other_speed(repeated(count))?), "faster", "play faster").found_by("speed").to(PLAY),
    does(&[Lab], &[Char('-'), PageDown], |lab, count| one(lab.player().other_speed(-repeated(count))?), "slower", "play slower; the time step stays as it is").found_by("speed").to(PLAY),
    row(&[Lab], &[Char('g')], Action::GoTo, "go to", "go to a step or a time; 400g goes to step 400").to(PLAY),
    does(&[Lab], &[Char('r')], restarted, "restart", "back to step 0; what was done stays").to(PLAY),
    row(&[Lab], &[Char('P')], Action::ChoosePush, "", "choose the push: point, force, direction, length").to(PUSH_GROUP),
    does(&[Lab], &[Char('u')], |_, count| one(Command::Undo(repeated(count).unsigned_abs())), "undo", "take back what was done last").to(CHANGE_GROUP),
    does(&[Lab], &[Char('U'), Ctrl('r')], |_, count| one(Command::Redo(repeated(count).unsigned_abs())), "", "do it again").to(CHANGE_GROUP),
    does(&[Lab], &[Char('m')], |lab, _| one(Command::look("residuals", !lab.view().look.residuals)), "residuals", "residuals: measured data less the run, or both again; --measured FILE puts data beside a run").worth(FooterPriority::Kept),
    does(&[Lab], &[Char('i')], |lab, _| one(Command::Pin(!lab.comparison().is_pinned())), "", "pin this run as the reference beside every other, or take it away").found_by("compare keep"),
    does(&[Lab], &[Char('a')], |lab, _| one(lab.adviser().followed(lab.player())?), "", "take the advice about the numbers: the run from the start with what mends them"),
    row(&[Lab], &[Char('X')], Action::Ask(Ask::Figure), "", "figure of the run up to here (a plot, a graph): SVG, PDF or PNG").found_by("screenshot picture image").to(KEEP_GROUP),
    row(&[Lab], &[Char('s')], Action::Ask(Ask::RunFile), "", "save the run file: scenario and all that was done").to(KEEP_GROUP),
    row(&[Lab], &[Char('S')], Action::Ask(Ask::Present), "", "save the present state as a scenario").to(KEEP_GROUP),
    row(&[Lab], &[Char('L')], Action::Lesson(LessonKey::List), "lessons", "the list of lessons; again: back to where one was"),
    row(&[Lab], &[Char('k')], Action::Class, "", "in a class: the teacher's acts; for a student: step aside, and back"),
    row(&[Lab], &[Tab], Action::NextPane, "pane", "the next pane"),
    row(&[Lab], &[BackTab], Action::PreviousPane, "", "the pane before"),
    does(&[Lab], &[Char('d')], |lab, _| Ok(lab.view().three_d_toggled()), "3-D", "fill the screen with the 3-D view, or show all panes again"),
    row(&[Lab], &[Char('v')], Action::Toggle(Pane::Step), "", "one time step, phase by phase, with its numbers; v takes it away again"),
    row(&[Lab], &[Char('M')], Action::ToDifference, "", "to the first step at which the rows of your own program differ, with its numbers (--measured mine.csv)").found_by("own code verify slip mistake"),
    row(&[Lab], &[Char('c')], Action::Ask(Ask::Settings), "settings", "settings: colours, dots, frames a second, the mouse, a bare screen, what is hidden").found_by("colors theme light dark background markers braille ascii fps health"),
    row(&[Lab], &[Char('/')], Action::FindValue, "", "find a value of the scenario by a part of its name").to(CHANGE_GROUP),
    row(&[Lab, Browser, Filter, Find, Help], &[Up], Action::Move(Direction::Up, 1), "", "up: in lists and values; in 3-D the camera").to(CHANGE_GROUP),
    row(&[Lab, Browser, Filter, Find, Help], &[Down], Action::Move(Direction::Down, 1), "", "down").to(CHANGE_GROUP),
    row(&[Lab], &[Left], Action::Move(Direction::Left, 1), "", "values: nudge down; 3-D: turn the camera left").to(CHANGE_GROUP),
    row(&[Lab], &[Right], Action::Move(Direction::Right, 1), "", "values: nudge up; 3-D: turn the camera right").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftLeft], Action::Move(Direction::Left, SHIFT_FACTOR), "", "the same ten times; a count does it too: 10 Left").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftRight], Action::Move(Direction::Right, SHIFT_FACTOR), "", "the same ten times").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftUp], Action::Move(Direction::Up, SHIFT_FACTOR), "", "ten lines up").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftDown], Action::Move(Direction::Down, SHIFT_FACTOR), "", "ten lines down").to(CHANGE_GROUP),
    row(&[Browser, Filter, Help], &[PageUp], Action::Move(Direction::PageUp, 1), "", "a page up"),
    row(&[Browser, Filter, Help], &[PageDown], Action::Move(Direction::PageDown, 1), "", "a page down"),
    does(&[Lab], &[Char('w')], wider, "", "traces: show twice the time"),
    does(&[Lab], &[Char('W')], narrower, "", "traces: show half the time"),
    row(&[Browser, Filter], &[Enter], Action::Choose, "open", "open what is selected").worth(FooterPriority::Kept),
    row(&[Browser], &[Char('/')], Action::Filter, "filter", "type a part of a name"),
    row(&[Find], &[Left], Action::Move(Direction::Left, 1), "nudge", "nudge the value down"),
    row(&[Find], &[Right], Action::Move(Direction::Right, 1), "", "nudge the value up"),
    row(&[Find], &[Enter], Action::Edit, "type it", "type the value that is found"),
    row(&[Help], &[Enter], Action::DoEntry, "do it", "do the entry that is selected"),
    row(&[Filter, Find, Help, Dialog], &[Backspace, Ctrl('h')], Action::InField(FieldEdit::Erase), "", "take the last character away"),
    row(&[Dialog], &[Enter], Action::Accept, "take it", "take what is typed").worth(FooterPriority::Kept),
    row(&[Dialog], &[Delete, Ctrl('d')], Action::InField(FieldEdit::Delete), "", "take the character at the cursor away"),
    row(&[Filter, Find, Help, Dialog], &[Ctrl('u')], Action::InField(FieldEdit::Clear), "", "take all of it away"),
    row(&[Dialog], &[Left, Ctrl('b')], Action::InField(FieldEdit::Left), "", "the cursor to the left"),
    row(&[Dialog], &[Right, Ctrl('f')], Action::InField(FieldEdit::Right), "", "the cursor to the right"),
    row(&[Dialog], &[Home, Ctrl('a')], Action::InField(FieldEdit::Home), "", "to the beginning"),
    row(&[Dialog], &[End, Ctrl('e')], Action::InField(FieldEdit::End), "", "to the end"),
    row(&[Dialog], &[Down, Tab], Action::InField(FieldEdit::Next), "", "the next line"),
    row(&[Dialog], &[Up, BackTab], Action::InField(FieldEdit::Previous), "", "the line before"),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Esc], Action::Close, "", "close what lies on top; first it clears what is searched for").to(LEAVE),
    row(&[Lab, Browser, Help], &[Char('?')], Action::Help, "help", "this list, and away again: type to search it").to(LEAVE).worth(FooterPriority::Kept),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('l')], Action::Redraw, "", "draw the whole screen again").to(LEAVE),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('z')], Action::Suspend, "", "back to the shell; fg returns").to(LEAVE),
    row(&[Lab, Browser], &[Char('q')], Action::Quit, "quit", "leave the lab: exit").to(LEAVE).worth(FooterPriority::Kept),
    row(&[Lab, Browser, Filter, Find, Help, Dialog], &[Ctrl('c')], Action::Quit, "", "leave the lab").to(LEAVE),
];

/// What `key` means in `mode` where the pane in focus adds these `keys`, which come before the others.
pub fn meaning(
    keys: impl IntoIterator<Item = &'static Binding>,
    mode: Mode,
    key: Key,
) -> Option<KeyEffect> {
    let bound = keys
        .into_iter()
        .chain(BINDINGS)
        .find(|row| row.modes.contains(&mode) && row.keys.contains(&key));
    let action = match (bound, mode, key) {
        (Some(row), _, _) => return Some(row.does),
        (None, Lab, Char(digit)) => Action::Digit(digit.to_digit(10)? as u8),
        (None, Filter | Find | Help | Dialog, Char(typed)) => {
            Action::InField(FieldEdit::Type(typed))
        }
        _ => return None,
    };
    Some(KeyEffect::Action(action))
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
