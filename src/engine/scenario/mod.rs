//! Reads a scenario from a TOML file, or from the CSV of a run, and checks its numbers.
//!
//! - [`Document`]: the text with its `--set` overrides.
//! - [`keys`]: the [`schema`] of every key that a file may have. A new key begins there.
//! - [`file`](mod@file): the structure of the file, as serde reads and writes it.
//! - `parts`, `solids`, `start`: turn its tables into checked numbers. `checks` makes a [`Scenario`] of these.
//! - [`Problems`]: errors, each with place, key, value and rule.
//! - [`csv`]: reads other CSV files: measured data and tables.

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

/// Returns the scenario of the preset `name` with these values set, for tests.
#[cfg(test)]
pub fn preset(name: &str, sets: &[&str]) -> std::sync::Arc<Scenario> {
    let mut document = Document::open(name).unwrap();
    sets.iter().for_each(|set| document.set(set).unwrap());
    std::sync::Arc::new(document.scenario().unwrap())
}
