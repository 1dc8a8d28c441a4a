//! The source of a figure: the runs, data or table to draw, and their embedding in the figure's file.

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

/// The content of a figure: runs with optional measured data, or a table.
#[derive(Clone, Debug, Default)]
pub struct FigureSource {
    pub spec: FigureSpec,
    pub runs: Vec<FigureRun>,
    pub measured: Option<Arc<MeasuredData>>,
    pub table: Option<TableSource>,
}

impl FigureSource {
    /// Adds `measured` to the figure.
    pub fn draw_with(&mut self, measured: Option<Arc<MeasuredData>>) {
        self.spec.measured_until_s = measured.as_ref().and_then(|it| it.until_s);
        self.measured = measured;
    }

    /// Checks that the request is valid, and that there is one name per run.
    ///
    /// # Errors
    /// Returns an error for values that no command line allows, or if the number of names differs from the number of
    /// runs.
    pub fn check(&self) -> Result<(), Problems> {
        let (runs, named) = (self.runs.len(), self.spec.labels.names.len());
        if !self.spec.is_sound() || (runs == 0 && self.table.is_none()) {
            return Err(refused("contains an invalid request for a figure"));
        }
        self.spec.check_letters().map_err(|rule| refused(&rule))?;
        if ![0, runs].contains(&named) && self.table.is_none() {
            return Err(refused(&format!(
                "--label is given {named} times for {runs} runs: give it once per run, in order"
            )));
        }
        Ok(())
    }

    /// Returns the kind of a figure of runs.
    pub(super) fn kind(&self) -> Result<FigureKind, String> {
        match (&self.spec.kind, &self.measured) {
            (Some(kind), _) => {
                FigureKind::named(kind).map_err(|rule| format!("{} {rule}", brief(kind, 60)))
            }
            (None, Some(measured)) => Ok(FigureKind::measured(measured.series()?)),
            (None, None) => Ok(FigureKind::traces()),
        }
    }

    /// Returns the job that draws this figure of runs as `kind`, reusing the numbers in `known`.
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

    /// Returns the bytes of a file that shows `scene`, with this source embedded.
    ///
    /// # Errors
    /// Returns the errors of [`format::write`].
    pub fn write(&self, scene: &PageScene, format: PageFormat) -> Result<Vec<u8>, Unwritable> {
        let mut origin = self.origin(format);
        origin.caveats.clone_from(&scene.caveats);
        format::write(scene, format, Some(&origin))
    }

    /// Returns the data to embed in the figure's file.
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

    /// Restores the source from an embedded `origin`. A file that was too large to embed is read from `folder`.
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

/// Returns the content of an embedded `file`. If it was too large to embed, the file of that name in `folder` is read.
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
            "needs {name} (SHA-256 {sum}), which was too large to embed: put that file into the same folder"
        ))
    })
}
