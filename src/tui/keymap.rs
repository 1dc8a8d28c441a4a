//! The one table of keys. A row has the modes of a key, its commands or action, and its text in the footer and the
//! help.

pub use crate::lab::Mode;
use crate::lab::action::{Action, Ask, Direction, FieldEdit, LessonKey, SHIFT_FACTOR, repeated};
use crate::lab::command::{Command, CursorTo, PushChoice, SeekTarget};
use crate::lab::view::Pane;
use crate::lab::{KeyCommands, Lab as TheLab};
use crate::plot::camera::Camera;
use Key::{
    BackTab, Backspace, Char, Ctrl, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp,
    Right, ShiftDown, ShiftLeft, ShiftRight, ShiftUp, Tab, Up,
};
use Mode::{Browser, Dialog, Find, Help, Lab, Lessons};

/// A key of the keyboard, independent of any terminal library.
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

/// A row of the table of keys.
#[derive(Debug)]
pub struct Binding {
    pub modes: &'static [Mode],
    /// Keys with this effect. The footer and the help show the first.
    pub keys: &'static [Key],
    pub does: KeyEffect,
    /// Text in the footer; empty if the footer does not list the key.
    pub footer: &'static str,
    pub help: &'static str,
    /// Further words by which the search in the help finds the row.
    pub search: &'static str,
    /// Group of the help that lists a key of the lab.
    pub purpose: &'static str,
    pub worth: FooterPriority,
}

/// Effect of a key.
#[derive(Clone, Copy, Debug)]
pub enum KeyEffect {
    /// Runs the commands that this function returns. Its second argument is the count typed before the key.
    Commands(fn(&TheLab, Option<u64>) -> KeyCommands),
    Action(Action),
}

/// Priority of a key in the footer. If there is not room for all, the lowest priorities are omitted first.
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
const CHANGE_GROUP: &str = "change values";
const PUSH_GROUP: &str = "push";
const KEEP_GROUP: &str = "save and export";
const OPEN_GROUP: &str = "open another run";
const LEAVE: &str = "help, close, quit";
/// Groups of the lab's keys, in order.
pub const PURPOSES: [&str; 7] = [
    PLAY,
    LOOK_GROUP,
    CHANGE_GROUP,
    PUSH_GROUP,
    KEEP_GROUP,
    OPEN_GROUP,
    LEAVE,
];

/// Keys of the traces while they have the focus.
#[rustfmt::skip]
pub const TRACES_KEYS: &[Binding] = &[
    row(&[Lab], &[Left], Action::Move(Direction::Left, 1), "cursor", "move the cursor left and show its values; Esc removes it"),
    row(&[Lab], &[Right], Action::Move(Direction::Right, 1), "", "move the cursor right"),
    row(&[Lab], &[Enter], Action::GoToCursor, "", "go to the step at the cursor; without a cursor, to the values"),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "magnify the values, as z does"),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "", "magnify the values less"),
];

/// Keys of the path from above while it has the focus.
#[rustfmt::skip]
pub const FROM_ABOVE_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('z')], zoomed_in, "zoom", "zoom in on the moving point; 3z zooms three notches"),
    does(&[Lab], &[Char('Z')], zoomed_out, "", "zoom out"),
    does(&[Lab], &[Home], |lab, _| one(lab.view().zoom_to(1.0)?), "", "show the whole path"),
];

/// Keys of the 3-D view while it has the focus.
#[rustfmt::skip]
pub const THREE_D_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('z')], zoomed_in, "zoom", "zoom in on the wheel; 3z zooms three notches"),
    does(&[Lab], &[Char('Z')], zoomed_out, "", "zoom out"),
    does(&[Lab], &[Home], |lab, _| whole_scene(lab), "", "show the whole scene from the default side"),
];

fn whole_scene(lab: &TheLab) -> KeyCommands {
    let usual = Command::look("camera", Camera::default());
    Ok(vec![lab.view().zoom_to(1.0)?, usual])
}

/// Number of keys, at the beginning of [`STEP_KEYS`], that move through the phases.
pub const PHASE_KEYS: usize = 2;

/// Keys of the values pane while it has the focus.
#[rustfmt::skip]
pub const VALUES_KEYS: &[Binding] = &[
    row(&[Lab], &[Char('/')], Action::FindValue, "find", "find a value by part of its name; Esc shows all again"),
];

/// Keys of the step pane while it has the focus.
#[rustfmt::skip]
pub const STEP_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('.')], |lab, count| lab.step_pane().other_phase(repeated(count), lab.view(), lab.player()), "next phase", "the next phase of the time step; after the last, the next time step"),
    does(&[Lab], &[Char(',')], |lab, count| lab.step_pane().other_phase(-repeated(count), lab.view(), lab.player()), "back", "the previous phase; before the first, the previous time step"),
    row(&[Lab], &[Char('v')], Action::Toggle(Pane::Step), "close", "close the step pane"),
    does(&[Lab], &[Char('y')], |lab, _| Ok(lab.view().why_sideways()), "why sideways", "why the axle goes sideways, not down; y shows the phases again"),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "add up", "add up the table point by point: add a point"),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "remove a point"),
    row(&[Lab], &[PageDown], Action::Move(Direction::PageDown, 1), "", "add ten points"),
    row(&[Lab], &[PageUp], Action::Move(Direction::PageUp, 1), "", "remove ten points"),
];

/// Keys that work while a lesson is open, whichever pane has the focus.
pub const LESSON_KEYS_EVERYWHERE: &[Binding] = LESSON_KEYS.split_at(5).0;

/// Keys of a lesson's page while it has the focus. The first five also work elsewhere.
#[rustfmt::skip]
pub const LESSON_KEYS: &[Binding] = &[
    row(&[Lab], &[Char('n')], Action::Lesson(LessonKey::Next), "next", "the rest of the page, then the next page; while the page's run plays, jump to its end"),
    row(&[Lab], &[Char('N')], Action::Lesson(LessonKey::Before), "", "previous page; its run starts again"),
    row(&[Lab], &[Char('b')], Action::Lesson(LessonKey::Again), "again", "restart the page and its run"),
    row(&[Lab], &[Char('h')], Action::Lesson(LessonKey::ShowTask), "", "a hint for the page's task; press again to see it done"),
    row(&[Lab], &[Ctrl('n')], Action::Lesson(LessonKey::Notes), "", "for teachers: notes, next page and clock"),
    row(&[Lab], &[Enter], Action::Lesson(LessonKey::Take), "answer", "lock the chosen answer; in the list: open the lesson"),
    row(&[Lab], &[Up], Action::Lesson(LessonKey::Move(Direction::Up)), "", "previous answer; without a question, scroll"),
    row(&[Lab], &[Down], Action::Lesson(LessonKey::Move(Direction::Down)), "", "next answer; without a question, scroll"),
    row(&[Lab], &[PageUp], Action::Lesson(LessonKey::Move(Direction::PageUp)), "", "scroll the page up"),
    row(&[Lab], &[PageDown], Action::Lesson(LessonKey::Move(Direction::PageDown)), "", "scroll the page down"),
];

pub fn zoomed_in(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_zoom(repeated(count))?)
}

pub fn zoomed_out(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_zoom(-repeated(count))?)
}

pub fn other_window(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_window(count, lab.player())?)
}

pub fn usual_window(lab: &TheLab, _: Option<u64>) -> KeyCommands {
    Ok(lab.view().usual_window())
}

pub fn magnified(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_magnification(repeated(count)))
}

pub fn magnified_less(lab: &TheLab, count: Option<u64>) -> KeyCommands {
    one(lab.view().other_magnification(-repeated(count)))
}

/// Returns the command for one time step, or for `count` steps: forward if `sign` is 1, back if it is -1.
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

/// Returns when the page stops hiding the answer to its question, or `None` if it hides nothing.
fn hidden_until(lab: &TheLab) -> Option<&'static str> {
    let view = lab.view();
    match view.asked() {
        Some(_) => Some("you have predicted"),
        None => view.hides_answers().then_some("the round is over"),
    }
}

fn exact_toggled(lab: &TheLab) -> KeyCommands {
    if let Some(when) = hidden_until(lab) {
        return Err(format!("the exact motion is hidden until {when}"));
    }
    one(Command::Exact(!lab.player().run().shows_exact()))
}

fn advice_taken(lab: &TheLab) -> KeyCommands {
    if let Some(when) = hidden_until(lab) {
        return Err(format!("the advice is hidden until {when}"));
    }
    one(lab.adviser().followed(lab.player())?)
}

/// Returns `command` as the meaning of a key.
pub fn one(command: Command) -> KeyCommands {
    Ok(vec![command])
}

/// Returns the row of a key that means an action.
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

/// Returns the row of a key that means commands.
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

    /// Returns the row with further `words` by which the help finds it.
    const fn found_by(self, words: &'static str) -> Self {
        Self {
            search: words,
            ..self
        }
    }
}

/// All bindings except digits and typed text, in the order of footer and help.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    row(&[Lab], &[Char(' ')], Action::TogglePause, "pause", "pause or resume the run").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('.')], |_, count| stepped(count, 1), "step", "one time step forward; 10. takes ten").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char(',')], |_, count| stepped(count, -1), "step", "one time step back; 10, takes ten").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('p')], |_, _| one(Command::Push(PushChoice::default())), "push", "apply the chosen push now").found_by("kick force hit").to(PUSH_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('t')], |lab, _| exact_toggled(lab), "exact", "show the exact motion and its distance from the run").found_by("compare truth true overlay dashed").worth(FooterPriority::Useful),
    row(&[Lab], &[Char('e')], Action::Parameters, "edit", "edit the scenario's values: Up, Down select; Left, Right nudge").found_by("parameters dt time step scheme mass gravity friction change").to(CHANGE_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('a')], |lab, _| advice_taken(lab), "fix", "follow the advice: rerun with the time step or scheme that fixes the run"),
    does(&[Lab], &[Char('r')], restarted, "restart", "back to step 0; edits and pushes are kept").to(PLAY),
    does(&[Lab], &[Char('j')], |lab, count| one(lab.view().other_fourth_strip(repeated(count))), "", "traces: fourth strip: tilt, distance from the exact motion, none, or a CSV column").found_by("column strip tilt distance off energy L"),
    does(&[Lab], &[Char('w')], other_window, "window", "traces: a few swings, or the whole run; 20w shows twenty swings"),
    row(&[Lab], &[Char('o')], Action::Browse, "open", "open a preset or a file").to(OPEN_GROUP).worth(FooterPriority::Useful),
    row(&[Lab], &[Char('L')], Action::Lesson(LessonKey::List), "lessons", "list the lessons").worth(FooterPriority::Kept),
    row(&[Lab], &[Char('x')], Action::Ask(Ask::Export), "CSV", "export the run so far as CSV").to(KEEP_GROUP).worth(FooterPriority::Useful),
    row(&[Lab], &[Enter], Action::Edit, "", "edit the selected value").to(CHANGE_GROUP),
    does(&[Lab], &[Char('f')], |lab, _| one(lab.view().fill_toggled()), "", "fill the screen with the pane, or show all panes again").worth(FooterPriority::Useful),
    does(&[Lab], &[Char('+'), Char('='), PageUp], |lab, count| one(lab.player().other_speed(repeated(count))?), "", "play faster").found_by("speed").to(PLAY),
    does(&[Lab], &[Char('-'), PageDown], |lab, count| one(lab.player().other_speed(-repeated(count))?), "", "play slower; the time step does not change").found_by("speed").to(PLAY),
    row(&[Lab], &[Char('g')], Action::GoTo, "", "go to a step or a time; 400g goes to step 400").to(PLAY),
    row(&[Lab], &[Char('P')], Action::ChoosePush, "", "choose the push: point, force, direction, length").to(PUSH_GROUP),
    does(&[Lab], &[Char('u')], |_, count| one(Command::Undo(repeated(count).unsigned_abs())), "", "undo the last change").to(CHANGE_GROUP),
    does(&[Lab], &[Char('U'), Ctrl('r')], |_, count| one(Command::Redo(repeated(count).unsigned_abs())), "", "redo it").to(CHANGE_GROUP),
    does(&[Lab], &[Char('m')], |lab, _| one(Command::look("residuals", !lab.view().look.residuals)), "residuals", "residuals (measured data minus the run), or both; --measured FILE loads data").worth(FooterPriority::Kept),
    does(&[Lab], &[Char('i')], |lab, _| one(Command::Pin(!lab.comparison().is_pinned())), "", "pin this run as the reference for later runs, or unpin it").found_by("compare keep"),
    row(&[Lab], &[Char('X')], Action::Ask(Ask::Figure), "", "export a figure of the run so far (plot, graph): SVG, PDF or PNG").found_by("screenshot picture image").to(KEEP_GROUP),
    row(&[Lab], &[Char('s')], Action::Ask(Ask::RunFile), "", "save the run file: the scenario with all edits and pushes").to(KEEP_GROUP),
    row(&[Lab], &[Char('S')], Action::Ask(Ask::Present), "", "save the present state as a scenario").to(KEEP_GROUP),
    row(&[Lab], &[Char('k')], Action::Class, "", "in a class: the teacher's menu; for a student: leave or rejoin"),
    row(&[Lab, Lessons], &[Tab], Action::NextPane, "", "next pane"),
    row(&[Lab, Lessons], &[BackTab], Action::PreviousPane, "", "previous pane"),
    row(&[Lab], &[Char('d')], Action::ThreeD, "", "the 3-D view, or the path from above"),
    row(&[Lab], &[Char('v')], Action::Toggle(Pane::Step), "", "show one time step phase by phase with its numbers, or close it"),
    does(&[Lab], &[Char('y')], |lab, _| Ok(lab.view().why_sideways()), "", "why the axle goes sideways, not down, in the numbers of one time step"),
    row(&[Lab], &[Char('M')], Action::ToDifference, "", "go to the first step at which your own program's rows differ (--measured mine.csv)").found_by("own code verify slip mistake"),
    row(&[Lab], &[Char('c')], Action::Ask(Ask::Settings), "", "settings: markers, colors, frames per second, mouse, bare screen, hidden parts").found_by("colors theme light dark background markers braille ascii fps health"),
    row(&[Lab], &[Char('/')], Action::FindValue, "", "find a value of the scenario by part of its name").to(CHANGE_GROUP),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "values: previous value; 3-D: turn the camera up").to(CHANGE_GROUP),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "", "values: next value; 3-D: turn the camera down").to(CHANGE_GROUP),
    row(&[Lab], &[Left], Action::Move(Direction::Left, 1), "", "values: nudge down; 3-D: turn the camera left").to(CHANGE_GROUP),
    row(&[Lab], &[Right], Action::Move(Direction::Right, 1), "", "values: nudge up; 3-D: turn the camera right").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftLeft], Action::Move(Direction::Left, SHIFT_FACTOR), "", "Left ten times; a count works too: 10 Left").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftRight], Action::Move(Direction::Right, SHIFT_FACTOR), "", "Right ten times").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftUp], Action::Move(Direction::Up, SHIFT_FACTOR), "", "ten rows up").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftDown], Action::Move(Direction::Down, SHIFT_FACTOR), "", "ten rows down").to(CHANGE_GROUP),
    does(&[Lab], &[Char('<')], |lab, count| one(lab.view().stepped_cursor(-i64::from(repeated(count)), lab.player())), "", "move the cursor one step left; 10< moves it ten"),
    does(&[Lab], &[Char('>')], |lab, count| one(lab.view().stepped_cursor(repeated(count).into(), lab.player())), "", "move the cursor one step right"),
    does(&[Lab], &[Char('(')], |_, _| one(Command::Cursor(CursorTo::TurnBefore)), "", "move the cursor to the previous turn of the tilt"),
    does(&[Lab], &[Char(')')], |_, _| one(Command::Cursor(CursorTo::NextTurn)), "", "move the cursor to the next turn of the tilt"),
    does(&[Lab], &[Char('|')], |_, _| one(Command::Cursor(CursorTo::Mark)), "", "mark the turn at the cursor; at another turn, count the swings: period, mean, theory"),
    does(&[Lab], &[Char('W')], usual_window, "", "traces: the default window at the run's time"),
    does(&[Lab], &[Char('[')], |lab, count| one(lab.view().panned(-repeated(count))), "", "traces: show earlier times"),
    does(&[Lab], &[Char(']')], |lab, count| one(lab.view().panned(repeated(count))), "", "traces: show later times"),
    does(&[Lab], &[Char('z')], magnified, "", "traces: magnify the values twofold"),
    does(&[Lab], &[Char('Z')], magnified_less, "", "traces: magnify the values less"),
    row(&[Browser], &[Enter], Action::Choose, "open", "open the selected row").worth(FooterPriority::Kept),
    row(&[Browser, Find, Help], &[Up, Ctrl('p')], Action::Move(Direction::Up, 1), "", "previous row"),
    row(&[Browser, Find, Help], &[Down, Ctrl('n')], Action::Move(Direction::Down, 1), "", "next row"),
    row(&[Browser, Find, Help], &[Home], Action::Move(Direction::First, 1), "", "first row"),
    row(&[Browser, Find, Help], &[End], Action::Move(Direction::Last, 1), "", "last row"),
    row(&[Browser, Find, Help], &[PageUp], Action::Move(Direction::PageUp, 1), "", "a page up"),
    row(&[Browser, Find, Help], &[PageDown], Action::Move(Direction::PageDown, 1), "", "a page down"),
    row(&[Lessons], &[Enter], Action::Lesson(LessonKey::Take), "open", "open the selected lesson where it was left").worth(FooterPriority::Kept),
    row(&[Lessons], &[Up, Ctrl('p')], Action::Lesson(LessonKey::Move(Direction::Up)), "", "previous lesson"),
    row(&[Lessons], &[Down, Ctrl('n')], Action::Lesson(LessonKey::Move(Direction::Down)), "", "next lesson"),
    row(&[Lessons], &[Home], Action::Lesson(LessonKey::Move(Direction::First)), "", "first lesson"),
    row(&[Lessons], &[End], Action::Lesson(LessonKey::Move(Direction::Last)), "", "last lesson"),
    row(&[Lessons], &[PageUp], Action::Lesson(LessonKey::Move(Direction::PageUp)), "", "ten lessons up"),
    row(&[Lessons], &[PageDown], Action::Lesson(LessonKey::Move(Direction::PageDown)), "", "ten lessons down"),
    row(&[Lessons], &[Backspace, Ctrl('h')], Action::Lesson(LessonKey::Filter(FieldEdit::Erase)), "", "erase the last character of the filter"),
    row(&[Lessons], &[Ctrl('u')], Action::Lesson(LessonKey::Filter(FieldEdit::Clear)), "", "clear the filter"),
    row(&[Find], &[Left], Action::Move(Direction::Left, 1), "nudge", "nudge the value down"),
    row(&[Find], &[Right], Action::Move(Direction::Right, 1), "", "nudge the value up"),
    row(&[Find], &[Enter], Action::Edit, "type it", "edit the value found"),
    row(&[Help], &[Enter], Action::DoEntry, "do it", "carry out the selected entry"),
    row(&[Browser, Find, Help, Dialog], &[Backspace, Ctrl('h')], Action::InField(FieldEdit::Erase), "", "erase the character before the cursor"),
    row(&[Dialog], &[Enter], Action::Accept, "apply", "apply; in the settings, change the selected one").worth(FooterPriority::Kept),
    row(&[Dialog], &[Delete, Ctrl('d')], Action::InField(FieldEdit::Delete), "", "erase the character at the cursor"),
    row(&[Browser, Find, Help, Dialog], &[Ctrl('u')], Action::InField(FieldEdit::Clear), "", "clear the text"),
    row(&[Dialog], &[Left, Ctrl('b')], Action::InField(FieldEdit::Left), "", "move the cursor left"),
    row(&[Dialog], &[Right, Ctrl('f')], Action::InField(FieldEdit::Right), "", "move the cursor right"),
    row(&[Dialog], &[Home, Ctrl('a')], Action::InField(FieldEdit::Home), "", "to the beginning"),
    row(&[Dialog], &[End, Ctrl('e')], Action::InField(FieldEdit::End), "", "to the end"),
    row(&[Dialog], &[Tab, Down, Ctrl('n')], Action::InField(FieldEdit::Next), "", "next field; in the field of a value: change from now on, or from the start"),
    row(&[Dialog], &[BackTab, Up, Ctrl('p')], Action::InField(FieldEdit::Previous), "", "previous field"),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Esc], Action::Close, "", "close the top window; in a filtered list, clear the filter first").to(LEAVE),
    row(&[Lab, Help], &[Char('?')], Action::Help, "help", "open or close this list; type to search it").to(LEAVE).worth(FooterPriority::Kept),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('l')], Action::Redraw, "", "draw the whole screen again").to(LEAVE),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('z')], Action::Suspend, "", "suspend to the shell; fg returns").to(LEAVE),
    row(&[Lab], &[Char('q')], Action::Quit, "quit", "quit the lab: exit").to(LEAVE),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('c')], Action::Quit, "", "quit the lab").to(LEAVE),
];

/// Returns the effect of `key` in `mode`. The `keys` of the pane in focus have priority over [`BINDINGS`].
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
        (None, Browser | Find | Help | Dialog, Char(typed)) => {
            Action::InField(FieldEdit::Type(typed))
        }
        (None, Lessons, Char(typed)) => Action::Lesson(LessonKey::Filter(FieldEdit::Type(typed))),
        _ => return None,
    };
    Some(KeyEffect::Action(action))
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
    fn rows_are_complete_and_keys_are_unique_per_mode() {
        for row in BINDINGS {
            let is_bound = !row.keys.is_empty() && !row.modes.is_empty();
            assert!(is_bound && !row.help.is_empty(), "{row:?}");
        }
        for mode in [Lab, Browser, Lessons, Find, Help, Dialog] {
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
