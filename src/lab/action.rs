//! What the user can want, in words that know no key.

/// An intention; [`Lab::update`](crate::lab::Lab::update) carries it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Stops the run, or lets it go on.
    TogglePause,
    /// One time step on, or as many as have been counted.
    Step,
    /// One time step back, or as many as have been counted.
    StepBack,
    /// Asks for a step or a time to go to; with a count, goes to that step.
    GoTo,
    /// Takes the last thing back that was done.
    Undo,
    /// Brings it again.
    Redo,
    /// Gives the push that is chosen.
    Push,
    /// The focus on the push that is to come.
    ChoosePush,
    /// The focus on the values of the scenario.
    Parameters,
    /// Asks for the value that is selected.
    Edit,
    /// Asks where to export the run.
    Export,
    /// Asks where to save the run file.
    SaveRun,
    /// Asks where to save the present state as a scenario.
    SavePresent,
    /// A digit of the count for the next action.
    Digit(u8),
    /// The next speed up.
    Faster,
    /// The next speed down.
    Slower,
    /// Back to step 0.
    Restart,
    /// Shows the exact motion beside the run, or does not.
    ToggleExact,
    /// The focus on the next pane.
    NextPane,
    /// The focus on the pane before.
    PreviousPane,
    /// The pane in focus fills the screen, or no longer.
    FillScreen,
    /// The 3-D view fills the screen, or no longer.
    ThreeD,
    /// Moves what is in focus, or nudges it.
    Move(Direction),
    /// The same, ten times.
    MoveFar(Direction),
    /// The traces show twice the time.
    WiderWindow,
    /// The traces show half the time.
    NarrowerWindow,
    /// The next kind of dots.
    NextMarker,
    /// With colour, or without.
    ToggleColour,
    /// For a dark screen, or for a light one.
    ToggleBackground,
    /// Opens the browser of presets and files.
    Browse,
    /// Takes what is selected in the browser.
    Choose,
    /// Types a filter for the browser.
    Filter,
    /// A character of it, or of what a dialog asks for.
    Type(char),
    /// Takes the last character away.
    Erase,
    /// Something else in the field of a dialog.
    InField(FieldEdit),
    /// Takes what was typed into a dialog.
    Accept,
    /// The list of keys.
    Help,
    /// Closes what lies on top.
    Close,
    /// Draws the whole screen again.
    Redraw,
    /// Stops the program until the shell resumes it.
    Suspend,
    /// Ends the program.
    Quit,
}

/// What can be done in a field beside typing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "they say it")]
pub enum FieldEdit {
    Delete,
    Clear,
    Left,
    Right,
    Home,
    End,
    Next,
    Previous,
}

/// Where to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "they say it")]
pub enum Direction {
    Up,
    Down,
    Left,
    Right,
    PageUp,
    PageDown,
}
