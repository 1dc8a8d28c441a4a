//! The report, reproduced: one document that follows the student's report, runs its method again, and compares every claim
//! with the exact motion.
//!
//! Each number of the document is read from a CSV, and one command writes each CSV and each figure ([`TABLES`],
//! [`FIGURES`]). The caller runs these commands and passes the CSVs as [`Tables`] to [`texts`], which writes the document.
//!
//! - `made`: the commands.
//! - `tables`: what the commands wrote.
//! - `numbers`: the numbers of the document, read from the tables.
//! - `explanation`, `sections`, `reading`: the words.
//! - `claims`: what the report claims, and what is true.

mod claims;
mod explanation;
mod made;
mod numbers;
mod reading;
mod sections;
mod tables;

use super::document::Block;
use super::document::{BIBLIOGRAPHY_FILE, Document, Entry, Figure, Reference, Text};
use crate::engine::scenario::Problems;
use claims::{Claim, claims};
pub use made::{FIGURES, Made, TABLES};
use numbers::Numbers;
pub use tables::Tables;

/// The document as Markdown: the first file to read.
pub const REPRODUCTION_PAGE: &str = "README.md";
const TEX_FILE: &str = "report.tex";
/// The claims and their verdicts, for a program. No other folder that gyrolab writes holds a file of this name.
pub const CLAIMS_FILE: &str = "claims.json";

const TITLE: &str = "What the time step did: a report on the gyroscope, computed again";

const REPORT: Reference = Reference {
    key: "report",
    entry: Entry::Other,
    author: "{A student}",
    title: "Simulation on Precession Motion of a Gyroscope and Analysis of Precession Motion With Respect To the Tilted Axis",
    published: "report of a course, with programs in MATLAB",
    volume: "",
    pages: "",
    year: "",
};
const GOLDSTEIN: Reference = Reference {
    key: "goldstein",
    entry: Entry::Book,
    author: "H. Goldstein and C. Poole and J. Safko",
    title: "Classical Mechanics, 3rd edition, section 5.7",
    published: "Addison-Wesley",
    volume: "",
    pages: "",
    year: "2002",
};

/// Returns the texts of the reproduced report, which are computed from `tables`: the names of their files and their bytes.
///
/// # Errors
/// When a preset cannot be read.
pub fn texts(tables: &Tables) -> Result<Vec<(String, Vec<u8>)>, Problems> {
    let numbers = Numbers::read(tables)?;
    let claims = claims(&numbers);
    let document = document(&numbers, &claims);
    let texts = [
        (REPRODUCTION_PAGE, document.markdown()),
        (TEX_FILE, document.tex()),
        (BIBLIOGRAPHY_FILE, document.bibliography()),
        (CLAIMS_FILE, claims::json(&claims)),
    ];
    let named = texts.map(|(name, text)| (name.to_owned(), text.into_bytes()));
    Ok(named.into())
}

fn document(numbers: &Numbers, claims: &[Claim]) -> Document {
    let mut document = Document::new(Text::plain(TITLE));
    document.references = vec![REPORT, GOLDSTEIN];
    explanation::summary(&mut document, numbers);
    explanation::gyroscope(&mut document, numbers);
    explanation::method(&mut document, numbers);
    explanation::sampling(&mut document, numbers);
    sections::sections(&mut document, numbers);
    claims::table(&mut document, claims);
    reading::open_questions(&mut document, numbers);
    reading::files(&mut document);
    document
}

/// Adds the pictures that [`FIGURES`] has under these names, one or two side by side. The first name is the label.
fn figure<const N: usize>(document: &mut Document, names: [&str; N], caption: &str) {
    document.blocks.push(Block::Figure(Figure {
        label: names[0].to_owned(),
        pictures: names.map(made::picture).into(),
        width_mm: made::WIDTHS_MM[N - 1],
        caption: Text::marked(caption),
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_shows_every_figure_and_prints_every_command() {
        let files = texts(&Tables::default()).unwrap();
        let (_, page) = files
            .iter()
            .find(|(name, _)| name == REPRODUCTION_PAGE)
            .unwrap();
        let page = str::from_utf8(page).unwrap();
        for made in TABLES.iter().chain(FIGURES) {
            assert!(page.contains(&made.command()), "{}", made.command());
        }
        for made in FIGURES {
            assert!(
                page.contains(&format!("]({})", made.path())),
                "{}",
                made.path()
            );
        }
    }
}
