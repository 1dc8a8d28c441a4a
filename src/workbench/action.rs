//! What the user can want, in words that know no key.

/// An intention; [`Lab::update`](super::lab::Lab::update) carries it out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Stops the run, or lets it go on.
    TogglePause,
    /// One time step on, or as many as have been counted.
    Step,
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
    /// Moves what is in focus.
    Move(Direction),
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
    /// A character of it.
    Type(char),
    /// Takes its last character away.
    Erase,
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
