//! The lab's state, and what every action does to it. It draws nothing and reads no clock: time comes in.

use super::action::{Action, Direction};
use super::browser::Browser;
use super::keymap::Mode;
use super::layout::Layout;
use super::live::{LiveRun, PlayEnd};
use super::pace::{Pace, Speed};
use super::readouts::{self, Readouts};
use super::view::{Pane, View};
use crate::run::NotFinite;
use crate::scenario::{Document, Scenario};
use ratatui::layout::Rect;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Longest stretch of stepping between two looks at the keyboard.
const STEPPING: Duration = Duration::from_millis(25);
/// The exact motion's share of that, and of a frame of 15 a second: a tenth.
const FOLLOWING: (Duration, Duration) = (Duration::from_micros(2500), Duration::from_millis(6));
/// How long a notice stands.
const NOTICE: Duration = Duration::from_secs(5);
/// Playback speed where the scenario names none, simulated seconds a second.
const SPEED: f64 = 1.0;
/// Rows of a page in lists.
const PAGE: isize = 10;
/// Degrees the camera turns at a key.
const TURN_DEG: f64 = 10.0;
/// The longest count that can be typed.
const MOST_COUNTED: u64 = 999_999_999;

/// What the loop must do that the lab cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Draw the whole screen again.
    Redraw,
    /// Stop until the shell resumes the program.
    Suspend,
    /// End.
    Quit,
}

/// The whole of what the user sees and steers.
pub struct Lab {
    /// SCENARIO as it was opened.
    name: String,
    run: LiveRun,
    azimuth_at_start_deg: f64,
    pace: Pace,
    /// The step at which it pauses by itself: the scenario's end at first, or where an errand of steps leads.
    stop: u64,
    /// Whether it is on its way to `stop` as fast as it can.
    errand: bool,
    view: View,
    readouts: Readouts,
    read_at: Duration,
    mode: Mode,
    /// The mode under the help.
    under_help: Mode,
    browser: Browser,
    folder: PathBuf,
    count: Option<u64>,
    notice: Option<(String, Duration)>,
    now: Duration,
    size: Rect,
    changed: bool,
}

impl Lab {
    /// A lab with the run of `scenario`, opened as `name`, at step 0.
    pub fn new(name: &str, scenario: Arc<Scenario>, view: View, running: bool) -> Self {
        let pace = Pace::new(speed(&scenario), running);
        let stop = scenario.steps;
        let run = LiveRun::new(scenario);
        let azimuth_at_start_deg = run.simulation().sample().azimuth_deg;
        Self {
            name: name.to_owned(),
            readouts: Readouts::new(&run, &pace, azimuth_at_start_deg),
            run,
            azimuth_at_start_deg,
            pace,
            stop,
            errand: false,
            view,
            read_at: Duration::ZERO,
            mode: Mode::Lab,
            under_help: Mode::Lab,
            browser: Browser::default(),
            folder: PathBuf::from("."),
            count: None,
            notice: None,
            now: Duration::ZERO,
            size: Rect::new(0, 0, 80, 24),
            changed: true,
        }
    }

    /// Takes the run to `step` at once, before anything is shown.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        while self.run.simulation().step_number() < step {
            self.run.step()?;
        }
        if step >= self.stop {
            self.stop = u64::MAX;
        }
        self.read_now();
        Ok(())
    }

    /// Lets time pass up to now, as `clock` tells it (since the lab was opened): steps, follows the exact motion, reads.
    pub fn advance(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let now = clock();
        let wall = now.saturating_sub(self.now);
        self.now = now;
        self.expire_notice();
        let owed_s = if self.errand {
            f64::INFINITY
        } else {
            self.pace.earn(wall)
        };
        if owed_s > 0.0 {
            self.play(owed_s, wall, clock);
        }
        if self.run.overlay_is_behind() {
            let deadline = clock()
                + if self.is_flat_out() {
                    FOLLOWING.0
                } else {
                    FOLLOWING.1
                };
            self.run.follow_exact(|| clock() >= deadline);
            self.changed = true;
        }
        if self.changed && self.now >= self.read_at + readouts::EVERY {
            self.read();
        }
    }

    fn play(&mut self, owed_s: f64, wall: Duration, clock: &mut dyn FnMut() -> Duration) {
        let before = self.run.simulation().step_number();
        let deadline = self.now + STEPPING;
        let played = self.run.play(owed_s, self.stop, || clock() >= deadline);
        self.pace
            .spend(played.stepped_s, wall, played.end == PlayEnd::CutShort);
        self.changed |= self.run.simulation().step_number() != before;
        match played.end {
            PlayEnd::InTime | PlayEnd::CutShort => {}
            PlayEnd::AtStop => self.arrive(),
            PlayEnd::NotFinite(error) => {
                self.pause();
                self.say(format!(
                    "the numbers are no longer finite at step {}: r begins again",
                    error.step
                ));
            }
        }
    }

    /// The run has come to where it was to stop.
    fn arrive(&mut self) {
        if !self.errand {
            let end = "end of the scenario's run: space goes on, r begins again";
            self.notice = Some((end.to_owned(), Duration::MAX));
        }
        self.pause();
        self.stop = match self.run.simulation().step_number() < self.run.scenario().steps {
            true => self.run.scenario().steps,
            false => u64::MAX,
        };
    }

    fn pause(&mut self) {
        self.errand = false;
        self.pace.set_running(false);
        self.read_now();
    }

    /// Carries out `action`; what only the loop can do comes back.
    pub fn update(&mut self, action: Action) -> Option<Request> {
        self.changed = true;
        let count = self.count.take();
        match action {
            Action::TogglePause => self.toggle_pause(),
            Action::Step => self.step(count.unwrap_or(1)),
            Action::Digit(digit) => self.count = Some(counted(count, digit)),
            Action::Faster => self.shift_speed(count, 1),
            Action::Slower => self.shift_speed(count, -1),
            Action::Restart => self.restart(Arc::clone(self.run.scenario())),
            Action::ToggleExact => self.toggle_exact(),
            Action::NextPane => self.view.shift_focus(&self.layout().focusable(), true),
            Action::PreviousPane => self.view.shift_focus(&self.layout().focusable(), false),
            Action::FillScreen => self.view.toggle_filled(),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::Move(direction) => self.shift(direction, count.unwrap_or(1)),
            Action::WiderWindow => self.zoom(true),
            Action::NarrowerWindow => self.zoom(false),
            Action::NextMarker => self.next_marker(),
            Action::ToggleColour => self.view.theme.colour = !self.view.theme.colour,
            Action::ToggleBackground => self.toggle_background(),
            Action::Browse => self.browse(),
            Action::Choose => self.choose(),
            Action::Filter => self.mode = Mode::Filter,
            Action::Type(typed) => self.browser.type_char(typed),
            Action::Erase => self.browser.erase(),
            Action::Help => self.toggle_help(),
            Action::Close => self.close(),
            Action::Redraw => return Some(Request::Redraw),
            Action::Suspend => return Some(Request::Suspend),
            Action::Quit => return Some(Request::Quit),
        }
        None
    }

    fn toggle_pause(&mut self) {
        self.errand = false;
        self.notice = None;
        self.pace.set_running(!self.pace.is_running());
        self.read_now();
    }

    fn step(&mut self, steps: u64) {
        self.pause();
        self.stop = self.run.simulation().step_number().saturating_add(steps);
        self.errand = true;
    }

    fn shift_speed(&mut self, count: Option<u64>, notches: i32) {
        let times = count.unwrap_or(1).min(100) as i32;
        self.pace.shift(notches * times);
        self.read_now();
    }

    /// Begins `scenario` at step 0; running or not stays as it is.
    fn restart(&mut self, scenario: Arc<Scenario>) {
        let shows_exact = self.run.overlay().is_some();
        self.errand = false;
        self.notice = None;
        self.stop = scenario.steps;
        self.run = LiveRun::new(scenario);
        self.run.set_overlay(shows_exact);
        self.azimuth_at_start_deg = self.run.simulation().sample().azimuth_deg;
        self.read_now();
    }

    fn toggle_exact(&mut self) {
        self.run.set_overlay(self.run.overlay().is_none());
        let said = match self.run.overlay() {
            Some(_) => "the exact motion of the same start is drawn faintly; t takes it away",
            None => "without the exact motion",
        };
        self.say(said.to_owned());
        self.read_now();
    }

    fn shift(&mut self, direction: Direction, count: u64) {
        let count = count.min(1000);
        match (self.mode, self.view.focus) {
            (Mode::Browser | Mode::Filter, _) => {
                self.browser.shift(rows(direction) * count as isize)
            }
            (Mode::Lab, Pane::ThreeD) => self.turn_camera(direction, count as f64 * TURN_DEG),
            (Mode::Lab, Pane::Traces | Pane::FromAbove) => {
                self.say("arrows turn the 3-D view (d) and move in lists".to_owned());
            }
            _ => {
                self.view.scroll = self
                    .view
                    .scroll
                    .saturating_add_signed(rows(direction) * count as isize)
            }
        }
    }

    fn turn_camera(&mut self, direction: Direction, degrees: f64) {
        let (yaw, pitch) = match direction {
            Direction::Left => (-degrees, 0.0),
            Direction::Right => (degrees, 0.0),
            Direction::Up | Direction::PageUp => (0.0, degrees),
            Direction::Down | Direction::PageDown => (0.0, -degrees),
        };
        self.view.camera.turn(yaw, pitch);
    }

    fn zoom(&mut self, wider: bool) {
        self.view
            .zoom(wider, self.run.simulation().motion().time_step_s);
        self.say(format!("the traces show {} s", self.view.window_s));
    }

    fn next_marker(&mut self) {
        self.view.marker = self.view.marker.next();
        self.say(format!("dots: {}", self.view.marker.name()));
    }

    fn toggle_background(&mut self) {
        self.view.toggle_background();
        let said = match self.view.theme.colour {
            true => format!("colours for a {:?} screen", self.view.theme.background).to_lowercase(),
            false => "there are no colours: c turns them on".to_owned(),
        };
        self.say(said);
    }

    fn browse(&mut self) {
        self.browser = Browser::new(&self.folder, &self.name);
        self.mode = Mode::Browser;
    }

    fn choose(&mut self) {
        let Some(name) = self.browser.choice().map(|entry| entry.name.clone()) else {
            return self.say("nothing is selected: Esc clears the filter".to_owned());
        };
        match Document::open(&name).and_then(|document| document.scenario()) {
            Ok(scenario) => self.open(name, Arc::new(scenario)),
            Err(problems) => {
                let first = problems
                    .list
                    .first()
                    .map(ToString::to_string)
                    .unwrap_or_default();
                self.say(format!(
                    "{}: {}",
                    problems.origin,
                    first.lines().next().unwrap_or_default()
                ));
            }
        }
    }

    fn open(&mut self, name: String, scenario: Arc<Scenario>) {
        self.mode = Mode::Lab;
        self.name = name;
        self.notice = None;
        self.pace = Pace::new(speed(&scenario), true);
        self.view.fit(&scenario);
        self.restart(scenario);
    }

    fn toggle_help(&mut self) {
        self.view.scroll = 0;
        if self.mode == Mode::Help {
            self.mode = self.under_help;
        } else {
            self.under_help = self.mode;
            self.mode = Mode::Help;
        }
    }

    /// Closes what lies on top, one thing at a time; with nothing to close it says how to leave.
    fn close(&mut self) {
        match self.mode {
            Mode::Help => self.toggle_help(),
            Mode::Filter => {
                self.browser.clear_filter();
                self.mode = Mode::Browser;
            }
            Mode::Browser => self.mode = Mode::Lab,
            Mode::Lab if self.view.filled => self.view.filled = false,
            Mode::Lab if self.notice.is_some() => self.notice = None,
            Mode::Lab => self.say("nothing to close; q leaves".to_owned()),
        }
    }

    fn say(&mut self, notice: String) {
        self.notice = Some((notice, self.now + NOTICE));
        self.changed = true;
    }

    fn expire_notice(&mut self) {
        if self
            .notice
            .as_ref()
            .is_some_and(|(_, until)| *until <= self.now)
        {
            self.notice = None;
            self.changed = true;
        }
    }

    fn read_now(&mut self) {
        self.read();
        self.changed = true;
    }

    fn read(&mut self) {
        self.readouts = Readouts::new(&self.run, &self.pace, self.azimuth_at_start_deg);
        self.read_at = self.now;
    }

    /// The screen has this size now.
    pub fn resize(&mut self, size: Rect) {
        self.size = size;
        self.changed = true;
    }

    /// Whether the picture has changed since this was asked last; the readouts shown are then up to date if the run
    /// stands still.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Whether time changes anything: the run goes on, or something is being computed.
    pub fn is_busy(&self) -> bool {
        self.pace.is_running() || self.errand || self.run.overlay_is_behind()
    }

    /// Whether it computes all the time there is, rather than at moments that one can wait for.
    pub fn is_flat_out(&self) -> bool {
        let catches_up = !self.pace.is_running() && self.run.overlay_is_behind();
        self.errand || catches_up || (self.pace.is_running() && self.pace.speed() == Speed::Top)
    }

    /// How long until the notice goes away by itself.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.notice
            .as_ref()
            .map(|(_, until)| until.saturating_sub(self.now))
    }

    /// The size of the screen.
    pub fn size(&self) -> Rect {
        self.size
    }

    /// The layout of the screen as it is now.
    pub fn layout(&self) -> Layout {
        Layout::new(self.size, &self.view, true)
    }

    /// The run.
    pub fn run(&self) -> &LiveRun {
        &self.run
    }

    /// How it is looked at.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The latest reading.
    pub fn readouts(&self) -> &Readouts {
        &self.readouts
    }

    /// What gets the keys.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The browser of presets and files.
    pub fn browser(&self) -> &Browser {
        &self.browser
    }

    /// Whether the run goes on by itself.
    pub fn is_running(&self) -> bool {
        self.pace.is_running()
    }

    /// The count typed so far.
    pub fn count(&self) -> Option<u64> {
        self.count
    }

    /// What is to be said now, if anything.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_ref().map(|(notice, _)| notice.as_str())
    }
}

fn speed(scenario: &Scenario) -> f64 {
    scenario
        .file
        .view
        .as_ref()
        .and_then(|view| view.speed)
        .unwrap_or(SPEED)
}

fn counted(count: Option<u64>, digit: u8) -> u64 {
    (count.unwrap_or(0) * 10 + u64::from(digit)).min(MOST_COUNTED)
}

fn rows(direction: Direction) -> isize {
    match direction {
        Direction::Up | Direction::Left => -1,
        Direction::Down | Direction::Right => 1,
        Direction::PageUp => -PAGE,
        Direction::PageDown => PAGE,
    }
}
