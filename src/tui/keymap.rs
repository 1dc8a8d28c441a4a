//! The one table of keys: the modes in which a key works, the commands or the action that it means, and its text in the
//! footer and the help.

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
const CHANGE_GROUP: &str = "change the values";
const PUSH_GROUP: &str = "push";
const KEEP_GROUP: &str = "keep and export";
const OPEN_GROUP: &str = "open another run";
const LEAVE: &str = "help, close, leave";
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
    row(&[Lab], &[Left], Action::Move(Direction::Left, 1), "cursor", "the cursor to the left: its values are shown; Esc takes it away"),
    row(&[Lab], &[Right], Action::Move(Direction::Right, 1), "", "the cursor to the right"),
    row(&[Lab], &[Enter], Action::GoToCursor, "", "go to the step at the cursor; without one, to the values"),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "magnify the values, as z does"),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "", "magnify them less"),
];

/// Keys of the path from above while it has the focus.
#[rustfmt::skip]
pub const FROM_ABOVE_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('z')], zoomed_in, "zoom", "show it larger, around what moves; 3z three notches"),
    does(&[Lab], &[Char('Z')], zoomed_out, "", "show it smaller"),
    does(&[Lab], &[Home], |lab, _| one(lab.view().zoom_to(1.0)?), "", "show the whole of it"),
];

/// Keys of the 3-D view while it has the focus.
#[rustfmt::skip]
pub const THREE_D_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('z')], zoomed_in, "zoom", "show it larger, around the wheel; 3z three notches"),
    does(&[Lab], &[Char('Z')], zoomed_out, "", "show it smaller"),
    does(&[Lab], &[Home], |lab, _| whole_scene(lab), "", "show the whole of it, from the usual side"),
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
    row(&[Lab], &[Char('/')], Action::FindValue, "find", "find a value by a part of its name; Esc shows all again"),
];

/// Keys of the step pane while it has the focus.
#[rustfmt::skip]
pub const STEP_KEYS: &[Binding] = &[
    does(&[Lab], &[Char('.')], |lab, count| lab.step_pane().other_phase(repeated(count), lab.view(), lab.player()), "next phase", "the next phase of the time step; after the last, the next time step"),
    does(&[Lab], &[Char(',')], |lab, count| lab.step_pane().other_phase(-repeated(count), lab.view(), lab.player()), "back", "the phase before; before the first, the time step before"),
    row(&[Lab], &[Char('v')], Action::Toggle(Pane::Step), "close", "the panes without the time step again"),
    does(&[Lab], &[Char('y')], |lab, _| Ok(lab.view().why_sideways()), "why sideways", "why the axle goes sideways, not down; y shows the phases again"),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "add up", "add up the table point by point: one more"),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "one point fewer"),
    row(&[Lab], &[PageDown], Action::Move(Direction::PageDown, 1), "", "ten points more"),
    row(&[Lab], &[PageUp], Action::Move(Direction::PageUp, 1), "", "ten points fewer"),
];

/// Keys that work while a lesson is open, whichever pane has the focus.
pub const LESSON_KEYS_EVERYWHERE: &[Binding] = LESSON_KEYS.split_at(5).0;

/// Keys of a lesson's page while it has the focus. The first five also work elsewhere.
#[rustfmt::skip]
pub const LESSON_KEYS: &[Binding] = &[
    row(&[Lab], &[Char('n')], Action::Lesson(LessonKey::Next), "next", "the rest of the page, then the next one; while a page's run plays: to its end"),
    row(&[Lab], &[Char('N')], Action::Lesson(LessonKey::Before), "", "the page before; its run begins again"),
    row(&[Lab], &[Char('b')], Action::Lesson(LessonKey::Again), "again", "begin the page again: its run from where the page wants it"),
    row(&[Lab], &[Char('h')], Action::Lesson(LessonKey::ShowTask), "", "a hint for the task of the page; again: show how it is done"),
    row(&[Lab], &[Ctrl('n')], Action::Lesson(LessonKey::Notes), "", "for a class: notes, the next page and a clock"),
    row(&[Lab], &[Enter], Action::Lesson(LessonKey::Take), "answer", "lock the chosen answer; in the list: open the lesson"),
    row(&[Lab], &[Up], Action::Lesson(LessonKey::Move(Direction::Up)), "", "the answer above; without a question: scroll"),
    row(&[Lab], &[Down], Action::Lesson(LessonKey::Move(Direction::Down)), "", "the answer below; without a question: scroll"),
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
        return Err(format!("the exact motion comes back when {when}"));
    }
    one(Command::Exact(!lab.player().run().shows_exact()))
}

fn advice_taken(lab: &TheLab) -> KeyCommands {
    if let Some(when) = hidden_until(lab) {
        return Err(format!("what fixes the run is told when {when}"));
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
    row(&[Lab], &[Char(' ')], Action::TogglePause, "pause", "stop the run, or let it go on").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('.')], |_, count| stepped(count, 1), "step", "one time step on; 10. takes ten").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char(',')], |_, count| stepped(count, -1), "step", "one time step back; 10, goes ten").to(PLAY).worth(FooterPriority::Kept),
    does(&[Lab], &[Char('p')], |_, _| one(Command::Push(PushChoice::default())), "push", "give the push that is chosen, now").found_by("kick force hit").to(PUSH_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('t')], |lab, _| exact_toggled(lab), "exact", "the exact motion beside the run, and how far apart they are").found_by("compare truth true overlay dashed").worth(FooterPriority::Useful),
    row(&[Lab], &[Char('e')], Action::Parameters, "edit", "to the values of the scenario: Up, Down choose, Left, Right nudge").found_by("parameters dt time step scheme mass gravity friction change").to(CHANGE_GROUP).worth(FooterPriority::Useful),
    does(&[Lab], &[Char('a')], |lab, _| advice_taken(lab), "fix", "take the advice: rerun from the start with the time step or scheme that fixes the run"),
    does(&[Lab], &[Char('r')], restarted, "restart", "back to step 0; what was done stays").to(PLAY),
    does(&[Lab], &[Char('j')], |lab, count| one(lab.view().other_fourth_strip(repeated(count))), "", "traces: a fourth strip: tilt, distance from the exact motion, none, or a column of the CSV").found_by("column strip tilt distance off energy L"),
    does(&[Lab], &[Char('w')], other_window, "window", "traces: a few swings, or the whole run; 20w shows twenty swings"),
    row(&[Lab], &[Char('o')], Action::Browse, "open", "open a preset or a file").to(OPEN_GROUP).worth(FooterPriority::Useful),
    row(&[Lab], &[Char('L')], Action::Lesson(LessonKey::List), "lessons", "the list of lessons").worth(FooterPriority::Kept),
    row(&[Lab], &[Char('x')], Action::Ask(Ask::Export), "CSV", "write the run up to here as CSV").to(KEEP_GROUP).worth(FooterPriority::Useful),
    row(&[Lab], &[Enter], Action::Edit, "", "type the value that is selected").to(CHANGE_GROUP),
    does(&[Lab], &[Char('f')], |lab, _| one(lab.view().fill_toggled()), "", "fill the screen with the pane, or show all panes again").worth(FooterPriority::Useful),
    does(&[Lab], &[Char('+'), Char('='), PageUp], |lab, count| one(lab.player().other_speed(repeated(count))?), "", "play faster").found_by("speed").to(PLAY),
    does(&[Lab], &[Char('-'), PageDown], |lab, count| one(lab.player().other_speed(-repeated(count))?), "", "play slower; the time step stays as it is").found_by("speed").to(PLAY),
    row(&[Lab], &[Char('g')], Action::GoTo, "", "go to a step or a time; 400g goes to step 400").to(PLAY),
    row(&[Lab], &[Char('P')], Action::ChoosePush, "", "choose the push: point, force, direction, length").to(PUSH_GROUP),
    does(&[Lab], &[Char('u')], |_, count| one(Command::Undo(repeated(count).unsigned_abs())), "", "take back what was done last").to(CHANGE_GROUP),
    does(&[Lab], &[Char('U'), Ctrl('r')], |_, count| one(Command::Redo(repeated(count).unsigned_abs())), "", "do it again").to(CHANGE_GROUP),
    does(&[Lab], &[Char('m')], |lab, _| one(Command::look("residuals", !lab.view().look.residuals)), "residuals", "residuals: measured data less the run, or both again; --measured FILE puts data beside a run").worth(FooterPriority::Kept),
    does(&[Lab], &[Char('i')], |lab, _| one(Command::Pin(!lab.comparison().is_pinned())), "", "pin this run as the reference beside every other, or take it away").found_by("compare keep"),
    row(&[Lab], &[Char('X')], Action::Ask(Ask::Figure), "", "figure of the run up to here (a plot, a graph): SVG, PDF or PNG").found_by("screenshot picture image").to(KEEP_GROUP),
    row(&[Lab], &[Char('s')], Action::Ask(Ask::RunFile), "", "save the run file: scenario and all that was done").to(KEEP_GROUP),
    row(&[Lab], &[Char('S')], Action::Ask(Ask::Present), "", "save the present state as a scenario").to(KEEP_GROUP),
    row(&[Lab], &[Char('k')], Action::Class, "", "in a class: the teacher's acts; for a student: step aside, and back"),
    row(&[Lab, Lessons], &[Tab], Action::NextPane, "", "the next pane"),
    row(&[Lab, Lessons], &[BackTab], Action::PreviousPane, "", "the pane before"),
    row(&[Lab], &[Char('d')], Action::ThreeD, "", "the 3-D view, or back to the path from above"),
    row(&[Lab], &[Char('v')], Action::Toggle(Pane::Step), "", "one time step, phase by phase, with its numbers; v takes it away again"),
    does(&[Lab], &[Char('y')], |lab, _| Ok(lab.view().why_sideways()), "", "why the axle goes sideways, not down, in the numbers of one time step"),
    row(&[Lab], &[Char('M')], Action::ToDifference, "", "to the first step at which the rows of your own program differ, with its numbers (--measured mine.csv)").found_by("own code verify slip mistake"),
    row(&[Lab], &[Char('c')], Action::Ask(Ask::Settings), "", "settings: markers, colors, frames a second, the mouse, a bare screen, what is hidden").found_by("colors theme light dark background markers braille ascii fps health"),
    row(&[Lab], &[Char('/')], Action::FindValue, "", "find a value of the scenario by a part of its name").to(CHANGE_GROUP),
    row(&[Lab], &[Up], Action::Move(Direction::Up, 1), "", "values: the value above; 3-D: the camera up").to(CHANGE_GROUP),
    row(&[Lab], &[Down], Action::Move(Direction::Down, 1), "", "values: the value below; 3-D: the camera down").to(CHANGE_GROUP),
    row(&[Lab], &[Left], Action::Move(Direction::Left, 1), "", "values: nudge down; 3-D: turn the camera left").to(CHANGE_GROUP),
    row(&[Lab], &[Right], Action::Move(Direction::Right, 1), "", "values: nudge up; 3-D: turn the camera right").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftLeft], Action::Move(Direction::Left, SHIFT_FACTOR), "", "the same ten times; a count does it too: 10 Left").to(CHANGE_GROUP),
    row(&[Lab], &[ShiftRight], Action::Move(Direction::Right, SHIFT_FACTOR), "", "the same ten times").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftUp], Action::Move(Direction::Up, SHIFT_FACTOR), "", "ten rows up").to(CHANGE_GROUP),
    row(&[Lab, Browser, Find, Help], &[ShiftDown], Action::Move(Direction::Down, SHIFT_FACTOR), "", "ten rows down").to(CHANGE_GROUP),
    does(&[Lab], &[Char('<')], |lab, count| one(lab.view().stepped_cursor(-i64::from(repeated(count)), lab.player())), "", "the cursor one step to the left; 10< ten"),
    does(&[Lab], &[Char('>')], |lab, count| one(lab.view().stepped_cursor(repeated(count).into(), lab.player())), "", "the cursor one step to the right"),
    does(&[Lab], &[Char('(')], |_, _| one(Command::Cursor(CursorTo::TurnBefore)), "", "the cursor to the last turn of the tilt before it"),
    does(&[Lab], &[Char(')')], |_, _| one(Command::Cursor(CursorTo::NextTurn)), "", "the cursor to the next turn of the tilt"),
    does(&[Lab], &[Char('|')], |_, _| one(Command::Cursor(CursorTo::Mark)), "", "mark the turn at the cursor; at another turn, count the swings between: period, mean, and theory's"),
    does(&[Lab], &[Char('W')], usual_window, "", "traces: the usual window again, at the run's time"),
    does(&[Lab], &[Char('[')], |lab, count| one(lab.view().panned(-repeated(count))), "", "traces: show earlier times"),
    does(&[Lab], &[Char(']')], |lab, count| one(lab.view().panned(repeated(count))), "", "traces: show later times"),
    does(&[Lab], &[Char('z')], magnified, "", "traces: magnify the values, twice each time"),
    does(&[Lab], &[Char('Z')], magnified_less, "", "traces: magnify the values less"),
    row(&[Browser], &[Enter], Action::Choose, "open", "open the selected row").worth(FooterPriority::Kept),
    row(&[Browser, Find, Help], &[Up, Ctrl('p')], Action::Move(Direction::Up, 1), "", "the row above"),
    row(&[Browser, Find, Help], &[Down, Ctrl('n')], Action::Move(Direction::Down, 1), "", "the row below"),
    row(&[Browser, Find, Help], &[Home], Action::Move(Direction::First, 1), "", "the first row"),
    row(&[Browser, Find, Help], &[End], Action::Move(Direction::Last, 1), "", "the last row"),
    row(&[Browser, Find, Help], &[PageUp], Action::Move(Direction::PageUp, 1), "", "a page up"),
    row(&[Browser, Find, Help], &[PageDown], Action::Move(Direction::PageDown, 1), "", "a page down"),
    row(&[Lessons], &[Enter], Action::Lesson(LessonKey::Take), "open", "open the selected lesson where it was left").worth(FooterPriority::Kept),
    row(&[Lessons], &[Up, Ctrl('p')], Action::Lesson(LessonKey::Move(Direction::Up)), "", "the lesson above"),
    row(&[Lessons], &[Down, Ctrl('n')], Action::Lesson(LessonKey::Move(Direction::Down)), "", "the lesson below"),
    row(&[Lessons], &[Home], Action::Lesson(LessonKey::Move(Direction::First)), "", "the first lesson"),
    row(&[Lessons], &[End], Action::Lesson(LessonKey::Move(Direction::Last)), "", "the last lesson"),
    row(&[Lessons], &[PageUp], Action::Lesson(LessonKey::Move(Direction::PageUp)), "", "ten lessons up"),
    row(&[Lessons], &[PageDown], Action::Lesson(LessonKey::Move(Direction::PageDown)), "", "ten lessons down"),
    row(&[Lessons], &[Backspace, Ctrl('h')], Action::Lesson(LessonKey::Filter(FieldEdit::Erase)), "", "erase the last character of the filter"),
    row(&[Lessons], &[Ctrl('u')], Action::Lesson(LessonKey::Filter(FieldEdit::Clear)), "", "clear the filter"),
    row(&[Find], &[Left], Action::Move(Direction::Left, 1), "nudge", "nudge the value down"),
    row(&[Find], &[Right], Action::Move(Direction::Right, 1), "", "nudge the value up"),
    row(&[Find], &[Enter], Action::Edit, "type it", "type the value that is found"),
    row(&[Help], &[Enter], Action::DoEntry, "do it", "do the entry that is selected"),
    row(&[Browser, Find, Help, Dialog], &[Backspace, Ctrl('h')], Action::InField(FieldEdit::Erase), "", "erase the character before the cursor"),
    row(&[Dialog], &[Enter], Action::Accept, "apply", "apply what is typed; in the settings: change the selected one").worth(FooterPriority::Kept),
    row(&[Dialog], &[Delete, Ctrl('d')], Action::InField(FieldEdit::Delete), "", "erase the character at the cursor"),
    row(&[Browser, Find, Help, Dialog], &[Ctrl('u')], Action::InField(FieldEdit::Clear), "", "erase all of it"),
    row(&[Dialog], &[Left, Ctrl('b')], Action::InField(FieldEdit::Left), "", "the cursor to the left"),
    row(&[Dialog], &[Right, Ctrl('f')], Action::InField(FieldEdit::Right), "", "the cursor to the right"),
    row(&[Dialog], &[Home, Ctrl('a')], Action::InField(FieldEdit::Home), "", "to the beginning"),
    row(&[Dialog], &[End, Ctrl('e')], Action::InField(FieldEdit::End), "", "to the end"),
    row(&[Dialog], &[Tab, Down, Ctrl('n')], Action::InField(FieldEdit::Next), "", "the next field; in the field of a value: from now on, or from the start"),
    row(&[Dialog], &[BackTab, Up, Ctrl('p')], Action::InField(FieldEdit::Previous), "", "the field before"),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Esc], Action::Close, "", "close the top window; of a list that is filtered, clear the filter first").to(LEAVE),
    row(&[Lab, Help], &[Char('?')], Action::Help, "help", "this list, and away again: type to search it").to(LEAVE).worth(FooterPriority::Kept),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('l')], Action::Redraw, "", "draw the whole screen again").to(LEAVE),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('z')], Action::Suspend, "", "back to the shell; fg returns").to(LEAVE),
    row(&[Lab], &[Char('q')], Action::Quit, "quit", "leave the lab: exit").to(LEAVE),
    row(&[Lab, Browser, Lessons, Find, Help, Dialog], &[Ctrl('c')], Action::Quit, "", "leave the lab").to(LEAVE),
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
    fn every_row_is_whole_and_no_key_is_bound_twice_in_a_mode() {
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
