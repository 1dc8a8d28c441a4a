//! Values that follow from several keys of a scenario, and can be set through them. Examples are the size and the tilt
//! of L, and the total mass.

use super::parameters::MOST_LISTED;
use crate::scenario::file::{ScenarioFile, VectorFrame};
use crate::scenario::schema::Nudge;
use crate::scenario::{Scenario, nudge, vector};
use crate::text::number::{rounded, shortest};
use nalgebra::Vector3;
use toml::{Table, Value};

/// Number of digits of an angle. Further digits are rounding errors.
const ANGLE_DIGITS: usize = 13;

/// A value that does not have a key of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DerivedValue {
    /// |L| at the start; L keeps its direction.
    MomentumSize,
    /// Angle of L from +z at the start; |L| and the azimuth stay.
    MomentumTilt,
    /// Size of the only push; its direction stays.
    PushSize,
    /// Time at which the only push ends; its beginning stays.
    PushEnd,
    /// Total mass; all masses change by one factor.
    Mass,
    /// Distance of the traced point from the pivot; its direction stays.
    Arm,
}

impl DerivedValue {
    pub const ALL: [Self; 6] = [
        Self::MomentumSize,
        Self::MomentumTilt,
        Self::PushSize,
        Self::PushEnd,
        Self::Mass,
        Self::Arm,
    ];

    /// Returns the name of the value, which begins with the key that it sets.
    pub fn key(self) -> &'static str {
        match self {
            Self::MomentumSize => "start.momentum_Js.size",
            Self::MomentumTilt => "start.momentum_Js.tilt",
            Self::PushSize => "push.0.force_N.size",
            Self::PushEnd => "push.0.end_s",
            Self::Mass => "body.mass_kg",
            Self::Arm => "body.arm_m",
        }
    }

    pub fn label(self) -> &'static str {
        match self {
            Self::MomentumSize => "|L|",
            Self::MomentumTilt => "L tilt",
            Self::PushSize => "push",
            Self::PushEnd => "push end",
            Self::Mass => "mass",
            Self::Arm => "arm",
        }
    }

    pub fn unit(self) -> &'static str {
        match self {
            Self::MomentumSize => "J s",
            Self::MomentumTilt => "deg",
            Self::PushSize => "N",
            Self::PushEnd => "s",
            Self::Mass => "kg",
            Self::Arm => "m",
        }
    }

    pub fn about(self) -> &'static str {
        match self {
            Self::MomentumSize => "size of L at the start, J s; its direction stays",
            Self::MomentumTilt => "angle of L from +z at the start, degrees; its size stays",
            Self::PushSize => "size of the push, N; its direction stays",
            Self::PushEnd => "time at which the push ends, s",
            Self::Mass => "total mass, kg; all masses change by one factor",
            Self::Arm => "distance of the traced point from the pivot, m",
        }
    }

    /// Returns the value in `scenario`. `file` is the scenario's file with its edits applied. `None` if it has no such
    /// value.
    pub fn number(self, file: &ScenarioFile, scenario: &Scenario) -> Option<f64> {
        let momentum = &scenario.start.momentum;
        match self {
            Self::MomentumSize => Some(momentum.norm()),
            Self::MomentumTilt => {
                let across = libm::hypot(momentum.x, momentum.y);
                let tilt_deg = rounded(libm::atan2(across, momentum.z).to_degrees(), ANGLE_DIGITS);
                (momentum.norm() > 0.0).then_some(tilt_deg)
            }
            Self::PushSize => {
                let [push] = &file.push[..] else { return None };
                Some(Vector3::from(push.force_N).norm())
            }
            Self::PushEnd => push_times_s(file).map(|[_, end_s]| end_s),
            Self::Mass => Some(scenario.body.mechanics.mass()),
            Self::Arm => Some(scenario.arm_m()),
        }
    }

    /// Returns the keys to set so that the value becomes `number`.
    ///
    /// # Errors
    /// Returns why it cannot be set to that number.
    pub fn set(
        self,
        number: f64,
        file: &ScenarioFile,
        scenario: &Scenario,
    ) -> Result<Table, String> {
        let table = match self {
            Self::MomentumSize => {
                not_negative(number)?;
                sized_momentum_table(number, scenario)
            }
            Self::MomentumTilt => momentum_table(tilted_momentum(number, scenario), scenario),
            Self::PushSize => {
                not_negative(number)?;
                let [push] = &file.push[..] else {
                    return Err(NO_PUSH.to_owned());
                };
                let direction = Vector3::from(push.force_N).try_normalize(0.0);
                let force = number * direction.unwrap_or_else(|| -Vector3::z());
                Table::from_iter([("push.0.force_N".to_owned(), vector(&force))])
            }
            Self::PushEnd => push_end_table(number, file)?,
            Self::Mass => mass_table(number, scenario)?,
            Self::Arm => arm_table(number, scenario)?,
        };
        Ok(table)
    }

    /// Returns true if the value can be set in this scenario.
    pub fn is_settable(self, file: &ScenarioFile, scenario: &Scenario) -> bool {
        let number = self.number(file, scenario);
        number.is_some_and(|number| self.set(number, file, scenario).is_ok())
    }

    /// Nudges `number` up `times` times, or down if `times` is negative.
    pub fn nudged(self, number: f64, times: i32) -> f64 {
        let rule = match self {
            Self::MomentumTilt => Nudge::By(1.0),
            Self::MomentumSize | Self::PushSize => Nudge::Hundredth(1.0),
            Self::PushEnd => Nudge::Hundredth(0.1),
            Self::Mass | Self::Arm => Nudge::Hundredth(0.01),
        };
        nudge::number(number, number.abs(), rule, times).unwrap_or(number)
    }

    /// Formats `number` with all its digits, or says that there is none.
    pub fn shown(self, number: Option<f64>) -> String {
        match (self, number) {
            (_, Some(number)) => shortest(number),
            (Self::PushSize, None) => "none".to_owned(),
            (_, None) => "–".to_owned(),
        }
    }
}

const NO_PUSH: &str = "this run has no push to set here: P sets the next push, p gives it";

fn not_negative(number: f64) -> Result<(), String> {
    if number >= 0.0 {
        Ok(())
    } else {
        Err("must be 0 or more".to_owned())
    }
}

fn positive(number: f64) -> Result<(), String> {
    if number > 0.0 {
        Ok(())
    } else {
        Err("must be above 0".to_owned())
    }
}

/// Returns the keys for L with the size `size`, J s, in the direction of L at the start. If L is 0, it is along the
/// axle.
fn sized_momentum_table(size: f64, scenario: &Scenario) -> Table {
    let given = scenario.file.start.momentum_Js.map(Vector3::from);
    if let Some(given) = given.filter(|given| given.norm() > 0.0) {
        return momentum_key(given * (size / given.norm()));
    }
    let direction = scenario.start.momentum.try_normalize(0.0);
    momentum_table(
        size * direction.unwrap_or_else(|| scenario.start.axle()),
        scenario,
    )
}

/// Returns the keys for `momentum` (world frame, J s), converted to the frame of the scenario's file.
fn momentum_table(momentum: Vector3<f64>, scenario: &Scenario) -> Table {
    let start = &scenario.file.start;
    let is_in_body = start.momentum_Js.is_some()
        && start.momentum_frame.unwrap_or_default() == VectorFrame::Body;
    let given = if is_in_body {
        scenario.start.orientation.tr_mul(&momentum)
    } else {
        momentum
    };
    momentum_key(without_rounding(given))
}

fn momentum_key(given: Vector3<f64>) -> Table {
    Table::from_iter([("start.momentum_Js".to_owned(), vector(&given))])
}

/// Returns `vector` with rounding errors in its components replaced by 0.
fn without_rounding(vector: Vector3<f64>) -> Vector3<f64> {
    /// Fraction of the vector's size below which a component is a rounding error.
    const COMPONENT_ROUNDING: f64 = 1e-15;
    let least = COMPONENT_ROUNDING * vector.norm();
    vector.map(|part| if part.abs() <= least { 0.0 } else { part })
}

/// Returns L at the start (world frame, J s), turned about a horizontal axis so that its angle from +z is `tilt_deg`. A
/// vertical L turns to the side to which `start.tilt_deg` turns the axle.
fn tilted_momentum(tilt_deg: f64, scenario: &Scenario) -> Vector3<f64> {
    let momentum = &scenario.start.momentum;
    let aside = Vector3::new(momentum.x, momentum.y, 0.0).try_normalize(0.0);
    let (turn_sin, turn_cos) =
        libm::sincos(scenario.file.start.turn_deg.unwrap_or(0.0).to_radians());
    let horizontal = aside.unwrap_or_else(|| Vector3::new(turn_sin, -turn_cos, 0.0));
    let (sin, cos) = libm::sincos(tilt_deg.to_radians());
    momentum.norm() * (sin * horizontal + cos * Vector3::z())
}

/// Returns the times at which the only push begins and ends, s. `None` if there is no push, or more than one.
fn push_times_s(file: &ScenarioFile) -> Option<[f64; 2]> {
    let [push] = &file.push[..] else { return None };
    if let Some(for_s) = push.for_s {
        let from_s = push.from_s.unwrap_or(0.0);
        return Some([from_s, from_s + for_s]);
    }
    let (first, count) = (push.first_step.unwrap_or(1) - 1, push.steps?);
    let time_step_s = file.motion.time_step_s;
    Some([first, first + count].map(|step| step as f64 * time_step_s))
}

fn push_end_table(end_s: f64, file: &ScenarioFile) -> Result<Table, String> {
    let [begin_s, _] = push_times_s(file).ok_or(NO_PUSH)?;
    let length_s = end_s - begin_s;
    let has_seconds = file.push.iter().any(|push| push.for_s.is_some());
    let steps = (length_s / file.motion.time_step_s).round();
    if !(length_s > 0.0 && (has_seconds || steps >= 1.0)) {
        return Err(format!(
            "must be after the beginning of the push, {} s",
            shortest(begin_s)
        ));
    }
    let (key, value) = if has_seconds {
        ("push.0.for_s", Value::Float(length_s))
    } else {
        ("push.0.steps", Value::Integer(steps as i64))
    };
    Ok(Table::from_iter([(key.to_owned(), value)]))
}

fn mass_table(mass: f64, scenario: &Scenario) -> Result<Table, String> {
    positive(mass)?;
    let factor = mass / scenario.body.mechanics.mass();
    let body = &scenario.file.body;
    if body.point.len().max(body.part.len()) > MOST_LISTED {
        return Err("cannot be set at once: the body has too many points".to_owned());
    }
    let rim = body
        .rim
        .iter()
        .map(|rim| ("body.rim.point_mass_kg".to_owned(), rim.point_mass_kg));
    let points = body.point.iter().enumerate().filter_map(|(index, point)| {
        let mass_kg = point.mass_kg.filter(|mass_kg| *mass_kg > 0.0)?;
        Some((format!("body.point.{index}.mass_kg"), mass_kg))
    });
    let parts = body
        .part
        .iter()
        .enumerate()
        .map(|(index, part)| (format!("body.part.{index}.mass_kg"), part.mass_kg));
    let masses = rim
        .chain(points)
        .chain(parts)
        .map(|(key, mass_kg)| (key, Value::Float(factor * mass_kg)));
    let moments = body.part.iter().enumerate().filter_map(|(index, part)| {
        let moments = Vector3::from(part.moments_kg_m2?);
        Some((
            format!("body.part.{index}.moments_kg_m2"),
            vector(&(factor * moments)),
        ))
    });
    Ok(masses.chain(moments).collect())
}

fn arm_table(arm_m: f64, scenario: &Scenario) -> Result<Table, String> {
    positive(arm_m)?;
    let at = scenario.body.mechanics.points()[scenario.trace].at;
    let place = scenario.trace.checked_sub(scenario.file.body.rim_points());
    let point = place.filter(|place| *place < scenario.file.body.point.len().min(MOST_LISTED));
    let (Some(index), Some(direction)) = (point, at.try_normalize(0.0)) else {
        return Err("cannot be set: the traced point is the center of a part".to_owned());
    };
    let moved = vector(&(arm_m * direction));
    Ok(Table::from_iter([(
        format!("body.point.{index}.at_m"),
        moved,
    )]))
}
