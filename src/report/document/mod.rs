//! Documents: headings, paragraphs, tables, figures and code, written as Markdown and as TeX.
//!
//! [`Document::markdown`] and [`Document::tex`] write the same blocks, with the same numbers of figures and tables.
//! Sentences are [`Text`]: plain text, or markup with emphasis, code, formulas, quantities and references.
//!
//! ```
//! use gyrolab::report::document::{Column, Document, Text, quantity};
//!
//! let mut document = Document::new(Text::plain("The wobble & its time step"));
//! document.section("What was run");
//! let height = quantity("0.389(12)", "m");
//! document.paragraph(&format!("The trace falls by {height}, *not* by 1 %: $ψ = |Ω| dt$ is large."));
//! document.table(
//!     "Two time steps.",
//!     [Column::text("scheme"), Column::number("fall (m)")],
//!     [[Text::plain("report"), Text::number("0.389(12)")]],
//! );
//! assert!(document.markdown().contains("falls by 0.389(12) m, *not* by 1 %: *ψ* = |*Ω*| *dt* is large"));
//! assert!(document.tex().contains(r"falls by \SI{0.389(12)}{m}, \emph{not} by 1 \%: $\psi = |\Omega|\,dt$ is large"));
//! ```

mod bibliography;
mod formula;
mod markdown;
mod table;
mod tex;
mod tex_text;
mod text;

pub use bibliography::{Entry, Reference};
pub use table::{Column, ColumnKind, Table};
pub use text::{Span, Text, escape, quantity};

/// The name of the file of references that the TeX document reads.
pub const BIBLIOGRAPHY_FILE: &str = "refs.bib";

/// A document: its title, its blocks in reading order, and the works that it cites.
#[derive(Clone, Debug, Default)]
pub struct Document {
    pub title: Text,
    pub blocks: Vec<Block>,
    pub references: Vec<Reference>,
}

#[derive(Clone, Debug)]
pub enum Block {
    /// Level 1 is a section, 2 a subsection, 3 a paragraph with a title.
    Heading {
        level: u8,
        text: Text,
    },
    Paragraph(Text),
    /// What another text says, set off from the paragraphs.
    Quote(Text),
    /// A formula on a line of its own, in the notation between two `$` of a text.
    Formula(String),
    List {
        is_numbered: bool,
        items: Vec<Text>,
    },
    Table(Table),
    Figure(Figure),
    /// Commands or a file, line by line. `language` is the name that Markdown gives it, such as `sh` or `toml`.
    Code {
        language: &'static str,
        text: String,
    },
}

/// One or more pictures side by side, with one caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The name by which `[#label]` in a text refers to it: letters, digits and hyphens.
    pub label: String,
    /// Paths of the pictures from the document's folder, without their endings: each exists as `.svg` and `.pdf`.
    pub pictures: Vec<String>,
    /// The width of each picture, mm. Pictures that are wider than the page together are made smaller.
    pub width_mm: f64,
    pub caption: Text,
}

impl Document {
    pub fn new(title: Text) -> Self {
        Self {
            title,
            ..Self::default()
        }
    }

    /// Begins a section. `text` is markup, as in the other methods.
    pub fn section(&mut self, text: &str) {
        self.heading(1, text);
    }

    pub fn subsection(&mut self, text: &str) {
        self.heading(2, text);
    }

    fn heading(&mut self, level: u8, text: &str) {
        let text = Text::marked(text);
        self.blocks.push(Block::Heading { level, text });
    }

    pub fn paragraph(&mut self, text: &str) {
        self.blocks.push(Block::Paragraph(Text::marked(text)));
    }

    pub fn quote(&mut self, text: &str) {
        self.blocks.push(Block::Quote(Text::marked(text)));
    }

    /// Adds a formula on a line of its own.
    pub fn formula(&mut self, formula: &str) {
        self.blocks.push(Block::Formula(formula.to_owned()));
    }

    /// Adds a list with bullets.
    pub fn list<S: AsRef<str>>(&mut self, items: impl IntoIterator<Item = S>) {
        self.add_list(false, items);
    }

    pub fn numbered_list<S: AsRef<str>>(&mut self, items: impl IntoIterator<Item = S>) {
        self.add_list(true, items);
    }

    fn add_list<S: AsRef<str>>(&mut self, is_numbered: bool, items: impl IntoIterator<Item = S>) {
        let items = items.into_iter().map(|item| Text::marked(item.as_ref()));
        self.blocks.push(Block::List {
            is_numbered,
            items: items.collect(),
        });
    }

    /// Adds a table without a label. Every row has a cell for each column; a column of empty cells is left out.
    pub fn table<const N: usize>(
        &mut self,
        caption: &str,
        columns: [Column; N],
        rows: impl IntoIterator<Item = [Text; N]>,
    ) {
        let rows = rows.into_iter().map(Vec::from).collect();
        self.any_table(None, caption, columns.into(), rows);
    }

    /// Adds a table to which `[#label]` refers.
    pub fn labeled_table<const N: usize>(
        &mut self,
        label: &str,
        caption: &str,
        columns: [Column; N],
        rows: impl IntoIterator<Item = [Text; N]>,
    ) {
        let rows = rows.into_iter().map(Vec::from).collect();
        self.any_table(Some(label), caption, columns.into(), rows);
    }

    /// Adds a table of any number of columns.
    pub fn any_table(
        &mut self,
        label: Option<&str>,
        caption: &str,
        columns: Vec<Column>,
        rows: Vec<Vec<Text>>,
    ) {
        let mut table = Table {
            label: label.map(str::to_owned),
            caption: Text::marked(caption),
            columns,
            rows,
        };
        table.remove_empty_columns();
        self.blocks.push(Block::Table(table));
    }

    /// Adds the figure of the picture `label`.svg and `label`.pdf.
    pub fn figure(&mut self, label: &str, width_mm: f64, caption: &str) {
        self.blocks.push(Block::Figure(Figure {
            label: label.to_owned(),
            pictures: vec![label.to_owned()],
            width_mm,
            caption: Text::marked(caption),
        }));
    }

    pub fn code(&mut self, language: &'static str, text: &str) {
        self.blocks.push(Block::Code {
            language,
            text: text.to_owned(),
        });
    }

    /// Returns the document as Markdown (GitHub's, which has tables).
    pub fn markdown(&self) -> String {
        markdown::write(self)
    }

    /// Returns the document as a complete TeX file for pdflatex, with booktabs, siunitx, graphicx and hyperref. It reads
    /// [`BIBLIOGRAPHY_FILE`] if the document has references.
    pub fn tex(&self) -> String {
        tex::write(self)
    }

    /// Returns the references as a BibTeX file.
    pub fn bibliography(&self) -> String {
        self.references.iter().map(Reference::bibtex).collect()
    }

    /// Returns what a reader calls the figure or table `label`: "Figure 2". `None` if there is none.
    fn name_of(&self, label: &str) -> Option<String> {
        let (mut figures, mut tables) = (0, 0);
        for block in &self.blocks {
            match block {
                Block::Figure(figure) => {
                    figures += 1;
                    if figure.label == label {
                        return Some(format!("Figure {figures}"));
                    }
                }
                Block::Table(table) => {
                    tables += 1;
                    if table.label.as_deref() == Some(label) {
                        return Some(format!("Table {tables}"));
                    }
                }
                _ => {}
            }
        }
        None
    }

    /// Returns the number of the reference `key`, counted from 1.
    fn number_of(&self, key: &str) -> Option<usize> {
        let place = self.references.iter().position(|it| it.key == key);
        place.map(|place| place + 1)
    }
}

#[cfg(test)]
mod tests;
