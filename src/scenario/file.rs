//! The shape of scenario and run files, as serde reads and writes them. What each key means is in [`super::keys`].

use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A scenario file; with `gyrolab` and any number of edits, a run file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct ScenarioFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gyrolab: Option<String>,
    pub title: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub about: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<String>,
    #[serde(default)]
    pub body: BodyFile,
    pub start: StartFile,
    pub motion: MotionFile,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub push: Vec<PushFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expected: Vec<ExpectedFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edit: Vec<EditFile>,
}

/// `[body]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct BodyFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rim: Option<RimFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub point: Vec<PointFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub part: Vec<PartFile>,
}

/// `[body.rim]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct RimFile {
    pub points: usize,
    pub radius_m: f64,
    pub height_m: f64,
    pub point_mass_kg: f64,
}

/// `[[body.point]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct PointFile {
    pub name: String,
    pub at_m: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
}

/// `[[body.part]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct PartFile {
    pub shape: String,
    pub name: String,
    pub mass_kg: f64,
    pub at_m: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner_radius_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_radius_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size_m: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moments_kg_m2: Option<[f64; 3]>,
}

/// `[start]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct StartFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub momentum_Js: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub momentum_frame: Option<Frame>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rpm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rad_per_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega_rad_per_s: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega_frame: Option<Frame>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotor: Option<String>,
}

/// The frame in which the start's momentum or angular velocity is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    /// As it is: the report's Method 1.
    #[default]
    World,
    /// Turned with the body: the report's Method 2.
    Body,
}

impl Frame {
    /// Its name, as a file has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Body => "body",
        }
    }
}

/// `[motion]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct MotionFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity_m_per_s2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scheme: Option<String>,
    pub time_step_s: f64,
    pub steps: u64,
}

/// `[[push]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct PushFile {
    pub point: String,
    pub force_N: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_step: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub for_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accumulates: Option<bool>,
}

/// `[friction]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "keys carry their unit as it is written")]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct FrictionFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_dry_Nm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_viscous_Nms: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_quadratic_Nms2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub swing_viscous_Nms: Option<f64>,
}

/// `[view]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct ViewFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look_at: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_s: Option<f64>,
    /// Length of time that the strip of the fast motion shows, s.
    pub detail_s: Option<f64>,
    pub detail_of: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub show: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hide: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fill: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<Choice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sum_to: Option<Choice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bare: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residuals: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<ZoomFile>,
}

/// A whole number or a word.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Choice {
    /// The number.
    Number(u64),
    /// The word.
    Word(String),
}

/// `[view.camera]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct CameraFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_deg: Option<f64>,
}

/// `[view.zoom]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct ZoomFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above: Option<f64>,
    #[serde(rename = "3d", skip_serializing_if = "Option::is_none")]
    pub three_d: Option<f64>,
}

/// `[[expected]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct ExpectedFile {
    pub readout: String,
    pub at_step: u64,
    pub value: f64,
    pub tolerance: f64,
}

/// `[[edit]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the table of keys says what each key means")]
pub struct EditFile {
    pub step: u64,
    pub set: Arc<toml::Table>,
}
