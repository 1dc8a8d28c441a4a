//! Through the run: at which speed, back, and to any step or time.

use super::command::{Command, Place, whole};
use super::{Lab, dialogs::Asking};

/// What the user may type to say where to go.
const WHERE: &str = "a step (421), a time (12.5 s), so many on or back (+50, -2 s), start or end";

impl Lab {
    pub(super) fn ask_where_to_go(&mut self) {
        let fields = [("to", String::new())];
        self.ask(Asking::GoTo, "go to a step or a time", &fields, &[WHERE]);
    }

    /// The command that `text` means.
    ///
    /// # Errors
    /// Why that is nowhere.
    pub(super) fn place_typed(&self, text: &str) -> Result<Command, String> {
        let step = self.step_meant(text.trim())?;
        Ok(Command::GoTo(Place::Step(step)))
    }

    fn step_meant(&self, text: &str) -> Result<u64, String> {
        let here = self.player.playback.step_number();
        let wrong = || format!("must be {WHERE}");
        let digits = text.trim_start_matches(['+', '-']);
        if let Some(time) = text.strip_suffix('s') {
            let time_s: f64 = time.trim().parse().map_err(|_| wrong())?;
            // With a sign it counts from here, as steps do.
            let from_s = if digits == text {
                0.0
            } else {
                self.run().now().time_s
            };
            return self.player.step_at(from_s + time_s);
        }
        match text {
            "start" => Ok(0),
            "end" => Ok(self.player.playback.end_step()),
            _ if text.starts_with('+') => whole(digits)
                .map(|steps| here.saturating_add(steps))
                .ok_or_else(wrong),
            _ if text.starts_with('-') => whole(digits)
                .map(|steps| here.saturating_sub(steps))
                .ok_or_else(wrong),
            _ if text.contains('.') => {
                Err("must be a whole number of steps, or a time such as 12.5 s".to_owned())
            }
            _ => whole(text).ok_or_else(wrong),
        }
    }
}
