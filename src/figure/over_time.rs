//! A curve over time in bounded memory, with its extremes.

/// At most so many stretches of time are kept: more than the widest page has dots across.
const MOST: usize = 8192;

/// A curve over time: of each stretch of time its first, lowest, highest and last point. The stretches double when there are
/// too many of them.
#[derive(Clone, Debug)]
pub struct OverTime {
    begin_s: f64,
    stretch_s: f64,
    stretches: Vec<Stretch>,
    last: Option<f64>,
    is_rising: Option<bool>,
}

/// Points of one stretch: time, s, and value.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    number: u64,
    first: [f64; 2],
    lowest: [f64; 2],
    highest: [f64; 2],
    last: [f64; 2],
    /// How often the curve turned up or down.
    turns: u64,
}

impl Stretch {
    fn and(&mut self, next: &Self) {
        if next.lowest[1] < self.lowest[1] {
            self.lowest = next.lowest;
        }
        if next.highest[1] > self.highest[1] {
            self.highest = next.highest;
        }
        self.last = next.last;
        self.turns += next.turns;
    }
}

/// How dense a curve is within a stretch of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Density {
    /// Its middle, s.
    pub time_s: f64,
    /// How often the curve turned up or down there.
    pub turns: u64,
    /// Its lowest and its highest value there.
    pub extent: (f64, f64),
}

impl OverTime {
    /// An empty curve; its points are about `apart_s` apart, s.
    pub fn new(apart_s: f64) -> Self {
        Self {
            begin_s: 0.0,
            stretch_s: apart_s.max(f64::MIN_POSITIVE),
            stretches: Vec::new(),
            last: None,
            is_rising: None,
        }
    }

    /// Adds a point, not earlier than those before; one that is not finite is passed over.
    pub fn push(&mut self, time_s: f64, value: f64) {
        if !(time_s.is_finite() && value.is_finite()) {
            return;
        }
        if self.stretches.is_empty() {
            self.begin_s = time_s;
        }
        let point = [time_s, value];
        let mut next = Stretch {
            number: ((time_s - self.begin_s) / self.stretch_s) as u64,
            first: point,
            lowest: point,
            highest: point,
            last: point,
            turns: u64::from(self.has_turned(value)),
        };
        match self.stretches.last_mut() {
            Some(last) if last.number == next.number => last.and(&next),
            _ => {
                while self.stretches.len() >= MOST {
                    self.double();
                    next.number /= 2;
                }
                match self.stretches.last_mut() {
                    Some(last) if last.number == next.number => last.and(&next),
                    _ => self.stretches.push(next),
                }
            }
        }
    }

    fn has_turned(&mut self, value: f64) -> bool {
        let before = self.last.replace(value).unwrap_or(value);
        if value == before {
            return false;
        }
        let is_rising = Some(value > before);
        let was_rising = std::mem::replace(&mut self.is_rising, is_rising);
        was_rising.is_some() && was_rising != is_rising
    }

    /// Makes the stretches twice as long.
    fn double(&mut self) {
        self.stretch_s *= 2.0;
        let mut kept: Vec<Stretch> = Vec::with_capacity(MOST);
        for mut stretch in self.stretches.drain(..) {
            stretch.number /= 2;
            match kept.last_mut() {
                Some(last) if last.number == stretch.number => last.and(&stretch),
                _ => kept.push(stretch),
            }
        }
        self.stretches = kept;
    }

    /// The points, in the order of time: every extreme of the curve is among them.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::with_capacity(4 * self.stretches.len());
        for stretch in &self.stretches {
            let (mut early, mut late) = (stretch.lowest, stretch.highest);
            if early[0] > late[0] {
                std::mem::swap(&mut early, &mut late);
            }
            for point in [stretch.first, early, late, stretch.last] {
                if points.last() != Some(&point) {
                    points.push(point);
                }
            }
        }
        points
    }

    /// How dense the curve is, stretch by stretch.
    pub fn density(&self) -> impl Iterator<Item = Density> {
        self.stretches.iter().map(|stretch| Density {
            time_s: 0.5 * (stretch.first[0] + stretch.last[0]),
            turns: stretch.turns,
            extent: (stretch.lowest[1], stretch.highest[1]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_short_curve_is_kept_as_it_is() {
        let mut curve = OverTime::new(0.1);
        let points = [[0.0, 1.0], [0.1, 3.0], [0.2, 2.0], [0.5, 2.0]];
        points
            .iter()
            .for_each(|point| curve.push(point[0], point[1]));
        assert_eq!(curve.points(), points);
        assert_eq!(curve.density().map(|part| part.turns).sum::<u64>(), 1);
    }

    #[test]
    fn a_time_step_that_becomes_longer_loses_nothing() {
        let mut curve = OverTime::new(1e-3);
        let mut time_s = 0.0;
        for step in 0..60_000_u32 {
            time_s += if step < 50_000 { 1e-3 } else { 0.1 };
            curve.push(time_s, f64::from(step % 7));
        }
        let late = curve
            .points()
            .iter()
            .filter(|point| point[0] > 50.0)
            .count();
        assert!(late > 8000, "{late} points");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn no_extreme_is_lost(seed in any::<u64>(), count in 10_000_usize..60_000) {
            let mut state = seed | 1;
            let mut random = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 33) as f64 / f64::from(u32::MAX)
            };
            let values: Vec<f64> = (0..count).map(|_| random()).collect();
            let mut curve = OverTime::new(0.5);
            values.iter().enumerate().for_each(|(step, &value)| curve.push(0.5 * step as f64, value));
            let points = curve.points();
            prop_assert!(points.len() <= 4 * MOST);
            prop_assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
            // Each sixtieth of the curve keeps its extremes, but for one stretch at its ends.
            let length = count / 60;
            for begin in (0..count - length).step_by(length) {
                let part = &values[begin..begin + length];
                for wanted in [f64::min, f64::max] {
                    let extreme = part.iter().copied().reduce(wanted).unwrap();
                    prop_assert!(points.iter().any(|point| wanted(point[1], extreme) == point[1]
                        && (point[0] / 0.5) as usize + 16 >= begin && point[0] / 0.5 <= (begin + length + 16) as f64));
                }
            }
        }
    }
}
