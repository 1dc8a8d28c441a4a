//! The curves of a sweep: its rows by what else was varied, and what each is called.

use super::Swept;
use crate::figure::chart::Axis;
use crate::figure::chart::ticks::with_minus;
use crate::figure::of_table::{Rows, grouped, within_room};
use crate::figure::page::letters;
use crate::figure::quantity;
use crate::text::number::shortest;

/// The key whose values are names.
const SCHEME: &str = "motion.scheme";

/// The rows of one curve.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Which of the curves it is, from 0.
    pub index: usize,
    /// Its rows.
    pub rows: Rows,
    /// The values of what else was varied.
    pub settings: Vec<Setting>,
}

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Setting {
    key: String,
    /// How the key stands at an axis.
    axis: Axis,
    value: String,
}

/// The curves of a sweep, of whose keys `along` is on the axis below.
pub(super) fn curves(swept: &Swept<'_>, along: &str) -> Vec<Curve> {
    let &Swept {
        table,
        varied,
        scenario,
    } = swept;
    let others: Vec<_> = varied.iter().filter(|key| *key != along).collect();
    let columns: Vec<_> = others
        .iter()
        .map(|key| table.texts(key).unwrap_or_default())
        .collect();
    let settings = |row: usize| {
        let each = others.iter().zip(&columns).map(|(key, texts)| Setting {
            key: (*key).clone(),
            axis: quantity::axis_in(scenario, key),
            value: texts.get(row).copied().unwrap_or_default().to_owned(),
        });
        each.collect::<Vec<_>>()
    };
    let values = |row: usize| {
        let texts = columns.iter().filter_map(|texts| texts.get(row).copied());
        texts.collect::<Vec<_>>().join("\n")
    };
    let values: Vec<String> = (0..table.count()).map(values).collect();
    let groups = grouped(&values).into_iter().enumerate();
    groups
        .map(|(index, (_, rows))| Curve {
            index,
            settings: settings(rows[0]),
            rows,
        })
        .collect()
}

/// What a curve with these `settings` is called, as markup no longer than `room_pt`; `word` stands before.
pub(super) fn name(word: &str, settings: &[Setting], room_pt: f64) -> String {
    let joined = |said: Vec<String>| {
        let word = (!word.is_empty()).then(|| word.to_owned());
        word.into_iter().chain(said).collect::<Vec<_>>().join(", ")
    };
    let markup = joined(settings.iter().map(Setting::markup).collect());
    let plain = joined(settings.iter().map(Setting::plain).collect());
    within_room(markup, &plain, room_pt)
}

impl Setting {
    /// Symbol, value and unit, as at an axis: "*θ*_{0} = 20°".
    fn markup(&self) -> String {
        if self.key == SCHEME {
            return letters::escape(&self.value);
        }
        let axis = &self.axis;
        let value = match self.value.parse() {
            Ok(number) => with_minus(&shortest(number)),
            Err(_) => return format!("{} = {}", axis.name, letters::escape(&self.value)),
        };
        let space = if ["", "°"].contains(&&*axis.unit) {
            ""
        } else {
            " "
        };
        format!("{} = {value}{space}{}", axis.name, axis.unit)
    }

    /// The whole key and its value.
    fn plain(&self) -> String {
        if self.key == SCHEME {
            self.value.clone()
        } else {
            format!("{} = {}", self.key, self.value)
        }
    }
}
