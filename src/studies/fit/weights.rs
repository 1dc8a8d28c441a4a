//! How much each datum counts: by its stated uncertainty, and by those of the settings that it was measured at; or, where
//! nothing is stated, as much as any other.
//!
//! The uncertainty of a setting moves what the model says of its row. To first order that adds to the covariance of the
//! row's data (J. Orear, Am. J. Phys. 50, 912 (1982)); since it depends on the fitted values, it is computed anew at each
//! minimum until nothing changes any more.

use super::levenberg::Stop;
use super::model::{FitProgress, Model, settings};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

#[derive(Clone, Debug)]
pub struct Weights {
    /// One standard uncertainty of each datum less the model, in the datum's unit; of unweighted data all the same.
    pub sigma: Vec<f64>,
    pub are_stated: bool,
    pub count_settings: bool,
    /// A change of each datum that is small and well above rounding, in its unit.
    pub(super) resolution: Vec<f64>,
    /// The data that the same uncertain settings move together.
    together: Vec<Together>,
}

/// Data of one row, and the root of their covariance.
#[derive(Clone, Debug)]
struct Together {
    data: Vec<usize>,
    root: Cholesky<f64, Dyn>,
}

/// By this part of its uncertainty a setting is changed to see what it moves.
const SETTING_CHANGE: f64 = 0.25;
/// The unit of unweighted residuals, of the size of the data, and a small change of them.
const UNWEIGHTED_UNIT: f64 = 1e-6;
const RESIDUAL_CHANGE: f64 = 0.01;
/// The relative change of the uncertainties at which the weights have settled.
const SETTLED_WEIGHTS: f64 = 1e-7;

/// Whether the uncertainties of `model`'s data are stated: of all, or of none.
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
            "{name} has no uncertainty in {}, and others have: give all of them one, in {own}, or none",
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
            "the measured columns have several units ({first}, {other}) and no uncertainties: without these nothing says how much one counts against the other"
        ));
    }
    Ok(false)
}

/// The settings with stated uncertainties, by their places.
fn uncertain_settings(model: &Model) -> impl Iterator<Item = usize> {
    settings(&model.measured.data)
        .iter()
        .enumerate()
        .filter(|(_, setting)| setting.sigmas.iter().any(Option::is_some))
        .map(|(index, _)| index)
}

/// How far each datum moves with one uncertainty of the setting, which is changed up and down, or at the edge of its range
/// only to the one side that is possible.
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
    /// The weights of the data of `model` at the values `p` of its free keys.
    pub fn at(model: &Model, p: &[f64], go_on: FitProgress<'_>) -> Result<Self, Stop> {
        if !are_stated(model).map_err(Stop::Impossible)? {
            return Ok(Self::alike(model));
        }
        let sigmas = model.data.iter().filter_map(|datum| datum.point.sigma);
        let sigma: Vec<f64> = sigmas.collect(); // of all data
        let mut weights = Self {
            resolution: sigma.clone(),
            are_stated: true,
            count_settings: false,
            together: Vec::new(),
            sigma,
        };
        // How far each datum moves with one uncertainty of each setting.
        let settings = uncertain_settings(model);
        let moved = settings
            .map(|setting| moved_by(setting, model, p, go_on))
            .collect::<Result<Vec<_>, _>>()?;
        if !moved.is_empty() {
            weights.add(model, &moved);
        }
        Ok(weights)
    }

    fn alike(model: &Model) -> Self {
        let squares = model.data.iter().map(|datum| datum.point.value.powi(2));
        let size = (squares.sum::<f64>() / model.data.len() as f64).sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        Self {
            sigma: vec![UNWEIGHTED_UNIT * size; model.data.len()],
            resolution: vec![RESIDUAL_CHANGE * size; model.data.len()],
            are_stated: false,
            count_settings: false,
            together: Vec::new(),
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
                self.together.push(Together { data, root });
            }
        }
        for (index, sigma) in self.sigma.iter_mut().enumerate() {
            let added: f64 = moved.iter().map(|moved| moved[index].powi(2)).sum();
            *sigma = (*sigma * *sigma + added).sqrt();
        }
    }

    /// `values`, one a datum, in units in which their uncertainties are 1 and independent.
    pub(super) fn whitened(&self, values: &[f64]) -> DVector<f64> {
        let pairs = values.iter().zip(&self.sigma);
        let mut white =
            DVector::from_iterator(values.len(), pairs.map(|(value, sigma)| value / sigma));
        for together in &self.together {
            let own = together.data.iter().map(|&index| values[index]);
            let own = DVector::from_iterator(together.data.len(), own);
            if let Some(solved) = together.root.l_dirty().solve_lower_triangular(&own) {
                for (&index, value) in together.data.iter().zip(solved.iter()) {
                    white[index] = *value;
                }
            }
        }
        white
    }

    /// The weights at `p`, computed anew; `None` where these have settled.
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
