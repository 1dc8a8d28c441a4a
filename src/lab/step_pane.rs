//! The time step that the step pane explains, and the commands of the pane's keys.

use super::action::{Direction, PAGE_KEY_ROWS};
use super::command::{Command, SeekTarget};
use super::player::Player;
use super::view::step::StepPageChoice;
use super::view::{Pane, View};
use crate::engine::scenario::Scenario;
use crate::engine::scenario::screen::ALL_ROWS;
use crate::lab::playback::loop_minimum::Dip;
use crate::physics::workings::{ColumnSums, Phase, PhaseName, PointTable, WorkedValue};
use crate::physics::{State, Workings};
use std::sync::Arc;

/// Maximum number of points of a body whose steps are explained while the run moves. The step of a larger body is
/// explained once the run is paused.
const MOST_POINTS_MOVING: usize = 1000;

/// A time step with the intermediate results of its scheme.
#[derive(Clone, Debug)]
pub struct StepWorkings {
    pub step: u64,
    pub states: (State, State),
    /// The intermediate results from which the step itself was computed.
    pub workings: Arc<Workings>,
    pub scenario: Arc<Scenario>,
    /// The running sums of the table on the page, with the index of its phase; `None` if no rows are added up.
    sums: Option<(usize, ColumnSums)>,
    /// The first dip of the run up to this step; `None` if the page does not show it or the axle was upright.
    pub dip: Option<Dip>,
}

impl StepWorkings {
    /// Reads the intermediate results of the latest step; `None` at step 0.
    fn read(player: &mut Player) -> Option<Self> {
        let now = player.run().simulation().now();
        let (step, states) = (now.number(), (*now.before()?, *now.after()));
        let scenario = Arc::clone(now.scenario());
        Some(Self {
            step,
            states,
            workings: player.run.workings()?,
            scenario,
            sums: None,
            dip: None,
        })
    }

    /// Returns the phase on `page` with its number, from 1, and the number of phases; `None` for a page without a
    /// phase.
    pub fn phase(&self, page: StepPageChoice) -> Option<(&Phase, usize, usize)> {
        let index = page.index(&self.workings)?;
        let phase = self.workings.phases().nth(index)?;
        Some((phase, index + 1, self.workings.phases().count()))
    }

    /// Returns the sum of each column over the first `rows` rows of `table`, the one on `page`; `None` if no sum was
    /// requested.
    pub fn sums(&self, page: StepPageChoice, table: &PointTable, rows: usize) -> Option<Vec<f64>> {
        let (of, sums) = self.sums.as_ref()?;
        (Some(*of) == page.index(&self.workings)).then(|| sums.first(table, rows))
    }

    /// Computes the sums or the dip that the page of `view` needs, unless they exist.
    fn complete(&mut self, view: &View) {
        let index = view.look.phase.index(&self.workings);
        let known = self.sums.as_ref().map(|(of, _)| *of);
        if view.look.sum_to.is_some() && index.is_some() && known != index {
            let phase = self.phase(view.look.phase);
            let table = phase.and_then(|(phase, ..)| table_of(phase));
            self.sums = index.zip(table.map(ColumnSums::from_table));
        }
        if view.look.phase == StepPageChoice::Why && self.dip.is_none() {
            self.dip = Dip::compute(&self.scenario, self.step);
        }
    }
}

/// Returns the table of `phase` whose rows are added up: its first table, if that has rows.
pub fn table_of(phase: &Phase) -> Option<&PointTable> {
    let mut values = phase.quantities.iter().map(|quantity| &quantity.value);
    let first = values.find_map(|value| match value {
        WorkedValue::Table(table) => Some(table),
        _ => None,
    });
    first.filter(|table| !table.points.is_empty())
}

#[derive(Default)]
pub struct StepPane {
    shown: Option<StepWorkings>,
}

impl StepPane {
    /// Returns the time step that the pane explains; `None` at step 0 and while the pane is hidden.
    pub fn shown(&self) -> Option<&StepWorkings> {
        self.shown.as_ref()
    }

    /// Reads the intermediate results of the present step if the pane is shown.
    pub(super) fn read(&mut self, player: &mut Player, view: &View) {
        player.keeps_workings = view.shows(Pane::Step);
        let now = player.run().simulation().now();
        let (number, scenario) = (now.number(), Arc::clone(now.scenario()));
        let is_large = scenario.body.mechanics.points().len() > MOST_POINTS_MOVING;
        let is_known = self.shown.as_ref().is_some_and(|known| {
            known.step == number && Arc::ptr_eq(&known.scenario, player.run().scenario())
        });
        if !player.keeps_workings || number == 0 || (is_large && player.is_moving()) {
            self.shown = None;
        } else if !is_known {
            self.shown = StepWorkings::read(player);
        }
        if player.keeps_workings {
            player.run.keep_workings(false);
        }
        if let Some(shown) = &mut self.shown {
            shown.complete(view);
        }
    }

    /// Checks that the scheme of the present step has the phase that `page` names.
    ///
    /// # Errors
    /// Returns an error that lists the scheme's phases if it does not have this one.
    pub(super) fn may_show(&self, page: StepPageChoice, player: &Player) -> Result<(), String> {
        let (StepPageChoice::Named(name), Some(shown)) = (page, &self.shown) else {
            return Ok(());
        };
        let phases = shown.workings.phases();
        let mut names: Vec<_> = phases.map(|phase| phase.name).collect();
        if names.contains(&name) {
            return Ok(());
        }
        names.dedup();
        let scheme = player.run().simulation().now().motion().scheme.name;
        let texts: Vec<_> = names.into_iter().map(PhaseName::text).collect();
        Err(format!(
            "{scheme} has no phase {name}: it has {}",
            texts.join(", ")
        ))
    }

    /// Returns the commands that move `times` phases forward, or back if negative. After the last phase of a step comes
    /// the first phase of the next step.
    pub fn other_phase(
        &self,
        times: i32,
        view: &View,
        player: &Player,
    ) -> Result<Vec<Command>, String> {
        let first = Command::look("phase", StepPageChoice::default());
        if player.is_moving() {
            return Ok(vec![Command::Pause]);
        }
        let here = player.step_number();
        let Some(shown) = &self.shown else {
            return if times > 0 {
                Ok(vec![Command::Step(1), first])
            } else {
                Err("the run begins here: . takes the first time step".to_owned())
            };
        };
        let count = shown.workings.phases().count().max(1) as i64;
        let at = match view.look.phase.index(&shown.workings) {
            Some(index) => index as i64,
            None if times > 0 => count - 1,
            None => count,
        };
        let target = at + i64::from(times);
        let (steps, index) = (target.div_euclid(count), target.rem_euclid(count));
        let page = match (steps, index) {
            (..0, index) if index == count - 1 => StepPageChoice::Last,
            _ => StepPageChoice::Number(index as usize + 1),
        };
        if steps == 0 {
            return Ok(vec![Command::look("phase", page)]);
        }
        if steps < 0 && steps.unsigned_abs() >= here {
            return Ok(vec![Command::GoTo(SeekTarget::Start), first]);
        }
        Ok(vec![Command::Step(steps), Command::look("phase", page)])
    }

    /// Returns the command that adds up more rows of the table, or fewer. Past either end all rows are added up.
    pub fn other_sum(
        &self,
        direction: Direction,
        times: i32,
        view: &View,
    ) -> Result<Command, String> {
        let phase = self
            .shown
            .as_ref()
            .and_then(|shown| shown.phase(view.look.phase));
        let Some(table) = phase.and_then(|(phase, ..)| table_of(phase)) else {
            return Err("no table here: . and , go through the phases".to_owned());
        };
        let all = table.points.len() as i64;
        if direction.is_sideways() {
            return Err("Up and Down add up the table; . and , go by phase".to_owned());
        }
        let rows = direction.rows(PAGE_KEY_ROWS) as i64 * i64::from(times);
        let now = match view.look.sum_to {
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

impl View {
    /// Returns the commands that show why the axle moves sideways, in the step pane. If that page is shown already,
    /// they return to the page before.
    pub fn why_sideways(&self) -> Vec<Command> {
        let is_open = self.shows(Pane::Step);
        let page = match self.look.phase {
            StepPageChoice::Why if is_open => self.page_before,
            _ => StepPageChoice::Why,
        };
        let mut commands = if is_open {
            Vec::new()
        } else {
            self.toggled(Pane::Step)
        };
        commands.push(Command::look("phase", page));
        commands
    }
}
