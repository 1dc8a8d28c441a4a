//! What the lab does with an action: it carries out the commands that the action stands for, or changes the interface,
//! which no command does: dialogs, the browser, the focus, dots and colours.

use super::action::{Action, Direction};
use super::carry_out::{Answer, Done};
use super::command::{Command, CursorTo, Place, PushChoice};
use super::dialog::{Dialog, Question};
use super::on_top::{Cleared, Mode};
use super::preview::Preview;
use super::values::Target;
use super::view::{Pane, Part};
use super::{Lab, Request};
use crate::export::Destination;
use crate::observe::camera::Zoom;
use std::path::Path;
use std::sync::Arc;

/// The factor of the arrows with Shift.
const FAR: i32 = 10;
/// The most times that an action is repeated; more repetitions would make no difference on the screen.
const MOST_REPEATED: u64 = 1000;
/// Rows of a page in lists.
const PAGE: isize = 10;

impl Lab {
    /// Carries out `action`. Returns what only the main loop can do.
    pub fn update(&mut self, action: Action) -> Option<Request> {
        let cleared = self.on_top.clear();
        if !matches!(
            action,
            Action::Move(_) | Action::MoveFar(_) | Action::Digit(_)
        ) {
            self.values.forget_nudge();
        }
        match self.commands_of(action, cleared.count) {
            Ok(Some(commands)) => self.carry_out_all(&commands),
            Ok(None) => {
                let request = self.change_interface(action, cleared);
                if request.is_some() {
                    return request;
                }
            }
            Err(reason) => self.say(reason),
        }
        self.view.keep_focus();
        self.read_now();
        None
    }

    /// Carries out `command` as a key does: what was said before goes, and its message is shown.
    pub fn carry_out_now(&mut self, command: &Command) {
        self.on_top.clear();
        self.carry_out_all(std::slice::from_ref(command));
    }

    /// Moves the focus to `pane`.
    pub fn turn_to(&mut self, pane: Pane) {
        self.on_top.clear();
        self.view.turn_to(pane);
        self.read_now();
    }

    /// Selects the entry of this number in the browser.
    pub fn select_in_browser(&mut self, row: usize) {
        self.on_top.clear();
        let selected = self.on_top.browser().selected();
        self.on_top.shift(row as isize - selected as isize);
        self.changed = true;
    }

    /// Carries out `commands` up to the first that is refused, and shows their messages.
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

    /// Shows the message of a command, or why it was refused.
    pub(super) fn tell_answer(&mut self, answer: Answer) {
        match answer {
            Ok(Done {
                said: Some(text),
                stays: true,
                ..
            }) => self.tell(text),
            Ok(Done {
                said: Some(text), ..
            }) => self.say(text),
            Ok(Done { said: None, .. }) => {}
            Err(refusal) => self.say(refusal.to_string()),
        }
    }

    /// The commands that `action` stands for as the lab is now; `None` for an action that only changes the interface.
    ///
    /// # Errors
    /// Why the action does nothing now.
    fn commands_of(
        &self,
        action: Action,
        count: Option<u64>,
    ) -> Result<Option<Vec<Command>>, String> {
        let times = repeated(count);
        let one = |command| Ok(Some(vec![command]));
        let steps = || i64::try_from(count.unwrap_or(1)).unwrap_or(i64::MAX);
        let speed = |notches| Ok(Command::Speed(self.player.other_speed(notches)?));
        match action {
            Action::TogglePause if !self.script.is_done() => Ok(None),
            Action::TogglePause => one(match self.player.is_moving() {
                true => Command::Pause,
                false => Command::Run,
            }),
            Action::Step | Action::StepBack if count == Some(0) => one(Command::Pause),
            Action::Step => one(Command::Step(steps())),
            Action::StepBack => one(Command::Step(-steps())),
            Action::Faster => speed(times).and_then(one),
            Action::Slower => speed(-times).and_then(one),
            Action::Restart => {
                let run = self.player.playback.is_running().then_some(Command::Run);
                let begin = Command::GoTo(Place::Start);
                Ok(Some([Some(begin), run].into_iter().flatten().collect()))
            }
            Action::GoTo => Ok(count.map(|step| vec![Command::GoTo(Place::Step(step))])),
            Action::Undo => one(Command::Undo(times.unsigned_abs())),
            Action::Redo => one(Command::Redo(times.unsigned_abs())),
            Action::Push => one(Command::Push(PushChoice::default())),
            Action::TakeAdvice if self.player.offer().is_none() => Err(
                "nothing is advised: the line about the numbers says when a mends them".to_owned(),
            ),
            Action::TakeAdvice => one(Command::TakeAdvice),
            Action::TogglePin => one(Command::Pin(!self.player.is_pinned())),
            Action::ToggleExact => one(Command::Exact(self.player.run().overlay().is_none())),
            Action::ToggleHealth => one(Command::Hide(self.view.toggled(Part::Health))),
            Action::TogglePredicted => one(Command::Hide(self.view.toggled(Part::Predicted))),
            Action::ToggleBare => one(Command::Bare(!self.view.bare)),
            Action::FillScreen => one(Command::Fill(
                (!self.view.filled).then_some(self.view.focus),
            )),
            Action::ThreeD if !self.view.is_filled_by(Pane::THREE_D) => {
                one(Command::Fill(Some(Pane::THREE_D)))
            }
            Action::StepCursor(direction) => one(self.stepped_cursor(signed(direction, times))),
            Action::ToTurn(direction) => one(Command::Cursor(match direction {
                Direction::Left => CursorTo::TurnBefore,
                _ => CursorTo::NextTurn,
            })),
            Action::GoToCursor => match self.view.cursor {
                Some(step) => one(Command::GoTo(Place::Step(step))),
                None => Ok(None),
            },
            Action::Pan(direction) => one(self.panned(direction, times)),
            Action::Magnify(more) => one(self.magnified(if more { times } else { -times })),
            Action::WholeView => Ok(Some(self.whole_view())),
            Action::WiderWindow => Ok(self.other_window(true)),
            Action::NarrowerWindow => Ok(self.other_window(false)),
            Action::ZoomIn => self.other_zoom(times).map(Some),
            Action::ZoomOut => self.other_zoom(-times).map(Some),
            Action::ZoomToWhole => self.zoom_to(1.0).map(Some),
            Action::Move(direction) => self.moved(direction, times),
            Action::MoveFar(direction) => self.moved(direction, times.saturating_mul(FAR)),
            _ => Ok(None),
        }
    }

    fn other_window(&self, wider: bool) -> Option<Vec<Command>> {
        let time_step_s = self.player.run().simulation().motion().time_step_s;
        let window_s = self.view.zoomed(wider, time_step_s)?;
        Some(vec![Command::Window(window_s)])
    }

    /// The command that shows the round picture in focus `rungs` larger.
    fn other_zoom(&self, rungs: i32) -> Result<Vec<Command>, String> {
        let now = match self.view.focus {
            Pane::THREE_D => self.view.zoom.three_d,
            _ => self.view.zoom.above,
        };
        match Zoom::shifted(now, rungs) {
            Some(next) => self.zoom_to(next),
            None if rungs > 0 => Err("this is the largest; Z makes it smaller".to_owned()),
            None => Err("this is the smallest; z makes it larger".to_owned()),
        }
    }

    /// The command that shows the round picture in focus `factor` times as large as the whole.
    fn zoom_to(&self, factor: f64) -> Result<Vec<Command>, String> {
        let mut zoom = self.view.zoom;
        match self.view.focus {
            Pane::FROM_ABOVE => zoom.above = factor,
            Pane::THREE_D => zoom.three_d = factor,
            _ => return Err("the view from above and the 3-D view are zoomed: Tab".to_owned()),
        }
        Ok(vec![Command::Zoom(zoom)])
    }

    /// The commands of an arrow key that is pressed `times` times.
    fn moved(&self, direction: Direction, times: i32) -> Result<Option<Vec<Command>>, String> {
        match (self.on_top.mode(), self.view.focus) {
            (Mode::Lab, Pane::THREE_D) => {
                let camera = self.view.turned(direction, times);
                Ok(Some(vec![Command::Camera(camera)]))
            }
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) => match direction {
                Direction::Left => self.nudged(-times),
                Direction::Right => self.nudged(times),
                _ => Ok(None),
            },
            (Mode::Lab, Pane::TRACES)
                if matches!(direction, Direction::Left | Direction::Right) =>
            {
                Ok(Some(vec![self.moved_cursor(signed(direction, times))]))
            }
            (Mode::Lab, _) => {
                Err("arrows change values (e), turn the 3-D view (d) and move in lists".to_owned())
            }
            _ => Ok(None),
        }
    }

    /// The command that nudges the selected value `times` times.
    fn nudged(&self, times: i32) -> Result<Option<Vec<Command>>, String> {
        Ok(match self.values.selected() {
            None => None,
            Some(_) if times == 0 => None,
            Some(Target::Parameter(parameter)) => Some(vec![Command::Nudge {
                key: parameter.key.clone(),
                times,
            }]),
            Some(Target::NextPush(field)) => {
                let scenario = self.player.run().scenario();
                let next = self.values.next_push().nudged(*field, times, scenario)?;
                Some(vec![Command::NextPush(PushChoice::field(*field, &next))])
            }
        })
    }

    /// Carries out an action that is no command.
    fn change_interface(&mut self, action: Action, cleared: Cleared) -> Option<Request> {
        let times = repeated(cleared.count);
        match action {
            Action::Digit(digit) => self.on_top.add_digit(cleared.count, digit),
            Action::TogglePause if self.script.is_held() => self.release_script(),
            Action::TogglePause => self.stop_script(),
            Action::GoTo => self.on_top.open_dialog(Dialog::go_to()),
            Action::ChoosePush => self.turn_to_next_push(),
            Action::Parameters | Action::GoToCursor => self.turn_to_parameters(),
            Action::Edit if self.view.focus != Pane::PARAMETERS => self.turn_to_parameters(),
            Action::Edit if self.values.selected().is_none() => {
                self.say("no value has that in its name: Esc shows all of them");
            }
            Action::Edit => {
                if let Some(dialog) = Dialog::value(&self.values) {
                    self.on_top.open_dialog(dialog);
                }
            }
            Action::Export | Action::SaveRun | Action::SavePresent => {
                match self.dialog_for_a_file(action) {
                    Ok(dialog) => self.on_top.open_dialog(dialog),
                    Err(reason) => self.say(reason),
                }
            }
            Action::NextPane => self.view.shift_focus(true),
            Action::PreviousPane => self.view.shift_focus(false),
            Action::ThreeD => self.view.toggle_three_d(),
            Action::WiderWindow | Action::NarrowerWindow => {
                self.say(format!("the traces show {} s", self.view.window_s));
            }
            Action::Move(direction) => self.shift(direction, times),
            Action::MoveFar(direction) => self.shift(direction, times.saturating_mul(FAR)),
            Action::NextMarker => {
                let text = self.view.next_marker();
                self.say(text);
                self.remember("marker", self.view.marker.name());
            }
            Action::ToggleColour => {
                let text = self.view.toggle_colour();
                self.say(text);
                self.remember("colour", self.view.theme.colour_choice());
            }
            Action::ToggleBackground => {
                let text = self.view.toggle_background();
                self.say(text);
                self.remember("background", self.view.theme.background.name());
            }
            Action::ToggleMouse => {
                let text = self.view.toggle_mouse();
                self.say(text);
                self.remember("mouse", self.view.mouse);
            }
            Action::Browse => {
                let files = &self.files;
                let may_be_read = |path: &std::path::Path| files.admit(path).is_ok();
                let name = self.work.name();
                self.on_top.open_browser(files.folder(), name, may_be_read);
            }
            Action::Choose => self.open_chosen(),
            Action::Filter => self.on_top.open_filter(),
            Action::FindValue => self.find_value(),
            Action::Type(typed) if self.on_top.mode() == Mode::Find => {
                self.values.type_name(typed.encode_utf8(&mut [0; 4]));
            }
            Action::Erase if self.on_top.mode() == Mode::Find => self.values.erase_name(),
            Action::Type(typed) => self.on_top.type_char(typed),
            Action::Erase => self.on_top.erase(),
            Action::DoEntry => {} // tui does it
            Action::InField(edit) => self.on_top.edit_field(edit),
            Action::Accept => self.accept(),
            Action::Help => self.on_top.toggle_help(),
            Action::Close => self.close(cleared.anything),
            Action::Redraw => return Some(Request::Redraw),
            Action::Suspend if self.files.confined().is_some() => {
                self.say("there is no shell to go back to: q leaves");
            }
            Action::Suspend => return Some(Request::Suspend),
            Action::Quit if self.files.is_exporting() && !cleared.was_warned => {
                self.on_top.warn_of_export(self.now);
            }
            Action::Quit => return Some(Request::Quit),
            Action::Step
            | Action::StepBack
            | Action::Faster
            | Action::Slower
            | Action::Restart
            | Action::Undo
            | Action::Redo
            | Action::Push
            | Action::ToggleExact
            | Action::TogglePin
            | Action::TakeAdvice
            | Action::FillScreen
            | Action::ToggleHealth
            | Action::TogglePredicted
            | Action::ToggleBare
            | Action::StepCursor(_)
            | Action::ToTurn(_)
            | Action::Pan(_)
            | Action::Magnify(_)
            | Action::WholeView
            | Action::ZoomIn
            | Action::ZoomOut
            | Action::ZoomToWhole => {} // commands
        }
        None
    }

    /// The dialog that asks for the file of an export, a run file or a scenario of the present state.
    ///
    /// # Errors
    /// Why there is nothing to write now.
    fn dialog_for_a_file(&self, action: Action) -> Result<Dialog, String> {
        let free_name = |about, extension| self.files.free_name(self.work.name(), about, extension);
        match action {
            Action::Export if self.files.is_exporting() => {
                Err("one export at a time: Esc stops the one under way".to_owned())
            }
            Action::Export => {
                let scenario = self.run_up_to(None, "export")?;
                Ok(Dialog::export(scenario, free_name("", "csv")))
            }
            Action::SaveRun => {
                let step = self.run_up_to(None, "save")?.steps;
                let later = self.work.journal().later_than(step);
                Ok(Dialog::save_run(step, later, free_name("-run", "toml")))
            }
            _ => {
                let content = self.player.present_as_text()?;
                Ok(Dialog::save_present(
                    content,
                    free_name("-from-here", "toml"),
                ))
            }
        }
    }

    /// Carries out the command that the open dialog asked for. If it is refused, the dialog stays and shows the reason.
    fn accept(&mut self) {
        let Some(dialog) = self.on_top.take_dialog() else {
            return;
        };
        let answer = self.answer_to(&dialog);
        match answer {
            Ok(_) => self.tell_answer(answer),
            Err(refusal) => self.on_top.open_dialog(dialog.refused(refusal)),
        }
    }

    fn answer_to(&mut self, dialog: &Dialog) -> Answer {
        let text = dialog.form().text(0);
        let path = self.files.path_of(text);
        let force = dialog.may_replace(&path);
        let command = match dialog.question() {
            Question::Value => {
                let run = self.player.run();
                let time_step_s = self.player.motion().time_step_s;
                self.values.value_typed(text, run.scenario(), time_step_s)?
            }
            Question::GoTo => {
                let step = self.player.step_meant(text)?;
                Some(Command::GoTo(Place::Step(step)))
            }
            Question::Export(scenario) => Some(Command::Export {
                path: text.to_owned(),
                every: dialog.every()?,
                to_step: Some(scenario.steps),
                force,
            }),
            Question::SaveRun(to_step) => Some(Command::Save {
                path: text.to_owned(),
                from_here: false,
                to_step: Some(*to_step),
                force,
            }),
            Question::SavePresent(content) => {
                return self.files.save("the scenario", content, &path, force);
            }
        };
        command.map_or(Ok(Done::SILENT), |command| self.carry_out(&command))
    }

    /// Moves the selection of what lies on top, or of the values.
    fn shift(&mut self, direction: Direction, times: i32) {
        let rows = rows(direction) * times as isize;
        match (self.on_top.mode(), self.view.focus) {
            (Mode::Lab | Mode::Find, Pane::PARAMETERS) => {
                self.values.shift(rows.signum() * times as isize);
            }
            _ => self.on_top.shift(rows),
        }
    }

    /// Opens the entry that is selected in the browser, and plays its run.
    fn open_chosen(&mut self) {
        let Some(entry) = self.on_top.browser().choice().cloned() else {
            return self.say("nothing is selected: Esc clears the filter");
        };
        let path = Path::new(&entry.name);
        if !entry.is_file || Destination::may_wait(path) || self.files.admit(path).is_err() {
            let answer = self.carry_out(&Command::Open(entry.name));
            return self.play_opened(answer);
        }
        self.on_top.choose();
        self.open_what_was_read();
        if self.on_top.browser().is_loading() {
            self.say("reading it: it opens when it has been read, Esc stays here");
        }
    }

    /// Opens the file that was chosen in the browser, once it has been read in the background.
    pub(super) fn open_what_was_read(&mut self) {
        let Some((name, preview)) = self.on_top.take_chosen() else {
            return;
        };
        let Preview::Known(known) = preview else {
            // There is no thread to read it.
            let answer = self.carry_out(&Command::Open(name));
            return self.play_opened(answer);
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
            self.on_top.close_browser();
            self.carry_out_all(&[Command::Run]);
        }
        self.tell_answer(answer);
    }

    /// Closes or stops one thing: what lies on top, the script, the steps asked for, the cursor, the pane that fills the
    /// screen, the export. Then it turns from the parameters back to the run. If there is none of these, it says how to
    /// leave, unless the key has already removed a message or a count.
    fn close(&mut self, has_cleared: bool) {
        let is_found = self.on_top.mode() == Mode::Find;
        let is_filtered = self.on_top.mode() == Mode::Lab && self.view.focus == Pane::PARAMETERS;
        if (is_found || is_filtered) && self.values.forget_name() {
            self.on_top.close();
            return;
        }
        if self.on_top.close() {
            return;
        }
        if !self.script.is_done() {
            self.stop_script();
        } else if self.player.playback.steps_to_go().is_some() {
            self.carry_out_all(&[Command::Pause]);
        } else if self.view.cursor.is_some() {
            self.carry_out_all(&[Command::Cursor(CursorTo::Nowhere)]);
        } else if self.view.filled {
            self.carry_out_all(&[Command::Fill(None)]);
        } else if has_cleared {
            // The key has done something already.
        } else if self.files.is_exporting() {
            self.files.stop_export();
        } else if !self.view.leave_parameters() {
            self.say("nothing to close; q leaves");
        }
    }

    /// Turns to the values, to type a part of the name of one.
    fn find_value(&mut self) {
        self.view.turn_to(Pane::PARAMETERS);
        self.values.forget_name();
        self.on_top.open_find();
    }

    /// Says that the help has `entries` entries that are found: the selected one is among them.
    pub fn limit_help(&mut self, entries: usize) {
        self.on_top.limit_help(entries);
    }

    /// Stops the run and drops the commands that are not carried out yet.
    fn stop_script(&mut self) {
        let left = self.script.drop_all();
        self.carry_out_all(&[Command::Pause]);
        self.say(match left {
            1 => "stopped: 1 command is left out".to_owned(),
            left => format!("stopped: {left} commands are left out"),
        });
    }
}

/// How often an action is repeated for `count`.
fn repeated(count: Option<u64>) -> i32 {
    count.unwrap_or(1).min(MOST_REPEATED) as i32
}

/// `times` to the right, or as many to the left.
fn signed(direction: Direction, times: i32) -> i32 {
    match direction {
        Direction::Left => -times,
        _ => times,
    }
}

fn rows(direction: Direction) -> isize {
    match direction {
        Direction::Up | Direction::Left => -1,
        Direction::Down | Direction::Right => 1,
        Direction::PageUp => -PAGE,
        Direction::PageDown => PAGE,
    }
}
