//! Units as they stand at the end of a name (`tilt_deg`, `time_step_s`): what they are called, and how one becomes another.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The end of the name, its underscore included.
    pub end: &'static str,
    /// The unit as it is written in text.
    pub name: &'static str,
    /// What it measures: two units of one kind can be converted.
    kind: Kind,
    /// How many of the SI's unit one of it is.
    in_si: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Time,
    Length,
    Mass,
    Angle,
    Rate,
    Acceleration,
    Moment,
    Momentum,
    Torque,
    Force,
    Energy,
    /// One that nothing else is converted to.
    Alone(u8),
}

const fn unit(end: &'static str, name: &'static str, kind: Kind, in_si: f64) -> Unit {
    Unit {
        end,
        name,
        kind,
        in_si,
    }
}

use std::f64::consts::TAU;

/// The units of the names that gyrolab uses; where one end is the end of another, the longer one comes first.
const OURS: [Unit; 16] = [
    unit("_rad_per_s", "rad/s", Kind::Rate, 1.0),
    unit("_m_per_s2", "m/s2", Kind::Acceleration, 1.0),
    unit("_kg_m2", "kg m2", Kind::Moment, 1.0),
    unit("_Nms2", "N m s2", Kind::Alone(0), 1.0),
    unit("_Nms", "N m s", Kind::Alone(1), 1.0),
    unit("_Nm", "N m", Kind::Torque, 1.0),
    unit("_Js", "J s", Kind::Momentum, 1.0),
    unit("_deg", "deg", Kind::Angle, TAU / 360.0),
    unit("_rpm", "rpm", Kind::Rate, TAU / 60.0),
    unit("_rad", "rad", Kind::Angle, 1.0),
    unit("_kg", "kg", Kind::Mass, 1.0),
    unit("_s", "s", Kind::Time, 1.0),
    unit("_m", "m", Kind::Length, 1.0),
    unit("_N", "N", Kind::Force, 1.0),
    unit("_J", "J", Kind::Energy, 1.0),
    unit("_ns", "ns", Kind::Time, 1e-9),
];

/// Units in which people measure, and in which no name of gyrolab is.
const OTHERS: [Unit; 27] = [
    unit("_deg_per_s", "deg/s", Kind::Rate, TAU / 360.0),
    unit("_g_cm2", "g cm2", Kind::Moment, 1e-7),
    unit("_kg_cm2", "kg cm2", Kind::Moment, 1e-4),
    unit("_g_m2", "g m2", Kind::Moment, 1e-3),
    unit("_cm_per_s2", "cm/s2", Kind::Acceleration, 1e-2),
    unit("_per_s", "1/s", Kind::Rate, TAU),
    unit("_per_min", "1/min", Kind::Rate, TAU / 60.0),
    unit("_Hz", "Hz", Kind::Rate, TAU),
    unit("_rps", "revolutions/s", Kind::Rate, TAU),
    unit("_mNm", "mN m", Kind::Torque, 1e-3),
    unit("_mJs", "mJ s", Kind::Momentum, 1e-3),
    unit("_ms", "ms", Kind::Time, 1e-3),
    unit("_us", "us", Kind::Time, 1e-6),
    unit("_min", "min", Kind::Time, 60.0),
    unit("_h", "h", Kind::Time, 3600.0),
    unit("_sec", "s", Kind::Time, 1.0),
    unit("_seconds", "s", Kind::Time, 1.0),
    unit("_minutes", "min", Kind::Time, 60.0),
    unit("_cm", "cm", Kind::Length, 1e-2),
    unit("_mm", "mm", Kind::Length, 1e-3),
    unit("_km", "km", Kind::Length, 1e3),
    unit("_g", "g", Kind::Mass, 1e-3),
    unit("_degrees", "deg", Kind::Angle, TAU / 360.0),
    unit("_radians", "rad", Kind::Angle, 1.0),
    unit("_mrad", "mrad", Kind::Angle, 1e-3),
    unit("_mN", "mN", Kind::Force, 1e-3),
    unit("_mJ", "mJ", Kind::Energy, 1e-3),
];

impl Unit {
    /// The unit at the end of `name`, of those that gyrolab uses.
    pub fn of(name: &str) -> Option<&'static Self> {
        OURS.iter().find(|unit| name.ends_with(unit.end))
    }

    /// The unit at the end of `name`, of those that anybody uses: the one whose end is the longest.
    pub fn anybodys(name: &str) -> Option<&'static Self> {
        let known = OURS.iter().chain(&OTHERS);
        let fits = known.filter(|unit| name.ends_with(unit.end));
        fits.max_by_key(|unit| unit.end.len())
    }

    /// By what a number in this unit is multiplied to be one in `other`; `None` where they do not measure the same.
    pub fn times(&self, other: &Self) -> Option<f64> {
        (self.kind == other.kind).then(|| self.in_si / other.in_si)
    }
}

/// `name` with `word` before its unit: `tilt_deg` becomes `tilt_uncertainty_deg`. Of the parts of a vector, whose names end
/// with a number, the unit stands before that.
pub fn with_word(name: &str, word: &str) -> String {
    let (name, place) = match name.rsplit_once('.') {
        Some((name, place)) if place.parse::<usize>().is_ok() => (name, format!(".{place}")),
        _ => (name, String::new()),
    };
    let end = Unit::of(name).map_or("", |unit| unit.end);
    let stem = &name[..name.len() - end.len()];
    format!("{stem}_{word}{end}{place}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_end_is_the_unit() {
        for (name, unit) in [
            ("wx_rad_per_s", "rad/s"),
            ("motion.gravity_m_per_s2", "m/s2"),
            ("t_min", "min"),
            ("tilt_rad", "rad"),
            ("nutation_per_min", "1/min"),
            ("spin_rad_per_s", "rad/s"),
        ] {
            assert_eq!(Unit::anybodys(name).map(|unit| unit.name), Some(unit));
        }
        assert_eq!(Unit::of("kappa"), None);
        // Found first, it is found right.
        for end in OURS.iter().map(|unit| unit.end).chain(["spin_rad_per_s"]) {
            assert_eq!(Unit::of(end), Unit::anybodys(end), "{end}");
        }
    }

    #[test]
    fn one_unit_becomes_another_of_its_kind() {
        let times = |from: &str, to: &str| Unit::anybodys(from)?.times(Unit::of(to)?);
        assert_eq!(times("t_min", "t_s"), Some(60.0));
        assert_eq!(times("spin_Hz", "spin_rpm"), Some(60.0));
        assert_eq!(times("x_cm", "x_m"), Some(0.01));
        assert_eq!(times("tilt_deg", "t_s"), None);
    }

    #[test]
    fn a_word_stands_before_the_unit() {
        for (name, with) in [
            ("tilt_deg", "tilt_uncertainty_deg"),
            ("Lx_Js", "Lx_uncertainty_Js"),
            ("kappa", "kappa_uncertainty"),
            ("start.spin_rpm", "start.spin_uncertainty_rpm"),
            ("body.point.0.at_m.2", "body.point.0.at_uncertainty_m.2"),
            (
                "measured_precession_rad_per_s",
                "measured_precession_uncertainty_rad_per_s",
            ),
        ] {
            assert_eq!(with_word(name, "uncertainty"), with);
        }
    }
}
