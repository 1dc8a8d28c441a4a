//! Dots in layers, for the pictures in which lines cross: the path from above and the 3-D view.
//!
//! Positions are in fine dots, two across and four down per cell, from the upper left. The marker may draw larger ones.
//! A cell has the color of its top dot. Lines of one body share their cells, and so do the path and its head.

use crate::lab::view::theme::{Marker, Theme};
use crate::tui::dots::{self, Dashes, on_sheet};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Fine dots in a cell, across and down.
pub const FINE_DOTS: (usize, usize) = (2, 4);

/// Width of an arrow's head at its base, as a fraction of the head's length.
const HEAD_WIDTH: f64 = 1.0;
/// Maximum length of a head, as a fraction of its arrow; and its minimum length, fine dots.
const MOST_OF_ARROW: f64 = 0.5;
const LEAST_HEAD: f64 = 3.0;

/// Layers, lowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    Ground,
    Previous,
    Far,
    Earlier,
    Run,
    Exact,
    Axle,
    Near,
    Mass,
    Shaft,
    Head,
    Start,
    ExactNow,
    Now,
}

/// Role and layer of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DotInk {
    pub role: Role,
    pub layer: Layer,
}

/// Position on the sheet, fine dots to the right and down.
pub type FineDot = (f64, f64);

/// Filled spot, by its width in fine dots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    Two,
    Three,
    /// Five, without the corners.
    Five,
}

/// Layered dots on an area of the screen.
pub struct LayeredDots {
    area: Rect,
    marker: Marker,
    /// Top dot at each position, in rows of the marker's dots.
    dots: Vec<Option<DotInk>>,
    width: usize,
    height: usize,
}

impl LayeredDots {
    pub fn new(area: Rect, marker: Marker) -> Self {
        let (across, down) = marker.dots();
        let (width, height) = (area.width as usize * across, area.height as usize * down);
        Self {
            area,
            marker,
            dots: vec![None; width * height],
            width,
            height,
        }
    }

    /// Returns the fine dots across and down.
    pub fn size(&self) -> (usize, usize) {
        (
            self.area.width as usize * FINE_DOTS.0,
            self.area.height as usize * FINE_DOTS.1,
        )
    }

    fn place(&self, (x, y): FineDot) -> Option<usize> {
        let (across, down) = self.marker.dots();
        let dot = (
            x.floor() * across as f64 / FINE_DOTS.0 as f64,
            y.floor() * down as f64 / FINE_DOTS.1 as f64,
        );
        let (column, row) = on_sheet(dot, (self.width, self.height))?;
        Some(row * self.width + column)
    }

    /// Sets a dot, unless a higher layer already has a dot there. Does nothing outside the sheet.
    pub fn set(&mut self, at: FineDot, ink: DotInk) {
        if let Some(place) = self.place(at)
            && self.dots[place].is_none_or(|there| there.layer <= ink.layer)
        {
            self.dots[place] = Some(ink);
        }
    }

    pub fn line(&mut self, from: FineDot, to: FineDot, ink: DotInk) {
        for (_, at) in dots::line(from, to, self.size()) {
            self.set(at, ink);
        }
    }

    /// Draws a line through `places`, dashed if `dashes` are given.
    ///
    /// Places more than `longest` fine dots apart are not joined, because the motion between them is unknown.
    pub fn path(
        &mut self,
        places: impl Iterator<Item = FineDot>,
        dashes: Option<Dashes>,
        longest: f64,
        ink: DotInk,
    ) {
        let (drawn, out_of) = dashes.unwrap_or((1, 1));
        let mut passed = 0;
        let mut last: Option<FineDot> = None;
        let mut last_dot: Option<FineDot> = None;
        for at in places {
            let from = last.replace(at).unwrap_or(at);
            let is_joined = (at.0 - from.0).abs().max((at.1 - from.1).abs()) <= longest;
            let from = if is_joined { from } else { at };
            for (_, dot) in dots::line(from, at, self.size()) {
                let whole = (dot.0.floor(), dot.1.floor());
                passed += usize::from(last_dot.replace(whole) != Some(whole));
                if passed % out_of < drawn {
                    self.set(dot, ink);
                }
            }
        }
    }

    pub fn spot(&mut self, (x, y): FineDot, spot: Spot, ink: DotInk) {
        let offsets = match spot {
            Spot::Two => 0..=1_i32,
            Spot::Three => -1..=1,
            Spot::Five => -2..=2,
        };
        for across in offsets.clone() {
            for down in offsets.clone() {
                let is_corner = spot == Spot::Five && (across * down).abs() == 4;
                if !is_corner {
                    self.set((x + f64::from(across), y + f64::from(down)), ink);
                }
            }
        }
    }

    /// Draws a small ring and clears lower layers inside it.
    pub fn ring(&mut self, (x, y): FineDot, ink: DotInk) {
        for across in -2..=2_i32 {
            for down in -2..=2_i32 {
                let at = (x + f64::from(across), y + f64::from(down));
                let is_corner = (across * down).abs() == 4;
                if across.abs().max(down.abs()) == 2 && !is_corner {
                    self.set(at, ink);
                } else if let Some(place) = self.place(at)
                    && self.dots[place].is_some_and(|there| there.layer < ink.layer)
                {
                    self.dots[place] = None;
                }
            }
        }
    }

    /// Draws a line with a filled head at `tip`. The head is `head` fine dots long, or shorter if the arrow is too
    /// short.
    pub fn arrow(&mut self, from: FineDot, tip: FineDot, head: f64, role: Role) {
        let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
        let length = libm::hypot(dx, dy);
        let ink = DotInk {
            role,
            layer: Layer::Head,
        };
        if length.is_nan() || length < 1.0 {
            self.spot(tip, Spot::Three, ink);
            return;
        }
        let shaft = DotInk {
            layer: Layer::Shaft,
            ..ink
        };
        self.line(from, tip, shaft);
        let (along, across) = ((dx / length, dy / length), (-dy / length, dx / length));
        let head = head.min((MOST_OF_ARROW * length).max(LEAST_HEAD));
        let rows = (2.0 * head) as u32;
        for row in 0..=rows {
            let back = head * f64::from(row) / f64::from(rows.max(1));
            let half = 0.5 * HEAD_WIDTH * back;
            let middle = (tip.0 - along.0 * back, tip.1 - along.1 * back);
            let [left, right] =
                [-half, half].map(|side| (middle.0 + across.0 * side, middle.1 + across.1 * side));
            self.line(left, right, ink);
        }
    }

    /// Draws the dots on the screen. Cells without dots do not change.
    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        for (index, position) in self.area.positions().enumerate() {
            let column = index % self.area.width as usize;
            let row = index / self.area.width as usize;
            let Some((sign, role)) = self.cell(column, row) else {
                continue;
            };
            if let Some(target) = buf.cell_mut(position) {
                target.set_char(sign).set_style(theme.style(role));
            }
        }
    }

    /// Returns the character and the role of a cell, or `None` if it has no dots.
    fn cell(&self, column: usize, row: usize) -> Option<(char, Role)> {
        let (across, down) = self.marker.dots();
        let in_cell = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
        let inked = in_cell.filter_map(|(x, y)| {
            let place = (row * down + y) * self.width + column * across + x;
            self.dots[place].map(|ink| (x, y, ink))
        });
        let inked: Vec<_> = inked.collect();
        let top = inked.iter().max_by_key(|(.., ink)| ink.layer)?.2.role;
        if (across, down) == (1, 1) {
            return Some((large_sign(top, self.marker), top));
        }
        let bits = inked
            .iter()
            .filter(|(.., ink)| share_cells(ink.role, top))
            .fold(0, |bits, (x, y, _)| bits | self.marker.bit(*x, *y));
        let layer = usize::from(is_faint(top) && top != Role::RunEarlier);
        Some((self.marker.sign(layer, bits), top))
    }
}

/// Returns true if dots of `role` are drawn in a cell whose top dot has the role `top`.
fn share_cells(role: Role, top: Role) -> bool {
    role == top || (is_of_body(role) && is_of_body(top)) || (is_of_path(role) && is_of_path(top))
}

fn is_of_body(role: Role) -> bool {
    matches!(
        role,
        Role::Text
            | Role::RimNear
            | Role::RimFar
            | Role::AngularMomentum
            | Role::AngularVelocity
            | Role::Torque
            | Role::Push
    )
}

fn is_of_path(role: Role) -> bool {
    matches!(role, Role::Run | Role::RunEarlier | Role::Cursor)
}

fn is_faint(role: Role) -> bool {
    matches!(
        role,
        Role::RunEarlier | Role::RimFar | Role::Floor | Role::Rule | Role::Previous
    )
}

/// Returns the character of `role` if a dot is as large as a cell. It distinguishes roles without colors.
fn large_sign(role: Role, marker: Marker) -> char {
    let is_ascii = marker == Marker::Ascii;
    match role {
        Role::Exact => 'e',
        Role::AngularMomentum => 'L',
        Role::AngularVelocity if is_ascii => 'W',
        Role::AngularVelocity => 'Ω',
        Role::Torque if is_ascii => 'T',
        Role::Torque => 'τ',
        Role::Push => 'F',
        Role::Cursor => '@',
        Role::Text => '#',
        Role::RunEarlier => 'o',
        Role::Label => '+',
        Role::Previous if is_ascii => ',',
        Role::Previous => '°',
        role if is_faint(role) && is_ascii => '.',
        role if is_faint(role) => '·',
        _ if is_ascii => '*',
        _ => '•',
    }
}
