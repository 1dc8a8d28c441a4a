//! A figure of runs that is being drawn: the runs with their numbers, and the finished figure.

use super::course::SampledRun;
use super::kind::FigureKind;
use super::spec::FigureSpec;
use crate::engine::data::MeasuredData;
use crate::engine::run::Clock;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{shortest, significant};
use crate::plot::chart::{Chart, ChartAxis, Panel, SeriesStyle};
use crate::plot::scene::PageScene;
use std::fmt;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct FigureRun {
    pub scenario: Arc<Scenario>,
    pub named: String,
}

impl FigureRun {
    /// Creates a run named by the title of its scenario.
    pub fn titled(scenario: Arc<Scenario>) -> Self {
        let named = scenario.file.title.clone();
        Self { scenario, named }
    }
}

/// Numbers of a single run that are known before its figures are drawn, and need not be recomputed.
#[derive(Clone, Debug, Default)]
pub struct KnownNumbers {
    pub recorded: Option<SampledRun>,
    /// The run's values for the measured data of the figures: for each column, one value per point.
    pub said: Option<Vec<Vec<f64>>>,
}

/// A run with its numbers, or the exact motion drawn with it.
pub(super) struct SampledRunNumbers {
    pub name: String,
    pub style: SeriesStyle,
    pub course: SampledRun,
    pub is_exact: bool,
}

/// A figure of runs to draw: its source, its kind, and the known numbers of its runs.
#[derive(Clone, Copy)]
pub(super) struct FigureJob<'a> {
    pub runs: &'a [FigureRun],
    pub spec: &'a FigureSpec,
    pub kind: &'a FigureKind,
    /// Data measured on a run, to be drawn with the runs.
    pub measured: Option<&'a MeasuredData>,
    pub known: &'a KnownNumbers,
}

impl FigureJob<'_> {
    /// Returns true if both figures use the same numbers of the runs, with the same names.
    pub fn is_alike(&self, other: &Self) -> bool {
        let are_residuals = [self, other].map(|it| matches!(it.kind, FigureKind::Residuals));
        let [a, b] = [self.spec, other.spec];
        (a.from_s, a.to_s) == (b.from_s, b.to_s)
            && a.width_pt == b.width_pt
            && a.exact == b.exact
            && self.is_beside() == other.is_beside()
            && are_residuals[0] == are_residuals[1]
            && a.labels == b.labels
    }

    /// Returns true if the exact motion or data are drawn too, so that even a single run needs a name.
    pub fn is_beside(&self) -> bool {
        self.spec.exact || self.measured.is_some()
    }

    /// Returns the end time of the longest run, s.
    pub fn end_s(&self) -> f64 {
        let ends = self.runs.iter().map(|run| Clock::end_s(&run.scenario));
        ends.fold(0.0, f64::max)
    }

    /// Returns true if `time_s` is in the time range of the figure.
    pub fn has(&self, time_s: f64) -> bool {
        let to_s = self.spec.to_s;
        time_s >= self.spec.from_s && to_s.is_none_or(|to_s| time_s <= to_s)
    }

    /// Returns the titles of the runs, each once.
    pub fn title(&self) -> String {
        let mut titles: Vec<&str> = Vec::new();
        for run in self.runs {
            let title = run.scenario.file.title.as_str();
            if !titles.contains(&title) {
                titles.push(title);
            }
        }
        titles.join("; ")
    }

    pub fn chart(&self, x: ChartAxis, panels: Vec<Panel>) -> Chart {
        Chart {
            title: self.title(),
            width_pt: self.spec.page_width_pt(),
            decimal_comma: self.spec.decimal_comma,
            x,
            panels,
            ..Chart::default()
        }
    }
}

/// A curve or path that is too dense on paper, and a shorter time range in which its turns are visible.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// Description of the problem and of the drawing.
    pub what: String,
    pub from_s: f64,
    pub to_s: f64,
}

impl Dense {
    pub fn options(&self) -> String {
        let (from_s, to_s) = (shortest(self.from_s), significant(self.to_s, 9));
        format!("--from {from_s} --to {to_s}")
    }
}

impl fmt::Display for Dense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; use {} to show a part", self.what, self.options())
    }
}

#[derive(Clone, Debug)]
pub struct DrawnFigure {
    pub scene: PageScene,
    /// Warnings other than `dense`, each a sentence without a period.
    pub warnings: Vec<String>,
    /// A curve or path that covers the paper solidly, if any.
    pub dense: Option<Dense>,
    /// The run whose numbers stopped being finite, and the step.
    pub broke: Option<String>,
}

impl DrawnFigure {
    /// Creates a figure without remarks.
    pub fn without_remarks(scene: PageScene) -> Self {
        Self {
            scene,
            warnings: Vec::new(),
            dense: None,
            broke: None,
        }
    }

    /// Returns all warnings, each a sentence without a period.
    pub fn told(&self) -> impl Iterator<Item = String> + '_ {
        let dense = self.dense.iter().map(ToString::to_string);
        self.warnings.iter().cloned().chain(dense)
    }
}
