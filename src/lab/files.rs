//! The files of the lab: their folder, the permission to read and write them, and the export in progress.

use super::answer::{ActionResult, Done, PendingAction, Refusal};
use super::command::{Export, FigureCommand, Save};
use super::player::Player;
use super::runs::Runs;
use crate::engine::data::{self, MeasuredData};
use crate::engine::export::Destination;
use crate::engine::export::destination::DestinationError;
use crate::engine::scenario::limits::{LONGEST_SCENARIO_FILE, SCENARIO_TOO_LONG, check_toml_size};
use crate::engine::scenario::{Document, Problem, Problems, Scenario, presets};
use crate::engine::text::printable::{PrintablePath, is_steering};
use crate::lab::storage::confined::Confined;
use crate::lab::storage::exporting::{self, Exporting, Written};
use crate::plot::PageFormat;
use crate::report::figure::kind::FigureKind;
use crate::report::figure::of_runs::FigureRun;
use crate::report::figure::{FigureSource, FigureSpec};
use indicatif::{DecimalBytes, HumanCount};
use std::borrow::Cow;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Default)]
pub struct Files {
    /// The folder in which files are read and written; `None` for the working directory.
    folder: Option<PathBuf>,
    /// The only folder in which the lab reads and writes, if it is restricted.
    confined: Option<Confined>,
    exporting: Option<Exporting>,
    /// The reason why the last export failed, until it has been read.
    failure: Option<String>,
    pub written: Vec<Written>,
    /// A line about the origin of the run for the header of an export.
    pub note: Option<String>,
}

impl Files {
    /// Reads and writes files in `folder` instead of the working directory.
    pub fn work_in(&mut self, folder: &Path) {
        self.folder = Some(folder.to_owned());
    }

    pub(super) fn folder(&self) -> &Path {
        self.folder.as_deref().unwrap_or(Path::new("."))
    }

    /// Restricts all reading and writing to `folder` from now on.
    pub fn confine(&mut self, folder: Confined) {
        self.confined = Some(folder);
    }

    /// Returns the only folder in which the lab reads and writes, if it is restricted.
    pub fn confined(&self) -> Option<&Confined> {
        self.confined.as_ref()
    }

    /// Checks that the file `path` may be read and written.
    ///
    /// # Errors
    /// Returns an error if the lab is restricted to another folder.
    pub fn admit(&self, path: &Path) -> Result<(), String> {
        self.confined().map_or(Ok(()), |folder| folder.check(path))
    }

    /// Checks that the file `path` may be read. The lab of a seat may also read files in the class's folder.
    ///
    /// # Errors
    /// Returns an error if the lab is restricted to another folder.
    pub fn admit_reading(&self, path: &Path) -> Result<(), String> {
        self.confined()
            .map_or(Ok(()), |folder| folder.check_reading(path))
    }

    fn admit_writing(&self, path: &Path) -> Result<(), String> {
        self.confined()
            .map_or(Ok(()), |folder| folder.check_writing(path))
    }

    /// Reads the preset or the file called `name`.
    pub(super) fn open_scenario(&self, name: &str) -> Result<Scenario, String> {
        self.admit_reading(Path::new(name))?;
        let checked = match presets::find(name) {
            Some(_) => Ok(()),
            None => refuse_waiting(name, "only the command line can open it"),
        };
        checked
            .and_then(|()| Document::open(name)?.scenario())
            .map_err(|problems| format!("{}: {}", problems.origin, problems.in_one_line()))
    }

    /// Reads the measured data `name`, shipped with the program or from a file.
    ///
    /// If `may_wait` is true, the file may be a FIFO or a device, which can take any length of time to read.
    pub(super) fn measured_text(
        &self,
        name: &str,
        may_wait: bool,
    ) -> Result<Cow<'static, str>, Problems> {
        if data::find_shipped(name).is_none() {
            self.admit(Path::new(name))
                .map_err(|rule| Problems::one(name, Problem::at("", rule)))?;
            if !may_wait {
                refuse_waiting(name, "gyrolab --measured can read it")?;
            }
        }
        data::text(name)
    }

    pub fn is_exporting(&self) -> bool {
        self.exporting.is_some()
    }

    /// Returns the path of the running export, if there is one.
    pub(super) fn exported_to(&self) -> Option<&Path> {
        self.exporting.as_ref().map(Exporting::path)
    }

    /// Starts writing the rows of the run.
    pub(super) fn export(&mut self, export: &Export, runs: &Runs, player: &Player) -> ActionResult {
        let mut layout = export.layout.clone();
        layout.note.clone_from(&self.note);
        let checked = layout.check().map_err(|error| error.to_string())?;
        let run = run_up_to(export.to_step, "export", runs, player)?;
        let scenario = runs.flag_stale_text(&run);
        let path = self.path_of(&export.path);
        self.may_export_to(&path)?;
        let begun = Exporting::begin(scenario, &path, checked, export.force);
        self.begin(begun, "exporting in the background")
    }

    fn begin(&mut self, begun: Result<Exporting, DestinationError>, said: &str) -> ActionResult {
        self.exporting = Some(begun.map_err(refusal)?);
        self.failure = None;
        Ok(Done::saying(said).going_on(PendingAction::Exporting))
    }

    /// Starts drawing a figure of the run.
    pub(super) fn draw(
        &mut self,
        figure: &FigureCommand,
        runs: &Runs,
        player: &Player,
        measured: Option<Arc<MeasuredData>>,
    ) -> ActionResult {
        let scenario = run_up_to(figure.to_step, "draw", runs, player)?;
        let path = self.path_of(&figure.path);
        self.may_export_to(&path)?;
        let kind = FigureKind::named(&figure.kind)
            .map_err(|refusal| format!("kind {} {refusal}", figure.kind))?;
        let source = FigureSource {
            spec: FigureSpec {
                kind: Some(kind.name()),
                exact: figure.exact,
                ..FigureSpec::default()
            },
            runs: vec![FigureRun::titled(scenario)],
            measured,
            table: None,
        };
        let format = PageFormat::from_path(&path).map_err(|refusal| refusal.to_string())?;
        let begun = Exporting::begin_figure(source, &path, format, figure.force);
        self.begin(begun, "drawing the figure in the background")
    }

    /// Saves the run as a run file, or its present state as a scenario.
    pub(super) fn save_run(&self, save: &Save, runs: &Runs, player: &Player) -> ActionResult {
        let path = self.path_of(&save.path);
        if save.from_here {
            let content = player.present_as_text()?;
            return self.save("the scenario", &content, &path, save.force);
        }
        let run = run_up_to(save.to_step, "save", runs, player)?;
        let run = runs.flag_stale_text(&run).to_toml();
        self.save("the run", &run, &path, save.force)
    }

    fn may_export_to(&self, path: &Path) -> Result<(), Refusal> {
        if self.exporting.is_some() {
            return Err("one export at a time: wait until the running one is done".into());
        }
        is_named(path)?;
        Ok(self.admit_writing(path)?)
    }

    pub(super) fn stop_export(&mut self) {
        if let Some(exporting) = &self.exporting {
            exporting.cancel();
        }
    }

    /// Checks the running export. Returns a message once it has ended.
    pub(super) fn follow_export(&mut self) -> Option<String> {
        let outcome = self.exporting.as_mut()?.outcome()?;
        self.exporting = None;
        Some(match outcome {
            Ok(written) => {
                let is_seat = self.confined().is_some_and(Confined::is_seat);
                let text = in_words(&written, is_seat);
                self.written.push(written);
                text
            }
            Err(reason) => {
                self.failure = Some(reason.clone());
                reason
            }
        })
    }

    /// Returns the reason if the last export failed, and forgets it.
    pub(super) fn take_failure(&mut self) -> Option<String> {
        self.failure.take()
    }

    /// Ends the running export and removes its file.
    pub(super) fn drop_export(&mut self) {
        self.exporting = None;
    }

    pub(super) fn export_in_words(&self) -> Option<String> {
        let (step, steps) = self.exporting.as_ref()?.progress();
        let percent = 100.0 * step as f64 / steps.max(1) as f64;
        Some(format!("exporting: {percent:.0} %, Esc stops it"))
    }

    /// Returns the path of the file that the user calls `name`.
    pub(super) fn path_of(&self, name: &str) -> PathBuf {
        let folder = self.folder.as_deref().filter(|_| !name.is_empty());
        folder.unwrap_or(Path::new("")).join(name)
    }

    /// Writes `content` to the file `path`. `what` names the content in messages.
    pub(super) fn save(&self, what: &str, content: &str, path: &Path, force: bool) -> ActionResult {
        is_named(path)?;
        if content.len() as u64 > LONGEST_SCENARIO_FILE {
            return Err(format!("{what} {SCENARIO_TOO_LONG}").into());
        }
        check_toml_size(content, 1).map_err(|problem| format!("{what} {}", problem.rule))?;
        self.admit_writing(path)?;
        let mut destination = Destination::open_file(path, force).map_err(refusal)?;
        let written = destination.write_all(content.as_bytes());
        written.map_err(|error| format!("cannot write {}: {error}", PrintablePath(path)))?;
        destination.keep().map_err(refusal)?;
        let whole = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let place = if self.confined().is_some_and(Confined::is_seat) {
            format!("{}: your teacher has it", PrintablePath(path))
        } else {
            PrintablePath(&whole).to_string()
        };
        Ok(Done {
            stays: true,
            ..Done::saying(format!("{what} is in {place}"))
        })
    }

    /// Returns an unused file name: `name` without its folder and extension, then `about`, a number if needed, and
    /// `extension`.
    pub(super) fn free_name(&self, name: &str, about: &str, extension: &str) -> String {
        let whole_stem = Path::new(name)
            .file_stem()
            .map_or("run".into(), |stem| stem.to_string_lossy());
        let stem = whole_stem
            .strip_suffix(about)
            .unwrap_or(&whole_stem)
            .replace(is_steering, "_"); // the suggested name can be read and typed
        (1..=1000)
            .map(|number| match number {
                1 => format!("{stem}{about}.{extension}"),
                _ => format!("{stem}{about}-{number}.{extension}"),
            })
            .find(|free_name| !self.path_of(free_name).exists())
            .unwrap_or_default()
    }
}

/// Returns the scenario of the run from step 0 to `to_step`, or to the present step of `player`. The verb `to` says in
/// messages what the run is needed for.
pub(super) fn run_up_to(
    to_step: Option<u64>,
    to: &str,
    runs: &Runs,
    player: &Player,
) -> Result<Arc<Scenario>, String> {
    let here = player.step_number();
    runs.run_up_to(to_step.unwrap_or(here), to)
}

fn refusal(error: DestinationError) -> Refusal {
    match error {
        DestinationError::Exists(path) => Refusal::Exists(path),
        other => Refusal::Because(other.fact()),
    }
}

/// Returns an error for a FIFO or a device: only the command line reads these, because they can block for any length of
/// time.
fn refuse_waiting(name: &str, instead: &str) -> Result<(), Problems> {
    if !Destination::may_wait(Path::new(name)) {
        return Ok(());
    }
    let rule = format!("is not a regular file: {instead}");
    Err(Problems::one(name, Problem::at("", rule)))
}

fn is_named(path: &Path) -> Result<(), Refusal> {
    let is_named = !path.as_os_str().is_empty();
    is_named.then_some(()).ok_or("the file needs a name".into())
}

/// Returns the message about a complete export, and how to copy the file. In the login of a seat no file can be copied.
fn in_words(written: &Written, is_seat: bool) -> String {
    let rows = written
        .rows
        .map(|rows| format!("{} rows, ", HumanCount(rows)));
    let warnings: String = written
        .warnings
        .iter()
        .map(|warning| format!(" · {warning}"))
        .collect();
    let end = match &written.not_finite {
        Some(end) => format!(", as far as the numbers are finite (step {})", end.step - 1),
        None => String::new(),
    };
    if is_seat {
        let name = written.path.file_name().unwrap_or_default();
        let (rows, name) = (rows.unwrap_or_default(), PrintablePath(Path::new(name)));
        return format!("wrote {rows}{name}{end}{warnings}: your teacher has it");
    }
    let fetched = exporting::scp_line(&written.path).map(|line| format!(" · {line}"));
    format!(
        "wrote {}{}{end}: {}{warnings}{}",
        rows.unwrap_or_default(),
        DecimalBytes(written.bytes),
        PrintablePath(&written.path),
        fetched.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suggested_name_is_unused() {
        let folder = tempfile::tempdir().unwrap();
        let mut files = Files::default();
        files.work_in(folder.path());
        assert_eq!(
            files.free_name("presets/cusps.toml", "", "csv"),
            "cusps.csv"
        );
        std::fs::write(folder.path().join("cusps-run.toml"), "").unwrap();
        let again = files.free_name("cusps-run.toml", "-run", "toml");
        assert_eq!(again, "cusps-run-2.toml");
        assert_eq!(files.free_name("a\u{1b}b", "", "csv"), "a_b.csv");
    }
}
