//! Friction as a scenario gives it, and the schemes that can be true to it.

use super::file::FrictionFile;
use super::problem::{Problem, listed};
use crate::physics::{Body, Damping, Friction, SchemeInfo, scheme};

/// The largest coefficient of friction, divided by the least moment of the body, whose effect is still finite.
const MOST_RATE: f64 = 1e100;

/// The friction of `[friction]` on `body`.
pub(super) fn friction(file: Option<&FrictionFile>, body: &Body) -> Result<Friction, Vec<Problem>> {
    let Some(file) = file else {
        return Ok(Friction::default());
    };
    let friction = Friction {
        spin_dry: file.spin_dry_Nm.unwrap_or(0.0),
        spin_viscous: file.spin_viscous_Nms.unwrap_or(0.0),
        spin_quadratic: file.spin_quadratic_Nms2.unwrap_or(0.0),
        swing_viscous: file.swing_viscous_Nms.unwrap_or(0.0),
    };
    let Some(damping) = Damping::new(body, &friction) else {
        return Ok(Friction::default());
    };
    let rates = [
        ("spin_dry_Nm", friction.spin_dry),
        ("spin_viscous_Nms", friction.spin_viscous),
        ("spin_quadratic_Nms2", friction.spin_quadratic),
        ("swing_viscous_Nms", friction.swing_viscous),
    ];
    let least = damping.least_moment();
    let Some((name, rate)) = rates.iter().find(|(_, rate)| *rate / least > MOST_RATE) else {
        return Ok(friction);
    };
    let rule = format!(
        "is too large for this body, whose least moment is {least:e} kg m^2: at most {:e}",
        MOST_RATE * least
    );
    let value = toml::Value::Float(*rate);
    let key = format!("friction.{name}");
    Err(vec![Problem::with_value(key, &value, rule)])
}

/// Refuses a `scheme` that is not true to `friction`.
pub(super) fn objects(
    scheme: &'static SchemeInfo,
    friction: &Friction,
) -> Result<(), Vec<Problem>> {
    let Some(why) = scheme.admits.objection(friction) else {
        return Ok(());
    };
    let able = listed(scheme::true_to(*friction).map(|scheme| scheme.name));
    let value = toml::Value::String(scheme.name.to_owned());
    let rule = format!("cannot be true to this friction: it {why}; take one of {able}");
    Err(vec![Problem::with_value("motion.scheme", &value, rule)])
}
