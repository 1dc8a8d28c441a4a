//! Is a CSV what its header says? What it holds, a run, a sweep, a comparison or a fit, is recomputed and compared with the
//! file line by line.

mod file_comparison;
mod recipe;
mod unverified;

use crate::engine::scenario::head::Head;
use crate::engine::scenario::{Document, Problem, Problems};
use file_comparison::UntilDifference;
pub use file_comparison::{FileComparison, FileDifference, first_difference};
use recipe::CsvRecipe;
pub use recipe::csv_of_comparison;
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::Path;
pub use unverified::{Unverified, other_version};

#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    pub rows: u64,
    /// The first thing that differs; `None` where all is the same.
    pub difference: Option<FileDifference>,
    /// What else there is to say, a line each: another version, where the run ends early, whether to believe it.
    pub notes: Vec<String>,
}

/// Recomputes the CSV `path` and compares. `fit` computes the CSV of the fit of a command line. `watch` gets the steps taken
/// so far (of a sweep the rows) and their number in all, and says whether to go on.
pub fn verify(
    path: &Path,
    fit: impl FnOnce(&str) -> Result<Vec<u8>, Unverified>,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Verified, Unverified> {
    let mut file = BufReader::new(File::open(path)?);
    let head = Head::read(&mut file)?;
    let header = run_file(&head)?;
    let document = Document::parse_header(&path.display().to_string(), &header)?;
    let version = document
        .table()
        .get("gyrolab")
        .and_then(toml::Value::as_str);
    let mut notes = Vec::from_iter(version.and_then(other_version));
    let recipe = CsvRecipe::read(path, &head, &header, &document)?;
    let mut comparison = FileComparison::new(&head, file);
    recipe.describe_columns(&mut comparison);
    let recomputed = recipe.recompute(UntilDifference(&mut comparison), &mut notes, fit, watch);
    if !comparison.differs() {
        recomputed?; // else it has stopped at the difference
    }
    let (rows, difference) = comparison.end()?;
    Ok(Verified {
        rows,
        difference,
        notes,
    })
}

/// The run file in the head of a CSV that gyrolab wrote.
fn run_file(head: &Head) -> Result<String, Problems> {
    if head.is_of_csv() {
        return head
            .run_file()
            .map_err(|problem| Problems::one("", problem));
    }
    let bytes = head.bytes();
    let rule = if bytes.is_empty() {
        "is empty: there is nothing to verify"
    } else if bytes.starts_with(b"# ") && bytes.ends_with(b"\n") && head.names().is_empty() {
        "ends in its header: there are no rows to verify"
    } else {
        "is no CSV that gyrolab wrote: those begin with the run file in \"# \" lines, and name their columns below it (a write-up is verified by its folder)"
    };
    Err(Problems::one("", Problem::at("", rule)))
}
