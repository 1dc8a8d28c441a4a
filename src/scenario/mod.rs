//! Scenarios: from a TOML file, or a run's own CSV, to numbers that have been checked.
//!
//! A [`Document`] is the text with its `--set` overrides; [`keys`] is the one table of every key a file may hold;
//! [`file`](mod@file) is the file's shape as serde reads and writes it; [`checks`] makes of it a [`Scenario`] whose
//! numbers make sense together. What is refused comes back as [`Problems`], each with place, key, value and rule.

pub mod checks;
pub mod document;
pub mod file;
pub mod keys;
pub mod presets;
pub mod problem;

pub use checks::{Body, Edit, Motion, Push, Scenario, Touches, Window};
pub use document::Document;
pub use file::ScenarioFile;
pub use problem::{Problem, Problems};
