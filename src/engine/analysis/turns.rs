//! The turning points of the axle's height, and the straight line of time and azimuth through them.

/// How many turning points are kept at most, and every how manyth is left when there are more.
#[derive(Clone, Copy, Debug)]
struct Thinning {
    most: usize,
    keeps_every: u64,
}

/// Of a symmetric body.
const OF_ALIKE: Thinning = Thinning {
    most: 32,
    keeps_every: 2,
};
/// Of a lopsided one, whose beats must be seen. Often they turn the body by nearly half a turn from one nutation to the next:
/// every second point would show one half of them alone.
const OF_BEATS: Thinning = Thinning {
    most: 128,
    keeps_every: 3,
};

/// A measured number with its uncertainty, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredNumber {
    pub value: f64,
    /// One standard error.
    pub uncertainty: f64,
    /// How many nutations it was taken from, a half one counted as one; 0 where there was none.
    pub nutations: u64,
}

impl MeasuredNumber {
    /// A value measured without whole nutations is settled once its relative uncertainty is at most this, one measured with
    /// them once the uncertainty is at most half of the value. (An axle that passes through the vertical has nutations but no well-defined azimuth.)
    const SETTLED: f64 = 0.05;

    /// Whether the uncertainty is small enough for the value to be shown and gone by.
    pub fn is_settled(&self) -> bool {
        let within = if self.nutations > 0 {
            0.5
        } else {
            Self::SETTLED
        };
        self.uncertainty <= within * self.value.abs()
    }
}

/// Why a run has no nutation period to state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WithoutNutation {
    /// The axle keeps its tilt.
    Steady,
    TooFew,
    /// It has swings so small beside the others that a rule would have to say whether they count.
    Uneven,
    /// The body has not turned so far about its axle that all lengths of its nutations were seen.
    BeatUnseen,
    /// The rows may miss a turning point.
    RowsTooFarApart,
}

impl WithoutNutation {
    /// The reason in words; empty where there is no nutation.
    pub fn words(self) -> &'static str {
        match self {
            Self::Steady => "",
            Self::TooFew => "too few were seen",
            Self::Uneven => "its swings are too uneven to be counted",
            Self::BeatUnseen => "they change over more time than this run",
            Self::RowsTooFarApart => "the steps are too far apart to see each",
        }
    }
}

/// A swing of the axle's height smaller than this is rounding, not nutation.
pub(super) const HEIGHT_SWING_ROUNDING: f64 = 1e-9;

/// One turning point of the axle's height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightExtreme {
    pub time_s: f64,
    /// How far the time is off by its interpolation, s.
    pub time_off_s: f64,
    /// Standard error of the time from all else, s.
    pub time_error_s: f64,
    /// Azimuth of the axle, full turns included, rad.
    pub azimuth: f64,
    /// How far the azimuth is off by its interpolation, rad.
    pub azimuth_off: f64,
    /// Standard error of the azimuth at a given time from all else, rad.
    pub azimuth_error: f64,
    /// Rate of the azimuth there, rad/s.
    pub azimuth_rate: f64,
    /// Sine of the tilt there.
    pub level: f64,
    /// In which direction of the body the vertical is there, about the axle, rad.
    pub phase: f64,
}

/// Turning points at even distances, in bounded memory, the first always among them.
#[derive(Clone, Debug)]
pub(super) struct Turns {
    thinning: Thinning,
    kept: Vec<(u64, HeightExtreme)>,
    stride: u64,
}

/// The straight line of time and azimuth from the first turning point to the last, and how far those between are off it.
#[derive(Clone, Copy, Debug)]
pub(super) struct StraightLine {
    pub first: HeightExtreme,
    pub last: HeightExtreme,
    /// How many intervals between two turning points there are from the first to the last.
    pub intervals: u64,
    /// Root mean square of the others' distance from even times, s.
    pub time_scatter_s: f64,
    /// The same of the azimuth at their times, rad.
    pub azimuth_scatter: f64,
    pub between: usize,
}

impl Turns {
    pub fn new() -> Self {
        Self::thinned_as(OF_ALIKE)
    }

    /// Keeps as many as it takes to see a lopsided body's beats.
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

    /// Whether the turning point of this number is to be kept.
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

    /// The turning points before that of this number, each with its own.
    pub fn before(&self, number: u64) -> impl Iterator<Item = &(u64, HeightExtreme)> {
        self.kept.iter().take_while(move |(at, _)| *at < number)
    }

    /// The line from the first turning point to `last`, which has this number; `None` if they are the same.
    pub fn line_to(&self, number: u64, last: HeightExtreme) -> Option<StraightLine> {
        let (_, first) = *self.kept.first().filter(|_| number > 0)?;
        let (mut times, mut azimuths, mut between) = (0.0, 0.0, 0);
        // What the interpolation is known to be off by does not count twice.
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

    /// Mean rate of the azimuth, rad/s.
    pub fn rate(&self) -> f64 {
        (self.last.azimuth - self.first.azimuth) / self.time_s()
    }

    /// Standard error of [`time_s`](Self::time_s), s, where the scatter counts `weight` times.
    pub fn time_error_s(&self, weight: f64) -> f64 {
        let [first, last] =
            [&self.first, &self.last].map(|turn| libm::hypot(turn.time_off_s, turn.time_error_s));
        let ends = libm::hypot(first, last);
        libm::hypot(ends, 2_f64.sqrt() * weight * self.time_scatter_s)
    }

    /// Standard error of [`rate`](Self::rate), rad/s, likewise.
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
