//! The curves of a sweep: its rows by what else was varied, and what each is called; and the lines of theory, one for all
//! curves of which it says the same.

use crate::plot::COLUMN_PT;
use crate::plot::chart::SeriesStyle;
use crate::report::figure::of_table::{RowIndices, grouped};
use crate::report::figure::setting::{CurveSetting, SCHEME_KEY, telling_digits};
use crate::studies::table::{SweepTable, TableSource};

/// Numbers that differ by no more than this part of themselves are the same.
const SAME_NUMBER: f64 = 1e-6;
/// From this many rows on a line looks smooth at the width of a column; with fewer its points are marked.
const SMOOTH_CURVE_ROWS: f64 = 40.0;

/// The scheme that is the exact motion.
const EXACT: &str = "exact";

/// The rows of one curve.
#[derive(Clone, Debug)]
pub(super) struct SweepCurve {
    /// Which of the curves it is, from 0.
    pub index: usize,
    /// Its rows.
    pub rows: RowIndices,
    /// The values of what else was varied.
    pub settings: Vec<CurveSetting>,
    /// Whether its runs are by the scheme `exact`.
    pub is_exact: bool,
}

impl SweepCurve {
    /// Returns `style` as the exact motion has it, if its runs are that: joined by a dashed line, and without marks where the
    /// rows are close on a page of that width.
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

/// Whether a line through so many rows looks smooth on a page of that width.
fn is_smooth(rows: usize, width_pt: f64) -> bool {
    rows as f64 > SMOOTH_CURVE_ROWS * width_pt / COLUMN_PT
}

/// Returns the curves of a sweep, along which the key `along`, and what varies together with it, varies.
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
            let values = others.iter().zip(&digits);
            let settings = values.map(|((key, texts), digits)| {
                CurveSetting::new(&swept.scenario, key, texts[rows[0]], *digits)
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
    /// The first of the curves that it is for.
    index: usize,
    /// Its points from left to right.
    pub points: Vec<[f64; 2]>,
    /// What is set alike for all of them.
    pub settings: Vec<CurveSetting>,
}

/// The lines of what theory says of each of these curves, whose points run from left to right. A curve of which it says
/// nothing has none.
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

    /// Whether it has the values of `points`, wherever both have one, and they do somewhere.
    fn says(&self, points: &[[f64; 2]]) -> bool {
        let pairs = points.iter().filter_map(|&[x, value]| {
            let own = self.points[self.place(x).ok()?][1];
            (own.is_finite() && value.is_finite()).then_some((own, value))
        });
        let mut pairs = pairs.peekable();
        pairs.peek().is_some()
            && pairs.all(|(a, b)| (a - b).abs() <= SAME_NUMBER * a.abs().max(b.abs()))
    }

    /// Takes in a curve of which theory says the same, and the `points` that were missing.
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

    /// How it is drawn on a page of that width, the theory at `place` of its panel: as a line where the rows are close, else
    /// as marks at the rows, since theory goes another way between them than the fine strokes that join them.
    pub fn style(&self, place: usize, width_pt: f64) -> SeriesStyle {
        if is_smooth(self.points.len(), width_pt) {
            SeriesStyle::theory(self.index, place)
        } else {
            SeriesStyle::theory_marked(self.index, place)
        }
    }
}
