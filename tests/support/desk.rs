//! A lab without a terminal and without a picture: tests send it keys and commands, and advance its clock.

#![allow(dead_code, reason = "no test needs all of it")]

use super::scenarios::{preset, view};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::lab::command::{self, Command};
use gyrolab::lab::view::theme::Marker;
use gyrolab::lab::{ActionResult, Lab};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::press::press;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// The lab and its clock.
pub struct Desk {
    pub lab: Lab,
    now: Duration,
}

impl Desk {
    /// Opens a paused lab with the preset `name`.
    pub fn open(name: &str) -> Self {
        Self::with(name, preset(name, &[]))
    }

    pub fn with(name: &str, scenario: Scenario) -> Self {
        let view = view(&scenario, Marker::Braille, false);
        Self::from_lab(Lab::new(name, Arc::new(scenario), view, false))
    }

    /// Creates a desk for an existing lab.
    pub fn from_lab(lab: Lab) -> Self {
        Self {
            lab,
            now: Duration::ZERO,
        }
    }

    /// Presses `keys`, and waits until the lab has finished the requested steps.
    pub fn press(&mut self, keys: &[Key]) {
        for &key in keys {
            press(key, &mut self.lab);
        }
        self.wait(2);
    }

    pub fn type_text(&mut self, text: &str) {
        text.chars().for_each(|c| {
            press(Key::Char(c), &mut self.lab);
        });
    }

    /// Advances the clock by `frames`, and then until the lab has finished the requested steps.
    pub fn wait(&mut self, frames: u32) {
        for _ in 0..frames {
            self.pass(Duration::from_millis(70));
        }
        while self.lab.player().steps_to_go().is_some() {
            self.pass(Duration::ZERO);
        }
    }

    pub fn pass(&mut self, time: Duration) {
        self.now += time;
        let now = self.now;
        self.lab.advance(&mut || now);
    }

    /// Executes `command`, and waits until the lab has finished the requested steps.
    pub fn carry_out(&mut self, command: &Command) -> ActionResult {
        let answer = self.lab.carry_out(command);
        self.wait(2);
        answer
    }

    /// Executes the commands in `text`, one `[[do]]` body per line. Returns the message of the last one.
    ///
    /// # Panics
    ///
    /// Panics if a command is rejected.
    #[track_caller]
    pub fn commands(&mut self, text: &str) -> Option<String> {
        let mut said = None;
        for command in commands(text) {
            said = self.carry_out(&command).unwrap().said;
        }
        said
    }

    pub fn step(&self) -> u64 {
        self.lab.player().step_number()
    }

    pub fn simulation(&self) -> &Simulation {
        self.lab.player().run().simulation()
    }

    /// Returns the scenario of the run with all edits.
    pub fn scenario(&self) -> Scenario {
        self.lab.player().run().scenario().as_ref().clone()
    }

    /// Saves the run file in `folder`, the lab's working directory, and reads it back. Returns `None` at step 0, where there
    /// is no run to save yet.
    pub fn saved(&mut self, folder: &Path) -> Option<Scenario> {
        if self.step() == 0 {
            return None;
        }
        self.commands("save = { path = 'saved.toml', force = true }");
        let file = folder.join("saved.toml");
        Some(Document::read(&file).unwrap().scenario().unwrap())
    }
}

/// Parses the commands in `text`, one per line.
#[track_caller]
pub fn commands(text: &str) -> Vec<Command> {
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let file: String = lines.map(|line| format!("[[do]]\n{line}\n")).collect();
    let document = Document::parse("commands.toml", &file).unwrap();
    let commands = command::read(&document).unwrap_or_else(|problems| panic!("{problems}"));
    commands
        .list
        .into_iter()
        .map(|placed| placed.command)
        .collect()
}
