//! Solid parts of a body: makes a [`PlacedSolid`] of each `[[body.part]]`, with the dimensions of its shape. A new
//! shape is a row of `FORMS`.

use super::kind::vector;
use super::problem::{Problem, Problems};
use crate::physics::part::{PartError, PlacedSolid, Shape};
use crate::text::nice_numbers::at_or_below;
use crate::text::number::{shortest, significant};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartFile {
    pub shape: String,
    pub name: String,
    pub mass_kg: f64,
    pub at_m: [f64; 3],
    pub axis: Option<[f64; 3]>,
    pub radius_m: Option<f64>,
    pub inner_radius_m: Option<f64>,
    pub outer_radius_m: Option<f64>,
    pub length_m: Option<f64>,
    pub size_m: Option<[f64; 3]>,
    pub moments_kg_m2: Option<[f64; 3]>,
    pub about: Option<About>,
}

/// The point about which the moments of a part are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum About {
    /// The part's center of mass.
    Center,
    /// The pivot. The axes through it are parallel to the part's own.
    Pivot,
}

/// A shape with its name in files, and its dimensions.
pub(super) struct SolidShape {
    name: &'static str,
    /// Required dimensions.
    needs: &'static [&'static str],
    may_have: &'static [&'static str],
    /// Makes the shape of a part that has the dimensions.
    make: fn(&PartFile) -> Shape,
}

const fn form(
    name: &'static str,
    needs: &'static [&'static str],
    may_have: &'static [&'static str],
    make: fn(&PartFile) -> Shape,
) -> SolidShape {
    SolidShape {
        name,
        needs,
        may_have,
        make,
    }
}

const TUBE: [&str; 3] = ["inner_radius_m", "outer_radius_m", "length_m"];

#[rustfmt::skip]
pub(super) static FORMS: [SolidShape; 9] = [
    form("ring", &["radius_m"], &[], |file| Shape::Ring { radius: file.radius_m.unwrap_or_default() }),
    form("cylinder", &["radius_m"], &["length_m"], |file| Shape::Cylinder { radius: file.radius_m.unwrap_or_default(), length: file.length_m.unwrap_or_default() }),
    form("tube", &TUBE, &[], |file| Shape::Tube { inner: file.inner_radius_m.unwrap_or_default(), outer: file.outer_radius_m.unwrap_or_default(), length: file.length_m.unwrap_or_default() }),
    form("rod", &["length_m"], &[], |file| Shape::Rod { length: file.length_m.unwrap_or_default() }),
    form("ball", &["radius_m"], &[], |file| Shape::Ball { radius: file.radius_m.unwrap_or_default() }),
    form("shell", &["radius_m"], &[], |file| Shape::Shell { radius: file.radius_m.unwrap_or_default() }),
    form("cone", &["radius_m", "length_m"], &[], |file| Shape::Cone { radius: file.radius_m.unwrap_or_default(), length: file.length_m.unwrap_or_default() }),
    form("block", &["size_m"], &[], |file| Shape::Block { size: file.size_m.unwrap_or_default().into() }),
    form("moments", &["moments_kg_m2"], &["about"], |file| Shape::Moments(Vector3::from(file.moments_kg_m2.unwrap_or_default()) / file.mass_kg)),
];

/// Dimensions of all shapes, in the order of the table of keys, and the reference point of moments.
const DIMENSIONS: [&str; 7] = [
    "radius_m",
    "inner_radius_m",
    "outer_radius_m",
    "length_m",
    "size_m",
    "moments_kg_m2",
    "about",
];

pub(super) const fn names() -> [&'static str; FORMS.len()] {
    let mut names = [""; FORMS.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = FORMS[at].name;
        at += 1;
    }
    names
}

pub fn has_dimension(shape: &str, name: &str) -> bool {
    let form = FORMS.iter().find(|form| form.name == shape);
    form.is_some_and(|form| form.needs.contains(&name) || form.may_have.contains(&name))
}

/// Reads the part that `file` describes. In error messages, the keys are relative to the part's table.
pub(super) fn read_part(file: &PartFile) -> Result<PlacedSolid, Problems> {
    // keys::check has rejected unknown shapes.
    let known = FORMS.iter().find(|form| form.name == file.shape);
    let form = known.unwrap_or(&FORMS[0]);
    Problems::from(wrong_dimensions(form, file)).or(())?;
    let axis = Vector3::from(file.axis.unwrap_or([0.0, 0.0, 1.0]));
    let center = Vector3::from(file.at_m);
    let part = match file.about {
        Some(About::Pivot) => {
            let moments = file.moments_kg_m2.unwrap_or_default().into();
            PlacedSolid::about_pivot(&moments, file.mass_kg, center, &axis)
        }
        Some(About::Center) | None => {
            PlacedSolid::new((form.make)(file), file.mass_kg, center, &axis)
        }
    };
    part.map_err(|error| refusal(error, file).into())
}

/// Returns the error message for the part of `file`.
fn refusal(error: PartError, file: &PartFile) -> Problem {
    let moments = vector(&Vector3::from(file.moments_kg_m2.unwrap_or_default()));
    let rule = match error {
        PartError::OutOfRange => return Problem::at("", error.to_string()),
        PartError::Dimension { name, rule } => return refused_dimension(name, rule, file),
        PartError::Unreal(_) => format!("cannot be: {error}"),
        PartError::TooFar { nearer, .. } => {
            format!("cannot be: {error}{}", moves_alike(file, nearer))
        }
    };
    Problem::with_value("moments_kg_m2", &moments, rule)
}

/// Returns the error message for a dimension, with its key and value in `file`. `name` is its name in [`PlacedSolid`] or
/// [`Shape`].
fn refused_dimension(name: &str, rule: &str, file: &PartFile) -> Problem {
    let key = match name {
        "inner" => "inner_radius_m",
        "outer" => "outer_radius_m",
        "mass" => "mass_kg",
        "moments" => "moments_kg_m2",
        "axis" => "axis",
        _ => &format!("{name}_m"),
    };
    let written = Table::try_from(file).unwrap_or_default();
    let rule = match (key, file.outer_radius_m) {
        ("inner_radius_m", Some(outer)) => {
            format!(
                "must not be greater than outer_radius_m, {}",
                shortest(outer)
            )
        }
        _ => rule.to_owned(),
    };
    match written.get(key) {
        Some(value) => Problem::with_value(key, value, rule),
        None => Problem::at(key, rule),
    }
}

/// Suggests a mass and a center of mass that the part of `file` may have instead. The mass is larger, and nearer to the
/// pivot by at least the factor `nearer`.
fn moves_alike(file: &PartFile, nearer: f64) -> String {
    let factor = at_or_below(nearer);
    let mass = file.mass_kg / factor;
    if !(factor > 0.0 && mass.is_finite()) {
        return String::new();
    }
    let [x, y, z] = file.at_m.map(|at| significant(factor * at, 12));
    let mass = significant(mass, 12);
    format!(
        ". The motion depends on M d, not on M: mass_kg = {mass} with at_m = [{x}, {y}, {z}] moves in the same way"
    )
}

/// Returns problems for the dimensions that are missing, and for those that a solid of this shape does not have.
fn wrong_dimensions(form: &SolidShape, file: &PartFile) -> Vec<Problem> {
    let written = Table::try_from(file).unwrap_or_default();
    let all = [form.needs, form.may_have].concat().join(", ");
    let shape = form.name;
    let mut problems = Vec::new();
    for name in DIMENSIONS {
        match written.get(name) {
            None if form.needs.contains(&name) => {
                let rule = format!("is missing: a part of shape {shape} has {all}");
                problems.push(Problem::at(name, rule));
            }
            Some(value) if !has_dimension(shape, name) => {
                let rule = format!("does not belong to shape {shape}, which has {all}: remove it");
                problems.push(Problem::with_value(name, value, rule));
            }
            _ => {}
        }
    }
    problems
}

/// Prepares the file's `table` for a new `value` at `key`. If a part gets another shape, or a component of a direction
/// that the file does not give, the required keys are added. They stay as near to the old values as possible.
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
            let new_dimensions = old.map_or(Table::new(), |old| dimensions(&old, shape));
            if !new_dimensions.is_empty() {
                part.retain(|dimension, _| !DIMENSIONS.contains(&dimension));
            }
            part.extend(new_dimensions);
        }
        _ => {}
    }
}

/// Returns the dimensions of a part of shape `shape` that resembles `old`. The result is empty if the shape is unknown
/// or the part invalid.
fn dimensions(old: &PartFile, shape: &str) -> Table {
    let Ok(part) = read_part(old) else {
        return Table::new();
    };
    let size = size_of(&part.shape);
    let (radius, length) = (0.5 * size.x.max(size.y), size.z);
    let hole = match part.shape {
        Shape::Tube { inner, .. } => inner,
        _ => 0.5 * radius,
    };
    // A rod or a cone must have a length.
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
    // The moments are then about the center, which is the default.
    DIMENSIONS
        .into_iter()
        .zip(values)
        .filter(|(name, _)| has_dimension(shape, name))
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

/// Returns the size of a solid along its x, its y and its axis, m.
fn size_of(shape: &Shape) -> Vector3<f64> {
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

fn round(radius: f64, length: f64) -> Vector3<f64> {
    Vector3::new(2.0 * radius, 2.0 * radius, length)
}

/// Returns the sides of the block with these moments per mass, m.
fn block_of(moments: &Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = (*moments).into();
    Vector3::new(b + c - a, a + c - b, a + b - c).map(|twice| (6.0 * twice.max(0.0)).sqrt())
}
