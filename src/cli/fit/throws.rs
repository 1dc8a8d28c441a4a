//! One free flight of a recording of throws, and the report of its fit.

use super::FitArgs;
use crate::engine::text::number::significant;
use crate::studies::fit::flights::Flight;
use crate::studies::fit::report::FitReport;
use serde::{Serialize, Serializer};
use serde_json::json;
use std::fmt;

/// A free flight of the recording.
pub(super) struct Throw {
    pub number: usize,
    pub of: usize,
    pub flight: Flight,
}

impl Throw {
    /// Returns the command line that fits this flight alone.
    pub fn args(&self, args: &FitArgs) -> FitArgs {
        FitArgs {
            from: Some(self.flight.from_s),
            to: Some(self.flight.to_s),
            flight: None,
            ..args.clone()
        }
    }

    pub fn json(&self) -> serde_json::Value {
        let Flight {
            from_s,
            to_s,
            rows,
            rate,
        } = self.flight;
        json!({
            "number": self.number, "of": self.of, "from_s": from_s, "to_s": to_s, "rows": rows,
            "mean_rate_rad_per_s": rate,
        })
    }
}

impl fmt::Display for Throw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [from_s, to_s] = [self.flight.from_s, self.flight.to_s].map(|it| significant(it, 6));
        let rate = significant(self.flight.rate, 3);
        write!(
            f,
            "flight {} of {}: {from_s} s to {to_s} s, {} rows, mean rate {rate} rad/s",
            self.number, self.of, self.flight.rows
        )
    }
}

/// The report of a fit, with the fitted flight of the recording.
pub(super) struct Thrown<'a> {
    pub report: FitReport<'a>,
    pub throw: Option<&'a Throw>,
}

impl Thrown<'_> {
    pub fn json(&self) -> serde_json::Result<serde_json::Value> {
        let mut json = serde_json::to_value(self.report)?;
        if let Some(throw) = self.throw {
            json["flight"] = throw.json();
        }
        Ok(json)
    }
}

impl fmt::Display for Thrown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(throw) = self.throw {
            writeln!(f, "{throw}")?;
        }
        self.report.fmt(f)
    }
}

impl Serialize for Thrown<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let json = self.json().map_err(serde::ser::Error::custom)?;
        json.serialize(serializer)
    }
}
