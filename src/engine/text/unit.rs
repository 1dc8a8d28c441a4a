//! Units at the end of a name (`tilt_deg`, `time_step_s`): their names, their spellings in other programs (`x (cm)`,
//! `gx_dps`), and conversions.
//!
//! A new unit is a row of `OURS` if a name of gyrolab ends with it, otherwise of `OTHER_UNITS`.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Ending of the name, with its underscore.
    pub end: &'static str,
    /// Unit as written in text.
    pub name: &'static str,
    /// Quantity that it measures. Two units of one kind can be converted.
    pub kind: UnitKind,
    /// Size of this unit in SI units.
    in_si: f64,
}

/// Quantity that a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitKind {
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
    /// A quantity with a single unit, which cannot be converted.
    Alone(u8),
}

const fn unit(end: &'static str, name: &'static str, kind: UnitKind, in_si: f64) -> Unit {
    Unit {
        end,
        name,
        kind,
        in_si,
    }
}

use std::f64::consts::TAU;

/// Units in the names that gyrolab uses. If one ending ends with another, the longer one comes first.
const OURS: [Unit; 16] = [
    unit("_rad_per_s", "rad/s", UnitKind::Rate, 1.0),
    unit("_m_per_s2", "m/s2", UnitKind::Acceleration, 1.0),
    unit("_kg_m2", "kg m2", UnitKind::Moment, 1.0),
    unit("_Nms2", "N m s2", UnitKind::Alone(0), 1.0),
    unit("_Nms", "N m s", UnitKind::Alone(1), 1.0),
    unit("_Nm", "N m", UnitKind::Torque, 1.0),
    unit("_Js", "J s", UnitKind::Momentum, 1.0),
    unit("_deg", "deg", UnitKind::Angle, TAU / 360.0),
    unit("_rpm", "rpm", UnitKind::Rate, TAU / 60.0),
    unit("_rad", "rad", UnitKind::Angle, 1.0),
    unit("_kg", "kg", UnitKind::Mass, 1.0),
    unit("_s", "s", UnitKind::Time, 1.0),
    unit("_m", "m", UnitKind::Length, 1.0),
    unit("_N", "N", UnitKind::Force, 1.0),
    unit("_J", "J", UnitKind::Energy, 1.0),
    unit("_ns", "ns", UnitKind::Time, 1e-9),
];

/// Units that people measure in, but which are not in any name of gyrolab.
const OTHER_UNITS: [Unit; 30] = [
    unit("_deg_per_s", "deg/s", UnitKind::Rate, TAU / 360.0),
    unit("_dps", "deg/s", UnitKind::Rate, TAU / 360.0),
    unit("_deg_s", "deg/s", UnitKind::Rate, TAU / 360.0),
    unit("_rad_s", "rad/s", UnitKind::Rate, 1.0),
    unit("_g_cm2", "g cm2", UnitKind::Moment, 1e-7),
    unit("_kg_cm2", "kg cm2", UnitKind::Moment, 1e-4),
    unit("_g_m2", "g m2", UnitKind::Moment, 1e-3),
    unit("_cm_per_s2", "cm/s2", UnitKind::Acceleration, 1e-2),
    unit("_per_s", "1/s", UnitKind::Rate, TAU),
    unit("_per_min", "1/min", UnitKind::Rate, TAU / 60.0),
    unit("_Hz", "Hz", UnitKind::Rate, TAU),
    unit("_rps", "revolutions/s", UnitKind::Rate, TAU),
    unit("_mNm", "mN m", UnitKind::Torque, 1e-3),
    unit("_mJs", "mJ s", UnitKind::Momentum, 1e-3),
    unit("_ms", "ms", UnitKind::Time, 1e-3),
    unit("_us", "us", UnitKind::Time, 1e-6),
    unit("_min", "min", UnitKind::Time, 60.0),
    unit("_h", "h", UnitKind::Time, 3600.0),
    unit("_sec", "s", UnitKind::Time, 1.0),
    unit("_seconds", "s", UnitKind::Time, 1.0),
    unit("_minutes", "min", UnitKind::Time, 60.0),
    unit("_cm", "cm", UnitKind::Length, 1e-2),
    unit("_mm", "mm", UnitKind::Length, 1e-3),
    unit("_km", "km", UnitKind::Length, 1e3),
    unit("_g", "g", UnitKind::Mass, 1e-3),
    unit("_degrees", "deg", UnitKind::Angle, TAU / 360.0),
    unit("_radians", "rad", UnitKind::Angle, 1.0),
    unit("_mrad", "mrad", UnitKind::Angle, 1e-3),
    unit("_mN", "mN", UnitKind::Force, 1e-3),
    unit("_mJ", "mJ", UnitKind::Energy, 1e-3),
];

impl Unit {
    /// Returns the unit at the end of `name`, among the units of gyrolab's names.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        OURS.iter().find(|unit| name.ends_with(unit.end))
    }

    /// Returns the unit at the end of `name`, among all known units. The longest ending wins.
    pub fn anybodys(name: &str) -> Option<&'static Self> {
        let known = OURS.iter().chain(&OTHER_UNITS);
        let fits = known.filter(|unit| name.ends_with(unit.end));
        fits.max_by_key(|unit| unit.end.len())
    }

    /// Parses a unit as people write it: `s`, `m/s2`, `°/s`, `deg s^-1`, `1/min`.
    pub fn written(text: &str) -> Option<&'static Self> {
        let name = plain(text);
        let mut known = OURS.iter().chain(&OTHER_UNITS);
        let in_lower_case = name.to_lowercase();
        let alias = ALIASES
            .iter()
            .find(|(written, _)| *written == in_lower_case);
        known
            .clone()
            .find(|unit| unit.name.replace(' ', "") == name)
            .or_else(|| {
                let (_, end) = alias?;
                known.clone().find(|unit| unit.end == *end)
            })
            .or_else(|| {
                known.find(|unit| unit.name.replace(' ', "").to_lowercase() == in_lower_case)
            })
    }

    /// Splits the name of a column into the bare name and its unit: `x (cm)`, `t [ms]`, `x / cm`, `x in cm`, `gx_dps`.
    pub fn split(text: &str) -> Option<(&str, &'static Self)> {
        let name = text.trim();
        let (stem, unit) = Self::in_brackets(name)
            .or_else(|| Self::behind(name, "/"))
            .or_else(|| Self::behind(name, " in "))
            .or_else(|| Self::at_end(name))?;
        Some((stem.trim(), unit))
    }

    fn in_brackets(name: &str) -> Option<(&str, &'static Self)> {
        let opening = match name.chars().last()? {
            ')' => '(',
            ']' => '[',
            '}' => '{',
            _ => return None,
        };
        let (stem, unit) = name[..name.len() - 1].rsplit_once(opening)?;
        let name_alone = stem.trim_end().trim_end_matches('/');
        Some((name_alone, Self::written(unit)?))
    }

    fn behind<'a>(name: &'a str, sign: &str) -> Option<(&'a str, &'static Self)> {
        let (stem, unit) = name.split_once(sign)?;
        Some((stem, Self::written(unit)?))
    }

    fn at_end(name: &str) -> Option<(&str, &'static Self)> {
        // The first separator leaves the longest unit after it: "rad_per_s" and not "s".
        let mut separators = name.match_indices(['_', '-', '.', ' ']);
        separators.find_map(|(at, _)| {
            let unit = name[at + 1..].replace(['-', '.', ' '], "_");
            let known = OURS
                .iter()
                .chain(&OTHER_UNITS)
                .find(|known| known.end[1..] == unit);
            Some((&name[..at], known.or_else(|| Self::written(&unit))?))
        })
    }

    /// Returns the factor from this unit to `other`. `None` if they measure different quantities.
    pub fn times(&self, other: &Self) -> Option<f64> {
        (self.kind == other.kind).then(|| self.in_si / other.in_si)
    }
}

/// Other names of units, in lower case and without blanks, and the ending that each unit has here.
const ALIASES: [(&str, &str); 23] = [
    ("newton", "_N"),
    ("newtons", "_N"),
    ("sec", "_s"),
    ("sek", "_s"),
    ("second", "_s"),
    ("seconds", "_s"),
    ("msec", "_ms"),
    ("millisecond", "_ms"),
    ("milliseconds", "_ms"),
    ("microseconds", "_us"),
    ("nanoseconds", "_ns"),
    ("minutes", "_min"),
    ("meter", "_m"),
    ("meters", "_m"),
    ("degree", "_deg"),
    ("degrees", "_deg"),
    ("radian", "_rad"),
    ("radians", "_rad"),
    ("dps", "_deg_per_s"),
    ("rps", "_rps"),
    ("rev/s", "_rps"),
    ("rev/min", "_rpm"),
    ("u/min", "_rpm"),
];

/// Returns `text` without blanks, with ASCII letters for signs, and with `per s` or `s^-1` as `/s`.
fn plain(text: &str) -> String {
    let mut plain = text
        .trim()
        .replace(['°', 'º', '˚'], "deg")
        .replace(['µ', 'μ'], "u");
    for (written, short) in [
        ("²", "2"),
        ("^2", "2"),
        ("⁻¹", "^-1"),
        ("−", "-"),
        ("_per_", "/"),
        (" per ", "/"),
    ] {
        plain = plain.replace(written, short);
    }
    plain.retain(|c| !c.is_whitespace() && !"·⋅*".contains(c));
    for of in ["s", "sec", "min"] {
        for power in ["^-1", "^(-1)", "-1"] {
            if let Some(front) = plain.strip_suffix(&format!("{of}{power}")) {
                plain = format!("{}/{of}", if front.is_empty() { "1" } else { front });
            }
        }
    }
    for (long, short) in [
        ("degrees/", "deg/"),
        ("degree/", "deg/"),
        ("radians/", "rad/"),
        ("radian/", "rad/"),
    ] {
        plain = plain.replace(long, short);
    }
    for (long, short) in [("/second", "/s"), ("/sec", "/s")] {
        if let Some(front) = plain.strip_suffix(long) {
            plain = front.to_owned() + short;
        }
    }
    plain
}

/// Parses a number that a person typed as an answer in `unit` (empty: a pure number), and returns it in that unit. A
/// unit of the same kind may follow the number, and a comma may be the decimal point.
///
/// # Errors
/// Returns a message if it is not such a number.
pub fn number_in(unit: &str, typed: &str) -> Result<f64, String> {
    let plain_text = typed.trim().replace(',', ".").replace('−', "-");
    let ends = plain_text.char_indices().map(|(at, c)| at + c.len_utf8());
    let parsed = ends.rev().find_map(|end| {
        let (number, rest) = plain_text.split_at(end);
        let number: f64 = number.trim_end().parse().ok()?;
        number.is_finite().then_some((number, rest.trim()))
    });
    let (number, stated) = parsed.ok_or("must be a number, such as 2.5 or 1e-3")?;
    if stated.is_empty() || stated == unit {
        return Ok(number);
    }
    let units = (Unit::written(stated), Unit::written(unit));
    if let (Some(own), Some(wanted)) = units
        && let Some(times) = own.times(wanted)
    {
        return Ok(number * times);
    }
    Err(match unit {
        "" => format!("must be a number alone, without {stated}"),
        unit => format!("must be in {unit}, not in {stated}"),
    })
}

/// Returns the name that `is_known` accepts and that equals `name` in another unit, with the factor to that unit:
/// `t_ms` is `t_s` times 0.001.
pub fn in_known_unit(name: &str, is_known: impl Fn(&str) -> bool) -> Option<(String, f64)> {
    if is_known(name) {
        return Some((name.to_owned(), 1.0));
    }
    let (front, place) = match name.rsplit_once('.') {
        Some((front, place)) if place.parse::<usize>().is_ok() => (front, &name[front.len()..]),
        _ => (name, ""),
    };
    let other = Unit::anybodys(front)?;
    let stem = &front[..front.len() - other.end.len()];
    OURS.iter().find_map(|ours| {
        let factor = other.times(ours)?;
        let known = format!("{stem}{}{place}", ours.end);
        is_known(&known).then_some((known, factor))
    })
}

/// Returns `name` with `word` inserted before its unit: `tilt_deg` becomes `tilt_uncertainty_deg`. Components of a
/// vector have a number after their unit.
pub fn with_word(name: &str, word: &str) -> String {
    let (name, place) = match name.rsplit_once('.') {
        Some((name, place)) if place.parse::<usize>().is_ok() => (name, format!(".{place}")),
        _ => (name, String::new()),
    };
    let end = Unit::from_name(name).map_or("", |unit| unit.end);
    let stem = &name[..name.len() - end.len()];
    format!("{stem}_{word}{end}{place}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_ending_is_the_unit() {
        for (name, unit) in [
            ("wx_rad_per_s", "rad/s"),
            ("motion.gravity_m_per_s2", "m/s2"),
            ("t_min", "min"),
            ("tilt_rad", "rad"),
            ("nutation_per_min", "1/min"),
            ("spin_rad_per_s", "rad/s"),
        ] {
            assert_eq!(Unit::anybodys(name).map(|found| found.name), Some(unit));
        }
        assert_eq!(Unit::from_name("kappa"), None);
        // The first match must be the correct one.
        for end in OURS.iter().map(|unit| unit.end).chain(["spin_rad_per_s"]) {
            assert_eq!(Unit::from_name(end), Unit::anybodys(end), "{end}");
        }
    }

    #[test]
    fn units_of_columns_are_recognized_in_many_forms() {
        for (name, stem, unit) in [
            ("x (cm)", "x", "cm"),
            ("Gyr X (°/s)", "Gyr X", "deg/s"),
            ("Gyroscope x(rad/s)", "Gyroscope x", "rad/s"),
            ("\u{3c9}_z / (rad s^-1)", "\u{3c9}_z", "rad/s"),
            ("X [rad s⁻¹]", "X", "rad/s"),
            ("rotation x (degrees per second)", "rotation x", "deg/s"),
            ("t / ms", "t", "ms"),
            ("x/m", "x", "m"),
            ("x in mm", "x", "mm"),
            ("timestamp_ms", "timestamp", "ms"),
            ("gx_dps", "gx", "deg/s"),
            ("gyr_x_deg_per_s", "gyr_x", "deg/s"),
            ("gyr.x.rad_s", "gyr.x", "rad/s"),
            ("Time (\u{b5}s)", "Time", "us"),
            ("Acceleration x (m/s²)", "Acceleration x", "m/s2"),
            ("spin (U/min)", "spin", "rpm"),
            ("Lz (J s)", "Lz", "J s"),
        ] {
            let found = Unit::split(name).map(|(front, own)| (front, own.name));
            assert_eq!(found, Some((stem, unit)), "{name}");
        }
        for name in [
            "x",
            "temp",
            "Time",
            "gyro x",
            "P (hPa)",
            "note (of ours)",
            "",
        ] {
            assert_eq!(Unit::split(name), None, "{name}");
        }
    }

    #[test]
    fn names_in_other_units_are_recognized() {
        let known = |name| {
            in_known_unit(name, |name| {
                ["t_s", "x_m", "body.point.0.at_m.2"].contains(&name)
            })
        };
        assert_eq!(known("t_ms"), Some(("t_s".to_owned(), 1e-3)));
        assert_eq!(known("x_m"), Some(("x_m".to_owned(), 1.0)));
        assert_eq!(known("x_deg"), None);
        let at = Some(("body.point.0.at_m.2".to_owned(), 1e-2));
        assert_eq!(known("body.point.0.at_cm.2"), at);
    }

    #[test]
    fn units_of_one_kind_convert() {
        let times = |from: &str, to: &str| Unit::anybodys(from)?.times(Unit::from_name(to)?);
        assert_eq!(times("t_min", "t_s"), Some(60.0));
        assert_eq!(times("spin_Hz", "spin_rpm"), Some(60.0));
        assert_eq!(times("x_cm", "x_m"), Some(0.01));
        assert_eq!(times("tilt_deg", "t_s"), None);
    }

    #[test]
    fn a_word_is_inserted_before_the_unit() {
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
