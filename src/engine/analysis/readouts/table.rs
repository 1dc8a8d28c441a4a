//! The table of readouts: a row for each, with its name, unit, source, meaning and formula.

use super::summary_row::SummaryPart::{Further, Motion, State};
use super::summary_row::{self, SummaryRow, summary};
use super::value_row::{Tolerance, ValueRow, now, passes_through_vertical, so_far};
use super::{ReadoutValue, Readouts};
use crate::analysis::theory::AxlePath;
use crate::analysis::{MeasuredNumber, Theory};
use crate::physics::SchemeInfo;
use crate::scenario::{problem, start};
use std::f64::consts::PI;
use std::time::Duration;

#[derive(Debug)]
pub struct Readout {
    /// Name, which ends with the unit.
    pub name: &'static str,
    /// Unit; empty for a pure number and for a text.
    pub unit: &'static str,
    pub meaning: &'static str,
    pub source: ReadoutSource,
    /// True if the readout is a text, and never a number.
    pub is_text: bool,
    kind: ValueKind,
    /// Symbol in figures, in their markup; empty if it has none.
    pub symbol: &'static str,
    /// Row in the lab's values pane, if any.
    pub row: Option<ValueRow>,
    /// Line in the summary of a run, if any.
    pub summary: Option<SummaryRow>,
    get: fn(&Readouts) -> ReadoutValue,
}

const DEGREES_PER_RAD: f64 = 180.0 / PI;

/// Part of the name of every readout that is the standard error of another.
const ERROR: &str = "_uncertainty";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadoutSource {
    /// From the scenario and its edits.
    Scenario,
    /// From the state at the last step.
    State,
    /// From every step of the run.
    EveryStep,
    /// From the steps since the forces last changed.
    Measured,
    /// By a formula for the scheme at this time step.
    Scheme,
    /// From the comparison with the exact motion.
    Exact,
    /// By the theory of the heavy symmetric top, for the exact motion under the present forces.
    Theory,
    /// From the clock of the machine. It differs from run to run.
    Clock,
}

impl ReadoutSource {
    pub fn words(self) -> &'static str {
        match self {
            Self::Scenario => "the scenario",
            Self::State => "the run's last step",
            Self::EveryStep => "every step of the run, including its start",
            Self::Measured => "the steps since the forces last changed",
            Self::Scheme => "a formula for the scheme at this time step",
            Self::Exact => "the comparison with the exact motion",
            Self::Theory => {
                "theory of the heavy symmetric top without friction, for the exact motion under the present forces"
            }
            Self::Clock => "the machine's clock",
        }
    }
}

impl Readout {
    /// Returns true if this is the standard error of another readout.
    pub fn is_uncertainty(&self) -> bool {
        self.name.contains(ERROR)
    }

    /// Returns the readout that is the standard error of this one.
    pub fn uncertainty(&self) -> Option<&'static Self> {
        READOUTS
            .iter()
            .find(|other| {
                let stem = other.name.split_once(ERROR);
                stem.is_some_and(|(stem, _)| self.name.starts_with(stem))
            })
            .filter(|_| !self.is_uncertainty())
    }

    /// Returns the readout with theory's prediction for this measured one.
    pub fn predicted(&self) -> Option<&'static Self> {
        let what = self.name.strip_prefix("measured_")?;
        find(&format!("predicted_{what}"))
    }

    /// Returns true if the readout depends on the body's position or momentum, which are lost when a scheme breaks
    /// down.
    pub fn is_of_body(&self) -> bool {
        matches!(self.source, ReadoutSource::State | ReadoutSource::Exact)
    }

    pub fn read_from(&self, readouts: &Readouts) -> ReadoutValue {
        (self.get)(readouts)
    }

    /// Parses `cell` of a CSV as a value of this readout. `None` if it is not a valid value.
    pub fn parse(&self, cell: &str) -> Option<ReadoutValue> {
        match self.kind {
            _ if cell.is_empty() => Some(ReadoutValue::Nothing),
            ValueKind::Number => {
                let number = cell.parse().ok().filter(|number: &f64| number.is_finite());
                number.map(ReadoutValue::Number)
            }
            ValueKind::Whole => cell.parse().ok().map(ReadoutValue::Whole),
            ValueKind::Flag => cell.parse().ok().map(ReadoutValue::Flag),
            ValueKind::Text => may_be(self.name, cell).then(|| ReadoutValue::Text(cell.to_owned())),
        }
    }
}

pub fn find(name: &str) -> Option<&'static Readout> {
    READOUTS.iter().find(|readout| readout.name == name)
}

pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    READOUTS.iter().map(|readout| readout.name)
}

/// Returns a hint for the unknown readout `wrong`: "did you mean tilt_deg?", or the list of names.
pub fn nearest(wrong: &str) -> String {
    // A name such as "lowest_tilt_deg" lacks its prefix: theory's, or the run's.
    let fuller = names().filter(|name| {
        name.strip_suffix(wrong)
            .is_some_and(|kind| kind.ends_with('_'))
    });
    match fuller.collect::<Vec<_>>()[..] {
        [] => problem::nearest(wrong, names()),
        ref fuller => format!("did you mean {}?", fuller.join(" or ")),
    }
}

fn value(measured: Option<MeasuredNumber>) -> Option<f64> {
    measured.map(|measured| measured.value)
}

fn uncertainty(measured: Option<MeasuredNumber>) -> Option<f64> {
    measured.map(|measured| measured.uncertainty)
}

/// Returns true if `text` is a valid value of the text readout `name`.
fn may_be(name: &str, text: &str) -> bool {
    match name {
        "path" => AxlePath::ALL.iter().any(|path| path.to_string() == text),
        "scheme" => SchemeInfo::find(text).is_some(),
        _ => true,
    }
}

/// Kind of value that a row's formula returns, if it returns one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ValueKind {
    Number,
    Whole,
    Flag,
    Text,
}

/// Result type of a row's formula: a number, a flag, or a text.
trait IntoValue {
    const KIND: ValueKind;

    fn value(self) -> ReadoutValue;
}

impl IntoValue for f64 {
    const KIND: ValueKind = ValueKind::Number;

    fn value(self) -> ReadoutValue {
        Some(self)
            .filter(|number| number.is_finite())
            .map_or(ReadoutValue::Nothing, ReadoutValue::Number)
    }
}

impl IntoValue for u64 {
    const KIND: ValueKind = ValueKind::Whole;

    fn value(self) -> ReadoutValue {
        ReadoutValue::Whole(self)
    }
}

impl IntoValue for bool {
    const KIND: ValueKind = ValueKind::Flag;

    fn value(self) -> ReadoutValue {
        ReadoutValue::Flag(self)
    }
}

impl IntoValue for String {
    const KIND: ValueKind = ValueKind::Text;

    fn value(self) -> ReadoutValue {
        ReadoutValue::Text(self)
    }
}

impl<T: IntoValue> IntoValue for Option<T> {
    const KIND: ValueKind = T::KIND;

    fn value(self) -> ReadoutValue {
        self.map_or(ReadoutValue::Nothing, T::value)
    }
}

/// Returns the kind of value that a formula returns.
const fn kind<T: IntoValue>(_: &impl Fn(&Readouts) -> T) -> ValueKind {
    T::KIND
}

macro_rules! optional {
    () => {
        None
    };
    ($row:expr) => {
        Some($row)
    };
}

/// Makes a readout of each line. A line has the name, unit, source and meaning, and a formula for the value from the
/// readouts `r`. The symbol, the row in the lab's values pane, and the line in the summary are optional.
macro_rules! readouts {
    ($($name:literal, $unit:literal, $source:ident, $meaning:literal, |$r:ident| $get:expr $(, $symbol:literal)? $(=> $row:expr)? $(, summary $summary:expr)?;)*) => {
        pub const READOUTS: &[Readout] = &[
            $(Readout {
                name: $name,
                unit: $unit,
                meaning: $meaning,
                source: ReadoutSource::$source,
                is_text: matches!(kind(&|$r: &Readouts| $get), ValueKind::Text),
                kind: kind(&|$r: &Readouts| $get),
                symbol: concat!($($symbol)?),
                row: optional!($($row)?),
                summary: optional!($($summary)?),
                get: |$r| $get.value(),
            }),*
        ];
    };
}

readouts! {
    "title", "", Scenario, "the scenario's title", |r| r.title.clone();
    "scheme", "", Scenario, "the numerical scheme in force", |r| r.scheme.to_owned() , summary summary(State, 0, "scheme", summary_row::scheme);
    "scheme_kind", "", Scenario, "variant of the scheme, if it has more than one", |r| r.scheme_kind.clone();
    "steps", "", State, "time steps taken", |r| r.sample.step , summary summary(State, 1, "steps", summary_row::steps);
    "time_step_s", "s", Scenario, "the time step in force", |r| r.time_step_s, "Δ*t*";
    "t_s", "s", State, "time", |r| r.sample.time_s, "*t*" , summary summary(State, 2, "t", summary_row::time);
    "x_m", "m", State, "traced point, world frame", |r| r.sample.position.x, "*x*" => now(0, "x", "x").of_moment(|moment| Some(moment.position.x)).decimals(4).off_by(Tolerance::OfArm) , summary summary(State, 3, "x, y, z", summary_row::position);
    "y_m", "m", State, "traced point, world frame", |r| r.sample.position.y, "*y*" => now(1, "y", "y").of_moment(|moment| Some(moment.position.y)).decimals(4).off_by(Tolerance::OfArm);
    "z_m", "m", State, "traced point, world frame", |r| r.sample.position.z, "*z*" => now(2, "z", "z").of_moment(|moment| Some(moment.position.z)).decimals(4).off_by(Tolerance::OfArm);
    "Lx_Js", "J s", State, "angular momentum about the pivot, world frame", |r| r.sample.momentum.x, "*L*_{*x*}" , summary summary(State, 4, "L", summary_row::momentum);
    "Ly_Js", "J s", State, "angular momentum about the pivot, world frame", |r| r.sample.momentum.y, "*L*_{*y*}";
    "Lz_Js", "J s", State, "angular momentum about the pivot, world frame", |r| r.sample.momentum.z, "*L*_{*z*}" => now(7, "Lz", "Lz").of_moment(|moment| Some(moment.momentum.z)).rank(2).off_by(Tolerance::OfItself);
    "L_Js", "J s", State, "size of the angular momentum about the pivot", |r| r.sample.momentum.norm(), "|*L*|" => now(6, "|L|", "|L|").of_moment(|moment| Some(moment.momentum.norm())).rank(1).off_by(Tolerance::OfItself);
    "wx_rad_per_s", "rad/s", State, "angular velocity I^-1 L, world frame", |r| r.sample.angular_velocity.x, "*ω*_{*x*}";
    "wy_rad_per_s", "rad/s", State, "angular velocity I^-1 L, world frame", |r| r.sample.angular_velocity.y, "*ω*_{*y*}";
    "wz_rad_per_s", "rad/s", State, "angular velocity I^-1 L, world frame", |r| r.sample.angular_velocity.z, "*ω*_{*z*}";
    "tilt_deg", "deg", State, "angle of the axle from +z", |r| r.sample.tilt_deg, "*θ*" => now(3, "tilt", "tilt").of_moment(|moment| Some(moment.tilt_deg)).decimals(2).off_by(Tolerance::Of(0.5)) , summary summary(Motion, 0, "tilt", summary_row::tilt);
    "azimuth_deg", "deg", State, "azimuth of the axle with all full turns", |r| r.sample.azimuth_deg, "*φ*" => so_far(7, "azimuth").decimals(2) , summary summary(Further, 3, "azimuth", summary_row::azimuth);
    "energy_J", "J", State, "kinetic energy, and potential energy from the height of the pivot", |r| r.sample.energy, "*E*";
    "energy_drift", "", State, "energy error caused by the scheme alone, in units of M g |c|, or of the kinetic energy at the start if M g |c| is below 1e-9 of it", |r| r.health.energy_drift => now(8, "energy error", "E error").in_unit_of_energy().of_moment(|moment| moment.energy_error).off_by(Tolerance::Of(0.05)) , summary summary(State, 5, "energy drift", summary_row::energy);
    "friction_work_J", "J", State, "work of friction since the start, which the energy drift allows for; exact and rk4 integrate its power, other schemes sum each impulse times the mean omega", |r| r.health.slowing.map(|slowing| slowing.work) , summary summary(Further, 7, "friction", summary_row::friction);
    "segment", "", Scenario, "edits of time step, scheme or gravity before this step", |r| r.sample.segment , summary summary(Further, 8, "edits", summary_row::edits);
    "measured_lowest_tilt_deg", "deg", EveryStep, "minimum angle of the axle from +z", |r| r.extremes.tilt.lowest_deg, "*θ*_{min}" => so_far(0, "tilt min").decimals(3);
    "measured_highest_tilt_deg", "deg", EveryStep, "maximum angle of the axle from +z", |r| r.extremes.tilt.highest_deg, "*θ*_{max}" => so_far(1, "tilt max").decimals(3);
    "measured_lowest_z_m", "m", EveryStep, "minimum z of the traced point", |r| r.extremes.lowest_z_m, "*z*_{min}" => so_far(2, "z min").decimals(4) , summary summary(Motion, 1, "z", summary_row::height);
    "measured_highest_z_m", "m", EveryStep, "maximum z of the traced point", |r| r.extremes.highest_z_m, "*z*_{max}" => so_far(3, "z max").decimals(4);
    "turns_per_step", "", State, "turns of the body in one time step, |Omega| dt/2 pi", |r| r.health.turns_per_step => now(9, "turns per step", "turns/dt").rank(3).in_unit("< 0.5", 1.0).off_by(Tolerance::UnlessReliable(0.5)) , summary summary(Further, 4, "a time step", summary_row::time_step);
    "nutation_multiplier", "", Scheme, "report's scheme only: its factor on a nutation's size per step; the true factor is 1", |r| r.health.nutation.map(|nutation| nutation.multiplier);
    "lag_deg", "deg", State, "angle between axle and L", |r| r.health.lag_deg => so_far(5, "axle to L").decimals(3) , summary summary(Further, 5, "lag", summary_row::lag);
    "steady_lag_deg", "deg", Scheme, "report's scheme only: its angle between axle and L in slow steady precession at this tilt and spin, which is the true angle times kappa psi/|1 - A|", |r| r.health.nutation.and_then(|nutation| nutation.scheme_lag_deg());
    "predicted_lag_deg", "deg", Scheme, "report's scheme only: mean angle between axle and L, |tau| dt/(|L| |1 - A|), at the last change of the forces; null if this linear theory is off by more than about a tenth, or if the scheme amplifies the nutation (kappa above 1)", |r| r.report_theory.and_then(|theory| theory.lag_deg(r.sample.step.saturating_sub(r.since)));
    "predicted_tilt_swing_deg", "deg", Scheme, "report's scheme only: swing of the tilt about that lag, by the same theory; also null if the scheme damps or amplifies the nutation in the run", |r| r.report_theory.and_then(|theory| theory.swing_deg(r.sample.step.saturating_sub(r.since)));
    "measured_tilt_swing_deg", "deg", Measured, "maximum tilt minus minimum tilt, as the steps show it", |r| value(r.tilt_swing);
    "measured_tilt_swing_uncertainty_deg", "deg", Measured, "estimate of how much more the tilt swings between the steps", |r| uncertainty(r.tilt_swing);
    "true_tilt_swing_deg", "deg", Theory, "maximum minus minimum tilt of the exact motion in the whole run; null once the forces have changed", |r| r.predicted_tilts_of_run().map(|(lowest, highest)| highest - lowest);
    "true_steady_lag_deg", "deg", Theory, "true angle between axle and L in slow steady precession; with the report's scheme only, null if the top spins too slowly for a steady precession", |r| r.health.nutation.and_then(|nutation| nutation.true_lag_deg) => so_far(6, "steady").decimals(3);
    "distance_m", "m", Exact, "distance of the traced point from the exact motion; null after predictable_until_s", |r| r.health.deviation.map(|off| off.distance_m) => so_far(8, "off exact").decimals(4);
    "most_distance_m", "m", Exact, "largest distance of the traced point from the exact motion so far, up to predictable_until_s", |r| r.health.most_distance_m;
    "predictable_until_s", "s", Exact, "time after which no double-precision computation can predict the motion; null if the run ends before that", |r| r.health.predictability.until_s;
    "reliable", "", Exact, "true if the numbers of this step are reliable; false after predictable_until_s, null if this is unknown", |r| r.health.is_reliable();
    "L_axle_drift_Js", "J s", Exact, "L along the axle minus its exact value", |r| r.health.deviation.map(|off| off.axle_momentum) , summary summary(Further, 6, "L", summary_row::constants);
    "Lz_drift_Js", "J s", Exact, "L_z minus its exact value", |r| r.health.deviation.map(|off| off.lz);
    "kappa", "", Scenario, "I3/I1 of a symmetric body; with start.rotor, I3 is the rotor's alone; if the body is symmetric only to 1 %, I1 is the mean moment across", |r| r.kappa, "*κ*";
    "asymmetry", "", Scenario, "deviation from symmetry about the axle: the largest of the relative difference of the moments across, the angle of the principal axis to the axle (rad), and the distance of the center of mass from the axle over the radius of gyration; 0 if symmetric, null without theory (above 0.001; for the moments above 0.01, or a fifth of their difference from the moment along the axle)", |r| r.asymmetry , summary summary(Motion, 4, "asymmetry", summary_row::asymmetry);
    "theory_axis", "", Theory, "axis of theory: +z, or else opposite to the forces, or along L without forces; if it is not +z, theory's numbers about +z are null", |r| r.theory.map(|theory| theory.axis.to_string());
    "path", "", Theory, "path of the axle about +z", |r| r.lasting_theory().map(|theory| theory.path.to_string()) , summary summary(Further, 0, "theory", summary_row::theory);
    "predicted_lowest_tilt_deg", "deg", Theory, "minimum tilt of the exact motion from +z in the whole run; null once the forces have changed", |r| r.predicted_tilts_of_run().map(|range| range.0), "*θ*_{min}";
    "predicted_highest_tilt_deg", "deg", Theory, "maximum tilt of the exact motion from +z in the whole run; null once the forces have changed", |r| r.predicted_tilts_of_run().map(|range| range.1), "*θ*_{max}";
    "cusp_tilt_deg", "deg", Theory, "tilt at which the azimuth of the axle stops", |r| r.lasting_theory().and_then(|theory| theory.cusp_tilt_deg);
    "predicted_precession_rad_per_s", "rad/s", Theory, "mean precession of the exact motion about +z", |r| r.lasting_theory().and_then(|theory| theory.precession), "*Ω*_{p}";
    "measured_precession_rad_per_s", "rad/s", Measured, "mean precession about +z; null with friction, which changes it all the time", |r| value(r.precession), "*Ω*_{p}" => now(4, "precession", "prec.").measured(|r| r.precession).unless(passes_through_vertical).in_unit("°/s", DEGREES_PER_RAD).off_by(Tolerance::OfItself) , summary summary(Motion, 2, "precession", summary_row::precession);
    "measured_precession_uncertainty_rad_per_s", "rad/s", Measured, "one standard error of the measurement, without the error of the scheme and its time step", |r| uncertainty(r.precession);
    "slow_precession_rad_per_s", "rad/s", Theory, "slow steady precession at this tilt", |r| r.theory_about_z().and_then(|theory| theory.slow_precession), "*Ω*_{slow}" , summary summary(Further, 1, "steady", summary_row::steady_precession);
    "fast_precession_rad_per_s", "rad/s", Theory, "fast steady precession at this tilt", |r| r.theory_about_z().and_then(|theory| theory.fast_precession), "*Ω*_{fast}";
    "fast_top_precession_rad_per_s", "rad/s", Theory, "precession of a fast top, M g h/L3", |r| r.theory_about_z().and_then(|theory| theory.fast_top_precession), "*M* *g* *h*/*L*_{3}";
    "predicted_nutation_period_s", "s", Theory, "nutation period of the exact motion", |r| r.lasting_theory().and_then(|theory| theory.nutation_period_s), "*T*_{n}";
    "measured_nutation_period_s", "s", Measured, "mean time between successive maxima of the tilt; null with friction", |r| value(r.nutation), "*T*_{n}" => now(5, "nutation", "nutat").measured(|r| r.nutation).off_by(Tolerance::OfItself) , summary summary(Motion, 3, "nutation", summary_row::nutation);
    "measured_nutation_uncertainty_s", "s", Measured, "one standard error of the measurement, without the error of the scheme and its time step", |r| uncertainty(r.nutation);
    "nutation_is_resolved", "", State, "false if the time step is too long to show the nutation, which is then under-sampled", |r| r.nutation_is_resolved();
    "predicted_precession_period_s", "s", Theory, "time of one turn of the mean precession of the exact motion about +z", |r| r.lasting_theory().and_then(Theory::precession_period_s), "*T*_{p}";
    "predicted_body_cone_period_s", "s", Theory, "free symmetric body: period of the instantaneous axis about the axle, seen from the body, (I1/|I3 - I1|) 2 pi/omega3; null with a load, without spin, for I3 = I1, or if only a rotor spins", |r| r.theory.filter(|theory| !r.has_rotor && !theory.is_of_a_moment).and_then(|theory| theory.body_cone_period_s), "*T*_{c}";
    "fast_top_nutation_rad_per_s", "rad/s", Theory, "nutation of a fast top, L3/I1", |r| r.theory.map(|theory| theory.fast_top_nutation), "*ω*_{n}";
    "fast_top_nutation_rpm", "rpm", Theory, "nutation of a fast top, in revolutions per minute", |r| r.theory.map(|theory| start::rpm(theory.fast_top_nutation)), "*ω*_{n}";
    "L_axle_Js", "J s", State, "L along the axle", |r| r.axle_momentum, "*L*_{3}" => so_far(4, "L along axle");
    "spin_rpm", "rpm", State, "spin rate: omega along the axle", |r| start::rpm(r.spin_rad_per_s), "*ω*_{3}";
    "w1_rad_per_s", "rad/s", State, "angular velocity along the body's own x", |r| r.sample.omega().x, "*ω*_{1}";
    "w2_rad_per_s", "rad/s", State, "angular velocity along the body's own y", |r| r.sample.omega().y, "*ω*_{2}";
    "w3_rad_per_s", "rad/s", State, "angular velocity along the axle", |r| r.sample.omega().z, "*ω*_{3}";
    "foot_force_N", "N", State, "vertical force of the floor on the foot", |r| r.sample.foot_force, "*N*";
    "predicted_mean_foot_force_N", "N", Theory, "mean foot force over whole nutations: M g minus upward pushes; for a lopsided body too", |r| r.predicted_mean_foot_force, "*M* *g*";
    "measured_mean_foot_force_N", "N", Measured, "mean foot force over whole nutations; null before the first one, or if the time step is too long to show them", |r| value(r.mean_foot_force), "*N*" , summary summary(Motion, 5, "foot force", summary_row::foot_force);
    "measured_mean_foot_force_uncertainty_N", "N", Measured, "one standard error of the measurement", |r| uncertainty(r.mean_foot_force);
    "sleeping_limit_Js", "J s", Theory, "minimum L along the axle with which this top sleeps upright; null if it is stable without spin, with its center of mass below the pivot", |r| r.theory_about_z().and_then(|theory| theory.sleeping_limit) , summary summary(Further, 2, "upright", summary_row::upright);
    "health", "", Exact, "whether the numbers are reliable, in one sentence", |r| r.health.sentence(r.advice.as_ref());
    "wall_s", "s", Clock, "time spent on stepping alone", |r| r.stepping.map(|wall| wall.as_secs_f64()) , summary summary(State, 6, "wall time", summary_row::wall_time);
    "steps_per_second", "1/s", Clock, "steps per second of that time", |r| r.stepping.map(|wall| per_second(r.sample.step, wall));
}

fn per_second(steps: u64, wall: Duration) -> f64 {
    match wall.as_secs_f64() {
        wall_s if wall_s > 0.0 => steps as f64 / wall_s,
        _ => 0.0,
    }
}
