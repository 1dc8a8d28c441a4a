//! What an action comes to: commands, with the numbers that count and selection give them; or a step of the interface,
//! a dialog, the focus, a list.

use super::action::{Action, Direction};
use super::carry_out::{Answer, Done};
use super::command::{Command, Place, PushChoice};
use super::values::Target;
use super::view::Pane;
use super::{Lab, Mode, Request};
use crate::observe::pace::Speed;

/// Factor for Shift.
const FAR: i32 = 10;
/// The longest count that can be typed.
const MOST_COUNTED: u64 = 999_999_999;
/// Repeating something on the screen more often than this shows nothing new.
const MOST_REPEATED: u64 = 1000;
/// Rows of a page in lists.
const PAGE: isize = 10;
/// Degrees the camera turns at a key.
const TURN_DEG: f64 = 10.0;

impl Lab {
    /// Carries out `action`; what only the loop can do comes back.
    pub fn update(&mut self, action: Action) -> Option<Request> {
        let count = self.count.take();
        let closed = self.notice.take_back() || count.is_some();
        let was_warned = std::mem::take(&mut self.was_warned);
        if !matches!(
            action,
            Action::Move(_) | Action::MoveFar(_) | Action::Digit(_)
        ) {
            self.values.forget_nudge();
        }
        match self.commands_of(action, count) {
            Ok(Some(commands)) => self.carry_out_all(&commands),
            Ok(None) => {
                let request = self.step_of_interface(action, count, closed, was_warned);
                if request.is_some() {
                    return request;
                }
            }
            Err(reason) => self.say(reason),
        }
        self.keep_focus();
        self.read_now();
        None
    }

    /// Carries `commands` out up to the first that is refused, and says what came of them.
    fn carry_out_all(&mut self, commands: &[Command]) {
        for command in commands {
            let answer = self.carry_out(command);
            let is_refused = answer.is_err();
            self.tell_answer(answer);
            if is_refused {
                return;
            }
        }
    }

    /// Says what a command has done, or why it did nothing.
    pub(super) fn tell_answer(&mut self, answer: Answer) {
        match answer {
            Ok(Done {
                said: Some(text),
                stays: true,
                ..
            }) => self.notice.keep_saying(text),
            Ok(Done {
                said: Some(text), ..
            }) => self.say(text),
            Ok(Done { said: None, .. }) => {}
            Err(refusal) => self.say(refusal.to_string()),
        }
    }

    /// The commands that `action` leads to as the lab stands; `None` where it is a step of the interface.
    ///
    /// # Errors
    /// Why it leads to none.
    fn commands_of(
        &self,
        action: Action,
        count: Option<u64>,
    ) -> Result<Option<Vec<Command>>, String> {
        let times = repeated(count);
        let one = |command| Ok(Some(vec![command]));
        let steps = || i64::try_from(count.unwrap_or(1)).unwrap_or(i64::MAX);
        match action {
            Action::TogglePause if !self.script.is_done() => Ok(None),
            Action::TogglePause => one(match self.is_moving() {
                true => Command::Pause,
                false => Command::Run,
            }),
            Action::Step | Action::StepBack if count == Some(0) => one(Command::Pause),
            Action::Step => one(Command::Step(steps())),
            Action::StepBack => one(Command::Step(-steps())),
            Action::Faster => self.other_speed(times).map(Some),
            Action::Slower => self.other_speed(-times).map(Some),
            Action::Restart => {
                let run = self.player.playback.is_running().then_some(Command::Run);
                let begin = Command::GoTo(Place::Start);
                Ok(Some([Some(begin), run].into_iter().flatten().collect()))
            }
            Action::GoTo => Ok(count.map(|step| vec![Command::GoTo(Place::Step(step))])),
            Action::Undo => one(Command::Undo(times.unsigned_abs())),
            Action::Redo => one(Command::Redo(times.unsigned_abs())),
            Action::Push => one(Command::Push(PushChoice::default())),
            Action::ToggleExact => one(Command::Exact(self.run().overlay().is_none())),
            Action::FillScreen => one(Command::Fill(
                (!self.view.filled).then_some(self.view.focus),
            )),
            Action::ThreeD if !self.is_filled_by(Pane::THREE_D) => {
                one(Command::Fill(Some(Pane::THREE_D)))
            }
            Action::WiderWindow => Ok(self.other_window(true)),
            Action::NarrowerWindow => Ok(self.other_window(false)),
            Action::Move(direction) => self.moved(direction, times),
            Action::MoveFar(direction) => self.moved(direction, times.saturating_mul(FAR)),
            _ => Ok(None),
        }
    }

    fn is_moving(&self) -> bool {
        self.player.playback.is_running() || self.player.playback.steps_to_go().is_some()
    }

    fn other_speed(&self, notches: i32) -> Result<Vec<Command>, String> {
        let now = self.player.playback.speed();
        match now.shifted(notches) {
            next if next != now => Ok(vec![Command::Speed(next)]),
            Speed::Top => Err("this is the top speed".to_owned()),
            Speed::Times(_) if notches > 0 => Err("this is the top speed".to_owned()),
            Speed::Times(_) => Err("this is the lowest speed; . takes a single step".to_owned()),
        }
    }

    fn other_window(&self, wider: bool) -> Option<Vec<Command>> {
        let time_step_s = self.run().simulation().motion().time_step_s;
        let window_s = self.view.zoomed(wider, time_step_s)?;
        Some(vec![Command::Window(window_s)])
    }

    /// What the arrow `direction` leads to, pressed `times` times.
    fn moved(&self, direction: Direction, times: i32) -> Result<Option<Vec<Command>>, String> {
        match (self.mode, self.view.focus) {
            (Mode::Lab, Pane::THREE_D) => Ok(Some(vec![self.turned(direction, times)])),
            (Mode::Lab, Pane::PARAMETERS) => match direction {
                Direction::Left => self.nudged(-times),
                Direction::Right => self.nudged(times),
                _ => Ok(None),
            },
            (Mode::Lab, _) => {
                Err("arrows change values (e), turn the 3-D view (d) and move in lists".to_owned())
            }
            _ => Ok(None),
        }
    }

    fn turned(&self, direction: Direction, times: i32) -> Command {
        let degrees = f64::from(times) * TURN_DEG;
        let (yaw, pitch) = match direction {
            Direction::Left => (-degrees, 0.0),
            Direction::Right => (degrees, 0.0),
            Direction::Up | Direction::PageUp => (0.0, degrees),
            Direction::Down | Direction::PageDown => (0.0, -degrees),
        };
        let mut camera = self.view.camera;
        camera.turn(yaw, pitch);
        Command::Camera(camera)
    }

    /// The line that is selected, nudged.
    fn nudged(&self, times: i32) -> Result<Option<Vec<Command>>, String> {
        Ok(match self.values.selected() {
            None => None,
            Some(_) if times == 0 => None,
            Some(Target::Parameter(parameter)) => Some(vec![Command::Nudge {
                key: parameter.key.clone(),
                times,
            }]),
            Some(Target::NextPush(field)) => {
                let scenario = self.run().scenario();
                let next = self.values.next_push().nudged(*field, times, scenario)?;
                Some(vec![Command::NextPush(PushChoice::field(*field, &next))])
            }
        })
    }

    /// Carries out an action that is no command.
    fn step_of_interface(
        &mut self,
        action: Action,
        count: Option<u64>,
        closed: bool,
        was_warned: bool,
    ) -> Option<Request> {
        let times = repeated(count);
        match action {
            Action::Digit(digit) => self.count = Some(counted(count, digit)),
            Action::TogglePause => self.stop_script(),
            Action::GoTo => self.ask_where_to_go(),
            Action::ChoosePush => self.choose_push(),
            Action::Parameters => self.turn_to_parameters(),
            Action::Edit => self.ask_for_value(),
            Action::Export => self.ask_for_export(),
            Action::SaveRun => self.ask_where_to_save_the_run(),
            Action::SavePresent => self.ask_where_to_save_the_present(),
            Action::NextPane => self.shift_focus(true),
            Action::PreviousPane => self.shift_focus(false),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::WiderWindow | Action::NarrowerWindow => {
                self.say(format!("the traces show {} s", self.view.window_s));
            }
            Action::Move(direction) => self.shift(direction, times),
            Action::MoveFar(direction) => self.shift(direction, times.saturating_mul(FAR)),
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
            Action::Suspend if self.files.confined().is_some() => {
                self.say("there is no shell to go back to: q leaves");
            }
            Action::Suspend => return Some(Request::Suspend),
            Action::Quit if self.may_quit(was_warned) => return Some(Request::Quit),
            Action::Quit
            | Action::Step
            | Action::StepBack
            | Action::Faster
            | Action::Slower
            | Action::Restart
            | Action::Undo
            | Action::Redo
            | Action::Push
            | Action::ToggleExact
            | Action::FillScreen => {} // commands
        }
        None
    }

    /// Moves the selection of the list on top, or that of the values.
    fn shift(&mut self, direction: Direction, times: i32) {
        let rows = rows(direction) * times as isize;
        match (self.mode, self.view.focus) {
            (Mode::Browser | Mode::Filter, _) => self.browser.shift(rows),
            (Mode::Lab, Pane::PARAMETERS) => self.values.shift(rows.signum() * times as isize),
            _ => self.view.scroll = self.view.scroll.saturating_add_signed(rows),
        }
    }

    fn browse(&mut self) {
        let folder = self.files.folder();
        let name = &self.history.present().name;
        let confined = self.files.confined();
        self.browser.begin(folder, name, |path| {
            confined.is_none_or(|folder| folder.check(path).is_ok())
        });
        self.mode = Mode::Browser;
    }

    fn choose(&mut self) {
        let Some(name) = self.browser.choice().map(|entry| entry.name.clone()) else {
            return self.say("nothing is selected: Esc clears the filter");
        };
        let answer = self.carry_out(&Command::Open(name));
        if answer.is_ok() {
            self.mode = Mode::Lab;
            self.carry_out_all(&[Command::Run]);
        }
        self.tell_answer(answer);
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
            Mode::Lab if !self.script.is_done() => self.stop_script(),
            Mode::Lab if self.player.playback.steps_to_go().is_some() => {
                self.carry_out_all(&[Command::Pause]);
            }
            Mode::Lab if self.view.filled => self.carry_out_all(&[Command::Fill(None)]),
            Mode::Lab if closed => {}
            Mode::Lab if self.files.is_exporting() => self.files.stop_export(),
            Mode::Lab => self.say("nothing to close; q leaves"),
        }
    }

    /// Stops the run and leaves the commands that are still to be carried out.
    fn stop_script(&mut self) {
        let left = self.drop_script();
        self.carry_out_all(&[Command::Pause]);
        self.say(match left {
            1 => "stopped: 1 command is left out".to_owned(),
            left => format!("stopped: {left} commands are left out"),
        });
    }
}

fn counted(count: Option<u64>, digit: u8) -> u64 {
    (count.unwrap_or(0) * 10 + u64::from(digit)).min(MOST_COUNTED)
}

/// How often to repeat what needs no more than `MOST_REPEATED` repetitions.
fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}

fn rows(direction: Direction) -> isize {
    match direction {
        Direction::Up | Direction::Left => -1,
        Direction::Down | Direction::Right => 1,
        Direction::PageUp => -PAGE,
        Direction::PageDown => PAGE,
    }
}
