//! What differs between two sweeps, for one who meant them to be the same.

use crate::scenario::document::Document;
use crate::scenario::dotted::join;
use crate::text::printable::brief;
use toml::{Table, Value};

/// So many differences are told.
const MOST: usize = 3;

/// What in `there`, the `# ` lines above other rows, differs from `wanted`: "measure is ["z_m"] there, and ["t_s"] here".
pub fn of_headers(there: &str, wanted: &str) -> String {
    let table = |lines: &str| {
        let stripped = lines.lines().map_while(|line| line.strip_prefix('#'));
        let text: String = stripped
            .flat_map(|line| [line.strip_prefix(' ').unwrap_or(line), "\n"])
            .collect();
        Document::parse("", &text).map(|document| document.table().clone())
    };
    match (table(there), table(wanted)) {
        (Ok(there), Ok(_)) if there.is_empty() => "it has no sweep file above its rows".to_owned(),
        (Ok(there), Ok(wanted)) => {
            let mut found = Vec::new();
            compare(&there, &wanted, "", &mut found);
            match found.len() {
                0 => "its columns differ".to_owned(),
                count if count > MOST => {
                    format!("{}, and {} more", found[..MOST].join("; "), count - MOST)
                }
                _ => found.join("; "),
            }
        }
        _ => "what stands above its rows is no sweep file".to_owned(),
    }
}

fn compare(there: &Table, here: &Table, path: &str, found: &mut Vec<String>) {
    let names = here
        .keys()
        .chain(there.keys().filter(|name| !here.contains_key(*name)));
    for name in names {
        let key = join(path, name);
        match (there.get(name), here.get(name)) {
            (Some(Value::Table(there)), Some(Value::Table(here))) => {
                compare(there, here, &key, found);
            }
            (one, other) if one == other => {}
            (one, other) => found.push(format!(
                "{key} is {} there, {} here",
                words(one),
                words(other)
            )),
        }
    }
}

fn words(value: Option<&Value>) -> String {
    match value {
        Some(value) => brief(&value.to_string().replace('\n', " "), 60),
        None => "not given".to_owned(),
    }
}
