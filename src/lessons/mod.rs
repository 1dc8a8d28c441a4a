//! Lessons: Markdown files with blocks that say what the lab does, read, checked, played without a screen, and taken beside
//! the lab.
//!
//! It uses the [`lab`](crate::lab), to which its blocks send commands. All that concerns the content, the course or the print
//! of a lesson belongs here. The pane that shows a page belongs to [`tui`](crate::tui).
//!
//! - [`lesson`]: a lesson as it was read: its pages, and the blocks of each.
//! - [`opening`]: a shipped lesson or a file is opened; [`reading`]: its Markdown becomes a [`Lesson`]; every refusal names
//!   file, line and key.
//! - [`text`](mod@text): text whose numbers come from the run.
//! - [`names`]: the numbers that an expression of a lesson can name.
//! - [`predictions`]: what a student has predicted.
//! - [`stage`]: what to carry out to stand on a page.
//! - [`play`]: a lesson played to its end without a screen, and whether its checks do what they should.
//! - [`handout`]: a lesson on paper, and what was predicted beside what came out; [`teacher`]: a sheet for the teacher.
//! - [`state`]: the lessons of a lab; [`open_lesson`]: the one that is open, with what its page has stated; [`page`]: what stands
//!   beside the panes, of [`markdown`]; [`clock`] and [`watch`]: the time, and a file that changes.
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
