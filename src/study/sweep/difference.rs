//! What differs between two sweeps, for one who meant them to be the same.

use crate::scenario::document::Document;
use crate::scenario::dotted::join;
use crate::text::printable::brief;
use std::fmt;
use toml::{Table, Value};

/// The most characters of a value that are shown.
const MOST_SHOWN: usize = 40;

/// The key whose value says nothing of what is computed.
const VERSION: &str = "gyrolab";

/// Why what stands above some rows is not the sweep that it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Differs {
    /// It is another sweep: the first key that differs, with both values.
    Sweep(String),
    /// It is no sweep, or the same one in another form.
    Form(String),
}

impl fmt::Display for Differs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Sweep(what) | Self::Form(what)) = self;
        f.write_str(what)
    }
}

/// What in `there`, the `# ` lines above some rows, differs first from `wanted`. `words` say in the text which of the two
/// a value is from: with "there" and "here" it is "vary.0.count is 20 there, 21 here".
pub fn of_headers(there: &str, wanted: &str, words: [&str; 2]) -> Differs {
    let table = |lines: &str| {
        let stripped = lines.lines().map_while(|line| line.strip_prefix('#'));
        let text: String = stripped
            .flat_map(|line| [line.strip_prefix(' ').unwrap_or(line), "\n"])
            .collect();
        Document::parse("", &text).map(|document| document.table().clone())
    };
    let form = |what: &str| Differs::Form(what.to_owned());
    match (table(there), table(wanted)) {
        (Ok(there), Ok(_)) if there.is_empty() => form("it has no sweep file above its rows"),
        (Ok(mut there), Ok(mut wanted)) => {
            let versions = (there.remove(VERSION), wanted.remove(VERSION));
            if let Some(what) = in_tables(&there, &wanted, "", words) {
                return Differs::Sweep(what);
            }
            let what = in_values((versions.0.as_ref(), versions.1.as_ref()), VERSION, words);
            what.map_or_else(|| form("its columns differ"), Differs::Form)
        }
        _ => form("what stands above its rows is no sweep file"),
    }
}

fn in_tables(there: &Table, wanted: &Table, path: &str, words: [&str; 2]) -> Option<String> {
    let more = there.keys().filter(|name| !wanted.contains_key(*name));
    let mut names = wanted.keys().chain(more);
    names.find_map(|name| {
        let values = (there.get(name), wanted.get(name));
        in_values(values, &join(path, name), words)
    })
}

fn in_values(
    values: (Option<&Value>, Option<&Value>),
    key: &str,
    words: [&str; 2],
) -> Option<String> {
    match values {
        (there, wanted) if there == wanted => None,
        (Some(Value::Table(there)), Some(Value::Table(wanted))) => {
            in_tables(there, wanted, key, words)
        }
        (Some(Value::Array(there)), Some(Value::Array(wanted))) => {
            let mut places = 0..there.len().max(wanted.len());
            places.find_map(|place| {
                let values = (there.get(place), wanted.get(place));
                in_values(values, &join(key, &place.to_string()), words)
            })
        }
        (there, wanted) => {
            let [there, wanted] = [there, wanted].map(in_words);
            let [of_there, of_wanted] = words;
            Some(format!("{key} is {there} {of_there}, {wanted} {of_wanted}"))
        }
    }
}

fn in_words(value: Option<&Value>) -> String {
    match value {
        Some(value) => brief(&value.to_string().replace('\n', " "), MOST_SHOWN),
        None => "not given".to_owned(),
    }
}
