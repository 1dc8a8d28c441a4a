//! A part of a sweep's points, for one of several machines.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The shard `number` of `of`: of the points in their order the `number`-th of `of` ranges, which are as long as each other
/// or differ by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub number: u64,
    pub of: u64,
}

const MOST: u64 = 1_000_000;

impl Shard {
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// The points, of all `points` of a sweep, that belong to it.
    pub fn range(self, points: u64) -> Range<u64> {
        let begin = |number| points * number / self.of; // both are small enough for u64
        begin(self.number - 1)..begin(self.number)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/');
        let numbers =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) && of <= MOST => {
                Ok(Self { number, of })
            }
            Some((number, of)) if number > of && (1..=MOST).contains(&of) => {
                Err(format!("must be one of the shards 1/{of} to {of}/{of}"))
            }
            _ => Err(format!(
                "must be K/N, such as 3/8: the K-th of N shards, K from 1, N at most {MOST}"
            )),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_belongs_to_one_shard() {
        for (points, of) in [(0, 3), (1, 7), (20, 6), (999_999_999, 1_000_000)] {
            let ranges = (1..=of).map(|number| Shard { number, of }.range(points));
            let end = ranges.fold(0, |end, range| {
                assert!(range.start == end && range.end - end <= points / of + 1);
                range.end
            });
            assert_eq!(end, points);
        }
    }

    #[test]
    fn shards_count_from_1() {
        for wrong in ["0/3", "1", "a/b", "-1/3", "1/2/3", "1/99999999999"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
        // Where there are no shards at all none of them is proposed.
        for (wrong, rule) in [("4/3", "1/3 to 3/3"), ("1/0", "must be K/N")] {
            let told = wrong.parse::<Shard>().unwrap_err();
            assert!(told.contains(rule), "{wrong}: {told}");
        }
        assert_eq!("3/3".parse::<Shard>().unwrap().to_string(), "3/3");
    }
}
