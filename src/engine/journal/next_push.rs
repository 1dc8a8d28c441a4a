//! The push that the user prepares: point, force, direction and duration.

use crate::physics::{State, observables};
use crate::scenario::file::PushFile;
use crate::scenario::problem::listed;
use crate::scenario::{Scenario, Window, nudge};
use crate::text::nice_numbers::{at_or_below, climbed};
use crate::text::number::shortest;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Duration of the default push as a fraction of the run, for scenarios without pushes.
const PUSH_DURATION_SHARE: f64 = 0.1;
/// Force of the default push, in weights of the body.
const WEIGHTS: f64 = 2.0;

/// Maximum distance of a point from the vertical, as a fraction of its distance from the pivot, at which "out" has no
/// direction.
const ON_VERTICAL: f64 = 1e-9;

/// Text for the start of a push that acts as soon as it is given.
const NOW_TEXT: &str = "now";

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct NextPush {
    pub point: String,
    pub size_N: f64,
    pub toward: Toward,
    /// Time at which it begins, s; 0 for the time at which it is given.
    #[serde(default)]
    pub from_s: f64,
    pub for_s: f64,
}

/// One of the four values of a [`NextPush`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum PushField {
    Point,
    Size,
    Toward,
    Length,
}

impl PushField {
    pub const ALL: [Self; 4] = [Self::Point, Self::Size, Self::Toward, Self::Length];

    pub fn about(self) -> &'static str {
        match self {
            Self::Point => "the name of a point of the body",
            Self::Size => "how hard, in N",
            Self::Toward => {
                "down, up, out or in (from the vertical), around or back, +x, -x, +y, -y, or three numbers"
            }
            Self::Length => {
                "duration in s, or in steps (20 steps); 0.3 from 2 lasts 0.3 s and begins at 2 s"
            }
        }
    }

    /// Returns label and unit of the field. The unit may be empty.
    pub fn label(self) -> (&'static str, &'static str) {
        match self {
            Self::Point => ("point", ""),
            Self::Size => ("force", "N"),
            Self::Toward => ("toward", ""),
            Self::Length => ("for", "s"),
        }
    }
}

impl NextPush {
    /// Returns the first push of `scenario`. If it has none, returns a default push that visibly moves its body.
    pub fn suggested_for(scenario: &Scenario) -> Self {
        let own = scenario.file.push.first().zip(scenario.pushes.first());
        let Some((file, push)) = own.filter(|(_, push)| push.force.norm() > 0.0) else {
            return Self::default_for(scenario);
        };
        let size = push.force.norm();
        let unit = push.force / size;
        let mut named = Toward::NAMED.into_iter().map(|(_, toward)| toward);
        let same = named.find(|toward| toward.direction(&Vector3::zeros()) == Ok(unit));
        Self {
            point: file.point.clone(),
            size_N: size,
            toward: same.unwrap_or(Toward::Along(unit.into())),
            from_s: 0.0,
            for_s: match push.window {
                Window::Steps { count, .. } => count as f64 * scenario.written_for_s,
                Window::Time { for_s, .. } => for_s,
            },
        }
    }

    /// Returns a downward push of two weights on the traced point, for a tenth of the run.
    fn default_for(scenario: &Scenario) -> Self {
        let body = &scenario.body.mechanics;
        let weight = body.mass() * scenario.motion.gravity.abs().max(1.0);
        let length_s = scenario.steps as f64 * scenario.motion.time_step_s;
        let names = scenario.body.names();
        let mut points = names.iter();
        let traced = points.find(|name| scenario.body.point(name) == Some(scenario.trace));
        let point = traced.or(names.first());
        Self {
            point: point.copied().unwrap_or_default().to_owned(),
            size_N: at_or_below(WEIGHTS * weight),
            toward: Toward::Down,
            from_s: 0.0,
            for_s: at_or_below(PUSH_DURATION_SHARE * length_s),
        }
    }

    /// Returns the same push. If the body of `scenario` has no point of this name, the push acts on the default point.
    pub fn suited_to(self, scenario: &Scenario) -> Self {
        if scenario.body.point(&self.point).is_some() {
            return self;
        }
        let point = Self::default_for(scenario).point;
        Self { point, ..self }
    }

    /// Formats the value of `field` as text that [`typed`](Self::typed) can parse.
    pub fn shown(&self, field: PushField) -> String {
        match field {
            PushField::Point => self.point.clone(),
            PushField::Size => shortest(self.size_N),
            PushField::Toward => self.toward.shown(),
            PushField::Length if self.from_s > 0.0 => {
                format!("{} from {}", shortest(self.for_s), shortest(self.from_s))
            }
            PushField::Length => shortest(self.for_s),
        }
    }

    /// Returns the push with `field` nudged up `times` times, or down if `times` is negative.
    pub fn nudged(
        &self,
        field: PushField,
        times: i32,
        scenario: &Scenario,
    ) -> Result<Self, String> {
        let mut next = self.clone();
        match field {
            PushField::Point => {
                let names = scenario.body.names();
                let point = nudge::cycled(&names, |name| **name == *self.point, times);
                next.point = point.copied().unwrap_or_default().to_owned();
            }
            PushField::Toward => {
                let toward =
                    nudge::cycled(&Toward::NAMED, |(_, toward)| *toward == self.toward, times);
                next.toward = toward.map_or(self.toward, |(_, toward)| *toward);
            }
            PushField::Size => next.size_N = climbed(self.size_N, times),
            PushField::Length => next.for_s = climbed(self.for_s, times),
        }
        next.checked()
    }

    /// Parses the text that the user typed for `field`, and returns the push with this value. A duration in steps is
    /// converted with `time_step_s` (s).
    pub fn typed(
        &self,
        field: PushField,
        text: &str,
        scenario: &Scenario,
        time_step_s: f64,
    ) -> Result<Self, String> {
        let (label, unit) = field.label();
        let number =
            |typed| nudge::typed(typed, unit).map_err(|reason| format!("{label} {reason}"));
        let mut next = self.clone();
        match field {
            PushField::Point => {
                let point = text.trim();
                scenario.body.point(point).ok_or_else(|| {
                    let names = listed(scenario.body.names().into_iter());
                    format!("{label} must be one of {names}")
                })?;
                next.point = point.to_owned();
            }
            PushField::Size => next.size_N = number(text)?,
            PushField::Toward => next.toward = Toward::typed(text)?,
            PushField::Length => {
                let (length, from) = text.split_once("from").unwrap_or((text, NOW_TEXT));
                next.for_s = match length.trim().split_once(" step") {
                    Some((steps, _)) => nudge::typed(steps, "")? * time_step_s,
                    None => number(length)?,
                };
                next.from_s = match from.trim() {
                    NOW_TEXT => 0.0,
                    from => number(from)?,
                }
            }
        }
        next.checked()
    }

    /// Returns the push if its force and duration are positive and finite.
    pub fn checked(self) -> Result<Self, String> {
        let is_valid = |number: f64| number > 0.0 && number.is_finite();
        if !is_valid(self.size_N) {
            return Err(
                "force must be greater than zero: reverse it with the direction".to_owned(),
            );
        }
        if self.from_s != 0.0 && !is_valid(self.from_s) {
            return Err("must begin at a time of the run, 0 s or later, or now".to_owned());
        }
        if !is_valid(self.for_s) {
            return Err("must last longer than zero".to_owned());
        }
        Ok(self)
    }

    /// Returns the push as a table of a run file, which begins no earlier than the time of `state`. Its times are in
    /// seconds, so that an edit of the time step does not change its duration.
    pub fn given(&self, scenario: &Scenario, state: &State) -> Result<PushFile, String> {
        let body = &scenario.body;
        let point = body
            .point(&self.point)
            .ok_or("this body has no named point to push: add a [[body.point]]")?;
        let at = observables::position(&body.mechanics, state, point);
        let (from_s, now_s) = (self.from_s, state.time_s);
        if 0.0 < from_s && from_s < now_s {
            let [from, now] = [from_s, now_s].map(shortest);
            return Err(format!(
                "the push begins at {from} s, but the run is at {now} s: first go there with r, or with g and {from} s"
            ));
        }
        let force = self.size_N * self.toward.direction(&at)?;
        Ok(PushFile {
            point: self.point.clone(),
            force_N: force.map(|component| component + 0.0).into(), // no -0
            from_s: Some(from_s.max(now_s)),
            for_s: Some(self.for_s),
            ..PushFile::default()
        })
    }

    pub fn in_words(&self) -> String {
        let [point, size, toward, length] = PushField::ALL.map(|field| self.shown(field));
        format!("{size} N on {point}, {toward}, for {length} s")
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Toward {
    /// −z, the direction of the weight.
    Down,
    /// +z.
    Up,
    /// Horizontally away from the vertical through the pivot.
    Out,
    In,
    /// Horizontally around that vertical, counterclockwise seen from above.
    Around,
    /// Horizontally around that vertical, clockwise seen from above.
    Back,
    /// A direction in the world frame.
    Along([f64; 3]),
}

impl TryFrom<String> for Toward {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Self::typed(&text)
    }
}

impl From<Toward> for String {
    fn from(toward: Toward) -> Self {
        toward.shown()
    }
}

impl Toward {
    const NAMED: [(&'static str, Self); 10] = [
        ("down", Self::Down),
        ("up", Self::Up),
        ("out", Self::Out),
        ("in", Self::In),
        ("around", Self::Around),
        ("back", Self::Back),
        ("+x", Self::Along([1.0, 0.0, 0.0])),
        ("-x", Self::Along([-1.0, 0.0, 0.0])),
        ("+y", Self::Along([0.0, 1.0, 0.0])),
        ("-y", Self::Along([0.0, -1.0, 0.0])),
    ];

    /// Formats the direction as text that [`typed`](Self::typed) can parse.
    pub fn shown(self) -> String {
        let named = Self::NAMED.iter().find(|(_, toward)| *toward == self);
        match (named, self) {
            (Some((name, _)), _) => (*name).to_owned(),
            (None, Self::Along(direction)) => direction.map(shortest).join(" "),
            (None, _) => String::new(),
        }
    }

    /// Parses a direction: a name, or three numbers.
    pub fn typed(text: &str) -> Result<Self, String> {
        let written = text.trim().trim_matches(['[', ']']);
        if let Some((_, toward)) = Self::NAMED.iter().find(|(name, _)| *name == written) {
            return Ok(*toward);
        }
        let numbers: Vec<f64> = written
            .split([' ', ','])
            .filter(|part| !part.is_empty())
            .map_while(|part| part.parse().ok().filter(|number: &f64| number.is_finite()))
            .collect();
        match <[f64; 3]>::try_from(numbers) {
            Ok(direction) if Vector3::from(direction).norm() > 0.0 => Ok(Self::Along(direction)),
            _ => {
                let names = Self::NAMED.map(|(name, _)| name).join(", ");
                Err(format!("toward must be one of {names}, or three numbers"))
            }
        }
    }

    /// Returns the direction as a unit vector, world frame, for a point at `at` (world frame, m).
    fn direction(self, at: &Vector3<f64>) -> Result<Vector3<f64>, String> {
        let out = Vector3::new(at.x, at.y, 0.0);
        let around = Vector3::new(-at.y, at.x, 0.0);
        let direction = match self {
            Self::Down => -Vector3::z(),
            Self::Up => Vector3::z(),
            Self::Along(direction) => Vector3::from(direction),
            _ if out.norm() <= ON_VERTICAL * at.norm() => {
                return Err(
                    "the point is on the vertical, where out has no direction: push along x or y"
                        .to_owned(),
                );
            }
            Self::Out => out,
            Self::In => -out,
            Self::Around => around,
            Self::Back => -around,
        };
        direction
            .try_normalize(0.0)
            .ok_or_else(|| "the push needs a direction".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    fn scenario(name: &str) -> Scenario {
        Document::open(name).unwrap().scenario().unwrap()
    }

    #[test]
    fn the_suggested_push_is_the_scenarios_own_or_a_strong_one() {
        let own = NextPush::suggested_for(&scenario("wobble-push"));
        assert_eq!(own.in_words(), "100 N on top, down, for 20 s");
        let default = NextPush::suggested_for(&scenario("method-2"));
        assert!(default.in_words().contains("N on top, down, for "));
        assert!(default.size_N >= 49.0 && default.for_s > 0.0, "{default:?}");
    }

    #[test]
    fn shown_values_parse_and_invalid_ones_are_rejected() {
        let scenario = scenario("method-2");
        let push = NextPush::suggested_for(&scenario);
        for field in PushField::ALL {
            assert_eq!(
                push.typed(field, &push.shown(field), &scenario, 0.1),
                Ok(push.clone())
            );
            let nudged = push.nudged(field, 1, &scenario).unwrap();
            let back = nudged.nudged(field, -1, &scenario).unwrap();
            assert_eq!(back, push, "{field:?}");
        }
        for (field, text) in [
            (PushField::Size, "-3"),
            (PushField::Size, "0"),
            (PushField::Length, "0"),
            (PushField::Length, "nan"),
            (PushField::Point, "hub 7"),
        ] {
            assert!(push.typed(field, text, &scenario, 0.1).is_err(), "{text}");
        }
        let typed = push.typed(PushField::Length, "20 steps", &scenario, 0.1);
        assert_eq!(typed.unwrap().for_s, 2.0);
    }

    #[test]
    fn named_directions_are_unit_vectors() {
        let at = Vector3::new(3.0, 4.0, 1.0);
        for (name, toward) in Toward::NAMED {
            let direction = toward.direction(&at).unwrap();
            assert!((direction.norm() - 1.0).abs() < 1e-15, "{name}");
            assert_eq!(Toward::typed(name), Ok(toward));
        }
        let out = Toward::Out.direction(&at).unwrap();
        assert_eq!(out, Vector3::new(0.6, 0.8, 0.0));
        let around = Toward::Around.direction(&at).unwrap();
        assert!(around.dot(&Vector3::new(-0.8, 0.6, 0.0)) > 0.999);
        assert!(Toward::Out.direction(&Vector3::z()).is_err());
        let along = Toward::Along([1.0, -2.0, 0.5]);
        assert_eq!(Toward::typed("[1, -2, 0.5]"), Ok(along));
        for bad in ["", "sideways", "1 2", "1 2 3 4", "0 0 0", "nan 0 0"] {
            assert!(Toward::typed(bad).is_err(), "{bad}");
        }
    }
}
