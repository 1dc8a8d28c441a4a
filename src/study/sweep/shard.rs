//! A part of a sweep's points, for one of several machines.

use std::fmt;
use std::str::FromStr;

/// The shard `number` of `of`: the points `number` - 1, `number` - 1 + `of`, and so on. Neighbours on the grid take about as
/// long as each other, so that all shards of a sweep do too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

/// The most shards of one sweep.
const MOST: u64 = 1_000_000;

impl Shard {
    /// All points.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Which one it is, from 1.
    pub fn number(self) -> u64 {
        self.number
    }

    /// How many there are.
    pub fn of(self) -> u64 {
        self.of
    }

    /// How many of a sweep's `points` belong to it.
    pub fn points(self, points: u64) -> u64 {
        (points + self.of - self.number) / self.of
    }

    /// The point, counted in the whole sweep, that is the `row`-th of this shard, both from 0.
    pub fn point(self, row: u64) -> u64 {
        row * self.of + self.number - 1
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
        for points in 0..20 {
            for of in 1..=7 {
                let mut seen = vec![0; points as usize];
                for number in 1..=of {
                    let shard: Shard = format!("{number}/{of}").parse().unwrap();
                    (0..shard.points(points)).for_each(|row| seen[shard.point(row) as usize] += 1);
                }
                assert!(seen.iter().all(|&count| count == 1), "{points} {of}");
            }
        }
    }

    #[test]
    fn shards_count_from_1() {
        for wrong in [
            "0/3",
            "4/3",
            "1/0",
            "1",
            "a/b",
            "-1/3",
            "1/2/3",
            "1/99999999999",
        ] {
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
