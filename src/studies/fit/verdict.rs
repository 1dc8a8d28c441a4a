//! The verdict of a fit in one sentence, and remarks about its keys.

use super::model::Model;
use super::search::Fit;
use super::solution::{LEAST_FREEDOM, Quality, RARE, student, too_large};
use crate::engine::data::{DataKind, MeasuredPoint, is_counted};
use crate::engine::text::number::{short, significant};
use std::collections::BTreeSet;

/// With a chi^2 per degree of freedom above this, the search may have ended in a local minimum.
const VERY_POOR: f64 = 10.0;
const AS_MANY: &str = "The fit cannot be judged: there are as many fitted values as data.";
const ELSEWHERE: &str = " There may be a better fit elsewhere: start the search at other values of the free keys with --set KEY=VALUE.";
/// Replaces [`ELSEWHERE`] if the data depend on no free key.
const NOWHERE: &str =
    " No value of the free keys improves it: free a key that the measured values depend on.";
/// Rows with residuals above this number of uncertainties are named.
const FAR_SIGMAS: f64 = 3.0;
/// Times are evenly spaced if all intervals are multiples of the shortest, within this fraction of it.
const EVEN_TIMES: f64 = 0.01;
/// With more rows per turn than this, an additional turn between two rows is too far from the fitted rate to be
/// plausible.
const MOST_ROWS: f64 = 10.0;
const MOST_FAR_ROWS: usize = 5;
/// Two keys with a correlation above this are difficult to distinguish.
pub(super) const HARDLY: f64 = 0.99;

impl Fit {
    /// Says in one sentence if the model fits.
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
                "The fit cannot be judged, since the data have no uncertainties, and {} too few to estimate them from the scatter of {} {unit}. The keys have no uncertainties either. Measure at least {LEAST_FREEDOM} more values than there are keys, or give the data uncertainties.",
                match freedom {
                    1 => "1 datum more than fitted values is".to_owned(),
                    count => format!("{count} data more than fitted values are"),
                },
                short(scatter)
            ),
            Some(scatter) => format!(
                "The fit cannot be judged, since the data have no uncertainties. They scatter about the model by {} {unit}. The uncertainties of the keys follow from this scatter times {} (Student's factor for {freedom} degrees of freedom).",
                short(scatter),
                significant(student(freedom), 3)
            ),
            None => "The fit cannot be judged: the data have no uncertainties, and there are as many fitted values as data.".to_owned(),
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

    /// Returns remarks on the keys, such as keys that cannot be distinguished, one sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let key = |index: usize| self.keys[index].free.key.as_str();
        let solution = &self.solution;
        let silent = solution.silent.iter().map(|&index| {
            let name = key(index);
            format!("The data do not depend on {name} and cannot determine it.")
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
        // For two keys held by the same limit, one determines the other, so their correlation is not reported.
        let close = pairs.filter(|(i, j): &(usize, usize)| {
            let mut edges = self.edges.iter();
            !edges.any(|edge| edge.holds[*i] && edge.holds[*j])
        }).filter_map(|(i, j)| {
            let correlation = solution.correlation(i, j).filter(|c| c.abs() > HARDLY)?;
            let (one, other) = (key(j), key(i));
            Some(format!(
                "{one} and {other} are difficult to distinguish: their correlation is {correlation:.4}."
            ))
        });
        let settings =
            "Each datum is weighted by its own uncertainty and by those of the settings.";
        let settings = self.weights.count_settings.then(|| settings.to_owned());
        let remarks = silent.chain(alike).chain(held).chain(close);
        remarks.chain(settings).collect()
    }

    /// Returns a warning if an azimuth, measured as a direction at even times, turns so far between rows that another
    /// number of turns would fit as well.
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
                "The azimuth is a direction, measured every {apart_s} s: a precession faster or slower by {rate} deg/s fits as well, because it adds whole turns between the rows. Start near the right value with --set KEY=VALUE, or measure at uneven times."
            )
        })
    }

    /// Describes a relative change of the `index`-th key, such as "motion.gravity_m_per_s2 by +1 %".
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
