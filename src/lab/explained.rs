//! The time step that the step pane takes apart, and what its keys do.

use super::action::Direction;
use super::command::{Command, Place};
use super::player::Player;
use super::steering::PAGE;
use super::view::View;
use super::view::step::Page;
use super::{Lab, Pane};
use crate::physics::workings::{Phase, Sums, Table, Value};
use crate::physics::{State, Workings};
use crate::playback::dip::Dip;
use crate::scenario::Scenario;
use crate::scenario::screen::ALL_ROWS;
use std::sync::Arc;

/// The most points of a body whose steps are taken apart while the run goes on. The step of a larger body is taken
/// apart once the run stands still.
const MOST_POINTS_MOVING: usize = 1000;

/// A time step with the intermediate results of its scheme.
#[derive(Clone, Debug)]
pub struct Explained {
    pub step: u64,
    pub states: (State, State),
    /// The intermediate results: the numbers that made the step itself.
    pub workings: Arc<Workings>,
    pub scenario: Arc<Scenario>,
    /// The sums of the table on the page, if some of its rows are added up.
    sums: Option<(usize, Sums)>,
    /// The first dip of the run, where the page shows it.
    dip: Option<Dip>,
}

impl Explained {
    /// The first dip of the run up to this step; `None` where the page does not show it, and where the axle was upright.
    pub fn dip(&self) -> Option<&Dip> {
        self.dip.as_ref()
    }

    /// The phase on `page` with its number, from 1, and how many there are; `None` for a page that shows none.
    pub fn phase(&self, page: Page) -> Option<(&Phase, usize, usize)> {
        let index = page.index(&self.workings)?;
        let phase = self.workings.phases().nth(index)?;
        Some((phase, index + 1, self.workings.phases().count()))
    }

    /// The sum of each column over the first `rows` rows of `table`, the one on `page`; `None` where nobody has
    /// asked for one.
    pub fn sums(&self, page: Page, table: &Table, rows: usize) -> Option<Vec<f64>> {
        let (of, sums) = self.sums.as_ref()?;
        (Some(*of) == page.index(&self.workings)).then(|| sums.first(table, rows))
    }

    /// Makes the sums that `view` asks for, unless they are there.
    fn add_up(&mut self, view: &View) {
        let index = view.page.index(&self.workings);
        let known = self.sums.as_ref().map(|(of, _)| *of);
        if view.sum_to.is_some() && index.is_some() && known != index {
            let phase = self.phase(view.page);
            let table = phase.and_then(|(phase, ..)| table_of(phase));
            self.sums = index.zip(table.map(Sums::of));
        }
    }
}

/// The table of `phase` whose rows are added up: its first, if it has rows.
pub fn table_of(phase: &Phase) -> Option<&Table> {
    let mut values = phase.quantities.iter().map(|quantity| &quantity.value);
    let first = values.find_map(|value| match value {
        Value::Table(table) => Some(table),
        _ => None,
    });
    first.filter(|table| !table.points.is_empty())
}

impl Player {
    /// Takes the present step apart where the step pane is shown.
    pub(super) fn explain(&mut self, view: &View) {
        self.explains = view.shows_step();
        let now = self.run().simulation().now();
        let (number, scenario) = (now.number(), Arc::clone(now.scenario()));
        let is_large = scenario.body.mechanics.points().len() > MOST_POINTS_MOVING;
        if !self.explains || number == 0 || (is_large && self.is_moving()) {
            self.explained = None;
            return;
        }
        let is_known = |known: &Explained| {
            known.step == number && Arc::ptr_eq(&known.scenario, self.run().scenario())
        };
        if !self.explained.as_ref().is_some_and(is_known) {
            self.explained = self.taken_apart();
        }
        if let Some(explained) = &mut self.explained {
            explained.add_up(view);
            if view.page == Page::Why && explained.dip.is_none() {
                explained.dip = Dip::of(&explained.scenario, explained.step);
            }
        }
    }

    /// Takes one time step. Where the step pane is shown, it keeps the intermediate results, so that the step need not
    /// be taken a second time for the pane.
    pub(super) fn take_one_step(&mut self) {
        self.playback.keep_workings(self.explains);
        self.playback.take_steps(1);
        if self.explains {
            self.explained = self.taken_apart();
            self.playback.keep_workings(false);
        }
    }

    /// Refuses a page that names a phase which the scheme of the present step does not have.
    pub(super) fn may_show(&self, page: Page) -> Result<(), String> {
        let (Page::Named(name), Some(explained)) = (page, self.explained()) else {
            return Ok(());
        };
        let phases = explained.workings.phases();
        let mut names: Vec<_> = phases.map(|phase| phase.name).collect();
        if names.contains(&name) {
            return Ok(());
        }
        names.dedup();
        let scheme = self.run().simulation().now().motion().scheme.name;
        let names = names.join(", ");
        Err(format!("{scheme} has no phase {name}: it has {names}"))
    }

    fn taken_apart(&mut self) -> Option<Explained> {
        let now = self.run().simulation().now();
        let (step, states) = (now.number(), (*now.before()?, *now.after()));
        let scenario = Arc::clone(now.scenario());
        Some(Explained {
            step,
            states,
            workings: self.playback.workings()?,
            scenario,
            sums: None,
            dip: None,
        })
    }

    /// The time step that the step pane takes apart; `None` at step 0, and while that pane is not shown.
    pub fn explained(&self) -> Option<&Explained> {
        self.explained.as_ref()
    }
}

impl Lab {
    /// Shows the step pane beside another one, or takes it away.
    pub(super) fn toggle_step(&mut self) {
        let is_shown = self.view.shows_step();
        let mut commands = Vec::new();
        if self.view.filled {
            commands.push(Command::Fill(None));
        }
        if self.view.shown.contains(&Pane::STEP) == is_shown {
            commands.push(Command::look("show", self.view.with_step_toggled()));
        }
        self.carry_out_all(&commands);
        if !is_shown {
            self.view.turn_to(Pane::STEP);
        }
    }

    /// The commands that go `times` phases forward or back. The first phase of the next step follows the last phase of
    /// a step.
    pub(super) fn other_phase(&self, times: i64) -> Result<Vec<Command>, String> {
        let first = Command::look("phase", Page::default());
        if self.player.is_moving() {
            return Ok(vec![Command::Pause]);
        }
        let here = self.player.playback.step_number();
        let Some(explained) = self.player.explained() else {
            return if times > 0 {
                Ok(vec![Command::Step(1), first])
            } else {
                Err("the run begins here: . takes the first time step".to_owned())
            };
        };
        let count = explained.workings.phases().count().max(1) as i64;
        let at = match self.view.page.index(&explained.workings) {
            Some(index) => index as i64,
            None if times > 0 => count - 1,
            None => count,
        };
        let target = at.saturating_add(times);
        let (steps, index) = (target.div_euclid(count), target.rem_euclid(count));
        let page = match (steps, index) {
            (..0, index) if index == count - 1 => Page::Last,
            _ => Page::Number(index as usize + 1),
        };
        if steps == 0 {
            return Ok(vec![Command::look("phase", page)]);
        }
        let before = steps.unsigned_abs();
        if steps < 0 && before >= here {
            return Ok(vec![Command::GoTo(Place::Start), first]);
        }
        Ok(vec![Command::Step(steps), Command::look("phase", page)])
    }

    /// The command that shows why the axle goes sideways, or the first phase again.
    pub(super) fn why_toggled(&self) -> Command {
        let page = match self.view.page {
            Page::Why => self.view.page_before,
            _ => Page::Why,
        };
        Command::look("phase", page)
    }

    /// The command that adds up more rows of the table in the step pane, or fewer. Beyond either end all rows are added
    /// up.
    pub(super) fn other_sum(&self, direction: Direction, times: i32) -> Result<Command, String> {
        let explained = self.player.explained();
        let phase = explained.and_then(|explained| explained.phase(self.view.page));
        let Some(table) = phase.and_then(|(phase, ..)| table_of(phase)) else {
            return Err("no table here: . and , go through the phases".to_owned());
        };
        let all = table.points.len() as i64;
        if matches!(direction, Direction::Left | Direction::Right) {
            return Err("Up and Down add up the table; . and , go by phase".to_owned());
        }
        let rows = direction.rows(PAGE) as i64 * i64::from(times);
        let now = match self.view.sum_to {
            Some(now) => (now as i64).min(all),
            None if rows > 0 => 0,
            None => all,
        };
        let next = now + rows;
        Ok(if (1..=all).contains(&next) {
            Command::look("sum_to", next)
        } else {
            Command::look("sum_to", ALL_ROWS)
        })
    }
}
