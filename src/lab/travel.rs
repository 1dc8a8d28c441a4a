//! The step that the user means when typing where to go.

use super::command::whole;
use super::player::Player;

/// What the user may type to say where to go.
pub(super) const WHERE: &str =
    "a step (421), a time (12.5 s), so many on or back (+50, -2 s), start or end";

impl Player {
    /// The step that `text` means, seen from where the run stands.
    pub(super) fn step_meant(&self, text: &str) -> Result<u64, String> {
        let text = text.trim();
        let here = self.playback.step_number();
        let wrong = || format!("must be {WHERE}");
        let digits = text.trim_start_matches(['+', '-']);
        if let Some(time) = text.strip_suffix('s') {
            let time_s: f64 = time.trim().parse().map_err(|_| wrong())?;
            // With a sign the time counts from here, as steps do.
            let from_s = if digits == text {
                0.0
            } else {
                self.run().now().time_s
            };
            return self.step_at(from_s + time_s);
        }
        match text {
            "start" => Ok(0),
            "end" => Ok(self.playback.end_step()),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::scenario;

    #[test]
    fn steps_and_times_count_from_the_start_or_from_here() {
        let mut player = Player::new(scenario(), false);
        player.step(100).unwrap();
        for (text, step) in [
            ("421", 421),
            (" 1e3 ", 1000),
            ("12.5 s", 125),
            ("+50", 150),
            ("-30", 70),
            ("-300", 0),
            ("+2 s", 120),
            ("-2s", 80),
            ("start", 0),
            ("end", 2300),
        ] {
            assert_eq!(player.step_meant(text), Ok(step), "{text}");
        }
        for text in ["", "soon", "12.5", "-11 s", "nan s", "+x"] {
            assert!(player.step_meant(text).is_err(), "{text}");
        }
    }
}
