//! The axis label of a quantity: symbol and unit of a column, a readout or a scenario key.

use crate::engine::analysis::readouts;
use crate::engine::text::unit::Unit;
use crate::plot::chart::ChartAxis;
use crate::plot::chart::ticks::with_minus;
use crate::plot::letters;

/// Prefix of a run's own measurements, and the word for it on an axis: in figures, "measured" refers to data.
pub const MEASURED_PREFIX: &str = "measured_";
pub const SIMULATED: &str = "simulated";

/// The components of a vector, by their index in a key.
const VECTOR_PARTS: [(&str, &str); 3] = [("0", "*x*"), ("1", "*y*"), ("2", "*z*")];

/// Returns the axis of a column, a readout or a dotted scenario key. A key gets the symbol of the matching readout at
/// the start, if there is one.
pub fn axis(name: &str) -> ChartAxis {
    let last = name.rsplit('.').next().unwrap_or(name);
    let readout = readouts::find(if last == "step" { "steps" } else { last });
    let (words, unit) = words(name);
    match readout {
        Some(readout) if !readout.symbol.is_empty() => {
            let symbol = if name.starts_with("start.") {
                at_start(readout.symbol)
            } else {
                readout.symbol.to_owned()
            };
            ChartAxis::new(symbol, unit_markup(readout.unit))
        }
        Some(readout) if last == name => ChartAxis::new(words, unit_markup(readout.unit)),
        _ => ChartAxis::new(words, unit_markup(unit)),
    }
}

/// Returns the axis of a key in this `scenario`. A point or part of the body is called by its name, as in "mass of
/// weight", and L has the axes of its frame.
pub fn axis_in(scenario: &toml::Table, key: &str) -> ChartAxis {
    if let Some(axis) = of_momentum(scenario, key) {
        return axis;
    }
    let mut steps = key.splitn(4, '.');
    let steps = [(); 4].map(|()| steps.next().unwrap_or_default());
    let [body, list @ ("point" | "part"), number, rest] = steps else {
        return axis(key);
    };
    let number = number.parse::<usize>().ok();
    let named = number.and_then(|number| scenario.get(body)?.get(list)?.get(number)?.get("name"));
    let Some(name) = named.and_then(toml::Value::as_str) else {
        return axis(key);
    };
    let own = axis(rest.strip_prefix("at_m.").unwrap_or(rest));
    let unit = axis(rest).unit;
    ChartAxis::new(format!("{} of {}", own.name, letters::escape(name)), unit)
}

/// Returns the axis of a component of L at the start: x, y, z in the world frame, or 1, 2, 3 in the body frame. Returns
/// `None` for another `key`, or if `scenario` has no start.
fn of_momentum(scenario: &toml::Table, key: &str) -> Option<ChartAxis> {
    let number = key.strip_prefix("start.momentum_Js.")?;
    let part = VECTOR_PARTS
        .iter()
        .position(|(other, _)| *other == number)?;
    let frame = scenario.get("start")?.get("momentum_frame");
    let index = match frame.and_then(toml::Value::as_str) {
        Some("body") => (part + 1).to_string(),
        _ => VECTOR_PARTS[part].1.to_owned(),
    };
    let unit = unit_markup(Unit::from_name("momentum_Js").map_or("", |unit| unit.name));
    Some(ChartAxis::new(at_start(&format!("*L*_{{{index}}}")), unit))
}

/// Returns the symbol of a quantity at the start: with the index 0, after an existing index.
fn at_start(symbol: &str) -> String {
    match symbol.strip_suffix('}') {
        Some(indexed) => format!("{indexed},0}}"),
        None => format!("{symbol}_{{0}}"),
    }
}

/// Returns a name as words in markup, and its unit.
pub fn words(name: &str) -> (String, &'static str) {
    let mut unit = "";
    let mut parts: Vec<&str> = name.split('.').collect();
    if parts.len() > 1 && ["motion", "body"].contains(&parts[0]) {
        parts.remove(0);
    }
    // A number at the end is a component; elsewhere it is the index of a point, a part or a push.
    let mut components = VECTOR_PARTS.iter();
    let component = components.find(|(number, _)| parts.last() == Some(number));
    if component.is_some() {
        parts.pop();
    }
    let mut words: Vec<String> = Vec::new();
    for part in parts {
        let (bare, of_part) = match Unit::from_name(part) {
            Some(own) => (&part[..part.len() - own.end.len()], own.name),
            None => (part, ""),
        };
        if !of_part.is_empty() {
            unit = of_part;
        }
        let named = match bare.strip_prefix(MEASURED_PREFIX) {
            Some(measured) => format!("{SIMULATED} {measured}"),
            None => bare.to_owned(),
        };
        words.push(letters::escape(&named.replace('_', " ")));
    }
    words.extend(component.map(|(_, letter)| (*letter).to_owned()));
    (words.join(" "), unit)
}

/// Converts a unit to markup: rad/s becomes rad s^{−1}.
pub fn unit_markup(unit: &str) -> String {
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    let numerator = above
        .split(' ')
        .filter(|word| !word.is_empty() && *word != "1")
        .map(|word| power(word, ""));
    let denominator = below
        .split(' ')
        .filter(|word| !word.is_empty())
        .map(|word| power(word, "-"));
    numerator.chain(denominator).collect::<Vec<_>>().join(" ")
}

/// Converts a factor of a unit, such as `m2`, to markup. `sign` is "-" in the denominator and "" in the numerator.
fn power(word: &str, sign: &str) -> String {
    let digits = word.trim_start_matches(|c: char| !c.is_ascii_digit());
    let base = match &word[..word.len() - digits.len()] {
        "deg" => "°",
        base => base,
    };
    match (digits, sign) {
        ("", "") => base.to_owned(),
        ("", sign) => format!("{base}^{{{}}}", with_minus(&format!("{sign}1"))),
        (digits, sign) => format!("{base}^{{{}}}", with_minus(&format!("{sign}{digits}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::export::columns::COLUMNS;

    #[test]
    fn columns_have_symbols_and_units() {
        for (column, name, unit) in [
            ("Lx_Js", "*L*_{*x*}", "J s"),
            ("start.spin_rpm", "*ω*_{3,0}", "rpm"),
            ("wz_rad_per_s", "*ω*_{*z*}", "rad s^{−1}"),
            ("tilt_deg", "*θ*", "°"),
            ("steps_per_second", "steps per second", "s^{−1}"),
            ("start.tilt_deg", "*θ*_{0}", "°"),
            ("motion.time_step_s", "Δ*t*", "s"),
            ("start.momentum_Js.2", "start momentum *z*", "J s"),
            ("motion.gravity_m_per_s2", "gravity", "m s^{−2}"),
        ] {
            let axis = axis(column);
            assert_eq!((&*axis.name, &*axis.unit), (name, unit), "{column}");
        }
    }

    #[test]
    fn parts_of_the_body_are_labeled_with_their_names() {
        let text =
            "[[body.point]]\nname = \"a_b\"\n[[body.part]]\n[[body.part]]\nname = \"ball\"\n";
        let [world, body] = [
            "start.momentum_frame='world'",
            "start.momentum_frame='body'",
        ];
        for (scenario, key, written) in [
            (text, "body.point.0.at_m.2", "*z* of a\\_b (m)"),
            (text, "body.point.0.mass_kg", "mass of a\\_b (kg)"),
            (
                text,
                "body.part.1.moments_kg_m2.2",
                "moments *z* of ball (kg m^{2})",
            ),
            (text, "start.momentum_Js.2", "start momentum *z* (J s)"),
            (world, "start.momentum_Js.2", "*L*_{*z*,0} (J s)"),
            (body, "start.momentum_Js.2", "*L*_{3,0} (J s)"),
            // Without a name it is called by its number.
            (text, "body.part.0.mass_kg", "part 0 mass (kg)"),
            (text, "start.tilt_deg", "*θ*_{0} (°)"),
        ] {
            let axis = axis_in(&scenario.parse().unwrap(), key);
            assert_eq!(format!("{} ({})", axis.name, axis.unit), written, "{key}");
        }
    }

    #[test]
    fn every_column_has_a_name_without_underscores() {
        for column in COLUMNS {
            let name = axis(column.name).name;
            assert!(!name.is_empty() && !name.contains("_m"), "{name}");
        }
    }
}
