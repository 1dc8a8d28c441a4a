//! A chart: panels on top of each other over a common axis, before anything has a position on the page.
//!
//! [`axis`] and [`ticks`] define the ticks and labels of an axis, and [`layout`] positions all parts. [`draw`] puts
//! them on a page, with curves from [`curve`], colors from [`map`], and the names of the curves from [`legend`].

pub mod axis;
pub mod curve;
pub mod draw;
pub mod layout;
pub mod legend;
pub mod map;
pub mod ticks;

use crate::plot::extent;
use crate::plot::ink::{BLACK, PointMark, grey};
use crate::plot::scene::{Color, StrokeStyle};
use map::ColorMap;
use ticks::{Ticks, power_of_ten};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    pub title: String,
    pub width_pt: f64,
    pub x: ChartAxis,
    /// The panels, from top to bottom; at least one.
    pub panels: Vec<Panel>,
    /// True if both axes have the same scale. The chart then has one panel.
    pub is_true_to_scale: bool,
    /// A magnified part of the x axis, shown on the right. Its panels have the same y axes.
    pub magnified: Option<Box<Chart>>,
    /// True if the errors are those of measuring numbers in a run, without the effect of the scheme on the run.
    pub are_read_off: bool,
    /// Its height with its legend, pt; `None`: as its panels need it. A chart that is true to scale has its own.
    pub height_pt: Option<f64>,
    /// Whether its numbers have a decimal comma.
    pub decimal_comma: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartAxis {
    /// The quantity on the axis, as markup.
    pub name: String,
    /// The unit, as markup; empty for a pure number.
    pub unit: String,
    pub is_log: bool,
    /// The range of the axis; `None` to fit the data.
    pub range: Option<(f64, f64)>,
    /// Typical size of the quantity, in its unit. Differences far below it are rounding errors. 0 if unknown.
    pub size: f64,
    /// Differences below this fraction of `size` are drawn flat, if it exceeds the limit of rounding.
    pub flat_below: f64,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    pub y: ChartAxis,
    pub series: Vec<ChartSeries>,
    /// A quantity over both axes, drawn as colors behind the series.
    pub map: Option<ColorMap>,
    /// The name of the column along its axis y; empty if there is none.
    pub column: String,
}

impl Panel {
    pub fn new(y: ChartAxis, series: Vec<ChartSeries>) -> Self {
        Self {
            y,
            series,
            map: None,
            column: String::new(),
        }
    }

    /// Sets the name of the column along its axis y.
    #[must_use]
    pub fn of_column(self, name: &str) -> Self {
        Self {
            column: name.to_owned(),
            ..self
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartSeries {
    /// Name in the legend, as markup; empty for none.
    pub name: String,
    /// The points in order. The line is interrupted at points that are not finite.
    pub points: Vec<[f64; 2]>,
    /// Standard errors of the x and of the y values. Empty without errors; NaN for an unknown error.
    pub errors: [Vec<f64>; 2],
    /// A band that replaces the line where it turns too often: x, minimum and maximum.
    pub band: Vec<[f64; 3]>,
    pub style: SeriesStyle,
}

impl ChartSeries {
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>, style: SeriesStyle) -> Self {
        Self {
            name: name.into(),
            points,
            style,
            ..Self::default()
        }
    }

    /// Returns true if this and `other` are curves of runs, each with a name, that can be drawn as one curve if they
    /// coincide.
    pub fn can_join(&self, other: &Self) -> bool {
        [self, other].iter().all(|series| {
            series.style.is_of_run() && !series.name.is_empty() && series.band.is_empty()
        }) && self.style.is_dots == other.style.is_dots
    }

    /// Creates the stripe of a push that acts between these values of the x axis.
    pub fn push(from: f64, to: f64) -> Self {
        Self::stripe("push", SeriesStyle::push(), from, to)
    }

    /// The time between these values of the axis x in which the motion cannot be predicted.
    pub fn unpredictable(from: f64, to: f64) -> Self {
        Self::stripe("not predictable", SeriesStyle::unpredictable(), from, to)
    }

    /// A stripe over the whole height of the panel between these values of the axis x.
    fn stripe(name: &str, style: SeriesStyle, from: f64, to: f64) -> Self {
        let stripe = [from, to].map(|time| [time, f64::NEG_INFINITY, f64::INFINITY]);
        Self {
            band: stripe.into(),
            ..Self::new(name, Vec::new(), style)
        }
    }

    /// Creates the stripe of the y values from 0 to `limit`, along the whole x axis.
    pub fn below(name: &str, limit: f64) -> Self {
        let ends = [f64::MIN_POSITIVE, f64::INFINITY];
        Self {
            band: ends.map(|x| [x, f64::MIN_POSITIVE, limit]).into(),
            ..Self::new(name, Vec::new(), SeriesStyle::push())
        }
    }

    /// Creates an entry of the legend without a curve.
    pub fn named(name: String) -> Self {
        let style = SeriesStyle {
            width_pt: 0.0,
            ..SeriesStyle::default()
        };
        Self::new(name, Vec::new(), style)
    }

    /// Creates the zero line across `range`.
    pub fn level((begin, end): (f64, f64)) -> Self {
        let points = vec![[begin, 0.0], [end, 0.0]];
        Self::new("", points, SeriesStyle::theory(0, 0))
    }

    /// Returns the ends of a point's error bar along x (0) or y (1). Without an error, both ends are the point.
    pub fn ends(&self, index: usize, axis: usize) -> [[f64; 2]; 2] {
        let error = self.errors[axis]
            .get(index)
            .copied()
            .filter(|error| error.is_finite())
            .unwrap_or(0.0);
        [error, -error].map(|error| {
            let mut end = self.points[index];
            end[axis] += error;
            end
        })
    }

    /// Returns the coordinates of the points along an axis, and of the ends of their error bars.
    pub fn reach(&self, axis: usize) -> impl Iterator<Item = f64> {
        (0..self.points.len()).flat_map(move |index| {
            let [high, low] = self.ends(index, axis);
            [high, low, self.points[index]].map(|point| point[axis])
        })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct SeriesStyle {
    pub color: Color,
    /// Width of the line, pt; 0 for points only.
    pub width_pt: f64,
    /// Lengths of strokes and gaps, pt; empty for a solid line.
    pub dash_pt: &'static [f64],
    pub mark: Option<PointMark>,
    /// Size of the marks, relative to the default.
    pub mark_share: f64,
    /// True to draw the series behind the others, and behind earlier series of this kind.
    pub is_behind: bool,
    /// True to draw a dot at each point instead of a line.
    pub is_dots: bool,
    /// True to draw the band of the series, if it has one.
    pub is_band: bool,
    /// Whether that band is hatched.
    pub is_hatched: bool,
    /// A mark at a few positions along the line, which distinguishes it without color.
    pub sparse_mark: Option<PointMark>,
    /// Whether its line has a white edge, so that it is seen on dense curves.
    pub has_halo: bool,
}

impl Default for SeriesStyle {
    fn default() -> Self {
        Self {
            color: BLACK,
            width_pt: 0.7,
            dash_pt: &[],
            mark: None,
            mark_share: 1.0,
            is_behind: false,
            is_dots: false,
            is_band: false,
            is_hatched: false,
            sparse_mark: None,
            has_halo: false,
        }
    }
}

/// Maximum number of curves, or series of points, that can be distinguished.
pub const MOST_CURVES: usize = 12;

/// Colors that are distinguishable with any color vision (Okabe and Ito, 2008), except for the color of the exact
/// motion.
///
/// The second half of [`MOST_CURVES`] reuses the colors with dashes and open marks. The first three colors have
/// different grays. With four or more curves, marks distinguish all curves without color.
const COLORS: [Color; MOST_CURVES / 2] = [
    BLACK,
    Color([0, 114, 178]),
    Color([230, 159, 0]),
    Color([0, 158, 115]),
    Color([204, 121, 167]),
    Color([86, 180, 233]),
];
/// Dashes of the second half of the curves: strokes and gaps, pt.
const SECOND_DASH: &[f64] = &[5.0, 1.6];
/// Number of curves in a panel from which on each curve has marks.
const FEWEST_MARKED_CURVES: usize = 4;
const MARKS: [PointMark; MOST_CURVES] = [
    PointMark::Dot,
    PointMark::Square,
    PointMark::Triangle,
    PointMark::Diamond,
    PointMark::Tip,
    PointMark::Star,
    PointMark::OpenSquare,
    PointMark::OpenTriangle,
    PointMark::OpenDiamond,
    PointMark::OpenTip,
    PointMark::OpenStar,
    PointMark::Ring,
];

/// Color of the exact motion, as in the lab on a light background.
pub const EXACT_COLOR: Color = Color([207, 74, 6]);
/// Dashes of exact motions: the first one, then those of further runs.
const EXACT_DASHES: [&[f64]; 4] = [&[3.2, 1.6], &[1.0, 1.2], &[5.0, 1.4, 1.0, 1.4], &[7.0, 2.0]];
/// Dashes of theory: strokes and gaps, pt. The dashes of the exact motion come last.
const THEORY_DASHES: [&[f64]; 6] = [
    &[],
    &[1.0, 1.2],
    &[5.0, 1.4, 1.0, 1.4],
    &[6.5, 2.0],
    &[2.0, 1.0, 2.0, 3.0],
    &[3.2, 1.6],
];
/// Color of a push, before it is mixed with white.
const PUSH_COLOR: Color = grey(120);

/// The color of a hatched time, which is seen on a band too.
const HATCH_COLOR: Color = grey(100);

/// Width of the dots of a path whose points are not joined, pt.
const DOT_PT: f64 = 1.1;

impl SeriesStyle {
    /// Returns the style of curve `index` of `count` in a panel. The first curve is on top.
    pub fn curve(index: usize, count: usize) -> Self {
        Self {
            color: COLORS[index % COLORS.len()],
            dash_pt: if index < COLORS.len() {
                &[]
            } else {
                SECOND_DASH
            },
            sparse_mark: (count >= FEWEST_MARKED_CURVES).then_some(MARKS[index % MARKS.len()]),
            is_behind: index > 0,
            ..Self::default()
        }
    }

    /// Returns the style of the exact motion number `index` in a panel: dashed, on top of the runs.
    pub fn exact(index: usize) -> Self {
        Self {
            color: EXACT_COLOR,
            dash_pt: EXACT_DASHES[index % EXACT_DASHES.len()],
            has_halo: true,
            ..Self::default()
        }
    }

    /// Returns the style of a push: a pale stripe behind the curves.
    pub fn push() -> Self {
        Self {
            color: PUSH_COLOR,
            width_pt: 0.0,
            is_band: true,
            ..Self::default()
        }
    }

    /// The time in which the motion cannot be predicted: hatched.
    pub fn unpredictable() -> Self {
        Self {
            color: HATCH_COLOR,
            is_hatched: true,
            ..Self::push()
        }
    }

    /// Returns true for the line of a run, which may coincide with the line of another run.
    fn is_of_run(&self) -> bool {
        self.width_pt > 0.0 && self.mark.is_none() && self.color != EXACT_COLOR && !self.is_band
    }

    /// Returns the style of points on a thin line, for series `index`.
    pub fn marked_line(index: usize) -> Self {
        Self {
            width_pt: 0.5,
            ..Self::points(index)
        }
    }

    pub fn points(index: usize) -> Self {
        Self {
            color: COLORS[index % COLORS.len()],
            width_pt: 0.0,
            mark: Some(MARKS[index % MARKS.len()]),
            ..Self::default()
        }
    }

    /// Returns the style of `count` measured points: open circles on top of the run's line. If there are many, they are
    /// gray and behind the line, which they would hide.
    pub fn measured(count: usize) -> Self {
        const MANY_MARKS: usize = 150;
        let are_many = count > MANY_MARKS;
        Self {
            color: if are_many { grey(160) } else { BLACK },
            width_pt: 0.0,
            mark: Some(PointMark::Ring),
            is_behind: are_many,
            ..Self::default()
        }
    }

    /// Returns the style of an open circle at the start of a path of this style.
    pub fn start(path: &Self) -> Self {
        Self {
            color: path.color,
            width_pt: 0.0,
            mark: Some(PointMark::Ring),
            ..Self::default()
        }
    }

    /// Returns the style of a limit: a faint line behind the others.
    pub fn limit() -> Self {
        Self {
            color: grey(165),
            width_pt: 0.4,
            is_behind: true,
            ..Self::default()
        }
    }

    /// Returns the style of a thin line of theory for series `index`. `place` distinguishes several theories of the
    /// same quantity.
    pub fn theory(index: usize, place: usize) -> Self {
        Self {
            color: if index == 0 {
                grey(70)
            } else {
                Self::points(index).color
            },
            dash_pt: THEORY_DASHES[place % THEORY_DASHES.len()],
            ..Self::default()
        }
    }

    /// Returns the style of theory as marks joined by fine strokes.
    pub fn theory_marked(index: usize, place: usize) -> Self {
        Self {
            width_pt: 0.35,
            mark: Some([PointMark::Cross, PointMark::Plus][place % 2]),
            ..Self::theory(index, 2 + place)
        }
    }

    /// Returns the corresponding style for the exact motion.
    pub fn as_exact(self) -> Self {
        Self {
            color: EXACT_COLOR,
            dash_pt: EXACT_DASHES[0],
            ..self
        }
    }

    /// Returns the style of small points for values that are neither measured nor theory, for series `index`.
    pub fn specks(index: usize) -> Self {
        Self {
            mark: Some(PointMark::Speck),
            ..Self::points(index)
        }
    }

    /// Returns the style with a dot at each point instead of a line.
    pub fn as_dots(self) -> Self {
        Self {
            dash_pt: &[],
            width_pt: DOT_PT,
            is_dots: true,
            ..self
        }
    }

    /// The white on both sides of its line together, pt: the exact motion is seen on the swings of a run then.
    pub fn halo_pt(&self) -> f64 {
        const HALO_PT: f64 = 0.9;
        if self.has_halo && self.width_pt > 0.0 {
            HALO_PT
        } else {
            0.0
        }
    }

    pub fn pen(&self) -> StrokeStyle {
        StrokeStyle {
            width_pt: self.width_pt,
            color: self.color,
            dash_pt: self.dash_pt.to_vec(),
            is_round: true,
        }
    }
}

/// Maximum value on an axis, so that the distance between its ends is finite.
const FARTHEST_AXIS_END: f64 = 1e306;
/// Margin beyond the data, relative to their range; if the range is only rounding, relative to their size.
const DATA_MARGIN: f64 = 0.045;
const CONSTANT_MARGIN: f64 = 0.1;

impl ChartAxis {
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            ..Self::default()
        }
    }

    pub fn within(self, range: (f64, f64)) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// Returns the title of the axis with these ticks: name, offset and unit.
    pub fn title(&self, ticks: &Ticks) -> String {
        let offset = match ticks.offset.as_deref() {
            None => String::new(),
            Some(offset) => match offset.strip_prefix('−') {
                Some(size) => format!(" + {size}"),
                None => format!(" − {offset}"),
            },
        };
        let power = match ticks.power {
            0 => String::new(),
            power => power_of_ten(power),
        };
        match format!("{power} {}", self.unit).trim() {
            "" => format!("{}{offset}", self.name),
            unit => format!("{}{offset} ({unit})", self.name),
        }
    }

    /// Returns the range of the axis for these `values`, ignoring values that it cannot show. Without values, any range
    /// is returned.
    pub fn range_of(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        /// Values that differ by less than this fraction of their size, or of the quantity's typical size, differ only
        /// by rounding.
        const VALUE_ROUNDING: f64 = 1e-10;
        if let Some(range) = self.range {
            return range;
        }
        let in_range = values
            .filter(|value| value.is_finite() && (!self.is_log || *value > 0.0))
            .map(|value| value.clamp(-FARTHEST_AXIS_END, FARTHEST_AXIS_END));
        let Some((low, high)) = extent(in_range) else {
            return if self.is_log { (0.1, 10.0) } else { (0.0, 1.0) };
        };
        if self.is_log {
            return decades_around(low, high);
        }
        let largest = low.abs().max(high.abs());
        let span = high - low;
        if span > (VALUE_ROUNDING * largest.max(self.size)).max(self.flat_below * self.size) {
            return (low - DATA_MARGIN * span, high + DATA_MARGIN * span);
        }
        if self.size > 0.0 && largest <= VALUE_ROUNDING.max(self.flat_below) * self.size {
            // The values are zero within their precision.
            return (-CONSTANT_MARGIN * self.size, CONSTANT_MARGIN * self.size);
        }
        let half = if largest > 1e-290 {
            CONSTANT_MARGIN * largest
        } else {
            1.0
        };
        let middle = 0.5 * low + 0.5 * high;
        (middle - half, middle + half)
    }
}

/// Returns the range of a logarithmic axis for values from `low` to `high`, with a margin.
fn decades_around(low: f64, high: f64) -> (f64, f64) {
    let (low, high) = (
        low.max(1.0 / FARTHEST_AXIS_END),
        high.max(1.0 / FARTHEST_AXIS_END),
    );
    let decades = libm::log10(high / low);
    let margin = if decades > 0.1 {
        DATA_MARGIN * decades
    } else {
        CONSTANT_MARGIN
    };
    let factor = libm::exp10(margin);
    (
        (low / factor).max(0.1 / FARTHEST_AXIS_END),
        (high * factor).min(10.0 * FARTHEST_AXIS_END),
    )
}
