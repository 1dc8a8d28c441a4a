//! How a run differs from the motion that the texts of its file (`about`, `source`, `look_at`, `next`, `[[expected]]`) were
//! written for, and what is done with these texts then.

use super::restart::in_force;
use crate::scenario::file::ScenarioFile;
use crate::scenario::presets::{PRESETS, Preset};
use crate::scenario::rescale::at_time_step;
use crate::scenario::{Document, Scenario, float};
use crate::text::number::shortest;
use crate::text::printable::printable;
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;
use toml::{Table, Value};

/// Joins the name of the original and its `about`, in the file of a run that was changed since.
const AS_IT_WAS: &str = " as it was: ";
/// Ends its `source` there.
const CHANGED: &str = "; changed since";

const MOST_LISTED_CHANGES: usize = 2;

/// The longest name of a file, in characters; a file of a longer name is called "what was opened".
const LONGEST_FILE_NAME: usize = 30;

/// The `look_at` line of the file of `scenario`: what the viewer should watch for.
pub fn look_at(scenario: &Scenario) -> Option<&str> {
    scenario.file.viewed_text("look_at")
}

/// The scenario that the words of a file were written for.
#[derive(Clone, Debug)]
pub struct Original {
    scenario: Arc<Scenario>,
    /// What it is called: "the preset cusps", "heron.toml".
    name: String,
}

impl Original {
    /// The original of `opened`, which was opened as `name`: the preset whose words it has, as an exported run has them,
    /// or else itself.
    pub fn of(name: &str, opened: &Arc<Scenario>) -> Self {
        if let Some((preset, scenario)) = preset_with_words_of(opened) {
            return Self {
                scenario: Arc::new(scenario),
                name: format!("the preset {}", preset.name),
            };
        }
        let file = Path::new(name).file_name().unwrap_or_default();
        let file = printable(&file.to_string_lossy()).into_owned();
        let is_short = (1..=LONGEST_FILE_NAME).contains(&file.chars().count());
        let file = Some(file).filter(|_| is_short);
        Self {
            scenario: Arc::clone(opened),
            name: file.unwrap_or("what was opened".to_owned()),
        }
    }

    /// Lists the differences that make `now` move differently. `None` where there are none, or where the `look_at` line
    /// itself is a new one.
    pub fn difference(&self, now: &Scenario) -> Option<String> {
        let is_its = look_at(&self.scenario) == look_at(now);
        self.change(now).filter(|_| is_its)
    }

    /// Lists the differences that make `now` move differently; `None` where there are none.
    fn change(&self, now: &Scenario) -> Option<String> {
        let changes = changes(&self.scenario, now);
        (!changes.is_empty()).then(|| format!("differs from {}: {}", self.name, changes.join(", ")))
    }

    /// `now` as it is to be written to a file: where it moves differently, the words say of which motion they were
    /// written, `look_at` says what was changed, and the numbers expected of the original are left out.
    pub fn marked(&self, now: &Arc<Scenario>) -> Arc<Scenario> {
        let Some(difference) = self.change(now) else {
            return Arc::clone(now);
        };
        let mut marked = Scenario::clone(now);
        let file = &mut marked.file;
        // What the user wrote anew is of this run.
        let original = &self.scenario.file;
        if file.about == original.about
            && let Some(about) = file.about.as_mut().filter(|it| !it.contains(AS_IT_WAS))
        {
            about.insert_str(0, &format!("Of {}{AS_IT_WAS}", self.name));
        }
        if file.source == original.source
            && let Some(source) = file.source.as_mut().filter(|it| !it.ends_with(CHANGED))
        {
            source.push_str(CHANGED);
        }
        let is_its = look_at(&self.scenario) == look_at(now);
        if let Some(view) = file.view.as_mut().filter(|_| is_its) {
            if let Some(look_at) = view.get_mut("look_at") {
                *look_at = difference.into();
            }
            view.remove("next");
        }
        file.expected.clear();
        Arc::new(marked)
    }
}

/// The preset with the same `look_at` or `about` as `scenario`, as it is shipped.
fn preset_with_words_of(scenario: &Scenario) -> Option<(&'static Preset, Scenario)> {
    let words = |file: &ScenarioFile| {
        let look_at = file.viewed_text("look_at");
        (file.about.clone(), look_at.map(str::to_owned))
    };
    let (about, look_at) = words(&scenario.file);
    let may_have = |preset: &&Preset| {
        let mut some = about.iter().chain(&look_at);
        some.any(|words| words.lines().all(|line| preset.text.contains(line)))
    };
    PRESETS.iter().filter(may_have).find_map(|preset| {
        let shipped = Document::parse(preset.name, preset.text).and_then(|it| it.scenario());
        let shipped = shipped.ok()?;
        let (its_about, its_look_at) = words(&shipped.file);
        let is_same = |one: &Option<String>, other| one.is_some() && one == other;
        (is_same(&about, &its_about) || is_same(&look_at, &its_look_at))
            .then_some((preset, shipped))
    })
}

fn changes(before: &Scenario, now: &Scenario) -> Vec<String> {
    let [old, new] = [before, now].map(|run| in_force(run, u64::MAX).0);
    let (old_file, new_file) = (&before.file, &now.file);
    let motion = |name: &str, unit: &str, [new, old]: [f64; 2]| {
        (new != old).then(|| format!("{name} {} {unit}, not {}", shortest(new), shortest(old)))
    };
    let [scheme, old_scheme] = [new, old].map(|motion| motion.scheme.name);
    let changes = [
        motion("dt", "s", [new.time_step_s, old.time_step_s]),
        (scheme != old_scheme).then(|| format!("{scheme} scheme, not {old_scheme}")),
        motion("gravity", "m/s2", [new.gravity, old.gravity]),
        (new_file.body != old_file.body).then(|| "another body".to_owned()),
        values("start", &old_file.start, &new_file.start),
        values("friction", &old_file.friction, &new_file.friction),
        push_change(before, now).map(str::to_owned),
    ];
    let mut changes: Vec<String> = changes.into_iter().flatten().collect();
    if changes.is_empty() && new_file.edit != old_file.edit {
        changes.push("edits on the way".to_owned());
    }
    changes
}

/// How the table `name` has changed: the new values, or, where they are many, that it is another. `None` if it has not.
fn values<T: Serialize + PartialEq>(name: &str, before: &T, now: &T) -> Option<String> {
    if before == now {
        return None;
    }
    // What is not there, as friction may be, is an empty table.
    let [before, now] = [before, now].map(|table| Table::try_from(table).unwrap_or_default());
    let new = now
        .iter()
        .filter(|(key, value)| before.get(*key) != Some(*value))
        .map(|(key, value)| {
            let is_plain = |value: &&Value| float(value).is_some() || value.is_array();
            let old = before.get(key).filter(is_plain);
            let old = old.filter(|_| is_plain(&value)).map(written);
            let old = old.map_or(String::new(), |old| format!(", not {old}"));
            format!("{name}.{key} {}{old}", written(value))
        });
    let new: Vec<_> = new.collect();
    Some(match new.len() {
        1..=MOST_LISTED_CHANGES => new.join(", "),
        _ => format!("another {name}"),
    })
}

/// `value` as a reader writes it: as short as it can be.
fn written(value: &Value) -> String {
    match value {
        Value::Array(list) => {
            let list: Vec<_> = list.iter().map(written).collect();
            format!("[{}]", list.join(", "))
        }
        Value::String(word) => word.clone(),
        Value::Float(number) => shortest(*number),
        value => value.to_string(),
    }
}

/// How the pushes have changed, in words, by more than the rescaling that a new time step causes.
fn push_change(before: &Scenario, now: &Scenario) -> Option<&'static str> {
    let (old, new) = (&before.file, &now.file);
    if new.push == old.push
        || at_time_step(old, now.motion.time_step_s).is_ok_and(|rescaled| rescaled.push == new.push)
    {
        return None;
    }
    Some(match new.push.len().saturating_sub(old.push.len()) {
        0 => "other pushes",
        1 => "one more push",
        _ => "more pushes",
    })
}
