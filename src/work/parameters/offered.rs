//! Which values of a scenario are listed, and the values that a file implies by leaving keys out.

use crate::scenario::dotted::{find, join};
use crate::scenario::keys::Key;
use crate::scenario::solids::has_dimension;
use crate::scenario::{Scenario, start, vector};
use nalgebra::Vector3;
use toml::{Table, Value};

/// The value that the file implies by leaving out the key at `place`, where it follows from other values: the spin or
/// momentum of a start that is given in another way, the axis and the length of a part.
pub(super) fn present(key: &Key, place: &str, table: &Table, scenario: &Scenario) -> Option<Value> {
    let start = &scenario.start;
    let spin = || scenario.spin_rad_per_s(start);
    match key.path {
        "start.momentum_Js" => Some(vector(&start.momentum)),
        "start.spin_rpm" => Some(start::rpm(spin()).into()),
        "start.spin_rad_per_s" => Some(spin().into()),
        "body.part.*.axis" => Some(vector(&Vector3::z())),
        "body.part.*.length_m" => is_dimension(place, table).then_some(Value::Float(0.0)),
        _ => None,
    }
}

/// Whether the dimension at `place` is one of the part's shape.
fn is_dimension(place: &str, table: &Table) -> bool {
    let Some((part, name)) = place.rsplit_once('.') else {
        return false;
    };
    let shape = find(table, &join(part, "shape")).and_then(Value::as_str);
    shape.is_some_and(|shape| has_dimension(shape, name))
}

/// Whether the key at `place` fits the other keys of its table: a push has its times either in steps or in seconds, and
/// an angular velocity is listed only where the file gives one.
pub(super) fn is_offered(place: &str, table: &Table) -> bool {
    let Some((inside, name)) = place.rsplit_once('.') else {
        return true;
    };
    if inside == "start" && name.starts_with("omega") {
        return find(table, "start.omega_rad_per_s").is_some();
    }
    if !inside.starts_with("push.") {
        return true;
    }
    let is_in_seconds = ["from_s", "for_s"]
        .iter()
        .any(|name| find(table, &join(inside, name)).is_some());
    match name {
        "first_step" | "steps" | "accumulates" => !is_in_seconds,
        "from_s" | "for_s" => is_in_seconds,
        _ => true,
    }
}
