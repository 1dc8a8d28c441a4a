//! The direction of a push that the user prepares.

use crate::text::number::shortest;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// A point stands on the vertical, where "out" has no direction, if its distance from it is at most this share of its
/// distance from the pivot.
const UPRIGHT: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Toward {
    /// −z, the direction of the weight.
    Down,
    /// +z.
    Up,
    /// Horizontally away from the vertical through the pivot.
    Out,
    /// Horizontally towards that vertical.
    In,
    /// Horizontally around that vertical, counterclockwise seen from above.
    Around,
    /// Horizontally around that vertical, clockwise seen from above.
    Back,
    /// A direction in the world frame.
    Along([f64; 3]),
}

impl TryFrom<String> for Toward {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        Self::typed(&text)
    }
}

impl From<Toward> for String {
    fn from(toward: Toward) -> Self {
        toward.shown()
    }
}

impl Toward {
    pub(super) const NAMED: [(&'static str, Self); 10] = [
        ("down", Self::Down),
        ("up", Self::Up),
        ("out", Self::Out),
        ("in", Self::In),
        ("around", Self::Around),
        ("back", Self::Back),
        ("+x", Self::Along([1.0, 0.0, 0.0])),
        ("-x", Self::Along([-1.0, 0.0, 0.0])),
        ("+y", Self::Along([0.0, 1.0, 0.0])),
        ("-y", Self::Along([0.0, -1.0, 0.0])),
    ];

    /// The direction as text that [`typed`](Self::typed) reads back.
    pub fn shown(self) -> String {
        let named = Self::NAMED.iter().find(|(_, toward)| *toward == self);
        match (named, self) {
            (Some((name, _)), _) => (*name).to_owned(),
            (None, Self::Along(direction)) => direction.map(shortest).join(" "),
            (None, _) => String::new(),
        }
    }

    /// Reads a direction: a name, or three numbers.
    pub fn typed(text: &str) -> Result<Self, String> {
        let text = text.trim().trim_matches(['[', ']']);
        if let Some((_, toward)) = Self::NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(*toward);
        }
        let numbers: Vec<f64> = text
            .split([' ', ','])
            .filter(|part| !part.is_empty())
            .map_while(|part| part.parse().ok().filter(|number: &f64| number.is_finite()))
            .collect();
        let direction = <[f64; 3]>::try_from(numbers).ok();
        let direction = direction.filter(|direction| Vector3::from(*direction).norm() > 0.0);
        direction.map(Self::Along).ok_or_else(|| {
            let names = Self::NAMED.map(|(name, _)| name).join(", ");
            format!("toward must be one of {names}, or three numbers")
        })
    }

    /// The unit vector of the direction, world frame, for a point that stands at `at` (world frame, m).
    ///
    /// # Errors
    /// Where the point stands on the vertical and the direction is relative to it, or where the vector is zero.
    pub(super) fn direction(self, at: &Vector3<f64>) -> Result<Vector3<f64>, String> {
        let out = Vector3::new(at.x, at.y, 0.0);
        let around = Vector3::new(-at.y, at.x, 0.0);
        let direction = match self {
            Self::Down => -Vector3::z(),
            Self::Up => Vector3::z(),
            Self::Along(direction) => Vector3::from(direction),
            _ if out.norm() <= UPRIGHT * at.norm() => {
                return Err("the point stands on the vertical, from where all ways lead out: push along x or y".to_owned());
            }
            Self::Out => out,
            Self::In => -out,
            Self::Around => around,
            Self::Back => -around,
        };
        direction
            .try_normalize(0.0)
            .ok_or_else(|| "the push needs a direction".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_is_a_unit_vector_as_named() {
        let at = Vector3::new(3.0, 4.0, 1.0);
        for (name, toward) in Toward::NAMED {
            let direction = toward.direction(&at).unwrap();
            assert!((direction.norm() - 1.0).abs() < 1e-15, "{name}");
            assert_eq!(Toward::typed(name), Ok(toward));
        }
        let out = Toward::Out.direction(&at).unwrap();
        assert_eq!(out, Vector3::new(0.6, 0.8, 0.0));
        let around = Toward::Around.direction(&at).unwrap();
        assert!(around.dot(&Vector3::new(-0.8, 0.6, 0.0)) > 0.999);
        assert!(Toward::Out.direction(&Vector3::z()).is_err());
        let along = Toward::Along([1.0, -2.0, 0.5]);
        assert_eq!(Toward::typed("[1, -2, 0.5]"), Ok(along));
        for bad in ["", "sideways", "1 2", "1 2 3 4", "0 0 0", "nan 0 0"] {
            assert!(Toward::typed(bad).is_err(), "{bad}");
        }
    }
}
