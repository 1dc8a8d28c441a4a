//! What differs between two rows.

use crate::text::printable::brief;
use crate::text::unit::Unit;
use std::fmt;

/// The most characters of a field that are shown.
const MOST_SHOWN: usize = 60;
/// A difference below this part of the largest number of its unit in the row is rounding.
const ROUNDING: f64 = 1e-9;

/// A field that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// The step, or whatever stands in the first column of the computed row.
    pub row: String,
    /// The first column's name.
    pub row_name: String,
    /// The column's name.
    pub column: String,
    /// What stands in the file.
    pub stands: String,
    /// What was computed.
    pub computed: String,
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            row,
            row_name,
            column,
            stands,
            computed,
        } = self;
        let [stands, computed] = [stands, computed].map(|text| match text.is_empty() {
            true => "empty",
            false => text,
        });
        write!(
            f,
            "the row of {row_name} {row}: {column} is {stands}, computed {computed}"
        )
    }
}

/// The first field that differs by more than rounding between a row of a file and the computed one, or where none does, the
/// first that differs; and how many do. `None` where the rows are not of the same columns.
pub(super) fn differing(
    names: &[String],
    there: &[String],
    wanted: &[String],
) -> Option<(Field, usize)> {
    if there.len() != wanted.len() || names.len() != wanted.len() {
        return None;
    }
    let differs = (0..names.len()).filter(|&place| there[place] != wanted[place]);
    let differs: Vec<usize> = differs.collect();
    let matters = |place: &&usize| is_beyond_rounding(names, there, wanted, **place);
    let place = *differs.iter().find(matters).or(differs.first())?;
    let field = Field {
        row: wanted[0].clone(),
        row_name: names[0].clone(),
        column: names[place].clone(),
        stands: brief(&there[place], MOST_SHOWN),
        computed: wanted[place].clone(),
    };
    Some((field, differs.len()))
}

/// Whether the numbers at `place` differ by more than rounding. The parts of a vector are told by their unit: one of them
/// that is zero has the rounding of the others.
fn is_beyond_rounding(names: &[String], there: &[String], wanted: &[String], place: usize) -> bool {
    let number = |text: &String| text.replace(',', ".").parse::<f64>().ok();
    let (Some(stands), Some(computed)) = (number(&there[place]), number(&wanted[place])) else {
        return true;
    };
    let unit = |place: usize| Unit::of(&names[place]).map(|unit| unit.name);
    let alike = (0..names.len()).filter(|&other| other == place || unit(other) == unit(place));
    let sizes = alike.filter_map(|other| number(&wanted[other]).map(f64::abs));
    let difference = (stands - computed).abs();
    difference.is_nan() || difference > ROUNDING * sizes.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(text: &str) -> Vec<String> {
        text.split(',').map(str::to_owned).collect()
    }

    fn told(there: &str, wanted: &str) -> (String, usize) {
        let names = row("step,t_s,Lx_Js,Lz_Js,tilt_deg");
        let (field, count) = differing(&names, &row(there), &row(wanted)).unwrap();
        (field.column, count)
    }

    #[test]
    fn the_first_field_that_matters_is_told() {
        let wanted = "3,0.3,3.469e-14,90,30";
        assert_eq!(told("3,0.3,3.470e-14,91,30", wanted), ("Lz_Js".into(), 2));
        assert_eq!(told("3,0.3,3.470e-14,90,30", wanted), ("Lx_Js".into(), 1));
        assert_eq!(
            told("3,0.3,3.470e-14,90,n/a", wanted),
            ("tilt_deg".into(), 2)
        );
        assert_eq!(told("3,0.4,3.470e-14,90,30", wanted), ("t_s".into(), 2));
        assert_eq!(told("3,NaN,3.470e-14,90,30", wanted), ("t_s".into(), 2));
        assert_eq!(differing(&row("a,b"), &row("1"), &row("1,2")), None);
    }
}
