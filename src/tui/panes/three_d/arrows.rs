//! The arrows of the scene, and the line that says what their letters mean.

use super::{CHANGE, Label, MOMENTUM, Subject, write};
use crate::physics::observables;
use crate::text::wrap::columns;
use crate::tui::dots::Ink;
use crate::tui::scene::Scene;
use crate::tui::theme::Role;
use nalgebra::Vector3;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Lengths of the arrows, of the scene's reach: their directions are what there is to see.
const OMEGA: f64 = 0.85;
const WEIGHT: f64 = 0.35;
const TORQUE: f64 = 0.5;
const PUSH: f64 = 0.4;
/// More pushes than this at one time are no picture.
const MOST_PUSHES: usize = 20;

impl Subject<'_> {
    /// L and Ω from the pivot, the weight at the centre of mass, its torque at the pivot, and at the tip of L where it goes.
    pub(super) fn vectors(&self, scene: &mut Scene) -> Vec<Label> {
        let simulation = self.run.simulation();
        let state = self.state;
        let body = &self.run.scenario().body.mechanics;
        let reach = self.reach;
        let direction = |vector: &Vector3<f64>| vector.try_normalize(f64::MIN_POSITIVE);
        let mut labels = Vec::new();
        let mut arrow = |name, role, from: Vector3<f64>, to: Vector3<f64>| {
            if !self.draws(name) {
                return;
            }
            scene.arrow(&from, &(from + to), Ink::Strong(role));
            labels.push((name, role, from + to * 1.04));
        };
        let pivot = Vector3::zeros();
        let weight = Vector3::z() * -simulation.loads().gravity;
        if let Some(down) = direction(&weight) {
            let centre = state.orientation * body.first_moment() / body.mass();
            arrow("g", Role::Push, centre, down * (WEIGHT * reach));
        }
        let omega = direction(&observables::angular_velocity(body, state));
        if let Some(along) = self.direction("Ω", omega) {
            arrow("Ω", Role::Y, pivot, along * (OMEGA * reach));
        }
        let momentum = self.direction("L", direction(&state.momentum));
        let momentum = momentum.map(|along| along * (MOMENTUM * reach));
        if let Some(torque) = self.direction("τ", self.torque) {
            arrow("τ", Role::X, pivot, torque * (TORQUE * reach));
            if let Some(momentum) = momentum {
                arrow("dL", Role::X, momentum, torque * (CHANGE * reach));
            }
        }
        if let Some(new) = self.new_momentum() {
            arrow("new L", Role::Z, pivot, new * (MOMENTUM * reach));
        }
        if let Some(momentum) = momentum {
            arrow("L", Role::Z, pivot, momentum);
        }
        labels
    }

    /// An arrow for each push that acts, from the pushed point along the force.
    pub(super) fn pushes(&self, scene: &mut Scene) -> Vec<Label> {
        let simulation = self.run.simulation();
        let points = self.run.scenario().body.mechanics.points();
        let length = PUSH * self.reach;
        let mut labels = Vec::new();
        let shown = if self.draws("F") { MOST_PUSHES } else { 0 };
        for push in simulation.loads().pushes.iter().take(shown) {
            let from = self.state.orientation * points[push.point].at;
            if let Some(direction) = push.force.try_normalize(f64::MIN_POSITIVE) {
                let tip = from + direction * length;
                scene.arrow(&from, &tip, Ink::Strong(Role::Push));
                labels.push(("F", Role::Push, tip));
            }
        }
        labels
    }

    /// What the letters mean, in as many words as there is room for.
    pub(super) fn legend(&self, area: Rect, buf: &mut Buffer) {
        let theme = &self.view.theme;
        let (torque, change) = match self.torque {
            Some(_) => (
                ["τ torque", "τ torque", "τ"],
                ["dL where L goes", "dL", "dL"],
            ),
            None => (["no torque", "no torque", ""], ["L stays", "", ""]),
        };
        let weight = match self.run.simulation().loads().gravity == 0.0 {
            true => ["no weight", "", ""],
            false => ["g weight", "g weight", "g"],
        };
        let momentum = ["L angular momentum", "L", "L"];
        let omega = ["Ω angular velocity", "Ω", "Ω"];
        let words = [
            (momentum, Role::Z),
            (omega, Role::Y),
            (weight, Role::Push),
            (torque, Role::X),
            (change, Role::X),
        ];
        let words = self.phase_legend().unwrap_or_else(|| words.to_vec());
        let length = |at: usize| -> usize {
            let lengths = words
                .iter()
                .map(|(words, _)| words[at])
                .filter(|word| !word.is_empty());
            lengths.map(|word| columns(word) + 2).sum()
        };
        let at = (0..3)
            .find(|&at| length(at) <= area.width as usize + 2)
            .unwrap_or(2);
        let mut x = 0;
        for (words, role) in words.iter().filter(|(words, _)| !words[at].is_empty()) {
            x = write(area, (x, 0), words[at], theme.style(*role), buf) + 2;
        }
    }
}
