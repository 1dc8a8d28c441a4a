//! The start: how the body stands, and its momentum, told in one of two ways: as it is, or by the spin about the axle.

use super::dotted::find;
use super::file::{Frame, StartFile};
use super::keys::STATED;
use super::problem::Problem;
use crate::physics::observables::{VERTICAL_WITHIN, angular_velocity};
use crate::physics::symmetry::steady_precession;
use crate::physics::{Body, State, SymmetricTop, rotation};
use crate::text::number;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use toml::{Table, Value};

/// rad/s of one revolution a minute.
const RPM: f64 = TAU / 60.0;

/// The state at t = 0 under the gravity `gravity`, m/s²; pushes do not count.
///
/// # Errors
/// Where the momentum is told in both ways or in none, or asked to be steady where it cannot be.
pub(super) fn start(file: &StartFile, body: &Body, gravity: f64) -> Result<State, Vec<Problem>> {
    is_told_once(file)?;
    let orientation = orientation(file);
    let momentum = match (file.momentum_Js, spin(file)) {
        (Some(momentum), _) => match file.momentum_frame.unwrap_or_default() {
            Frame::World => Vector3::from(momentum),
            Frame::Body => orientation * Vector3::from(momentum),
        },
        (None, spin) => {
            let spin = spin.unwrap_or_default();
            let mut velocity = Vector3::new(0.0, 0.0, spin);
            if file.steady == Some(true) {
                let precession = steady(body, &orientation, spin, gravity);
                velocity += precession.map_err(|rule| refused("steady", true, rule))?;
            }
            orientation * (body.inertia() * velocity)
        }
    };
    Ok(State {
        time_s: 0.0,
        orientation,
        momentum,
    })
}

/// ω3, the component of the angular velocity along the axle, rad/s.
pub(crate) fn spin_of(body: &Body, state: &State) -> f64 {
    state.axle().dot(&angular_velocity(body, state))
}

/// The same in revolutions a minute.
pub(crate) fn rpm(rad_per_s: f64) -> f64 {
    rad_per_s / RPM
}

/// Rz(turn) Rx(tilt) Rz(roll); an angle of 0 leaves every bit of the others alone.
fn orientation(file: &StartFile) -> Matrix3<f64> {
    let about = |axis: Vector3<f64>, deg: Option<f64>| {
        rotation::about(&axis, deg.unwrap_or(0.0).to_radians())
    };
    let is_turned = |deg: Option<f64>| deg.is_some_and(|deg| deg != 0.0);
    let mut orientation = about(Vector3::x(), file.tilt_deg);
    if is_turned(file.turn_deg) {
        orientation = about(Vector3::z(), file.turn_deg) * orientation;
    }
    if is_turned(file.roll_deg) {
        orientation *= about(Vector3::z(), file.roll_deg);
    }
    orientation
}

/// The spin that is written, rad/s.
fn spin(file: &StartFile) -> Option<f64> {
    file.spin_rad_per_s.or(file.spin_rpm.map(|rpm| rpm * RPM))
}

fn refused(name: &str, value: impl Into<Value>, rule: impl Into<String>) -> Vec<Problem> {
    vec![Problem::with_value(
        format!("start.{name}"),
        &value.into(),
        rule,
    )]
}

fn is_told_once(file: &StartFile) -> Result<(), Vec<Problem>> {
    match (file.momentum_Js, file.spin_rpm, file.spin_rad_per_s) {
        (None, None, None) => {
            let rule = format!("is missing ({STATED})");
            return Err(vec![Problem::at("start.momentum_Js", rule)]);
        }
        (Some(_), Some(spin), _) => {
            return Err(refused(
                "spin_rpm",
                spin,
                "is given beside momentum_Js: keep one of the two",
            ));
        }
        (Some(_), _, Some(spin)) => {
            return Err(refused(
                "spin_rad_per_s",
                spin,
                "is given beside momentum_Js: keep one of the two",
            ));
        }
        (_, Some(_), Some(spin)) => {
            return Err(refused(
                "spin_rad_per_s",
                spin,
                "is given beside spin_rpm: keep one of the two",
            ));
        }
        _ => {}
    }
    let is_spun = file.momentum_Js.is_none();
    match (file.momentum_frame, file.steady) {
        (Some(_), _) if is_spun => {
            let rule = "goes with momentum_Js, and a spin is given: leave it out";
            Err(vec![Problem::at("start.momentum_frame", rule)])
        }
        (_, Some(true)) if !is_spun => {
            let rule = "goes with a spin: give spin_rpm or spin_rad_per_s instead of momentum_Js";
            Err(refused("steady", true, rule))
        }
        _ => Ok(()),
    }
}

/// The angular velocity, body frame, rad/s, that the spin `spin` (rad/s) lacks for a steady precession: φ'(z − (z·e3)e3),
/// φ' the slow root.
fn steady(
    body: &Body,
    orientation: &Matrix3<f64>,
    spin: f64,
    gravity: f64,
) -> Result<Vector3<f64>, String> {
    let top = SymmetricTop::of(body).ok_or(
        "needs a body that is symmetric about its axle, and this one is lopsided: leave it out",
    )?;
    let up = orientation.row(2).transpose();
    let across = Vector3::new(up.x, up.y, 0.0);
    if across.norm() <= VERTICAL_WITHIN {
        return Ok(Vector3::zeros()); // a vertical axle stays where it is
    }
    let cosine = if up.z.abs() <= VERTICAL_WITHIN {
        0.0
    } else {
        up.z
    };
    let load = gravity * top.first_moment;
    let slow = match load == 0.0 {
        true => Some(0.0),
        false => steady_precession(top.across * cosine, top.along * spin, load).0,
    };
    let precession = slow.filter(|slow| slow.is_finite());
    precession
        .map(|slow| slow * across)
        .ok_or_else(|| too_slow(least_spin(&top, cosine, load)))
}

/// The least spin with a steady precession, rad/s: I3² ω3² = 4 I1 cos θ M g l.
fn least_spin(top: &SymmetricTop, cosine: f64, load: f64) -> f64 {
    2.0 * (top.across * cosine).abs().sqrt() * load.abs().sqrt() / top.along
}

fn too_slow(least: f64) -> String {
    let why = match least {
        0.0 => "the spin must not be zero".to_owned(),
        least if least.is_finite() => format!(
            "the spin must be at least {} rpm ({} rad/s)",
            above(rpm(least)),
            above(least)
        ),
        _ => "its numbers leave the range of floating-point numbers".to_owned(),
    };
    format!("has no steady precession at this tilt: {why}")
}

/// A number of four digits not below `number`, and hardly above it.
fn above(number: f64) -> String {
    let up = number * (1.0 + 6e-4);
    number::significant(up, 4)
}

/// The two ways to tell the momentum: the keys of each.
const MOMENTUM: [&str; 2] = ["momentum_Js", "momentum_frame"];
const SPIN: [&str; 3] = ["spin_rpm", "spin_rad_per_s", "steady"];

/// Takes out of the file's `table` what a new value at `key` replaces: the momentum and the other spin by a spin, the
/// spin by a momentum.
pub(super) fn make_room(table: &mut Table, key: &str) {
    let replaced: &[&str] = match key {
        "start.spin_rpm" => &["momentum_Js", "momentum_frame", "spin_rad_per_s"],
        "start.spin_rad_per_s" => &["momentum_Js", "momentum_frame", "spin_rpm"],
        "start.momentum_Js" => &SPIN,
        _ => &[],
    };
    remove(table, replaced);
}

fn remove(table: &mut Table, names: &[&str]) {
    if let Some(Value::Table(start)) = table.get_mut("start") {
        start.retain(|name, _| !names.contains(&name));
    }
}

/// Whether a new `value` at `key` is about the way of telling the momentum that `table` does not use.
pub(super) fn is_other_way(table: &Table, key: &str, value: &Value) -> bool {
    let is_spun = find(table, "start.momentum_Js").is_none();
    match key {
        "start.momentum_frame" => is_spun,
        "start.steady" => !is_spun && value.as_bool() == Some(true),
        _ => is_spun && key.starts_with("start.momentum_Js."),
    }
}

/// Tells the momentum in `table` in the way that `key` is about, as it is in the state `start`; `frame` is that of a
/// momentum, where it is not the world's.
pub(super) fn tell_other_way(
    table: &mut Table,
    key: &str,
    value: &Value,
    body: &Body,
    start: &State,
) {
    let is_steady = key == "start.steady";
    remove(table, if is_steady { &MOMENTUM } else { &SPIN });
    let momentum = match value.as_str() {
        Some("body") => start.orientation.tr_mul(&start.momentum),
        _ => start.momentum,
    };
    let (name, told) = match is_steady {
        true => ("spin_rad_per_s", spin_of(body, start).into()),
        false => ("momentum_Js", vector(&momentum)),
    };
    if let Some(Value::Table(table)) = table.get_mut("start") {
        table.insert(name.to_owned(), told);
    }
}

pub(crate) fn vector(vector: &Vector3<f64>) -> Value {
    Value::Array(vector.iter().map(|&number| Value::Float(number)).collect())
}
