//! Scenarios: from a TOML file, or a run's own CSV, to numbers that have been checked.
//!
//! A [`Document`] is the text with its `--set` overrides; [`keys`] is the [`schema`] of every key a file may hold;
//! [`file`](mod@file) is the file's shape as serde reads and writes it; `parts`, `solids` and `start` make
//! checked numbers of its tables, and `checks` a [`Scenario`] of those. What is refused comes back as [`Problems`], each
//! with place, key, value and rule. [`csv`] reads the other CSVs: measured data and tables.

mod checks;
pub mod csv;
pub mod document;
pub mod dotted;
pub mod file;
pub mod head;
pub mod keys;
pub mod kind;
pub mod limits;
mod model;
pub mod nudge;
mod parts;
pub mod presets;
pub mod problem;
pub mod rescale;
pub mod schema;
pub mod screen;
pub mod solids;
pub mod start;

pub use document::Document;
pub use file::ScenarioFile;
pub use kind::{float, vector};
pub use model::{Edit, Motion, NamedBody, Push, Pushes, Scenario, Window};
pub use problem::{Problem, Problems};

/// The scenario of the preset `name` in which these values are set, for tests.
#[cfg(test)]
pub fn preset(name: &str, sets: &[&str]) -> std::sync::Arc<Scenario> {
    let mut document = Document::open(name).unwrap();
    sets.iter().for_each(|set| document.set(set).unwrap());
    std::sync::Arc::new(document.scenario().unwrap())
}
