//! The errors of a comparison, computed again. Its last two columns are times by the wall, which no second run repeats.

use super::lines::Lines;
use super::{Difference, Field, Kind, Verified, What};
use crate::analysis::compare::{self, ComparisonRow};
use crate::analysis::cost::is_affordable;
use crate::physics::SchemeInfo;
use crate::run::Clock;
use crate::scenario::rescale::MOST_STEPS;
use crate::scenario::{Problem, Scenario};
use crate::text::printable::brief;
use std::collections::BTreeMap;
use std::io::Read;
use std::ops::ControlFlow;

/// How the line of names begins in the CSV of a comparison.
pub(super) const FIRST_COLUMNS: &[u8] = b"scheme,time_step_s,";

/// The columns that hold times by the wall.
const WALL: [&str; 2] = ["ns_per_step", "wall_s"];

/// The longest file that is taken as a comparison, bytes.
const LONGEST: u64 = 16 << 20;

/// Holds the rows in `lines` against the comparison of `scenario`.
///
/// # Errors
/// Why it cannot be recomputed; `None` where `watch` stopped it.
pub(super) fn verify<R: Read>(
    scenario: &Scenario,
    mut lines: Lines<R>,
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Result<Verified, Option<Problem>> {
    let whole = |rule: String| Some(Problem::at("", rule));
    if !is_affordable(scenario) {
        let rule = "cannot be recomputed: the exact motion of its run would take too long";
        return Err(whole(rule.to_owned()));
    }
    let there = Table::read(&mut lines).map_err(whole)?;
    let (schemes, time_steps) = there.asked(scenario).map_err(whole)?;
    let rows = compare::compare(scenario, &schemes, &time_steps, watch).ok_or(None)?;
    let wanted = written(&rows).map_err(|error| whole(error.to_string()))?;
    let (rows, difference) = there.held_against(&wanted);
    Ok(Verified {
        kind: Kind::Comparison,
        rows,
        difference,
        written_by: None,
        verdict: String::new(),
        not_finite: None,
    })
}

/// The rows of a comparison as text, each with its line in the file.
struct Table {
    names: Vec<String>,
    rows: Vec<(u64, Vec<String>)>,
}

impl Table {
    fn read<R: Read>(lines: &mut Lines<R>) -> Result<Self, String> {
        let mut table = Self {
            names: Vec::new(),
            rows: Vec::new(),
        };
        let (mut number, mut length) = (0, 0);
        loop {
            number += 1;
            let line = lines
                .next(LONGEST)
                .map_err(|error| format!("cannot be read: {error}"))?;
            length += line.len() as u64;
            if line.is_empty() {
                return Ok(table);
            }
            if length > LONGEST {
                return Err("is longer than any comparison".to_owned());
            }
            let text = String::from_utf8_lossy(line);
            let text = text.trim_start_matches('\u{feff}').trim_end();
            if text.starts_with('#') {
                continue;
            }
            let fields = text.split(',').map(str::to_owned).collect();
            match table.names.is_empty() {
                true => table.names = fields,
                false => table.rows.push((number, fields)),
            }
        }
    }

    /// The schemes and the time steps (s) that were compared.
    fn asked(&self, scenario: &Scenario) -> Result<(Vec<&'static SchemeInfo>, Vec<f64>), String> {
        let mut schemes: Vec<&'static SchemeInfo> = Vec::new();
        let mut time_steps = BTreeMap::new();
        for (line, row) in &self.rows {
            let scheme = row.first().and_then(|name| SchemeInfo::find(name));
            let step = row.get(1).and_then(|step| step.parse::<f64>().ok());
            let step = step.filter(|step| *step > 0.0 && step.is_finite());
            let (Some(scheme), Some(step)) = (scheme, step) else {
                return Err(format!(
                    "cannot be recomputed: line {line} names no scheme and time step"
                ));
            };
            if Clock::end_s(scenario) / step > MOST_STEPS {
                return Err(format!(
                    "cannot be recomputed: line {line} has more time steps than can be counted"
                ));
            }
            if !schemes.iter().any(|known| known.name == scheme.name) {
                schemes.push(scheme);
            }
            time_steps.insert(step.to_bits(), step);
        }
        if schemes.is_empty() {
            return Err("has no rows: there is nothing to verify".to_owned());
        }
        // From coarse to fine, as the order is measured; the bits of positive numbers are in their order.
        Ok((schemes, time_steps.into_values().rev().collect()))
    }

    /// How many rows are the same as `wanted`, whose first row holds the names, and what differs first.
    fn held_against(&self, wanted: &[Vec<String>]) -> (u64, Option<Difference>) {
        let last = self.rows.last().map_or(1, |(line, _)| *line);
        let shown = |row: &[String]| brief(&row.join(","), 60);
        let names = wanted.first().map_or(&[][..], Vec::as_slice);
        if self.names != names {
            let line = self.rows.first().map_or(last, |(line, _)| line - 1);
            let (stands, computed) = (shown(&self.names), shown(names));
            let what = What::Line { stands, computed };
            return (0, Some(Difference { line, what }));
        }
        let computed = wanted.get(1..).unwrap_or_default();
        for (index, row) in computed.iter().enumerate() {
            let Some((line, there)) = self.rows.get(index) else {
                let what = What::Missing {
                    computed: shown(row),
                };
                return (
                    index as u64,
                    Some(Difference {
                        line: last + 1,
                        what,
                    }),
                );
            };
            if let Some(what) = differing(names, there, row) {
                return (index as u64, Some(Difference { line: *line, what }));
            }
        }
        let extra = self.rows.get(computed.len()).map(|(line, row)| Difference {
            line: *line,
            what: What::Extra { stands: shown(row) },
        });
        (computed.len() as u64, extra)
    }
}

/// What differs first between two rows, times by the wall left out.
fn differing(names: &[String], there: &[String], wanted: &[String]) -> Option<What> {
    if there.len() != wanted.len() {
        return Some(What::Line {
            stands: brief(&there.join(","), 60),
            computed: brief(&wanted.join(","), 60),
        });
    }
    let pairs = names.iter().zip(there.iter().zip(wanted));
    let mut pairs = pairs.filter(|(name, _)| !WALL.contains(&name.as_str()));
    let (column, (stands, computed)) = pairs.find(|(_, (stands, computed))| stands != computed)?;
    Some(What::Field(Field {
        row: wanted[..2].join(" "),
        row_name: "scheme and time step".to_owned(),
        column: column.clone(),
        stands: brief(stands, 60),
        computed: computed.clone(),
    }))
}

/// `rows` as they are written, the names first.
fn written(rows: &[ComparisonRow]) -> Result<Vec<Vec<String>>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| writer.serialize(row))?;
    let bytes = writer.into_inner().unwrap_or_default();
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(bytes.as_slice());
    let rows = reader
        .records()
        .map(|record| record.map(|record| record.iter().map(str::to_owned).collect()));
    rows.collect()
}
