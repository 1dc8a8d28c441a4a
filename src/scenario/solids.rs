//! The solid parts of a body: from `[[body.part]]` to [`Part`], with the dimensions that each shape has.

use super::file::PartFile;
use super::kind::vector;
use super::problem::Problem;
use crate::physics::part::{Part, PartError, Shape};
use crate::text::number::shortest;
use nalgebra::Vector3;
use toml::{Table, Value};

/// A shape as a file names it, and its dimensions.
pub(super) struct Form {
    name: &'static str,
    /// The dimensions without which there is no such solid.
    needs: &'static [&'static str],
    /// Those that it may have too.
    may_have: &'static [&'static str],
}

const fn form(
    name: &'static str,
    needs: &'static [&'static str],
    may_have: &'static [&'static str],
) -> Form {
    Form {
        name,
        needs,
        may_have,
    }
}

/// Every shape there is.
pub(super) static FORMS: [Form; 9] = [
    form("ring", &["radius_m"], &[]),
    form("cylinder", &["radius_m"], &["length_m"]),
    form(
        "tube",
        &["inner_radius_m", "outer_radius_m", "length_m"],
        &[],
    ),
    form("rod", &["length_m"], &[]),
    form("ball", &["radius_m"], &[]),
    form("shell", &["radius_m"], &[]),
    form("cone", &["radius_m", "length_m"], &[]),
    form("block", &["size_m"], &[]),
    form("moments", &["moments_kg_m2"], &[]),
];

/// The dimensions of any shape, in the order of the table of keys.
pub(super) const DIMENSIONS: [&str; 6] = [
    "radius_m",
    "inner_radius_m",
    "outer_radius_m",
    "length_m",
    "size_m",
    "moments_kg_m2",
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

/// Whether the shape called `shape` has the dimension `name`.
pub(crate) fn has_dimension(shape: &str, name: &str) -> bool {
    let form = FORMS.iter().find(|form| form.name == shape);
    form.is_some_and(|form| form.needs.contains(&name) || form.may_have.contains(&name))
}

/// The part that `file` describes.
///
/// # Errors
/// A dimension that is missing, or that its shape has not, or that no solid has; a direction of length 0. Keys are those in
/// the part's table.
pub(super) fn part(file: &PartFile) -> Result<Part, Vec<Problem>> {
    // An unknown shape has been refused by the keys.
    let form = FORMS.iter().find(|form| form.name == file.shape);
    let form = form.unwrap_or(&FORMS[0]);
    let problems = wrong_dimensions(form, file);
    if !problems.is_empty() {
        return Err(problems);
    }
    let shape = shape(file).map_err(|problem| vec![problem])?;
    let axis = Vector3::from(file.axis.unwrap_or([0.0, 0.0, 1.0]));
    if axis == Vector3::zeros() {
        let rule = "must not be of length 0: it is a direction";
        return Err(vec![Problem::with_value("axis", &vector(&axis), rule)]);
    }
    let centre = Vector3::from(file.at_m);
    Part::new(shape, file.mass_kg, centre, &axis).map_err(|error| {
        let problem = match error {
            PartError::OutOfRange => Problem::at("", error.to_string()),
            PartError::Unreal(_) => {
                let moments = vector(&Vector3::from(file.moments_kg_m2.unwrap_or_default()));
                Problem::with_value("moments_kg_m2", &moments, format!("cannot be: {error}"))
            }
        };
        vec![problem]
    })
}

/// The dimensions that are missing, and those that a solid of this form has not.
fn wrong_dimensions(form: &Form, file: &PartFile) -> Vec<Problem> {
    let written = Table::try_from(file).unwrap_or_default();
    let all = [form.needs, form.may_have].concat().join(", ");
    let wrong = |name: &'static str| match (written.get(name), has_dimension(form.name, name)) {
        (None, _) if form.needs.contains(&name) => {
            let rule = format!("is missing: a part of shape {} has {all}", form.name);
            Some(Problem::at(name, rule))
        }
        (Some(value), false) => {
            let shape = form.name;
            let rule = format!("does not go with shape {shape}, which has {all}: leave it out");
            Some(Problem::with_value(name, value, rule))
        }
        _ => None,
    };
    DIMENSIONS.into_iter().filter_map(wrong).collect()
}

/// The shape of `file`, which has the dimensions of its form.
fn shape(file: &PartFile) -> Result<Shape, Problem> {
    let given = Option::<f64>::unwrap_or_default;
    let (radius, length) = (given(file.radius_m), given(file.length_m));
    let long = || {
        let rule = "must be greater than zero";
        let refused = || Problem::with_value("length_m", &Value::Float(length), rule);
        (length > 0.0).then_some(length).ok_or_else(refused)
    };
    Ok(match file.shape.as_str() {
        "cylinder" => Shape::Cylinder { radius, length },
        "tube" => {
            let (inner, outer) = (given(file.inner_radius_m), given(file.outer_radius_m));
            if inner > outer {
                let outer = shortest(outer);
                let rule = format!("must not be greater than outer_radius_m, {outer}");
                let inner = Value::Float(inner);
                return Err(Problem::with_value("inner_radius_m", &inner, rule));
            }
            Shape::Tube {
                inner,
                outer,
                length,
            }
        }
        "rod" => Shape::Rod { length: long()? },
        "ball" => Shape::Ball { radius },
        "shell" => Shape::Shell { radius },
        "cone" => Shape::Cone {
            radius,
            length: long()?,
        },
        "block" => Shape::Block {
            size: not_negative("size_m", file.size_m)?,
        },
        "moments" => {
            Shape::Moments(not_negative("moments_kg_m2", file.moments_kg_m2)? / file.mass_kg)
        }
        _ => Shape::Ring { radius },
    })
}

fn not_negative(name: &str, numbers: Option<[f64; 3]>) -> Result<Vector3<f64>, Problem> {
    let numbers = Vector3::from(numbers.unwrap_or_default());
    if numbers.min() >= 0.0 {
        return Ok(numbers);
    }
    let rule = "must hold no negative number";
    Err(Problem::with_value(name, &vector(&numbers), rule))
}
