//! What a figure is drawn from, what of that its file carries, and the way back.

use super::kind::FigureKind;
use super::labels::FigureLabels;
use super::of_runs::{self, DrawnFigure, FigureRequest, FigureRun};
use super::of_table;
use crate::engine::data::{self, MeasuredData};
use crate::engine::provenance::{File, Origin, Payload, sha256};
use crate::engine::scenario::{Document, Problem, Problems, csv};
use crate::engine::text::printable::brief;
use crate::plot::format::{self, PageFormat};
use crate::plot::scene::{PageScene, Unwritable};
use crate::plot::{COLUMN_PT, PT_PER_MM};
use crate::studies::table::TableSource;
use serde::{Deserialize, Serialize};
use std::ops::{ControlFlow, RangeInclusive};
use std::path::Path;
use std::sync::Arc;

/// The narrowest and the widest page, mm.
pub const WIDTHS_MM: RangeInclusive<f64> = 30.0..=1000.0;

/// What a figure shows: runs, beside what was measured where there is something, or else a table.
#[derive(Clone, Debug, Default)]
pub struct FigureSource {
    pub asked: FigureOptions,
    pub runs: Vec<FigureRun>,
    pub measured: Option<Arc<MeasuredData>>,
    pub table: Option<TableSource>,
}

/// What of it is to be shown, as the figure's file has it; of a table kind, width and labels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureOptions {
    /// The name of a [`FigureKind`], or the columns of a table; what is usual where there is none.
    pub kind: Option<String>,
    pub from_s: f64,
    pub to_s: Option<f64>,
    pub exact: bool,
    /// What was measured later is not shown, s.
    pub measured_until_s: Option<f64>,
    /// The width of a column where there is none.
    pub width_pt: Option<f64>,
    /// Whether an SVG has its text as text.
    pub text: bool,
    pub labels: FigureLabels,
}

impl FigureSource {
    pub fn new(runs: &[FigureRun], request: &FigureRequest) -> Self {
        let FigureRequest { measured, .. } = request;
        let asked = FigureOptions {
            kind: Some(request.kind.name()),
            from_s: request.from_s,
            to_s: request.to_s,
            exact: request.exact,
            measured_until_s: measured.as_ref().and_then(|it| it.until_s),
            width_pt: Some(request.width_pt),
            text: false,
            labels: request.labels.clone(),
        };
        Self {
            asked,
            runs: runs.to_vec(),
            measured: measured.clone(),
            table: None,
        }
    }

    /// Draws it. `watch` is told the step reached and the last one, and says whether to go on; `None` where it said no.
    ///
    /// # Errors
    /// When it cannot be drawn so, in words.
    pub fn draw(
        &self,
        watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Option<DrawnFigure>, String> {
        self.check()?;
        match &self.table {
            Some(table) => match of_table(table, &self.asked) {
                Ok(figure) => Ok(Some(figure)),
                Err(refusal) => Err(format!("{}: {refusal}", table.origin)),
            },
            None => of_runs::figure(&self.runs, &self.request()?, watch),
        }
    }

    /// Refuses what no command line gives, and other names than there are runs.
    pub fn check(&self) -> Result<(), Problems> {
        let (asked, runs, named) = (&self.asked, self.runs.len(), self.asked.labels.names.len());
        let times_s = [Some(asked.from_s), asked.to_s, asked.measured_until_s];
        let is_sound = times_s
            .into_iter()
            .flatten()
            .all(|time_s| time_s >= 0.0 && time_s.is_finite())
            && asked
                .width_pt
                .is_none_or(|pt| WIDTHS_MM.contains(&((pt / PT_PER_MM * 1e6).round() / 1e6)))
            && asked
                .labels
                .y_range
                .is_none_or(|(low, high)| low < high && (high - low).is_finite())
            && (runs > 0 || self.table.is_some());
        if !is_sound {
            return Err(refused("was asked for what no figure can have"));
        }
        if ![0, runs].contains(&named) && self.table.is_none() {
            return Err(refused(&format!(
                "--label is given {named} times for {runs} runs: give it once per run, in order"
            )));
        }
        Ok(())
    }

    fn request(&self) -> Result<FigureRequest, String> {
        let asked = &self.asked;
        let kind = match (&asked.kind, &self.measured) {
            (Some(kind), _) => {
                FigureKind::named(kind).map_err(|rule| format!("{} {rule}", brief(kind, 60)))?
            }
            (None, Some(measured)) => FigureKind::measured(measured.series()?),
            (None, None) => FigureKind::traces(),
        };
        Ok(FigureRequest {
            kind,
            from_s: asked.from_s,
            to_s: asked.to_s,
            exact: asked.exact,
            measured: self.measured.clone(),
            width_pt: asked.width_pt.unwrap_or(COLUMN_PT),
            labels: asked.labels.clone(),
        })
    }

    /// The bytes of a file of the `scene` that was drawn, which carries what it was drawn from.
    ///
    /// # Errors
    /// As [`format::write`].
    pub fn write(&self, scene: &PageScene, format: PageFormat) -> Result<Vec<u8>, Unwritable> {
        format::write(scene, format, Some(&self.origin(format)))
    }

    /// What its file carries.
    pub fn origin(&self, format: PageFormat) -> Origin {
        let data = self.measured.iter();
        let data = data.map(|it| File::new(Payload::Data, &it.origin, &it.text));
        let table = self.table.iter();
        let table = table.map(|it| File::new(Payload::Table, &it.origin, &it.text));
        let asked = FigureOptions {
            text: format == PageFormat::SvgText,
            ..self.asked.clone()
        };
        let files = self
            .runs
            .iter()
            .map(|run| File::new(Payload::Run, &run.named, &run.scenario.to_toml()))
            .chain(data)
            .chain(table);
        Origin::new(&asked, files.collect())
    }

    /// What the figure of that `origin` shows. A file that was too large to travel is sought in `folder`.
    pub fn of(origin: &Origin, folder: &Path) -> Result<Self, Problems> {
        let asked: Result<FigureOptions, _> = origin.figure.clone().try_into();
        let mut source = Self {
            asked: asked.map_err(|error| refused(error.message()))?,
            ..Self::default()
        };
        for file in &origin.files {
            let (named, text) = (file.name.clone(), content(file, folder)?);
            match file.holds {
                Payload::Run => {
                    let scenario = Document::parse_header(&named, &text)?.scenario()?;
                    let scenario = Arc::new(scenario);
                    source.runs.push(FigureRun { scenario, named });
                }
                Payload::Data => {
                    let data = data::read(&named, &text)?;
                    let data = data.until(source.asked.measured_until_s);
                    source.measured = Some(Arc::new(data));
                }
                Payload::Table => source.table = TableSource::of(&named, text)?,
            }
        }
        Ok(source)
    }
}

/// The figure of `table` that is asked for.
fn of_table(table: &TableSource, asked: &FigureOptions) -> Result<DrawnFigure, String> {
    let columns = asked.kind.iter().flat_map(|kind| kind.split(','));
    let columns: Vec<_> = columns.map(str::trim).collect();
    let mut chart = of_table::chart(table, &columns, asked.width_pt.unwrap_or(COLUMN_PT))?;
    let without_point = of_table::warning(table, &chart);
    let hidden = asked.labels.apply(&mut chart)?;
    let mut figure = DrawnFigure::of(chart.scene());
    asked.labels.write_title(&mut figure.scene);
    figure
        .warnings
        .extend(without_point.into_iter().chain(hidden));
    Ok(figure)
}

fn refused(rule: &str) -> Problems {
    Problem::at("", rule).into()
}

/// What is in a carried `file`; of one that was too large for it what is in the file of that name in `folder`.
fn content(file: &File, folder: &Path) -> Result<String, Problems> {
    let Some(sum) = &file.sha256 else {
        return Ok(file.text.clone());
    };
    let name = Path::new(&file.name).file_name().unwrap_or_default();
    let path = folder.join(name);
    let text = path.is_file().then(|| csv::text(&path).ok()).flatten();
    let text = text.filter(|text| sha256(text.as_bytes()) == *sum);
    text.ok_or_else(|| {
        let name = &file.name;
        refused(&format!(
            "needs {name} (SHA-256 {sum}), which was too large to travel with it: put that file into the same folder"
        ))
    })
}
