//! The step pane: one time step, one phase per page. A page has the explanation, the formula, the numbers of this step,
//! their effect, and where the 3-D view shows it.
//!
//! The numbers are those of the step itself. Only the angle by which L turns is computed here.

mod numbers;
mod page;
mod why;

use super::{PaneRow, rule};
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{rounded, shortest, significant};
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::step_pane::{StepWorkings, table_of};
use crate::lab::view::step::StepPageChoice;
use crate::lab::view::{Pane, View};
use crate::physics::observables::position;
use crate::physics::workings::{Phase, PhaseName, WorkedQuantity, WorkedValue};
use crate::studies::own_code::{SlipTrial, TRACED_SYMBOL};
use crate::tui::keymap::{self, one};
use crate::tui::theme::Role;
use numbers::{CellFormat, TableView, is_summed};
use page::{StepPageLine, StepPageSection};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::cmp::Ordering;

/// Columns between the names of two phases.
const PHASE_GAP: usize = 2;
/// Maximum change of L_z, as a fraction of L, that counts as rounding.
const SAME_HEIGHT: f64 = 1e-12;

/// Rank of less important numbers while the rows of a table are added up.
const ASIDE: u8 = 10;
/// Number from which a point of the rim is named by its number alone, because the column is too narrow for more.
const SHORT_NAMES_FROM: usize = 1000;

pub const STEP_ROW: PaneRow = PaneRow {
    id: Pane::Step,
    title: "step",
    draw,
    keys: keymap::STEP_KEYS,
    arrows: Some(|lab, direction, times| {
        one(lab.step_pane().other_sum(direction, times, lab.view())?)
    }),
};

fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let view = lab.view();
    let (title, place) = titles(lab);
    let right = Some((place.as_str(), Role::Label)).filter(|_| !place.is_empty());
    let has_focus = view.marks_focus_of(STEP_ROW.id);
    let inside = rule(&title, right, has_focus, area, &view.theme, buf);
    if inside.is_empty() {
        return;
    }
    match lab.step_pane().shown() {
        None => nothing_yet(lab, inside, buf),
        Some(_) if view.look.phase == StepPageChoice::Why => why::draw(lab, inside, buf),
        Some(explained) => {
            if let Some((phase, number, _)) = explained.phase(view.look.phase) {
                let own = lab.comparison().own_code();
                let page = PhasePage {
                    explained,
                    phase,
                    number,
                    trial: own.and_then(|own| trial_of(own.trial()?, explained.step, phase)),
                    view,
                    width: inside.width.into(),
                };
                let sections = page.sections(inside.height.into());
                page::draw(&sections, inside, &view.theme, buf);
            }
        }
    }
}

/// Returns the texts on the rule, left and right: the step, and the phase of the page.
fn titles(lab: &Lab) -> (String, String) {
    let Some(explained) = lab.step_pane().shown() else {
        return (STEP_ROW.title.to_owned(), String::new());
    };
    let step = explained.step;
    let place = match explained.phase(lab.view().look.phase) {
        Some((_, number, count)) => format!("phase {number} of {count}"),
        None => "why sideways, not down?".to_owned(),
    };
    (format!("step {} → {step}", step - 1), place)
}

/// Tells the user how to get a step that can be explained.
fn nothing_yet(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let player = lab.player();
    let texts: [&str; 2] = if player.step_number() == 0 {
        [
            "No time step has been taken yet.",
            "Press . to take the first. It is then shown here phase by phase, with formulas and numbers.",
        ]
    } else if player.is_busy() {
        [
            "The run is playing.",
            "Press space to pause it. The last time step is then shown here phase by phase.",
        ]
    } else {
        [
            "This time step would take too long to compute again.",
            "Press . to take the next time step, which is then shown here phase by phase.",
        ]
    };
    let sections =
        texts.map(|text| StepPageSection::text(0, text, area.width.into(), 0, Role::Text));
    page::draw(&sections, area, &lab.view().theme, buf);
}

/// A page about a phase.
struct PhasePage<'a> {
    explained: &'a StepWorkings,
    phase: &'a Phase,
    number: usize,
    /// Description of the slip in the user's program, and that program's numbers for the phase.
    trial: Option<(&'a str, Vec<WorkedQuantity>)>,
    view: &'a View,
    width: usize,
}

impl PhasePage<'_> {
    /// Returns the sections of the page for `room` lines.
    fn sections(&self, room: usize) -> Vec<StepPageSection> {
        let [happens, changes, seen] = words_of(self.phase.name);
        let text =
            |rank, text, indent, role| StepPageSection::text(rank, text, self.width, indent, role);
        let mut sections = Vec::new();
        sections.push(self.list());
        if let Some((words, _)) = &self.trial {
            let words = format!("yours has {words}");
            let section = StepPageSection::text(1, &words, self.width, 2, Role::Measured);
            sections.push(section);
        }
        sections.push(text(1, self.phase.formula, 2, Role::Heading).apart());
        sections.push(text(2, happens, 0, Role::Text));
        let part = self.part();
        sections.push(text(8, &part, 0, Role::Label));
        sections.extend(self.quantities());
        sections.push(self.labelled(4, "changes", changes).apart());
        sections.push(self.labelled(6, "in 3-D", seen));
        let outcome = self.outcome();
        sections.push(text(3, &outcome, 0, Role::Text).apart());
        sections.retain(|section| section.lines.iter().any(|line| !line.is_blank()));
        page::fit(&mut sections, room);
        self.fill_tables(&mut sections, room);
        page::spread(&mut sections, room);
        sections
    }

    /// Returns all phases in one row: the finished ones, the current one, and those to come.
    ///
    /// If there is no room for all names, only the current phase has a name, and the others have numbers.
    fn list(&self) -> StepPageSection {
        let phases: Vec<_> = self.explained.workings.phases().zip(1..).collect();
        let named = |phase: &Phase, number: usize| format!("{number} {}", short_name(phase.name));
        let whole = phases
            .iter()
            .map(|(phase, number)| columns(&named(phase, *number)) + PHASE_GAP);
        let has_names = whole.sum::<usize>() <= self.width;
        let mut items: Vec<_> = phases
            .into_iter()
            .map(|(phase, number)| match number.cmp(&self.number) {
                Ordering::Equal => (format!(" {} ", named(phase, number)), Role::Selected),
                _ if has_names => (named(phase, number), role_beside(number, self.number)),
                _ => (number.to_string(), role_beside(number, self.number)),
            })
            .collect();
        // The first ones are dropped until the current one is visible.
        while columns_until_present(&items) > self.width && items.len() > 1 {
            items.remove(0);
        }
        let mut line = StepPageLine::default();
        let mut at = 0;
        for (text, role) in items {
            // The blanks around the current one are part of the gap.
            let blank = usize::from(role == Role::Selected);
            let begin = at - blank.min(at);
            at = begin + columns(&text) + PHASE_GAP - blank;
            line.pieces.push((begin, text, role));
        }
        StepPageSection::new(2, vec![line])
    }

    /// Returns a text on the part of the step to which the phase belongs; empty if the step has only one part.
    fn part(&self) -> String {
        let parts = &self.explained.workings.parts;
        let mut phases = 0;
        let part = parts.iter().position(|part| {
            phases += part.phases.len();
            phases >= self.number
        });
        let Some(part) = part.filter(|_| parts.len() > 1) else {
            return String::new();
        };
        let (number, count) = (part + 1, parts.len());
        let length_s = shortest(rounded(parts[part].length_s, 6));
        format!("part {number} of {count} of the step, which is {length_s} s long")
    }

    /// Returns the effect of the phase on L in words; empty if the phase does not change L.
    fn outcome(&self) -> String {
        let [old, new] = ["L", "new L"].map(|symbol| match self.phase.value(symbol) {
            Some(WorkedValue::Vector(vector)) => Some(*vector),
            _ => None,
        });
        let Some(new) = new else {
            return String::new();
        };
        let old = old.unwrap_or(self.explained.states.0.momentum);
        let turn_deg = libm::atan2(old.cross(&new).norm(), old.dot(&new)).to_degrees();
        let turn = significant(turn_deg, 3);
        let rises = new.z - old.z;
        if rises.abs() <= SAME_HEIGHT * old.norm() {
            format!("L turns by {turn}°; its z does not change: sideways, not down.")
        } else {
            format!(
                "L turns by {turn}°; its z changes by {} J s.",
                significant(rises, 3)
            )
        }
    }

    /// Returns a section with `label` before `text`.
    fn labelled(&self, rank: u8, label: &str, text: &str) -> StepPageSection {
        let column = label.len() + 2;
        let mut section =
            StepPageSection::text(rank, text, self.width.saturating_sub(column), 0, Role::Text);
        for piece in section.lines.iter_mut().flat_map(|line| &mut line.pieces) {
            piece.0 = column;
        }
        if let Some(first) = section.lines.first_mut() {
            first.pieces.push((0, format!("{label}:"), Role::Label));
        }
        section.lines.retain(|_| !text.is_empty());
        section
    }

    /// Returns the numbers of the phase. Tables have their minimum number of lines.
    fn quantities(&self) -> Vec<StepPageSection> {
        let all = &self.phase.quantities;
        let format = CellFormat::of_vectors(self.width);
        let adds_up = self.sum().is_some();
        // While points are added up, quantities computed from the full sums are less important.
        let is_aside = |quantity: &WorkedQuantity| adds_up && is_made_of_sums(self.phase, quantity);
        let has_heads = |quantity: &&WorkedQuantity| {
            matches!(
                quantity.value,
                WorkedValue::Vector(_) | WorkedValue::Matrix(_)
            )
        };
        let is_headed = all.iter().filter(has_heads).all(is_aside);
        let mut heads = Some(numbers::heads(if is_headed { ASIDE } else { 5 }, format).apart());
        let mut sections = Vec::new();
        for (index, quantity) in all.iter().enumerate() {
            if let WorkedValue::Table(table) = &quantity.value {
                sections.extend((!table.points.is_empty()).then(|| StepPageSection {
                    table: Some(index),
                    ..StepPageSection::new(0, self.table(index, 0)).apart()
                }));
                continue;
            }
            if has_heads(&quantity) {
                sections.extend(heads.take());
            }
            let is_last = index + 1 == all.len();
            let rank = match quantity.symbol {
                _ if is_aside(quantity) => ASIDE,
                _ if is_last => 0,
                "S" => 7,
                _ => 3,
            };
            sections.push(StepPageSection::new(
                rank,
                numbers::lines(quantity, format, is_last),
            ));
            sections.extend(self.yours(quantity, format));
        }
        sections.extend(self.traced(heads, format));
        sections
    }

    /// Returns the traced point after the step, in the run and in the user's program, if that has a slip.
    fn traced(&self, heads: Option<StepPageSection>, format: CellFormat) -> Vec<StepPageSection> {
        let (scenario, (_, after)) = (&self.explained.scenario, &self.explained.states);
        let at = position(&scenario.body.mechanics, after, scenario.trace);
        let traced = WorkedQuantity::new(TRACED_SYMBOL, "m", at);
        let Some(yours) = self.yours(&traced, format) else {
            return Vec::new();
        };
        let own = StepPageSection::new(3, numbers::lines(&traced, format, false));
        heads.into_iter().chain([own, yours]).collect()
    }

    /// Returns the user's program's numbers for `quantity`, or a note that they are the same.
    fn yours(&self, quantity: &WorkedQuantity, format: CellFormat) -> Option<StepPageSection> {
        let (_, numbers) = self.trial.as_ref()?;
        let yours = numbers.iter().find(|it| it.symbol == quantity.symbol)?;
        let mut lines = numbers::lines(yours, format, false);
        if lines == numbers::lines(quantity, format, false) {
            lines = vec![StepPageLine::new(
                numbers::SYMBOL + 1,
                "the same",
                Role::Measured,
            )];
        }
        let pieces = lines.iter_mut().flat_map(|line| &mut line.pieces);
        pieces.for_each(|piece| piece.2 = Role::Measured);
        lines[0].pieces.retain(|piece| piece.0 >= numbers::SYMBOL);
        lines[0]
            .pieces
            .push((0, "yours".to_owned(), Role::Measured));
        Some(StepPageSection::new(1, lines))
    }

    /// Returns the number of rows that are added up, and their sums.
    fn sum(&self) -> Option<(usize, Vec<f64>)> {
        let table = table_of(self.phase)?;
        let rows = self.view.look.sum_to?.min(table.points.len());
        Some((
            rows,
            self.explained.sums(self.view.look.phase, table, rows)?,
        ))
    }

    /// Returns the lines of the table with this index among the quantities: `room` lines, or its minimum if that is
    /// more.
    fn table(&self, index: usize, room: usize) -> Vec<StepPageLine> {
        let WorkedValue::Table(table) = &self.phase.quantities[index].value else {
            return Vec::new();
        };
        let is_first = table_of(self.phase).is_some_and(|first| std::ptr::eq(first, table));
        let scenario = &self.explained.scenario;
        let view = TableView {
            table,
            sum: self.sum().filter(|_| is_first),
            name: &|point| name_of(scenario, point),
            width: self.width,
        };
        view.lines(room.max(view.least()))
    }

    /// Gives the remaining lines to the tables.
    fn fill_tables(&self, sections: &mut [StepPageSection], room: usize) {
        let mut left = room.saturating_sub(page::height(sections));
        for section in sections {
            if let Some(index) = section.table {
                let had = section.lines.len();
                section.lines = self.table(index, had + left);
                left = left.saturating_sub(section.lines.len().saturating_sub(had));
            }
        }
    }
}

/// Returns the role of the name of phase `number` next to the `present` one: finished or to come.
const fn role_beside(number: usize, present: usize) -> Role {
    if number < present {
        Role::Text
    } else {
        Role::Label
    }
}

/// Returns the columns of the phases up to the current one.
fn columns_until_present(items: &[(String, Role)]) -> usize {
    let shown = items.iter().take_while(|(_, role)| *role != Role::Label);
    shown.map(|(text, _)| columns(text) + PHASE_GAP).sum()
}

/// Returns the name of a phase in one or two words.
const fn short_name(name: PhaseName) -> &'static str {
    match name {
        PhaseName::Inertia => "inertia",
        PhaseName::AngularVelocity => "Ω",
        PhaseName::AxisAndAngle => "axis",
        PhaseName::Rotation => "rotation",
        PhaseName::NewPositions => "positions",
        PhaseName::Torque => "torque",
        PhaseName::NewMomentum => "new L",
        PhaseName::Friction => "friction",
        PhaseName::Kick => "kick",
        PhaseName::FreeMotion => "free",
        PhaseName::SpinAboutAxle => "spin",
        PhaseName::RoundingTakenOut => "rounding",
        PhaseName::NewOrientation => "new Q",
        PhaseName::Slope1AtBeginning => "slope 1",
        PhaseName::Slope2HalfWay => "slope 2",
        PhaseName::Slope3HalfWay => "slope 3",
        PhaseName::Slope4AtEnd => "slope 4",
        PhaseName::ThetaFunctions => "theta",
        PhaseName::TaylorSeries => "series",
    }
}

/// Returns the contribution of the chosen point to the sums of the table, written out, or `None` if no point is chosen.
pub(super) fn about_point(lab: &Lab) -> Option<String> {
    let view = lab.view();
    let shown = lab.step_pane().shown();
    let explained = shown.filter(|_| view.shows(Pane::Step))?;
    let (phase, ..) = explained.phase(view.look.phase)?;
    let table = table_of(phase)?;
    let row = view.look.sum_to?.checked_sub(1)?;
    let point = *table.points.get(row)?;
    let name = name_of(&explained.scenario, point);
    let mass_kg = explained.scenario.body.mechanics.points()[point].mass;
    if is_summed(table) && mass_kg == 0.0 {
        return Some(format!("{name} has no mass and adds nothing"));
    }
    let short = |number: f64| significant(number, 4);
    let [of_x, of_y] = match (table.columns.first()?.0, table.row(row)) {
        ("m", [m, x, y, _, xx, yy, ..]) => {
            [("x", x, xx), ("y", y, yy)].map(|(axis, at, product)| {
                let (m, at, product) = (short(*m), short(*at), short(*product));
                format!("m {axis}² = {m} · ({at})² = {product} kg m²")
            })
        }
        ("m x", [x, y, ..]) => [("x", x), ("y", y)].map(|(axis, product)| {
            let (m, at, product) = (short(mass_kg), short(product / mass_kg), short(*product));
            format!("m {axis} = {m} · {at} = {product} kg m")
        }),
        _ => return None,
    };
    Some(format!("{name}: {of_x}, {of_y}"))
}

/// Returns the description of the slip in `trial`, and its numbers of `phase` in the time step `step`.
fn trial_of<'a>(
    trial: &'a SlipTrial,
    step: u64,
    phase: &Phase,
) -> Option<(&'a str, Vec<WorkedQuantity>)> {
    let numbers = trial.numbers(step)?.into_iter();
    let of_phase = numbers.filter(|(name, _)| *name == phase.name);
    Some((&trial.words, of_phase.map(|(_, it)| it).collect()))
}

/// Returns true if `quantity` of `phase` is computed from the sums over the table's rows.
fn is_made_of_sums(phase: &Phase, quantity: &WorkedQuantity) -> bool {
    let table = table_of(phase);
    table.is_some_and(is_summed) && matches!(quantity.symbol, "S" | "I" | "Σ m X")
}

/// Returns the name of the point with this index. A point of the rim has its number on the rim.
pub(super) fn name_of(scenario: &Scenario, point: usize) -> String {
    match scenario.point_name(point) {
        Some(name) => name,
        None if point < SHORT_NAMES_FROM => format!("rim {point}"),
        None => point.to_string(),
    }
}

/// Returns three texts on a phase: the explanation, the quantity that it changes and its purpose, and where the 3-D
/// view shows it. A text is empty if there is nothing to say.
#[rustfmt::skip]
const fn words_of(phase: PhaseName) -> [&'static str; 3] {
    match phase {
        PhaseName::Inertia => ["The mass distribution about the pivot, added up point by point.", "nothing yet; gives I", "the body before the step (gray)"],
        PhaseName::AngularVelocity => ["The current axis of rotation and its speed: L divided by the inertia.", "nothing yet; gives Ω", "the arrow Ω"],
        PhaseName::AxisAndAngle => ["The line u along Ω, and the angle about it in one time step.", "nothing yet; gives u and the angle", "the line u through the pivot"],
        PhaseName::Rotation => ["The matrix that turns any point about u by that angle.", "nothing yet; gives R", "the body before (gray) and after"],
        PhaseName::NewPositions => ["R turns every point to its new position.", "the positions of the points", "the body before (gray) and after"],
        PhaseName::Torque => ["The torque of the forces about the pivot, with each point where it is now.", "nothing yet; gives τ", "the arrows τ, weight and F"],
        PhaseName::NewMomentum => ["In the time dt the forces change L. The next step begins with the new L.", "only L", "the arrow L, and dL at its tip"],
        PhaseName::Friction => ["Friction slows spin and swing: it reduces L while the body does not move.", "only L", "the arrow L"],
        PhaseName::Kick => ["The forces act for the time h: they change L while the body does not move.", "only L", "the arrow L, and dL at its tip"],
        PhaseName::FreeMotion => ["The body moves for the time h as if there were no forces: L stays constant.", "the orientation", "the body before (gray) and after"],
        PhaseName::SpinAboutAxle => ["The body turns about its own axle, once for the whole step.", "the rotation about the axle", "the body before (gray) and after"],
        PhaseName::RoundingTakenOut => ["Rounding has distorted the orientation slightly: it is made a rotation again.", "the orientation, by a rounding error", ""],
        PhaseName::NewOrientation => ["The orientation at the end of the step.", "the orientation", "the body before (gray) and after"],
        PhaseName::Slope1AtBeginning => ["The rates of change of orientation and momentum as the step begins.", "nothing yet; four slopes make a step", "the arrow Ω"],
        PhaseName::Slope2HalfWay => ["The rates after half the step, if slope 1 applied until then.", "nothing yet; four slopes make a step", "the arrow Ω"],
        PhaseName::Slope3HalfWay => ["The rates after half the step again, now with slope 2: more accurate.", "nothing yet; four slopes make a step", "the arrow Ω"],
        PhaseName::Slope4AtEnd => ["The rates as the step ends, if slope 3 applied to the whole step.", "nothing yet; four slopes make a step", "the arrow Ω"],
        PhaseName::ThetaFunctions => ["Two complex numbers for the orientation at the time t, exact for any time step.", "nothing yet; gives α and β", ""],
        PhaseName::TaylorSeries => ["Orientation and momentum at the time t, from a series exact to the last digits.", "the orientation, and L", "the body before (gray) and after"],
    }
}
