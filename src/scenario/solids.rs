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
    read: fn(&PartFile) -> Result<Shape, Problem>,
}

const fn form(
    name: &'static str,
    needs: &'static [&'static str],
    read: fn(&PartFile) -> Result<Shape, Problem>,
) -> Form {
    Form {
        name,
        needs,
        may_have: &[],
        read,
    }
}

/// Every shape there is.
pub(super) static FORMS: [Form; 9] = [
    form("ring", &["radius_m"], |file| {
        let radius = given(file.radius_m);
        Ok(Shape::Ring { radius })
    }),
    Form {
        may_have: &["length_m"],
        ..form("cylinder", &["radius_m"], |file| {
            Ok(Shape::Cylinder {
                radius: given(file.radius_m),
                length: given(file.length_m),
            })
        })
    },
    form(
        "tube",
        &["inner_radius_m", "outer_radius_m", "length_m"],
        tube,
    ),
    form("rod", &["length_m"], |file| {
        let length = long(file)?;
        Ok(Shape::Rod { length })
    }),
    form("ball", &["radius_m"], |file| {
        let radius = given(file.radius_m);
        Ok(Shape::Ball { radius })
    }),
    form("shell", &["radius_m"], |file| {
        let radius = given(file.radius_m);
        Ok(Shape::Shell { radius })
    }),
    form("cone", &["radius_m", "length_m"], |file| {
        let (radius, length) = (given(file.radius_m), long(file)?);
        Ok(Shape::Cone { radius, length })
    }),
    form("block", &["size_m"], |file| {
        let size = not_negative("size_m", file.size_m)?;
        Ok(Shape::Block { size })
    }),
    form("moments", &["moments_kg_m2"], |file| {
        let moments = not_negative("moments_kg_m2", file.moments_kg_m2)?;
        Ok(Shape::Moments(moments / file.mass_kg))
    }),
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
    let shape = (form.read)(file).map_err(|problem| vec![problem])?;
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
    let all = || [form.needs, form.may_have].concat().join(", ");
    let wrong = |name: &'static str| {
        let (needs, may) = (form.needs.contains(&name), form.may_have.contains(&name));
        match written.get(name) {
            None if needs => Some(Problem::at(
                name,
                format!("is missing: a part of shape {} has {}", form.name, all()),
            )),
            Some(value) if !needs && !may => Some(Problem::with_value(
                name,
                value,
                format!(
                    "does not go with shape {}, which has {}: leave it out",
                    form.name,
                    all()
                ),
            )),
            _ => None,
        }
    };
    DIMENSIONS.into_iter().filter_map(wrong).collect()
}

/// A dimension that is there, or may be left out and is then 0.
fn given(dimension: Option<f64>) -> f64 {
    dimension.unwrap_or_default()
}

/// The length of a solid that is nothing without one.
fn long(file: &PartFile) -> Result<f64, Problem> {
    match given(file.length_m) {
        length if length > 0.0 => Ok(length),
        length => Err(Problem::with_value(
            "length_m",
            &Value::Float(length),
            "must be greater than zero",
        )),
    }
}

fn tube(file: &PartFile) -> Result<Shape, Problem> {
    let (inner, outer) = (given(file.inner_radius_m), given(file.outer_radius_m));
    if inner > outer {
        let rule = format!(
            "must not be greater than outer_radius_m, {}",
            shortest(outer)
        );
        let inner = Value::Float(inner);
        return Err(Problem::with_value("inner_radius_m", &inner, rule));
    }
    Ok(Shape::Tube {
        inner,
        outer,
        length: given(file.length_m),
    })
}

fn not_negative(name: &str, numbers: Option<[f64; 3]>) -> Result<Vector3<f64>, Problem> {
    let numbers = Vector3::from(numbers.unwrap_or_default());
    if numbers.min() < 0.0 {
        Err(Problem::with_value(
            name,
            &vector(&numbers),
            "must hold no negative number",
        ))
    } else {
        Ok(numbers)
    }
}
