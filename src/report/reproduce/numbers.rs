//! The numbers of the document, read from its tables and from the presets.

use super::tables::Tables;
use crate::engine::scenario::{Document, Problems, Scenario, Window};
use crate::engine::text::number::{fixed, significant};
use crate::physics::SymmetricTop;
use crate::report::document::quantity;
use std::f64::consts::{PI, TAU};

/// All numbers of the document.
pub(super) struct Numbers {
    pub top: Top,
    pub method_1: Run,
    pub method_1_steeper: Run,
    pub method_2_slow: Run,
    pub method_2: Run,
    pub push: Run,
    /// x of the traced point in Method 1, in the whole run and half a turn of the precession later, m.
    pub first_x_m: Range,
    pub later_x_m: Both<Range>,
    /// Greatest z of the traced point in the second half of Method 1, m.
    pub back_up_z_m: f64,
    pub without_weight: Both<Flight>,
    /// With 200 J s, and with 100 times that.
    pub spins: [Both<Flight>; 2],
    /// Precession at the tilts of [`TILTS_DEG`], rad/s: of the report's top with steps of 0.1 s, and of a slow one.
    pub of_fast_top: [Both<f64>; 3],
    pub of_slow_top: [Both<f64>; 3],
    pub slow_tops: [SlowTop; 4],
    /// The push, from the longest time step to the shortest.
    pub finer: [Finer; 7],
    pub lag: Lag,
    /// The push with the wheel at other heights.
    pub heights: [OtherHeight; 4],
    /// The torque of weight and push together, as a multiple of the weight's.
    pub push_torque: f64,
    /// Distance from the foot to the axle's upper end in every row of the push, m.
    pub length_m: Range,
    /// Greatest distance from the vertical in the two halves of the time after the push, m.
    pub radii_m: [f64; 2],
}

/// The same by the report's scheme and of the exact motion.
#[derive(Clone, Copy)]
pub(super) struct Both<T> {
    pub report: T,
    pub exact: T,
}

#[derive(Clone, Copy)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

/// The body of the report's runs, and the start of Method 2.
pub(super) struct Top {
    pub mass_kg: f64,
    /// Height of the hub along the axle, m.
    pub hub_m: f64,
    /// Length of the axle, m.
    pub arm_m: f64,
    /// Moments of inertia about the foot across and along the axle, kg m2.
    pub across: f64,
    pub along: f64,
    pub gravity: f64,
    /// |L|, J s.
    pub momentum: f64,
    pub tilt_rad: f64,
}

/// One of the report's runs.
pub(super) struct Run {
    pub time_step_s: f64,
    pub duration_s: f64,
    /// Angle between axle and L at the start, degrees.
    pub start_lag_deg: f64,
    /// Azimuth of the axle at the start, degrees.
    pub start_azimuth_deg: f64,
    pub report: Measured,
    pub exact: Measured,
    /// Largest distance of the traced point from the exact motion, m.
    pub most_distance_m: f64,
}

/// What is read off a run by one scheme.
#[derive(Clone, Copy)]
pub(super) struct Measured {
    pub z_m: Range,
    pub highest_tilt_deg: f64,
    /// How far the axle has gone around, degrees.
    pub azimuth_deg: f64,
    pub precession: f64,
    pub nutation_s: f64,
    pub turns_per_step: f64,
    pub spin_rpm: f64,
    /// |L|, J s.
    pub momentum: f64,
}

/// Spin (rpm), azimuth at the end (degrees) and precession (rad/s); NaN where the table has none.
#[derive(Clone, Copy)]
pub(super) struct Flight {
    pub spin_rpm: f64,
    pub azimuth_deg: f64,
    pub precession: f64,
}

/// A top that is let go with little angular momentum.
pub(super) struct SlowTop {
    /// |L|, J s.
    pub momentum: f64,
    pub tilt_deg: Both<Range>,
}

/// The push at one time step.
pub(super) struct Finer {
    pub time_step_s: f64,
    pub turns_per_step: f64,
    pub z_m: Both<Range>,
    pub most_distance_m: f64,
}

/// The push with the wheel at another height on the axle.
pub(super) struct OtherHeight {
    pub height_m: f64,
    pub z_m: Range,
    /// The same with a time step of 0.001 s.
    pub finer_z_m: Range,
    pub exact_z_m: Range,
}

/// What the linear theory of the scheme says of Method 2, and what its run shows, degrees.
pub(super) struct Lag {
    /// Angle between axle and L in a steady precession.
    pub offset_deg: f64,
    pub predicted_swing_deg: f64,
    pub swing_deg: f64,
}

pub(super) const TILTS_DEG: [f64; 3] = [15.0, 45.0, 75.0];
const MOMENTA: [&str; 4] = ["20.0", "40.0", "60.0", "1000.0"];
const HEIGHTS_M: [&str; 4] = ["0.4", "0.5", "0.65", "0.8"];
const TIME_STEPS_S: [&str; 7] = ["0.1", "0.05", "0.02", "0.01", "0.005", "0.002", "0.001"];

/// The readouts that are the ends of a range.
const Z: [&str; 2] = ["measured_lowest_z_m", "measured_highest_z_m"];
const TILT: [&str; 2] = ["measured_lowest_tilt_deg", "measured_highest_tilt_deg"];
const PRECESSION: &str = "measured_precession_rad_per_s";

impl Numbers {
    /// Reads the numbers from the `tables`; NaN where one is missing.
    ///
    /// # Errors
    /// When a preset cannot be read.
    pub fn read(tables: &Tables) -> Result<Self, Problems> {
        let pushed = Document::open("wobble-push")?.scenario()?;
        let heights = tables.column("method-1", "z_m");
        Ok(Self {
            top: Top::new(&Document::open("method-2")?.scenario()?),
            method_1: Run::read(tables, "method-1")?,
            method_1_steeper: Run::read(tables, "method-1-steeper")?,
            method_2_slow: Run::read(tables, "method-2-slow")?,
            method_2: Run::read(tables, "method-2")?,
            push: Run::read(tables, "wobble-push")?,
            first_x_m: Range::of(&tables.column("method-1", "x_m")),
            later_x_m: Both {
                report: Range::of(&tables.column("half-a-turn-later", "x_m")),
                exact: Range::of(&tables.column("half-a-turn-later-exact", "x_m")),
            },
            back_up_z_m: Range::of(&heights[heights.len() / 2..]).high,
            without_weight: Both::of(|scheme| Flight::read(tables, "no-weight", &["0.0", scheme])),
            spins: ["200.0", "20000.0"].map(|momentum| {
                Both::of(|scheme| Flight::read(tables, "faster-spin", &[momentum, scheme]))
            }),
            of_fast_top: at_tilts(tables, "tilt-fast-top"),
            of_slow_top: at_tilts(tables, "tilt-slow-top"),
            slow_tops: MOMENTA.map(|momentum| SlowTop {
                momentum: momentum.parse().unwrap_or(f64::NAN),
                tilt_deg: Both::of(|scheme| tables.range("slow-tops", &[momentum, scheme], TILT)),
            }),
            finer: TIME_STEPS_S.map(|time_step_s| Finer::read(tables, time_step_s)),
            lag: Lag::read(tables),
            heights: HEIGHTS_M.map(|height_m| OtherHeight::read(tables, height_m)),
            push_torque: push_torque(&pushed),
            length_m: Range::of(&distances(tables, &["x_m", "y_m", "z_m"])),
            radii_m: radii_m(tables, &pushed),
        })
    }

    /// By how much the torque of the weight is too small in Method 2, because the axle is more upright than L, %.
    pub fn weaker_torque_percent(&self) -> f64 {
        let tilt_rad = self.top.tilt_rad;
        let upright_rad = tilt_rad - self.lag.offset_deg.to_radians();
        100.0 * (1.0 - libm::sin(upright_rad) / libm::sin(tilt_rad))
    }

    /// The report's five runs in its order, each with its name.
    pub fn runs(&self) -> [(&'static str, &Run); 5] {
        [
            ("Method 1", &self.method_1),
            ("Method 1, more tilted", &self.method_1_steeper),
            ("Method 2, short steps", &self.method_2_slow),
            ("Method 2, long steps", &self.method_2),
            ("Method 2 with a push", &self.push),
        ]
    }
}

/// Reads the precession at each of [`TILTS_DEG`], rad/s.
fn at_tilts(tables: &Tables, table: &str) -> [Both<f64>; 3] {
    TILTS_DEG.map(|tilt_deg| {
        let label = format!("{tilt_deg:?}");
        Both::of(|scheme| tables.number(table, &[&label, scheme], PRECESSION))
    })
}

impl<T> Both<T> {
    /// Returns what `read` gives for the name of each scheme.
    fn of(read: impl Fn(&str) -> T) -> Self {
        Self {
            report: read("report"),
            exact: read("exact"),
        }
    }
}

impl Range {
    fn of(numbers: &[f64]) -> Self {
        Self {
            low: numbers.iter().copied().fold(f64::INFINITY, f64::min),
            high: numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    pub fn size(self) -> f64 {
        self.high - self.low
    }

    /// The size of a range in m, mm.
    pub fn size_mm(self) -> f64 {
        1000.0 * self.size()
    }

    /// The size as a part of the low end, %.
    pub fn percent(self) -> f64 {
        100.0 * self.size() / self.low
    }

    /// Returns the markup of `0.6171 to 0.9141`, without a unit.
    pub fn markup(self, decimals: usize) -> String {
        let [low, high] = [self.low, self.high].map(|end| with_decimals(end, decimals, ""));
        format!("{low} to {high}")
    }
}

impl Tables {
    /// Reads the readouts that are the ends of a range.
    fn range(&self, table: &str, labels: &[&str], ends: [&str; 2]) -> Range {
        let [low, high] = ends.map(|end| self.number(table, labels, end));
        Range { low, high }
    }
}

impl Top {
    fn new(scenario: &Scenario) -> Self {
        let body = &scenario.body.mechanics;
        let symmetric = SymmetricTop::from_body(body);
        let [across, along] = symmetric.map_or([f64::NAN; 2], |top| [top.across, top.along]);
        Self {
            mass_kg: body.mass(),
            hub_m: body.first_moment().norm() / body.mass(),
            arm_m: scenario.arm_m(),
            across,
            along,
            gravity: scenario.motion.gravity,
            momentum: scenario.start.momentum.norm(),
            tilt_rad: libm::acos(scenario.start.axle().z),
        }
    }

    /// M g h, N m.
    pub fn weight_torque(&self) -> f64 {
        self.mass_kg * self.gravity * self.hub_m
    }

    /// The precession of a fast top, rad/s.
    pub fn precession(&self) -> f64 {
        self.weight_torque() / self.momentum
    }

    /// Time of one turn of the wheel, s.
    pub fn spin_s(&self) -> f64 {
        TAU * self.along / self.momentum
    }

    /// The angle by which the weight turns L in a time step, degrees.
    pub fn kick_deg(&self, time_step_s: f64) -> f64 {
        let torque = self.weight_torque() * libm::sin(self.tilt_rad);
        (torque * time_step_s / self.momentum).to_degrees()
    }

    /// How far the tilt swings if z of the axle's upper end has this range, degrees.
    pub fn tilt_swing_deg(&self, z_m: Range) -> f64 {
        let [low, high] = [z_m.high, z_m.low].map(|z| libm::acos(z / self.arm_m));
        (high - low).to_degrees()
    }

    /// The distance of the axle's upper end from the vertical at the height `z_m`, m.
    pub fn radius_m(&self, z_m: f64) -> f64 {
        (self.arm_m * self.arm_m - z_m * z_m).sqrt()
    }
}

impl Run {
    fn read(tables: &Tables, preset: &str) -> Result<Self, Problems> {
        let scenario = Document::open(preset)?.scenario()?;
        let (axle, momentum) = (scenario.start.axle(), scenario.start.momentum);
        let table = format!("{preset}-numbers");
        let time_step_s = scenario.motion.time_step_s;
        Ok(Self {
            time_step_s,
            duration_s: scenario.steps as f64 * time_step_s,
            start_lag_deg: axle.angle(&momentum).to_degrees(),
            start_azimuth_deg: libm::atan2(axle.y, axle.x).to_degrees(),
            report: Measured::read(tables, &table, "report"),
            exact: Measured::read(tables, &table, "exact"),
            most_distance_m: tables.number(&table, &["report"], "most_distance_m"),
        })
    }

    /// How far the axle goes around by one of the two schemes, degrees.
    pub fn goes_around_deg(&self, measured: &Measured) -> f64 {
        measured.azimuth_deg - self.start_azimuth_deg
    }

    /// By how much a turn of the precession takes longer than in the exact motion, %.
    pub fn slower_percent(&self) -> f64 {
        100.0 * (self.report.turn_s() / self.exact.turn_s() - 1.0)
    }
}

impl Measured {
    fn read(tables: &Tables, table: &str, scheme: &str) -> Self {
        let labels = [scheme];
        Self {
            z_m: tables.range(table, &labels, Z),
            highest_tilt_deg: tables.number(table, &labels, "measured_highest_tilt_deg"),
            azimuth_deg: tables.number(table, &labels, "azimuth_deg"),
            precession: tables.number(table, &labels, PRECESSION),
            nutation_s: tables.number(table, &labels, "measured_nutation_period_s"),
            turns_per_step: tables.number(table, &labels, "turns_per_step"),
            spin_rpm: tables.number(table, &labels, "spin_rpm"),
            momentum: tables.number(table, &labels, "L_Js"),
        }
    }

    /// The time of a turn of the precession, s.
    pub fn turn_s(&self) -> f64 {
        TAU / self.precession
    }

    /// The time of a turn of the wheel, s.
    pub fn spin_s(&self) -> f64 {
        60.0 / self.spin_rpm
    }
}

impl Flight {
    fn read(tables: &Tables, table: &str, labels: &[&str]) -> Self {
        Self {
            spin_rpm: tables.number(table, labels, "spin_rpm"),
            azimuth_deg: tables.number(table, labels, "azimuth_deg"),
            precession: tables.number(table, labels, PRECESSION),
        }
    }
}

impl Finer {
    fn read(tables: &Tables, time_step_s: &str) -> Self {
        let labels = [time_step_s, "report"];
        Self {
            time_step_s: time_step_s.parse().unwrap_or(f64::NAN),
            turns_per_step: tables.number("push-finer", &labels, "turns_per_step"),
            z_m: Both::of(|scheme| tables.range("push-finer", &[time_step_s, scheme], Z)),
            most_distance_m: tables.number("push-finer", &labels, "most_distance_m"),
        }
    }

    /// Whether z swings at most by a tenth more than in the exact motion.
    pub fn is_true(&self) -> bool {
        self.z_m.report.size() < 1.1 * self.z_m.exact.size()
    }
}

impl OtherHeight {
    fn read(tables: &Tables, height_m: &str) -> Self {
        let range = |rest: [&str; 2]| {
            let labels = [height_m, rest[0], rest[1]];
            tables.range("other-heights", &labels, Z)
        };
        Self {
            height_m: height_m.parse().unwrap_or(f64::NAN),
            z_m: range(["0.1", "report"]),
            finer_z_m: range(["0.001", "report"]),
            exact_z_m: range(["0.001", "exact"]),
        }
    }
}

impl Lag {
    fn read(tables: &Tables) -> Self {
        let labels = ["0.1"];
        Self {
            offset_deg: tables.number("comb", &labels, "predicted_lag_deg"),
            predicted_swing_deg: tables.number("comb", &labels, "predicted_tilt_swing_deg"),
            swing_deg: tables.number("comb", &labels, "measured_tilt_swing_deg"),
        }
    }
}

/// Returns the torque of weight and push together, as a multiple of the weight's. Both act at points of the axle.
fn push_torque(scenario: &Scenario) -> f64 {
    let pushes = scenario.pushes.iter().map(|push| {
        let arm_m = scenario.body.mechanics.points()[push.point].at.norm();
        push.force.norm() * arm_m
    });
    1.0 + pushes.sum::<f64>() / Top::new(scenario).weight_torque()
}

/// Returns 2 |sin(psi/2)| of an angle psi in turns.
pub(super) fn chord(turns: f64) -> f64 {
    2.0 * libm::sin(PI * turns).abs()
}

/// Returns the length of the vector of these columns in each row of the push.
fn distances(tables: &Tables, names: &[&str]) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = names
        .iter()
        .map(|name| tables.column("wobble-push", name))
        .collect();
    let rows = 0..columns.first().map_or(0, Vec::len);
    let squares = rows.map(|row| {
        let place = columns.iter().filter_map(|column| column.get(row));
        place.map(|number| number * number).sum::<f64>()
    });
    squares.map(f64::sqrt).collect()
}

/// Returns the greatest distance from the vertical in the two halves of the time after the push of `pushed`, m.
fn radii_m(tables: &Tables, pushed: &Scenario) -> [f64; 2] {
    let end = pushed.pushes.iter().map(|push| match push.window {
        Window::Steps { first, count } => (first + count) as usize,
        Window::Time { .. } => 0,
    });
    let radii = distances(tables, &["x_m", "y_m"]);
    let after = radii.get(end.max().unwrap_or(0)..).unwrap_or_default();
    let (first, second) = after.split_at(after.len() / 2);
    [first, second].map(|half| Range::of(half).high)
}

/// Returns the markup of `number` with so many decimals and its unit.
pub(super) fn with_decimals(number: f64, decimals: usize, unit: &str) -> String {
    quantity(&fixed(number, decimals), unit)
}

/// Returns the markup of `number` with so many significant digits and its unit.
pub(super) fn with_digits(number: f64, digits: usize, unit: &str) -> String {
    quantity(&significant(number, digits), unit)
}
