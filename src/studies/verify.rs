//! Verification of CSV files: recomputes a run, a sweep, a comparison or a fit from the header, and compares the result
//! with the file line by line.

mod file_comparison;
mod recipe;
mod unverified;

use crate::engine::scenario::head::Head;
use crate::engine::scenario::{Document, Problem, Problems};
use file_comparison::UntilDifference;
pub use file_comparison::{FileComparison, FileDifference, first_difference};
use recipe::CsvRecipe;
pub use recipe::{csv_of_comparison, write_rows};
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::Path;
pub use unverified::{Unverified, other_version};

#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    pub rows: u64,
    /// The first difference; `None` if file and result are the same.
    pub difference: Option<FileDifference>,
    /// Remarks, one per line: another version of gyrolab, a run that ends early, the accuracy of the run.
    pub notes: Vec<String>,
}

/// Recomputes the CSV `path` and compares it with the file.
///
/// `fit` computes the CSV of a fit from its command line. `watch` is called with the number of steps so far (for a
/// sweep, rows) and their total, and can stop the computation.
///
/// # Errors
/// Returns an error if the file cannot be read or recomputed, or if `watch` stopped the computation.
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
        recomputed?; // after a difference, the error only says that it stopped there
    }
    let (rows, difference) = comparison.end()?;
    Ok(Verified {
        rows,
        difference,
        notes,
    })
}

/// Returns the run file in the header of a CSV from gyrolab.
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
        "ends within its header: there are no rows to verify"
    } else {
        "is not a CSV from gyrolab, which begins with the run file in \"# \" lines, followed by the column names (to verify a write-up, name its folder)"
    };
    Err(Problems::one("", Problem::at("", rule)))
}
