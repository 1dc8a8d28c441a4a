//! The figures of a handout, and the empty axes for drawn predictions, as inline SVG.

use crate::engine::data::RunQuantity;
use crate::engine::run::Simulation;
use crate::engine::scenario::Scenario;
use crate::engine::scenario::screen::ABOVE;
use crate::engine::text::number::shortest;
use crate::lab::Lab;
use crate::lab::view::{FourthStrip, Pane};
use crate::lessons::lesson::{DrawnAnswer, Lesson, LessonPage};
use crate::lessons::play::LessonProgressCallback;
use crate::plot::chart::{Chart, ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::{COLUMN_PT, PT_PER_MM, PageFormat, PageScene, format};
use crate::report::figure::of_runs::FigureRun;
use crate::report::figure::{FigureSource, FigureSpec, labels::FigureLabels, quantity};
use std::collections::BTreeMap;
use std::sync::Arc;

const HEIGHT: &str = "z_m";
const TILT: &str = "tilt_deg";
/// Minimum range of a height axis next to a question, as a fraction of the traced point's distance from the pivot.
const LEAST_ARM_SHARE: f64 = 0.1;
/// Minimum range of a tilt axis next to a question, degrees.
const LEAST_TILT_DEG: f64 = 5.0;
/// Width of a path from above, which is about as high.
const ABOVE_PT: f64 = 62.0 * PT_PER_MM;
/// Room beyond the run's values, as a fraction of their range.
const MARGIN: f64 = 0.05;

/// Vertical axes of the figures of a lesson.
pub(super) struct AxisRanges {
    /// Column that represents the traces if the lab chooses the strips: the column of the questions.
    usual: &'static str,
    /// Ranges so far. An axis never shows less than on an earlier page, so that small changes look small.
    shown: BTreeMap<&'static str, (f64, f64)>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    pub caption: String,
    pub svg: String,
    pub kind: PaperFigureKind,
}

/// Kind of a figure, which decides its size on paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PaperFigureKind {
    /// Curves, in the size of the figure.
    Chart,
    /// The 3-D view.
    Space,
    /// Small letters, which need the full width of the paper.
    Table,
    /// Empty axes next to a question.
    Frame,
}

/// Returns the figures of the panes that `lab` shows. `is_asked` is true if the page has a question.
pub(super) fn of_lab(
    lab: &Lab,
    pane_svg: fn(&Lab, Pane) -> String,
    is_asked: bool,
    ranges: &mut AxisRanges,
    go_on: LessonProgressCallback<'_>,
) -> Vec<Figure> {
    let look = &lab.view().look;
    let panes = match look.show.as_slice() {
        [] => &[Pane::Traces, Pane::Above],
        chosen => chosen,
    };
    let mut figures = Vec::new();
    for pane in panes {
        figures.extend(match pane {
            Pane::Traces => {
                let column = ranges.column(look.detail_of);
                let labels = FigureLabels {
                    y_range: ranges.of_run(column, lab, is_asked),
                    ..FigureLabels::default()
                };
                of_run(lab, column, labels, go_on)
            }
            Pane::Above => of_run(lab, ABOVE, FigureLabels::default(), go_on),
            Pane::ThreeD | Pane::Step => Some(Figure {
                caption: format!("The lab at t = {} s.", time_now(lab)),
                svg: pane_svg(lab, *pane),
                kind: match pane {
                    Pane::Step => PaperFigureKind::Table,
                    _ => PaperFigureKind::Space,
                },
            }),
            Pane::Lesson | Pane::Parameters => None,
        });
    }
    figures
}

impl AxisRanges {
    pub fn new(lesson: &Lesson) -> Self {
        let mut predicts = lesson.pages.iter().flat_map(LessonPage::predicts);
        let asked = predicts.find_map(|predict| match predict.draw {
            Some(DrawnAnswer::OverTime(column)) => Some(column),
            _ => None,
        });
        Self {
            usual: asked.unwrap_or(HEIGHT),
            shown: BTreeMap::new(),
        }
    }

    /// Returns the column that represents the traces with this fourth strip on paper.
    fn column(&self, strip: FourthStrip) -> &'static str {
        match strip {
            FourthStrip::Auto | FourthStrip::None => self.usual,
            FourthStrip::X => "x_m",
            FourthStrip::Y => "y_m",
            FourthStrip::Z => HEIGHT,
            FourthStrip::Tilt => TILT,
            FourthStrip::Distance => "distance_m",
            FourthStrip::Column(name) => name,
        }
    }

    /// Returns the range for `column` of the run of `lab`, or `None` if its extremes are not known.
    ///
    /// If the page has a question (`is_asked`), a small swing is not magnified, because it may be the answer.
    fn of_run(&mut self, column: &'static str, lab: &Lab, is_asked: bool) -> Option<(f64, f64)> {
        if let Some(chosen) = chosen_range(column, lab) {
            return Some(chosen);
        }
        let player = lab.player();
        let least_range = match column {
            HEIGHT => LEAST_ARM_SHARE * player.run().scenario().arm_m(),
            TILT => LEAST_TILT_DEG,
            _ => return None,
        };
        let low = player.number(&format!("measured_lowest_{column}"))?;
        let high = player.number(&format!("measured_highest_{column}"))?;
        let missing = if is_asked {
            least_range - (high - low)
        } else {
            0.0
        };
        let margin = (0.5 * missing).max(MARGIN * (high - low));
        let least = if column == TILT { 0.0 } else { f64::MIN };
        let own = (f64::max(low - margin, least), high + margin);
        let earlier = *self.shown.get(column).unwrap_or(&own);
        let range = (own.0.min(earlier.0), own.1.max(earlier.1));
        self.shown.insert(column, range);
        (range.0 < range.1).then_some(range)
    }

    /// Returns the shown range of heights, enlarged to twice its size, or `None` for another column.
    fn around_shown(&self, column: &str) -> Option<(f64, f64)> {
        let (low, high) = *self.shown.get(column).filter(|_| column == HEIGHT)?;
        let room = 0.5 * (high - low);
        Some((low - room, high + room))
    }

    /// Returns the empty axes for `drawn`. They cover the time of the run of `lab` so far, and show its start.
    pub fn frame(&self, drawn: DrawnAnswer, lab: &Lab) -> Option<Figure> {
        let run = lab.player().run();
        let (scenario, end_s) = (run.scenario(), run.now().time_s);
        let simulation = Simulation::new(Arc::clone(scenario));
        let start = simulation.now();
        let chart = match drawn {
            DrawnAnswer::FromAbove => {
                let reach = 1.1 * scenario.arm_m();
                let place = start.position();
                let axis = |name| quantity::axis(name).within((-reach, reach));
                Chart {
                    width_pt: ABOVE_PT,
                    is_true_to_scale: true,
                    ..empty(axis("x_m"), axis("y_m"), Some([place.x, place.y]))
                }
            }
            DrawnAnswer::OverTime(column) => {
                let value = RunQuantity::find(column)?.value_at(start);
                let range = chosen_range(column, lab)
                    .or_else(|| self.around_shown(column))
                    .or_else(|| natural_range(column, value, scenario))?;
                let time = quantity::axis("t_s").within((0.0, end_s));
                let value_axis = quantity::axis(column).within(range);
                // A force at the start would reveal how the motion begins.
                let is_given = !column.ends_with("_N");
                empty(time, value_axis, is_given.then_some([0.0, value]))
            }
        };
        let mut scene = chart.scene();
        let caption = match drawn {
            DrawnAnswer::FromAbove => "Draw the path that you expect, seen from above.".to_owned(),
            DrawnAnswer::OverTime(column) => {
                format!("Draw what you expect: {} over time.", words(column))
            }
        };
        scene.title = format!("Empty axes. {caption}");
        Some(Figure {
            svg: svg(&scene)?,
            caption,
            kind: PaperFigureKind::Frame,
        })
    }
}

/// Returns the range that the lesson has chosen for the strip of `column`.
fn chosen_range(column: &str, lab: &Lab) -> Option<(f64, f64)> {
    let look = &lab.view().look;
    let chosen = match (column, look.detail_of) {
        (HEIGHT, _) => look.z_range_m,
        (TILT, FourthStrip::Tilt) => look.detail_range,
        (column, FourthStrip::Column(shown)) if shown == column => look.detail_range,
        _ => None,
    };
    chosen.map(|[low, high]| (low, high))
}

/// Returns the figure of this kind for the run of `lab` up to its current step. Returns `None` at step 0, or if it
/// cannot be drawn.
fn of_run(
    lab: &Lab,
    kind: &str,
    mut labels: FigureLabels,
    go_on: LessonProgressCallback<'_>,
) -> Option<Figure> {
    let player = lab.player();
    let step = player.step_number();
    let scenario = lab.runs().journal().scenario_until(step).ok()?;
    let end = time_now(lab);
    let caption = match kind {
        ABOVE => format!("The path from above, 0 to {end} s."),
        column => format!("{} over time, 0 to {end} s.", words(column)),
    };
    let exact = player.run().shows_exact();
    if exact {
        // Otherwise the legend would state the file's time step, although the page may have set another.
        labels.names = vec!["computed".to_owned()];
    }
    let source = FigureSource {
        spec: FigureSpec {
            kind: Some(kind.to_owned()),
            exact,
            width_pt: (kind == ABOVE).then_some(ABOVE_PT),
            labels,
            ..FigureSpec::default()
        },
        runs: vec![FigureRun::titled(scenario)],
        ..FigureSource::default()
    };
    let drawn = (step > 0).then(|| source.draw(go_on));
    let mut scene = drawn?.ok()??.scene;
    scene.title = format!("{caption} {}", scene.title);
    Some(Figure {
        svg: svg(&scene)?,
        caption,
        kind: PaperFigureKind::Chart,
    })
}

/// Returns the time of the run to a thousandth, s.
fn time_now(lab: &Lab) -> String {
    let time_s = lab.player().run().now().time_s;
    shortest(libm::round(time_s * 1000.0) / 1000.0)
}

fn words(column: &str) -> String {
    RunQuantity::find(column).map_or_else(|| column.to_owned(), RunQuantity::words)
}

fn svg(scene: &PageScene) -> Option<String> {
    let bytes = format::write(scene, PageFormat::Svg, None).ok()?;
    String::from_utf8(bytes).ok()
}

/// Returns empty axes, with the starting point of the motion if given.
fn empty(x: ChartAxis, y: ChartAxis, start: Option<[f64; 2]>) -> Chart {
    let series = start.map(|start| ChartSeries::new("start", vec![start], SeriesStyle::points(0)));
    Chart {
        width_pt: COLUMN_PT,
        x,
        panels: vec![Panel::new(y, series.into_iter().collect())],
        ..Chart::default()
    }
}

/// Returns a range of `column` that does not reveal the motion, because it depends only on the body and the start.
/// Returns `None` for other columns.
fn natural_range(column: &str, start: f64, scenario: &Scenario) -> Option<(f64, f64)> {
    let reach = 1.1 * scenario.arm_m();
    Some(match column {
        HEIGHT if start > 0.2 * reach => (0.0, reach),
        HEIGHT | "x_m" | "y_m" => (-reach, reach),
        TILT if start <= 90.0 => (0.0, 120.0),
        TILT => (0.0, 185.0),
        "azimuth_deg" => (start - 30.0, start + 390.0),
        _ if column.starts_with('w') && start != 0.0 => (-1.5 * start.abs(), 1.5 * start.abs()),
        _ => return None,
    })
}
