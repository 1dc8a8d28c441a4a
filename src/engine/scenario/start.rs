//! Orientation and momentum at the start. A file gives the momentum itself, the spin about the axle, the angular
//! velocity, or Euler rates.

use super::dotted::find;
use super::file::{StartFile, VectorFrame};
use super::keys::STATED;
use super::kind::vector;
use super::model::Scenario;
use super::problem::Problem;
use crate::physics::observables::{VERTICAL_WITHIN, angular_velocity};
use crate::physics::symmetry::steady_precession;
use crate::physics::{self, State, SymmetricTop, rotation};
use crate::text::number;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use toml::{Table, Value};

/// Fraction of the angular velocity below which an Euler rate is rounding.
const RATE_ROUNDING: f64 = 1e-15;

/// One revolution per minute in rad/s.
const RPM: f64 = TAU / 60.0;

/// Returns the state at t = 0. `gravity`, m/s², matters for a steady precession; pushes do not.
pub(super) fn start_state(
    file: &StartFile,
    body: &physics::Body,
    gravity: f64,
) -> Result<State, Problem> {
    is_told_once(file)?;
    let orientation = written_orientation(file);
    let momentum = if let Some(momentum) = file.momentum_Js {
        in_world(momentum, file.momentum_frame, &orientation)
    } else {
        let velocity = if let Some(omega) = file.omega_rad_per_s {
            orientation.tr_mul(&in_world(omega, file.omega_frame, &orientation))
        } else if let Some(spin) = spin(file) {
            let mut velocity = Vector3::new(0.0, 0.0, spin);
            if file.steady == Some(true) {
                let precession = steady(body, &orientation, spin, gravity);
                velocity += precession.map_err(|rule| refused("steady", true, rule))?;
            }
            velocity
        } else {
            of_euler_rates(file, &orientation)
        };
        orientation * (body.inertia() * velocity)
    };
    Ok(State {
        time_s: 0.0,
        orientation,
        momentum,
    })
}

/// Returns the world components of `vector`, which is given in `frame`.
fn in_world(
    vector: [f64; 3],
    frame: Option<VectorFrame>,
    orientation: &Matrix3<f64>,
) -> Vector3<f64> {
    match frame.unwrap_or_default() {
        VectorFrame::World => Vector3::from(vector),
        VectorFrame::Body => orientation * Vector3::from(vector),
    }
}

/// Converts rad/s to revolutions per minute.
pub fn rpm(rad_per_s: f64) -> f64 {
    rad_per_s / RPM
}

/// Returns Rz(turn) Rx(tilt) Rz(roll). An angle of 0 leaves every bit of the others unchanged.
fn written_orientation(file: &StartFile) -> Matrix3<f64> {
    let [tilt, turn, roll] = [file.tilt_deg, file.turn_deg, file.roll_deg]
        .map(|degrees| degrees.unwrap_or(0.0).to_radians());
    let mut orientation = rotation::about(&Vector3::x(), tilt);
    if turn != 0.0 {
        orientation = rotation::about(&Vector3::z(), turn) * orientation;
    }
    if roll != 0.0 {
        orientation *= rotation::about(&Vector3::z(), roll);
    }
    orientation
}

/// Returns the angular velocity, body frame, rad/s, from the Euler rates in `file`. Missing rates are 0. They are the
/// rates of the turn φ, the tilt θ and the roll ψ of `orientation` = Rz(φ) Rx(θ) Rz(ψ).
///
/// The angular velocity is φ' z + θ' n + ψ' e3, where n is the line of nodes (H. Goldstein, Classical Mechanics,
/// section 4.9). This also holds for a vertical axle, where φ' and ψ' are about the same axis.
fn of_euler_rates(file: &StartFile, orientation: &Matrix3<f64>) -> Vector3<f64> {
    let vertical = orientation.row(2).transpose();
    let (nodes, _) = nodes(file);
    file.precession_rad_per_s.unwrap_or(0.0) * vertical
        + file.nutation_rad_per_s.unwrap_or(0.0) * nodes
        + file.psi_dot_rad_per_s.unwrap_or(0.0) * Vector3::z()
}

/// Returns the line of nodes, and the direction perpendicular to it and to the axle, body frame. The vertical is sin θ
/// times that direction, plus e3 cos θ.
fn nodes(file: &StartFile) -> (Vector3<f64>, Vector3<f64>) {
    let (sin, cos) = libm::sincos(file.roll_deg.unwrap_or(0.0).to_radians());
    (Vector3::new(cos, -sin, 0.0), Vector3::new(sin, cos, 0.0))
}

/// Returns precession, nutation and psi-dot, rad/s, at the start of `now`. `None` if the axle is vertical and turns out
/// of the plane in which Euler rates can tilt it.
fn euler_rates(now: &Scenario) -> Option<[f64; 3]> {
    let start = &now.start;
    let in_world = angular_velocity(&now.body.mechanics, start);
    let omega = start.orientation.tr_mul(&in_world);
    let vertical = start.orientation.row(2).transpose();
    let (nodes, across) = nodes(&now.file.start);
    let (sine, rate) = (vertical.dot(&across), omega.dot(&across));
    let is_vertical = sine.abs() <= VERTICAL_WITHIN;
    if is_vertical && rate.abs() > VERTICAL_WITHIN * omega.norm() {
        return None;
    }
    let precession = if is_vertical { 0.0 } else { rate / sine };
    let rates = [
        precession,
        omega.dot(&nodes),
        omega.z - precession * vertical.z,
    ];
    // The turn into the body frame leaves a rounding error in place of a zero.
    let rounding = RATE_ROUNDING * omega.norm();
    Some(rates.map(|exact| if exact.abs() <= rounding { 0.0 } else { exact }))
}

fn spin(file: &StartFile) -> Option<f64> {
    file.spin_rad_per_s.or(file.spin_rpm.map(|rpm| rpm * RPM))
}

fn refused(name: &str, value: impl Into<Value>, rule: impl Into<String>) -> Problem {
    Problem::with_value(format!("start.{name}"), &value.into(), rule)
}

fn is_told_once(file: &StartFile) -> Result<(), Problem> {
    let written = Table::try_from(file).unwrap_or_default();
    let mut told = WAYS_TO_TELL
        .into_iter()
        .filter(|name| written.contains_key(*name));
    let Some(way) = told.next() else {
        let rule = format!("is missing ({STATED})");
        return Err(Problem::at("start.momentum_Js", rule));
    };
    let others = replaced(way);
    if let Some(other) = told.find(|name| others.contains(name)) {
        let rule = if EULER.contains(&other) {
            format!(
                "cannot be combined with {way}: remove it, or give psi_dot_rad_per_s instead of {way}"
            )
        } else {
            format!("is given in addition to {way}: keep only one")
        };
        return Err(refused(other, written[other].clone(), rule));
    }
    for (frame, own) in [
        ("momentum_frame", "momentum_Js"),
        ("omega_frame", "omega_rad_per_s"),
    ] {
        if written.contains_key(frame) && way != own {
            let rule = format!("belongs to {own}, but {way} is given: remove it");
            return Err(Problem::at(format!("start.{frame}"), rule));
        }
    }
    if file.steady == Some(true) && !SPIN.contains(&way) {
        let rule = format!("needs a spin: give spin_rpm or spin_rad_per_s instead of {way}");
        return Err(refused("steady", true, rule));
    }
    Ok(())
}

/// Returns the angular velocity, body frame, rad/s, that must be added to the spin `spin` (rad/s) for a steady
/// precession. It is φ'(z − (z·e3)e3), where φ' is the slow root.
fn steady(
    body: &physics::Body,
    orientation: &Matrix3<f64>,
    spin: f64,
    gravity: f64,
) -> Result<Vector3<f64>, String> {
    let top = SymmetricTop::from_body(body).ok_or(
        "needs a body that is symmetric about its axle, but this one is lopsided: remove it",
    )?;
    let up = orientation.row(2).transpose();
    let across = Vector3::new(up.x, up.y, 0.0);
    if across.norm() <= VERTICAL_WITHIN {
        return Ok(Vector3::zeros()); // a vertical axle stays where it is
    }
    let is_level = up.z.abs() <= VERTICAL_WITHIN;
    let cosine = if is_level { 0.0 } else { up.z };
    let load = gravity * top.first_moment;
    let slow = match load {
        0.0 => Some(0.0),
        _ => steady_precession(top.across * cosine, top.along * spin, load).0,
    };
    match slow {
        Some(slow) if slow.is_finite() => Ok(slow * across),
        _ => Err(too_slow(least_spin(&top, cosine, load))),
    }
}

/// Returns the minimum spin for a steady precession, rad/s: I3² ω3² = 4 I1 cos θ M g l.
fn least_spin(top: &SymmetricTop, cosine: f64, load: f64) -> f64 {
    2.0 * (top.across * cosine).abs().sqrt() * load.abs().sqrt() / top.along
}

fn too_slow(least: f64) -> String {
    let why = match least {
        0.0 => "the spin must not be zero".to_owned(),
        least if least.is_finite() => {
            let (rpm, rate) = (above(rpm(least)), above(least));
            format!("the spin must be at least {rpm} rpm ({rate} rad/s)")
        }
        _ => "its numbers leave the range of floating-point numbers".to_owned(),
    };
    format!("has no steady precession at this tilt: {why}")
}

/// Rounds `number` up to four significant digits.
fn above(number: f64) -> String {
    let up = number * (1.0 + 6e-4);
    number::significant(up, 4)
}

/// Keys that give the momentum. A start has one of them, or several of the last three.
const WAYS_TO_TELL: [&str; 7] = [
    "momentum_Js",
    "spin_rpm",
    "spin_rad_per_s",
    "omega_rad_per_s",
    "precession_rad_per_s",
    "nutation_rad_per_s",
    "psi_dot_rad_per_s",
];
/// Keys that replace another form of the momentum when they are set. Precession and nutation do not, because with one
/// of them alone the spin would be lost.
const REPLACING: [&str; 5] = [
    "momentum_Js",
    "spin_rpm",
    "spin_rad_per_s",
    "omega_rad_per_s",
    "psi_dot_rad_per_s",
];
/// Forms of the momentum, with the keys of each.
const START_KEYS: [&[&str]; 4] = [&MOMENTUM_KEYS, &SPIN, &OMEGA_KEYS, &EULER];
const MOMENTUM_KEYS: [&str; 2] = ["momentum_Js", "momentum_frame"];
const SPIN: [&str; 3] = ["spin_rpm", "spin_rad_per_s", "steady"];
const OMEGA_KEYS: [&str; 2] = ["omega_rad_per_s", "omega_frame"];
/// The Euler rates. A start in this form has one or more of them.
pub const EULER: [&str; 3] = [
    "precession_rad_per_s",
    "nutation_rad_per_s",
    "psi_dot_rad_per_s",
];

/// Returns the keys of the form to which the key `name` of the start belongs.
fn way_of(name: &str) -> Option<&'static [&'static str]> {
    START_KEYS.into_iter().find(|way| way.contains(&name))
}

/// Returns the keys of the start that a new value at its key `name` replaces: the other forms of the momentum, or the
/// other spin.
fn replaced(name: &str) -> Vec<&'static str> {
    let own = way_of(name).unwrap_or_default();
    let others = START_KEYS
        .into_iter()
        .filter(|way| !own.is_empty() && *way != own);
    let spins = SPIN[..2]
        .iter()
        .filter(|spin| SPIN[..2].contains(&name) && **spin != name);
    others.flatten().chain(spins).copied().collect()
}

/// Returns true if a file can have only one of the dotted keys `one` and `other`, because both give the momentum at the
/// start.
pub fn exclude_each_other(one: &str, other: &str) -> bool {
    let [one, other] = [one, other].map(|key| key.strip_prefix("start.")?.split('.').next());
    one.zip(other)
        .is_some_and(|(one, other)| replaced(one).contains(&other))
}

/// Removes the keys from the file's `table` that a new value at `key` replaces.
pub(super) fn make_room(table: &mut Table, key: &str) {
    let name = key.strip_prefix("start.").unwrap_or_default();
    if REPLACING.contains(&name) {
        remove(table, &replaced(name));
    }
}

fn remove(table: &mut Table, names: &[&str]) {
    if let Some(Value::Table(start)) = table.get_mut("start") {
        start.retain(|name, _| !names.contains(&name));
    }
}

/// Returns true if a new `value` at `key` needs a form of the momentum that `table` does not use.
pub(super) fn is_other_way(table: &Table, key: &str, value: &Value) -> bool {
    let name = key.strip_prefix("start.").unwrap_or_default();
    let ways: &[&str] = match name.split_once('.').map_or(name, |(vector, _)| vector) {
        "momentum_Js" if name != "momentum_Js" => &["momentum_Js"],
        "omega_rad_per_s" if name != "omega_rad_per_s" => &["omega_rad_per_s"],
        "momentum_frame" => &["momentum_Js"],
        "omega_frame" => &["omega_rad_per_s"],
        name if EULER.contains(&name) => &EULER,
        "steady" if value.as_bool() == Some(true) => &SPIN[..2],
        _ => return false,
    };
    let start = find(table, "start");
    ways.iter()
        .all(|way| start.is_none_or(|start| start.get(way).is_none()))
}

/// Converts the momentum in `table` to the form that `key` belongs to, as it is at the start of `now`. If `value` is a
/// frame, the result is in that frame, otherwise in the world frame.
///
/// # Errors
/// Returns an error if the key is an Euler rate, and no Euler rates give this start.
pub(super) fn tell_other_way(
    table: &mut Table,
    key: &str,
    value: &Value,
    now: &Scenario,
) -> Result<(), Problem> {
    let name = key.split('.').nth(1).unwrap_or_default();
    let own = way_of(name).unwrap_or(&MOMENTUM_KEYS);
    remove(table, &replaced(own[own.len() - 1]));
    let start = &now.start;
    let is_body_frame = value.as_str() == Some("body");
    let Some(Value::Table(file)) = table.get_mut("start") else {
        return Ok(());
    };
    match own[0] {
        "spin_rpm" => {
            file.insert(
                "spin_rad_per_s".to_owned(),
                now.spin_rad_per_s(start).into(),
            );
        }
        "precession_rad_per_s" => {
            let rates = euler_rates(now).ok_or_else(|| Problem::at(key, NO_RATES))?;
            for (way, rate) in EULER.into_iter().zip(rates) {
                file.insert(way.to_owned(), rate.into());
            }
        }
        way => {
            let in_world = match way {
                "omega_rad_per_s" => angular_velocity(&now.body.mechanics, start),
                _ => start.momentum,
            };
            let framed = if is_body_frame {
                start.orientation.tr_mul(&in_world)
            } else {
                in_world
            };
            file.insert(way.to_owned(), vector(&framed));
        }
    }
    Ok(())
}

/// Error message if a start cannot be given by Euler rates.
const NO_RATES: &str = "cannot be set alone: the axle is vertical, and no Euler rates give its present angular velocity; tilt it, or write all rates into the file";
