//! The limits at which a search has ended, and the uncertainty inside them.
//!
//! Beyond such a limit the fit would be better. At the limit the distance s is 0, but the data prefer a negative s:
//! their normal distribution of s has its mean outside. Only the part with s > 0 is possible. The upper limit of s at
//! 68 % is the value below which 68.27 % of this part lies, if all s > 0 were equally likely before the measurement.
//!
//! This upper limit is never 0. It contains the true value at least as often as stated, because experiments that find s
//! above 0 are reported in the usual way.

use super::chart::{Chart, Rule, moment};
use super::fitted::Fitted;
use super::free::Free;
use super::levenberg::{Minimum, SINGULAR};
use super::solution::COMBINATION_ROUNDING;
use super::within::complement;
use crate::engine::text::number::significant;
use nalgebra::DVector;
use serde_json::{Value, json};

/// A limit that holds keys.
#[derive(Clone, Debug)]
pub struct Edge {
    pub rule: Rule,
    /// True for a physical limit, false for a bound set by the user.
    pub is_of_nature: bool,
    /// True for each key that the limit holds.
    pub holds: Vec<bool>,
    /// Change of each key per unit of distance from the limit, with the other active limits held.
    pub moves: Vec<f64>,
    /// Upper limit of the distance. `None` if the user set the bound, which says nothing physical, or if the data do
    /// not determine the distance.
    pub most: Option<Most>,
    /// The moment to compare the distance with, kg m^2: for a flat body the moment about its normal, for a rod a moment
    /// across it.
    pub moment: Option<f64>,
}

/// Upper limits of a distance at 68.27 % and 95.45 %, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Most {
    pub at_68: f64,
    pub at_95: f64,
}

const LEVEL_68: f64 = 0.682_689_492;
const LEVEL_95: f64 = 0.954_499_736;

/// Equations of a body without extent along each axis.
const FLAT: [&str; 3] = ["B + C = A", "A + C = B", "A + B = C"];
const ROD: [&str; 3] = ["A = 0", "B = 0", "C = 0"];

impl Edge {
    /// Returns the part that this limits, and its shape, such as "flat: A + B = C".
    pub fn of_part(&self) -> Option<(usize, String)> {
        match self.rule {
            Rule::Least(_) | Rule::Greatest(_) => None,
            Rule::SecondMoment { part, axis } => Some((part, format!("flat: {}", FLAT[axis]))),
            Rule::Moment { part, axis } => Some((part, format!("rod: {}", ROD[axis]))),
        }
    }

    /// Returns the upper limits of the distance at both levels, in percent of [`moment`](Self::moment).
    fn percents(&self) -> Option<[f64; 2]> {
        let times = match self.rule {
            Rule::SecondMoment { .. } => 200.0, // A + B - C is twice the second moment
            _ => 100.0,
        };
        let Most { at_68, at_95 } = self.most?;
        Some([at_68, at_95].map(|most| times * most / self.moment.unwrap_or(f64::NAN)))
    }

    /// Describes the limit and its consequences in words.
    pub fn remark(&self, keys: &[Fitted]) -> String {
        let key = |place: usize| (&keys[place].free.key, significant(keys[place].value, 6));
        match (self.rule, self.most) {
            (Rule::Least(place) | Rule::Greatest(place), None) => {
                let (key, value) = key(place);
                format!(
                    "{key} is at its bound {value}: the fit would be better beyond it, and the key has no uncertainty. With another start value (--set), the search may find a better fit within the bounds."
                )
            }
            (Rule::Least(place) | Rule::Greatest(place), Some(Most { at_68, at_95 })) => {
                let (key, value) = key(place);
                let [at_68, at_95] =
                    [at_68, at_95].map(|it| significant(keys[place].value + it, 2));
                format!(
                    "{key} is at {value}, its lowest possible value{}.",
                    at_most(&at_68, &at_95)
                )
            }
            (Rule::SecondMoment { part, axis }, _) => {
                let (sum, moment) = FLAT[axis].split_once(" = ").unwrap_or_default();
                let most = self.percents().map_or(String::new(), |[a, b]| {
                    let percents = at_most(&percent(a), &percent(b));
                    format!(" {sum} is above {moment} by{}", &percents[1..])
                });
                format!(
                    "body.part.{part} is flat: {}, at the physical limit (A, B, C: its moments .0, .1, .2 about its center).{most}{} On one side, the other values have the uncertainty of an exactly flat body; on the other side, the uncertainty of the thickness is added in quadrature.",
                    FLAT[axis],
                    if most.is_empty() { "" } else { "." }
                )
            }
            (Rule::Moment { part, axis }, _) => {
                let (moment, _) = ROD[axis].split_once(" = ").unwrap_or_default();
                let other = ["A", "B", "C"][(axis + 1) % 3];
                let most = self.percents().map_or(String::new(), |[a, b]| {
                    let percents = at_most(&percent(a), &percent(b));
                    format!(" {moment} is{} of {other}.", &percents[1..])
                });
                format!(
                    "body.part.{part} is a rod: {}, at the physical limit (A, B, C: its moments .0, .1, .2 about its center).{most} On one side, the other values have the uncertainty of an exact rod; on the other side, the uncertainty of the thickness is added in quadrature.",
                    ROD[axis]
                )
            }
        }
    }

    pub fn json(&self, keys: &[Fitted]) -> Value {
        let held: Vec<&String> = keys
            .iter()
            .zip(&self.holds)
            .filter(|(_, holds)| **holds)
            .map(|(key, _)| &key.free.key)
            .collect();
        let (rule, unit) = match self.of_part() {
            Some((_, rule)) => (rule, Some("kg m^2")),
            None => ("bound of the key".to_owned(), None),
        };
        json!({
            "rule": rule, "keys": held, "unit": unit, "is_of_nature": self.is_of_nature,
            "distance_at_most_68": self.most.map(|most| most.at_68), "distance_at_most_95": self.most.map(|most| most.at_95),
        })
    }
}

fn percent(percent: f64) -> String {
    format!("{} %", significant(percent, 2))
}

/// Returns the limits that hold the keys at the `minimum`. `variance` is the factor of the covariances.
pub fn edges_at(
    minimum: &Minimum,
    chart: &Chart,
    free: &[Free],
    variance: Option<f64>,
) -> Vec<Edge> {
    let keys = chart.keys(&minimum.p);
    minimum
        .held
        .iter()
        .map(|&place: &usize| {
            let rule = chart.rules[place];
            let inside = Inside::new(minimum, chart, place);
            let moves = match &inside {
                Some(inside) => (&chart.inverse * &inside.moves).as_slice().to_vec(),
                None => vec![0.0; free.len()],
            };
            let is_of_nature = rule.is_of_nature(free);
            let moment_at_limit = match rule {
                Rule::Least(_) | Rule::Greatest(_) => None,
                Rule::SecondMoment { part, axis } => chart.moment(part, axis, &keys),
                Rule::Moment { part, axis } => chart.moment(part, (axis + 1) % 3, &keys),
            };
            Edge {
                moment: moment_at_limit,
                is_of_nature,
                rule,
                holds: (0..free.len())
                    .map(|key: usize| match rule {
                        Rule::Least(held) | Rule::Greatest(held) => held == key,
                        Rule::SecondMoment { part, .. } | Rule::Moment { part, .. } => {
                            let mut moments = free[key].keys.iter().filter_map(|key| moment(key));
                            moments.any(|(own, _)| own == part)
                        }
                    })
                    .collect(),
                moves,
                most: inside
                    .filter(|_| is_of_nature)
                    .zip(variance)
                    .and_then(|(it, variance)| it.most(variance)),
            }
        })
        .collect()
}

/// The normal distribution of the distance to a limit, from the data alone.
struct Inside {
    mean: f64,
    /// Standard deviation, for data with uncertainty 1.
    sigma: f64,
    /// Change of each parameter per unit of distance.
    moves: DVector<f64>,
}

impl Inside {
    /// Computes the distribution for the limit at index `place`, with the other active limits held. Returns `None` if
    /// the data do not determine it.
    fn new(minimum: &Minimum, chart: &Chart, place: usize) -> Option<Self> {
        let slopes = &minimum.slopes;
        let units = slopes.column_iter().map(|column| match column.norm() {
            norm if norm > 0.0 => norm.recip(),
            _ => 1.0,
        });
        let units = DVector::from_iterator(slopes.ncols(), units);
        let others: Vec<DVector<f64>> = minimum
            .held
            .iter()
            .filter(|other| **other != place)
            .map(|&other| chart.limits[other].normal.component_mul(&units))
            .collect();
        let free = complement(others.iter(), slopes.ncols());
        let columns = slopes * nalgebra::DMatrix::from_diagonal(&units) * &free;
        let svd = columns.svd(true, true);
        let (u, v_t) = (svd.u?, svd.v_t?);
        let least = SINGULAR * svd.singular_values.amax();
        let normal = chart.limits[place].normal.component_mul(&units);
        let (mut mean, mut square) = (0.0, 0.0);
        let mut moves = DVector::zeros(slopes.ncols());
        for (k, &singular) in svd.singular_values.iter().enumerate() {
            let way = &free * v_t.row(k).transpose();
            let along = normal.dot(&way);
            if singular > least {
                mean += along * u.column(k).dot(&minimum.residuals) / singular;
                square += (along / singular).powi(2);
                moves += along / singular.powi(2) * way;
            } else if along.abs() > COMBINATION_ROUNDING * normal.norm() {
                return None;
            }
        }
        (square > 0.0).then(|| Self {
            mean: mean.min(0.0),
            sigma: square.sqrt(),
            moves: moves.component_mul(&units) / square,
        })
    }

    fn most(&self, variance: f64) -> Option<Most> {
        let sigma = self.sigma * variance.sqrt();
        let [at_68, at_95] =
            [LEVEL_68, LEVEL_95].map(|level| sigma * sigmas_to_most(-self.mean / sigma, level));
        let most = Most { at_68, at_95 };
        (most.at_68 > 0.0 && most.at_95.is_finite()).then_some(most)
    }
}

/// Returns an upper limit, in standard deviations, for a normal distribution whose mean is `below` standard deviations
/// below 0. The fraction `level` of the part above 0 lies below this limit.
fn sigmas_to_most(below: f64, level: f64) -> f64 {
    /// Beyond this the part above 0 is exponential to 0.2 %, and soon too small for floating-point numbers.
    const FAR: f64 = 30.0;
    if below > FAR {
        return -libm::log(1.0 - level) / below;
    }
    let wanted = (1.0 - level) * both_tails(below);
    let (mut from, mut to) = (0.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (from + to);
        if both_tails(below + middle) > wanted {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

fn at_most(at_68: &str, at_95: &str) -> String {
    format!(", at most {at_68} with 68 % probability and {at_95} with 95 %")
}

/// Returns the probability that a standard normal number is farther than `from` from 0.
fn both_tails(from: f64) -> f64 {
    libm::erfc(from * std::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_limits_use_the_truncated_distribution() {
        // With the mean at the limit: one and two standard deviations. With the mean far outside: values of an
        // exponential.
        for (below, level, wanted) in [
            (0.0, LEVEL_68, 1.0),
            (0.0, LEVEL_95, 2.0),
            (1.0, LEVEL_68, 0.641_5),
            (29.999_9, LEVEL_68, 0.038_2),
            (30.000_1, LEVEL_68, 0.038_3),
        ] {
            let found = sigmas_to_most(below, level);
            assert!((found - wanted).abs() < 2e-4, "{below}: {found}");
        }
    }
}
