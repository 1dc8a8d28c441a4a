//! A scenario with checked numbers, from which a run is made.

use super::file::ScenarioFile;
use super::keys::TOP;
use super::problem::{Problem, nearest};
use crate::physics::{self, Friction, PlacedSolid, SchemeInfo, State, observables, part};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// A scenario, or a run with its edits, whose numbers have been checked.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// The file, as it would be written again.
    pub file: ScenarioFile,
    /// The body that turns, with the names of its points.
    pub body: Arc<NamedBody>,
    /// Index of the point whose path is shown.
    pub trace: usize,
    /// Orientation and momentum at t = 0.
    pub start: State,
    pub friction: Friction,
    pub motion: Motion,
    pub steps: u64,
    /// Time step for which its step counts were written, s.
    pub written_for_s: f64,
    pub pushes: Pushes,
    /// Changes by the user during the run, in the order of the steps.
    pub edits: Vec<Edit>,
}

/// The body, its solid parts, and the names of its points.
#[derive(Clone, Debug)]
pub struct NamedBody {
    /// The mechanics. Its points are those of the rim, then the named points, then those of the parts.
    pub mechanics: physics::Body,
    pub parts: Vec<PlacedSolid>,
    pub names: HashMap<String, usize>,
}

/// Gravity, scheme and time step, which edits may change during the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Acceleration of gravity along −z, m/s².
    pub gravity: f64,
    pub scheme: &'static SchemeInfo,
    pub time_step_s: f64,
}

/// A force that acts on one point for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    pub point: usize,
    /// Force, world frame, N.
    pub force: Vector3<f64>,
    pub window: Window,
    /// True for the report's line taken literally: j times the force on its j-th step, and kept to the end.
    pub accumulates: bool,
}

/// Time window of a push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Window {
    /// Acts on `count` steps, beginning with step `first`. Step 1 ends at t = dt.
    Steps { first: u64, count: u64 },
    /// Acts for a length of time from a given time on.
    Time { from_s: f64, for_s: f64 },
}

/// Pushes of a run at one time. Edits that set no push share the list of the previous edit.
pub type Pushes = Arc<Vec<Push>>;

/// A change during the run. It is made at `step` and applies from the next step on.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    pub step: u64,
    /// Gravity, scheme and time step from then on.
    pub motion: Motion,
    pub pushes: Pushes,
    /// Numbers of the pushes that the edit set, each once, in order.
    pub set_pushes: Vec<usize>,
    /// True if the edit set the time step. Steps then count from here with the new length, and pushes keep their times
    /// in seconds.
    pub sets_time_step: bool,
    /// True if the edit set the time step, the scheme or gravity.
    pub begins_segment: bool,
}

impl Scenario {
    /// Returns how the body moves in the first step: what edits before it have made of the file's motion.
    pub fn first_motion(&self) -> &Motion {
        let at_start = self.edits.iter().take_while(|edit| edit.step == 0);
        at_start.last().map_or(&self.motion, |edit| &edit.motion)
    }
}

impl Edit {
    /// Returns the pushes that the edit set, with their new values.
    pub fn pushes_set(&self) -> impl Iterator<Item = &Push> {
        self.set_pushes
            .iter()
            .filter_map(|&place| self.pushes.get(place))
    }
}

impl NamedBody {
    /// Returns the number of points that come before the points of parts.
    pub fn points_before_parts(&self) -> usize {
        self.mechanics.points().len() - part::POINTS_PER_PART * self.parts.len()
    }

    /// Returns the indices of the points of the part with this index.
    pub fn points_of_part(&self, part: usize) -> Range<usize> {
        let first = self.points_before_parts() + part * part::POINTS_PER_PART;
        first..first + part::POINTS_PER_PART
    }

    pub fn point(&self, name: &str) -> Option<usize> {
        self.names.get(name).copied()
    }

    /// Returns the names of the named points, in the order of the body's list.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.names.keys().map(String::as_str).collect();
        names.sort_by_cached_key(|name| self.names[*name]);
        names
    }

    pub(super) fn find(&self, key: &str, name: &str) -> Result<usize, Problem> {
        self.point(name).ok_or_else(|| self.no_point(key, name))
    }

    /// Returns the problem that no point has the `name`, which is the value of `key`.
    pub(super) fn no_point(&self, key: &str, name: &str) -> Problem {
        let near = nearest(name, self.names().into_iter());
        let value = toml::Value::String(name.to_owned());
        Problem::with_value(key, &value, format!("is not a point of this body: {near}"))
    }
}

impl Scenario {
    /// Returns the distance of the traced point from the pivot, m. The error of a run is measured relative to it.
    pub fn arm_m(&self) -> f64 {
        self.body.mechanics.points()[self.trace].at.norm()
    }

    /// Returns true if the point "top" is traced because the file names none.
    pub fn traces_top(&self) -> bool {
        self.file.trace.is_none() && self.body.point(TOP).is_some()
    }

    pub fn traced_name(&self) -> &str {
        let unnamed = if self.traces_top() {
            TOP
        } else {
            "farthest point"
        };
        self.file.trace.as_deref().unwrap_or(unnamed)
    }

    /// Returns the shortest time step of a run, edits included, s.
    pub fn least_time_step_s(&self) -> f64 {
        let (mut least_s, mut since, mut now_s) = (f64::INFINITY, 0, self.motion.time_step_s);
        for edit in &self.edits {
            // No steps lie between edits at the same step.
            if edit.step > since {
                least_s = least_s.min(now_s);
            }
            (since, now_s) = (edit.step, edit.motion.time_step_s);
        }
        least_s.min(now_s)
    }

    /// Returns the rate ω3 at which the body (or only its rotor) spins about the axle in `state`, rad/s.
    pub fn spin_rad_per_s(&self, state: &State) -> f64 {
        let omega = observables::angular_velocity(&self.body.mechanics, state);
        state.axle().dot(&omega)
    }

    /// Returns the name of the point with this index. A point of a part adds its direction from the part's center:
    /// "wheel +x". `None` for a point of the rim.
    pub fn point_name(&self, index: usize) -> Option<String> {
        const OFF_CENTRE: [&str; part::POINTS_PER_PART] =
            ["", " +x", " -x", " +y", " -y", " +z", " -z"];
        let file = &self.file.body;
        if let Some(of_parts) = index.checked_sub(self.body.points_before_parts()) {
            let part = file.part.get(of_parts / part::POINTS_PER_PART)?;
            return Some(part.name.clone() + OFF_CENTRE[of_parts % part::POINTS_PER_PART]);
        }
        let point = file.point.get(index.checked_sub(file.rim_points())?)?;
        Some(point.name.clone())
    }

    /// Returns the index of the part that spins alone, if any.
    pub fn rotor(&self) -> Option<usize> {
        let name = self.file.start.rotor.as_ref()?;
        let parts = &self.file.body.part;
        parts.iter().position(|part| part.name == *name)
    }

    /// Returns the run file: the scenario with its edits and the version of the program. Reading it restores this
    /// scenario.
    pub fn to_toml(&self) -> String {
        let version = Some(env!("CARGO_PKG_VERSION").to_owned());
        let file = ScenarioFile {
            gyrolab: version,
            ..self.file.clone()
        };
        // A checked file contains nothing that TOML cannot write.
        toml::to_string(&file).unwrap_or_default()
    }
}
