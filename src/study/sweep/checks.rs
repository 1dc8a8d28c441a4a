//! What a sweep varies and measures, checked.

use super::axis::Axis;
use super::file::VaryFile;
use crate::analysis::readouts::{self, READOUTS, Readout, Source};
use crate::scenario::Problem;
use crate::scenario::dotted::overlap;
use crate::scenario::start::exclude_each_other;
use toml::Value;

/// The axes that `files` ask for.
pub(super) fn axes(files: &[VaryFile], problems: &mut Vec<Problem>) -> Vec<Axis> {
    let mut axes: Vec<Axis> = Vec::new();
    if files.is_empty() {
        let rule = "is missing: a sweep varies at least one key, by [[vary]] or --vary KEY=A..B:N";
        problems.push(Problem::at("vary", rule));
    }
    for (index, file) in files.iter().enumerate() {
        let place = format!("vary.{index}");
        match Axis::new(file, &place) {
            Ok(axis) => {
                let clashes = |other: &&Axis| {
                    overlap(&other.key, &axis.key) || exclude_each_other(&other.key, &axis.key)
                };
                if let Some(other) = axes.iter().find(clashes) {
                    let rule = if other.key == axis.key {
                        "varies twice".to_owned()
                    } else if exclude_each_other(&other.key, &axis.key) {
                        format!("varies, and so does {}: a start has one of them", other.key)
                    } else {
                        format!("varies, and so does {}, which writes into it", other.key)
                    };
                    problems.push(Problem::at(axis.key.clone(), rule));
                }
                axes.push(axis);
            }
            Err(mut wrong) => problems.append(&mut wrong),
        }
    }
    axes
}

/// The readouts called `names`; without any, every number that is the same each time.
pub(super) fn measured(
    names: Option<&[String]>,
    axes: &[Axis],
    problems: &mut Vec<Problem>,
) -> Vec<&'static Readout> {
    let Some(names) = names else {
        let is_number = |readout: &&Readout| readout.source != Source::Clock && !readout.is_text;
        return READOUTS.iter().filter(is_number).collect();
    };
    if names.is_empty() {
        problems.push(Problem::at("measure", "must name at least one readout"));
    }
    let mut found: Vec<&Readout> = Vec::new();
    for name in names {
        let mut refuse = |rule: &str| {
            let value = Value::String(name.clone());
            problems.push(Problem::with_value("measure", &value, rule));
        };
        match readouts::find(name) {
            None => refuse(&format!("is no readout: {}", readouts::nearest(name))),
            Some(readout) if readout.source == Source::Clock => {
                refuse(
                    "is told by the clock: it is another number each time, and so would be the file",
                );
            }
            Some(readout) if is_found(&found, readout) => refuse("is named twice"),
            Some(readout) if axes.iter().any(|axis| axis.key == readout.name) => {
                refuse("varies, and has its column already");
            }
            Some(readout) => found.push(readout),
        }
    }
    found
}

fn is_found(found: &[&Readout], readout: &Readout) -> bool {
    found.iter().any(|other| other.name == readout.name)
}
