//! Opening a preset or a file while the lab is on the screen.

use super::Lab;
use super::answer::{Answer, Done};
use super::command::{Command, Commands};
use super::on_top::Mode;
use super::preview::Preview;
use crate::export::Destination;
use crate::scenario::{Document, Problem, Problems, Scenario, presets};
use std::path::Path;
use std::sync::Arc;

/// Reads the preset or the file called `name`. A FIFO or a device is refused: reading it may wait for any length of time,
/// which only the command line can do.
pub(super) fn read(name: &str) -> Result<Document, Problems> {
    if presets::find(name).is_none() && Destination::may_wait(Path::new(name)) {
        let rule = "is not a regular file: it can be opened at the command line only";
        return Err(Problems::one(name, Problem::at("", rule)));
    }
    Document::open(name)
}

impl Lab {
    /// Changes to the run of `scenario`, which another lab shows as `name`, and which ends there at `end_s`. It is paused at
    /// step 0.
    pub fn show_run(&mut self, name: &str, scenario: Arc<Scenario>, end_s: f64) {
        self.take_commands(Commands::default());
        self.open(name, scenario);
        self.work.set_end(end_s);
        self.player.playback.set_end(end_s);
        self.view.keep_focus();
        self.read_now();
    }

    /// Opens the entry that is selected in the browser: plays its run, or lists what is in the folder.
    pub(super) fn open_chosen(&mut self) {
        let Some(entry) = self.on_top.browser.choice().cloned() else {
            return self.say("nothing is selected: Esc clears the filter");
        };
        if entry.is_folder {
            let files = &self.files;
            let may_be_read = |path: &Path| files.admit(path).is_ok();
            self.on_top.mode = Mode::Browser;
            if !self.on_top.browser.enter(may_be_read) {
                self.say(format!("{} cannot be opened any more", entry.name));
            }
            self.changed = true;
            return;
        }
        let path = Path::new(&entry.name);
        if !entry.is_file || Destination::may_wait(path) || self.files.admit(path).is_err() {
            let answer = self.carry_out(&Command::Open(entry.name));
            return self.play_opened(answer);
        }
        self.on_top.browser.choose();
        self.open_what_was_read();
        if self.on_top.browser.is_loading() {
            self.say("reading it: it opens when it has been read, Esc stays here");
        }
    }

    /// Opens the file that was chosen in the browser, once it has been read in the background.
    pub(super) fn open_what_was_read(&mut self) {
        let Some((name, preview)) = self.on_top.take_chosen() else {
            return;
        };
        let Preview::Known(known) = preview else {
            return;
        };
        let answer = match known.as_ref() {
            Ok(scenario) => {
                self.values.forget_nudge();
                self.open(&name, Arc::new(scenario.clone()));
                self.view.keep_focus();
                self.read_now();
                Ok(Done::SILENT)
            }
            Err(reason) => Err(reason.lines().next().unwrap_or_default().into()),
        };
        self.play_opened(answer);
    }

    /// Closes the browser and plays what has been opened, or says why nothing was.
    fn play_opened(&mut self, answer: Answer) {
        self.changed = true;
        if answer.is_ok() {
            self.on_top.mode = Mode::Lab;
            self.carry_out_all(&[Command::Run]);
        }
        self.tell_answer(answer);
    }
}
