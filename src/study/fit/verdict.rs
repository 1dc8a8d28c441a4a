//! Whether the model fits, in one sentence.

use super::model::{Measurand, Model};
use super::quality::{LEAST_FREEDOM, Quality, RARE, student};
use super::search::Fit;
use crate::measured::{Data, Point, is_counted};
use crate::text::number::{short, significant};

/// From this chi^2 a degree of freedom on, the search may have ended in a valley that is not the deepest.
const VERY_POOR: f64 = 10.0;
const ELSEWHERE: &str = " The search goes down from where it begins, and there may be a better fit elsewhere: begin at other values of the free keys by --set KEY=VALUE.";
/// What is said instead where the data depend on no free key.
const NOWHERE: &str =
    " No value of the free keys changes that: free a key on which what was measured depends.";
/// Rows that are off by more than this many uncertainties are named.
const FAR: f64 = 3.0;
/// Times are even where they are whole multiples of one to this part of it.
const EVEN: f64 = 0.01;
/// With more rows than this in a turn, another whole turn between two of them is too far from the fitted rate to be meant.
const MOST_ROWS: f64 = 10.0;
const MOST_NAMED: usize = 5;
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
            None => {
                "Whether the model fits cannot be said: there are as many fitted values as data"
                    .to_owned()
                    + "."
            }
            Some(probability) if probability < RARE => {
                let is_very_poor = chi_squared > VERY_POOR * freedom as f64;
                let elsewhere = match is_very_poor {
                    false => "",
                    true if self.solution.silent.len() == self.keys.len() => NOWHERE,
                    true => ELSEWHERE,
                };
                format!(
                    "The model does not fit: {sum}, which chance gives {}; {}.{elsewhere}",
                    once_in(probability),
                    self.far()
                )
            }
            Some(probability) if probability > 1.0 - RARE => format!(
                "The model fits, but the uncertainties are too large: {sum}; by their scatter the data are about {} times as good as stated.",
                significant((freedom as f64 / chi_squared).sqrt(), 2)
            ),
            Some(_) => format!("The model fits: {sum}."),
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
        let mut off: Vec<(f64, usize)> = self
            .residuals
            .iter()
            .filter_map(|residual| Some((residual.in_sigmas()?.abs(), residual.row + 1)))
            .collect();
        off.sort_by(|a, b| b.0.total_cmp(&a.0));
        let worst = off.first().map_or(0.0, |(sigmas, _)| *sigmas);
        off.retain(|(sigmas, _)| *sigmas > FAR);
        let mut rows: Vec<usize> = off.iter().map(|(_, row)| *row).collect();
        rows.sort_unstable();
        rows.dedup();
        let more = rows.len().saturating_sub(MOST_NAMED);
        if rows.is_empty() {
            let worst = significant(worst, 2);
            return match &self.residuals[..] {
                [only] => format!("row {} is {worst} sigma off", only.row + 1),
                _ => format!(
                    "no single row is more than {worst} sigma off, but together they deviate more than chance explains"
                ),
            };
        }
        let least = off.last().map_or(0.0, |(sigmas, _)| *sigmas);
        let [least, worst] = [least, worst].map(|sigmas| significant(sigmas, 2));
        let names: Vec<String> = rows
            .iter()
            .take(MOST_NAMED)
            .map(ToString::to_string)
            .collect();
        match (&names[..], more) {
            ([row], _) => format!("row {row} is {worst} sigma off"),
            ([rows @ .., last], 0) => {
                let rows = rows.join(", ");
                format!("rows {rows} and {last} are {least} to {worst} sigma off")
            }
            (rows, more) => {
                let rows = rows.join(", ");
                format!("rows {rows} and {more} more are {least} to {worst} sigma off")
            }
        }
    }

    /// What cannot be told apart, and other things to know about the keys; a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let key = |index: usize| self.keys[index].free.key.as_str();
        let mut remarks = Vec::new();
        for &index in &self.solution.silent {
            remarks.push(format!(
                "The data do not depend on {}: they say nothing of it.",
                key(index)
            ));
        }
        for alike in &self.solution.alike {
            let names: Vec<&str> = alike.iter().map(|(index, _)| key(*index)).collect();
            let changes: Vec<String> = alike
                .iter()
                .map(|(index, part)| self.changed(*index, *part))
                .collect();
            remarks.push(format!(
                "The data cannot tell {} apart: changing {} together changes no measured number.",
                names.join(" and "),
                changes.join(" and ")
            ));
        }
        for (index, fitted) in self
            .keys
            .iter()
            .enumerate()
            .filter(|(_, fitted)| fitted.is_held)
        {
            let bound = significant(fitted.value, 6);
            remarks.push(format!(
                "{} stands at its bound {bound}: the fit would be better beyond it, and it has no uncertainty. Begun at another value by --set, the search may find a better fit within.",
                key(index)
            ));
        }
        for i in 0..self.keys.len() {
            for j in 0..i {
                let correlation = self.solution.correlation(i, j).filter(|c| c.abs() > HARDLY);
                if let Some(correlation) = correlation {
                    remarks.push(format!(
                        "{} and {} are hardly told apart: their correlation is {correlation:.4}.",
                        key(j),
                        key(i)
                    ));
                }
            }
        }
        if self.weights.count_settings {
            remarks.push(
                "The uncertainties of the settings count: each datum is weighed by both."
                    .to_owned(),
            );
        }
        remarks
    }

    /// What is said of an azimuth that was measured as a direction at even times, where the model turns it so far from one
    /// time to the next that other whole turns between them may be the true ones.
    pub(super) fn aliased(&self, model: &Model) -> Option<String> {
        let Data::Series(series) = &model.measured.data else {
            return None;
        };
        let is_direction = |column: &Measurand| column.quantity.is_some_and(|q| q.is_direction);
        let column = model.columns.iter().position(is_direction)?;
        let of_column =
            (model.data.iter().zip(&self.residuals)).filter(|(d, _)| d.column == column);
        let (points, at): (Vec<Point>, Vec<[f64; 2]>) = of_column
            .map(|(datum, r)| (datum.point, [series.times_s[datum.point.row], r.model]))
            .unzip();
        let ways = at
            .windows(2)
            .map(|pair| [0, 1].map(|i| pair[1][i] - pair[0][i]));
        let ways: Vec<[f64; 2]> = ways.filter(|[time_s, _]| *time_s > 0.0).collect();
        let apart_s = ways.iter().map(|way| way[0]).reduce(f64::min)?;
        let is_even = |[time_s, _]: &[f64; 2]| {
            let times = time_s / apart_s;
            (times - times.round()).abs() < EVEN
        };
        let turns = |[time_s, way]: &[f64; 2]| (way * apart_s / time_s).abs() > 360.0 / MOST_ROWS;
        let is_aliased = ways.iter().all(is_even) && ways.iter().any(turns) && !is_counted(&points);
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
        if fitted.value == 0.0 {
            format!(
                "{} by {:+.2e}",
                fitted.free.key,
                0.01 * part * fitted.free.scale
            )
        } else {
            format!("{} by {:+.2} %", fitted.free.key, part)
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
