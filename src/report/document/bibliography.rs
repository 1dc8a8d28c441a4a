//! The works that a document cites.

use super::tex_text::escaped;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reference {
    /// The name by which `[@key]` in a text refers to it.
    pub key: &'static str,
    pub entry: Entry,
    /// Authors separated by "and"; an institution in braces.
    pub author: &'static str,
    pub title: &'static str,
    /// The journal, the publisher, or where it can be found.
    pub published: &'static str,
    /// The volume and the pages of a journal.
    pub volume: &'static str,
    pub pages: &'static str,
    pub year: &'static str,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Entry {
    Article,
    Book,
    #[default]
    Other,
}

impl Reference {
    /// Returns the entry of a BibTeX file.
    pub(super) fn bibtex(&self) -> String {
        let (kind, place) = match self.entry {
            Entry::Article => ("article", "journal"),
            Entry::Book => ("book", "publisher"),
            Entry::Other => ("misc", "howpublished"),
        };
        let fields = [
            ("author", self.author.to_owned()),
            // Braces keep its capitals.
            ("title", format!("{{{}}}", escaped(self.title))),
            (place, escaped(self.published)),
            ("volume", self.volume.to_owned()),
            ("pages", self.pages.replace('–', "--")),
            ("year", self.year.to_owned()),
        ];
        let lines = fields
            .iter()
            .filter(|(_, value)| !value.is_empty())
            .map(|(name, value)| format!(",\n  {name} = {{{value}}}"));
        format!("@{kind}{{{}{}\n}}\n", self.key, lines.collect::<String>())
    }

    /// Returns the entry in the parts that a reader sees: before the title, the title, and after it.
    pub(super) fn line(&self) -> [String; 3] {
        let author = self.author.replace(['{', '}'], "");
        let place = match (self.volume, self.pages) {
            ("", _) => self.published.to_owned(),
            (volume, "") => format!("{} {volume}", self.published),
            (volume, pages) => format!("{} {volume}, {pages}", self.published),
        };
        let after = [place.as_str(), self.year];
        let after: Vec<_> = after.into_iter().filter(|part| !part.is_empty()).collect();
        [author, self.title.to_owned(), after.join(", ")]
    }
}
