//! The structure of scenario and run files, as serde reads and writes them. The meaning of each key is in
//! [`super::keys`].

use super::dotted::join;
use super::keys::{self, SCENARIO};
use super::kind::{ValueKind, float};
pub use super::solids::PartFile;
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};
use std::ops::{Deref, DerefMut};
use toml::{Table, Value};

/// A scenario file. With `gyrolab` and any number of edits, it is a run file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ScenarioFile {
    pub gyrolab: Option<String>,
    pub title: String,
    pub about: Option<String>,
    pub source: Option<String>,
    pub trace: Option<String>,
    #[serde(default)]
    pub body: BodyFile,
    pub start: StartFile,
    pub motion: MotionFile,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub push: Vec<PushFile>,
    pub friction: Option<FrictionFile>,
    pub view: Option<ViewFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expected: Vec<ExpectedFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edit: Vec<EditFile>,
}

impl ScenarioFile {
    /// Returns the file without its version, its expected results, and its view.
    pub fn bare(self) -> Self {
        Self {
            gyrolab: None,
            expected: Vec::new(),
            view: None,
            ..self
        }
    }

    /// Returns the value of `key` in `[view]`.
    pub fn viewed(&self, key: &str) -> Option<&Value> {
        self.view.as_ref()?.get(key)
    }

    pub fn viewed_text(&self, key: &str) -> Option<&str> {
        self.viewed(key)?.as_str()
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyFile {
    pub rim: Option<RimFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub point: Vec<PointFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub part: Vec<PartFile>,
}

impl BodyFile {
    pub fn rim_points(&self) -> usize {
        self.rim.as_ref().map_or(0, |rim| rim.points)
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RimFile {
    pub points: usize,
    pub radius_m: f64,
    pub height_m: f64,
    pub point_mass_kg: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointFile {
    pub name: String,
    pub at_m: [f64; 3],
    pub mass_kg: Option<f64>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct StartFile {
    pub tilt_deg: Option<f64>,
    pub turn_deg: Option<f64>,
    pub roll_deg: Option<f64>,
    pub momentum_Js: Option<[f64; 3]>,
    pub momentum_frame: Option<VectorFrame>,
    pub spin_rpm: Option<f64>,
    pub spin_rad_per_s: Option<f64>,
    pub steady: Option<bool>,
    pub omega_rad_per_s: Option<[f64; 3]>,
    pub omega_frame: Option<VectorFrame>,
    pub precession_rad_per_s: Option<f64>,
    pub nutation_rad_per_s: Option<f64>,
    pub psi_dot_rad_per_s: Option<f64>,
    pub rotor: Option<String>,
}

/// Frame of the start's momentum or angular velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VectorFrame {
    /// World frame: the report's Method 1.
    #[default]
    World,
    /// Body frame, turned with the body: the report's Method 2.
    Body,
}

impl VectorFrame {
    pub fn name(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Body => "body",
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionFile {
    pub gravity_m_per_s2: Option<f64>,
    pub scheme: Option<String>,
    pub time_step_s: f64,
    pub steps: u64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct PushFile {
    pub point: String,
    pub force_N: [f64; 3],
    pub first_step: Option<u64>,
    pub steps: Option<u64>,
    pub from_s: Option<f64>,
    pub for_s: Option<f64>,
    pub accumulates: Option<bool>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
pub struct FrictionFile {
    pub spin_dry_Nm: Option<f64>,
    pub spin_viscous_Nms: Option<f64>,
    pub spin_quadratic_Nms2: Option<f64>,
    pub swing_viscous_Nms: Option<f64>,
}

/// Keys of `[view]` and their values, as a table. They are written in the order of [`keys::KEYS`].
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(from = "Table")]
pub struct ViewFile(Table);

impl From<Table> for ViewFile {
    /// Converts whole numbers in `table` to floats if their key has the type number.
    fn from(mut table: Table) -> Self {
        make_floats(&mut table, "view");
        Self(table)
    }
}

fn make_floats(table: &mut Table, under: &str) {
    for (name, value) in table {
        let path = join(under, name);
        if let Value::Table(inner) = value {
            make_floats(inner, &path);
        } else if let (Some(number), Ok((_, ValueKind::Number(_)))) =
            (float(value), keys::find(&path))
        {
            *value = Value::Float(number);
        }
    }
}

impl Deref for ViewFile {
    type Target = Table;

    fn deref(&self) -> &Table {
        &self.0
    }
}

impl DerefMut for ViewFile {
    fn deref_mut(&mut self) -> &mut Table {
        &mut self.0
    }
}

impl Serialize for ViewFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        InOrder("view", &self.0).serialize(serializer)
    }
}

/// The table at a dotted path, for writing in the order of [`keys::KEYS`].
struct InOrder<'a>(&'a str, &'a Table);

impl Serialize for InOrder<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(path, table) = self;
        let mut map = serializer.serialize_map(None)?;
        for name in SCENARIO.names(path) {
            match table.get(name) {
                Some(Value::Table(inner)) => {
                    map.serialize_entry(name, &InOrder(&join(path, name), inner))?;
                }
                Some(value) => map.serialize_entry(name, value)?,
                None => {}
            }
        }
        map.end()
    }
}

/// A whole number or a word.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Choice {
    Number(u64),
    Word(String),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExpectedFile {
    pub readout: String,
    pub at_step: u64,
    pub value: f64,
    pub tolerance: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EditFile {
    pub step: u64,
    pub set: Table,
}
