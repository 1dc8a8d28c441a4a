//! What was run, as a table of Markdown: body, start, forces, scheme, time steps, pushes and edits.

use super::Writeup;
use super::markdown::escaped;
use crate::export::summary::steps_in_words;
use crate::physics::{SchemeInfo, SymmetricTop};
use crate::scenario::file::{BodyFile, FrictionFile};
use crate::scenario::{Push, Scenario, Window};
use crate::text::number::{fixed, shortest, significant};
use std::fmt::{self, Write};

/// More parts, pushes or edits than these are counted, not listed.
const MOST_LISTED: usize = 12;

/// A part of L that is smaller than this part of |L| is zero.
const ROUNDING: f64 = 1e-14;

/// Writes the table.
///
/// # Errors
/// None: a `String` takes what is written to it.
pub(super) fn write(page: &mut String, writeup: &Writeup) -> fmt::Result {
    let scenario = &writeup.scenario;
    let mut row = |name: &str, text: &str| writeln!(page, "| {name} | {} |", escaped(text));
    row("", "")?;
    row("---", "---")?;
    row("body", &body(scenario))?;
    row("moments of inertia about the pivot", &moments(scenario))?;
    let top = scenario.body.mechanics.points()[scenario.trace].at.norm();
    let name = scenario.file.trace.as_deref().unwrap_or("top");
    row(
        "traced point",
        &format!("{name}, {} m from the pivot", significant(top, 6)),
    )?;
    row("start", &start(scenario))?;
    if let Some(rotor) = &scenario.file.start.rotor {
        row("rotor", &format!("{rotor}: it spins, the rest does not"))?;
    }
    let gravity = shortest(scenario.motion.gravity);
    row("gravity", &format!("{gravity} m/s^2"))?;
    if let Some(friction) = &scenario.file.friction {
        row("friction", &friction_in_words(friction))?;
    }
    let SchemeInfo { name, about, .. } = scenario.motion.scheme;
    row("scheme", &format!("{name}: {about}"))?;
    let steps = steps_in_words(scenario, writeup.readouts.sample.step);
    row("time steps", &steps)?;
    for push in scenario.pushes.iter().take(MOST_LISTED) {
        row("push", &push_in_words(push, &writeup.name_of(push.point)))?;
    }
    if scenario.pushes.len() > MOST_LISTED {
        row("push", &format!("{} in all", scenario.pushes.len()))?;
    }
    for edit in scenario.file.edit.iter().take(MOST_LISTED) {
        let set = edit
            .set
            .iter()
            .map(|(key, value)| format!("{key} = {value}"));
        let set: Vec<_> = set.collect();
        row(&format!("edit at step {}", edit.step), &set.join(", "))?;
    }
    match scenario.file.edit.len() {
        count if count > MOST_LISTED => row("edits", &format!("{count} in all")),
        _ => Ok(()),
    }
}

/// What the scenario makes the body of, its mass, and where its centre of mass is.
fn body(scenario: &Scenario) -> String {
    let body = &scenario.body.mechanics;
    let centre = body.first_moment().norm() / body.mass();
    format!(
        "{}; {} kg together; centre of mass {} m from the pivot",
        made_of(&scenario.file.body).join(", "),
        significant(body.mass(), 6),
        significant(centre, 6)
    )
}

fn made_of(body: &BodyFile) -> Vec<String> {
    let mut made = Vec::new();
    if let Some(rim) = &body.rim {
        made.push(format!(
            "{} masses of {} kg on a rim of radius {} m at the height {} m",
            rim.points,
            shortest(rim.point_mass_kg),
            significant(rim.radius_m, 6),
            significant(rim.height_m, 6)
        ));
    }
    let masses = body.point.iter();
    match masses
        .filter(|point| point.mass_kg.is_some_and(|mass| mass > 0.0))
        .count()
    {
        0 => {}
        1 => made.push("1 point mass".to_owned()),
        count => made.push(format!("{count} point masses")),
    }
    if body.part.len() > MOST_LISTED {
        made.push(format!("{} parts", body.part.len()));
        return made;
    }
    let parts = body.part.iter();
    made.extend(parts.map(|part| {
        let mass = shortest(part.mass_kg);
        format!("{} ({}, {mass} kg)", part.name, part.shape)
    }));
    made
}

fn moments(scenario: &Scenario) -> String {
    let body = &scenario.body.mechanics;
    let Some(top) = SymmetricTop::of(body) else {
        return "lopsided: not symmetric about the axle".to_owned();
    };
    let of = if scenario.rotor().is_some() {
        "of the rotor"
    } else {
        "about it"
    };
    format!(
        "I1 = {} kg m^2 across the axle, I3 = {} kg m^2 {of}, kappa = I3/I1 = {}",
        significant(top.across, 6),
        significant(top.along, 6),
        significant(top.kappa(), 6)
    )
}

fn start(scenario: &Scenario) -> String {
    let tilt_deg = scenario.start.axle().z.clamp(-1.0, 1.0);
    let tilt_deg = libm::acos(tilt_deg).to_degrees();
    let momentum = &scenario.start.momentum;
    // What is left of a zero by the turn from the body frame is rounding.
    let rounding = ROUNDING * momentum.norm();
    let part = |axis: usize| match momentum[axis] {
        part if part.abs() < rounding => 0.0,
        part => part,
    };
    let [x, y, z] = [0, 1, 2].map(|axis| significant(part(axis), 9));
    format!(
        "axle tilted by {} degrees, L = ({x}, {y}, {z}) J s in the world frame",
        fixed(tilt_deg, 4)
    )
}

/// The coefficients that are there, each with its unit.
fn friction_in_words(friction: &FrictionFile) -> String {
    let terms = [
        ("on the spin", "dry", friction.spin_dry_Nm, "N m"),
        ("on the spin", "viscous", friction.spin_viscous_Nms, "N m s"),
        (
            "on the spin",
            "quadratic",
            friction.spin_quadratic_Nms2,
            "N m s^2",
        ),
        (
            "on the swing",
            "viscous",
            friction.swing_viscous_Nms,
            "N m s",
        ),
    ];
    let there = terms.iter().filter_map(|(of, kind, size, unit)| {
        let size = size.filter(|size| *size != 0.0)?;
        Some(format!("{kind} {of} {} {unit}", shortest(size)))
    });
    let there: Vec<_> = there.collect();
    if there.is_empty() {
        "none".to_owned()
    } else {
        there.join(", ")
    }
}

fn push_in_words(push: &Push, point: &str) -> String {
    let [x, y, z] = [0, 1, 2].map(|axis| shortest(push.force[axis]));
    let when = match push.window {
        Window::Steps { first, count: 1 } => format!("on time step {first}"),
        Window::Steps { first, count } => {
            format!("on {count} time steps from step {first} on")
        }
        Window::Time { from_s, for_s } => {
            format!("from {} s on for {} s", shortest(from_s), shortest(for_s))
        }
    };
    let grows = if push.accumulates {
        ", added anew on each of them and kept to the end"
    } else {
        ""
    };
    format!("({x}, {y}, {z}) N on the point {point} {when}{grows}")
}
