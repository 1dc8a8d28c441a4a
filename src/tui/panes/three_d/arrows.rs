//! The arrows of the scene, and the line that says what their letters mean.

use super::{CHANGE, Label, MOMENTUM, Subject, write};
use crate::physics::observables;
use crate::text::wrap::columns;
use crate::tui::dots::Ink;
use crate::tui::scene::{Over, Scene};
use crate::tui::theme::Role;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Length of the arrow of the angular velocity, in lengths of the axle.
const OMEGA: f64 = 1.17;
/// Lengths of the other arrows, as shares of the body's size. Only their directions have a meaning.
const WEIGHT: f64 = 0.35;
const TORQUE: f64 = 0.5;
const PUSH: f64 = 0.4;
/// The most pushes that are drawn at one time.
const MOST_PUSHES: usize = 20;

/// How the arrow of this letter is drawn.
fn look(letter: &str) -> (Role, Over) {
    match letter {
        // The axle is whole where it is seen upright.
        "g" => (Role::Push, Over::BehindRod),
        "Ω" => (Role::Y, Over::Arrow),
        // These are short and cross the rim, which would hide them.
        "τ" | "dL" => (Role::X, Over::Everything),
        "F" => (Role::Push, Over::Everything),
        _ => (Role::Z, Over::Farther),
    }
}

impl Subject<'_> {
    pub(super) fn draw_arrows(&self, scene: &mut Scene) -> Vec<Label> {
        let mut labels = Vec::new();
        for (letter, from, along) in self.arrows() {
            if !self.draws(letter) {
                continue;
            }
            let (tip, (role, over)) = (from + along, look(letter));
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
        let (state, loads) = (self.state, self.run.simulation().loads());
        let body = &self.run.scenario().body.mechanics;
        let (reach, arm) = (self.reach, self.arm);
        let direction = |vector: &Vector3<f64>| vector.try_normalize(f64::MIN_POSITIVE);
        let pivot = Vector3::zeros();
        let mut arrows = Vec::new();
        if let Some(down) = direction(&(Vector3::z() * -loads.gravity)) {
            let centre = state.orientation * body.first_moment() / body.mass();
            arrows.push(("g", centre, down * (WEIGHT * reach)));
        }
        let omega = direction(&observables::angular_velocity(body, state));
        if let Some(along) = self.direction("Ω", omega) {
            // Shorter than L, in which it would vanish where both lie along the axle.
            arrows.push(("Ω", pivot, along * (OMEGA * arm)));
        }
        let momentum = self.direction("L", direction(&state.momentum));
        let momentum = momentum.map(|along| along * (MOMENTUM * arm));
        if let Some(torque) = self.direction("τ", self.torque) {
            arrows.push(("τ", pivot, torque * (TORQUE * reach)));
        }
        if let (Some(change), Some(tip)) = (self.direction("dL", self.change), momentum) {
            arrows.push(("dL", tip, change * (CHANGE * reach)));
        }
        if let Some(new) = self.new_momentum() {
            arrows.push(("new L", pivot, new * (MOMENTUM * arm)));
        }
        arrows.extend(momentum.map(|along| ("L", pivot, along)));
        for push in loads.pushes.iter().take(MOST_PUSHES) {
            let from = state.orientation * body.points()[push.point].at;
            let along = direction(&push.force);
            arrows.extend(along.map(|along| ("F", from, along * (PUSH * reach))));
        }
        arrows
    }

    /// Lines that the legend takes of `width` columns, at most `most`. They are as many while a push acts as between
    /// pushes.
    pub(super) fn legend_lines(&self, width: usize, most: usize) -> usize {
        let has_pushes = !self.run.scenario().pushes.is_empty();
        self.legend_in(width, most, has_pushes).len().max(1)
    }

    /// What the letters and signs mean, in as many words as there is room for.
    pub(super) fn legend(&self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let is_pushed = !self.run.simulation().loads().pushes.is_empty();
        let lines = self.legend_in(area.width as usize, area.height as usize, is_pushed);
        for (line, y) in lines.iter().zip(0..area.height) {
            let mut x = 0;
            for (word, role) in line {
                x = write(area, (x, y), word, theme.style(*role), buf) + APART as u16;
            }
        }
    }

    /// The lines of the legend: everything named at length, or what there is room for.
    fn legend_in(&self, width: usize, most: usize, is_pushed: bool) -> Vec<Line> {
        let (arrows, signs) = match self.phase_legend() {
            Some(words) => (words, Vec::new()),
            None => (self.arrows_in_words(is_pushed), self.signs_in_words()),
        };
        let lines = |(arrows_at, signs_at): (usize, Option<usize>)| {
            let named = arrows.iter().map(|(words, role)| (words[arrows_at], *role));
            let signs = signs_at
                .into_iter()
                .flat_map(|at| signs.iter().map(move |sign| (sign, at)));
            let signs = signs.map(|((words, role), at)| (words[at], *role));
            in_lines(named.chain(signs), width)
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
        let fits = |lines: &Vec<Line>| lines.len() <= most;
        let fitting = forms.into_iter().map(lines).find(fits);
        fitting.unwrap_or_else(|| lines((2, None)).into_iter().take(most).collect())
    }

    fn arrows_in_words(&self, is_pushed: bool) -> Vec<Words> {
        let is_rubbed = !self.run.simulation().loads().friction.is_none();
        let torque = match self.torque {
            Some(_) => ["τ torque", "τ torque", "τ"],
            None => ["no torque", "no torque", ""],
        };
        let change = match self.change {
            Some(_) if is_rubbed => ["dL with friction", "dL", "dL"],
            Some(_) => ["dL = τ dt", "dL", "dL"],
            None => ["L stays", "", ""],
        };
        let weight = if self.run.simulation().loads().gravity == 0.0 {
            ["no weight", "", ""]
        } else {
            ["g weight", "g weight", "g"]
        };
        let mut words = vec![
            (["L angular momentum", "L", "L"], Role::Z),
            (["Ω angular velocity", "Ω", "Ω"], Role::Y),
            (weight, Role::Push),
            (torque, Role::X),
            (change, Role::X),
        ];
        if is_pushed {
            words.push((["F push", "F push", "F"], Role::Push));
        }
        words
    }

    /// What is drawn besides the arrows.
    #[rustfmt::skip]
    fn signs_in_words(&self) -> Vec<Words> {
        let is_top = self.run.scenario().file.trace.is_none();
        let all = [
            (true, ["+ pivot"; 3], Role::Heading),
            (true, ["thick: axle", "", ""], Role::Focus),
            (is_top, ["* axle top", "* top", "* top"], Role::Focus),
            (!is_top, ["* traced point", "* traced", "* traced"], Role::Focus),
            (true, ["►▲ its way", "", ""], Role::Focus),
            (self.shape.rim.is_some(), ["■ hub", "■ hub", ""], Role::Heading),
            (true, ["O o · masses, near to far", "O o · masses", ""], Role::Text),
            (self.run.overlay().is_some(), ["dots: exact motion", "dots: exact", "dots: exact"], Role::Exact),
            (self.pinned.is_some(), ["long dashes: pinned", "-- pinned", "-- pinned"], Role::Pinned),
            (self.ghost.is_some(), ["dotted: other run", "dotted: other", "dotted: other"], Role::Ghost),
        ];
        let drawn = all.into_iter().filter(|(is_drawn, ..)| *is_drawn);
        drawn.map(|(_, words, role)| (words, role)).collect()
    }
}

/// What a letter means, at length, in short and as the letter alone.
type Words = ([&'static str; 3], Role);
/// The words of a line of the legend.
type Line = Vec<(&'static str, Role)>;
/// Columns between two words of the legend.
const APART: usize = 2;

/// `words` in lines of at most `width` columns; a word that is wider has a line of its own.
fn in_lines(words: impl Iterator<Item = (&'static str, Role)>, width: usize) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut free = 0;
    for (word, role) in words.filter(|(word, _)| !word.is_empty()) {
        let length = columns(word) + APART;
        match lines.last_mut() {
            Some(line) if length <= free + APART => line.push((word, role)),
            _ => {
                lines.push(vec![(word, role)]);
                free = width;
            }
        }
        free = free.saturating_sub(length);
    }
    lines
}
