//! Lessons: Markdown files with blocks that say what the lab does, read, checked and played without a screen.
//!
//! - [`lesson`]: a lesson as it was read: its pages, and the blocks of each.
//! - [`reading`]: Markdown becomes a [`Lesson`]; every refusal names file, line and key.
//! - [`text`](mod@text): text whose numbers come from the run.
//! - [`names`]: the numbers that an expression of a lesson can name.
//! - [`predictions`]: what a student has predicted.
//! - [`stage`]: what to carry out to stand on a page.
//! - [`class`]: the lessons of a lab; [`taken`]: the one that is open, with the one who takes it; [`page`]: what stands
//!   beside the panes, of [`markdown`]; [`clock`] and [`watch`]: the time, and a file that changes.
//! - [`shipped`]: the lessons that come with the program.

mod blocks;
pub mod class;
pub mod clock;
pub mod lesson;
pub mod markdown;
pub mod names;
pub mod page;
pub mod predictions;
pub mod reading;
pub mod shipped;
pub mod stage;
mod structure;
pub mod taken;
pub mod text;
pub mod watch;

pub use class::Class;
pub use lesson::{Answer, Asked, Block, Check, Compare, Keep, Lesson, Page, Predict, Setup, Shown};
pub use names::{Kept, Names};
pub use predictions::Predictions;
pub use stage::Stage;
pub use text::Text;
