//! The commands `export` and `figure`: the file, which rows and columns of the run it has, or what is drawn.

use super::Command;
use super::reading::{Read, field, fields, flag, line, number, path, whole, with_path, wrong};
use crate::export::layout::LayoutFile;
use crate::figure::Format;
use crate::figure::kind::Kind;
use crate::scenario::Problem;
use crate::scenario::keys::Range;
use crate::scenario::screen::TRACES;
use std::num::NonZeroU64;
use std::path::Path;
use toml::Value;

const KEYS: [&str; 9] = [
    "path", "every", "from_s", "to_s", "columns", "points", "excel", "to_step", "force",
];

pub(super) fn export(value: &Value) -> Read {
    let given = with_path(value);
    let table = fields(&given, &KEYS)?;
    let time = |name| field(table, name, |time| number(Range::NotNegative, time));
    let layout = LayoutFile {
        every: whole(table, "every", 1)?.and_then(NonZeroU64::new),
        from_s: time("from_s")?,
        to_s: time("to_s")?,
        columns: field(table, "columns", names)?,
        points: flag(table, "points")?,
        excel: flag(table, "excel")?,
    };
    let layout = layout.check().map_err(|error| {
        let value = table.get(error.key).unwrap_or(value);
        vec![Problem::with_value(error.key, value, error.rule)]
    })?;
    Ok(Command::Export {
        path: path(table, value)?,
        layout,
        to_step: whole(table, "to_step", 1)?,
        force: flag(table, "force")?,
    })
}

pub(super) fn figure(value: &Value) -> Read {
    let given = with_path(value);
    let table = fields(&given, &["path", "kind", "exact", "to_step", "force"])?;
    let kind = field(table, "kind", |given| match Kind::named(line(given)?) {
        Ok(_) => line(given).map(str::to_owned),
        Err(refusal) => wrong(given, refusal),
    })?;
    let path = path(table, value)?;
    if let Err(refusal) = Format::of(Path::new(&path)) {
        return wrong(value, refusal.to_string());
    }
    Ok(Command::Figure {
        path,
        kind: kind.unwrap_or_else(|| TRACES.to_owned()),
        exact: flag(table, "exact")?,
        to_step: whole(table, "to_step", 1)?,
        force: flag(table, "force")?,
    })
}

fn names(value: &Value) -> Result<Vec<String>, Vec<Problem>> {
    let Some(list) = value.as_array() else {
        let rule = "must be a list of names in brackets";
        return Err(vec![Problem::with_value("", value, rule)]);
    };
    list.iter()
        .map(|name| line(name).map(str::to_owned))
        .collect()
}
