//! A part that is to have another shape, or a direction that its file does not give: its table gets the dimensions that the
//! new value asks for, as near to the old ones as there are.

use super::file::PartFile;
use super::kind::vector;
use super::solids::{self, DIMENSIONS, has_dimension};
use crate::physics::part::Shape;
use nalgebra::Vector3;
use toml::{Table, Value};

/// Prepares the file's `table` for a new `value` at `key`, which may belong to a part.
pub(super) fn prepare(table: &mut Table, key: &str, value: &Value) {
    let mut names = key.split('.');
    let (Some("body"), Some("part")) = (names.next(), names.next()) else {
        return;
    };
    let index = names.next().and_then(|index| index.parse::<usize>().ok());
    let parts = table.get_mut("body").and_then(|body| body.get_mut("part"));
    let part = parts
        .zip(index)
        .and_then(|(parts, index)| parts.get_mut(index));
    let (Some(name), Some(Value::Table(part))) = (names.next(), part) else {
        return;
    };
    match (name, value.as_str()) {
        ("axis", _) if names.next().is_some() && !part.contains_key("axis") => {
            part.insert("axis".to_owned(), vector(&Vector3::z()));
        }
        ("shape", Some(shape)) => {
            let old: Result<PartFile, _> = part.clone().try_into();
            let told = old.map_or(Vec::new(), |old| dimensions(&old, shape));
            if !told.is_empty() {
                part.retain(|key, _| !DIMENSIONS.contains(&key));
            }
            let told = told.into_iter();
            part.extend(told.map(|(name, value)| (name.to_owned(), value)));
        }
        _ => {}
    }
}

/// The dimensions that a part of the shape `shape` has in the place of `old`; none where there is no such shape, or no such
/// part.
fn dimensions(old: &PartFile, shape: &str) -> Vec<(&'static str, Value)> {
    let Ok(part) = solids::part(old) else {
        return Vec::new();
    };
    let size = size(&part.shape);
    let (radius, length) = (0.5 * size.x.max(size.y), size.z);
    let hole = match part.shape {
        Shape::Tube { inner, .. } => inner,
        _ => 0.5 * radius,
    };
    // A rod or a cone without length is nothing.
    let length = match (length > 0.0, shape) {
        (false, "rod" | "cone") => 2.0 * radius,
        _ => length,
    };
    let values = [
        radius.into(),
        hole.into(),
        radius.into(),
        length.into(),
        vector(&size),
        vector(&part.moments()),
    ];
    let all = DIMENSIONS.into_iter().zip(values);
    all.filter(|(name, _)| has_dimension(shape, name)).collect()
}

/// How long a solid is along its x, its y and its axis, m.
fn size(shape: &Shape) -> Vector3<f64> {
    let round = |radius: f64, length: f64| Vector3::new(2.0 * radius, 2.0 * radius, length);
    match *shape {
        Shape::Ring { radius } => round(radius, 0.0),
        Shape::Cylinder { radius, length } | Shape::Cone { radius, length } => {
            round(radius, length)
        }
        Shape::Tube { outer, length, .. } => round(outer, length),
        Shape::Rod { length } => round(0.5 * length, length),
        Shape::Ball { radius } | Shape::Shell { radius } => round(radius, 2.0 * radius),
        Shape::Block { size } => size,
        Shape::Moments(moments) => block_of(&moments),
    }
}

/// The sides of the block that has these moments divided by the mass, m.
fn block_of(moments: &Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = (*moments).into();
    let side = |twice: f64| (6.0 * twice.max(0.0)).sqrt();
    Vector3::new(side(b + c - a), side(a + c - b), side(a + b - c))
}
