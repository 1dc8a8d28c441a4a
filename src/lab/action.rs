//! Actions: the effects of keys that are not commands. An action moves the focus or a selection, opens or closes a
//! window, types, or quits.
//!
//! The table of keys in `tui` maps keys to actions and commands.

use super::view::Pane;

/// Factor by which Shift multiplies an arrow key.
pub const SHIFT_FACTOR: i32 = 10;
/// Rows that a page key moves.
pub(super) const PAGE_KEY_ROWS: isize = 10;
/// Maximum count of a key. More repetitions would make no difference on the screen.
const MOST_REPEATED: u64 = 1000;

/// An action of the user. [`Lab::update`](crate::lab::Lab::update) carries it out.
#[derive(Clone, Copy, Debug)]
pub enum Action {
    /// Pauses or resumes the run or a script.
    TogglePause,
    /// Goes to the step of the count. Without a count, asks for a step or a time.
    GoTo,
    /// Moves the focus to the values of the next push.
    ChoosePush,
    /// Moves the focus to the values of the scenario.
    Parameters,
    /// Asks for a new value of the selected row.
    Edit,
    Ask(Ask),
    Digit(u8),
    NextPane,
    PreviousPane,
    /// Shows this pane, which is shown on request only, and moves the focus there; or hides it.
    Toggle(Pane),
    /// Moves the focus to the 3-D view, or from there to the path from above.
    ThreeD,
    /// Goes to the first step at which the rows of the user's own program differ from the run, and opens the step pane.
    ToDifference,
    /// Moves a selection, or nudges the selected value. The number multiplies the distance of one press.
    ///
    /// In panes where arrows are commands, the pane's row in `tui` says which.
    Move(Direction, i32),
    /// Goes to the step at the cursor. Without a cursor, moves the focus to the values.
    GoToCursor,
    Browse,
    /// Moves the focus to the values and starts a filter: only values whose name contains the typed text are listed.
    FindValue,
    /// Carries out the entry that is selected in the help. The entries belong to `tui`, which does this.
    DoEntry,
    Choose,
    /// Edits the typed text: the field of a dialog, a filter, or the search of the help.
    InField(FieldEdit),
    /// Applies the dialog.
    Accept,
    /// Opens or closes the help, which lists keys and words.
    Help,
    /// Closes a popup, or stops what is running.
    Close,
    Lesson(LessonKey),
    /// In a class: opens the teacher's menu, or leaves or rejoins the presentation.
    Class,
    Redraw,
    /// Suspends the program until the shell resumes it.
    Suspend,
    Quit,
}

impl Action {
    /// Returns true if nudges of a value before and after this action are one edit, which a single undo restores.
    pub(super) fn keeps_nudge(self) -> bool {
        matches!(self, Self::Move(..) | Self::Digit(_))
    }
}

/// A request that the lab passes to the modules above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LabRequest {
    /// Carry out a lesson key.
    Lesson(LessonKey),
    /// Use this number as the answer to the latest question of the lesson.
    Answer(f64),
    /// Carry out the key of the class.
    Class,
    Redraw,
    /// Suspend the program until the shell resumes it.
    Suspend,
    Quit,
}

/// The purpose of a dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A step or a time to go to.
    Place,
    /// A new value of the selected row.
    Value,
    Export,
    Figure,
    RunFile,
    /// A file in which to save the present state as a scenario.
    Present,
    Settings,
}

/// An action on the lesson. The module above the lab carries it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LessonKey {
    /// Opens the list of lessons, or closes it.
    List,
    /// Closes the list of lessons. On a page, says how to leave the lesson.
    Leave,
    Next,
    Before,
    /// Restarts the page, with its run.
    Again,
    ShowTask,
    /// Shows or hides the teacher's notes, the next page and a clock.
    Notes,
    /// Selects the answer above or below, or scrolls.
    Move(Direction),
    /// Selects the listed lesson with this index.
    Select(usize),
    /// Changes the text that filters the list of lessons.
    Filter(FieldEdit),
    /// Submits the selected answer, asks for a number, or opens the selected lesson.
    Take,
    /// Selects the answer with this number, or asks for a number that begins with this digit.
    Digit(u8),
    /// Asks for a number that begins with this sign or decimal point.
    Sign(char),
}

/// An edit in a field of a dialog or in a line without a cursor. A line without a cursor supports typing, erasing and
/// clearing only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldEdit {
    Type(char),
    Erase,
    Delete,
    Clear,
    Left,
    Right,
    Home,
    End,
    Next,
    Previous,
}

/// The direction of an arrow or page key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Up,
    Down,
    Left,
    Right,
    PageUp,
    PageDown,
    First,
    Last,
}

impl Direction {
    pub fn is_sideways(self) -> bool {
        matches!(self, Self::Left | Self::Right)
    }

    /// Returns the number of rows that the key moves in a list, negative for up. A page key moves by `page`.
    pub fn rows(self, page: isize) -> isize {
        /// A number larger than the length of any list.
        const ALL_ROWS: isize = 1_000_000_000;
        match self {
            Self::First => -ALL_ROWS,
            Self::Last => ALL_ROWS,
            Self::Up | Self::Left => -1,
            Self::Down | Self::Right => 1,
            Self::PageUp => -page,
            Self::PageDown => page,
        }
    }
}

/// Returns `times`, negative for the left.
pub fn signed(direction: Direction, times: i32) -> i32 {
    match direction {
        Direction::Left => -times,
        _ => times,
    }
}

/// Returns how many times to apply a key that was pressed after `count`.
pub fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}
