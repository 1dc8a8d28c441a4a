//! Measured data in a write-up: their file, and how far the run is from them.

use super::{AGAIN, CSV, READOUTS_FILE, RUN_FILE, WRITEUP_PAGE};
use crate::engine::data::compared::{Compared, Sum};
use crate::engine::data::{MeasuredData, RunQuantity, at_times};
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{NOT_AVAILABLE, counted, shortest, significant};
use crate::studies::fit::solution::too_large;
use serde_json::{Value, json};
use std::fmt::{self, Write};
use std::path::Path;
use std::sync::Arc;

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

    /// Writes the section of the page.
    pub(super) fn write(&self, page: &mut String) -> fmt::Result {
        let (sum, name) = (&self.compared.sum, self.name());
        let measured = match sum.points - sum.compared {
            0 => String::new(),
            later => format!(
                " The run ends at {} s, before {later} of them: these are not compared.",
                shortest(self.end_s)
            ),
        };
        writeln!(page, "`{name}` holds {}.{measured}\n", points(sum.points))?;
        writeln!(
            page,
            "| what | compared | chi^2 | with uncertainty | largest, in uncertainties | without uncertainty off by (rms) |"
        )?;
        writeln!(page, "| --- | --- | --- | --- | --- | --- |")?;
        for (column, own) in self.rows() {
            write_row(page, column, own)?;
        }
        if sum.weighed > 0 {
            writeln!(
                page,
                "\nchi^2 of all is {} at {}: the sum of the squares of measured less run, in units of the stated uncertainties. Where \
             the run is right and no value of it was fitted, it is about as large as their number.",
                significant(sum.chi_squared, 4),
                points(sum.weighed)
            )?;
            if let Some(too_large) = too_large(sum.chi_squared, sum.weighed as u64) {
                writeln!(page, "\nBut {too_large}.")?;
            }
        }
        Ok(())
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

fn write_row(page: &mut String, name: &str, own: &Sum) -> fmt::Result {
    let chi_squared = (own.weighed > 0).then(|| significant(own.chi_squared, 4));
    let largest = own.largest.map(|largest| {
        let time_s = significant(largest.time_s, 9);
        format!("{} at {time_s} s", significant(largest.sigmas, 3))
    });
    let scatter = own.scatter.first();
    let rms =
        scatter.map(|(quantity, rms)| format!("{} {}", significant(*rms, 3), quantity.unit()));
    let [chi_squared, largest, rms] =
        [chi_squared, largest, rms].map(|text| text.unwrap_or(NOT_AVAILABLE.to_owned()));
    writeln!(
        page,
        "| `{name}` | {} of {} | {chi_squared} | {} | {largest} | {rms} |",
        own.compared, own.points, own.weighed
    )
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
fn name_of_copy(origin: &str) -> String {
    const OTHERWISE: &str = "measured.csv";
    let stem = Path::new(origin).file_stem().and_then(|stem| stem.to_str());
    let stem = stem.filter(|stem| {
        stem.chars()
            .all(|c| c.is_ascii_alphanumeric() || "._-".contains(c))
            && !stem.starts_with(['-', '.'])
    });
    let name = stem.map(|stem| format!("{stem}.csv"));
    name.filter(|name| ![CSV, RUN_FILE, WRITEUP_PAGE, READOUTS_FILE, AGAIN].contains(&&**name))
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
