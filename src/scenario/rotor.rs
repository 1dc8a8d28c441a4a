//! The rotor: the one part that spins, in a frame that does not.
//!
//! The axle moves by the moments across of all that tilts, by L along the axle, and by the torque. Where the frame is
//! symmetric too and turns freely about the axle, the gyroscope therefore moves as a rigid body whose moment about the axle
//! is the rotor's: that is the body which is computed, and its spin, its energy and the work of friction are the rotor's.

use super::file::{PartFile, StartFile};
use super::model::Body;
use super::problem::{Problem, nearest};
use crate::physics::{self, Part, SymmetricTop};
use toml::Value;

/// A direction, a place or a moment is on or about the axle to this part of its size, as for
/// [`SymmetricTop`]: less is the rounding of a scenario's digits.
const WITHIN: f64 = 1e-9;

/// What turns: `body`, of which the part that `file` names as the rotor spins alone.
///
/// # Errors
/// Where there is no such part, it cannot spin alone about the axle, or the body is lopsided.
pub(super) fn spinning(
    file: &StartFile,
    body: &Body,
    parts: &[PartFile],
) -> Result<physics::Body, Vec<Problem>> {
    let whole = &body.mechanics;
    let Some(name) = &file.rotor else {
        return Ok(whole.clone());
    };
    let refused = |rule: &str| {
        let value = Value::String(name.clone());
        Err(vec![Problem::with_value("start.rotor", &value, rule)])
    };
    let Some(index) = parts.iter().position(|part| part.name == *name) else {
        let near = nearest(name, parts.iter().map(|part| part.name.as_str()));
        return refused(&format!("is no part of this body: {near}"));
    };
    if SymmetricTop::of(whole).is_none() {
        return refused(
            "needs a body that is symmetric about its axle, and this one is lopsided: leave it out",
        );
    }
    match alone(&body.parts[index]) {
        Ok(moment) => {
            (whole.clone().with_rotor(moment)).or_else(|error| refused(&error.to_string()))
        }
        Err(rule) => refused(rule),
    }
}

/// The moment about the axle of a `part` that can spin alone about it, kg m².
fn alone(part: &Part) -> Result<f64, &'static str> {
    let moments = part.moments();
    let axis = part.directions.column(2);
    let size = (moments.amax() / part.mass).sqrt();
    let is_small = |number: f64, size: f64| number.abs() <= WITHIN * size;
    let centre = part.centre;
    let is_on_axle = [centre.x, centre.y]
        .iter()
        .all(|&across| is_small(across, size.max(centre.z.abs())));
    let is_along = is_small(axis.x, 1.0) && is_small(axis.y, 1.0);
    let is_round = is_small(moments.x - moments.y, moments.amax());
    match (is_on_axle, is_along, is_round) {
        (false, ..) => Err("must have its centre on the axle, x and y of at_m 0"),
        (_, false, _) => Err("must have its axis along the axle, [0, 0, 1]"),
        (.., false) => Err(
            "must be symmetric about its axis: of any other the moments would change as it spins",
        ),
        _ if moments.z <= WITHIN * moments.amax() => {
            Err("has no moment about the axle: no spin of it gives a momentum")
        }
        _ => Ok(moments.z),
    }
}
