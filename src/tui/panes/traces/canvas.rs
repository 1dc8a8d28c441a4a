//! A canvas on which curves of different kinds share cells. The top layer of a cell determines its role.

use crate::lab::view::theme::{Marker, Theme};
use crate::tui::dots::on_sheet;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// Layer of a dot, lowest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Between the edges of an envelope.
    Fill,
    Previous,
    Exact,
    /// The run before the window of the traces.
    Earlier,
    Run,
    /// The displayed time.
    Now,
}

const LAYERS: [Layer; 6] = [
    Layer::Fill,
    Layer::Previous,
    Layer::Exact,
    Layer::Earlier,
    Layer::Run,
    Layer::Now,
];

impl Layer {
    fn role(self) -> Role {
        match self {
            Self::Fill => Role::Fill,
            Self::Previous => Role::Previous,
            Self::Exact => Role::Exact,
            Self::Earlier => Role::RunEarlier,
            Self::Run => Role::Run,
            Self::Now => Role::Cursor,
        }
    }

    /// Returns the layers whose dots are shown in a cell with this top layer.
    fn shown_with(self) -> &'static [Self] {
        match self {
            Self::Now => &[Self::Now, Self::Run, Self::Earlier],
            Self::Run => &[Self::Run, Self::Earlier],
            Self::Earlier => &[Self::Earlier],
            Self::Exact => &[Self::Exact],
            Self::Previous => &[Self::Previous],
            Self::Fill => &[Self::Fill],
        }
    }

    /// Returns the index of the layer's sign. If dots are as large as a cell, layers differ by their signs.
    fn sign_layer(self) -> usize {
        match self {
            Self::Now | Self::Run | Self::Earlier => 0,
            Self::Fill => 1,
            Self::Exact => 2,
            Self::Previous => 3,
        }
    }
}

type CanvasCell = [u8; LAYERS.len()];

/// Dots of curves on an area of the screen, by layer.
pub struct Canvas {
    area: Rect,
    marker: Marker,
    cells: Vec<CanvasCell>,
}

impl Canvas {
    pub fn new(area: Rect, marker: Marker) -> Self {
        let cells = vec![CanvasCell::default(); area.width as usize * area.height as usize];
        Self {
            area,
            marker,
            cells,
        }
    }

    /// Returns the columns of dots.
    pub fn width(&self) -> usize {
        self.area.width as usize * self.marker.dots().0
    }

    /// Returns the rows of dots.
    pub fn height(&self) -> usize {
        self.area.height as usize * self.marker.dots().1
    }

    /// Returns the dots per cell, across and down.
    pub fn in_a_cell(&self) -> (usize, usize) {
        self.marker.dots()
    }

    /// Sets the dot at column `x`, row `y`. Does nothing outside the canvas.
    pub fn set(&mut self, x: usize, y: f64, layer: Layer) {
        let Some((x, y)) = on_sheet((x as f64, y), (self.width(), self.height())) else {
            return;
        };
        let (across, down) = self.marker.dots();
        let cell = y / down * self.area.width as usize + x / across;
        self.cells[cell][layer as usize] |= self.marker.bit(x % across, y % down);
    }

    /// Sets the dots of column `x` from the row `upper` to the row `lower`.
    pub fn upright(&mut self, x: usize, (upper, lower): (f64, f64), layer: Layer) {
        let last = self.height() as f64 - 1.0;
        if !(upper <= last && lower >= 0.0) {
            return; // outside, or NaN
        }
        let rows = upper.max(0.0) as usize..=lower.min(last) as usize;
        rows.for_each(|y| self.set(x, y as f64, layer));
    }

    pub fn render(&self, theme: &Theme, buf: &mut Buffer) {
        for (cell, position) in self.cells.iter().zip(self.area.positions()) {
            let top = LAYERS
                .into_iter()
                .rev()
                .find(|layer| cell[*layer as usize] != 0);
            let (Some(top), Some(target)) = (top, buf.cell_mut(position)) else {
                continue;
            };
            let shown = top.shown_with().iter();
            let mut bits = shown.fold(0, |bits, layer| bits | cell[*layer as usize]);
            if top >= Layer::Earlier {
                // Fill the envelope up to its edge, with every second dot, so that the edge remains visible.
                bits |= cell[Layer::Fill as usize] & self.checkered();
            }
            let sign = self.marker.sign(top.sign_layer(), bits);
            target.set_char(sign).set_style(theme.style(top.role()));
        }
    }

    /// Returns the bits of every second dot of a cell.
    fn checkered(&self) -> u8 {
        let (across, down) = self.marker.dots();
        let mut bits = 0;
        for (x, y) in (0..down).flat_map(|y| (0..across).map(move |x| (x, y))) {
            if (x + y) % 2 == 0 {
                bits |= self.marker.bit(x, y);
            }
        }
        bits
    }
}
