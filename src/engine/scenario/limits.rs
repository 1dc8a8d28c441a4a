//! Limits on the size of a scenario or run file. A larger file gets one error message, and is not checked further.

use super::dotted::find;
use super::problem::Problem;
use toml::{Table, Value};

/// Maximum length of a scenario or run file, bytes.
pub const LONGEST_SCENARIO_FILE: u64 = 4_000_000;

pub const SCENARIO_TOO_LONG: &str =
    "is larger than 4 MB (4000000 bytes), the limit for a scenario or run file: shorten it";

/// Maximum length of a CSV's header, bytes. Its run file is longer than the scenario, because it writes every number in
/// full and begins each line with "# ".
pub(super) const LONGEST_HEADER: u64 = 4 * LONGEST_SCENARIO_FILE;

pub const MOST_POINTS: i64 = 100_000;

pub const MOST_PUSHES: usize = 10_000;
pub const MOST_EDITS: usize = 10_000;

/// Maximum product of the number of edits and the number of points, parts and pushes.
pub const MOST_PRODUCT: usize = 1_000_000;

/// Maximum number of tables in a file. A few letters create a table, which takes 2 kB.
const MOST_TABLES: usize = 120_000;

/// Maximum number of lines and array elements in a file.
const MOST_FILE_VALUES: usize = 800_000;

/// Checks that `text` has at most `times` the tables and values of a file. More would take far more memory than a usual
/// scenario of its length. The header of a CSV may have twice as many, because it writes on several lines what a
/// scenario may have on one.
pub fn check_toml_size(text: &str, times: usize) -> Result<(), Problem> {
    let (most_tables, most_values) = (times * MOST_TABLES, times * MOST_FILE_VALUES);
    let (mut tables, mut values, mut heading) = (0, 0, "");
    for line in text.lines().map(str::trim_start) {
        if line.starts_with('[') {
            // The second [[body.point]] creates no further tables around it.
            tables += 1 + if line == heading { 0 } else { dots(line) };
            heading = line;
        } else {
            let keys = line
                .split(['{', ','])
                .filter_map(|part| part.split_once('='));
            tables += line.matches('{').count() + keys.map(|(key, _)| dots(key)).sum::<usize>();
        }
        values += 1 + line.matches(',').count();
    }
    if tables <= most_tables && values <= most_values {
        return Ok(());
    }
    let rule = format!(
        "has more than {most_tables} tables (a dot in a key counts as one) or {most_values} values: remove some"
    );
    Err(Problem::at("", rule))
}

/// Counts the dots in `part` of a line. A dot in quotes is part of a name.
fn dots(part: &str) -> usize {
    let unquoted = part.split(['"', '\'']).step_by(2);
    unquoted.map(|text| text.matches('.').count()).sum()
}

/// Returns the limit that the file in `table` exceeds, if any.
pub(super) fn exceeded(table: &Table) -> Option<Problem> {
    let rim = find(table, "body.rim.points").and_then(Value::as_integer);
    let bodies = usize::try_from(rim.unwrap_or(0))
        .unwrap_or(0)
        .saturating_add(length(table, "body.point"))
        .saturating_add(length(table, "body.part"));
    too_many(length(table, "edit"), bodies, length(table, "push"))
}

fn length(table: &Table, key: &str) -> usize {
    let list = find(table, key).and_then(Value::as_array);
    list.map_or(0, Vec::len)
}

/// Returns the problem if there are too many `edits` of a body of `bodies` points and parts, with this number of
/// `pushes`.
pub(super) fn too_many(edits: usize, bodies: usize, pushes: usize) -> Option<Problem> {
    for (key, name, count, most) in [
        ("push", "pushes", pushes, MOST_PUSHES),
        ("edit", "edits", edits, MOST_EDITS),
    ] {
        if count > most {
            let rule =
                format!("{count} {name} are too many: at most {most} are allowed; remove some");
            return Some(Problem::at(key, rule));
        }
    }
    let others = bodies.saturating_add(pushes);
    let rule = format!(
        "{edits} edits of {others} points, parts and pushes are too many: {edits} times {others} may be at most {MOST_PRODUCT}; remove some"
    );
    (edits.saturating_mul(others) > MOST_PRODUCT).then(|| Problem::at("edit", rule))
}
