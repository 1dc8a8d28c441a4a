//! Stores the turning points of the axle's height, and fits a straight line of time and azimuth through them.

/// Maximum number of turning points to keep, and the factor by which the interval between them grows beyond it.
#[derive(Clone, Copy, Debug)]
struct Thinning {
    most: usize,
    keeps_every: u64,
}

/// For a symmetric body.
const OF_ALIKE: Thinning = Thinning {
    most: 32,
    keeps_every: 2,
};
/// For a lopsided body, whose beats must be visible. The body often turns by nearly half a turn from one nutation to
/// the next. Every second point would then show only one half of the beats.
const OF_BEATS: Thinning = Thinning {
    most: 128,
    keeps_every: 3,
};

/// A measured number with its uncertainty, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredNumber {
    pub value: f64,
    /// One standard error of the value.
    pub uncertainty: f64,
    /// Number of nutations measured, with a half nutation counted as one. It is 0 if there was none.
    pub nutations: u64,
}

impl MeasuredNumber {
    /// Maximum relative uncertainty of a settled value that was measured without whole nutations.
    ///
    /// A value measured with nutations is settled if its uncertainty is at most half of it. (An axle that passes
    /// through the vertical has nutations, but no well-defined azimuth.)
    const SETTLED: f64 = 0.05;

    /// Returns true if the uncertainty is small enough for the value to be shown and used.
    pub fn is_settled(&self) -> bool {
        let within = if self.nutations > 0 {
            0.5
        } else {
            Self::SETTLED
        };
        self.uncertainty <= within * self.value.abs()
    }
}

/// Reason why a run has no nutation period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WithoutNutation {
    /// The axle keeps its tilt.
    Steady,
    TooFew,
    /// Some swings are so small relative to the others that counting them would be a matter of convention.
    Uneven,
    /// The body has not turned far enough about its axle to show all lengths of its nutations.
    BeatUnseen,
    /// The rows may miss a turning point.
    RowsTooFarApart,
}

impl WithoutNutation {
    /// Returns the reason in words. It is empty if there is no nutation.
    pub fn words(self) -> &'static str {
        match self {
            Self::Steady => "",
            Self::TooFew => "too few were seen",
            Self::Uneven => "its swings are too uneven to count",
            Self::BeatUnseen => "they vary over a longer time than this run",
            Self::RowsTooFarApart => "the steps are too far apart to see each",
        }
    }
}

/// Swings of the axle's height below this are rounding, and not nutation.
pub(super) const HEIGHT_SWING_ROUNDING: f64 = 1e-9;

/// One turning point of the axle's height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightExtreme {
    pub time_s: f64,
    /// Error of the time from interpolation, s.
    pub time_off_s: f64,
    /// Standard error of the time from all other causes, s.
    pub time_error_s: f64,
    /// Azimuth of the axle, full turns included, rad.
    pub azimuth: f64,
    /// Error of the azimuth from interpolation, rad.
    pub azimuth_off: f64,
    /// Standard error of the azimuth at a given time from all other causes, rad.
    pub azimuth_error: f64,
    /// Rate of the azimuth there, rad/s.
    pub azimuth_rate: f64,
    /// Sine of the tilt there.
    pub level: f64,
    /// Direction of the vertical about the axle, seen from the body, rad.
    pub phase: f64,
}

/// Equally spaced turning points, in bounded memory. The first one is always among them.
#[derive(Clone, Debug)]
pub(super) struct Turns {
    thinning: Thinning,
    kept: Vec<(u64, HeightExtreme)>,
    stride: u64,
}

/// Straight line of time and azimuth from the first turning point to the last, and the scatter of the points between.
#[derive(Clone, Copy, Debug)]
pub(super) struct StraightLine {
    pub first: HeightExtreme,
    pub last: HeightExtreme,
    /// Number of intervals between turning points, from the first to the last.
    pub intervals: u64,
    /// Root mean square deviation of the points between from even times, s.
    pub time_scatter_s: f64,
    /// Root mean square deviation of their azimuths from the line at their times, rad.
    pub azimuth_scatter: f64,
    pub between: usize,
}

impl Turns {
    pub fn new() -> Self {
        Self::thinned_as(OF_ALIKE)
    }

    /// Keeps enough turning points to show the beats of a lopsided body.
    pub fn of_beats() -> Self {
        Self::thinned_as(OF_BEATS)
    }

    fn thinned_as(thinning: Thinning) -> Self {
        Self {
            thinning,
            kept: Vec::new(),
            stride: 1,
        }
    }

    /// Returns true if the turning point of this number is to be kept.
    pub fn wants(&self, number: u64) -> bool {
        number.is_multiple_of(self.stride)
    }

    pub fn keep(&mut self, number: u64, turn: HeightExtreme) {
        self.kept.push((number, turn));
        if self.kept.len() > self.thinning.most {
            self.stride *= self.thinning.keeps_every;
            let stride = self.stride;
            self.kept.retain(|(kept, _)| kept.is_multiple_of(stride));
        }
    }

    /// Returns the kept turning points before the one of this number, with their numbers.
    pub fn before(&self, number: u64) -> impl Iterator<Item = &(u64, HeightExtreme)> {
        self.kept.iter().take_while(move |(at, _)| *at < number)
    }

    /// Returns the line from the first turning point to `last`, which has this number. `None` if they are the same
    /// point.
    pub fn line_to(&self, number: u64, last: HeightExtreme) -> Option<StraightLine> {
        let (_, first) = *self.kept.first().filter(|_| number > 0)?;
        let (mut times, mut azimuths, mut between) = (0.0, 0.0, 0);
        // The known error of the interpolation must not count twice.
        let [begin, end] = [&first, &last].map(|turn| turn.time_s - turn.time_off_s);
        let true_rate =
            (last.azimuth - last.azimuth_off - first.azimuth + first.azimuth_off) / (end - begin);
        for (at, turn) in self.kept[1..].iter().take_while(|(at, _)| *at < number) {
            let way = turn.time_s - turn.time_off_s - begin;
            let turned = turn.azimuth - turn.azimuth_off - first.azimuth + first.azimuth_off;
            times += (way - *at as f64 / number as f64 * (end - begin)).powi(2);
            azimuths += (turned - true_rate * way).powi(2);
            between += 1;
        }
        let [time_scatter_s, azimuth_scatter] =
            [times, azimuths].map(|sum| (sum / between.max(1) as f64).sqrt());
        Some(StraightLine {
            first,
            last,
            intervals: number,
            time_scatter_s,
            azimuth_scatter,
            between,
        })
    }
}

impl StraightLine {
    pub fn time_s(&self) -> f64 {
        self.last.time_s - self.first.time_s
    }

    /// Returns the mean rate of the azimuth, rad/s.
    pub fn rate(&self) -> f64 {
        (self.last.azimuth - self.first.azimuth) / self.time_s()
    }

    /// Returns the standard error of [`time_s`](Self::time_s), s, with the scatter multiplied by `weight`.
    pub fn time_error_s(&self, weight: f64) -> f64 {
        let [first, last] =
            [&self.first, &self.last].map(|turn| libm::hypot(turn.time_off_s, turn.time_error_s));
        let ends = libm::hypot(first, last);
        libm::hypot(ends, 2_f64.sqrt() * weight * self.time_scatter_s)
    }

    /// Returns the standard error of [`rate`](Self::rate), rad/s, with the scatter multiplied by `weight`.
    pub fn rate_error(&self, weight: f64) -> f64 {
        let rate = self.rate();
        let [first, last] = [&self.first, &self.last].map(|turn| {
            let late = (turn.azimuth_rate - rate) * turn.time_error_s;
            let off = turn.azimuth_off - rate * turn.time_off_s;
            libm::hypot(libm::hypot(turn.azimuth_error, late), off)
        });
        let ends = libm::hypot(first, last);
        libm::hypot(ends, 2_f64.sqrt() * weight * self.azimuth_scatter) / self.time_s()
    }
}
