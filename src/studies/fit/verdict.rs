//! Whether the model fits, in one sentence.

use super::model::Model;
use super::search::Fit;
use super::solution::{LEAST_FREEDOM, Quality, RARE, student, too_large};
use crate::engine::data::{DataKind, MeasuredPoint, is_counted};
use crate::engine::text::number::{short, significant};
use std::collections::BTreeSet;

/// From this chi^2 a degree of freedom on, the search may have ended in a valley that is not the deepest.
const VERY_POOR: f64 = 10.0;
const AS_MANY: &str =
    "Whether the model fits cannot be said: there are as many fitted values as data.";
const ELSEWHERE: &str = " The search goes down from where it begins, and there may be a better fit elsewhere: begin at other values of the free keys by --set KEY=VALUE.";
/// What is said instead where the data depend on no free key.
const NOWHERE: &str =
    " No value of the free keys changes that: free a key on which what was measured depends.";
/// Rows that are off by more than this many uncertainties are named.
const FAR_SIGMAS: f64 = 3.0;
/// Times are even where they are whole multiples of one to this part of it.
const EVEN_TIMES: f64 = 0.01;
/// With more rows than this in a turn, another whole turn between two of them is too far from the fitted rate to be meant.
const MOST_ROWS: f64 = 10.0;
const MOST_FAR_ROWS: usize = 5;
/// From this correlation on, two keys are hardly told apart.
pub(super) const HARDLY: f64 = 0.99;

impl Fit {
    /// Whether the model fits, in one sentence.
    pub fn sentence(&self, model: &Model) -> String {
        let Quality {
            chi_squared,
            degrees_of_freedom: freedom,
            probability,
            ..
        } = self.quality;
        let Some(chi_squared) = chi_squared else {
            return self.of_scatter(model);
        };
        let degrees = match freedom {
            1 => "1 degree of freedom".to_owned(),
            count => format!("{count} degrees of freedom"),
        };
        let sum = format!("chi^2 {} at {degrees}", significant(chi_squared, 3));
        match probability {
            None => AS_MANY.to_owned(),
            Some(probability) if probability < RARE => {
                let elsewhere = if chi_squared <= VERY_POOR * freedom as f64 {
                    ""
                } else if self.solution.silent.len() == self.keys.len() {
                    NOWHERE
                } else {
                    ELSEWHERE
                };
                format!(
                    "The model does not fit: {sum}, which chance gives {}; {}.{elsewhere}",
                    once_in(probability),
                    self.far()
                )
            }
            Some(_) => match too_large(chi_squared, freedom) {
                Some(too_large) => format!("The model fits, but {too_large} ({sum})."),
                None => format!("The model fits: {sum}."),
            },
        }
    }

    fn of_scatter(&self, model: &Model) -> String {
        let unit = model
            .columns
            .first()
            .map_or("", |column| column.readout.unit);
        let freedom = self.quality.degrees_of_freedom;
        match self.quality.scatter {
            Some(scatter) if freedom < LEAST_FREEDOM => format!(
                "Whether the model fits cannot be said, since the data have no uncertainties; nor can uncertainties of the keys: {} too few to tell from their scatter of {} {unit} how good the data are. Measure {LEAST_FREEDOM} more than there are keys at least, or give the data their uncertainties.",
                match freedom {
                    1 => "1 datum more than fitted values is".to_owned(),
                    count => format!("{count} data more than fitted values are"),
                },
                short(scatter)
            ),
            Some(scatter) => format!(
                "Whether the model fits cannot be said, since the data have no uncertainties: they scatter about it by {} {unit}, of which the uncertainties of the keys are made, times {} (Student's factor for {freedom} degrees of freedom).",
                short(scatter),
                significant(student(freedom), 3)
            ),
            None => "Whether the model fits cannot be said: the data have no uncertainties, and there are as many fitted values as data.".to_owned(),
        }
    }

    fn far(&self) -> String {
        let all: Vec<(usize, f64)> = self
            .residuals
            .iter()
            .filter_map(|residual| Some((residual.row + 1, residual.in_sigmas()?.abs())))
            .collect();
        let (mut rows, mut least, mut worst) = (BTreeSet::new(), f64::INFINITY, 0.0_f64);
        for (row, off) in all {
            worst = worst.max(off);
            if off > FAR_SIGMAS {
                rows.insert(row);
                least = least.min(off);
            }
        }
        let [least, worst] = [least, worst].map(|number| significant(number, 2));
        let names = rows.iter().take(MOST_FAR_ROWS).map(ToString::to_string);
        match (&names.collect::<Vec<_>>()[..], rows.len()) {
            ([], _) => match &self.residuals[..] {
                [only] => format!("row {} is {worst} sigma off", only.row + 1),
                _ => format!(
                    "no single row is more than {worst} sigma off, but together they deviate more than chance explains"
                ),
            },
            ([row], _) => format!("row {row} is {worst} sigma off"),
            ([first @ .., last], ..=MOST_FAR_ROWS) => format!(
                "rows {} and {last} are {least} to {worst} sigma off",
                first.join(", ")
            ),
            (first, count) => {
                let (listed, more) = (first.join(", "), count - MOST_FAR_ROWS);
                format!("rows {listed} and {more} more are {least} to {worst} sigma off")
            }
        }
    }

    /// What cannot be told apart, and other things to know about the keys; a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let key = |index: usize| self.keys[index].free.key.as_str();
        let solution = &self.solution;
        let silent = solution.silent.iter().map(|&index| {
            let name = key(index);
            format!("The data do not depend on {name}: they say nothing of it.")
        });
        let alike = solution.alike.iter().map(|alike| {
            let names: Vec<_> = alike.iter().map(|(index, _)| key(*index)).collect();
            let changes = alike
                .iter()
                .map(|(index, part)| self.changed(*index, *part));
            format!(
                "The data cannot tell {} apart: changing {} together changes no measured number.",
                names.join(" and "),
                changes.collect::<Vec<_>>().join(" and ")
            )
        });
        let held = self.edges.iter().map(|edge| edge.remark(&self.keys));
        let pairs = (0..self.keys.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        // Of two keys that one limit holds, each says what the other is.
        let close = pairs.filter(|(i, j): &(usize, usize)| {
            let mut edges = self.edges.iter();
            !edges.any(|edge| edge.holds[*i] && edge.holds[*j])
        }).filter_map(|(i, j)| {
            let correlation = solution.correlation(i, j).filter(|c| c.abs() > HARDLY)?;
            let (one, other) = (key(j), key(i));
            Some(format!(
                "{one} and {other} are hardly told apart: their correlation is {correlation:.4}."
            ))
        });
        let settings = "The uncertainties of the settings count: each datum is weighed by both.";
        let settings = self.weights.count_settings.then(|| settings.to_owned());
        let remarks = silent.chain(alike).chain(held).chain(close);
        remarks.chain(settings).collect()
    }

    /// What is said of an azimuth that was measured as a direction at even times, where the model turns it so far from one
    /// time to the next that other whole turns between them may be the true ones.
    pub(super) fn aliased(&self, model: &Model) -> Option<String> {
        let DataKind::Series(series) = &model.measured.data else {
            return None;
        };
        let column = model
            .columns
            .iter()
            .position(|column| column.quantity.is_some_and(|q| q.is_direction))?;
        let of_column =
            (model.data.iter().zip(&self.residuals)).filter(|(d, _)| d.column == column);
        let (points, at): (Vec<MeasuredPoint>, Vec<[f64; 2]>) = of_column
            .map(|(datum, r)| (datum.point, [series.times_s[datum.point.row], r.model]))
            .unzip();
        let ways: Vec<[f64; 2]> = at
            .windows(2)
            .map(|pair| [0, 1].map(|i| pair[1][i] - pair[0][i]))
            .filter(|[time_s, _]| *time_s > 0.0)
            .collect();
        let apart_s = ways.iter().map(|way| way[0]).reduce(f64::min)?;
        let is_aliased = ways.iter().all(|[time_s, _]: &[f64; 2]| {
            let times = time_s / apart_s;
            (times - times.round()).abs() < EVEN_TIMES
        }) && ways
            .iter()
            .any(|[time_s, way]| (way * apart_s / time_s).abs() > 360.0 / MOST_ROWS)
            && !is_counted(&points);
        is_aliased.then(|| {
            let rate = significant(360.0 / apart_s, 3);
            let apart_s = significant(apart_s, 3);
            format!(
                "The azimuth is a direction, measured at even times, {apart_s} s apart: a precession faster or slower by {rate} deg/s makes whole turns more between them and fits as well. Begin near the right one by --set KEY=VALUE, or measure at uneven times."
            )
        })
    }

    /// A change of the `index`-th key by a part, such as "motion.gravity_m_per_s2 by +1 %".
    fn changed(&self, index: usize, part: f64) -> String {
        let fitted = &self.keys[index];
        let (key, scale) = (&fitted.free.key, fitted.free.scale);
        if fitted.value == 0.0 {
            format!("{key} by {:+.2e}", 0.01 * part * scale)
        } else {
            format!("{key} by {part:+.2} %")
        }
    }
}

fn once_in(probability: f64) -> String {
    match 1.0 / probability {
        times if times < 1e6 => format!("once in {} times", significant(times, 2)),
        times if times.is_finite() => format!("once in {times:.0e} times"),
        _ => "never".to_owned(),
    }
}
