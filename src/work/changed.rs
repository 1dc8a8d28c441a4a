//! The scenario's `look_at` line, and the line that replaces it once the user has changed the scenario: the file's
//! line may then be false, so the lab lists the changes instead.

use crate::scenario::rescale::at_time_step;
use crate::scenario::{Motion, Scenario};
use crate::text::number::shortest;

/// The `look_at` line of the file of `scenario`: what the viewer should watch for.
pub fn look_at(scenario: &Scenario) -> Option<&str> {
    scenario.file.view.as_ref()?.look_at.as_deref()
}

/// Lists the differences that make `now` move differently from `before`. `None` where there are none, or where the
/// `look_at` line itself is a new one.
pub fn changed(before: &Scenario, now: &Scenario) -> Option<String> {
    let changes = changes(before, now);
    if changes.is_empty() || look_at(before) != look_at(now) {
        return None;
    }
    Some(format!(
        "differs from what was opened: {}",
        changes.join(", ")
    ))
}

fn changes(before: &Scenario, now: &Scenario) -> Vec<String> {
    let (old, new) = (last_motion(before), last_motion(now));
    let mut changes = Vec::new();
    if new.time_step_s != old.time_step_s {
        changes.push(format!(
            "dt {} s, not {}",
            shortest(new.time_step_s),
            shortest(old.time_step_s)
        ));
    }
    if new.scheme.name != old.scheme.name {
        changes.push(format!(
            "{} scheme, not {}",
            new.scheme.name, old.scheme.name
        ));
    }
    if new.gravity != old.gravity {
        changes.push(format!(
            "gravity {} m/s2, not {}",
            shortest(new.gravity),
            shortest(old.gravity)
        ));
    }
    let others = [
        (now.file.body != before.file.body, "another body"),
        (now.file.start != before.file.start, "another start"),
        (
            now.file.friction != before.file.friction,
            "another friction",
        ),
        (are_pushes_changed(before, now), push_change(before, now)),
    ];
    changes.extend(
        others
            .iter()
            .filter(|(is_changed, _)| *is_changed)
            .map(|(_, what)| (*what).to_owned()),
    );
    if changes.is_empty() && now.file.edit != before.file.edit {
        changes.push("edits on the way".to_owned());
    }
    changes
}

/// Gravity, scheme and time step after the last edit.
fn last_motion(scenario: &Scenario) -> &Motion {
    scenario
        .edits
        .last()
        .map_or(&scenario.motion, |edit| &edit.motion)
}

/// How the pushes have changed, in words.
fn push_change(before: &Scenario, now: &Scenario) -> &'static str {
    match now.file.push.len().saturating_sub(before.file.push.len()) {
        0 => "other pushes",
        1 => "one more push",
        _ => "more pushes",
    }
}

/// Whether the pushes differ by more than the rescaling that a new time step causes.
fn are_pushes_changed(before: &Scenario, now: &Scenario) -> bool {
    let (old, new) = (&before.file, &now.file);
    let is_rescaled = || {
        at_time_step(old, now.motion.time_step_s).is_ok_and(|rescaled| rescaled.push == new.push)
    };
    new.push != old.push && !is_rescaled()
}
