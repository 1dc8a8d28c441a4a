//! The lab's state, and what every action does to it. It draws nothing and reads no clock: time comes in.
//!
//! This file has the state, the dispatch of actions and the passing of time; the rooms beside it carry out what
//! belongs together: `travel` through the run, `looking` at it, `editing` it, `opening` another, `dialogs` and what
//! they ask for, `keeping` all of it. What they work on has rooms of its own: [`history`](mod@crate::work::history) the runs one after the other, each with its
//! journal; [`editor`] the list of what can be edited; [`next_push`](mod@crate::work::next_push) the push to come; [`form`] what is typed into;
//! [`browser`] the list of presets and files; [`changed`](mod@crate::work::changed) says what there is to see, [`notice`] what has just happened.

pub mod action;
pub mod browser;
mod dialogs;
mod editing;
pub mod editor;
pub mod form;
mod keeping;
mod looking;
pub mod notice;
mod opening;
pub mod preview;
mod travel;
pub mod view;

pub use dialogs::Dialog;
pub use keeping::{Summary, Unreadable};

use crate::analysis::health::Advice;
use crate::lab::action::Action;
use crate::lab::view::{Pane, View};
use crate::observe::advisor::Advisor;
use crate::observe::ghost::Ghost;
use crate::observe::live::LiveRun;
use crate::observe::pace::Speed;
use crate::observe::playback::{Halt, Playback};
use crate::observe::reading::{self, Reading};
use crate::run::NotFinite;
use crate::scenario::{Motion, Scenario};
use crate::storage::confined::Confined;
use crate::storage::exporting::{Exporting, Written};
use crate::tui::keymap::{Key, Mode};
use crate::work::changed;
use crate::work::history::History;
use crate::work::next_push::NextPush;
use crate::work::restart::in_force;
use browser::Browser;
use editing::Target;
use editor::Editor;
use indicatif::HumanCount;
use notice::Notice;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// A value that was nudged longer ago is nudged anew: undo takes back what belongs together.
const BELONGS: Duration = Duration::from_secs(3);
/// What is moved far is moved so often.
const FAR: i32 = 10;
/// Part of the traces' time that may pass between two readings.
const FAST: f64 = 0.1;
/// The longest count that can be typed.
const MOST_COUNTED: u64 = 999_999_999;
/// Repeating something on the screen more often than this shows nothing new.
const MOST_REPEATED: u64 = 1000;

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
    /// The run, what was done to it, and the runs before it.
    history: History,
    /// The scenario as it was opened, and how the run differs from it, where it does.
    file: Arc<Scenario>,
    changed_from_file: Option<String>,
    playback: Playback,
    ghost: Option<Ghost>,
    /// What can be edited: every value of the scenario as it is now, and below them the push to come.
    targets: Vec<Target>,
    editor: Editor,
    next_push: NextPush,
    /// How many entries of the journal act on what the editor lists.
    entries_listed: usize,
    /// Where files are looked for and written to, if not in the present folder.
    folder: Option<PathBuf>,
    /// The folder that is not left, if there is one.
    confined: Option<Confined>,
    /// Why the session is not kept, if it is not.
    trouble: Option<String>,
    /// The key that was nudged last, if nothing else has been done since.
    last_nudged: Option<(String, Duration)>,
    dialog: Option<Dialog>,
    exporting: Option<Exporting>,
    written: Vec<Written>,
    /// The step to which a run or a session that was come back to is on its way.
    returning_to: Option<u64>,
    /// Whether the end was asked for while something was under way.
    was_warned: bool,
    /// The text of run and journal for the session, as long as it holds.
    work: Option<Arc<str>>,
    /// Whether to look for what would mend a run.
    is_advised: bool,
    advisor: Option<Advisor>,
    reading: Reading,
    read_at: Duration,
    view: View,
    mode: Mode,
    /// The mode under the help.
    under_help: Mode,
    browser: Browser,
    count: Option<u64>,
    notice: Notice,
    now: Duration,
    /// The panes that stand side by side while none fills the screen, in the order in which the focus goes through them.
    side_by_side: Vec<Pane>,
    changed: bool,
}

impl Lab {
    /// A lab with the run of `scenario`, opened as `name`, at step 0.
    pub fn new(name: &str, scenario: Arc<Scenario>, view: View, running: bool) -> Self {
        let history = History::new(name, &scenario);
        let mut playback = Playback::new(Arc::clone(&scenario), running);
        let mut lab = Self {
            history,
            changed_from_file: None,
            ghost: None,
            targets: Vec::new(),
            editor: Editor::default(),
            next_push: NextPush::of(&scenario),
            entries_listed: 0,
            file: scenario,
            folder: None,
            confined: None,
            trouble: None,
            last_nudged: None,
            dialog: None,
            exporting: None,
            written: Vec::new(),
            returning_to: None,
            was_warned: false,
            work: None,
            is_advised: false,
            advisor: None,
            reading: playback.read(),
            playback,
            read_at: Duration::ZERO,
            view,
            mode: Mode::Lab,
            under_help: Mode::Lab,
            browser: Browser::default(),
            count: None,
            notice: Notice::default(),
            now: Duration::ZERO,
            side_by_side: Pane::ALL.to_vec(),
            changed: true,
        };
        lab.list_parameters();
        lab
    }

    /// Says that its scenario was `file` before it was changed: the file's note is shown only where it still holds.
    pub fn set_file(&mut self, file: Arc<Scenario>) {
        self.changed_from_file = changed::changed(&file, self.run().scenario());
        self.file = file;
    }

    /// Looks for files in `folder`, and writes them there, instead of the present folder.
    pub fn work_in(&mut self, folder: &Path) {
        self.folder = Some(folder.to_owned());
    }

    /// From now on reads and writes nothing outside of the folder.
    pub fn confine(&mut self, folder: Confined) {
        self.confined = Some(folder);
    }

    /// Whether the file `path` may be read and written.
    fn admit(&self, path: &Path) -> Result<(), String> {
        let confined = self.confined.as_ref();
        confined.map_or(Ok(()), |folder| folder.check(path))
    }

    /// From now on looks in the background for what would mend a run that is not to be believed.
    pub fn take_advice(&mut self) {
        self.is_advised = true;
    }

    /// What would mend the run, where that is known.
    pub fn advice(&self) -> Option<&Advice> {
        self.advisor.as_ref()?.advice()
    }

    /// Takes the run to `step` at once, before anything is shown.
    ///
    /// # Errors
    /// When the numbers stop being finite on the way.
    pub fn begin_at(&mut self, step: u64) -> Result<(), NotFinite> {
        let arrived = self.playback.begin_at(step);
        self.read_now();
        arrived
    }

    /// Lets time pass up to now, as `clock` tells it (since the lab was opened): steps, follows the exact motion, reads.
    pub fn advance(&mut self, clock: &mut dyn FnMut() -> Duration) {
        let now = clock();
        let wall = now.saturating_sub(self.now);
        self.now = now;
        self.changed |= self.notice.expire(now);
        let before = self.playback.step_number();
        if let Some(halt) = self.playback.advance(now, wall, clock) {
            self.halted(halt);
        }
        self.changed |= self.playback.step_number() != before;
        if self.run().overlay_is_behind() {
            self.playback.follow_exact(clock);
            self.changed = true;
        }
        self.changed |= self.advisor.as_mut().is_some_and(Advisor::has_news);
        self.changed |= self.browser.take_news();
        self.follow_export();
        let is_due = self.is_fast() || now >= self.read_at + reading::EVERY;
        if self.changed && is_due {
            self.read_now();
        }
    }

    /// Whether the pictures run away from numbers that are read off a few times a second.
    fn is_fast(&self) -> bool {
        let window_s = self.view.window_s;
        let passes_s = reading::EVERY.as_secs_f64();
        self.playback.is_flat_out()
            || matches!(self.playback.speed(), Speed::Times(speed) if speed * passes_s > FAST * window_s)
    }

    fn halted(&mut self, halt: Halt) {
        match halt {
            Halt::StepsTaken => {}
            Halt::EndOfRun => self
                .notice
                .keep_saying("end of the scenario's run: space goes on, r begins again"),
            Halt::NotFinite(error) => {
                let text = format!(
                    "the numbers are no longer finite at step {}: u takes the last edit back, r begins again",
                    error.step
                );
                self.notice.keep_saying(text);
            }
        }
        self.read_now();
    }

    /// Carries out `action`; what only the loop can do comes back.
    pub fn update(&mut self, action: Action) -> Option<Request> {
        let count = self.count.take();
        let closed = self.notice.take_back() || count.is_some();
        let was_warned = std::mem::take(&mut self.was_warned);
        if !matches!(
            action,
            Action::Move(_) | Action::MoveFar(_) | Action::Digit(_)
        ) {
            self.last_nudged = None;
        }
        match action {
            Action::TogglePause => self.toggle_pause(),
            Action::Step => self.playback.take_steps(count.unwrap_or(1)),
            Action::StepBack => self.step_back(count.unwrap_or(1)),
            Action::Digit(digit) => self.count = Some(counted(count, digit)),
            Action::Faster => self.shift_speed(repeated(count)),
            Action::Slower => self.shift_speed(-repeated(count)),
            Action::Restart => self.playback.restart(),
            Action::GoTo => self.ask_where_to_go(count),
            Action::Undo => self.undo(repeated(count)),
            Action::Redo => self.redo(repeated(count)),
            Action::Push => self.push(),
            Action::ChoosePush => self.choose_push(),
            Action::Parameters => self.turn_to_parameters(),
            Action::Edit => self.ask_for_value(),
            Action::Export => self.ask_for_export(),
            Action::SaveRun => self.ask_where_to_save_the_run(),
            Action::SavePresent => self.ask_where_to_save_the_present(),
            Action::ToggleExact => self.toggle_exact(),
            Action::NextPane => self.shift_focus(true),
            Action::PreviousPane => self.shift_focus(false),
            Action::FillScreen => self.view.toggle_filled(),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::Move(direction) => self.shift(direction, repeated(count)),
            Action::MoveFar(direction) => {
                self.shift(direction, repeated(count).saturating_mul(FAR));
            }
            Action::WiderWindow => self.zoom(true),
            Action::NarrowerWindow => self.zoom(false),
            Action::NextMarker => self.next_marker(),
            Action::ToggleColour => self.toggle_colour(),
            Action::ToggleBackground => self.toggle_background(),
            Action::Browse => self.browse(),
            Action::Choose => self.choose(),
            Action::Filter => self.mode = Mode::Filter,
            Action::Type(typed) => self.type_char(typed),
            Action::Erase => self.erase(),
            Action::InField(edit) => self.edit_field(edit),
            Action::Accept => self.accept(),
            Action::Help => self.toggle_help(),
            Action::Close => self.close(closed),
            Action::Redraw => return Some(Request::Redraw),
            Action::Suspend if self.confined.is_some() => {
                self.say("there is no shell to go back to: q leaves");
            }
            Action::Suspend => return Some(Request::Suspend),
            Action::Quit => {
                if self.may_quit(was_warned) {
                    return Some(Request::Quit);
                }
            }
        }
        self.keep_focus();
        self.read_now();
        None
    }

    /// Says that `key` means nothing here.
    pub fn refuse(&mut self, key: Key) {
        self.count = None;
        let text = match (self.mode, key) {
            (Mode::Lab, Key::Char('/')) => {
                "/ filters the list of presets and files: o shows it".to_owned()
            }
            (Mode::Filter, _) => format!("no key {key} here; Enter opens, Esc clears the filter"),
            (Mode::Dialog, _) => {
                format!("no key {key} here; Enter takes what is typed, Esc leaves it")
            }
            _ => format!("no key {key} here; ? lists them"),
        };
        self.say(text);
        self.changed = true;
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

    /// Closes what lies on top, one thing at a time; with nothing to close, and nothing `closed` already, it says how
    /// to leave.
    fn close(&mut self, closed: bool) {
        match self.mode {
            Mode::Help => self.toggle_help(),
            Mode::Filter => {
                self.browser.clear_filter();
                self.mode = Mode::Browser;
            }
            Mode::Browser => self.mode = Mode::Lab,
            Mode::Dialog => self.close_dialog(),
            Mode::Lab if self.playback.steps_to_go().is_some() => {
                self.stop_steps();
            }
            Mode::Lab if self.view.filled => self.view.filled = false,
            Mode::Lab if closed => {}
            Mode::Lab if self.exporting.is_some() => self.stop_export(),
            Mode::Lab => self.say("nothing to close; q leaves"),
        }
    }

    fn say(&mut self, text: impl Into<String>) {
        self.notice.say(text, self.now);
    }

    fn read_now(&mut self) {
        self.reading = self.playback.read();
        self.read_at = self.now;
        self.changed = true;
        if self.entries_in_force() != self.entries_listed {
            self.list_parameters();
        }
        if self.is_advised
            && self.advisor.is_none()
            && self.reading.readouts.health.is_believed() == Some(false)
        {
            self.advisor = Some(Advisor::ask(Arc::clone(self.run().scenario())));
        }
    }

    /// Says which panes stand side by side on the screen, as it is now, while none fills it, from left to right. Until
    /// this is said, it is all of them. The whole picture is to be drawn again.
    pub fn set_side_by_side(&mut self, panes: Vec<Pane>) {
        self.side_by_side = panes;
        self.keep_focus();
        self.changed = true;
    }

    /// Whether the picture has changed and is to be taken.
    pub fn has_changed(&self) -> bool {
        self.changed
    }

    /// Whether the picture has changed since this was asked last.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// How long until the notice goes away by itself.
    pub fn notice_ends_in(&self) -> Option<Duration> {
        self.notice.ends_in(self.now)
    }

    /// The run on its pace.
    pub fn playback(&self) -> &Playback {
        &self.playback
    }

    /// The run.
    pub fn run(&self) -> &LiveRun {
        self.playback.run()
    }

    /// The run before, where an edit has begun this one anew.
    pub fn ghost(&self) -> Option<&Ghost> {
        self.ghost.as_ref()
    }

    /// What can be edited, and which of it is selected.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The dialog on top, if there is one.
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// What has been exported since the lab was opened.
    pub fn written(&self) -> &[Written] {
        &self.written
    }

    /// Whether something is under way that time changes, beside the run.
    pub fn is_exporting(&self) -> bool {
        self.exporting.is_some()
    }

    /// Gravity, scheme and time step of the step to come.
    pub fn motion(&self) -> Motion {
        let simulation = self.run().simulation();
        in_force(simulation.scenario(), simulation.step_number()).0
    }

    /// How it is looked at.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The latest reading.
    pub fn reading(&self) -> &Reading {
        &self.reading
    }

    /// What gets the keys.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The browser of presets and files.
    pub fn browser(&self) -> &Browser {
        &self.browser
    }

    /// The count typed so far.
    pub fn count(&self) -> Option<u64> {
        self.count
    }

    /// What there is to see in the run.
    pub fn note(&self) -> &str {
        let file = || changed::look_at(self.run().scenario());
        let note = self.changed_from_file.as_deref().or_else(file);
        note.unwrap_or("r begins the run again, o opens another")
    }

    /// What is to be said now, if anything: what keeps the lab busy, or else what has happened.
    pub fn notice(&self) -> Option<String> {
        let stepping = self
            .playback
            .steps_to_go()
            .map(|left| format!("stepping: {} to go, Esc stops", HumanCount(left)));
        let said = || self.notice.text().map(str::to_owned);
        stepping.or_else(said).or_else(|| self.export_in_words())
    }
}

fn counted(count: Option<u64>, digit: u8) -> u64 {
    (count.unwrap_or(0) * 10 + u64::from(digit)).min(MOST_COUNTED)
}

/// How often to repeat what needs no more than `MOST_REPEATED` repetitions.
fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}
