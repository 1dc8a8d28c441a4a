//! Describes how a run differs from the motion that the texts of its file (`about`, `source`, `look_at`, `next`,
//! `[[expected]]`) were written for, and adapts these texts.

use super::restart::in_force;
use crate::scenario::presets::{PRESETS, Preset};
use crate::scenario::rescale::at_time_step;
use crate::scenario::{Document, Motion, Scenario, float};
use crate::text::number::shortest;
use crate::text::printable::printable;
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;
use toml::{Table, Value};

/// Text between the name of the original and its `about`, in the file of a run that has changed since.
const AS_IT_WAS: &str = " as it was: ";
/// End of its `source` in such a file.
const CHANGED: &str = "; changed since";

const MOST_LISTED_CHANGES: usize = 2;

/// Maximum length of a file's name, characters. A file with a longer name is called "what was opened".
const LONGEST_FILE_NAME: usize = 30;

/// Returns the `look_at` line of the file of `scenario`, which tells the viewer what to watch.
pub fn look_at(scenario: &Scenario) -> Option<&str> {
    scenario.file.viewed_text("look_at")
}

/// Scenario that the texts of a file were written for.
#[derive(Clone, Debug)]
pub struct Original {
    scenario: Arc<Scenario>,
    /// Its name: "the preset cusps", "heron.toml".
    name: String,
}

impl Original {
    /// Finds the original of `opened`, which was opened as `name`. It is the preset with the same texts, as in an
    /// exported run, or else `opened` itself.
    pub fn find(name: &str, opened: &Arc<Scenario>) -> Self {
        if let Some((preset, scenario)) = preset_with_words_of(opened) {
            return Self {
                scenario: Arc::new(scenario),
                name: format!("the preset {}", preset.name),
            };
        }
        let file_name = Path::new(name).file_name().unwrap_or_default();
        let shown = printable(&file_name.to_string_lossy()).into_owned();
        let is_short = (1..=LONGEST_FILE_NAME).contains(&shown.chars().count());
        Self {
            scenario: Arc::clone(opened),
            name: if is_short {
                shown
            } else {
                "what was opened".to_owned()
            },
        }
    }

    /// Lists the differences that make `now` move differently. `None` if there are none, or if the `look_at` line is
    /// new too.
    pub fn difference(&self, now: &Scenario) -> Option<String> {
        self.change(now).filter(|_| self.has_look_at_of(now))
    }

    fn has_look_at_of(&self, now: &Scenario) -> bool {
        look_at(&self.scenario) == look_at(now)
    }

    /// Lists the differences that make `now` move differently. `None` if there are none.
    fn change(&self, now: &Scenario) -> Option<String> {
        let list = changes(&self.scenario, now).join(", ");
        (!list.is_empty()).then(|| format!("differs from {}: {list}", self.name))
    }

    /// Returns `now` for writing to a file. If it moves differently, its texts name the motion that they were written
    /// for, and `look_at` lists the changes. The expected numbers of the original are removed.
    pub fn flag_stale_text(&self, now: &Arc<Scenario>) -> Arc<Scenario> {
        let Some(difference) = self.change(now) else {
            return Arc::clone(now);
        };
        let mut marked = Scenario::clone(now);
        let file = &mut marked.file;
        // A text that the user has rewritten belongs to this run.
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
        if let Some(view) = file.view.as_mut().filter(|_| self.has_look_at_of(now)) {
            if let Some(look_at) = view.get_mut("look_at") {
                *look_at = difference.into();
            }
            view.remove("next");
        }
        file.expected.clear();
        Arc::new(marked)
    }
}

/// Finds the preset, as shipped, with the same `look_at` or `about` as `scenario`.
fn preset_with_words_of(scenario: &Scenario) -> Option<(&'static Preset, Scenario)> {
    let words = words_of(scenario);
    PRESETS.iter().find_map(|preset| {
        let mut lines_of_each = words.iter().flatten().map(|text| text.lines());
        if !lines_of_each.any(|mut lines| lines.all(|line| preset.text.contains(line))) {
            return None; // parsing it would take long
        }
        let document = Document::parse(preset.name, preset.text).ok()?;
        let shipped = document.scenario().ok()?;
        let is_same = words
            .iter()
            .zip(words_of(&shipped))
            .any(|(text, its)| text.is_some() && *text == its);
        is_same.then_some((preset, shipped))
    })
}

/// Returns the texts by which a preset is recognized: `about` and `look_at`.
fn words_of(scenario: &Scenario) -> [Option<&str>; 2] {
    [scenario.file.about.as_deref(), look_at(scenario)]
}

fn changes(before: &Scenario, now: &Scenario) -> Vec<String> {
    let [old, new] = [before, now].map(|run| in_force(run, u64::MAX).0);
    let (old_file, new_file) = (&before.file, &now.file);
    let [scheme, old_scheme] = [new, old].map(|motion| motion.scheme.name);
    let of_motion = [
        (
            number_change("dt", "s", [new.time_step_s, old.time_step_s]),
            last_change(now, |motion| motion.time_step_s.to_bits()),
        ),
        (
            (scheme != old_scheme).then(|| format!("{scheme} scheme, not {old_scheme}")),
            last_change(now, |motion| motion.scheme.name),
        ),
        (
            number_change("gravity", "m/s2", [new.gravity, old.gravity]),
            last_change(now, |motion| motion.gravity.to_bits()),
        ),
    ];
    let changes_of_motion = of_motion.into_iter().filter_map(|(change, step)| {
        Some(match step {
            0 => change?,
            step => format!("{}, from step {step} on", change?),
        })
    });
    let others = [
        (new_file.body != old_file.body).then(|| "another body".to_owned()),
        values("start", &old_file.start, &new_file.start),
        values("friction", &old_file.friction, &new_file.friction),
        push_change(before, now).map(str::to_owned),
    ];
    let mut changes: Vec<String> = changes_of_motion
        .chain(others.into_iter().flatten())
        .collect();
    if changes.is_empty() && new_file.edit != old_file.edit {
        changes.push("edits during the run".to_owned());
    }
    changes
}

/// Returns the step of the last edit of `now` that changes the result of `value`, or 0 if none does.
fn last_change<T: PartialEq>(now: &Scenario, value: impl Fn(&Motion) -> T) -> u64 {
    let (mut last, mut before) = (0, value(&now.motion));
    for edit in &now.edits {
        let after = value(&edit.motion);
        if after != before {
            (last, before) = (edit.step, after);
        }
    }
    last
}

fn number_change(name: &str, unit: &str, [new, old]: [f64; 2]) -> Option<String> {
    (new != old).then(|| format!("{name} {} {unit}, not {}", shortest(new), shortest(old)))
}

/// Describes how the table `name` has changed: lists the new values, or, if there are many, says only that the table
/// differs. `None` if it has not changed.
fn values<T: Serialize + PartialEq>(name: &str, before: &T, now: &T) -> Option<String> {
    if before == now {
        return None;
    }
    // A missing table, such as friction, counts as empty.
    let [old_table, new_table] =
        [before, now].map(|table| Table::try_from(table).unwrap_or_default());
    let mut new = Vec::new();
    for (key, value) in &new_table {
        match old_table.get(key) {
            Some(old) if old == value => {}
            Some(old) if is_plain(old) && is_plain(value) => {
                new.push(format!(
                    "{name}.{key} {}, not {}",
                    written(value),
                    written(old)
                ));
            }
            _ => new.push(format!("{name}.{key} {}", written(value))),
        }
    }
    Some(match new.len() {
        1..=MOST_LISTED_CHANGES => new.join(", "),
        _ => format!("another {name}"),
    })
}

fn is_plain(value: &Value) -> bool {
    float(value).is_some() || value.is_array()
}

/// Formats `value` as a person would write it, as short as possible.
fn written(value: &Value) -> String {
    match value {
        Value::Array(list) => {
            let items: Vec<_> = list.iter().map(written).collect();
            format!("[{}]", items.join(", "))
        }
        Value::String(word) => word.clone(),
        Value::Float(number) => shortest(*number),
        value => value.to_string(),
    }
}

/// Describes how the pushes have changed, apart from the rescaling that a new time step causes.
fn push_change(before: &Scenario, now: &Scenario) -> Option<&'static str> {
    let (old, new) = (&before.file, &now.file);
    if new.push == old.push
        || at_time_step(old, now.motion.time_step_s).is_ok_and(|scaled| scaled.push == new.push)
    {
        return None;
    }
    Some(match new.push.len().saturating_sub(old.push.len()) {
        0 => "other pushes",
        1 => "one more push",
        _ => "more pushes",
    })
}
