//! The actions of the user. The table of keys in `tui` says which key stands for which action.

/// An action of the user; [`Lab::update`](crate::lab::Lab::update) carries it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Pauses the run, or lets it go on; stops a script.
    TogglePause,
    /// One time step forward, or as many as the count says.
    Step,
    /// One time step back, or as many as the count says.
    StepBack,
    /// Asks for a step or a time to go to; with a count, goes to the step of that number.
    GoTo,
    Undo,
    /// Does again what was undone last.
    Redo,
    /// Gives the push to come, now.
    Push,
    /// Begins the run anew as the advice about its numbers says.
    TakeAdvice,
    /// Pins the present run as the reference, or takes the pinned one away.
    TogglePin,
    /// Moves the focus to the values of the push to come.
    ChoosePush,
    /// Moves the focus to the values of the scenario.
    Parameters,
    /// Asks for a new value of the selected line.
    Edit,
    /// Asks where to export the run.
    Export,
    /// Asks where to draw a figure of the run.
    Figure,
    /// Asks where to save the run file.
    SaveRun,
    /// Asks where to save the present state as a scenario.
    SavePresent,
    /// Adds a digit to the count for the next action.
    Digit(u8),
    /// The next higher speed.
    Faster,
    /// The next lower speed.
    Slower,
    /// Goes back to step 0.
    Restart,
    /// Shows the exact motion beside the run, or hides it.
    ToggleExact,
    /// Shows measured data less what the run says, or both again.
    ToggleResiduals,
    /// Moves the focus to the next pane.
    NextPane,
    /// Moves the focus to the pane before.
    PreviousPane,
    /// Fills the screen with the pane in focus, or shows all panes again.
    FillScreen,
    /// Fills the screen with the 3-D view, or shows all panes again.
    ThreeD,
    /// Shows the step pane beside another one, or takes it away.
    ToggleStep,
    /// Goes to the next phase of the time step; after the last takes the next step.
    NextPhase,
    /// Goes to the phase before; before the first goes one step back.
    PhaseBack,
    /// Shows in the step pane why the axle goes sideways, or the phases again.
    Why,
    /// Moves a selection, nudges the selected value, or turns the camera.
    Move(Direction),
    /// As `Move`, ten times.
    MoveFar(Direction),
    /// Doubles the time that the traces show.
    WiderWindow,
    /// Moves the cursor on the traces by one step to the left or right.
    StepCursor(Direction),
    /// Moves it to the next turn of the tilt on that side.
    ToTurn(Direction),
    /// Goes to the step at the cursor.
    GoToCursor,
    /// The traces show earlier or later times.
    Pan(Direction),
    /// The values of the traces are magnified twice as much, or half.
    Magnify(bool),
    /// The traces show the run as at first.
    WholeView,
    /// Halves the time that the traces show.
    NarrowerWindow,
    /// Shows the round picture in focus larger.
    ZoomIn,
    /// Shows the round picture in focus smaller.
    ZoomOut,
    /// Shows the whole of the round picture in focus.
    ZoomToWhole,
    /// Opens the dialog of the settings.
    Settings,
    /// Opens the browser of presets and files.
    Browse,
    /// Turns to the values and begins to type a part of a name: only values with it in their names are listed.
    FindValue,
    /// Does the entry that is selected in the help; `tui`, which has the entries, carries it out.
    DoEntry,
    /// Opens the entry that is selected in the browser.
    Choose,
    /// Begins to type the filter of the browser.
    Filter,
    /// Changes what is typed: the field of a dialog, a filter, or the search of the help.
    InField(FieldEdit),
    /// Accepts what is typed into the dialog.
    Accept,
    /// Opens or closes the help: the list of keys and words.
    Help,
    /// Closes what lies on top, or stops what is in progress.
    Close,
    Lesson(LessonKey),
    /// The class: the teacher's acts, or stepping aside and coming back. The room above the lab does it.
    Class,
    /// Draws the whole screen again.
    Redraw,
    /// Suspends the program until the shell resumes it.
    Suspend,
    /// Ends the program.
    Quit,
}

/// What a key does in the lesson. The room above the lab does it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LessonKey {
    /// Opens the list of lessons, or closes it.
    List,
    /// Closes the list of lessons; on a page it says how to leave.
    Leave,
    /// Turns to the next page.
    Next,
    /// Turns to the page before.
    Before,
    /// Begins the page again: the run as the page wants it.
    Again,
    ShowTask,
    /// Shows or hides the notes for the teacher, the next page and a clock.
    Notes,
    /// Selects the answer above or below, or scrolls.
    Move(Direction),
    /// Gives the selected answer, asks for a number, or opens the selected lesson.
    Take,
}

/// A change in the field of a dialog, or in a line without a cursor: there something can be typed, erased and cleared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldEdit {
    Type(char),
    /// Removes the character before the cursor.
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
}

impl Direction {
    /// Rows by which a key moves in a list; a page key moves by `page`.
    pub fn rows(self, page: isize) -> isize {
        match self {
            Self::Up | Self::Left => -1,
            Self::Down | Self::Right => 1,
            Self::PageUp => -page,
            Self::PageDown => page,
        }
    }
}
