//! The lab on a screen of a given size, without a terminal: tests send keys and compare pictures.

use super::desk::commands;
use super::scenarios::{preset, view};
use gyrolab::lab::view::theme::Marker;
use gyrolab::lab::{Lab, LabRequest};
use gyrolab::lessons::Lessons;
use gyrolab::tui::app;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::press::press;
use gyrolab::tui::screen;
use ratatui::layout::Rect;
use std::sync::Arc;
use std::time::Duration;

pub const SMALL: Rect = Rect {
    x: 0,
    y: 0,
    width: 80,
    height: 24,
};
pub const LARGE: Rect = Rect {
    x: 0,
    y: 0,
    width: 200,
    height: 50,
};
pub const FRAME: Duration = Duration::from_millis(100);

/// A lab with its screen, and a clock that only the test advances.
pub struct Stage {
    pub lab: Lab,
    pub class: Lessons,
    pub now: Duration,
    pub size: Rect,
    /// The working directory of the lab.
    _folder: tempfile::TempDir,
}

impl Stage {
    pub fn open(scenario: &str, set: &[&str], size: Rect) -> Self {
        let numbers = Arc::new(preset(scenario, set));
        let view = view(&numbers, Marker::Braille, true);
        let mut lab = Lab::new(scenario, numbers, view, true);
        lab.set_file(&Arc::new(preset(scenario, &[])));
        let folder = tempfile::tempdir().unwrap();
        lab.files_mut().work_in(folder.path());
        screen::fit(&mut lab, size);
        Self {
            lab,
            class: Lessons::default(),
            now: Duration::ZERO,
            size,
            _folder: folder,
        }
    }

    pub fn key(&mut self, key: Key) -> Option<LabRequest> {
        let request = press(key, &mut self.lab)?;
        app::do_in_class(request, &mut self.lab, &mut self.class, self.size)
    }

    /// Opens the lesson `name` on `page`.
    #[track_caller]
    pub fn lesson(&mut self, name: &str, page: usize) -> &mut Self {
        let opened = self.class.open(name, Some(page), &mut self.lab);
        opened.unwrap();
        self.wait(0.0)
    }

    /// Waits until the lab has executed all pending commands, such as those of a lesson page.
    #[track_caller]
    pub fn settle(&mut self) -> &mut Self {
        for _ in 0..10_000 {
            self.wait(0.1);
            if self.lab.script().is_done() {
                return self.wait(0.1);
            }
        }
        panic!("the commands never finish");
    }

    pub fn press(&mut self, keys: &str) -> &mut Self {
        for key in keys.chars() {
            let key = match key {
                '\n' => Key::Enter,
                '\t' => Key::Tab,
                '\u{1b}' => Key::Esc,
                '↑' => Key::Up,
                '↓' => Key::Down,
                '←' => Key::Left,
                '→' => Key::Right,
                '\u{e}' => Key::Ctrl('n'),
                c => Key::Char(c),
            };
            self.key(key);
        }
        self.wait(0.0)
    }

    /// Advances the clock by `seconds`, frame by frame; every reading of the clock advances it too.
    pub fn wait(&mut self, seconds: f64) -> &mut Self {
        for _ in 0..=(seconds / FRAME.as_secs_f64()).round() as usize {
            let mut looks = 0;
            let now = self.now;
            let mut clock = || {
                looks += 1;
                now + Duration::from_micros(50) * (looks - 1)
            };
            self.lab.advance(&mut clock);
            self.class.update(now, &mut self.lab);
            screen::refit(&mut self.lab, self.size);
            self.now += FRAME;
        }
        self.now -= FRAME;
        self
    }

    /// Executes the commands in `text`, one `[[do]]` body per line. Then fits the lab to the screen again, like the
    /// terminal before the next frame.
    #[track_caller]
    pub fn commands(&mut self, text: &str) -> &mut Self {
        for command in commands(text) {
            self.lab.carry_out(&command).unwrap();
        }
        screen::refit(&mut self.lab, self.size);
        self.wait(0.0)
    }

    /// Returns the id of the pane in focus.
    pub fn focus(&self) -> &'static str {
        self.lab.view().focus.id()
    }

    pub fn picture(&self) -> String {
        screen::text(&self.lab, true, (self.size.width, self.size.height))
    }

    pub fn step(&self) -> u64 {
        self.lab.player().run().simulation().step_number()
    }

    #[track_caller]
    pub fn shows(&mut self, words: &str) -> &mut Self {
        let picture = self.picture();
        assert!(picture.contains(words), "no {words:?} in\n{picture}");
        self
    }

    #[track_caller]
    pub fn shows_no(&mut self, words: &str) -> &mut Self {
        let picture = self.picture();
        assert!(!picture.contains(words), "{words:?} in\n{picture}");
        self
    }
}

pub fn picture(scenario: &str, size: Rect, seconds: f64, keys: &str) -> String {
    let mut stage = Stage::open(scenario, &[], size);
    stage.wait(seconds).commands("pause = true");
    stage.press(keys).wait(6.0);
    stage.picture()
}
