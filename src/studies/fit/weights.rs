//! The weight of each datum.
//!
//! A weight follows from the stated uncertainties of the datum and of the settings in its row. Without stated
//! uncertainties, all data have the same weight.
//!
//! The uncertainty of a setting changes the model's value for its row. To first order this adds to the covariance of
//! the row's data (J. Orear, Am. J. Phys. 50, 912 (1982)). Since it depends on the fitted values, it is recomputed at
//! each minimum until it no longer changes.

use super::levenberg::Stop;
use super::model::{FitProgress, Model, settings};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

#[derive(Clone, Debug)]
pub struct Weights {
    /// One standard uncertainty of each residual, in the datum's unit; equal for all unweighted data.
    pub sigma: Vec<f64>,
    pub are_stated: bool,
    pub count_settings: bool,
    /// A change of each datum that is small but well above rounding, in its unit.
    pub(super) resolution: Vec<f64>,
    /// Groups of data that share uncertain settings.
    correlated: Vec<CorrelatedData>,
}

/// Data of one row, and the Cholesky factor of their covariance matrix.
#[derive(Clone, Debug)]
struct CorrelatedData {
    data: Vec<usize>,
    root: Cholesky<f64, Dyn>,
}

/// Change of a setting, as a fraction of its uncertainty, to find its effect on the data.
const SETTING_CHANGE: f64 = 0.25;
/// Unit of unweighted residuals, and a small change of them, both relative to the size of the data.
const UNWEIGHTED_UNIT: f64 = 1e-6;
const RESIDUAL_CHANGE: f64 = 0.01;
/// Relative change of the uncertainties below which the weights have settled.
const SETTLED_WEIGHTS: f64 = 1e-7;

/// Returns true if all of `model`'s data have uncertainties, false if none has.
///
/// # Errors
/// Returns an error if only some data have uncertainties, or if data without uncertainties have different units.
pub fn are_stated(model: &Model) -> Result<bool, String> {
    let sigmas = model.data.iter().filter_map(|datum| datum.point.sigma);
    let stated = sigmas.count();
    let settings_are_uncertain = uncertain_settings(model).next().is_some();
    if stated == model.data.len() {
        return Ok(true);
    }
    if let Some(datum) = model.data.iter().find(|datum| datum.point.sigma.is_none())
        && (stated > 0 || settings_are_uncertain)
    {
        let name = model.columns[datum.column].readout.name;
        let own = crate::engine::text::unit::with_word(name, "uncertainty");
        return Err(format!(
            "{name} has no uncertainty in {}, but other values do: give all of them one, in {own}, or none",
            model.row(datum.point.row)
        ));
    }
    let mut units = model
        .data
        .iter()
        .map(|datum| model.columns[datum.column].readout.unit);
    let first = units.next().unwrap_or_default();
    if let Some(other) = units.find(|unit| *unit != first) {
        return Err(format!(
            "the measured columns have different units ({first}, {other}) and no uncertainties: give uncertainties so that the columns can be weighted"
        ));
    }
    Ok(false)
}

/// Returns the indices of the settings with stated uncertainties.
fn uncertain_settings(model: &Model) -> impl Iterator<Item = usize> {
    settings(&model.measured.data)
        .iter()
        .enumerate()
        .filter(|(_, setting)| setting.sigmas.iter().any(Option::is_some))
        .map(|(index, _)| index)
}

/// Returns the change of each datum per uncertainty of the setting. The setting is changed up and down; at the edge of
/// its range, only to the possible side.
fn moved_by(
    setting: usize,
    model: &Model,
    p: &[f64],
    go_on: FitProgress<'_>,
) -> Result<Vec<f64>, Stop> {
    let at = |by: f64| model.values(p, Some((setting, by)), go_on);
    let ((high, above), (low, below)) = match (at(SETTING_CHANGE), at(-SETTING_CHANGE)) {
        (Ok(above), Err(Stop::Impossible(_))) => ((SETTING_CHANGE, above), (0.0, at(0.0)?)),
        (Err(Stop::Impossible(_)), Ok(below)) => ((0.0, at(0.0)?), (-SETTING_CHANGE, below)),
        (above, below) => ((SETTING_CHANGE, above?), (-SETTING_CHANGE, below?)),
    };
    let pairs = above.iter().zip(&below);
    Ok(pairs.map(|(up, down)| (up - down) / (high - low)).collect())
}

impl Weights {
    /// Computes the weights of the data of `model` at the values `p` of its free keys.
    pub fn at(model: &Model, p: &[f64], go_on: FitProgress<'_>) -> Result<Self, Stop> {
        if !are_stated(model).map_err(Stop::Impossible)? {
            return Ok(Self::unweighted(model));
        }
        let sigmas = model.data.iter().filter_map(|datum| datum.point.sigma);
        let sigma: Vec<f64> = sigmas.collect(); // all data have one here
        let mut weights = Self {
            resolution: sigma.clone(),
            are_stated: true,
            count_settings: false,
            correlated: Vec::new(),
            sigma,
        };
        let settings = uncertain_settings(model);
        let moved = settings
            .map(|setting| moved_by(setting, model, p, go_on))
            .collect::<Result<Vec<_>, _>>()?;
        if !moved.is_empty() {
            weights.add(model, &moved);
        }
        Ok(weights)
    }

    fn unweighted(model: &Model) -> Self {
        let squares = model.data.iter().map(|datum| datum.point.value.powi(2));
        let size = (squares.sum::<f64>() / model.data.len() as f64).sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        Self {
            sigma: vec![UNWEIGHTED_UNIT * size; model.data.len()],
            resolution: vec![RESIDUAL_CHANGE * size; model.data.len()],
            are_stated: false,
            count_settings: false,
            correlated: Vec::new(),
        }
    }

    fn add(&mut self, model: &Model, moved: &[Vec<f64>]) {
        self.count_settings = true;
        let rows = model.data.iter().map(|datum| datum.point.row).max();
        let mut of_row = vec![Vec::new(); rows.map_or(0, |row| row + 1)];
        for (index, datum) in model.data.iter().enumerate() {
            of_row[datum.point.row].push(index);
        }
        for data in of_row.into_iter().filter(|data| data.len() > 1) {
            let covariance = DMatrix::from_fn(data.len(), data.len(), |i, j| {
                let (a, b) = (data[i], data[j]);
                let own = if i == j { self.sigma[a].powi(2) } else { 0.0 };
                own + moved.iter().map(|moved| moved[a] * moved[b]).sum::<f64>()
            });
            if let Some(root) = Cholesky::new(covariance) {
                self.correlated.push(CorrelatedData { data, root });
            }
        }
        for (index, sigma) in self.sigma.iter_mut().enumerate() {
            let added: f64 = moved.iter().map(|moved| moved[index].powi(2)).sum();
            *sigma = (*sigma * *sigma + added).sqrt();
        }
    }

    /// Returns `values`, one per datum, in units in which their uncertainties are 1 and independent.
    pub(super) fn whitened(&self, values: &[f64]) -> DVector<f64> {
        let pairs = values.iter().zip(&self.sigma);
        let mut white =
            DVector::from_iterator(values.len(), pairs.map(|(value, sigma)| value / sigma));
        for correlated in &self.correlated {
            let own = correlated.data.iter().map(|&index| values[index]);
            let own = DVector::from_iterator(correlated.data.len(), own);
            if let Some(solved) = correlated.root.l_dirty().solve_lower_triangular(&own) {
                for (&index, value) in correlated.data.iter().zip(solved.iter()) {
                    white[index] = *value;
                }
            }
        }
        white
    }

    /// Recomputes the weights at `p`. Returns `None` if they have settled.
    pub(super) fn renewed(
        &self,
        model: &Model,
        p: &[f64],
        go_on: FitProgress<'_>,
    ) -> Result<Option<Self>, Stop> {
        if !self.count_settings {
            return Ok(None);
        }
        let next = Self::at(model, p, go_on)?;
        let pairs = next.sigma.iter().zip(&self.sigma);
        let changes = pairs.map(|(now, before)| (now / before - 1.0).abs());
        Ok((changes.fold(0.0, f64::max) > SETTLED_WEIGHTS).then_some(next))
    }
}
