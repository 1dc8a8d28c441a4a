//! What a figure shows, what of that its file carries, and the way back.

use super::kind::Kind;
use super::labels::Labels;
use super::of_runs::{self, Figure, Request, Run};
use super::page::format::{self, Format, Unwritable};
use super::page::scene::Scene;
use super::table::Table;
use super::{COLUMN_PT, PT_PER_MM, of_table};
use crate::data;
use crate::origin::{File, Holds, Origin, sha256};
use crate::scenario::{Document, Problem, Problems, csv};
use serde::{Deserialize, Serialize};
use std::ops::{ControlFlow, RangeInclusive};
use std::path::Path;
use std::sync::Arc;

/// The narrowest and the widest page, mm.
pub const WIDTHS_MM: RangeInclusive<f64> = 30.0..=1000.0;

#[derive(Clone, Debug)]
pub enum Source {
    Runs(Vec<Run>, Request),
    Table(Table, OfTable),
}

/// What a figure of a table is to show: those of the columns that are named, all that make sense where none is.
#[derive(Clone, Debug, PartialEq)]
pub struct OfTable {
    pub kind: Option<String>,
    pub width_pt: f64,
    pub labels: Labels,
}

/// What a figure was asked to show, as its file has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Asked {
    kind: Option<String>,
    from_s: f64,
    to_s: Option<f64>,
    exact: bool,
    /// What was measured later is not shown, s.
    measured_until_s: Option<f64>,
    width_pt: f64,
    /// Whether an SVG has its text as text.
    text: bool,
    labels: Labels,
}

impl Default for Asked {
    fn default() -> Self {
        Self::of(&Request::default())
    }
}

impl Asked {
    fn of(request: &Request) -> Self {
        Self {
            kind: Some(request.kind.name()),
            from_s: request.from_s,
            to_s: request.to_s,
            exact: request.exact,
            measured_until_s: request.measured.as_ref().and_then(|it| it.until_s),
            width_pt: request.width_pt,
            text: false,
            labels: request.labels.clone(),
        }
    }

    /// Refuses numbers that no command line could have given.
    fn check(&self) -> Result<(), &'static str> {
        let is_time = |time_s: f64| time_s >= 0.0 && time_s.is_finite();
        let times_s = [Some(self.from_s), self.to_s, self.measured_until_s];
        let width_mm = (self.width_pt / PT_PER_MM * 1e6).round() / 1e6;
        let is_range = |(low, high): (f64, f64)| low < high && (high - low).is_finite();
        let is_sound = times_s.into_iter().flatten().all(is_time)
            && WIDTHS_MM.contains(&width_mm)
            && self.labels.y_range.is_none_or(is_range);
        is_sound
            .then_some(())
            .ok_or("what was asked of this figure cannot be drawn")
    }
}

impl Source {
    /// Draws it. `watch` is told the step reached and the last one, and says whether to go on; `None` where it said no.
    ///
    /// # Errors
    /// When it cannot be drawn so, in words.
    pub fn draw(
        &self,
        watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Option<Figure>, String> {
        match self {
            Self::Runs(runs, request) => of_runs::figure(runs, request, watch),
            Self::Table(table, asked) => {
                let drawn = asked
                    .draw(table)
                    .map_err(|refusal| format!("{}: {refusal}", table.origin));
                drawn.map(Some)
            }
        }
    }

    /// The bytes of a file of the `scene` that was drawn, which carries what it was drawn from.
    ///
    /// # Errors
    /// As [`format::write`].
    pub fn write(&self, scene: &Scene, format: Format) -> Result<Vec<u8>, Unwritable> {
        format::write(scene, format, Some(&self.origin(format)))
    }

    /// What its file carries.
    pub fn origin(&self, format: Format) -> Origin {
        let (mut asked, files) = match self {
            Self::Runs(runs, request) => {
                let run = |run: &Run| File::new(Holds::Run, &run.named, &run.scenario.to_toml());
                let measured = request.measured.iter();
                let measured = measured.map(|it| File::new(Holds::Data, &it.origin, &it.text));
                let files = runs.iter().map(run).chain(measured).collect();
                (Asked::of(request), files)
            }
            Self::Table(table, of_table) => {
                let asked = Asked {
                    kind: of_table.kind.clone(),
                    width_pt: of_table.width_pt,
                    labels: of_table.labels.clone(),
                    ..Asked::default()
                };
                (
                    asked,
                    vec![File::new(Holds::Table, &table.origin, &table.text)],
                )
            }
        };
        asked.text = format == Format::SvgText;
        Origin {
            gyrolab: env!("CARGO_PKG_VERSION").to_owned(),
            figure: toml::Table::try_from(asked).unwrap_or_default(),
            files,
        }
    }

    /// What the figure of that `origin` shows, and whether its SVG has text as text. A file that was too large to travel is
    /// sought in `folder`.
    pub fn of(origin: &Origin, folder: &Path) -> Result<(Self, bool), Problems> {
        let refused = |rule: String| Problems::from(Problem::at("", rule));
        let asked: Result<Asked, _> = origin.figure.clone().try_into();
        let asked = asked.map_err(|error| refused(error.message().to_owned()))?;
        asked.check().map_err(|rule| refused(rule.to_owned()))?;
        if let Some(table) = origin.all(Holds::Table).next() {
            let opened = Table::of(&table.name, content(table, folder)?)?;
            let table = opened.ok_or_else(|| refused(format!("{}: is no table", table.name)))?;
            let of_table = OfTable {
                kind: asked.kind,
                width_pt: asked.width_pt,
                labels: asked.labels,
            };
            return Ok((Self::Table(table, of_table), asked.text));
        }
        let mut runs = Vec::new();
        for run in origin.all(Holds::Run) {
            let document = Document::parse_header(&run.name, &content(run, folder)?)?;
            runs.push(Run {
                scenario: Arc::new(document.scenario()?),
                named: run.name.clone(),
            });
        }
        let named = asked.labels.names.len();
        if runs.is_empty() || !(named == 0 || named == runs.len()) {
            return Err(refused(
                "holds not as many runs as names of runs".to_owned(),
            ));
        }
        let mut measured = None;
        for file in origin.all(Holds::Data) {
            let data = data::read(&file.name, &content(file, folder)?)?;
            measured = Some(Arc::new(match asked.measured_until_s {
                Some(until_s) => data.until(until_s),
                None => data,
            }));
        }
        let kind = asked
            .kind
            .as_deref()
            .map_or(Ok(Kind::traces()), Kind::named);
        let request = Request {
            kind: kind.map_err(refused)?,
            from_s: asked.from_s,
            to_s: asked.to_s,
            exact: asked.exact,
            measured,
            width_pt: asked.width_pt,
            labels: asked.labels,
        };
        Ok((Self::Runs(runs, request), asked.text))
    }
}

/// What is in a carried `file`; of one that was too large for it what is in the file of that name in `folder`.
fn content(file: &File, folder: &Path) -> Result<String, Problems> {
    let sum = match &file.content {
        Ok(text) => return Ok(text.clone()),
        Err(sum) => sum,
    };
    let path = folder.join(Path::new(&file.name).file_name().unwrap_or_default());
    let text = csv::text(&path)
        .ok()
        .filter(|text| sha256(text.as_bytes()) == *sum);
    let rule = format!(
        "needs {} (SHA-256 {sum}), which was too large to travel with it: put that file into the same folder",
        file.name
    );
    text.ok_or_else(|| Problem::at("", rule).into())
}

impl OfTable {
    fn draw(&self, table: &Table) -> Result<Figure, String> {
        let columns = self.kind.iter().flat_map(|kind| kind.split(','));
        let columns: Vec<_> = columns.map(str::trim).collect();
        let mut chart = of_table::chart(table, &columns, self.width_pt)?;
        let hidden = self.labels.apply(&mut chart)?;
        let mut scene = chart.scene();
        self.labels.write_title(&mut scene);
        let mut warnings = of_table::warnings(table, &columns);
        warnings.extend(hidden);
        Ok(Figure {
            scene,
            warnings,
            dense: None,
            broke: None,
        })
    }
}

impl Default for Request {
    fn default() -> Self {
        Self {
            kind: Kind::traces(),
            from_s: 0.0,
            to_s: None,
            exact: false,
            measured: None,
            width_pt: COLUMN_PT,
            labels: Labels::default(),
        }
    }
}
