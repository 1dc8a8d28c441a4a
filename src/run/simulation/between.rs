//! The state of a run between two of its steps.

use super::{NotFinite, Simulation};

impl Simulation {
    /// When the next step ends, s.
    pub fn next_time_s(&self) -> f64 {
        let number = self.now.number;
        let mut clock = self.clock;
        let due = self.now.scenario.edits[self.edits_made..].iter();
        for edit in due.take_while(|edit| edit.step == number) {
            if edit.touches.time_step {
                clock.change(number, edit.motion.time_step_s);
            }
        }
        clock.time_s(number + 1)
    }

    /// Takes one step of the scheme that ends at `time_s`, s, instead of the run's own. Up to the time at which that would
    /// have ended, this is the run between its steps: it begins where the step begins and leads to where it leads, and is as
    /// accurate. A time that is not after the present one changes nothing.
    ///
    /// From there on its steps end at other times than those of the run: where the run is still needed, call this on a
    /// clone.
    pub fn step_to_time(&mut self, time_s: f64) -> Result<(), NotFinite> {
        if self.next_edit == self.now.number {
            self.make_due_edits();
        }
        let length_s = time_s - self.now.after.time_s;
        if length_s <= 0.0 {
            return Ok(());
        }
        self.clock.change(self.now.number, length_s);
        self.now.motion.time_step_s = length_s;
        self.take_step()?;
        self.now.after.time_s = time_s; // and not the sum, whose last digit may differ
        Ok(())
    }
}
