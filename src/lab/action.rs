//! What a key does that stands for no command: it moves the focus or a selection, opens or closes, types, or leaves. The
//! table of keys in `tui` says which key stands for which action, and which for commands.

use super::view::Pane;

/// The factor of the arrows with Shift.
pub const SHIFT_FACTOR: i32 = 10;
/// Rows that a page key moves by.
pub(super) const PAGE_KEY_ROWS: isize = 10;
/// The most times that a key is repeated; more repetitions would make no difference on the screen.
const MOST_REPEATED: u64 = 1000;

/// An action of the user; [`Lab::update`](crate::lab::Lab::update) carries it out.
#[derive(Clone, Copy, Debug)]
pub enum Action {
    /// Pauses the run, or lets it go on; pauses a script.
    TogglePause,
    /// Goes to the step of the count; without one, asks for a step or a time to go to.
    GoTo,
    /// Moves the focus to the values of the push to come.
    ChoosePush,
    /// Moves the focus to the values of the scenario.
    Parameters,
    /// Asks for a new value of the selected line.
    Edit,
    Ask(Ask),
    Digit(u8),
    NextPane,
    PreviousPane,
    /// Shows this pane, one that is shown on request, beside another one and moves the focus there, or takes it away.
    Toggle(Pane),
    /// Moves the focus to the 3-D view, or from there to the path from above.
    ThreeD,
    /// Goes to the first step at which rows of the user's own program differ from the run, with the step pane.
    ToDifference,
    /// Moves a selection, or nudges the selected value. Where arrows mean a command in a pane, its row in `tui` says which. So many times as far as one press.
    Move(Direction, i32),
    /// Goes to the step at the cursor; without one, moves the focus to the values.
    GoToCursor,
    Browse,
    /// Turns to the values and begins to type a part of a name: only values with it in their names are listed.
    FindValue,
    /// Does the entry that is selected in the help; `tui`, which has the entries, carries it out.
    DoEntry,
    Choose,
    /// Changes what is typed: the field of a dialog, a filter, or the search of the help.
    InField(FieldEdit),
    /// Accepts what is typed into the dialog.
    Accept,
    /// Opens or closes the help: the list of keys and words.
    Help,
    /// Closes a popup, or stops what is in progress.
    Close,
    Lesson(LessonKey),
    /// The class: the teacher's acts, or stepping aside and coming back.
    Class,
    Redraw,
    /// Suspends the program until the shell resumes it.
    Suspend,
    Quit,
}

impl Action {
    /// Returns whether the nudges of a value before and after it are one act: one undo takes back both.
    pub(super) fn keeps_nudge(self) -> bool {
        matches!(self, Self::Move(..) | Self::Digit(_))
    }
}

/// What the lab leaves to the rooms above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LabRequest {
    /// Do in the lesson what a key stands for.
    Lesson(LessonKey),
    /// Take this number as the answer to the question of the lesson that was asked last.
    Answer(f64),
    /// Do in the class what its key stands for.
    Class,
    Redraw,
    /// Suspend the program until the shell resumes it.
    Suspend,
    Quit,
}

/// What a dialog asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A step or a time to go to.
    Place,
    /// A new value of the selected line.
    Value,
    Export,
    Figure,
    RunFile,
    /// Where to save the present state as a scenario.
    Present,
    Settings,
}

/// What a key does in the lesson. The room above the lab does it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LessonKey {
    /// Opens the list of lessons, or closes it.
    List,
    /// Closes the list of lessons; on a page it says how to leave.
    Leave,
    Next,
    Before,
    /// Begins the page again: the run as the page wants it.
    Again,
    ShowTask,
    /// Shows or hides the notes for the teacher, the next page and a clock.
    Notes,
    /// Selects the answer above or below, or scrolls.
    Move(Direction),
    /// Selects the lesson of this number among those that are listed.
    Select(usize),
    /// Changes the text that filters the list of lessons.
    Filter(FieldEdit),
    /// Gives the selected answer, asks for a number, or opens the selected lesson.
    Take,
    /// Marks the answer of this number, or asks for a number that begins with this digit.
    Digit(u8),
    /// Asks for a number that begins with this sign or decimal point.
    Sign(char),
}

/// A change in the field of a dialog, or in a line without a cursor: there something can be typed, erased and cleared.
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

    /// Rows by which a key moves in a list; a page key moves by `page`.
    pub fn rows(self, page: isize) -> isize {
        /// More rows than any list has.
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

/// `times` to the right, or as many to the left.
pub fn signed(direction: Direction, times: i32) -> i32 {
    match direction {
        Direction::Left => -times,
        _ => times,
    }
}

/// Returns how often a key acts that was pressed after this count.
pub fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}
