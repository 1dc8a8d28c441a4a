//! The legend: the names of the lines, in a free corner of the panel or above the panels.

use super::curve::{BAND_WHITE, hatch};
use super::layout::{ChartLayout, PAGE_EDGE};
use super::{Chart, SeriesStyle};
use crate::plot::ink::{self, LABEL_PT, PageRectangle, WHITE, at, paler};
use crate::plot::scene::{PageScene, Point, StrokeStyle, TextAnchor, VectorPath};

/// Length of the line of an entry, and its distance from the name, pt.
const KEY: f64 = 17.0;
const AFTER_KEY: f64 = 3.5;
/// Half the height of a band's sample next to its name, pt.
const LEGEND_BAND: f64 = 2.6;
const LEGEND_ROW_PT: f64 = 9.6;
const LEGEND_ENTRY_GAP: f64 = 11.0;
/// Distance between legend and frame, and the clearance around the legend, pt.
const INSET: f64 = 4.5;
const LEGEND_CLEARANCE: f64 = 2.5;
/// Maximum width and height of a legend inside a panel, relative to the panel.
const LEGEND_WIDTH_SHARE: f64 = 0.62;

#[derive(Clone, Debug)]
pub struct Legend {
    entries: Vec<LegendEntry>,
}

#[derive(Clone, Debug)]
struct LegendEntry {
    /// The style of the series; `None` for a remark.
    style: Option<SeriesStyle>,
    name: String,
    width_pt: f64,
}

/// Returns the maximum length of an entry's name on a page of this width, pt.
pub fn longest_name(width_pt: f64) -> f64 {
    width_pt - 2.0 * PAGE_EDGE - KEY - AFTER_KEY
}

impl Legend {
    /// Creates the legend of `series`, given by name and style, with each name once, followed by the `remarks`.
    pub fn new<'a>(
        series: impl Iterator<Item = (&'a str, &'a SeriesStyle)>,
        remarks: impl IntoIterator<Item = String>,
    ) -> Self {
        let mut entries: Vec<LegendEntry> = Vec::new();
        for (name, style) in series.filter(|(name, _)| !name.is_empty()) {
            if entries.iter().any(|entry| entry.name == name) {
                continue;
            }
            entries.push(LegendEntry {
                style: Some(style.clone()),
                width_pt: KEY + AFTER_KEY + ink::width(name, LABEL_PT),
                name: name.to_owned(),
            });
        }
        entries.extend(remarks.into_iter().map(|remark| LegendEntry {
            style: None,
            width_pt: ink::width(&remark, LABEL_PT),
            name: remark,
        }));
        Self { entries }
    }

    pub fn from_chart(chart: &Chart, remarks: impl IntoIterator<Item = String>) -> Self {
        let series = chart.panels.iter().flat_map(|panel| &panel.series);
        let named = series.map(|series| (series.name.as_str(), &series.style));
        Self::new(named, remarks)
    }

    /// Arranges the entries above the panels in rows of at most `room` pt.
    fn rows(&self, room: f64) -> Vec<Vec<&LegendEntry>> {
        let mut rows: Vec<Vec<&LegendEntry>> = Vec::new();
        let mut used = 0.0;
        for entry in &self.entries {
            match rows.last_mut() {
                Some(row) if used + LEGEND_ENTRY_GAP + entry.width_pt <= room => {
                    row.push(entry);
                    used += LEGEND_ENTRY_GAP + entry.width_pt;
                }
                _ => {
                    rows.push(vec![entry]);
                    used = entry.width_pt;
                }
            }
        }
        rows
    }

    /// Returns the height of the legend above the picture on a page of this width, pt.
    pub fn height_above(&self, width_pt: f64) -> f64 {
        let rows = self.rows(width_pt - 2.0 * PAGE_EDGE).len();
        rows as f64 * LEGEND_ROW_PT + rows.min(1) as f64
    }

    /// Returns a corner of the only panel in which nothing is drawn, if there is one.
    pub fn free_corner(&self, chart: &Chart, layout: &ChartLayout) -> Option<PageRectangle> {
        let ([panel], [placed], []) =
            (&chart.panels[..], &layout.panels[..], &layout.magnified[..])
        else {
            return None;
        };
        if panel.map.is_some() {
            return None;
        }
        let widest = self.entries.iter().map(|entry| entry.width_pt);
        let width = widest.fold(0.0, f64::max);
        let height = self.entries.len() as f64 * LEGEND_ROW_PT - 1.0;
        let frame = placed.frame.grown(-INSET);
        let is_small = width <= LEGEND_WIDTH_SHARE * frame.width()
            && height <= LEGEND_WIDTH_SHARE * frame.height();
        if !is_small || self.entries.is_empty() {
            return None;
        }
        let lefts = [frame.right - width, frame.left];
        let tops = [frame.top, frame.bottom - height];
        let corners = tops.iter().flat_map(|&top| {
            lefts.map(|left| PageRectangle {
                left,
                top,
                right: left + width,
                bottom: top + height,
            })
        });
        let is_free =
            |corner: &PageRectangle| placed.is_clear(&corner.grown(LEGEND_CLEARANCE), panel);
        corners.into_iter().find(is_free)
    }

    pub fn draw_in(&self, corner: &PageRectangle, scene: &mut PageScene) {
        scene.fill(corner.outline(), WHITE);
        let label = ink::height(LABEL_PT);
        for (row, entry) in self.entries.iter().enumerate() {
            let base =
                corner.top + row as f64 * LEGEND_ROW_PT + 0.5 * (LEGEND_ROW_PT - 1.0 + label);
            entry.draw(at(corner.left, base), scene);
        }
    }

    /// Draws the legend above the picture on a page of this width, starting at `left` if there is room, pt.
    pub fn draw_above(&self, width_pt: f64, left: f64, scene: &mut PageScene) {
        let label = ink::height(LABEL_PT);
        for (index, row) in self.rows(width_pt - 2.0 * PAGE_EDGE).iter().enumerate() {
            let width: f64 = row.iter().map(|entry| entry.width_pt).sum::<f64>()
                + LEGEND_ENTRY_GAP * (row.len() as f64 - 1.0);
            let mut x = left.min(width_pt - PAGE_EDGE - width).max(PAGE_EDGE);
            let base = PAGE_EDGE + index as f64 * LEGEND_ROW_PT + 0.5 * (LEGEND_ROW_PT + label);
            for entry in row {
                entry.draw(at(x, base), scene);
                x += entry.width_pt + LEGEND_ENTRY_GAP;
            }
        }
    }
}

impl LegendEntry {
    /// Draws the entry with the name's baseline at the height of `place`.
    fn draw(&self, place: Point, scene: &mut PageScene) {
        let Some(style) = &self.style else {
            scene.write(&self.name, LABEL_PT, place, TextAnchor::Start);
            return;
        };
        let y = place.y - 0.5 * ink::height(LABEL_PT);
        if style.is_band {
            let key = PageRectangle {
                left: place.x,
                top: y - LEGEND_BAND,
                right: place.x + KEY,
                bottom: y + LEGEND_BAND,
            };
            if style.is_hatched {
                hatch(&key, style.color, scene);
            } else {
                scene.fill(key.outline(), paler(style.color, BAND_WHITE));
            }
        }
        if style.width_pt > 0.0 {
            let ends = [at(place.x, y), at(place.x + KEY, y)];
            let pen = StrokeStyle {
                is_round: false,
                dash_pt: if style.is_dots {
                    vec![style.width_pt, 2.0 * style.width_pt]
                } else {
                    style.dash_pt.to_vec()
                },
                ..style.pen()
            };
            scene.stroke(VectorPath::polyline(ends), pen, None);
        }
        if let Some(mark) = style.mark.or(style.sparse_mark) {
            scene.mark(mark, at(place.x + 0.5 * KEY, y), style.color);
        }
        let name = at(place.x + KEY + AFTER_KEY, place.y);
        scene.write(&self.name, LABEL_PT, name, TextAnchor::Start);
    }
}
