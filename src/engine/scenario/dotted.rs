//! Dotted keys: paths to values in a table, with numbers from 0 for positions in arrays (`push.0.force_N`).

use super::problem::Problem;
pub use super::problem::join;
use toml::{Table, Value};

/// Maximum number of names and numbers in a key. body.point.N.at_m.N has five. Unlimited nesting would exhaust the
/// stack.
const DEEPEST_KEY: usize = 5;

/// Writes `value` at the dotted `key`. Numbers are positions in arrays, and a position one past the end adds an
/// element.
pub fn set_key(table: &mut Table, key: &str, value: Value) -> Result<(), Problem> {
    let names: Vec<&str> = key.split('.').collect();
    if names.len() > DEEPEST_KEY {
        let rule = format!("is too deep: a key has at most {DEEPEST_KEY} names and numbers");
        return Err(Problem::at(key, rule));
    }
    if names.contains(&"") {
        let rule = "is not a dotted key such as motion.time_step_s";
        return Err(Problem::at(key, rule));
    }
    let mut inside = table.entry(names[0]).or_insert(empty(&names[1..]));
    let mut path = names[0].to_owned();
    for (index, name) in names.iter().enumerate().skip(1) {
        let above = path;
        path = join(&above, name);
        inside = match inside {
            Value::Table(outer) => outer.entry(*name).or_insert(empty(&names[index + 1..])),
            Value::Array(array) => place(array, name, &path, empty(&names[index + 1..]))?,
            other => {
                let rule = format!("has no {name}");
                return Err(Problem::with_value(above, other, rule));
            }
        };
    }
    *inside = value;
    Ok(())
}

/// Returns the empty value that can hold the names `inside`.
fn empty(inside: &[&str]) -> Value {
    match inside.first().map(|name| name.parse::<usize>()) {
        Some(Ok(_)) => Value::Array(Vec::new()),
        Some(Err(_)) => Value::Table(Table::new()),
        None => Value::Boolean(false),
    }
}

/// Returns the element of `array` at position `name`. If that is one past the end, `empty` is added first.
fn place<'a>(
    array: &'a mut Vec<Value>,
    name: &str,
    path: &str,
    empty: Value,
) -> Result<&'a mut Value, Problem> {
    let Ok(index) = name.parse::<usize>() else {
        let rule = "must be a position in an array: a number from 0";
        return Err(Problem::at(path, rule));
    };
    let length = array.len();
    if index == length {
        array.push(empty);
    }
    array.get_mut(index).ok_or_else(|| {
        let rule = format!("leads past the end: the array has {length} elements, numbered from 0");
        Problem::at(path, rule)
    })
}

pub fn find<'a>(written: &'a Table, key: &str) -> Option<&'a Value> {
    let mut names = key.split('.');
    let first = names.next().and_then(|name| written.get(name));
    names.fold(first, |value, name| match value? {
        Value::Table(table) => table.get(name),
        Value::Array(array) => array.get(name.parse::<usize>().ok()?),
        _ => None,
    })
}

/// Returns true if the dotted `key` is `table` or lies in it.
pub fn is_in(key: &str, table: &str) -> bool {
    key.strip_prefix(table)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Returns true if the dotted keys `one` and `other` write into the same value.
pub fn overlap(one: &str, other: &str) -> bool {
    is_in(one, other) || is_in(other, one)
}

/// Returns the number, from 0, of the push that the dotted `key` belongs to.
pub fn number_of_push(key: &str) -> Option<usize> {
    key.strip_prefix("push.")?.split('.').next()?.parse().ok()
}
