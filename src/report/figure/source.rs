//! What a figure is drawn from, what of that its file carries, and the way back.

use super::job::{FigureJob, FigureRun, KnownNumbers};
use super::kind::FigureKind;
use super::spec::FigureSpec;
use crate::engine::data::{self, MeasuredData};
use crate::engine::provenance::{File, Origin, Payload, sha256};
use crate::engine::scenario::{Document, Problem, Problems, csv};
use crate::engine::text::printable::brief;
use crate::plot::format::{self, PageFormat};
use crate::plot::scene::{PageScene, Unwritable};
use crate::studies::table::TableSource;
use std::path::Path;
use std::sync::Arc;

/// What a figure shows: runs, beside what was measured where there is something, or else a table.
#[derive(Clone, Debug, Default)]
pub struct FigureSource {
    pub spec: FigureSpec,
    pub runs: Vec<FigureRun>,
    pub measured: Option<Arc<MeasuredData>>,
    pub table: Option<TableSource>,
}

impl FigureSource {
    /// Draws `measured` with the runs.
    pub fn draw_with(&mut self, measured: Option<Arc<MeasuredData>>) {
        self.spec.measured_until_s = measured.as_ref().and_then(|it| it.until_s);
        self.measured = measured;
    }

    /// Refuses what no command line gives, and other names than there are runs.
    pub fn check(&self) -> Result<(), Problems> {
        let (runs, named) = (self.runs.len(), self.spec.labels.names.len());
        if !self.spec.is_sound() || (runs == 0 && self.table.is_none()) {
            return Err(refused("was asked for what no figure can have"));
        }
        if ![0, runs].contains(&named) && self.table.is_none() {
            return Err(refused(&format!(
                "--label is given {named} times for {runs} runs: give it once per run, in order"
            )));
        }
        Ok(())
    }

    /// Returns its kind, of a figure of runs.
    pub(super) fn kind(&self) -> Result<FigureKind, String> {
        match (&self.spec.kind, &self.measured) {
            (Some(kind), _) => {
                FigureKind::named(kind).map_err(|rule| format!("{} {rule}", brief(kind, 60)))
            }
            (None, Some(measured)) => Ok(FigureKind::measured(measured.series()?)),
            (None, None) => Ok(FigureKind::traces()),
        }
    }

    /// Returns it as a figure of runs to be drawn: of this `kind`, with what is `known` of its runs.
    pub(super) fn job<'a>(
        &'a self,
        kind: &'a FigureKind,
        known: &'a KnownNumbers,
    ) -> FigureJob<'a> {
        FigureJob {
            runs: &self.runs,
            spec: &self.spec,
            kind,
            measured: self.measured.as_deref(),
            known,
        }
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
        let spec = FigureSpec {
            text: format == PageFormat::SvgText,
            ..self.spec.clone()
        };
        let runs = self
            .runs
            .iter()
            .map(|run| File::new(Payload::Run, &run.named, &run.scenario.to_toml()));
        let data = self
            .measured
            .iter()
            .map(|it| File::new(Payload::Data, &it.origin, &it.text));
        let table = self
            .table
            .iter()
            .map(|it| File::new(Payload::Table, &it.origin, &it.text));
        Origin::new(&spec, runs.chain(data).chain(table).collect())
    }

    /// What the figure of that `origin` shows. A file that was too large to travel is sought in `folder`.
    pub fn from_origin(origin: &Origin, folder: &Path) -> Result<Self, Problems> {
        let spec: Result<FigureSpec, _> = origin.figure.clone().try_into();
        let mut source = Self {
            spec: spec.map_err(|error| refused(error.message()))?,
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
                    let until_s = source.spec.measured_until_s;
                    let measured = data::read(&named, &text)?.until(until_s);
                    source.measured = Some(Arc::new(measured));
                }
                Payload::Table => source.table = TableSource::from_csv(&named, text)?,
            }
        }
        Ok(source)
    }
}

fn refused(rule: &str) -> Problems {
    Problem::at("", rule).into()
}

/// What is in a carried `file`; of one that was too large for it what is in the file of that name in `folder`.
fn content(file: &File, folder: &Path) -> Result<String, Problems> {
    let Some(sum) = &file.sha256 else {
        return Ok(file.text.clone());
    };
    let path = folder.join(Path::new(&file.name).file_name().unwrap_or_default());
    let text = path.is_file().then(|| csv::text(&path).ok()).flatten();
    let text = text.filter(|text| sha256(text.as_bytes()) == *sum);
    text.ok_or_else(|| {
        let name = &file.name;
        refused(&format!(
            "needs {name} (SHA-256 {sum}), which was too large to travel with it: put that file into the same folder"
        ))
    })
}
