//! A map: a quantity over two others, drawn as colored cells, with a color bar.

use super::ChartAxis;
use super::axis::AxisScale;
use super::draw::FRAME_PT;
use super::layout::{AXIS_TITLE_GAP, PlacedPanel, TICK_LABEL_GAP, fitted, title_height};
use super::ticks::Ticks;
use crate::plot::extent;
use crate::plot::ink::{self, BLACK, LABEL_PT, PageRectangle, at, grey, pen};
use crate::plot::scene::{Color, PageScene, TextAnchor, VectorPath};

/// A quantity over two others. Each pair of their values has a cell in the color of the quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColorMap {
    /// The values along the x and the y axis, in ascending order; at least two of each.
    pub along: [Vec<f64>; 2],
    /// The values of the quantity, one row per y value; NaN for missing values.
    pub values: Vec<Vec<f64>>,
    /// The axis of the color bar.
    pub color: ChartAxis,
}

/// Width of the color bar, and its distance from the panel, pt.
const BAR_PT: f64 = 7.0;
const BAR_GAP: f64 = 6.0;
/// Number of different colors.
const LEVELS: f64 = 128.0;
/// Overlap of a cell with the next ones, pt, which hides gaps between them.
const OVERLAP_PT: f64 = 0.3;
/// Line width of the cross in a cell without a value, pt, and its gray level.
const CROSS_PT: f64 = 0.3;
const CROSS_GRAY: u8 = 150;

/// The color bar next to a panel.
#[derive(Clone, Debug)]
pub struct PlacedBar {
    pub frame: PageRectangle,
    scale: AxisScale,
    ticks: Ticks,
    title: (String, f64),
    title_at: f64,
}

impl ColorMap {
    /// Returns the range of the cells along x (0) or y (1).
    pub fn range(&self, axis: usize, is_log: bool) -> Option<(f64, f64)> {
        extent(edges(&self.along[axis], is_log).into_iter())
    }

    /// Returns the range of the colors.
    fn colors(&self) -> (f64, f64) {
        let values = self.values.iter().flatten().copied();
        let axis = &self.color;
        let shown = values.filter(|value| value.is_finite() && (!axis.is_log || *value > 0.0));
        match extent(shown) {
            Some((low, high)) if low < high => (low, high),
            // A map with a single value gets a color bar with some margin.
            one => axis.range_of(one.into_iter().flat_map(|(low, high)| [low, high])),
        }
    }

    /// Returns true if a cell has no color.
    pub fn has_gaps(&self) -> bool {
        let mut values = self.values.iter().flatten();
        values.any(|value| !value.is_finite() || (self.color.is_log && *value <= 0.0))
    }

    /// Returns the width that the color bar needs to the right of a panel that is `height` pt high.
    pub fn bar_room(&self, height: f64) -> f64 {
        let scale = AxisScale::new(&self.color, self.colors(), (height, 0.0));
        let ticks = scale.ticks_beside(&self.color);
        BAR_GAP
            + BAR_PT
            + TICK_LABEL_GAP
            + super::axis::widest(&ticks)
            + AXIS_TITLE_GAP
            + title_height()
    }

    /// Returns the color bar to the right of a panel with this `frame`.
    pub fn bar(&self, frame: &PageRectangle) -> PlacedBar {
        let left = frame.right + BAR_GAP;
        let scale = AxisScale::new(&self.color, self.colors(), (frame.bottom, frame.top));
        let ticks = scale.ticks_beside(&self.color);
        let labels = left + BAR_PT + TICK_LABEL_GAP + super::axis::widest(&ticks);
        PlacedBar {
            frame: PageRectangle {
                left,
                right: left + BAR_PT,
                ..*frame
            },
            title: fitted(self.color.title(&ticks), frame.height()),
            title_at: labels + AXIS_TITLE_GAP + 0.75 * title_height(),
            scale,
            ticks,
        }
    }

    /// Draws the cells in the panel `placed`.
    pub fn draw(&self, placed: &PlacedPanel, scene: &mut PageScene) {
        let range = self.colors();
        let colors = AxisScale::new(&self.color, range, (0.0, 1.0));
        let [xs, ys] = [(0, &placed.x), (1, &placed.y)].map(|(axis, scale)| {
            let edges = edges(&self.along[axis], scale.is_log);
            let places = edges.iter().map(|edge| scale.place(*edge));
            places.collect::<Vec<f64>>()
        });
        let mut gaps = Vec::new();
        // From top to bottom and left to right, so that each cell covers the overlap of the previous ones.
        for (row, values) in self.values.iter().enumerate().rev() {
            let (top, bottom) = (ys[row + 1], ys[row]);
            let levels: Vec<Option<u32>> = values
                .iter()
                .map(|value| level(colors.place(*value)))
                .collect();
            let mut column = 0;
            for run in levels.chunk_by(|a, b| a == b) {
                let (left, right) = (xs[column], xs[column + run.len()]);
                let cell = PageRectangle {
                    left,
                    top,
                    right,
                    bottom,
                };
                match run[0] {
                    Some(level) => {
                        let color = color_at(f64::from(level) / (LEVELS - 1.0));
                        let grown = PageRectangle {
                            right: right + OVERLAP_PT,
                            bottom: bottom + OVERLAP_PT,
                            ..cell
                        };
                        scene.fill_in(grown.outline(), color, Some(&placed.frame));
                    }
                    None => gaps.extend((column..column + run.len()).map(|column| PageRectangle {
                        left: xs[column],
                        right: xs[column + 1],
                        ..cell
                    })),
                }
                column += run.len();
            }
        }
        for gap in gaps {
            // Covers the overlap of the previous cells.
            scene.fill_in(gap.outline(), ink::WHITE, Some(&placed.frame));
            let diagonals = [
                [at(gap.left, gap.top), at(gap.right, gap.bottom)],
                [at(gap.left, gap.bottom), at(gap.right, gap.top)],
            ];
            for ends in diagonals {
                let line = VectorPath::polyline(ends);
                scene.stroke(line, pen(CROSS_PT, grey(CROSS_GRAY)), Some(&placed.frame));
            }
        }
    }
}

impl PlacedBar {
    /// Draws the color bar with its labels.
    pub fn draw(&self, scene: &mut PageScene) {
        let frame = &self.frame;
        let height = frame.height() / LEVELS;
        for level in 0..LEVELS as u32 {
            let bottom = frame.bottom - height * f64::from(level);
            let part = PageRectangle {
                top: (bottom - height - OVERLAP_PT).max(frame.top),
                bottom,
                ..*frame
            };
            scene.fill(part.outline(), color_at(f64::from(level) / (LEVELS - 1.0)));
        }
        scene.stroke(frame.outline(), pen(FRAME_PT, BLACK), None);
        let label = ink::height(LABEL_PT);
        for tick in &self.ticks.major {
            let y = self.scale.place(tick.at);
            let ends = [
                at(frame.right, y),
                at(frame.right + 0.5 * TICK_LABEL_GAP, y),
            ];
            scene.line(ends, FRAME_PT, BLACK);
            let place = at(frame.right + TICK_LABEL_GAP, y + 0.5 * label);
            scene.write(&tick.label, LABEL_PT, place, TextAnchor::Start);
        }
        let middle = at(self.title_at, 0.5 * (frame.top + frame.bottom));
        scene.write_up(&self.title.0, self.title.1, middle);
    }
}

/// Returns the edges of the cells around `values`, which are sorted. Edges lie midway between values; the first and
/// last cells are symmetric around their values.
fn edges(values: &[f64], is_log: bool) -> Vec<f64> {
    let scaled: Vec<f64> = if is_log {
        values.iter().map(|value| libm::log(*value)).collect()
    } else {
        values.to_vec()
    };
    let [first, second, ..] = scaled[..] else {
        return values.to_vec();
    };
    let [.., last_but_one, last] = scaled[..] else {
        return values.to_vec();
    };
    let middles = scaled.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let ends = [
        first - 0.5 * (second - first),
        last + 0.5 * (last - last_but_one),
    ];
    let all = std::iter::once(ends[0]).chain(middles).chain([ends[1]]);
    all.map(|edge| if is_log { libm::exp(edge) } else { edge })
        .collect()
}

/// Returns the color level at the fraction `share` of the map's range; `None` if it is NaN.
fn level(share: f64) -> Option<u32> {
    let level = (share * (LEVELS - 1.0)).round();
    level
        .is_finite()
        .then(|| level.clamp(0.0, LEVELS - 1.0) as u32)
}

/// Coefficients of red, green and blue in powers of the fraction, in ascending order: the color map viridis (van der
/// Walt and Smith, 2015) to within two levels of 255. Its lightness increases evenly, so that the map is readable in
/// gray too.
const VIRIDIS: [[f64; 3]; 7] = [
    [
        0.277_727_327_223_417_7,
        0.005_407_344_544_966_578,
        0.334_099_805_335_306_1,
    ],
    [
        0.105_093_043_108_577_4,
        1.404_613_529_898_575,
        1.384_590_162_594_685,
    ],
    [
        -0.330_861_828_725_556_3,
        0.214_847_559_468_213,
        0.095_095_163_028_236_59,
    ],
    [
        -4.634_230_498_983_486,
        -5.799_100_973_351_585,
        -19.332_440_956_279_87,
    ],
    [
        6.228_269_936_347_081,
        14.179_933_366_805_09,
        56.690_552_600_681_05,
    ],
    [
        4.776_384_997_670_288,
        -13.745_145_377_746_01,
        -65.353_032_633_372_34,
    ],
    [
        -5.435_455_855_934_631,
        4.645_852_612_178_535,
        26.312_435_249_583_2,
    ],
];

/// Returns the color at the fraction `share` of the range, from 0 to 1.
fn color_at(share: f64) -> Color {
    Color([0, 1, 2].map(|part| {
        let powers = VIRIDIS.iter().rev();
        let value = powers.fold(0.0, |sum, row| sum * share + row[part]);
        (255.0 * value.clamp(0.0, 1.0)).round() as u8
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_rises_monotonically() {
        let lightness = |share| {
            let Color(parts) = color_at(share);
            let [red, green, blue] = parts.map(f64::from);
            0.2126 * red + 0.7152 * green + 0.0722 * blue
        };
        let all: Vec<f64> = (0..=50)
            .map(|part| lightness(f64::from(part) / 50.0))
            .collect();
        assert!(all.windows(2).all(|pair| pair[1] > pair[0]), "{all:?}");
        assert!(all[0] < 35.0 && all[50] > 210.0, "{all:?}");
    }

    #[test]
    fn cell_edges_are_midway_between_values() {
        assert_eq!(edges(&[1.0, 2.0, 4.0], false), [0.5, 1.5, 3.0, 5.0]);
        let log = edges(&[1.0, 100.0], true);
        let rounded: Vec<f64> = log.iter().map(|edge| (edge * 1e6).round() / 1e6).collect();
        assert_eq!(rounded, [0.1, 10.0, 1000.0]);
    }
}
