//! The numbers of a run beside those of the exact motion and of theory, each with a verdict in words.

use super::exact::ExactNumbers;
use super::verdict::{Stated, Tolerance, compare};
use crate::engine::analysis::readouts::{
    READOUTS, Readout, ReadoutSource, find, passes_through_vertical,
};
use crate::engine::analysis::{Readouts, WithoutNutation};
use crate::engine::run::EnergyUnit;
use crate::engine::text::number::{NOT_AVAILABLE, significant};
use crate::engine::text::unit::Unit;
use crate::report::document::Text;

/// A number of the run in the table.
pub struct QuantityRow {
    pub readout: &'static Readout,
    pub label: String,
    /// This run, the exact motion, theory.
    pub cells: [Text; 3],
    pub unit: Text,
    /// Markup.
    pub verdict: String,
    pub meaning: String,
}

/// The number that a time step can be too long to see.
const NUTATION: &str = "measured_nutation_period_s";
const PRECESSION: &str = "measured_precession_rad_per_s";
const FOOT_FORCE: &str = "measured_mean_foot_force_N";
/// The number whose theory is the difference of two others.
const SWING: &str = "measured_tilt_swing_deg";
const ENERGY: &str = "energy_drift";

/// How the names of measured numbers begin.
const MEASURED_NAME_PREFIX: &str = "measured_";

/// The numbers at the end of the run that are compared.
const AT_END: [&str; 6] = ["x_m", "y_m", "z_m", "tilt_deg", "L_axle_Js", ENERGY];

/// What stands where theory has no formula.
const NO_FORMULA: &str = "–";

/// Returns the readouts of the table, those that are read off the steps first.
pub(super) fn compared() -> impl Iterator<Item = &'static Readout> {
    let measured = READOUTS.iter().filter(|readout| {
        readout.name.starts_with(MEASURED_NAME_PREFIX) && !readout.is_uncertainty()
    });
    measured.chain(AT_END.into_iter().filter_map(find))
}

/// A run whose numbers are compared.
pub struct RunNumbers<'a> {
    pub run: &'a Readouts,
    pub exact: &'a ExactNumbers,
    /// When the forces last changed, s, where that is not the start.
    pub since_s: Option<f64>,
}

impl RunNumbers<'_> {
    /// Every number that the run, the exact motion or theory has.
    pub fn rows(&self) -> Vec<QuantityRow> {
        compared().filter_map(|readout| self.row(readout)).collect()
    }

    fn row(&self, readout: &'static Readout) -> Option<QuantityRow> {
        let run = stated(readout, self.run);
        let exact = self.exact.readouts();
        let exact = exact
            .filter(|exact| readout.name != NUTATION || exact.nutation_is_resolved() != Some(false))
            .and_then(|exact| number(Some(readout), exact));
        let predicted = self.predicted(readout);
        run.map(|it| it.number).or(exact).or(predicted)?;
        // To the last digit of the run's number, so that they are compared digit by digit.
        let digits = |number: f64| match run {
            Some(run) => Text::number(&run.with_digits(number)),
            None => Text::number(&significant(number, 6)),
        };
        let missing = || Text::plain(NOT_AVAILABLE);
        let cells = [
            run.map_or_else(missing, |it| Text::number(&it.to_string())),
            exact.map_or_else(missing, digits),
            predicted.map_or_else(|| Text::plain(NO_FORMULA), digits),
        ];
        let (label, meaning) = self.words(readout);
        Some(QuantityRow {
            readout,
            label,
            cells,
            unit: self.unit(readout),
            verdict: self.verdict(readout, run, exact, predicted),
            meaning,
        })
    }

    /// What theory says of `readout`.
    fn predicted(&self, readout: &Readout) -> Option<f64> {
        if readout.name == SWING {
            let range_deg = self.run.predicted_tilt_range_deg();
            return range_deg.map(|(low, high)| high - low);
        }
        // What theory says of the motion since the forces last changed says nothing of the run before.
        let is_of_it = readout.source != ReadoutSource::EveryStep || self.since_s.is_none();
        number(theory(readout), self.run).filter(|_| is_of_it)
    }

    /// Returns the verdict on a number: compared with the exact motion or, where that is not known, with theory.
    fn verdict(
        &self,
        readout: &Readout,
        run: Option<Stated>,
        exact: Option<f64>,
        predicted: Option<f64>,
    ) -> String {
        let Some(run) = run else {
            return format!("not judged: {}", self.why_without(readout));
        };
        if readout.name == NUTATION && self.is_strobed() {
            return "not resolved: the time step is longer than half a nutation, and the number is an artifact of it".to_owned();
        }
        let tolerance = self.tolerance(readout);
        match (exact, predicted, self.exact) {
            (Some(exact), ..) => compare(run, exact, tolerance, readout.unit),
            (None, Some(theory), _) => {
                let verdict = compare(run, theory, tolerance, readout.unit);
                format!("{verdict}, from theory")
            }
            (None, None, ExactNumbers::Missing(reason)) => format!("not judged: {reason}"),
            (None, None, ExactNumbers::Known(_)) => {
                "not judged: the exact motion does not have this number".to_owned()
            }
        }
    }

    fn is_strobed(&self) -> bool {
        self.run.nutation_is_resolved() == Some(false)
    }

    /// Returns how far `readout` may be from the exact motion.
    fn tolerance(&self, readout: &Readout) -> Tolerance {
        let exact = self.exact.readouts().unwrap_or(self.run);
        match readout.name {
            "x_m" | "y_m" | "z_m" | "measured_lowest_z_m" | "measured_highest_z_m" => {
                Tolerance::of_place(self.run.health.arm_m)
            }
            "tilt_deg" | "measured_lowest_tilt_deg" | "measured_highest_tilt_deg" | SWING => {
                let tilt = &exact.extremes.tilt;
                Tolerance::of_tilt((tilt.lowest_deg, tilt.highest_deg))
            }
            NUTATION => Tolerance::OF_NUTATION,
            ENERGY => Tolerance::OF_ENERGY,
            _ => Tolerance::OF_RATE,
        }
    }

    /// Returns why the run does not have the number `readout`.
    fn why_without(&self, readout: &Readout) -> &'static str {
        match (readout.name, self.run.without_nutation) {
            (NUTATION | PRECESSION | FOOT_FORCE, _) if self.run.health.slowing.is_some() => {
                "friction changes it all the time"
            }
            (NUTATION, Some(WithoutNutation::Steady)) => "the axle keeps its tilt",
            (NUTATION, Some(why)) => why.words(),
            (PRECESSION, _) if passes_through_vertical(self.run) => {
                "the axle passes through the vertical"
            }
            (PRECESSION, _) => "too little of it was seen to state it",
            (FOOT_FORCE, _) if self.is_strobed() => "the time step is too long to see the nutation",
            (FOOT_FORCE, _) => "no whole nutation was seen",
            (ENERGY, _) => "there is no energy to measure it by",
            _ => "the run does not have this number",
        }
    }

    fn unit(&self, readout: &Readout) -> Text {
        match (readout.name, self.run.health.energy_unit) {
            (ENERGY, Some(EnergyUnit::Weight)) => Text::marked("$M g |c|$"),
            (ENERGY, Some(EnergyUnit::KineticAtStart)) => {
                Text::plain("kinetic energy at the start")
            }
            _ => Text::unit(readout.unit),
        }
    }

    /// The label of the row of `readout`, and the line that says what it is.
    fn words(&self, readout: &Readout) -> (String, String) {
        let is_measured = readout.name.starts_with(MEASURED_NAME_PREFIX);
        let mut label = match readout.name {
            ENERGY => "energy error".to_owned(),
            "L_axle_Js" => "L along the axle".to_owned(),
            name => bare(name),
        };
        let mut meaning = match readout.meaning {
            meaning if meaning == label => label.clone(),
            meaning => format!("{label}: {meaning}"),
        };
        if !is_measured {
            label += " at the end";
        }
        let since_s = self
            .since_s
            .filter(|_| readout.source == ReadoutSource::Measured);
        if let Some(since_s) = since_s {
            let since = significant(since_s, 9);
            label += &format!(" since {since} s");
            meaning += &format!("; since the forces last changed, at t = {since} s");
        }
        (label, meaning)
    }
}

/// The number of the run that a readout is, in its unit.
fn number(readout: Option<&Readout>, readouts: &Readouts) -> Option<f64> {
    readout.and_then(|readout| readout.read_from(readouts).number())
}

/// The number with its uncertainty. What the tilt swings beyond its steps is no uncertainty of reading.
fn stated(readout: &Readout, readouts: &Readouts) -> Option<Stated> {
    let sigma = theory(readout).and(number(readout.uncertainty(), readouts));
    Some(Stated {
        number: number(Some(readout), readouts)?,
        sigma,
    })
}

/// The readout with the theory of the exact motion. (The swing that the report's scheme makes has a formula, which is none.)
fn theory(readout: &Readout) -> Option<&'static Readout> {
    readout
        .predicted()
        .filter(|it| it.source == ReadoutSource::Theory)
}

/// The `name` of a number in words.
fn bare(name: &str) -> String {
    let bare = name.strip_prefix(MEASURED_NAME_PREFIX).unwrap_or(name);
    let end = Unit::from_name(bare).map_or("", |unit| unit.end);
    bare[..bare.len() - end.len()].replace('_', " ")
}
