//! The intermediate results of one time step, phase by phase.
//!
//! A scheme passes its phases to a listener. Its step is one function for every listener. The plain step has a listener
//! that does nothing and costs nothing; the explained step fills a list of [phases](Phase). The numbers shown are therefore
//! those that made the step.

use super::Loads;
use nalgebra::{Matrix3, Vector3};
use std::fmt;

/// Makes the enum of the phases of a time step, the list of all, and their texts from one table.
macro_rules! phase_names {
    ($($name:ident = $text:literal,)*) => {
        /// The name of a phase. The phases of the report's scheme come first, in its order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum PhaseName {
            $(#[doc = $text] $name,)*
        }

        impl PhaseName {
            /// Every name.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Returns the words by which files and commands choose the phase.
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }

            /// True if the phase computes a slope of a Runge-Kutta scheme.
            pub fn is_slope(self) -> bool {
                self.text().starts_with("slope")
            }
        }
    };
}

phase_names! {
    Inertia = "inertia",
    AngularVelocity = "angular velocity",
    AxisAndAngle = "axis and angle",
    Rotation = "rotation",
    NewPositions = "new positions",
    Torque = "torque",
    NewMomentum = "new momentum",
    Friction = "friction",
    Kick = "kick",
    FreeMotion = "free motion",
    SpinAboutAxle = "spin about the axle",
    RoundingTakenOut = "rounding taken out",
    NewOrientation = "new orientation",
    Slope1AtBeginning = "slope 1: at the beginning",
    Slope2HalfWay = "slope 2: half way by slope 1",
    Slope3HalfWay = "slope 3: half way by slope 2",
    Slope4AtEnd = "slope 4: at the end by slope 3",
    ThetaFunctions = "theta functions",
    TaylorSeries = "Taylor series",
}

impl fmt::Display for PhaseName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.text())
    }
}

/// Rows between two sums that are stored.
const ROWS_PER_SUM: usize = 256;
/// Rows are added up in turn to so many sums, which are added last, as the report's scheme does it with its points: the
/// sum of all rows is then the scheme's to the last bit.
const SUM_LANES: usize = 2;

/// The workings of one time step.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Workings {
    /// The parts of the step in the order of time. There is one part, unless a push begins or ends within the step and the
    /// scheme is [continuous](super::SchemeInfo::continuous).
    pub parts: Vec<LoadInterval>,
}

/// The part of a time step during which no force changes.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadInterval {
    /// Its length, s.
    pub length_s: f64,
    /// The forces that act during it.
    pub loads: Loads,
    /// What the scheme computed, in this order.
    pub phases: Vec<Phase>,
}

/// One phase of a time step.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// Its name.
    pub name: PhaseName,
    /// The formula as a line of Unicode text.
    pub formula: &'static str,
    /// The part of the state that it changes.
    pub changes: PhaseTarget,
    /// The numbers: first those that are used, last the result.
    pub quantities: Vec<WorkedQuantity>,
}

/// The part of the state that a phase changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseTarget {
    /// Nothing: it computes a number for a later phase.
    Nothing,
    /// The orientation.
    Orientation,
    /// The angular momentum.
    Momentum,
    /// Both.
    Both,
}

/// A number, vector, matrix or table with its symbol.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkedQuantity {
    /// The symbol in the formula. Vectors and matrices are in the world frame.
    pub symbol: &'static str,
    /// Unit; empty for a pure number, and for a table, because its columns have units.
    pub unit: &'static str,
    /// Its value.
    pub value: WorkedValue,
}

/// The value of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum WorkedValue {
    /// A number.
    Number(f64),
    /// A vector.
    Vector(Vector3<f64>),
    /// A matrix.
    Matrix(Matrix3<f64>),
    /// Numbers of each point.
    Table(PointTable),
}

/// Numbers of the points of the body, one row per point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointTable {
    /// Symbol and unit of each column.
    pub columns: &'static [(&'static str, &'static str)],
    /// The index of each row's point in the body.
    pub points: Vec<usize>,
    /// The numbers, row by row.
    pub cells: Vec<f64>,
}

/// Takes in the phases of a step, each of which is made only where it is listened to.
pub(crate) trait Listener {
    const LISTENS: bool;

    fn hear(&mut self, phase: impl FnOnce() -> Phase);
}

/// The listener of a plain step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nobody;

impl Listener for Nobody {
    const LISTENS: bool = false;

    #[inline(always)]
    fn hear(&mut self, _: impl FnOnce() -> Phase) {}
}

impl Listener for Vec<Phase> {
    const LISTENS: bool = true;

    fn hear(&mut self, phase: impl FnOnce() -> Phase) {
        self.push(phase());
    }
}

impl Workings {
    /// All phases in the order in which they were computed.
    pub fn phases(&self) -> impl DoubleEndedIterator<Item = &Phase> {
        self.parts.iter().flat_map(|part| &part.phases)
    }
}

impl Phase {
    pub(crate) fn new(name: PhaseName, formula: &'static str) -> Self {
        Self {
            name,
            formula,
            changes: PhaseTarget::Nothing,
            quantities: Vec::new(),
        }
    }

    /// The same, with one more quantity behind the others.
    pub(crate) fn with(
        mut self,
        symbol: &'static str,
        unit: &'static str,
        value: impl Into<WorkedValue>,
    ) -> Self {
        self.quantities
            .push(WorkedQuantity::new(symbol, unit, value));
        self
    }

    pub(crate) fn changing(self, changes: PhaseTarget) -> Self {
        Self { changes, ..self }
    }

    /// The quantity with that symbol.
    pub fn value(&self, symbol: &str) -> Option<&WorkedValue> {
        let mut quantities = self.quantities.iter();
        let found = quantities.find(|quantity| quantity.symbol == symbol);
        found.map(|quantity| &quantity.value)
    }
}

impl WorkedQuantity {
    /// `value` under its `symbol`, in `unit`.
    pub fn new(symbol: &'static str, unit: &'static str, value: impl Into<WorkedValue>) -> Self {
        Self {
            symbol,
            unit,
            value: value.into(),
        }
    }
}

impl PointTable {
    pub(crate) fn new(columns: &'static [(&'static str, &'static str)]) -> Self {
        Self {
            columns,
            points: Vec::new(),
            cells: Vec::new(),
        }
    }

    /// Adds a row for the point of this index, as long as there are columns.
    pub(crate) fn add<const COLUMNS: usize>(&mut self, point: usize, row: [f64; COLUMNS]) {
        debug_assert_eq!(COLUMNS, self.columns.len());
        self.points.push(point);
        self.cells.extend(row);
    }

    /// The rows, each with the index of its point.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[f64])> {
        let rows = self.cells.chunks_exact(self.columns.len().max(1));
        self.points.iter().copied().zip(rows)
    }

    /// The numbers of this row, from 0; none where there is no such row.
    pub fn row(&self, row: usize) -> &[f64] {
        let columns = self.columns.len();
        let cells = self.cells.get(row * columns..(row + 1) * columns);
        cells.unwrap_or_default()
    }
}

impl From<f64> for WorkedValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<Vector3<f64>> for WorkedValue {
    fn from(vector: Vector3<f64>) -> Self {
        Self::Vector(vector)
    }
}

impl From<Matrix3<f64>> for WorkedValue {
    fn from(matrix: Matrix3<f64>) -> Self {
        Self::Matrix(matrix)
    }
}

impl From<PointTable> for WorkedValue {
    fn from(table: PointTable) -> Self {
        Self::Table(table)
    }
}

/// Sums of the columns of a table, stored after every 256 rows: the sum of any number of rows is at most 255 rows away.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSums {
    columns: usize,
    /// After 0, 256, 512 ... rows: the sums of every second row from the first, column by column, and then those of every
    /// second row from the second.
    stored: Vec<f64>,
}

impl ColumnSums {
    /// The sums of `table`; its rows are visited once.
    pub fn from_table(table: &PointTable) -> Self {
        let columns = table.columns.len();
        let mut lanes = vec![0.0; SUM_LANES * columns];
        let mut stored = lanes.clone();
        for (row, (_, cells)) in table.rows().enumerate() {
            add(&mut lanes, row, cells);
            if (row + 1) % ROWS_PER_SUM == 0 {
                stored.extend_from_slice(&lanes);
            }
        }
        Self { columns, stored }
    }

    /// The sum of each column over the first `most_rows` rows of `table`, which is the one they were made of.
    pub fn first(&self, table: &PointTable, most_rows: usize) -> Vec<f64> {
        let rows = most_rows.min(table.points.len());
        let from = rows / ROWS_PER_SUM;
        let width = SUM_LANES * self.columns;
        let stored = self.stored.get(from * width..(from + 1) * width);
        let mut lanes = stored.map_or_else(|| vec![0.0; width], <[f64]>::to_vec);
        for row in from * ROWS_PER_SUM..rows {
            add(&mut lanes, row, table.row(row));
        }
        let (even, odd) = lanes.split_at(self.columns);
        even.iter().zip(odd).map(|(even, odd)| even + odd).collect()
    }
}

fn add(lanes: &mut [f64], row: usize, cells: &[f64]) {
    let begin = row % SUM_LANES * cells.len();
    for (sum, cell) in lanes[begin..].iter_mut().zip(cells) {
        *sum += cell;
    }
}
