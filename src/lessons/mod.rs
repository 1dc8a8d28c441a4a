//! Lessons: Markdown files whose blocks control the lab. They are read, checked, played without a screen, and shown
//! next to the panes.
//!
//! The blocks send commands to the [`lab`](crate::lab). The content, the state and the printed forms of a lesson belong
//! here. The pane that shows a page belongs to [`tui`](crate::tui).
//!
//! - [`lesson`]: a parsed lesson, with its pages and their blocks.
//! - [`opening`]: opens a shipped lesson or a file.
//! - [`reading`]: parses Markdown into a [`Lesson`]. Every error names file, line and key.
//! - [`text`](mod@text): text with numbers of the run.
//! - [`names`]: the numbers that expressions of a lesson can use.
//! - [`predictions`]: the student's predictions.
//! - [`stage`]: the commands that bring the lab to the state of a page.
//! - [`play`]: plays a lesson to its end without a screen and tests its checks.
//! - [`handout`]: a lesson on paper, and predictions with their outcomes. [`teacher`]: the teacher's sheet.
//! - [`state`]: the lessons of a lab. [`open_lesson`]: the open lesson. [`page`]: its page as a sheet, made of
//!   [`markdown`]. [`clock`]: the time. [`watch`]: detects changes of a file.
//! - [`shipped`]: the lessons that come with the program.

mod blocks;
pub mod clock;
pub mod handout;
pub mod lesson;
pub mod markdown;
pub mod names;
pub mod open_lesson;
pub mod opening;
pub mod page;
pub mod play;
pub mod predictions;
pub mod reading;
pub mod shipped;
pub mod stage;
pub mod state;
mod structure;
pub mod teacher;
pub mod text;
pub mod watch;

pub use lesson::{
    AnswerKind, Check, CodeBlock, Compare, Keep, Lesson, LessonBlock, LessonPage, Predict,
    PredictionAnswer, Setup,
};
pub use names::KeptNumbers;
pub use state::Lessons;
