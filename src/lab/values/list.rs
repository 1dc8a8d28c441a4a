//! The list of the values that can be edited, and the selected value.

use crate::engine::journal::derived::DerivedValue;
use crate::engine::journal::next_push::{NextPush, PushField};
use crate::engine::journal::parameters::Parameter;
use crate::engine::scenario::{Scenario, ScenarioFile, nudge};
use toml::{Table, Value};

/// The headings of the values that are always shown.
pub const MAIN_GROUPS: [&str; 2] = ["start and motion", "body"];
/// The heading of the values of the next push.
pub(super) const NEXT_PUSH_HEADING: &str = "next push (p)";

/// The values, the selected one, and the search text.
///
/// A search lists only values whose group, label or key matches. If any value matches at the beginning of its words,
/// only such values are listed; otherwise those that contain the text anywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueList {
    pub values: Vec<ListedValue>,
    /// Index of the selected value among all values.
    selected: usize,
    pub name: String,
    /// Match quality of the listed values.
    shows: Option<Match>,
}

impl ValueList {
    /// Replaces the values. The selection stays on the value with the same group and label, or else at the same index.
    pub fn set(&mut self, values: Vec<ListedValue>) {
        let was = self
            .selected()
            .map(|value| (value.group.clone(), value.label.clone()));
        self.values = values;
        self.search();
        let stays = was.is_some_and(|(group, label)| self.select(&group, &label));
        if !stays {
            self.selected = self.selected.min(self.values.len().saturating_sub(1));
            self.keep_shown();
        }
    }

    /// Changes the search text. Only values whose group, label or key matches are listed; an empty text lists all.
    ///
    /// The selection stays on its value, or moves to the first one listed.
    pub(in crate::lab) fn filter_by<T>(&mut self, change: impl FnOnce(&mut String) -> T) -> T {
        let changed = change(&mut self.name);
        self.search();
        self.keep_shown();
        changed
    }

    /// Moves the selection by `rows` listed values. It stops at both ends.
    pub fn shift(&mut self, rows: isize) {
        let shown = self.indices();
        let here = shown.iter().position(|&index| index == self.selected);
        let next = here.unwrap_or(0).saturating_add_signed(rows);
        let next = shown.get(next).or(shown.last());
        self.selected = next.copied().unwrap_or(self.selected);
    }

    /// Selects the value `label` of `group`. Returns false if there is none.
    pub fn select(&mut self, group: &str, label: &str) -> bool {
        let mut values = self.values.iter();
        let found = values.position(|value| value.group == group && value.label == label);
        self.selected = found.unwrap_or(self.selected);
        found.is_some()
    }

    /// Selects the value at `index` among all values, if it is listed.
    pub fn select_index(&mut self, index: usize) {
        let is_shown = self
            .values
            .get(index)
            .is_some_and(|value| self.is_shown(value));
        if is_shown {
            self.selected = index;
        }
    }

    pub fn selected(&self) -> Option<&ListedValue> {
        let value = self.values.get(self.selected)?;
        self.is_shown(value).then_some(value)
    }

    /// Returns the index of the selected value among all values.
    pub fn selected_index(&self) -> usize {
        self.selected
    }

    /// Returns the listed values in order, each with its index among all values.
    pub fn shown(&self) -> Vec<(usize, &ListedValue)> {
        let values = self.values.iter().enumerate();
        values.filter(|(_, value)| self.is_shown(value)).collect()
    }

    fn is_shown(&self, value: &ListedValue) -> bool {
        let answer = value.answers(&self.name);
        answer.is_some() && answer == self.shows
    }

    /// Computes the best match quality of the values for the search text.
    fn search(&mut self) {
        let answers = self.values.iter().map(|value| value.answers(&self.name));
        self.shows = answers.flatten().min();
    }

    fn indices(&self) -> Vec<usize> {
        self.shown().into_iter().map(|(index, _)| index).collect()
    }

    fn keep_shown(&mut self) {
        if self.selected().is_none() {
            let first = self.indices().first().copied();
            self.selected = first.unwrap_or(self.selected);
        }
    }
}

/// A value in words, and its source.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedValue {
    /// Dotted key, as in `--set`; `None` for the next push.
    pub key: Option<String>,
    pub group: String,
    pub label: String,
    pub unit: &'static str,
    /// The value with all its digits.
    pub text: String,
    /// True if the scenario's file does not set it, so that the default applies.
    pub is_default: bool,
    pub is_settable: bool,
    /// Priority of a value that is always shown: the highest ranks are dropped first if space is short. `None` for
    /// values that are only in the whole list.
    pub rank: Option<u8>,
    pub(in crate::lab) source: ValueSource,
}

/// The source of a listed value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::lab) enum ValueSource {
    Scenario(Box<Parameter>),
    /// A value that is computed from several keys, and its number.
    Derived(DerivedValue, Option<f64>),
    NextPush(PushField),
}

/// The values that are always shown, in order, with their ranks.
const MAIN_VALUES: [(MainValue, u8); 12] = [
    (MainValue::Key("start.tilt_deg"), 0),
    (MainValue::Derived(DerivedValue::MomentumSize), 0),
    (MainValue::Derived(DerivedValue::MomentumTilt), 3),
    (MainValue::Key("motion.time_step_s"), 0),
    (MainValue::Key("motion.scheme"), 1),
    (MainValue::Key("motion.gravity_m_per_s2"), 4),
    (MainValue::Derived(DerivedValue::PushSize), 2),
    (MainValue::Derived(DerivedValue::PushEnd), 5),
    (MainValue::Derived(DerivedValue::Mass), 0),
    (MainValue::Derived(DerivedValue::Arm), 0),
    (MainValue::Key("body.rim.radius_m"), 1),
    (MainValue::Key("body.rim.points"), 2),
];

enum MainValue {
    Key(&'static str),
    Derived(DerivedValue),
}

/// Moves the values that are always shown out of `parameters`, and adds those that are computed from several keys.
/// `file` is the file of `scenario` with its edits.
pub(super) fn main_values(
    parameters: &mut Vec<Parameter>,
    file: &ScenarioFile,
    scenario: &Scenario,
) -> Vec<ListedValue> {
    let mut values = Vec::with_capacity(MAIN_VALUES.len());
    for (main, rank) in MAIN_VALUES {
        let value = match main {
            MainValue::Key(key) => {
                let place = parameters.iter().position(|parameter| parameter.key == key);
                place.map(|place| ListedValue::from(parameters.remove(place)))
            }
            MainValue::Derived(derived) => ListedValue::of_derived(derived, file, scenario),
        };
        let is_of_body = |key: &str| key.starts_with("body.");
        values.extend(value.map(|value| ListedValue {
            group:
                MAIN_GROUPS[usize::from(value.key.as_deref().is_some_and(is_of_body))].to_owned(),
            rank: Some(rank),
            ..value
        }));
    }
    values
}

fn of_key(parameter: &Parameter, value: Value) -> Table {
    Table::from_iter([(parameter.key.clone(), value)])
}

impl From<Parameter> for ListedValue {
    fn from(parameter: Parameter) -> Self {
        let label = &parameter.label;
        let with_frame = parameter.frame.map(|frame| format!("{label} {frame}"));
        Self {
            key: Some(parameter.key.clone()),
            group: parameter.group.clone(),
            label: with_frame.unwrap_or_else(|| label.clone()),
            unit: parameter.unit(),
            text: parameter.shown(),
            is_default: parameter.is_default,
            is_settable: true,
            rank: None,
            source: ValueSource::Scenario(Box::new(parameter)),
        }
    }
}

impl ListedValue {
    pub(super) fn all_of(push: &NextPush) -> [Self; 4] {
        PushField::ALL.map(|field| Self {
            key: None,
            group: NEXT_PUSH_HEADING.to_owned(),
            label: field.label().0.to_owned(),
            unit: field.label().1,
            text: push.shown(field),
            is_default: false,
            is_settable: true,
            rank: None,
            source: ValueSource::NextPush(field),
        })
    }

    /// Returns the value of `derived` in `scenario`, whose file with its edits is `file`; `None` if this run cannot
    /// have such a value.
    fn of_derived(derived: DerivedValue, file: &ScenarioFile, scenario: &Scenario) -> Option<Self> {
        let number = derived.number(file, scenario);
        let is_listed = match derived {
            DerivedValue::PushSize => file.push.len() <= 1,
            _ => number.is_some(),
        };
        is_listed.then(|| Self {
            key: Some(derived.key().to_owned()),
            group: String::new(),
            label: derived.label().to_owned(),
            unit: derived.unit(),
            text: derived.shown(number),
            is_default: false,
            is_settable: derived.is_settable(file, scenario),
            rank: None,
            source: ValueSource::Derived(derived, number),
        })
    }

    /// Returns the keys to set to nudge the value up `times` times, or down if negative. The table is empty for the
    /// next push, which has no keys.
    ///
    /// # Errors
    /// Returns an error if the value cannot be nudged this way.
    pub(in crate::lab) fn nudged(
        &self,
        times: i32,
        file: &ScenarioFile,
        scenario: &Scenario,
    ) -> Result<Table, String> {
        match &self.source {
            ValueSource::Scenario(parameter) => Ok(of_key(parameter, parameter.nudged(times)?)),
            ValueSource::Derived(derived, number) => {
                let nudged = derived.nudged(number.unwrap_or(0.0), times);
                derived.set(nudged, file, scenario)
            }
            ValueSource::NextPush(_) => Ok(Table::new()),
        }
    }

    /// Returns the keys to set to give the value the content of `text`, and true if that changes it. The table is empty
    /// for the next push, which has no keys.
    ///
    /// # Errors
    /// Returns an error if the value cannot be `text`.
    pub(in crate::lab) fn typed(
        &self,
        text: &str,
        file: &ScenarioFile,
        scenario: &Scenario,
    ) -> Result<(Table, bool), String> {
        match &self.source {
            ValueSource::Scenario(parameter) => {
                let value = parameter.typed(text)?;
                let is_new = value != parameter.value || parameter.is_default;
                Ok((of_key(parameter, value), is_new))
            }
            ValueSource::Derived(derived, number) => {
                let typed = nudge::typed(text, derived.unit())?;
                Ok((derived.set(typed, file, scenario)?, *number != Some(typed)))
            }
            ValueSource::NextPush(_) => Ok((Table::new(), false)),
        }
    }

    /// Returns its key in the scenario's file; `None` if it is computed from several keys or belongs to the next push.
    pub fn file_key(&self) -> Option<&str> {
        let is_of_file = matches!(self.source, ValueSource::Scenario(_));
        self.key.as_deref().filter(|_| is_of_file)
    }

    /// Returns a one-line description with the unit.
    pub fn about(&self) -> &'static str {
        match &self.source {
            ValueSource::Scenario(parameter) => parameter.spec.about,
            ValueSource::Derived(derived, _) => derived.about(),
            ValueSource::NextPush(field) => field.about(),
        }
    }

    /// Returns the match quality of its group, label and key for the search text `name`.
    pub(super) fn answers(&self, name: &str) -> Option<Match> {
        let key = self.key.as_deref().unwrap_or_default();
        Match::find(&format!("{} {} {key}", self.group, self.label), name)
    }
}

/// Match quality of names in a search, ignoring case. The best comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Match {
    /// Each search word is the beginning of a word in the names.
    Word,
    /// Each search word occurs somewhere in the names.
    Part,
}

impl Match {
    /// Returns the match quality of `names` for the search text `name`; `None` if they do not match.
    pub fn find(names: &str, name: &str) -> Option<Self> {
        let (text, search) = (names.to_lowercase(), name.to_lowercase());
        let mut wanted = search.split_whitespace();
        let begins_words = wanted.clone().all(|wanted| {
            let mut words = text.split(|c: char| !c.is_alphanumeric());
            text.starts_with(wanted) || words.any(|word| word.starts_with(wanted))
        });
        if begins_words {
            return Some(Self::Word);
        }
        wanted.all(|word| text.contains(word)).then_some(Self::Part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::journal::parameters::{parameters, table_of};
    use crate::lab::for_tests::scenario;

    /// Returns a scenario value that is listed under this group and label.
    fn listed((group, label): (&str, &str)) -> ListedValue {
        let scenario = scenario();
        let mut parameter = parameters(&table_of(&scenario.file), &scenario).remove(0);
        parameter.key.clear();
        parameter.group = group.to_owned();
        parameter.label = label.to_owned();
        parameter.into()
    }

    fn list(values: &[(&str, &str)]) -> ValueList {
        let mut list = ValueList::default();
        list.set(values.iter().copied().map(listed).collect());
        list
    }

    fn selected(list: &ValueList) -> String {
        let value = list.selected().unwrap();
        format!("{} {}", value.group, value.label)
    }

    #[test]
    fn the_selection_stays_on_its_value() {
        let mut list = list(&[("start", "tilt"), ("motion", "dt"), ("push 0", "steps")]);
        assert!(list.select("motion", "dt"));
        list.set(
            [("body", "dt"), ("start", "tilt"), ("motion", "dt")]
                .map(listed)
                .into(),
        );
        assert_eq!(selected(&list), "motion dt");
        // The value is gone: the value at its index is selected, or the last one.
        list.set([("start", "tilt"), ("start", "Lx")].map(listed).into());
        assert_eq!(selected(&list), "start Lx");
        list.set(Vec::new());
        assert_eq!(list.selected(), None);
    }

    #[test]
    fn the_selection_stops_at_both_ends() {
        let mut list = list(&[("a", "1"), ("a", "2"), ("b", "1")]);
        for (rows, reached) in [(1, "a 2"), (1000, "b 1"), (isize::MIN, "a 1")] {
            list.shift(rows);
            assert_eq!(selected(&list), reached);
        }
        assert!(!list.select("c", "1"));
        assert_eq!(selected(&list), "a 1");
        ValueList::default().shift(3);
    }
}
