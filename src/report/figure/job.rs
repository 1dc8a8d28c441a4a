//! A figure of runs at work: the runs with their numbers, and what it is once it is drawn.

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
    /// The run under the title of its scenario.
    pub fn titled(scenario: Arc<Scenario>) -> Self {
        let named = scenario.file.title.clone();
        Self { scenario, named }
    }
}

/// What is known of a single run before its figures are drawn: so much of it need not be computed once more.
#[derive(Clone, Debug, Default)]
pub struct KnownNumbers {
    pub recorded: Option<SampledRun>,
    /// What it says of the measured data of the figures: of each column a value for every point.
    pub said: Option<Vec<Vec<f64>>>,
}

/// A run with its numbers, or the exact motion beside it.
pub(super) struct SampledRunNumbers {
    pub name: String,
    pub style: SeriesStyle,
    pub course: SampledRun,
    pub is_exact: bool,
}

/// A figure of runs that is being drawn: its source, of which the kind is known, and what is known of its runs.
#[derive(Clone, Copy)]
pub(super) struct FigureJob<'a> {
    pub runs: &'a [FigureRun],
    pub spec: &'a FigureSpec,
    pub kind: &'a FigureKind,
    /// What was measured on a run, to be drawn with them.
    pub measured: Option<&'a MeasuredData>,
    pub known: &'a KnownNumbers,
}

impl FigureJob<'_> {
    /// Whether both are drawn from the same numbers of the runs under the same names.
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

    /// Whether something is drawn beside the runs, so that a single run needs a name.
    pub fn is_beside(&self) -> bool {
        self.spec.exact || self.measured.is_some()
    }

    /// The end of the longest run, s.
    pub fn end_s(&self) -> f64 {
        let ends = self.runs.iter().map(|run| Clock::end_s(&run.scenario));
        ends.fold(0.0, f64::max)
    }

    /// Whether `time_s` is in the stretch that is drawn.
    pub fn has(&self, time_s: f64) -> bool {
        let to_s = self.spec.to_s;
        time_s >= self.spec.from_s && to_s.is_none_or(|to_s| time_s <= to_s)
    }

    /// The titles of the runs, each once.
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
            x,
            panels,
            ..Chart::default()
        }
    }
}

/// What is too dense on paper to be told apart, and a shorter stretch of time in which it is not.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    /// What is, and how it is drawn, in words.
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
        write!(f, "{}; {} shows a part", self.what, self.options())
    }
}

#[derive(Clone, Debug)]
pub struct DrawnFigure {
    pub scene: PageScene,
    /// Warnings without the one of `dense`, each a sentence without its full stop.
    pub warnings: Vec<String>,
    /// What covers the paper so densely that it is solid black, where something does.
    pub dense: Option<Dense>,
    /// Which run's numbers stopped being finite, and at which step.
    pub broke: Option<String>,
}

impl DrawnFigure {
    /// A picture of which there is nothing to say.
    pub fn without_remarks(scene: PageScene) -> Self {
        Self {
            scene,
            warnings: Vec::new(),
            dense: None,
            broke: None,
        }
    }

    /// All that its reader should know of it, each a sentence without its end.
    pub fn told(&self) -> impl Iterator<Item = String> + '_ {
        let dense = self.dense.iter().map(ToString::to_string);
        self.warnings.iter().cloned().chain(dense)
    }
}
