//! The arrows of the scene, and the line that says what their letters mean. Where the step pane is shown, only the arrows
//! that its phase is about, the axis of its turn, and the body as it stood before the step.

use super::super::{MOST_SHOWN_PUSHES, in_lines};
use super::body::BodySign;
use super::{CHANGE_ARROW_SHARE, MOMENTUM_ARROW_LENGTH, SceneSubject, SpaceLabel, write};
use crate::lab::step_pane::{StepWorkings, table_of};
use crate::lab::view::{Pane, View};
use crate::physics::workings::{Phase, PhaseName, WorkedValue};
use crate::physics::{State, observables};
use crate::tui::dots::Ink;
use crate::tui::scene::{DepthBias, DotScene, LineStroke};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Length of the arrow of the angular velocity, in lengths of the axle.
const OMEGA_ARROW_LENGTH: f64 = 1.17;
/// Lengths of the other arrows, as shares of the body's size. Only their directions have a meaning.
const WEIGHT: f64 = 0.35;
const TORQUE_ARROW_SHARE: f64 = 0.5;
const PUSH_ARROW_LENGTH: f64 = 0.4;
/// How far the axis of a turn goes beyond the body on both sides, as a share of its size.
const AXIS: f64 = 1.0;
/// Directions that differ by less than this, rad, are drawn as one.
const DISTINCT_DIRECTIONS_RAD: f64 = 0.03;

/// What a letter means, at length, in short and as the letter alone; and how its arrow is drawn.
fn meaning(letter: &str) -> (LegendText, DepthBias) {
    match letter {
        // The axle is whole where it is seen upright.
        "g" => (
            (["g weight", "g weight", "g"], Role::Push),
            DepthBias::BehindRod,
        ),
        "Ω" => (
            (["Ω angular velocity", "Ω", "Ω"], Role::Y),
            DepthBias::Arrow,
        ),
        "u" => (
            (["u axis of the turn", "u axis", "u"], Role::Y),
            DepthBias::Farther,
        ),
        // These are short and cross the rim, which would hide them.
        "τ" => (
            (["τ torque", "τ torque", "τ"], Role::X),
            DepthBias::Everything,
        ),
        "dL" => ((["dL = τ dt", "dL", "dL"], Role::X), DepthBias::Everything),
        "F" => (
            (["F push", "F push", "F"], Role::Push),
            DepthBias::Everything,
        ),
        _ => (
            (["L angular momentum", "L", "L"], Role::Z),
            DepthBias::Farther,
        ),
    }
}

impl SceneSubject<'_> {
    pub(super) fn draw_arrows(&self, scene: &mut DotScene) -> Vec<SpaceLabel> {
        let mut labels = Vec::new();
        for (letter, from, along) in self.arrows() {
            if !self.draws(letter) {
                continue;
            }
            let (tip, ((_, role), over)) = (from + along, meaning(letter));
            scene.arrow(&from, &tip, Ink::Strong(role), over);
            // L goes on beyond the tip of Ω, where no letter can be read, and dL is on the side to which the torque points.
            let place = match self.torque.filter(|_| letter == "Ω") {
                Some(torque) => scene.beside(&tip, &torque),
                None => scene.beyond(&from, &tip),
            };
            labels.push((letter, role, place));
        }
        labels
    }

    /// L and Ω from the pivot, the weight at the centre of mass, its torque at the pivot, at the tip of L where L goes, and
    /// the pushes that act: each with its letter, its origin and its length.
    fn arrows(&self) -> Vec<(&'static str, Vector3<f64>, Vector3<f64>)> {
        let (state, loads) = (self.state, self.seen.run.simulation().loads());
        let body = &self.seen.run.scenario().body.mechanics;
        let (reach, arm) = (self.reach, self.arm);
        fn direction(vector: &Vector3<f64>) -> Option<Vector3<f64>> {
            vector.try_normalize(f64::MIN_POSITIVE)
        }
        let pivot = Vector3::zeros();
        let mut arrows = Vec::new();
        if let Some(down) = direction(&(Vector3::z() * -loads.gravity)) {
            let centre = state.orientation * body.first_moment() / body.mass();
            arrows.push(("g", centre, down * (WEIGHT * reach)));
        }
        let omega = direction(&observables::angular_velocity(body, state));
        if let Some(along) = self.direction("Ω", omega) {
            // Shorter than L, in which it would vanish where both lie along the axle.
            arrows.push(("Ω", pivot, along * (OMEGA_ARROW_LENGTH * arm)));
        }
        let momentum = self
            .direction("L", direction(&state.momentum))
            .map(|along| along * (MOMENTUM_ARROW_LENGTH * arm));
        if let Some(torque) = self.direction("τ", self.torque) {
            arrows.push(("τ", pivot, torque * (TORQUE_ARROW_SHARE * reach)));
        }
        if let (Some(change), Some(tip)) = (self.direction("dL", self.change), momentum) {
            arrows.push(("dL", tip, change * (CHANGE_ARROW_SHARE * reach)));
        }
        if let Some(new) = self.new_momentum() {
            arrows.push(("new L", pivot, new * (MOMENTUM_ARROW_LENGTH * arm)));
        }
        arrows.extend(momentum.map(|along| ("L", pivot, along)));
        for push in loads.pushes.iter().take(MOST_SHOWN_PUSHES) {
            let from = state.orientation * body.points()[push.point].at;
            let along = direction(&push.force);
            arrows.extend(along.map(|along| ("F", from, along * (PUSH_ARROW_LENGTH * reach))));
        }
        arrows
    }

    /// Lines that the legend takes of `width` columns, at most `most`. They are as many while a push acts as between
    /// pushes.
    pub(super) fn legend_lines(&self, width: usize, most: usize) -> usize {
        let has_pushes = !self.seen.run.scenario().pushes.is_empty();
        self.legend_in(width, most, has_pushes).len().max(1)
    }

    /// What the letters and signs mean, in as many words as there is room for.
    pub(super) fn legend(&self, area: Rect, buf: &mut Buffer) {
        let theme = &self.seen.view.theme;
        let is_pushed = !self.seen.run.simulation().loads().pushes.is_empty();
        let lines = self.legend_in(area.width as usize, area.height as usize, is_pushed);
        for (line, y) in lines.iter().zip(0..area.height) {
            let mut x = 0;
            for (word, role) in line {
                x = write(area, (x, y), word, theme.style(*role), buf) + LEGEND_WORD_GAP as u16;
            }
        }
    }

    /// The lines of the legend: everything named at length, or what there is room for.
    fn legend_in(&self, width: usize, most: usize, is_pushed: bool) -> Vec<LegendLine> {
        let (arrows, signs) = match self.phase_legend() {
            Some(words) => (words, Vec::new()),
            None => (self.arrows_in_words(is_pushed), self.signs_in_words()),
        };
        let lines = |(arrows_at, signs_at): (usize, Option<usize>)| {
            let named = arrows.iter().map(|(words, role)| (words[arrows_at], *role));
            let signs = signs_at
                .into_iter()
                .flat_map(|at| signs.iter().map(move |sign| (sign, at)))
                .map(|((words, role), at)| (words[at], *role));
            let words = named.chain(signs).filter(|(word, _)| !word.is_empty());
            in_lines(words, |(word, _)| word, LEGEND_WORD_GAP, width)
        };
        let forms = [
            (0, Some(0)),
            (0, Some(1)),
            (0, Some(2)),
            (1, Some(1)),
            (1, Some(2)),
            (2, Some(2)),
            (1, None),
        ];
        let fitting = forms
            .into_iter()
            .map(lines)
            .find(|lines| lines.len() <= most);
        fitting.unwrap_or_else(|| lines((2, None)).into_iter().take(most).collect())
    }

    fn arrows_in_words(&self, is_pushed: bool) -> Vec<LegendText> {
        let loads = self.seen.run.simulation().loads();
        let is_rubbed = !loads.friction.is_none();
        let letters = ["L", "Ω", "g", "τ", "dL", "F"].into_iter();
        let words = |letter| {
            let (words, role) = meaning(letter).0;
            let words = match letter {
                "g" if loads.gravity == 0.0 => ["no weight", "", ""],
                "τ" if self.torque.is_none() => ["no torque", "no torque", ""],
                "dL" if self.change.is_none() => ["L stays", "", ""],
                "dL" if is_rubbed => ["dL with friction", "dL", "dL"],
                _ => words,
            };
            (words, role)
        };
        letters
            .filter(|letter| is_pushed || *letter != "F")
            .map(words)
            .collect()
    }

    /// What is drawn besides the arrows.
    #[rustfmt::skip]
    fn signs_in_words(&self) -> Vec<LegendText> {
        let is_top = self.seen.run.scenario().traces_top();
        let all = [
            (true, ["+ pivot"; 3], Role::Heading),
            (true, ["thick: axle", "", ""], Role::Focus),
            (is_top, ["* axle top", "* top", "* top"], Role::Focus),
            (!is_top, ["* traced point", "* traced", "* traced"], Role::Focus),
            (true, ["►▲ its way", "", ""], Role::Focus),
            (self.shape.rim.is_some(), ["■ hub", "■ hub", ""], Role::Heading),
            (true, ["O o · masses, near to far", "O o · masses", ""], Role::Text),
            (self.seen.run.overlay().is_some(), ["dots: exact motion", "dots: exact", "dots: exact"], Role::Exact),
            (self.seen.pinned.is_some(), ["long dashes: pinned", "-- pinned", "-- pinned"], Role::Pinned),
            (self.seen.ghost.is_some(), ["dotted: other run", "dotted: other", "dotted: other"], Role::Ghost),
        ];
        let drawn = all.into_iter().filter(|(is_drawn, ..)| *is_drawn);
        drawn.map(|(_, words, role)| (words, role)).collect()
    }
}

/// What a letter means, at length, in short and as the letter alone.
type LegendText = ([&'static str; 3], Role);
/// The words of a line of the legend.
type LegendLine = Vec<(&'static str, Role)>;
/// Columns between two words of the legend.
const LEGEND_WORD_GAP: usize = 2;

#[derive(Clone, Copy)]
pub struct StepArrows<'a> {
    explained: &'a StepWorkings,
    phase: &'a Phase,
    /// The point that was added last to the sum of the table, or chosen in it.
    point: Option<usize>,
}

impl<'a> StepArrows<'a> {
    /// The phase on the page of the step pane of `view`, if that is on the screen.
    pub fn of_shown_phase(explained: Option<&'a StepWorkings>, view: &View) -> Option<Self> {
        let shown = explained.filter(|_| view.shows(Pane::Step))?;
        let (phase, ..) = shown.phase(view.look.phase)?;
        let row = view.look.sum_to.and_then(|rows| rows.checked_sub(1));
        let points = table_of(phase).map(|table| &table.points);
        Some(Self {
            explained: shown,
            phase,
            point: row
                .zip(points)
                .and_then(|(row, points)| points.get(row).copied()),
        })
    }

    /// The letters of the arrows that the phase is about.
    fn letters(&self) -> &'static [&'static str] {
        match self.phase.name {
            PhaseName::Inertia => &[],
            PhaseName::AngularVelocity => &["Ω", "L"],
            PhaseName::Torque => &["τ", "g", "F"],
            PhaseName::NewMomentum | PhaseName::Kick => &["L", "dL", "new L"],
            PhaseName::FreeMotion | PhaseName::Friction => &["L"],
            name if name.is_slope() => &["Ω", "τ"],
            _ => &["u"],
        }
    }

    /// Whether the body is drawn as it stood before the step too.
    fn has_before(&self) -> bool {
        match self.phase.name {
            PhaseName::AngularVelocity
            | PhaseName::AxisAndAngle
            | PhaseName::Torque
            | PhaseName::NewMomentum
            | PhaseName::Kick
            | PhaseName::Friction => false,
            name => !name.is_slope(),
        }
    }

    /// The direction of the last vector of this `symbol` in the step up to this phase.
    fn direction(&self, symbol: &str) -> Option<Vector3<f64>> {
        let phases = self
            .explained
            .workings
            .phases()
            .rev()
            .skip_while(|phase| !std::ptr::eq(*phase, self.phase));
        let mut quantities = phases.flat_map(|phase| phase.quantities.iter().rev());
        let found = quantities.find(|quantity| quantity.symbol == symbol)?;
        match found.value {
            WorkedValue::Vector(vector) => vector.try_normalize(f64::MIN_POSITIVE),
            _ => None,
        }
    }

    /// Whether friction has a part in dL, which is not along τ then.
    fn is_rubbed(&self) -> bool {
        let mut parts = self.explained.workings.parts.iter();
        parts.any(|part| !part.loads.friction.is_none())
    }

    fn before(&self) -> &State {
        &self.explained.states.0
    }
}

impl SceneSubject<'_> {
    /// Whether the arrow of this letter is drawn. Where the step pane is shown, only those are that its phase is about.
    fn draws(&self, letter: &str) -> bool {
        let shown = self.shown_phase.as_ref();
        shown.is_none_or(|shown| shown.letters().contains(&letter))
    }

    /// The direction of `letter` in the numbers of the phase, or else `now`.
    fn direction(&self, letter: &str, now: Option<Vector3<f64>>) -> Option<Vector3<f64>> {
        let shown = self.shown_phase.as_ref();
        shown.and_then(|shown| shown.direction(letter)).or(now)
    }

    /// The axis of the turn, and the body before it.
    pub(super) fn phase(&self, scene: &mut DotScene) -> Vec<SpaceLabel> {
        let mut labels = Vec::new();
        let Some(shown) = &self.shown_phase else {
            return labels;
        };
        if let Some(axis) = shown.direction("u").filter(|_| self.draws("u")) {
            let end = axis * (AXIS * MOMENTUM_ARROW_LENGTH * self.arm);
            scene.line(&-end, &end, LineStroke::Thin, Ink::Strong(Role::Y));
            labels.push(("u", Role::Y, end * 1.04));
        }
        if shown.has_before() {
            self.body_before(shown.before(), scene);
        }
        if let Some(point) = shown.point {
            let points = self.seen.run.scenario().body.mechanics.points();
            let Some(point) = points.get(point) else {
                return labels;
            };
            let before = shown.before().orientation * point.at;
            let (from, to) = match shown.phase.name {
                PhaseName::Inertia => (Vector3::zeros(), before),
                _ => (before, self.state.orientation * point.at),
            };
            scene.line(&from, &to, LineStroke::Thin, Ink::Strong(Role::Focus));
            labels.push(("@", Role::Focus, to));
        }
        labels
    }

    /// The masses where they were before the step.
    pub(super) fn signs_of_phase(&self, scene: &DotScene) -> Vec<BodySign> {
        let shown = self.shown_phase.as_ref().filter(|shown| shown.has_before());
        shown.map_or_else(Vec::new, |shown| self.masses_before(shown.before(), scene))
    }

    /// The direction of the new L, if the phase makes one that is seen to differ from the old.
    fn new_momentum(&self) -> Option<Vector3<f64>> {
        let shown = self.shown_phase.as_ref().filter(|_| self.draws("dL"))?;
        let (old, new) = (shown.direction("L")?, shown.direction("new L")?);
        Some(new).filter(|new| (new - old).norm() > DISTINCT_DIRECTIONS_RAD)
    }

    /// What the letters of the phase mean.
    fn phase_legend(&self) -> Option<Vec<LegendText>> {
        let shown = self.shown_phase.as_ref()?;
        let words = |letter: &&str| match *letter {
            "dL" if shown.is_rubbed() => (["dL, its direction", "dL, direction", "dL"], Role::X),
            "dL" => (
                ["dL along τ, its direction", "dL, direction", "dL"],
                Role::X,
            ),
            letter => meaning(letter).0,
        };
        let mut words: Vec<_> = shown
            .letters()
            .iter()
            .filter(|letter| match **letter {
                "F" => !self.seen.run.simulation().loads().pushes.is_empty(),
                "u" => shown.direction("u").is_some(),
                "new L" => false, // the arrow says it
                _ => true,
            })
            .map(words)
            .collect();
        if shown.has_before() {
            words.push((["° dotted: before the step", "° before", "°"], Role::Quiet));
        }
        if shown.point.is_some() {
            words.push((["@ the point", "@ point", "@"], Role::Focus));
        }
        Some(words)
    }
}
