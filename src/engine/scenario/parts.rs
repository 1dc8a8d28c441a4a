//! Checks the tables of a scenario one by one: points that exist, an inertia that can be inverted, pushes that have a
//! duration.

use super::file::{BodyFile, FrictionFile, MotionFile, PartFile, PushFile, StartFile};
use super::keys::GRAVITY;
use super::limits::MOST_POINTS;
use super::model::{Motion, NamedBody, Push, Pushes, Window};
use super::problem::{Problem, Problems, listed, nearest};
use super::solids;
use crate::physics::{
    self, BodyError, Damping, Friction, PlacedSolid, PointMass, SchemeInfo, SymmetricTop, scheme,
};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::f64::consts::TAU;
use toml::Value;

/// Number of points that each part counts as, towards the maximum number of points.
const OF_PART: usize = 6;
/// Maximum ratio of a friction coefficient to the smallest moment of the body. Up to it, the effect is finite.
const MOST_RATE: f64 = 1e100;
/// Tolerance for a direction, position or moment to be on or about the axle, relative to its size, as in
/// [`SymmetricTop`]. Smaller deviations come from rounded digits in a scenario.
const AXLE_TOLERANCE: f64 = 1e-9;

pub(super) fn read_body(file: &BodyFile) -> Result<NamedBody, Problems> {
    check_point_count(file)?;
    let mut points = rim_points(file);
    let mut named = PointNames::default();
    for (index, point) in file.point.iter().enumerate() {
        named.add(&point.name, points.len(), "point", index);
        points.push(PointMass {
            at: Vector3::from(point.at_m),
            mass: point.mass_kg.unwrap_or(0.0),
        });
    }
    let mut parts = Vec::with_capacity(file.part.len());
    for (index, solid) in file.part.iter().enumerate() {
        named.add(&solid.name, points.len(), "part", index);
        match solids::read_part(solid) {
            Ok(part) => {
                points.extend(part.points());
                parts.push(part);
            }
            Err(problems) => named.refuse(problems, index),
        }
    }
    named.problems.or(())?;
    let mechanics = physics::Body::new(points).map_err(|error| {
        let few = match (&error, &file.rim) {
            (BodyError::Singular { .. }, Some(rim)) if rim.points == 1 => {
                "; a rim with 1 point leaves all mass on a line: use 2 points or more"
            }
            _ => "",
        };
        Problem::at("body", format!("{error}{few}"))
    })?;
    Ok(NamedBody {
        mechanics,
        parts,
        names: named.names,
    })
}

fn check_point_count(file: &BodyFile) -> Result<(), Problem> {
    let count = file.rim_points() + file.point.len() + OF_PART * file.part.len();
    if count as i64 <= MOST_POINTS {
        return Ok(());
    }
    let parts = file.part.first();
    let of_parts = parts.map_or("", |_| ", six for each part");
    let rule = format!("has {count} points{of_parts}; at most {MOST_POINTS} are allowed");
    Err(Problem::at("body", rule))
}

/// Names of points and parts, each with the index of its point, and the problems with them.
#[derive(Default)]
struct PointNames {
    names: HashMap<String, usize>,
    problems: Problems,
}

impl PointNames {
    /// Names the point `point`. The name is in the table of this `kind`, `point` or `part`, with this `index`.
    fn add(&mut self, name: &str, point: usize, kind: &str, index: usize) {
        if self.names.insert(name.to_owned(), point).is_some() {
            self.problems.add(|| {
                let value = Value::String(name.to_owned());
                let key = format!("body.{kind}.{index}.name");
                let rule = match kind {
                    "point" => "is also the name of another point: give each its own name",
                    _ => "is also the name of a point or of another part: give each its own name",
                };
                Problem::with_value(key, &value, rule)
            });
        }
    }

    /// Adds the problems of the part with this `index`. Their keys are relative to its table.
    fn refuse(&mut self, problems: Problems, index: usize) {
        let place = format!("body.part.{index}");
        self.problems.add_all(problems.inside(&place));
    }
}

fn rim_points(file: &BodyFile) -> Vec<PointMass> {
    let Some(rim) = &file.rim else {
        return Vec::new();
    };
    (0..rim.points)
        .map(|j| {
            let (sin, cos) = libm::sincos(TAU * j as f64 / rim.points as f64);
            PointMass {
                at: Vector3::new(rim.radius_m * cos, rim.radius_m * sin, rim.height_m),
                mass: rim.point_mass_kg,
            }
        })
        .collect()
}

pub(super) fn read_motion(file: &MotionFile) -> Motion {
    let named = file.scheme.as_deref().and_then(SchemeInfo::find);
    Motion {
        gravity: file.gravity_m_per_s2.unwrap_or(GRAVITY),
        scheme: named.unwrap_or(&physics::scheme::SCHEMES[0]), // keys::check has rejected unknown names
        time_step_s: file.time_step_s,
    }
}

pub(super) fn read_pushes(files: &[PushFile], body: &NamedBody) -> Result<Pushes, Problems> {
    let mut found = Problems::default();
    let mut pushes = Vec::with_capacity(files.len());
    for (index, file) in files.iter().enumerate() {
        // Look for the nearest name only for listed problems: there may be 100 000 points.
        if found.is_full() && body.point(&file.point).is_none() {
            found.more += 1;
        } else {
            pushes.extend(found.kept(read_push(file, body, &format!("push.{index}"))));
        }
    }
    found.or(pushes.into())
}

pub(super) fn read_push(file: &PushFile, body: &NamedBody, key: &str) -> Result<Push, Problems> {
    let mut problems = Problems::default();
    let point = problems.kept(body.find(&format!("{key}.point"), &file.point));
    let window = problems.kept(read_window(file, key));
    let (Some(point), Some(window)) = (point, window) else {
        return Err(problems);
    };
    Ok(Push {
        point,
        force: Vector3::from(file.force_N),
        window,
        accumulates: file.accumulates.unwrap_or(false),
    })
}

fn read_window(file: &PushFile, key: &str) -> Result<Window, Problem> {
    let rule = match (file.first_step, file.steps, file.from_s, file.for_s) {
        (first, Some(count), None, None) => {
            return Ok(Window::Steps {
                first: first.unwrap_or(1),
                count,
            });
        }
        (None, None, from, Some(for_s)) if file.accumulates != Some(true) => {
            let from_s = from.unwrap_or(0.0);
            return Ok(Window::Time { from_s, for_s });
        }
        (None, None, _, Some(_)) => {
            "accumulates step by step: give first_step and steps instead of seconds"
        }
        (None, None, Some(_), None) => "has no duration: add for_s",
        (Some(_), None, None, None) => "has no duration: add steps",
        (None, None, None, None) => "has no duration: add steps, or for_s",
        _ => "has times in steps and in seconds: keep first_step and steps, or from_s and for_s",
    };
    Err(Problem::at(key, rule))
}

pub(super) fn read_friction(
    file: Option<&FrictionFile>,
    body: &physics::Body,
) -> Result<Friction, Problem> {
    let Some(file) = file else {
        return Ok(Friction::default());
    };
    let rates = [
        ("spin_dry_Nm", file.spin_dry_Nm),
        ("spin_viscous_Nms", file.spin_viscous_Nms),
        ("spin_quadratic_Nms2", file.spin_quadratic_Nms2),
        ("swing_viscous_Nms", file.swing_viscous_Nms),
    ]
    .map(|(name, rate)| (name, rate.unwrap_or(0.0)));
    let [spin_dry, spin_viscous, spin_quadratic, swing_viscous] = rates.map(|(_, rate)| rate);
    let friction = Friction {
        spin_dry,
        spin_viscous,
        spin_quadratic,
        swing_viscous,
    };
    let Some(damping) = Damping::new(body, &friction) else {
        return Ok(Friction::default());
    };
    let least = damping.least_moment();
    let Some((name, rate)) = rates.iter().find(|(_, rate)| *rate / least > MOST_RATE) else {
        return Ok(friction);
    };
    let rule = format!(
        "is too large for this body, whose smallest moment is {least:e} kg m^2: at most {:e}",
        MOST_RATE * least
    );
    let key = format!("friction.{name}");
    Err(Problem::with_value(key, &Value::Float(*rate), rule))
}

/// Checks that `scheme` can model `friction`.
pub(super) fn check_scheme(
    scheme: &'static SchemeInfo,
    friction: &Friction,
) -> Result<(), Problem> {
    let Some(why) = scheme.admits.why_not(friction) else {
        return Ok(());
    };
    let able = listed(scheme::true_to(*friction).map(|able| able.name));
    let value = Value::String(scheme.name.to_owned());
    let rule = format!("does not support this friction: it {why}; use one of {able}");
    Err(Problem::with_value("motion.scheme", &value, rule))
}

/// Returns the body that spins. If `file` names a rotor, only that part of `body` spins, in a frame that does not.
///
/// The motion of the axle depends on the moments across of all that tilts, on L along the axle, and on the torque. If
/// the frame is symmetric too, and turns freely about the axle, the gyroscope moves like a rigid body with the rotor's
/// moment about the axle. The program computes this body. Its spin, its energy and the work of friction are those of
/// the rotor.
pub(super) fn spinning_body(
    file: &StartFile,
    body: &NamedBody,
    parts: &[PartFile],
) -> Result<physics::Body, Problem> {
    let Some(name) = &file.rotor else {
        return Ok(body.mechanics.clone());
    };
    with_rotor(name, body, parts).map_err(|rule| {
        let value = Value::String(name.clone());
        Problem::with_value("start.rotor", &value, rule)
    })
}

/// Returns the mechanics of `body` with the part called `name` as its rotor.
///
/// # Errors
/// Returns why that part cannot be a rotor.
fn with_rotor(name: &str, body: &NamedBody, parts: &[PartFile]) -> Result<physics::Body, String> {
    let whole = &body.mechanics;
    let Some(index) = parts.iter().position(|part| part.name == *name) else {
        let near = nearest(name, parts.iter().map(|part| part.name.as_str()));
        return Err(format!("is not a part of this body: {near}"));
    };
    if SymmetricTop::from_body(whole).is_none() {
        let rule =
            "needs a body that is symmetric about its axle, but this one is lopsided: remove it";
        return Err(rule.to_owned());
    }
    let moment = moment_alone(&body.parts[index])?;
    let turning = whole.clone().with_rotor(moment);
    turning.map_err(|error| error.to_string())
}

/// Returns the moment of inertia about the axle of a `part` that can spin alone about it, kg m².
fn moment_alone(part: &PlacedSolid) -> Result<f64, &'static str> {
    let moments = part.moments();
    let axis = part.directions.column(2);
    let size = (moments.amax() / part.mass).sqrt();
    let off_axle = part.center.x.abs().max(part.center.y.abs());
    let is_on_axle = off_axle <= AXLE_TOLERANCE * size.max(part.center.z.abs());
    let is_along = axis.x.abs().max(axis.y.abs()) <= AXLE_TOLERANCE;
    let is_round = (moments.x - moments.y).abs() <= AXLE_TOLERANCE * moments.amax();
    match (is_on_axle, is_along, is_round) {
        (false, ..) => Err("must have its center on the axle: x and y of at_m must be 0"),
        (_, false, _) => Err("must have its axis along the axle, [0, 0, 1]"),
        (.., false) => {
            Err("must be symmetric about its axis: otherwise its moments would change as it spins")
        }
        _ if moments.z <= AXLE_TOLERANCE * moments.amax() => {
            Err("has no moment about the axle, so its spin gives no momentum")
        }
        _ => Ok(moments.z),
    }
}
