//! Opens scenarios, and creates views of them.

use gyrolab::engine::journal::parameters;
use gyrolab::engine::scenario::file::ScenarioFile;
use gyrolab::engine::scenario::{Document, Problems, Scenario};
use gyrolab::lab::Lab;
use gyrolab::lab::storage::session::SessionContent;
use gyrolab::lab::view::View;
use gyrolab::lab::view::theme::Marker;
use gyrolab::lab::view::theme::{Background, Palette, Theme};
use gyrolab::physics::SchemeInfo;
use toml::{Table, Value};

/// Opens the preset `name` with the settings `set` (`key=value`).
#[track_caller]
pub fn preset(name: &str, set: &[&str]) -> Scenario {
    let mut document = Document::open(name).unwrap();
    set.iter().for_each(|set| document.set(set).unwrap());
    let scenario = document.scenario();
    scenario.unwrap_or_else(|problems| panic!("{problems}"))
}

/// Parses the scenario in the TOML `text`, or returns its problems.
pub fn read(text: &str) -> Result<Scenario, Problems> {
    Document::parse("x.toml", text)?.scenario()
}

/// Parses the scenario in the TOML `text`, which must be valid.
#[track_caller]
pub fn parse(text: &str) -> Scenario {
    read(text).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// Returns the scheme `name`.
#[track_caller]
pub fn find_scheme(name: &str) -> &'static SchemeInfo {
    SchemeInfo::find(name).unwrap()
}

/// Resumes the lab of the session `content`.
#[track_caller]
pub fn resumed(content: &SessionContent) -> Lab {
    Lab::resumed(content, None, |scenario| {
        view(scenario, Marker::Braille, false)
    })
    .unwrap()
}

/// Returns a view of `scenario` on a dark background, in true color or without colors.
pub fn view(scenario: &Scenario, marker: Marker, has_color: bool) -> View {
    let theme = Theme {
        palette: if has_color {
            Palette::TrueColor
        } else {
            Palette::Plain
        },
        background: Background::Dark,
    };
    View::new(scenario, marker, theme)
}

/// Returns the scenario of `file` with `value` at `key`.
pub fn changed(file: &ScenarioFile, key: &str, value: Value) -> Result<Scenario, Problems> {
    parameters::changed(file, &Table::from_iter([(key.to_owned(), value)]))
}
