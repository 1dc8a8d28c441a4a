//! The player: the run on the screen with its speed, the reading of its numbers, its ghost, and the advice about it.

use super::advised::Offer;
use super::explained::Explained;
use super::measured::Beside;
use super::rerun::{Heading, Pinned, Replay};
use crate::analysis::health::Advice;
use crate::journal::restart::in_force;
use crate::lab::view::View;
use crate::playback::background::{self, Job};
use crate::playback::detail::{Detail, Placement, Wanted};
use crate::playback::ghost::Ghost;
use crate::playback::live::LiveRun;
use crate::playback::lookup;
use crate::playback::pace::Speed;
use crate::playback::reading::{self, Reading};
use crate::playback::recording::Curve;
use crate::playback::{Halt, Playback};
use crate::run::{Clock, Sample};
use crate::scenario::{Motion, Scenario};
use std::sync::Arc;
use std::time::Duration;

/// The share of the traces' window that may pass between two readings; a faster run is read for every frame.
const FAST: f64 = 0.1;
/// If the window of the fast motion passes in less wall time than this, s, the strip stands still for a while.
const PASSES_S: f64 = 8.0;
/// How long the strip then stands still.
const HOLD: Duration = Duration::from_secs(1);

/// The run, its ghost, its latest reading and the advice about it.
pub struct Player {
    pub playback: Playback,
    /// The run before, where an edit has begun this one anew.
    pub(super) ghost: Option<Ghost>,
    pub(super) pinned: Option<Pinned>,
    pub(super) measured: Option<Beside>,
    /// Whether to look for a scheme or time step that would make doubtful numbers right.
    pub(super) is_advised: bool,
    pub(super) advisor: Option<Job<Advice>>,
    pub(super) offer: Option<Offer>,
    /// Whether the step pane was shown when the run was last read, and the step that it takes apart.
    pub(super) explains: bool,
    pub(super) explained: Option<Explained>,
    pub reading: Reading,
    read_at: Duration,
    pub detail: Detail,
    detail_at: Duration,
    /// Whether `detail` is of the run that was opened last.
    has_detail: bool,
    /// The numbers at the cursor, and the scenario of their run.
    at_cursor: Option<(Arc<Scenario>, Sample)>,
    /// The step to which the run is on its way by itself; out of date where other steps were asked for since.
    pub(super) heading: Option<Heading>,
    /// The time to which the last edit that began the run anew had it played; `None` if another act came after it.
    pub(super) replay: Option<Replay>,
}

impl Player {
    /// The run of `scenario` at step 0, with the exact motion where its `[view]` says so.
    pub(super) fn new(scenario: Arc<Scenario>, running: bool) -> Self {
        let exact = begins_with_exact(&scenario).unwrap_or(false);
        let mut playback = Playback::new(scenario, running);
        playback.set_exact(exact);
        let reading = playback.read();
        let following = Wanted::following(Clock::end_s(playback.run().scenario()));
        Self {
            detail: Detail::new(playback.run(), &reading.readouts, &following, None),
            detail_at: Duration::ZERO,
            has_detail: true,
            at_cursor: None,
            reading,
            playback,
            ghost: None,
            is_advised: false,
            advisor: None,
            offer: None,
            explains: false,
            explained: None,
            read_at: Duration::ZERO,
            pinned: None,
            measured: None,
            heading: None,
            replay: None,
        }
    }

    /// Changes to the run of `scenario`, which was opened under another name. It is paused at step 0.
    pub(super) fn open(&mut self, scenario: Arc<Scenario>) {
        let shows_exact = self.run().shows_exact();
        let exact = begins_with_exact(&scenario).unwrap_or(shows_exact);
        self.keep_pinned();
        (self.ghost, self.heading, self.replay) = (None, None, None);
        self.has_detail = false;
        self.measure_again(&scenario);
        self.playback = Playback::new(scenario, false);
        self.playback.set_exact(exact);
    }

    /// Forgets the advice: the scenario has changed.
    pub(super) fn forget_advice(&mut self) {
        (self.advisor, self.offer) = (None, None);
    }

    /// Advances the run and the exact motion by `wall`, the time up to `now`; `clock` returns the present time. Returns why
    /// the run stopped by itself, if it did, and whether the picture has changed.
    pub(super) fn advance(
        &mut self,
        now: Duration,
        wall: Duration,
        clock: &mut dyn FnMut() -> Duration,
    ) -> (Option<Halt>, bool) {
        let before = self.playback.step_number();
        let halt = self.playback.advance(now, wall, clock);
        let mut is_new = halt.is_some() || self.playback.step_number() != before;
        if self.run().overlay_is_behind() {
            self.playback.follow_exact(clock);
            is_new = true;
        }
        is_new |= self.follow_measured(clock);
        is_new |= self.take_advice_news() | self.take_pinned_news();
        (halt, is_new)
    }

    /// Whether the numbers must be read again at `now`, if the traces show `window_s`.
    pub(super) fn is_due(&self, now: Duration, window_s: f64) -> bool {
        self.is_fast(window_s) || now >= self.read_at + reading::EVERY
    }

    /// Whether the run is so fast that numbers read a few times a second would not belong to the picture of each frame.
    fn is_fast(&self, window_s: f64) -> bool {
        let passes_s = reading::EVERY.as_secs_f64();
        self.playback.is_flat_out()
            || matches!(self.playback.speed(), Speed::Times(speed) if speed * passes_s > FAST * window_s)
    }

    /// Reads the numbers, and begins to look for advice if they are doubtful. Returns a message where the strip of the
    /// fast motion now shows another curve of the same run.
    pub(super) fn read(&mut self, now: Duration, view: &View) -> Option<&'static str> {
        self.reading = self.playback.read();
        self.read_at = now;
        self.compare();
        self.read_off(view.cursor);
        let of_this_run = self.has_detail.then_some(self.detail.curve);
        self.choose_detail(now, view);
        let is_other = view.detail_of.is_none()
            && of_this_run.is_some_and(|before| before != self.detail.curve);
        self.explain(view);
        // Not while the user waits for a step to be reached: the search would take a processor from the stepping.
        if self.is_advised
            && self.advisor.is_none()
            && self.playback.steps_to_go().is_none()
            && self.reading.readouts.health.is_believed() == Some(false)
        {
            self.advisor = Some(background::advice(self.to_be_mended()));
        }
        is_other.then_some(match self.detail.curve {
            Curve::Tilt => "the upper strip shows the tilt again: it swings",
            _ => "the upper strip shows x now: it swings, and the tilt does not",
        })
    }

    /// Looks up the numbers at the cursor, unless they are known.
    fn read_off(&mut self, cursor: Option<u64>) {
        let run = self.playback.run();
        let is_known = |(of, sample): &(Arc<Scenario>, Sample)| {
            Some(sample.step) == cursor && Arc::ptr_eq(of, run.scenario())
        };
        if self.at_cursor.as_ref().is_some_and(is_known) {
            return;
        }
        let found = cursor.and_then(|step| lookup::sample(run, step).ok());
        self.at_cursor = found.map(|sample| (Arc::clone(run.scenario()), sample));
    }

    pub fn cursor(&self) -> Option<&Sample> {
        self.at_cursor.as_ref().map(|(_, sample)| sample)
    }

    /// Chooses the window of the strip of the fast motion. While the window passes too fast to be seen, it is chosen
    /// only once in a while.
    fn choose_detail(&mut self, now: Duration, view: &View) {
        let is_fast = match self.playback.speed() {
            _ if !self.playback.is_running() => false,
            Speed::Top => true,
            Speed::Times(speed) => speed * PASSES_S > self.detail.window_s,
        };
        let is_held = is_fast && self.cursor().is_none();
        let is_of_this_run = self.detail.begin_s + self.detail.window_s <= self.run().now().time_s;
        if is_held && self.has_detail && is_of_this_run && now < self.detail_at + HOLD {
            return;
        }
        let wanted = Wanted {
            window_s: view.detail_s,
            curve: view.detail_of,
            long_s: view.window_s,
            place: match self.cursor() {
                Some(cursor) => Placement::About(cursor.time_s),
                None if is_held => Placement::Latest,
                None if self.playback.is_at_end() => Placement::UpToNow,
                None => Placement::Following,
            },
        };
        let (run, readouts) = (self.playback.run(), &self.reading.readouts);
        // The window of another run says nothing about this one.
        let before = self.has_detail.then_some(&self.detail);
        self.detail = Detail::new(run, readouts, &wanted, before);
        (self.detail_at, self.has_detail) = (now, true);
    }

    pub fn run(&self) -> &LiveRun {
        self.playback.run()
    }

    /// The run before, where an edit has begun this one anew.
    pub fn ghost(&self) -> Option<&Ghost> {
        self.ghost.as_ref()
    }

    /// The scheme or time step that would make doubtful numbers right, if one has been found.
    pub fn advice(&self) -> Option<&Advice> {
        self.advisor.as_ref()?.answer()
    }

    /// Gravity, scheme and time step of the step to come.
    pub fn motion(&self) -> Motion {
        let simulation = self.run().simulation();
        in_force(simulation.scenario(), simulation.step_number()).0
    }
}

fn begins_with_exact(scenario: &Scenario) -> Option<bool> {
    scenario.file.view.as_ref()?.exact
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::{scenario, view};

    #[test]
    fn a_run_that_was_played_stays_as_a_ghost() {
        let mut player = Player::new(scenario(), false);
        player.begin(scenario(), false);
        assert!(player.ghost().is_none(), "it stood at its start");
        player.step(100).unwrap();
        player.begin(scenario(), false);
        let end_s = player.ghost().map(Ghost::end_s);
        assert!(end_s.is_some_and(|end_s| (end_s - 10.0).abs() < 1e-9));
        assert_eq!(player.playback.step_number(), 100, "to the same time");
        player.playback.begin(scenario()); // a run that was stopped on its way there
        player.step(1).unwrap();
        player.begin(scenario(), false);
        assert_eq!(
            player.ghost().map(Ghost::end_s),
            end_s,
            "one step is no run"
        );
        player.open(scenario());
        assert!(player.ghost().is_none());
    }

    #[test]
    fn the_search_for_advice_about_a_run_ends_when_an_edit_begins_another() {
        let edits: [fn(&mut Player); 2] = [
            |player| player.begin(scenario(), false),
            |player| player.begin_with_act(&scenario(), false),
        ];
        for edit in edits {
            let mut player = Player::new(scenario(), false);
            player.advisor = Some(background::advice(scenario()));
            edit(&mut player);
            assert!(player.advisor.is_none());
        }
    }

    #[test]
    fn advice_is_sought_where_the_run_stands_and_not_on_its_way() {
        let view = view(&[]);
        let mut player = Player::new(scenario(), false);
        player.is_advised = true;
        player.return_to(100_000_000);
        player.step(1000).unwrap();
        player.return_to(100_000_000);
        player.read(Duration::ZERO, &view);
        assert!(player.advisor.is_none());
        player.pause();
        player.read(Duration::ZERO, &view);
        assert!(player.advisor.is_some());
    }

    #[test]
    fn what_is_kept_is_where_it_is_on_its_way_back_to() {
        let mut player = Player::new(scenario(), false);
        player.return_to(100_000_000);
        assert!(player.playback.step_number() < 100_000_000);
        assert_eq!(player.step_to_keep(), 100_000_000);
        assert!(player.in_words().unwrap().ends_with("Esc stops"));
        player.pause();
        assert_eq!(player.step_to_keep(), player.playback.step_number());
        assert_eq!(player.in_words(), None);
    }
}
