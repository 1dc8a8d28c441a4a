//! Measured data in a write-up: their file, and how far the run is from them.

use super::fit::FIT_CSV;
use super::page::MEASURED_TABLE;
use super::{AGAIN, CSV};
use crate::engine::data::compared::{Compared, Sum};
use crate::engine::data::{MeasuredData, RunQuantity, at_times};
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{counted, shortest, significant};
use crate::report::document::{Column, Document, Text, escape, quantity};
use crate::studies::fit::solution::too_large;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// In a cell for which there is nothing: no value of this column has, or lacks, an uncertainty.
const NOTHING: &str = "–";

#[derive(Clone, Debug)]
pub struct MeasuredComparison {
    /// The data; their origin is the name of their copy in the folder.
    pub measured: Arc<MeasuredData>,
    /// What the run says of those that it reached: of each column a value for every point.
    pub said: Vec<Vec<f64>>,
    pub compared: Compared,
    pub end_s: f64,
}

impl MeasuredComparison {
    /// `measured` before the comparison with a run.
    pub fn new(measured: MeasuredData) -> Self {
        Self {
            measured: Arc::new(MeasuredData {
                origin: name_of_copy(&measured.origin),
                ..measured
            }),
            said: Vec::new(),
            compared: Compared::default(),
            end_s: 0.0,
        }
    }

    pub fn name(&self) -> &str {
        &self.measured.origin
    }

    /// Holds the data against the run of `scenario` up to `end_s`, the last time at which its numbers are finite. Returns
    /// false where `go_on` said no on the way.
    ///
    /// # Errors
    /// Where the data are a table of runs: what to do with it.
    pub fn hold(
        &mut self,
        scenario: &Arc<Scenario>,
        end_s: f64,
        go_on: &dyn Fn() -> bool,
    ) -> Result<bool, String> {
        self.end_s = end_s;
        let reached = self.reached();
        let series = reached.series().map_err(|error| error.to_string())?;
        let values = at_times(series, scenario, go_on);
        let Some(values) = values.map_err(|error| error.to_string())? else {
            return Ok(false);
        };
        let traced = scenario.body.mechanics.points()[scenario.trace].at;
        let whole = self.measured.series().map_err(|e| e.to_string())?;
        self.compared = Compared::new(whole, &values, end_s, &traced);
        self.said = values;
        Ok(true)
    }

    /// The data that were measured before the end of the run.
    pub(super) fn reached(&self) -> Arc<MeasuredData> {
        Arc::new(MeasuredData::clone(&self.measured).until(Some(self.end_s)))
    }

    /// What was measured, with how far the run is from it, one row a column.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&'static str, &Sum)> {
        let series = self.measured.series();
        let curves = series.map(|series| series.curves.as_slice());
        let names = curves.unwrap_or_default().iter();
        names
            .map(|curve| curve.quantity.name)
            .zip(&self.compared.sums)
    }

    /// Adds the table of the measured quantities, and how well the run agrees with them.
    pub(super) fn add_to(&self, document: &mut Document) {
        let sum = &self.compared.sum;
        let later = match sum.points - sum.compared {
            0 => String::new(),
            later => format!(
                " The run ends at {}, before {later} of them: these are not compared.",
                quantity(&shortest(self.end_s), "s")
            ),
        };
        let (name, points) = (self.name(), points(sum.points));
        document.paragraph(&format!("`{name}` has {points}.{later}"));
        let columns = [
            Column::text("quantity"),
            Column::text("compared"),
            Column::text("with uncertainty"),
            Column::number("$χ^2$"),
            Column::text("largest residual, in uncertainties"),
            Column::text("rms residual of the others"),
        ];
        let caption = "Measured data compared with this run; a residual is measured less run.";
        let rows = self.rows().map(|(column, own)| row(column, own));
        document.labeled_table(MEASURED_TABLE, caption, columns, rows);
        if sum.weighed > 0 {
            document.paragraph(&format!(
                "All of them have $χ^2$ = {} for {} with uncertainties: the sum of the squared residuals in units of the stated uncertainties. If \
                 the run is right and none of its values was fitted, $χ^2$ is about as large as their number.",
                significant(sum.chi_squared, 4),
                self::points(sum.weighed),
            ));
            if let Some(too_large) = too_large(sum.chi_squared, sum.weighed as u64) {
                document.paragraph(&format!("But {}.", escape(&too_large)));
            }
        }
    }

    /// The same for programs.
    pub(super) fn json(&self) -> Value {
        let columns = self.rows().map(|(name, sum)| {
            let mut column = sum_as_json(sum);
            column["name"] = json!(name);
            column["unit"] = json!(RunQuantity::find(name).map_or("", RunQuantity::unit));
            column["rms_without_uncertainty"] =
                json!(sum.scatter.first().map(|(_, scatter)| scatter));
            column
        });
        let mut all = sum_as_json(&self.compared.sum);
        all["file"] = json!(self.name());
        all["columns"] = json!(columns.collect::<Vec<_>>());
        all
    }
}

fn row(name: &str, own: &Sum) -> [Text; 6] {
    let chi_squared = if own.weighed > 0 {
        Text::number(&significant(own.chi_squared, 4))
    } else {
        Text::plain(NOTHING)
    };
    let largest = own.largest.map_or(NOTHING.to_owned(), |largest| {
        let time = quantity(&significant(largest.time_s, 9), "s");
        format!("{} at {time}", significant(largest.sigmas, 3))
    });
    let rms = own.scatter.first();
    let rms = rms.map_or(NOTHING.to_owned(), |(measured, rms)| {
        quantity(&significant(*rms, 3), measured.unit())
    });
    [
        Text::code(name),
        Text::plain(&format!("{} of {}", own.compared, own.points)),
        Text::plain(&own.weighed.to_string()),
        chi_squared,
        Text::marked(&largest),
        Text::marked(&rms),
    ]
}

/// The numbers of `sum`; null where there is none.
fn sum_as_json(sum: &Sum) -> Value {
    json!({
        "points": sum.points, "points_in_run": sum.compared, "points_with_uncertainty": sum.weighed,
        "chi_squared": (sum.weighed > 0).then_some(sum.chi_squared),
        "largest_sigmas": sum.largest.map(|largest| largest.sigmas),
        "largest_at_s": sum.largest.map(|largest| largest.time_s),
    })
}

fn points(count: usize) -> String {
    counted(count as u64, "measured value")
}

/// The name of the copy of the data `origin`: the name of the file, where a shell and Markdown take it as it is and no other
/// file of the folder has it.
pub fn name_of_copy(origin: &str) -> String {
    const OTHERWISE: &str = "measured.csv";
    let stem = Path::new(origin).file_stem().and_then(|stem| stem.to_str());
    let stem = stem.filter(|stem| {
        stem.chars()
            .all(|c| c.is_ascii_alphanumeric() || "._-".contains(c))
            && !stem.starts_with(['-', '.'])
    });
    let name = stem.map(|stem| format!("{stem}.csv"));
    name.filter(|name| ![CSV, AGAIN, FIT_CSV].contains(&&**name))
        .unwrap_or_else(|| OTHERWISE.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_have_plain_unused_names() {
        for (origin, name) in [
            ("bench.csv", "bench.csv"),
            ("../a folder/bench-2.txt", "bench-2.csv"),
            ("heidelberg-spin-decay", "heidelberg-spin-decay.csv"),
            ("old/run.csv", "measured.csv"),
            ("again.csv", "measured.csv"),
            ("our data.csv", "measured.csv"),
            ("-rf.csv", "measured.csv"),
            ("/dev/fd/63", "63.csv"),
        ] {
            assert_eq!(name_of_copy(origin), name, "{origin}");
        }
    }
}
