//! A fit as people read it, and as programs do.

use super::free::shown;
use super::model::Model;
use super::quality::student;
use super::search::{Fit, Fitted};
use super::table::Numbers;
use crate::data::Residual;
use crate::text::number::{NONE, short, shortest, significant, uncertain};
use crate::text::printable::{printable, printable_lines};
use serde::ser::{Serialize, Serializer};
use serde_json::{Value, json};
use std::fmt;

#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    pub fit: &'a Fit,
    pub model: &'a Model,
    /// The scheme of the scenario, where the runs have another.
    pub instead_of: Option<&'static str>,
}

/// Digits of a value whose uncertainty cannot be stated.
const DIGITS: usize = 7;

impl Fitted {
    /// The value with its uncertainty, as people read it: 0.003920(38).
    pub fn stated(&self) -> String {
        let stated = self.sigma.and_then(|sigma| uncertain(self.value, sigma));
        match stated {
            Some(stated) => stated.to_string(),
            None => significant(self.value, DIGITS),
        }
    }

    /// What is to be known of it beside its value; empty where there is nothing.
    fn remark(&self) -> &'static str {
        match (self.is_held, self.sigma) {
            (true, _) => "at its bound",
            (false, None) => "no uncertainty can be stated",
            (false, Some(_)) => "",
        }
    }
}

impl Report<'_> {
    /// What is to be known beside the values, a sentence each.
    fn remarks(&self) -> Vec<String> {
        let other = self.instead_of.map(|own| {
            format!(
                "The fitted runs have the scheme {}; the scenario's own is {own} (--scheme {own} fits the runs of that).",
                self.model.scheme
            )
        });
        let remarks = other.into_iter().chain(self.fit.remarks());
        remarks.chain(self.fit.aliased(self.model)).collect()
    }

    fn keys(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.fit.keys.iter().map(|key| {
            let free = &key.free;
            let bounds = match (free.from.is_finite(), free.to.is_finite()) {
                (false, false) => String::new(),
                _ => format!("{}..{}", shown(free.from), shown(free.to)),
            };
            [
                free.key.clone(),
                key.stated(),
                shortest(free.start),
                bounds,
                key.remark().to_owned(),
            ]
        });
        write_table(f, ["key", "value", "start", "bounds", ""], rows)
    }

    fn correlations(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.fit.keys.len();
        if count < 2 {
            return Ok(());
        }
        writeln!(f, "\nCorrelations, the keys in that order:")?;
        for i in 0..count {
            let cell = |j: usize| match self.fit.solution.correlation(i, j) {
                Some(correlation) => format!("{correlation:>9.4}"),
                None => format!("{NONE:>9}"),
            };
            let cells: String = (0..=i).map(cell).collect();
            writeln!(f, " {cells}")?;
        }
        Ok(())
    }

    fn furthest(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const MOST: usize = 5;
        let mut all: Vec<(usize, &Residual)> = self.fit.residuals.iter().enumerate().collect();
        let size = |residual: &Residual| residual.in_sigmas().unwrap_or(residual.value()).abs();
        all.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
        let rows = all.iter().take(MOST).map(|(index, residual)| {
            let readout = self.model.columns[self.model.data[*index].column].readout;
            let sigmas = residual.in_sigmas();
            [
                (residual.row + 1).to_string(),
                readout.name.to_owned(),
                significant(residual.measured, 6),
                residual.sigma.map(short).unwrap_or_default(),
                significant(residual.model, 6),
                significant(residual.value(), 3),
                sigmas.map_or(String::new(), |sigmas| format!("{sigmas:+.1}")),
            ]
        });
        let head = [
            "row",
            "quantity",
            "measured",
            "sigma",
            "model",
            "residual",
            "in sigmas",
        ];
        match all.len() {
            0..=MOST => writeln!(f, "\nResiduals:")?,
            count => writeln!(
                f,
                "\nThe {MOST} of {count} residuals that are furthest off:"
            )?,
        }
        write_table(f, head, rows)
    }

    fn json(&self) -> Value {
        let (fit, quality) = (self.fit, self.fit.quality);
        let bound = |bound: f64| bound.is_finite().then_some(bound);
        let keys = fit.keys.iter().map(|key| {
            json!({
                "key": key.free.key, "value": key.value, "uncertainty": key.sigma, "start": key.free.start,
                "from": bound(key.free.from), "to": bound(key.free.to), "is_at_bound": key.is_held,
            })
        });
        let each = 0..fit.keys.len();
        let matrix = |cell: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
            let row = |i| each.clone().map(|j| cell(i, j)).collect();
            each.clone().map(row).collect()
        };
        let covariance = matrix(&|i, j| Some(fit.solution.covariance[i][j]? * fit.variance?));
        let alike = fit.solution.alike.iter().map(|alike| {
            let parts = alike.iter().map(|(index, part)| {
                json!({ "key": fit.keys[*index].free.key, "relative_change": part })
            });
            parts.collect::<Vec<_>>()
        });
        let silent = fit.solution.silent.iter();
        let silent = silent.map(|&index| &fit.keys[index].free.key);
        let residuals = fit.residuals.iter().zip(&self.model.data);
        let residuals = residuals.map(|(residual, datum)| {
            let mut row = json!(Numbers::of(residual));
            row["row"] = json!(residual.row + 1);
            row["quantity"] = json!(self.model.columns[datum.column].readout.name);
            row
        });
        let freedom = quality.degrees_of_freedom;
        json!({
            "measured": self.model.measured.origin, "scenario": self.model.title, "scheme": self.model.scheme,
            "keys": keys.collect::<Vec<_>>(),
            "correlation": matrix(&|i, j| fit.solution.correlation(i, j)), "covariance": covariance,
            "chi_squared": quality.chi_squared, "degrees_of_freedom": freedom,
            "chi_squared_per_degree_of_freedom": quality.chi_squared.filter(|_| freedom > 0).map(|sum| sum / freedom as f64),
            "probability": quality.probability, "scatter": quality.scatter,
            "student_factor": quality.scatter.and(fit.variance).map(|_| student(freedom)),
            "fits": quality.fits(), "verdict": fit.sentence(self.model), "remarks": self.remarks(),
            "cannot_be_told_apart": alike.collect::<Vec<_>>(), "no_influence": silent.collect::<Vec<_>>(),
            "residuals": residuals.collect::<Vec<_>>(), "steps": fit.steps,
        })
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quality = self.fit.quality;
        writeln!(
            f,
            "{} in {}, scheme {}: {} values, {} free\n",
            printable(&self.model.measured.origin),
            printable(&self.model.title),
            self.model.scheme,
            self.model.data.len(),
            self.fit.keys.len()
        )?;
        self.keys(f)?;
        self.correlations(f)?;
        self.furthest(f)?;
        writeln!(f)?;
        if let (Some(sum), freedom @ 1..) = (quality.chi_squared, quality.degrees_of_freedom) {
            let each = significant(sum / freedom as f64, 3);
            let probability = quality
                .probability
                .map_or(NONE.to_owned(), |p| significant(p, 2));
            writeln!(
                f,
                "chi^2/degree of freedom: {each}, probability of so much or more: {probability}"
            )?;
        }
        for remark in self.remarks() {
            writeln!(f, "{}", printable_lines(&remark))?;
        }
        f.write_str(&self.fit.sentence(self.model))
    }
}

impl Serialize for Report<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.json().serialize(serializer)
    }
}

/// A head and rows of cells in columns that are as wide as their widest cell.
fn write_table<const N: usize>(
    f: &mut fmt::Formatter<'_>,
    head: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> fmt::Result {
    let rows: Vec<_> = std::iter::once(head.map(str::to_owned))
        .chain(rows)
        .collect();
    let width = |cell: &String| cell.chars().count();
    let widest = |column: usize| rows.iter().map(|row| width(&row[column])).max();
    let widths: Vec<usize> = (0..N).filter_map(widest).collect();
    for row in &rows {
        let cells = row.iter().zip(&widths);
        let cells = cells.map(|(cell, most)| {
            let room = " ".repeat(most - width(cell));
            format!("  {}{room}", printable(cell))
        });
        writeln!(f, "{}", cells.collect::<String>().trim_end())?;
    }
    Ok(())
}
