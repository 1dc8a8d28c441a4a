//! The curves of a sweep: its rows grouped by the other varied keys, and the lines of theory, which curves with the
//! same theory share.

use crate::plot::COLUMN_PT;
use crate::plot::chart::SeriesStyle;
use crate::report::figure::of_table::{RowIndices, grouped};
use crate::report::figure::setting::{CurveSetting, SCHEME_KEY, telling_digits};
use crate::studies::table::{SweepTable, TableSource};

/// Numbers with at most this relative difference are equal.
const SAME_NUMBER: f64 = 1e-6;
/// Number of rows above which a line looks smooth at the width of a column. With fewer rows, its points are marked.
const SMOOTH_CURVE_ROWS: f64 = 40.0;

/// The scheme of the exact motion.
const EXACT: &str = "exact";

/// One curve of a sweep.
#[derive(Clone, Debug)]
pub(super) struct SweepCurve {
    /// Index of the curve.
    pub index: usize,
    /// Indices of its rows.
    pub rows: RowIndices,
    /// Values of the other varied keys.
    pub settings: Vec<CurveSetting>,
    /// True if its runs use the scheme `exact`.
    pub is_exact: bool,
}

impl SweepCurve {
    /// Returns `style` for the curve. Exact runs get the color and the dashed line of the exact motion, without marks
    /// if the rows are close together on a page of this width.
    pub fn style(&self, style: SeriesStyle, width_pt: f64) -> SeriesStyle {
        if !self.is_exact {
            return style;
        }
        let mark = style.mark.filter(|_| !is_smooth(self.rows.len(), width_pt));
        SeriesStyle {
            mark,
            width_pt: SeriesStyle::default().width_pt,
            ..style.as_exact()
        }
    }
}

/// Returns true if a line through this number of rows looks smooth on a page of this width.
fn is_smooth(rows: usize, width_pt: f64) -> bool {
    rows as f64 > SMOOTH_CURVE_ROWS * width_pt / COLUMN_PT
}

/// Returns the curves of a sweep. The key `along`, and the keys that vary together with it, vary along a curve.
pub(super) fn curves(table: &TableSource, swept: &SweepTable, along: &str) -> Vec<SweepCurve> {
    let axes = swept.axes.iter();
    let others = axes.filter(|keys| !keys.iter().any(|key| key == along));
    let others: Vec<(&String, Vec<&str>)> = others
        .flatten()
        .filter_map(|key| Some((key, table.texts(key)?)))
        .collect();
    let values: Vec<String> = (0..table.count())
        .map(|row| {
            let texts: Vec<_> = others.iter().map(|(_, texts)| texts[row]).collect();
            texts.join("\n")
        })
        .collect();
    let digits: Vec<usize> = others
        .iter()
        .map(|(_, texts)| telling_digits(texts.iter().copied()))
        .collect();
    grouped(&values)
        .into_iter()
        .enumerate()
        .map(|(index, (_, rows))| {
            let told = others.iter().zip(&digits);
            let settings = told.map(|((key, texts), most)| {
                CurveSetting::new(&swept.scenario, key, texts[rows[0]], *most)
            });
            let scheme = others.iter().find(|(key, _)| *key == SCHEME_KEY);
            SweepCurve {
                index,
                settings: settings.collect(),
                is_exact: scheme.is_some_and(|(_, texts)| texts[rows[0]] == EXACT),
                rows,
            }
        })
        .collect()
}

/// A line of theory.
pub(super) struct TheoryLine {
    /// Index of the first curve with this theory.
    index: usize,
    /// Points from left to right.
    pub points: Vec<[f64; 2]>,
    /// Settings that all curves of the line share.
    pub settings: Vec<CurveSetting>,
}

/// Returns the lines of theory for these curves, whose points are sorted from left to right. A curve without theory has
/// no line.
pub(super) fn lines<'a>(
    curves: impl Iterator<Item = (&'a SweepCurve, Vec<[f64; 2]>)>,
) -> Vec<TheoryLine> {
    let mut lines: Vec<TheoryLine> = Vec::new();
    for (curve, points) in curves {
        if !points.iter().any(|point| point[1].is_finite()) {
            continue;
        }
        match lines.iter_mut().find(|line| line.says(&points)) {
            Some(line) => line.take_in(curve, points),
            None => lines.push(TheoryLine {
                index: curve.index,
                points,
                settings: curve.settings.clone(),
            }),
        }
    }
    lines
}

impl TheoryLine {
    fn place(&self, x: f64) -> Result<usize, usize> {
        self.points.binary_search_by(|point| point[0].total_cmp(&x))
    }

    /// Returns true if the line agrees with `points` wherever both have a value, and if there is such a position.
    fn says(&self, points: &[[f64; 2]]) -> bool {
        let pairs = points.iter().filter_map(|&[x, value]| {
            let own = self.points[self.place(x).ok()?][1];
            (own.is_finite() && value.is_finite()).then_some((own, value))
        });
        let mut pairs = pairs.peekable();
        pairs.peek().is_some()
            && pairs.all(|(a, b)| (a - b).abs() <= SAME_NUMBER * a.abs().max(b.abs()))
    }

    /// Adds a curve with the same theory, and the `points` that were missing.
    fn take_in(&mut self, curve: &SweepCurve, points: Vec<[f64; 2]>) {
        self.settings.retain(|it| curve.settings.contains(it));
        for point in points.into_iter().filter(|point| point[1].is_finite()) {
            match self.place(point[0]) {
                Ok(place) if self.points[place][1].is_nan() => self.points[place] = point,
                Ok(_) => {}
                Err(place) => self.points.insert(place, point),
            }
        }
    }

    /// Returns the style of the line on a page of this width, for the theory at index `place` of its panel. It is a
    /// line if the rows are close together, else marks, since straight strokes between distant rows do not follow the
    /// theory.
    pub fn style(&self, place: usize, width_pt: f64) -> SeriesStyle {
        if is_smooth(self.points.len(), width_pt) {
            SeriesStyle::theory(self.index, place)
        } else {
            SeriesStyle::theory_marked(self.index, place)
        }
    }
}
