//! The values of a scenario as parameters that the lab lists, nudges and lets the user type. Their labels, units,
//! nudges and defaults are in the table of [`keys`](crate::scenario::keys).

use crate::physics::scheme;
use crate::scenario::dotted::{find, join, set_key};
use crate::scenario::file::{BodyFile, ScenarioFile};
use crate::scenario::keys::KEYS;
use crate::scenario::kind::{Range, ValueKind};
use crate::scenario::schema::{LabValue, Nudge, SchemaRow};
use crate::scenario::solids::has_dimension;
use crate::scenario::{Document, Problems, Scenario, float, nudge, start, vector};
use crate::text::number::shortest;
use crate::text::printable::brief;
use nalgebra::Vector3;
use toml::{Table, Value};

pub(super) const MOST_LISTED: usize = 50;

const START_MOMENTUM_KEY: &str = "start.momentum_Js";

#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Dotted key, in the form for `--set`: `start.momentum_Js.2`, `push.0.force_N.0`.
    pub key: String,
    /// Row in the table of keys. A component of a vector has the vector's row.
    pub spec: &'static SchemaRow,
    /// Heading in the list: `scenario`, `body`, `point top`, `part wheel`, `start`, `motion`, `push 0`, `view`. Pushes
    /// and points without a name are numbered from 0, as in their keys.
    pub group: String,
    /// Short name of at most 12 characters.
    pub label: String,
    /// Frame of the value, `world` or `body`, for a component of the start's momentum. `None` for other values.
    pub frame: Option<&'static str>,
    /// Value in the file, or the default if the file has none. Numbers are floats, whole numbers are integers.
    pub value: Value,
    pub is_default: bool,
    /// Words or point names to choose from. Empty if there is no choice.
    pub choices: Vec<String>,
    kind: ValueKind,
    lab: LabValue,
    /// Scale of relative nudges: the absolute value or, for a component, the norm of its vector.
    size: f64,
}

/// Returns all values of the scenario file `table`, in the order of the table of keys. A vector gives three parameters.
/// Each of the first 50 elements of an array of tables gives a group. `scenario` is the scenario of that file, and
/// provides the spin or momentum if the file does not contain it.
pub fn parameters(table: &Table, scenario: &Scenario) -> Vec<Parameter> {
    let mut list = Vec::with_capacity(64);
    for keys in KEYS.chunk_by(|one, next| array_of(one) == array_of(next)) {
        let count = array_of(&keys[0]).map_or(1, |array| length(table, array));
        for index in 0..count {
            for key in keys {
                let place = key.path.replacen('*', &index.to_string(), 1);
                list.extend(parameters_of(key, &place, table, scenario));
            }
        }
    }
    list
}

/// Returns the part of `file` that [`parameters`] lists, as a TOML table. It copies only the first 50 points and parts,
/// so it is fast for large bodies too.
pub fn table_of(file: &ScenarioFile) -> Table {
    let point = file.body.point.iter().take(MOST_LISTED).cloned().collect();
    let part = file.body.part.iter().take(MOST_LISTED).cloned().collect();
    let listed = ScenarioFile {
        title: file.title.clone(),
        about: file.about.clone(),
        source: file.source.clone(),
        trace: file.trace.clone(),
        body: BodyFile {
            rim: file.body.rim.clone(),
            point,
            part,
        },
        start: file.start.clone(),
        motion: file.motion.clone(),
        push: file.push.clone(),
        friction: file.friction,
        view: file.view.clone(),
        ..ScenarioFile::default()
    };
    Table::try_from(&listed).unwrap_or_default() // TOML can write every checked file
}

/// Returns the same as [`table_of`], with the edits of the scenario up to `step`.
pub fn table_at(scenario: &Scenario, step: u64) -> Table {
    let mut table = table_of(&scenario.file);
    let made = scenario.file.edit.iter().filter(|edit| edit.step <= step);
    for (key, value) in made.flat_map(|edit| &edit.set) {
        let _ = set_key(&mut table, key, value.clone()); // checked when the scenario was read
    }
    table
}

/// Returns the same as [`table_at`], as a file.
pub fn file_at(scenario: &Scenario, step: u64) -> ScenarioFile {
    let file = table_at(scenario, step).try_into();
    file.unwrap_or_else(|_: toml::de::Error| scenario.file.clone())
}

/// Returns the checked scenario of `file` with the values of `set`, which have the form of `--set key=value`.
///
/// If the file gives a spin and a key is a component of the momentum, the momentum (world frame) that follows from the
/// spin first replaces it. If the file gives a momentum and a key is `steady`, the spin that follows from it replaces
/// it.
pub fn changed(file: &ScenarioFile, set: &Table) -> Result<Scenario, Problems> {
    let mut document = Document::from_file("scenario", file)?;
    for (key, value) in set {
        document.write(key, value.clone())?;
    }
    document.scenario()
}

fn array_of(key: &SchemaRow) -> Option<&'static str> {
    key.path.split_once(".*.").map(|(array, _)| array)
}

fn length(table: &Table, array: &str) -> usize {
    let elements = find(table, array).and_then(Value::as_array);
    elements.map_or(0, |elements| elements.len().min(MOST_LISTED))
}

fn names(table: &Table, array: &str) -> Vec<String> {
    (0..length(table, array))
        .filter_map(|index| find(table, &format!("{array}.{index}.name"))?.as_str())
        .map(str::to_owned)
        .collect()
}

/// Returns the parameters of one key, at its `place` in `table`: none, one, or the three components of a vector.
fn parameters_of(
    key: &'static SchemaRow,
    place: &str,
    table: &Table,
    scenario: &Scenario,
) -> Vec<Parameter> {
    let Some(lab) = key.lab.filter(|_| is_offered(place, table)) else {
        return Vec::new();
    };
    let written = find(table, place);
    let value = written.cloned();
    let Some(value) = value
        .or_else(|| present(key, place, table, scenario))
        .or_else(|| key.default.map(Value::from))
    else {
        return Vec::new();
    };
    let parameter = Parameter {
        key: place.to_owned(),
        spec: key,
        group: group(place, table),
        label: lab.label.to_owned(),
        frame: (key.path == START_MOMENTUM_KEY).then(|| {
            let frame = scenario.file.start.momentum_frame;
            frame.unwrap_or_default().name()
        }),
        size: size(&value),
        value: as_kind(value, key.kind),
        is_default: written.is_none(),
        choices: choices(key, table, scenario),
        kind: key.kind,
        lab,
    };
    match key.kind {
        ValueKind::Vector => parameter.components(),
        _ => vec![parameter],
    }
}

/// Returns the value that follows from other values if the key at `place` is missing. This is the spin or momentum of a
/// start that is given in another form, or the axis or length of a part.
fn present(key: &SchemaRow, place: &str, table: &Table, scenario: &Scenario) -> Option<Value> {
    let start = &scenario.start;
    match key.path {
        "start.momentum_Js" => Some(vector(&start.momentum)),
        "start.spin_rpm" => Some(start::rpm(scenario.spin_rad_per_s(start)).into()),
        "start.spin_rad_per_s" => Some(scenario.spin_rad_per_s(start).into()),
        "start.precession_rad_per_s" | "start.nutation_rad_per_s" | "start.psi_dot_rad_per_s" => {
            Some(Value::Float(0.0))
        }
        "body.part.*.axis" => Some(vector(&Vector3::z())),
        "body.part.*.length_m" => {
            let shape = find(table, &place.replace("length_m", "shape"))?.as_str()?;
            has_dimension(shape, "length_m").then_some(Value::Float(0.0))
        }
        _ => None,
    }
}

/// Returns true if the key at `place` fits the other keys of its table. A push has its times either in steps or in
/// seconds. An angular velocity and Euler rates are listed only if the file gives them. Only moments that are given
/// have a reference point.
fn is_offered(place: &str, table: &Table) -> bool {
    let Some((inside, name)) = place.rsplit_once('.') else {
        return true;
    };
    let has = |names: &[&str]| {
        let mut keys = names.iter().map(|sibling| join(inside, sibling));
        keys.any(|key| find(table, &key).is_some())
    };
    match (inside.split('.').next(), name) {
        (Some("start"), "omega_rad_per_s" | "omega_frame") => has(&["omega_rad_per_s"]),
        (Some("start"), name) if start::EULER.contains(&name) => has(&start::EULER),
        (Some("body"), "about") => has(&["moments_kg_m2"]),
        (Some("push"), "first_step" | "steps" | "accumulates") => !has(&["from_s", "for_s"]),
        (Some("push"), "from_s" | "for_s") => has(&["from_s", "for_s"]),
        _ => true,
    }
}

fn group(place: &str, table: &Table) -> String {
    let names: Vec<&str> = place.split('.').collect();
    match names[..] {
        [_] => "scenario".to_owned(),
        ["body", kind @ ("point" | "part"), index, ..] => {
            match find(table, &format!("body.{kind}.{index}.name")).and_then(Value::as_str) {
                Some(name) => format!("{kind} {}", brief(name, 40)),
                None => format!("{kind} {index}"),
            }
        }
        ["push", index, ..] => format!("push {index}"),
        _ => names[0].to_owned(),
    }
}

fn choices(key: &SchemaRow, table: &Table, scenario: &Scenario) -> Vec<String> {
    match (key.kind, key.path) {
        (_, "motion.scheme") => {
            let able = scheme::true_to(scenario.friction);
            able.map(|scheme| scheme.name.to_owned()).collect()
        }
        (ValueKind::OneOf(words), _) => words.iter().map(|&word| word.to_owned()).collect(),
        (_, "trace" | "push.*.point") => {
            [names(table, "body.point"), names(table, "body.part")].concat()
        }
        (_, "start.rotor") => names(table, "body.part"),
        _ => Vec::new(),
    }
}

fn size(value: &Value) -> f64 {
    match value {
        Value::Array(items) => items.iter().filter_map(float).fold(0.0, libm::hypot),
        other => float(other).unwrap_or_default().abs(),
    }
}

/// Returns `value` as a float if `kind` is a number. Whole numbers stay integers.
fn as_kind(value: Value, kind: ValueKind) -> Value {
    match (kind, float(&value)) {
        (ValueKind::Number(_), Some(number)) => Value::Float(number),
        _ => value,
    }
}

impl Parameter {
    pub fn unit(&self) -> &'static str {
        self.spec.unit
    }

    /// Formats the value: a number with all its digits, text without quotes and with line ends as `\n`.
    pub fn shown(&self) -> String {
        match &self.value {
            Value::Float(number) => shortest(*number),
            Value::String(text) if self.kind == ValueKind::Paragraph => {
                text.replace('\\', "\\\\").replace('\n', "\\n")
            }
            Value::String(text) => text.clone(),
            other => other.to_string(),
        }
    }

    /// Nudges the value up `times` times, or down if `times` is negative.
    pub fn nudged(&self, times: i32) -> Result<Value, String> {
        let value = match (&self.value, self.lab.nudge) {
            (_, Nudge::Typed) => return Err("is text: type it".to_owned()),
            (Value::Boolean(flag), Nudge::Turn) => Value::Boolean(*flag ^ (times % 2 != 0)),
            (_, Nudge::Turn) => Value::String(self.cycled(times)?),
            (Value::Integer(value), _) => Value::Integer(nudge::whole(*value, times)),
            (value, rule) => {
                let number = float(value);
                let nudged =
                    number.and_then(|number| nudge::number(number, self.size, rule, times));
                Value::Float(nudged.ok_or("cannot be nudged: type it")?)
            }
        };
        self.checked(value)
    }

    /// Returns the choice `times` positions after the present one. The list is cyclic.
    fn cycled(&self, times: i32) -> Result<String, String> {
        let is_now = |choice: &String| Some(choice.as_str()) == self.value.as_str();
        match nudge::cycled(&self.choices, is_now, times) {
            Some(next) if self.choices.len() > 1 || !is_now(next) => Ok(next.clone()),
            _ => Err("has no other choice".to_owned()),
        }
    }

    /// Parses the text that the user typed: a number with or without its unit, a word, true or false, or text.
    pub fn typed(&self, text: &str) -> Result<Value, String> {
        let value = match self.kind {
            ValueKind::Number(_) => Value::Float(nudge::typed(text, self.unit())?),
            ValueKind::Whole(..) => Value::Integer(typed_whole(text)?),
            ValueKind::Flag => Value::Boolean(typed_flag(text)?),
            ValueKind::OneOf(_) | ValueKind::Pane(_) => Value::String(text.trim().to_owned()),
            ValueKind::Paragraph => Value::String(unescaped(text)),
            ValueKind::WholeOr(..) => match typed_whole(text) {
                Ok(whole) => Value::Integer(whole),
                Err(_) => Value::String(text.trim().to_owned()),
            },
            _ => Value::String(text.to_owned()),
        };
        self.checked(value)
    }

    fn checked(&self, value: Value) -> Result<Value, String> {
        self.kind.check(&value).map(|()| value)
    }

    fn components(self) -> Vec<Parameter> {
        let items = self.value.as_array().into_iter().flatten();
        items
            .filter_map(float)
            .zip(["x", "y", "z"])
            .enumerate()
            .map(|(index, (number, axis))| Parameter {
                key: join(&self.key, &format!("{index}")),
                label: format!("{}{axis}", self.label),
                value: Value::Float(number),
                kind: ValueKind::Number(Range::Any),
                ..self.clone()
            })
            .collect()
    }
}

fn typed_whole(text: &str) -> Result<i64, String> {
    /// Largest whole number up to which every whole number is exact as a float.
    const LARGEST_WHOLE_EDIT: f64 = 9e15;
    if let Ok(whole) = text.trim().parse() {
        return Ok(whole);
    }
    let number = nudge::typed(text, "")?;
    if number.fract() == 0.0 && number.abs() <= LARGEST_WHOLE_EDIT {
        Ok(number as i64)
    } else {
        Err("must be a whole number".to_owned())
    }
}

fn typed_flag(text: &str) -> Result<bool, String> {
    match text.trim().to_lowercase().as_str() {
        "true" | "yes" | "on" => Ok(true),
        "false" | "no" | "off" => Ok(false),
        _ => Err("must be true or false".to_owned()),
    }
}

/// Replaces each written `\n` in `text` by a line end, and each `\\` by a backslash.
fn unescaped(text: &str) -> String {
    const BACKSLASH: &str = "\0"; // a temporary mark: no text may contain it
    let with_line_ends = text.replace(r"\\", BACKSLASH).replace(r"\n", "\n");
    with_line_ends.replace(BACKSLASH, r"\")
}
