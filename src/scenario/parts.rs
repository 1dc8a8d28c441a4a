//! The parts of a scenario, each from its table in the file: points that exist, an inertia that can be inverted, pushes
//! that say how long they act.

use super::dotted::join;
use super::file::{BodyFile, MotionFile, PushFile};
use super::keys::GRAVITY;
use super::limits::MOST_POINTS;
use super::model::{Body, Motion, Push, Pushes, Window};
use super::problem::{Problem, Problems};
use super::solids;
use crate::physics::{self, BodyError, PointMass, SchemeInfo};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The points that each part counts as, held against the most that there may be.
const OF_PART: usize = 6;

pub(super) fn body(file: &BodyFile) -> Result<Body, Problems> {
    few_enough(file)?;
    let mut points = rim_points(file);
    let mut named = Named::default();
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
        match solids::part(solid) {
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
                "; the rim has 1 point, which leaves all mass on a line: 2 points or more"
            }
            _ => "",
        };
        vec![Problem::at("body", format!("{error}{few}"))]
    })?;
    Ok(Body {
        mechanics,
        parts,
        names: named.names,
    })
}

fn few_enough(file: &BodyFile) -> Result<(), Vec<Problem>> {
    let count = file.rim_points() + file.point.len() + OF_PART * file.part.len();
    if count as i64 <= MOST_POINTS {
        return Ok(());
    }
    let parts = file.part.first();
    let of_parts = parts.map_or("", |_| ", six for each part");
    let rule = format!("has {count} points{of_parts}; at most {MOST_POINTS} are allowed");
    Err(vec![Problem::at("body", rule)])
}

/// The names of points and parts as they are found, each with the index of its point, and what is wrong with them.
#[derive(Default)]
struct Named {
    names: HashMap<String, usize>,
    problems: Problems,
}

impl Named {
    /// Names the point `point`; the name stands in the table of this kind, `point` or `part`, with this index.
    fn add(&mut self, name: &str, point: usize, kind: &str, index: usize) {
        if self.names.insert(name.to_owned(), point).is_some() {
            self.problems.add(|| {
                let value = toml::Value::String(name.to_owned());
                let key = format!("body.{kind}.{index}.name");
                let rule = match kind {
                    "point" => "is the name of another point too: each needs its own",
                    _ => "is the name of a point, or of another part, too: each needs its own",
                };
                Problem::with_value(key, &value, rule)
            });
        }
    }

    /// What is wrong with the part of this index, whose keys are those in its table.
    fn refuse(&mut self, problems: Vec<Problem>, index: usize) {
        for problem in problems {
            let key = join(&format!("body.part.{index}"), &problem.key);
            let key = key.trim_end_matches('.').to_owned();
            self.problems.add(|| Problem { key, ..problem });
        }
    }
}

fn rim_points(file: &BodyFile) -> Vec<PointMass> {
    let Some(rim) = &file.rim else {
        return Vec::new();
    };
    let point = |j: usize| {
        let (sin, cos) = libm::sincos(TAU * j as f64 / rim.points as f64);
        let at = Vector3::new(rim.radius_m * cos, rim.radius_m * sin, rim.height_m);
        PointMass {
            at,
            mass: rim.point_mass_kg,
        }
    };
    (0..rim.points).map(point).collect()
}

pub(super) fn motion(file: &MotionFile) -> Motion {
    let named = file.scheme.as_deref().and_then(SchemeInfo::find);
    Motion {
        gravity: file.gravity_m_per_s2.unwrap_or(GRAVITY),
        scheme: named.unwrap_or(&physics::scheme::SCHEMES[0]), // an unknown name has been refused by the keys
        time_step_s: file.time_step_s,
    }
}

pub(super) fn pushes(files: &[PushFile], body: &Body) -> Result<Pushes, Problems> {
    let mut found = Problems::default();
    let pushes = files.iter().enumerate().filter_map(|(index, file)| {
        // The nearest name is sought for those that are told alone: there may be 100 000 points.
        if found.is_full() && body.point(&file.point).is_none() {
            found.more += 1;
            return None;
        }
        found.kept(push(file, body, &format!("push.{index}")))
    });
    let pushes = pushes.collect::<Vec<_>>().into();
    found.or(pushes)
}

pub(super) fn push(file: &PushFile, body: &Body, key: &str) -> Result<Push, Problems> {
    let mut problems = Problems::default();
    let point = problems.kept(body.find(&format!("{key}.point"), &file.point));
    let window = problems.kept(window(file, key));
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

/// When the push at `key` acts.
fn window(file: &PushFile, key: &str) -> Result<Window, Vec<Problem>> {
    let rule = match (file.first_step, file.steps, file.from_s, file.for_s) {
        (first, Some(count), None, None) => {
            let first = first.unwrap_or(1);
            return Ok(Window::Steps { first, count });
        }
        (None, None, from, Some(for_s)) if file.accumulates != Some(true) => {
            let from_s = from.unwrap_or(0.0);
            return Ok(Window::Time { from_s, for_s });
        }
        (None, None, _, Some(_)) => {
            "accumulates step by step: give first_step and steps instead of seconds"
        }
        (None, None, Some(_), None) => "does not say for how long: add for_s",
        (Some(_), None, None, None) => "does not say for how long: add steps",
        (None, None, None, None) => "does not say for how long: add steps, or for_s",
        _ => "counts in steps and in seconds: keep first_step and steps, or from_s and for_s",
    };
    Err(vec![Problem::at(key, rule)])
}
